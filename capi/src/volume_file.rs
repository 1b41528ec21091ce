//! Reading and writing of volume files.

use super::boundary::{Failure, buffer, guard, handle, out, shared, slice};
use super::number::Number;
use super::source::{Source, copy, data, leafless_sink, leafless_source, sink};
use super::status::leafless_status;
use super::volume::leafless_volume_format::*;
use super::volume::{leafless_volume, leafless_volume_format, type_of};
use core::ffi::c_char;
use leafless::exchange::{
    NrrdEncoding, VolumeFile, VolumeFormat, open_volume, read_volume, volume_data_file, write_nrrd,
    write_raw_volume,
};
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
    fn file(&self, format: leafless_volume_format) -> Result<Vec<u8>, Failure> {
        let refuse = |name, problem| Err(Failure::Argument { name, problem });
        let encoding = match format {
            LEAFLESS_VOLUME_FORMAT_RAW => return Ok(write_raw_volume(&self.samples, &self.grid)?),
            LEAFLESS_VOLUME_FORMAT_NRRD => NrrdEncoding::Raw,
            LEAFLESS_VOLUME_FORMAT_NRRD_GZIP => NrrdEncoding::Gzip,
            LEAFLESS_VOLUME_FORMAT_METAIMAGE => return refuse("format", "MetaImage can be read only"),
        };
        if self.placement.is_some() {
            return refuse("volume", "has other axes than x, y and z, which cannot be written");
        }
        Ok(write_nrrd(&self.samples, &self.grid, encoding)?)
    }
}

/// Reads a volume file, NRRD or MetaImage, detected from the content. If it names another file for its
/// samples, that file is read from the same folder or below it, or is given as `data`.
///
/// NRRD: versions 1 to 5, attached and detached, raw, gzip and ascii. MetaImage: binary, ASCII and
/// compressed. All scalar sample types and both byte orders are supported. Samples that are neither 8 nor 16
/// bits wide become float, and int8_t becomes int16_t. O(n); the samples are copied once.
///
/// Samples in another file must lie in the header's folder or below it, by their real path: links are
/// followed before this check. The header's folder is the folder of the given path and, if the header is a
/// link, also the folder of the link's target, which is searched second. For bytes in memory no other file is
/// read.
///
/// - Buffers: `source`, one struct, with LEAFLESS_ACCESS_COPY. `data`, one struct of the same kind: the file
///   of the samples, which replaces the file that the header names; or NULL. Bytes in memory whose samples
///   are in another file need `data`, else the result is LEAFLESS_E_VOLUME_FILE. leafless_volume_data_file
///   returns the name of that file. `volume`, one pointer.
/// - Result: `*volume`; leafless_volume_describe returns the facts that the file states.
/// - Errors: LEAFLESS_E_VOLUME_FILE, with the problem and its position in the message, if the file has
///   neither format, is damaged, or uses an unsupported feature; LEAFLESS_E_IO; LEAFLESS_E_UTF8;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*volume` with leafless_volume_free.
/// - Untrusted input: any file. A header that asks for more samples than its data can hold is refused before
///   anything is allocated; compressed samples become at most 1032 times as long as the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_read(
    source: *const leafless_source,
    data: *const leafless_source,
    volume: *mut *mut leafless_volume,
) -> leafless_status {
    guard(|| unsafe {
        let source = copy(source)?;
        let data = self::data(data)?;
        let volume = out(volume, "volume")?;
        let file = match (source, data) {
            (Source::Path(path), None) => open_volume(path)?,
            (Source::Bytes(bytes), None) => read_volume(bytes, None)?,
            (header, Some(samples)) => read_volume(&header.whole()?, Some(&samples.whole()?))?,
        };
        volume.write(give(file))
    })
}

/// Returns the name of the file that contains the samples of a volume file, relative to the volume file.
///
/// - Buffers: `bytes`, `length` bytes: the file, or all of its header; may be NULL if `length` is 0. `name`,
///   room for `capacity` bytes, or NULL to get only the length; `name_length`, one number.
/// - Result: `*name_length`, in bytes; 0 if the samples follow the header. The name, in UTF-8, not
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

/// Writes a volume file.
///
/// The byte order is little-endian, and bits become bytes 0 and 1. A NRRD stores the position of the first
/// sample, corner + spacing / 2, rounded so that reading restores the same corner. Near a power of two no
/// such double may exist; then the position is off by half a unit in the last place. It stores no unit. A raw
/// file stores no position. O(n) time and memory.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_ARGUMENT if `format` is not a format that can be written, or if a volume with axes
///   other than x, y and z is written as NRRD; LEAFLESS_E_IO; LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_write(
    volume: *const leafless_volume,
    format: Number<leafless_volume_format>,
    sink: *const leafless_sink,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let format = format.known("format")?;
        let sink = self::sink(sink)?;
        sink.put_whole(&volume.file(format)?)
    })
}
