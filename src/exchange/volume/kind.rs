//! Sample types of files, and their conversion.

use crate::error::{Error, VolumeFileError};
use crate::lattice::Each;
use crate::memory;
use crate::solid::{Samples, VoxelGrid};
use alloc::vec::Vec;

/// The type of the samples in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SampleKind {
    /// Bits, eight to a byte, the lowest first; each row along x begins with a byte of its own.
    Bit,
    /// Whole numbers of 8 bits, from −128.
    I8,
    /// Whole numbers of 8 bits, from 0.
    U8,
    /// Whole numbers of 16 bits, from −32 768.
    I16,
    /// Whole numbers of 16 bits, from 0.
    U16,
    /// Whole numbers of 32 bits, from −2^31.
    I32,
    /// Whole numbers of 32 bits, from 0.
    U32,
    /// Whole numbers of 64 bits, from −2^63.
    I64,
    /// Whole numbers of 64 bits, from 0.
    U64,
    /// Numbers of single precision.
    F32,
    /// Numbers of double precision.
    F64,
}

impl SampleKind {
    /// All types.
    pub const ALL: [SampleKind; 11] = [
        SampleKind::Bit,
        SampleKind::I8,
        SampleKind::U8,
        SampleKind::I16,
        SampleKind::U16,
        SampleKind::I32,
        SampleKind::U32,
        SampleKind::I64,
        SampleKind::U64,
        SampleKind::F32,
        SampleKind::F64,
    ];

    /// Returns the name: `bit`, or a letter and the number of bits, from `i8` and `u8` to `f64`.
    pub const fn name(self) -> &'static str {
        match self {
            SampleKind::Bit => "bit",
            SampleKind::I8 => "i8",
            SampleKind::U8 => "u8",
            SampleKind::I16 => "i16",
            SampleKind::U16 => "u16",
            SampleKind::I32 => "i32",
            SampleKind::U32 => "u32",
            SampleKind::I64 => "i64",
            SampleKind::U64 => "u64",
            SampleKind::F32 => "f32",
            SampleKind::F64 => "f64",
        }
    }

    /// Returns the middle of the type's range, which is the default threshold: ½ for bits, 127½ for bytes, −½
    /// for signed whole numbers; 0 for single and double precision.
    pub const fn half_range(self) -> f64 {
        match self {
            SampleKind::Bit => 0.5,
            SampleKind::U8 => 127.5,
            SampleKind::U16 => 32_767.5,
            SampleKind::U32 => 2_147_483_647.5,
            SampleKind::U64 => 9_223_372_036_854_775_808.0,
            SampleKind::I8 | SampleKind::I16 | SampleKind::I32 | SampleKind::I64 => -0.5,
            SampleKind::F32 | SampleKind::F64 => 0.0,
        }
    }

    /// Returns the number of bytes of a grid's samples; `None` beyond 2^64.
    pub(super) fn bytes(self, grid: &VoxelGrid) -> Option<u64> {
        let [nx, ny, nz] = grid.extents().each(u64::from);
        let each = match self {
            SampleKind::Bit => return nx.div_ceil(8).checked_mul(ny)?.checked_mul(nz),
            SampleKind::I8 | SampleKind::U8 => 1,
            SampleKind::I16 | SampleKind::U16 => 2,
            SampleKind::I32 | SampleKind::U32 | SampleKind::F32 => 4,
            SampleKind::I64 | SampleKind::U64 | SampleKind::F64 => 8,
        };
        grid.count().checked_mul(each)
    }

    /// Converts bytes to samples, and returns the number of rounded samples. `bytes` must have the length
    /// that [`bytes`](Self::bytes) returns.
    pub(super) fn samples(
        self,
        bytes: &[u8],
        big: bool,
        grid: &VoxelGrid,
    ) -> Result<(Samples<'static>, u64), Error> {
        // The bytes of each number, least significant first.
        fn numbers<const N: usize>(bytes: &[u8], big: bool) -> impl ExactSizeIterator<Item = [u8; N]> {
            bytes.as_chunks::<N>().0.iter().map(move |&(mut number)| {
                if big {
                    number.reverse();
                }
                number
            })
        }
        Ok(match self {
            SampleKind::Bit => (Samples::Bits(bits(bytes, grid)?.into()), 0),
            SampleKind::I8 => (memory::collected(bytes.iter().map(|&b| i16::from(b as i8)))?.into(), 0),
            SampleKind::U8 => (memory::copied(bytes)?.into(), 0),
            SampleKind::I16 => (memory::collected(numbers(bytes, big).map(i16::from_le_bytes))?.into(), 0),
            SampleKind::U16 => (memory::collected(numbers(bytes, big).map(u16::from_le_bytes))?.into(), 0),
            SampleKind::F32 => (memory::collected(numbers(bytes, big).map(f32::from_le_bytes))?.into(), 0),
            SampleKind::I32 => singles(numbers(bytes, big).map(|n| i32::from_le_bytes(n).into()))?,
            SampleKind::U32 => singles(numbers(bytes, big).map(|n| u32::from_le_bytes(n).into()))?,
            SampleKind::I64 => wide(numbers(bytes, big).map(|n| i64::from_le_bytes(n).into()))?,
            SampleKind::U64 => wide(numbers(bytes, big).map(|n| u64::from_le_bytes(n).into()))?,
            SampleKind::F64 => singles(numbers(bytes, big).map(f64::from_le_bytes))?,
        })
    }

    /// Parses samples of a text, separated by white space or commas.
    pub(super) fn parsed(self, text: &[u8], grid: &VoxelGrid) -> Result<(Samples<'static>, u64), Error> {
        // Each number but the last is followed by a separator.
        if grid.count() > (text.len() as u64).div_ceil(2) {
            let (expected, found) = (2 * grid.count() - 1, text.len() as u64);
            return Err(VolumeFileError::Length { expected, found }.into());
        }
        let count = usize::try_from(grid.count()).map_err(|_| Error::OutOfMemory)?;
        let mut words = text
            .split(|&b| b.is_ascii_whitespace() || b == b',')
            .filter(|word| !word.is_empty())
            .map(|word| core::str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok()));
        let mut numbers = memory::with_capacity(count)?;
        for index in 0..count as u64 {
            let number = words.next().flatten().filter(|&number| self.has(number));
            numbers.push(number.ok_or(VolumeFileError::Sample { index })?);
        }
        if words.next().is_some() {
            return Err(VolumeFileError::Sample { index: count as u64 }.into());
        }
        let numbers = numbers.into_iter();
        Ok(match self {
            SampleKind::U8 => (memory::collected(numbers.map(|x| x as u8))?.into(), 0),
            SampleKind::U16 => (memory::collected(numbers.map(|x| x as u16))?.into(), 0),
            SampleKind::I8 | SampleKind::I16 => (memory::collected(numbers.map(|x| x as i16))?.into(), 0),
            _ => singles(numbers)?,
        })
    }

    /// Returns whether this type can represent a number.
    fn has(self, number: f64) -> bool {
        let (least, beyond) = match self {
            SampleKind::Bit => (0.0, 2.0),
            SampleKind::I8 => (-128.0, 128.0),
            SampleKind::U8 => (0.0, 256.0),
            SampleKind::I16 => (-32_768.0, 32_768.0),
            SampleKind::U16 => (0.0, 65_536.0),
            SampleKind::I32 => (-2_147_483_648.0, 2_147_483_648.0),
            SampleKind::U32 => (0.0, 4_294_967_296.0),
            SampleKind::I64 => (-9_223_372_036_854_775_808.0, 9_223_372_036_854_775_808.0),
            SampleKind::U64 => (0.0, 18_446_744_073_709_551_616.0),
            SampleKind::F32 | SampleKind::F64 => return true,
        };
        least <= number && number < beyond && number % 1.0 == 0.0
    }
}

/// Packs rows of bytes into rows of words.
fn bits(bytes: &[u8], grid: &VoxelGrid) -> Result<Vec<u64>, Error> {
    let [nx, ny, nz] = grid.extents().each(|extent| extent as usize);
    let mut words = memory::with_capacity(grid.words() * ny * nz)?;
    for row in bytes.chunks(nx.div_ceil(8)) {
        for few in row.chunks(8) {
            words.push(few.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte)));
        }
    }
    Ok(words)
}

/// Rounds numbers to single precision, and returns the number of numbers that changed.
fn singles(numbers: impl ExactSizeIterator<Item = f64>) -> Result<(Samples<'static>, u64), Error> {
    let mut rounded = 0;
    let singles = memory::collected(numbers.map(|number| {
        let single = number as f32;
        rounded += u64::from(f64::from(single) != number && !number.is_nan());
        single
    }))?;
    Ok((singles.into(), rounded))
}

/// Does the same for integers that doubles cannot hold.
fn wide(numbers: impl ExactSizeIterator<Item = i128>) -> Result<(Samples<'static>, u64), Error> {
    let mut rounded = 0;
    let singles = memory::collected(numbers.map(|number| {
        let single = number as f32;
        rounded += u64::from(single as i128 != number);
        single
    }))?;
    Ok((singles.into(), rounded))
}
