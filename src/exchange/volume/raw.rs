//! Arrays of samples without a header.

use super::kind::SampleKind;
use crate::error::{Error, VolumeFileError};
use crate::solid::{Samples, VoxelGrid};

/// What must be known of an array of samples to read it: x fastest, then y, then z.
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
    /// How many samples there are, and where they lie.
    pub grid: VoxelGrid,
    /// What numbers they are.
    pub kind: SampleKind,
    /// Whether the byte of the highest weight comes first.
    pub big_endian: bool,
    /// Bytes before the first sample.
    pub skip: u64,
}

/// Reads the samples of an array, and tells how many of them single precision had to round: what is neither
/// bits nor 8 or 16 bits wide becomes numbers of single precision, and numbers of 8 bits with a sign become
/// 16 bits. O(n).
///
/// # Errors
/// [`VolumeFileError::Length`] if there are more or fewer bytes than the layout asks for;
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
