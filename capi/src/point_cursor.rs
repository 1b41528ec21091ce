//! Repeated point queries of a stored octree: cursors and tables.

use super::boundary::{array, discard, exclusive, guard, out, share, shared, slice};
use super::contains::{answers, leafless_membership};
use super::octree::{leafless_octree, leafless_tag};
use super::status::leafless_status;
use leafless::query::{PointCursor, PointTable};
use std::sync::Arc;
use yoke::Yoke;

/// A cursor for point queries that keeps the path to the last cell: for points near each other, such as along
/// a line or in scan order.
///
/// Every call changes the cursor: only one thread may use it at a time. Each thread may have its own cursor.
pub struct leafless_point_cursor(Yoke<PointCursor<'static>, Arc<leafless_octree>>);

/// Makes a point cursor.
///
/// - Buffers: `cursor`, one pointer.
/// - Result: `*cursor`.
/// - Ownership: the cursor shares the octree, which may be freed; release `*cursor` with
///   leafless_point_cursor_free.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_point_cursor_new(
    octree: *const leafless_octree,
    cursor: *mut *mut leafless_point_cursor,
) -> leafless_status {
    guard(|| unsafe {
        let octree = share(octree, "octree")?;
        let cursor = out(cursor, "cursor")?;
        let yoke = Yoke::attach_to_cart(octree, |handle| PointCursor::new(handle.octree.view()));
        cursor.write(Box::into_raw(Box::new(leafless_point_cursor(yoke))))
    })
}

/// Releases a point cursor.
///
/// - Buffers: `cursor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_point_cursor_free(cursor: *mut leafless_point_cursor) {
    // SAFETY: the caller's promise.
    unsafe { discard(cursor) }
}

/// Like leafless_octree_contains, from the path to the last cell.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
///
/// cbindgen:ptrs-as-arrays=[[point_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_point_cursor_contains(
    cursor: *mut leafless_point_cursor,
    point_model: *const f64,
    membership: *mut leafless_membership,
) -> leafless_status {
    guard(|| unsafe {
        let cursor = exclusive(cursor, "cursor")?;
        let point = array(point_model, "point_model")?;
        let membership = out(membership, "membership")?;
        membership.write(cursor.0.with_mut_return(move |cursor| cursor.contains(point)).into())
    })
}

/// Like leafless_octree_tag_at, from the path to the last cell.
///
/// - Buffers: `cell`, 3 numbers; `tag`, one.
/// - Result: `*tag`: EMPTY, FULL or PARTIAL; PARTIAL if a coordinate is not below 2^depth.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_point_cursor_tag_at(
    cursor: *mut leafless_point_cursor,
    cell: *const u32,
    tag: *mut leafless_tag,
) -> leafless_status {
    guard(|| unsafe {
        let cursor = exclusive(cursor, "cursor")?;
        let cell = array(cell, "cell")?;
        let tag = out(tag, "tag")?;
        tag.write(cursor.0.with_mut_return(move |cursor| cursor.tag_at(cell)).into())
    })
}

/// A table of all cells of one level, for point queries at random positions: about twice as fast as
/// leafless_octree_contains, because the table decides most points. It takes 4 * 8^level bytes: 1 MiB for
/// level 6, 64 MiB for level 8. Queries do not change the table: any threads may use it at once.
pub struct leafless_point_table(Yoke<PointTable<'static>, Arc<leafless_octree>>);

/// Makes a point table.
///
/// - Buffers: `table`, one pointer; `table_level`, one.
/// - Result: `*table`; `*table_level`: the level of the table's cells, which is `level` or the next coarser
///   level at which the octree's array elements, of two levels each, begin. A `level` beyond 8, or beyond the
///   octree's depth, is reduced to that limit.
/// - Errors: LEAFLESS_E_NO_MEMORY.
/// - Ownership: the table shares the octree, which may be freed; release `*table` with
///   leafless_point_table_free.
/// - Untrusted input: any octree; the work is bounded by 8^level.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_point_table_new(
    octree: *const leafless_octree,
    level: u8,
    table: *mut *mut leafless_point_table,
    table_level: *mut u8,
) -> leafless_status {
    guard(|| unsafe {
        let octree = share(octree, "octree")?;
        let (table, table_level) = (out(table, "table")?, out(table_level, "table_level")?);
        let yoke: Yoke<PointTable<'static>, _> =
            Yoke::try_attach_to_cart(octree, |handle| PointTable::new(handle.octree.view(), level))?;
        table_level.write(yoke.get().level())?;
        table.write(Box::into_raw(Box::new(leafless_point_table(yoke))))
    })
}

/// Releases a point table.
///
/// - Buffers: `table`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_point_table_free(table: *mut leafless_point_table) {
    // SAFETY: the caller's promise.
    unsafe { discard(table) }
}

/// Like leafless_octree_contains, through a table.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
///
/// cbindgen:ptrs-as-arrays=[[point_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_point_table_contains(
    table: *const leafless_point_table,
    point_model: *const f64,
    membership: *mut leafless_membership,
) -> leafless_status {
    guard(|| unsafe {
        let table = shared(table, "table")?.0.get();
        let point = array(point_model, "point_model")?;
        out(membership, "membership")?.write(table.contains(point).into())
    })
}

/// Like leafless_octree_contains_many, through a table.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `memberships`, room for `count`. Both may be NULL
///   if `count` is 0.
/// - Result: `memberships[i]` for point i.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_point_table_contains_many(
    table: *const leafless_point_table,
    points_model: *const f64,
    count: u64,
    memberships: *mut leafless_membership,
) -> leafless_status {
    guard(|| unsafe {
        let table = shared(table, "table")?.0.get();
        let points: &[[f64; 3]] = slice(points_model.cast(), count, "points_model")?;
        if points.is_empty() {
            return Ok(());
        }
        Ok(table.contains_many(points, answers(memberships, points.len())?)?)
    })
}
