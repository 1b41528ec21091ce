//! Mesh simplification.

use super::boundary::{filled, guard, out, output, shared};
use super::control::{controlled, leafless_options};
use super::mesh::{give, leafless_mesh};
use super::status::leafless_status;
use leafless::surface::{SimplifiedReport, simplify};

/// A report of leafless_mesh_simplify.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_simplified {
    /// sizeof(leafless_simplified).
    pub struct_size: u32,
    /// Proven bound of the distance between the two meshes, in model units: no point of either mesh is
    /// further from the other mesh.
    pub deviation_model: f64,
    /// Triangles that were removed.
    pub removed: u64,
    /// Pairs of intersecting triangles of the result. All of them come from intersections of the input.
    pub intersecting_pairs: u64,
}

output!(leafless_simplified);

/// Returns the mesh with fewer triangles. No point of either mesh is further than `tolerance_model` from the
/// other mesh; this is proven in both directions.
///
/// Vertices are removed; no vertex is moved. Edges between triangles whose normals differ by more than 30
/// degrees stay edges, and so do edges between triangles with different attribute values. Vertices along such
/// an edge are removed as far as the tolerance allows; corners stay. A closed manifold mesh stays a closed
/// manifold, with as many bodies and holes. Vertices on open edges, and vertices on edges of more than two
/// triangles, stay. No new intersections of triangles arise.
///
/// O(n log n) time for n triangles if each vertex has few triangles: some 20 microseconds and some 300 bytes
/// a triangle. One thread removes vertices; all threads prove the bound.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `simple`, one
///   pointer.
/// - Result: `*simple`, with the attribute values of the remaining triangles, without the values of corners;
///   its stated deviation is that of `mesh` plus the bound proven here; `*report`. Both are identical for any
///   number of threads.
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
