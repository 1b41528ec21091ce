//! Rays: hits and intervals in octrees and solids, and lines of sight.

use super::boundary::{Failure, array, buffer, guard, out, shared, slice};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::number::{Number, enumeration};
use super::octree::leafless_octree;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::Error;
use leafless::memory;
use leafless::query::{Obstacle, RayHit, RaySpans, Sight, line_of_sight, ray_spans};
use leafless::{Ray, cast_rays};

/// A half-line or a segment: the points origin + t · direction with 0 ≤ t ≤ t_last. Each coordinate is 0 or
/// has a magnitude between 2^-256 and 2^256.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_ray {
    /// The start of the ray.
    pub origin_model: [f64; 3],
    /// The direction, not zero, of any length. t is a distance if the length is 1.
    pub direction_model: [f64; 3],
    /// The greatest t: INFINITY for a half-line, or between 2^-256 and 2^256; 1 for the segment from
    /// `origin_model` to `origin_model` + `direction_model`.
    pub t_last: f64,
}

impl TryFrom<&leafless_ray> for Ray {
    type Error = Error;

    fn try_from(ray: &leafless_ray) -> Result<Ray, Error> {
        Ray::new(ray.origin_model, ray.direction_model)?.until(ray.t_last)
    }
}

/// The first hit of a ray with a solid.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_ray_hit {
    /// The interval that contains the least t at which the ray is in the solid: before `lower` the ray is
    /// proven outside, at `upper` inside. `upper` is INFINITY if the ray is nowhere proven inside; then it
    /// may miss the solid. Both are INFINITY if nothing stops the ray.
    pub t: leafless_interval,
    /// The outward normal of the face through which the ray enters the cell, or of the surface if the solid
    /// provides it. Its length is 1 up to rounding; it is zero if the ray starts in the cell, or nothing
    /// stops it.
    pub normal: [f64; 3],
    /// The index, on each axis, of the first cell that stops the ray among the cells of its level.
    pub cell: [u32; 3],
    /// The cell's level; 0 is the universe.
    pub level: u32,
    /// The number of the surface that stops the ray, if the solid answers rays itself: for a mesh, the
    /// triangle's index. UINT32_MAX otherwise, and where the ray meets the closure of a hole of a mesh.
    pub surface: u32,
    /// Whether something stops the ray.
    pub is_hit: bool,
}

impl From<Option<RayHit>> for leafless_ray_hit {
    fn from(hit: Option<RayHit>) -> leafless_ray_hit {
        match hit {
            Some(RayHit { t, cell, normal, surface }) => leafless_ray_hit {
                t: t.into(),
                normal,
                cell: cell.at,
                level: cell.level.into(),
                surface: surface.unwrap_or(u32::MAX),
                is_hit: true,
            },
            None => leafless_ray_hit {
                t: leafless_interval { lower: f64::INFINITY, upper: f64::INFINITY },
                normal: [0.0; 3],
                cell: [0; 3],
                level: 0,
                surface: u32::MAX,
                is_hit: false,
            },
        }
    }
}

/// The cells that stop a ray.
#[repr(u32)]
pub enum leafless_obstacle {
    /// Proven solid cells: FULL.
    LEAFLESS_OBSTACLE_FULL = 0,
    /// Possibly solid cells: FULL and PARTIAL.
    LEAFLESS_OBSTACLE_UPPER = 1,
}

/// The verdict on a line of sight between two points past a solid.
#[derive(Clone, Copy)]
#[repr(u8)]
pub enum leafless_sight {
    /// Proven: no point of the segment lies in the solid.
    LEAFLESS_SIGHT_CLEAR = 0,
    /// Proven: some point of the segment lies in the solid, or on its surface.
    LEAFLESS_SIGHT_BLOCKED = 1,
    /// Neither could be proven with the cells of the frame.
    LEAFLESS_SIGHT_UNDECIDED = 2,
}

impl From<Sight> for leafless_sight {
    fn from(sight: Sight) -> leafless_sight {
        match sight {
            Sight::Clear => leafless_sight::LEAFLESS_SIGHT_CLEAR,
            Sight::Blocked => leafless_sight::LEAFLESS_SIGHT_BLOCKED,
            Sight::Undecided => leafless_sight::LEAFLESS_SIGHT_UNDECIDED,
        }
    }
}

enumeration! {
    leafless_obstacle => Obstacle {
        LEAFLESS_OBSTACLE_FULL => Obstacle::Full,
        LEAFLESS_OBSTACLE_UPPER => Obstacle::Upper,
    }
}

/// Returns one of the host's rays.
fn ray(index: usize, ray: &leafless_ray) -> Result<Ray, Failure> {
    Ray::try_from(ray).map_err(|error| Failure::Element { name: "rays", index: index as u64, error })
}

/// Finds the first hits of rays with an octree's cells, regardless of their proofs about the original solid.
/// Space outside the universe is ignored. A ray visits at most 3 · 2^depth cells, usually about a dozen.
///
/// - Buffers: `rays`, `count` structs; `hits`, room for `count`. Both may be NULL if `count` is 0. `on` is a
///   leafless_obstacle.
/// - Result: `hits[i]` for ray i.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is not a leafless_obstacle, or a ray violates the ranges of
///   leafless_ray.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_cast_rays(
    octree: *const leafless_octree,
    rays: *const leafless_ray,
    count: u64,
    on: Number<leafless_obstacle>,
    hits: *mut leafless_ray_hit,
) -> leafless_status {
    guard(|| unsafe {
        /// Number of rays that are cast together.
        const BATCH: usize = 64;
        let octree = &shared(octree, "octree")?.octree;
        let rays = slice(rays, count, "rays")?;
        let on = on.known("on")?;
        if rays.is_empty() {
            return Ok(());
        }
        out(hits, "hits")?;
        // Nothing is written before all rays are checked.
        for (index, given) in rays.iter().enumerate() {
            ray(index, given)?;
        }
        // Preparing a batch costs more than a ray.
        if let [given] = rays {
            return out(hits, "hits")?.write(octree.cast_ray(&ray(0, given)?, on).into());
        }
        let mut some: Vec<Ray> = memory::with_capacity(rays.len().min(BATCH))?;
        let mut to = hits;
        for batch in rays.chunks(BATCH) {
            some.clear();
            for given in batch {
                some.push(Ray::try_from(given)?);
            }
            let mut found = [None; BATCH];
            octree.cast_rays(&some, on, &mut found[..batch.len()])?;
            for &hit in &found[..batch.len()] {
                to.write(hit.into());
                to = to.add(1);
            }
        }
        Ok(())
    })
}

/// Finds the first hits of rays with a solid, without an octree, as far as the cells of the frame decide it;
/// in the finest cells the solid's own surfaces refine the hit. Space outside the universe is ignored. A ray
/// splits the PARTIAL cells that it passes up to the first FULL one: O(depth) cells across a surface, up to
/// O(2^depth) along one.
///
/// - Buffers: `frame`, one struct; `rays`, `count` structs; `options`, one struct or NULL (its limit
///   `max_splits` applies to each ray separately: cells that were not split count as PARTIAL); `hits`, room
///   for `count`. `rays` and `hits` may be NULL if `count` is 0. `on` is a leafless_obstacle.
/// - Result: `hits[i]` for ray i; identical for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if `on` is not a leafless_obstacle, or a ray violates the ranges of
///   leafless_ray; otherwise as leafless_solid_contains_many.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_cast_rays(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    rays: *const leafless_ray,
    count: u64,
    on: Number<leafless_obstacle>,
    options: *const leafless_options,
    hits: *mut leafless_ray_hit,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let given = slice(rays, count, "rays")?;
        let on = on.known("on")?;
        if given.is_empty() {
            return Ok(());
        }
        out(hits, "hits")?;
        let mut rays = memory::with_capacity(given.len())?;
        for (index, given) in given.iter().enumerate() {
            rays.push(ray(index, given)?);
        }
        let found = controlled(options, |control| cast_rays(solid, &frame, &rays, on, control))?;
        for (index, hit) in found.into_iter().enumerate() {
            // There is one hit for each ray, and room for that many.
            hits.add(index).write(hit.into());
        }
        Ok(())
    })
}

/// Writes the spans of a ray to the host's buffers: both lists or none.
///
/// # Safety
/// As [`buffer`] and [`out`].
unsafe fn write_spans(
    spans: impl FnOnce() -> Result<RaySpans, Failure>,
    inner: (*mut leafless_interval, u64, *mut u64),
    outer: (*mut leafless_interval, u64, *mut u64),
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        let (to_inner, inner_count) = (buffer(inner.0, inner.1, "inner")?, out(inner.2, "inner_count")?);
        let (to_outer, outer_count) = (buffer(outer.0, outer.1, "outer")?, out(outer.2, "outer_count")?);
        let RaySpans { inner, outer } = spans()?;
        to_inner.check(inner.len())?;
        to_outer.check(outer.len())?;
        to_inner.fill_with(&inner)?;
        to_outer.fill_with(&outer)?;
        inner_count.write(inner.len() as u64)?;
        outer_count.write(outer.len() as u64)
    }
}

/// Returns the intervals of a ray in an octree's cells, regardless of their proofs about the original solid:
/// ascending, disjoint intervals of t. Space outside the universe is ignored. O(cells along the ray · depth).
///
/// - Buffers: `ray`, one struct; `inner` and `outer`, room for `inner_capacity` and `outer_capacity` structs,
///   each NULL to get only its count; `inner_count` and `outer_count`, one number each.
/// - Result: `inner`, the intervals in FULL cells, rounded inward; `outer`, the intervals in FULL or PARTIAL
///   cells, rounded outward; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the ray violates the ranges of leafless_ray; LEAFLESS_E_BUFFER if a
///   capacity is too small: nothing is written then; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any numbers; damage reads as PARTIAL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_ray_spans(
    octree: *const leafless_octree,
    ray: *const leafless_ray,
    inner: *mut leafless_interval,
    inner_capacity: u64,
    inner_count: *mut u64,
    outer: *mut leafless_interval,
    outer_capacity: u64,
    outer_count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let ray = Ray::try_from(shared(ray, "ray")?)?;
        let spans = || Ok(octree.ray_spans(&ray)?);
        write_spans(spans, (inner, inner_capacity, inner_count), (outer, outer_capacity, outer_count))
    })
}

/// Returns the intervals of a ray in a solid, without an octree, as far as the cells of the frame decide it:
/// ascending, disjoint intervals of t. Space outside the universe is ignored. The ray splits all PARTIAL
/// cells that it passes: O(depth) cells where it crosses a surface, up to O(2^depth) along one. Returning
/// only the counts costs as much as returning the intervals.
///
/// - Buffers: as leafless_octree_ray_spans; `frame`, one struct; `options`, one struct or NULL (with its
///   limit `max_splits`: cells that were not split count as PARTIAL).
/// - Result: `inner`, the intervals proven inside, rounded inward; `outer`, the intervals not proven outside,
///   rounded outward; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the ray violates the ranges of leafless_ray; LEAFLESS_E_BUFFER if a
///   capacity is too small: nothing is written then; otherwise as leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_ray_spans(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    ray: *const leafless_ray,
    options: *const leafless_options,
    inner: *mut leafless_interval,
    inner_capacity: u64,
    inner_count: *mut u64,
    outer: *mut leafless_interval,
    outer_capacity: u64,
    outer_count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let ray = Ray::try_from(shared(ray, "ray")?)?;
        let spans = || controlled(options, |control| ray_spans(solid, &frame, &ray, control));
        write_spans(spans, (inner, inner_capacity, inner_count), (outer, outer_capacity, outer_count))
    })
}

/// Returns whether two points see each other past a solid, without an octree, as far as the cells of the
/// frame decide it. If the solid may extend beyond the universe and a point lies there, the answer is not
/// LEAFLESS_SIGHT_CLEAR. Costs as much as one ray of leafless_solid_cast_rays.
///
/// - Buffers: `frame`, one struct; `from_model` and `to_model`, 3 numbers each; `options`, one struct or NULL
///   (with its limit `max_splits`: cells that were not split count as PARTIAL); `sight`, one.
/// - Result: `*sight`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, or a coordinate is neither 0 nor of a magnitude
///   between 2^-256 and 2^256; otherwise as leafless_solid_contains_many.
/// - Untrusted input: any solid, any numbers; set `max_splits` if the depth or the solid is untrusted.
///
/// cbindgen:ptrs-as-arrays=[[from_model; 3], [to_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_line_of_sight(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    from_model: *const f64,
    to_model: *const f64,
    options: *const leafless_options,
    sight: *mut leafless_sight,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let (from, to) = (array(from_model, "from_model")?, array(to_model, "to_model")?);
        let sight = out(sight, "sight")?;
        let found = controlled(options, |control| line_of_sight(solid, &frame, from, to, control))?;
        sight.write(found.into())
    })
}
