//! Set algebra and storage formats of tri-dexel models.

use super::boundary::{Failure, guard, out, shared, sized};
use super::control::{controlled, leafless_options};
use super::number::Number;
use super::operation::{leafless_operation, leafless_operation::*, operands};
use super::status::leafless_status;
use super::tridexel::{give, leafless_tridexel, leafless_tridexel_format};
use leafless::{Metadata, TriDexel, memory};

/// Combines tri-dexel models, at least one, by a set operation. The result is exact: all laws of sets hold.
/// It takes O(rays + intervals · log models), and is identical, bit for bit, for any number of threads. The
/// result stores the data that any operand stores; ends are doubles if those of one operand are. An end keeps
/// its surface and its normal, which is reversed where a subtraction exposes the other side. Where several
/// operands overlap, the material of the first one counts. Operands are combined in pairs: the limits of
/// `options` apply to each of these steps.
///
/// - Buffers: `tridexels`, `count` handles; `options`, one struct or NULL; `result`, one pointer. `operation`
///   is a leafless_operation.
/// - Result: `*result`, with the facts "name" and "units" if all operands have the same value of them, and no
///   other metadata.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT,
///   also if `count` is 0 or the operands have rays along different axes; LEAFLESS_E_DAMAGED if an operand
///   was mapped unverified and is damaged; LEAFLESS_E_LIMIT, also for 2^32 intervals along one axis;
///   LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands are unchanged; release `*result` with leafless_tridexel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any models.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_combine(
    operation: Number<leafless_operation>,
    tridexels: *const *const leafless_tridexel,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let operation = operation.known("operation")?;
        let models = operands(tridexels, count, false, "tridexels", |handle| &handle.model)?;
        let result = out(result, "result")?;
        let views = memory::collected(models.iter().map(|model| *model.view()))?;
        let made = controlled(options, |control| match operation {
            LEAFLESS_OPERATION_UNION => TriDexel::union_of(&views, control),
            LEAFLESS_OPERATION_INTERSECTION => TriDexel::intersection_of(&views, control),
            LEAFLESS_OPERATION_DIFFERENCE => TriDexel::difference_of(&views, control),
            LEAFLESS_OPERATION_XOR => TriDexel::xor_of(&views, control),
        })?;
        let common = Metadata::common(models.iter().map(|model| model.metadata()))?;
        result.write(give(made.with_metadata(common)))
    })
}

/// Returns the complement of a tri-dexel model inside its universe. O(rays of the universe + intervals).
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer.
/// - Result: as leafless_tridexel_combine.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also for 2^32 rays along one axis; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_tridexel_combine.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model; set `max_bytes` if its depth is untrusted.
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

/// Returns the same tri-dexel model in another storage format. Data that `tridexel` does not store are
/// unknown in the result: no surface, no normal, material 0. Doubles become fixed-point numbers and vice
/// versa; an interval that becomes empty by rounding is left out.
///
/// - Buffers: `format`, one struct or NULL; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, with the metadata of `tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT if a field of `format` is wrong, or `directions` are neither 0 nor those of
///   `tridexel`; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*result` with leafless_tridexel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_with_format(
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

/// Returns the same tri-dexel model with one material for all intervals.
///
/// - Buffers: `options`, one struct or NULL; `result`, one pointer. `material` is any number.
/// - Result: `*result`, which stores materials, with the metadata of `tridexel`.
/// - Errors: LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `tridexel` is unchanged; release `*result` with leafless_tridexel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any model, any number.
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
