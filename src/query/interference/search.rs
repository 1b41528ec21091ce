//! The search for an overlap.
//!
//! Both solids are queried about the cells of one frame ([`Joint`]). A cell where one solid is EMPTY, or
//! where the known bounds of both exclude each other, is done. A cell where both are FULL proves an overlap.
//! So does a ball in a cell on the inner sides of all slabs. In any other cell the cut solids are split. A
//! cell of either solid is therefore split at most once, and only where the other solid is present.
//!
//! A proof that nothing overlaps needs all cells, so their order does not matter. A proof of overlap needs a
//! single cell, so the search begins where an overlap is likely: a cut cell with FULL siblings lies deeper in
//! the solid than one with EMPTY siblings.

use super::{Ball, Overlap};
use crate::control::{Control, Job};
use crate::cut;
use crate::error::Error;
use crate::lattice::Each;
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

/// A cell of the intersection of two classifiers.
type OpenOf<A, B> = Open<Part<Joint<A, B>>>;

/// A rank in the queue: the greater number comes first; among equals, the cell met earlier.
type Rank = (u64, Reverse<u64>);

/// The number of cells in one query to a host program's shape. (It does not depend on the threads, and hence
/// neither does the result.)
const GATHERED: usize = 16;

/// The state of the search.
pub(super) struct Search<'s, A: Classifier, B: Classifier> {
    both: Subject<'s, Joint<A, B>>,
    /// The splits of either solid, and the number of splits still allowed.
    splits: [u64; 2],
    left: u64,
    open: Queue<Rank, OpenOf<A, B>>,
    /// Numbers of finest cells: FULL in both, open, and undecidable.
    full: u64,
    waiting: u64,
    undecided: u64,
    witness: Option<(Cell, Ball)>,
    level: u8,
}

/// The result of a search.
pub(super) struct Found {
    pub(super) verdict: Overlap,
    pub(super) witness: Option<(Cell, Ball)>,
    /// In cubic model units.
    pub(super) volume: Interval,
    pub(super) splits: [u64; 2],
    /// The number of splits still allowed.
    pub(super) left: u64,
    /// Which of both solids are PARTIAL in the universe.
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

    /// True if a solid prefers to be queried about several cells at once.
    pub(super) fn likes_many(&self) -> bool {
        self.both.worker.likes_many()
    }

    /// Searches until an overlap is proven, none is possible, or the budget is spent. `threads` threads query
    /// a host program.
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
        // Where both continue outside of the universe, their overlap is unknown.
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

    /// Number of finest cells in a cell.
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
                    // Non-negative doubles have the order of their bits.
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

    /// Records a ball, in half edges from the centre of a cell.
    fn find(&mut self, cell: Cell, (at, radius): ([f64; 3], f64)) {
        if self.witness.is_none() {
            let cube = Cube { frame: self.both.classifier.frame(), cell };
            self.witness = Some((cell, Ball::in_cell(&cube, at, radius)));
        }
    }

    /// Takes the next cell from the queue, if the budget allows its split.
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
        // Where the first solid is EMPTY, the second was not split.
        self.splits[1] -= self.both.worker.spared;
        self.left += self.both.worker.spared;
        self.meet_children(open.cell, children)
    }

    /// Does the same as [`split`](Self::split) for a cell and the next ones. Each solid is queried about all
    /// of its cells at once.
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

    /// Frees the memory of parts that are not in use. Returns `false` if the parts in use take too much of
    /// the allowed bytes.
    fn tidy(&mut self) -> Result<bool, Error> {
        let both = &mut self.both;
        let is_full = both.takes(2);
        if !(is_full || both.is_wasteful()) {
            return Ok(true);
        }
        self.open.change(|all| {
            both.keep(all.iter_mut().map(|open| &mut open.item.verdict))?;
            // Half of the allowance must be free, or the next step would end here again.
            Ok(!(is_full && both.takes(4)))
        })
    }
}

/// Returns the number of splits of either solid that splitting a cell takes.
fn splits<A, B>(open: &Open<crate::solid::joint::JointPart<A, B>>) -> [u64; 2] {
    match &open.verdict {
        Verdict::Partial(part) => part.splits().each(u64::from),
        _ => [0; 2],
    }
}

/// The price of a cell's level in the search for an overlap. Without it the search would never leave a
/// contact. (The product is computed here: the library's powers differ between platforms, and would change
/// the order of the search.)
fn decay(level: u8) -> f64 {
    (0..level).fold(1.0, |product, _| product * 0.8)
}
