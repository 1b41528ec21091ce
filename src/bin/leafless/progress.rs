//! Long work: a bar for whoever waits at a terminal.

use indicatif::{ProgressBar, ProgressStyle};
use leafless::Control;
use std::io::IsTerminal;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Work that is done before this needs no bar.
const PATIENCE: Duration = Duration::from_secs(1);
/// Steps of the bar.
const STEPS: u64 = 1000;

/// Runs `work` on so many threads (0: one a processor), with a progress bar called `label` once it has taken
/// more than a second, if standard error is a terminal.
pub fn watched<T>(label: &'static str, threads: usize, work: impl FnOnce(&Control<'_>) -> T) -> T {
    let start = Instant::now();
    let bar = OnceLock::new();
    let show = |done: f64| {
        if start.elapsed() > PATIENCE {
            let bar = bar.get_or_init(|| started(label, start));
            bar.set_position((done * STEPS as f64) as u64);
        }
    };
    let progress: Option<&(dyn Fn(f64) + Sync)> =
        if std::io::stderr().is_terminal() { Some(&show) } else { None };
    let result = work(&Control { threads, progress, ..Control::default() });
    if let Some(bar) = bar.get() {
        bar.finish_and_clear();
    }
    result
}

fn started(label: &'static str, start: Instant) -> ProgressBar {
    let bar = ProgressBar::new(STEPS).with_message(label).with_elapsed(start.elapsed());
    match ProgressStyle::with_template("{msg} [{bar:40}] {percent:>3} %  {elapsed} (about {eta} left)") {
        Ok(style) => bar.with_style(style.progress_chars("=> ")),
        Err(_) => bar,
    }
}
