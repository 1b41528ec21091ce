//! Layouts: what stands where, and whether it may.

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

/// A container with obstacles, items, and the places of copies of these items. Solids are prepared once, when
/// the layout is made. Copies are numbered from 0, in the order in which they were placed.
///
/// While one call changes it, every other call returns LEAFLESS_E_BUSY, from another thread as from the
/// host's functions that are asked about a cell. While another call reads it, changing it returns
/// LEAFLESS_E_BUSY. Calls that read it may be made at once from any number of threads.
pub struct leafless_layout(RwLock<Layout>);

/// To read a layout, unless another call changes it.
///
/// # Safety
/// As [`shared`].
pub(super) unsafe fn read<'a>(
    layout: *const leafless_layout,
) -> Result<RwLockReadGuard<'a, Layout>, Failure> {
    // SAFETY: the caller's promise.
    unlocked(unsafe { shared(layout, "layout")? }.0.try_read())
}

/// To change a layout, unless another call uses it.
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
        // A change that was cut off may have placed a copy without the box around it.
        Err(TryLockError::Poisoned(_)) => panic!("an earlier call left this layout by a panic"),
        Err(TryLockError::WouldBlock) => Err(Failure::Busy { name: "layout" }),
    }
}

/// A number of the host as an index; what is too large for one is no index of anything.
fn index(number: u64) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

/// A copy of an item in its place.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_placement {
    /// The number of the item.
    pub item: u64,
    /// Where it stands: the rows of [M | t], where a point p of the item goes to M p + t.
    pub matrix: [f64; 12],
}

impl From<&Placed> for leafless_placement {
    fn from(placed: &Placed) -> leafless_placement {
        let rows = placed.placement.rows();
        leafless_placement { item: placed.item as u64, matrix: core::array::from_fn(|k| rows[k / 4][k % 4]) }
    }
}

/// What a copy may be too near to.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_beside {
    /// What lies outside the container.
    LEAFLESS_BESIDE_WALL = 0,
    /// An obstacle.
    LEAFLESS_BESIDE_OBSTACLE = 1,
    /// Another copy.
    LEAFLESS_BESIDE_PLACED = 2,
}
use leafless_beside::*;

/// What is known of a copy and something beside it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_neighbour {
    /// The distance of the two, in model units: 0 if they touch or overlap.
    pub gap_model: leafless_interval,
    /// The number of the obstacle or of the other copy; 0 for the wall.
    pub number: u64,
    /// A leafless_beside: what is beside it.
    pub beside: u32,
    /// A leafless_gap_verdict: whether the two are proven to be as far apart as they should be, or not to be.
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

/// How a copy stands, and what is next to it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_standing {
    /// sizeof(leafless_standing).
    pub struct_size: u32,
    /// A leafless_gap_verdict. YES: the copy is proven to lie in the container, to overlap with nothing, and
    /// to be as far from everything as it should be. NO: one of these is proven to be wrong.
    pub verdict: u32,
    /// How many neighbours are in the way, or may be: those of which YES is not proven. All are counted; no
    /// more than the first 256 are told.
    pub conflict_count: u64,
    /// Cells that were split.
    pub splits: u64,
    /// If `has_nearest`, what is next to the copy, but for the wall: the gap holds the least of all
    /// distances. Else it is UNDECIDED about the wall.
    pub nearest: leafless_neighbour,
    /// Whether there is anything else in the container.
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

/// How one of many copies stands.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_placed_standing {
    /// As leafless_standing has it.
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

/// A layout of what a bay holds, in which nothing is placed. It takes the time that its solids take to be
/// prepared, once each.
///
/// - Buffers: `options`, one struct or NULL; `layout`, one pointer.
/// - Result: `*layout`.
/// - Errors: LEAFLESS_E_ARGUMENT if the container or an obstacle has no bounds, or no extent along an axis;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the layout shares the solids. The bay may be changed and freed, which does not concern the
///   layout. Release `*layout` with leafless_layout_free.
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

/// Places a copy of an item, wherever that is. Nothing is checked, and the count of the item is not looked
/// at.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t], where a point p of the item goes to M p + t;
///   `number`, one number.
/// - Result: `*number`, the number of the copy, which is greater by one than that of the last.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such item; if an entry is neither 0 nor of a magnitude
///   between 2^-64 and 2^64; if M mirrors, or stretches lengths by more than 10^-9 of them;
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

/// Moves a copy to another place. Nothing is checked: leafless_layout_check does that.
///
/// - Buffers: `matrix`, 12 numbers, as for leafless_layout_place.
/// - Errors: as leafless_layout_place, and LEAFLESS_E_ARGUMENT if there is no copy of this number.
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

/// Takes a copy away. Copies that were placed later get numbers that are less by one.
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

/// Which copies stand where, in the order of their numbers.
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

/// Where one copy stands.
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

/// Whether a copy may stand where it does, what is in its way, and what is next to it. Only what is near is
/// looked at: what boxes tell apart costs nothing.
///
/// A pair of closed meshes takes some ten microseconds. Other pairs take splits. `max_splits` limits their
/// number for each pair, which is 4 096 if that is 0; once it is spent, the answer is UNDECIDED.
///
/// - Buffers: `options`, one struct or NULL; `conflicts`, room for `capacity` structs, or NULL; `standing`,
///   one struct.
/// - Result: `*standing`; in `conflicts` the first `capacity` neighbours that are in the way, or may be, and
///   no more than 256.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no copy of this number; LEAFLESS_E_FRAME if a solid belongs to
///   another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_BUSY. A `capacity` that is too small is no error.
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

/// As leafless_layout_check for all copies, in the order of their numbers, but without what is next to them.
/// The results are identical for any number of threads.
///
/// - Buffers: `options`, one struct or NULL; `standings`, room for `capacity` structs, or NULL to get only
///   their number, for which nothing is checked; `count`, one number.
/// - Result: `*count`, the number of copies; `standings`.
/// - Errors: as leafless_layout_check, and LEAFLESS_E_BUFFER if the capacity is too small.
/// - Threads: any; runs on as many threads as `options` says; LEAFLESS_E_BUSY while another call changes the
///   layout.
/// - Untrusted input: none but the solids; the default of `max_splits` bounds the work for each pair.
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
