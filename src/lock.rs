//! A value that threads share, one at a time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// A mutex that is held for one closure.
///
/// The mutex alone is enough. The standard library takes a contended mutex in code of its own, which comes
/// compiled without ThreadSanitizer. `mark` repeats in code of this crate what the mutex says there: each
/// owner stores it at the end, and loads it at the start. The price is two plain moves of a byte.
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

    /// Calls `work` with the value, which no other thread has meanwhile.
    ///
    /// A panic in `work` leaves the value as it is then: the next owner gets it like any other.
    pub(crate) fn with<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        let mut value = self.value.lock().unwrap_or_else(PoisonError::into_inner);
        self.mark.load(Ordering::Acquire);
        let result = work(&mut value);
        self.mark.store(true, Ordering::Release);
        result
    }

    /// The value.
    #[cfg(feature = "parallel")]
    pub(crate) fn into_inner(self) -> T {
        self.value.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}
