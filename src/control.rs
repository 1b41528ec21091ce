//! Cancelling, watching and limiting long work.

use crate::error::Error;
use crate::parallel;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

/// How a long operation may proceed. The default has no limit, uses all processors and reports to nobody.
///
/// No field but `max_splits` changes a result: an operation either returns what it would have returned
/// without them, bit for bit, or an error. (Which damage to unverified bytes is noticed may depend on the
/// number of threads.)
#[derive(Clone, Copy, Default)]
pub struct Control<'a> {
    /// Threads to use; 0 means as many as the machine has processors, numbers beyond 1024 mean 1024. Without
    /// the feature `parallel`, and where the system refuses to start threads, there is one: the calling
    /// thread.
    pub threads: usize,
    /// Refuse results of more than this many octree nodes with [`Error::Limit`]. (What is refined on demand
    /// stops there.)
    pub max_nodes: Option<u64>,
    /// Refuse results whose working form is larger than this many bytes. Where the size is known beforehand,
    /// the refusal is [`Error::TooLarge`] and nothing is done; where it is found out on the way, it is
    /// [`Error::Limit`]. (What is refined on demand stops there.) When a result is put together, it takes as
    /// much again for a moment. Interference, clearance, deviations, bounding boxes and areas of sections end
    /// with what they know, as with `max_splits` spent, before what they remember of a solid's parts takes so
    /// much.
    ///
    /// A small solid may have a large result: a file of some hundred bytes holds a cell of depth 20, whose
    /// surface has 2^43 triangles at the finest level. Set a limit where a solid or its depth is not your own
    /// choice.
    pub max_bytes: Option<u64>,
    /// Split at most this many cells; `None` means no limit, or the one that the operation names. Only
    /// operations that split on demand heed it, and say so: with it spent they stop, and keep or return what
    /// they have; it is no error.
    pub max_splits: Option<u64>,
    /// Setting this flag, from any thread, ends the operation with [`Error::Cancelled`].
    pub cancel: Option<&'a AtomicBool>,
    /// Called now and then, from any of the threads, with the fraction done (0 to 1).
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
    /// The default with a number of threads.
    pub fn threads(threads: usize) -> Control<'static> {
        Control { threads, ..Control::default() }
    }

    /// Whether the caller cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|flag| flag.load(Relaxed))
    }

    /// Does `work` that is the part between two fractions of all that there is to do.
    pub(crate) fn share<R>(&self, [from, to]: [f64; 2], work: impl FnOnce(&Control<'_>) -> R) -> R {
        let report = |done: f64| {
            if let Some(progress) = self.progress {
                progress(from + (to - from) * done);
            }
        };
        let progress: Option<&(dyn Fn(f64) + Sync)> = self.progress.is_some().then_some(&report);
        work(&Control { progress, ..*self })
    }

    /// Refuses what is known to take more bytes than the caller allows.
    pub(crate) fn afford(&self, what: &'static str, needed: u64) -> Result<(), Error> {
        match self.max_bytes.filter(|&limit| needed > limit) {
            Some(limit) => Err(Error::TooLarge { what, needed, limit }),
            None => Ok(()),
        }
    }

    /// Refuses when the caller cancelled.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// Runs `work` where the functions of [`parallel`] use the threads that were asked for, if the work is
    /// `worth` starting them; `work` is told whether there is more than one.
    pub(crate) fn run<R: Send>(&self, worth: bool, work: impl FnOnce(bool) -> R + Send) -> R {
        if worth { parallel::run(self.threads, work) } else { work(false) }
    }
}

/// One run of an operation under a [`Control`]: the counters that its threads share.
pub(crate) struct Job<'a> {
    control: &'a Control<'a>,
    nodes: AtomicUsize,
    bytes: AtomicUsize,
    done: AtomicUsize,
}

/// Parts that progress is counted in.
pub(crate) const WHOLE: usize = 1 << 18;

impl<'a> Job<'a> {
    pub(crate) fn new(control: &'a Control<'a>) -> Job<'a> {
        Job { control, nodes: AtomicUsize::new(0), bytes: AtomicUsize::new(0), done: AtomicUsize::new(0) }
    }

    /// Whom it runs under.
    pub(crate) fn control(&self) -> &'a Control<'a> {
        self.control
    }

    /// Whether octree nodes must be counted.
    pub(crate) fn counts_nodes(&self) -> bool {
        self.control.max_nodes.is_some()
    }

    /// Reports stored nodes and bytes; refuses when a limit is passed or the caller cancelled.
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

    /// Refuses when the caller cancelled.
    pub(crate) fn check(&self) -> Result<(), Error> {
        self.control.check()
    }

    /// Does all tasks as [`parallel::each`], which are all that there is to do.
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

    /// Reports all that is left as done.
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
