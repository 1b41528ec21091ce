//! Arrays of samples without a header.

use super::kind::SampleKind;
use crate::error::{Error, VolumeFileError};
use crate::solid::{Samples, VoxelGrid};

/// The layout of an array of samples without a header: x fastest, then y, then z.
///
/// ```
/// use leafless::solid::VoxelGrid;
/// use leafless::exchange::{RawVolume, SampleKind, read_raw_volume};
/// let grid = VoxelGrid::new([2, 1, 2], [0.0; 3], [1.0; 3])?;
/// let layout = RawVolume { grid, kind: SampleKind::U16, big_endian: true, skip: 0 };
/// let (samples, rounded) = read_raw_volume(&[0, 1, 0, 2, 1, 0, 0, 255], &layout)?;
/// assert!(matches!(samples, leafless::solid::Samples::U16(array) if array.values() == [1, 2, 256, 255]));
/// assert_eq!(rounded, 0);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RawVolume {
    /// The number of samples, and their positions.
    pub grid: VoxelGrid,
    /// The type of the samples.
    pub kind: SampleKind,
    /// True if the most significant byte comes first.
    pub big_endian: bool,
    /// Number of bytes before the first sample.
    pub skip: u64,
}

/// Reads the samples of an array, and returns them with the number of samples that single precision had to
/// round. Bits and numbers of 8 or 16 bits are kept, but signed numbers of 8 bits become 16 bits wide; all
/// others become numbers of single precision. O(n).
///
/// # Errors
/// [`VolumeFileError::Length`] if there are more or fewer bytes than the layout needs;
/// [`Error::OutOfMemory`].
pub fn read_raw_volume(bytes: &[u8], layout: &RawVolume) -> Result<(Samples<'static>, u64), Error> {
    let length = layout.kind.bytes(&layout.grid).ok_or(Error::OutOfMemory)?;
    let expected = length.checked_add(layout.skip).ok_or(Error::OutOfMemory)?;
    if bytes.len() as u64 != expected {
        return Err(VolumeFileError::Length { expected, found: bytes.len() as u64 }.into());
    }
    let samples = bytes.get(layout.skip as usize..).unwrap_or(&[]);
    layout.kind.samples(samples, layout.big_endian, &layout.grid)
}
