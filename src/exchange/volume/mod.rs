//! Volume files: raw arrays, NRRD and MetaImage.
//!
//! | format | what is read |
//! |---|---|
//! | raw | [`RawVolume`]: bits, 8, 16, 32 and 64 bits, both byte orders, bytes before the samples |
//! | NRRD | versions 1 to 5; `.nrrd` and a detached `.nhdr` with one data file; encodings raw, gzip and ascii; all integer types and float, double; little and big endian; `spacings`, `axis mins` and `maxs` with `centers`, `space directions` with `space origin`; `line skip`, `byte skip` (−1 too); `units` and `space units`; comments, keys and values |
//! | MetaImage | `.mha` and `.mhd` with one data file; binary, ASCII and compressed data (zlib, gzip); all types `MET_*` of single numbers; `ElementSpacing` (else `ElementSize`), `Offset`, `TransformMatrix` and their other names; `HeaderSize` (−1 too), `CompressedDataSize`, byte orders |
//!
//! | format | what is refused, by name |
//! |---|---|
//! | both | samples of several numbers (colours, vectors); more than three axes of more than one sample; samples in several files (`LIST`, patterns); a data file outside of the header's folder, also one that a link leads to ([`open_volume`]); spacings that are negative, zero, infinite or NaN, and directions that lie in one plane up to rounding |
//! | NRRD | encodings bzip2, hex and zrl; blocks; spaces of another dimension than three; fields that the format does not have, values that a field does not have, and fields that stand twice; spacings or ends of an axis that has a direction, and a `space origin` without directions |
//! | MetaImage | objects that are no images; flags that are neither true nor false; text that is compressed |
//!
//! Unknown fields of a MetaImage are skipped, as MetaIO does; `ElementToIntensityFunctionSlope` and `Offset`
//! change nothing, as in ITK. Samples lie at the centres of voxels, in the words of NRRD: `space origin`,
//! like `Offset`, is the position of the first sample, and so is `axis mins`, unless the axis is
//! cell-centred.
//!
//! Bytes may be anything: no reader panics, and a header with more samples than its data can contain is
//! refused before anything is allocated. Besides the samples and the file, compressed samples need memory for
//! the decompressed data (at most 1032 times the length of the file, the maximum ratio of DEFLATE), and
//! samples in a text need eight bytes each.

mod header;
mod inflate;
mod kind;
mod metaimage;
mod nrrd;
mod open;
mod place;
mod raw;
mod write;

pub use kind::SampleKind;
pub use open::open_volume;
pub use raw::{RawVolume, read_raw_volume};
pub use write::{NrrdEncoding, write_nrrd, write_raw_volume};

use super::LengthUnit;
use crate::control::Control;
use crate::error::{Error, VolumeFileError};
use crate::lattice::Affine;
use crate::solid::{AnySolid, Band, Samples, Volume, VoxelGrid};
use alloc::borrow::Cow;
use alloc::string::String;
use core::fmt;
use header::{Encoding, Header, Place, Skip};

/// The volume formats that describe their contents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VolumeFormat {
    /// NRRD, `.nrrd` or `.nhdr`.
    Nrrd,
    /// MetaImage, `.mha` or `.mhd`.
    MetaImage,
}

impl VolumeFormat {
    /// Returns the format of a file with this content; `None` if it is neither.
    pub fn detect(bytes: &[u8]) -> Option<VolumeFormat> {
        if bytes.starts_with(nrrd::MAGIC) {
            Some(VolumeFormat::Nrrd)
        } else if metaimage::is_header(bytes) {
            Some(VolumeFormat::MetaImage)
        } else {
            None
        }
    }
}

impl fmt::Display for VolumeFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            VolumeFormat::Nrrd => "NRRD",
            VolumeFormat::MetaImage => "MetaImage",
        })
    }
}

/// A volume from a file.
#[non_exhaustive]
#[derive(Debug, Clone)]
pub struct VolumeFile {
    /// The samples. Bits and numbers of 8 or 16 bits are kept, but signed numbers of 8 bits become 16 bits
    /// wide. All others become numbers of single precision.
    pub samples: Samples<'static>,
    /// The positions of the samples, before `placement` is applied.
    pub grid: VoxelGrid,
    /// The map that moves the grid to the position that the file states, if the file's axes are not x, y and
    /// z. The first sample of the grid then lies at 0. The map's directions are rounded.
    pub placement: Option<Affine>,
    /// The unit of the grid's lengths, if the file states it.
    pub unit: Option<LengthUnit>,
    /// The format of the file.
    pub format: VolumeFormat,
    /// The sample type in the file.
    pub kind: SampleKind,
    /// Number of samples that single precision had to round.
    pub rounded: u64,
}

impl VolumeFile {
    /// Returns the solid of the voxels that are inside, at the position that the file states: a [`Volume`],
    /// moved by [`AnySolid::placed`] if its axes are not x, y and z. Without a band, a voxel is inside if its
    /// sample is at least the middle of the type's range ([`SampleKind::half_range`]). The samples are
    /// shared.
    ///
    /// # Errors
    /// As [`Volume::new`].
    ///
    /// ```no_run
    /// use leafless::exchange::open_volume;
    /// use leafless::{Control, Rule, build, solid::Band};
    /// let (file, control) = (open_volume("scan.nrrd")?, Control::default());
    /// let part = file.solid(Some(Band::at_least(900.0)?), &control)?;
    /// // The frame of the voxels, which suits a file without a placement.
    /// let tree = build(&part, &file.grid.frame()?, Rule::Sampled, &control)?;
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn solid(&self, band: Option<Band>, control: &Control<'_>) -> Result<AnySolid, Error> {
        let band = band.map_or_else(|| Band::at_least(self.kind.half_range()), Ok)?;
        let solid = AnySolid::new(Volume::new(self.samples.clone(), &self.grid, band, control)?);
        match &self.placement {
            Some(placement) => solid.placed(placement),
            None => Ok(solid),
        }
    }
}

/// Returns the name of the data file of a header, relative to the header; `None` if the samples follow the
/// header.
///
/// # Errors
/// [`Error::VolumeFile`].
pub fn volume_data_file(bytes: &[u8]) -> Result<Option<String>, Error> {
    Ok(match header(bytes)?.1.place {
        Place::Here(_) => None,
        Place::There(name) => Some(name),
    })
}

/// Reads a volume. `data` is the content of the data file, if [`volume_data_file`] returns one.
///
/// O(n); the samples are copied, once.
///
/// # Errors
/// [`Error::VolumeFile`] with the problem and its place; [`Error::OutOfMemory`].
///
/// ```
/// use leafless::exchange::read_volume;
/// let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n\n";
/// let file = read_volume(&[header.as_bytes(), &[1, 2, 3, 4]].concat(), None)?;
/// assert_eq!(file.grid.extents(), [2, 2, 1]);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn read_volume(bytes: &[u8], data: Option<&[u8]>) -> Result<VolumeFile, Error> {
    let (format, header) = header(bytes)?;
    let (grid, placement) = header.axes.placed(header.extents)?;
    let data = match (&header.place, data) {
        (&Place::Here(from), _) => bytes.get(from..).unwrap_or(&[]),
        (Place::There(_), Some(data)) => data,
        (Place::There(_), None) => {
            return Err(VolumeFileError::Missing { what: "the file of the samples" }.into());
        }
    };
    let (samples, rounded) = samples(&header, data, &grid)?;
    let (unit, kind) = (header.unit, header.kind);
    Ok(VolumeFile { samples, grid, placement, unit, format, kind, rounded })
}

fn header(bytes: &[u8]) -> Result<(VolumeFormat, Header), Error> {
    if bytes.is_empty() {
        return Err(VolumeFileError::Empty.into());
    }
    let format = VolumeFormat::detect(bytes).ok_or(VolumeFileError::UnknownFormat)?;
    let header = match format {
        VolumeFormat::Nrrd => nrrd::header(bytes)?,
        VolumeFormat::MetaImage => metaimage::header(bytes)?,
    };
    Ok((format, header))
}

/// Returns the samples that a header describes, from the bytes after the header.
fn samples(header: &Header, data: &[u8], grid: &VoxelGrid) -> Result<(Samples<'static>, u64), Error> {
    let mut data = data;
    for _ in 0..header.lines {
        let end = data.iter().position(|&byte| byte == b'\n');
        let end = end.ok_or(VolumeFileError::Missing { what: "a line that is to be skipped" })?;
        data = &data[end + 1..];
    }
    let length = header.kind.bytes(grid).ok_or(Error::OutOfMemory)?;
    let found = data.len() as u64;
    let short = |expected: u64| Error::from(VolumeFileError::Length { expected, found });
    let behind = |data: &'_ [u8], skip: u64| -> Option<usize> {
        usize::try_from(skip).ok().filter(|&skip| skip <= data.len())
    };
    if let (Encoding::Text, Skip::Bytes(skip)) = (header.encoding, header.skip) {
        let skip = behind(data, skip).ok_or_else(|| short(skip))?;
        return header.kind.parsed(&data[skip..], grid);
    }
    let mut data = Cow::Borrowed(data);
    let mut skip = header.skip;
    if header.encoding == Encoding::Deflated {
        let Skip::Bytes(before) = skip else { return Err(short(length)) };
        let outside = if header.skips_compressed { before } else { 0 };
        let bytes = behind(&data, outside).and_then(|from| data.get(from..)).ok_or_else(|| short(outside))?;
        let bytes = match header.compressed {
            Some(size) => usize::try_from(size).ok().and_then(|size| bytes.get(..size)),
            None => Some(bytes),
        };
        let bytes = bytes.ok_or_else(|| short(header.compressed.unwrap_or(0)))?;
        let all = length.checked_add(before - outside).ok_or(Error::OutOfMemory)?;
        skip = Skip::Bytes(before - outside);
        data = Cow::Owned(inflate::inflate(bytes, all)?);
    }
    let found = data.len() as u64;
    let before = match skip {
        Skip::Bytes(before) => before,
        Skip::Rest => found.checked_sub(length).ok_or_else(|| short(length))?,
    };
    let expected = length.checked_add(before).ok_or(Error::OutOfMemory)?;
    // Editors and tools append a line end.
    let rest = behind(&data, expected).and_then(|end| data.get(end..));
    if !rest.is_some_and(|rest| rest.iter().all(|&byte| matches!(byte, b'\n' | b'\r' | 0))) {
        return Err(VolumeFileError::Length { expected, found }.into());
    }
    let samples = data.get(before as usize..expected as usize).unwrap_or(&[]);
    header.kind.samples(samples, header.big, grid)
}
