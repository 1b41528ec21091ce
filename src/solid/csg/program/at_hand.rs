//! Answers of other solids to queries that were asked together.

use crate::solid::ErasedPart;
use crate::solid::Verdict;
use alloc::vec::{IntoIter, Vec};

/// The answers of the other solids at hand: one queue for each solid, and no queues outside a batch.
#[derive(Default)]
pub(crate) struct AtHand {
    pub(super) splits: Vec<Splits>,
    pub(super) samples: Vec<IntoIter<Option<bool>>>,
}

/// The splits of one solid, in the order in which they will be used.
#[derive(Default)]
pub(super) struct Splits {
    /// The height of the solid's scratch memory before all these splits.
    pub(super) height: usize,
    pub(super) verdicts: IntoIter<[Verdict<ErasedPart>; 8]>,
}

impl AtHand {
    /// Takes the next split of a solid, and the height of its scratch memory before.
    pub(crate) fn split(&mut self, solid: u32) -> Option<(usize, [Verdict<ErasedPart>; 8])> {
        let splits = self.splits.get_mut(solid as usize)?;
        Some((splits.height, splits.verdicts.next()?))
    }

    /// Takes the next sample of a solid.
    pub(crate) fn sample(&mut self, solid: u32) -> Option<Option<bool>> {
        self.samples.get_mut(solid as usize)?.next()
    }
}
