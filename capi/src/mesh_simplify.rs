//! Meshes with fewer triangles.

use super::boundary::{filled, guard, out, output, shared};
use super::control::{controlled, leafless_options};
use super::mesh::{give, leafless_mesh};
use super::status::leafless_status;
use leafless::surface::{SimplifiedReport, simplify};

/// How a mesh was simplified.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_simplified {
    /// sizeof(leafless_simplified).
    pub struct_size: u32,
    /// No point of either mesh is further from the other one than that (model units). That is proven.
    pub deviation_model: f64,
    /// Triangles that were taken away.
    pub removed: u64,
    /// Pairs of triangles of the result that intersect each other. All of them did before.
    pub intersecting_pairs: u64,
}

output!(leafless_simplified);

/// The same mesh with fewer triangles, no point of which is further than `tolerance_model` from the mesh, and
/// none of the mesh further from it: proven in both directions by the triangles of both.
///
/// Vertices are taken out, and none is moved. Edges between triangles whose normals differ by more than 30
/// degrees stay edges, and so do those between triangles that bear different values; along an edge vertices
/// go as far as the tolerance allows, and corners stay. A mesh that is closed and a manifold stays so, with
/// as many bodies and holes. Vertices on open edges, and those where more than two triangles meet in an edge,
/// stay. No triangles intersect each other that did not before.
///
/// O(n log n) time for n triangles whose vertices have few: some 20 microseconds a triangle, and some 300
/// bytes. One thread takes vertices out, and all prove.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `simple`, one
///   pointer.
/// - Result: `*simple`, with the values of triangles that are left and without those of corners, whose stated
///   deviation is that of `mesh` with what is proven here; `*report`. The same for any number of threads.
/// - Errors: LEAFLESS_E_ARGUMENT if `tolerance_model` is not between 2^-256 and 2^256; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*simple` with leafless_mesh_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_simplify(
    mesh: *const leafless_mesh,
    tolerance_model: f64,
    options: *const leafless_options,
    report: *mut leafless_simplified,
    simple: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let report = if report.is_null() { None } else { Some(filled(report, "report")?) };
        let simple = out(simple, "simple")?;
        let found = controlled(options, |control| simplify(mesh, tolerance_model, control))?;
        if let Some(report) = report {
            let &SimplifiedReport { deviation, removed, intersecting_pairs } = found.report();
            report.write(leafless_simplified {
                struct_size: size_of::<leafless_simplified>() as u32,
                deviation_model: deviation,
                removed,
                intersecting_pairs,
            })?;
        }
        simple.write(give(found.into_mesh()))
    })
}
