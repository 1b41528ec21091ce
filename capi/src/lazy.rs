//! Octrees that are split on demand.

use super::boundary::{Failure, Sized32, array, buffer, discard, filled, guard, out, output, shared, sized};
use super::contains::leafless_membership;
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::number::{Number, enumeration};
use super::octree::{give, leafless_octree, leafless_statistics, leafless_tag};
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::Cell;
use leafless::LazyOctree;
use leafless::op::{Refinement, Zone};
use std::sync::{RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError, TryLockResult};

/// An octree of a solid that is split on demand: a cell is split when a call requests it, and split cells are
/// stored. FULL and EMPTY cells are proven; cells that are not split yet are PARTIAL.
///
/// Splitting and refining change the octree. While one call changes it, every other call returns
/// LEAFLESS_E_BUSY, both from another thread and from the host's functions inside the call. While a call
/// reads it, splitting and refining return LEAFLESS_E_BUSY. Its other functions may be called at once from
/// any number of threads.
pub struct leafless_lazy(RwLock<LazyOctree<'static>>);

type Held = LazyOctree<'static>;

/// Returns the octree for reading, unless another call changes it.
///
/// # Safety
/// As [`shared`].
unsafe fn read<'a>(lazy: *const leafless_lazy) -> Result<RwLockReadGuard<'a, Held>, Failure> {
    // SAFETY: the caller's promise.
    unlocked(unsafe { shared(lazy, "lazy")? }.0.try_read())
}

/// Returns the octree for changing, unless another call uses it.
///
/// # Safety
/// As [`shared`].
unsafe fn change<'a>(lazy: *const leafless_lazy) -> Result<RwLockWriteGuard<'a, Held>, Failure> {
    // SAFETY: the caller's promise.
    unlocked(unsafe { shared(lazy, "lazy")? }.0.try_write())
}

/// The octree is unchanged when a call panics, so a poisoned lock is usable.
fn unlocked<G>(held: TryLockResult<G>) -> Result<G, Failure> {
    match held {
        Ok(held) => Ok(held),
        Err(TryLockError::Poisoned(held)) => Ok(held.into_inner()),
        Err(TryLockError::WouldBlock) => Err(Failure::Busy { name: "lazy" }),
    }
}

/// Basic facts about a lazy octree.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_lazy_info {
    /// sizeof(leafless_lazy_info).
    pub struct_size: u32,
    /// The universe and the greatest depth of cells.
    pub frame: leafless_frame,
    /// Counts over all levels, and the certified volume.
    pub statistics: leafless_statistics,
    /// Cells that were split in total, including cells that were merged again. No cell is counted twice.
    pub splits: u64,
    /// Splits that the solid repeated because cells below were to be split.
    pub replays: u64,
    /// Bytes of the split cells.
    pub bytes: u64,
}

output!(leafless_lazy_info);

/// The cell at `pointer`.
///
/// # Safety
/// As [`array`].
unsafe fn cell(pointer: *const u32, level: u32) -> Result<Cell, Failure> {
    // SAFETY: the caller's promise.
    let at = unsafe { array(pointer, "cell")? };
    Ok(Cell { level: self::level(level), at })
}

/// A level that is out of range stays out of range.
fn level(level: u32) -> u8 {
    u8::try_from(level).unwrap_or(u8::MAX)
}

fn new(lazy: LazyOctree<'static>) -> *mut leafless_lazy {
    Box::into_raw(Box::new(leafless_lazy(RwLock::new(lazy))))
}

/// Makes a lazy octree in which only the universe is classified. The frame's depth limits the depth of cells;
/// a great depth costs nothing until its cells are requested.
///
/// - Buffers: `frame`, one struct; `lazy`, one pointer.
/// - Result: `*lazy`.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_ARGUMENT; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the octree shares the solid, which may be freed; release `*lazy` with leafless_lazy_free.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_new(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    lazy: *mut *mut leafless_lazy,
) -> leafless_status {
    guard(|| unsafe {
        let solid = shared(solid, "solid")?.solid.clone();
        let frame = self::frame(frame)?;
        let lazy = out(lazy, "lazy")?;
        lazy.write(new(LazyOctree::new(solid, &frame)?))
    })
}

/// Makes a lazy octree that continues an octree of leafless_lazy_freeze. The octree must come from the same
/// solid, which the fingerprint identifies; `frame` may be deeper than the octree's frame. The octree's cells
/// are trusted, unless splits of the solid contradict them. Splits are counted from zero.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `lazy`, one pointer.
/// - Result: `*lazy`. O(n).
/// - Errors: LEAFLESS_E_SOURCE if the octree does not hold the solid's fingerprint; LEAFLESS_E_ARGUMENT if
///   the solid has none, or the octree is deeper than the frame; LEAFLESS_E_FRAME if the octree has another
///   universe, or the solid belongs to another frame; LEAFLESS_E_DAMAGED; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` is unchanged; `*lazy` shares the solid, which may be freed; release it with
///   leafless_lazy_free.
/// - Untrusted input: any octree; set `max_bytes` if it is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_resume(
    octree: *const leafless_octree,
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    options: *const leafless_options,
    lazy: *mut *mut leafless_lazy,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let solid = shared(solid, "solid")?.solid.clone();
        let frame = self::frame(frame)?;
        let lazy = out(lazy, "lazy")?;
        lazy.write(new(controlled(options, |control| LazyOctree::resume(octree, solid, &frame, control))?))
    })
}

/// Releases a lazy octree.
///
/// - Buffers: `lazy`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_free(lazy: *mut leafless_lazy) {
    // SAFETY: the caller's promise.
    unsafe { discard(lazy) }
}

/// Splits a PARTIAL cell. It costs nothing if the cell was split before, is decided, or cannot be improved by
/// splitting.
///
/// - Buffers: `cell`, 3 numbers, the cell's index on each axis; `tags`, room for 8.
/// - Result: the tags of its children in octant order (bit 0 of the octant is x, bit 1 y, bit 2 z).
/// - Errors: LEAFLESS_E_ARGUMENT if the cell is not in the frame, has the frame's depth, or lies in a cell
///   that is not split yet; LEAFLESS_E_SOURCE if the solid contradicts the octree; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the handle.
/// - Untrusted input: any solid, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3], [tags; 8]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_split(
    lazy: *mut leafless_lazy,
    cell: *const u32,
    level: u32,
    tags: *mut leafless_tag,
) -> leafless_status {
    guard(|| unsafe {
        let mut lazy = change(lazy)?;
        let cell = self::cell(cell, level)?;
        let tags = out(tags.cast::<[leafless_tag; 8]>(), "tags")?;
        tags.write(lazy.split(cell)?.map(leafless_tag::from))
    })
}

/// The kind of zone: which cells are refined.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_zone_kind {
    /// All of the universe.
    LEAFLESS_ZONE_KIND_EVERYTHING = 0,
    /// The cells whose interiors meet the box from `min_model` to `max_model`; for a box without thickness,
    /// the cells that contain it.
    LEAFLESS_ZONE_KIND_BOX = 1,
    /// The cells that contain `point_model`: one of each level.
    LEAFLESS_ZONE_KIND_POINT = 2,
    /// All cells that the points `point_model` + t · `direction_model` with `from` ≤ t ≤ `to` touch.
    LEAFLESS_ZONE_KIND_RAY = 3,
}
use leafless_zone_kind::*;

enumeration! {
    leafless_zone_kind => leafless_zone_kind {
        LEAFLESS_ZONE_KIND_EVERYTHING => LEAFLESS_ZONE_KIND_EVERYTHING,
        LEAFLESS_ZONE_KIND_BOX => LEAFLESS_ZONE_KIND_BOX,
        LEAFLESS_ZONE_KIND_POINT => LEAFLESS_ZONE_KIND_POINT,
        LEAFLESS_ZONE_KIND_RAY => LEAFLESS_ZONE_KIND_RAY,
    }
}

/// A zone of model space in which cells are refined. Fields that its kind does not use are ignored.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_zone {
    /// sizeof(leafless_zone).
    pub struct_size: u32,
    /// A leafless_zone_kind: the kind decides which of the fields below are used.
    pub kind: Number<leafless_zone_kind>,
    /// A box's lower corner.
    pub min_model: [f64; 3],
    /// A box's upper corner.
    pub max_model: [f64; 3],
    /// A point, or a point of a ray. For a ray each coordinate is 0 or of a magnitude between 2^-256 and
    /// 2^256.
    pub point_model: [f64; 3],
    /// A ray's direction, of any length but zero; its coordinates have the range of a ray's point.
    pub direction_model: [f64; 3],
    /// The parameter t of a ray's start; may be -INFINITY.
    pub from: f64,
    /// The parameter t of a ray's end; may be INFINITY.
    pub to: f64,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_zone {}

/// Splits the cells of a zone down to `level`, as far as they can be split. The limits in `options`
/// (`max_splits`; `max_nodes` and `max_bytes` of the whole octree) end the work without damage to the octree.
/// With limits, coarser cells are split before finer ones, and along a ray the nearest cells first.
///
/// - Buffers: `zone`, one struct, or NULL for everything; `options`, one struct or NULL; `done`, one truth
///   value, or NULL.
/// - Result: `*done`, whether the work was completed before a limit was reached.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is beyond the frame's depth, a box has min > max on an axis, a
///   number violates the ranges of leafless_zone, or from > to; LEAFLESS_E_SOURCE if the solid contradicts
///   the octree; LEAFLESS_E_CALLBACK; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY. Cells that were split
///   before the error stay split.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the handle; works in the calling thread.
/// - Untrusted input: any solid, any numbers; set limits if the level or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_refine(
    lazy: *mut leafless_lazy,
    zone: *const leafless_zone,
    level: u32,
    options: *const leafless_options,
    done: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let mut lazy = change(lazy)?;
        let zone = sized(zone, "zone")?;
        let zone = match zone.kind.known("zone.kind")? {
            LEAFLESS_ZONE_KIND_EVERYTHING => Zone::Whole,
            LEAFLESS_ZONE_KIND_BOX => Zone::Box { min: zone.min_model, max: zone.max_model },
            LEAFLESS_ZONE_KIND_POINT => Zone::Point(zone.point_model),
            LEAFLESS_ZONE_KIND_RAY => {
                let (origin, direction) = (zone.point_model, zone.direction_model);
                Zone::Ray { origin, direction, from: zone.from, to: zone.to }
            }
        };
        let done = if done.is_null() { None } else { Some(out(done, "done")?) };
        let level = self::level(level);
        let refined = controlled(options, |control| lazy.refine(&zone, level, control))?;
        done.map_or(Ok(()), |done| done.write(refined == Refinement::Done))
    })
}

/// Returns the tag of a cell. Cells inside a cell that is decided, or not split yet, have its tag.
///
/// - Buffers: `cell`, 3 numbers, the cell's index on each axis; `tag`, one; `can_split`, one truth value, or
///   NULL.
/// - Result: `*tag`; BRANCH if the cell was split and its children differ; PARTIAL if it is not a cell of the
///   frame. `*can_split`, whether leafless_lazy_split would query the solid: the cell is PARTIAL, its parent
///   was split, it is above the frame's depth, and the solid did not report that splitting does not help.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_tag_at(
    lazy: *const leafless_lazy,
    cell: *const u32,
    level: u32,
    tag: *mut leafless_tag,
    can_split: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let lazy = read(lazy)?;
        let cell = self::cell(cell, level)?;
        let tag = out(tag, "tag")?;
        let can_split = if can_split.is_null() { None } else { Some(out(can_split, "can_split")?) };
        tag.write(lazy.tag(cell).into())?;
        can_split.map_or(Ok(()), |can_split| can_split.write(lazy.can_split(cell)))
    })
}

/// Returns whether the solid contains a point, as far as cells have been split. A point on the boundary may
/// be inside or outside.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[point_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_contains(
    lazy: *const leafless_lazy,
    point_model: *const f64,
    membership: *mut leafless_membership,
) -> leafless_status {
    guard(|| unsafe {
        let lazy = read(lazy)?;
        let point = array(point_model, "point_model")?;
        out(membership, "membership")?.write(lazy.contains(point).into())
    })
}

/// Returns basic facts about a lazy octree, as far as cells have been split. O(depth).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`. A cell counts as a node also if its eight children are PARTIAL.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_describe(
    lazy: *const leafless_lazy,
    info: *mut leafless_lazy_info,
) -> leafless_status {
    guard(|| unsafe {
        let lazy = read(lazy)?;
        filled(info, "info")?.write(leafless_lazy_info {
            struct_size: size_of::<leafless_lazy_info>() as u32,
            frame: lazy.frame().into(),
            statistics: (&lazy.statistics()).into(),
            splits: lazy.splits(),
            replays: lazy.replays(),
            bytes: lazy.bytes(),
        })
    })
}

/// Returns the counts of each level, and the certified volumes of the octree cut off at that level. Entry 0
/// is the universe, entry `depth` the finest cells.
///
/// - Buffers: `levels`, room for `capacity` structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, depth + 1; the levels.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_levels(
    lazy: *const leafless_lazy,
    levels: *mut leafless_statistics,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let lazy = read(lazy)?;
        let levels = buffer(levels, capacity, "levels")?;
        let count = out(count, "count")?;
        let statistics = lazy.statistics();
        levels.fill_with(statistics.levels())?;
        count.write(statistics.levels().len() as u64)
    })
}

/// Returns the number of cells of each level that were split, including cells that were merged again. Entry 0
/// is the universe.
///
/// - Buffers: `splits`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, the frame's depth; the numbers.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_splits(
    lazy: *const leafless_lazy,
    splits: *mut u64,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let lazy = read(lazy)?;
        let splits = buffer(splits, capacity, "splits")?;
        let count = out(count, "count")?;
        let found: Vec<u64> = (0..lazy.frame().depth()).map(|level| lazy.splits_at(level)).collect();
        splits.fill(&found)?;
        count.write(found.len() as u64)
    })
}

/// Returns the current octree: canonical, with PARTIAL cells where cells are not split. Its fact "source" is
/// the solid's fingerprint, if there is one. leafless_lazy_resume continues it, also from a file.
///
/// - Buffers: `options`, one struct or NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the octree; runs on as many threads as
///   `options` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_lazy_freeze(
    lazy: *const leafless_lazy,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let lazy = read(lazy)?;
        let octree = out(octree, "octree")?;
        octree.write(give(controlled(options, |control| lazy.freeze(control))?))
    })
}
