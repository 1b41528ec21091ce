//! Boundaries of solids that know their surfaces: meshes, faces, and the surfaces that these lie on.

use super::boundary::{buffer, filled, guard, handle, out, output, refer, release, shared};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::mesh::leafless_mesh;
use super::number::Number;
use super::polyhedron::leafless_polyhedron_arrays;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::TriangleMesh;
use leafless::memory;
use leafless::solid::SurfaceShape;
use leafless::surface::{BoundaryFaces, BoundaryRegion, BoundaryReport, boundary};
use leafless_surface_kind::*;
use std::sync::Arc;

/// The boundary of a solid: a mesh whose triangles know their surfaces, and its faces.
///
/// A region is what hangs together on one surface, over edges of the mesh. On a plane it is one face: an
/// outer loop, which runs counter-clockwise as seen from outside the solid, and a loop around each hole,
/// which runs the other way. On a curved surface its triangles are the faces. Two faces that meet in an edge
/// have the same vertices there.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_boundary_free releases.
pub struct leafless_boundary {
    mesh: Arc<TriangleMesh>,
    report: BoundaryReport,
    surfaces: Vec<leafless_boundary_surface>,
    faces: BoundaryFaces,
}

/// What a surface is.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_surface_kind {
    /// Anything without numbers of its own: a sum of powers, a torus that is stretched.
    LEAFLESS_SURFACE_KIND_OTHER = 0,
    /// A plane: the points p with `direction` · p = `offset_model`.
    LEAFLESS_SURFACE_KIND_PLANE = 1,
    /// The points that are `radius_model` away from `point_model`.
    LEAFLESS_SURFACE_KIND_BALL = 2,
    /// The points that are `radius_model` away from the line through `point_model` along `direction`.
    LEAFLESS_SURFACE_KIND_CYLINDER = 3,
    /// The lines through `point_model` at an angle of `half_angle_radians` to `direction`.
    LEAFLESS_SURFACE_KIND_CONE = 4,
    /// The points that are `minor_model` away from the circle of radius `radius_model` around `point_model`,
    /// across `direction`.
    LEAFLESS_SURFACE_KIND_TORUS = 5,
    /// Any other surface of degree two.
    LEAFLESS_SURFACE_KIND_QUADRIC = 6,
}

/// A surface in model space. Fields that the kind does not use are 0.
///
/// The numbers are those of the exact surface, rounded. A surface of degree two has the name of a ball, a
/// cylinder or a cone if its coefficients are those of one to 10^-9 of their size.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_boundary_surface {
    /// A leafless_surface_kind.
    pub kind: leafless_surface_kind,
    /// Reserved; 0.
    pub reserved: u32,
    /// Of a ball and a torus the centre, of a cylinder the point of the axis that is nearest to the origin,
    /// of a cone the apex.
    pub point_model: [f64; 3],
    /// Of a plane the normal, which points out of the half-space that it bounds; of a cylinder, a cone and a
    /// torus the axis. Of length 1.
    pub direction: [f64; 3],
    /// Of a plane: its distance from the origin, along the normal.
    pub offset_model: f64,
    /// Of a ball and a cylinder, and of the circle of a torus.
    pub radius_model: f64,
    /// Of a torus.
    pub minor_model: f64,
    /// Of a cone: the angle between axis and surface, between 0 and π/2.
    pub half_angle_radians: f64,
    /// Of a quadric: the factors of x², y², z², xy, yz, zx, x, y, z and 1, as leafless_solid_new_quadric
    /// takes them. The largest one is between 1/2 and 1.
    pub coefficients: [f64; 10],
}

impl From<SurfaceShape> for leafless_boundary_surface {
    fn from(shape: SurfaceShape) -> leafless_boundary_surface {
        let none = leafless_boundary_surface {
            kind: LEAFLESS_SURFACE_KIND_OTHER,
            reserved: 0,
            point_model: [0.0; 3],
            direction: [0.0; 3],
            offset_model: 0.0,
            radius_model: 0.0,
            minor_model: 0.0,
            half_angle_radians: 0.0,
            coefficients: [0.0; 10],
        };
        match shape {
            SurfaceShape::Plane { normal, offset } => leafless_boundary_surface {
                kind: LEAFLESS_SURFACE_KIND_PLANE,
                direction: normal,
                offset_model: offset,
                ..none
            },
            SurfaceShape::Ball { centre, radius } => leafless_boundary_surface {
                kind: LEAFLESS_SURFACE_KIND_BALL,
                point_model: centre,
                radius_model: radius,
                ..none
            },
            SurfaceShape::Cylinder { point, axis, radius } => leafless_boundary_surface {
                kind: LEAFLESS_SURFACE_KIND_CYLINDER,
                point_model: point,
                direction: axis,
                radius_model: radius,
                ..none
            },
            SurfaceShape::Cone { apex, axis, half_angle } => leafless_boundary_surface {
                kind: LEAFLESS_SURFACE_KIND_CONE,
                point_model: apex,
                direction: axis,
                half_angle_radians: half_angle,
                ..none
            },
            SurfaceShape::Torus { centre, axis, major, minor } => leafless_boundary_surface {
                kind: LEAFLESS_SURFACE_KIND_TORUS,
                point_model: centre,
                direction: axis,
                radius_model: major,
                minor_model: minor,
                ..none
            },
            SurfaceShape::Quadric { coefficients } => {
                leafless_boundary_surface { kind: LEAFLESS_SURFACE_KIND_QUADRIC, coefficients, ..none }
            }
            _ => none,
        }
    }
}

/// A part of a boundary that hangs together on one surface.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_boundary_region {
    /// The number of its surface among those of leafless_boundary_surfaces; UINT32_MAX where the boundary is
    /// known to a cell only.
    pub surface: u32,
    /// Its first face. The others follow.
    pub first_face: u32,
    /// How many faces it has.
    pub face_count: u32,
    /// How many triangles of the mesh.
    pub triangle_count: u32,
    /// The area of these triangles.
    pub area_model: f64,
    /// Whether the normal of the surface points into the solid: that of a plane as `direction` says, that of
    /// a ball, a cylinder, a cone and a torus away from its centre, axis or circle. So a bore is turned, and
    /// a pin is not.
    pub is_turned: bool,
}

impl From<&BoundaryRegion> for leafless_boundary_region {
    fn from(region: &BoundaryRegion) -> leafless_boundary_region {
        leafless_boundary_region {
            surface: region.surface.unwrap_or(u32::MAX),
            first_face: region.faces.start,
            face_count: region.faces.len() as u32,
            triangle_count: region.triangles,
            area_model: region.area,
            is_turned: region.is_turned,
        }
    }
}

/// What is known of the boundary of a solid.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_boundary_report {
    /// sizeof(leafless_boundary_report).
    pub struct_size: u32,
    /// No point of the mesh is further from the boundary of the solid than that, and no point of the boundary
    /// from the mesh (model units). That is proven; infinite if nothing is.
    pub deviation_model: f64,
    /// Pairs of triangles that intersect each other: 0 but where cells of the frame's depth do not tell
    /// surfaces apart.
    pub intersecting_pairs: u64,
    /// Cells that the boundary passes through.
    pub cells: u64,
    /// Cells that were split.
    pub splits: u64,
    /// Surfaces that the solid is made of.
    pub surfaces: u64,
    /// Regions.
    pub regions: u64,
    /// Faces.
    pub faces: u64,
}

output!(leafless_boundary_report);

/// The boundary of a solid that knows its surfaces, as solids of half-spaces do, and octrees that keep
/// theirs: its plane faces as they are, with triangles between their corners alone, and curved ones in chords
/// that are no further from them than about `tolerance_model`. Edges are sharp, and corners are exact to
/// rounding. The solid must end inside the universe of the frame.
///
/// The mesh is closed, and exactly two triangles meet in each edge; where the solid touches itself, vertices
/// lie at one place. Cells are split until at most three surfaces in each have a simple arrangement. Where
/// more meet in a point, and where surfaces touch, they are split as far as the depth of the frame, which
/// costs little: 12 to 16 is good for parts.
///
/// How far the mesh and the boundary are from each other is proven by the surfaces. Where that is more than
/// the tolerance, cells are split, as far as the depth of the frame.
///
/// About 50 microseconds and 500 bytes a cell; threads share the proof.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `boundary`, one pointer.
/// - Result: `*boundary`.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid is not known to end inside the universe, or consists of
///   something else than surfaces, as a mesh or a host program's function does, or `tolerance_model` is not
///   between 2^-256 and 2^256; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices, triangles or
///   corners; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `solid` is unchanged; release `*boundary` with leafless_boundary_free.
/// - Threads: any.
/// - Untrusted input: any solid; set `max_nodes` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_boundary(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    tolerance_model: f64,
    options: *const leafless_options,
    boundary: *mut *mut leafless_boundary,
) -> leafless_status {
    guard(|| unsafe {
        // The cells lie on a lattice of their own, for which nothing is kept.
        let solid = shared(solid, "solid")?.solid.solid();
        let frame = self::frame(frame)?;
        let to = out(boundary, "boundary")?;
        let found = controlled(options, |control| self::boundary(solid, &frame, tolerance_model, control))?;
        let mut surfaces = memory::with_capacity(found.surfaces().len())?;
        for surface in found.surfaces() {
            surfaces.push(surface.shape()?.into());
        }
        let (faces, report) = (found.faces()?, *found.report());
        to.write(handle(leafless_boundary { mesh: Arc::new(found.into_mesh()), report, surfaces, faces }))
    })
}

/// Returns one more reference to a boundary.
///
/// - Buffers: `boundary`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `boundary`.
/// - Ownership: release each reference with leafless_boundary_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_ref(
    boundary: *const leafless_boundary,
    reference: *mut *mut leafless_boundary,
) -> leafless_status {
    guard(|| unsafe { refer(boundary, "boundary", reference) })
}

/// Releases a reference to a boundary; with the last one the boundary is gone. Its mesh stays if it was asked
/// for.
///
/// - Buffers: `boundary`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_free(boundary: *mut leafless_boundary) {
    // SAFETY: the caller's promise.
    unsafe { release(boundary) }
}

/// What is known of a boundary. O(1).
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_describe(
    boundary: *const leafless_boundary,
    report: *mut leafless_boundary_report,
) -> leafless_status {
    guard(|| unsafe {
        let boundary = shared(boundary, "boundary")?;
        let BoundaryReport { intersecting_pairs, cells, splits, deviation } = boundary.report;
        filled(report, "report")?.write(leafless_boundary_report {
            struct_size: size_of::<leafless_boundary_report>() as u32,
            deviation_model: deviation,
            intersecting_pairs,
            cells,
            splits,
            surfaces: boundary.surfaces.len() as u64,
            regions: boundary.faces.regions().len() as u64,
            faces: boundary.faces.arrays().faces.len() as u64 - 1,
        })
    })
}

/// The mesh of a boundary. O(1).
///
/// - Buffers: `mesh`, one pointer.
/// - Result: `*mesh`.
/// - Ownership: the mesh is shared, and `boundary` may be freed; release `*mesh` with leafless_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_mesh(
    boundary: *const leafless_boundary,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let own = shared(boundary, "boundary")?.mesh.clone();
        let mesh = out(mesh, "mesh")?;
        mesh.write(handle(leafless_mesh { mesh: own, warnings: Vec::new() }))
    })
}

/// The surfaces that a solid is made of, by their kinds and numbers. Some may bound nothing.
///
/// - Buffers: `surfaces`, room for `capacity` structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`; the surfaces.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_surfaces(
    boundary: *const leafless_boundary,
    surfaces: *mut leafless_boundary_surface,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let boundary = shared(boundary, "boundary")?;
        let surfaces = buffer(surfaces, capacity, "surfaces")?;
        let count = out(count, "count")?;
        surfaces.fill(&boundary.surfaces)?;
        count.write(boundary.surfaces.len() as u64)
    })
}

/// The regions of a boundary, in the order of their faces.
///
/// - Buffers: `regions`, room for `capacity` structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`; the regions.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_regions(
    boundary: *const leafless_boundary,
    regions: *mut leafless_boundary_region,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let boundary = shared(boundary, "boundary")?;
        let regions = buffer(regions, capacity, "regions")?;
        let count = out(count, "count")?;
        regions.fill_with(boundary.faces.regions())?;
        count.write(boundary.faces.regions().len() as u64)
    })
}

/// The region of each triangle of the mesh of a boundary.
///
/// - Buffers: `regions`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, the number of triangles; in `regions` the number of the region of each.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_triangle_regions(
    boundary: *const leafless_boundary,
    regions: *mut u32,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let boundary = shared(boundary, "boundary")?;
        let regions = buffer(regions, capacity, "regions")?;
        let count = out(count, "count")?;
        regions.fill(boundary.faces.of_triangles())?;
        count.write(boundary.faces.of_triangles().len() as u64)
    })
}

/// The faces of a boundary where they lie, without a copy, as leafless_mesh_write_polygons and
/// leafless_mesh_from_polyhedron take them: vertices of type double, which are those of the mesh, and indices
/// of 32 bits.
///
/// A plane region is triangles, too, if its loops touch each other along edges, as they do where the solid
/// touches itself, or if its corners lie further beside one plane than 10^-9 of the solid's extent. A shell
/// around a void belongs to the smallest solid in which it lies.
///
/// - Buffers: `arrays`, one struct.
/// - Result: `*arrays`.
/// - Ownership: the arrays belong to the boundary and live as long as the reference `boundary`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_peek_faces(
    boundary: *const leafless_boundary,
    arrays: *mut leafless_polyhedron_arrays,
) -> leafless_status {
    guard(|| unsafe {
        let faces = shared(boundary, "boundary")?.faces.arrays();
        let parts = |offsets: &[u32]| offsets.len() as u64 - 1;
        filled(arrays, "arrays")?.write(leafless_polyhedron_arrays {
            struct_size: size_of::<leafless_polyhedron_arrays>() as u32,
            // Doubles, and below indices of 32 bits.
            vertex_type: Number::ZERO,
            vertices: faces.vertices.as_ptr().cast(),
            vertex_count: faces.vertices.len() as u64,
            vertex_stride: 0,
            corners: faces.corners.as_ptr().cast(),
            corner_count: faces.corners.len() as u64,
            loops: faces.loops.as_ptr().cast(),
            loop_count: parts(faces.loops),
            faces: faces.faces.as_ptr().cast(),
            face_count: parts(faces.faces),
            shells: faces.shells.as_ptr().cast(),
            shell_count: parts(faces.shells),
            solids: faces.solids.as_ptr().cast(),
            solid_count: parts(faces.solids),
            index_type: Number::ZERO,
            scale: 0.0,
            tolerance_model: 0.0,
        })
    })
}
