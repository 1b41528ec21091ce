//! Contours: closed meshes of any solid, with cells of several sizes.
//!
//! (Ju, Losasso, Schaefer and Warren, *Dual contouring of Hermite data*, 2002; Schaefer, Ju and Warren,
//! *Manifold dual contouring*, 2007; Ju and Udeshi, *Intersection-free contouring on an octree grid*, 2006.)
//!
//! Cells are split until the surface in each is one piece that a single vertex can represent. The signs at
//! the corners of cells, which neighbours share, decide which pieces there are, and how they are connected.
//! So the mesh is closed and a manifold for any signs. Places are computed last.
//!
//! From the bottom up, each file uses only files named before it: `cells`, `walk` (their minimal faces and
//! edges), `sheets` (pieces of the surface), `triangles`, `probe` (queries of the solid), `fit` (vertices),
//! `grow` (splitting of cells).

mod cells;
mod fit;
mod grow;
mod probe;
mod sheets;
#[cfg(test)]
mod tests;
mod triangles;
mod walk;

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, Frame, MAX_DEPTH, axes, valid};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::Tag;
use crate::parallel::each_with;
use crate::query::{Reference, Remade};
use crate::solid::{Classifier, DynSolid, Solid, Transform, Worker};
use crate::surface::simplify::{Reduction, Regions};
use crate::walk::Proven;
use alloc::sync::Arc;
use alloc::vec::Vec;
use cells::{Cells, Kind};
use fit::{Space, best};
use grow::Grower;
use hashbrown::HashSet;
use probe::Probe;
use sheets::{NONE, Sheets};
use triangles::{Place, Triangles, dot};

/// A contour of a solid: its mesh and a report.
pub struct Contour {
    mesh: TriangleMesh,
    report: ContourReport,
}

/// A report on a contour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContourReport {
    /// The number of pairs of intersecting triangles, counted as by [`TriangleMesh::intersecting_pairs`].
    pub intersecting_pairs: u64,
    /// The number of cells that the surface passes through.
    pub cells: u64,
    /// The number of cells that were split.
    pub splits: u64,
    /// The number of points whose side the solid did not report; they counted as outside.
    pub undecided: u64,
    /// A proven bound of the distance of the mesh from the solid's boundary, and of the boundary from the
    /// mesh (model units). If mesh and boundary have more than 32 768 triangles together, the bound is only
    /// as tight as the comparison with the tolerance needs. Infinite if nothing is known.
    pub deviation: f64,
}

impl Contour {
    /// The mesh.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Returns the mesh.
    pub fn into_mesh(self) -> TriangleMesh {
        self.mesh
    }

    /// The report on the contour.
    pub fn report(&self) -> &ContourReport {
        &self.report
    }
}

/// How often the mesh is rebuilt because cells were split.
const ROUNDS: usize = 48;

/// The greatest number of intersecting pairs that one round examines.
const PAIRS: usize = 1 << 16;

/// How often cells are split because the mesh is proven to be too far from the boundary next to them.
const PROOFS: usize = 16;

/// The greatest distance of cells from the surface, and the greatest movement of the surface by removing
/// vertices, as parts of the tolerance. (Both rarely occur at one place; where they do, vertices stay.)
const CELLS: f64 = 0.7;
const FEWER: f64 = 0.5;

/// How often a triangle is cut to test whether it is near the boundary, and to prove a bound of its distance.
const LOOKS: u64 = 16;
const PROVES: u64 = 1 << 10;

/// Intersecting pairs are searched for if at most one in this number of cells was refused.
const ROUGH: u64 = 64;

/// Vertices are put back and the mesh is compared again as long as the number of triangles that are too far
/// falls by a sixteenth, or falls at all while it is at most this number.
const FEW: usize = 1 << 8;

/// The accuracy of the reference boundary, as a part of the tolerance of cells.
const KNOWN: f64 = 0.25;

/// The number of levels below a cell at which its surface is compared with the mesh.
const AHEAD: u8 = 2;

/// The number of cells or triangles that one task compares with the surface, and the number from which
/// several threads pay.
const CHUNK: usize = 64;
const MANY: usize = 1 << 10;

/// The shift of the lattice, as parts of the edge. With it, no face of a part with round dimensions lies in
/// the lattice.
const SHIFTS: [f64; 3] = [0.013_371, 0.017_317, 0.011_831];
const LARGER: f64 = 1.031_77;

/// Builds a closed mesh of any solid, with few triangles where the solid is flat and small ones elsewhere: of
/// meshes, expressions that contain meshes, volumes, tri-dexel models, and a host program's functions. The
/// solid must end inside the universe of `frame`. (For solids that provide their surfaces, use
/// [`boundary`](crate::surface::boundary), whose faces and corners are exact.)
///
/// Cells are split until the surface in each is one piece that a single vertex can represent. The vertex lies
/// where the planes of the surface meet, so sharp edges and corners of flat faces are exact to rounding in
/// such cells. Cells that are proven empty or full are never split. Slabs of the solid in a cell and in the
/// cells below it show whether a vertex suffices; without slabs, lines through the cell do. If the solid
/// provides nearest points, as meshes do, the mesh is compared with the solid at many points. Cells are
/// split, down to the depth of the frame, where the two are further from each other than seven tenths of
/// `tolerance` (model units). At the end, vertices are removed as by [`simplify`](super::simplify()), where
/// the mesh stays within `tolerance`. So a plane face has few triangles, however many cells it has.
///
/// [`ContourReport::deviation`] is proven in the same way as by [`deviation`](crate::deviation): for closed
/// meshes from their triangles, and for all other solids from slabs of cells, of which up to sixteen are
/// split for each cell of the contour. Cells are also split where a point of the mesh or of the boundary is
/// proven to be further from the other than seven tenths of `tolerance`. Any larger deviation that remains is
/// reported as it is: where cells of the frame's depth are too coarse, and where slabs are too coarse. The
/// boundary of a solid without slabs is known to about the size of these cells. For an octree that proves
/// nothing about its solid, nothing is known.
///
/// For any solid, the mesh is closed, exactly two triangles meet in each edge, and the triangles around each
/// vertex form one fan. Signs at corners of cells decide about the mesh, so a solid thinner than a finest
/// cell may vanish. Triangles may intersect each other where sheets of the surface come close. Cells are
/// split until no triangles intersect, or until the finest cells are reached, and
/// [`ContourReport::intersecting_pairs`] counts the remaining pairs. Points whose side the solid does not
/// report, such as points in PARTIAL cells of a stored octree, count as outside. The lattice is shifted a
/// little against that of the frame, so that faces may lie in planes of the frame's lattice.
///
/// The time is about 100 µs per cell for a mesh, and more for solids that answer no rays. Threads share the
/// comparison with the solid and the proof. The result depends only on the solid, the frame and the
/// tolerance. The memory is that of the cells and of the triangles. `control.max_nodes` bounds the splits.
/// When `control.max_splits` is spent, cells stay as they are, and the mesh is coarser.
///
/// (Ju, Losasso, Schaefer and Warren, *Dual contouring of Hermite data*, 2002; Schaefer, Ju and Warren,
/// *Manifold dual contouring*, 2007.)
///
/// ```
/// use leafless::{Control, FillRule, Frame, MeshSolid, TriangleMesh, surface::contour};
/// let vertices = vec![[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0]];
/// let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let solid = MeshSolid::new(mesh, FillRule::NonZero)?;
/// let frame = Frame::around([0.0; 3], [9.0; 3], 8)?;
/// let found = contour(&solid, &frame, 0.05, &Control::default())?;
/// assert!((found.mesh().volume() - 121.5).abs() < 1.0 && found.report().intersecting_pairs == 0);
/// # Ok::<(), leafless::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] if the solid is not known to end inside the universe, or `tolerance` is not between
/// 2^-256 and 2^256; the errors of the solid; [`Error::Limit`], [`Error::OutOfMemory`], and
/// [`Error::Cancelled`].
pub fn contour(
    solid: &dyn DynSolid,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Contour, Error> {
    valid::length("tolerance", tolerance)?;
    let edge = frame.edge() * LARGER;
    let origin = axes(|k| frame.origin()[k] - frame.edge() * SHIFTS[k]);
    let lattice = Frame::new(origin, edge, MAX_DEPTH)?;
    let job = Job::new(control);
    job.check()?;
    let quiet = Control { progress: None, ..*control };
    let mut wanted = Wanted { depth: frame.depth(), tolerance: tolerance / edge, quiet: &quiet };
    let found = match solid.home() {
        None => wanted.find(solid.on(&lattice, &quiet)?, &job)?,
        Some(home) => {
            // A stored octree can only be evaluated on its own lattice, and knows nothing smaller than half
            // its cells.
            let is_finer = |depth: &u8| edge / f64::from(1u32 << depth) < 0.5 * home.cell_size();
            wanted.depth -= (2..=frame.depth()).filter(is_finer).count() as u8;
            let moved = Transform::new(solid, &home, &Affine::IDENTITY);
            wanted.find(moved.on(&lattice, &quiet)?, &job)?
        }
    };
    job.finish();
    Ok(found)
}

/// The parameters of a contour.
struct Wanted<'w> {
    depth: u8,
    /// The tolerance in unit coordinates.
    tolerance: f64,
    quiet: &'w Control<'w>,
}

impl Wanted<'_> {
    fn find<C: Classifier>(&self, classifier: C, job: &Job<'_>) -> Result<Contour, Error> {
        if classifier.exterior() != Tag::Empty {
            return Err(Error::Argument { name: "frame", problem: "must hold all of the solid" });
        }
        let frame = *classifier.frame();
        let mut probe = Probe::new(&classifier, self.depth, self.quiet)?;
        let certain = Proven(classifier.clone());
        let edge = frame.edge();
        let cells = CELLS * self.tolerance;
        let mut proof = Proof {
            classifier: &certain,
            reference: None,
            tolerance: KNOWN * cells * edge,
            job: Job::new(self.quiet),
        };
        let (mut near, mut proven) = (HashSet::new(), HashSet::new());
        let mut grower = Grower::new(&mut probe, self.depth, cells, job)?;
        grower.grow(0, WHOLE / 2)?;
        let (mut round, mut proofs) = (0, 0);
        let mesh = loop {
            round += 1;
            job.check()?;
            let sheets = Sheets::find(&grower.cells, grower.probe)?;
            let places = places(&sheets, grower.probe)?;
            let vertices = vertices(&grower.cells, &sheets, &places)?;
            let made = Triangles::of(&sheets, vertices, &places, |_| false)?;
            let mesh = Arc::new(assemble(&made, &frame)?);
            if round >= ROUNDS {
                break mesh;
            }
            let compared = Compared { made: &made, sheets: &sheets, mesh: &mesh };
            let refused = compared.refused(&classifier, &mut grower.cells, &mut near, self)?;
            let is_rough = refused.len() as u64 > grower.cells.open() / ROUGH;
            let mut is_split = grower.split_all(refused.len(), refused)?;
            if !(is_rough && is_split) {
                let pairs = mesh.intersecting_pairs(PAIRS, self.quiet)?;
                let meeting = pairs.pairs.iter().flat_map(|pair| pair.triangles);
                let leaves = meeting.flat_map(|triangle| compared.around(triangle));
                is_split |= grower.split_all(pairs.pairs.len(), leaves)?;
            }
            if is_split {
                continue;
            }
            if proofs >= PROOFS {
                break mesh;
            }
            proofs += 1;
            let is_new = fresh(&mesh, &mut proven)?;
            let remade = Remade { mesh: &mesh, is_new: if proofs > 1 { &is_new } else { &[] }, cuts: LOOKS };
            let found = proof.reference(grower.budget())?.beyond(&remade, cells * edge, self.quiet)?;
            let leaves = found.beyond.iter().flat_map(|&triangle| compared.around(triangle));
            if !grower.split_all(found.beyond.len(), leaves)? {
                break mesh;
            }
        };
        let (mesh, intersecting_pairs, deviation) =
            self.reduced(&mesh, edge, proof.reference(grower.budget())?)?;
        let report = ContourReport {
            intersecting_pairs,
            cells: grower.cells.open(),
            splits: grower.splits,
            undecided: grower.probe.undecided,
            deviation,
        };
        Ok(Contour { mesh, report })
    }

    /// Returns a mesh with fewer triangles, the number of pairs of these that intersect, and a bound of its
    /// distance from the boundary of the solid. `edge` is the edge of the universe.
    fn reduced(
        &self,
        mesh: &TriangleMesh,
        edge: f64,
        reference: &Reference,
    ) -> Result<(TriangleMesh, u64, f64), Error> {
        let (tolerance, job) = (self.tolerance * edge, Job::new(self.quiet));
        let mut reduction = Reduction::new(mesh, Regions::Alike(&[]), FEWER * tolerance)?;
        let mut last = usize::MAX;
        loop {
            let (simple, kept, pairs) = reduction.run(&job, 0)?;
            let simple = Arc::new(simple);
            let remade = Remade { mesh: &simple, is_new: &[], cuts: PROVES };
            let found = reference.beyond(&remade, tolerance, self.quiet)?;
            let beyond = found.beyond.iter().map(|&triangle| kept[triangle as usize]);
            // (Triangles that are too far in any case will be so again.)
            let count = found.beyond.len();
            let hardly_falls = count >= last || (count > FEW && count > last - last / 16);
            if hardly_falls || !reduction.hold(beyond)? {
                let deviation = reference.apart(&simple, tolerance, self.quiet)?.min(found.most);
                return Ok((Arc::unwrap_or_clone(simple), pairs, deviation));
            }
            last = count;
        }
    }
}

/// Returns for each triangle of a mesh whether it is not yet in the known set, and adds all triangles to the
/// set.
fn fresh(mesh: &TriangleMesh, known: &mut HashSet<[[u64; 3]; 3]>) -> Result<Vec<bool>, Error> {
    known.try_reserve(mesh.triangles().len())?;
    let vertices = mesh.vertices();
    let corners =
        mesh.triangles().iter().map(|own| own.each(|vertex| vertices[vertex as usize].each(f64::to_bits)));
    memory::collected(corners.map(|corners| known.insert(corners)))
}

/// Bounds of the distance between meshes and a solid.
struct Proof<'p, C> {
    classifier: &'p C,
    /// The reference boundary, computed when it is first needed.
    reference: Option<Reference>,
    /// The accuracy of the reference boundary (model units).
    tolerance: f64,
    job: Job<'p>,
}

impl<C: Classifier> Proof<'_, C> {
    /// Returns the reference boundary. If it is not known exactly, at most `budget` cells are split to locate
    /// it.
    fn reference(&mut self, budget: u64) -> Result<&Reference, Error> {
        match &mut self.reference {
            Some(reference) => Ok(reference),
            none => Ok(none.insert(Reference::new(self.classifier, self.tolerance, budget, &self.job)?)),
        }
    }
}

/// The places where edges are crossed.
fn places<W: Worker>(sheets: &Sheets, probe: &mut Probe<'_, W>) -> Result<Vec<Place>, Error> {
    let mut places = memory::with_capacity(sheets.crossings.len())?;
    let mut spare = Vec::new();
    for crossing in &sheets.crossings {
        let (axis, at) = (usize::from(crossing.axis), crossing.at.each(|c| 2 * c));
        let length = 2 * crossing.length;
        places.push(probe.crossing(axis, at, length, crossing.starts_inside, &mut spare)?);
    }
    Ok(places)
}

/// A mesh with the sheets and triangles from which it was made.
struct Compared<'c> {
    made: &'c Triangles,
    sheets: &'c Sheets,
    mesh: &'c TriangleMesh,
}

impl Compared<'_> {
    /// The leaves around the crossing to which a triangle belongs.
    fn around(&self, triangle: u32) -> [u32; 4] {
        self.sheets.crossings[self.made.crossings[triangle as usize] as usize].around
    }

    /// Returns the leaves next to which the mesh is too far from the surface. `known` holds points of meshes
    /// that are near the surface.
    fn refused<C: Classifier>(
        &self,
        classifier: &C,
        cells: &mut Cells,
        known: &mut HashSet<[u64; 3]>,
        wanted: &Wanted<'_>,
    ) -> Result<Vec<u32>, Error> {
        let mut unchecked = Vec::new();
        let tolerance = CELLS * wanted.tolerance;
        for (number, leaf) in (0u32..).zip(&mut cells.leaves) {
            if leaf.kind != Kind::Open || leaf.is_gone || leaf.is_checked {
                continue;
            }
            leaf.is_checked = true;
            let edge = 1.0 / f64::from(1u32 << leaf.cell.level);
            if leaf.cell.level < cells.depth && edge * 1.75 > tolerance {
                memory::push(&mut unchecked, (number, leaf.cell))?;
            }
        }
        let mut doubtful = Vec::new();
        for triangle in 0..self.made.triangles.len() as u32 {
            if self.points(triangle).any(|point| !known.contains(&point.each(f64::to_bits))) {
                memory::push(&mut doubtful, triangle)?;
            }
        }
        let tree = self.mesh.triangle_tree(wanted.quiet)?;
        let (seen, is_worth) = (&*known, unchecked.len() + doubtful.len() > MANY);
        let probe = || Probe::new(classifier, wanted.depth, wanted.quiet);
        let none = || None;
        let (mut refused, near) = wanted.quiet.run(is_worth, |parallel| {
            let far = each_with(parallel, unchecked.chunks(CHUNK), none, |own, leaves| {
                wanted.quiet.check()?;
                let probe = match own {
                    Some(probe) => probe,
                    none => none.insert(probe()?),
                };
                let (mut far, mut samples, mut hint) = (Vec::new(), Vec::new(), None);
                for &(leaf, cell) in leaves {
                    samples.clear();
                    probe.samples(cell, AHEAD, &mut samples)?;
                    let is_near = |&sample: &[f64; 3]| {
                        let point = probe.model(sample);
                        tree.nearest(&point, hint).is_some_and(|near| {
                            hint = Some(near.triangle);
                            tree.most_from(near.triangle, &point) <= tolerance * probe.edge()
                        })
                    };
                    if !samples.iter().all(is_near) {
                        memory::push(&mut far, leaf)?;
                    }
                }
                Ok(far)
            })?;
            let near = each_with(parallel, doubtful.chunks(CHUNK), none, |own, triangles| {
                wanted.quiet.check()?;
                let probe = match own {
                    Some(probe) => probe,
                    none => none.insert(probe()?),
                };
                let mut near = memory::with_capacity(triangles.len())?;
                for &triangle in triangles {
                    let mut is_near = true;
                    let new = self.points(triangle).filter(|point| !seen.contains(&point.each(f64::to_bits)));
                    for point in new {
                        let Some(nearest) = probe.nearest(point)? else { break };
                        let off = axes(|k| nearest[k] - point[k]);
                        is_near &= dot(off, off) <= tolerance * tolerance;
                    }
                    near.push(is_near);
                }
                Ok(near)
            })?;
            Ok::<_, Error>((far, near))
        })?;
        let mut leaves = Vec::new();
        for far in &mut refused {
            leaves.try_reserve(far.len())?;
            leaves.append(far);
        }
        for (&triangle, &is_near) in doubtful.iter().zip(near.iter().flatten()) {
            known.try_reserve(4)?;
            leaves.try_reserve(4)?;
            if is_near {
                known.extend(self.points(triangle).map(|point| point.each(f64::to_bits)));
            } else {
                leaves.extend(self.around(triangle));
            }
        }
        Ok(leaves)
    }

    /// The points of a triangle that are compared with the surface: its middle, and the middles of the sides
    /// that lead to a greater vertex number. (So each side is compared once.)
    fn points(&self, triangle: u32) -> impl Iterator<Item = [f64; 3]> {
        let own = self.made.triangles[triangle as usize];
        let [a, b, c] = own.each(|vertex| self.made.vertices[vertex as usize]);
        let sides = [(a, b), (b, c), (c, a)].into_iter().enumerate();
        let sides = sides.filter(move |&(k, _)| own[k] <= own[(k + 1) % 3]);
        let middles = sides.map(|(_, (p, q))| axes(|k| 0.5 * (p[k] + q[k])));
        middles.chain([axes(|k| (a[k] + b[k] + c[k]) / 3.0)])
    }
}

/// The vertices of all sheets, in unit coordinates.
fn vertices(cells: &Cells, sheets: &Sheets, places: &[Place]) -> Result<Vec<[f64; 3]>, Error> {
    // The crossings around each sheet.
    let mut first = memory::filled(sheets.sheets.len() + 1, 0u32)?;
    let count = sheets.sheets.iter().map(|sheet| sheet.crossings as usize).sum();
    let mut list = memory::filled(count, 0u32)?;
    for (k, sheet) in sheets.sheets.iter().enumerate() {
        first[k + 1] = first[k] + sheet.crossings;
    }
    let mut next = memory::copied(&first)?;
    for (number, around) in (0u32..).zip(&sheets.around) {
        for k in 0..4 {
            if !around[..k].contains(&around[k]) {
                let place = &mut next[around[k] as usize];
                list[*place as usize] = number;
                *place += 1;
            }
        }
    }
    memory::collected(sheets.sheets.iter().enumerate().map(|(k, sheet)| {
        let leaf = &cells.leaves[sheet.leaf as usize];
        if let (Some(vertex), 1) = (leaf.vertex, sheets.counts[sheet.leaf as usize]) {
            return vertex;
        }
        let edge = 1.0 / f64::from(1u32 << leaf.cell.level);
        let space = Space { low: leaf.cell.at.each(|c| f64::from(c) * edge), edge };
        let own = &list[first[k] as usize..first[k + 1] as usize];
        best(own.iter().map(|&crossing| places[crossing as usize]), &space)
    }))
}

/// The mesh, without vertices that no triangle uses.
fn assemble(made: &Triangles, frame: &Frame) -> Result<TriangleMesh, Error> {
    let mut numbers = memory::filled(made.vertices.len(), NONE)?;
    let mut kept = memory::with_capacity(made.vertices.len())?;
    let mut triangles = memory::with_capacity(made.triangles.len())?;
    for triangle in &made.triangles {
        triangles.push(triangle.each(|vertex| {
            let number = &mut numbers[vertex as usize];
            if *number == NONE {
                *number = kept.len() as u32;
                let unit = made.vertices[vertex as usize];
                kept.push(axes(|k| frame.origin()[k] + unit[k] * frame.edge()));
            }
            *number
        }));
    }
    Ok(TriangleMesh::from_welded(kept, triangles, 0, 0))
}
