//! Traverses records cell by cell, with the octants of each cell in a chosen order.

use super::code::{number_of, size};
use super::records::VoxelRecordsRef;
use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::Tag;
use core::ops::Range;

/// A cell and the records in it.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub cell: Cell,
    pub range: Range<usize>,
}

impl VoxelRecordsRef<'_> {
    /// The whole universe with all records.
    pub(super) fn whole(&self) -> Part {
        Part { cell: Cell::ROOT, range: 0..self.len() }
    }

    /// Returns whether the first record of a part is that of its cell.
    pub(super) fn has_own(&self, part: &Part) -> bool {
        // No record of the part reaches beyond the cell, so that a record of its level is the cell's own.
        !part.range.is_empty() && self.levels()[part.range.start] == part.cell.level
    }

    /// The records in the octants of a cell; the cell's own record is left out. O(log n).
    pub(super) fn split(&self, part: &Part) -> [Part; 8] {
        let depth = self.frame().depth();
        let mut start = part.range.start + self.has_own(part) as usize;
        core::array::from_fn(|octant| {
            if part.cell.level >= depth {
                return Part { cell: part.cell, range: 0..0 };
            }
            let cell = part.cell.child(octant as u8);
            let end = number_of(cell, depth) + size(cell.level, depth);
            let rest = &self.codes()[start..part.range.end];
            let first = start;
            start += match rest.last() {
                // The last octant takes all remaining records, and many octants are empty.
                Some(&last) if last < end => rest.len(),
                Some(_) => rest.partition_point(|&code| code < end),
                None => 0,
            };
            Part { cell, range: first..start }
        })
    }

    /// Visits all records: those of a cell octant by octant in the order that `order` returns, and a refined
    /// record before the records that it consists of. No two records are compared. O(n · levels).
    pub(super) fn visit(
        &self,
        part: &Part,
        order: &impl Fn(Cell) -> [u8; 8],
        put: &mut impl FnMut(usize) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if part.range.len() <= 1 {
            return part.range.clone().try_for_each(put);
        }
        if self.has_own(part) {
            put(part.range.start)?;
        }
        let octants = self.split(part);
        for octant in order(part.cell) {
            self.visit(&octants[octant as usize & 7], order, put)?;
        }
        Ok(())
    }
}

/// Checks a tag that represents boundary voxels.
pub(super) fn checked(boundary: Tag) -> Result<Tag, Error> {
    let problem = "must be EMPTY, PARTIAL or FULL";
    if boundary == Tag::Branch { Err(Error::Argument { name: "boundary", problem }) } else { Ok(boundary) }
}
