//! A point of a cell whose winding number is known, and from which all triangles keep away.

use super::crossing::Projection;
use super::local::{Point, Seen, View};
use super::placed::ranks;
use core::array::from_fn as array;

/// A point whose winding number is known.
#[derive(Clone, Copy)]
pub(super) struct Base {
    pub(super) at: Point,
    pub(super) winding: i32,
}

impl View<'_> {
    /// Returns the lowest centre, or one of two centres in the middle. `None` if triangles come near to all
    /// three.
    pub(super) fn base(&self) -> Option<Base> {
        const EIGHTHS: [[i32; 3]; 3] = [[0, 0, 0], [5, 3, 2], [2, 7, 5]];
        EIGHTHS.into_iter().find_map(|eighths| {
            let cell = array(|axis| self.at[axis] + self.size * eighths[axis] / 8);
            let at = self.centre(cell);
            let is_clear = self.triangles.iter().all(|&triangle| self.seen(triangle).is_clear_of(&at));
            is_clear.then(|| Base { at, winding: self.winding + self.change(cell) })
        })
    }

    /// The change of the winding number on the way from the lowest centre to the centre of `cell`, along x,
    /// then y, then z.
    fn change(&self, cell: [i32; 3]) -> i32 {
        let mut from = self.at;
        let mut change = 0;
        for w in 0..3 {
            if from[w] == cell[w] {
                continue;
            }
            let (u, v) = [(1, 2), (0, 2), (0, 1)][w];
            for &triangle in self.triangles {
                let corners = self.placed.corners(triangle);
                let spans = |axis: usize| {
                    let (first, end) = ranks(&corners, axis);
                    first <= from[axis] && from[axis] < end
                };
                if !(spans(u) && spans(v)) {
                    continue;
                }
                let mut seen = Projection::new(self.placed, triangle, corners, w);
                if let Some(span) =
                    seen.span(from[v]).filter(|span| span.first <= from[u] && from[u] < span.end)
                {
                    let above = seen.above(from[u], from[v], span.step);
                    if from[w] < above && above <= cell[w] {
                        change += span.step;
                    }
                }
            }
            from[w] = cell[w];
        }
        change
    }
}

impl Seen {
    /// Returns whether a point in the cell surely lies so far from the triangle that rounding cannot matter.
    pub(super) fn is_clear_of(&self, p: &Point) -> bool {
        let margin = 8.0 * self.slack();
        // A finest centre is no nearer to the cell's faces than 2^-20.
        let is_small = margin < 1.0 / (1 << 22) as f64;
        is_small
            && ((0..3).any(|axis| p[axis] < self.low[axis] - margin || p[axis] > self.high[axis] + margin)
                || self.side(p, margin) != 0)
    }
}
