//! Contours: closed meshes of any solid, with cells of several sizes.
//!
//! (Ju, Losasso, Schaefer and Warren, *Dual contouring of Hermite data*, 2002; Schaefer, Ju and Warren, *Manifold dual contouring*,
//! 2007; Ju and Udeshi, *Intersection-free contouring on an octree grid*, 2006.)
//!
//! Cells are split until the surface in each is one piece that a single vertex can stand for. Which pieces there are, and how they
//! hang together, is decided by signs at corners of cells, which neighbours share: the mesh is closed and a manifold whatever they
//! are. Places are found last.
//!
//! From the bottom up, each file uses only files named before it: `cells`, `walk` (their minimal faces and edges), `sheets` (pieces of
//! the surface), `triangles`, `probe` (what the solid is asked for), `fit` (vertices), `grow` (when cells end).

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
use crate::lattice::{Affine, Frame, MAX_DEPTH, axes, valid};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::Tag;
use crate::query::{Comparison, Reference};
use crate::solid::{Classifier, Solid, Transform, Worker};
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

/// The contour of a solid.
pub struct Contour {
    mesh: TriangleMesh,
    report: ContourReport,
}

/// How a contour was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContourReport {
    /// Pairs of triangles that intersect each other, as [`TriangleMesh::intersecting_pairs`] counts them.
    pub intersecting_pairs: u64,
    /// Cells that the surface passes through.
    pub cells: u64,
    /// Cells that were split.
    pub splits: u64,
    /// Points of which the solid did not tell whether they lie inside; they counted as outside.
    pub undecided: u64,
    /// No point of the mesh is further from the solid's boundary than that, and none of the boundary from the mesh (model units): proven.
    /// Infinite if nothing is known.
    pub deviation: f64,
}

impl Contour {
    /// The triangles.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The triangles.
    pub fn into_mesh(self) -> TriangleMesh {
        self.mesh
    }

    /// How it was found.
    pub fn report(&self) -> &ContourReport {
        &self.report
    }
}

/// How often cells are split where triangles intersect.
const ROUNDS: usize = 24;

/// Intersecting pairs that are looked at in one round.
const PAIRS: usize = 1 << 16;

/// How often cells are split because the mesh is proven to be too far from the boundary next to them.
const PROOFS: usize = 6;

/// Cells that are split to know where the boundary is, for each cell of the contour, and those of any contour.
const SPLITS: u64 = 16;
const ANYWAY: u64 = 4096;

/// How well they tell it, as a part of the tolerance.
const KNOWN: f64 = 0.25;

/// How many levels below a cell its surface is compared with the mesh.
const AHEAD: u8 = 2;

/// How far from each other samples of the surface and the mesh may be, in tolerances.
const NEAR: f64 = 1.0;

/// How far the lattice is moved, as parts of the edge: so that no face of a part with round dimensions lies in it.
const SHIFTS: [f64; 3] = [0.013_371, 0.017_317, 0.011_831];
const LARGER: f64 = 1.031_77;

/// A closed mesh of any solid, with few triangles where it is flat and small ones where it is not: of meshes, expressions with meshes in
/// them, volumes, tri-dexel models, and a host program's functions. The solid must end inside of the universe of `frame`. (Solids that
/// know their surfaces have [`boundary`](crate::surface::boundary), whose faces and corners are exact.)
///
/// Cells are split until the surface in each is one piece that a single vertex can stand for: where the planes of the surface meet, so
/// that sharp edges and corners of flat faces are exact to rounding in such cells. Cells that are proven empty or full are never split.
/// Slabs of the solid in a cell and in the cells below it tell whether a vertex will do, and lines through the cell do where there are
/// none. Where the solid tells nearest points, as meshes do, the mesh is compared with it at many points, and cells are split where the
/// two are further from each other than `tolerance` (model units), as far as the depth of the frame.
///
/// [`ContourReport::deviation`] is proven, as [`deviation`](crate::deviation) proves it: of a closed mesh whose triangles do not intersect
/// exactly, and of anything else by slabs of cells, of which up to sixteen are split for each cell of the contour. Where the mesh is proven
/// to be further from the boundary than `tolerance`, cells are split, too. What is left beyond it is told as it is: where cells of the
/// frame's depth are too coarse, and where slabs are. A solid without any is known to about the size of these cells, and of an octree
/// that proves nothing of its solid nothing is known.
///
/// The mesh is closed, exactly two triangles meet in each edge, and the triangles around each vertex are one fan, whatever the solid is.
/// It is decided by signs at corners of cells, and of a solid thinner than a finest cell nothing may be left. Triangles may intersect each
/// other where sheets of the surface come close; cells are split until none do, or there are no finer ones, and
/// [`ContourReport::intersecting_pairs`] counts what is left. Points of which the solid does not tell on which side they lie, as such in
/// PARTIAL cells of a stored octree, count as outside. The lattice is not that of the frame but lies a little beside it, so that
/// faces may lie in planes of the frame's lattice.
///
/// Some 100 µs a cell of a mesh, and more for solids that answer no rays; threads share only the proof. The result depends on the solid, the
/// frame and the tolerance alone. The memory is that of the cells and of the triangles. `control.max_nodes` bounds the splits; with
/// `control.max_splits` spent cells stay as they are, and the mesh is coarser.
///
/// (Ju, Losasso, Schaefer and Warren, *Dual contouring of Hermite data*, 2002; Schaefer, Ju and Warren, *Manifold dual contouring*,
/// 2007.)
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
/// [`Error::Argument`] if the solid is not known to end inside of the universe, or `tolerance` is not between 2^-256 and 2^256; the
/// solid's own; [`Error::Limit`], [`Error::OutOfMemory`], and [`Error::Cancelled`].
pub fn contour<S: Solid>(
    solid: &S,
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
    let wanted = Wanted { depth: frame.depth(), tolerance: tolerance / edge, quiet: &quiet };
    let found = match solid.home() {
        None => wanted.find(solid.on(&lattice, &quiet)?, &job)?,
        Some(home) => {
            // A stored octree is known on its own lattice alone.
            let moved = Transform::new(solid, &home, &Affine::IDENTITY);
            wanted.find(moved.on(&lattice, &quiet)?, &job)?
        }
    };
    job.finish();
    Ok(found)
}

/// What is wanted.
struct Wanted<'w> {
    depth: u8,
    /// In unit coordinates.
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
        let classifier = Proven(classifier);
        let mut proof = Proof { reference: None, count: 0 };
        let mut near = HashSet::new();
        let mut grower = Grower::new(&mut probe, self.depth, self.tolerance, job)?;
        grower.grow(0, WHOLE / 2)?;
        let mut round = 0;
        loop {
            round += 1;
            job.check()?;
            let sheets = Sheets::find(&grower.cells, grower.probe)?;
            let mut places = memory::with_capacity(sheets.crossings.len())?;
            let mut spare = Vec::new();
            for crossing in &sheets.crossings {
                let (axis, at) = (usize::from(crossing.axis), crossing.at.map(|c| 2 * c));
                places.push(grower.probe.crossing(
                    axis,
                    at,
                    2 * crossing.length,
                    crossing.starts_inside,
                    &mut spare,
                )?);
            }
            let vertices = vertices(&grower.cells, &sheets, &places)?;
            let made = Triangles::of(&sheets, vertices, &places, |_| false)?;
            let mesh = Arc::new(assemble(&made, &frame)?);
            if round < ROUNDS {
                let refused = Compared { made: &made, sheets: &sheets, mesh: &mesh }.refused(
                    &mut grower,
                    &mut near,
                    self.tolerance,
                    self.quiet,
                )?;
                let mut is_changed = false;
                for leaf in refused {
                    if !grower.cells.leaves[leaf as usize].is_gone {
                        is_changed |= grower.split(leaf, 0)?;
                    }
                }
                if is_changed {
                    continue;
                }
            }
            let pairs = mesh.intersecting_pairs(PAIRS, self.quiet)?;
            let mut is_changed = false;
            if pairs.count > 0 && round < ROUNDS {
                for triangle in pairs.pairs.iter().flat_map(|pair| pair.triangles) {
                    let crossing = made.crossings[triangle as usize];
                    for leaf in sheets.crossings[crossing as usize].around {
                        if !grower.cells.leaves[leaf as usize].is_gone {
                            is_changed |= grower.split(leaf, 0)?;
                        }
                    }
                }
            }
            if is_changed {
                continue;
            }
            let cells = grower.cells.open();
            let most = job.control().max_splits.map_or(u64::MAX, |most| most - grower.splits);
            let compared = proof.compare(&classifier, &mesh, self, (SPLITS * cells + ANYWAY).min(most))?;
            if !compared.beyond.is_empty() && round < ROUNDS && proof.count <= PROOFS {
                let tree = mesh.triangle_tree(self.quiet)?;
                for point in &compared.beyond {
                    let Some(near) = tree.nearest(point, None) else { continue };
                    let crossing = made.crossings[near.triangle as usize];
                    for leaf in sheets.crossings[crossing as usize].around {
                        if !grower.cells.leaves[leaf as usize].is_gone {
                            is_changed |= grower.split(leaf, 0)?;
                        }
                    }
                }
            }
            if !is_changed {
                let report = ContourReport {
                    intersecting_pairs: pairs.count,
                    cells,
                    splits: grower.splits,
                    undecided: grower.probe.undecided,
                    deviation: compared.most,
                };
                return Ok(Contour { mesh: Arc::unwrap_or_clone(mesh), report });
            }
        }
    }
}

/// How far meshes are from a solid.
struct Proof {
    /// Where the boundary is, once somebody has asked.
    reference: Option<Reference>,
    /// How many meshes were compared with it.
    count: usize,
}

impl Proof {
    fn compare<C: Classifier>(
        &mut self,
        classifier: &C,
        mesh: &Arc<TriangleMesh>,
        wanted: &Wanted<'_>,
        budget: u64,
    ) -> Result<Comparison, Error> {
        let job = Job::new(wanted.quiet);
        let tolerance = wanted.tolerance * classifier.frame().edge();
        let reference = match &mut self.reference {
            Some(reference) => reference,
            None => {
                let known = Reference::new(classifier, KNOWN * tolerance, budget, &job)?;
                self.reference.insert(known)
            }
        };
        self.count += 1;
        reference.compare(mesh, tolerance, &job)
    }
}

/// A mesh with what it was made of.
struct Compared<'c> {
    made: &'c Triangles,
    sheets: &'c Sheets,
    mesh: &'c TriangleMesh,
}

impl Compared<'_> {
    /// The leaves next to which the mesh is too far from the surface. `known` are points of meshes that are near to it.
    fn refused<W: Worker>(
        &self,
        grower: &mut Grower<'_, '_, W>,
        known: &mut HashSet<[u64; 3]>,
        tolerance: f64,
        control: &Control<'_>,
    ) -> Result<Vec<u32>, Error> {
        let mut refused = Vec::new();
        let tree = self.mesh.triangle_tree(control)?;
        let mut samples = Vec::new();
        let mut hint = None;
        for leaf in 0..grower.cells.leaves.len() {
            let own = grower.cells.leaves[leaf];
            if own.kind != Kind::Open || own.is_gone || own.is_checked {
                continue;
            }
            grower.cells.leaves[leaf].is_checked = true;
            let edge = 1.0 / f64::from(1u32 << own.cell.level);
            if own.cell.level >= grower.cells.depth || edge * 1.75 <= tolerance {
                continue;
            }
            control.check()?;
            samples.clear();
            grower.probe.samples(own.cell, AHEAD, &mut samples)?;
            for &sample in &samples {
                let point = grower.probe.model(sample);
                let near = tree.nearest(&point, hint);
                let is_near = near.is_some_and(|near| {
                    hint = Some(near.triangle);
                    tree.most_from(near.triangle, &point) <= NEAR * tolerance * grower.probe.edge()
                });
                if !is_near {
                    memory::push(&mut refused, leaf as u32)?;
                    break;
                }
            }
        }
        if !refused.is_empty() {
            return Ok(refused);
        }
        for (triangle, &crossing) in self.made.triangles.iter().zip(&self.made.crossings) {
            let corners = triangle.map(|vertex| self.made.vertices[vertex as usize]);
            let [a, b, c] = corners;
            // The middle, and those of sides that run this way.
            let middle = |p: [f64; 3], q: [f64; 3]| axes(|k| 0.5 * (p[k] + q[k]));
            let points = [axes(|k| (a[k] + b[k] + c[k]) / 3.0), middle(a, b), middle(b, c), middle(c, a)];
            for (side, point) in points.into_iter().enumerate() {
                if side > 0 && triangle[side - 1] > triangle[side % 3] {
                    continue;
                }
                let bits = point.map(f64::to_bits);
                if known.contains(&bits) {
                    continue;
                }
                let Some(nearest) = grower.probe.nearest(point)? else { break };
                let off = axes(|k| nearest[k] - point[k]);
                if dot(off, off) > NEAR * NEAR * tolerance * tolerance {
                    refused.try_reserve(4)?;
                    refused.extend(self.sheets.crossings[crossing as usize].around);
                    break;
                }
                known.try_reserve(1)?;
                known.insert(bits);
            }
        }
        Ok(refused)
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
        let space = Space { low: leaf.cell.at.map(|c| f64::from(c) * edge), edge };
        let own = &list[first[k] as usize..first[k + 1] as usize];
        best(own.iter().map(|&crossing| places[crossing as usize]), &space)
    }))
}

/// The mesh, without vertices that no triangle has.
fn assemble(made: &Triangles, frame: &Frame) -> Result<TriangleMesh, Error> {
    let mut numbers = memory::filled(made.vertices.len(), NONE)?;
    let mut kept = memory::with_capacity(made.vertices.len())?;
    let mut triangles = memory::with_capacity(made.triangles.len())?;
    for triangle in &made.triangles {
        triangles.push(triangle.map(|vertex| {
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
