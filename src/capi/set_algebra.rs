//! The set algebra of octrees.

use super::boundary::{Failure, guard, out, shared, slice};
use super::control::{controlled, leafless_options};
use super::octree::{give, leafless_octree};
use super::status::leafless_status;
use crate::control::Control;
use crate::error::Error;
use crate::octree::{Octree, OctreeRef};
use crate::op;
use alloc::vec::Vec;

type Binary = fn(&OctreeRef<'_>, &OctreeRef<'_>, &Control<'_>) -> Result<Octree, Error>;
type Nary = fn(&[OctreeRef<'_>], &Control<'_>) -> Result<Octree, Error>;

/// # Safety
/// As the functions below.
unsafe fn binary(
    operation: Binary,
    a: *const leafless_octree,
    b: *const leafless_octree,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (shared(a, "a")?.octree.view(), shared(b, "b")?.octree.view());
        let result = out(result, "result")?;
        result.write(give(controlled(options, |control| operation(a, b, control))?))
    })
}

/// # Safety
/// As the functions below.
unsafe fn nary(
    operation: Nary,
    octrees: *const *const leafless_octree,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octrees = slice(octrees, count, "octrees")?;
        let result = out(result, "result")?;
        let mut views = Vec::new();
        views.try_reserve_exact(octrees.len()).map_err(|_| Error::OutOfMemory)?;
        for &octree in octrees {
            views.push(*shared(octree, "octrees")?.octree.view());
        }
        if views.is_empty() {
            return Err(Failure::Argument { name: "count", problem: "must be at least 1" });
        }
        result.write(give(controlled(options, |control| operation(&views, control))?))
    })
}

/// Every point of `a` and of `b`. Exact, and the same bit for bit for any number of threads; never larger than
/// both operands together.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, without metadata.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands stay as they are; give `*result` back with leafless_octree_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any octrees; damage in ones that were mapped unverified is an error or reads as PARTIAL.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_union(
    a: *const leafless_octree,
    b: *const leafless_octree,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { binary(op::union, a, b, options, result) }
}

/// The points that `a` and `b` have in common.
///
/// - Buffers: as leafless_octree_union.
/// - Result: as leafless_octree_union.
/// - Errors: as leafless_octree_union.
/// - Ownership: as leafless_octree_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_octree_union.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_intersection(
    a: *const leafless_octree,
    b: *const leafless_octree,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { binary(op::intersection, a, b, options, result) }
}

/// `a` without `b`.
///
/// - Buffers: as leafless_octree_union.
/// - Result: as leafless_octree_union.
/// - Errors: as leafless_octree_union.
/// - Ownership: as leafless_octree_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_octree_union.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_difference(
    a: *const leafless_octree,
    b: *const leafless_octree,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { binary(op::difference, a, b, options, result) }
}

/// The points of just one of `a` and `b`.
///
/// - Buffers: as leafless_octree_union.
/// - Result: as leafless_octree_union.
/// - Errors: as leafless_octree_union.
/// - Ownership: as leafless_octree_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_octree_union.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_xor(
    a: *const leafless_octree,
    b: *const leafless_octree,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { binary(op::xor, a, b, options, result) }
}

/// Everything but `octree`, inside of its universe and out.
///
/// - Buffers: as leafless_octree_union.
/// - Result: as leafless_octree_union.
/// - Errors: as leafless_octree_union.
/// - Ownership: as leafless_octree_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_octree_union.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_complement(
    octree: *const leafless_octree,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = shared(octree, "octree")?.octree.view();
        let result = out(result, "result")?;
        result.write(give(controlled(options, |control| op::complement(octree, control))?))
    })
}

/// The union of any number of octrees, at least one. Limits and progress of `options` concern each of its steps.
///
/// - Buffers: `octrees`, `count` handles; `options`, one struct or NULL; `result`, one pointer.
/// - Result: as leafless_octree_union.
/// - Errors: as leafless_octree_union, and LEAFLESS_E_ARGUMENT if `count` is 0.
/// - Ownership: as leafless_octree_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_octree_union.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_union_of(
    octrees: *const *const leafless_octree,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { nary(op::union_of, octrees, count, options, result) }
}

/// The intersection of any number of octrees, at least one.
///
/// - Buffers: as leafless_octree_union_of.
/// - Result: as leafless_octree_union.
/// - Errors: as leafless_octree_union_of.
/// - Ownership: as leafless_octree_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_octree_union.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_intersection_of(
    octrees: *const *const leafless_octree,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { nary(op::intersection_of, octrees, count, options, result) }
}

/// The points that lie in an odd number of octrees, at least one.
///
/// - Buffers: as leafless_octree_union_of.
/// - Result: as leafless_octree_union.
/// - Errors: as leafless_octree_union_of.
/// - Ownership: as leafless_octree_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: as leafless_octree_union.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_xor_of(
    octrees: *const *const leafless_octree,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { nary(op::xor_of, octrees, count, options, result) }
}
