//! Clearance of two solids: checks of a least distance, and distances for many placements.

use super::boundary::{Failure, buffer, filled, guard, out, output, shared, slice};
use super::control::{controlled, leafless_options};
use super::csg::placement;
use super::frame::{frame, frame_of, leafless_frame, leafless_interval};
use super::measure::leafless_stop_reason;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::memory;
use leafless::query::{Gap, GapVerdict, clearance_at, gap_at_least, gap_at_least_at};
use leafless::{Affine, Clearance};

/// The verdict on whether two solids keep a least distance.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_gap_verdict {
    /// Proven: no two points of the solids are nearer.
    LEAFLESS_GAP_VERDICT_YES = 0,
    /// Proven: two points are nearer.
    LEAFLESS_GAP_VERDICT_NO = 1,
    /// Not decided at the frame's depth, or before the splits were spent; or a solid may extend beyond the
    /// universe.
    LEAFLESS_GAP_VERDICT_UNDECIDED = 2,
}

impl From<GapVerdict> for leafless_gap_verdict {
    fn from(verdict: GapVerdict) -> leafless_gap_verdict {
        match verdict {
            GapVerdict::Yes => leafless_gap_verdict::LEAFLESS_GAP_VERDICT_YES,
            GapVerdict::No => leafless_gap_verdict::LEAFLESS_GAP_VERDICT_NO,
            GapVerdict::Undecided => leafless_gap_verdict::LEAFLESS_GAP_VERDICT_UNDECIDED,
        }
    }
}

/// The verdict on whether two solids keep a least distance, with its proof.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_gap {
    /// sizeof(leafless_gap).
    pub struct_size: u32,
    /// A leafless_gap_verdict.
    pub verdict: u32,
    /// Bounds of the distance when the search ended, in model units.
    pub distance_model: leafless_interval,
    /// If `has_points`, a point of the first solid, in model units. The distance of the two points is at most
    /// the upper bound, up to rounding of their coordinates. Else zeros.
    pub point_a_model: [f64; 3],
    /// A point of the second solid.
    pub point_b_model: [f64; 3],
    /// Cells of the first solid that were split.
    pub splits_a: u64,
    /// Cells of the second solid that were split.
    pub splits_b: u64,
    /// The reason why the search ended; LEAFLESS_STOP_REASON_TOLERANCE if the verdict is proven.
    pub measured: leafless_stop_reason,
    /// Whether the upper bound is finite.
    pub has_points: bool,
    /// Whether one of the solids may extend beyond the universe; the result says nothing about the part
    /// beyond.
    pub is_clipped: bool,
}

output!(leafless_gap);

impl From<&Gap> for leafless_gap {
    fn from(found: &Gap) -> leafless_gap {
        let Gap { verdict, evidence } = found;
        let [a, b] = evidence.points.unwrap_or([[0.0; 3]; 2]);
        leafless_gap {
            struct_size: size_of::<leafless_gap>() as u32,
            verdict: leafless_gap_verdict::from(*verdict) as u32,
            distance_model: evidence.distance.into(),
            point_a_model: a,
            point_b_model: b,
            splits_a: evidence.splits[0],
            splits_b: evidence.splits[1],
            measured: evidence.stop_reason.into(),
            has_points: evidence.points.is_some(),
            is_clipped: evidence.clipped,
        }
    }
}

/// The verdict on whether two solids, one of which is moved, keep a least distance.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_placed_gap {
    /// As in leafless_gap.
    pub distance_model: leafless_interval,
    /// If `has_points`, a point of the first solid, in model units; else zeros.
    pub point_a_model: [f64; 3],
    /// A point of the second solid.
    pub point_b_model: [f64; 3],
    /// Cells of the first solid that were split.
    pub splits_a: u64,
    /// Cells of the second solid that were split.
    pub splits_b: u64,
    /// A leafless_gap_verdict.
    pub verdict: u32,
    /// The reason why the search ended; LEAFLESS_STOP_REASON_TOLERANCE if the verdict is proven.
    pub measured: leafless_stop_reason,
    /// Whether the upper bound is finite.
    pub has_points: bool,
    /// Whether one of the solids may extend beyond the universe; the result says nothing about the part
    /// beyond.
    pub is_clipped: bool,
}

impl From<&Gap> for leafless_placed_gap {
    fn from(found: &Gap) -> leafless_placed_gap {
        let whole = leafless_gap::from(found);
        leafless_placed_gap {
            distance_model: whole.distance_model,
            point_a_model: whole.point_a_model,
            point_b_model: whole.point_b_model,
            splits_a: whole.splits_a,
            splits_b: whole.splits_b,
            verdict: whole.verdict,
            measured: whole.measured,
            has_points: whole.has_points,
            is_clipped: whole.is_clipped,
        }
    }
}

/// Bounds of the distance between two solids, one of which is moved.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_placed_clearance {
    /// As in leafless_clearance.
    pub distance_model: leafless_interval,
    /// If `has_points`, a point of the first solid, in model units; else zeros.
    pub point_a_model: [f64; 3],
    /// A point of the second solid.
    pub point_b_model: [f64; 3],
    /// As in leafless_clearance.
    pub depth_model: f64,
    /// Cells of the first solid that were split.
    pub splits_a: u64,
    /// Cells of the second solid that were split.
    pub splits_b: u64,
    /// The reason why the search ended.
    pub measured: leafless_stop_reason,
    /// Whether the upper bound is finite.
    pub has_points: bool,
    /// Whether one of the solids may extend beyond the universe; the result says nothing about the part
    /// beyond.
    pub is_clipped: bool,
}

impl From<&Clearance> for leafless_placed_clearance {
    fn from(found: &Clearance) -> leafless_placed_clearance {
        let [a, b] = found.points.unwrap_or([[0.0; 3]; 2]);
        leafless_placed_clearance {
            distance_model: found.distance.into(),
            point_a_model: a,
            point_b_model: b,
            depth_model: found.depth,
            splits_a: found.splits[0],
            splits_b: found.splits[1],
            measured: found.stop_reason.into(),
            has_points: found.points.is_some(),
            is_clipped: found.clipped,
        }
    }
}

/// Returns whether two solids keep the distance `least_model` (model units) inside the universe of a frame.
/// The search ends as soon as this is proven or disproven. If the distance is almost exactly `least_model`,
/// nothing may be proven within `max_splits`, which are counted and limited as for leafless_solid_clearance.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `gap`, one struct.
/// - Result: `*gap`.
/// - Errors: as leafless_solid_interfere; LEAFLESS_E_ARGUMENT also if `least_model` is not between 2^-256 and
///   2^256.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_gap_at_least(
    a: *const leafless_solid,
    b: *const leafless_solid,
    frame: *const leafless_frame,
    least_model: f64,
    options: *const leafless_options,
    gap: *mut leafless_gap,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (&shared(a, "a")?.solid, &shared(b, "b")?.solid);
        let frame = self::frame(frame)?;
        let result = filled(gap, "gap")?;
        let found = controlled(options, |control| gap_at_least(a, b, &frame, least_model, control))?;
        result.write((&found).into())
    })
}

/// Like leafless_solid_clearance for `a` and `b` under each of many affine maps, applied as by
/// leafless_solid_transformed. `max_splits` applies to each map. The results are identical for any number of
/// threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `clearances`, room for `count`. `matrices` and
///   `clearances` may be NULL if `count` is 0.
/// - Result: `clearances[i]` for map i.
/// - Errors: as leafless_solid_interfere and leafless_solid_transformed; nothing is then written.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: as leafless_solid_clearance, and any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_clearance_many(
    a: *const leafless_solid,
    b: *const leafless_solid,
    own: *const leafless_frame,
    matrices: *const f64,
    count: u64,
    frame: *const leafless_frame,
    tolerance_model: f64,
    options: *const leafless_options,
    clearances: *mut leafless_placed_clearance,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (&shared(a, "a")?.solid, &shared(b, "b")?.solid);
        let own = frame_of(own, "own")?;
        let matrices: &[[f64; 12]] = slice(matrices.cast(), count, "matrices")?;
        let frame = self::frame(frame)?;
        if count > 0 {
            out(clearances, "clearances")?;
        }
        let results = buffer(clearances, count, "clearances")?;
        let placements = placements(matrices)?;
        let found = controlled(options, |control| {
            clearance_at(a, b, &own, &placements, &frame, tolerance_model, control)
        })?;
        results.fill_with(&found)
    })
}

/// Like leafless_solid_gap_at_least for `a` and `b` under each of many affine maps, applied as by
/// leafless_solid_transformed. `max_splits` applies to each map. The results are identical for any number of
/// threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `gaps`, room for `count`. `matrices` and `gaps` may be NULL
///   if `count` is 0.
/// - Result: `gaps[i]` for map i.
/// - Errors: as leafless_solid_gap_at_least and leafless_solid_transformed; nothing is then written.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: as leafless_solid_gap_at_least, and any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_gap_at_least_many(
    a: *const leafless_solid,
    b: *const leafless_solid,
    own: *const leafless_frame,
    matrices: *const f64,
    count: u64,
    frame: *const leafless_frame,
    least_model: f64,
    options: *const leafless_options,
    gaps: *mut leafless_placed_gap,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (&shared(a, "a")?.solid, &shared(b, "b")?.solid);
        let own = frame_of(own, "own")?;
        let matrices: &[[f64; 12]] = slice(matrices.cast(), count, "matrices")?;
        let frame = self::frame(frame)?;
        if count > 0 {
            out(gaps, "gaps")?;
        }
        let results = buffer(gaps, count, "gaps")?;
        let placements = placements(matrices)?;
        let found = controlled(options, |control| {
            gap_at_least_at(a, b, &own, &placements, &frame, least_model, control)
        })?;
        results.fill_with(&found)
    })
}

/// Returns the maps of a list of matrices.
unsafe fn placements(matrices: &[[f64; 12]]) -> Result<Vec<Affine>, Failure> {
    let mut placements = memory::with_capacity(matrices.len())?;
    for matrix in matrices {
        placements.push(unsafe { placement(matrix.as_ptr())? });
    }
    Ok(placements)
}
