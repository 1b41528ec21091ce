//! A mutex for values that threads share.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// A mutex that is held for one closure.
///
/// The mutex alone would be enough. `mark` is there for ThreadSanitizer: the standard library locks a
/// contended mutex in its own code, which is compiled without ThreadSanitizer. `mark` repeats the mutex's
/// ordering in code of this crate: each owner loads it at the start and stores it at the end. The price is
/// two plain moves of a byte.
#[derive(Default)]
pub(crate) struct Lock<T> {
    mark: AtomicBool,
    value: Mutex<T>,
}

impl<T> Lock<T> {
    #[cfg(feature = "parallel")]
    pub(crate) fn new(value: T) -> Lock<T> {
        Lock { mark: AtomicBool::new(false), value: Mutex::new(value) }
    }

    /// Calls `work` with exclusive access to the value.
    ///
    /// A panic in `work` leaves the value as it is at that moment. The next owner gets it in that state.
    pub(crate) fn with<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        let mut value = self.value.lock().unwrap_or_else(PoisonError::into_inner);
        self.mark.load(Ordering::Acquire);
        let result = work(&mut value);
        self.mark.store(true, Ordering::Release);
        result
    }

    /// Returns the value.
    #[cfg(feature = "parallel")]
    pub(crate) fn into_inner(self) -> T {
        self.value.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}
