//! Volumes from the host's arrays.

use super::boundary::{Failure, Sized32, guard, handle, out, sized, slice};
use super::source::{Source, leafless_access::*, leafless_source, source};
use super::status::leafless_status;
use super::volume::leafless_sample_type::{self, *};
use super::volume::leafless_volume_format::LEAFLESS_VOLUME_FORMAT_RAW;
use super::volume::{TYPES, leafless_volume};
use leafless::Error;
use leafless::error::VolumeFileError;
use leafless::exchange::{RawVolume, read_raw_volume, read_whole};
use leafless::memory;
use leafless::solid::{Samples, VoxelGrid};
use leafless_byte_order::*;
use std::path::Path;
use std::sync::OnceLock;

/// The order of a number's bytes.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_byte_order {
    /// The order of this machine.
    LEAFLESS_BYTE_ORDER_NATIVE = 0,
    /// The byte of the lowest weight first.
    LEAFLESS_BYTE_ORDER_LITTLE = 1,
    /// The byte of the highest weight first.
    LEAFLESS_BYTE_ORDER_BIG = 2,
}

/// The layout and the position of an array of samples: x varies fastest, then y, then z, without gaps. Zero
/// is the default of every field but the first and `extents`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_volume_layout {
    /// sizeof(leafless_volume_layout).
    pub struct_size: u32,
    /// A leafless_sample_type.
    pub sample_type: u32,
    /// Number of samples along x, y and z: 1 to 2^20 each. An octree's cube may be larger; the space beyond
    /// the samples takes no memory.
    pub extents: [u32; 3],
    /// A leafless_byte_order.
    pub byte_order: u32,
    /// Bytes before the first sample.
    pub skip: u64,
    /// The lower corner of the first voxel: the position of the first sample minus half the spacing. Each
    /// coordinate is 0 or of a magnitude between 2^-256 and 2^256.
    pub corner_model: [f64; 3],
    /// The edges of a voxel, 2^-256 to 2^256; all three 0 means 1.
    pub spacing_model: [f64; 3],
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_volume_layout {}

/// A layout that was checked.
pub(super) struct Layout {
    /// The grid, the type and the bytes before the samples. Bits in words have the same kind as bits in
    /// bytes.
    pub(super) raw: RawVolume,
    pub(super) sample_type: leafless_sample_type,
}

impl Layout {
    /// # Safety
    /// As [`sized`]; `layout` is not NULL.
    pub(super) unsafe fn new(layout: *const leafless_volume_layout) -> Result<Layout, Failure> {
        if layout.is_null() {
            return Err(Failure::Null { name: "layout" });
        }
        // SAFETY: the caller's promise.
        let given = unsafe { sized(layout, "layout")? };
        let known = TYPES.iter().find(|(named, _)| *named as u32 == given.sample_type);
        let Some(&(sample_type, kind)) = known else {
            let problem = "is no leafless_sample_type";
            return Err(Failure::Argument { name: "layout.sample_type", problem });
        };
        let big_endian = match given.byte_order {
            order if order == LEAFLESS_BYTE_ORDER_NATIVE as u32 => cfg!(target_endian = "big"),
            order if order == LEAFLESS_BYTE_ORDER_LITTLE as u32 => false,
            order if order == LEAFLESS_BYTE_ORDER_BIG as u32 => true,
            _ => {
                let problem = "is no leafless_byte_order";
                return Err(Failure::Argument { name: "layout.byte_order", problem });
            }
        };
        let spacing = if given.spacing_model == [0.0; 3] { [1.0; 3] } else { given.spacing_model };
        let grid = VoxelGrid::new(given.extents, given.corner_model, spacing)?;
        Ok(Layout { raw: RawVolume { grid, kind, big_endian, skip: given.skip }, sample_type })
    }

    /// Returns a copy of the samples in `bytes`, and how many were rounded.
    pub(super) fn copied(&self, bytes: &[u8]) -> Result<(Samples<'static>, u64), Error> {
        let found = bytes.len() as u64;
        if self.raw.skip > found {
            return Err(VolumeFileError::Length { expected: self.raw.skip, found }.into());
        }
        if self.sample_type != LEAFLESS_SAMPLE_TYPE_BITS {
            return read_raw_volume(bytes, &self.raw);
        }
        let [_, y, z] = self.raw.grid.extents().map(u64::from);
        let length = (8 * self.raw.grid.words() as u64).checked_mul(y * z).ok_or(Error::OutOfMemory)?;
        let expected = length.checked_add(self.raw.skip).ok_or(Error::OutOfMemory)?;
        if found != expected {
            return Err(VolumeFileError::Length { expected, found }.into());
        }
        let words = bytes.get(self.raw.skip as usize..).unwrap_or(&[]).as_chunks::<8>().0;
        let word = |&bytes: &[u8; 8]| match self.raw.big_endian {
            true => u64::from_be_bytes(bytes),
            false => u64::from_le_bytes(bytes),
        };
        Ok((Samples::Bits(memory::collected(words.iter().map(word))?.into()), 0))
    }

    /// Returns the samples in place.
    ///
    /// # Safety
    /// The bytes stay in place, unchanged, as long as the volume or an object made from it lives.
    unsafe fn viewed(&self, bytes: &[u8]) -> Result<Samples<'static>, Failure> {
        /// # Safety
        /// As [`Layout::viewed`].
        unsafe fn elements<T>(bytes: &[u8]) -> Result<&'static [T], Failure> {
            if !bytes.len().is_multiple_of(size_of::<T>()) {
                return Err(wrong_length());
            }
            // SAFETY: the caller's promise.
            unsafe { slice(bytes.as_ptr().cast(), (bytes.len() / size_of::<T>()) as u64, "source.bytes") }
        }
        if self.raw.big_endian != cfg!(target_endian = "big") {
            let problem = "must be this machine's for samples that are used where they lie";
            return Err(Failure::Argument { name: "layout.byte_order", problem });
        }
        if self.raw.skip != 0 {
            let problem = "must be 0 for samples that are used where they lie";
            return Err(Failure::Argument { name: "layout.skip", problem });
        }
        // SAFETY: the caller's promise.
        let samples: Samples<'static> = unsafe {
            match self.sample_type {
                LEAFLESS_SAMPLE_TYPE_BITS => Samples::Bits(elements::<u64>(bytes)?.into()),
                LEAFLESS_SAMPLE_TYPE_U8 => elements::<u8>(bytes)?.into(),
                LEAFLESS_SAMPLE_TYPE_U16 => elements::<u16>(bytes)?.into(),
                LEAFLESS_SAMPLE_TYPE_I16 => elements::<i16>(bytes)?.into(),
                LEAFLESS_SAMPLE_TYPE_F32 => elements::<f32>(bytes)?.into(),
                _ => {
                    let problem =
                        "must be U8, U16, I16, F32 or BITS for samples that are used where they lie";
                    return Err(Failure::Argument { name: "layout.sample_type", problem });
                }
            }
        };
        samples.check(&self.raw.grid).map_err(|_| wrong_length())?;
        Ok(samples)
    }

    /// Returns the volume of samples in this layout.
    pub(super) fn volume(&self, (samples, rounded): (Samples<'static>, u64)) -> leafless_volume {
        leafless_volume {
            samples,
            grid: self.raw.grid,
            placement: None,
            unit: None,
            format: LEAFLESS_VOLUME_FORMAT_RAW,
            file_type: self.sample_type,
            rounded,
            ranges: OnceLock::new(),
        }
    }
}

/// Makes a volume from an array of samples without a header, in memory or in a file.
///
/// With LEAFLESS_ACCESS_COPY the samples are copied: O(n); bytes may have any address. With
/// LEAFLESS_ACCESS_MAP, which is for bytes only, they are used in place: O(1). The layout's type must then be
/// LEAFLESS_SAMPLE_TYPE_U8, _U16, _I16, _F32 or _BITS, the byte order this machine's, `skip` 0, and the bytes
/// aligned for their type. LEAFLESS_ACCESS_MAP_VERIFIED is the same, because any samples are a valid volume.
///
/// - Buffers: `layout`, one struct; `source`, one struct; `volume`, one pointer.
/// - Result: `*volume`.
/// - Errors: LEAFLESS_E_ARGUMENT if the type, the byte order, an extent, the corner or the spacing is
///   invalid, if the layout or the source does not fit the access, or if the number of bytes is not `skip`
///   plus the size of the samples; LEAFLESS_E_VOLUME_FILE if a file has a wrong number of bytes;
///   LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: samples that are copied may be freed after the call. Samples used in place belong to the
///   host. They must stay in place, unchanged, until the last reference is released to the volume, to every
///   solid made from it, and to every object made from these, except octrees and meshes, which have their own
///   data. Release `*volume` with leafless_volume_free.
/// - Untrusted input: any layout, any bytes, any file; memory is at most the file's length and as much again
///   for the samples, twice as much for int8_t.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_new(
    layout: *const leafless_volume_layout,
    source: *const leafless_source,
    volume: *mut *mut leafless_volume,
) -> leafless_status {
    guard(|| unsafe {
        let layout = Layout::new(layout)?;
        let (source, access) = self::source(source)?;
        let volume = out(volume, "volume")?;
        let samples = match (source, access) {
            (Source::Bytes(bytes), LEAFLESS_ACCESS_COPY) => {
                layout.copied(bytes).map_err(|error| match error {
                    Error::VolumeFile(VolumeFileError::Length { .. }) => wrong_length(),
                    error => error.into(),
                })?
            }
            (Source::Bytes(bytes), _) => (layout.viewed(bytes)?, 0),
            (Source::Path(path), LEAFLESS_ACCESS_COPY) => {
                let path = Path::new(path);
                let bytes = read_whole(path).map_err(|error| error.of_file(path))?;
                layout.copied(&bytes).map_err(|error| error.of_file(path))?
            }
            (Source::Path(_), _) => {
                let problem = "must be LEAFLESS_ACCESS_COPY for samples in a file";
                return Err(Failure::Argument { name: "source.access", problem });
            }
        };
        volume.write(handle(layout.volume(samples)))
    })
}

fn wrong_length() -> Failure {
    Failure::Argument {
        name: "source.length",
        problem: "must be the bytes of all samples that the layout tells of, and those to skip",
    }
}
