//! Answers of other solids to questions that were asked together.

use crate::solid::Verdict;
use crate::solid::erased::ErasedPart;
use alloc::vec::{IntoIter, Vec};

/// Answers of the other solids that are at hand, one queue for each solid; none while no batch is under way.
#[derive(Default)]
pub(crate) struct AtHand {
    pub(super) splits: Vec<Splits>,
    pub(super) samples: Vec<IntoIter<Option<bool>>>,
}

/// Splits of one solid in the order in which they will be asked for.
#[derive(Default)]
pub(super) struct Splits {
    /// Height of the solid's scratch memory before all of them.
    pub(super) height: usize,
    pub(super) verdicts: IntoIter<[Verdict<ErasedPart>; 8]>,
}

impl AtHand {
    /// The next split of a solid that is at hand, and the height of its scratch memory before.
    pub(crate) fn split(&mut self, solid: u32) -> Option<(usize, [Verdict<ErasedPart>; 8])> {
        let splits = self.splits.get_mut(solid as usize)?;
        Some((splits.height, splits.verdicts.next()?))
    }

    /// The next sample of a solid that is at hand.
    pub(crate) fn sample(&mut self, solid: u32) -> Option<Option<bool>> {
        self.samples.get_mut(solid as usize)?.next()
    }
}
