//! Coplanar shrink: simple marching cubes with one region instead of many triangles in one plane.

use super::blocks::{Blocks, FINDING};
use super::bon::{Cell, Merge, cells};
use super::chunks;
use super::lattice::Lattice;
use super::outline::{Edge, Outlines};
use super::plane::Plane;
use super::points;
use super::published;
use super::resolve::{Resolve, resolved};
use super::samples::Samples;
use super::simple::Snap;
use super::size::Least;
use super::sweep::{Sweep, Vertex};
use crate::control::{Control, Job, WHOLE};
use crate::error::{Error, MeshError};
use crate::lattice::axes;
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::OctreeRef;
use alloc::vec::Vec;

/// Extracts the surface of an octree by simple marching cubes, *shrunk*. It is the surface of
/// [`simple_marching_cubes`](crate::surface::simple_marching_cubes) with far fewer triangles in its plane
/// parts. A block of cells has 44 triangles, however large it is.
///
/// All triangles in one plane become one region with straight edges from corner to corner, and each region is
/// cut into triangles without new vertices. Neighbouring regions have the same edges between them, so the
/// mesh has no cracks. It is closed and balanced like that of simple marching cubes, with the same volume and
/// area, and it is a 2-manifold where that mesh is one. Triangles may be long and thin. Vertices are centres
/// of cells, sorted by z, y and x; triangles are sorted by their planes.
///
/// Cells in one plane are merged first, from the bottom of an octree up (see [`published_shrink`]). The
/// triangles of merged cells do not fit together where cells of several sizes meet. So the outlines of all
/// cells are added up instead; the remaining edges bound the regions.
///
/// Everything outside the universe counts as EMPTY. `resolve` is as in
/// [`marching_cubes`](crate::marching_cubes).
///
/// O(n log n + n w) for n cells at the surface, of which at most w lie along a line in a plane region. In
/// addition to the mesh, up to 200 bytes are needed for each cell at a curved surface. The result is the same
/// for any number of threads.
///
/// # Errors
/// As [`marching_cubes`](crate::marching_cubes).
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build, surface::{Snap, coplanar_shrink, simple_marching_cubes}};
/// let frame = Frame::new([0.0; 3], 32.0, 5)?;
/// let block = build(&Csg::cuboid([2.0; 3], [28.0; 3])?, &frame, Rule::Sampled, &Control::default())?;
/// let all = simple_marching_cubes(block.view(), Snap::Fat, None, &Control::default())?;
/// let few = coplanar_shrink(block.view(), Snap::Fat, None, &Control::default())?;
/// assert_eq!((all.triangles().len(), few.triangles().len()), (8_108, 44));
/// assert_eq!(all.volume(), few.volume());
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn coplanar_shrink(
    tree: &OctreeRef<'_>,
    snap: Snap,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    of_octree(tree, Form::Closed, snap, resolve, control)
}

/// Extracts the surface of an octree by coplanar shrink in its published form. This function exists for
/// comparison, because **its mesh has cracks**. The mesh of
/// [`coplanar_shrink`](crate::surface::coplanar_shrink) has no cracks, and fewer triangles.
///
/// The dual cells at the surface lie in an octree that branches on need. From the bottom up, the cells of a
/// node become one if all of them have a *coplanar configuration* (one of the 54 that a plane with one of 13
/// normals makes), and all lie in the same plane. A merged cell has the triangles of marching cubes, with
/// vertices where the plane cuts its edges; other cells have the triangles of
/// [`simple_marching_cubes`](crate::surface::simple_marching_cubes). Where cells of several sizes meet, the
/// smaller cells have vertices on the edges of the larger cells' triangles, and the mesh is open there.
///
/// The method is that of <https://github.com/chnhideyoshi/OctreeBaseSimplifiedMarchingCubes>, which places
/// vertices at the outer samples ([`Snap::Fat`]).
///
/// # Errors
/// As [`marching_cubes`](crate::marching_cubes).
pub fn published_shrink(
    tree: &OctreeRef<'_>,
    snap: Snap,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    of_octree(tree, Form::Published, snap, resolve, control)
}

/// A form of the method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Closed,
    Published,
}

/// Extracts the surface of an octree.
fn of_octree(
    tree: &OctreeRef<'_>,
    form: Form,
    snap: Snap,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    resolved(tree, resolve, control, |tree, partial, control| {
        extract(&Samples::new(tree, partial, u32::MAX)?, &Lattice::new(tree.frame())?, form, snap, control)
    })
}

/// Extracts the surface of samples.
pub(super) fn extract(
    samples: &Samples<'_>,
    lattice: &Lattice,
    form: Form,
    snap: Snap,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let job = Job::new(control);
    job.check()?;
    control.run(samples.levels() > 3, |parallel| {
        let blocks = Blocks::find(samples, &Least::REGIONS, &job, parallel)?;
        let bias = blocks.bias;
        let merge = match form {
            Form::Closed => Merge::Sided,
            Form::Published => Merge::Plane,
        };
        let (of_cells, rest) = ((WHOLE - FINDING) / 4, WHOLE - FINDING - (WHOLE - FINDING) / 4);
        let cells = cells(&blocks, snap, merge, of_cells, &job, parallel)?;
        drop(blocks);
        let (corners, triangles) = match form {
            Form::Closed => closed(&cells, bias, snap, rest, &job, parallel)?,
            Form::Published => published::triangles(&cells, bias, snap, rest, &job, parallel)?,
        };
        drop(cells);
        let vertices = memory::collected(corners.iter().map(|&corner| {
            let at = points::position(corner);
            axes(|axis| lattice.coordinate(axis, 2 * at[axis] + 1))
        }))?;
        Ok(TriangleMesh::from_welded(vertices, triangles, 0, 0))
    })
}

/// Makes regions with outlines that fit together: the samples that are vertices, and the triangles.
fn closed(
    cells: &[Cell],
    bias: i32,
    snap: Snap,
    weight: usize,
    job: &Job<'_>,
    parallel: bool,
) -> Result<(Vec<u64>, Vec<[u32; 3]>), Error> {
    let of_outlines = weight * 2 / 3;
    let Outlines { corners, edges } = Outlines::of(cells, bias, snap.table(), of_outlines, job, parallel)?;
    let mut regions = Vec::new();
    for region in edges.chunk_by(|a, b| a.plane == b.plane) {
        memory::push(&mut regions, region)?;
    }
    let found = chunks::map(regions.len(), weight - of_outlines, job, parallel, |range| {
        let (mut sweep, mut triangles) = (Sweep::default(), Vec::new());
        for region in &regions[range] {
            triangulate(region, &corners, &mut sweep, &mut triangles)?;
        }
        Ok(triangles)
    })?;
    let count = found.iter().map(Vec::len).sum();
    if count > u32::MAX as usize {
        return Err(MeshError::TooMany.into());
    }
    let mut triangles = memory::with_capacity(count)?;
    found.iter().for_each(|part| triangles.extend_from_slice(part));
    Ok((corners, triangles))
}

/// Appends the triangles of a region.
fn triangulate(
    region: &[Edge],
    corners: &[u64],
    sweep: &mut Sweep,
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), Error> {
    let Some(first) = region.first() else { return Ok(()) };
    // The region is seen from outside, along an axis that the plane does not contain.
    let normal = Plane::from_code(first.plane).normal();
    let axis = (0..3).find(|&axis| normal[axis] != 0).unwrap_or(0);
    let (mut u, mut v) = ((axis + 1) % 3, (axis + 2) % 3);
    if normal[axis] < 0 {
        (u, v) = (v, u);
    }
    let vertex = |number: u32| -> Vertex {
        let at = points::position(corners[number as usize]);
        ([at[u], at[v]], number)
    };
    sweep.triangulate(region.iter().map(|edge| [vertex(edge.from), vertex(edge.to)]), triangles)
}
