//! The effect of a change in place: the removed and the added parts.

use super::merge::SetOp;
use super::place::{Place, Span};
use super::view::OTHERS;
use crate::lattice::Each;
use crate::lattice::Frame;

/// The effect of a change by a [`DexelEditor`](super::DexelEditor) on its rays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DexelChange {
    /// The number of rays, in all directions, whose intervals changed.
    pub rays: u64,
    /// For each axis, the volume that the rays along it lost (cubic model units): the sum of the lengths,
    /// times the area of a cell's face. It is an estimate, not a bound. It differs between the axes, because
    /// rays do not see what lies between them. 0 for an axis without rays.
    pub removed: [f64; 3],
    /// For each axis, the volume that the rays along it gained.
    pub added: [f64; 3],
    /// The box of finest cells that contains the changed parts of rays: its first cell, and the first cell
    /// beyond it on each axis. `None` if no ray changed.
    pub cells: Option<[[u32; 3]; 2]>,
}

impl DexelChange {
    /// No change.
    pub(super) const NONE: DexelChange =
        DexelChange { rays: 0, removed: [0.0; 3], added: [0.0; 3], cells: None };

    /// Adds the changes along an axis.
    pub(super) fn add(&mut self, axis: usize, tally: &Tally, frame: &Frame) {
        if tally.rays == 0 {
            return;
        }
        let cell = frame.cell_size();
        self.rays += tally.rays;
        self.removed[axis] = tally.removed * cell * cell * cell;
        self.added[axis] = tally.added * cell * cell * cell;
        let [u, v] = OTHERS[axis];
        let mut found = [[0; 3]; 2];
        (found[0][u], found[0][v], found[0][axis]) =
            (tally.first[0], tally.first[1], crate::lattice::exact::floor(tally.along[0]) as u32);
        (found[1][u], found[1][v], found[1][axis]) =
            (tally.end[0], tally.end[1], -crate::lattice::exact::floor(-tally.along[1]) as u32);
        self.cells = Some(self.cells.map_or(found, |[first, end]| {
            [
                core::array::from_fn(|i| first[i].min(found[0][i])),
                core::array::from_fn(|i| end[i].max(found[1][i])),
            ]
        }));
    }
}

/// The changes of the rays along one axis, in cells.
pub(super) struct Tally {
    rays: u64,
    removed: f64,
    added: f64,
    first: [u32; 2],
    end: [u32; 2],
    along: [f64; 2],
}

impl Tally {
    pub const NONE: Tally = Tally {
        rays: 0,
        removed: 0.0,
        added: 0.0,
        first: [u32::MAX; 2],
        end: [0; 2],
        along: [f64::INFINITY, f64::NEG_INFINITY],
    };

    #[inline(always)]
    pub fn add(&mut self, ray: [u32; 2], part: &Part) {
        self.rays += 1;
        self.removed += part.removed;
        self.added += part.added;
        for i in 0..2 {
            self.first[i] = self.first[i].min(ray[i]);
            self.end[i] = self.end[i].max(ray[i] + 1);
        }
        self.along = [self.along[0].min(part.along[0]), self.along[1].max(part.along[1])];
    }
}

/// The change of one ray, in cells.
pub(super) struct Part {
    pub removed: f64,
    pub added: f64,
    /// The range in which the ray differs.
    pub along: [f64; 2],
}

/// The change of a ray by an operation with `other`: it was `own` and became `made`. `None` if it did not
/// change.
#[inline]
pub(super) fn part<S: Span>(op: SetOp, own: &[S], other: &[S], made: &[S], depth: u8) -> Option<Part> {
    let first = (0..).find(|&k| end(own, k) != end(made, k) || end(own, k).is_none())?;
    let (own_ends, made_ends) = (2 * own.len(), 2 * made.len());
    let last = (0..).find(|&k| {
        let behind = |list, ends: usize| ends.checked_sub(k + 1).and_then(|k| end(list, k));
        let (a, b) = (behind(own, own_ends), behind(made, made_ends));
        a != b || a.is_none()
    })?;
    let at = |list: &[S], k: usize| end(list, k).map(|at| at.cells(depth));
    let behind = |list: &[S], k: usize| (2 * list.len()).checked_sub(k + 1).and_then(|k| at(list, k));
    // Beyond the ends of both lists nothing differs.
    let low = [at(own, first), at(made, first)].into_iter().flatten().reduce(f64::min)?;
    let high = [behind(own, last), behind(made, last)].into_iter().flatten().reduce(f64::max)?;
    let length = |list: &[S]| {
        list.iter().map(|span| span.ends().each(|end| end.cells(depth))).map(|[a, b]| b - a).sum::<f64>()
    };
    let (before, after) = (length(own), length(made));
    let (removed, added) = match op {
        SetOp::Union => (0.0, after - before),
        SetOp::Intersection | SetOp::Difference => (before - after, 0.0),
        // The common part is in neither operand's share of the result.
        SetOp::Xor => {
            let common = (before + length(other) - after) / 2.0;
            (common, length(other) - common)
        }
    };
    Some(Part { removed, added, along: [low, high] })
}

/// The k-th end of a list.
#[inline(always)]
fn end<S: Span>(list: &[S], k: usize) -> Option<S::Place> {
    list.get(k / 2).map(|span| span.ends()[k % 2])
}
