//! Deviation: the distance of the boundaries of two solids.

use super::boundary::{filled, guard, output, shared};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::measure::leafless_stop_reason;
use super::octree::leafless_proof;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::query::{OneWay, Within};
use leafless::{Deviation, deviation};

/// The one-sided distance of one boundary from another.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_one_way {
    /// The greatest distance of a point of the first boundary from the nearest point of the second, in model
    /// units. 0 if the first solid has no boundary; infinite if only the second solid has none.
    pub distance_model: leafless_interval,
    /// If `has_witness`, a point next to the first boundary; else zeros.
    pub point_model: [f64; 3],
    /// If `has_witness`, an upper bound of the point's distance from the first boundary, in model units;
    /// else 0.
    pub apart_model: f64,
    /// If `has_witness`, the point next to the second boundary that is nearest to `point_model`, as far as
    /// the boundary is known; else zeros.
    pub nearest_model: [f64; 3],
    /// Whether the lower bound was attained at a point, the witness.
    pub has_witness: bool,
}

impl From<&OneWay> for leafless_one_way {
    fn from(way: &OneWay) -> leafless_one_way {
        let at = way.at.as_ref();
        leafless_one_way {
            distance_model: way.distance.into(),
            point_model: at.map_or([0.0; 3], |at| at.point),
            apart_model: at.map_or(0.0, |at| at.apart),
            nearest_model: at.map_or([0.0; 3], |at| at.nearest),
            has_witness: at.is_some(),
        }
    }
}

/// The verdict on whether two boundaries are within a distance of each other.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_within {
    /// Proven: each point of either boundary is within the distance of the other.
    LEAFLESS_WITHIN_YES = 0,
    /// Proven: a point of one boundary is further away from the other.
    LEAFLESS_WITHIN_NO = 1,
    /// Not decided by the bounds.
    LEAFLESS_WITHIN_UNDECIDED = 2,
}

impl From<Within> for leafless_within {
    fn from(within: Within) -> leafless_within {
        match within {
            Within::Yes => leafless_within::LEAFLESS_WITHIN_YES,
            Within::No => leafless_within::LEAFLESS_WITHIN_NO,
            Within::Undecided => leafless_within::LEAFLESS_WITHIN_UNDECIDED,
        }
    }
}

/// Bounds of the distance of the boundaries of two solids.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_deviation {
    /// sizeof(leafless_deviation).
    pub struct_size: u32,
    /// The greater of the two one-sided distances, in model units: the Hausdorff distance of the boundaries.
    pub distance_model: leafless_interval,
    /// The one-sided distance of the first boundary from the second.
    pub a_to_b: leafless_one_way,
    /// The one-sided distance of the second boundary from the first.
    pub b_to_a: leafless_one_way,
    /// The proofs about the first solid; unproven tags count as undecided.
    pub proof_a: leafless_proof,
    /// The proofs about the second solid.
    pub proof_b: leafless_proof,
    /// Cells of the first solid that were split; 0 if its boundary is known to consist of triangles.
    pub splits_a: u64,
    /// Cells of the second solid that were split.
    pub splits_b: u64,
    /// Number of cuts of pieces of the first boundary.
    pub cuts_a: u64,
    /// Number of cuts of pieces of the second boundary.
    pub cuts_b: u64,
    /// A leafless_within: whether the boundaries are within `within_model` of each other.
    pub verdict: u32,
    /// The reason why the search ended.
    pub measured: leafless_stop_reason,
    /// Whether the first solid may extend beyond the universe; the result says nothing about the part beyond.
    pub is_clipped_a: bool,
    /// Whether the second solid may extend beyond the universe.
    pub is_clipped_b: bool,
}

output!(leafless_deviation);

impl leafless_deviation {
    fn new(found: &Deviation, within_model: f64) -> leafless_deviation {
        leafless_deviation {
            struct_size: size_of::<leafless_deviation>() as u32,
            distance_model: found.distance().into(),
            a_to_b: (&found.a_to_b).into(),
            b_to_a: (&found.b_to_a).into(),
            proof_a: found.proofs[0].into(),
            proof_b: found.proofs[1].into(),
            splits_a: found.splits[0],
            splits_b: found.splits[1],
            cuts_a: found.cuts[0],
            cuts_b: found.cuts[1],
            verdict: leafless_within::from(found.within(within_model)) as u32,
            measured: found.stop_reason.into(),
            is_clipped_a: found.clipped[0],
            is_clipped_b: found.clipped[1],
        }
    }
}

/// Computes the distance of the boundaries of two solids, in both directions, inside the universe of a frame.
///
/// The boundary of a closed mesh whose triangles do not intersect is known exactly; for two such meshes the
/// result is exact up to rounding. For any other solid, cells are split until the slabs of each cell locate
/// the boundary to a twelfth of `tolerance_model` (model units); undecided parts widen the intervals.
///
/// `measured` of the result is the reason why the search ended. With LEAFLESS_STOP_REASON_TOLERANCE both
/// intervals are no wider than `tolerance_model`. With LEAFLESS_STOP_REASON_EXHAUSTED neither splits of cells
/// nor cuts of pieces of the boundaries improve the result. With LEAFLESS_STOP_REASON_BUDGET `max_splits`
/// cells of a solid were split (262 144 if that is 0), or 64 times as many pieces of a boundary were cut, or
/// `max_bytes` is almost reached.
///
/// `verdict` of the result is a leafless_within: whether the boundaries are proven to be within
/// `within_model` of each other. If `within_model` is not a number, the verdict is undecided.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `deviation`, one struct.
/// - Result: `*deviation`.
/// - Errors: as leafless_solid_interfere.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_deviation(
    a: *const leafless_solid,
    b: *const leafless_solid,
    frame: *const leafless_frame,
    tolerance_model: f64,
    within_model: f64,
    options: *const leafless_options,
    deviation: *mut leafless_deviation,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (&shared(a, "a")?.solid, &shared(b, "b")?.solid);
        let frame = self::frame(frame)?;
        let result = filled(deviation, "deviation")?;
        let found = controlled(options, |control| self::deviation(a, b, &frame, tolerance_model, control))?;
        result.write(leafless_deviation::new(&found, within_model))
    })
}
