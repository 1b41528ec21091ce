//! The budget of a search.

use super::super::Standing;
use super::super::proof::PAIR_SPLITS;
use crate::control::Control;
use crate::error::Error;
use crate::query::GapVerdict;

/// The spent and the allowed numbers of tests and splits.
pub(super) struct Budget<'b> {
    pub(super) control: Control<'b>,
    pub(super) tests: u64,
    pub(super) max_tests: u64,
    pub(super) splits: u64,
    pub(super) max_splits: u64,
}

impl Budget<'_> {
    pub(super) fn is_spent(&self) -> bool {
        self.tests >= self.max_tests || self.splits >= self.max_splits
    }

    /// Runs the test of a place.
    pub(super) fn tested(
        &mut self,
        test: impl FnOnce(&Control<'_>) -> Result<Standing, Error>,
    ) -> Result<bool, Error> {
        self.tests += 1;
        let left = self.max_splits - self.splits;
        let standing = test(&Control { max_splits: Some(left.min(PAIR_SPLITS)), ..self.control })?;
        self.splits += standing.splits.min(left);
        Ok(standing.verdict == GapVerdict::Yes)
    }
}
