//! Cursors on the nodes of an octree.

use super::boundary::{Failure, discard, exclusive, filled, guard, out, output, share, shared};
use super::octree::{leafless_octree, leafless_tag};
use super::status::leafless_status;
use leafless::octree::Cursor;
use std::sync::Arc;
use yoke::Yoke;

/// A position in an octree that moves along its links, one level at a step. It starts at the universe.
///
/// Moving changes the cursor: while one thread moves it, no other thread may use it. Each thread may have its
/// own cursor.
pub struct leafless_cursor(pub(super) Yoke<Cursor<'static>, Arc<leafless_octree>>);

/// The state of a cursor: the cell that it is at.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cursor_info {
    /// sizeof(leafless_cursor_info).
    pub struct_size: u32,
    /// The cell's index on each axis among the cells of its level.
    pub cell: [u32; 3],
    /// The cell's level; 0 is the universe.
    pub level: u32,
    /// The cell's tag.
    pub tag: leafless_tag,
    /// For a BRANCH, the tags of its children in octant order (bit 0 of the octant is x, bit 1 y, bit 2 z);
    /// else eight times the cell's own tag.
    pub children: [leafless_tag; 8],
}

output!(leafless_cursor_info);

/// Makes a cursor at the universe.
///
/// - Buffers: `cursor`, one pointer.
/// - Result: `*cursor`.
/// - Ownership: the cursor shares the octree, which may be freed; release `*cursor` with
///   leafless_cursor_free.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cursor_new(
    octree: *const leafless_octree,
    cursor: *mut *mut leafless_cursor,
) -> leafless_status {
    guard(|| unsafe {
        let octree = share(octree, "octree")?;
        let cursor = out(cursor, "cursor")?;
        let yoke = Yoke::attach_to_cart(octree, |handle| Cursor::new(handle.octree.view()));
        cursor.write(Box::into_raw(Box::new(leafless_cursor(yoke))))
    })
}

/// Releases a cursor.
///
/// - Buffers: `cursor`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cursor_free(cursor: *mut leafless_cursor) {
    // SAFETY: the caller's promise.
    unsafe { discard(cursor) }
}

/// Returns the state of a cursor.
///
/// - Buffers: `state`, one struct.
/// - Result: `*state`.
/// - Threads: any, while no thread moves the cursor.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cursor_describe(
    cursor: *const leafless_cursor,
    state: *mut leafless_cursor_info,
) -> leafless_status {
    guard(|| unsafe {
        let cursor = shared(cursor, "cursor")?.0.get();
        let (cell, tag) = (cursor.cell(), cursor.tag());
        let children = cursor.node().map_or([tag; 8], |node| node.tags());
        filled(state, "state")?.write(leafless_cursor_info {
            struct_size: size_of::<leafless_cursor_info>() as u32,
            cell: cell.at,
            level: cell.level.into(),
            tag: tag.into(),
            children: children.map(leafless_tag::from),
        })
    })
}

/// Moves a cursor to a child of its cell. On a cell that is not a BRANCH it does not move.
///
/// - Buffers: `moved`, one truth value, or NULL. `octant` is 0 to 7.
/// - Result: `*moved`, whether the cell is a BRANCH.
/// - Errors: LEAFLESS_E_ARGUMENT if `octant` is not 0 to 7.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree; damage reads as PARTIAL, so that a walk visits every cell at most once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cursor_descend(
    cursor: *mut leafless_cursor,
    octant: u32,
    moved: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let cursor = exclusive(cursor, "cursor")?;
        let moved = if moved.is_null() { None } else { Some(out(moved, "moved")?) };
        let octant = match u8::try_from(octant) {
            Ok(octant) if octant < 8 => octant,
            _ => return Err(Failure::Argument { name: "octant", problem: "must be 0 to 7" }),
        };
        let descended = cursor.0.with_mut_return(move |cursor| cursor.descend(octant));
        moved.map_or(Ok(()), |moved| moved.write(descended))
    })
}

/// Moves a cursor to the parent of its cell. On the universe it does not move.
///
/// - Buffers: `moved`, one truth value, or NULL.
/// - Result: `*moved`, whether there is a parent.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cursor_ascend(
    cursor: *mut leafless_cursor,
    moved: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let cursor = exclusive(cursor, "cursor")?;
        let moved = if moved.is_null() { None } else { Some(out(moved, "moved")?) };
        let ascended = cursor.0.with_mut_return(|cursor| cursor.ascend());
        moved.map_or(Ok(()), |moved| moved.write(ascended))
    })
}
