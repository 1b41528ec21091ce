//! The system's allocator, which counts what a thread holds, and can be told to refuse the n-th request of a
//! thread.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    /// Requests of this thread until one is refused; 0 when none is to be.
    static LEFT: Cell<u64> = const { Cell::new(0) };
    /// Whether all requests behind that one are refused, too.
    static FOR_GOOD: Cell<bool> = const { Cell::new(false) };
    /// Bytes up to which a request is always granted.
    static SPARED: Cell<usize> = const { Cell::new(0) };
    /// Requests refused.
    static REFUSED: Cell<u64> = const { Cell::new(0) };
    /// Bytes held by what this thread asked for since it was last set to zero, and the most of it.
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
        // No allocator fails to give memory back.
        if size > layout.size() && refuses(size) {
            return std::ptr::null_mut();
        }
        // Both at once, as if it were copied.
        hold(size as i64);
        hold(-(layout.size() as i64));
        // SAFETY: as the caller promises.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Failing = Failing;

/// Runs `work` with its n-th request of more than `spared` bytes refused, and all behind it if `for_good`;
/// tells how many were.
pub fn refusing<R>(n: u64, spared: usize, for_good: bool, work: impl FnOnce() -> R) -> (R, u64) {
    FOR_GOOD.set(for_good);
    SPARED.set(spared);
    REFUSED.set(0);
    LEFT.set(n);
    let result = work();
    LEFT.set(0);
    (result, REFUSED.get())
}

/// The bytes that `work` leaves behind in this thread.
pub fn left<R>(work: impl FnOnce() -> R) -> (R, usize) {
    HELD.set([0; 2]);
    let result = work();
    (result, HELD.get()[0] as usize)
}

/// The most bytes that `work` held at once, beyond what there was before.
pub fn most_held<R>(work: impl FnOnce() -> R) -> (R, usize) {
    HELD.set([0; 2]);
    let result = work();
    (result, HELD.get()[1] as usize)
}
