//! The cells of one level about which nothing is known.

use super::cells::CellFilter;
use super::cuts::{CellCut, CutsRef};
use super::tag::Tag;
use super::view::OctreeRef;
use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use alloc::vec::Vec;

/// Most cells in the list.
const MOST: usize = 1 << 24;

impl OctreeRef<'_> {
    /// Returns the cells of `level` about which nothing is known, in Morton order: each is PARTIAL, or lies
    /// in a PARTIAL cell, and no surfaces are kept there. For a [top](crate::Shard::Top) of that level, these
    /// are the cells that need a shard. O(cells of the levels above, and of the result).
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] if the frame has no such level; [`Error::Limit`] if there are more than 2^24
    /// cells; [`Error::Damaged`] if the cuts of an unverified tree turn out damaged; [`Error::OutOfMemory`].
    pub fn open_cells(&self, level: u8) -> Result<Vec<Cell>, Error> {
        if level > self.frame.depth() {
            return Err(Error::Argument { name: "level", problem: "is below the depth of the frame" });
        }
        self.ensure_cuts()?;
        let mut found = Vec::new();
        for known in self.cells(CellFilter::tags(&[Tag::Partial]).levels(0..=level)) {
            match &self.cuts {
                Some(cuts) => match self.record_above(cuts, known.cell) {
                    Some((record, _)) => below_record(cuts, record, known.cell, level, &mut found)?,
                    None => all_in(known.cell, level, &mut found)?,
                },
                None => all_in(known.cell, level, &mut found)?,
            }
        }
        Ok(found)
    }
}

/// Appends the open cells of a PARTIAL cell with a record.
fn below_record(
    cuts: &CutsRef<'_>,
    record: usize,
    cell: Cell,
    level: u8,
    found: &mut Vec<Cell>,
) -> Result<(), Error> {
    match cuts.at(record) {
        CellCut::None => all_in(cell, level, found),
        CellCut::Split(first) if cell.level < level => {
            (0..8).try_for_each(|k| below_record(cuts, first + usize::from(k), cell.child(k), level, found))
        }
        _ => Ok(()),
    }
}

/// Appends all cells of a level in a cell.
fn all_in(cell: Cell, level: u8, found: &mut Vec<Cell>) -> Result<(), Error> {
    if cell.level < level {
        return (0..8).try_for_each(|k| all_in(cell.child(k), level, found));
    }
    if found.len() == MOST {
        return Err(Error::Limit { what: "open cells", limit: MOST as u64 });
    }
    memory::push(found, cell)
}
