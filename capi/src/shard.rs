//! Shards, the parts of octrees: building, cutting, joining, counting, and use as one solid.

use super::boundary::{Failure, buffer, guard, out, shared, slice};
use super::control::{controlled, leafless_options};
use super::extended::{leafless_cut_options, surface_options};
use super::frame::{frame, leafless_frame};
use super::number::{Number, enumeration};
use super::octree::{give, leafless_octree, leafless_statistics};
use super::op::leafless_rule;
use super::operation::operands;
use super::solid::{self, leafless_solid};
use super::status::leafless_status;
use leafless::lattice::MAX_DEPTH;
use leafless::octree::Statistics;
use leafless::op::{build_extended_shard, join};
use leafless::solid::ShardedOctree;
use leafless::{Cell, Error, Frame, Shard, build_shard, memory, op};

/// The kind of a shard: which cells it contains.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_shard_kind {
    /// The cells down to a level. Cells of the last level that would be split stay PARTIAL.
    LEAFLESS_SHARD_KIND_TOP = 0,
    /// The cells inside one cell, and the cells that contain it.
    LEAFLESS_SHARD_KIND_BELOW = 1,
}
use leafless_shard_kind::*;

enumeration! {
    leafless_shard_kind => leafless_shard_kind {
        LEAFLESS_SHARD_KIND_TOP => LEAFLESS_SHARD_KIND_TOP,
        LEAFLESS_SHARD_KIND_BELOW => LEAFLESS_SHARD_KIND_BELOW,
    }
}

/// The set of cells that a shard of an octree contains. All other cells of the shard are PARTIAL.
///
/// An octree is cut at a level into its top, and into one shard for each cell of that level that the top
/// leaves open (leafless_octree_open_cells). Every shard is an octree on the frame of the whole, and its
/// verdicts hold for the whole solid. leafless_octree_join joins shards again.
///
/// The code of a cell is its index in Morton order among the 8^level cells of its level. Bit 3k of the code
/// is bit k of the cell's index along x, bit 3k + 1 that along y, bit 3k + 2 that along z.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_shard {
    /// The code of the cell; 0 for a top.
    pub code: u64,
    /// The level of the cell, or the last level of a top: 0 to the depth of the frame.
    pub level: u32,
    /// A leafless_shard_kind.
    pub kind: Number<leafless_shard_kind>,
}

/// Returns a level of a frame. `name` is the name of the parameter, for messages.
fn level_of(frame: &Frame, level: u32, name: &'static str) -> Result<u8, Failure> {
    let problem = "must not be greater than the depth of the frame";
    let known = u8::try_from(level).ok().filter(|&level| level <= frame.depth());
    known.ok_or(Failure::Argument { name, problem })
}

/// Returns the cell of a frame with this level and this code. `names` are the names of both parameters.
pub(super) fn cell_of(
    frame: &Frame,
    level: u32,
    code: u64,
    names: [&'static str; 2],
) -> Result<Cell, Failure> {
    let level = level_of(frame, level, names[0])?;
    let problem = "must be less than 8^level";
    Cell::from_morton(level, code).ok_or(Failure::Argument { name: names[1], problem })
}

/// Returns the failure with the name of the refused argument in the header.
pub(super) fn renamed(failure: Failure, name: &'static str) -> Failure {
    match failure {
        Failure::Library(Error::Argument { problem, .. }) => Failure::Argument { name, problem },
        other => other,
    }
}

/// Returns the shard of a frame at `pointer`.
///
/// # Safety
/// As [`shared`].
unsafe fn shard_of(frame: &Frame, pointer: *const leafless_shard) -> Result<Shard, Failure> {
    // SAFETY: the caller's promise.
    let given = unsafe { shared(pointer, "shard")? };
    match given.kind.known("shard.kind")? {
        LEAFLESS_SHARD_KIND_TOP if given.code != 0 => {
            Err(Failure::Argument { name: "shard.code", problem: "must be 0 for a top" })
        }
        LEAFLESS_SHARD_KIND_TOP => Ok(Shard::Top { level: level_of(frame, given.level, "shard.level")? }),
        LEAFLESS_SHARD_KIND_BELOW => {
            let cell = cell_of(frame, given.level, given.code, ["shard.level", "shard.code"])?;
            Ok(Shard::Below(cell))
        }
    }
}

/// Builds one shard of the octree of a solid: the cells of the shard are those that leafless_octree_build
/// makes. All other cells are PARTIAL under every rule. Time and memory are linear in the cells of the shard
/// and the cells that contain it.
///
/// Joining the top and the shards of all cells that it leaves open (leafless_octree_join) makes the octree
/// that leafless_octree_build makes, byte for byte.
///
/// - Buffers: `frame` and `shard`, one struct each; `options`, one struct or NULL; `octree`, one pointer.
///   `rule` is a leafless_rule.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build; LEAFLESS_E_ARGUMENT also if the frame does not have the cells of the
///   shard.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_bytes` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_build_shard(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    rule: Number<leafless_rule>,
    shard: *const leafless_shard,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let rule = rule.known("rule")?;
        let shard = shard_of(&frame, shard)?;
        let octree = out(octree, "octree")?;
        octree.write(give(controlled(options, |control| build_shard(solid, &frame, rule, shard, control))?))
    })
}

/// Builds one shard of the extended octree of a solid: the cells of the shard are those that
/// leafless_octree_build_extended makes. All other cells are PARTIAL, without surfaces.
///
/// - Buffers: `frame` and `shard`, one struct each; `cuts`, one struct or NULL; `options`, one struct or
///   NULL; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build_extended; LEAFLESS_E_ARGUMENT also if the frame does not have the cells
///   of the shard.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_bytes` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_build_extended_shard(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    cuts: *const leafless_cut_options,
    shard: *const leafless_shard,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let surfaces = surface_options(cuts)?;
        let shard = shard_of(&frame, shard)?;
        let octree = out(octree, "octree")?;
        octree.write(give(controlled(options, |control| {
            build_extended_shard(solid, &frame, &surfaces, shard, control)
        })?))
    })
}

/// Cuts a shard off an octree. The shard is the octree that leafless_octree_build_shard or
/// leafless_octree_build_extended_shard makes of the solid that the octree was built from.
///
/// - Buffers: `shard`, one struct; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, without metadata and channels.
/// - Errors: LEAFLESS_E_ARGUMENT if the octree's frame does not have the cells of the shard;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `octree` is unchanged; release `*result` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree, any numbers; damage in an octree that was mapped unverified is an error or
///   reads as PARTIAL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_shard(
    octree: *const leafless_octree,
    shard: *const leafless_shard,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let shard = shard_of(octree.frame(), shard)?;
        let result = out(result, "result")?;
        result.write(give(controlled(options, |control| op::shard(octree.view(), shard, control))?))
    })
}

/// Joins several octrees of one solid on one frame. A cell is FULL or EMPTY if one of the octrees decides it,
/// and PARTIAL if all octrees leave it open. Surfaces of a PARTIAL cell are kept if one of the octrees keeps
/// them.
///
/// This is the reverse of cutting an octree into shards: the result is the whole, byte for byte. The cell of
/// a missing shard is PARTIAL. The octrees may overlap. If two of them keep surfaces of one cell, the
/// surfaces of the first octree are kept.
///
/// Time is linear in the cells that are split in one octree and not open in another one, plus the
/// memory traffic of copied parts.
///
/// - Buffers: `octrees`, `count` handles; `options`, one struct or NULL; `result`, one pointer.
/// - Result: `*result`, without metadata and channels.
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT
///   if `count` is 0, or if a cell is FULL in one octree and EMPTY in another one, so that they are not of
///   one solid; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the octrees are unchanged; release `*result` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octrees; damage in octrees that were mapped unverified is an error or reads as
///   PARTIAL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_join(
    octrees: *const *const leafless_octree,
    count: u64,
    options: *const leafless_options,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octrees = operands(octrees, count, false, "octrees", |handle| &handle.octree)?;
        let result = out(result, "result")?;
        let views = memory::collected(octrees.iter().map(|octree| *octree.view()))?;
        let joined = controlled(options, |control| join(&views, control));
        result.write(give(joined.map_err(|failure| renamed(failure, "octrees"))?))
    })
}

/// Returns the codes of the open cells of a level: the cells that an octree leaves open. Each is PARTIAL, or
/// lies in a PARTIAL cell, and keeps no surfaces. If the octree is a top of that level, each of these cells
/// needs a shard. O(cells of the levels above, and of the result).
///
/// - Buffers: `codes`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `codes`, ascending, as in leafless_shard; `*count`.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is greater than the octree's depth; LEAFLESS_E_BUFFER if the
///   capacity is too small; LEAFLESS_E_LIMIT if there are more than 2^24 cells; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_open_cells(
    octree: *const leafless_octree,
    level: u32,
    codes: *mut u64,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let level = level_of(octree.frame(), level, "level")?;
        let codes = buffer(codes, capacity, "codes")?;
        let count = out(count, "count")?;
        let cells = octree.view().open_cells(level)?;
        codes.check(cells.len())?;
        for (index, cell) in cells.iter().enumerate() {
            codes.put(index, cell.morton());
        }
        count.write(cells.len() as u64)
    })
}

/// Computes the statistics of the octree that leafless_octree_join would make of a top and its shards, level
/// by level, without joining. Each shard is represented by its counts, which leafless_octree_levels returns
/// on the machine that has the shard. The cell of a missing shard is PARTIAL. O(cells × depth).
///
/// Only `nodes`, `full` and `partial` of the counts are read.
///
/// - Buffers: `codes`, `code_count` numbers as in leafless_shard, ascending: the cells of the shards, all of
///   level `level`; `levels`, `level_count` structs: depth + 1 of the first shard, from the universe on, then
///   those of the second one, and so on; `joined`, room for `capacity` structs, or NULL to get only the
///   count; `count`, one number.
/// - Result: `*count`, depth + 1; `joined`, the levels of the whole as from leafless_octree_levels. The last
///   level has the volume.
/// - Errors: LEAFLESS_E_ARGUMENT if `level` is not less than the depth, a code is not less than 8^level, the
///   codes do not ascend, `level_count` is not `code_count` × (depth + 1), a cell is not open in `octree`, or
///   a shard does not split its cell: join such a shard and the top (leafless_octree_join), and pass the
///   result as the top; LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; wrong counts give wrong statistics.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_statistics_with(
    octree: *const leafless_octree,
    level: u32,
    codes: *const u64,
    code_count: u64,
    levels: *const leafless_statistics,
    level_count: u64,
    joined: *mut leafless_statistics,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let frame = octree.frame();
        let codes = slice(codes, code_count, "codes")?;
        let levels = slice(levels, level_count, "levels")?;
        let joined = buffer(joined, capacity, "joined")?;
        let count = out(count, "count")?;
        if level_of(frame, level, "level")? == frame.depth() {
            return Err(Failure::Argument { name: "level", problem: "must be less than the depth" });
        }
        let each = usize::from(frame.depth()) + 1;
        if code_count.checked_mul(each as u64) != Some(level_count) {
            let problem = "must be code_count times the depth + 1";
            return Err(Failure::Argument { name: "level_count", problem });
        }
        let mut shards = memory::with_capacity(codes.len())?;
        for (&code, own) in codes.iter().zip(levels.chunks_exact(each)) {
            let mut counts = [[0; 3]; MAX_DEPTH as usize + 1];
            for (counted, level) in counts.iter_mut().zip(own) {
                *counted = [level.nodes, level.full, level.partial];
            }
            let cell = cell_of(frame, level, code, ["level", "codes"])?;
            shards.push((cell, Statistics::of_counts(frame, &counts[..each])));
        }
        let found = octree.statistics_with(&shards).map_err(|error| renamed(error.into(), "codes"))?;
        joined.fill_with(found.levels())?;
        count.write(found.levels().len() as u64)
    })
}

/// Makes a solid from a top and its shards, on their universe. The solid answers like the joined octree
/// (leafless_octree_join, leafless_solid_from_octree), without joining. The library reads a shard only when
/// one of its cells is queried, so that a mapped file is not read before. The cell of a missing shard is
/// PARTIAL.
///
/// The solid keeps no list of surfaces. To build its extended octree, join the shards.
///
/// - Buffers: `codes`, `count` numbers as in leafless_shard, in any order: the cells of the shards, all of
///   level `level`; `octrees`, `count` handles: the shards; `solid`, one pointer.
/// - Result: `*solid`. O(shards).
/// - Errors: LEAFLESS_E_FRAME if the frames differ; LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT
///   if `level` is greater than the depth, a code is not less than 8^level, or two shards have the same cell;
///   LEAFLESS_E_NO_MEMORY. Queries of the solid return LEAFLESS_E_DAMAGED if an octree was mapped unverified
///   and its links are damaged.
/// - Ownership: the solid shares the octrees, which may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any octrees, any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_from_shards(
    top: *const leafless_octree,
    level: u32,
    codes: *const u64,
    octrees: *const *const leafless_octree,
    count: u64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let top = &shared(top, "top")?.octree;
        let codes = slice(codes, count, "codes")?;
        let octrees = operands(octrees, count, true, "octrees", |handle| &handle.octree)?;
        let solid = out(solid, "solid")?;
        level_of(top.frame(), level, "level")?;
        let mut shards = memory::with_capacity(octrees.len())?;
        for (&code, octree) in codes.iter().zip(octrees) {
            shards.push((cell_of(top.frame(), level, code, ["level", "codes"])?, octree.clone()));
        }
        let sharded = ShardedOctree::new(top.clone(), shards);
        solid.write(solid::give(sharded.map_err(|error| renamed(error.into(), "codes"))?))
    })
}
