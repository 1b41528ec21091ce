//! Attributes that the host program implements.

use super::attribute::{components, give, leafless_attribute, leafless_value_range};
use super::boundary::{Failure, Sized32, guard, out, sized};
use super::host::{done, leafless_destroy_fn};
use super::status::leafless_status;
use core::ffi::c_void;
use leafless::Bounds;
use leafless::Error;
use leafless::attribute::{Attribute, ValueRange};
use leafless::memory;

/// Computes the value of the host's attribute at a point (3 numbers, model units): sets the numbers of
/// `value`, one for each component of the attribute. All are NaN before and stay NaN where there is no value;
/// a value whose first number is NaN counts as no value. Returns 0, or the host's own error code, which ends
/// the operation with LEAFLESS_E_CALLBACK and the code in the message.
///
/// It is called from several threads at once, which may all be the library's own, unless the operation's
/// options have `threads` = 1. It must give the same answer to the same point. It must return: no exception,
/// no longjmp. It may call this library.
pub type leafless_attribute_value_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, point: *const f64, value: *mut f64) -> i32>;

/// Computes the values at `count` points (3 numbers each) at once, for hosts that do this faster than one by
/// one: the numbers of the first value, then those of the second, and so on. Otherwise as
/// leafless_attribute_value_fn.
pub type leafless_attribute_values_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, points: *const f64, count: u64, values: *mut f64) -> i32>;

/// Bounds the values of the host's attribute in the interior of the box [min, max] (3 numbers each, model
/// units): sets `kind` and the intervals of `*range`. Before the call the kind is LEAFLESS_RANGE_KIND_UNKNOWN
/// and all numbers are NaN. The range must be proven: a wrong range hides details, because the library does
/// not search further. An interval that contains a NaN, or with lower > upper, proves nothing; an invalid
/// `kind` ends the operation with LEAFLESS_E_CALLBACK. Otherwise as leafless_attribute_value_fn.
pub type leafless_attribute_range_fn = Option<
    unsafe extern "C" fn(
        ctx: *mut c_void,
        min: *const f64,
        max: *const f64,
        range: *mut leafless_value_range,
    ) -> i32,
>;

/// An attribute of the host. `components` and one of `value` and `values` must be set; all other fields but
/// the first may be zero.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_attribute_callbacks {
    /// sizeof(leafless_attribute_callbacks).
    pub struct_size: u32,
    /// Numbers per value: 1 to 4.
    pub components: u32,
    /// Computes the value at a point; not called if `values` is set.
    pub value: leafless_attribute_value_fn,
    /// Computes the values at many points, as many as the operation has ready.
    pub values: leafless_attribute_values_fn,
    /// Bounds the values in a box; optional. With it, channels that hardly change are filled without a call
    /// for every cell, and LEAFLESS_CRITERION_RANGE misses no detail.
    pub range: leafless_attribute_range_fn,
    /// Called when the library no longer needs `ctx`; optional.
    pub destroy: leafless_destroy_fn,
    /// The context that the functions are called with.
    pub ctx: *mut c_void,
}

// SAFETY: numbers, a pointer, and optional functions.
unsafe impl Sized32 for leafless_attribute_callbacks {}

/// The host's functions with their context.
struct HostAttribute {
    callbacks: leafless_attribute_callbacks,
    components: usize,
}

// SAFETY: the library only passes `ctx` back to the host. By their documented contract, the functions may be
// called from any thread.
unsafe impl Send for HostAttribute {}
// SAFETY: as above.
unsafe impl Sync for HostAttribute {}

impl Drop for HostAttribute {
    fn drop(&mut self) {
        if let Some(destroy) = self.callbacks.destroy {
            // SAFETY: as the host gave it, with its own context; this is the only place that calls it.
            unsafe { destroy(self.callbacks.ctx) }
        }
    }
}

impl HostAttribute {
    /// Returns the value that the numbers mean.
    fn value(&self, numbers: &[f64]) -> Option<[f64; 4]> {
        let mut value = [0.0; 4];
        for (to, &number) in value.iter_mut().zip(numbers).take(self.components) {
            *to = number;
        }
        (!value[0].is_nan()).then_some(value)
    }
}

// SAFETY, of all calls here: the functions are as the host gave them, called with their own context and with
// the documented counts of numbers.
impl Attribute for HostAttribute {
    fn components(&self) -> usize {
        self.components
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        let ctx = self.callbacks.ctx;
        if let Some(many) = self.callbacks.values {
            let mut numbers = memory::filled(points.len().saturating_mul(self.components), f64::NAN)?;
            // SAFETY: as above.
            done(unsafe { many(ctx, points.as_ptr().cast(), points.len() as u64, numbers.as_mut_ptr()) })?;
            for (to, numbers) in values.iter_mut().zip(numbers.chunks_exact(self.components)) {
                *to = self.value(numbers);
            }
        } else if let Some(one) = self.callbacks.value {
            for (to, point) in values.iter_mut().zip(points) {
                let mut numbers = [f64::NAN; 4];
                // SAFETY: as above.
                done(unsafe { one(ctx, point.as_ptr(), numbers.as_mut_ptr()) })?;
                *to = self.value(&numbers);
            }
        }
        Ok(())
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let Some(range) = self.callbacks.range else { return Ok(ValueRange::Unknown) };
        let mut found = leafless_value_range::UNKNOWN;
        let (min, max) = (bounds.min.as_ptr(), bounds.max.as_ptr());
        // SAFETY: as above.
        done(unsafe { range(self.callbacks.ctx, min, max, &mut found) })?;
        found.range(self.components)
    }
}

/// Makes an attribute from the host's own functions.
///
/// - Buffers: `callbacks`, one struct, which is copied; `attribute`, one pointer.
/// - Result: `*attribute`.
/// - Errors: LEAFLESS_E_NULL if `value` and `values` are NULL; LEAFLESS_E_ARGUMENT unless `components` is 1
///   to 4. After an error `destroy` is not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; release `*attribute` with
///   leafless_attribute_free.
/// - Threads: any; leafless_attribute_value_fn describes the threads that call the functions.
/// - Untrusted input: any answers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_attribute_new_callbacks(
    callbacks: *const leafless_attribute_callbacks,
    attribute: *mut *mut leafless_attribute,
) -> leafless_status {
    guard(|| unsafe {
        if callbacks.is_null() {
            return Err(Failure::Null { name: "callbacks" });
        }
        let callbacks = sized(callbacks, "callbacks")?;
        if callbacks.value.is_none() && callbacks.values.is_none() {
            return Err(Failure::Null { name: "callbacks.value" });
        }
        let components = components(callbacks.components, "callbacks.components")?;
        let attribute = out(attribute, "attribute")?;
        // From here on the library owns the host's context.
        attribute.write(give(HostAttribute { callbacks, components }))
    })
}
