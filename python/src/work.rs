//! Long operations: the interpreter is released, Ctrl-C interrupts, progress is reported, limits hold.

use crate::arguments::Argument;
use crate::error::{OrRaise, raised};
use crate::from_package;
use leafless::{Control, Error};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use std::sync::atomic::{
    AtomicBool, AtomicU64,
    Ordering::{Acquire, Relaxed, Release},
};
use std::thread;
use std::time::Duration;

/// The time between two checks of signals and progress.
const GLANCE: Duration = Duration::from_millis(50);

/// The size of the working thread's stack (bytes): that of a usual main thread.
const STACK: usize = 8 << 20;

/// Refuses a result that is known to need more bytes than the caller allows.
pub fn afford(control: &Control<'_>, what: &'static str, needed: u64) -> Result<(), Error> {
    match control.max_bytes.filter(|&limit| needed > limit) {
        Some(limit) => Err(Error::TooLarge { what, needed, limit }),
        None => Ok(()),
    }
}

/// Reports progress, and fails if the caller cancelled.
pub fn advance(control: &Control<'_>, done: usize, all: usize) -> Result<(), Error> {
    if control.is_cancelled() {
        return Err(Error::Cancelled);
    }
    if let Some(progress) = control.progress {
        progress(done as f64 / all.max(1) as f64);
    }
    Ok(())
}

/// The keyword arguments of all long operations: `threads`, `max_nodes`, `max_bytes`, `max_splits`,
/// `progress`.
#[derive(Default)]
pub struct Limits {
    threads: usize,
    max_nodes: Option<u64>,
    max_bytes: Option<u64>,
    pub max_splits: Option<u64>,
    progress: Option<Py<PyAny>>,
}

impl Limits {
    /// Reads the limits from keyword arguments, and refuses any other argument.
    pub fn of(given: Option<&Bound<'_, PyDict>>) -> PyResult<Limits> {
        let mut limits = Limits::default();
        for (name, value) in given.into_iter().flat_map(|given| given.iter()) {
            if value.is_none() {
                continue;
            }
            match name.extract::<&str>()? {
                "threads" => limits.threads = Argument::take(&value, "threads")?,
                "max_nodes" => limits.max_nodes = Argument::take(&value, "max_nodes")?,
                "max_bytes" => limits.max_bytes = Argument::take(&value, "max_bytes")?,
                "max_splits" => limits.max_splits = Argument::take(&value, "max_splits")?,
                "progress" if value.is(PyBool::new(value.py(), false)) => {}
                "progress" => {
                    let reporter = from_package!(value.py(), "leafless._progress", "reporter")?;
                    limits.progress = Some(reporter.call1((value,))?.unbind());
                }
                name => return Err(PyTypeError::new_err(format!("unexpected keyword argument '{name}'"))),
            }
        }
        Ok(limits)
    }

    fn control<'a>(
        &self,
        cancel: Option<&'a AtomicBool>,
        progress: Option<&'a (dyn Fn(f64) + Sync)>,
    ) -> Control<'a> {
        let &Limits { threads, max_nodes, max_bytes, max_splits, .. } = self;
        Control { threads, max_nodes, max_bytes, max_splits, cancel, progress }
    }

    /// Runs a long operation in a thread of its own. The calling thread waits for signals, which cancel the
    /// operation, and calls the progress function.
    pub fn run<R: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Control<'_>) -> Result<R, Error> + Send,
    ) -> PyResult<R> {
        let (cancel, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let report = |part: f64| done.store(part.to_bits(), Relaxed);
        let progress: Option<&(dyn Fn(f64) + Sync)> = self.progress.is_some().then_some(&report);
        let control = self.control(Some(&cancel), progress);
        let (found, stopped) = py.detach(|| -> PyResult<_> {
            let (waiting, control) = (thread::current(), &control);
            // A thread that has done its work is not finished at once.
            let is_done = &AtomicBool::new(false);
            thread::scope(|scope| {
                let worker = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || {
                    let found = work(control);
                    is_done.store(true, Release);
                    waiting.unpark();
                    found
                })?;
                let (mut told, mut stopped) = (0, None);
                // A thread that panics is finished without being done.
                let goes_on = || !is_done.load(Acquire) && !worker.is_finished();
                while goes_on() {
                    thread::park_timeout(GLANCE);
                    if stopped.is_none() && goes_on() {
                        stopped = Python::attach(|py| self.glance(py, &done, &mut told)).err();
                        if stopped.is_some() {
                            cancel.store(true, Relaxed);
                        }
                    }
                }
                match worker.join() {
                    Ok(found) => Ok((found, stopped)),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            })
        })?;
        match (found, stopped) {
            (Err(Error::Cancelled), Some(stopped)) => Err(stopped),
            (found, stopped) => {
                let found = found.or_raise(py)?;
                if let Some(stopped) = stopped {
                    return Err(stopped);
                }
                if let Some(progress) = &self.progress {
                    progress.call1(py, (1.0,))?;
                }
                Ok(found)
            }
        }
    }

    /// Checks signals, and reports the progress since the last time.
    fn glance(&self, py: Python<'_>, done: &AtomicU64, told: &mut u64) -> PyResult<()> {
        py.check_signals()?;
        let now = done.load(Relaxed);
        if let Some(progress) = &self.progress
            && now != *told
        {
            *told = now;
            progress.call1(py, (f64::from_bits(now).min(1.0),))?;
        }
        Ok(())
    }

    /// Runs a short operation on the calling thread, with the interpreter released.
    pub fn run_here<R: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Control<'_>) -> Result<R, Error> + Send,
    ) -> PyResult<R> {
        let control = self.control(None, None);
        py.detach(|| work(&control)).map_err(|error| raised(py, error))
    }

    /// Runs an operation in a thread of its own if it is `long` or reports progress, else on the calling
    /// thread.
    pub fn run_if<R: Send>(
        &self,
        long: bool,
        py: Python<'_>,
        work: impl FnOnce(&Control<'_>) -> Result<R, Error> + Send,
    ) -> PyResult<R> {
        if long || self.progress.is_some() { self.run(py, work) } else { self.run_here(py, work) }
    }
}
