//! Triangle meshes: volume, centroid and inertia from the triangles, and triangles that intersect.

use super::boundary::{buffer, filled, guard, out, output, shared};
use super::control::{controlled, leafless_options};
use super::frame::leafless_interval;
use super::measure::row_by_row;
use super::mesh::{leafless_fill, leafless_mesh};
use super::number::Number;
use super::status::leafless_status;
use leafless::Interval;
use leafless::mesh::{IntersectingPair, IntersectingPairs, MeshMoments};

/// Verdict on whether the moments of the enclosed volume are known from the triangles of a mesh.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_moments_verdict {
    /// The moments are known, up to rounding and to the mesh's displacement.
    LEAFLESS_MOMENTS_VERDICT_KNOWN = 0,
    /// Not known: the mesh is empty, not closed, or not consistently oriented as the fill rule demands.
    LEAFLESS_MOMENTS_VERDICT_OPEN = 1,
    /// Not known: too many triangles lie too close to each other, or all triangles of a body are slivers.
    LEAFLESS_MOMENTS_VERDICT_UNDECIDED = 2,
    /// Not known: two triangles intersect.
    LEAFLESS_MOMENTS_VERDICT_INTERSECTING = 3,
}
use leafless_moments_verdict::*;

/// Mass properties of the volume that a mesh encloses, for density 1, as in leafless_measures. Unless they
/// are known, each interval contains all numbers.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_moments {
    /// sizeof(leafless_mesh_moments).
    pub struct_size: u32,
    /// Volume.
    pub volume_model: leafless_interval,
    /// Centroid; intervals of all numbers unless `has_centroid`.
    pub centroid_model: [leafless_interval; 3],
    /// Tensor of inertia about the model's origin, row by row.
    pub inertia_origin_model: [leafless_interval; 9],
    /// The same about the centroid.
    pub inertia_centroid_model: [leafless_interval; 9],
    /// Indices of two triangles that intersect, if `known` is LEAFLESS_MOMENTS_VERDICT_INTERSECTING; else 0.
    pub triangles: [u32; 2],
    /// Whether the moments are known, or why not.
    pub known: leafless_moments_verdict,
    /// Whether the volume is proven not to be 0.
    pub has_centroid: bool,
}

output!(leafless_mesh_moments);

impl From<MeshMoments> for leafless_mesh_moments {
    fn from(moments: MeshMoments) -> leafless_mesh_moments {
        let any = leafless_interval::from(Interval::ALL);
        let unknown = leafless_mesh_moments {
            struct_size: size_of::<leafless_mesh_moments>() as u32,
            volume_model: leafless_interval { lower: 0.0, ..any },
            centroid_model: [any; 3],
            inertia_origin_model: [any; 9],
            inertia_centroid_model: [any; 9],
            triangles: [0; 2],
            known: LEAFLESS_MOMENTS_VERDICT_OPEN,
            has_centroid: false,
        };
        match moments {
            MeshMoments::Known(moments) => leafless_mesh_moments {
                struct_size: size_of::<leafless_mesh_moments>() as u32,
                volume_model: moments.volume.into(),
                centroid_model: moments.centroid().unwrap_or([Interval::ALL; 3]).map(Into::into),
                inertia_origin_model: row_by_row(moments.inertia_about_origin()),
                inertia_centroid_model: row_by_row(moments.inertia_about_centroid()),
                known: LEAFLESS_MOMENTS_VERDICT_KNOWN,
                has_centroid: moments.centroid().is_some(),
                ..unknown
            },
            MeshMoments::Open => unknown,
            MeshMoments::Intersecting(triangles) => leafless_mesh_moments {
                struct_size: size_of::<leafless_mesh_moments>() as u32,
                triangles,
                known: LEAFLESS_MOMENTS_VERDICT_INTERSECTING,
                ..unknown
            },
            MeshMoments::Undecided => leafless_mesh_moments {
                struct_size: size_of::<leafless_mesh_moments>() as u32,
                known: LEAFLESS_MOMENTS_VERDICT_UNDECIDED,
                ..unknown
            },
        }
    }
}

/// Two triangles with a common point that is not on a common vertex or edge.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_intersecting_pair {
    /// Lower corner of a box in which they meet: the intersection of their bounding boxes.
    pub min_model: [f64; 3],
    /// Its upper corner.
    pub max_model: [f64; 3],
    /// Indices of the triangles, ascending.
    pub triangles: [u32; 2],
}

impl From<&IntersectingPair> for leafless_intersecting_pair {
    fn from(pair: &IntersectingPair) -> leafless_intersecting_pair {
        let (min_model, max_model) = pair.bounds;
        leafless_intersecting_pair { min_model, max_model, triangles: pair.triangles }
    }
}

/// Computes the volume and the moments of the region that a mesh encloses by a fill rule, exact up to
/// rounding: usually to 14 digits. They are known if the mesh is closed and no two triangles intersect.
/// leafless_solid_measure returns the same for a solid of such a mesh.
///
/// - Buffers: `options`, one struct or NULL (its limits are ignored); `moments`, one struct. `fill` is a
///   leafless_fill.
/// - Result: `*moments`, written whether they are known or not.
/// - Errors: LEAFLESS_E_ARGUMENT if `fill` is not a leafless_fill; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; works in the calling thread. Each call analyses the mesh.
/// - Untrusted input: any mesh; the work is limited.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_measure(
    mesh: *const leafless_mesh,
    fill: Number<leafless_fill>,
    options: *const leafless_options,
    moments: *mut leafless_mesh_moments,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let fill = fill.known("fill")?;
        let moments = filled(moments, "moments")?;
        moments.write(controlled(options, |control| mesh.moments(fill, control))?.into())
    })
}

/// Finds the pairs of triangles that intersect: they cross, touch, or fold onto each other. The test is
/// exact. Triangles without area are left out.
///
/// - Buffers: `options`, one struct or NULL (its limits are ignored); `pairs`, room for `capacity` of them,
///   or NULL to get only their number; `count`, one number; `is_complete`, one number.
/// - Result: `*count`, the number of pairs found; the first `capacity` of them in `pairs`, in ascending order
///   of triangles; `*is_complete`, false if the search stopped because too many triangles lie close to each
///   other.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY. A `capacity` that is too small is not an error.
/// - Threads: any; works in the calling thread. Each call analyses the mesh.
/// - Untrusted input: any mesh; the work is limited.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_intersecting_pairs(
    mesh: *const leafless_mesh,
    options: *const leafless_options,
    pairs: *mut leafless_intersecting_pair,
    capacity: u64,
    count: *mut u64,
    is_complete: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let pairs = buffer(pairs, capacity, "pairs")?;
        let count = out(count, "count")?;
        let is_complete = out(is_complete, "is_complete")?;
        let limit = usize::try_from(capacity).unwrap_or(usize::MAX);
        let IntersectingPairs { count: found, is_complete: complete, pairs: first } =
            controlled(options, |control| mesh.intersecting_pairs(limit, control))?;
        pairs.fill_with(&first)?;
        count.write(found)?;
        is_complete.write(complete)
    })
}
