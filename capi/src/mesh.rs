//! Triangle meshes: properties, defects, repair and placement.

use super::boundary::{Failure, array, buffer, filled, guard, handle, out, output, refer, release, shared};
use super::number::{Number, enumeration};
use super::status::leafless_status;
use leafless::mesh::{DefectKind, MeshDefect, MeshReport};
use leafless::{FillRule, TriangleMesh};
use std::sync::Arc;

/// A surface of triangles with shared vertices. Vertices at equal positions are welded. A mesh need not be
/// closed.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_mesh_free releases.
pub struct leafless_mesh {
    pub(super) mesh: Arc<TriangleMesh>,
    /// Warnings about the file that the mesh was read from.
    pub(super) warnings: Vec<String>,
}

/// The fill rule: which points a surface encloses.
///
/// The winding number of a surface at a point is the solid angle that the surface subtends there, divided by
/// 4π, positive where the point sees the inner side. For a closed surface it is an integer. For a surface
/// with holes, fins or inverted triangles it is a fraction, and by convention the nearest integer decides: a
/// hole is closed by the surface from which half of all directions lead out.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_fill {
    /// Points whose winding number is at least 1/2 in magnitude: overlapping bodies are united, and an
    /// inside-out body counts as a body.
    LEAFLESS_FILL_NON_ZERO = 0,
    /// Points from which a ray crosses the surface an odd number of times: the overlap of two bodies is
    /// outside. Orientation does not matter. An even number of triangles must meet on every edge.
    LEAFLESS_FILL_EVEN_ODD = 1,
    /// Points whose winding number is at least 1/2: an inside-out body is a cavity, and is subtracted from
    /// bodies that it overlaps.
    LEAFLESS_FILL_POSITIVE = 2,
}

enumeration! {
    leafless_fill => FillRule {
        LEAFLESS_FILL_NON_ZERO => FillRule::NonZero,
        LEAFLESS_FILL_EVEN_ODD => FillRule::EvenOdd,
        LEAFLESS_FILL_POSITIVE => FillRule::Positive,
    }
}

/// A report of the import of a mesh and of the connectivity of its triangles.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_report {
    /// sizeof(leafless_mesh_report).
    pub struct_size: u32,
    /// Triangles of the input: triangles + degenerate.
    pub facets_read: u64,
    /// Triangles of the mesh.
    pub triangles: u64,
    /// Vertices of the mesh, all at different positions.
    pub vertices: u64,
    /// Vertices of the input at the position of an earlier vertex.
    pub welded: u64,
    /// Triangles that were dropped because two of their corners coincide.
    pub degenerate: u64,
    /// Edges that an odd number of triangles use. A mesh is closed if it has no such edge.
    pub boundary_edges: u64,
    /// Loops of boundary edges that pass each vertex once: the holes of the surface and the rims of sheets.
    pub boundary_loops: u64,
    /// Edges that an even number of triangles use, but not half of them in each direction. A closed mesh is
    /// consistently oriented if it has no such edge.
    pub misoriented_edges: u64,
    /// Edges that more than two triangles use, for instance where two bodies touch. They are harmless.
    pub non_manifold_edges: u64,
    /// Triangles that repeat an earlier one, in the same orientation. Each repetition counts.
    pub duplicate: u64,
    /// Pairs of triangles with the same corners and opposite orientations: walls without thickness. The two
    /// cancel each other.
    pub opposite: u64,
    /// Triangles without area whose corners are three different vertices. They are harmless.
    pub flat: u64,
    /// Sets of triangles that are connected by edges. Bodies that touch only in single vertices count
    /// separately, and so do the outer and the inner surface of a hollow body.
    pub bodies: u64,
    /// Bodies that are open or not consistently oriented.
    pub open_bodies: u64,
    /// Other bodies that enclose a negative volume: cavities and inside-out bodies.
    pub inside_out_bodies: u64,
    /// Vertices that leafless_mesh_sewn moved onto another vertex.
    pub sewn: u64,
    /// Largest displacement of a sewn vertex along an axis, in model units, without a stated deviation.
    pub displacement_model: f64,
    /// Closed bodies that are proven to overlap another one: their surfaces cross, or one lies inside the
    /// other with the same orientation and no cavity between them. The winding number then exceeds 1 in
    /// magnitude at some points, and leafless_mesh_volume differs from the volume that a fill rule encloses.
    pub overlapping_bodies: u64,
    /// Other closed bodies that may overlap another one: they touch in a way that is not decided, such as a
    /// peg that fits its hole exactly, or the search had to stop.
    pub undecided_bodies: u64,
    /// Faces of more than three corners that were triangulated: from OBJ, PLY and OFF files and from
    /// polyhedra. 0 for other meshes.
    pub polygons: u64,
    /// Polygons that are not flat: corners lie off the face's plane by more than 2^-40 of its extent. Such a
    /// face does not define a surface. The mesh is one of its triangulations, and every proof about the mesh
    /// is about that triangulation.
    pub bent_polygons: u64,
    /// Half the distance, in model units and up to rounding, between the two planes parallel to a face that
    /// have all its corners between them, for the face where it is greatest. Every triangulation of the face
    /// lies between the planes.
    pub polygon_deviation_model: f64,
    /// Edges, each counted once.
    pub edges: u64,
    /// V - E + F of the vertices that triangles use, the edges and the triangles. For a 2-manifold it is 2
    /// for each component less 2 for each handle.
    pub euler_characteristic: i64,
    /// Whether the mesh is closed and consistently oriented: every edge is used as often in one direction as
    /// in the other. An empty mesh is closed.
    pub is_closed: bool,
    /// Whether exactly two triangles meet at every edge and use it in opposite directions.
    pub is_manifold: bool,
}

output!(leafless_mesh_report);

impl From<MeshReport> for leafless_mesh_report {
    fn from(found: MeshReport) -> leafless_mesh_report {
        leafless_mesh_report {
            struct_size: size_of::<leafless_mesh_report>() as u32,
            facets_read: found.facets_read,
            triangles: found.triangles,
            vertices: found.vertices,
            welded: found.welded,
            degenerate: found.degenerate,
            boundary_edges: found.boundary_edges,
            boundary_loops: found.boundary_loops,
            misoriented_edges: found.misoriented_edges,
            non_manifold_edges: found.non_manifold_edges,
            duplicate: found.duplicate,
            opposite: found.opposite,
            flat: found.flat,
            bodies: found.bodies,
            open_bodies: found.open_bodies,
            inside_out_bodies: found.inside_out_bodies,
            sewn: found.sewn,
            displacement_model: found.displacement,
            overlapping_bodies: found.overlapping_bodies,
            undecided_bodies: found.undecided_bodies,
            polygons: found.polygons,
            bent_polygons: found.bent_polygons,
            polygon_deviation_model: found.polygon_deviation,
            edges: found.edges,
            euler_characteristic: found.euler_characteristic,
            is_closed: found.is_closed(),
            is_manifold: found.is_manifold(),
        }
    }
}

/// Kinds of defects of a mesh, the most harmful first.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_defect {
    /// A loop of edges that an odd number of triangles use: around a hole, or around a sheet.
    LEAFLESS_DEFECT_HOLE = 0,
    /// Edges that an even number of triangles use, but not half of them in each direction.
    LEAFLESS_DEFECT_MISORIENTED = 1,
    /// Triangles with the same corners as an earlier one, in the same or the opposite orientation.
    LEAFLESS_DEFECT_DUPLICATE = 2,
    /// Edges that more than two triangles use. They are harmless.
    LEAFLESS_DEFECT_NON_MANIFOLD = 3,
    /// Triangles without area. They are harmless.
    LEAFLESS_DEFECT_FLAT = 4,
}

/// A defective part of a mesh: one loop around a hole, or, for the other kinds, edges or triangles that are
/// connected by common vertices.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_defect {
    /// Lower corner of the bounding box of its vertices.
    pub min_model: [f64; 3],
    /// Upper corner of the bounding box of its vertices.
    pub max_model: [f64; 3],
    /// Total length of the edges, in model units; 0 for kinds that count triangles.
    pub length_model: f64,
    /// Number of edges; for LEAFLESS_DEFECT_DUPLICATE and LEAFLESS_DEFECT_FLAT number of triangles.
    pub count: u64,
    /// The kind of defect.
    pub kind: leafless_defect,
}

impl From<&MeshDefect> for leafless_mesh_defect {
    fn from(defect: &MeshDefect) -> leafless_mesh_defect {
        leafless_mesh_defect {
            min_model: defect.bounds.0,
            max_model: defect.bounds.1,
            length_model: defect.length,
            count: defect.count,
            kind: match defect.kind {
                DefectKind::Hole => leafless_defect::LEAFLESS_DEFECT_HOLE,
                DefectKind::Misoriented => leafless_defect::LEAFLESS_DEFECT_MISORIENTED,
                DefectKind::Duplicate => leafless_defect::LEAFLESS_DEFECT_DUPLICATE,
                DefectKind::NonManifold => leafless_defect::LEAFLESS_DEFECT_NON_MANIFOLD,
                DefectKind::Flat => leafless_defect::LEAFLESS_DEFECT_FLAT,
            },
        }
    }
}

pub(super) fn give(mesh: TriangleMesh) -> *mut leafless_mesh {
    handle(leafless_mesh { mesh: Arc::new(mesh), warnings: Vec::new() })
}

/// Returns one more reference to a mesh.
///
/// - Buffers: `mesh`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `mesh`.
/// - Ownership: release each reference with leafless_mesh_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_ref(
    mesh: *const leafless_mesh,
    reference: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe { refer(mesh, "mesh", reference) })
}

/// Releases a reference to a mesh; the last release frees the mesh. Solids made of it stay.
///
/// - Buffers: `mesh`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_free(mesh: *mut leafless_mesh) {
    // SAFETY: the caller's promise.
    unsafe { release(mesh) }
}

/// Basic facts about a mesh.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_info {
    /// sizeof(leafless_mesh_info).
    pub struct_size: u32,
    /// Number of attributes of its triangles; leafless_mesh_peek_attribute_at describes each.
    pub attributes: u32,
    /// Vertices.
    pub vertices: u64,
    /// Triangles.
    pub triangles: u64,
    /// Bytes of memory that the mesh keeps: its arrays and attributes, and the analysis of its edges if it
    /// was computed. Memory that meshes and solids share counts for each of them.
    pub bytes: u64,
    /// Largest distance between the true boundary and the mesh, as stated by leafless_mesh_with_deviation.
    pub deviation_model: f64,
    /// Largest distance between the true boundary and the mesh along an axis: the deviation, plus the
    /// displacement that closed hair cracks, plus the rounding of a placement.
    pub displacement_model: f64,
}

output!(leafless_mesh_info);

/// Returns basic facts about a mesh. O(1), but for the names of attributes.
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_describe(
    mesh: *const leafless_mesh,
    info: *mut leafless_mesh_info,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        filled(info, "info")?.write(leafless_mesh_info {
            struct_size: size_of::<leafless_mesh_info>() as u32,
            attributes: mesh.attributes().len() as u32,
            vertices: mesh.vertices().len() as u64,
            triangles: mesh.triangles().len() as u64,
            bytes: mesh.bytes(),
            deviation_model: mesh.deviation(),
            displacement_model: mesh.displacement(),
        })
    })
}

/// Copies the arrays of a mesh; leafless_mesh_describe returns their lengths.
///
/// - Buffers: `vertices`, room for `vertex_capacity` vertices of 3 numbers; `triangles`, room for
///   `triangle_capacity` triangles of 3 indices. Each may be NULL if it is not wanted.
/// - Result: both arrays.
/// - Errors: LEAFLESS_E_BUFFER if a capacity is too small; then neither is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_copy(
    mesh: *const leafless_mesh,
    vertices: *mut f64,
    vertex_capacity: u64,
    triangles: *mut u32,
    triangle_capacity: u64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let vertices = buffer(vertices.cast::<[f64; 3]>(), vertex_capacity, "vertices")?;
        let triangles = buffer(triangles.cast::<[u32; 3]>(), triangle_capacity, "triangles")?;
        triangles.check(mesh.triangles().len())?;
        vertices.fill(mesh.vertices())?;
        triangles.fill(mesh.triangles())
    })
}

/// Computes the unit normals at the vertices of a mesh. They point outward where triangles turn
/// counter-clockwise as seen from outside. A normal is the mean of the normals of the adjacent triangles,
/// each weighted by its angle at the vertex, so it does not depend on the triangulation of plane parts. Where
/// the mean is zero, as at a vertex without triangles, the normal is zero. O(t + v).
///
/// - Buffers: `normals`, room for `capacity` normals of 3 numbers, or NULL to get only their number; `count`,
///   one number.
/// - Result: `*count`, the number of vertices; the normals, in the order of the vertices.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Threads: any. Each call computes them.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_normals(
    mesh: *const leafless_mesh,
    normals: *mut f64,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let normals = buffer(normals.cast::<[f64; 3]>(), capacity, "normals")?;
        let count = out(count, "count")?;
        normals.check(mesh.vertices().len())?;
        if normals.wanted() {
            normals.fill(&mesh.vertex_normals()?)?;
        }
        count.write(mesh.vertices().len() as u64)
    })
}

/// Returns the bounding box of a mesh's triangles.
///
/// - Buffers: `min_model` and `max_model`, room for 3 numbers each.
/// - Result: both corners.
/// - Errors: LEAFLESS_E_MESH if the mesh has no triangle.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_bounds(
    mesh: *const leafless_mesh,
    min_model: *mut f64,
    max_model: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let min = out(min_model.cast(), "min_model")?;
        let max = out(max_model.cast(), "max_model")?;
        if mesh.triangles().is_empty() {
            return Err(leafless::error::MeshError::Empty.into());
        }
        let (low, high): ([f64; 3], [f64; 3]) = mesh.bounds();
        min.write(low)?;
        max.write(high)
    })
}

/// Returns the volume that a mesh encloses, by the divergence theorem: overlaps count twice, inside-out
/// bodies count negative. For an open mesh it has no meaning. The result is rounded; an octree provides a
/// certified volume.
///
/// - Buffers: `volume_model`, one number.
/// - Result: `*volume_model`, in cubic model units.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_volume(
    mesh: *const leafless_mesh,
    volume_model: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        out(volume_model, "volume_model")?.write(mesh.volume())
    })
}

/// Returns the sum of the areas of a mesh's triangles. The result is rounded; leafless_solid_surface_area
/// returns the certified area of a solid's boundary. O(t).
///
/// - Buffers: `area_model`, one number.
/// - Result: `*area_model`, in square model units.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_area(
    mesh: *const leafless_mesh,
    area_model: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        out(area_model, "area_model")?.write(mesh.area())
    })
}

/// Reports the import of a mesh and the connectivity of its triangles. The first call analyses the edges and
/// searches for overlapping bodies; later calls take no time.
///
/// - Buffers: `report`, one struct.
/// - Result: `*report`.
/// - Errors: LEAFLESS_E_NO_MEMORY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_inspect(
    mesh: *const leafless_mesh,
    report: *mut leafless_mesh_report,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let report = filled(report, "report")?;
        report.write(mesh.report()?.into())
    })
}

/// Lists the defects of a mesh, the worst first: in the order of leafless_defect, and within a kind by the
/// longest side of their boxes, then by count, then by position.
///
/// - Buffers: `defects`, room for `capacity` of them, or NULL to get only their number.
/// - Result: `*count`, the number of defects, but not more than `limit`; the worst ones in `defects`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Threads: any. Each call analyses the mesh.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_defects(
    mesh: *const leafless_mesh,
    limit: u64,
    defects: *mut leafless_mesh_defect,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let defects = buffer(defects, capacity, "defects")?;
        let count = out(count, "count")?;
        let found = mesh.defects(usize::try_from(limit).unwrap_or(usize::MAX))?;
        defects.fill_with(&found)?;
        count.write(found.len() as u64)
    })
}

/// Checks that a mesh has no hole, so that every point off the surface is inside or outside. An even number
/// of triangles must meet at every edge and, except for LEAFLESS_FILL_EVEN_ODD, half of them must use it in
/// each direction. Self-intersections, overlaps, nested and inside-out bodies are all allowed. The mesh of a
/// solid need not pass this check.
///
/// - Buffers: none. `fill` is a leafless_fill.
/// - Result: LEAFLESS_OK if the mesh passes.
/// - Errors: LEAFLESS_E_MESH if the mesh is empty, not closed, or (except for LEAFLESS_FILL_EVEN_ODD) not
///   consistently oriented; LEAFLESS_E_ARGUMENT if `fill` is not a leafless_fill; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_check_closed(
    mesh: *const leafless_mesh,
    fill: Number<leafless_fill>,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        Ok(mesh.check_closed(fill.known("fill")?)?)
    })
}

/// Returns the mesh with hair cracks closed. Two vertices at open edges are merged if their distance is at
/// most 2^-24 of the longest extent of the larger of their pieces. (A piece is a set of triangles that are
/// connected by common vertices.) Verdicts about solids made of the mesh stay proven, because they allow for
/// the displacement.
///
/// - Buffers: `sewn`, one pointer.
/// - Result: `*sewn`; leafless_mesh_inspect reports how many vertices moved and how far.
/// - Errors: LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*sewn` with leafless_mesh_free.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_sewn(
    mesh: *const leafless_mesh,
    sewn: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let sewn = out(sewn, "sewn")?;
        sewn.write(give(mesh.try_clone()?.sewn()?))
    })
}

/// Returns the same mesh with a stated deviation: the true boundary is known only to lie within this distance
/// of the mesh, as the boundary of a part lies near a tessellation with that deflection. The new deviation
/// replaces an earlier one.
///
/// The assumption: the boundary of the true solid is the mesh's surface after a continuous displacement of
/// each point by at most this distance, without inverting any part. A dent, a hole or a body that the mesh
/// lacks is not covered, however small it is. Everything proven about solids made of the mesh is then proven
/// about the true solid: cells near the triangles are undecided, intervals contain the truth, and a point too
/// close to the surface gets no verdict. The area of the true boundary is not known. Placements and set
/// operations keep the deviation, and leafless_proof reports it. Results that are not proofs describe the
/// mesh itself: a sampled octree, a tri-dexel model, a picture, leafless_mesh_bounds and
/// leafless_mesh_volume.
///
/// - Buffers: `stated`, one pointer.
/// - Result: `*stated`; leafless_mesh_describe returns its deviation. A solid of it needs a closed mesh, and
///   is refused with LEAFLESS_E_MESH otherwise.
/// - Errors: LEAFLESS_E_ARGUMENT unless `deviation_model` is finite, not negative, and at most 2^256;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*stated` with leafless_mesh_free.
/// - Untrusted input: any number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_with_deviation(
    mesh: *const leafless_mesh,
    deviation_model: f64,
    stated: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let stated = out(stated, "stated")?;
        stated.write(give(mesh.try_clone()?.with_deviation(deviation_model)?))
    })
}

/// Returns the mesh under an affine map: x' = M x + t, rounded. A reflection turns the mesh inside out. The
/// moved vertices count as exact: the displacement of closed cracks and a stated deviation are dropped.
/// leafless_solid_placed keeps both.
///
/// - Buffers: `matrix`, 12 numbers: three rows of M and t, (m00 m01 m02 t0, m10 …); `moved`, one pointer.
/// - Result: `*moved`, welded as by leafless_mesh_new.
/// - Errors: LEAFLESS_E_ARGUMENT if a number of the matrix is not finite; LEAFLESS_E_MESH if a vertex leaves
///   ±2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*moved` with leafless_mesh_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_transformed(
    mesh: *const leafless_mesh,
    matrix: *const f64,
    moved: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let matrix: [[f64; 4]; 3] = array(matrix.cast(), "matrix")?;
        let moved = out(moved, "moved")?;
        finite("matrix", matrix.as_flattened())?;
        let row = |[a, b, c, t]: [f64; 4], [x, y, z]: [f64; 3]| a * x + b * y + c * z + t;
        moved.write(give(mesh.transformed(|vertex| matrix.map(|m| row(m, vertex)))?))
    })
}

/// Returns the mesh moved by a vector, rounded. The displacement found by leafless_mesh_sewn and a stated
/// deviation are kept.
///
/// - Buffers: `offset_model`, 3 numbers; `moved`, one pointer.
/// - Result: `*moved`.
/// - Errors: LEAFLESS_E_ARGUMENT if a number of the offset is not finite; LEAFLESS_E_MESH if a vertex leaves
///   ±2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*moved` with leafless_mesh_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[offset_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_translated(
    mesh: *const leafless_mesh,
    offset_model: *const f64,
    moved: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let offset: [f64; 3] = array(offset_model, "offset_model")?;
        let moved = out(moved, "moved")?;
        finite("offset_model", &offset)?;
        moved.write(give(mesh.translated(offset)?))
    })
}

/// Refuses numbers that are not finite. Ranges are checked elsewhere.
fn finite(name: &'static str, values: &[f64]) -> Result<(), Failure> {
    if values.iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    Err(Failure::Argument { name, problem: "every number must be finite" })
}
