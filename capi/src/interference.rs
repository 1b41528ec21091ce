//! Overlap and distance of two solids, and solids under affine maps.

use super::boundary::{Failure, buffer, filled, guard, out, output, shared, slice};
use super::control::{controlled, leafless_options};
use super::csg::placement;
use super::frame::{frame, frame_of, leafless_frame, leafless_interval};
use super::measure::leafless_stop_reason;
use super::octree::leafless_proof;
use super::solid::{give, leafless_solid};
use super::status::leafless_status;
use leafless::Cell;
use leafless::Error;
use leafless::memory;
use leafless::query::{Ball, Overlap, interference_at};
use leafless::solid::Transform;
use leafless::{AnySolid, Clearance, Interference, clearance, interference};

/// The verdict on whether the interiors of two solids share points.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_overlap {
    /// Proven: the interiors are disjoint. The solids may touch.
    LEAFLESS_OVERLAP_DISJOINT = 0,
    /// Proven: a ball lies in both.
    LEAFLESS_OVERLAP_OVERLAPPING = 1,
    /// Not decided at the frame's depth, or before the splits were spent; or both solids may extend beyond
    /// the universe and overlap there.
    LEAFLESS_OVERLAP_UNDECIDED = 2,
}

impl From<Overlap> for leafless_overlap {
    fn from(overlap: Overlap) -> leafless_overlap {
        match overlap {
            Overlap::Disjoint => leafless_overlap::LEAFLESS_OVERLAP_DISJOINT,
            Overlap::Overlapping => leafless_overlap::LEAFLESS_OVERLAP_OVERLAPPING,
            Overlap::Undecided => leafless_overlap::LEAFLESS_OVERLAP_UNDECIDED,
        }
    }
}

/// Facts about the overlap of two solids inside the universe of a frame.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_interference {
    /// The volume of their intersection, in cubic model units; the upper bound is infinite if `is_clipped`.
    pub volume_model: leafless_interval,
    /// The proofs about the first solid; unproven tags count as undecided.
    pub proof_a: leafless_proof,
    /// The proofs about the second solid.
    pub proof_b: leafless_proof,
    /// Cells of the first solid that were split.
    pub splits_a: u64,
    /// Cells of the second solid that were split.
    pub splits_b: u64,
    /// A leafless_overlap.
    pub verdict: u32,
    /// The finest level of the visited cells.
    pub level: u32,
    /// If the solids are proven to overlap, the centre, in model units, of a ball that is proven to lie in
    /// both; else zeros. It is not the largest such ball.
    pub ball_centre_model: [f64; 3],
    /// The radius of that ball.
    pub ball_radius_model: f64,
    /// The witness: the cell that contains that ball, by its index on each axis; else zeros.
    /// leafless_frame_cell_bounds returns its box. (For octrees under a map there may be no such cell,
    /// because they may overlap by less than a cell.)
    pub witness: [u32; 3],
    /// The level of that cell.
    pub witness_level: u32,
    /// Whether both solids may extend beyond the universe. Then they are not proven to be disjoint.
    pub is_clipped: bool,
}

impl From<&Interference> for leafless_interference {
    fn from(found: &Interference) -> leafless_interference {
        let witness = found.witness.unwrap_or(Cell::ROOT);
        let ball = found.ball.unwrap_or(Ball { centre: [0.0; 3], radius: 0.0 });
        leafless_interference {
            volume_model: found.volume.into(),
            proof_a: found.proofs[0].into(),
            proof_b: found.proofs[1].into(),
            splits_a: found.splits[0],
            splits_b: found.splits[1],
            verdict: leafless_overlap::from(found.verdict) as u32,
            level: found.level.into(),
            ball_centre_model: ball.centre,
            ball_radius_model: ball.radius,
            witness: witness.at,
            witness_level: witness.level.into(),
            is_clipped: found.clipped,
        }
    }
}

/// Bounds of the distance between two solids inside the universe of a frame.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_clearance {
    /// sizeof(leafless_clearance).
    pub struct_size: u32,
    /// The least distance between points of the two solids, in model units: 0 if they touch or overlap. The
    /// upper bound is infinite as long as no point of one solid is proven; the lower bound is infinite, too,
    /// if one solid is proven to be empty.
    pub distance_model: leafless_interval,
    /// If `has_nearest`, a point of the first solid, in model units. The distance of the two points is at
    /// most the upper bound, up to rounding of their coordinates; for solids with a `depth_model` the points
    /// are equal. Else zeros.
    pub point_a_model: [f64; 3],
    /// A point of the second solid.
    pub point_b_model: [f64; 3],
    /// A unit vector that points out of the first solid at its point, if one is known; else zeros.
    pub normal_a: [f64; 3],
    /// The same for the second solid.
    pub normal_b: [f64; 3],
    /// For solids that overlap, the radius, in model units, of a ball that is proven to lie in both; 0 if no
    /// ball was found.
    pub depth_model: f64,
    /// The proofs about the first solid; unproven tags count as undecided.
    pub proof_a: leafless_proof,
    /// The proofs about the second solid.
    pub proof_b: leafless_proof,
    /// Cells of the first solid that were split.
    pub splits_a: u64,
    /// Cells of the second solid that were split.
    pub splits_b: u64,
    /// If `has_nearest`, the cell of the first solid with its point, by its index on each axis; else zeros.
    pub nearest_a: [u32; 3],
    /// The level of that cell.
    pub nearest_a_level: u32,
    /// The cell of the second solid with its point.
    pub nearest_b: [u32; 3],
    /// The level of that cell.
    pub nearest_b_level: u32,
    /// The reason why the search ended.
    pub measured: leafless_stop_reason,
    /// Whether the upper bound is finite.
    pub has_nearest: bool,
    /// Whether one of the solids may extend beyond the universe; the result says nothing about the part
    /// beyond.
    pub is_clipped: bool,
}

output!(leafless_clearance);

impl From<&Clearance> for leafless_clearance {
    fn from(found: &Clearance) -> leafless_clearance {
        let [a, b] = found.nearest.unwrap_or([Cell::ROOT; 2]);
        let points = found.points.unwrap_or([[0.0; 3]; 2]);
        let normals = found.normals.map(Option::unwrap_or_default);
        leafless_clearance {
            struct_size: size_of::<leafless_clearance>() as u32,
            distance_model: found.distance.into(),
            point_a_model: points[0],
            point_b_model: points[1],
            normal_a: normals[0],
            normal_b: normals[1],
            depth_model: found.depth,
            proof_a: found.proofs[0].into(),
            proof_b: found.proofs[1].into(),
            splits_a: found.splits[0],
            splits_b: found.splits[1],
            nearest_a: a.at,
            nearest_a_level: a.level.into(),
            nearest_b: b.at,
            nearest_b_level: b.level.into(),
            measured: found.stop_reason.into(),
            has_nearest: found.nearest.is_some(),
            is_clipped: found.clipped,
        }
    }
}

/// Makes a solid under an affine map, from its cells on a frame of its own.
///
/// A cell is FULL or EMPTY if its inverse image touches only cells of the solid's own frame with that tag:
/// cells of about its size, or larger decided cells. So a surface that is not parallel to the lattice blurs
/// by about a cell, down to the depth of the solid's own frame; rounding is outward. If the map takes lattice
/// planes to lattice planes, nothing blurs. Parts outside the solid's own universe are undecided, unless the
/// solid is proven to end inside. (leafless_solid_placed moves a solid in the best way for its kind, and
/// chooses a frame if one is needed.)
///
/// - Buffers: `own`, one struct; `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check, or if an entry is neither 0 nor of a magnitude
///   between 2^-64 and 2^64, or M is singular; LEAFLESS_E_LIMIT if too many transforms are nested. Queries of
///   the result return LEAFLESS_E_FRAME if `operand` belongs to another frame than `own`.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solid and numbers.
///
/// cbindgen:ptrs-as-arrays=[[matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_transformed(
    operand: *const leafless_solid,
    own: *const leafless_frame,
    matrix: *const f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let (placed, solid) = (transformed(operand, own, matrix)?, out(solid, "solid")?);
        solid.write(give(placed))
    })
}

/// Makes a solid on its own frame under a map.
unsafe fn transformed(
    operand: *const leafless_solid,
    own: *const leafless_frame,
    matrix: *const f64,
) -> Result<Transform<AnySolid>, Failure> {
    let operand = unsafe { shared(operand, "operand") }?.solid.solid();
    let (own, placement) = unsafe { (frame_of(own, "own")?, placement(matrix)?) };
    if operand.nesting() >= AnySolid::MOST_NESTED {
        let limit = AnySolid::MOST_NESTED.into();
        return Err(Error::Limit { what: "transforms within each other", limit }.into());
    }
    Ok(Transform::new(operand.clone(), &own, &placement))
}

/// Like leafless_solid_transformed, except that LEAFLESS_RULE_SAMPLED decides every centre by the cell of the
/// solid's own frame that contains its inverse image: the centre is inside if that cell is FULL, or if that
/// cell's own centre lies inside.
///
/// So a sampled octree can be sampled again on a rotated, coarser or finer lattice, where
/// leafless_solid_transformed is refused with LEAFLESS_E_NOT_SAMPLED. A surface is displaced by up to half a
/// diagonal of the solid's own cells. A centre whose inverse image lies on a face between two cells belongs
/// to the upper cell. Other rules, and the classification of cells, are as for leafless_solid_transformed.
///
/// - Buffers: `own`, one struct; `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: as leafless_solid_transformed. Building with LEAFLESS_RULE_SAMPLED returns
///   LEAFLESS_E_NOT_SAMPLED only if the inverse image of a centre lies in an undecided cell;
///   leafless_octree_resolve decides such cells beforehand.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solid and numbers.
///
/// cbindgen:ptrs-as-arrays=[[matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_resampled(
    operand: *const leafless_solid,
    own: *const leafless_frame,
    matrix: *const f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let (placed, solid) = (transformed(operand, own, matrix)?, out(solid, "solid")?);
        solid.write(give(placed.nearest()))
    })
}

/// Returns whether two solids overlap inside the universe of a frame. Once an overlap is proven, its volume
/// is refined until the interval is no wider than `tolerance_model` cubic model units; an infinite tolerance
/// ends the work with the proof.
///
/// If both solids consist of surfaces (expressions of half-spaces, and octrees that keep their surfaces), a
/// surface that bounds both is recognised under all placements, and solids that touch in it from opposite
/// sides are proven to be disjoint. Meshes and functions of the host that touch stay undecided.
///
/// Cells of one solid are split only where the other solid may be. The work ends at the frame's depth, or
/// when `max_splits` cells of both are split, and returns the result so far.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `interference`, one struct.
/// - Result: `*interference`.
/// - Errors: LEAFLESS_E_FRAME if a solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check, or if the tolerance is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` if the depth or the solids are untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_interfere(
    a: *const leafless_solid,
    b: *const leafless_solid,
    frame: *const leafless_frame,
    tolerance_model: f64,
    options: *const leafless_options,
    interference: *mut leafless_interference,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (&shared(a, "a")?.solid, &shared(b, "b")?.solid);
        let frame = self::frame(frame)?;
        let result = out(interference, "interference")?;
        let found =
            controlled(options, |control| self::interference(a, b, &frame, tolerance_model, control))?;
        result.write((&found).into())
    })
}

/// Like leafless_solid_interfere for `a` and `b` under each of many affine maps, applied as by
/// leafless_solid_transformed. `max_splits` applies to each map. The results are identical for any number of
/// threads.
///
/// - Buffers: `own`, one struct, the frame of `b`; `matrices`, `count` times 12 numbers; `frame`, one struct,
///   that of `a`; `options`, one struct or NULL; `interferences`, room for `count`. `matrices` and
///   `interferences` may be NULL if `count` is 0.
/// - Result: `interferences[i]` for map i.
/// - Errors: as leafless_solid_interfere and leafless_solid_transformed; nothing is then written.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: as leafless_solid_interfere, and any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_interfere_many(
    a: *const leafless_solid,
    b: *const leafless_solid,
    own: *const leafless_frame,
    matrices: *const f64,
    count: u64,
    frame: *const leafless_frame,
    tolerance_model: f64,
    options: *const leafless_options,
    interferences: *mut leafless_interference,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (&shared(a, "a")?.solid, &shared(b, "b")?.solid);
        let own = frame_of(own, "own")?;
        let matrices: &[[f64; 12]] = slice(matrices.cast(), count, "matrices")?;
        let frame = self::frame(frame)?;
        if count > 0 {
            out(interferences, "interferences")?;
        }
        let results = buffer(interferences, count, "interferences")?;
        let mut placements = memory::with_capacity(matrices.len())?;
        for matrix in matrices {
            placements.push(placement(matrix.as_ptr())?);
        }
        let found = controlled(options, |control| {
            interference_at(a, b, &own, &placements, &frame, tolerance_model, control)
        })?;
        results.fill_with(&found)
    })
}

/// Computes the distance between two solids inside the universe of a frame.
///
/// `measured` of the result is the reason why the search ended. With LEAFLESS_STOP_REASON_TOLERANCE the
/// interval is no wider than `tolerance_model` (model units). With LEAFLESS_STOP_REASON_EXHAUSTED the cells
/// of the frame's depth cannot raise the lower bound, and the interval is no wider than twice their diagonal,
/// which is the limit of cells for most solids; or no pair of cells is left; or a solid may extend beyond the
/// universe, which keeps the lower bound at 0. With LEAFLESS_STOP_REASON_BUDGET `max_splits` steps were
/// taken, or 1 048 576 if that is 0. A step visits the children of one cell. A cell whose children are
/// visited again, next to another cell, counts once more.
///
/// The distance of two closed meshes in the universe is computed from their triangles, exact up to rounding:
/// some 10^-13 of their sizes and of the distance. Bodies of a mesh may overlap, unless only positive winding
/// numbers count, triangles lie on each other, or vertices were moved. A step is then 64 pairs of boxes
/// around triangles, and no cells are split.
///
/// If both solids provide slabs, as expressions, open meshes and extended octrees do, each level makes the
/// interval about four times as narrow, and plane faces, balls and cylinders are resolved at once. Other
/// solids are resolved to the size of cells: the upper bound is finite once the search has found a FULL cell
/// of each, and the work grows with the area where the distance is close to the least one, measured in cells
/// of the size of the tolerance.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `clearance`, one struct.
/// - Result: `*clearance`.
/// - Errors: as leafless_solid_interfere.
/// - Untrusted input: any solids; the default of `max_splits` bounds the work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_clearance(
    a: *const leafless_solid,
    b: *const leafless_solid,
    frame: *const leafless_frame,
    tolerance_model: f64,
    options: *const leafless_options,
    clearance: *mut leafless_clearance,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (&shared(a, "a")?.solid, &shared(b, "b")?.solid);
        let frame = self::frame(frame)?;
        let result = filled(clearance, "clearance")?;
        let found = controlled(options, |control| self::clearance(a, b, &frame, tolerance_model, control))?;
        result.write((&found).into())
    })
}
