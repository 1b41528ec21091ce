//! How a solid's parts are had again.

use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame};
use crate::solid::{Scratch, Solid, Verdict};
use alloc::vec::Vec;

/// One split on the way.
struct Step<P> {
    /// Height of the scratch memory before it.
    mark: usize,
    verdicts: [Verdict<P>; 8],
}

/// The splits from the universe to one cell, which have its part: to split another cell, those are replayed that do not
/// lie on the way to this one, too.
pub(super) struct Trail<S: Solid> {
    scratch: S::Scratch,
    root: Verdict<S::Part>,
    /// Where the way leads.
    cell: Cell,
    /// `steps[i]` is the split of the ancestor of `cell` at level i; the last may be its own.
    steps: Vec<Step<S::Part>>,
    splits: u64,
}

impl<S: Solid> Trail<S> {
    /// Asks the solid for the universe.
    pub(super) fn new(solid: &S, frame: &Frame) -> Result<Trail<S>, Error> {
        let mut scratch = S::Scratch::default();
        let root = solid.root(&mut scratch, frame)?;
        let mut steps = Vec::new();
        steps.try_reserve_exact(frame.depth().into()).map_err(|_| Error::OutOfMemory)?;
        Ok(Trail { scratch, root, cell: Cell::ROOT, steps, splits: 0 })
    }

    /// The verdict of the universe.
    pub(super) fn root(&self) -> &Verdict<S::Part> {
        &self.root
    }

    /// Splits that the solid was asked for.
    pub(super) fn splits(&self) -> u64 {
        self.splits
    }

    pub(super) fn evaluations(&self) -> u64 {
        self.scratch.evaluations()
    }

    /// The splits at hand that lie on the way to `cell`, which ends with its own.
    pub(super) fn at_hand(&self, cell: Cell) -> usize {
        let level = cell.level.min(self.cell.level);
        let (a, b) = (cell.ancestor(level).at, self.cell.ancestor(level).at);
        let differ = (a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2]);
        // The universe is on every way.
        let shared = level as usize + 1 - (u32::BITS - differ.leading_zeros()) as usize;
        shared.min(self.steps.len())
    }

    /// What the solid says of the children of `cell`'s ancestor at `level`, if [`lead`](Self::lead) came that far.
    pub(super) fn verdicts(&self, level: u8) -> Option<&[Verdict<S::Part>; 8]> {
        self.steps.get(level as usize).map(|step| &step.verdicts)
    }

    /// Leads the way to `cell`, which is above the frame's depth, and splits it. It ends before a cell that the solid
    /// does not split.
    ///
    /// # Errors
    /// The solid's own; the way then ends where they occurred.
    pub(super) fn lead(&mut self, solid: &S, frame: &Frame, cell: Cell) -> Result<(), Error> {
        self.cut(self.at_hand(cell));
        self.cell = cell;
        for level in self.steps.len() as u8..=cell.level {
            let ancestor = cell.ancestor(level);
            let verdict = match self.steps.last() {
                Some(step) => &step.verdicts[ancestor.octant() as usize],
                None => &self.root,
            };
            let Verdict::Partial(part) = verdict else { return Ok(()) };
            let mark = self.scratch.mark();
            match solid.split(&mut self.scratch, &Cube { frame, cell: ancestor }, part) {
                Ok(verdicts) => self.steps.push(Step { mark, verdicts }),
                Err(error) => {
                    self.scratch.release(mark);
                    return Err(error);
                }
            }
            self.splits += 1;
        }
        Ok(())
    }

    /// Forgets all but the first `steps` splits.
    pub(super) fn cut(&mut self, steps: usize) {
        if let Some(step) = self.steps.get(steps) {
            self.scratch.release(step.mark);
            self.steps.truncate(steps);
        }
    }
}
