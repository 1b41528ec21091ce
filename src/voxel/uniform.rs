//! Tests whether a whole box is of one kind.

use super::descent::Part;
use super::record::VoxelKind;
use super::records::VoxelRecordsRef;
use crate::lattice::Cell;

/// The greatest number of cells that are visited.
const VISITS: u32 = 256;

/// The test of a box of finest cells, from `first` to `last`.
struct Look<'r> {
    records: &'r VoxelRecordsRef<'r>,
    first: [u32; 3],
    last: [u32; 3],
    visits: u32,
    /// A record in the box.
    found: Option<usize>,
    /// Whether some part of the box has no record.
    has_nothing: bool,
}

impl VoxelRecordsRef<'_> {
    /// The common content of the box from the finest cell `first` to `last`: a record that is equal to all
    /// other records in the box, or `Some(None)` if there are none. A box that extends `beyond` the universe
    /// has a part without records. `None` if the box is not known to be of one kind; boundary voxels never
    /// are. O(log n).
    pub(super) fn uniform(&self, first: [u32; 3], last: [u32; 3], beyond: bool) -> Option<Option<usize>> {
        let mut look = Look { records: self, first, last, visits: 0, found: None, has_nothing: beyond };
        look.visit(&self.whole()).then_some(look.found)
    }
}

impl Look<'_> {
    /// Returns whether everything seen so far, and the part of a cell in the box, are of one kind. The
    /// recursion is as deep as the lattice, at most 20 levels.
    fn visit(&mut self, part: &Part) -> bool {
        self.visits += 1;
        if self.visits > VISITS {
            return false;
        }
        if part.range.is_empty() {
            self.has_nothing = true;
            return self.found.is_none();
        }
        let index = part.range.start;
        if self.records.has_own(part) && self.records.kind_at(index) != VoxelKind::Refined {
            return self.take(index);
        }
        let octants = self.records.split(part);
        octants.iter().all(|octant| !self.meets(octant.cell) || self.visit(octant))
    }

    fn take(&mut self, index: usize) -> bool {
        let kind = self.records.kind_at(index);
        if self.has_nothing || kind == VoxelKind::Boundary {
            return false;
        }
        let Some(found) = self.found else {
            self.found = Some(index);
            return true;
        };
        let numbers = |index: usize| self.records.numbers_at(index).iter().map(|number| number.to_bits());
        self.records.kind_at(found) == kind && numbers(found).eq(numbers(index))
    }

    fn meets(&self, cell: Cell) -> bool {
        let shift = self.records.frame().depth() - cell.level;
        (0..3).all(|axis| {
            (cell.at[axis] << shift) <= self.last[axis] && self.first[axis] < ((cell.at[axis] + 1) << shift)
        })
    }
}
