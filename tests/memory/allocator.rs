//! An allocator over the system's. It counts the bytes that a thread holds, and can refuse the n-th request
//! of a thread.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    /// Requests of this thread until a request is refused; 0 if no request is to be refused.
    static LEFT: Cell<u64> = const { Cell::new(0) };
    /// Whether all later requests are refused, too.
    static FOR_GOOD: Cell<bool> = const { Cell::new(false) };
    /// Size in bytes up to which a request is always granted.
    static SPARED: Cell<usize> = const { Cell::new(0) };
    /// Number of refused requests.
    static REFUSED: Cell<u64> = const { Cell::new(0) };
    /// Bytes that this thread has held since the last reset: at present, and at most.
    static HELD: Cell<[i64; 2]> = const { Cell::new([0; 2]) };
}

struct Failing;

fn refuses(size: usize) -> bool {
    LEFT.with(|left| match left.get() {
        0 => false,
        _ if size <= SPARED.get() => false,
        1 => {
            if !FOR_GOOD.get() {
                left.set(0);
            }
            REFUSED.set(REFUSED.get() + 1);
            true
        }
        n => {
            left.set(n - 1);
            false
        }
    })
}

fn hold(bytes: i64) {
    let [held, most] = HELD.get();
    HELD.set([held + bytes, most.max(held + bytes)]);
}

// SAFETY: memory comes from the system's allocator and goes back to it.
unsafe impl GlobalAlloc for Failing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if refuses(layout.size()) {
            return std::ptr::null_mut();
        }
        hold(layout.size() as i64);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if refuses(layout.size()) {
            return std::ptr::null_mut();
        }
        hold(layout.size() as i64);
        // SAFETY: as the caller promises.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        hold(-(layout.size() as i64));
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Freeing memory never fails.
        if size > layout.size() && refuses(size) {
            return std::ptr::null_mut();
        }
        // Both blocks at once, as in a copy.
        hold(size as i64);
        hold(-(layout.size() as i64));
        // SAFETY: as the caller promises.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Failing = Failing;

/// Runs `work` and refuses its n-th request of more than `spared` bytes; if `for_good`, refuses all later
/// ones as well. Returns the number of refused requests, too.
pub fn refusing<R>(n: u64, spared: usize, for_good: bool, work: impl FnOnce() -> R) -> (R, u64) {
    FOR_GOOD.set(for_good);
    SPARED.set(spared);
    REFUSED.set(0);
    LEFT.set(n);
    let result = work();
    LEFT.set(0);
    (result, REFUSED.get())
}

/// Returns the bytes that `work` leaves allocated in this thread, with its result.
pub fn left<R>(work: impl FnOnce() -> R) -> (R, usize) {
    HELD.set([0; 2]);
    let result = work();
    (result, HELD.get()[0] as usize)
}

/// Returns the most bytes that `work` held at once beyond the bytes held before, with its result.
pub fn most_held<R>(work: impl FnOnce() -> R) -> (R, usize) {
    HELD.set([0; 2]);
    let result = work();
    (result, HELD.get()[1] as usize)
}
