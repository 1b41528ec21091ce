//! The search for an overlap.
//!
//! Both solids are asked about the cells of one frame ([`Joint`]). A cell where one of them is EMPTY, or
//! where what is known of both excludes each other, is done; a cell where both are FULL proves an overlap,
//! and so does a ball in a cell on the inner sides of all slabs. Of any other cell the sides that are cut are
//! split: so a cell of either is split once at the most, and only where the other one is.
//!
//! Which cell comes first does not matter to a proof that nothing overlaps, which needs them all. A proof of
//! overlap needs a single one, so the search begins where it is likely: a cut cell with FULL siblings lies
//! deeper in the solid than one with EMPTY ones.

use super::{Ball, Overlap};
use crate::control::{Control, Job};
use crate::cut;
use crate::error::Error;
use crate::lattice::{Cell, Cube, Interval};
use crate::memory;
use crate::octree::stats::volume_of;
use crate::solid::joint::Joint;
use crate::solid::{Ask, Batch, Classifier, OCTANTS, Verdict, Worker};
use crate::walk::Part;
use crate::walk::Queue;
use crate::walk::Subject;
use core::cmp::Reverse;

/// A PARTIAL cell of the intersection.
struct Open<P> {
    cell: Cell,
    verdict: Verdict<P>,
}

/// A cell of what two classifiers have in common.
type OpenOf<A, B> = Open<Part<Joint<A, B>>>;

/// A place in the queue: the greater number comes first; among equals, what was met earlier.
type Rank = (u64, Reverse<u64>);

/// Cells of which a host program's shape is asked at once. (It does not depend on the threads, and so the
/// result does not either.)
const GATHERED: usize = 16;

/// What is under way.
pub(super) struct Search<'s, A: Classifier, B: Classifier> {
    both: Subject<'s, Joint<A, B>>,
    /// Splits of either solid, and those that may still be made.
    splits: [u64; 2],
    left: u64,
    open: Queue<Rank, OpenOf<A, B>>,
    /// In finest cells: what is FULL of both, open, and not to be decided.
    full: u64,
    waiting: u64,
    undecided: u64,
    witness: Option<(Cell, Ball)>,
    level: u8,
}

/// What a search found.
pub(super) struct Found {
    pub(super) verdict: Overlap,
    pub(super) witness: Option<(Cell, Ball)>,
    /// Cubic model units.
    pub(super) volume: Interval,
    pub(super) splits: [u64; 2],
    /// Splits that may still be made.
    pub(super) left: u64,
    /// Which of both are PARTIAL in the universe.
    pub(super) partial: [bool; 2],
    pub(super) level: u8,
}

impl<'s, A: Classifier, B: Classifier> Search<'s, A, B> {
    pub(super) fn new(both: &'s Joint<A, B>, control: &'s Control<'s>) -> Result<Self, Error> {
        Ok(Search {
            both: Subject::new(both, control)?,
            splits: [0; 2],
            left: control.max_splits.unwrap_or(u64::MAX),
            open: Queue::new(),
            full: 0,
            waiting: 0,
            undecided: 0,
            witness: None,
            level: 0,
        })
    }

    /// Whether a solid is better asked about several cells at once.
    pub(super) fn likes_many(&self) -> bool {
        self.both.worker.likes_many()
    }

    /// Searches until an overlap is proven, none is possible, or the budget is spent. `threads` ask a host
    /// program.
    pub(super) fn run(mut self, clipped: bool, threads: usize, job: &Job<'_>) -> Result<Found, Error> {
        job.check()?;
        let root = self.both.worker.root()?;
        let partial = if let Verdict::Partial(part) = &root { part.splits() } else { [false; 2] };
        self.meet(Cell::ROOT, root)?;
        let many = self.likes_many();
        while self.witness.is_none() && self.open.peek().is_some() {
            job.check()?;
            let Some(open) = self.take() else { break };
            if many {
                self.split_many(open, threads)?;
            } else {
                self.split(&open)?;
            }
            if !self.tidy()? {
                break;
            }
        }
        // Where both go on outside of the universe, nobody knows what they do there.
        let undecided = clipped || self.waiting + self.undecided > 0;
        Ok(Found {
            verdict: match self.witness {
                Some(_) => Overlap::Overlapping,
                None if undecided => Overlap::Undecided,
                None => Overlap::Disjoint,
            },
            witness: self.witness,
            volume: volume_of(
                self.both.classifier.frame(),
                self.full,
                self.full + self.waiting + self.undecided,
            ),
            splits: self.splits,
            left: self.left,
            partial,
            level: self.level,
        })
    }

    /// Finest cells in a cell.
    fn cells(&self, cell: Cell) -> u64 {
        1 << (3 * (self.both.classifier.frame().depth() - cell.level))
    }

    /// Takes in a cell.
    fn meet(&mut self, cell: Cell, verdict: Verdict<Part<Joint<A, B>>>) -> Result<(), Error> {
        let cells = self.cells(cell);
        self.level = self.level.max(cell.level);
        match &verdict {
            Verdict::Empty => {}
            Verdict::Full => {
                self.full += cells;
                self.find(cell, ([0.0; 3], 1.0));
            }
            Verdict::Partial(part) => {
                if self.witness.is_none()
                    && let Some(known) = self.both.worker.enclosure(cell, part)?
                    && let Some(ball) = cut::ball(&known)
                {
                    self.find(cell, ball);
                }
                if cell.level < self.both.classifier.frame().depth() {
                    // Doubles that are not negative have the order of their bits.
                    let rank = ((part.likely * decay(cell.level)).to_bits(), Reverse(self.open.met()));
                    self.open.push(rank, Open { cell, verdict })?;
                    self.waiting += cells;
                } else {
                    self.undecided += cells;
                }
            }
            Verdict::Undecided => self.undecided += cells,
        }
        Ok(())
    }

    /// Takes in a ball, in half edges from the centre of a cell.
    fn find(&mut self, cell: Cell, (at, radius): ([f64; 3], f64)) {
        if self.witness.is_none() {
            let cube = Cube { frame: self.both.classifier.frame(), cell };
            self.witness = Some((cell, Ball::in_cell(&cube, at, radius)));
        }
    }

    /// Takes up the cell that comes next, if the budget allows it to be split.
    fn take(&mut self) -> Option<OpenOf<A, B>> {
        let splits = splits(&self.open.peek()?.item);
        self.left = self.left.checked_sub(splits.iter().sum())?;
        (0..2).for_each(|k| self.splits[k] += splits[k]);
        let open = self.open.pop()?;
        self.waiting -= self.cells(open.cell);
        Some(open)
    }

    fn split(&mut self, open: &OpenOf<A, B>) -> Result<(), Error> {
        let Verdict::Partial(part) = &open.verdict else { return Ok(()) };
        self.both.worker.spared = 0;
        let children = self.both.split(open.cell, part)?;
        // Where nothing of the first solid is, the second was not split.
        self.splits[1] -= self.both.worker.spared;
        self.left += self.both.worker.spared;
        self.meet_children(open.cell, children)
    }

    /// As [`split`](Self::split) of a cell and those that come next, each solid being asked about all of its
    /// cells at once.
    fn split_many(&mut self, first: OpenOf<A, B>, threads: usize) -> Result<(), Error> {
        let mut all = memory::with_capacity(GATHERED)?;
        all.push(first);
        while all.len() < GATHERED
            && let Some(open) = self.take()
        {
            all.push(open);
        }
        let mut asked = memory::with_capacity(all.len())?;
        asked.extend(all.iter().filter_map(|open| match &open.verdict {
            Verdict::Partial(part) => Some((open.cell, part.clone())),
            _ => None,
        }));
        let families = self.both.split_many(&asked, threads)?;
        for ((cell, _), children) in asked.into_iter().zip(families) {
            self.meet_children(cell, children)?;
        }
        Ok(())
    }

    /// Takes in the children of a cell.
    fn meet_children(
        &mut self,
        parent: Cell,
        children: [Verdict<Part<Joint<A, B>>>; 8],
    ) -> Result<(), Error> {
        for (k, verdict) in OCTANTS.into_iter().zip(children) {
            self.meet(parent.child(k), verdict)?;
        }
        Ok(())
    }

    /// Gives back memory that only parts hold which are not in use. `false` if those in use take too much of
    /// what is allowed.
    fn tidy(&mut self) -> Result<bool, Error> {
        let both = &mut self.both;
        let is_full = both.takes(2);
        if !(is_full || both.is_wasteful()) {
            return Ok(true);
        }
        self.open.change(|all| {
            both.keep(all.iter_mut().map(|open| &mut open.item.verdict))?;
            // Half of it must be free, or the next step would end here again.
            Ok(!(is_full && both.takes(4)))
        })
    }
}

/// How many splits of either solid it takes to split a cell.
fn splits<A, B>(open: &Open<crate::solid::joint::JointPart<A, B>>) -> [u64; 2] {
    match &open.verdict {
        Verdict::Partial(part) => part.splits().map(u64::from),
        _ => [0; 2],
    }
}

/// What a cell's level costs in the search for an overlap: without it the search would never come back from a
/// contact. (A product of its own: the library's powers differ between platforms, and the order of the search
/// with them.)
fn decay(level: u8) -> f64 {
    (0..level).fold(1.0, |product, _| product * 0.8)
}
