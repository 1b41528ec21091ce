//! Mesh files.

use super::boundary::{Failure, Out, Sized32, buffer, guard, handle, out, path, shared, sized, slice};
use super::mesh::leafless_mesh;
use super::status::leafless_status;
use core::ffi::c_char;
use core::fmt::Write;
use leafless::Error;
use leafless::exchange::{LengthUnit, MeshFile, MeshFormat, MeshOptions, open_mesh, read_mesh, write_stl};
use leafless::memory;
use leafless_mesh_format::*;
use leafless_unit::*;
use std::sync::Arc;

/// The formats of mesh files, which can be read and written.
#[derive(Clone, Copy, PartialEq)]
#[repr(u32)]
pub enum leafless_mesh_format {
    /// To be found out: when reading from the file's content and, where that is not clear, its name; when writing
    /// from its name.
    LEAFLESS_MESH_FORMAT_ANY = 0,
    /// STL, binary or ASCII; which of the two is always found out.
    LEAFLESS_MESH_FORMAT_STL = 1,
    /// Wavefront OBJ.
    LEAFLESS_MESH_FORMAT_OBJ = 2,
    /// Stanford PLY, binary or ASCII.
    LEAFLESS_MESH_FORMAT_PLY = 3,
    /// Geomview OFF.
    LEAFLESS_MESH_FORMAT_OFF = 4,
    /// 3MF, the 3D Manufacturing Format. What it means by its surfaces is LEAFLESS_FILL_POSITIVE.
    LEAFLESS_MESH_FORMAT_3MF = 5,
}

/// Units of length. Coordinates have none: what an unknown unit means is up to the host.
#[derive(Clone, Copy, PartialEq)]
#[repr(u32)]
pub enum leafless_unit {
    /// Not known.
    LEAFLESS_UNIT_UNKNOWN = 0,
    /// 1/1000 of a millimetre.
    LEAFLESS_UNIT_MICROMETRE = 1,
    /// The millimetre.
    LEAFLESS_UNIT_MILLIMETRE = 2,
    /// 10 millimetres.
    LEAFLESS_UNIT_CENTIMETRE = 3,
    /// 1000 millimetres.
    LEAFLESS_UNIT_METRE = 4,
    /// 25.4 millimetres.
    LEAFLESS_UNIT_INCH = 5,
    /// 12 inches.
    LEAFLESS_UNIT_FOOT = 6,
}

/// How a mesh file is to be taken. NULL means the defaults. All fields but the first may be zero, which is
/// their default.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_options {
    /// sizeof(leafless_mesh_options).
    pub struct_size: u32,
    /// The file's format, a leafless_mesh_format.
    pub format: u32,
    /// The unit of the numbers in the file, a leafless_unit. LEAFLESS_UNIT_UNKNOWN means what the file says,
    /// which only a 3MF does; anything else overrides that.
    pub unit: u32,
    /// The unit that the mesh shall have, a leafless_unit. LEAFLESS_UNIT_UNKNOWN means that of the file.
    pub target: u32,
    /// What all coordinates are multiplied by besides: 2^-256 to 2^256, or 0, which means 1.
    pub scale: f64,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_mesh_options {}

/// What a mesh file says besides the mesh.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_source {
    /// The file's format.
    pub format: leafless_mesh_format,
    /// The unit of the mesh, converted but not scaled, if it is known.
    pub unit: leafless_unit,
    /// Instances of objects that are not meant to be solid, such as supports in a 3MF, and that the mesh does
    /// not contain.
    pub skipped: u64,
}

const FORMATS: [(leafless_mesh_format, MeshFormat); 5] = [
    (LEAFLESS_MESH_FORMAT_STL, MeshFormat::Stl),
    (LEAFLESS_MESH_FORMAT_OBJ, MeshFormat::Obj),
    (LEAFLESS_MESH_FORMAT_PLY, MeshFormat::Ply),
    (LEAFLESS_MESH_FORMAT_OFF, MeshFormat::Off),
    (LEAFLESS_MESH_FORMAT_3MF, MeshFormat::ThreeMf),
];

const UNITS: [(leafless_unit, LengthUnit); 6] = [
    (LEAFLESS_UNIT_MICROMETRE, LengthUnit::Micrometre),
    (LEAFLESS_UNIT_MILLIMETRE, LengthUnit::Millimetre),
    (LEAFLESS_UNIT_CENTIMETRE, LengthUnit::Centimetre),
    (LEAFLESS_UNIT_METRE, LengthUnit::Metre),
    (LEAFLESS_UNIT_INCH, LengthUnit::Inch),
    (LEAFLESS_UNIT_FOOT, LengthUnit::Foot),
];

pub(super) fn unit(unit: u32, name: &'static str) -> Result<Option<LengthUnit>, Failure> {
    if unit == LEAFLESS_UNIT_UNKNOWN as u32 {
        return Ok(None);
    }
    let known = UNITS.iter().find(|(known, _)| *known as u32 == unit);
    known.map(|&(_, unit)| Some(unit)).ok_or(Failure::Argument { name, problem: "is no leafless_unit" })
}

pub(super) fn unit_of(unit: Option<LengthUnit>) -> leafless_unit {
    let known = UNITS.iter().find(|(_, known)| Some(*known) == unit);
    known.map_or(LEAFLESS_UNIT_UNKNOWN, |(unit, _)| *unit)
}

/// The format with this number; `None` for LEAFLESS_MESH_FORMAT_ANY.
pub(super) fn format(format: u32) -> Result<Option<MeshFormat>, Failure> {
    if format == LEAFLESS_MESH_FORMAT_ANY as u32 {
        return Ok(None);
    }
    let known = FORMATS.iter().find(|(known, _)| *known as u32 == format);
    let problem = "is no leafless_mesh_format";
    known.map(|&(_, format)| Some(format)).ok_or(Failure::Argument { name: "options.format", problem })
}

/// # Safety
/// `options` is NULL or points to valid options.
unsafe fn options(options: *const leafless_mesh_options) -> Result<MeshOptions, Failure> {
    // SAFETY: the caller's promise.
    let given = unsafe { sized(options, "options")? };
    Ok(MeshOptions {
        format: format(given.format)?,
        unit: unit(given.unit, "options.unit")?,
        target: unit(given.target, "options.target")?,
        scale: if given.scale == 0.0 { 1.0 } else { given.scale },
    })
}

impl From<&MeshFile> for leafless_mesh_source {
    fn from(file: &MeshFile) -> leafless_mesh_source {
        let format = FORMATS.iter().find(|(_, format)| *format == file.format);
        leafless_mesh_source {
            format: format.map_or(LEAFLESS_MESH_FORMAT_ANY, |(format, _)| *format),
            unit: unit_of(file.unit),
            skipped: file.skipped,
        }
    }
}

/// Where a mesh and what is said of it go.
struct Results {
    source: Option<Out<leafless_mesh_source>>,
    mesh: Out<*mut leafless_mesh>,
}

impl Results {
    /// # Safety
    /// As [`out`]; `source` may be NULL.
    unsafe fn new(
        source: *mut leafless_mesh_source,
        mesh: *mut *mut leafless_mesh,
    ) -> Result<Results, Failure> {
        // SAFETY: the caller's promise.
        unsafe {
            let source = if source.is_null() { None } else { Some(out(source, "source")?) };
            Ok(Results { source, mesh: out(mesh, "mesh")? })
        }
    }

    fn write(self, file: MeshFile) -> Result<(), Failure> {
        if let Some(source) = self.source {
            source.write((&file).into())?;
        }
        let mut warnings = memory::with_capacity(file.warnings.len())?;
        for warning in &file.warnings {
            let mut text = String::new();
            text.try_reserve(256).map_err(Error::from)?;
            // Writing to a string does not fail.
            let _ = write!(text, "{warning}");
            warnings.push(text);
        }
        self.mesh.write(handle(leafless_mesh { mesh: Arc::new(file.mesh), warnings }))
    }
}

/// Reads a mesh file. Everything in it becomes one mesh, welded as by leafless_mesh_new; polygons become
/// triangles.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `options`, one struct, or NULL; `source`, one struct, or
///   NULL if it is not wanted; `mesh`, one pointer.
/// - Result: `*mesh`, not checked to be closed; `*source`. leafless_mesh_peek_warning_at tells where the file
///   departs from its format, though it could be read.
/// - Errors: LEAFLESS_E_MESH_FILE, with the part, line, facet or byte in the message, if the file cannot be
///   read, if its format is not known, or if `target` is given and nobody says from which unit;
///   LEAFLESS_E_MESH, with the vertex, if a coordinate is beyond ±2^256 once it is scaled;
///   LEAFLESS_E_ARGUMENT if the format or a unit is none, or the scale out of range; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*mesh` back with leafless_mesh_free.
/// - Untrusted input: any file. Memory is at most a small multiple of its length; of a 3MF, which is
///   compressed, of 64 times its length and 16 MiB, and its instances may come to 2^25 vertices and 2^25
///   triangles, or to as many as the file has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_open(
    path: *const c_char,
    path_length: usize,
    options: *const leafless_mesh_options,
    source: *mut leafless_mesh_source,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let path = self::path(path, path_length)?;
        let options = self::options(options)?;
        let results = Results::new(source, mesh)?;
        results.write(open_mesh(path, &options)?)
    })
}

/// As leafless_mesh_open for a file in memory, of whose name nothing is known.
///
/// - Buffers: `bytes`, `length` bytes; may be NULL if there are none. `options`, one struct, or NULL;
///   `source`, one struct, or NULL if it is not wanted; `mesh`, one pointer.
/// - Result: `*mesh`, not checked to be closed; `*source`.
/// - Errors: as leafless_mesh_open, but those of paths.
/// - Ownership: the bytes are not kept; give `*mesh` back with leafless_mesh_free.
/// - Untrusted input: any bytes; memory as for leafless_mesh_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_from_bytes(
    bytes: *const u8,
    length: u64,
    options: *const leafless_mesh_options,
    source: *mut leafless_mesh_source,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let bytes = slice(bytes, length, "bytes")?;
        let options = self::options(options)?;
        let results = Results::new(source, mesh)?;
        results.write(read_mesh(bytes, &options)?)
    })
}

/// What a mesh file departs from its format in, though it could be read: a sentence in UTF-8 for each kind of
/// departure, by its place among all. A mesh that was not read from a file, or was made from another mesh, has
/// none.
///
/// - Buffers: `count`, one number; `warning`, `warning_length`, one each, both NULL to ask for the count only.
/// - Result: `*count`, the number of all warnings; the text, not NUL-terminated, with its length in bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no warning `index`, unless only the count is asked for.
/// - Ownership: the text belongs to the mesh and lives as long as the reference `mesh`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_peek_warning_at(
    mesh: *const leafless_mesh,
    index: u64,
    count: *mut u64,
    warning: *mut *const c_char,
    warning_length: *mut usize,
) -> leafless_status {
    guard(|| unsafe {
        let warnings = &shared(mesh, "mesh")?.warnings;
        let count = out(count, "count")?;
        if warning.is_null() && warning_length.is_null() {
            return count.write(warnings.len() as u64);
        }
        let (warning, warning_length) = (out(warning, "warning")?, out(warning_length, "warning_length")?);
        let missing = Failure::Argument { name: "index", problem: "is not below the number of warnings" };
        let found = usize::try_from(index).ok().and_then(|index| warnings.get(index)).ok_or(missing)?;
        warning.write(found.as_ptr().cast())?;
        warning_length.write(found.len())?;
        count.write(warnings.len() as u64)
    })
}

/// Writes a binary STL file into memory: 84 + 50 t bytes. Coordinates are rounded to 32 bits;
/// leafless_mesh_written_form tells what that costs.
///
/// - Buffers: `bytes`, room for `capacity` bytes, or NULL to ask for the length only.
/// - Result: `*length`, the length of the file; the file in `bytes`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_ARGUMENT if a coordinate is beyond
///   the range of 32-bit floating point numbers; LEAFLESS_E_NO_MEMORY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_to_stl(
    mesh: *const leafless_mesh,
    bytes: *mut u8,
    capacity: u64,
    length: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let mesh = &shared(mesh, "mesh")?.mesh;
        let bytes = buffer(bytes, capacity, "bytes")?;
        let length = out(length, "length")?;
        let file = write_stl(mesh)?;
        bytes.fill(&file)?;
        length.write(file.len() as u64)
    })
}
