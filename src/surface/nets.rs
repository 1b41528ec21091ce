//! Surface nets: a vertex in each cube between eight samples, at the mean of its crossings.

use super::blocks::{Blocks, FINDING};
use super::dual::{self, Crossings};
use super::hermite::Hermite;
use super::lattice::Lattice;
use super::resolve::{Resolve, resolved};
use super::samples::Samples;
use super::size::Least;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::octree::OctreeRef;

/// Extracts the surface of an octree by surface nets: a closed mesh. Each cube between eight centres of
/// finest cells that do not all lie on one side has a vertex. The vertex lies at the mean of the middles of
/// the cube's edges that the surface crosses.
///
/// Compared with marching cubes, steps of the cells are smoothed by half a cell, and the triangles are about
/// as many and better shaped: each crossed edge has one quadrilateral, split along its shorter diagonal.
/// Vertices lie within half a cell of those of marching cubes. The method is the plain form of dual
/// contouring, for octrees that store neither surfaces nor normals.
///
/// The mesh is closed, also where the solid reaches the universe's boundary, because everything outside the
/// universe counts as EMPTY. Exactly two triangles meet in each edge, and the triangles around each vertex
/// form one fan: a cube through which several sheets of the surface pass has a vertex for each sheet, and
/// there are some additional vertices where two sheets come near each other. Triangles turn counter-clockwise
/// as seen from outside, and may intersect where sheets come near each other. `resolve` defines the side of
/// PARTIAL cells; `None` suffices for trees without PARTIAL cells.
///
/// (Gibson, *Constrained elastic surface nets*, 1998, without its relaxation; one vertex for each sheet after
/// Nielson, *Dual marching cubes*, 2004, and Schaefer, Ju and Warren, *Manifold dual contouring*, 2007.)
///
/// O(elements of the tree + mesh). In addition to the mesh, 56 bytes are needed for each block of 4³ cells at
/// the surface, and 8 for each vertex. The result is the same for any number of threads.
///
/// # Errors
/// As [`marching_cubes`](crate::marching_cubes).
///
/// ```
/// use leafless::{Control, Csg, FillRule, Frame, Rule, build, surface::surface_nets};
/// let frame = Frame::new([-1.0; 3], 2.0, 6)?;
/// let ball = build(&Csg::ball([0.0; 3], 0.75)?, &frame, Rule::Sampled, &Control::default())?;
/// let mesh = surface_nets(ball.view(), None, &Control::default())?;
/// mesh.check_closed(FillRule::NonZero)?;
/// assert!((mesh.volume() - 1.767).abs() < 0.02);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn surface_nets(
    tree: &OctreeRef<'_>,
    resolve: Option<Resolve<'_>>,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    resolved(tree, resolve, control, |tree, partial, control| {
        let samples = Samples::new(tree, partial, u32::MAX)?;
        let lattice = Lattice::new(tree.frame())?;
        let job = Job::new(control);
        job.check()?;
        control.run(samples.levels() > 3, |parallel| {
            let blocks = Blocks::find(&samples, &Least::NETS, &job, parallel)?;
            job.advance((WHOLE - FINDING) / 4);
            Ok(dual::extract(&Middles, &blocks, &lattice, &job, parallel)?.0)
        })
    })
}

/// Crossings in the middle of edges, without normals.
struct Middles;

impl Crossings for Middles {
    fn at(&self, _: u32) -> Hermite {
        Hermite { t: 0.5, normal: [0.0; 3] }
    }

    fn vanished(&self, _: &Blocks, _: &[bool]) -> Result<u64, Error> {
        // No body vanishes, because vertices lie inside their cubes.
        Ok(0)
    }
}
