//! Writing volumes as raw arrays and as NRRD.

use crate::error::Error;
use crate::lattice::axes;
use crate::memory;
use crate::solid::{Samples, VoxelGrid};
use alloc::vec::Vec;
use core::fmt::Write;
use miniz_oxide::deflate::core::{
    CompressorOxide, TDEFLFlush, TDEFLStatus, compress, create_comp_flags_from_zip_params,
};

/// The encoding of samples in a NRRD.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NrrdEncoding {
    /// Uncompressed.
    Raw,
    /// Compressed by DEFLATE, level 6.
    Gzip,
}

/// Returns the bytes of samples, x fastest, least significant byte first. Bits become bytes 0 and 1, which
/// more programs can read; bits beyond a row are left out. O(n).
///
/// # Errors
/// [`Error::Argument`] if the grid has a different number of samples; [`Error::OutOfMemory`].
pub fn write_raw_volume(samples: &Samples<'_>, grid: &VoxelGrid) -> Result<Vec<u8>, Error> {
    samples.check(grid)?;
    Ok(match samples {
        Samples::Bits(words) => {
            let nx = grid.extents()[0] as usize;
            let count = usize::try_from(grid.count()).map_err(|_| Error::OutOfMemory)?;
            let mut bytes = memory::with_capacity(count)?;
            for row in words.values().chunks(grid.words()) {
                let bits = row.iter().flat_map(|&word| (0..64).map(move |i| (word >> i & 1) as u8));
                bytes.extend(bits.take(nx));
            }
            bytes
        }
        Samples::U8(values) => memory::copied(values.values())?,
        Samples::U16(values) => bytes_of(values.values(), |v| v.to_le_bytes())?,
        Samples::I16(values) => bytes_of(values.values(), |v| v.to_le_bytes())?,
        Samples::F32(values) => bytes_of(values.values(), |v| v.to_le_bytes())?,
    })
}

fn bytes_of<T: Copy, const N: usize>(values: &[T], of: impl Fn(T) -> [u8; N]) -> Result<Vec<u8>, Error> {
    let mut bytes = memory::with_capacity(values.len().checked_mul(N).ok_or(Error::OutOfMemory)?)?;
    values.iter().for_each(|&value| bytes.extend_from_slice(&of(value)));
    Ok(bytes)
}

/// Returns a NRRD file, version 4, with the grid as `space directions` and `space origin`. The origin is the
/// position of the first sample, corner + spacing / 2, rounded to a double from which
/// [`read_volume`](super::read_volume) computes the same corner. If there is no such double, near a power of
/// two, the grid that is read back is off by half a unit in the last place. O(n).
///
/// # Errors
/// As [`write_raw_volume`].
///
/// ```
/// use leafless::solid::VoxelGrid;
/// use leafless::exchange::{NrrdEncoding, read_volume, write_nrrd};
/// let grid = VoxelGrid::new([2, 3, 1], [-0.5, 2.0, 0.0], [0.25, 0.25, 1.0])?;
/// let bytes = write_nrrd(&vec![1u16, 2, 3, 4, 5, 60_000].into(), &grid, NrrdEncoding::Gzip)?;
/// assert_eq!(read_volume(&bytes, None)?.grid, grid);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn write_nrrd(samples: &Samples<'_>, grid: &VoxelGrid, encoding: NrrdEncoding) -> Result<Vec<u8>, Error> {
    let data = write_raw_volume(samples, grid)?;
    let (kind, is_wide) = match samples {
        Samples::Bits(_) | Samples::U8(_) => ("uint8", false),
        Samples::U16(_) => ("uint16", true),
        Samples::I16(_) => ("int16", true),
        Samples::F32(_) => ("float", true),
    };
    let ([nx, ny, nz], [x, y, z], [sx, sy, sz]) = (grid.extents(), origin(grid), grid.spacing());
    let mut header = memory::text("")?;
    // A double takes at most 80 characters, so nothing is allocated below.
    header.try_reserve(1024)?;
    let endian = if is_wide { "endian: little\n" } else { "" };
    let name = if encoding == NrrdEncoding::Gzip { "gzip" } else { "raw" };
    let _ = write!(
        header,
        "NRRD0004\ntype: {kind}\ndimension: 3\nspace dimension: 3\nsizes: {nx} {ny} {nz}\nspace directions: ({sx:e},0,0) \
         (0,{sy:e},0) (0,0,{sz:e})\nspace origin: ({x:e},{y:e},{z:e})\n{endian}encoding: {name}\n\n"
    );
    let mut file = header.into_bytes();
    match encoding {
        NrrdEncoding::Raw => {
            file.try_reserve_exact(data.len())?;
            file.extend_from_slice(&data);
        }
        NrrdEncoding::Gzip => gzip(&data, &mut file)?,
    }
    Ok(file)
}

/// Returns the position of the first sample, as near as doubles come to it; if several are, one that leads
/// back to the corner.
fn origin(grid: &VoxelGrid) -> [f64; 3] {
    let (centre, corner, spacing) = (grid.centre([0; 3]), grid.corner(), grid.spacing());
    axes(|axis| {
        let near = centre[axis];
        let leads_back = |x: &f64| x - 0.5 * spacing[axis] == corner[axis];
        [near, near.next_down(), near.next_up()].into_iter().find(leads_back).unwrap_or(near)
    })
}

/// More than the compressor allocates for itself.
const COMPRESSOR: usize = 1 << 19;

/// Appends a gzip member.
fn gzip(data: &[u8], file: &mut Vec<u8>) -> Result<(), Error> {
    drop(memory::with_capacity::<u8>(COMPRESSOR)?);
    let mut compressor = memory::boxed(CompressorOxide::new(create_comp_flags_from_zip_params(6, -15, 0)))?;
    file.try_reserve(18)?;
    file.extend_from_slice(b"\x1F\x8B\x08\0\0\0\0\0\0\xFF");
    let mut rest = data;
    loop {
        let at = file.len();
        file.try_reserve((rest.len() / 2).max(1 << 12))?;
        file.resize(file.capacity(), 0);
        let [compressor] = &mut *compressor;
        let (status, taken, made) = compress(compressor, rest, &mut file[at..], TDEFLFlush::Finish);
        file.truncate(at + made);
        rest = rest.get(taken..).unwrap_or(&[]);
        match status {
            TDEFLStatus::Done => break,
            TDEFLStatus::Okay => {}
            // Neither the parameters nor the buffer can cause a failure.
            _ => return Err(Error::OutOfMemory),
        }
    }
    file.try_reserve(8)?;
    file.extend_from_slice(&crc32fast::hash(data).to_le_bytes());
    file.extend_from_slice(&(data.len() as u32).to_le_bytes());
    Ok(())
}
