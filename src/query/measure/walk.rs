//! Splitting those cells of which most is in doubt.
//!
//! The *doubt* of an undecided cell is a bound of the volume that may or may not belong to the solid: the cell, or
//! what its enclosure leaves open. Work goes in passes. Each has a *threshold*, a share of the universe's volume, and
//! splits all cells whose doubt is greater; the next one has a lower threshold. Cells whose doubt is not greater are
//! *leaves*: they contribute the moments of the sets between which the solid lies there.
//!
//! At first all open cells are kept with their parts: the *front*. Once it is long, memory matters more than splits,
//! and it stays as it is: each pass walks depth first through what lies below it and keeps nothing but moments.

use super::moments::{Moments, Tally};
use super::{StopReason, Tolerance};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, CellMoments, Frame};
use crate::memory;
use crate::op::gathered::{self, Part};
use crate::op::split_one;
use crate::query::each;
use crate::solid::{Classifier, Enclosure, Verdict, Worker, cut};
use alloc::vec::Vec;
use core::ops::AddAssign;
use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A longer front is not split further, but walked through.
const LONG_FRONT: usize = 1 << 13;

/// Cells of the front that have their scratch memory in common, and that one thread takes on at once.
const CHUNK: usize = 1 << 7;

/// A longer front of a solid that is asked about all of it at once is not split further.
const LONG_GATHERED: usize = 1 << 22;

/// Less doubt than that, as a share of the cell, is rounding: splitting does not lessen it.
const ROUNDING: f64 = 1e-12;

/// Splits after which a walk below one chunk looks whether all of them have spent the budget.
const BATCH: u64 = 1 << 10;

/// What was found.
pub(super) struct Walked {
    /// About the lattice's origin.
    pub(super) found: Found,
    pub(super) stop_reason: StopReason,
    pub(super) level: u8,
    pub(super) splits: u64,
}

/// Moments of what is proven inside, and of what is open.
#[derive(Clone, Copy, Default)]
pub(super) struct Found {
    pub(super) full: Moments,
    pub(super) open: Moments,
}

impl Found {
    /// The volume in doubt.
    fn doubt(&self) -> i128 {
        self.open.volume + self.open.error + 2 * self.full.error
    }
}

impl AddAssign for Found {
    fn add_assign(&mut self, other: Found) {
        self.full += other.full;
        self.open += other.open;
    }
}

/// What is known of an open cell.
enum Known {
    Nothing,
    Slabs(Enclosure),
    Moments(CellMoments),
}

impl Known {
    fn of<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part) -> Result<Known, Error> {
        if let Some(moments) = worker.moments(cell, part)? {
            return Ok(Known::Moments(moments));
        }
        Ok(worker.enclosure(cell, part)?.map_or(Known::Nothing, Known::Slabs))
    }

    /// As a share of the cell.
    fn doubt(&self) -> f64 {
        match self {
            Known::Nothing => 1.0,
            Known::Slabs(enclosure) => cut::doubt(enclosure) / 8.0,
            Known::Moments(moments) => (2.0 * moments.error / 8.0).min(1.0),
        }
    }
}

/// Adds up cells.
struct Tallies {
    full: Tally,
    open: Tally,
    /// Of cells whose moments are known.
    known: Tally,
    /// Of cells that an enclosure cuts: the sets in the solid, and those around it.
    low: Tally,
    high: Tally,
    /// The finest level.
    level: u8,
}

impl Tallies {
    fn new() -> Tallies {
        let [full, open, known, low, high] = [(); 5].map(|()| Tally::new());
        Tallies { full, open, known, low, high, level: 0 }
    }

    fn full(&mut self, cell: Cell) {
        self.level = self.level.max(cell.level);
        self.full.add(cell);
    }

    /// Adds a cell that is not decided.
    fn open(&mut self, cell: Cell, known: &Known) {
        self.level = self.level.max(cell.level);
        match known {
            Known::Nothing => self.open.add(cell),
            Known::Slabs(enclosure) => {
                let (low, high) = cut::bounds(enclosure);
                self.low.add_cut(cell, &low);
                self.high.add_cut(cell, &high);
            }
            Known::Moments(moments) => self.known.add_known(cell, moments),
        }
    }

    fn finish(self) -> Found {
        let low = self.low.finish();
        let full = self.full.finish() + self.known.finish() + low;
        Found { full, open: self.open.finish() + (self.high.finish() - low) }
    }
}

/// An undecided cell that can be split.
struct Open<P> {
    cell: Cell,
    part: P,
    /// As a share of the universe.
    doubt: f64,
}

/// Neighbouring cells of the front, in Morton order, with the worker that has their parts.
struct Chunk<W: Worker> {
    worker: W,
    cells: Vec<Open<W::Part>>,
    /// What the last whole pass has found below them.
    found: Found,
    level: u8,
}

/// The volume of a cell, as a share of the universe.
fn size(level: u8) -> f64 {
    f64::from_bits((1023 - 3 * level as u64) << 52)
}

/// What is known of a cell, and its doubt as a share of the universe: 0 if splitting does not lessen it.
fn weigh<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part) -> Result<(Known, f64), Error> {
    let known = Known::of(worker, cell, part)?;
    let doubt = known.doubt();
    Ok((known, if doubt <= ROUNDING { 0.0 } else { doubt * size(cell.level) }))
}

/// Splits a solid until one of the reasons to end is met.
pub(super) fn walk<C: Classifier>(
    classifier: &C,
    tolerance: Tolerance,
    budget: u64,
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
        Walk { classifier, frame, tolerance, budget, job: &job, chunk, long, parallel }.run()
    })
}

struct Walk<'a, C> {
    classifier: &'a C,
    frame: &'a Frame,
    tolerance: Tolerance,
    budget: u64,
    job: &'a Job<'a>,
    /// Cells of a chunk, and of a front that is split further.
    chunk: usize,
    long: usize,
    parallel: bool,
}

/// The cells of the front.
type Front<C> = Vec<Chunk<<C as Classifier>::Worker>>;

/// A worker with the cells of the next front.
type Next<C> = (<C as Classifier>::Worker, Vec<Open<Part<C>>>);

impl<C: Classifier> Walk<'_, C> {
    fn run(&self) -> Result<Walked, Error> {
        let (mut settled, mut front, mut level) = self.root()?;
        let mut splits = 0;
        let mut unreported = WHOLE;
        // The volume in doubt after the last pass that was evaluated, and its threshold.
        let mut last: Option<(f64, f64)> = None;
        let mut threshold = 1.0;
        let (stop_reason, found) = loop {
            let length: usize = front.iter().map(|chunk| chunk.cells.len()).sum();
            let doubts = || front.iter().flat_map(|chunk| &chunk.cells).map(|open| open.doubt);
            let greatest = doubts().fold(0.0, f64::max);
            if length <= self.long && greatest > 0.0 && !self.may_be_met(&settled, doubts().sum()) {
                threshold = greatest / 8.0;
                let count = doubts().filter(|&doubt| doubt > threshold).count() as u64;
                if splits + count > self.budget {
                    let found = self.evaluate(&settled, &mut front, &mut level)?;
                    break (self.reason(&found), found);
                }
                splits += count;
                let share = unreported / 2;
                unreported -= share;
                let (more, next, deepest) = self.split(&mut front, threshold)?;
                settled += more;
                front = next;
                level = level.max(deepest);
                self.job.advance(share);
                continue;
            }
            // From here on the front stays. What is known at its threshold comes first.
            let mut found = self.evaluate(&settled, &mut front, &mut level)?;
            let mut deepest = greatest;
            let stop_reason = loop {
                if self.is_met(&found) {
                    break StopReason::Tolerance;
                }
                if deepest == 0.0 {
                    break StopReason::Exhausted;
                }
                let before = (found.doubt().max(0) as f64, threshold);
                threshold = self.next_threshold(&found, threshold, last).min(deepest / 2.0);
                last = Some(before);
                let share = unreported / 2;
                unreported -= share;
                let Some((passed, left)) = self.deepen(&mut front, threshold, self.budget - splits, share)?
                else {
                    break StopReason::Budget;
                };
                splits += passed;
                deepest = left;
                level = front.iter().fold(level, |level, chunk| level.max(chunk.level));
                found = total(settled, &front);
            };
            break (stop_reason, found);
        };
        self.job.advance(unreported);
        Ok(Walked { found, stop_reason, level, splits })
    }

    /// Why no more is split where the budget does not allow it.
    fn reason(&self, found: &Found) -> StopReason {
        if self.is_met(found) { StopReason::Tolerance } else { StopReason::Budget }
    }

    /// What is settled at once, the first front, and the finest level.
    fn root(&self) -> Result<(Found, Front<C>, u8), Error> {
        let mut worker = self.classifier.worker()?;
        let mut settled = Tallies::new();
        let mut cells = Vec::new();
        match worker.root()? {
            Verdict::Partial(part) => {
                let (_, doubt) = weigh(&mut worker, Cell::ROOT, &part)?;
                memory::push(&mut cells, Open { cell: Cell::ROOT, part, doubt })?;
            }
            Verdict::Empty => {}
            Verdict::Full => settled.full(Cell::ROOT),
            Verdict::Undecided => settled.open(Cell::ROOT, &Known::Nothing),
        }
        let chunk = Chunk { worker, cells, found: Found::default(), level: 0 };
        Ok((settled.finish(), memory::collected([chunk].into_iter())?, 0))
    }

    fn is_met(&self, found: &Found) -> bool {
        self.is_close(found.full.volume as f64, found.doubt() as f64)
    }

    /// Whether it is worth looking if the tolerance is met: doubts are bounds, and up to some times too great.
    fn may_be_met(&self, settled: &Found, doubts: f64) -> bool {
        let universe = super::moments::UNIVERSE as f64;
        let (full, open) = (settled.full.volume as f64, settled.doubt() as f64);
        self.is_close(full + 0.5 * universe * doubts, open + 0.1 * universe * doubts)
    }

    /// Whether `open` is little enough beside `full`, both in units of moments.
    fn is_close(&self, full: f64, open: f64) -> bool {
        let unit = self.unit();
        open <= 0.0
            || open <= self.tolerance.relative * (full + 0.5 * open)
            || open * unit <= self.tolerance.absolute
    }

    /// The unit of volumes in cubic model units, rounded.
    fn unit(&self) -> f64 {
        let edge = self.frame.edge();
        edge * edge * edge / super::moments::UNIVERSE as f64
    }

    /// The threshold of the next pass: where the tolerance should be met, judged by the pass before.
    fn next_threshold(&self, found: &Found, threshold: f64, last: Option<(f64, f64)>) -> f64 {
        let (full, open) = (found.full.volume.max(0) as f64, found.doubt().max(1) as f64);
        let wanted = (self.tolerance.relative * full).max(self.tolerance.absolute / self.unit());
        // The volume in doubt goes down with a power of the threshold: the third root where cells are in doubt as a
        // whole, the square root where surfaces are curved, and faster at plane ones.
        let power = match last {
            Some((before, at)) if at > threshold && before > open => {
                (libm::log(at / threshold) / libm::log(before / open)).clamp(1.0, 3.0)
            }
            _ => 2.0,
        };
        let wanted = (0.8 * wanted / open).clamp(0.0, 1.0);
        let most = if self.budget < u64::MAX { 1.0 / 64.0 } else { 1.0 / 4096.0 };
        threshold * libm::pow(wanted, power).clamp(most, 1.0 / 4.0)
    }

    /// What the front contributes as it is.
    fn evaluate(
        &self,
        settled: &Found,
        front: &mut [Chunk<C::Worker>],
        level: &mut u8,
    ) -> Result<Found, Error> {
        let levels = each(self.parallel, front.iter_mut(), |chunk| {
            let mut tallies = Tallies::new();
            for open in &chunk.cells {
                let known = Known::of(&mut chunk.worker, open.cell, &open.part)?;
                tallies.open(open.cell, &known);
            }
            chunk.level = tallies.level;
            chunk.found = tallies.finish();
            Ok(chunk.level)
        })?;
        *level = levels.into_iter().fold(*level, u8::max);
        Ok(total(*settled, front))
    }

    /// Splits the cells of the front whose doubt is greater: what is settled by it, the new front, and the finest
    /// level.
    fn split(&self, front: &mut [Chunk<C::Worker>], threshold: f64) -> Result<(Found, Front<C>, u8), Error> {
        let (mut settled, mut next, mut level) = (Found::default(), Vec::new(), 0);
        let tasks = front.iter_mut();
        for (found, chunks, deepest) in
            each(self.parallel, tasks, |chunk| self.split_chunk(chunk, threshold))?
        {
            settled += found;
            level = level.max(deepest);
            next.try_reserve(chunks.len())?;
            next.extend(chunks);
        }
        Ok((settled, next, level))
    }

    fn split_chunk(
        &self,
        chunk: &mut Chunk<C::Worker>,
        threshold: f64,
    ) -> Result<(Found, Front<C>, u8), Error> {
        let mut settled = Tallies::new();
        let mut next: Front<C> = Vec::new();
        let mut out: Option<Next<C>> = None;
        let many = chunk.worker.likes_many();
        let mut gathered = Vec::new().into_iter();
        if many {
            let mut cells = Vec::new();
            for open in chunk.cells.iter().filter(|open| open.doubt > threshold) {
                memory::push(&mut cells, (open.cell, open.part.clone()))?;
            }
            let threads = if self.parallel { gathered::threads() } else { 1 };
            let control = self.job.control();
            let worker = &mut chunk.worker;
            gathered = gathered::split_each(self.classifier, worker, &cells, threads, control)?.into_iter();
        }
        for open in &chunk.cells {
            self.job.check()?;
            if open.doubt <= threshold {
                let (worker, cells) = self.next(&mut out)?;
                let part = worker.hand_over(&chunk.worker, &open.part)?;
                memory::push(cells, Open { cell: open.cell, part, doubt: open.doubt })?;
            } else {
                let mark = chunk.worker.mark();
                let children = match gathered.next() {
                    Some(children) => children,
                    None => chunk.worker.split(open.cell, &open.part)?,
                };
                for (octant, verdict) in (0..8).zip(children) {
                    let child = open.cell.child(octant);
                    match verdict {
                        Verdict::Empty => {}
                        Verdict::Full => settled.full(child),
                        Verdict::Undecided => settled.open(child, &Known::Nothing),
                        Verdict::Partial(part) => {
                            let (known, doubt) = weigh(&mut chunk.worker, child, &part)?;
                            if child.level == self.frame.depth() {
                                settled.open(child, &known);
                                continue;
                            }
                            let (worker, cells) = self.next(&mut out)?;
                            let part = worker.hand_over(&chunk.worker, &part)?;
                            memory::push(cells, Open { cell: child, part, doubt })?;
                        }
                    }
                }
                if !many {
                    chunk.worker.release(mark);
                }
            }
            if let Some(full) = out.take_if(|(_, cells)| cells.len() >= self.chunk) {
                memory::push(&mut next, chunk_of(full))?;
            }
        }
        if let Some(rest) = out {
            memory::push(&mut next, chunk_of(rest))?;
        }
        let level = settled.level;
        Ok((settled.finish(), next, level))
    }

    /// Where the next cell of the front goes.
    fn next<'o>(&self, out: &'o mut Option<Next<C>>) -> Result<&'o mut Next<C>, Error> {
        Ok(match out {
            Some(out) => out,
            none => none.insert((self.classifier.worker()?, Vec::new())),
        })
    }

    /// Walks through what lies below the front, to cells whose doubt is not greater: the number of splits, and the
    /// greatest doubt of a cell that can be split. `None`, and nothing changed, if that takes more splits than are
    /// left.
    fn deepen(
        &self,
        front: &mut [Chunk<C::Worker>],
        threshold: f64,
        left: u64,
        share: usize,
    ) -> Result<Option<(u64, f64)>, Error> {
        let one = share / front.len().max(1);
        self.job.advance(share - one * front.len());
        let spent = AtomicU64::new(0);
        let passes = each(self.parallel, front.iter_mut(), |chunk| {
            let mut pass = Pass {
                depth: self.frame.depth(),
                threshold,
                tallies: Tallies::new(),
                splits: 0,
                deepest: 0.0,
                spent: &spent,
                left,
            };
            let mark = chunk.worker.mark();
            for open in &chunk.cells {
                if open.doubt > threshold {
                    pass.below(&mut chunk.worker, open.cell, &open.part, self.job)?;
                    chunk.worker.release(mark);
                } else {
                    let known = Known::of(&mut chunk.worker, open.cell, &open.part)?;
                    pass.tallies.open(open.cell, &known);
                    pass.deepest = pass.deepest.max(open.doubt);
                }
                if pass.is_over() {
                    break;
                }
            }
            self.job.advance(one);
            spent.fetch_add(pass.splits, Relaxed);
            let level = pass.tallies.level;
            Ok((pass.tallies.finish(), level, pass.deepest))
        })?;
        let spent = spent.into_inner();
        if spent > left {
            return Ok(None);
        }
        let mut greatest: f64 = 0.0;
        for (chunk, (found, level, deepest)) in front.iter_mut().zip(passes) {
            (chunk.found, chunk.level) = (found, level);
            greatest = greatest.max(deepest);
        }
        Ok(Some((spent, greatest)))
    }
}

fn chunk_of<W: Worker>((worker, cells): (W, Vec<Open<W::Part>>)) -> Chunk<W> {
    Chunk { worker, cells, found: Found::default(), level: 0 }
}

/// One walk below a chunk.
struct Pass<'a> {
    depth: u8,
    threshold: f64,
    tallies: Tallies,
    /// Splits that have not been added to those of all.
    splits: u64,
    /// The greatest doubt of a leaf that can be split.
    deepest: f64,
    spent: &'a AtomicU64,
    left: u64,
}

impl Pass<'_> {
    fn is_over(&mut self) -> bool {
        if self.splits >= BATCH {
            self.spent.fetch_add(core::mem::take(&mut self.splits), Relaxed);
        }
        self.spent.load(Relaxed) > self.left
    }

    /// The recursion is as deep as the frame, 20 levels at the most.
    fn below<W: Worker>(
        &mut self,
        worker: &mut W,
        cell: Cell,
        part: &W::Part,
        job: &Job<'_>,
    ) -> Result<(), Error> {
        job.check()?;
        self.splits += 1;
        if self.is_over() {
            return Ok(());
        }
        let mark = worker.mark();
        for (octant, verdict) in (0..8).zip(split_one(worker, cell, part, job.control())?) {
            let child = cell.child(octant);
            match verdict {
                Verdict::Empty => {}
                Verdict::Full => self.tallies.full(child),
                Verdict::Undecided => self.tallies.open(child, &Known::Nothing),
                Verdict::Partial(part) => {
                    let (known, doubt) = weigh(worker, child, &part)?;
                    if child.level == self.depth || doubt <= self.threshold {
                        if child.level < self.depth {
                            self.deepest = self.deepest.max(doubt);
                        }
                        self.tallies.open(child, &known);
                    } else {
                        self.below(worker, child, &part, job)?;
                    }
                }
            }
        }
        worker.release(mark);
        Ok(())
    }
}

fn total<W: Worker>(settled: Found, front: &[Chunk<W>]) -> Found {
    let mut total = settled;
    front.iter().for_each(|chunk| total += chunk.found);
    total
}
