//! Volume files.

use super::boundary::{Failure, buffer, guard, handle, out, path, shared, slice};
use super::status::leafless_status;
use super::volume::leafless_volume_format::*;
use super::volume::{leafless_volume, type_of};
use super::volume_arrays::{Layout, leafless_volume_layout};
use core::ffi::c_char;
use leafless::exchange::{
    NrrdEncoding, VolumeFile, VolumeFormat, open_volume, read_volume, read_whole, volume_data_file,
    write_nrrd, write_raw_volume,
};
use leafless::file::replace;
use std::io::Write;
use std::path::Path;
use std::sync::OnceLock;

fn give(file: VolumeFile) -> *mut leafless_volume {
    handle(leafless_volume {
        file_type: type_of(file.kind),
        format: match file.format {
            VolumeFormat::Nrrd => LEAFLESS_VOLUME_FORMAT_NRRD,
            VolumeFormat::MetaImage => LEAFLESS_VOLUME_FORMAT_METAIMAGE,
        },
        samples: file.samples,
        grid: file.grid,
        placement: file.placement,
        unit: file.unit,
        rounded: file.rounded,
        ranges: OnceLock::new(),
    })
}

impl leafless_volume {
    fn file(&self, format: u32) -> Result<Vec<u8>, Failure> {
        let refuse = |name, problem| Err(Failure::Argument { name, problem });
        let encoding = match format {
            raw if raw == LEAFLESS_VOLUME_FORMAT_RAW as u32 => {
                return Ok(write_raw_volume(&self.samples, &self.grid)?);
            }
            nrrd if nrrd == LEAFLESS_VOLUME_FORMAT_NRRD as u32 => NrrdEncoding::Raw,
            gzip if gzip == LEAFLESS_VOLUME_FORMAT_NRRD_GZIP as u32 => NrrdEncoding::Gzip,
            meta if meta == LEAFLESS_VOLUME_FORMAT_METAIMAGE as u32 => {
                return refuse("format", "MetaImage can be read only");
            }
            _ => return refuse("format", "is no leafless_volume_format"),
        };
        if self.placement.is_some() {
            return refuse("volume", "has other axes than x, y and z, which cannot be written");
        }
        Ok(write_nrrd(&self.samples, &self.grid, encoding)?)
    }
}

/// Reads a volume file, NRRD or MetaImage; the content tells which. If it names another file for its samples,
/// that is read from the same folder or below it.
///
/// NRRD: versions 1 to 5, attached and detached, raw, gzip and ascii. MetaImage: binary, ASCII and
/// compressed. All types of single numbers, both byte orders. What is neither 8 nor 16 bits wide becomes
/// float, and int8_t becomes int16_t. O(n); the samples are copied once.
///
/// Samples in another file must lie in the header's folder or below it, by their real path: links are followed
/// before that is judged. The header's folder is the one that `path` names and, if the header is a link, also
/// the one in which the header really lies, which is searched second.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `volume`, one pointer.
/// - Result: `*volume`; leafless_volume_describe tells what the file says.
/// - Errors: LEAFLESS_E_VOLUME_FILE, with what is wrong where in the message, if the file is neither, is
///   damaged, or uses something that cannot be read; LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*volume` back with leafless_volume_free.
/// - Untrusted input: any file. A header that asks for more samples than its data can hold is refused before
///   anything is allocated; compressed samples become at most 1032 times as long as the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_open(
    path: *const c_char,
    path_length: usize,
    volume: *mut *mut leafless_volume,
) -> leafless_status {
    guard(|| unsafe {
        let path = self::path(path, path_length)?;
        out(volume, "volume")?.write(give(open_volume(path)?))
    })
}

/// As leafless_volume_open for a file in memory.
///
/// - Buffers: `bytes`, `length` bytes; may be NULL if there are none. `data`, `data_length` bytes: the file
///   of the samples, if leafless_volume_data_file tells of one; else NULL and 0. `volume`, one pointer.
/// - Result: `*volume`.
/// - Errors: as leafless_volume_open, but those of paths.
/// - Ownership: the bytes are not kept; give `*volume` back with leafless_volume_free.
/// - Untrusted input: any bytes; memory as for leafless_volume_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_from_bytes(
    bytes: *const u8,
    length: u64,
    data: *const u8,
    data_length: u64,
    volume: *mut *mut leafless_volume,
) -> leafless_status {
    guard(|| unsafe {
        let bytes = slice(bytes, length, "bytes")?;
        let data =
            if data.is_null() && data_length == 0 { None } else { Some(slice(data, data_length, "data")?) };
        out(volume, "volume")?.write(give(read_volume(bytes, data)?))
    })
}

/// The name of the file that has the samples of a volume file, relative to that.
///
/// - Buffers: `bytes`, `length` bytes: the file, or all of its header; may be NULL if there are none. `name`,
///   room for `capacity` bytes, or NULL to ask for the length only; `name_length`, one number.
/// - Result: `*name_length`, in bytes; 0 if the samples stand behind the header. The name, in UTF-8, not
///   NUL-terminated. It may be any text: check it before you open such a file.
/// - Errors: LEAFLESS_E_VOLUME_FILE; LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_data_file(
    bytes: *const u8,
    length: u64,
    name: *mut c_char,
    capacity: u64,
    name_length: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let bytes = slice(bytes, length, "bytes")?;
        let name = buffer(name.cast::<u8>(), capacity, "name")?;
        let name_length = out(name_length, "name_length")?;
        let found = volume_data_file(bytes)?.unwrap_or_default();
        name.fill(found.as_bytes())?;
        name_length.write(found.len() as u64)
    })
}

/// Reads an array of samples without a header. O(n). (In memory, leafless_volume_new does the same.)
///
/// - Buffers: `path`, `path_length` bytes of UTF-8; `layout`, one struct; `volume`, one pointer.
/// - Result: `*volume`.
/// - Errors: LEAFLESS_E_VOLUME_FILE if the file is longer or shorter than the layout says;
///   LEAFLESS_E_ARGUMENT as leafless_volume_new; LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: give `*volume` back with leafless_volume_free.
/// - Untrusted input: any file, any layout; memory is at most the file's length and as much again for the
///   samples, twice as much for int8_t.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_open_raw(
    path: *const c_char,
    path_length: usize,
    layout: *const leafless_volume_layout,
    volume: *mut *mut leafless_volume,
) -> leafless_status {
    guard(|| unsafe {
        let path = Path::new(self::path(path, path_length)?);
        let layout = Layout::new(layout)?;
        let volume = out(volume, "volume")?;
        let bytes = read_whole(path).map_err(|error| error.of_file(path))?;
        let copied = layout.copied(&bytes).map_err(|error| error.of_file(path))?;
        volume.write(handle(layout.volume(copied)))
    })
}

/// Saves a volume in a file. At any moment there is the old file or the new one, each complete, as
/// leafless_octree_save tells.
///
/// The byte of the lowest weight comes first, and bits become bytes 0 and 1. A NRRD holds the place of the
/// first sample, corner + spacing / 2, rounded so that the same corner is read again; where no double does that,
/// near a power of two, the volume lies half a last place beside. It holds no unit. A raw file holds no place at all.
/// O(n) time and memory.
///
/// - Buffers: `path`, `path_length` bytes of UTF-8. `format` is a leafless_volume_format.
/// - Result: LEAFLESS_OK once the file is on the disk.
/// - Errors: LEAFLESS_E_ARGUMENT if `format` is none that can be written, or if the volume has other axes
///   than x, y and z and shall become a NRRD; LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY. The old
///   file is then as it was; only if the very last step fails, synchronising the directory, the new one is in
///   place.
/// - Untrusted input: any volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_save(
    volume: *const leafless_volume,
    format: u32,
    path: *const c_char,
    path_length: usize,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let path = Path::new(self::path(path, path_length)?);
        let bytes = volume.file(format)?;
        Ok(replace(path, |file| Ok(file.write_all(&bytes)?))?)
    })
}

/// The bytes of a volume's file, in memory: those that leafless_volume_save writes. Asking for the length
/// takes as long as filling.
///
/// - Buffers: `bytes`, room for `capacity` bytes, or NULL to ask for the length only; `length`, one number.
///   `format` is a leafless_volume_format.
/// - Result: `*length`, the length of the file; the file in `bytes`.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small; LEAFLESS_E_ARGUMENT as leafless_volume_save;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_to_bytes(
    volume: *const leafless_volume,
    format: u32,
    bytes: *mut u8,
    capacity: u64,
    length: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let bytes = buffer(bytes, capacity, "bytes")?;
        let length = out(length, "length")?;
        let file = volume.file(format)?;
        bytes.fill(&file)?;
        length.write(file.len() as u64)
    })
}
