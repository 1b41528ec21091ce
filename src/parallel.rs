//! Work shared between several threads. All code that may use more than one thread goes through this module.
//!
//! The threads belong to a pool that lives as long as one call of [`run`]. One function hands out tasks by
//! number, whatever their type, so that the scheduling code is compiled once and not once for every kind of
//! task. A task costs two uncontended locks, about 50 ns; a task should take at least ten times as long.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// Calls `work` with the functions below set to use `threads` threads (0: as many as the machine has
/// processors). The argument of `work` is true if there is more than one thread. Without the feature
/// `parallel`, or if the system refuses to start threads, there is one.
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

/// Returns the number of threads at work.
pub(crate) fn threads() -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "parallel"))]
    1
}

/// Does all tasks, on the current threads if `parallel`. The results are in the order of the tasks.
///
/// # Errors
/// One of the errors of `work`. Tasks that have not begun by then are not done.
pub(crate) fn each<T: Send, R: Send>(
    parallel: bool,
    tasks: impl ExactSizeIterator<Item = T>,
    work: impl Fn(T) -> Result<R, Error> + Sync,
) -> Result<Vec<R>, Error> {
    each_with(parallel, tasks, || (), |(), task| work(task))
}

/// Does all tasks as [`each`] does, with a state of its own for each thread. A thread keeps its state from
/// one task to the next.
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

/// Does two things, at the same time if `parallel`, on the threads of [`run`].
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

/// Appends the item that `make` returns for each number. Meant for items of a few instructions. `list` must
/// have room for the items. `own` makes a state for each run of consecutive numbers.
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

/// Sorts a list. Equal items are indistinguishable, so the result does not depend on the number of threads.
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

    /// Maximum number of threads that an operation starts.
    const MOST: usize = 1024;

    /// Calls `work` in a pool, if more than one thread is wanted and the system starts them.
    pub(super) fn run(threads: usize, work: &mut (dyn FnMut() + Send)) {
        let threads = match threads {
            0 => thread::available_parallelism().map_or(1, |n| n.get()),
            n => n.min(MOST),
        };
        if threads < 2 {
            return;
        }
        // All threads are joined. A scope alone would only wait until their work is done; with the joins no
        // thread outlives the call, not even by its clean-up at the end.
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
                // A panic in a thread has already reached `install`.
                let _ = thread.join();
            }
        });
    }

    /// A task, and later its result.
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

    /// Calls `work` with the number of each task, on all threads.
    fn share(count: usize, work: &(dyn Fn(usize) -> Result<(), Error> + Sync)) -> Result<(), Error> {
        (0..count).into_par_iter().try_for_each(work)
    }
}
