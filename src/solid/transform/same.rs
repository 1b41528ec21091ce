//! Cells that are images of cells: all answers carry over exactly.

use super::image::Maps;
use crate::lattice::{Cell, CellMoments, CubeMoments, Frame, Inverse, PAIRS, PLACES, axes};
use crate::solid::{Crossing, Segment};

/// A map of cells to cells, as it acts on coordinates from a cell's centre in half edges: y = P x with a
/// signed permutation P.
pub(super) struct Turn {
    /// For each axis of the solid's own cell: the axis of the image, and the sign.
    axes: [(usize, f64); 3],
}

impl Turn {
    /// Returns the turn, if the source is exactly the inverse image of the cell, and nothing is rounded.
    pub(super) fn of(maps: &Maps, frame: &Frame, cell: Cell, own: &Frame, source: Cell) -> Option<Turn> {
        if !maps.inward.is_exact() {
            return None;
        }
        let extent = |frame: &Frame, cell: Cell| super::extent(frame, cell);
        let (corner, edge) = extent(frame, cell);
        let (low, high) = maps.inward.image(corner, edge);
        let (corner, edge) = extent(own, source);
        if low != corner || (0..3).any(|axis| high[axis] != corner[axis] + edge) {
            return None;
        }
        let turn = axes(|i| {
            let row = maps.inward.linear[i];
            let j = (0..3).find(|&j| row[j] != 0.0).unwrap_or(i);
            (j, 1f64.copysign(row[j]))
        });
        Some(Turn { axes: turn })
    }

    /// Converts moments of the solid in the source to moments in the cell. Axes change places and signs; the
    /// error does not change.
    pub(super) fn moments(&self, known: &CellMoments) -> CellMoments {
        let CubeMoments { volume, first, second } = known.moments;
        let mut moved = CubeMoments { volume, first: [0.0; 3], second: [0.0; 6] };
        for (i, (j, sign)) in self.axes.into_iter().enumerate() {
            moved.first[j] = sign * first[i];
        }
        for (place, (a, b)) in PAIRS.into_iter().enumerate() {
            let [(i, of_a), (j, of_b)] = [self.axes[a], self.axes[b]];
            moved.second[PLACES[i][j]] = of_a * of_b * second[place];
        }
        CellMoments { moments: moved, error: known.error }
    }

    /// Converts a crossing in the source to a crossing in the cell.
    pub(super) fn crossing(&self, known: &Crossing) -> Crossing {
        let mut normal = [0.0; 3];
        for (i, (j, sign)) in self.axes.into_iter().enumerate() {
            normal[j] = sign * known.normal[i];
        }
        Crossing { t: known.t, normal }
    }
}

/// The inverse image of a segment, if neither end is rounded.
pub(super) fn segment(back: &Inverse, segment: &Segment) -> Option<Segment> {
    Some(Segment { from: back.exact_image(segment.from)?, to: back.exact_image(segment.to)? })
}
