//! Options of long operations: threads, limits, progress; cancelling from another thread.

use super::boundary::{Failure, Sized32, guard, handle, initialise, out, release, shared, sized};
use super::status::leafless_status;
use core::ffi::c_void;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use leafless::Control;
use leafless::Error;

/// A switch that stops long operations from any thread and reports their progress.
///
/// All its functions may be called at once from any number of threads.
pub struct leafless_control {
    cancelled: AtomicBool,
    /// The fraction done, as the bits of a double.
    fraction: AtomicU64,
}

/// The host's progress function: receives the fraction that is done (0 to 1) and returns 0 to go on. Any
/// other value ends the operation with LEAFLESS_E_CANCELLED, unless it is already done, and cancels the
/// `control` of its options, if there is one, until leafless_control_reset.
///
/// Any of the operation's threads may call it, also two at once and then not in ascending order; with
/// `threads` = 1 only the calling thread does. It must return: no exception, no longjmp. It may call this
/// library.
pub type leafless_progress_fn = Option<unsafe extern "C" fn(ctx: *mut c_void, fraction: f64) -> i32>;

/// Options of long operations: threads, limits, progress and cancelling. Where a function takes options, NULL
/// means the defaults. Zero is the default of every field but the first. No option but `max_splits` changes a
/// result.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_options {
    /// sizeof(leafless_options).
    pub struct_size: u32,
    /// Number of threads; 0 means the number of processors, numbers beyond 1024 mean 1024. Inside a function
    /// that the library calls it is always 1.
    pub threads: u32,
    /// Largest number of octree nodes of a result; 0 means no limit. A larger result is refused with
    /// LEAFLESS_E_LIMIT.
    pub max_nodes: u64,
    /// Largest size in bytes of a result's working form; 0 means no limit. A larger result is refused with
    /// LEAFLESS_E_LIMIT, before any work if the size is known beforehand. Assembling a result needs the same
    /// amount once more for a moment. Set a limit if a solid or its depth is untrusted: a file of some
    /// hundred bytes may hold a cell whose surface has 2^43 triangles. Interference, clearance, deviations
    /// and bounding boxes stop before their cache of a solid's parts exceeds the limit; as when max_splits is
    /// spent, they return the answer found so far.
    pub max_bytes: u64,
    /// Largest number of cells to split; 0 means no limit, or the default that the function names. It applies
    /// only to functions that split on demand, and their comments say so. When it is spent, they stop and
    /// keep or return the result so far, without an error.
    pub max_splits: u64,
    /// The progress function; optional.
    pub progress: leafless_progress_fn,
    /// The context that `progress` is called with.
    pub progress_ctx: *mut c_void,
    /// A control that can cancel the operation and report its progress; optional. Give operations that run at
    /// the same time a control each, or their progress is mixed up.
    pub control: *const leafless_control,
}

// SAFETY: numbers, pointers, and an optional function.
unsafe impl Sized32 for leafless_options {}

/// Pointers of the host that are passed to its own functions, in any thread.
struct Host<'a> {
    progress: leafless_progress_fn,
    ctx: *mut c_void,
    control: &'a leafless_control,
}

// SAFETY: the library only passes `ctx` back to the host. By its documented contract, the host's function may
// be called from any thread.
unsafe impl Sync for Host<'_> {}

impl Host<'_> {
    fn report(&self, fraction: f64) {
        self.control.fraction.store(fraction.to_bits(), Relaxed);
        if let Some(progress) = self.progress
            // SAFETY: as the host gave it, with its own context.
            && unsafe { progress(self.ctx, fraction) } != 0
        {
            self.control.cancelled.store(true, Relaxed);
        }
    }
}

/// Runs a long operation under the host's options.
///
/// # Safety
/// `options` is NULL or points to valid options.
pub(super) unsafe fn controlled<R>(
    options: *const leafless_options,
    operation: impl FnOnce(&Control<'_>) -> Result<R, Error>,
) -> Result<R, Failure> {
    let own = leafless_control { cancelled: AtomicBool::new(false), fraction: AtomicU64::new(0) };
    // SAFETY: the caller's promise.
    let options = unsafe { sized(options, "options")? };
    let control = match options.control.is_null() {
        true => &own,
        // SAFETY: a living handle, as the caller promises.
        false => unsafe { shared(options.control, "options.control")? },
    };
    let host = Host { progress: options.progress, ctx: options.progress_ctx, control };
    let progress = |fraction: f64| host.report(fraction);
    let limit = |most: u64| (most != 0).then_some(most);
    control.fraction.store(0, Relaxed);
    Ok(operation(&Control {
        // A thread of the library that waits for others takes up other work meanwhile. It would call the
        // host's function again during a call.
        threads: if rayon::current_thread_index().is_some() { 1 } else { options.threads as usize },
        max_nodes: limit(options.max_nodes),
        max_bytes: limit(options.max_bytes),
        max_splits: limit(options.max_splits),
        cancel: Some(&control.cancelled),
        progress: Some(&progress),
    })?)
}

/// Sets any struct that begins with `struct_size` to its default: its size, and zeros. In C and C++ the macro
/// LEAFLESS_INIT does the same; this function is for other languages.
///
/// - Buffers: `value`, one struct of `struct_size` bytes, which need not be initialised.
/// - Result: `*value`.
/// - Errors: LEAFLESS_E_ARGUMENT if `struct_size` is not sensible.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_init(value: *mut c_void, struct_size: usize) -> leafless_status {
    guard(|| unsafe { initialise(value, struct_size) })
}

/// Makes a control.
///
/// - Buffers: `control`, one pointer.
/// - Result: `*control`, not cancelled.
/// - Ownership: release `*control` with leafless_control_free, after the operations that use it are done.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_control_new(control: *mut *mut leafless_control) -> leafless_status {
    guard(|| unsafe {
        let control = out(control, "control")?;
        let (cancelled, fraction) = (AtomicBool::new(false), AtomicU64::new(0));
        control.write(handle(leafless_control { cancelled, fraction }))
    })
}

/// Releases a control.
///
/// - Buffers: `control`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_control_free(control: *mut leafless_control) {
    // SAFETY: the caller's promise.
    unsafe { release(control) }
}

/// Cancels the operations that run with this control. They return LEAFLESS_E_CANCELLED soon, and so do later
/// operations until leafless_control_reset.
///
/// - Buffers: `control`, a handle.
/// - Result: none; returns at once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_control_cancel(control: *const leafless_control) -> leafless_status {
    guard(|| unsafe {
        shared(control, "control")?.cancelled.store(true, Relaxed);
        Ok(())
    })
}

/// Makes a cancelled control usable again.
///
/// - Buffers: `control`, a handle.
/// - Threads: any, but operations that have not noticed the cancellation yet may go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_control_reset(control: *const leafless_control) -> leafless_status {
    guard(|| unsafe {
        let control = shared(control, "control")?;
        control.cancelled.store(false, Relaxed);
        control.fraction.store(0, Relaxed);
        Ok(())
    })
}

/// Returns whether a control was cancelled, and the progress of the operation that runs with it.
///
/// - Buffers: `control`, a handle; `cancelled` and `fraction`, one each, each may be NULL.
/// - Result: `*cancelled`; `*fraction`, 0 to 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_control_state(
    control: *const leafless_control,
    cancelled: *mut bool,
    fraction: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let control = shared(control, "control")?;
        let cancelled = if cancelled.is_null() { None } else { Some(out(cancelled, "cancelled")?) };
        let fraction = if fraction.is_null() { None } else { Some(out(fraction, "fraction")?) };
        if let Some(cancelled) = cancelled {
            cancelled.write(control.cancelled.load(Relaxed))?;
        }
        if let Some(fraction) = fraction {
            fraction.write(f64::from_bits(control.fraction.load(Relaxed)))?;
        }
        Ok(())
    })
}
