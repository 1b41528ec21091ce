//! Conversions between places on a ray and coordinates in model space.
//!
//! The centre of cell k lies at the real number origin + (k + ½) · edge / 2^depth, whether or not that is a
//! double. Both conversions keep the gap of a place: the centres below it are decided exactly.

use super::place::{Place, gap};
use crate::lattice::Frame;
use crate::lattice::exact::DoubleDouble;

/// The lattice along one axis of a frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<'a> {
    pub frame: &'a Frame,
    pub axis: usize,
}

impl Line<'_> {
    /// The coordinate of a place that is `cells` cells from the universe's lower face: the nearest double in
    /// the place's gap, up to an ulp. If no double lies in the gap, as may happen far from the origin, it is
    /// the nearest of all doubles.
    pub fn coordinate(&self, cells: f64) -> f64 {
        let (origin, size) = (self.frame.origin()[self.axis], self.frame.cell_size());
        let count = self.frame.cells();
        // (Arrays from a file may contain any numbers.)
        if !(0.0..=f64::from(count)).contains(&cells) {
            return origin + cells * size;
        }
        let sum = DoubleDouble::from(origin) + DoubleDouble::product(cells, size);
        let x = sum.high + sum.low;
        let gap = gap(cells) as u32;
        // The possible effect of rounding, in cells.
        let slack = 4.0 * f64::EPSILON * x.abs() / size;
        let centre = f64::from(gap) + 0.5;
        if cells - (centre - 1.0) > slack && centre - cells > slack {
            return x;
        }
        let moved = if gap > 0 && self.side(x, gap - 1) <= 0 {
            x.next_up()
        } else if gap < count && self.side(x, gap) > 0 {
            x.next_down()
        } else {
            x
        };
        if self.gap(moved) == gap { moved } else { x }
    }

    /// The first cell whose centre does not lie below a coordinate, which must not be NaN; exact. Beyond the
    /// last centre it is the number of cells.
    pub fn gap(&self, x: f64) -> u32 {
        let (x, count) = (clamped(x), self.frame.cells());
        let cells = self.frame.scaled(self.axis, x);
        if cells < -1.0 {
            return 0;
        }
        if cells > f64::from(count) + 1.0 {
            return count;
        }
        // The error is below 2^-30.
        const SURE: f64 = 0.5 - 1.0 / (1u64 << 28) as f64;
        let nearest = gap(cells);
        let found = if (cells - nearest as f64).abs() < SURE {
            nearest
        } else {
            // One of the two neighbouring centres is so near that the other one is not in question.
            let centre = if cells > nearest as f64 { nearest } else { nearest - 1 };
            if self.frame.side(self.axis, x, 2 * centre + 1) > 0 { centre + 1 } else { centre }
        };
        found.clamp(0, i64::from(count)) as u32
    }

    /// The place nearest to a coordinate, which must not be NaN, in the coordinate's gap. A coordinate beyond
    /// the universe gives a face of the universe.
    pub fn place<P: Place>(&self, x: f64) -> P {
        let size = DoubleDouble::from(self.frame.cell_size());
        let cells = self.frame.near_offset(self.axis, clamped(x), 0).quotient(size);
        P::rounded_in(cells.clamp(0.0, f64::from(self.frame.cells())), self.gap(x), self.frame.depth())
    }

    /// The exact sign of a coordinate minus the centre of a cell.
    fn side(&self, x: f64, cell: u32) -> i32 {
        self.frame.side(self.axis, x, 2 * i64::from(cell) + 1)
    }
}

/// Limits a coordinate: far outside nothing needs to be exact, but nothing may overflow.
fn clamped(x: f64) -> f64 {
    const FAR: f64 = f64::from_bits((1023 + 400) << 52);
    x.clamp(-FAR, FAR)
}

/// Returns whether a number of cells is a place in a universe of this depth.
pub(crate) fn is_place(cells: f64, depth: u8) -> bool {
    (0.0..=f64::from(1u32 << depth)).contains(&cells)
}
