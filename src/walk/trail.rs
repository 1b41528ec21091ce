//! Recomputes parts by replaying splits from the root.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, CellMoments};
use crate::memory;
use crate::solid::{Ask, Crossing, Enclosure, Segment, Verdict, Worker};
use crate::walk::split_one;
use alloc::vec::Vec;

/// One split on the path.
struct Step<P> {
    /// The height of the scratch memory before the split.
    mark: usize,
    verdicts: [Verdict<P>; 8],
}

/// The splits on the path from the universe to one cell, which provide its part. To split another cell, only
/// the splits that the two paths do not share are replayed.
pub(crate) struct Trail<W: Worker> {
    worker: W,
    root: Verdict<W::Part>,
    /// The cell at the end of the path.
    cell: Cell,
    /// `steps[i]` is the split of the ancestor of `cell` at level i; the last may be its own.
    steps: Vec<Step<W::Part>>,
    /// The split of `cell` itself, if its part was recalled without the path.
    own: Option<[Verdict<W::Part>; 8]>,
    splits: u64,
}

impl<W: Worker> Trail<W> {
    /// Starts a trail at the universe.
    pub(crate) fn new(mut worker: W) -> Result<Trail<W>, Error> {
        let root = worker.root()?;
        let steps = memory::with_capacity(worker.frame().depth().into())?;
        Ok(Trail { worker, root, cell: Cell::ROOT, steps, own: None, splits: 0 })
    }

    /// Returns whether cells are better split in batches, each without the path to it.
    pub(crate) fn likes_many(&mut self) -> bool {
        let mark = self.worker.mark();
        let alone = self.worker.likes_many() && self.worker.recall(Cell::ROOT).is_some();
        self.worker.release(mark);
        alone
    }

    /// The worker, for cells that are split without the path to them, and the count of splits.
    pub(crate) fn worker(&mut self) -> (&mut W, &mut u64) {
        (&mut self.worker, &mut self.splits)
    }

    /// The verdict on the universe.
    pub(crate) fn root(&self) -> &Verdict<W::Part> {
        &self.root
    }

    /// The number of splits so far.
    pub(crate) fn splits(&self) -> u64 {
        self.splits
    }

    /// The number of kept splits that lie on the path to `cell`, its own included.
    pub(crate) fn at_hand(&self, cell: Cell) -> usize {
        let level = cell.level.min(self.cell.level);
        let (a, b) = (cell.ancestor(level).at, self.cell.ancestor(level).at);
        let differ = (a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2]);
        // The universe is on every path.
        let shared = level as usize + 1 - (u32::BITS - differ.leading_zeros()) as usize;
        shared.min(self.steps.len())
    }

    /// The verdicts on the children of `cell`'s ancestor at `level`, if [`lead`](Self::lead) came that far.
    pub(crate) fn verdicts(&self, level: u8) -> Option<&[Verdict<W::Part>; 8]> {
        match &self.own {
            Some(own) => (level == self.cell.level).then_some(own),
            None => self.steps.get(level as usize).map(|step| &step.verdicts),
        }
    }

    /// Follows the path to `cell`, which is above the frame's depth, and splits the cell. The path ends
    /// before a cell that the solid does not split.
    ///
    /// # Errors
    /// Those of the solid; the path then ends where the error occurred.
    pub(crate) fn lead(&mut self, cell: Cell, control: &Control<'_>) -> Result<(), Error> {
        let mark = self.worker.mark();
        if let Some(part) = self.worker.recall(cell) {
            self.own = None;
            let verdicts = split_one(&mut self.worker, cell, &part, control);
            self.worker.release(mark);
            // The kept steps do not lead to this cell.
            self.cut(0);
            (self.own, self.cell) = (Some(verdicts?), cell);
            self.splits += 1;
            return Ok(());
        }
        self.follow(cell, control)
    }

    /// As [`lead`](Self::lead), with all splits on the path even if the part could be recalled without them.
    pub(crate) fn follow(&mut self, cell: Cell, control: &Control<'_>) -> Result<(), Error> {
        self.cut(self.at_hand(cell));
        (self.own, self.cell) = (None, cell);
        while self.steps.len() <= cell.level.into() {
            let ancestor = cell.ancestor(self.steps.len() as u8);
            let Verdict::Partial(part) = verdict_at(&self.steps, &self.root, ancestor) else { break };
            let mark = self.worker.mark();
            match split_one(&mut self.worker, ancestor, part, control) {
                Ok(verdicts) => self.steps.push(Step { mark, verdicts }),
                Err(error) => {
                    self.worker.release(mark);
                    return Err(error);
                }
            }
            self.splits += 1;
        }
        Ok(())
    }

    /// The verdict on `cell`, to whose parent the path leads, or on the ancestor that the path ends before.
    pub(crate) fn verdict(&self, cell: Cell) -> &Verdict<W::Part> {
        verdict_at(&self.steps, &self.root, cell.ancestor(self.steps.len() as u8))
    }

    #[cfg(feature = "render")]
    /// The level of the cell where a path to a parent ends: one below the parent, or the level of an ancestor
    /// that the solid does not split.
    pub(crate) fn level(&self) -> u8 {
        self.steps.len() as u8
    }

    /// The enclosure of the boundary in `cell`, to whose parent the path leads.
    ///
    /// # Errors
    /// Those of the solid.
    pub(crate) fn enclosure(&mut self, cell: Cell) -> Result<Option<Enclosure>, Error> {
        self.ask(cell, |worker, part| worker.enclosure(cell, part))
    }

    /// The moments of the solid in `cell`, to whose parent the path leads.
    ///
    /// # Errors
    /// Those of the solid.
    pub(crate) fn moments(&mut self, cell: Cell) -> Result<Option<CellMoments>, Error> {
        self.ask(cell, |worker, part| worker.moments(cell, part))
    }

    /// The crossing of a segment in `cell`, to whose parent the path leads, with the boundary, if the solid
    /// can find it.
    ///
    /// # Errors
    /// Those of the solid.
    pub(crate) fn crossing(&mut self, cell: Cell, segment: &Segment) -> Result<Option<Crossing>, Error> {
        self.ask(cell, |worker, part| worker.crossing(cell, part, segment))
    }

    /// Returns whether the centre of a finest `cell`, to whose parent the path leads, lies inside, if the
    /// solid can decide.
    ///
    /// # Errors
    /// Those of the solid.
    pub(crate) fn sample(&mut self, cell: Cell) -> Result<Option<bool>, Error> {
        self.ask(cell, |worker, part| worker.sample(cell, part))
    }

    /// Asks about a cell to whose parent the path leads, if the cell has a part.
    fn ask<R>(
        &mut self,
        cell: Cell,
        question: impl FnOnce(&mut W, &W::Part) -> Result<Option<R>, Error>,
    ) -> Result<Option<R>, Error> {
        if self.steps.len() != usize::from(cell.level) {
            return Ok(None);
        }
        let Verdict::Partial(part) = verdict_at(&self.steps, &self.root, cell) else { return Ok(None) };
        let mark = self.worker.mark();
        let answer = question(&mut self.worker, part);
        self.worker.release(mark);
        answer
    }

    /// Drops all but the first `steps` splits.
    pub(crate) fn cut(&mut self, steps: usize) {
        if let Some(step) = self.steps.get(steps) {
            self.worker.release(step.mark);
            self.steps.truncate(steps);
        }
    }
}

/// The verdict on `cell` by the last of the steps.
fn verdict_at<'s, P>(steps: &'s [Step<P>], root: &'s Verdict<P>, cell: Cell) -> &'s Verdict<P> {
    steps.last().map_or(root, |step| &step.verdicts[cell.octant() as usize])
}
