//! Height maps: the reach of the solid in each column, seen from one side.

use super::{Columns, Shadow, Visitor};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Frame, Interval};
use crate::memory;
use alloc::vec::Vec;

/// The side from which columns are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Side {
    /// From above, towards lower coordinates: the highest cell counts.
    Above = 0,
    /// From below: the lowest cell counts.
    Below = 1,
}

/// A height map: the reach of the solid cells in columns, seen from one side. A height is the upper face of
/// the highest cell, or the lower face of the lowest cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Heights {
    frame: Frame,
    columns: Columns,
    side: Side,
    full: Vec<u32>,
    upper: Vec<u32>,
}

/// No cell: greater than all planes.
const NONE: u32 = u32::MAX;

impl Heights {
    /// Builds an empty height map. `count` is the number of columns.
    pub(super) fn new(frame: Frame, columns: Columns, side: Side, count: usize) -> Result<Heights, Error> {
        let (full, upper) = (memory::filled(count, NONE)?, memory::filled(count, NONE)?);
        Ok(Heights { frame, columns, side, full, upper })
    }

    /// Copies the results of a block of the columns.
    pub(super) fn take(&mut self, block: &Heights) {
        let size = block.columns.size();
        let row = size[0] as usize;
        for v in 0..size[1] {
            let steps = [0, 1].each(|i| block.columns.first[i] - self.columns.first[i]);
            let (to, from) = (self.columns.place([steps[0], steps[1] + v]), block.columns.place([0, v]));
            self.full[to..to + row].copy_from_slice(&block.full[from..from + row]);
            self.upper[to..to + row].copy_from_slice(&block.upper[from..from + row]);
        }
    }

    /// The columns.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// The side from which the columns are seen.
    pub fn side(&self) -> Side {
        self.side
    }

    /// Returns an interval, in model units, for the reach of the solid in the column with this
    /// [index](Columns::index): the greatest coordinate of the solid's points along the axis, or the least
    /// one from below. The end of the interval that needs a proof is infinite if no cell of the column is
    /// FULL. `None` if the column is proven empty, or is not selected.
    pub fn height(&self, index: usize) -> Option<Interval> {
        let axis = self.columns.axis;
        let possible = self.frame.plane(axis, self.upper_plane(index)?);
        let proven = self.full_plane(index).map(|plane| self.frame.plane(axis, plane));
        Some(match self.side {
            Side::Above => {
                Interval::between(proven.map_or(f64::NEG_INFINITY, |plane| plane.lower), possible.upper)
            }
            Side::Below => {
                Interval::between(possible.lower, proven.map_or(f64::INFINITY, |plane| plane.upper))
            }
        })
    }

    /// Returns the lattice plane, 0 to 2^depth, in which a column's first FULL cell ends towards the side;
    /// `None` if the column has no FULL cell.
    pub fn full_plane(&self, index: usize) -> Option<u32> {
        self.full.get(index).copied().filter(|&plane| plane != NONE)
    }

    /// Returns the same plane for the first cell that is FULL or PARTIAL.
    pub fn upper_plane(&self, index: usize) -> Option<u32> {
        self.upper.get(index).copied().filter(|&plane| plane != NONE)
    }
}

impl Visitor for Heights {
    fn meet(&mut self, is_full: bool, shadow: &Shadow) -> Result<(), Error> {
        let nearer = |plane: &mut u32| match self.side {
            Side::Above if *plane == NONE => *plane = shadow.cells.end,
            Side::Above => *plane = (*plane).max(shadow.cells.end),
            Side::Below => *plane = (*plane).min(shadow.cells.start),
        };
        for column in shadow.places(self.columns) {
            nearer(&mut self.upper[column]);
            if is_full {
                nearer(&mut self.full[column]);
            }
        }
        Ok(())
    }

    /// Cells come from the side, so that a FULL cell hides all cells behind it.
    fn skips(&self, shadow: &Shadow) -> bool {
        shadow.places(self.columns).all(|column| self.full[column] != NONE)
    }
}
