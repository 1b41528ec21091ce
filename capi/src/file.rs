//! Files, and octrees in the bytes of a file.

use super::boundary::{Failure, buffer, guard, out, path, shared, slice};
use super::frame::leafless_frame;
use super::octree::{give, leafless_octree, leafless_proof, leafless_tag};
use super::status::leafless_status;
use super::tridexel::{axes, leafless_dexel_ends, leafless_dexel_normals};
use core::ffi::{c_char, c_void};
use leafless::Error;
use leafless::Octree;
use leafless::file::{self, DexelProbe, Probe, Section};
use leafless::memory;
use std::io;

/// Major version of the file format that this library writes, and the only one that it reads.
pub const LEAFLESS_FORMAT_MAJOR: u32 = 0;
/// Minor version of the file format that this library writes; it reads newer ones, too.
pub const LEAFLESS_FORMAT_MINOR: u32 = 3;
const _: () = {
    assert!(LEAFLESS_FORMAT_MAJOR == file::MAJOR as u32);
    assert!(LEAFLESS_FORMAT_MINOR == file::MINOR as u32);
};

/// What header and section table of a tri-dexel model's file say of it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_tridexel_probe {
    /// The axes that rays run along, a sum of leafless_axes; 0 if the file holds an octree.
    pub directions: u32,
    /// How the ends of intervals are stored.
    pub ends: leafless_dexel_ends,
    /// How unit normals are stored.
    pub normals: leafless_dexel_normals,
    /// 1 if it is stored on which surfaces the ends lie, else 0.
    pub has_surfaces: u32,
    /// 1 if it is stored what intervals are made of, else 0.
    pub has_materials: u32,
    /// Zero.
    pub reserved: u32,
    /// Rays in the window along each axis, empty ones among them.
    pub rays: [u64; 3],
    /// Intervals along each axis.
    pub intervals: [u64; 3],
}

/// What header and section table of a file say.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_probe {
    /// Major version of the format.
    pub major: u32,
    /// Minor version of the format.
    pub minor: u32,
    /// Where the octree or the tri-dexel model lies, and its depth.
    pub frame: leafless_frame,
    /// Array elements without bricks; 0 for a tri-dexel model.
    pub elements: u64,
    /// Array elements of the deepest level; 0 for a tri-dexel model.
    pub bricks: u64,
    /// Length of the file in bytes.
    pub file_length: u64,
    /// Sections of the file.
    pub sections: u64,
    /// What the cells prove; nothing for a tri-dexel model.
    pub proof: leafless_proof,
    /// The tag of the whole universe; BRANCH if it is cut; EMPTY for a tri-dexel model.
    pub root: leafless_tag,
    /// What is known of the space outside of the universe; never BRANCH; EMPTY for a tri-dexel model.
    pub exterior: leafless_tag,
    /// Whether nothing is undecided.
    pub is_binary: bool,
    /// What is stored of a tri-dexel model; all zeros for an octree.
    pub tridexel: leafless_tridexel_probe,
}

impl From<Option<&DexelProbe>> for leafless_tridexel_probe {
    fn from(probe: Option<&DexelProbe>) -> leafless_tridexel_probe {
        let format = probe.map(|probe| probe.format).unwrap_or_default();
        leafless_tridexel_probe {
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
pub struct leafless_section {
    /// Number of its kind.
    pub kind: u32,
    /// The object that it belongs to: 0 is the solid.
    pub owner: u32,
    /// Whether a reader must know the kind to read the file.
    pub is_required: bool,
    /// Name of its kind, NUL-terminated; empty if this library does not know it.
    pub name: [c_char; 24],
    /// Where it begins in the file, in bytes.
    pub offset: u64,
    /// Its length in bytes.
    pub length: u64,
    /// Its length in elements.
    pub count: u64,
}

impl From<&Probe> for leafless_probe {
    fn from(probe: &Probe) -> leafless_probe {
        leafless_probe {
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

impl From<&Section> for leafless_section {
    fn from(section: &Section) -> leafless_section {
        let mut name = [0; 24];
        // The last character stays NUL.
        for (to, from) in name[..23].iter_mut().zip(section.name.unwrap_or_default().bytes()) {
            *to = from as c_char;
        }
        leafless_section {
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

/// Hands out what a probe found.
///
/// # Safety
/// As [`out`] and [`buffer`].
unsafe fn hand_out(
    found: impl FnOnce() -> Result<Probe, Failure>,
    probe: *mut leafless_probe,
    sections: *mut leafless_section,
    capacity: u64,
) -> Result<(), Failure> {
    // SAFETY: the caller's promises.
    let (probe, sections) = unsafe { (out(probe, "probe")?, buffer(sections, capacity, "sections")?) };
    let found = found()?;
    sections.check(found.sections.len())?;
    let list = memory::collected(found.sections.iter().map(leafless_section::from))?;
    sections.fill(&list)?;
    probe.write((&found).into())
}

/// What a file says of itself, without looking at more than header and section table. Whether the rest is
/// good is not known then.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `probe`, one struct; `sections`, room for `capacity`
///   structs, or NULL if they are not wanted.
/// - Result: `*probe`; as many sections as it says.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_IO; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_file_probe(
    path: *const c_char,
    path_length: usize,
    probe: *mut leafless_probe,
    sections: *mut leafless_section,
    capacity: u64,
) -> leafless_status {
    guard(|| unsafe {
        let path = self::path(path, path_length)?;
        hand_out(|| Ok(file::probe(path)?), probe, sections, capacity)
    })
}

/// As leafless_file_probe for the first bytes of a file in memory, or all of them: 128 and 40 for each
/// section. 488 suffice for an octree without channels that this library wrote, 808 for a tri-dexel model, 163 968
/// for any file.
///
/// - Buffers: `bytes`, `length` bytes, may be NULL if there are none; `probe`, one struct; `sections`, room
///   for `capacity` structs, or NULL if they are not wanted.
/// - Result: `*probe`; as many sections as it says.
/// - Errors: LEAFLESS_E_FORMAT, also if the bytes end before the section table does; LEAFLESS_E_VERSION;
///   LEAFLESS_E_BUFFER; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_bytes_probe(
    bytes: *const u8,
    length: u64,
    probe: *mut leafless_probe,
    sections: *mut leafless_section,
    capacity: u64,
) -> leafless_status {
    guard(|| unsafe {
        let bytes = slice(bytes, length, "bytes")?;
        hand_out(|| Ok(file::probe_bytes(bytes)?), probe, sections, capacity)
    })
}

/// Checks everything that the format promises of a whole file in memory: O(n).
///
/// - Buffers: `bytes`, `length` bytes on an address that is a multiple of 8; may be NULL if there are none.
/// - Result: LEAFLESS_OK if the file is good.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT if the bytes are
///   misaligned; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_bytes_verify(bytes: *const u8, length: u64) -> leafless_status {
    guard(|| unsafe { Ok(file::verify(slice(bytes, length, "bytes")?)?) })
}

/// Gives the octree that `open` finds at a path.
///
/// # Safety
/// As [`path`] and [`out`].
unsafe fn opened(
    path: *const c_char,
    path_length: usize,
    octree: *mut *mut leafless_octree,
    open: impl FnOnce(&str) -> Result<Octree, Error>,
) -> leafless_status {
    guard(|| unsafe {
        let path = self::path(path, path_length)?;
        let octree = out(octree, "octree")?;
        octree.write(give(open(path)?))
    })
}

/// Gives the octree that `open` finds in bytes, which stay as long as it says.
///
/// # Safety
/// As [`slice`] and [`out`].
unsafe fn found_in<'a>(
    bytes: *const u8,
    length: u64,
    octree: *mut *mut leafless_octree,
    open: impl FnOnce(&'a [u8]) -> Result<Octree, Error>,
) -> leafless_status {
    guard(|| unsafe {
        let bytes = slice(bytes, length, "bytes")?;
        let octree = out(octree, "octree")?;
        octree.write(give(open(bytes)?))
    })
}

/// Reads a file into memory and verifies all of it: the plain way, and the one for files that may not be
/// trusted. Later changes of the file do not matter.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FORMAT, also if the file holds a tri-dexel model; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Untrusted input: any file; memory is at most a small multiple of its length.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_open(
    path: *const c_char,
    path_length: usize,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { opened(path, path_length, octree, |path| file::open(path)) }
}

/// Maps a file into memory and looks at its header, section table, bounds, level table and metadata only:
/// some microseconds for a file of any size. What queries touch is read when they do. Of a file that is
/// damaged elsewhere queries answer undecided or wrong, but stay in bounds and end.
///
/// While the octree lives, or a cursor, a solid or an octree with other metadata that shares it, nobody may
/// make the file shorter: reading beyond its new end raises SIGBUS, which by default ends the process. Nobody
/// may write to it either: answers may then be wrong, and nothing more is promised. Removing the file, or
/// replacing it by renaming another over it, as leafless_octree_save does, is harmless.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED if the level table contradicts the
///   header; LEAFLESS_E_ARGUMENT if there is no regular file; LEAFLESS_E_IO; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Untrusted input: any contents, but only where nobody else can change the file; else
///   leafless_octree_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_map(
    path: *const c_char,
    path_length: usize,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise, which includes that of the mapping.
    unsafe { opened(path, path_length, octree, |path| file::map(path)) }
}

/// As leafless_octree_map, but verifies all of the file first, in one scan. Who writes to the file afterwards
/// undoes that.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_open, and LEAFLESS_E_ARGUMENT if there is no regular file.
/// - Ownership: give `*octree` back with leafless_octree_free.
/// - Untrusted input: any contents, but only where nobody else can change the file; else
///   leafless_octree_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_map_verified(
    path: *const c_char,
    path_length: usize,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise, which includes that of the mapping.
    unsafe { opened(path, path_length, octree, |path| file::map_verified(path)) }
}

/// The octree in the bytes of a whole file, copied and verified as by leafless_octree_open.
///
/// - Buffers: `bytes`, `length` bytes, may be NULL if there are none; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bytes are not kept; give `*octree` back with leafless_octree_free.
/// - Untrusted input: any bytes; memory is at most a small multiple of their number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_from_bytes(
    bytes: *const u8,
    length: u64,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { found_in(bytes, length, octree, file::from_bytes) }
}

/// The octree in the bytes of a whole file, used where they lie, and checked as little as by
/// leafless_octree_map; call leafless_bytes_verify first where they may be damaged. For files that are part
/// of a program, or that the host maps itself.
///
/// - Buffers: `bytes`, `length` bytes on an address that is a multiple of 8; `octree`, one pointer.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED if the level table contradicts the
///   header; LEAFLESS_E_ARGUMENT if the bytes are misaligned; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bytes stay the host's. They must stay, unchanged, until the last reference is given back
///   to the octree, to every octree that leafless_octree_with_metadata or leafless_octree_without_metadata
///   made of it, and to every cursor and solid of these. Give `*octree` back with leafless_octree_free.
/// - Untrusted input: any bytes, as leafless_octree_map.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_view_bytes(
    bytes: *const u8,
    length: u64,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    // SAFETY: the caller's promise, by which the bytes outlive the octree and all that is made of it.
    unsafe { found_in::<'static>(bytes, length, octree, file::from_static) }
}

/// Saves an octree: at any moment, also after a crash or a power failure, there is the old file or the new
/// one, each complete. Equal octrees with equal metadata give equal bytes.
///
/// The bytes go to a temporary file in the same directory, which is synchronised with the disk and then
/// renamed over the old file. On Linux the temporary file has no name until it is complete, so that nothing is
/// left of it when the process is killed, where the file system has such files. Elsewhere a file
/// `.leafless-….tmp` may stay behind. A file that is replaced keeps its permissions, its other hard links keep
/// the old contents. A symbolic link is followed. What is no regular file, such as a pipe, is written to
/// directly; a pipe that nobody reads raises SIGPIPE, and a file beyond the process's limit SIGXFSZ, if the
/// host has not ignored them. A pipe that nobody has opened for reading is waited for, also if signal handlers
/// run meanwhile.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8.
/// - Result: LEAFLESS_OK once the file is on the disk.
/// - Errors: LEAFLESS_E_IO; LEAFLESS_E_DAMAGED if the octree was mapped unverified and is damaged;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY. The old file is then as it was; only if the very last step fails,
///   synchronising the directory, the new one is in place.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_save(
    octree: *const leafless_octree,
    path: *const c_char,
    path_length: usize,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        Ok(file::save(octree, self::path(path, path_length)?)?)
    })
}

/// The bytes of an octree's file, in memory. Asking for the length takes as long as filling.
///
/// - Buffers: `bytes`, room for `capacity` bytes, or NULL to ask for the length only; `length`, one number.
/// - Result: `*length`, the length of the file; the file in `bytes`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_DAMAGED if the octree was mapped
///   unverified and is damaged; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_to_bytes(
    octree: *const leafless_octree,
    bytes: *mut u8,
    capacity: u64,
    length: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let bytes = buffer(bytes, capacity, "bytes")?;
        let length = out(length, "length")?;
        let file = file::to_bytes(octree)?;
        bytes.fill(&file)?;
        length.write(file.len() as u64)
    })
}

/// Takes bytes of a file in order: all `count` of them, and returns 0; anything else ends the writing with
/// LEAFLESS_E_CALLBACK. It is called in the calling thread. It must return: no exception, no longjmp. It may
/// call this library.
pub type leafless_write_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, bytes: *const u8, count: u64) -> i32>;

/// Hands bytes to the host.
pub(super) struct Sink {
    write: unsafe extern "C" fn(*mut c_void, *const u8, u64) -> i32,
    ctx: *mut c_void,
    code: i32,
}

impl io::Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // SAFETY: as the host gave it, with its own context.
        self.code = unsafe { (self.write)(self.ctx, bytes.as_ptr(), bytes.len() as u64) };
        if self.code == 0 { Ok(bytes.len()) } else { Err(io::ErrorKind::Other.into()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes a file through a function of the host.
///
/// # Safety
/// `write` may be called with `ctx`.
pub(super) unsafe fn written(
    write: leafless_write_fn,
    ctx: *mut c_void,
    work: impl FnOnce(&mut Sink) -> Result<(), Error>,
) -> Result<(), Failure> {
    let write = write.ok_or(Failure::Null { name: "write" })?;
    let mut sink = Sink { write, ctx, code: 0 };
    match work(&mut sink) {
        Err(Error::Io(_)) if sink.code != 0 => Err(Error::Callback { code: sink.code }.into()),
        done => Ok(done?),
    }
}

/// Writes an octree's file through a function of the host, in a few large pieces; the file is never in memory
/// as a whole.
///
/// - Result: LEAFLESS_OK once `write` has taken all bytes.
/// - Errors: LEAFLESS_E_CALLBACK with what `write` returned in the message; LEAFLESS_E_NULL if it is NULL;
///   LEAFLESS_E_DAMAGED if the octree was mapped unverified and is damaged; LEAFLESS_E_NO_MEMORY. The last
///   two come before anything is written.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_write(
    octree: *const leafless_octree,
    write: leafless_write_fn,
    ctx: *mut c_void,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        written(write, ctx, |sink| file::write_to(octree, sink))
    })
}
