//! Limits, cancelling and progress of long operations.

use crate::error::Error;
use crate::parallel;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

/// Limits for a long operation, and ways to watch and cancel it. The default has no limit, uses all
/// processors and reports no progress.
///
/// No field but `max_splits` changes a result: with any other field set, an operation returns the same
/// result, bit for bit, or an error. (Which damage in unverified bytes is noticed may depend on the number of
/// threads.)
#[derive(Clone, Copy, Default)]
pub struct Control<'a> {
    /// Number of threads. 0 means as many as the machine has processors; numbers beyond 1024 mean 1024.
    /// Without the feature `parallel`, or if the system refuses to start threads, only the calling thread
    /// works.
    pub threads: usize,
    /// Maximum number of octree nodes of a result; a larger result is [`Error::Limit`]. (Refinement on demand
    /// stops there.)
    pub max_nodes: Option<u64>,
    /// Maximum size of the working form of a result, in bytes. If a larger size is known beforehand, the
    /// error is [`Error::TooLarge`] and no work is done; if it is found during the work, the error is
    /// [`Error::Limit`]. (Refinement on demand stops there.) While a result is assembled, it briefly takes
    /// twice its memory. Interference, clearance, deviations, bounding boxes and areas of sections remember
    /// parts of the solids. They stop before these parts exceed the limit, and return their bounds so far, as
    /// they do when `max_splits` is spent.
    ///
    /// A small solid may have a large result: a file of some hundred bytes can hold one cell of depth 20,
    /// whose surface has 2^43 triangles at the finest level. Set a limit if the solid or its depth comes from
    /// somebody else.
    pub max_bytes: Option<u64>,
    /// Maximum number of cells to split; `None` means no limit, or the limit that the operation documents.
    /// Only operations that split on demand use this field, and their documentation says so. When the splits
    /// are spent, these operations stop and keep or return their results so far, without an error.
    pub max_splits: Option<u64>,
    /// A flag that ends the operation with [`Error::Cancelled`] when any thread sets it.
    pub cancel: Option<&'a AtomicBool>,
    /// A function that is called now and then, from any of the threads, with the fraction done (0 to 1).
    pub progress: Option<&'a (dyn Fn(f64) + Sync)>,
}

impl core::fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Control")
            .field("threads", &self.threads)
            .field("max_nodes", &self.max_nodes)
            .field("max_bytes", &self.max_bytes)
            .field("max_splits", &self.max_splits)
            .field("cancel", &self.cancel)
            .finish_non_exhaustive()
    }
}

impl Control<'_> {
    /// Returns the default with this number of threads.
    pub fn threads(threads: usize) -> Control<'static> {
        Control { threads, ..Control::default() }
    }

    /// Returns whether the caller cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|flag| flag.load(Relaxed))
    }

    /// Calls `work`, which covers the given range of fractions of all progress.
    pub(crate) fn share<R>(&self, [from, to]: [f64; 2], work: impl FnOnce(&Control<'_>) -> R) -> R {
        let report = |done: f64| {
            if let Some(progress) = self.progress {
                progress(from + (to - from) * done);
            }
        };
        let progress: Option<&(dyn Fn(f64) + Sync)> = self.progress.is_some().then_some(&report);
        work(&Control { progress, ..*self })
    }

    /// Refuses work that is known to take more bytes than the caller allows.
    pub(crate) fn afford(&self, what: &'static str, needed: u64) -> Result<(), Error> {
        match self.max_bytes.filter(|&limit| needed > limit) {
            Some(limit) => Err(Error::TooLarge { what, needed, limit }),
            None => Ok(()),
        }
    }

    /// Returns [`Error::Cancelled`] if the caller cancelled.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// Runs `work` with the functions of [`parallel`] set to the number of threads that the caller chose, if
    /// the work is `worth` starting threads. The argument of `work` is true if there is more than one thread.
    pub(crate) fn run<R: Send>(&self, worth: bool, work: impl FnOnce(bool) -> R + Send) -> R {
        if worth { parallel::run(self.threads, work) } else { work(false) }
    }
}

/// One run of an operation under a [`Control`], with the counters that its threads share.
pub(crate) struct Job<'a> {
    control: &'a Control<'a>,
    nodes: AtomicUsize,
    bytes: AtomicUsize,
    done: AtomicUsize,
}

/// Number of parts in which progress is counted.
pub(crate) const WHOLE: usize = 1 << 18;

impl<'a> Job<'a> {
    pub(crate) fn new(control: &'a Control<'a>) -> Job<'a> {
        Job { control, nodes: AtomicUsize::new(0), bytes: AtomicUsize::new(0), done: AtomicUsize::new(0) }
    }

    /// Returns the control of this run.
    pub(crate) fn control(&self) -> &'a Control<'a> {
        self.control
    }

    /// Returns whether octree nodes must be counted.
    pub(crate) fn counts_nodes(&self) -> bool {
        self.control.max_nodes.is_some()
    }

    /// Counts stored nodes and bytes. Refuses when a limit is exceeded or the caller cancelled.
    pub(crate) fn spend(&self, nodes: usize, bytes: usize) -> Result<(), Error> {
        let within = |counter: &AtomicUsize, amount: usize, limit: Option<u64>, what| match limit {
            Some(limit) => {
                let total = counter.fetch_add(amount, Relaxed).saturating_add(amount);
                if total as u64 > limit { Err(Error::Limit { what, limit }) } else { Ok(()) }
            }
            None => Ok(()),
        };
        within(&self.nodes, nodes, self.control.max_nodes, "nodes")?;
        within(&self.bytes, bytes, self.control.max_bytes, "bytes")?;
        self.check()
    }

    /// Returns [`Error::Cancelled`] if the caller cancelled.
    pub(crate) fn check(&self) -> Result<(), Error> {
        self.control.check()
    }

    /// Does all tasks with [`parallel::each`]. The tasks are the whole work of this run.
    ///
    /// # Errors
    /// As [`parallel::each`].
    pub(crate) fn each<T: Send, R: Send>(
        &self,
        parallel: bool,
        tasks: impl ExactSizeIterator<Item = T>,
        work: impl Fn(T) -> Result<R, Error> + Sync,
    ) -> Result<Vec<R>, Error> {
        let count = tasks.len();
        let each_task = WHOLE.checked_div(count).unwrap_or(0);
        self.advance(WHOLE - each_task * count);
        parallel::each(parallel, tasks, |task| {
            let done = work(task)?;
            self.advance(each_task);
            Ok(done)
        })
    }

    /// Reports all remaining work as done.
    #[cfg(feature = "std")]
    pub(crate) fn finish(&self) {
        self.advance(WHOLE.saturating_sub(self.done.load(Relaxed)));
    }

    /// Reports `parts` of [`WHOLE`] as done.
    pub(crate) fn advance(&self, parts: usize) {
        if let Some(progress) = self.control.progress {
            let done = self.done.fetch_add(parts, Relaxed) + parts;
            progress(done as f64 / WHOLE as f64);
        }
    }
}
