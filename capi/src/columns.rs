//! Columns of cells along an axis: runs of solid cells, and height maps.

use super::boundary::{Failure, array, buffer, guard, handle, out, release, shared};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::number::{Number, enumeration};
use super::octree::leafless_octree;
use super::rays::leafless_obstacle;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::query::{ColumnCells, Columns, Heights, Obstacle, Run, Side, columns, heights};
use leafless::{Frame, Interval};

/// Consecutive finest cells of a column.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_run {
    /// The coordinate of the lowest cell along the column.
    pub start: u32,
    /// Number of cells, at least one.
    pub length: u32,
}

impl From<&Run> for leafless_run {
    fn from(run: &Run) -> leafless_run {
        leafless_run { start: run.start, length: run.length }
    }
}

/// The side from which columns are viewed.
#[repr(u32)]
pub enum leafless_side {
    /// From above, towards lower coordinates: the height is that of the highest cell.
    LEAFLESS_SIDE_ABOVE = 0,
    /// From below: the height is that of the lowest cell.
    LEAFLESS_SIDE_BELOW = 1,
}

/// The solid cells of columns, as runs.
///
/// Immutable: any number of threads may read it at once.
pub struct leafless_columns(ColumnCells);

/// Returns the rectangle with these corners, or all columns of a frame.
///
/// # Safety
/// As [`array`] for a corner that is not NULL.
unsafe fn rectangle(
    frame: &Frame,
    axis: u32,
    first: *const u32,
    end: *const u32,
) -> Result<Columns, Failure> {
    let axis = axis.try_into().unwrap_or(usize::MAX);
    // A rectangle needs both of its corners.
    if first.is_null() && end.is_null() {
        return Ok(Columns::all(frame, axis)?);
    }
    // SAFETY: the caller's promise.
    unsafe { Ok(Columns::within(axis, array(first, "first")?, array(end, "end")?)?) }
}

enumeration! {
    leafless_side => Side {
        LEAFLESS_SIDE_ABOVE => Side::Above,
        LEAFLESS_SIDE_BELOW => Side::Below,
    }
}

/// Returns the solid cells of an octree in a rectangle of columns, regardless of their proofs about the
/// original solid. A column is a row of finest cells along an axis, from one side of the universe to the
/// other. It stands for all lines along the axis within it, such as the ray through the centres of its cells.
/// O(cells in the columns + columns · cells along each), where a stored cell counts once.
///
/// - Buffers: `first` and `end`, 2 numbers each, or both NULL for all columns: the coordinates of the first
///   column's cells on the other two axes in the order x, y, z, and the first coordinates beyond the last
///   column; `columns`, one pointer. `axis` is 0 for x, 1 for y, 2 for z.
/// - Result: `*columns`, to be read with leafless_columns_copy.
/// - Errors: LEAFLESS_E_ARGUMENT if `axis` is greater than 2, `first` lies beyond `end`, or the columns reach
///   beyond the universe; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*columns` with leafless_columns_free.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is visited
///   twice.
///
/// cbindgen:ptrs-as-arrays=[[first; 2], [end; 2]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_columns(
    octree: *const leafless_octree,
    axis: u32,
    first: *const u32,
    end: *const u32,
    columns: *mut *mut leafless_columns,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let rectangle = rectangle(octree.frame(), axis, first, end)?;
        let columns = out(columns, "columns")?;
        columns.write(handle(leafless_columns(octree.columns(&rectangle)?)))
    })
}

/// Returns the solid cells of a frame in a rectangle of columns, without an octree: all PARTIAL cells in the
/// columns are split down to the frame's depth.
///
/// - Buffers: as leafless_octree_columns; `frame`, one struct; `options`, one struct or NULL (only its limit
///   `max_bytes` applies).
/// - Result: `*columns`, to be read with leafless_columns_copy; identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_columns; LEAFLESS_E_LIMIT if the result takes more than
///   `max_bytes`; otherwise as leafless_solid_contains_many.
/// - Ownership: release `*columns` with leafless_columns_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; choose the depth and the rectangle yourself.
///
/// cbindgen:ptrs-as-arrays=[[first; 2], [end; 2]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_columns(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    axis: u32,
    first: *const u32,
    end: *const u32,
    options: *const leafless_options,
    columns: *mut *mut leafless_columns,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let rectangle = rectangle(&frame, axis, first, end)?;
        let to = out(columns, "columns")?;
        let found = controlled(options, |control| self::columns(solid, &frame, &rectangle, control))?;
        to.write(handle(leafless_columns(found)))
    })
}

/// Copies the runs of solid cells in columns, in compressed rows: the runs of column i are `runs[offsets[i]]`
/// up to, but not including, `runs[offsets[i + 1]]`. They ascend, and no two of them touch. In a rectangle
/// that is `width` columns wide along the first of the other two axes, the column at steps (u, v) from the
/// first has the index i = v · width + u.
///
/// - Buffers: `offsets`, room for `offset_capacity` numbers, and `runs`, room for `run_capacity` structs,
///   each NULL to get only its count; `offset_count` and `run_count`, one number each. `on` is a
///   leafless_obstacle: FULL for cells that are proven solid, UPPER for cells that may be solid.
/// - Result: `offsets`, one more than columns; `runs`; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is not a leafless_obstacle; LEAFLESS_E_BUFFER if a capacity is too
///   small: nothing is written then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_columns_copy(
    columns: *const leafless_columns,
    on: Number<leafless_obstacle>,
    offsets: *mut u64,
    offset_capacity: u64,
    offset_count: *mut u64,
    runs: *mut leafless_run,
    run_capacity: u64,
    run_count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let cells = &shared(columns, "columns")?.0;
        let found = match on.known("on")? {
            Obstacle::Full => &cells.full,
            Obstacle::Upper => &cells.upper,
        };
        let (offsets, runs) =
            (buffer(offsets, offset_capacity, "offsets")?, buffer(runs, run_capacity, "runs")?);
        let (offset_count, run_count) = (out(offset_count, "offset_count")?, out(run_count, "run_count")?);
        offsets.check(found.offsets().len())?;
        runs.check(found.runs().len())?;
        offsets.fill(found.offsets())?;
        runs.fill_with(found.runs())?;
        offset_count.write(found.offsets().len() as u64)?;
        run_count.write(found.runs().len() as u64)
    })
}

/// Frees columns.
///
/// - Buffers: `columns`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_columns_free(columns: *mut leafless_columns) {
    // SAFETY: the caller's promise.
    unsafe { release(columns) }
}

/// Writes the heights of columns to the host's buffer.
///
/// # Safety
/// As [`buffer`] and [`out`].
unsafe fn write_heights(
    rectangle: &Columns,
    found: impl FnOnce() -> Result<Heights, Failure>,
    heights: (*mut leafless_interval, u64, *mut u64),
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        let (to, count) = (buffer(heights.0, heights.1, "heights_model")?, out(heights.2, "count")?);
        let needed = usize::try_from(rectangle.count()).unwrap_or(usize::MAX);
        to.check(needed)?;
        if to.wanted() {
            let map = found()?;
            let nowhere = match map.side() {
                Side::Above => Interval::exactly(f64::NEG_INFINITY),
                Side::Below => Interval::exactly(f64::INFINITY),
            };
            for index in 0..needed {
                heights.0.add(index).write(map.height(index).unwrap_or(nowhere).into());
            }
        }
        count.write(rectangle.count())
    }
}

/// Computes a height map: how far an octree's solid cells reach in a rectangle of columns, regardless of
/// their proofs about the original solid. It costs as much as leafless_octree_columns.
///
/// - Buffers: `first` and `end` as leafless_octree_columns; `heights_model`, room for `capacity` structs, or
///   NULL to get only the count; `count`, one number. `side` is a leafless_side.
/// - Result: `*count`, the number of columns; for each column, in the order of leafless_columns_copy, an
///   interval that contains the greatest coordinate of the solid's points in the column, or from below the
///   least one. The end that needs a proof is infinite if no cell of the column is FULL. Both are -INFINITY
///   (from below INFINITY) if the column is empty.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_columns, or if `side` is not a leafless_side;
///   LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is visited
///   twice.
///
/// cbindgen:ptrs-as-arrays=[[first; 2], [end; 2]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_heights(
    octree: *const leafless_octree,
    axis: u32,
    first: *const u32,
    end: *const u32,
    side: Number<leafless_side>,
    heights_model: *mut leafless_interval,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let rectangle = rectangle(octree.frame(), axis, first, end)?;
        let side = side.known("side")?;
        let found = || Ok(octree.heights(&rectangle, side)?);
        write_heights(&rectangle, found, (heights_model, capacity, count))
    })
}

/// Computes a height map: how far a solid reaches in a rectangle of columns, without an octree, as far as the
/// cells of the frame decide it. PARTIAL cells in the columns are split down to the frame's depth, unless
/// FULL cells hide them.
///
/// - Buffers: as leafless_octree_heights; `frame`, one struct; `options`, one struct or NULL (only its limit
///   `max_bytes` applies).
/// - Result: as leafless_octree_heights; identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_octree_heights; LEAFLESS_E_BUFFER if the capacity is too small;
///   LEAFLESS_E_LIMIT if the result takes more than `max_bytes`; otherwise as leafless_solid_contains_many.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; choose the depth and the rectangle yourself.
///
/// cbindgen:ptrs-as-arrays=[[first; 2], [end; 2]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_heights(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    axis: u32,
    first: *const u32,
    end: *const u32,
    side: Number<leafless_side>,
    options: *const leafless_options,
    heights_model: *mut leafless_interval,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let rectangle = rectangle(&frame, axis, first, end)?;
        let side = side.known("side")?;
        let found = || controlled(options, |control| self::heights(solid, &frame, &rectangle, side, control));
        write_heights(&rectangle, found, (heights_model, capacity, count))
    })
}
