//! Surfaces of tri-dexel models: vertices where rays cross the solid's surface.

use super::blocks::{Blocks, FINDING};
use super::chunks;
use super::cubes::triangles;
use super::dual::{self, Crossings};
use super::hermite::{Hermite, Said, said};
use super::lattice::Lattice;
use super::samples::Samples;
use super::size::Least;
use super::solid::edges;
use super::vanished::{is_kept, vanished};
use super::weld::weld;
use crate::control::{Control, Job, WHOLE};
use crate::dexel::{DexelFormat, DexelNormals, TriDexelRef};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Frame, axes};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::op::{DexelOptions, dexelize, octree_from_dexels};
use crate::solid::DynSolid;
use crate::walk::Edge;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

/// A report on how exactly a surface of a tri-dexel model follows its rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct DexelSurfaceReport {
    /// Edges between two neighbouring cell centres of which one lies inside: the places where a ray crosses
    /// the surface.
    pub crossings: u64,
    /// Crossings on edges that the ray crosses more than once: a feature thinner than a cell is lost there.
    pub several: u64,
    /// Crossings that were put in the middle of their edges because the model has no rays along them.
    pub without_rays: u64,
    /// Crossings that were put in the middle of their edges because the ray along the edge does not leave the
    /// solid there: the directions of the model disagree.
    pub disagreeing: u64,
    /// Crossings without a known normal. (Dual contouring only.)
    pub without_normals: u64,
    /// Vertices whose crossings all have no normal; they lie at the mean of the crossings. (Dual contouring
    /// only.)
    pub means: u64,
    /// Vertices that would fit their planes better outside their cells. (Dual contouring only.)
    pub clamped: u64,
    /// Bodies that are missing in the mesh. A body is a connected set of inside cell centres, each adjacent
    /// to the next along an axis. It is missing if none of its crossings has a triangle. Its surface then
    /// lies nearer to its centres than doubles can express, so that its vertices lie at the centres, and each
    /// of its triangles has two corners at one place.
    pub vanished: u64,
    /// Intervals in all directions that contain no cell centre; touching intervals count as one. Such a
    /// feature is thinner than the lattice, belongs to no body, and has no crossing.
    pub without_centres: u64,
}

/// Extracts the surface of a solid by dual contouring, with sharp edges and corners. A tri-dexel model with
/// normals is made of the solid on `frame`, passed to [`dual_contouring_dexels`], and dropped.
///
/// ```
/// use leafless::{Control, Csg, Frame, surface::dual_contouring_solid};
/// let frame = Frame::new([-1.0; 3], 2.0, 4)?;
/// let block = Csg::cuboid([-0.52, -0.33, -0.71], [0.61, 0.47, 0.29])?;
/// let (mesh, _) = dual_contouring_solid(&block, &frame, &Control::default())?;
/// // The eight corners are vertices, and nothing is cut off.
/// assert!((mesh.volume() - 1.13 * 0.8 * 1.0).abs() < 1e-6);
/// # Ok::<(), leafless::Error>(())
/// ```
///
/// # Errors
/// As [`dexelize`] and [`marching_cubes_dexels`].
pub fn dual_contouring_solid(
    solid: &dyn DynSolid,
    frame: &Frame,
    control: &Control<'_>,
) -> Result<(TriangleMesh, DexelSurfaceReport), Error> {
    let format = DexelFormat { normals: DexelNormals::Bits32, ..DexelFormat::default() };
    let options = DexelOptions { format, ..DexelOptions::default() };
    let model = control.share([0.0, 0.6], |control| dexelize(solid, frame, &options, control))?;
    control.share([0.6, 1.0], |control| dual_contouring_dexels(model.view(), control))
}

/// Extracts the surface of a tri-dexel model by marching cubes: a closed mesh, with vertices where rays cross
/// the solid's surface.
///
/// The samples are the centres of cells, as in [`octree_from_dexels`](crate::op::octree_from_dexels);
/// everything outside the universe is outside. On each edge between two neighbouring centres of which one
/// lies inside, there is one vertex. It lies where the ray along this edge leaves the solid, nearest to the
/// inside centre. The report counts edges that the ray crosses more than once, and edges without such a
/// place: the model has no rays in this direction, or its directions disagree. On these edges the vertex lies
/// half-way.
///
/// The mesh is oriented as that of [`marching_cubes`](crate::marching_cubes). Vertices that coincide at a
/// centre on the surface become one vertex, and triangles without area are dropped. At such places more than
/// two triangles may meet on an edge, in balance. Everywhere else every edge belongs to exactly two
/// triangles. A body that loses all its triangles in this way [is counted](DexelSurfaceReport::vanished). A
/// feature that [contains no centre](DexelSurfaceReport::without_centres) is not in the mesh, and is also
/// counted.
///
/// Edges and corners of the solid are cut off by up to a cell; [`dual_contouring_dexels`] keeps them.
///
/// O(rays + intervals + octree + mesh), where the octree is that of
/// [`octree_from_dexels`](crate::op::octree_from_dexels). The result is the same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] if the frame is so far from the origin that doubles cannot distinguish its cells;
/// [`MeshError::TooMany`](crate::error::MeshError::TooMany) for more than 2^32 − 1 vertices or triangles;
/// [`Error::TooLarge`] or [`Error::Limit`] beyond the limits of `control`; [`Error::OutOfMemory`];
/// [`Error::Cancelled`].
///
/// ```
/// use leafless::{
///     Control, Frame, TriDexel, dexel::{Dexel, DexelEnd, DexelFormat}, surface::marching_cubes_dexels,
/// };
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 5)?, Control::default());
/// // A ball of radius 0.75.
/// let ball = |_: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
///     let [u, v] = ray.map(|i| (f64::from(i) + 0.5) / 16.0 - 1.0);
///     let rest = 0.75 * 0.75 - u * u - v * v;
///     if rest > 0.0 {
///         let end = DexelEnd::new;
///         list.push(Dexel { start: end(-rest.sqrt()), end: end(rest.sqrt()), material: 0 });
///     }
///     Ok(())
/// };
/// let model = TriDexel::from_rays(&frame, DexelFormat::default(), [true; 3], ball, &control)?;
/// let (mesh, report) = marching_cubes_dexels(model.view(), &control)?;
/// assert_eq!(report.without_rays + report.disagreeing, 0);
/// for [x, y, z] in mesh.vertices() {
///     assert!((x * x + y * y + z * z - 0.75 * 0.75).abs() < 1e-8);
/// }
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn marching_cubes_dexels(
    model: &TriDexelRef<'_>,
    control: &Control<'_>,
) -> Result<(TriangleMesh, DexelSurfaceReport), Error> {
    model.sound()?;
    surface(model, control, |lattice, blocks, job, parallel| {
        let mut vertices = memory::filled(blocks.vertices, [0.0; 3])?;
        let is_welded = AtomicBool::new(true);
        let rays = Rays { model, blocks, counts: Counts::default() };
        rays.for_each(&mut vertices, (WHOLE - FINDING) / 2, job, parallel, |edge, hermite, vertex| {
            let place = |axis: usize| f64::from(edge.lower[axis]) + 0.5;
            *vertex = axes(|axis| lattice.position(axis, place(axis)));
            let (low, high) = (vertex[edge.axis], lattice.position(edge.axis, place(edge.axis) + 1.0));
            let x = lattice.position(edge.axis, place(edge.axis) + hermite.t).clamp(low, high);
            vertex[edge.axis] = x;
            if !(low < x && x < high) {
                is_welded.store(false, Relaxed);
            }
        })?;
        let triangles = triangles(Vec::new(), blocks, job, parallel)?;
        let mut bodies = 0;
        let mesh = if is_welded.into_inner() {
            TriangleMesh::from_welded(vertices, triangles, 0, 0)
        } else {
            let mut covered = memory::filled(vertices.len(), false)?;
            for &triangle in triangles.iter().filter(|&&triangle| is_kept(&vertices, triangle)) {
                triangle.iter().for_each(|&crossing| covered[crossing as usize] = true);
            }
            bodies = vanished(model, blocks, |crossing| covered[crossing])?;
            weld(vertices, triangles)?
        };
        let report = rays.counts.report(model, blocks);
        Ok((mesh, DexelSurfaceReport { without_normals: 0, vanished: bodies, ..report }))
    })
}

/// Extracts the surface of a tri-dexel model by dual contouring: a closed mesh that keeps the solid's edges
/// and corners.
///
/// Samples and crossings are those of [`marching_cubes_dexels`]. In each cube between eight centres the mesh
/// has one vertex for each sheet of the surface. The vertex lies where it fits best the planes at the sheet's
/// crossings, with the normals that the model stores (at the minimum of their quadratic error function), and
/// never outside the cube. On a smooth surface this place is near the mean of the crossings; on an edge of
/// the solid it lies on the edge; where three faces meet, it is the corner. Two faces that meet at less than
/// about 11 degrees count as smooth. Crossings without a known normal contribute to the mean only, so a model
/// without normals gives a smooth mesh.
///
/// Each crossing gives a quadrilateral between the four cubes around it, split by the diagonal that passes
/// nearer to the crossing. (Ju, Losasso, Schaefer and Warren 2002; one vertex for each sheet after Nielson
/// 2004 and Schaefer, Ju and Warren 2007.)
///
/// The mesh is oriented as that of [`marching_cubes`](crate::marching_cubes). Every edge belongs to exactly
/// two triangles, in opposite directions. This needs some additional vertices where two sheets come near each
/// other: on a face between two cubes that has two inside centres at the ends of a diagonal, if the sheets
/// around both centres are connected in both cubes. Vertices at one place, as on the common face of two
/// cubes, become one vertex, and triangles without area are dropped. At such places more than two triangles
/// may meet on an edge, in balance. Triangles may intersect. Missing bodies are counted as by
/// [`marching_cubes_dexels`]; any other body of one centre is a cuboid around the centre.
///
/// Time as for [`marching_cubes_dexels`]. The result is the same for any number of threads.
///
/// # Errors
/// As [`marching_cubes_dexels`].
pub fn dual_contouring_dexels(
    model: &TriDexelRef<'_>,
    control: &Control<'_>,
) -> Result<(TriangleMesh, DexelSurfaceReport), Error> {
    model.sound()?;
    surface(model, control, |lattice, blocks, job, parallel| {
        let mut crossings = memory::filled(blocks.vertices, Hermite::default())?;
        let rays = Rays { model, blocks, counts: Counts::default() };
        rays.for_each(&mut crossings, (WHOLE - FINDING) / 4, job, parallel, |_, hermite, crossing| {
            *crossing = hermite;
        })?;
        let told = Told { model, crossings };
        let (mesh, counts) = dual::extract(&told, blocks, lattice, job, parallel)?;
        let dual::DualCounts { means, clamped, vanished } = counts;
        Ok((mesh, DexelSurfaceReport { means, clamped, vanished, ..rays.counts.report(model, blocks) }))
    })
}

/// The crossings that the rays of a model give for the cut edges.
struct Told<'a> {
    model: &'a TriDexelRef<'a>,
    crossings: Vec<Hermite>,
}

impl Crossings for Told<'_> {
    #[inline(always)]
    fn at(&self, edge: u32) -> Hermite {
        self.crossings[edge as usize]
    }

    fn vanished(&self, blocks: &Blocks, covered: &[bool]) -> Result<u64, Error> {
        vanished(self.model, blocks, |crossing| covered[crossing])
    }
}

/// Passes the blocks of a model's samples to `extract` and returns its result.
fn surface<R: Send>(
    model: &TriDexelRef<'_>,
    control: &Control<'_>,
    extract: impl FnOnce(&Lattice, &Blocks, &Job<'_>, bool) -> Result<R, Error> + Send,
) -> Result<R, Error> {
    let lattice = Lattice::new(model.frame())?;
    let tree = control.share([0.0, 0.5], |control| octree_from_dexels(model, control))?;
    control.share([0.5, 1.0], |control| {
        let samples = Samples::new(tree.view(), false, u32::MAX)?;
        let job = Job::new(control);
        job.check()?;
        control.run(samples.levels() > 3, |parallel| {
            let blocks = Blocks::find(&samples, &Least::CUBES, &job, parallel)?;
            extract(&lattice, &blocks, &job, parallel)
        })
    })
}

/// The rays of a model, evaluated for all cut edges.
struct Rays<'a> {
    model: &'a TriDexelRef<'a>,
    blocks: &'a Blocks,
    counts: Counts,
}

#[derive(Default)]
struct Counts {
    several: AtomicUsize,
    without_rays: AtomicUsize,
    disagreeing: AtomicUsize,
    without_normals: AtomicUsize,
}

impl Counts {
    fn report(&self, model: &TriDexelRef<'_>, blocks: &Blocks) -> DexelSurfaceReport {
        let count = |counter: &AtomicUsize| counter.load(Relaxed) as u64;
        DexelSurfaceReport {
            crossings: blocks.vertices as u64,
            several: count(&self.several),
            without_rays: count(&self.without_rays),
            disagreeing: count(&self.disagreeing),
            without_normals: count(&self.without_normals),
            means: 0,
            clamped: 0,
            vanished: 0,
            without_centres: model.without_centres(),
        }
    }
}

impl Rays<'_> {
    /// Passes each cut edge and its crossing to `put`, with its place in a list of all edges.
    fn for_each<T: Send>(
        &self,
        output: &mut [T],
        weight: usize,
        job: &Job<'_>,
        parallel: bool,
        put: impl Fn(&Edge, Hermite, &mut T) + Sync,
    ) -> Result<(), Error> {
        let list = &self.blocks.list;
        let start = |i: usize| list[i].vertex as usize;
        chunks::for_each(list.len(), output, start, weight, job, parallel, |range, piece| {
            let mut places = piece.iter_mut();
            let [mut several, mut without_rays, mut disagreeing, mut without_normals] = [0; 4];
            for block in &list[range] {
                for (edge, place) in edges(block, self.blocks.bias).zip(&mut places) {
                    let mut hermite = Hermite { t: 0.5, normal: [0.0; 3] };
                    match said(self.model, &edge) {
                        Said::NoRays => without_rays += 1,
                        Said::Nothing => disagreeing += 1,
                        Said::At { place, normal, several: more } => {
                            several += usize::from(more);
                            let t = place - (f64::from(edge.lower[edge.axis]) + 0.5);
                            let normal = normal.map_or([0.0; 3], |normal| normal.each(|c| c as f32));
                            hermite = Hermite { t: t.clamp(0.0, 1.0), normal };
                        }
                    }
                    without_normals += usize::from(hermite.normal == [0.0; 3]);
                    put(&edge, hermite, place);
                }
            }
            self.counts.several.fetch_add(several, Relaxed);
            self.counts.without_rays.fetch_add(without_rays, Relaxed);
            self.counts.disagreeing.fetch_add(disagreeing, Relaxed);
            self.counts.without_normals.fetch_add(without_normals, Relaxed);
            Ok(())
        })
    }
}
