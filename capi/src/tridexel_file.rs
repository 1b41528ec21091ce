//! Files of tri-dexel models.

use super::boundary::{buffer, guard, out, path, shared, slice};
use super::file::{leafless_write_fn, written};
use super::status::leafless_status;
use super::tridexel::{give, leafless_tridexel};
use core::ffi::{c_char, c_void};
use leafless::Error;
use leafless::TriDexel;
use leafless::file::dexels;

/// Gives the model that `open` finds at a path.
///
/// # Safety
/// As [`path`] and [`out`].
unsafe fn opened(
    path: *const c_char,
    path_length: usize,
    tridexel: *mut *mut leafless_tridexel,
    open: impl FnOnce(&str) -> Result<TriDexel, Error>,
) -> leafless_status {
    guard(|| unsafe {
        let path = self::path(path, path_length)?;
        let tridexel = out(tridexel, "tridexel")?;
        tridexel.write(give(open(path)?))
    })
}

/// Gives the model that `open` finds in bytes, which stay as long as it says.
///
/// # Safety
/// As [`slice`] and [`out`].
unsafe fn found_in<'a>(
    bytes: *const u8,
    length: u64,
    tridexel: *mut *mut leafless_tridexel,
    open: impl FnOnce(&'a [u8]) -> Result<TriDexel, Error>,
) -> leafless_status {
    guard(|| unsafe {
        let bytes = slice(bytes, length, "bytes")?;
        let tridexel = out(tridexel, "tridexel")?;
        tridexel.write(give(open(bytes)?))
    })
}

/// Reads the file of a tri-dexel model into memory and verifies all of it: the plain way, and the one for files that may
/// not be trusted. Later changes of the file do not matter.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_FORMAT, also if the file holds an octree; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*tridexel` back with leafless_tridexel_free.
/// - Untrusted input: any file; memory is at most a small multiple of its length.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_open(
    path: *const c_char,
    path_length: usize,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { opened(path, path_length, tridexel, |path| dexels::open(path)) }
}

/// Maps the file of a tri-dexel model into memory and looks at its header, section table, bounds, windows and metadata
/// only: some microseconds for a file of any size. Of a file that is damaged elsewhere intervals are read as they stand
/// there, in bounds; set algebra, editors and writing check all of it first and return LEAFLESS_E_DAMAGED.
///
/// While the model lives, or one with other metadata that shares it, nobody may make the file shorter or write to it, as
/// for leafless_octree_map. Removing the file, or replacing it by renaming another over it, as leafless_tridexel_save
/// does, is harmless.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_FORMAT, also if the file holds an octree; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_ARGUMENT if there is no regular file; LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*tridexel` back with leafless_tridexel_free.
/// - Untrusted input: any contents, but only where nobody else can change the file; else leafless_tridexel_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_map(
    path: *const c_char,
    path_length: usize,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise, which includes that of the mapping.
    unsafe { opened(path, path_length, tridexel, |path| dexels::map(path)) }
}

/// As leafless_tridexel_map, but verifies all of the file first, in one scan. Who writes to the file afterwards undoes that.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: as leafless_tridexel_open, and LEAFLESS_E_ARGUMENT if there is no regular file.
/// - Ownership: give `*tridexel` back with leafless_tridexel_free.
/// - Untrusted input: any contents, but only where nobody else can change the file; else leafless_tridexel_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_map_verified(
    path: *const c_char,
    path_length: usize,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise, which includes that of the mapping.
    unsafe { opened(path, path_length, tridexel, |path| dexels::map_verified(path)) }
}

/// The tri-dexel model in the bytes of a whole file, copied and verified as by leafless_tridexel_open.
///
/// - Buffers: `bytes`, `length` bytes, may be NULL if there are none; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_FORMAT, also if the file holds an octree; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bytes are not kept; give `*tridexel` back with leafless_tridexel_free.
/// - Untrusted input: any bytes; memory is at most a small multiple of their number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_from_bytes(
    bytes: *const u8,
    length: u64,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise.
    unsafe { found_in(bytes, length, tridexel, dexels::from_bytes) }
}

/// The tri-dexel model in the bytes of a whole file, used where they lie, and checked as little as by
/// leafless_tridexel_map; call leafless_bytes_verify first where they may be damaged. For files that are part of a
/// program, or that the host maps itself.
///
/// - Buffers: `bytes`, `length` bytes on an address that is a multiple of 8; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_FORMAT, also if the file holds an octree; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED;
///   LEAFLESS_E_ARGUMENT if the bytes are misaligned; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bytes stay the host's. They must stay, unchanged, until the last reference is given back to the
///   model, and to every model that leafless_tridexel_with_metadata or leafless_tridexel_without_metadata made of it.
///   Give `*tridexel` back with leafless_tridexel_free.
/// - Untrusted input: any bytes, as leafless_tridexel_map.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_view_bytes(
    bytes: *const u8,
    length: u64,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    // SAFETY: the caller's promise, by which the bytes outlive the model and all that is made of it.
    unsafe { found_in::<'static>(bytes, length, tridexel, dexels::from_static) }
}

/// Saves a tri-dexel model: at any moment, also after a crash or a power failure, there is the old file or the new one,
/// each complete. Equal models with equal metadata give equal bytes. What leafless_octree_save says of temporary files,
/// permissions, links and pipes holds here, too.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8.
/// - Result: LEAFLESS_OK once the file is on the disk.
/// - Errors: LEAFLESS_E_IO; LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY. The old file is then as it was; only if the very last step fails, synchronising the directory,
///   the new one is in place.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_save(
    tridexel: *const leafless_tridexel,
    path: *const c_char,
    path_length: usize,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        Ok(dexels::save(model, self::path(path, path_length)?)?)
    })
}

/// The bytes of a tri-dexel model's file, in memory. Asking for the length takes as long as filling.
///
/// - Buffers: `bytes`, room for `capacity` bytes, or NULL to ask for the length only; `length`, one number.
/// - Result: `*length`, the length of the file; the file in `bytes`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_DAMAGED if the model was mapped unverified and is
///   damaged; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_to_bytes(
    tridexel: *const leafless_tridexel,
    bytes: *mut u8,
    capacity: u64,
    length: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let bytes = buffer(bytes, capacity, "bytes")?;
        let length = out(length, "length")?;
        let file = dexels::to_bytes(model)?;
        bytes.fill(&file)?;
        length.write(file.len() as u64)
    })
}

/// Writes a tri-dexel model's file through a function of the host, in a few large pieces; the file is never in memory as a
/// whole.
///
/// - Result: LEAFLESS_OK once `write` has taken all bytes.
/// - Errors: LEAFLESS_E_CALLBACK with what `write` returned in the message; LEAFLESS_E_NULL if it is NULL;
///   LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_NO_MEMORY. The last two come before
///   anything is written.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_write(
    tridexel: *const leafless_tridexel,
    write: leafless_write_fn,
    ctx: *mut c_void,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        written(write, ctx, |sink| dexels::write_to(model, sink))
    })
}
