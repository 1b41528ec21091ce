//! Splitting the largest undecided cells first.
//!
//! Cells of one level are equally large, so this goes level by level, and all cells of a level are kept with
//! their parts for the next: the *front*. Once it is long, memory matters more than splits, and it stays as
//! it is: each pass walks depth first through what lies below it, to a deeper level than the one before, and
//! keeps nothing but the moments of the cells that it ends at.

use super::StopReason;
use super::moments::{Moments, Tally};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::op::gathered::{self, Part};
use crate::query::descent::{Step, descend};
use crate::query::each;
use crate::solid::{Classifier, Verdict, Worker};
use alloc::vec::Vec;
use core::ops::AddAssign;

/// A longer front is not split further, but walked through.
const LONG_FRONT: usize = 1 << 16;

/// Cells of the front that have their scratch memory in common, and that one thread takes on at once.
const CHUNK: usize = 1 << 8;

/// A longer front of a solid that is asked about all of it at once is not split further.
const LONG_GATHERED: usize = 1 << 22;

/// What was found.
pub(super) struct Walked {
    /// About the lattice's origin.
    pub(super) found: Found,
    pub(super) stop_reason: StopReason,
    pub(super) level: u8,
    pub(super) splits: u64,
}

/// Moments of FULL and of undecided cells.
#[derive(Clone, Copy, Default)]
pub(super) struct Found {
    pub(super) full: Moments,
    pub(super) open: Moments,
}

impl AddAssign for Found {
    fn add_assign(&mut self, other: Found) {
        self.full += other.full;
        self.open += other.open;
    }
}

/// Adds up FULL and undecided cells.
struct Tallies {
    full: Tally,
    open: Tally,
}

impl Tallies {
    fn new(frame: &Frame) -> Tallies {
        Tallies { full: Tally::new(frame.depth()), open: Tally::new(frame.depth()) }
    }

    fn finish(self) -> Found {
        Found { full: self.full.finish(), open: self.open.finish() }
    }
}

/// Neighbouring cells of the front, in Morton order, with the worker that has their parts.
struct Chunk<W: Worker> {
    worker: W,
    cells: Vec<(Cell, W::Part)>,
    /// The cells themselves, or what the last whole pass has found below them.
    found: Found,
}

impl<W: Worker> Chunk<W> {
    /// Cells with parts of this worker.
    fn new(worker: W, cells: Vec<(Cell, W::Part)>, frame: &Frame) -> Chunk<W> {
        let mut tallies = Tallies::new(frame);
        cells.iter().for_each(|&(cell, _)| tallies.open.add(cell));
        Chunk { worker, cells, found: tallies.finish() }
    }
}

/// Splits a solid until one of the reasons to end is met.
pub(super) fn walk<C: Classifier>(
    classifier: &C,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Walked, Error> {
    let job = Job::new(control);
    job.check()?;
    // Shallow walks are done faster than threads are made.
    let frame = classifier.frame();
    let likes_many = classifier.worker()?.likes_many();
    control.run(frame.depth() > 5 || likes_many, |parallel| {
        // All of a front is asked at once.
        let (chunk, long) = if likes_many { (usize::MAX, LONG_GATHERED) } else { (CHUNK, LONG_FRONT) };
        Walk { classifier, frame, tolerance, job: &job, chunk, long, parallel }.run()
    })
}

struct Walk<'a, C> {
    classifier: &'a C,
    frame: &'a Frame,
    tolerance: f64,
    job: &'a Job<'a>,
    /// Cells of a chunk, and of a front that is split further.
    chunk: usize,
    long: usize,
    parallel: bool,
}

/// The cells of the front.
type Front<C> = Vec<Chunk<<C as Classifier>::Worker>>;

/// Cells with their parts.
type Cells<C> = Vec<(Cell, Part<C>)>;

impl<C: Classifier> Walk<'_, C> {
    fn run(&self) -> Result<Walked, Error> {
        let budget = self.job.control().max_splits.unwrap_or(u64::MAX);
        let (mut settled, mut front) = self.root()?;
        let (mut level, mut left) = (0, budget);
        // Whether all of the front was split, and whether the last pass ended at cells that can be.
        let (mut whole, mut splittable) = (true, true);
        let mut unreported = WHOLE;
        let stop_reason = loop {
            let found = total(settled, &front);
            let length: usize = front.iter().map(|chunk| chunk.cells.len()).sum();
            if self.is_met(&found) {
                break StopReason::Tolerance;
            }
            if whole && (length == 0 || !splittable) {
                break StopReason::Exhausted;
            }
            if left == 0 {
                break StopReason::Budget;
            }
            let share = unreported / 2;
            unreported -= share;
            if length <= self.long {
                whole = length as u64 <= left;
                let (found, next) = self.split(&mut front, &mut left)?;
                settled += found;
                front = next;
                level += whole as u8;
                self.job.advance(share);
            } else {
                let target = self.target(&found, level);
                match self.deepen(&mut front, target, &mut left, share)? {
                    Some(more) => (splittable, level) = (more, target),
                    None => whole = false,
                }
            }
        };
        self.job.advance(unreported);
        Ok(Walked { found: total(settled, &front), stop_reason, level, splits: budget - left })
    }

    /// What is settled at once, and the first front.
    fn root(&self) -> Result<(Found, Front<C>), Error> {
        let mut worker = self.classifier.worker()?;
        let mut settled = Tallies::new(self.frame);
        let mut cells = Vec::new();
        match worker.root()? {
            Verdict::Partial(part) => memory::push(&mut cells, (Cell::ROOT, part))?,
            Verdict::Empty => {}
            Verdict::Full => settled.full.add(Cell::ROOT),
            Verdict::Undecided => settled.open.add(Cell::ROOT),
        }
        let front = memory::collected([Chunk::new(worker, cells, self.frame)].into_iter())?;
        Ok((settled.finish(), front))
    }

    fn is_met(&self, found: &Found) -> bool {
        let (full, open) = (found.full.volume as f64, found.open.volume as f64);
        open == 0.0 || open <= self.tolerance * (full + 0.5 * open)
    }

    /// The level for the next pass: where the tolerance will be met if each level halves what is undecided.
    /// Under a budget it is the next one, so that the budget does not end half-way to a deep one.
    fn target(&self, found: &Found, level: u8) -> u8 {
        let mut expected = *found;
        let mut target = level + 1;
        while target < self.frame.depth() && self.job.control().max_splits.is_none() {
            expected.open.volume /= 2;
            expected.full.volume += expected.open.volume / 2;
            if self.is_met(&expected) {
                break;
            }
            target += 1;
        }
        target
    }

    /// Splits the cells of the front, as many as may be: what is settled by it, and the new front.
    fn split(&self, front: &mut [Chunk<C::Worker>], left: &mut u64) -> Result<(Found, Front<C>), Error> {
        let tasks = front.iter_mut().map(|chunk| {
            let count = (*left).min(chunk.cells.len() as u64) as usize;
            *left -= count as u64;
            (chunk, count)
        });
        let mut settled = Found::default();
        let mut next = Vec::new();
        for (found, chunks) in each(self.parallel, tasks, |(chunk, count)| self.split_chunk(chunk, count))? {
            settled += found;
            next.try_reserve(chunks.len())?;
            next.extend(chunks);
        }
        Ok((settled, next))
    }

    /// Splits the first `count` cells of a chunk; the others are settled as undecided.
    fn split_chunk(&self, chunk: &mut Chunk<C::Worker>, count: usize) -> Result<(Found, Front<C>), Error> {
        let mut settled = Tallies::new(self.frame);
        let mut next: Front<C> = Vec::new();
        chunk.cells.iter().skip(count).for_each(|&(cell, _)| settled.open.add(cell));
        let mut verdicts = Vec::new();
        let mut out: Option<(C::Worker, Cells<C>)> = None;
        let many = chunk.worker.likes_many();
        let step = if many { count.max(1) } else { 1 };
        for cells in chunk.cells[..count].chunks(step) {
            self.job.check()?;
            let mark = chunk.worker.mark();
            verdicts.clear();
            if many {
                let threads = if self.parallel { gathered::threads() } else { 1 };
                let control = self.job.control();
                verdicts = gathered::split_each(self.classifier, &mut chunk.worker, cells, threads, control)?;
            } else {
                let (cell, part) = &cells[0];
                verdicts.push(chunk.worker.split(*cell, part)?);
            }
            for ((cell, _), children) in cells.iter().zip(verdicts.drain(..)) {
                for (octant, verdict) in (0..8).zip(children) {
                    let child = cell.child(octant);
                    match verdict {
                        Verdict::Empty => {}
                        Verdict::Full => settled.full.add(child),
                        Verdict::Partial(part) if child.level < self.frame.depth() => {
                            let (worker, cells) = match &mut out {
                                Some(out) => out,
                                none => none.insert((self.classifier.worker()?, Vec::new())),
                            };
                            let part = worker.hand_over(&chunk.worker, &part)?;
                            memory::push(cells, (child, part))?;
                        }
                        Verdict::Undecided | Verdict::Partial(_) => settled.open.add(child),
                    }
                }
                if let Some((worker, cells)) = out.take_if(|(_, cells)| cells.len() >= self.chunk) {
                    memory::push(&mut next, Chunk::new(worker, cells, self.frame))?;
                }
            }
            chunk.worker.release(mark);
        }
        if let Some((worker, cells)) = out {
            memory::push(&mut next, Chunk::new(worker, cells, self.frame))?;
        }
        Ok((settled.finish(), next))
    }

    /// Walks through what lies below the front, to cells of level `target`: whether any of these can be
    /// split. `None` if the budget has ended it. (Under a budget one thread has to do it, as what it leaves
    /// depends on the order.)
    fn deepen(
        &self,
        front: &mut [Chunk<C::Worker>],
        target: u8,
        left: &mut u64,
        share: usize,
    ) -> Result<Option<bool>, Error> {
        let one = share / front.len().max(1);
        self.job.advance(share - one * front.len());
        if self.job.control().max_splits.is_some() {
            let mut splittable = false;
            for chunk in front {
                match self.deepen_chunk(chunk, target, left)? {
                    Some(more) => splittable |= more,
                    None => return Ok(None),
                }
                self.job.advance(one);
            }
            return Ok(Some(splittable));
        }
        let done = each(self.parallel, front.iter_mut(), |chunk| {
            let mut own = u64::MAX;
            let more = self.deepen_chunk(chunk, target, &mut own)?;
            self.job.advance(one);
            Ok((more, u64::MAX - own))
        })?;
        *left -= done.iter().map(|&(_, splits)| splits).sum::<u64>();
        Ok(Some(done.iter().any(|&(more, _)| more == Some(true))))
    }

    /// As [`deepen`](Self::deepen) below one chunk, which stays as it was if the budget ends it.
    fn deepen_chunk(
        &self,
        chunk: &mut Chunk<C::Worker>,
        target: u8,
        left: &mut u64,
    ) -> Result<Option<bool>, Error> {
        let depth = self.frame.depth();
        let mut pass = Pass { depth, target, left, found: Tallies::new(self.frame), splittable: false };
        let mark = chunk.worker.mark();
        for (cell, part) in &chunk.cells {
            let goes_on = pass.may_split()
                && descend(&mut chunk.worker, *cell, part, self.job, &mut |cell, verdict| {
                    pass.step(cell, verdict)
                })?;
            if !goes_on {
                chunk.worker.release(mark);
                return Ok(None);
            }
        }
        chunk.found = pass.found.finish();
        Ok(Some(pass.splittable))
    }
}

/// One walk below a chunk.
struct Pass<'l> {
    depth: u8,
    target: u8,
    /// Splits that may still be made.
    left: &'l mut u64,
    found: Tallies,
    /// Whether a cell at the target can be split.
    splittable: bool,
}

impl Pass<'_> {
    /// Takes one split off those that are left, if there is one.
    #[inline]
    fn may_split(&mut self) -> bool {
        let may = *self.left > 0;
        *self.left -= may as u64;
        may
    }

    fn step<P>(&mut self, cell: Cell, verdict: Verdict<P>) -> Step<P> {
        match verdict {
            Verdict::Empty => {}
            Verdict::Full => self.found.full.add(cell),
            Verdict::Undecided => self.found.open.add(cell),
            Verdict::Partial(part) if cell.level < self.target => {
                return if self.may_split() { Step::Into(part) } else { Step::End };
            }
            Verdict::Partial(_) => {
                self.splittable |= cell.level < self.depth;
                self.found.open.add(cell);
            }
        }
        Step::Past
    }
}

fn total<W: Worker>(settled: Found, front: &[Chunk<W>]) -> Found {
    let mut total = settled;
    front.iter().for_each(|chunk| total += chunk.found);
    total
}
