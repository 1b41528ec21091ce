//! Queries of points and boxes in octrees and solids.

use super::boundary::{Failure, array, guard, out, shared, slice};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::octree::{leafless_octree, leafless_tag};
use super::solid::leafless_solid;
use super::status::leafless_status;
use core::mem::{align_of, size_of};
use leafless::query::{Region, classify_box};
use leafless::{Membership, contains};

/// The answer to a point query.
#[derive(Clone, Copy)]
#[repr(u8)]
pub enum leafless_membership {
    /// Proven outside.
    LEAFLESS_MEMBERSHIP_OUTSIDE = 0,
    /// Proven inside.
    LEAFLESS_MEMBERSHIP_INSIDE = 1,
    /// In a PARTIAL cell, outside the universe, or not a number.
    LEAFLESS_MEMBERSHIP_UNDECIDED = 2,
}

impl From<Membership> for leafless_membership {
    #[inline(always)]
    fn from(membership: Membership) -> leafless_membership {
        match membership {
            Membership::Outside => leafless_membership::LEAFLESS_MEMBERSHIP_OUTSIDE,
            Membership::Inside => leafless_membership::LEAFLESS_MEMBERSHIP_INSIDE,
            Membership::Undecided => leafless_membership::LEAFLESS_MEMBERSHIP_UNDECIDED,
        }
    }
}

// Batches write their answers directly to the host's buffer: both types have the same bytes.
const _: () = {
    assert!(size_of::<Membership>() == size_of::<leafless_membership>());
    assert!(align_of::<Membership>() == align_of::<leafless_membership>());
    assert!(Membership::Outside as u8 == leafless_membership::LEAFLESS_MEMBERSHIP_OUTSIDE as u8);
    assert!(Membership::Inside as u8 == leafless_membership::LEAFLESS_MEMBERSHIP_INSIDE as u8);
    assert!(Membership::Undecided as u8 == leafless_membership::LEAFLESS_MEMBERSHIP_UNDECIDED as u8);
};

/// Returns room for the answers to `count` points, at least one.
///
/// # Safety
/// `memberships` is NULL, or has room for `count` answers that nothing else uses.
pub(super) unsafe fn answers<'m>(
    memberships: *mut leafless_membership,
    count: usize,
) -> Result<&'m mut [Membership], Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        out(memberships, "memberships")?;
        // Every byte must be a valid answer before a slice of answers exists.
        memberships.cast::<u8>().write_bytes(Membership::Undecided as u8, count);
        Ok(core::slice::from_raw_parts_mut(memberships.cast(), count))
    }
}

/// The answer to a box query. Each is proven, except UNDECIDED.
#[derive(Clone, Copy)]
#[repr(u8)]
pub enum leafless_region {
    /// The interiors of box and solid are disjoint.
    LEAFLESS_REGION_OUTSIDE = 0,
    /// The box lies in the solid.
    LEAFLESS_REGION_INSIDE = 1,
    /// Nothing could be proven at the octree's depth.
    LEAFLESS_REGION_UNDECIDED = 2,
    /// Part of the box lies inside, part outside.
    LEAFLESS_REGION_CROSSING = 3,
}

impl From<Region> for leafless_region {
    fn from(region: Region) -> leafless_region {
        match region {
            Region::Outside => leafless_region::LEAFLESS_REGION_OUTSIDE,
            Region::Inside => leafless_region::LEAFLESS_REGION_INSIDE,
            Region::Crossing => leafless_region::LEAFLESS_REGION_CROSSING,
            Region::Undecided => leafless_region::LEAFLESS_REGION_UNDECIDED,
        }
    }
}

/// Returns whether the solid of an octree contains a point. A point on the boundary may be inside or outside;
/// a point that is outside the universe or not a number is undecided. At most ⌈depth/2⌉ array elements are
/// read.
///
/// - Buffers: `point_model`, 3 numbers; `membership`, one.
/// - Result: `*membership`.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
///
/// cbindgen:ptrs-as-arrays=[[point_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_contains(
    octree: *const leafless_octree,
    point_model: *const f64,
    membership: *mut leafless_membership,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let point = array(point_model, "point_model")?;
        let membership = out(membership, "membership")?;
        membership.write(octree.contains(point).into())
    })
}

/// Like leafless_octree_contains for many points at once, which is faster than one by one.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `memberships`, room for `count`. Both may be NULL
///   if `count` is 0.
/// - Result: `memberships[i]` for point i.
/// - Untrusted input: any octree, any numbers; damage reads as undecided.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_contains_many(
    octree: *const leafless_octree,
    points_model: *const f64,
    count: u64,
    memberships: *mut leafless_membership,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let points: &[[f64; 3]] = slice(points_model.cast(), count, "points_model")?;
        if points.is_empty() {
            return Ok(());
        }
        let answers = answers(memberships, points.len())?;
        Ok(octree.contains_many(points, answers)?)
    })
}

/// Returns the tag of a finest cell.
///
/// - Buffers: `cell`, 3 numbers; `tag`, one.
/// - Result: `*tag`: EMPTY, FULL or PARTIAL; PARTIAL if a coordinate is not below 2^depth.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_tag_at(
    octree: *const leafless_octree,
    cell: *const u32,
    tag: *mut leafless_tag,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let cell = array(cell, "cell")?;
        out(tag, "tag")?.write(octree.view().tag_at(cell).into())
    })
}

/// Classifies a box against the solid of an octree. The part of the box outside the universe is undecided.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `region`, one.
/// - Result: `*region`.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number.
/// - Untrusted input: any octree, any numbers; no array element is read twice; damage reads as undecided.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_classify_box(
    octree: *const leafless_octree,
    min_model: *const f64,
    max_model: *const f64,
    region: *mut leafless_region,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let (min, max) = (array(min_model, "min_model")?, array(max_model, "max_model")?);
        let region = out(region, "region")?;
        region.write(octree.classify_box(min, max)?.into())
    })
}

/// Returns whether a solid contains points, without an octree. A point is undecided if it lies in a cell of
/// the frame that is undecided at the frame's depth, lies outside the universe, or is not a number. A point
/// on the boundary may be inside or outside. If the solid has a `contains` function of the host, it is called
/// first. Otherwise each point splits at most one cell a level, and points near each other share splits.
///
/// - Buffers: `frame`, one struct; `points_model`, `count` points of 3 numbers; `options`, one struct or NULL
///   (its limits are ignored); `memberships`, room for `count`. `points_model` and `memberships` may be NULL
///   if `count` is 0.
/// - Result: `memberships[i]` for point i; identical for any number of threads.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_contains_many(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    points_model: *const f64,
    count: u64,
    options: *const leafless_options,
    memberships: *mut leafless_membership,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let points: &[[f64; 3]] = slice(points_model.cast(), count, "points_model")?;
        if points.is_empty() {
            return Ok(());
        }
        let answers = answers(memberships, points.len())?;
        controlled(options, |control| contains(solid, &frame, points, answers, control))
    })
}

/// Classifies a box against a solid, without an octree, as far as the cells of the frame decide it. The part
/// of the box outside the universe is undecided. The work ends as soon as the answer is known, or when
/// `max_splits` cells are split.
///
/// - Buffers: `frame`, one struct; `min_model` and `max_model`, 3 numbers each; `options`, one struct or
///   NULL; `region`, one.
/// - Result: `*region`.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number; otherwise as
///   leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_classify_box(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    min_model: *const f64,
    max_model: *const f64,
    options: *const leafless_options,
    region: *mut leafless_region,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let (min, max) = (array(min_model, "min_model")?, array(max_model, "max_model")?);
        let region = out(region, "region")?;
        let found = controlled(options, |control| classify_box(solid, &frame, min, max, control))?;
        region.write(found.into())
    })
}
