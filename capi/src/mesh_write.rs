//! Mesh files, written.

use super::boundary::{Failure, Sized32, guard, out, shared, sized};
use super::mesh::{give, leafless_mesh};
use super::mesh_file::{leafless_mesh_format, leafless_unit};
use super::number::Number;
use super::source::{leafless_sink, sink};
use super::status::leafless_status;
use leafless::exchange::{MeshFormat, WriteOptions, write_mesh, written_form};
use std::borrow::Cow;
use std::path::Path;

/// How a mesh file is written. NULL means the defaults. All fields but the first may be zero, which is their
/// default.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_write_options {
    /// sizeof(leafless_mesh_write_options).
    pub struct_size: u32,
    /// The file's format. LEAFLESS_MESH_FORMAT_ANY means what the extension of the
    /// path says: .stl, .obj, .ply, .off or .3mf, in any letter case.
    pub format: Number<leafless_mesh_format>,
    /// 1 to write STL and PLY as text, which is several times as long; OBJ and OFF always are text, and a 3MF
    /// never is. Else 0.
    pub is_text: u32,
    /// The unit of the coordinates, which only a 3MF tells. LEAFLESS_UNIT_UNKNOWN means the
    /// millimetre. Nothing is converted.
    pub unit: Number<leafless_unit>,
    /// 1 to write PLY and OBJ with the normals that leafless_mesh_normals tells; other formats have none. Else 0.
    pub has_normals: u32,
    /// How far the true boundary may lie from the mesh, which a comment of PLY, OBJ and OFF and metadata of a 3MF
    /// tell; an STL has no place for it. leafless_mesh_file_info has it when the file is read. 0 tells nothing.
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

/// The format that a path's extension says.
fn format_of(path: &Path) -> Result<MeshFormat, Failure> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let problem = "must be given for a path with none of the extensions .stl, .obj, .ply, .off and .3mf";
    extension
        .and_then(MeshFormat::from_extension)
        .ok_or(Failure::Argument { name: "options.format", problem })
}

/// The format of a file that has no path must be given.
fn format_given(format: Option<MeshFormat>) -> Result<MeshFormat, Failure> {
    let problem = "must be given for a file without a path";
    format.ok_or(Failure::Argument { name: "options.format", problem })
}

/// Writes a mesh file: STL, PLY, OBJ, OFF or 3MF.
///
/// Vertices and triangles keep their order. PLY (little-endian, of type double), OBJ and OFF hold the
/// coordinates exactly; a 3MF has one object, which is the build's one item, and leaves out triangles that have a
/// vertex twice. STL rounds coordinates to 32 bits without a word: what is small and far away loses triangles, up
/// to all of them. leafless_mesh_written_form tells before. O(n) time and memory.
///
/// - Buffers: `options`, one struct, or NULL, with a format unless the sink has a path; `sink`, one struct.
/// - Errors: LEAFLESS_E_ARGUMENT if the format or the unit is none, if the format is LEAFLESS_MESH_FORMAT_ANY
///   and there is no path or it has none of the extensions, for an STL of coordinates beyond the range of float,
///   or for an OBJ without vertices; LEAFLESS_E_IO; LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
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
        let format = match (format, sink.path()) {
            (None, Some(path)) => format_of(path)?,
            (format, _) => format_given(format)?,
        };
        sink.put_whole(&write_mesh(mesh, format, &options)?)
    })
}

/// The mesh that a reader gets back from the file that leafless_mesh_write writes. An STL has 32-bit coordinates:
/// vertices move, vertices that meet are one, and triangles of which two corners meet are dropped, so that the
/// surface may be pinched, flat or gone. leafless_mesh_inspect of both meshes tells. All other formats keep
/// vertices and triangles as they are. O(n) time and memory.
///
/// - Buffers: `options`, one struct, with a format; `kept`, one pointer.
/// - Result: `*kept`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_mesh_write without a path; LEAFLESS_E_NO_MEMORY.
/// - Ownership: `mesh` stays as it is; give `*kept` back with leafless_mesh_free.
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
