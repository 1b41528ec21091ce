//! Progress of long work: a bar at a terminal, lines in a log; and limits of memory and time.

use crate::failure::complain;
use crate::memory;
use indicatif::{ProgressBar, ProgressStyle};
use leafless::{Control, Error};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Work that takes less time than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);
/// The time between two lines of progress without a terminal, …
const PACE: Duration = Duration::from_secs(5);
/// … and after a minute: a night's work fills no log.
const SLOW_PACE: Duration = Duration::from_secs(30);
/// Steps of the bar.
const STEPS: u64 = 1000;

/// Runs `work` on `threads` threads (0: one for each processor). If standard error is a terminal, a progress
/// bar called `label` appears after one second; otherwise a line is printed every few seconds. Work that
/// would take more memory than is allowed ends with an error that says so.
pub fn watched<R>(
    label: &'static str,
    threads: usize,
    work: impl FnOnce(&Control<'_>) -> Result<R, Error>,
) -> Result<R, String> {
    let start = Instant::now();
    let (bar, told) = (OnceLock::new(), Told::new(label));
    let show = |done: f64| {
        if start.elapsed() > PATIENCE {
            let bar = bar.get_or_init(|| started(label, start));
            bar.set_position((done * STEPS as f64) as u64);
        }
    };
    let note = |done: f64| {
        if let Some(told) = &told {
            told.note(done);
        }
    };
    let progress: &(dyn Fn(f64) + Sync) = if told.is_some() { &note } else { &show };
    let max_bytes = Some(memory::affordable());
    let result = work(&Control { threads, progress: Some(progress), max_bytes, ..Control::default() });
    if let Some(bar) = bar.get() {
        bar.finish_and_clear();
    }
    drop(told);
    result.map_err(|error| match error {
        // The only limit that is set here; others are the library's own, and explain themselves.
        Error::Limit { what: "bytes", limit } => format!(
            "needs more than the {} of memory that there is room for: take fewer levels of cells (one less takes about \
             a quarter), or give more with --max-memory",
            memory::told(limit)
        ),
        Error::TooLarge { what, needed, limit } => format!(
            "{what} would take {} of memory or more, and there is room for {}: take fewer levels of cells (one less takes \
             about a quarter), or give more with --max-memory",
            memory::told(needed),
            memory::told(limit)
        ),
        // Nothing else cancels the work.
        Error::Cancelled => "the time of --seconds was over before any bounds were found: give more".into(),
        Error::OutOfMemory => {
            "the system has no memory left: take fewer levels of cells (one less takes about a quarter)".into()
        }
        error => error.to_string(),
    })
}

fn started(label: &'static str, start: Instant) -> ProgressBar {
    let bar = ProgressBar::new(STEPS).with_message(label).with_elapsed(start.elapsed());
    match ProgressStyle::with_template("{msg} [{bar:40}] {percent:>3} %  {elapsed} (about {eta} left)") {
        Ok(style) => bar.with_style(style.progress_chars("=> ")),
        Err(_) => bar,
    }
}

/// Runs work that does not report its progress; every few seconds a line says that it continues.
pub fn at_work<R>(label: &'static str, work: impl FnOnce() -> R) -> R {
    let told = Told::new(label);
    let result = work();
    drop(told);
    result
}

/// A thread that reports running work every few seconds, until this value is dropped.
struct Told {
    /// Thousandths of the work that are done.
    done: Arc<AtomicU32>,
    thread: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Told {
    /// Starts the thread, or returns `None` at a terminal.
    fn new(label: &'static str) -> Option<Told> {
        if std::io::stderr().is_terminal() {
            return None;
        }
        let done = Arc::new(AtomicU32::new(0));
        let (end, ended) = channel();
        let seen = done.clone();
        let tell = move || {
            let start = Instant::now();
            let pace = || if start.elapsed() < Duration::from_secs(60) { PACE } else { SLOW_PACE };
            while ended.recv_timeout(pace()) == Err(RecvTimeoutError::Timeout) {
                let time = start.elapsed().as_secs();
                let part = match seen.load(Relaxed) {
                    0 => String::new(),
                    done => format!(", {} % done", done / 10),
                };
                complain(&format!("{label}: at work for {time} s{part}"));
            }
        };
        // If the thread cannot be started, there are no lines.
        let thread = std::thread::Builder::new().name("progress".into()).stack_size(1 << 17).spawn(tell).ok();
        Some(Told { done, thread: thread.map(|thread| (end, thread)) })
    }

    fn note(&self, done: f64) {
        self.done.store((done * 1000.0) as u32, Relaxed);
    }
}

impl Drop for Told {
    fn drop(&mut self) {
        if let Some((end, thread)) = self.thread.take() {
            drop(end);
            // No line comes after the result. (The thread does not panic.)
            let _ = thread.join();
        }
    }
}

/// Splits of the first attempt within a time limit.
const FIRST_SPLITS: u64 = 1 << 10;

/// Repeats work with four times as many splits each time, until it `is_done` or the time is over. Returns the
/// result of the last attempt that was completed. Without a time limit the work is done once.
pub fn within_time<R>(
    seconds: Option<f64>,
    control: &Control<'_>,
    work: impl Fn(&Control<'_>) -> Result<R, Error>,
    is_done: impl Fn(&R) -> bool,
) -> Result<R, Error> {
    let Some(seconds) = seconds else { return work(control) };
    until(Some(seconds), |is_over| {
        let most = control.max_splits.unwrap_or(u64::MAX);
        let (mut best, mut splits) = (None, FIRST_SPLITS.min(most));
        loop {
            let control = Control { max_splits: Some(splits), cancel: is_over, ..*control };
            match work(&control) {
                Ok(found) if splits == most || is_done(&found) => break Ok(found),
                Ok(found) => best = Some(found),
                Err(Error::Cancelled) => break best.ok_or(Error::Cancelled),
                Err(error) => break Err(error),
            }
            splits = splits.saturating_mul(4).min(most);
        }
    })
}

/// Runs work with a flag that is raised when the time is over. Without a time limit there is no flag.
pub fn until<R>(seconds: Option<f64>, work: impl FnOnce(Option<&AtomicBool>) -> R) -> R {
    let Some(seconds) = seconds else { return work(None) };
    let is_over = AtomicBool::new(false);
    let (end, ended) = channel::<()>();
    std::thread::scope(|scope| {
        let is_over = &is_over;
        scope.spawn(move || {
            let _ = ended.recv_timeout(Duration::from_secs_f64(seconds));
            is_over.store(true, Relaxed);
        });
        let result = work(Some(is_over));
        drop(end);
        result
    })
}
