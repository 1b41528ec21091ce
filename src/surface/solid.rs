//! Surfaces of any solid, sampled at the corners of the lattice.

use super::blocks::{Block, Blocks};
use super::chunks;
use super::cubes::{midpoints, triangles};
use super::key;
use super::lattice::Lattice;
use super::masks::bits;
use super::samples::Samples;
use super::shrink::{self, Form};
use super::simple::{self, Snap};
use super::size::Least;
use super::weld::weld;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Frame, MAX_DEPTH, morton};
use crate::mesh::TriangleMesh;
use crate::octree::Octree;
use crate::op::{Rule, build};
use crate::solid::{Classifier, DynSolid};
use crate::walk::{Edge, Trail};
use alloc::vec::Vec;
use core::ops::Range;
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// The place of a marching-cubes vertex on an edge between an inside and an outside sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum VertexPlacement {
    /// Half-way. The mesh has steps, and deviates from the surface by up to half a cell.
    #[default]
    Midpoint,
    /// The point where the edge crosses the solid's surface; if there are several crossings, one of them.
    ///
    /// The solid is queried for the crossing ([`Question::Crossing`](crate::solid::Question::Crossing)). If
    /// the solid cannot compute it, cells along the edge are split, down to the depth of 20, and their
    /// verdicts and slabs narrow down the crossing. With slabs, as half-spaces, CSG and meshes provide them,
    /// the crossing is found to rounding in a few steps. Without slabs it is found to about a finest cell of
    /// depth 20 or somewhat more.
    ///
    /// Vertices that then coincide at a sample become one vertex, and triangles without area are dropped.
    /// Faces that lie in planes of the lattice are reproduced exactly; an edge between two such faces is cut
    /// off by one cell where samples on both faces lie outside. Where the solid has no thickness at a sample,
    /// the mesh is closed and balanced, but more than two triangles may meet on an edge.
    Crossing,
}

/// Extracts the surface of a solid by marching cubes. The samples are the corners of the cells of `frame`,
/// 2^depth + 1 per axis.
///
/// The mesh is closed and oriented as that of [`marching_cubes`](crate::marching_cubes). The part of the
/// solid outside the frame's universe is cut off. There the vertices lie on the boundary of the universe with
/// [`VertexPlacement::Crossing`], otherwise half a cell beyond it. A corner on the solid's surface is decided
/// by the shift by (ε, ε², ε³) that all samples share.
///
/// The solid is built on a frame of twice the edge and one more level, whose cells have the corners as
/// centres. So the time is that of [`build`](crate::build) with [`Rule::Sampled`](crate::Rule::Sampled), plus
/// some splits per vertex for crossings. (A solid that extends beyond the universe is also sampled there.)
/// The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] if the depth of the frame is 20, which leaves no further level, or if the frame is so
/// far from the origin that doubles cannot distinguish its corners; [`Error::NotSampled`] if the solid cannot
/// decide points; [`Error::FrameMismatch`] for stored octrees, which have samples of their own; the other
/// errors of the solid; [`MeshError::TooMany`](crate::error::MeshError::TooMany) for more than 2^32 − 1
/// vertices or triangles; [`Error::OutOfMemory`]; and cancellation or an exceeded limit of `control`.
///
/// ```
/// use leafless::{Control, Csg, Frame, surface::{VertexPlacement, marching_cubes_solid}};
/// let frame = Frame::new([-1.0; 3], 2.0, 5)?;
/// let (ball, control) = (Csg::ball([0.0; 3], 0.75)?, Control::default());
/// let mesh = marching_cubes_solid(&ball, &frame, VertexPlacement::Crossing, &control)?;
/// for [x, y, z] in mesh.vertices() {
///     assert!((x * x + y * y + z * z - 0.75 * 0.75).abs() < 1e-9);
/// }
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn marching_cubes_solid(
    solid: &dyn DynSolid,
    frame: &Frame,
    placement: VertexPlacement,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let corners = Corners::new(solid, frame, control)?;
    let samples = corners.samples()?;
    control.share([0.5, 1.0], |control| {
        let job = Job::new(control);
        job.check()?;
        let finest = match placement {
            VertexPlacement::Midpoint => None,
            VertexPlacement::Crossing => Some(solid.on(&frame.with_depth(MAX_DEPTH)?, control)?),
        };
        control.run(samples.levels() > 2, |parallel| {
            let blocks = Blocks::find(&samples, &Least::CUBES, &job, parallel)?;
            let mut vertices = midpoints(Vec::new(), &blocks, &corners.lattice, &job, parallel)?;
            let mut is_welded = true;
            if let Some(classifier) = &finest {
                let crossings = Crossings { classifier, frame, corners: &corners, blocks: &blocks };
                is_welded = crossings.find(&mut vertices, &job, parallel)?;
            }
            let triangles = triangles(Vec::new(), &blocks, &job, parallel)?;
            if is_welded {
                Ok(TriangleMesh::from_welded(vertices, triangles, 0, 0))
            } else {
                weld(vertices, triangles)
            }
        })
    })
}

/// Extracts the surface of a solid by simple marching cubes, sampled as by [`marching_cubes_solid`]. Its
/// vertices are corners of the lattice, or of cells beside the universe. In all other respects it is as
/// [`simple_marching_cubes`](crate::surface::simple_marching_cubes).
///
/// # Errors
/// As [`marching_cubes_solid`].
pub fn simple_marching_cubes_solid(
    solid: &dyn DynSolid,
    frame: &Frame,
    snap: Snap,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let corners = Corners::new(solid, frame, control)?;
    control.share([0.5, 1.0], |control| simple::extract(&corners.samples()?, &corners.lattice, snap, control))
}

/// Extracts the surface of a solid by coplanar shrink, sampled as by [`marching_cubes_solid`]. In all other
/// respects it is as [`coplanar_shrink`](crate::surface::coplanar_shrink).
///
/// # Errors
/// As [`marching_cubes_solid`].
pub fn coplanar_shrink_solid(
    solid: &dyn DynSolid,
    frame: &Frame,
    snap: Snap,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    shrunk(solid, frame, Form::Closed, snap, control)
}

/// Extracts the surface of a solid by the published form of coplanar shrink, which has cracks, sampled as by
/// [`marching_cubes_solid`]. In all other respects it is as
/// [`published_shrink`](crate::surface::published_shrink).
///
/// # Errors
/// As [`marching_cubes_solid`].
pub fn published_shrink_solid(
    solid: &dyn DynSolid,
    frame: &Frame,
    snap: Snap,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    shrunk(solid, frame, Form::Published, snap, control)
}

fn shrunk(
    solid: &dyn DynSolid,
    frame: &Frame,
    form: Form,
    snap: Snap,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let corners = Corners::new(solid, frame, control)?;
    control.share([0.5, 1.0], |control| {
        shrink::extract(&corners.samples()?, &corners.lattice, form, snap, control)
    })
}

/// The corners of a lattice, inside or outside a solid.
struct Corners {
    /// A tree whose cells have the corners as centres.
    tree: Octree,
    /// Corners per axis.
    count: u32,
    lattice: Lattice,
}

impl Corners {
    fn new(solid: &dyn DynSolid, frame: &Frame, control: &Control<'_>) -> Result<Corners, Error> {
        if frame.depth() >= MAX_DEPTH {
            return Err(Error::Argument { name: "frame", problem: "must have a depth of at most 19" });
        }
        // If doubles resolve the cells of the frame, they also resolve its corners, up to rounding.
        Lattice::new(frame)?;
        let origin = frame.origin().each(|o| o - 0.5 * frame.cell_size());
        let frame_of_corners = Frame::new(origin, 2.0 * frame.edge(), frame.depth() + 1)?;
        let lattice = Lattice::new(&frame_of_corners)?;
        let tree =
            control.share([0.0, 0.5], |control| build(solid, &frame_of_corners, Rule::Sampled, control))?;
        Ok(Corners { tree, count: frame.cells() + 1, lattice })
    }

    fn samples(&self) -> Result<Samples<'_>, Error> {
        Samples::new(self.tree.view(), false, self.count)
    }
}

/// Moves vertices to crossings.
struct Crossings<'a, C> {
    classifier: &'a C,
    frame: &'a Frame,
    corners: &'a Corners,
    blocks: &'a Blocks,
}

impl<C: Classifier> Crossings<'_, C> {
    /// Moves all vertices. Returns whether they still are distinct.
    fn find(&self, vertices: &mut [[f64; 3]], job: &Job<'_>, parallel: bool) -> Result<bool, Error> {
        let list = &self.blocks.list;
        let start = |i: usize| list[i].vertex as usize;
        let is_welded = AtomicBool::new(true);
        chunks::for_each(list.len(), vertices, start, 0, job, parallel, |range, piece| {
            if !self.in_chunk(range, piece, job)? {
                is_welded.store(false, Relaxed);
            }
            Ok(())
        })?;
        Ok(is_welded.into_inner())
    }

    fn in_chunk(&self, range: Range<usize>, piece: &mut [[f64; 3]], job: &Job<'_>) -> Result<bool, Error> {
        let mut trail = Trail::new(self.classifier.worker()?)?;
        let mut places = piece.iter_mut();
        let mut is_welded = true;
        for block in &self.blocks.list[range] {
            job.check()?;
            for (edge, place) in edges(block, self.blocks.bias).zip(&mut places) {
                let t = edge.crossing(self.frame, &mut trail, job.control())?;
                let end =
                    |k: i32| self.corners.lattice.coordinate(edge.axis, 2 * (edge.lower[edge.axis] + k) + 1);
                let (low, high) = (end(0), end(1));
                let x = (low + t * (high - low)).clamp(low, high);
                place[edge.axis] = x;
                is_welded &= low < x && x < high;
            }
        }
        Ok(is_welded)
    }
}

/// The cut edges of a block in the order of their vertices.
pub(super) fn edges(block: &Block, bias: i32) -> impl Iterator<Item = Edge> {
    let at = key::position(block.key, bias);
    let block = *block;
    (0..3).flat_map(move |axis| {
        bits(block.cut[axis]).map(move |c| {
            let inner = morton::position(c);
            let lower = axes(|axis| 4 * at[axis] + inner[axis] as i32);
            Edge { axis, lower, steps: 1, starts_inside: block.inside >> c & 1 != 0 }
        })
    })
}
