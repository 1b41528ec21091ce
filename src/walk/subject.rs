//! A solid in a search that keeps parts.

use super::split::{Part, split_each, split_one};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::Tag;
use crate::solid::{Batch, Classifier, Parts, Verdict};
use alloc::vec::Vec;

/// A solid in a search: its worker, and a count of its splits.
pub(crate) struct Subject<'s, C: Classifier> {
    pub(crate) classifier: &'s C,
    pub(crate) worker: C::Worker,
    pub(crate) splits: u64,
    control: &'s Control<'s>,
    /// The height of the memory when all parts in it were last in use.
    used: usize,
}

impl<'s, C: Classifier> Subject<'s, C> {
    pub(crate) fn new(classifier: &'s C, control: &'s Control<'s>) -> Result<Self, Error> {
        Ok(Subject { classifier, worker: classifier.worker()?, splits: 0, control, used: 0 })
    }

    /// Returns whether the solid may extend, or extends, beyond the universe.
    pub(crate) fn is_clipped(&self) -> bool {
        self.classifier.exterior() != Tag::Empty
    }

    /// Splits a cell.
    pub(crate) fn split(&mut self, cell: Cell, part: &Part<C>) -> Result<[Verdict<Part<C>>; 8], Error> {
        self.splits += 1;
        split_one(&mut self.worker, cell, part, self.control)
    }

    /// Splits several cells. A solid that prefers batches is queried by `threads` threads.
    pub(crate) fn split_many(
        &mut self,
        cells: &[(Cell, Part<C>)],
        threads: usize,
    ) -> Result<Vec<[Verdict<Part<C>>; 8]>, Error> {
        self.splits += cells.len() as u64;
        let threads = if self.worker.likes_many() { threads } else { 1 };
        split_each(self.classifier, &mut self.worker, cells, threads, self.control)
    }

    /// Returns whether most of the memory holds parts that are no longer in use.
    pub(crate) fn is_wasteful(&self) -> bool {
        self.worker.mark() > 4 * self.used + 4096
    }

    /// Returns whether the parts in memory take more than one in `share` of the bytes that the caller allows.
    /// (While memory grows or is handed over there are two copies, and there may be another solid.)
    pub(crate) fn takes(&self, share: u64) -> bool {
        self.control.max_bytes.is_some_and(|limit| self.worker.scratch_bytes() as u64 > limit / share)
    }

    /// Releases the memory of all parts but these.
    pub(crate) fn keep<'k>(
        &mut self,
        verdicts: impl Iterator<Item = &'k mut Verdict<Part<C>>>,
    ) -> Result<(), Error>
    where
        Part<C>: 'k,
    {
        let mut worker = self.classifier.worker()?;
        for verdict in verdicts {
            if let Verdict::Partial(part) = verdict {
                *part = worker.hand_over(&self.worker, part)?;
            }
        }
        self.used = worker.mark();
        self.worker = worker;
        Ok(())
    }
}
