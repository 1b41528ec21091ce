//! Mesh files, written.

use super::boundary::{Failure, Sized32, buffer, guard, out, path, shared, sized};
use super::mesh::{give, leafless_mesh};
use super::mesh_file::{format, unit};
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::exchange::{MeshFormat, WriteOptions, write_mesh, written_form};
use leafless::file::replace;
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

/// How a mesh file is written. NULL means the defaults. All fields but the first may be zero, which is their
/// default.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_write_options {
    /// sizeof(leafless_mesh_write_options).
    pub struct_size: u32,
    /// The file's format, a leafless_mesh_format. LEAFLESS_MESH_FORMAT_ANY means what the extension of the
    /// path says: .stl, .obj, .ply, .off or .3mf, in any letter case.
    pub format: u32,
    /// 1 to write STL and PLY as text, which is several times as long; OBJ and OFF always are text, and a 3MF
    /// never is. Else 0.
    pub is_text: u32,
    /// The unit of the coordinates, a leafless_unit, which only a 3MF tells. LEAFLESS_UNIT_UNKNOWN means the
    /// millimetre. Nothing is converted.
    pub unit: u32,
    /// 1 to write PLY and OBJ with the normals that leafless_mesh_normals tells; other formats have none. Else 0.
    pub has_normals: u32,
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
    let unit = unit(given.unit, "options.unit")?;
    let (text, normals) = (given.is_text == 1, given.has_normals == 1);
    Ok((format(given.format)?, WriteOptions { text, unit, normals }))
}

/// The options for a file without a path, which must name the format.
///
/// # Safety
/// `options` is NULL or points to valid options.
unsafe fn in_memory(
    options: *const leafless_mesh_write_options,
) -> Result<(MeshFormat, WriteOptions), Failure> {
    if options.is_null() {
        return Err(Failure::Null { name: "options" });
    }
    // SAFETY: the caller's promise.
    let (format, options) = unsafe { self::options(options)? };
    let problem = "must be given for a file in memory, which has no name";
    Ok((format.ok_or(Failure::Argument { name: "options.format", problem })?, options))
}

/// Saves a mesh in a file: STL, PLY, OBJ, OFF or 3MF. At any moment there is the old file or the new one,
/// each complete, as leafless_octree_save tells.
///
/// Vertices and triangles keep their order. PLY (little-endian, of type double), OBJ and OFF hold the
/// coordinates exactly; a 3MF has one object, which is the build's one item, and leaves out triangles that have a
/// vertex twice. STL rounds coordinates to 32 bits without a word: what is small and far away loses triangles, up
/// to all of them. leafless_mesh_written_form tells before. O(n) time and memory.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `options`, one struct, or NULL.
/// - Result: LEAFLESS_OK once the file is on the disk.
/// - Errors: LEAFLESS_E_ARGUMENT if the format or the unit is none, if the format is LEAFLESS_MESH_FORMAT_ANY
///   and the path has none of the extensions, for an STL of coordinates beyond the range of float, or for an
///   OBJ without vertices; LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY. The old file is then as it
///   was; only if the very last step fails, synchronising the directory, the new one is in place.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_save(
    mesh: *const leafless_mesh,
    path: *const c_char,
    path_length: usize,
    options: *const leafless_mesh_write_options,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let path = Path::new(self::path(path, path_length)?);
        let (format, options) = self::options(options)?;
        let extension = || path.extension().and_then(|extension| extension.to_str());
        let format = format.or_else(|| extension().and_then(MeshFormat::from_extension));
        let problem = "must be given for a path with none of the extensions .stl, .obj, .ply, .off and .3mf";
        let format = format.ok_or(Failure::Argument { name: "options.format", problem })?;
        let bytes = write_mesh(mesh, format, &options)?;
        Ok(replace(path, |file| Ok(file.write_all(&bytes)?))?)
    })
}

/// The bytes of a mesh's file, in memory: those that leafless_mesh_save writes. Asking for the length takes
/// as long as filling.
///
/// - Buffers: `options`, one struct, with a format; `bytes`, room for `capacity` bytes, or NULL to ask for
///   the length only; `length`, one number.
/// - Result: `*length`, the length of the file; the file in `bytes`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_ARGUMENT as leafless_mesh_save, and
///   if the format is LEAFLESS_MESH_FORMAT_ANY; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_to_bytes(
    mesh: *const leafless_mesh,
    options: *const leafless_mesh_write_options,
    bytes: *mut u8,
    capacity: u64,
    length: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let (format, options) = in_memory(options)?;
        let bytes = buffer(bytes, capacity, "bytes")?;
        let length = out(length, "length")?;
        let file = write_mesh(mesh, format, &options)?;
        bytes.fill(&file)?;
        length.write(file.len() as u64)
    })
}

/// The mesh that a reader gets back from the file that leafless_mesh_save writes. An STL has 32-bit coordinates:
/// vertices move, vertices that meet are one, and triangles of which two corners meet are dropped, so that the
/// surface may be pinched, flat or gone. leafless_mesh_describe of both meshes tells. All other formats keep
/// vertices and triangles as they are. O(n) time and memory.
///
/// - Buffers: `options`, one struct, with a format; `kept`, one pointer.
/// - Result: `*kept`.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_mesh_to_bytes; LEAFLESS_E_NO_MEMORY.
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
        let (format, options) = in_memory(options)?;
        let kept = out(kept, "kept")?;
        kept.write(give(match written_form(mesh, format, &options)?.mesh {
            Cow::Borrowed(mesh) => mesh.try_clone()?,
            Cow::Owned(mesh) => mesh,
        }))
    })
}
