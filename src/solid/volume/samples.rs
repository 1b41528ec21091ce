//! The samples of a volume, borrowed or shared, and the band of values that are inside.

use super::VoxelGrid;
use crate::error::Error;
use crate::lattice::Each;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;

/// An array that a volume reads, borrowed or shared with its owner. It is never copied.
pub enum SampleArray<'a, T> {
    /// A borrowed slice, which must live as long as the volume is used.
    Borrowed(&'a [T]),
    /// A value that the volume and its clones keep alive: a vector, a mapped file. It must always return the
    /// same slice.
    Shared(Arc<dyn AsRef<[T]> + Send + Sync + 'a>),
}

impl<T> SampleArray<'_, T> {
    /// The values.
    #[inline]
    pub fn values(&self) -> &[T] {
        match self {
            SampleArray::Borrowed(values) => values,
            SampleArray::Shared(owner) => owner.as_ref().as_ref(),
        }
    }
}

impl<T> Clone for SampleArray<'_, T> {
    fn clone(&self) -> Self {
        match self {
            SampleArray::Borrowed(values) => SampleArray::Borrowed(values),
            SampleArray::Shared(owner) => SampleArray::Shared(owner.clone()),
        }
    }
}

impl<T> fmt::Debug for SampleArray<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SampleArray").field("length", &self.values().len()).finish()
    }
}

impl<'a, T> From<&'a [T]> for SampleArray<'a, T> {
    fn from(values: &'a [T]) -> Self {
        SampleArray::Borrowed(values)
    }
}

impl<T: Send + Sync + 'static> From<Vec<T>> for SampleArray<'static, T> {
    fn from(values: Vec<T>) -> Self {
        SampleArray::Shared(Arc::new(values))
    }
}

/// The samples of a volume, x fastest, then y, then z.
#[derive(Debug, Clone)]
pub enum Samples<'a> {
    /// Bits with the values 0 and 1. Each row along x begins with a new word: the bit of the sample (x, y, z)
    /// is bit x mod 64 of word x / 64 + w·(y + ny·z), where w = ⌈nx / 64⌉. Other bits of a row's last word do
    /// not count. [`OctreeRef::bitmap`](crate::OctreeRef::bitmap) writes the same layout.
    Bits(SampleArray<'a, u64>),
    /// Integers from 0 to 255.
    U8(SampleArray<'a, u8>),
    /// Integers from 0 to 65 535.
    U16(SampleArray<'a, u16>),
    /// Integers from −32 768 to 32 767, as the Hounsfield units of tomography.
    I16(SampleArray<'a, i16>),
    /// Numbers of single precision. A NaN is never inside; infinite values are compared as numbers.
    F32(SampleArray<'a, f32>),
}

macro_rules! samples_of {
    ($($variant:ident($kind:ty)),*) => {$(
        impl<'a> From<&'a [$kind]> for Samples<'a> {
            fn from(values: &'a [$kind]) -> Self {
                Samples::$variant(values.into())
            }
        }

        impl From<Vec<$kind>> for Samples<'static> {
            fn from(values: Vec<$kind>) -> Self {
                Samples::$variant(values.into())
            }
        }
    )*};
}
samples_of!(U8(u8), U16(u16), I16(i16), F32(f32));

impl Samples<'_> {
    /// The number of elements of the array: words of bits, or samples.
    fn len(&self) -> usize {
        match self {
            Samples::Bits(words) => words.values().len(),
            Samples::U8(values) => values.values().len(),
            Samples::U16(values) => values.values().len(),
            Samples::I16(values) => values.values().len(),
            Samples::F32(values) => values.values().len(),
        }
    }

    /// Returns whether the array is borrowed.
    pub(super) fn is_borrowed(&self) -> bool {
        match self {
            Samples::Bits(words) => matches!(words, SampleArray::Borrowed(_)),
            Samples::U8(values) => matches!(values, SampleArray::Borrowed(_)),
            Samples::U16(values) => matches!(values, SampleArray::Borrowed(_)),
            Samples::I16(values) => matches!(values, SampleArray::Borrowed(_)),
            Samples::F32(values) => matches!(values, SampleArray::Borrowed(_)),
        }
    }

    /// The number of bytes of the array, borrowed or not.
    pub fn bytes(&self) -> usize {
        match self {
            Samples::Bits(words) => size_of_val(words.values()),
            Samples::U8(values) => size_of_val(values.values()),
            Samples::U16(values) => size_of_val(values.values()),
            Samples::I16(values) => size_of_val(values.values()),
            Samples::F32(values) => size_of_val(values.values()),
        }
    }

    /// Checks that the array has one element for each sample of a grid.
    ///
    /// # Errors
    /// [`Error::Argument`] if it does not.
    pub fn check(&self, grid: &VoxelGrid) -> Result<(), Error> {
        let [_, y, z] = grid.extents().each(u64::from);
        let (count, problem) = match self {
            Samples::Bits(_) => {
                (grid.words() as u64 * y * z, "must have ⌈nx / 64⌉ words for each of the ny · nz rows")
            }
            _ => (grid.count(), "must have nx · ny · nz elements"),
        };
        if self.len() as u64 == count { Ok(()) } else { Err(Error::Argument { name: "samples", problem }) }
    }

    /// The sample at a place of a grid; `None` beyond it.
    pub(super) fn get(&self, grid: &VoxelGrid, at: [u32; 3]) -> Option<f64> {
        let [nx, ny, nz] = grid.extents();
        let [x, y, z] = at;
        if x >= nx || y >= ny || z >= nz {
            return None;
        }
        let row = y as usize + ny as usize * z as usize;
        let i = row * nx as usize + x as usize;
        Some(match self {
            Samples::Bits(words) => {
                let word = words.values().get(row * grid.words() + x as usize / 64)?;
                f64::from((word >> (x % 64) & 1) as u8)
            }
            Samples::U8(values) => f64::from(*values.values().get(i)?),
            Samples::U16(values) => f64::from(*values.values().get(i)?),
            Samples::I16(values) => f64::from(*values.values().get(i)?),
            Samples::F32(values) => f64::from(*values.values().get(i)?),
        })
    }
}

/// The values that are inside: those from `low` to `high`, both included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    low: f64,
    high: f64,
}

impl Band {
    /// Makes the band of the values that are not less than `threshold`.
    ///
    /// # Errors
    /// [`Error::Argument`] if `threshold` is not a number.
    pub fn at_least(threshold: f64) -> Result<Band, Error> {
        Band::between(threshold, f64::INFINITY)
    }

    /// Makes the band of the values that are not greater than `threshold`.
    ///
    /// # Errors
    /// [`Error::Argument`] if `threshold` is not a number.
    pub fn at_most(threshold: f64) -> Result<Band, Error> {
        Band::between(f64::NEG_INFINITY, threshold)
    }

    /// Makes the band of the values from `low` to `high`, both included; both may be infinite.
    ///
    /// # Errors
    /// [`Error::Argument`] if one of them is not a number, or if low > high.
    pub fn between(low: f64, high: f64) -> Result<Band, Error> {
        // A comparison with NaN is false.
        if low <= high {
            return Ok(Band { low, high });
        }
        Err(Error::Argument { name: "band", problem: "must be numbers with low ≤ high" })
    }

    /// The least value that is inside.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// The greatest value that is inside.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Returns whether a value is inside.
    pub fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }
}
