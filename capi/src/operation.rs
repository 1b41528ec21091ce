//! The set operations for operands of every kind.

use super::boundary::{Failure, shared, slice};
use super::number::enumeration;
use leafless::memory;

/// A set operation on several operands.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_operation {
    /// The points of at least one operand.
    LEAFLESS_OPERATION_UNION = 0,
    /// The points that all operands have in common.
    LEAFLESS_OPERATION_INTERSECTION = 1,
    /// The points of the first operand that lie in none of the others.
    LEAFLESS_OPERATION_DIFFERENCE = 2,
    /// The points that lie in an odd number of operands: for two operands, in exactly one.
    LEAFLESS_OPERATION_XOR = 3,
}
use leafless_operation::*;

enumeration! {
    leafless_operation => leafless_operation {
        LEAFLESS_OPERATION_UNION => LEAFLESS_OPERATION_UNION,
        LEAFLESS_OPERATION_INTERSECTION => LEAFLESS_OPERATION_INTERSECTION,
        LEAFLESS_OPERATION_DIFFERENCE => LEAFLESS_OPERATION_DIFFERENCE,
        LEAFLESS_OPERATION_XOR => LEAFLESS_OPERATION_XOR,
    }
}

/// Returns the results of `part` for each operand.
///
/// # Safety
/// As [`slice`] and, for each element, [`shared`].
pub(super) unsafe fn operands<'a, H: 'a, P>(
    handles: *const *const H,
    count: u64,
    may_be_none: bool,
    name: &'static str,
    part: impl Fn(&'a H) -> P,
) -> Result<Vec<P>, Failure> {
    // SAFETY: as the caller promises.
    let handles = unsafe { slice(handles, count, name)? };
    if handles.is_empty() && !may_be_none {
        return Err(Failure::Argument { name: "count", problem: "must be at least 1" });
    }
    let mut parts = memory::with_capacity(handles.len())?;
    for &handle in handles {
        // SAFETY: as the caller promises.
        parts.push(part(unsafe { shared(handle, name)? }));
    }
    Ok(parts)
}
