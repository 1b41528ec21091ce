//! Records cell by cell, the octants of each cell in an order of choice.

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
    /// All records.
    pub(super) fn whole(&self) -> Part {
        Part { cell: Cell::ROOT, range: 0..self.len() }
    }

    /// Whether the first record of a part is of its cell itself.
    pub(super) fn has_own(&self, part: &Part) -> bool {
        // No record of the part reaches beyond the cell, so one of its level is it.
        !part.range.is_empty() && self.levels()[part.range.start] == part.cell.level
    }

    /// The records in the octants of a cell that has none of its own, or without that. O(log n).
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
                // The last octant takes all that is left, and many octants are empty.
                Some(&last) if last < end => rest.len(),
                Some(_) => rest.partition_point(|&code| code < end),
                None => 0,
            };
            Part { cell, range: first..start }
        })
    }

    /// Hands over all records: those of a cell octant by octant in the order that `order` gives, a refined
    /// one before those that it consists of. No two records are compared. O(n · levels).
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

/// What a tag must not be that stands for boundary voxels.
pub(super) fn checked(boundary: Tag) -> Result<Tag, Error> {
    let problem = "must be EMPTY, PARTIAL or FULL";
    if boundary == Tag::Branch { Err(Error::Argument { name: "boundary", problem }) } else { Ok(boundary) }
}
