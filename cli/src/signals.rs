//! Signals that end the program: it ends at once, wherever it waits, and leaves no temporary file and no
//! terminal in another mode behind.
//!
//! A thread of its own waits for the signals, and no other thread ever receives one: no system call is
//! interrupted, and none needs to be. What the signal must undo is undone by that thread. Then the process
//! dies of the signal, as it would have without all this, so that a shell knows why it ended.

use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

type Action = Box<dyn FnOnce() + Send>;

/// What is to be done before the program ends. Whoever changes anything that an action undoes holds the lock.
static UNDO: Mutex<Option<Action>> = Mutex::new(None);
/// Locked while something is written that must not be cut off in the middle.
static WHOLE: Mutex<()> = Mutex::new(());
/// Whether a signal has come.
static IS_ENDING: AtomicBool = AtomicBool::new(false);

/// How long what must not be cut off may take until it ends by itself.
const PATIENCE: Duration = Duration::from_millis(500);

fn undo() -> MutexGuard<'static, Option<Action>> {
    UNDO.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A change that is undone when this is dropped, or when the program ends before.
#[cfg(unix)]
pub struct Change(());

#[cfg(unix)]
impl Change {
    /// Makes a change, if it can be made.
    pub fn make(
        change: impl FnOnce() -> Option<()>,
        undone: impl FnOnce() + Send + 'static,
    ) -> Option<Change> {
        let mut undo = undo();
        change()?;
        *undo = Some(Box::new(undone));
        Some(Change(()))
    }
}

#[cfg(unix)]
impl Drop for Change {
    fn drop(&mut self) {
        let mut undo = undo();
        if let Some(undone) = undo.take() {
            undone();
        }
    }
}

/// Calls `write` with each piece of a text, and with `end` after the piece in which a signal comes. The
/// program then ends. It does so without `end` if a piece takes longer than half a second.
pub fn write_whole<E>(text: &[u8], end: &[u8], write: impl Fn(&[u8]) -> Result<(), E>) -> Result<(), E> {
    /// Bytes of a piece: a slow line takes them in no time.
    const PIECE: usize = 1024;
    let whole = WHOLE.lock().unwrap_or_else(PoisonError::into_inner);
    for piece in text.chunks(PIECE) {
        if IS_ENDING.load(SeqCst) {
            let written = write(end);
            drop(whole);
            written?;
            loop {
                std::thread::park();
            }
        }
        write(piece)?;
    }
    Ok(())
}

/// Does what must be done before the program ends. After that no other thread can save a file or change a
/// terminal.
#[cfg(any(unix, windows))]
fn clean_up() {
    IS_ENDING.store(true, SeqCst);
    let start = Instant::now();
    while matches!(WHOLE.try_lock(), Err(TryLockError::WouldBlock)) && start.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(1));
    }
    let mut undo = undo();
    if let Some(undone) = undo.take() {
        undone();
    }
    std::mem::forget(undo);
    leafless::file::abandon_saves();
}

/// Begins to wait for signals. To be called before there are other threads.
#[cfg(unix)]
pub fn watch() {
    use nix::sys::signal::Signal::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGXFSZ};
    use nix::sys::signal::{SigHandler, SigSet};
    // What is written beyond the limit on the size of files is then an error, which is told.
    set(SIGXFSZ, SigHandler::SigIgn);
    let mut ending = SigSet::empty();
    for signal in [SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU] {
        // A signal that is ignored stays so, as SIGHUP under `nohup`. (There is no way to ask without
        // setting.)
        if matches!(set(signal, SigHandler::SigDfl), Some(SigHandler::SigIgn)) {
            set(signal, SigHandler::SigIgn);
        } else {
            ending.add(signal);
        }
    }
    // Threads that are started later inherit this.
    if ending.thread_block().is_err() {
        return;
    }
    let wait = move || {
        if let Ok(signal) = ending.wait() {
            clean_up();
            // Nothing else does so, and there is nobody to tell if this fails.
            let _ = ending.thread_unblock();
            let _ = nix::sys::signal::raise(signal);
            // The first process of a container does not die of signals.
            std::process::exit(128 + signal as i32);
        }
        // The signals do now what they do by default.
        let _ = ending.thread_unblock();
        loop {
            std::thread::park();
        }
    };
    let thread = std::thread::Builder::new().name("signals".into()).stack_size(1 << 17);
    if thread.spawn(wait).is_err() {
        let _ = ending.thread_unblock();
    }
}

/// Sets what a signal does, and returns what it did.
#[cfg(unix)]
#[allow(unsafe_code)]
fn set(
    signal: nix::sys::signal::Signal,
    does: nix::sys::signal::SigHandler,
) -> Option<nix::sys::signal::SigHandler> {
    use nix::sys::signal::{SaFlags, SigAction, SigSet, sigaction};
    let action = SigAction::new(does, SaFlags::empty(), SigSet::empty());
    // SAFETY: the program installs no function as a handler.
    unsafe { sigaction(signal, &action) }.ok().map(|before| before.handler())
}

/// The same for Ctrl-C and Ctrl-Break on Windows, and the closing of the console.
#[cfg(windows)]
pub fn watch() {
    /// What shells report of a program that Ctrl-C ended.
    const STOPPED: i32 = 130;
    // If this fails the program ends without it.
    let _ = ctrlc::set_handler(|| {
        clean_up();
        std::process::exit(STOPPED);
    });
}

/// Other systems have no signals.
#[cfg(not(any(unix, windows)))]
pub fn watch() {}
