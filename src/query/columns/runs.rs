//! Runs of solid cells in columns.

use super::{Columns, Shadow, Visitor};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// Consecutive finest cells of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct Run {
    /// The coordinate of the lowest cell along the column.
    pub start: u32,
    /// The number of cells, at least one.
    pub length: u32,
}

/// Runs of cells in columns, as compressed rows. The runs of a column ascend, and no two of them touch.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnRuns {
    offsets: Vec<u64>,
    runs: Vec<Run>,
}

impl ColumnRuns {
    /// Returns the runs of the column with this [index](Columns::index); an empty slice if there is no such
    /// column.
    pub fn column(&self, index: usize) -> &[Run] {
        let end = index.checked_add(1).and_then(|next| self.offsets.get(next));
        match (self.offsets.get(index), end) {
            (Some(&start), Some(&end)) => self.runs.get(start as usize..end as usize).unwrap_or_default(),
            _ => &[],
        }
    }

    /// The index in [`runs`](Self::runs) of each column's first run, followed by the number of all runs.
    pub fn offsets(&self) -> &[u64] {
        &self.offsets
    }

    /// The runs of all columns, column by column.
    pub fn runs(&self) -> &[Run] {
        &self.runs
    }
}

/// The solid cells of columns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnCells {
    /// The cells that are proven to be solid: FULL.
    pub full: ColumnRuns,
    /// The cells that may be solid: FULL and PARTIAL.
    pub upper: ColumnRuns,
}

impl ColumnCells {
    /// Combines the results of blocks of the columns.
    pub(super) fn gathered(columns: &Columns, count: usize, blocks: &[CellLists]) -> Result<Self, Error> {
        Ok(ColumnCells {
            full: gathered(columns, count, blocks, |block| &block.full)?,
            upper: gathered(columns, count, blocks, |block| &block.upper)?,
        })
    }
}

/// The index that stands for no run.
const NONE: usize = usize::MAX;

/// Runs in the order in which they were met, each with a link to the previous run of its column.
struct Lists {
    last: Vec<usize>,
    runs: Vec<(Run, usize)>,
}

impl Lists {
    fn new(count: usize) -> Result<Lists, Error> {
        Ok(Lists { last: memory::filled(count, NONE)?, runs: Vec::new() })
    }

    #[inline]
    fn add(&mut self, column: usize, run: Run) -> Result<(), Error> {
        let last = &mut self.last[column];
        if let Some((before, _)) = self.runs.get_mut(*last)
            && before.start + before.length == run.start
        {
            before.length += run.length;
            return Ok(());
        }
        let place = self.runs.len();
        memory::push(&mut self.runs, (run, *last))?;
        *last = place;
        Ok(())
    }

    /// The runs of a column, from the last to the first.
    fn backwards(&self, column: usize) -> impl Iterator<Item = Run> + '_ {
        let mut next = self.last[column];
        core::iter::from_fn(move || {
            let &(run, before) = self.runs.get(next)?;
            next = before;
            Some(run)
        })
    }
}

/// The solid cells of a block of columns.
pub(super) struct CellLists {
    block: Columns,
    full: Lists,
    upper: Lists,
}

impl CellLists {
    /// Builds empty lists. `count` is the number of the block's columns.
    pub(super) fn new(block: Columns, count: usize) -> Result<CellLists, Error> {
        Ok(CellLists { block, full: Lists::new(count)?, upper: Lists::new(count)? })
    }
}

impl Visitor for CellLists {
    fn meet(&mut self, is_full: bool, shadow: &Shadow) -> Result<(), Error> {
        let run = Run { start: shadow.cells.start, length: shadow.cells.end - shadow.cells.start };
        for column in shadow.places(self.block) {
            self.upper.add(column, run)?;
            if is_full {
                self.full.add(column, run)?;
            }
        }
        Ok(())
    }

    fn skips(&self, _: &Shadow) -> bool {
        false
    }
}

/// Arranges the columns of blocks in the order of the whole: count, sum up, fill.
fn gathered(
    columns: &Columns,
    count: usize,
    blocks: &[CellLists],
    lists: impl Fn(&CellLists) -> &Lists,
) -> Result<ColumnRuns, Error> {
    // For each column of a block, its index in the block's own lists and in the whole.
    let places = |block: &Columns| {
        let (block, size, columns) = (*block, block.size(), *columns);
        (0..size[1]).flat_map(move |v| {
            (0..size[0]).map(move |u| {
                let steps = [u, v];
                let whole = [0, 1].each(|i| block.first[i] - columns.first[i] + steps[i]);
                (block.place(steps), columns.place(whole))
            })
        })
    };
    let mut offsets: Vec<u64> = memory::filled(count.checked_add(1).ok_or(Error::OutOfMemory)?, 0)?;
    for block in blocks {
        for (own, place) in places(&block.block) {
            offsets[place + 1] = lists(block).backwards(own).count() as u64;
        }
    }
    let mut sum = 0;
    for offset in &mut offsets {
        sum += *offset;
        *offset = sum;
    }
    let mut runs = memory::filled(sum as usize, Run { start: 0, length: 0 })?;
    for block in blocks {
        for (own, place) in places(&block.block) {
            let end = offsets[place + 1] as usize;
            for (back, run) in (1..).zip(lists(block).backwards(own)) {
                runs[end - back] = run;
            }
        }
    }
    Ok(ColumnRuns { offsets, runs })
}
