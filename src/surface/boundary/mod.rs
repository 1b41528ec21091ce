//! Boundary evaluation: the surfaces that a solid is made of, cut to the pieces that bound it.
//!
//! (Requicha and Voelcker, *Boolean operations in solid modeling: boundary evaluation and merging
//! algorithms*, 1985; Brunet and Navazo, *Solid representation and operation using extended octrees*, 1990.)
//!
//! Cells are split until the surfaces in each have a simple arrangement. Then surfaces cross the edges of
//! cells where they have different signs at the ends, faces have arcs between such crossings, and cells have
//! polygons between such arcs. Signs at corners of the lattice decide all of this. Neighbours share the
//! signs, so the result is closed. Places are computed last.
//!
//! From the bottom up, each file uses only files named before it: `figures` (surfaces as functions), `scaled`
//! (comparing two functions), `redundant` (surfaces that need not be known), `joint` (touching surfaces),
//! `leaves` (the cells), `walk` (their minimal faces and edges), `edges`, `curve` (curves as chords),
//! `faces`, `cells`, `patches` (triangles), `held` (places whose triangles stay), `mates`, `proof`, `regions`
//! (triangles on one surface as faces).

mod cells;
mod curve;
mod edges;
mod faces;
mod figures;
mod held;
mod joint;
mod leaves;
mod mates;
mod patches;
mod proof;
mod redundant;
mod regions;
mod scaled;
mod strips;
#[cfg(test)]
mod tests;
mod walk;

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, Cell, Frame, axes, valid};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::Tag;
use crate::solid::{
    AskWhole, BoundaryFacets, Classifier, DynSolid, PlacedHalfSpace, Solid, Transform, Worker,
};
use crate::surface::simplify::{Reduction, Regions, simplify};
use crate::walk::Trail;
use alloc::vec::Vec;
use cells::Pieces;
use edges::{Corners, Edges, NONE};
use faces::Faces;
use figures::{Figures, UNKNOWN};
use held::Held;
use leaves::{Leaves, Refused, Wanted};
use patches::Patches;
use proof::{Known, prove};
pub use regions::{BoundaryFaces, BoundaryRegion};

/// The boundary of a solid: a mesh that stores the surface of each triangle.
pub struct Boundary {
    mesh: TriangleMesh,
    surfaces: Vec<PlacedHalfSpace>,
    of_triangles: Vec<u32>,
    report: BoundaryReport,
}

/// A report on a boundary evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryReport {
    /// The number of pairs of intersecting triangles, counted as by [`TriangleMesh::intersecting_pairs`].
    pub intersecting_pairs: u64,
    /// The number of cells that the boundary passes through.
    pub cells: u64,
    /// The number of cells that were split.
    pub splits: u64,
    /// A proven bound of the distance of the mesh from the solid's boundary, and of the boundary from the
    /// mesh (model units). Infinite if nothing is known.
    pub deviation: f64,
}

impl Boundary {
    /// The mesh.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Returns the mesh.
    pub fn into_mesh(self) -> TriangleMesh {
        self.mesh
    }

    /// The report on the evaluation.
    pub fn report(&self) -> &BoundaryReport {
        &self.report
    }

    /// The surfaces of which the solid is made.
    pub fn surfaces(&self) -> &[PlacedHalfSpace] {
        &self.surfaces
    }

    /// Returns the number of the surface on which a triangle lies (up to its chords); `None` where the
    /// boundary is only known to a cell.
    pub fn surface_of(&self, triangle: usize) -> Option<u32> {
        self.of_triangles.get(triangle).copied().filter(|&surface| surface != NONE)
    }

    /// Returns the faces: plane ones as polygons, curved ones as triangles, each with its surface.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, mesh::Polyhedron, surface::boundary};
    /// let bore = Csg::cylinder_between([4.0, 3.0, -1.0], [4.0, 3.0, 2.0], 1.0)?;
    /// let plate = Csg::cuboid([0.0; 3], [8.0, 6.0, 1.0])?.difference(&bore)?;
    /// let frame = Frame::around([0.0; 3], [8.0, 6.0, 1.0], 14)?;
    /// let found = boundary(&plate, &frame, 0.01, &Control::default())?;
    /// let faces = found.faces()?;
    /// let arrays = faces.arrays();
    /// // Six plane faces, of which two have a hole, and the wall of the bore.
    /// assert_eq!(faces.regions().len(), 7);
    /// let plane = faces.regions().iter().filter(|region| region.faces.len() == 1);
    /// let loops = plane.map(|region| {
    ///     let face = region.faces.start as usize;
    ///     arrays.faces[face + 1] - arrays.faces[face]
    /// });
    /// assert_eq!(loops.sum::<u32>(), 6 + 2);
    /// assert!((Polyhedron::new(&arrays)?.mesh().volume() - found.mesh().volume()).abs() < 1e-12);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// O(n log n) expected.
    ///
    /// # Errors
    /// [`MeshError::TooMany`](crate::error::MeshError::TooMany) beyond 2^32 - 1 corners;
    /// [`Error::OutOfMemory`]; [`Error::Limit`] as [`PlacedHalfSpace::shape`].
    pub fn faces(&self) -> Result<BoundaryFaces, Error> {
        BoundaryFaces::find(&self.mesh, &self.surfaces, &self.of_triangles)
    }
}

/// How often the cells are rebuilt if some are not as simple as they looked.
const ROUNDS: usize = 24;

/// How often an insufficient proof is repeated with smaller cells.
const PROOFS: usize = 6;

/// The greatest number of intersecting pairs that one round examines.
const PAIRS: usize = 4096;

/// The greatest rise of a surface between the sides of a cell, and the greatest distance of chords from
/// edges, as parts of the tolerance.
const CELLS: f64 = 0.8;
const CHORDS: f64 = 0.5;

/// The greatest movement of the surface by removing vertices, as a part of the tolerance.
const FEWER: f64 = 0.35;

/// The shift of the lattice, as parts of the edge. With it, no face of a part with round dimensions lies in
/// the lattice.
const SHIFTS: [f64; 3] = [0.013_371, 0.017_317, 0.011_831];
const LARGER: f64 = 1.031_77;

/// Evaluates the boundary of a solid that provides its surfaces: expressions of half-spaces, and octrees that
/// keep surfaces ([`build_extended`](crate::build_extended)). Plane faces are exact, and curved faces are
/// approximated by chords. The solid must end inside the universe of `frame`. For a closed mesh without
/// intersecting triangles, the boundary is the mesh, [simplified](super::simplify()), without triangles
/// inside other bodies.
///
/// Vertices that are not needed within the tolerance are removed, along edges and within the pieces of one
/// surface, so that walls of cylinders and cones have triangles from end to end.
///
/// A plane face becomes triangles between its corners only, whatever its shape. A corner is the point in
/// which its surfaces meet, to rounding (some 10^-15 of the coordinates). Where two plane faces meet, they
/// have a straight edge without further vertices. Vertices on curved edges lie on both surfaces; all other
/// vertices lie on their surface. The middle of each side of a triangle, and the middle of the triangle, are
/// within about `tolerance` (model units) of the surface. So the number of triangles does not depend on
/// cells: a box has 12 triangles, a bore about π √(2 r / `tolerance`) in a strip around it.
///
/// The mesh is closed, and exactly two triangles meet in each edge. Where the solid touches itself in a line
/// or a point, several vertices lie at one place. [`BoundaryReport::intersecting_pairs`] counts intersecting
/// triangles. Cells are split until there are none, or until the finest cells are reached.
///
/// If no triangle remains of a solid that is thinner than a finest cell, [`BoundaryReport::deviation`] is
/// infinite, because the solid may be anywhere in the cells. It is finite if the solid is proven to be empty.
///
/// [`BoundaryReport::deviation`] is proven from the surfaces, independently of how the mesh was made. From
/// the mesh to the boundary: one short step moves the whole triangle inside, and another one outside, so the
/// boundary lies between. From the boundary to the mesh: the triangles of a surface, seen along its normal,
/// cover the part of the surface that bounds the solid. At the sides where the triangles end, the functions
/// of the other surfaces bound how far the part can go on. If the proven distance exceeds the tolerance,
/// cells are split a few more times. Any larger deviation that remains (at edges in which the solid touches
/// itself, and in finest cells) is reported as it is.
///
/// Cells are split until each has at most three surfaces that are nearly flat and cross at angles, or two
/// surfaces that touch along a curve on a plane and continue each other there. Where more surfaces meet in a
/// point, and where surfaces touch otherwise, cells are split down to the depth of the frame, and the
/// boundary is only known to a finest cell there. A depth of 12 to 16 is good for parts, and costs little,
/// because only such places are cut that far. A part thinner than such a cell may vanish there. The lattice
/// is shifted a little against that of the frame, so that faces may lie in planes of the frame's lattice.
///
/// The time is about 50 µs per cell, most of it for the proof, which several threads share. The result
/// depends only on the solid, the frame and the tolerance. The memory is that of the cells and of the
/// triangles, about 500 bytes per cell; `control.max_nodes` bounds the splits.
///
/// ```
/// use leafless::{Control, Csg, Frame, surface::boundary};
/// let bore = Csg::cylinder_between([4.0, 3.0, -1.0], [4.0, 3.0, 2.0], 1.0)?;
/// let plate = Csg::cuboid([0.0; 3], [8.0, 6.0, 1.0])?.difference(&bore)?;
/// let frame = Frame::around([0.0; 3], [8.0, 6.0, 1.0], 14)?;
/// let found = boundary(&plate, &frame, 0.01, &Control::default())?;
/// assert!(found.mesh().triangles().len() < 400 && found.report().intersecting_pairs == 0);
/// assert!((found.mesh().volume() - (48.0 - std::f64::consts::PI)).abs() < 0.05);
/// # Ok::<(), leafless::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] if the solid is not known to end inside the universe, if something other than surfaces
/// bounds it in more than 65,536 finest cells (as in an expression of meshes and half-spaces, or with a host
/// program's function; a [`contour`](crate::surface::contour()) takes any solid), or if `tolerance` is not
/// between 2^-256 and 2^256; the errors of the solid; [`Error::Limit`], [`Error::OutOfMemory`], and
/// [`Error::Cancelled`].
pub fn boundary(
    solid: &dyn DynSolid,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Boundary, Error> {
    valid::length("tolerance", tolerance)?;
    let edge = frame.edge() * LARGER;
    let origin = axes(|k| frame.origin()[k] - frame.edge() * SHIFTS[k]);
    let lattice = Frame::new(origin, edge, frame.depth())?;
    let job = Job::new(control);
    job.check()?;
    let found = match solid.home() {
        None => evaluate(&solid.on(&lattice, control)?, tolerance, &job)?,
        Some(home) => {
            // A stored octree can only be evaluated on its own lattice.
            let moved = Transform::new(solid, &home, &Affine::IDENTITY);
            evaluate(&moved.on(&lattice, control)?, tolerance, &job)?
        }
    };
    job.finish();
    Ok(found)
}

fn evaluate<C: Classifier>(classifier: &C, tolerance: f64, job: &Job<'_>) -> Result<Boundary, Error> {
    let control = job.control();
    if classifier.exterior() != Tag::Empty {
        return Err(Error::Argument { name: "frame", problem: "must hold all of the solid" });
    }
    let frame = *classifier.frame();
    let Some(surfaces) = classifier.surfaces(control)?.filter(|list| !list.is_empty()) else {
        return of_facets(classifier.facets(control)?.ok_or(UNKNOWN)?, tolerance, control);
    };
    let figures = Figures::new(&surfaces, &frame)?;
    let whole = tolerance / frame.edge();
    let (bent, tolerance) = (CELLS * whole, CHORDS * whole);
    let (mut refused, mut held) = (Refused::default(), Held::default());
    let (mut round, mut proofs, mut known) = (0, 0, Known::default());
    loop {
        // (The number of rounds is not known in advance, so progress treats the first one as all.)
        let parts = if round == 0 { WHOLE / 8 } else { 0 };
        let wanted = Wanted { figures: &figures, tolerance: bent, refused: &refused, parts: 2 * parts };
        let leaves = Leaves::grow(classifier, &wanted, job)?;
        let corners = Points { trail: Trail::new(classifier.worker()?)?, frame, control };
        let mut edges = Edges::find(&leaves, &figures, corners)?;
        job.advance(parts);
        let faces = Faces::find(&leaves, &mut edges, tolerance, &mut refused)?;
        job.advance(parts);
        let pieces = Pieces::find(&leaves, &faces, &mut edges, tolerance, &mut refused)?;
        job.advance(parts);
        let limits = (whole, frame.depth());
        let mut patches = Patches::of_curves(&pieces, &figures, &edges.vertices, limits, &mut refused)?;
        round += 1;
        job.check()?;
        if refused.settle() && round < ROUNDS {
            continue;
        }
        patches.add_planes(&pieces, &figures, &edges.vertices)?;
        let mesh = assemble(&patches, &edges.vertices, &frame)?;
        let found = mesh.intersecting_pairs(PAIRS, &quiet(control))?;
        if found.count > 0 {
            let mut meets = memory::filled(edges.vertices.len(), false)?;
            for triangle in found.pairs.iter().flat_map(|pair| pair.triangles) {
                patches.triangles[triangle as usize].iter().for_each(|&corner| meets[corner as usize] = true);
            }
            pieces.refuse(|corner| meets[corner as usize], frame.depth(), &mut refused)?;
        }
        let is_last = !refused.settle() || round >= ROUNDS;
        if !is_last {
            continue;
        }
        let lattice = (&frame, whole);
        let slack = FEWER * whole * frame.edge();
        let numbers = Regions::Numbered(&patches.surfaces);
        let unit = |point: &[f64; 3]| -> [f64; 3] { axes(|k| (point[k] - frame.origin()[k]) / frame.edge()) };
        let mut reduction = Reduction::new(&mesh, numbers, slack)?;
        reduction.keep(&held.chosen(mesh.vertices().iter().map(unit))?);
        if proofs + 2 >= PROOFS {
            // In the last round all vertices stay.
            reduction.keep(&memory::filled(mesh.vertices().len(), true)?);
        }
        let (mesh, kept, pairs) = reduction.run(job, 0)?;
        let of_kept = kept.iter().map(|&triangle| patches.surfaces[triangle as usize]);
        let of_triangles = memory::collected(of_kept)?;
        let proof = prove(&leaves, &figures, (&mesh, &of_triangles), lattice, &mut known, job)?;
        held.add(&proof.beyond)?;
        proofs += 1;
        let beyond = proof.beyond.iter().filter(|cell| cell.level < frame.depth());
        beyond.clone().try_for_each(|&cell| refused.add(cell))?;
        if proofs >= PROOFS || !refused.settle() || round >= ROUNDS {
            let (cells, splits) = (leaves.open.len() as u64, leaves.splits);
            let deviation = rounded_up(proof.most + leaves.slack, &frame);
            let report = BoundaryReport { intersecting_pairs: pairs, cells, splits, deviation };
            return Ok(Boundary { mesh, surfaces, of_triangles, report });
        }
    }
}

/// The boundary of a solid that triangles bound, with fewer triangles.
fn of_facets(facets: BoundaryFacets, tolerance: f64, control: &Control<'_>) -> Result<Boundary, Error> {
    let BoundaryFacets { mesh, chosen } = facets;
    let mut triangles = memory::copied(mesh.triangles())?;
    if !chosen.is_empty() {
        let mut chosen = chosen.iter();
        triangles.retain(|_| chosen.next().is_some_and(|&own| own));
    }
    let outer = TriangleMesh::from_welded(memory::copied(mesh.vertices())?, triangles, 0, 0);
    let found = simplify(&outer, tolerance, control)?;
    let report = BoundaryReport {
        intersecting_pairs: found.report().intersecting_pairs,
        cells: 0,
        splits: 0,
        deviation: (found.report().deviation + mesh.radius()).next_up(),
    };
    let mesh = found.into_mesh();
    let of_triangles = memory::filled(mesh.triangles().len(), NONE)?;
    Ok(Boundary { mesh, surfaces: Vec::new(), of_triangles, report })
}

/// A length in model units, plus the rounding errors of vertices.
fn rounded_up(most: f64, frame: &Frame) -> f64 {
    let far = frame.origin().iter().fold(frame.edge(), |most, c| most.max(c.abs()));
    most * frame.edge() * (1.0 + 1e-12) + 8.0 * f64::EPSILON * far
}

/// The same control without progress reports.
fn quiet<'c>(control: &Control<'c>) -> Control<'c> {
    Control { progress: None, ..*control }
}

/// The mesh, without vertices that no triangle uses.
fn assemble(patches: &Patches, vertices: &[[f64; 3]], frame: &Frame) -> Result<TriangleMesh, Error> {
    let mut places = memory::filled(vertices.len(), NONE)?;
    let mut kept = Vec::new();
    let mut triangles = memory::with_capacity(patches.triangles.len())?;
    for triangle in &patches.triangles {
        let mut corners = [0; 3];
        for (corner, &vertex) in corners.iter_mut().zip(triangle) {
            let place = &mut places[vertex as usize];
            if *place == NONE {
                *place = kept.len() as u32;
                let unit = vertices[vertex as usize];
                memory::push(&mut kept, axes(|k| frame.origin()[k] + unit[k] * frame.edge()))?;
            }
            *corner = *place;
        }
        triangles.push(corners);
    }
    Ok(TriangleMesh::from_welded(kept, triangles, 0, 0))
}

/// Corners that no surface decides.
struct Points<'c, W: Worker> {
    trail: Trail<W>,
    frame: Frame,
    control: &'c Control<'c>,
}

impl<W: Worker> Corners for Points<'_, W> {
    fn is_inside(&mut self, at: [u32; 3], unit: [f64; 3]) -> Result<bool, Error> {
        let point = axes(|k| self.frame.origin()[k] + unit[k] * self.frame.edge());
        let mut answer = [None];
        self.trail.worker().0.inside(&[point], &mut answer)?;
        if let [Some(inside)] = answer {
            return Ok(inside);
        }
        let most = self.frame.cells() - 1;
        let cell = Cell { level: self.frame.depth(), at: at.each(|c| c.min(most)) };
        self.trail.follow(cell.parent(), self.control)?;
        Ok(match self.trail.verdict(cell).tag() {
            Tag::Empty => false,
            Tag::Full => true,
            Tag::Partial | Tag::Branch => self.trail.sample(cell)?.unwrap_or(false),
        })
    }
}
