//! Distances of points and of cells from solids, and the nearest cells.

use super::boundary::{Failure, array, buffer, guard, out, shared, slice};
use super::cells::{leafless_cell, tags};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::measure::leafless_stop_reason;
use super::number::{Number, enumeration};
use super::octree::leafless_octree;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::Interval;
use leafless::memory;
use leafless::query::{DistanceTo, NearCell, PointDistance, distances};

/// The set that a distance is measured to.
#[repr(u32)]
pub enum leafless_distance_to {
    /// To the solid: 0 for its points.
    LEAFLESS_DISTANCE_TO_SOLID = 0,
    /// To the complement of the solid: 0 for points outside.
    LEAFLESS_DISTANCE_TO_COMPLEMENT = 1,
    /// To the boundary, with a sign: positive outside the solid, negative inside.
    LEAFLESS_DISTANCE_TO_BOUNDARY = 2,
}

enumeration! {
    leafless_distance_to => DistanceTo {
        LEAFLESS_DISTANCE_TO_SOLID => DistanceTo::Solid,
        LEAFLESS_DISTANCE_TO_COMPLEMENT => DistanceTo::Complement,
        LEAFLESS_DISTANCE_TO_BOUNDARY => DistanceTo::Boundary,
    }
}

/// Bounds of the distance of a point from a solid.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_point_distance {
    /// The distance, in model units. The upper bound is infinite as long as no point of the set is proven,
    /// and the lower bound is infinite if the set is proven to be empty.
    pub distance_model: leafless_interval,
    /// Number of cell splits.
    pub splits: u64,
    /// The nearest point of the boundary, up to rounding, if `has_nearest`; else zeros.
    pub nearest_model: [f64; 3],
    /// The number of the surface that the nearest point lies on: for a mesh, the triangle's index. If there
    /// are several, one that bounds the solid next to the point, if one is found. UINT32_MAX if there is
    /// none.
    pub surface: u32,
    /// The reason why the search ended.
    pub measured: leafless_stop_reason,
    /// Whether the nearest point is known. A mesh inside the universe provides it with the triangle, unless
    /// the nearest triangle intersects another one, or the boundary may be nearer across a hole. For other
    /// solids it is known if the upper bound is finite, and its distance is at most that bound; but it is not
    /// known if the point may lie on the side of the boundary from which no distance is measured.
    pub has_nearest: bool,
}

impl From<&PointDistance> for leafless_point_distance {
    fn from(found: &PointDistance) -> leafless_point_distance {
        leafless_point_distance {
            distance_model: found.distance.into(),
            splits: found.splits,
            nearest_model: found.nearest.map_or([0.0; 3], |near| near.point),
            surface: found.nearest.and_then(|near| near.surface).unwrap_or(u32::MAX),
            measured: found.stop_reason.into(),
            has_nearest: found.nearest.is_some(),
        }
    }
}

/// A cell near a point.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_near_cell {
    /// The point of the closed cell that is nearest to the given point: each coordinate is that of the given
    /// point, or a rounded coordinate of a face of the cell.
    pub point_model: [f64; 3],
    /// The distance of the closed cell from the given point, rounded outward.
    pub distance_model: leafless_interval,
    /// The cell and its tag.
    pub found: leafless_cell,
}

impl From<&NearCell> for leafless_near_cell {
    fn from(near: &NearCell) -> leafless_near_cell {
        leafless_near_cell {
            point_model: near.point,
            distance_model: near.distance.into(),
            found: near.found.into(),
        }
    }
}

/// Computes the distances of points from the solid of an octree, its complement or its boundary, from the
/// octree's cells and its exterior. For the distance from the solid, FULL cells give the upper bound, FULL
/// and PARTIAL cells the lower bound. Points may lie outside the universe. Usually some dozen array elements
/// are read for each point.
///
/// - Buffers: `points_model`, `count` points of 3 numbers; `options`, one struct or NULL (its limits are
///   ignored); `distances_model`, room for `count`. `points_model` and `distances_model` may be NULL if
///   `count` is 0. `to` is a leafless_distance_to.
/// - Result: `distances_model[i]` for point i, identical for any number of threads: 0 to infinity if a
///   coordinate is not a finite number, or all numbers for LEAFLESS_DISTANCE_TO_BOUNDARY.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and for each point at most twice as
///   many array elements are read as the octree has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_distances(
    octree: *const leafless_octree,
    points_model: *const f64,
    count: u64,
    to: Number<leafless_distance_to>,
    options: *const leafless_options,
    distances_model: *mut leafless_interval,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let points: &[[f64; 3]] = slice(points_model.cast(), count, "points_model")?;
        let to = to.known("to")?;
        if count > 0 {
            out(distances_model, "distances_model")?;
        }
        let results = buffer(distances_model, count, "distances_model")?;
        let mut found = memory::filled(points.len(), Interval::exactly(0.0))?;
        controlled(options, |control| octree.distances(points, to, &mut found, control))?;
        results.fill(&memory::collected(found.into_iter().map(leafless_interval::from))?)
    })
}

/// Computes the distances of points from a solid, its complement or its boundary, without an octree. Points
/// may lie outside the universe of the frame. The cells that may be nearest are split first.
///
/// `measured` of a result is the reason why the search for the point ended. With
/// LEAFLESS_STOP_REASON_TOLERANCE the interval is no wider than `tolerance_model` (model units), or both ends
/// are infinite. With LEAFLESS_STOP_REASON_EXHAUSTED no cell is left whose split would help, or, for a solid
/// without slabs, the nearest undecided cell cannot be split, and the interval is no wider than twice the
/// diagonal of the frame's finest cells. With LEAFLESS_STOP_REASON_BUDGET `max_splits` cells were split for
/// the point, or 65 536 if that is 0.
///
/// - Buffers: `frame`, one struct; `points_model`, `count` points of 3 numbers; `options`, one struct or
///   NULL; `distances`, room for `count`. `points_model` and `distances` may be NULL if `count` is 0. `to` is
///   a leafless_distance_to.
/// - Result: `distances[i]` for point i, identical for any number of threads.
/// - Errors: LEAFLESS_E_FRAME if the solid belongs to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check, or if the tolerance is negative or not a number; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; the default of `max_splits` bounds the work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_distances(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    points_model: *const f64,
    count: u64,
    to: Number<leafless_distance_to>,
    tolerance_model: f64,
    options: *const leafless_options,
    distances: *mut leafless_point_distance,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let points: &[[f64; 3]] = slice(points_model.cast(), count, "points_model")?;
        let to = to.known("to")?;
        if count > 0 {
            out(distances, "distances")?;
        }
        let results = buffer(distances, count, "distances")?;
        let found = controlled(options, |control| {
            self::distances(solid, &frame, points, to, tolerance_model, control)
        })?;
        results.fill_with(&found)
    })
}

/// Returns the cells of an octree with tags in `tags` that are nearest to a point, the nearest first; equally
/// near cells come in Morton order. A cell is closed, has its stored size, and is not a BRANCH. With
/// LEAFLESS_TAGS_FULL and a capacity of 1 this is the nearest cell that is proven solid. The point may lie
/// outside the universe. Before cells are compared, the point is rounded to 2^-56 of the universe's edge, or,
/// if it is far away, to 2^-57 of its distance.
///
/// - Buffers: `point_model`, 3 numbers; `cells`, room for `capacity` structs, which may be NULL if `capacity`
///   is 0; `count`, one number. `tags` is one or several leafless_tags.
/// - Result: `*count`, which is `capacity` unless the octree has fewer such cells; the cells.
/// - Errors: LEAFLESS_E_ARGUMENT if `tags` is not a combination of leafless_tags, or a coordinate is not a
///   finite number; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL, and at most as many array elements
///   are read as the octree has.
///
/// cbindgen:ptrs-as-arrays=[[point_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_nearest_cells(
    octree: *const leafless_octree,
    point_model: *const f64,
    tags: u32,
    cells: *mut leafless_near_cell,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let point = array(point_model, "point_model")?;
        let tags = self::tags(tags)?;
        if capacity > 0 {
            out(cells, "cells")?;
        }
        let results = buffer(cells, capacity, "cells")?;
        let count = out(count, "count")?;
        let found = octree.nearest_cells(point, &tags, usize::try_from(capacity).unwrap_or(usize::MAX))?;
        results.fill_with(&found)?;
        count.write(found.len() as u64)
    })
}

/// Computes the signed distances of the finest cells in a box from the boundary of the solid. Entry (z·ny +
/// y)·nx + x, two numbers, belongs to the cell `min_cell` + (x, y, z), where nx, ny and nz are `max_cell` −
/// `min_cell`.
///
/// The interval between the two numbers (model units) contains the signed distance of the cell's centre from
/// the boundary of any solid that the octree's cells and its exterior describe: positive outside, negative
/// inside. The field is that of the whole solid, including the parts outside the box. The ends are distances
/// from the nearest closed cells, exact up to one outward rounding; they are infinite if there is no such
/// cell.
///
/// The time is linear in the cells of the box and a margin around it as wide as the largest distance. In
/// addition to `field`, memory is a quarter of a byte for each of these cells, and for each thread some 140
/// bytes for each cell of a slice across z. A small box far away from the solid costs as much as
/// leafless_octree_distances for its cells.
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first finest cell of the box, and the first cell
///   beyond it on each axis; `options`, one struct or NULL (its limits are ignored); `field`, `capacity`
///   numbers, two for each cell; it may be NULL if the box has no cells.
/// - Result: the field, identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, if the box is not within the universe, or if
///   `capacity` is not twice the number of its cells; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
///
/// cbindgen:ptrs-as-arrays=[[min_cell; 3], [max_cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_distance_field(
    octree: *const leafless_octree,
    min_cell: *const u32,
    max_cell: *const u32,
    options: *const leafless_options,
    field: *mut f32,
    capacity: u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let (min, max) = (array(min_cell, "min_cell")?, array(max_cell, "max_cell")?);
        if capacity > 0 {
            out(field, "field")?;
        }
        buffer(field, capacity, "field")?;
        if !capacity.is_multiple_of(2) {
            return Err(Failure::Argument { name: "capacity", problem: "must be two for each cell" });
        }
        let entries: &mut [[f32; 2]] = if capacity == 0 {
            &mut []
        } else {
            // The numbers are set before a slice of them exists.
            field.write_bytes(0, capacity as usize);
            core::slice::from_raw_parts_mut(field.cast(), capacity as usize / 2)
        };
        controlled(options, |control| octree.distance_field(min, max, entries, control))
    })
}
