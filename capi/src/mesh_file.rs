//! Reading of mesh files.

use super::boundary::{Failure, Sized32, filled, guard, handle, out, output, shared, sized};
use super::mesh::leafless_mesh;
use super::number::{Number, enumeration};
use super::source::{Source, copy, leafless_source};
use super::status::leafless_status;
use core::ffi::c_char;
use core::fmt::Write;
use leafless::Error;
use leafless::exchange::{LengthUnit, MeshFile, MeshFormat, MeshOptions, open_mesh, read_mesh};
use leafless::memory;
use leafless_mesh_format::*;
use leafless_unit::*;
use std::sync::Arc;

/// The formats of mesh files that can be read and written.
#[derive(Clone, Copy, PartialEq)]
#[repr(u32)]
pub enum leafless_mesh_format {
    /// To be detected: when reading, from the file's content and, if that is ambiguous, its name; when
    /// writing, from its name.
    LEAFLESS_MESH_FORMAT_ANY = 0,
    /// STL, binary or ASCII; which of the two is always detected.
    LEAFLESS_MESH_FORMAT_STL = 1,
    /// Wavefront OBJ.
    LEAFLESS_MESH_FORMAT_OBJ = 2,
    /// Stanford PLY, binary or ASCII.
    LEAFLESS_MESH_FORMAT_PLY = 3,
    /// Geomview OFF.
    LEAFLESS_MESH_FORMAT_OFF = 4,
    /// 3MF, the 3D Manufacturing Format. Its surfaces follow LEAFLESS_FILL_POSITIVE.
    LEAFLESS_MESH_FORMAT_3MF = 5,
}

enumeration! {
    leafless_mesh_format => Option<MeshFormat> {
        LEAFLESS_MESH_FORMAT_ANY => None,
        LEAFLESS_MESH_FORMAT_STL => Some(MeshFormat::Stl),
        LEAFLESS_MESH_FORMAT_OBJ => Some(MeshFormat::Obj),
        LEAFLESS_MESH_FORMAT_PLY => Some(MeshFormat::Ply),
        LEAFLESS_MESH_FORMAT_OFF => Some(MeshFormat::Off),
        LEAFLESS_MESH_FORMAT_3MF => Some(MeshFormat::ThreeMf),
    }
}

/// Units of length. Coordinates have no unit: the host decides the meaning of an unknown unit.
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

enumeration! {
    leafless_unit => Option<LengthUnit> {
        LEAFLESS_UNIT_UNKNOWN => None,
        LEAFLESS_UNIT_MICROMETRE => Some(LengthUnit::Micrometre),
        LEAFLESS_UNIT_MILLIMETRE => Some(LengthUnit::Millimetre),
        LEAFLESS_UNIT_CENTIMETRE => Some(LengthUnit::Centimetre),
        LEAFLESS_UNIT_METRE => Some(LengthUnit::Metre),
        LEAFLESS_UNIT_INCH => Some(LengthUnit::Inch),
        LEAFLESS_UNIT_FOOT => Some(LengthUnit::Foot),
    }
}

pub(super) fn unit_of(unit: Option<LengthUnit>) -> leafless_unit {
    match unit {
        None => LEAFLESS_UNIT_UNKNOWN,
        Some(LengthUnit::Micrometre) => LEAFLESS_UNIT_MICROMETRE,
        Some(LengthUnit::Millimetre) => LEAFLESS_UNIT_MILLIMETRE,
        Some(LengthUnit::Centimetre) => LEAFLESS_UNIT_CENTIMETRE,
        Some(LengthUnit::Metre) => LEAFLESS_UNIT_METRE,
        Some(LengthUnit::Inch) => LEAFLESS_UNIT_INCH,
        Some(LengthUnit::Foot) => LEAFLESS_UNIT_FOOT,
    }
}

/// Options of reading a mesh file. NULL means the defaults. Zero is the default of every field but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_options {
    /// sizeof(leafless_mesh_options).
    pub struct_size: u32,
    /// The file's format.
    pub format: Number<leafless_mesh_format>,
    /// The unit of the numbers in the file. LEAFLESS_UNIT_UNKNOWN means the unit that the file states (only
    /// 3MF files do); any other value overrides it.
    pub unit: Number<leafless_unit>,
    /// The unit of the resulting mesh. LEAFLESS_UNIT_UNKNOWN means the unit of the file.
    pub target: Number<leafless_unit>,
    /// Additional factor for all coordinates: 2^-256 to 2^256, or 0, which means 1.
    pub scale: f64,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_mesh_options {}

/// Facts that a mesh file states besides the mesh.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_mesh_file_info {
    /// sizeof(leafless_mesh_file_info).
    pub struct_size: u32,
    /// The file's format.
    pub format: leafless_mesh_format,
    /// The unit of the mesh after conversion and before scaling, if it is known.
    pub unit: leafless_unit,
    /// Number of instances of objects that are not meant to be solid, such as supports in a 3MF. The mesh
    /// does not contain them.
    pub skipped: u64,
    /// Largest distance between the true boundary and the mesh according to the file, converted and scaled; 0
    /// if the file does not state it. The library does not rely on it; to rely on it, state it with
    /// leafless_mesh_with_deviation.
    pub deviation_model: f64,
}

output!(leafless_mesh_file_info);

/// # Safety
/// `options` is NULL or points to valid options.
unsafe fn options(options: *const leafless_mesh_options) -> Result<MeshOptions, Failure> {
    // SAFETY: the caller's promise.
    let given = unsafe { sized(options, "options")? };
    Ok(MeshOptions {
        format: given.format.known("options.format")?,
        unit: given.unit.known("options.unit")?,
        target: given.target.known("options.target")?,
        scale: if given.scale == 0.0 { 1.0 } else { given.scale },
    })
}

impl From<&MeshFile> for leafless_mesh_file_info {
    fn from(file: &MeshFile) -> leafless_mesh_file_info {
        leafless_mesh_file_info {
            struct_size: size_of::<leafless_mesh_file_info>() as u32,
            format: match file.format {
                MeshFormat::Stl => LEAFLESS_MESH_FORMAT_STL,
                MeshFormat::Obj => LEAFLESS_MESH_FORMAT_OBJ,
                MeshFormat::Ply => LEAFLESS_MESH_FORMAT_PLY,
                MeshFormat::Off => LEAFLESS_MESH_FORMAT_OFF,
                MeshFormat::ThreeMf => LEAFLESS_MESH_FORMAT_3MF,
                _ => LEAFLESS_MESH_FORMAT_ANY,
            },
            unit: unit_of(file.unit),
            skipped: file.skipped,
            deviation_model: file.deviation.unwrap_or(0.0),
        }
    }
}

/// Returns the mesh of a file, with the warnings as texts.
fn give(file: MeshFile) -> Result<*mut leafless_mesh, Failure> {
    let mut warnings = memory::with_capacity(file.warnings.len())?;
    for warning in &file.warnings {
        let mut text = String::new();
        text.try_reserve(256).map_err(Error::from)?;
        // Writing to a string cannot fail.
        let _ = write!(text, "{warning}");
        warnings.push(text);
    }
    Ok(handle(leafless_mesh { mesh: Arc::new(file.mesh), warnings }))
}

/// Reads a mesh file. Everything in it becomes one mesh, welded as by leafless_mesh_new; polygons become
/// triangles. Hair cracks, which come from rounded numbers in files, are closed as by leafless_mesh_sewn;
/// leafless_mesh_inspect reports how many vertices moved and how far. Bytes in memory have no name, so their
/// format is detected from the content only.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY; `options`, one struct, or NULL; `found`, one
///   struct, or NULL if it is not wanted; `mesh`, one pointer.
/// - Result: `*mesh`, not checked to be closed; `*found`. leafless_mesh_peek_warning_at returns the
///   violations of the format that did not prevent reading.
/// - Errors: LEAFLESS_E_MESH_FILE, with the part, line, facet or byte in the message, if the file cannot be
///   read, if its format is not known, or if `target` is given and neither `unit` nor the file states a unit;
///   LEAFLESS_E_MESH, with the vertex, if a coordinate is beyond ±2^256 once it is scaled;
///   LEAFLESS_E_ARGUMENT if the format or a unit is invalid, or the scale is out of range; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*mesh` with leafless_mesh_free.
/// - Untrusted input: any file. Memory is at most a small multiple of its length. For a 3MF, which is
///   compressed, it is at most a small multiple of 64 times its length plus 16 MiB, and its instances may
///   have up to 2^25 vertices and 2^25 triangles, or as many as the file has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_mesh_read(
    source: *const leafless_source,
    options: *const leafless_mesh_options,
    found: *mut leafless_mesh_file_info,
    mesh: *mut *mut leafless_mesh,
) -> leafless_status {
    guard(|| unsafe {
        let source = copy(source)?;
        let options = self::options(options)?;
        let found = if found.is_null() { None } else { Some(filled(found, "found")?) };
        let mesh = out(mesh, "mesh")?;
        let mut file = match source {
            Source::Path(path) => open_mesh(path, &options)?,
            Source::Bytes(bytes) => read_mesh(bytes, &options)?,
        };
        file.mesh = file.mesh.sewn()?;
        let said = leafless_mesh_file_info::from(&file);
        mesh.write(give(file)?)?;
        found.map_or(Ok(()), |found| found.write(said))
    })
}

/// Returns one of the warnings from reading a mesh file, by its index: a sentence in UTF-8 for each kind of
/// violation of the format that did not prevent reading. A mesh that was not read from a file, or was made
/// from another mesh, has none.
///
/// - Buffers: `count`, one number; `warning`, `warning_length`, one each, both NULL to get only the count.
/// - Result: `*count`, the number of all warnings; the text, not NUL-terminated, with its length in bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no warning `index`, unless only the count is requested.
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
