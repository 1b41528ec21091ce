//! The search for an overlap.
//!
//! Both solids are asked about the cells of one frame. A cell where one of them is EMPTY is done, a cell
//! where both are FULL proves an overlap, and of any other the sides that are cut are split: so a cell of
//! either is split once at the most, and only where the other one is.
//!
//! Which cell comes first does not matter to a proof that nothing overlaps, which needs them all. A proof of
//! overlap needs a single one, so the search begins where it is likely: a cut cell with FULL siblings lies
//! deeper in the solid than one with EMPTY ones. For the volume of the overlap the largest cells come first.

use super::children::{Children, split, split_many};
use super::{Interference, Overlap};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Interval};
use crate::memory;
use crate::octree::stats::volume_of;
use crate::solid::{Batch, Classifier, Verdict, Worker};
use crate::walk::Part;
use crate::walk::Queue;
use crate::walk::Subject;
use core::cmp::Reverse;

/// A cell in which neither solid is EMPTY and one can be split.
struct Pair<P, Q> {
    cell: Cell,
    a: Verdict<P>,
    b: Verdict<Q>,
}

/// Pairs of the cells of two classifiers.
type PairOf<A, B> = Pair<Part<A>, Part<B>>;

impl<P, Q> Pair<P, Q> {
    /// How many splits it takes to split it.
    fn splits(&self) -> u64 {
        matches!(self.a, Verdict::Partial(_)) as u64 + matches!(self.b, Verdict::Partial(_)) as u64
    }
}

/// A place in the queue: the greater number comes first; among equals, what was met earlier.
type Rank = (u64, Reverse<u64>);

/// Pairs of which a host program's shape is asked at once. (It does not depend on the threads, and so the
/// result does not either.)
const GATHERED: usize = 16;

/// What is under way.
pub(super) struct Search<'s, A: Classifier, B: Classifier> {
    a: Subject<'s, A>,
    b: Subject<'s, B>,
    /// Splits that may still be made.
    left: u64,
    open: Queue<Rank, PairOf<A, B>>,
    /// In finest cells: what is FULL of both, open, and not to be decided.
    full: u64,
    waiting: u64,
    undecided: u64,
    witness: Option<Cell>,
    level: u8,
}

impl<'s, A: Classifier, B: Classifier> Search<'s, A, B> {
    pub(super) fn new(a: &'s A, b: &'s B, control: &'s Control<'s>) -> Result<Self, Error> {
        Ok(Search {
            a: Subject::new(a, control)?,
            b: Subject::new(b, control)?,
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
        self.a.worker.likes_many() || self.b.worker.likes_many()
    }

    /// Searches until the volume is known that well, or the budget is spent. `threads` ask a host program.
    pub(super) fn run(
        mut self,
        tolerance: f64,
        threads: usize,
        job: &Job<'_>,
    ) -> Result<Interference, Error> {
        job.check()?;
        let a = self.a.worker.root()?;
        if !matches!(a, Verdict::Empty) {
            let b = self.b.worker.root()?;
            self.meet(Cell::ROOT, a, b, 1.0)?;
        }
        let many = self.likes_many();
        let mut searching = true;
        while self.open.peek().is_some() {
            job.check()?;
            if searching && self.witness.is_some() {
                searching = false;
                if tolerance < f64::INFINITY {
                    self.open.change(|pairs| {
                        pairs.iter_mut().for_each(|pair| pair.key.0 = size(pair.item.cell.level).to_bits());
                    });
                }
            }
            if !searching && self.volume().width() <= tolerance {
                break;
            }
            let Some(pair) = self.take() else { break };
            if many {
                self.split_many(pair, searching, threads)?;
            } else {
                self.split(&pair, searching)?;
            }
            if !self.tidy()? {
                break;
            }
        }
        Ok(self.found())
    }

    fn found(self) -> Interference {
        // Where both go on outside of the universe, nobody knows what they do there.
        let clipped = self.a.is_clipped() && self.b.is_clipped();
        let undecided = clipped || self.waiting + self.undecided > 0;
        let volume = self.volume();
        Interference {
            verdict: match self.witness {
                Some(_) => Overlap::Overlapping,
                None if undecided => Overlap::Undecided,
                None => Overlap::Disjoint,
            },
            witness: self.witness,
            volume: if clipped { Interval::between(volume.lower, f64::INFINITY) } else { volume },
            splits: [self.a.splits, self.b.splits],
            level: self.level,
            proofs: [self.a.classifier.proof(), self.b.classifier.proof()],
            clipped,
        }
    }

    fn volume(&self) -> Interval {
        volume_of(self.a.classifier.frame(), self.full, self.full + self.waiting + self.undecided)
    }

    /// Finest cells in a cell.
    fn cells(&self, cell: Cell) -> u64 {
        1 << (3 * (self.a.classifier.frame().depth() - cell.level))
    }

    /// Takes in a cell.
    fn meet(&mut self, cell: Cell, a: Verdict<Part<A>>, b: Verdict<Part<B>>, rank: f64) -> Result<(), Error> {
        let cells = self.cells(cell);
        match (&a, &b) {
            (Verdict::Empty, _) | (_, Verdict::Empty) => return Ok(()),
            (Verdict::Full, Verdict::Full) => {
                self.full += cells;
                self.witness.get_or_insert(cell);
            }
            (Verdict::Partial(_), _) | (_, Verdict::Partial(_))
                if cell.level < self.a.classifier.frame().depth() =>
            {
                // Doubles that are not negative have the order of their bits.
                let rank = (rank.to_bits(), Reverse(self.open.met()));
                self.open.push(rank, Pair { cell, a, b })?;
                self.waiting += cells;
            }
            _ => self.undecided += cells,
        }
        self.level = self.level.max(cell.level);
        Ok(())
    }

    /// Takes up the pair that comes next, if the budget allows it to be split.
    fn take(&mut self) -> Option<PairOf<A, B>> {
        self.left = self.left.checked_sub(self.open.peek()?.item.splits())?;
        let pair = self.open.pop()?;
        self.waiting -= self.cells(pair.cell);
        Some(pair)
    }

    fn split(&mut self, pair: &PairOf<A, B>, searching: bool) -> Result<(), Error> {
        let of_a = split(&mut self.a, pair.cell, &pair.a)?;
        if self.is_done(pair, &of_a) {
            return Ok(());
        }
        let of_b = split(&mut self.b, pair.cell, &pair.b)?;
        self.meet_children(pair.cell, of_a, of_b, searching)
    }

    /// As [`split`](Self::split) of a pair and those that come next, each solid being asked about all of its
    /// cells at once.
    fn split_many(&mut self, first: PairOf<A, B>, searching: bool, threads: usize) -> Result<(), Error> {
        let mut pairs = memory::with_capacity(GATHERED)?;
        pairs.push(first);
        while pairs.len() < GATHERED
            && let Some(pair) = self.take()
        {
            pairs.push(pair);
        }
        let mut of_a = split_many(&mut self.a, pairs.iter().map(|pair| (pair.cell, &pair.a)), threads)?;
        for i in (0..pairs.len()).rev() {
            if self.is_done(&pairs[i], &of_a[i]) {
                pairs.remove(i);
                of_a.remove(i);
            }
        }
        let of_b = split_many(&mut self.b, pairs.iter().map(|pair| (pair.cell, &pair.b)), threads)?;
        for ((pair, of_a), of_b) in pairs.iter().zip(of_a).zip(of_b) {
            self.meet_children(pair.cell, of_a, of_b, searching)?;
        }
        Ok(())
    }

    /// Whether the children in the first solid are EMPTY. Then the second need not be split, and is not.
    fn is_done(&mut self, pair: &PairOf<A, B>, (of_a, _): &Children<Part<A>>) -> bool {
        let is_done = of_a.iter().all(|verdict| matches!(verdict, Verdict::Empty));
        if is_done {
            self.left += matches!(pair.b, Verdict::Partial(_)) as u64;
        }
        is_done
    }

    /// Takes in the children of a cell.
    fn meet_children(
        &mut self,
        parent: Cell,
        (of_a, likely_a): Children<Part<A>>,
        (of_b, likely_b): Children<Part<B>>,
        searching: bool,
    ) -> Result<(), Error> {
        let level = parent.level + 1;
        let by_level = if searching { decay(level) } else { size(level) };
        for (k, (a, b)) in of_a.into_iter().zip(of_b).enumerate() {
            let rank = if searching { likely_a[k] * likely_b[k] * by_level } else { by_level };
            self.meet(parent.child(k as u8), a, b, rank)?;
        }
        Ok(())
    }

    /// Gives back memory that only parts hold which are not in use. `false` if those in use take too much of what is
    /// allowed.
    fn tidy(&mut self) -> Result<bool, Error> {
        let (a, b) = (&mut self.a, &mut self.b);
        let is_full = a.takes(4) || b.takes(4);
        let (tidy_a, tidy_b) = (is_full || a.is_wasteful(), is_full || b.is_wasteful());
        if !(tidy_a || tidy_b) {
            return Ok(true);
        }
        self.open.change(|pairs| {
            if tidy_a {
                a.keep(pairs.iter_mut().map(|pair| &mut pair.item.a))?;
            }
            if tidy_b {
                b.keep(pairs.iter_mut().map(|pair| &mut pair.item.b))?;
            }
            // Half of it must be free, or the next step would end here again.
            Ok(!(is_full && (a.takes(8) || b.takes(8))))
        })
    }
}

/// What a cell's level costs in the search for an overlap: without it the search would never come back from a
/// contact. (A product of its own: the library's powers differ between platforms, and the order of the search
/// with them.)
fn decay(level: u8) -> f64 {
    (0..level).fold(1.0, |product, _| product * 0.8)
}

/// The order of cells by size.
fn size(level: u8) -> f64 {
    (u8::MAX - level) as f64
}
