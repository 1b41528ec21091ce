//! Solids whose answers come more cheaply many at a time: asked level by level.
//!
//! A host program's functions take most of the time of whoever asks them, and can be asked about all cells of
//! a level at once, by as many threads as there are. What they say is kept, and the octree is then built from
//! that.

use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::Tag;
use crate::parallel;
use crate::solid::{Classifier, Verdict, Worker};
use alloc::vec::Vec;

/// Levels below a cell that are asked at most before anything is written. (Of a surface some four times as
/// many cells are kept with each.)
pub(super) const LEVELS: u8 = 8;

/// What a solid said of the cells below one cell.
pub(super) struct Gathered {
    frame: Frame,
    splits: Vec<Split>,
    /// Whether the centres of finest cells that are open lie inside, if that was asked.
    centres: Vec<Option<bool>>,
}

/// A cell that was split.
struct Split {
    verdicts: [Verdict<()>; 8],
    /// Of the children that are open: where the first was split, or its centre. The others follow.
    first: u32,
}

/// The parts of a classifier's workers.
pub(crate) type Part<C> = <<C as Classifier>::Worker as Worker>::Part;

impl Gathered {
    /// Splits a cell and all that is open below it; asks for the `centres` of finest cells too.
    pub(super) fn new<C: Classifier>(
        classifier: &C,
        worker: &mut C::Worker,
        (cell, part): (Cell, Part<C>),
        centres: bool,
        job: &Job<'_>,
        threads: usize,
    ) -> Result<Gathered, Error> {
        let frame = *classifier.frame();
        let mut gathered = Gathered { frame, splits: Vec::new(), centres: Vec::new() };
        let mark = worker.mark();
        let mut front = memory::collected([(cell, part)].into_iter())?;
        for level in cell.level..frame.depth() {
            let verdicts = split_each(classifier, worker, &front, threads, job.control())?;
            let finest = level + 1 == frame.depth();
            let mut next = Vec::new();
            gathered.splits.try_reserve(front.len())?;
            // Children are split after all cells of this level, in the same order.
            let below = if finest { 0 } else { gathered.splits.len() + front.len() };
            for ((cell, _), eight) in front.iter().zip(verdicts) {
                let first = u32::try_from(below + next.len()).map_err(|_| Error::OutOfMemory)?;
                next.try_reserve(8)?;
                let verdicts = map_parts(eight, |octant, part| {
                    next.push((cell.child(octant), part));
                    Ok(())
                })?;
                gathered.splits.push(Split { verdicts, first });
            }
            front = next;
            if front.is_empty() {
                break;
            }
        }
        if centres {
            gathered.centres = each(classifier, worker, &front, threads, |worker, cells, inside| {
                worker.sample_many(cells, job.control(), inside)
            })?;
        }
        worker.release(mark);
        Ok(gathered)
    }
}

/// What is asked about many cells, by several threads: the answers in the order of the cells. Parts among the
/// answers are handed over to `worker`.
fn each<C: Classifier, A: Answer<Part<C>>>(
    classifier: &C,
    worker: &mut C::Worker,
    cells: &[(Cell, Part<C>)],
    threads: usize,
    ask: impl Fn(&mut C::Worker, &[(Cell, Part<C>)], &mut Vec<A>) -> Result<(), Error> + Sync,
) -> Result<Vec<A>, Error> {
    let mut all = memory::with_capacity(cells.len())?;
    each_known(classifier, worker, cells, threads, ask, |_, answer| {
        all.push(answer);
        Ok(())
    })?;
    Ok(all)
}

/// The children of many cells, which several threads split.
pub(crate) fn split_each<C: Classifier>(
    classifier: &C,
    worker: &mut C::Worker,
    cells: &[(Cell, Part<C>)],
    threads: usize,
    control: &Control<'_>,
) -> Result<Vec<[Verdict<Part<C>>; 8]>, Error> {
    each(classifier, worker, cells, threads, |worker, cells, verdicts| {
        worker.split_many(cells, control, verdicts)
    })
}

/// As [`each`], with the answers going to `take` in the order of the cells, each with its cell's place. If
/// there is an error, the answers that were had all the same are taken first.
pub(super) fn each_known<C: Classifier, A: Answer<Part<C>>>(
    classifier: &C,
    worker: &mut C::Worker,
    cells: &[(Cell, Part<C>)],
    threads: usize,
    ask: impl Fn(&mut C::Worker, &[(Cell, Part<C>)], &mut Vec<A>) -> Result<(), Error> + Sync,
    mut take: impl FnMut(usize, A) -> Result<(), Error>,
) -> Result<(), Error> {
    if threads > 1 && cells.len() > 1 {
        let from = &*worker;
        let share = cells.len().div_ceil(threads);
        let one = |cells: &[(Cell, Part<C>)]| {
            let mut own = classifier.worker()?;
            let mut handed = memory::with_capacity(cells.len())?;
            for (cell, part) in cells {
                handed.push((*cell, own.hand_over(from, part)?));
            }
            let mut answers = Vec::new();
            let done = ask(&mut own, &handed, &mut answers);
            Ok::<_, Error>((own, answers, done))
        };
        let shares = parallel::each(true, cells.chunks(share), |cells| Ok(one(cells)))?;
        let mut result = Ok(());
        for (i, known) in shares.into_iter().enumerate() {
            let done = known.and_then(|(own, answers, done)| {
                for (k, answer) in answers.into_iter().enumerate() {
                    let answer = answer.handed_over(|part| worker.hand_over(&own, &part))?;
                    take(i * share + k, answer)?;
                }
                done
            });
            result = result.and(done);
        }
        return result;
    }
    let mut answers = Vec::new();
    let done = ask(worker, cells, &mut answers);
    for (k, answer) in answers.into_iter().enumerate() {
        take(k, answer)?;
    }
    done
}

/// An answer that may hold parts.
pub(super) trait Answer<P>: Send + Sized {
    fn handed_over(self, hand_over: impl FnMut(P) -> Result<P, Error>) -> Result<Self, Error>;
}

impl<P: Send> Answer<P> for [Verdict<P>; 8] {
    fn handed_over(self, mut hand_over: impl FnMut(P) -> Result<P, Error>) -> Result<Self, Error> {
        map_parts(self, |_, part| hand_over(part))
    }
}

/// Eight siblings with other parts.
fn map_parts<P, Q>(
    eight: [Verdict<P>; 8],
    mut part: impl FnMut(u8, P) -> Result<Q, Error>,
) -> Result<[Verdict<Q>; 8], Error> {
    let mut mapped = [const { Verdict::Undecided }; 8];
    for ((octant, verdict), to) in (0..).zip(eight).zip(&mut mapped) {
        *to = verdict.try_map(|own| part(octant, own))?;
    }
    Ok(mapped)
}

impl<P> Answer<P> for Option<bool> {
    fn handed_over(self, _: impl FnMut(P) -> Result<P, Error>) -> Result<Self, Error> {
        Ok(self)
    }
}

impl Classifier for &Gathered {
    type Worker = Self;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<Self, Error> {
        Ok(self)
    }

    fn exterior(&self) -> Tag {
        Tag::Partial
    }
}

/// Parts are the places of splits, and of the centres of finest cells. The cell that all is below has the
/// first.
impl Worker for &Gathered {
    type Part = u32;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<u32>, Error> {
        Ok(Verdict::Partial(0))
    }

    fn split(&mut self, _: Cell, part: &u32) -> Result<[Verdict<u32>; 8], Error> {
        let Split { verdicts, first } = &self.splits[*part as usize];
        let mut next = *first;
        map_parts(*verdicts, |_, ()| {
            next += 1;
            Ok(next - 1)
        })
    }

    fn sample(&mut self, _: Cell, part: &u32) -> Result<Option<bool>, Error> {
        Ok(self.centres.get(*part as usize).copied().flatten())
    }
}

/// The eight children of a cell, by whichever form of splitting the solid likes; where that takes long,
/// `control` can cancel it half-way.
pub(crate) fn split_one<W: Worker>(
    worker: &mut W,
    cell: Cell,
    part: &W::Part,
    control: &Control<'_>,
) -> Result<[Verdict<W::Part>; 8], Error> {
    if !worker.likes_many() {
        return worker.split(cell, part);
    }
    let mut verdicts = Vec::new();
    worker.split_many(&[(cell, part.clone())], control, &mut verdicts)?;
    Ok(verdicts.pop().unwrap_or([const { Verdict::Undecided }; 8]))
}
