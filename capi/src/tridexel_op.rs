//! Set algebra of tri-dexel models, and what they store.

use super::boundary::{Failure, guard, out, shared, sized, slice};
use super::control::{controlled, leafless_options};
use super::status::leafless_status;
use super::tridexel::{give, leafless_tridexel, leafless_tridexel_format};
use leafless::Control;
use leafless::Error;
use leafless::Metadata;
use leafless::TriDexel;
use leafless::dexel::TriDexelRef;
use leafless::memory;

type Binary = fn(&TriDexelRef<'_>, &TriDexelRef<'_>, &Control<'_>) -> Result<TriDexel, Error>;
type Nary = fn(&[TriDexelRef<'_>], &Control<'_>) -> Result<TriDexel, Error>;

/// # Safety
/// As the functions below.
unsafe fn binary(
    operation: Binary,
    a: *const leafless_tridexel,
    b: *const leafless_tridexel,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (&shared(a, "a")?.model, &shared(b, "b")?.model);
        let result = out(result, "result")?;
        let made = controlled(options, |control| operation(a.view(), b.view(), control))?;
        result.write(give(made.with_metadata(Metadata::common([a.metadata(), b.metadata()])?)))
    })
}

/// # Safety
/// As the functions below.
unsafe fn nary(
    operation: Nary,
    tridexels: *const *const leafless_tridexel,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let tridexels = slice(tridexels, count, "tridexels")?;
        let result = out(result, "result")?;
        let mut views = memory::with_capacity(tridexels.len())?;
        let mut metadata = memory::with_capacity(tridexels.len())?;
        for &tridexel in tridexels {
            let model = &shared(tridexel, "tridexels")?.model;
            views.push(*model.view());
            metadata.push(model.metadata());
        }
        if views.is_empty() {
            return Err(Failure::Argument { name: "count", problem: "must be at least 1" });
        }
        let made = controlled(options, |control| operation(&views, control))?;
        result.write(give(made.with_metadata(Metadata::common(metadata.iter().copied())?)))
    })
}

/// The points that lie in `a`, in `b`, or in both. Exact: all laws of sets hold. O(rays + intervals), and the same bit for
/// bit for any number of threads. The result stores what either operand does; ends are doubles if those of one operand
/// are. An end keeps its surface and its normal, turned about where a subtraction shows its other side. Where both
/// operands hold a place, the material of `a` counts.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, with those of the facts "name" and "units" that all operands have with one value, and
///   no other metadata.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_ARGUMENT if the operands have rays along different axes;
///   LEAFLESS_E_DAMAGED if an operand was mapped unverified and is damaged; LEAFLESS_E_LIMIT, also for 2^32 intervals along
///   one axis; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands stay as they are; give `*result` back with leafless_tridexel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any models.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_union(
    a: *const leafless_tridexel,
    b: *const leafless_tridexel,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { binary(|a, b, control| a.union(b, control), a, b, options, result) }
}

/// The points that `a` and `b` have in common.
///
/// - Buffers: as leafless_tridexel_union.
/// - Result: as leafless_tridexel_union.
/// - Errors: as leafless_tridexel_union.
/// - Ownership: as leafless_tridexel_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any models.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_intersection(
    a: *const leafless_tridexel,
    b: *const leafless_tridexel,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { binary(|a, b, control| a.intersection(b, control), a, b, options, result) }
}

/// `a` without `b`.
///
/// - Buffers: as leafless_tridexel_union.
/// - Result: as leafless_tridexel_union.
/// - Errors: as leafless_tridexel_union.
/// - Ownership: as leafless_tridexel_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any models.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_difference(
    a: *const leafless_tridexel,
    b: *const leafless_tridexel,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { binary(|a, b, control| a.difference(b, control), a, b, options, result) }
}

/// The points of just one of `a` and `b`.
///
/// - Buffers: as leafless_tridexel_union.
/// - Result: as leafless_tridexel_union.
/// - Errors: as leafless_tridexel_union.
/// - Ownership: as leafless_tridexel_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any models.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_xor(
    a: *const leafless_tridexel,
    b: *const leafless_tridexel,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { binary(|a, b, control| a.xor(b, control), a, b, options, result) }
}

/// The points of the universe that do not lie in `tridexel`. O(rays of the universe + intervals).
///
/// - Buffers: as leafless_tridexel_union.
/// - Result: as leafless_tridexel_union.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also for 2^32 rays along one axis; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_tridexel_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model; set `max_bytes` where its depth is not your own choice.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_complement(
    tridexel: *const leafless_tridexel,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let result = out(result, "result")?;
        let made = controlled(options, |control| model.view().complement(control))?;
        result.write(give(made.with_metadata(Metadata::common([model.metadata()])?)))
    })
}

/// The union of any number of tri-dexel models, at least one. Where several hold a place, the material of the first one
/// counts. O(rays + intervals · log models). Limits of `options` concern each of its steps.
///
/// - Buffers: `tridexels`, `count` handles; `options`, one struct or NULL; `result`, one pointer.
/// - Result: as leafless_tridexel_union.
/// - Errors: as leafless_tridexel_union, and LEAFLESS_E_ARGUMENT if `count` is 0.
/// - Ownership: as leafless_tridexel_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any models.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_union_of(
    tridexels: *const *const leafless_tridexel,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { nary(TriDexel::union_of, tridexels, count, options, result) }
}

/// The intersection of any number of tri-dexel models, at least one.
///
/// - Buffers: as leafless_tridexel_union_of.
/// - Result: as leafless_tridexel_union.
/// - Errors: as leafless_tridexel_union_of.
/// - Ownership: as leafless_tridexel_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any models.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_intersection_of(
    tridexels: *const *const leafless_tridexel,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { nary(TriDexel::intersection_of, tridexels, count, options, result) }
}

/// The points that lie in an odd number of tri-dexel models, at least one.
///
/// - Buffers: as leafless_tridexel_union_of.
/// - Result: as leafless_tridexel_union.
/// - Errors: as leafless_tridexel_union_of.
/// - Ownership: as leafless_tridexel_union.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any models.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_xor_of(
    tridexels: *const *const leafless_tridexel,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { nary(TriDexel::xor_of, tridexels, count, options, result) }
}

/// The same tri-dexel model with other things stored. What `tridexel` does not store is unknown in the result: no surface,
/// no normal, material 0. Doubles become fixed-point numbers and back; an interval that this makes empty is left out.
///
/// - Buffers: `format`, one struct or NULL; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, with the metadata of `tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT if a field of `format` is wrong, or `directions` are neither 0 nor those of `tridexel`;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` stays as it is; give `*result` back with leafless_tridexel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_to_format(
    tridexel: *const leafless_tridexel,
    format: *const leafless_tridexel_format,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let (directions, format) = sized(format, "format")?.parts()?;
        if directions.is_some_and(|wanted| wanted != model.view().directions()) {
            let problem = "must be 0, or those of the model";
            return Err(Failure::Argument { name: "format.directions", problem });
        }
        let result = out(result, "result")?;
        let made = controlled(options, |control| model.view().to_format(format, control))?;
        result.write(give(made.with_metadata(model.metadata().clone())))
    })
}

/// The same tri-dexel model, all of it of one material.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer. `material` is any number.
/// - Result: `*result`, which stores materials, with the metadata of `tridexel`.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` stays as it is; give `*result` back with leafless_tridexel_free.
/// - Threads: any; uses as many as `options` says.
/// - Untrusted input: any model, any number.
/// - Since: 0.1
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_with_material(
    tridexel: *const leafless_tridexel,
    material: u32,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let result = out(result, "result")?;
        let made = controlled(options, |control| model.view().with_material(material, control))?;
        result.write(give(made.with_metadata(model.metadata().clone())))
    })
}
