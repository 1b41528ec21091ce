//! Boundaries of solids that provide their surfaces: meshes, faces, and the faces' surfaces.

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

/// The boundary of a solid: a mesh whose triangles refer to their surfaces, and its faces.
///
/// A region is a part of the boundary on one surface that is connected by edges of the mesh. On a plane it is
/// one face: an outer loop, counter-clockwise as seen from outside the solid, and a clockwise loop around
/// each hole. On a curved surface its triangles are the faces. Two faces that meet in an edge have the same
/// vertices there.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_boundary_free releases.
pub struct leafless_boundary {
    mesh: Arc<TriangleMesh>,
    report: BoundaryReport,
    surfaces: Vec<leafless_boundary_surface>,
    faces: BoundaryFaces,
}

/// The kind of a surface.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_surface_kind {
    /// A surface without numbers of its own: a sum of powers, a stretched torus.
    LEAFLESS_SURFACE_KIND_OTHER = 0,
    /// A plane: the points p with `direction` · p = `offset_model`.
    LEAFLESS_SURFACE_KIND_PLANE = 1,
    /// A ball: the points at the distance `radius_model` from `point_model`.
    LEAFLESS_SURFACE_KIND_BALL = 2,
    /// A cylinder: the points at the distance `radius_model` from the line through `point_model` along
    /// `direction`.
    LEAFLESS_SURFACE_KIND_CYLINDER = 3,
    /// A cone: the lines through `point_model` at the angle `half_angle_radians` to `direction`.
    LEAFLESS_SURFACE_KIND_CONE = 4,
    /// A torus: the points at the distance `minor_model` from the circle of radius `radius_model` around
    /// `point_model`, perpendicular to `direction`.
    LEAFLESS_SURFACE_KIND_TORUS = 5,
    /// Any other surface of degree two.
    LEAFLESS_SURFACE_KIND_QUADRIC = 6,
}

/// A surface in model space. Fields that the kind does not use are 0.
///
/// The numbers are those of the exact surface, rounded. A surface of degree two has the kind of a ball, a
/// cylinder or a cone if its coefficients match one to a relative 10^-9.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_boundary_surface {
    /// A leafless_surface_kind.
    pub kind: leafless_surface_kind,
    /// Reserved; 0.
    pub reserved: u32,
    /// Ball and torus: the centre. Cylinder: the point of the axis that is nearest to the origin. Cone: the
    /// apex.
    pub point_model: [f64; 3],
    /// Plane: the normal, which points out of the half-space that it bounds. Cylinder, cone and torus: the
    /// axis. The length is 1.
    pub direction: [f64; 3],
    /// Plane: its distance from the origin, along the normal.
    pub offset_model: f64,
    /// Ball, cylinder, and circle of a torus: the radius.
    pub radius_model: f64,
    /// Torus: the radius of the tube.
    pub minor_model: f64,
    /// Cone: the angle between axis and surface, between 0 and π/2.
    pub half_angle_radians: f64,
    /// Quadric: the coefficients of x², y², z², xy, yz, zx, x, y, z and 1, as for leafless_solid_new_quadric.
    /// The largest magnitude is between 1/2 and 1.
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

/// A connected part of a boundary on one surface.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_boundary_region {
    /// The index of its surface in leafless_boundary_surfaces; UINT32_MAX if the boundary is known only to a
    /// cell.
    pub surface: u32,
    /// Index of its first face. The others follow.
    pub first_face: u32,
    /// Number of its faces.
    pub face_count: u32,
    /// Number of its triangles in the mesh.
    pub triangle_count: u32,
    /// The area of these triangles, in square model units.
    pub area_model: f64,
    /// Whether the normal of the surface points into the solid. The normal of a plane is `direction`; that of
    /// a ball, a cylinder, a cone and a torus points away from the centre, axis or circle. So it is true for
    /// a bore, and false for a pin.
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

/// Facts about the boundary of a solid.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_boundary_report {
    /// sizeof(leafless_boundary_report).
    pub struct_size: u32,
    /// Proven bound of the distance between the mesh and the boundary of the solid, in both directions, in
    /// model units; infinite if nothing is proven.
    pub deviation_model: f64,
    /// Pairs of triangles that intersect each other: 0 unless cells of the frame's depth do not separate
    /// surfaces.
    pub intersecting_pairs: u64,
    /// Cells that the boundary crosses.
    pub cells: u64,
    /// Cells that were split.
    pub splits: u64,
    /// Number of surfaces that the solid is made of.
    pub surfaces: u64,
    /// Number of regions.
    pub regions: u64,
    /// Number of faces.
    pub faces: u64,
}

output!(leafless_boundary_report);

/// Makes the boundary of a solid that provides its surfaces, such as solids of half-spaces, and octrees that
/// keep their surfaces. Plane faces are exact, with triangles only between their corners. Curved faces become
/// chords at a distance of about `tolerance_model` at most. Edges are sharp, and corners are exact up to
/// rounding. The solid must end inside the universe of the frame.
///
/// The mesh is closed, and exactly two triangles meet at each edge; where the solid touches itself, vertices
/// have equal positions. Cells are split until at most three surfaces in each have a simple arrangement.
/// Where more surfaces meet in a point, and where surfaces touch, cells are split to the depth of the frame,
/// which costs little: a depth of 12 to 16 is good for parts.
///
/// The surfaces prove a bound of the distance between mesh and boundary. Where it exceeds the tolerance,
/// cells are split, down to the depth of the frame.
///
/// It takes about 50 microseconds and 500 bytes a cell; threads share the proof.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `boundary`, one pointer.
/// - Result: `*boundary`.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid is not known to end inside the universe, or does not consist of
///   surfaces only (a mesh and a host program's function do not), or if `tolerance_model` is not between
///   2^-256 and 2^256; LEAFLESS_E_MESH if there would be more than 2^32 - 1 vertices, triangles or corners;
///   LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
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
        // The cells lie on a lattice of their own, so no preparation is kept for the solid.
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

/// Releases a reference to a boundary; the last release frees the boundary. References to its mesh stay
/// valid.
///
/// - Buffers: `boundary`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_boundary_free(boundary: *mut leafless_boundary) {
    // SAFETY: the caller's promise.
    unsafe { release(boundary) }
}

/// Returns facts about a boundary. O(1).
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

/// Returns the mesh of a boundary. O(1).
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

/// Returns the surfaces that a solid is made of, with their kinds and numbers. Some of them may bound
/// nothing.
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

/// Returns the regions of a boundary, in the order of their faces.
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

/// Returns the region of each triangle of the mesh of a boundary.
///
/// - Buffers: `regions`, room for `capacity` numbers, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, the number of triangles; in `regions` the index of each triangle's region.
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

/// Returns the faces of a boundary in place, without a copy, in the form for leafless_mesh_write_polygons and
/// leafless_mesh_from_polyhedron: vertices of type double, which are those of the mesh, and indices of 32
/// bits.
///
/// A plane region consists of triangles, too, if its loops touch each other along edges, as where the solid
/// touches itself, or if its corners lie off one plane by more than 10^-9 of the solid's extent. A shell
/// around a void belongs to the smallest solid that contains it.
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
            // Vertices are doubles; the indices below have 32 bits.
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
