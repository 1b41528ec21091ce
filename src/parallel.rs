//! Work that several threads share. Whatever takes more than one thread comes here, and nowhere else is it
//! asked whether there may be more than one.
//!
//! The threads are those of a pool that stands as long as [`run`] takes. Tasks go to them through one
//! function that knows nothing of what they are, so that the machinery which shares them out is compiled once
//! and not for every kind of task. A task costs two locks that nobody else holds, some 50 ns: it should be
//! worth ten times that.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// Does `work` where the functions below use `threads` threads (0: as many as the machine has processors),
/// and tells it whether there is more than one. Without the feature `parallel`, and where the system refuses
/// to start threads, there is one.
pub(crate) fn run<R: Send>(threads: usize, work: impl FnOnce(bool) -> R + Send) -> R {
    #[cfg(not(feature = "parallel"))]
    let _ = threads;
    #[cfg(feature = "parallel")]
    let work = {
        let (mut work, mut done) = (Some(work), None);
        pool::run(threads, &mut || done = work.take().map(|work| work(true)));
        match (done, work) {
            (Some(done), _) => return done,
            (None, Some(work)) => work,
            (None, None) => unreachable!("work was taken and not done"),
        }
    };
    work(false)
}

/// Threads at work.
pub(crate) fn threads() -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "parallel"))]
    1
}

/// Does all tasks, on the threads at hand if `parallel`: the results in the order of the tasks.
///
/// # Errors
/// One of those of `work`. Tasks that have not begun by then are not done.
pub(crate) fn each<T: Send, R: Send>(
    parallel: bool,
    tasks: impl ExactSizeIterator<Item = T>,
    work: impl Fn(T) -> Result<R, Error> + Sync,
) -> Result<Vec<R>, Error> {
    each_with(parallel, tasks, || (), |(), task| work(task))
}

/// As [`each`], with something of its own for every thread, which one task leaves to the next.
///
/// # Errors
/// As [`each`].
pub(crate) fn each_with<S: Send, T: Send, R: Send>(
    parallel: bool,
    tasks: impl ExactSizeIterator<Item = T>,
    own: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, T) -> Result<R, Error> + Sync,
) -> Result<Vec<R>, Error> {
    #[cfg(feature = "parallel")]
    if parallel && tasks.len() > 1 {
        return pool::each_with(tasks, own, work);
    }
    let _ = parallel;
    let mut done = memory::with_capacity(tasks.len())?;
    let mut own = own();
    for task in tasks {
        done.push(work(&mut own, task)?);
    }
    Ok(done)
}

/// Does two things, at the same time if `parallel`: on the threads of [`run`].
pub(crate) fn both<A: Send, B: Send>(
    parallel: bool,
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    #[cfg(feature = "parallel")]
    if parallel {
        return rayon::join(one, other);
    }
    let _ = parallel;
    (one(), other())
}

/// Appends what `make` makes of each number. For items of a few instructions; `list` has room for them. `own`
/// is made for every share of neighbours.
pub(crate) fn extend<S, T: Send>(
    parallel: bool,
    list: &mut Vec<T>,
    numbers: Range<usize>,
    own: impl Fn() -> S + Sync + Send,
    make: impl Fn(&mut S, usize) -> T + Sync + Send,
) {
    #[cfg(feature = "parallel")]
    if parallel {
        use rayon::prelude::*;
        list.par_extend(numbers.into_par_iter().with_min_len(1 << 10).map_init(own, make));
        return;
    }
    let _ = parallel;
    let mut own = own();
    list.extend(numbers.map(|number| make(&mut own, number)));
}

/// Sorts a list. Equal items cannot be told apart, so that any number of threads leaves the same.
pub(crate) fn sort<T: Ord + Send>(list: &mut [T], parallel: bool) {
    #[cfg(feature = "parallel")]
    if parallel {
        use rayon::slice::ParallelSliceMut;
        return list.par_sort_unstable();
    }
    let _ = parallel;
    list.sort_unstable();
}

#[cfg(feature = "parallel")]
mod pool {
    use crate::error::Error;
    use crate::lock::Lock;
    use crate::memory;
    use alloc::vec::Vec;
    use rayon::prelude::*;
    use std::thread;

    /// Most threads that an operation starts.
    const MOST: usize = 1024;

    /// Does `work` in a pool, if more than one thread is wanted and the system starts them.
    pub(super) fn run(threads: usize, work: &mut (dyn FnMut() + Send)) {
        let threads = match threads {
            0 => thread::available_parallelism().map_or(1, |n| n.get()),
            n => n.min(MOST),
        };
        if threads < 2 {
            return;
        }
        // All are joined, and not only done with their work, as a scope alone sees to: no thread outlives the
        // call, not even by what it tidies up at its end.
        thread::scope(|scope| {
            let mut joinable = Vec::new();
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).spawn_handler(|thread| {
                joinable.push(thread::Builder::new().spawn_scoped(scope, || thread.run())?);
                Ok(())
            });
            if let Ok(pool) = pool.build() {
                pool.install(work);
            }
            for thread in joinable {
                // A panic in one has reached `install`.
                let _ = thread.join();
            }
        });
    }

    /// A task, and then what came of it.
    enum Slot<T, R> {
        Task(T),
        Taken,
        Done(R),
    }

    pub(super) fn each_with<S: Send, T: Send, R: Send>(
        tasks: impl ExactSizeIterator<Item = T>,
        own: impl Fn() -> S + Sync,
        work: impl Fn(&mut S, T) -> Result<R, Error> + Sync,
    ) -> Result<Vec<R>, Error> {
        let slots = memory::collected(tasks.map(|task| Lock::new(Slot::Task(task))))?;
        let idle = Lock::new(Vec::new());
        share(slots.len(), &|i| {
            let Slot::Task(task) = slots[i].with(|slot| core::mem::replace(slot, Slot::Taken)) else {
                return Ok(());
            };
            let mut mine = idle.with(Vec::pop).unwrap_or_else(&own);
            let done = work(&mut mine, task)?;
            slots[i].with(|slot| *slot = Slot::Done(done));
            idle.with(|idle| memory::push(idle, mine))
        })?;
        let mut done = memory::with_capacity(slots.len())?;
        done.extend(slots.into_iter().filter_map(|slot| match slot.into_inner() {
            Slot::Done(result) => Some(result),
            _ => None,
        }));
        Ok(done)
    }

    /// Shares out the numbers of tasks.
    fn share(count: usize, work: &(dyn Fn(usize) -> Result<(), Error> + Sync)) -> Result<(), Error> {
        (0..count).into_par_iter().try_for_each(work)
    }
}
