//! Splits of cells, one by one or in batches, by the form of splitting that the solid prefers.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::parallel;
use crate::solid::{Batch, Classifier, Enclosure, Parts, Verdict, Worker};
use alloc::vec::Vec;

/// The parts of a classifier's workers.
pub(crate) type Part<C> = <<C as Classifier>::Worker as Parts>::Part;

/// Splits a cell, by the form of splitting that the solid prefers. Where that takes long, `control` can
/// cancel it half-way.
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

/// Asks a question about many cells, with several threads: returns the answers in the order of the cells.
/// Parts among the answers are handed over to `worker`.
pub(crate) fn each<C: Classifier, A: Answer<Part<C>>>(
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

/// Splits many cells with several threads.
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

/// As [`each`], with the answers going to `take` in the order of the cells, each with its cell's index. After
/// an error, the answers that were computed are still taken first.
pub(crate) fn each_known<C: Classifier, A: Answer<Part<C>>>(
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
pub(crate) trait Answer<P>: Send + Sized {
    fn handed_over(self, hand_over: impl FnMut(P) -> Result<P, Error>) -> Result<Self, Error>;
}

impl<P: Send> Answer<P> for [Verdict<P>; 8] {
    fn handed_over(self, mut hand_over: impl FnMut(P) -> Result<P, Error>) -> Result<Self, Error> {
        map_parts(self, |_, part| hand_over(part))
    }
}

/// Eight siblings with other parts.
pub(crate) fn map_parts<P, Q>(
    eight: [Verdict<P>; 8],
    mut part: impl FnMut(u8, P) -> Result<Q, Error>,
) -> Result<[Verdict<Q>; 8], Error> {
    let mut mapped = [const { Verdict::Undecided }; 8];
    for ((octant, verdict), to) in (0..).zip(eight).zip(&mut mapped) {
        *to = verdict.try_map(|own| part(octant, own))?;
    }
    Ok(mapped)
}

impl<P> Answer<P> for Option<Enclosure> {
    fn handed_over(self, _: impl FnMut(P) -> Result<P, Error>) -> Result<Self, Error> {
        Ok(self)
    }
}

impl<P> Answer<P> for Option<bool> {
    fn handed_over(self, _: impl FnMut(P) -> Result<P, Error>) -> Result<Self, Error> {
        Ok(self)
    }
}
