//! Contours: meshes of any solid from cells of several sizes.

use super::boundary::{filled, guard, out, output, shared};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::mesh::{give, leafless_mesh};
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::surface::{ContourReport, contour};

/// A report of leafless_solid_contour.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_contour_report {
    /// sizeof(leafless_contour_report).
    pub struct_size: u32,
    /// Proven bound of the distance between the mesh and the boundary of the solid, in both directions, in
    /// model units; infinite if nothing is proven.
    pub deviation_model: f64,
    /// Pairs of triangles that intersect each other: 0 unless cells of the frame's depth do not separate
    /// sheets of the surface.
    pub intersecting_pairs: u64,
    /// Cells that the surface passes through.
    pub cells: u64,
    /// Cells that were split.
    pub splits: u64,
    /// Points that the solid could not decide; they counted as outside.
    pub undecided: u64,
}

output!(leafless_contour_report);

/// Makes a closed mesh of any solid, with few triangles where it is flat and small triangles where it is not:
/// of meshes, expressions with meshes in them, volumes, octrees, tri-dexel models, and functions of the host.
/// The solid must end inside the universe of the frame. (leafless_solid_boundary is sharper for solids that
/// provide their surfaces.)
///
/// Cells are split until the surface in each is one piece that a single vertex can represent: the vertex lies
/// where planes of the surface meet, so that edges and corners are sharp. The distance of the mesh from the
/// solid is then about `tolerance_model`, as far as cells of the frame's depth allow. For every solid the
/// mesh is closed, exactly two triangles meet at each edge, and the triangles around each vertex are one fan.
/// A solid that is thinner than a finest cell may vanish. Points that the solid cannot decide count as
/// outside.
///
/// It takes about 100 microseconds a cell for a mesh, and more for solids that answer no rays, in one thread.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL (`max_nodes` bounds the splits; when
///   `max_splits` is spent, cells are not split further); `report`, one struct or NULL; `mesh`, one pointer.
/// - Result: `*mesh`; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid is not known to end inside the universe, or `tolerance_model`
///   is not between 2^-256 and 2^256; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices or
///   triangles; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*mesh` with leafless_mesh_free.
/// - Threads: any.
/// - Untrusted input: any solid; set `max_nodes` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_contour(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    tolerance_model: f64,
    options: *const leafless_options,
    report: *mut leafless_contour_report,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        // The cells lie on a lattice of their own, so no preparation is kept for the solid.
        let solid = shared(solid, "solid")?.solid.solid();
        let frame = self::frame(frame)?;
        let report = match report.is_null() {
            true => None,
            false => Some(filled(report, "report")?),
        };
        let mesh = out(mesh, "mesh")?;
        let found = controlled(options, |control| contour(solid, &frame, tolerance_model, control))?;
        if let Some(report) = report {
            let &ContourReport { intersecting_pairs, cells, splits, undecided, deviation } = found.report();
            report.write(leafless_contour_report {
                struct_size: size_of::<leafless_contour_report>() as u32,
                deviation_model: deviation,
                intersecting_pairs,
                cells,
                splits,
                undecided,
            })?;
        }
        mesh.write(give(found.into_mesh()))
    })
}
