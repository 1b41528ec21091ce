//! Cells of octrees: neighbours, and iterators over cells and boundary faces.

use super::boundary::{Failure, array, buffer, discard, exclusive, guard, out, share, slice};
use super::cursor::leafless_cursor;
use super::frame::{frame, leafless_frame};
use super::octree::{leafless_octree, leafless_tag};
use super::status::leafless_status;
use leafless::Cell;
use leafless::Tag;
use leafless::lattice::Cube;
use leafless::octree::{BoundaryFace, BoundaryFaces, CellFilter, Cells, Direction, TaggedCell};
use std::sync::Arc;
use yoke::Yoke;

/// A cell of an octree and its tag.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cell {
    /// The cell's index on each axis among the cells of its level: its lower corner in units of its edge.
    pub cell: [u32; 3],
    /// The cell's level; 0 is the universe.
    pub level: u32,
    /// The cell's tag.
    pub tag: leafless_tag,
}

impl From<TaggedCell> for leafless_cell {
    #[inline(always)]
    fn from(found: TaggedCell) -> leafless_cell {
        let TaggedCell { cell, tag } = found;
        leafless_cell { cell: cell.at, level: cell.level.into(), tag: tag.into() }
    }
}

/// A square between two cells that are not split: one with a requested tag, and one with another tag. It is a
/// whole face of the smaller cell.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_boundary_face {
    /// The cell with a requested tag.
    pub inner: leafless_cell,
    /// The cell with another tag. Outside the universe: the inner cell's index and level, with the exterior's
    /// tag.
    pub outer: leafless_cell,
    /// The axis from the inner cell to the outer one: 0 is x, 1 y, 2 z.
    pub axis: u8,
    /// Whether the outer cell lies above the inner one on that axis.
    pub is_upper: bool,
    /// Whether the outer cell lies in the universe.
    pub has_outer: bool,
}

/// A set of tags: one of these values, or several joined by `|`.
#[repr(u32)]
pub enum leafless_tags {
    /// EMPTY cells.
    LEAFLESS_TAGS_EMPTY = 1,
    /// BRANCH cells: cells that are split.
    LEAFLESS_TAGS_BRANCH = 2,
    /// PARTIAL cells.
    LEAFLESS_TAGS_PARTIAL = 4,
    /// FULL cells.
    LEAFLESS_TAGS_FULL = 8,
    /// All cells that are not split.
    LEAFLESS_TAGS_LEAVES = 13,
}

/// An iterator over cells of an octree. Its position is before the next cell.
///
/// Reading changes it: while one thread reads, no other may use it. Threads may have one each.
pub struct leafless_cells(Yoke<Cells<'static>, Arc<leafless_octree>>);

/// An iterator over boundary faces of an octree. Its position is before the next face.
///
/// Reading changes it: while one thread reads, no other may use it. Threads may have one each.
pub struct leafless_faces {
    faces: Yoke<BoundaryFaces<'static>, Arc<leafless_octree>>,
    exterior: Tag,
}

impl leafless_faces {
    fn in_c(&self, face: BoundaryFace) -> leafless_boundary_face {
        let BoundaryFace { inner, outer, direction } = face;
        let axis = direction.steps().iter().position(|&step| step != 0).unwrap_or(0);
        leafless_boundary_face {
            inner: inner.into(),
            outer: outer.unwrap_or(TaggedCell { tag: self.exterior, ..inner }).into(),
            axis: axis as u8,
            is_upper: direction.steps()[axis] > 0,
            has_outer: outer.is_some(),
        }
    }
}

/// Returns the cell with these coordinates; values out of range stay out of range.
///
/// # Safety
/// As [`array`].
unsafe fn cell(pointer: *const u32, level: u32) -> Result<Cell, Failure> {
    // SAFETY: the caller's promise.
    let at = unsafe { array(pointer, "cell")? };
    Ok(Cell { level: level.try_into().unwrap_or(u8::MAX), at })
}

/// # Safety
/// As [`array`].
unsafe fn direction(pointer: *const i32) -> Result<Direction, Failure> {
    // SAFETY: the caller's promise.
    let steps: [i32; 3] = unsafe { array(pointer, "direction")? };
    let steps = steps.map(|step| i8::try_from(step).unwrap_or(i8::MAX));
    let problem = "must be three numbers of -1, 0 and 1, which are not all 0";
    Direction::new(steps).ok_or(Failure::Argument { name: "direction", problem })
}

/// Returns the tags of one or several leafless_tags.
pub(super) fn tags(tags: u32) -> Result<std::vec::Vec<Tag>, Failure> {
    if !(1..=15).contains(&tags) {
        return Err(Failure::Argument { name: "tags", problem: "must be one or several leafless_tags" });
    }
    let all = [Tag::Empty, Tag::Branch, Tag::Partial, Tag::Full];
    let chosen = |i: usize| if tags >> i & 1 != 0 { &all[i..=i] } else { &[] };
    Ok((0..4).flat_map(chosen).copied().collect())
}

/// # Safety
/// As [`array`] for a box that is not NULL.
unsafe fn filter(
    tags: u32,
    min_level: u32,
    max_level: u32,
    min_cell: *const u32,
    max_cell: *const u32,
) -> Result<CellFilter, Failure> {
    let chosen = self::tags(tags)?;
    let level = |level: u32| level.try_into().unwrap_or(u8::MAX);
    let filter = CellFilter::tags(&chosen).levels(level(min_level)..=level(max_level));
    // A box needs both of its corners.
    if min_cell.is_null() && max_cell.is_null() {
        return Ok(filter);
    }
    // SAFETY: the caller's promise.
    unsafe { Ok(filter.within(array(min_cell, "min_cell")?, array(max_cell, "max_cell")?)) }
}

/// Returns the box of a cell of any level, in model units, rounded outward to the nearest doubles.
///
/// - Buffers: `frame`, one struct; `cell`, 3 numbers; `min_model` and `max_model`, room for 3 numbers each.
/// - Result: `min_model` and `max_model`; the exact corners if these are doubles.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, if `level` is greater than the frame's depth, or a
///   coordinate of `cell` not below 2^level.
/// - Untrusted input: any values.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3], [min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_frame_cell_bounds(
    frame: *const leafless_frame,
    cell: *const u32,
    level: u32,
    min_model: *mut f64,
    max_model: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let frame = self::frame(frame)?;
        let cell = self::cell(cell, level)?;
        let min = out(min_model.cast::<[f64; 3]>(), "min_model")?;
        let max = out(max_model.cast::<[f64; 3]>(), "max_model")?;
        if cell.level > frame.depth() || cell.at.iter().any(|&a| a >> cell.level != 0) {
            let problem = "lies outside of the universe, or is finer than the finest cells";
            return Err(Failure::Argument { name: "cell", problem });
        }
        let (low, high) = Cube { frame: &frame, cell }.bounds();
        min.write(low)?;
        max.write(high)
    })
}

/// Moves a cursor to a cell, or to the cell that contains it and is not split. O(levels below the common
/// ancestor).
///
/// - Buffers: `cell`, 3 numbers; `reached`, one truth value, or NULL.
/// - Result: `*reached`, whether the cursor is at the cell itself.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; then the cursor does not move.
/// - Threads: no other call may use the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cursor_seek(
    cursor: *mut leafless_cursor,
    cell: *const u32,
    level: u32,
    reached: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let cursor = exclusive(cursor, "cursor")?;
        let cell = self::cell(cell, level)?;
        let reached = if reached.is_null() { None } else { Some(out(reached, "reached")?) };
        let is_there = cursor.0.with_mut_return(move |cursor| cursor.seek(cell))?;
        reached.map_or(Ok(()), |reached| reached.write(is_there))
    })
}

/// Returns the neighbour of a cursor's cell across a face, an edge or a vertex: the cell of the same size,
/// which is a BRANCH if it is split, or the larger cell that contains it and is not split. The cursor does
/// not move. Amortised O(1) along a walk, at most O(depth).
///
/// - Buffers: `direction`, 3 numbers of -1, 0 and 1: the steps along x, y and z; `neighbour`, one struct;
///   `exists`, one truth value, or NULL.
/// - Result: `*neighbour`; `*exists`, whether it lies in the universe. If not, `*neighbour` is the cursor's
///   own cell with the exterior's tag.
/// - Errors: LEAFLESS_E_ARGUMENT if `direction` is not a direction.
/// - Threads: any, while no thread moves the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
///
/// cbindgen:ptrs-as-arrays=[[direction; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cursor_neighbour(
    cursor: *const leafless_cursor,
    direction: *const i32,
    neighbour: *mut leafless_cell,
    exists: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let handle = super::boundary::shared(cursor, "cursor")?;
        let direction = self::direction(direction)?;
        let neighbour = out(neighbour, "neighbour")?;
        let exists = if exists.is_null() { None } else { Some(out(exists, "exists")?) };
        let found = handle.0.get().neighbour(direction);
        let tag = handle.0.backing_cart().octree.view().exterior();
        let outside = TaggedCell { cell: handle.0.get().cell(), tag };
        neighbour.write(found.unwrap_or(outside).into())?;
        exists.map_or(Ok(()), |exists| exists.write(found.is_some()))
    })
}

/// Returns all cells that are not split and touch a cursor's cell on one side: one cell that is at least as
/// large, or the smaller cells at its face, edge or vertex, in Morton order.
///
/// - Buffers: `direction`, 3 numbers of -1, 0 and 1: the steps along x, y and z; `cells`, room for `capacity`
///   structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, 0 if the side lies on the boundary of the universe; the cells.
/// - Errors: LEAFLESS_E_ARGUMENT if `direction` is not a direction; LEAFLESS_E_BUFFER if the capacity is too
///   small.
/// - Threads: any, while no thread moves the cursor.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and no array element is visited
///   twice.
///
/// cbindgen:ptrs-as-arrays=[[direction; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cursor_neighbours(
    cursor: *const leafless_cursor,
    direction: *const i32,
    cells: *mut leafless_cell,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let cursor = super::boundary::shared(cursor, "cursor")?.0.get();
        let direction = self::direction(direction)?;
        let to = buffer(cells, capacity, "cells")?;
        let count = out(count, "count")?;
        let found = cursor.neighbours(direction).count();
        to.check(found)?;
        if to.wanted() {
            for (i, neighbour) in cursor.neighbours(direction).take(found).enumerate() {
                cells.add(i).write(neighbour.into());
            }
        }
        count.write(found as u64)
    })
}

/// Makes an iterator over the cells of an octree with some tags, on some levels, in a box, in Morton order. A
/// cell that is split comes before the cells in it. The iterator reads no parts of the octree outside the box
/// or below the levels.
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each, or both NULL for the whole universe: the first
///   finest cell of the box on each axis, and the first cell beyond it; `cells`, one pointer. `tags` are
///   leafless_tags. `min_level` and `max_level` may be greater than the depth.
/// - Result: `*cells`, positioned before the first such cell.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` is not a combination of leafless_tags.
/// - Ownership: `*cells` shares the octree, which may be freed; release it with leafless_cells_free.
/// - Untrusted input: any octree, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[min_cell; 3], [max_cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cells_new(
    octree: *const leafless_octree,
    tags: u32,
    min_level: u32,
    max_level: u32,
    min_cell: *const u32,
    max_cell: *const u32,
    cells: *mut *mut leafless_cells,
) -> leafless_status {
    guard(|| unsafe {
        let octree = share(octree, "octree")?;
        let filter = self::filter(tags, min_level, max_level, min_cell, max_cell)?;
        let cells = out(cells, "cells")?;
        let yoke = Yoke::attach_to_cart(octree, |handle| handle.octree.view().cells(filter));
        cells.write(Box::into_raw(Box::new(leafless_cells(yoke))))
    })
}

/// Frees an iterator over cells.
///
/// - Buffers: `cells`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cells_free(cells: *mut leafless_cells) {
    // SAFETY: the caller's promise.
    unsafe { discard(cells) }
}

/// Moves an iterator to a cell: the next cell is that cell, or the cell that contains it and is not split, or
/// the first requested cell after it in Morton order. O(depth).
///
/// - Buffers: `cell`, 3 numbers.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; then nothing changes.
/// - Threads: no other call may use `cells`.
/// - Untrusted input: any octree, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cells_seek(
    cells: *mut leafless_cells,
    cell: *const u32,
    level: u32,
) -> leafless_status {
    guard(|| unsafe {
        let cells = exclusive(cells, "cells")?;
        let cell = self::cell(cell, level)?;
        Ok(cells.0.with_mut_return(move |cells| cells.seek(cell))?)
    })
}

/// Reads the next cells.
///
/// - Buffers: `buffer`, room for `capacity` structs, which may be NULL if `capacity` is 0; `count`, one
///   number.
/// - Result: the cells; `*count`, their number: less than `capacity` only if there are no more.
/// - Threads: no other call may use `cells`.
/// - Untrusted input: any octree; damage reads as PARTIAL, and no array element is visited twice.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_cells_next(
    cells: *mut leafless_cells,
    buffer: *mut leafless_cell,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let cells = exclusive(cells, "cells")?;
        let room = self::room(buffer, capacity)?;
        let count = out(count, "count")?;
        let mut free = buffer;
        let found = cells.0.with_mut_return(move |cells| {
            cells.put(room, |found| {
                // SAFETY: there is room for `capacity` elements, and each is written once.
                free.write(found.into());
                free = free.add(1);
            })
        });
        count.write(found as u64)
    })
}

/// Returns the number of elements that `buffer` has room for.
///
/// # Safety
/// As [`slice`], but no element is read.
unsafe fn room<T>(buffer: *mut T, capacity: u64) -> Result<usize, Failure> {
    // SAFETY: bytes that may be uninitialised may be viewed as `MaybeUninit`.
    unsafe { Ok(slice(buffer.cast::<core::mem::MaybeUninit<T>>(), capacity, "buffer")?.len()) }
}

/// Makes an iterator over the boundary faces of an octree: faces between cells with some tags and cells with
/// other tags, both not split. FULL gives the boundary of the region that is certainly solid; FULL and
/// PARTIAL that of the region that is possibly solid. Where cells of different sizes meet, there is one face
/// for each of the smaller cells. The space outside the universe has the exterior's tag. Faces come in Morton
/// order of the inner cells, for each inner cell in the order -z, -y, -x, +x, +y, +z, and for each side in
/// the Morton order of the outer cells.
///
/// - Buffers: as leafless_cells_new; levels and box apply to the inner cells; `faces`, one pointer. BRANCH
///   among the tags is ignored.
/// - Result: `*faces`, positioned before the first face.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` is not a combination of leafless_tags.
/// - Ownership: `*faces` shares the octree, which may be freed; release it with leafless_faces_free.
/// - Untrusted input: any octree, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[min_cell; 3], [max_cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_faces_new(
    octree: *const leafless_octree,
    tags: u32,
    min_level: u32,
    max_level: u32,
    min_cell: *const u32,
    max_cell: *const u32,
    faces: *mut *mut leafless_faces,
) -> leafless_status {
    guard(|| unsafe {
        let octree = share(octree, "octree")?;
        let filter = self::filter(tags, min_level, max_level, min_cell, max_cell)?;
        let to = out(faces, "faces")?;
        let exterior = octree.octree.view().exterior();
        let faces = Yoke::attach_to_cart(octree, |handle| handle.octree.view().boundary_faces(filter));
        to.write(Box::into_raw(Box::new(leafless_faces { faces, exterior })))
    })
}

/// Frees an iterator over boundary faces.
///
/// - Buffers: `faces`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_faces_free(faces: *mut leafless_faces) {
    // SAFETY: the caller's promise.
    unsafe { discard(faces) }
}

/// Moves an iterator to the faces of a cell, or of the cell that contains it and is not split, or of the
/// first requested cell after it in Morton order. O(depth).
///
/// - Buffers: `cell`, 3 numbers.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth, or a coordinate of `cell` not
///   below 2^level; then nothing changes.
/// - Threads: no other call may use `faces`.
/// - Untrusted input: any octree, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_faces_seek(
    faces: *mut leafless_faces,
    cell: *const u32,
    level: u32,
) -> leafless_status {
    guard(|| unsafe {
        let faces = exclusive(faces, "faces")?;
        let cell = self::cell(cell, level)?;
        Ok(faces.faces.with_mut_return(move |faces| faces.seek(cell))?)
    })
}

/// Reads the next faces.
///
/// - Buffers: `buffer`, room for `capacity` structs, which may be NULL if `capacity` is 0; `count`, one
///   number.
/// - Result: the faces; `*count`, their number: less than `capacity` only if there are no more.
/// - Threads: no other call may use `faces`.
/// - Untrusted input: any octree; damage reads as PARTIAL. An array element is visited once for its own
///   cells, and at most six times for neighbouring cells, as in a sound octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_faces_next(
    faces: *mut leafless_faces,
    buffer: *mut leafless_boundary_face,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let faces = exclusive(faces, "faces")?;
        let room = self::room(buffer, capacity)?;
        let count = out(count, "count")?;
        let mut found = 0;
        while found < room {
            let Some(face) = faces.faces.with_mut_return(|faces| faces.next()) else { break };
            // SAFETY: there is room for one more.
            buffer.add(found).write(faces.in_c(face));
            found += 1;
        }
        count.write(found as u64)
    })
}
