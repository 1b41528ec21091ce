//! Signals that end the program: it ends at once, wherever it waits, and leaves no temporary file behind and
//! no terminal in another mode.
//!
//! A separate thread waits for the signals, and no other thread ever receives one: no system call is
//! interrupted, and none needs to be. That thread undoes what must be undone. Then the process dies of the
//! signal, as it would have without this module, so that a shell knows why it ended.

use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

type Action = Box<dyn FnOnce() + Send>;

/// The action that is needed before the program ends. Code that makes a change which an action undoes holds
/// the lock.
static UNDO: Mutex<Option<Action>> = Mutex::new(None);
/// Locked while text is written that must not be cut off.
static WHOLE: Mutex<()> = Mutex::new(());
/// True after a signal.
static IS_ENDING: AtomicBool = AtomicBool::new(false);

/// The time that an uninterruptible write may take to end by itself.
const PATIENCE: Duration = Duration::from_millis(500);

fn undo() -> MutexGuard<'static, Option<Action>> {
    UNDO.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A change that is undone when this value is dropped, or when the program ends before.
#[cfg(unix)]
pub struct Change(());

#[cfg(unix)]
impl Change {
    /// Makes a change, if possible.
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

/// Calls `write` with each piece of a text, and with `end` after the piece during which a signal arrives. The
/// program then ends. If a piece takes longer than half a second, the program ends without writing `end`.
pub fn write_whole<E>(text: &[u8], end: &[u8], write: impl Fn(&[u8]) -> Result<(), E>) -> Result<(), E> {
    /// Bytes of a piece: even a slow line transmits them in no time.
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

/// Performs the clean-up before the program ends. After it, no other thread can save a file or change a
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

/// Starts to wait for signals. Must be called before there are other threads.
#[cfg(unix)]
pub fn watch() {
    use nix::sys::signal::Signal::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGXFSZ};
    use nix::sys::signal::{SigHandler, SigSet};
    // Writing beyond the limit on file sizes then becomes an error, which is reported.
    set(SIGXFSZ, SigHandler::SigIgn);
    let mut ending = SigSet::empty();
    for signal in [SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU] {
        // An ignored signal stays ignored, as SIGHUP under `nohup`. (There is no way to query the action
        // without setting it.)
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
            // Nothing else unblocks signals, and a failure could not be reported.
            let _ = ending.thread_unblock();
            let _ = nix::sys::signal::raise(signal);
            // The first process of a container does not die of signals.
            std::process::exit(128 + signal as i32);
        }
        // From here on, the signals have their default actions.
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

/// Sets the action of a signal, and returns the previous one.
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

/// The same for Ctrl-C and Ctrl-Break on Windows, and for the closing of the console.
#[cfg(windows)]
pub fn watch() {
    /// The exit code that shells report for a program that Ctrl-C ended.
    const STOPPED: i32 = 130;
    // If this fails, Ctrl-C ends the program without the clean-up.
    let _ = ctrlc::set_handler(|| {
        clean_up();
        std::process::exit(STOPPED);
    });
}

/// Does nothing: other systems have no signals.
#[cfg(not(any(unix, windows)))]
pub fn watch() {}
