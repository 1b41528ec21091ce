//! Surfaces of volumes: vertices where the field between samples leaves the band.

use super::blocks::{Block, Blocks, FINDING};
use super::chunks;
use super::cubes::triangles;
use super::lattice::Lattice;
use super::resolve::{Resolve, resolved};
use super::samples::Samples;
use super::size::Least;
use super::solid::edges;
use super::weld::weld;
use crate::control::{Control, Job, WHOLE};
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{LARGEST, SMALLEST};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::OctreeRef;
use crate::op::{Rule, build};
use crate::solid::{Volume, VoxelGrid};
use crate::walk::Edge;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Extracts the surface of a volume by marching cubes. Vertices lie where the field, interpolated linearly
/// between neighbouring samples, leaves the band ([`Volume::crossing_between`]). For samples of a smooth
/// function, the vertices lie on the surface to second order in the spacing.
///
/// Samples are the centres of voxels, which need not be cubes. Everything beyond the grid is outside, so that
/// the mesh is closed, with vertices in the outer faces of the grid. Between bits, and where a sample is
/// infinite or NaN, a vertex lies half-way. The mesh is oriented as that of
/// [`marching_cubes`](crate::marching_cubes). Vertices that coincide at a sample on the surface become one
/// vertex, and triangles without area are dropped. At such places more than two triangles may meet on an
/// edge, in balance.
///
/// O(n / 64 + surface) for n samples. The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] if the grid is so far from the origin that doubles cannot distinguish its voxels;
/// [`MeshError::TooMany`] for more than 2^32 − 1 vertices or triangles; [`Error::TooLarge`] or
/// [`Error::Limit`] beyond the limits of `control`; [`Error::OutOfMemory`]; [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Volume, solid::{Band, VoxelGrid}, surface::marching_cubes_volume};
/// let grid = VoxelGrid::new([3, 3, 3], [0.0; 3], [1.0; 3])?;
/// let mut samples = [0.0f32; 27];
/// samples[13] = 4.0;
/// let volume = Volume::new(samples[..].into(), &grid, Band::at_least(1.0)?, &Control::default())?;
/// let mesh = marching_cubes_volume(&volume, &Control::default())?;
/// assert_eq!(mesh.bounds(), ([0.75; 3], [2.25; 3]));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn marching_cubes_volume(volume: &Volume<'_>, control: &Control<'_>) -> Result<TriangleMesh, Error> {
    // Voxels become cells of edge 1, whatever their shape.
    let cells = volume.in_voxels()?;
    let frame = cells.grid().frame()?;
    let tree = control.share([0.0, 0.5], |control| build(&cells, &frame, Rule::Sampled, control))?;
    control.share([0.5, 1.0], |control| extract(tree.view(), false, volume, [0; 3], control))
}

/// Extracts the surface of an octree whose finest cells are voxels of a volume. The mesh is as that of
/// [`marching_cubes`](crate::marching_cubes), but where the volume's own surface passes between two cells,
/// the vertices are those of [`marching_cubes_volume`]. Elsewhere, for example where set operations have cut
/// the octree, vertices lie half-way.
///
/// `resolve` defines the side of PARTIAL cells; `None` suffices for trees without PARTIAL cells.
///
/// # Errors
/// [`Error::Argument`] if the finest cells are not voxels of the volume's lattice ([`VoxelGrid::frame`] makes
/// a suitable frame), and as [`marching_cubes`](crate::marching_cubes).
pub fn marching_cubes_with_volume(
    tree: &OctreeRef<'_>,
    volume: &Volume<'_>,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let problem = "must have the octree's finest cells as voxels";
    let first = volume.first_voxel(tree.frame()).ok_or(Error::Argument { name: "volume", problem })?;
    Lattice::new(tree.frame())?;
    resolved(tree, resolve, control, |tree, partial, control| extract(tree, partial, volume, first, control))
}

/// Extracts the surface of a tree whose first cell is the voxel `first`, whether or not that voxel lies in
/// the grid.
fn extract(
    tree: &OctreeRef<'_>,
    partial: bool,
    volume: &Volume<'_>,
    first: [i64; 3],
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    check_resolution(volume.grid())?;
    let samples = Samples::new(tree, partial, u32::MAX)?;
    let job = Job::new(control);
    job.check()?;
    control.run(samples.levels() > 3, |parallel| {
        let blocks = Blocks::find(&samples, &Least::CUBES, &job, parallel)?;
        let mut vertices = memory::filled(blocks.vertices, [0.0; 3])?;
        let (list, weight) = (&blocks.list, (WHOLE - FINDING) / 2);
        let start = |i: usize| list[i].vertex as usize;
        let is_welded = AtomicBool::new(true);
        chunks::for_each(list.len(), &mut vertices, start, weight, &job, parallel, |range, piece| {
            let places = Places { volume, first, bias: blocks.bias };
            if !places.fill(&list[range], piece, &job)? {
                is_welded.store(false, Relaxed);
            }
            Ok(())
        })?;
        let triangles = triangles(Vec::new(), &blocks, &job, parallel)?;
        if is_welded.into_inner() {
            Ok(TriangleMesh::from_welded(vertices, triangles, 0, 0))
        } else {
            weld(vertices, triangles)
        }
    })
}

/// Refuses grids whose voxels doubles cannot distinguish.
fn check_resolution(grid: &VoxelGrid) -> Result<(), Error> {
    for axis in 0..3 {
        let spacing = grid.spacing()[axis];
        let farthest = grid.corner()[axis].abs() + 2.0 * f64::from(grid.extents()[axis] + 1) * spacing;
        if farthest > LARGEST {
            return Err(MeshError::TooLarge { vertex: 0 }.into());
        }
        if spacing < 4.0 * SMALLEST || spacing < 16.0 * f64::EPSILON * farthest {
            let problem = "so far from the origin, or so small, that doubles cannot tell its voxels apart";
            return Err(Error::Argument { name: "grid", problem });
        }
    }
    Ok(())
}

/// The places of vertices.
struct Places<'a> {
    volume: &'a Volume<'a>,
    first: [i64; 3],
    bias: i32,
}

impl Places<'_> {
    /// Places the vertices of blocks. Returns whether they are distinct.
    fn fill(&self, blocks: &[Block], piece: &mut [[f64; 3]], job: &Job<'_>) -> Result<bool, Error> {
        let mut places = piece.iter_mut();
        let mut is_welded = true;
        for block in blocks {
            job.check()?;
            for (edge, place) in edges(block, self.bias).zip(&mut places) {
                let at = axes(|axis| self.first[axis] + i64::from(edge.lower[axis]));
                *place = axes(|axis| self.coordinate(axis, at[axis], 0.0));
                let (low, high) = (place[edge.axis], self.coordinate(edge.axis, at[edge.axis], 1.0));
                let x = self.coordinate(edge.axis, at[edge.axis], self.crossing(&edge, at)).clamp(low, high);
                place[edge.axis] = x;
                is_welded &= low < x && x < high;
            }
        }
        Ok(is_welded)
    }

    /// The coordinate at a fraction of a step behind a sample, in model units.
    fn coordinate(&self, axis: usize, at: i64, part: f64) -> f64 {
        let grid = self.volume.grid();
        let x = grid.corner()[axis] + (at as f64 + (0.5 + part)) * grid.spacing()[axis];
        if x.abs() < SMALLEST { 0.0 } else { x }
    }

    /// Returns the fraction of the edge at which it is crossed, from the sample `at` on; one half if the
    /// volume does not cross it in this direction.
    fn crossing(&self, edge: &Edge, at: [i64; 3]) -> f64 {
        // (Places beyond such numbers are beyond the grid.)
        let at = at.each(|a| i32::try_from(a).unwrap_or(i32::MAX - 1));
        let starts_inside = self.volume.contains_voxel(at.each(|a| u32::try_from(a).unwrap_or(u32::MAX)));
        match self.volume.crossing_between(at, edge.axis) {
            Some(t) if starts_inside == edge.starts_inside => t,
            _ => 0.5,
        }
    }
}
