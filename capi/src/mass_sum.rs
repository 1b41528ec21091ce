//! Exact sums of the measures of a frame's cells, for solids that several machines measure.

use super::boundary::{Failure, Sized32, filled, guard, output, shared, sized};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::measure::leafless_measures;
use super::shard::{cell_of, renamed};
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::Tolerance;
use leafless::query::{MassSum, measure_in};

/// The volume and the moments of a solid in some cells of its frame.
///
/// Sums are exact: they are the same in any order, and subtracting a sum that was added restores the earlier
/// sum. So several machines can measure the cells of one solid, and one machine adds the results.
///
/// The struct has no pointers. A program may store its bytes or send them to another machine. Only the
/// version of the library that made a sum can read it. The functions refuse bytes that are not a sum, but
/// they cannot detect every damage.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mass_sum {
    /// sizeof(leafless_mass_sum).
    pub struct_size: u32,
    /// For internal use of the library.
    pub bytes: [u8; 404],
}

output!(leafless_mass_sum);
const _: () = assert!(MassSum::BYTES == 404);

// SAFETY: numbers.
unsafe impl Sized32 for leafless_mass_sum {}

impl From<MassSum> for leafless_mass_sum {
    fn from(sum: MassSum) -> leafless_mass_sum {
        leafless_mass_sum { struct_size: size_of::<leafless_mass_sum>() as u32, bytes: sum.to_bytes() }
    }
}

/// Returns the sum at `pointer`.
///
/// # Safety
/// As [`sized`].
unsafe fn sum_of(pointer: *const leafless_mass_sum, name: &'static str) -> Result<MassSum, Failure> {
    if pointer.is_null() {
        return Err(Failure::Null { name });
    }
    // SAFETY: the caller's promise.
    let given = unsafe { sized(pointer, name)? };
    // The missing bytes of a shorter struct were lost when it was written; they are not zero.
    if (given.struct_size as usize) < size_of::<leafless_mass_sum>() {
        return Err(Failure::Argument { name, problem: "is too short for a sum of this version" });
    }
    let problem = "is no sum of this version, or is damaged";
    MassSum::from_bytes(&given.bytes).map_err(|_| Failure::Argument { name, problem })
}

/// Measures the part of a solid in one cell of a frame, as leafless_solid_measure measures the whole. The
/// tolerances apply to the volume in the cell. A solid that provides its own moments is split all the same.
///
/// If the solid is an octree without surfaces, and both tolerances are 0, the sum over all cells of a level
/// has the measures of the whole octree.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL (`max_nodes` and `max_bytes` are ignored);
///   `sum`, one struct. `code` is the code of a cell of level `level`, as in leafless_shard.
/// - Result: `*sum`.
/// - Errors: as leafless_solid_measure; LEAFLESS_E_ARGUMENT also if the frame does not have the cell.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_measure_cell(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    level: u32,
    code: u64,
    relative: f64,
    absolute_model: f64,
    options: *const leafless_options,
    sum: *mut leafless_mass_sum,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let cell = cell_of(&frame, level, code, ["level", "code"])?;
        let sum = filled(sum, "sum")?;
        let tolerance = Tolerance { relative, absolute: absolute_model };
        sum.write(controlled(options, |control| measure_in(solid, &frame, cell, tolerance, control))?.into())
    })
}

/// Returns the sum of a cell whose content is unknown. Adding it to a sum keeps the proofs of that sum.
///
/// To measure a top and its shards: take the sum of the top in the whole universe (level 0, code 0). For each
/// shard subtract the unknown sum of its cell, and add the sum of the shard in that cell.
///
/// - Buffers: `frame` and `sum`, one struct each. `code` is the code of a cell of level `level`, as in
///   leafless_shard.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if the frame does not have the cell.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mass_sum_unknown(
    frame: *const leafless_frame,
    level: u32,
    code: u64,
    sum: *mut leafless_mass_sum,
) -> leafless_status {
    guard(|| unsafe {
        let frame = self::frame(frame)?;
        let cell = cell_of(&frame, level, code, ["level", "code"])?;
        filled(sum, "sum")?.write(MassSum::unknown(&frame, cell)?.into())
    })
}

/// Adds two sums over disjoint sets of cells.
///
/// - Buffers: `a`, `b` and `sum`, one struct each; `sum` may be `a` or `b`.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if `a` or `b` is not a sum of this version, or if the result exceeds the
///   universe, because a cell was added twice; LEAFLESS_E_FRAME if the frames differ.
/// - Untrusted input: any bytes; damaged sums give a wrong result.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mass_sum_add(
    a: *const leafless_mass_sum,
    b: *const leafless_mass_sum,
    sum: *mut leafless_mass_sum,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (sum_of(a, "a")?, sum_of(b, "b")?);
        let sum = filled(sum, "sum")?;
        sum.write(a.plus(&b).map_err(|error| renamed(error.into(), "b"))?.into())
    })
}

/// Subtracts the sum `b` over some cells of `a` from `a`. The result proves what `a` proves. The numbers of
/// splits are added.
///
/// - Buffers: as leafless_mass_sum_add.
/// - Result: `*sum`.
/// - Errors: LEAFLESS_E_ARGUMENT if `a` or `b` is not a sum of this version, or if the result would be
///   negative; LEAFLESS_E_FRAME if the frames differ.
/// - Untrusted input: any bytes; damaged sums give a wrong result.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mass_sum_subtract(
    a: *const leafless_mass_sum,
    b: *const leafless_mass_sum,
    sum: *mut leafless_mass_sum,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (sum_of(a, "a")?, sum_of(b, "b")?);
        let sum = filled(sum, "sum")?;
        sum.write(a.minus(&b).map_err(|error| renamed(error.into(), "b"))?.into())
    })
}

/// Returns volume, centroid and inertia of the solid in the cells of a sum. `is_exact` is false.
///
/// - Buffers: `sum` and `measures`, one struct each.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT if `sum` is not a sum of this version, or if the frame's universe is too
///   small for cells of level 20.
/// - Untrusted input: any bytes; a damaged sum gives wrong measures.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mass_sum_measures(
    sum: *const leafless_mass_sum,
    measures: *mut leafless_measures,
) -> leafless_status {
    guard(|| unsafe {
        let sum = sum_of(sum, "sum")?;
        filled(measures, "measures")?.write(sum.properties()?.into())
    })
}
