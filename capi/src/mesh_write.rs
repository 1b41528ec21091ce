//! Writing of mesh files.

use super::boundary::{Failure, Sized32, filled, guard, out, output, shared, sized};
use super::control::{controlled, leafless_options};
use super::mesh::{give, leafless_mesh};
use super::mesh_file::{leafless_mesh_format, leafless_unit};
use super::number::Number;
use super::polyhedron::leafless_polyhedron_arrays;
use super::source::{leafless_sink, sink};
use super::status::leafless_status;
use leafless::exchange::{MeshFormat, WriteOptions, write_mesh, write_polygons, written_form};
use std::borrow::Cow;
use std::path::Path;

/// Options of writing a mesh file. NULL means the defaults. Zero is the default of every field but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_write_options {
    /// sizeof(leafless_mesh_write_options).
    pub struct_size: u32,
    /// The file's format. LEAFLESS_MESH_FORMAT_ANY means the format of the path's extension: .stl, .obj,
    /// .ply, .off or .3mf, in any letter case.
    pub format: Number<leafless_mesh_format>,
    /// 1 to write STL and PLY as text, which is several times as long; else 0. OBJ and OFF are always text;
    /// 3MF never is.
    pub is_text: u32,
    /// The unit of the coordinates, which only a 3MF stores. LEAFLESS_UNIT_UNKNOWN means the millimetre.
    /// Coordinates are not converted.
    pub unit: Number<leafless_unit>,
    /// 1 to write PLY and OBJ with the normals of leafless_mesh_normals, which other formats do not store;
    /// else 0.
    pub has_normals: u32,
    /// Largest distance between the true boundary and the mesh; 0 means that it is not stated. It is stored
    /// in a comment of PLY, OBJ and OFF files and in the metadata of a 3MF; an STL cannot store it. When the
    /// file is read, leafless_mesh_file_info contains it.
    pub deviation_model: f64,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_mesh_write_options {}

/// # Safety
/// `options` is NULL or points to valid options.
unsafe fn options(
    options: *const leafless_mesh_write_options,
) -> Result<(Option<MeshFormat>, WriteOptions), Failure> {
    // SAFETY: the caller's promise.
    let given = unsafe { sized(options, "options")? };
    if given.is_text > 1 {
        return Err(Failure::Argument { name: "options.is_text", problem: "must be 0 or 1" });
    }
    if given.has_normals > 1 {
        return Err(Failure::Argument { name: "options.has_normals", problem: "must be 0 or 1" });
    }
    let unit = given.unit.known("options.unit")?;
    let deviation = if given.deviation_model == 0.0 { None } else { Some(given.deviation_model) };
    let (text, normals) = (given.is_text == 1, given.has_normals == 1);
    Ok((given.format.known("options.format")?, WriteOptions { text, unit, normals, deviation }))
}

/// Returns the format of a path's extension.
fn format_of(path: &Path) -> Result<MeshFormat, Failure> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let problem = "must be given for a path with none of the extensions .stl, .obj, .ply, .off and .3mf";
    extension
        .and_then(MeshFormat::from_extension)
        .ok_or(Failure::Argument { name: "options.format", problem })
}

/// Returns the given format, or an error, because the format of a file without a path must be given.
fn format_given(format: Option<MeshFormat>) -> Result<MeshFormat, Failure> {
    let problem = "must be given for a file without a path";
    format.ok_or(Failure::Argument { name: "options.format", problem })
}

/// Returns the given format, or else the format of the path.
fn chosen(format: Option<MeshFormat>, path: Option<&Path>) -> Result<MeshFormat, Failure> {
    match (format, path) {
        (None, Some(path)) => format_of(path),
        (format, _) => format_given(format),
    }
}

/// Writes a mesh file: STL, PLY, OBJ, OFF or 3MF.
///
/// Vertices and triangles keep their order. PLY (little-endian, of type double), OBJ and OFF hold the
/// coordinates exactly; a 3MF has one object, which is the build's one item, and leaves out triangles that
/// have a vertex twice. STL rounds coordinates to 32 bits silently: a mesh that is small and far from the
/// origin loses triangles, up to all of them. leafless_mesh_written_form shows the loss beforehand, and
/// leafless_mesh_in_single_precision avoids it as far as possible. O(n) time and memory.
///
/// - Buffers: `options`, one struct, or NULL, with a format unless the sink has a path; `sink`, one struct.
/// - Errors: LEAFLESS_E_ARGUMENT if the format or the unit is invalid, if the format is
///   LEAFLESS_MESH_FORMAT_ANY and there is no path or the path has none of the extensions, for an STL of
///   coordinates beyond the range of float, or for an OBJ without vertices; LEAFLESS_E_IO;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_write(
    mesh: *const leafless_mesh,
    options: *const leafless_mesh_write_options,
    sink: *const leafless_sink,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let (format, options) = self::options(options)?;
        let sink = self::sink(sink)?;
        let format = chosen(format, sink.path())?;
        sink.put_whole(&write_mesh(mesh, format, &options)?)
    })
}

/// A report of leafless_mesh_in_single_precision.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_single_precision {
    /// sizeof(leafless_single_precision).
    pub struct_size: u32,
    /// Reserved; 0.
    pub reserved: u32,
    /// Largest displacement of a vertex along an axis by rounding, in model units.
    pub rounding_model: f64,
    /// Proven bound of the distance between the two meshes, in model units: no point of either mesh is
    /// further from the other mesh.
    pub deviation_model: f64,
    /// Triangles that rounding turned into an edge or a point; they were removed.
    pub collapsed: u64,
    /// Triangles that rounding turned into a line; they were joined to their neighbours.
    pub flipped: u64,
    /// Vertices that were moved to representable positions next to their nearest ones.
    pub moved: u64,
    /// Triangles without area and vertices at the position of another vertex that remain.
    pub degenerate: u64,
    /// Pairs of intersecting triangles that remain.
    pub intersecting_pairs: u64,
}

output!(leafless_single_precision);

/// Returns the mesh with 32-bit coordinates, as in an STL. As far as possible, it removes the triangles that
/// rounding makes degenerate and the intersections that rounding causes: leafless_mesh_write then loses
/// nothing. Edges whose ends coincide are collapsed, and triangles that become lines are joined to their
/// neighbours. Vertices of triangles that are then still degenerate or intersect move to neighbouring
/// representable positions, if these are no further than `tolerance_model` from the given positions. A closed
/// mesh stays closed. A mesh whose coordinates already are 32-bit numbers is returned unchanged, and nothing
/// is counted.
///
/// It takes a few times as long as leafless_mesh_intersecting_pairs.
///
/// - Buffers: `options`, one struct or NULL; `report`, one struct, or NULL if it is not wanted; `single`, one
///   pointer.
/// - Result: `*single`, without attributes; `*report`.
/// - Errors: LEAFLESS_E_ARGUMENT if the tolerance is negative or not a number, or for coordinates beyond the
///   range of float; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*single` with leafless_mesh_free.
/// - Untrusted input: any mesh; the work is bounded.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_in_single_precision(
    mesh: *const leafless_mesh,
    tolerance_model: f64,
    options: *const leafless_options,
    report: *mut leafless_single_precision,
    single: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let report = if report.is_null() { None } else { Some(filled(report, "report")?) };
        let single = out(single, "single")?;
        let found = controlled(options, |control| mesh.in_single_precision(tolerance_model, control))?;
        if let Some(report) = report {
            report.write(leafless_single_precision {
                struct_size: size_of::<leafless_single_precision>() as u32,
                reserved: 0,
                rounding_model: found.rounding,
                deviation_model: found.deviation,
                collapsed: found.collapsed,
                flipped: found.flipped,
                moved: found.moved,
                degenerate: found.degenerate,
                intersecting_pairs: found.intersecting_pairs,
            })?;
        }
        single.write(give(found.mesh))
    })
}

/// Writes solids with plane faces as a file of polygons: OBJ or OFF. A face with holes, which these formats
/// cannot store, is cut into a few polygons without holes; all other faces are written as given. No vertex is
/// added, and vertices keep their order.
///
/// The faces are checked as in leafless_mesh_from_polyhedron, always with its default tolerance. O(n log n)
/// time.
///
/// - Buffers: `arrays`, one struct, whose `tolerance_model` is 0; its arrays must not change during the call.
///   `options`, one struct, or NULL (only the format and the deviation are used), with a format unless the
///   sink has a path; `sink`, one struct.
/// - Errors: those of leafless_mesh_from_polyhedron; LEAFLESS_E_ARGUMENT if the format is neither OBJ nor
///   OFF, or is LEAFLESS_MESH_FORMAT_ANY and there is no path or the path has none of the extensions;
///   LEAFLESS_E_IO; LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the arrays are only read during the call, and may be freed after it.
/// - Untrusted input: any values in the arrays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_write_polygons(
    arrays: *const leafless_polyhedron_arrays,
    options: *const leafless_mesh_write_options,
    sink: *const leafless_sink,
) -> leafless_status {
    guard(|| unsafe {
        if arrays.is_null() {
            return Err(Failure::Null { name: "arrays" });
        }
        let arrays = sized(arrays, "arrays")?;
        if arrays.tolerance_model != 0.0 {
            return Err(Failure::Argument { name: "arrays.tolerance_model", problem: "must be 0" });
        }
        let (format, options) = self::options(options)?;
        let sink = self::sink(sink)?;
        let format = chosen(format, sink.path())?;
        let bytes = arrays.taken(|arrays| Ok(write_polygons(arrays, format, &options)?))?;
        sink.put_whole(&bytes)
    })
}

/// Returns the mesh that a reader gets from the file that leafless_mesh_write writes. An STL has 32-bit
/// coordinates: vertices move, vertices that coincide are merged, and triangles with coincident corners are
/// dropped, so that the surface may be pinched, flat or empty. Compare leafless_mesh_inspect of both meshes
/// to see the loss. All other formats keep vertices and triangles unchanged. O(n) time and memory.
///
/// - Buffers: `options`, one struct, with a format; `kept`, one pointer.
/// - Result: `*kept`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_mesh_write without a path; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` is unchanged; release `*kept` with leafless_mesh_free.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_written_form(
    mesh: *const leafless_mesh,
    options: *const leafless_mesh_write_options,
    kept: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        if options.is_null() {
            return Err(Failure::Null { name: "options" });
        }
        let (format, options) = self::options(options)?;
        let format = format_given(format)?;
        let kept = out(kept, "kept")?;
        kept.write(give(match written_form(mesh, format, &options)?.mesh {
            Cow::Borrowed(mesh) => mesh.try_clone()?,
            Cow::Owned(mesh) => mesh,
        }))
    })
}
