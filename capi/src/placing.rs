//! Layouts: placing, moving and checking copies of items.

use super::bay::leafless_bay;
use super::boundary::{Failure, buffer, discard, filled, guard, out, output, shared};
use super::clearance::leafless_gap_verdict;
use super::control::{controlled, leafless_options};
use super::csg::placement;
use super::frame::leafless_interval;
use super::status::leafless_status;
use leafless::Interval;
use leafless::layout::{Beside, Layout, Neighbour, Placed, Standing};
use leafless::query::GapVerdict;
use std::sync::{RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError, TryLockResult};

/// A container with obstacles, items, and placed copies of these items. Solids are prepared once, when the
/// layout is made. Copies are numbered from 0, in the order of placing.
///
/// While one call changes a layout, every other call returns LEAFLESS_E_BUSY, both from another thread and
/// from the host's functions inside the call. While a call reads it, calls that change it return
/// LEAFLESS_E_BUSY. Any number of threads may read it at once.
pub struct leafless_layout(RwLock<Layout>);

/// Returns a layout for reading, unless another call changes it.
///
/// # Safety
/// As [`shared`].
pub(super) unsafe fn read<'a>(
    layout: *const leafless_layout,
) -> Result<RwLockReadGuard<'a, Layout>, Failure> {
    // SAFETY: the caller's promise.
    unlocked(unsafe { shared(layout, "layout")? }.0.try_read())
}

/// Returns a layout for changing, unless another call uses it.
///
/// # Safety
/// As [`shared`].
pub(super) unsafe fn change<'a>(
    layout: *const leafless_layout,
) -> Result<RwLockWriteGuard<'a, Layout>, Failure> {
    // SAFETY: the caller's promise.
    unlocked(unsafe { shared(layout, "layout")? }.0.try_write())
}

fn unlocked<G>(held: TryLockResult<G>) -> Result<G, Failure> {
    match held {
        Ok(held) => Ok(held),
        // A change that panicked may have placed a copy without its bounding box.
        Err(TryLockError::Poisoned(_)) => panic!("an earlier call left this layout by a panic"),
        Err(TryLockError::WouldBlock) => Err(Failure::Busy { name: "layout" }),
    }
}

/// Returns a number of the host as an index. A number that is too large becomes an index that does not exist.
fn index(number: u64) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

/// A placed copy of an item.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_placement {
    /// The number of the item.
    pub item: u64,
    /// The placement: the rows of [M | t], where a point p of the item goes to M p + t.
    pub matrix: [f64; 12],
}

impl From<&Placed> for leafless_placement {
    fn from(placed: &Placed) -> leafless_placement {
        let rows = placed.placement.rows();
        leafless_placement { item: placed.item as u64, matrix: core::array::from_fn(|k| rows[k / 4][k % 4]) }
    }
}

/// The kinds of objects that a copy may be too near to.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_beside {
    /// The outside of the container.
    LEAFLESS_BESIDE_WALL = 0,
    /// An obstacle.
    LEAFLESS_BESIDE_OBSTACLE = 1,
    /// Another copy.
    LEAFLESS_BESIDE_PLACED = 2,
}
use leafless_beside::*;

/// The relation of a copy to a neighbour.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_neighbour {
    /// The distance of the two, in model units: 0 if they touch or overlap.
    pub gap_model: leafless_interval,
    /// The number of the obstacle or of the other copy; 0 for the wall.
    pub number: u64,
    /// A leafless_beside: the kind of the neighbour.
    pub beside: u32,
    /// A leafless_gap_verdict: whether the two are proven to keep their clearance, or to violate it.
    pub verdict: u32,
}

impl From<&Neighbour> for leafless_neighbour {
    fn from(found: &Neighbour) -> leafless_neighbour {
        let (beside, number) = match found.other {
            Beside::Wall => (LEAFLESS_BESIDE_WALL, 0),
            Beside::Obstacle(number) => (LEAFLESS_BESIDE_OBSTACLE, number),
            Beside::Placed(number) => (LEAFLESS_BESIDE_PLACED, number),
        };
        leafless_neighbour {
            gap_model: found.gap.into(),
            number: number as u64,
            beside: beside as u32,
            verdict: leafless_gap_verdict::from(found.verdict) as u32,
        }
    }
}

/// The check of a copy, with its nearest neighbour.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_standing {
    /// sizeof(leafless_standing).
    pub struct_size: u32,
    /// A leafless_gap_verdict. YES: the copy is proven to lie in the container, to overlap nothing, and to
    /// keep all clearances. NO: one of these is proven to be violated.
    pub verdict: u32,
    /// Number of conflicts: neighbours without a proven YES. All are counted; only the first 256 are
    /// returned.
    pub conflict_count: u64,
    /// Cells that were split.
    pub splits: u64,
    /// If `has_nearest`, the nearest neighbour except the wall; its gap contains the least of all distances.
    /// Otherwise the wall with the verdict UNDECIDED.
    pub nearest: leafless_neighbour,
    /// Whether the container holds anything else.
    pub has_nearest: bool,
}

output!(leafless_standing);

impl From<&Standing> for leafless_standing {
    fn from(found: &Standing) -> leafless_standing {
        let nothing =
            Neighbour { other: Beside::Wall, verdict: GapVerdict::Undecided, gap: Interval::exactly(0.0) };
        leafless_standing {
            struct_size: size_of::<leafless_standing>() as u32,
            verdict: leafless_gap_verdict::from(found.verdict) as u32,
            conflict_count: found.conflict_count as u64,
            splits: found.splits,
            nearest: (&found.nearest.unwrap_or(nothing)).into(),
            has_nearest: found.nearest.is_some(),
        }
    }
}

/// The check of one of many copies.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_placed_standing {
    /// As in leafless_standing.
    pub conflict_count: u64,
    /// Cells that were split.
    pub splits: u64,
    /// A leafless_gap_verdict.
    pub verdict: u32,
}

impl From<&Standing> for leafless_placed_standing {
    fn from(found: &Standing) -> leafless_placed_standing {
        leafless_placed_standing {
            conflict_count: found.conflict_count as u64,
            splits: found.splits,
            verdict: leafless_gap_verdict::from(found.verdict) as u32,
        }
    }
}

/// Makes a layout from a bay, with nothing placed. It takes the time to prepare each of its solids once.
///
/// - Buffers: `options`, one struct or NULL; `layout`, one pointer.
/// - Result: `*layout`.
/// - Errors: LEAFLESS_E_ARGUMENT if the container or an obstacle has no bounds, or no extent along an axis;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layout shares the solids. The bay may be changed and freed without effect on the layout.
///   Release `*layout` with leafless_layout_free.
/// - Untrusted input: any solids.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_new(
    bay: *const leafless_bay,
    options: *const leafless_options,
    layout: *mut *mut leafless_layout,
) -> leafless_status {
    guard(|| unsafe {
        let bay = &shared(bay, "bay")?.0;
        let layout = out(layout, "layout")?;
        let made = controlled(options, |control| Layout::new(bay, control))?;
        layout.write(Box::into_raw(Box::new(leafless_layout(RwLock::new(made)))))
    })
}

/// Releases a layout.
///
/// - Buffers: `layout`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_free(layout: *mut leafless_layout) {
    // SAFETY: the caller's promise.
    unsafe { discard(layout) }
}

/// Places a copy of an item anywhere. Nothing is checked, and the count of the item is ignored.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t], where a point p of the item goes to M p + t;
///   `number`, one number.
/// - Result: `*number`, the number of the copy, one greater than that of the previous copy.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such item; if an entry is neither 0 nor of a magnitude
///   between 2^-64 and 2^64; if M mirrors, or changes lengths by more than 10^-9 of them;
///   LEAFLESS_E_NO_MEMORY; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_place(
    layout: *mut leafless_layout,
    item: u64,
    matrix: *const f64,
    number: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let mut layout = change(layout)?;
        let placement = self::placement(matrix)?;
        let number = out(number, "number")?;
        number.write(layout.place(index(item), &placement)? as u64)
    })
}

/// Moves a copy to another placement. Nothing is checked; leafless_layout_check does that.
///
/// - Buffers: `matrix`, 12 numbers, as for leafless_layout_place.
/// - Errors: as leafless_layout_place, and LEAFLESS_E_ARGUMENT if there is no copy with this number.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_move_to(
    layout: *mut leafless_layout,
    number: u64,
    matrix: *const f64,
) -> leafless_status {
    guard(|| unsafe {
        let mut layout = change(layout)?;
        let placement = self::placement(matrix)?;
        Ok(layout.move_to(index(number), &placement)?)
    })
}

/// Removes a copy. The numbers of copies that were placed later decrease by one.
///
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call uses the layout.
/// - Untrusted input: any number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_remove(
    layout: *mut leafless_layout,
    number: u64,
) -> leafless_status {
    guard(|| unsafe {
        change(layout)?.remove(index(number))?;
        Ok(())
    })
}

/// Returns the placements of all copies, in the order of their numbers.
///
/// - Buffers: `placements`, room for `capacity` structs, or NULL to get only their number; `count`, one
///   number.
/// - Result: `*count`; `placements`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_placements(
    layout: *const leafless_layout,
    placements: *mut leafless_placement,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let layout = read(layout)?;
        let placements = buffer(placements, capacity, "placements")?;
        let count = out(count, "count")?;
        placements.fill_with(layout.placed())?;
        count.write(layout.placed().len() as u64)
    })
}

/// Returns the placement of one copy.
///
/// - Buffers: `placement`, one struct.
/// - Result: `*placement`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_BUSY.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
/// - Untrusted input: any number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_placement_at(
    layout: *const leafless_layout,
    number: u64,
    placement: *mut leafless_placement,
) -> leafless_status {
    guard(|| unsafe {
        let layout = read(layout)?;
        let placement = out(placement, "placement")?;
        let Some(placed) = layout.placed().get(index(number)) else {
            let problem = "must be the number of something that is placed";
            return Err(Failure::Argument { name: "number", problem });
        };
        placement.write(placed.into())
    })
}

/// Checks the placement of a copy: whether it is valid, its conflicts, and its nearest neighbour. Only near
/// objects are examined; disjoint bounding boxes cost almost nothing.
///
/// A pair of closed meshes takes some ten microseconds. Other pairs take splits. `max_splits` limits their
/// number for each pair, 0 meaning 4 096; when it is spent, the answer is UNDECIDED.
///
/// - Buffers: `options`, one struct or NULL; `conflicts`, room for `capacity` structs, or NULL; `standing`,
///   one struct.
/// - Result: `*standing`; in `conflicts` the first `capacity` neighbours without a proven YES, at most 256.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_FRAME if a solid belongs to
///   another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_BUSY. A `capacity` that is too small is not an error.
/// - Threads: any; LEAFLESS_E_BUSY while another call changes the layout.
/// - Untrusted input: any number; the default of `max_splits` bounds the work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_check(
    layout: *const leafless_layout,
    number: u64,
    options: *const leafless_options,
    conflicts: *mut leafless_neighbour,
    capacity: u64,
    standing: *mut leafless_standing,
) -> leafless_status {
    guard(|| unsafe {
        let layout = read(layout)?;
        let conflicts = buffer(conflicts, capacity, "conflicts")?;
        let standing = filled(standing, "standing")?;
        let found = controlled(options, |control| layout.check(index(number), control))?;
        for (index, conflict) in found.conflicts.iter().enumerate() {
            conflicts.put(index, conflict.into());
        }
        standing.write((&found).into())
    })
}

/// Like leafless_layout_check for all copies, in the order of their numbers, but without their nearest
/// neighbours. The results are identical for any number of threads.
///
/// - Buffers: `options`, one struct or NULL; `standings`, room for `capacity` structs, or NULL to get only
///   their number, without checks; `count`, one number.
/// - Result: `*count`, the number of copies; `standings`.
/// - Errors: as leafless_layout_check, and LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; runs on as many threads as `options` says; LEAFLESS_E_BUSY while another call changes the
///   layout.
/// - Untrusted input: only the solids; the default of `max_splits` bounds the work for each pair.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_layout_check_all(
    layout: *const leafless_layout,
    options: *const leafless_options,
    standings: *mut leafless_placed_standing,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let layout = read(layout)?;
        let standings = buffer(standings, capacity, "standings")?;
        let count = out(count, "count")?;
        standings.check(layout.placed().len())?;
        if standings.wanted() {
            standings.fill_with(&controlled(options, |control| layout.check_all(control))?)?;
        }
        count.write(layout.placed().len() as u64)
    })
}
