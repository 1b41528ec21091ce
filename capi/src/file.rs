//! Files: description and verification; reading and writing of octrees.

use super::boundary::{buffer, filled, guard, out, output, shared};
use super::frame::leafless_frame;
use super::octree::{give, leafless_octree, leafless_proof, leafless_tag};
use super::source::leafless_access::*;
use super::source::{Source, leafless_sink, leafless_source, sink, source};
use super::status::leafless_status;
use super::tridexel::{axes, leafless_dexel_ends, leafless_dexel_normals};
use core::ffi::c_char;
use leafless::Error;
use leafless::error::FormatError;
use leafless::file::{self, DexelProbe, Probe, Section, dexels};
use leafless::memory;

/// Major version of the file format that this library writes, and the only one that it reads.
pub const LEAFLESS_FORMAT_MAJOR: u32 = 0;
/// Minor version of the file format that this library writes; it also reads newer minor versions.
pub const LEAFLESS_FORMAT_MINOR: u32 = 4;
const _: () = {
    assert!(LEAFLESS_FORMAT_MAJOR == file::MAJOR as u32);
    assert!(LEAFLESS_FORMAT_MINOR == file::MINOR as u32);
};

/// Facts about a tri-dexel model from the header and the section table of its file.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_file_tridexel_info {
    /// The axes that rays run along, a sum of leafless_axes; 0 if the file holds an octree.
    pub directions: u32,
    /// The storage format of the ends of intervals.
    pub ends: leafless_dexel_ends,
    /// The storage format of unit normals.
    pub normals: leafless_dexel_normals,
    /// 1 if the surfaces of the ends are stored, else 0.
    pub has_surfaces: u32,
    /// 1 if the materials of intervals are stored, else 0.
    pub has_materials: u32,
    /// Reserved; 0.
    pub reserved: u32,
    /// Rays in the window along each axis, including empty rays.
    pub rays: [u64; 3],
    /// Intervals along each axis.
    pub intervals: [u64; 3],
}

/// Facts from the header and the section table of a file.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_file_info {
    /// sizeof(leafless_file_info).
    pub struct_size: u32,
    /// Major version of the format.
    pub major: u32,
    /// Minor version of the format.
    pub minor: u32,
    /// The frame of the octree or the tri-dexel model.
    pub frame: leafless_frame,
    /// Array elements without bricks; 0 for a tri-dexel model.
    pub elements: u64,
    /// Array elements of the deepest level; 0 for a tri-dexel model.
    pub bricks: u64,
    /// Length of the file in bytes.
    pub file_length: u64,
    /// Number of sections of the file.
    pub sections: u64,
    /// The proofs that the cells give; none for a tri-dexel model.
    pub proof: leafless_proof,
    /// The tag of the whole universe; BRANCH if it is split; EMPTY for a tri-dexel model.
    pub root: leafless_tag,
    /// The tag of the space outside the universe; never BRANCH; EMPTY for a tri-dexel model.
    pub exterior: leafless_tag,
    /// Whether no cell is undecided.
    pub is_binary: bool,
    /// Facts about a tri-dexel model; all zeros for an octree.
    pub tridexel: leafless_file_tridexel_info,
}

output!(leafless_file_info);

impl From<Option<&DexelProbe>> for leafless_file_tridexel_info {
    fn from(probe: Option<&DexelProbe>) -> leafless_file_tridexel_info {
        let format = probe.map(|probe| probe.format).unwrap_or_default();
        leafless_file_tridexel_info {
            directions: probe.map_or(0, |probe| axes(probe.directions)),
            ends: format.ends.into(),
            normals: format.normals.into(),
            has_surfaces: format.surfaces.into(),
            has_materials: format.materials.into(),
            reserved: 0,
            rays: probe.map_or([0; 3], |probe| probe.rays),
            intervals: probe.map_or([0; 3], |probe| probe.intervals),
        }
    }
}

/// A section of a file.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_file_section {
    /// Number of its kind.
    pub kind: u32,
    /// The object that the section belongs to: 0 is the solid.
    pub owner: u32,
    /// Whether a reader must know the kind to read the file.
    pub is_required: bool,
    /// Name of its kind, NUL-terminated; empty if this library does not know it.
    pub name: [c_char; 24],
    /// Its offset in the file, in bytes.
    pub offset: u64,
    /// Its length in bytes.
    pub length: u64,
    /// Its length in elements.
    pub count: u64,
}

impl From<&Probe> for leafless_file_info {
    fn from(probe: &Probe) -> leafless_file_info {
        leafless_file_info {
            struct_size: size_of::<leafless_file_info>() as u32,
            major: probe.version.0.into(),
            minor: probe.version.1.into(),
            frame: (&probe.frame).into(),
            elements: probe.elements,
            bricks: probe.bricks,
            file_length: probe.file_len,
            sections: probe.sections.len() as u64,
            proof: probe.proof.into(),
            root: probe.root.into(),
            exterior: probe.exterior.into(),
            is_binary: probe.binary,
            tridexel: probe.dexels.as_ref().into(),
        }
    }
}

impl From<&Section> for leafless_file_section {
    fn from(section: &Section) -> leafless_file_section {
        let mut name = [0; 24];
        // The last character stays NUL.
        for (to, from) in name[..23].iter_mut().zip(section.name.unwrap_or_default().bytes()) {
            *to = from as c_char;
        }
        leafless_file_section {
            kind: section.kind,
            owner: section.owner,
            is_required: section.required,
            name,
            offset: section.offset,
            length: section.length,
            count: section.count,
        }
    }
}

/// Describes a file from its header and section table. The rest of the file is not checked. A source of bytes
/// may hold only the first bytes of a file: 128, plus 40 for each section. 488 bytes suffice for an octree
/// without channels that this library wrote, 808 for a tri-dexel model, 163 968 for any file.
///
/// - Buffers: `source`, one struct (`access` is ignored); `probe`, one struct; `sections`, room for
///   `capacity` structs, or NULL if they are not wanted.
/// - Result: `*probe`; as many sections as `sections` of `*probe`.
/// - Errors: LEAFLESS_E_FORMAT, also if bytes end before the section table does; LEAFLESS_E_VERSION;
///   LEAFLESS_E_IO; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any file, any bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_file_describe(
    source: *const leafless_source,
    probe: *mut leafless_file_info,
    sections: *mut leafless_file_section,
    capacity: u64,
) -> leafless_status {
    guard(|| unsafe {
        let (source, _) = self::source(source)?;
        let probe = filled(probe, "probe")?;
        let sections = buffer(sections, capacity, "sections")?;
        let found = match source {
            Source::Path(path) => file::probe(path)?,
            Source::Bytes(bytes) => file::probe_bytes(bytes)?,
        };
        sections.check(found.sections.len())?;
        let list = memory::collected(found.sections.iter().map(leafless_file_section::from))?;
        sections.fill(&list)?;
        probe.write((&found).into())
    })
}

/// Checks all of a file, mapped into memory.
///
/// # Safety
/// As [`file::map`].
unsafe fn verify_mapped(path: &str) -> Result<(), Error> {
    // SAFETY: the caller's promise.
    match unsafe { file::map_verified(path) } {
        Err(error) if matches!(error.cause(), Error::Format(FormatError::OtherModel { .. })) => {
            // SAFETY: the caller's promise.
            unsafe { dexels::map_verified(path) }.map(drop)
        }
        done => done.map(drop),
    }
}

/// Verifies a whole file of an octree or a tri-dexel model against all rules of the format: O(n). With
/// LEAFLESS_ACCESS_COPY a file is read into memory, else it is mapped. Bytes are checked in place.
///
/// - Buffers: `source`, one struct; bytes on an address that is a multiple of 8.
/// - Result: LEAFLESS_OK if the file is valid.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT if the bytes are
///   misaligned, or if the file to map is not a regular file; LEAFLESS_E_IO; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: as described in leafless_source.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_file_verify(source: *const leafless_source) -> leafless_status {
    guard(|| unsafe {
        let checked = match self::source(source)? {
            (Source::Bytes(bytes), _) => file::verify(bytes),
            (Source::Path(path), LEAFLESS_ACCESS_COPY) => file::verify_path(path),
            (Source::Path(path), _) => verify_mapped(path),
        };
        Ok(checked?)
    })
}

/// Reads an octree, with its metadata and channels.
///
/// - Buffers: `source`, one struct; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED, with LEAFLESS_ACCESS_MAP only if the
///   level table contradicts the header; LEAFLESS_E_ARGUMENT if the file holds a tri-dexel model, if the file
///   to map is not a regular file, or if bytes to view are misaligned; LEAFLESS_E_IO; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: leafless_source describes how long a file or bytes must stay unchanged. Release `*octree`
///   with leafless_octree_free.
/// - Untrusted input: as described in leafless_source.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_read(
    source: *const leafless_source,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let source = self::source(source)?;
        let octree = out(octree, "octree")?;
        // The host promises that data used in place stays unchanged.
        let found = match source {
            (Source::Path(path), LEAFLESS_ACCESS_COPY) => file::open(path)?,
            (Source::Path(path), LEAFLESS_ACCESS_MAP) => file::map(path)?,
            (Source::Path(path), LEAFLESS_ACCESS_MAP_VERIFIED) => file::map_verified(path)?,
            (Source::Bytes(bytes), LEAFLESS_ACCESS_COPY) => file::from_bytes(bytes)?,
            (Source::Bytes(bytes), LEAFLESS_ACCESS_MAP) => file::from_static(bytes)?,
            (Source::Bytes(bytes), LEAFLESS_ACCESS_MAP_VERIFIED) => {
                let found = file::from_static(bytes)?;
                file::verify(bytes)?;
                found
            }
        };
        octree.write(give(found))
    })
}

/// Writes an octree's file. Equal octrees with equal metadata and channels give equal bytes. The whole file
/// is in memory only if the sink is a buffer.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_DAMAGED if the octree was mapped unverified and is damaged; LEAFLESS_E_IO;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_write(
    octree: *const leafless_octree,
    sink: *const leafless_sink,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let sink = self::sink(sink)?;
        sink.put(|path| file::save(octree, path), |to| file::write_to(octree, to), || file::to_bytes(octree))
    })
}
