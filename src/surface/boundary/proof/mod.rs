//! Proven bounds of the distance between a mesh and the boundary of a solid. The proof uses the surfaces of
//! which the solid is made, and does not depend on how the mesh was made.
//!
//! From the bottom up: `local` (functions around a place), `clip` (polygons), `truth` (verdicts of the leaves
//! on polygons), `witness` (from the mesh to the boundary), `sheets` (from the boundary to the mesh), `known`
//! (results that hold for several meshes).

mod clip;
mod known;
mod local;
mod sheets;
mod truth;
mod witness;

use super::figures::{Figures, length, minus};
use super::leaves::{Leaf, Leaves, OpenLeaf};
use super::mates::mates;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::{Cell, Frame, axes};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::parallel;
use alloc::vec::Vec;
pub(super) use known::Known;
use local::Local;
use sheets::{Lists, Sheet, Subject};
use truth::{Around, Truth, cube};
use witness::Witnesses;

/// The greatest number of parts of cells that are examined where only their extent is known: for all cells
/// together, and for one cell.
const PARTS: usize = 1 << 18;
const PARTS_OF_CELL: usize = 64;

/// The first budget of each triangle for halved pieces and for sizes of cubes around them, and of each
/// surface in a cell for boxes.
const PIECES: u32 = 16;
const BOXES: u32 = 64;

/// A second budget for triangles and cells that need more: their common share is this number plus the total
/// first budget. `MOST` bounds the share of one of them.
const MORE: u32 = 1 << 15;
const MOST: u32 = 1024;

/// The number of triangles, or cells, that one task examines.
const GROUP: usize = 32;

/// The number of triangles and cells from which threads pay.
const WORTH: usize = 256;

/// The result of a proof.
pub(super) struct Proof {
    /// A bound of the distance of each point of the mesh from the boundary, and of the boundary from the mesh
    /// (edges of the universe).
    pub(super) most: f64,
    /// The cells in which the bound exceeds the tolerance.
    pub(super) beyond: Vec<Cell>,
    tolerance: f64,
}

impl Proof {
    fn add(&mut self, cell: Cell, most: f64) -> Result<(), Error> {
        self.most = self.most.max(most);
        if most.is_nan() || most > self.tolerance {
            memory::push(&mut self.beyond, cell)?;
        }
        Ok(())
    }
}

/// Proves a bound of the distance between a mesh and the boundary of the solid that the leaves describe.
/// `surfaces` are those of the triangles. `known` holds results of proofs for other meshes and leaves of the
/// same solid with the same tolerance.
///
/// The result does not depend on the number of threads.
pub(super) fn prove(
    leaves: &Leaves,
    figures: &Figures,
    (mesh, surfaces): (&TriangleMesh, &[u32]),
    (frame, tolerance): (&Frame, f64),
    known: &mut Known,
    job: &Job<'_>,
) -> Result<Proof, Error> {
    let origin = frame.origin();
    let edge = frame.edge();
    let vertices = memory::collected(
        mesh.vertices().iter().map(|v| -> [f64; 3] { axes(|k| (v[k] - origin[k]) / edge) }),
    )?;
    let triangles = mesh.triangles();
    known.turn_to(&vertices, triangles, surfaces)?;
    let tree = mesh.triangle_tree(job.control())?;
    let is_closed = mates(triangles)?;
    let mut proof = Proof { most: 0.0, beyond: Vec::new(), tolerance };
    let Some(mates) = is_closed else {
        proof.most = f64::INFINITY;
        return Ok(proof);
    };
    let subject = Subject { vertices: &vertices, triangles, surfaces, mates, tree, origin, edge };
    let truth = Truth { leaves, figures };
    job.control().run(triangles.len() + leaves.open.len() >= WORTH, |parallel| {
        let prover = Prover { truth: &truth, subject: &subject, tolerance, parallel, job };
        prover.triangles_to_boundary(known, &mut proof)?;
        prover.boundary_to_triangles(known, &mut proof)?;
        contacts(&truth, &subject, (Cell::ROOT, leaves.root), &mut Vec::new(), &mut |cell, most| {
            proof.add(cell, most)
        })?;
        Ok(proof)
    })
}

/// Examines all triangles and cells. Those that little effort proves near are done first; the others share a
/// budget.
struct Prover<'p> {
    truth: &'p Truth<'p>,
    subject: &'p Subject<'p>,
    tolerance: f64,
    parallel: bool,
    job: &'p Job<'p>,
}

/// The result for a triangle.
struct Triangle {
    number: u32,
    most: f64,
    /// The cells in which the triangle is further from the boundary than the tolerance, with the bounds.
    beyond: Vec<(Cell, f64)>,
    /// Whether a greater budget might improve the result.
    is_spent: bool,
}

/// The result for the boundary in a cell.
struct Shown {
    leaf: u32,
    /// The bound; `None` if nothing was proven.
    most: Option<f64>,
    /// The triangles near which the boundary was proven to be.
    by: Vec<u32>,
}

impl Prover<'_> {
    /// Bounds the distance of the triangles from the boundary.
    fn triangles_to_boundary(&self, known: &mut Known, proof: &mut Proof) -> Result<(), Error> {
        let count = self.subject.triangles.len() as u32;
        let mut left = Vec::new();
        for number in 0..count {
            match known.of_triangle(number) {
                Some(most) => proof.most = proof.most.max(most),
                None => memory::push(&mut left, number)?,
            }
        }
        let mut found = self.triangles(&left, PIECES)?;
        left.clear();
        for triangle in found.extract_if(.., |triangle| triangle.is_spent && !triangle.beyond.is_empty()) {
            memory::push(&mut left, triangle.number)?;
        }
        let again = self.triangles(&left, shared(count, PIECES, left.len()))?;
        found.try_reserve(again.len())?;
        found.extend(again);
        let near = || found.iter().filter(|triangle| triangle.most.is_finite());
        for triangle in near() {
            if triangle.beyond.is_empty() {
                known.keep_triangle(triangle.number, triangle.most);
            }
            proof.most = proof.most.max(triangle.most);
            triangle.beyond.iter().try_for_each(|&(cell, most)| proof.add(cell, most))?;
        }
        // For the others, the bound is the path to a triangle with a known bound, plus that bound.
        for triangle in found.iter().filter(|triangle| !triangle.most.is_finite()) {
            let [a, b, c] = self.subject.corners(triangle.number);
            let long = length(minus(b, a)).max(length(minus(c, a)));
            let some = (0..count).step_by(1 + count as usize / 256);
            let some = some.filter_map(|number| Some((number, known.of_triangle(number)?)));
            let others = near().take(256).map(|triangle| (triangle.number, triangle.most));
            let ways = some.chain(others).map(|(number, most)| {
                let [corner, ..] = self.subject.corners(number);
                length(minus(corner, a)) + long + most
            });
            let most = ways.fold(f64::INFINITY, f64::min);
            triangle.beyond.iter().try_for_each(|&(cell, own)| proof.add(cell, own.min(most)))?;
        }
        Ok(())
    }

    /// Examines triangles, each with a budget of `budget`.
    fn triangles(&self, numbers: &[u32], budget: u32) -> Result<Vec<Triangle>, Error> {
        let start = || Witnesses::new(self.truth, self.tolerance);
        let groups = parallel::each_with(self.parallel, numbers.chunks(GROUP), start, |witnesses, group| {
            self.job.check()?;
            let mut found = memory::with_capacity(group.len())?;
            for &number in group {
                let mut triangle = Triangle { number, most: 0.0, beyond: Vec::new(), is_spent: false };
                let (corners, surface) =
                    (self.subject.corners(number), self.subject.surfaces[number as usize]);
                triangle.is_spent = witnesses.triangle(corners, surface, budget, &mut |cell, most| {
                    triangle.most = triangle.most.max(most);
                    match most <= self.tolerance {
                        true => Ok(()),
                        false => memory::push(&mut triangle.beyond, (cell, most)),
                    }
                })?;
                found.push(triangle);
            }
            Ok(found)
        })?;
        joined(groups)
    }

    /// Bounds the distance of the boundary in open cells from the triangles.
    fn boundary_to_triangles(&self, known: &mut Known, proof: &mut Proof) -> Result<(), Error> {
        let leaves = &self.truth.leaves.open;
        let mut left = Vec::new();
        for (number, leaf) in (0u32..).zip(leaves) {
            match known.of_cell(leaf.cell) {
                Some(most) => proof.most = proof.most.max(most),
                None => memory::push(&mut left, number)?,
            }
        }
        let mut first = self.cells(&left, BOXES)?;
        left.clear();
        for shown in first.extract_if(.., |shown| shown.most.is_none()) {
            memory::push(&mut left, shown.leaf)?;
        }
        let boxes = BOXES + shared(leaves.len() as u32, BOXES, left.len());
        let parts = PARTS_OF_CELL.min(PARTS / left.len().max(1)) as u32;
        for Shown { leaf, most, by } in first.into_iter().chain(self.cells(&left, boxes)?) {
            let leaf = &leaves[leaf as usize];
            match most {
                Some(most) => {
                    proof.add(leaf.cell, most)?;
                    if most <= self.tolerance {
                        known.keep_cell(leaf.cell, most, by)?;
                    }
                }
                None => {
                    let around = cube(leaf.cell);
                    let (subject, figures) = (self.subject, self.truth.figures);
                    proof.add(
                        leaf.cell,
                        far(subject, figures, leaf, &around, self.tolerance, &mut { parts })?,
                    )?;
                }
            }
        }
        Ok(())
    }

    /// Examines cells, in which each surface may use a number of boxes.
    fn cells(&self, numbers: &[u32], boxes: u32) -> Result<Vec<Shown>, Error> {
        let groups =
            parallel::each_with(self.parallel, numbers.chunks(GROUP), Lists::default, |lists, group| {
                self.job.check()?;
                let mut found = memory::with_capacity(group.len())?;
                for &leaf in group {
                    lists.used.clear();
                    let most = self.cell(&self.truth.leaves.open[leaf as usize], boxes, lists)?;
                    let mut by = Vec::new();
                    if most.is_some() {
                        lists.used.sort_unstable();
                        lists.used.dedup();
                        by = memory::copied(&lists.used)?;
                    }
                    found.push(Shown { leaf, most, by });
                }
                Ok(found)
            })?;
        joined(groups)
    }

    /// Bounds the distance of the boundary in a cell from the mesh, surface by surface; `None` if nothing is
    /// proven.
    fn cell(&self, leaf: &OpenLeaf, boxes: u32, lists: &mut Lists) -> Result<Option<f64>, Error> {
        let Some(open) = leaf.open else { return Ok(None) };
        let mut most: f64 = 0.0;
        // (On the plane of a joint the solid only changes where its surfaces do.)
        let plane = leaf.joint.map(|joint| joint.plane);
        for place in (0..open.indices().len()).filter(|&place| Some(place) != plane) {
            for is_above in [false, true] {
                let (which, part) = ((place, is_above), (leaf.cell, self.tolerance));
                let mut sheet = Sheet::new(self.subject, self.truth.figures, &open, which, part, lists);
                match sheet.away(boxes)? {
                    Some(own) => most = most.max(own),
                    None => return Ok(None),
                }
            }
        }
        Ok(Some(most))
    }
}

/// The share of each of `some` in the budget that all together did not need.
fn shared(all: u32, each: u32, some: usize) -> u32 {
    let whole = MORE.saturating_add(each.saturating_mul(all));
    (whole / some.max(1) as u32).min(MOST)
}

fn joined<T>(groups: Vec<Vec<T>>) -> Result<Vec<T>, Error> {
    let mut all = memory::with_capacity(groups.iter().map(Vec::len).sum())?;
    all.extend(groups.into_iter().flatten());
    Ok(all)
}

/// Calls `told` for each full cell beside an empty one, if no cell between them contains the boundary. The
/// second argument is a bound of the distance of the boundary there from the mesh.
fn contacts(
    truth: &Truth<'_>,
    subject: &Subject<'_>,
    (cell, leaf): (Cell, Leaf),
    found: &mut Vec<(Cell, Leaf)>,
    told: &mut impl FnMut(Cell, f64) -> Result<(), Error>,
) -> Result<(), Error> {
    if let Leaf::Branch(node) = leaf {
        for (octant, &child) in (0u8..).zip(&truth.leaves.nodes[node as usize]) {
            contacts(truth, subject, (cell.child(octant), child), found, told)?;
        }
    }
    if !matches!(leaf, Leaf::Full) {
        return Ok(());
    }
    let own = cube(cell);
    for side in 0..6 {
        let (axis, is_upper) = (side / 2, side % 2 == 1);
        // The layer behind the inside of the face. (No cell is as small as `LEAST`.)
        let mut behind = own.grown(-truth::LEAST);
        let face = if is_upper { own.high[axis] } else { own.low[axis] };
        let away = if is_upper { truth::LEAST } else { -truth::LEAST };
        (behind.low[axis], behind.high[axis]) = (face + away, face + away);
        truth.meeting(&behind, found)?;
        for &(other, leaf) in &*found {
            let other = match leaf {
                Leaf::Empty => cube(other),
                Leaf::Outside => own,
                _ => continue,
            };
            let shared = Around {
                low: axes(|k| if k == axis { face } else { own.low[k].max(other.low[k]) }),
                high: axes(|k| if k == axis { face } else { own.high[k].min(other.high[k]) }),
            };
            told(cell, subject.away(&shared).0)?;
        }
    }
    Ok(())
}

/// Bounds the distance of the boundary in a part of a cell from the mesh, by the part's extent.
fn far(
    subject: &Subject<'_>,
    figures: &Figures,
    leaf: &OpenLeaf,
    part: &Around,
    tolerance: f64,
    parts: &mut u32,
) -> Result<f64, Error> {
    let centre = part.centre();
    if let Some(open) = leaf.open {
        let (mut signs, mut unknown) = (0u8, 0u8);
        let prism = local::Prism { centre, axes: sheets::UNITS, half: [part.half(); 3] };
        for (k, &surface) in open.indices().iter().enumerate() {
            match Local::new(figures, surface, centre, part.half()).map(|local| local.within(&prism)) {
                Some([low, _]) if low > 0.0 => signs |= 1 << k,
                Some([_, high]) if high < 0.0 => {}
                _ => unknown |= 1 << k,
            }
        }
        if truth::settled(&open, signs, unknown).is_some() {
            return Ok(0.0);
        }
    }
    let (most, _) = subject.away(part);
    if most <= tolerance || *parts < 8 || length(minus(part.high, centre)) <= 0.5 * tolerance {
        return Ok(most);
    }
    *parts -= 8;
    let mut all: f64 = 0.0;
    for octant in 0..8usize {
        let half = |k: usize| octant >> k & 1 == 0;
        let part = Around {
            low: axes(|k| if half(k) { part.low[k] } else { centre[k] }),
            high: axes(|k| if half(k) { centre[k] } else { part.high[k] }),
        };
        all = all.max(far(subject, figures, leaf, &part, tolerance, parts)?);
    }
    Ok(all)
}
