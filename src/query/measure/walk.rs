//! A walk that splits the cells with the greatest doubt.
//!
//! The *doubt* of an undecided cell bounds the possible difference of the measured quantity in that cell: for
//! a volume all of the cell, or the part that its enclosure leaves open. The work is done in passes. Each
//! pass has a *threshold*, and splits all cells whose doubt is greater; the next pass has a lower threshold.
//! Cells with at most this doubt are *leaves*: they contribute their known bounds.
//!
//! At first all open cells are kept with their parts: the *front*. Once the front is long, memory matters
//! more than splits, and the front stays as it is. Each pass then walks depth first through the cells below
//! it and keeps only sums.

use super::quantity::{Found, Quantity};
use super::{StopReason, Tolerance};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::parallel::{self, each};
use crate::solid::{Batch, Classifier, Parts, Verdict, Worker};
use crate::walk;
use crate::walk::Part;
use crate::walk::split_one;
use alloc::vec::Vec;
use core::marker::PhantomData;
use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// The greatest length of a front that is split further. A longer front is walked through.
const LONG_FRONT: usize = 1 << 13;

/// The greatest size, in bytes, of a front that is split further: splitting it once more leaves eight times
/// as many parts.
const LARGE_FRONT: usize = 1 << 26;

/// The number of cells of the front that share scratch memory, and that form one thread's task.
const CHUNK: usize = 1 << 7;

/// The greatest length of a front that is split further, for a solid that is queried about all of the front
/// at once.
const LONG_GATHERED: usize = 1 << 22;

/// A doubt, as a share of the cell, that is due to rounding: splitting does not reduce it.
const ROUNDING: f64 = 1e-12;

/// The number of splits after which a walk below one chunk checks whether all walks together have spent the
/// budget.
const BATCH: u64 = 1 << 10;

/// The result of a walk.
pub(super) struct Walked<F> {
    pub(super) found: F,
    pub(super) stop_reason: StopReason,
    pub(super) level: u8,
    pub(super) splits: u64,
}

/// Cells that are not split: their contributions, and their finest level.
struct Leaves<Q> {
    sum: Q,
    level: u8,
}

impl<Q: Quantity> Leaves<Q> {
    fn new() -> Leaves<Q> {
        Leaves { sum: Q::new(), level: 0 }
    }

    fn full(&mut self, cell: Cell) {
        self.level = self.level.max(cell.level);
        self.sum.full(cell);
    }

    fn open(&mut self, cell: Cell, known: &Q::Known) {
        self.level = self.level.max(cell.level);
        self.sum.open(cell, known);
    }
}

/// An undecided cell that can be split.
struct Open<P> {
    cell: Cell,
    part: P,
    /// The doubt, as a share of the universe.
    doubt: f64,
}

/// Neighbouring cells of the front, in Morton order, with the worker that holds their parts.
struct Chunk<W: Worker, F> {
    worker: W,
    cells: Vec<Open<W::Part>>,
    /// The result of the last complete pass below the cells.
    found: F,
    level: u8,
}

/// Returns the knowledge about a cell, and its doubt as a share of the universe: 0 if splitting does not
/// reduce it.
fn weigh<Q: Quantity, W: Worker>(
    worker: &mut W,
    cell: Cell,
    part: &W::Part,
) -> Result<(Q::Known, f64), Error> {
    let known = Q::known(worker, cell, part)?;
    let doubt = Q::doubt(&known);
    let size = f64::from_bits((1023 - (Q::DIMENSION * cell.level) as u64) << 52);
    Ok((known, if doubt <= ROUNDING { 0.0 } else { doubt * size }))
}

/// Splits a solid until one of the stop reasons is met.
pub(super) fn walk<Q: Quantity, C: Classifier>(
    classifier: &C,
    tolerance: Tolerance,
    budget: u64,
    control: &Control<'_>,
) -> Result<Walked<Q::Found>, Error> {
    walk_in::<Q, C>(classifier, Cell::ROOT, tolerance, budget, control)
}

/// Does the same for the part of the solid in a cell of the frame.
pub(super) fn walk_in<Q: Quantity, C: Classifier>(
    classifier: &C,
    within: Cell,
    tolerance: Tolerance,
    budget: u64,
    control: &Control<'_>,
) -> Result<Walked<Q::Found>, Error> {
    let job = Job::new(control);
    job.check()?;
    // Shallow walks take less time than starting threads.
    let frame = classifier.frame();
    let likes_many = classifier.worker()?.likes_many();
    control.run(frame.depth() > 5 || likes_many, |parallel| {
        // All of a front is queried at once.
        let (chunk, long) = if likes_many { (usize::MAX, LONG_GATHERED) } else { (CHUNK, LONG_FRONT) };
        let quantity = PhantomData::<Q>;
        // (While a front is split, two fronts exist.)
        let large = control.max_bytes.map_or(LARGE_FRONT, |limit| LARGE_FRONT.min((limit / 4) as usize));
        let job = &job;
        Walk { quantity, classifier, frame, within, tolerance, budget, job, chunk, long, large, parallel }
            .run()
    })
}

struct Walk<'a, Q, C> {
    quantity: PhantomData<Q>,
    classifier: &'a C,
    frame: &'a Frame,
    /// The measured cell.
    within: Cell,
    tolerance: Tolerance,
    budget: u64,
    job: &'a Job<'a>,
    /// The maximal number of cells of a chunk, and of a front that is split further.
    chunk: usize,
    long: usize,
    /// The maximal number of bytes of a front that is split further.
    large: usize,
    parallel: bool,
}

/// The cells of the front.
type Front<Q, C> = Vec<ChunkOf<Q, C>>;

type ChunkOf<Q, C> = Chunk<<C as Classifier>::Worker, <Q as Quantity>::Found>;

/// The settled sum, the open cells, and the finest level.
type Step<Q, C> = (<Q as Quantity>::Found, Front<Q, C>, u8);

/// A worker with the cells of the next front.
type Next<C> = (<C as Classifier>::Worker, Vec<Open<Part<C>>>);

impl<Q: Quantity, C: Classifier> Walk<'_, Q, C> {
    fn run(&self) -> Result<Walked<Q::Found>, Error> {
        let (mut settled, mut front, mut level) = self.root()?;
        let mut splits = 0;
        let mut unreported = WHOLE;
        // The doubt after the last evaluated pass, and its threshold.
        let mut last: Option<(f64, f64)> = None;
        let mut threshold = 1.0;
        let (stop_reason, found) = loop {
            let length: usize = front.iter().map(|chunk| chunk.cells.len()).sum();
            let doubts = || front.iter().flat_map(|chunk| &chunk.cells).map(|open| open.doubt);
            let greatest = doubts().fold(0.0, f64::max);
            let bytes: usize = front.iter().map(|chunk| chunk.worker.scratch_bytes()).sum();
            let is_short = length <= self.long && bytes <= self.large;
            if is_short && greatest > 0.0 && !self.may_be_met(&settled, doubts().sum()) {
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
            // From here on the front stays. Evaluate it at its own threshold first.
            let mut found = self.evaluate(&settled, &mut front, &mut level)?;
            let mut deepest = greatest;
            let stop_reason = loop {
                if self.is_met(&found) {
                    break StopReason::Tolerance;
                }
                if deepest == 0.0 {
                    break StopReason::Exhausted;
                }
                let before = (found.doubt().max(0.0), threshold);
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

    /// Returns why the walk ends where the budget does not allow more splits.
    fn reason(&self, found: &Q::Found) -> StopReason {
        if self.is_met(found) { StopReason::Tolerance } else { StopReason::Budget }
    }

    /// Returns the sum settled at once, the first front, and the finest level.
    fn root(&self) -> Result<Step<Q, C>, Error> {
        let mut worker = self.classifier.worker()?;
        let mut settled = Leaves::<Q>::new();
        let mut cells = Vec::new();
        let mut verdict = worker.root()?;
        for level in 1..=self.within.level {
            let Verdict::Partial(part) = &verdict else { break };
            let eight = split_one(&mut worker, self.within.ancestor(level - 1), part, self.job.control())?;
            let octant = usize::from(self.within.ancestor(level).octant());
            verdict = eight.into_iter().nth(octant).unwrap_or(Verdict::Undecided);
        }
        let cell = self.within;
        match verdict {
            Verdict::Partial(part) => {
                let (known, doubt) = weigh::<Q, _>(&mut worker, cell, &part)?;
                if cell.level == self.frame.depth() {
                    settled.open(cell, &known);
                } else {
                    memory::push(&mut cells, Open { cell, part, doubt })?;
                }
            }
            Verdict::Empty => {}
            Verdict::Full => settled.full(cell),
            Verdict::Undecided => settled.open(cell, &Q::NOTHING),
        }
        let chunk = Chunk { worker, cells, found: Q::Found::default(), level: 0 };
        Ok((settled.sum.finish(), memory::collected([chunk].into_iter())?, 0))
    }

    fn is_met(&self, found: &Q::Found) -> bool {
        self.is_close(found.least(), found.doubt())
    }

    /// True if the tolerance may be met, so that an evaluation is worthwhile. Doubts are upper bounds, often
    /// several times too great.
    fn may_be_met(&self, settled: &Q::Found, doubts: f64) -> bool {
        let (least, doubt) = (settled.least(), settled.doubt());
        self.is_close(least + 0.5 * Q::UNIVERSE * doubts, doubt + 0.1 * Q::UNIVERSE * doubts)
    }

    /// True if `doubt` is small enough compared with `least`, both in units of the sum. Without an upper
    /// bound the answer is `false`, although the middle is infinite too.
    fn is_close(&self, least: f64, doubt: f64) -> bool {
        doubt <= 0.0
            || doubt < f64::INFINITY && doubt <= self.tolerance.relative * (least + 0.5 * doubt)
            || doubt * self.unit() <= self.tolerance.absolute
    }

    /// Returns the unit of the sum in model units, rounded.
    fn unit(&self) -> f64 {
        let edge = self.frame.edge();
        (1..Q::DIMENSION).fold(edge, |power, _| power * edge) * Q::SIZE / Q::UNIVERSE
    }

    /// Returns the threshold of the next pass, at which the tolerance should be met, extrapolated from the
    /// previous pass.
    fn next_threshold(&self, found: &Q::Found, threshold: f64, last: Option<(f64, f64)>) -> f64 {
        let (least, open) = (found.least().max(0.0), found.doubt().max(1.0));
        let wanted = (self.tolerance.relative * least).max(self.tolerance.absolute / self.unit());
        // The total doubt decreases with a power of the threshold: the third root where whole cells are in
        // doubt, the square root where surfaces are curved, and faster at plane surfaces.
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

    /// Returns the contributions of the present front.
    fn evaluate(
        &self,
        settled: &Q::Found,
        front: &mut [ChunkOf<Q, C>],
        level: &mut u8,
    ) -> Result<Q::Found, Error> {
        let levels = each(self.parallel, front.iter_mut(), |chunk| {
            let mut leaves = Leaves::<Q>::new();
            for open in &chunk.cells {
                let known = Q::known(&mut chunk.worker, open.cell, &open.part)?;
                leaves.open(open.cell, &known);
            }
            chunk.level = leaves.level;
            chunk.found = leaves.sum.finish();
            Ok(chunk.level)
        })?;
        *level = levels.into_iter().fold(*level, u8::max);
        Ok(total(*settled, front))
    }

    /// Splits the cells of the front whose doubt exceeds the threshold. Returns the sum settled by the
    /// splits, the new front, and the finest level.
    fn split(&self, front: &mut [ChunkOf<Q, C>], threshold: f64) -> Result<Step<Q, C>, Error> {
        let (mut settled, mut next, mut level) = (Q::Found::default(), Vec::new(), 0);
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

    fn split_chunk(&self, chunk: &mut ChunkOf<Q, C>, threshold: f64) -> Result<Step<Q, C>, Error> {
        let mut settled = Leaves::<Q>::new();
        let mut next: Front<Q, C> = Vec::new();
        let mut out: Option<Next<C>> = None;
        let many = chunk.worker.likes_many();
        let mut gathered = Vec::new().into_iter();
        if many {
            let mut cells = Vec::new();
            for open in chunk.cells.iter().filter(|open| open.doubt > threshold) {
                memory::push(&mut cells, (open.cell, open.part.clone()))?;
            }
            let threads = if self.parallel { parallel::threads() } else { 1 };
            let control = self.job.control();
            let worker = &mut chunk.worker;
            gathered = walk::split_each(self.classifier, worker, &cells, threads, control)?.into_iter();
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
                        Verdict::Undecided => settled.open(child, &Q::NOTHING),
                        Verdict::Partial(part) => {
                            let (known, doubt) = weigh::<Q, _>(&mut chunk.worker, child, &part)?;
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
        Ok((settled.sum.finish(), next, level))
    }

    /// Returns the place of the front's next cell.
    fn next<'o>(&self, out: &'o mut Option<Next<C>>) -> Result<&'o mut Next<C>, Error> {
        Ok(match out {
            Some(out) => out,
            none => none.insert((self.classifier.worker()?, Vec::new())),
        })
    }

    /// Walks through the cells below the front, down to cells whose doubt does not exceed the threshold.
    /// Returns the number of splits, and the greatest doubt of a cell that can be split. If that takes more
    /// splits than are left, the walk returns `None` and changes nothing.
    fn deepen(
        &self,
        front: &mut [ChunkOf<Q, C>],
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
                leaves: Leaves::<Q>::new(),
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
                    let known = Q::known(&mut chunk.worker, open.cell, &open.part)?;
                    pass.leaves.open(open.cell, &known);
                    pass.deepest = pass.deepest.max(open.doubt);
                }
                if pass.is_over() {
                    break;
                }
            }
            self.job.advance(one);
            spent.fetch_add(pass.splits, Relaxed);
            let level = pass.leaves.level;
            Ok((pass.leaves.sum.finish(), level, pass.deepest))
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

fn chunk_of<W: Worker, F: Default>((worker, cells): (W, Vec<Open<W::Part>>)) -> Chunk<W, F> {
    Chunk { worker, cells, found: F::default(), level: 0 }
}

/// One walk below a chunk.
struct Pass<'a, Q> {
    depth: u8,
    threshold: f64,
    leaves: Leaves<Q>,
    /// The number of splits not yet added to the total.
    splits: u64,
    /// The greatest doubt of a leaf that can be split.
    deepest: f64,
    spent: &'a AtomicU64,
    left: u64,
}

impl<Q: Quantity> Pass<'_, Q> {
    fn is_over(&mut self) -> bool {
        if self.splits >= BATCH {
            self.spent.fetch_add(core::mem::take(&mut self.splits), Relaxed);
        }
        self.spent.load(Relaxed) > self.left
    }

    /// Walks through the cells below a cell. The recursion is as deep as the frame, 20 levels at the most.
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
                Verdict::Full => self.leaves.full(child),
                Verdict::Undecided => self.leaves.open(child, &Q::NOTHING),
                Verdict::Partial(part) => {
                    let (known, doubt) = weigh::<Q, _>(worker, child, &part)?;
                    if child.level == self.depth || doubt <= self.threshold {
                        if child.level < self.depth {
                            self.deepest = self.deepest.max(doubt);
                        }
                        self.leaves.open(child, &known);
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

fn total<W: Worker, F: Found>(settled: F, front: &[Chunk<W, F>]) -> F {
    let mut total = settled;
    front.iter().for_each(|chunk| total += chunk.found);
    total
}
