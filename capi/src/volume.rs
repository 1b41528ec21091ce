//! Volumes: bitmaps and arrays of samples, and solids made from them.

use super::boundary::{Failure, array, filled, guard, out, output, refer, release, shared};
use super::control::{controlled, leafless_options};
use super::frame::{leafless_frame, leafless_interval};
use super::mesh_file::{leafless_unit, unit_of};
use super::number::enumeration;
use super::solid::{give_any, leafless_solid};
use super::status::leafless_status;
use core::ffi::c_void;
use leafless::Control;
use leafless::Error;
use leafless::exchange::{LengthUnit, SampleKind};
use leafless::solid::{Band, Samples, VoxelGrid};
use leafless::{Affine, Interval};
use leafless::{AnySolid, Volume};
use leafless_sample_type::*;
use std::sync::OnceLock;

/// A three-dimensional bitmap or array of samples, with its position. Each sample stands for the closed box
/// around it, its voxel: on each axis voxel i reaches from corner + i·spacing to corner + (i + 1)·spacing.
/// leafless_solid_from_volume makes a solid from the voxels whose samples lie in a band.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_volume_free releases.
pub struct leafless_volume {
    pub(super) samples: Samples<'static>,
    pub(super) grid: VoxelGrid,
    /// The map that moves the grid to the file's axes, if these are not x, y and z.
    pub(super) placement: Option<Affine>,
    pub(super) unit: Option<LengthUnit>,
    pub(super) format: leafless_volume_format,
    pub(super) file_type: leafless_sample_type,
    pub(super) rounded: u64,
    /// The data that all bands share, once it was computed.
    pub(super) ranges: OnceLock<Volume<'static>>,
}

/// The type of samples. The arrays of a volume have one of the first five types. Samples of other types are
/// converted to one of these when they are copied.
#[derive(Clone, Copy, PartialEq)]
#[repr(u32)]
pub enum leafless_sample_type {
    /// uint8_t.
    LEAFLESS_SAMPLE_TYPE_U8 = 0,
    /// uint16_t.
    LEAFLESS_SAMPLE_TYPE_U16 = 1,
    /// int16_t, as the Hounsfield units of tomography.
    LEAFLESS_SAMPLE_TYPE_I16 = 2,
    /// float. A sample that is not a number is never inside.
    LEAFLESS_SAMPLE_TYPE_F32 = 3,
    /// Bits with the values 0 and 1, in uint64_t: each row along x begins with a word of its own, and the bit
    /// of the sample (x, y, z) is bit x mod 64 of word x / 64 + w (y + ny z), where w = ⌈nx / 64⌉. The other
    /// bits of a row's last word are ignored. leafless_octree_bitmap writes the same layout.
    LEAFLESS_SAMPLE_TYPE_BITS = 4,
    /// Bits in bytes, eight to a byte, the lowest first: each row along x begins with a byte of its own. They
    /// become LEAFLESS_SAMPLE_TYPE_BITS.
    LEAFLESS_SAMPLE_TYPE_BITS_IN_BYTES = 5,
    /// int8_t. It becomes int16_t.
    LEAFLESS_SAMPLE_TYPE_I8 = 6,
    /// int32_t. It becomes float, as do all following types.
    LEAFLESS_SAMPLE_TYPE_I32 = 7,
    /// uint32_t.
    LEAFLESS_SAMPLE_TYPE_U32 = 8,
    /// int64_t.
    LEAFLESS_SAMPLE_TYPE_I64 = 9,
    /// uint64_t.
    LEAFLESS_SAMPLE_TYPE_U64 = 10,
    /// double.
    LEAFLESS_SAMPLE_TYPE_F64 = 11,
}

/// The formats of volume files.
#[derive(Clone, Copy, PartialEq)]
#[repr(u32)]
pub enum leafless_volume_format {
    /// The samples alone. A leafless_volume_layout describes them for reading.
    LEAFLESS_VOLUME_FORMAT_RAW = 0,
    /// NRRD, `.nrrd` or `.nhdr`. When written, samples are uncompressed.
    LEAFLESS_VOLUME_FORMAT_NRRD = 1,
    /// MetaImage, `.mha` or `.mhd`, for reading only.
    LEAFLESS_VOLUME_FORMAT_METAIMAGE = 2,
    /// For writing only: NRRD with samples compressed by DEFLATE. (A NRRD file that was read has
    /// LEAFLESS_VOLUME_FORMAT_NRRD, compressed or not.)
    LEAFLESS_VOLUME_FORMAT_NRRD_GZIP = 3,
}

enumeration! {
    leafless_volume_format => leafless_volume_format {
        LEAFLESS_VOLUME_FORMAT_RAW => leafless_volume_format::LEAFLESS_VOLUME_FORMAT_RAW,
        LEAFLESS_VOLUME_FORMAT_NRRD => leafless_volume_format::LEAFLESS_VOLUME_FORMAT_NRRD,
        LEAFLESS_VOLUME_FORMAT_METAIMAGE => leafless_volume_format::LEAFLESS_VOLUME_FORMAT_METAIMAGE,
        LEAFLESS_VOLUME_FORMAT_NRRD_GZIP => leafless_volume_format::LEAFLESS_VOLUME_FORMAT_NRRD_GZIP,
    }
}

/// Basic facts about a volume.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_volume_info {
    /// sizeof(leafless_volume_info).
    pub struct_size: u32,
    /// Number of samples along x, y and z.
    pub extents: [u32; 3],
    /// Type of the samples in memory: one of the first five.
    pub sample_type: leafless_sample_type,
    /// Type of the samples in the file or array that the volume was made from.
    pub file_type: leafless_sample_type,
    /// The file's format; LEAFLESS_VOLUME_FORMAT_RAW for arrays.
    pub format: leafless_volume_format,
    /// The unit of all lengths, if the file states it.
    pub unit: leafless_unit,
    /// Whether the file's axes are not x, y and z: then `placement` moves the voxels.
    pub is_placed: bool,
    /// The number of samples.
    pub sample_count: u64,
    /// Number of samples that were rounded to single precision.
    pub rounded: u64,
    /// The least value that is inside by default: the middle of the range of `file_type`. 0.5 for bits, 127.5
    /// for uint8_t, 32767.5 for uint16_t, -0.5 for integers with a sign, 0 for float and double.
    pub default_threshold: f64,
    /// The lower corner of the first voxel, before `placement` moves it.
    pub corner_model: [f64; 3],
    /// The edges of a voxel.
    pub spacing_model: [f64; 3],
    /// The affine map x' = M x + t that moves the voxels to the position of the file: three rows of M and t.
    /// Its directions are rounded. The identity unless `is_placed`.
    pub placement: [f64; 12],
    /// Bytes of the samples, in memory or in the host's memory, and of the index for solids.
    pub bytes: u64,
}

output!(leafless_volume_info);

pub(super) const TYPES: [(leafless_sample_type, SampleKind); 12] = [
    (LEAFLESS_SAMPLE_TYPE_U8, SampleKind::U8),
    (LEAFLESS_SAMPLE_TYPE_U16, SampleKind::U16),
    (LEAFLESS_SAMPLE_TYPE_I16, SampleKind::I16),
    (LEAFLESS_SAMPLE_TYPE_F32, SampleKind::F32),
    (LEAFLESS_SAMPLE_TYPE_BITS_IN_BYTES, SampleKind::Bit),
    (LEAFLESS_SAMPLE_TYPE_BITS, SampleKind::Bit),
    (LEAFLESS_SAMPLE_TYPE_I8, SampleKind::I8),
    (LEAFLESS_SAMPLE_TYPE_I32, SampleKind::I32),
    (LEAFLESS_SAMPLE_TYPE_U32, SampleKind::U32),
    (LEAFLESS_SAMPLE_TYPE_I64, SampleKind::I64),
    (LEAFLESS_SAMPLE_TYPE_U64, SampleKind::U64),
    (LEAFLESS_SAMPLE_TYPE_F64, SampleKind::F64),
];

/// Returns the type of a file's samples.
pub(super) fn type_of(kind: SampleKind) -> leafless_sample_type {
    TYPES.iter().find(|(_, known)| *known == kind).map_or(LEAFLESS_SAMPLE_TYPE_U8, |(named, _)| *named)
}

impl leafless_volume {
    /// Returns the band of a caller, or the band from the default threshold on.
    ///
    /// # Safety
    /// `band` is NULL or misaligned, or points to a struct.
    pub(super) unsafe fn band(&self, band: *const leafless_interval) -> Result<Band, Failure> {
        let [low, high] = match band.is_null() {
            true => [self.threshold(), f64::INFINITY],
            // SAFETY: the caller's promise.
            false => unsafe { array(band.cast::<f64>(), "band")? },
        };
        Ok(Band::between(low, high)?)
    }

    fn sample_type(&self) -> leafless_sample_type {
        match self.samples {
            Samples::Bits(_) => LEAFLESS_SAMPLE_TYPE_BITS,
            Samples::U8(_) => LEAFLESS_SAMPLE_TYPE_U8,
            Samples::U16(_) => LEAFLESS_SAMPLE_TYPE_U16,
            Samples::I16(_) => LEAFLESS_SAMPLE_TYPE_I16,
            Samples::F32(_) => LEAFLESS_SAMPLE_TYPE_F32,
        }
    }

    /// Returns the least value that is inside by default.
    fn threshold(&self) -> f64 {
        let known = TYPES.iter().find(|(named, _)| *named == self.file_type);
        known.map_or(0.0, |(_, kind)| kind.half_range())
    }

    /// Returns the voxels that are inside. Only the first call reads the samples.
    pub(super) fn voxels(&self, band: Band, control: &Control<'_>) -> Result<Volume<'static>, Error> {
        match self.ranges.get() {
            Some(volume) => volume.with_band(band, control),
            None => {
                let volume = Volume::new(self.samples.clone(), &self.grid, band, control)?;
                // If another thread was faster, its ranges are equal.
                let _ = self.ranges.set(volume.clone());
                Ok(volume)
            }
        }
    }
}

/// Returns one more reference to a volume.
///
/// - Buffers: `volume`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `volume`.
/// - Ownership: release each reference with leafless_volume_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_ref(
    volume: *const leafless_volume,
    reference: *mut *mut leafless_volume,
) -> leafless_status {
    guard(|| unsafe { refer(volume, "volume", reference) })
}

/// Releases a reference to a volume; the last release frees the volume. Solids made of it stay, and keep its
/// samples.
///
/// - Buffers: `volume`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_free(volume: *mut leafless_volume) {
    // SAFETY: the caller's promise.
    unsafe { release(volume) }
}

/// Returns basic facts about a volume. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_describe(
    volume: *const leafless_volume,
    info: *mut leafless_volume_info,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let rows = *volume.placement.unwrap_or(Affine::IDENTITY).rows();
        filled(info, "info")?.write(leafless_volume_info {
            struct_size: size_of::<leafless_volume_info>() as u32,
            extents: volume.grid.extents(),
            sample_type: volume.sample_type(),
            file_type: volume.file_type,
            format: volume.format,
            unit: unit_of(volume.unit),
            is_placed: volume.placement.is_some(),
            sample_count: volume.grid.count(),
            rounded: volume.rounded,
            default_threshold: volume.threshold(),
            corner_model: volume.grid.corner(),
            spacing_model: volume.grid.spacing(),
            placement: core::array::from_fn(|k| rows[k / 4][k % 4]),
            bytes: (volume.samples.bytes() + volume.ranges.get().map_or(0, Volume::bytes)) as u64,
        })
    })
}

/// Returns the address of a volume's samples, without a copy: x varies fastest, in the `sample_type` of
/// leafless_volume_describe.
///
/// - Buffers: `samples` and `length`, one each.
/// - Result: `*samples`, the address of the first sample; `*length`, their size in bytes.
/// - Ownership: the samples belong to the volume, or to the host if it uses the host's array, and
///   live as long as the reference `volume`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_peek_samples(
    volume: *const leafless_volume,
    samples: *mut *const c_void,
    length: *mut u64,
) -> leafless_status {
    fn bytes<T>(values: &[T]) -> (*const c_void, u64) {
        (values.as_ptr().cast(), size_of_val(values) as u64)
    }
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let (samples, length) = (out(samples, "samples")?, out(length, "length")?);
        let (start, count) = match &volume.samples {
            Samples::Bits(words) => bytes(words.values()),
            Samples::U8(values) => bytes(values.values()),
            Samples::U16(values) => bytes(values.values()),
            Samples::I16(values) => bytes(values.values()),
            Samples::F32(values) => bytes(values.values()),
        };
        samples.write(start)?;
        length.write(count)
    })
}

/// Makes the frame whose finest cells are the voxels of a volume, with the least depth that holds all voxels.
/// On this frame a solid of the volume has no PARTIAL cell, and its octree is the bitmap, bit for bit.
///
/// - Buffers: `frame`, one struct.
/// - Result: `*frame`.
/// - Errors: LEAFLESS_E_ARGUMENT if voxels are not cubes, or their axes are not x, y and z; use a frame
///   around leafless_volume_bounds then.
/// - Untrusted input: any volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_frame(
    volume: *const leafless_volume,
    frame: *mut leafless_frame,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let frame = out(frame, "frame")?;
        if volume.placement.is_some() {
            let problem = "has other axes than x, y and z, and cells have not; give bounds and a depth";
            return Err(Failure::Argument { name: "volume", problem });
        }
        frame.write((&volume.grid.frame()?).into())
    })
}

/// Returns a box that contains all voxels of a volume at the position that the file states, rounded outward.
///
/// - Buffers: `min_model` and `max_model`, room for 3 numbers each.
/// - Result: both corners.
/// - Errors: LEAFLESS_E_ARGUMENT if the box is beyond the range of double.
/// - Untrusted input: any volume.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_bounds(
    volume: *const leafless_volume,
    min_model: *mut f64,
    max_model: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let (min, max) = (out(min_model.cast(), "min_model")?, out(max_model.cast(), "max_model")?);
        let bounds = volume.grid.bounds();
        let bounds = match &volume.placement {
            Some(placement) => bounds.placed(placement),
            None => Some(bounds),
        };
        let problem = "reaches beyond the range of double";
        let bounds = bounds.ok_or(Failure::Argument { name: "volume", problem })?;
        min.write(bounds.min)?;
        max.write(bounds.max)
    })
}

/// Returns the least and the greatest sample of a volume. O(n); O(n / 64) after the first solid or range.
///
/// - Buffers: `options`, one struct or NULL (its limits are ignored); `range`, one struct.
/// - Result: `*range`: 0 to 1 for bits; all numbers if a sample is not a number.
/// - Errors: LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_volume_range(
    volume: *const leafless_volume,
    options: *const leafless_options,
    range: *mut leafless_interval,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let range = out(range, "range")?;
        let found = controlled(options, |control| match volume.ranges.get() {
            Some(volume) => Ok(volume.value_range()),
            None => Ok(volume.voxels(Band::at_least(volume.threshold())?, control)?.value_range()),
        })?;
        let [lower, upper] = match found {
            Some(found) => found,
            None if volume.sample_type() == LEAFLESS_SAMPLE_TYPE_BITS => [0.0, 1.0],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        };
        range.write(Interval::new(lower, upper).unwrap_or(Interval::ALL).into())
    })
}

/// Makes a solid from a volume: the union of the closed voxels whose samples lie in a band, at the position
/// that the file states. Space beyond the voxels is outside. All functions for solids accept it: it can be
/// built, combined, measured, and have its surface extracted.
///
/// On the frame of leafless_volume_frame, finest cells are voxels and no cell is PARTIAL. On any other frame,
/// a cell is PARTIAL if it meets both voxels inside the band and voxels outside it.
///
/// The first solid of a volume reads all samples, in O(n). Later solids, with other bands, read only the
/// blocks that the block's least and greatest value do not decide. The samples are shared; for uint8_t the
/// solid takes about 1/32 of their memory in addition.
///
/// - Buffers: `band`, one struct: the least and the greatest value that are inside, which may be infinite; or
///   NULL, which means all values from the `default_threshold` of leafless_volume_describe on. `options`, one
///   struct or NULL (its limits are ignored); `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if an end of the band is not a number, or the lower end exceeds the upper
///   end; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the solid shares the samples, and `volume` may be freed; release `*solid` with
///   leafless_solid_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any volume.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_from_volume(
    volume: *const leafless_volume,
    band: *const leafless_interval,
    options: *const leafless_options,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let volume = shared(volume, "volume")?;
        let band = volume.band(band)?;
        let solid = out(solid, "solid")?;
        let voxels = AnySolid::new(controlled(options, |control| volume.voxels(band, control))?);
        solid.write(give_any(match &volume.placement {
            Some(placement) => voxels.placed(placement)?,
            None => voxels,
        }))
    })
}
