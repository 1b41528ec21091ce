//! The cells of a boundary evaluation: split until the surfaces in each cell have a simple arrangement.

use super::figures::{Figures, Shape, dot};
use super::joint::Joint;
use super::redundant::without_redundant;
use super::scaled::Scaled;
use crate::control::Job;
use crate::cut::Quadratic;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, axes};
use crate::memory;
use crate::octree::Tag;
use crate::solid::{Ask, Classifier, OpenSurfaces, Verdict, Worker};
use alloc::vec::Vec;

/// A cell that is not split.
#[derive(Debug, Clone, Copy)]
pub(super) enum Leaf {
    Empty,
    Full,
    /// The number of the cell among the open ones.
    Open(u32),
    Branch(u32),
    /// The space around the universe.
    Outside,
}

/// A cell that the boundary passes through.
#[derive(Debug, Clone, Copy)]
pub(super) struct OpenLeaf {
    pub(super) cell: Cell,
    /// The function that describes the solid in the cell, if it is known.
    pub(super) open: Option<OpenSurfaces>,
    /// Whether the surfaces cross each other at most once in each face of the cell.
    pub(super) is_simple: bool,
    /// Two touching surfaces of a simple cell.
    pub(super) joint: Option<Joint>,
}

/// The cells of the universe.
pub(super) struct Leaves {
    pub(super) nodes: Vec<[Leaf; 8]>,
    pub(super) open: Vec<OpenLeaf>,
    pub(super) root: Leaf,
    pub(super) depth: u8,
    pub(super) splits: u64,
    /// The greatest deviation of the boundary where surfaces were left out (edges of the universe).
    pub(super) slack: f64,
    /// The number of finest cells in which no surface is known.
    unknown: u32,
}

/// More finest cells without a known surface than this are not points or lines in which surfaces meet, but a
/// boundary without surfaces.
const UNKNOWN_CELLS: u32 = 1 << 16;

/// The error if a mesh or a host program's function bounds a part of the solid.
const MIXED: Error = Error::Argument {
    name: "solid",
    problem: "is bounded by something other than known surfaces; a contour or dual contouring takes any solid",
};

/// The greatest number of surfaces in a simple cell.
pub(super) const MOST: usize = 3;

/// The sine of the greatest angle between a surface's normals in a simple cell and its normal at the centre.
const CONE: f64 = 0.6;

/// The conditions under which cells end.
pub(super) struct Wanted<'w> {
    pub(super) figures: &'w Figures,
    /// The greatest distance of chords from surfaces, in edges of the universe.
    pub(super) tolerance: f64,
    /// Cells that are split although they look simple.
    pub(super) refused: &'w Refused,
    /// The progress units of the whole universe.
    pub(super) parts: usize,
}

/// Cells that are not as simple as they look.
#[derive(Default)]
pub(super) struct Refused {
    /// The first `known` cells are in ascending order.
    cells: Vec<(u8, [u32; 3])>,
    known: usize,
}

impl Refused {
    pub(super) fn add(&mut self, cell: Cell) -> Result<(), Error> {
        memory::push(&mut self.cells, (cell.level, cell.at))
    }

    /// Returns whether a cell was refused before the last [`settle`](Self::settle).
    fn contains(&self, cell: Cell) -> bool {
        self.cells[..self.known].binary_search(&(cell.level, cell.at)).is_ok()
    }

    /// Sorts in the added cells. `false` if there are no new ones.
    pub(super) fn settle(&mut self) -> bool {
        let before = self.known;
        self.cells.sort_unstable();
        self.cells.dedup();
        self.known = self.cells.len();
        self.known > before
    }
}

impl Leaves {
    pub(super) fn grow<C: Classifier>(
        classifier: &C,
        wanted: &Wanted<'_>,
        job: &Job<'_>,
    ) -> Result<Leaves, Error> {
        let depth = classifier.frame().depth();
        let (nodes, open, root) = (Vec::new(), Vec::new(), Leaf::Empty);
        let mut leaves = Leaves { nodes, open, root, depth, splits: 0, slack: 0.0, unknown: 0 };
        let mut worker = classifier.worker()?;
        let root = worker.root()?;
        leaves.root = leaves.add(Cell::ROOT, root, &mut worker, wanted, job)?;
        Ok(leaves)
    }

    /// Adds a cell, and reports it.
    fn add<W: Worker>(
        &mut self,
        cell: Cell,
        verdict: Verdict<W::Part>,
        worker: &mut W,
        wanted: &Wanted<'_>,
        job: &Job<'_>,
    ) -> Result<Leaf, Error> {
        let part = match verdict {
            Verdict::Partial(part) => part,
            decided => {
                wanted.report(cell, job);
                return match decided.tag() {
                    Tag::Empty => Ok(Leaf::Empty),
                    Tag::Full => Ok(Leaf::Full),
                    Tag::Partial | Tag::Branch => {
                        self.end(OpenLeaf { cell, open: None, is_simple: false, joint: None })
                    }
                };
            }
        };
        let open = worker.surfaces(cell, &part)?.map(|open| open.shortened());
        let fewer = open.and_then(|open| without_redundant(wanted.figures, cell, &open));
        if let Some((_, slack)) = fewer {
            self.slack = self.slack.max(slack);
        }
        let mut open = fewer.map(|(open, _)| open).or(open);
        let found = open.and_then(|open| Joint::find(wanted.figures, cell, &open));
        let joint = found.map(|(joint, function, slack)| {
            (open, self.slack) = (Some(function), self.slack.max(slack));
            joint
        });
        if let Some(inside) = open.and_then(|open| open.settled()) {
            wanted.report(cell, job);
            return Ok(if inside { Leaf::Full } else { Leaf::Empty });
        }
        let is_refused = wanted.refused.contains(cell);
        let is_simple = !is_refused && open.is_some_and(|open| wanted.is_simple(cell, &open, joint));
        let may_end = cell.level > 0 && !is_refused;
        if is_simple
            || cell.level == self.depth
            || may_end && open.is_some_and(|open| wanted.is_merged(cell, &open))
            || may_end && is_thin(worker, cell, &part, wanted)?
        {
            wanted.report(cell, job);
            return self.end(OpenLeaf { cell, open, is_simple, joint });
        }
        job.spend(1, size_of::<[Leaf; 8]>())?;
        self.splits += 1;
        let mark = worker.mark();
        let node = self.nodes.len();
        memory::push(&mut self.nodes, [Leaf::Empty; 8])?;
        let children = worker.split(cell, &part)?;
        for (octant, child) in (0..8u8).zip(children) {
            self.nodes[node][usize::from(octant)] =
                self.add(cell.child(octant), child, worker, wanted, job)?;
        }
        worker.release(mark);
        Ok(Leaf::Branch(node as u32))
    }

    fn end(&mut self, leaf: OpenLeaf) -> Result<Leaf, Error> {
        if leaf.open.is_none() && leaf.cell.level == self.depth {
            self.unknown += 1;
            if self.unknown > UNKNOWN_CELLS {
                return Err(MIXED);
            }
        }
        memory::push(&mut self.open, leaf)?;
        Ok(Leaf::Open(self.open.len() as u32 - 1))
    }
}

/// Returns whether the boundary in a cell lies between two planes that are nearer to each other than half the
/// tolerance.
fn is_thin<W: Worker>(
    worker: &mut W,
    cell: Cell,
    part: &W::Part,
    wanted: &Wanted<'_>,
) -> Result<bool, Error> {
    let Some(enclosure) = worker.enclosure(cell, part)? else { return Ok(false) };
    let half = 0.5 / f64::from(1u32 << cell.level);
    let mut known = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
    let (Some(slab), None) = (known.next(), known.next()) else { return Ok(false) };
    let width = (slab.outer - slab.inner) / sqrt(dot(slab.normal, slab.normal));
    Ok(width * half <= 0.5 * wanted.tolerance)
}

impl Wanted<'_> {
    /// Reports a cell as done.
    fn report(&self, cell: Cell, job: &Job<'_>) {
        let parts = self.parts >> (3 * u32::from(cell.level)).min(usize::BITS - 1);
        if parts > 0 {
            job.advance(parts);
        }
    }

    /// Returns whether the boundary in a cell lies within the tolerance of one nearly flat surface. Surfaces
    /// that are very near to each other count as one, as where a ball ends a round bar; the solid must then
    /// depend on one surface only.
    fn is_merged(&self, cell: Cell, open: &OpenSurfaces) -> bool {
        let most = 0.4 * self.tolerance / (0.5 / f64::from(1u32 << cell.level));
        let mut known = [Scaled::default(); OpenSurfaces::MOST];
        for (place, &surface) in known.iter_mut().zip(open.indices()) {
            match Scaled::of(self.figures, surface, cell) {
                Some(own) => *place = own,
                None => return false,
            }
        }
        let mut table = open.table();
        for k in 1..open.indices().len() {
            let other = (0..k).find(|&i| table.depends_on(i) && known[i].apart(&known[k]).0 <= most);
            if let Some(i) = other {
                table = table.renamed(k, i, known[i].apart(&known[k]).1);
            }
        }
        let mut left = (0..open.indices().len()).filter(|&k| table.depends_on(k));
        match (left.next(), left.next()) {
            (None, _) => true,
            (Some(k), None) => known[k].rise() <= most,
            _ => false,
        }
    }

    /// Returns whether the surfaces in a cell are nearly flat, and cross each other at clear angles, except
    /// two that touch in a joint.
    fn is_simple(&self, cell: Cell, open: &OpenSurfaces, joint: Option<Joint>) -> bool {
        if open.indices().len() > MOST {
            return false;
        }
        let half = 0.5 / f64::from(1u32 << cell.level);
        let mut known = [([0.0; 3], 0.0); MOST];
        for (place, &surface) in known.iter_mut().zip(open.indices()) {
            let shape = self.figures.shape(surface);
            let Some(taylor) = self.figures.taylor(surface, cell) else { return false };
            let steep = sqrt(dot(taylor.f.gradient, taylor.f.gradient));
            let sine = taylor.bend / steep;
            if sine.is_nan() || sine >= CONE {
                return false;
            }
            let normal = taylor.f.gradient.each(|c| c / steep);
            *place = (normal, sine);
            if shape == Shape::Plane {
                continue;
            }
            // The distance of the surface from its tangent plane.
            let [xx, yy, zz, xy, xz, yz] = taylor.f.squares.each(f64::abs);
            let rise = (xx + yy + zz + 2.0 * (xy + xz + yz) + taylor.f.error) / steep * half;
            if shape == Shape::Bent && rise > 1.5 * self.tolerance {
                return false;
            }
            if rise > 0.25 * self.tolerance && bulges(&taylor.f, steep, 0.25 * self.tolerance / half) {
                return false;
            }
        }
        let count = open.indices().len();
        for i in 0..count {
            for j in i + 1..count {
                let ((n, a), (m, b)) = (known[i], known[j]);
                let is_plane = |k: usize| self.figures.shape(open.indices()[k]) == Shape::Plane;
                let are_one = joint.is_some_and(|joint| joint.sides.contains(&i) && joint.sides.contains(&j));
                if are_one || is_plane(i) && is_plane(j) {
                    continue;
                }
                let cross = [n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]];
                if sqrt(dot(cross, cross)) <= 1.2 * (a + b) {
                    return false;
                }
            }
        }
        true
    }
}

/// Returns whether a surface leaves a cell through an edge or a face and comes back through the same one, by
/// more than `most` (in half edges).
fn bulges(f: &Quadratic, steep: f64, most: f64) -> bool {
    let ([a, b, c], [xx, yy, zz, xy, xz, yz]) = (f.gradient, f.squares);
    let square = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let gradient = [a, b, c];
    let value = |p: [f64; 3]| {
        let rows: [f64; 3] = axes(|i| dot(square[i], p));
        f.value + dot(gradient, p) + dot(rows, p)
    };
    let slope = |p: [f64; 3], axis: usize| gradient[axis] + 2.0 * dot(square[axis], p);
    let counts = |dip: f64, side: f64| dip * side < 0.0 && dip.abs() / steep > most;
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for corner in 0..4 {
            let mut p = [0.0; 3];
            (p[u], p[v]) = (f64::from(corner & 1) * 2.0 - 1.0, f64::from(corner >> 1) * 2.0 - 1.0);
            let second = 2.0 * square[axis][axis];
            if second == 0.0 {
                continue;
            }
            let x = -slope(p, axis) / second;
            if x.abs() < 1.0 {
                let end = |x: f64| {
                    let mut q = p;
                    q[axis] = x;
                    value(q)
                };
                let (low, high, dip) = (end(-1.0), end(1.0), end(x));
                if low * high > 0.0 && counts(dip, low) {
                    return true;
                }
            }
        }
        for side in [-1.0, 1.0] {
            let mut p = [0.0; 3];
            p[axis] = side;
            let (uu, vv, uv) = (2.0 * square[u][u], 2.0 * square[v][v], 2.0 * square[u][v]);
            let determinant = uu * vv - uv * uv;
            if determinant == 0.0 {
                continue;
            }
            let (gu, gv) = (slope(p, u), slope(p, v));
            let (x, y) = ((uv * gv - vv * gu) / determinant, (uv * gu - uu * gv) / determinant);
            if x.abs() < 1.0 && y.abs() < 1.0 {
                (p[u], p[v]) = (x, y);
                let dip = value(p);
                let corners: [f64; 4] = core::array::from_fn(|k| {
                    let mut q = p;
                    (q[u], q[v]) = (if k & 1 == 0 { -1.0 } else { 1.0 }, if k & 2 == 0 { -1.0 } else { 1.0 });
                    value(q)
                });
                if corners.iter().all(|&corner| counts(dip, corner)) {
                    return true;
                }
            }
        }
    }
    false
}
