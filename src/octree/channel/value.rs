//! The types of a channel's values.

use crate::error::Error;
use alloc::vec::Vec;

/// The number type of a channel's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum ScalarType {
    /// Integers from 0 to 255.
    U8 = 1,
    /// Integers from 0 to 65 535.
    U16 = 2,
    /// Integers from 0 to 4 294 967 295.
    U32 = 3,
    /// Finite numbers of single precision.
    F32 = 5,
}

impl ScalarType {
    /// All number types.
    pub const ALL: [ScalarType; 4] = [ScalarType::U8, ScalarType::U16, ScalarType::U32, ScalarType::F32];

    /// Returns the bytes of a number.
    pub fn size(self) -> usize {
        match self {
            ScalarType::U8 => 1,
            ScalarType::U16 => 2,
            ScalarType::U32 | ScalarType::F32 => 4,
        }
    }

    /// Returns the name of the type: `u8`, `u16`, `u32` or `f32`.
    pub fn name(self) -> &'static str {
        match self {
            ScalarType::U8 => "u8",
            ScalarType::U16 => "u16",
            ScalarType::U32 => "u32",
            ScalarType::F32 => "f32",
        }
    }

    /// Returns the bits of the nearest number of the type: integers round half to even, and zero is positive.
    /// `None` beyond the type's range, and for NaN.
    fn encode(self, value: f64) -> Option<u32> {
        let integer = |greatest: u32| {
            let nearest = libm::rint(value);
            (0.0..=f64::from(greatest)).contains(&nearest).then_some(nearest as u32)
        };
        match self {
            ScalarType::U8 => integer(u8::MAX.into()),
            ScalarType::U16 => integer(u16::MAX.into()),
            ScalarType::U32 => integer(u32::MAX),
            ScalarType::F32 => {
                let nearest = value as f32;
                nearest.is_finite().then(|| if nearest == 0.0 { 0 } else { nearest.to_bits() })
            }
        }
    }

    fn decode(self, bits: u32) -> f64 {
        match self {
            ScalarType::F32 => f64::from(f32::from_bits(bits)),
            _ => f64::from(bits),
        }
    }
}

/// The type of a channel's values: one to four numbers of one type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ValueType {
    scalar: ScalarType,
    components: u8,
}

/// A value as the bits of its numbers; those beyond the components are 0. Equal values have equal bits.
pub(crate) type Bits = [u32; 4];

impl ValueType {
    /// Returns the type of values with `components` numbers each.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] unless `components` is 1 to 4.
    pub fn new(scalar: ScalarType, components: u8) -> Result<ValueType, Error> {
        if (1..=4).contains(&components) {
            return Ok(ValueType { scalar, components });
        }
        Err(Error::Argument { name: "components", problem: "must be 1 to 4" })
    }

    /// Returns the type of the numbers.
    pub fn scalar(self) -> ScalarType {
        self.scalar
    }

    /// Returns the number of components of a value: 1 to 4.
    pub fn components(self) -> usize {
        self.components.into()
    }

    /// Returns the bytes of a value: 1 to 16.
    pub fn size(self) -> usize {
        self.scalar.size() * self.components()
    }

    /// Returns the value that a channel of this type stores for `value`: each number rounded to the nearest
    /// one of the type, integers half to even. The numbers beyond the components do not count, and become 0.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] if a number is beyond the range of the type, infinite or not a number.
    pub fn nearest(self, value: [f64; 4]) -> Result<[f64; 4], Error> {
        Ok(self.decode(self.encode(value)?))
    }

    pub(crate) fn encode(self, value: [f64; 4]) -> Result<Bits, Error> {
        let mut bits = [0; 4];
        for (bits, &value) in bits.iter_mut().zip(&value).take(self.components()) {
            let problem = "must lie in the range of the channel's type";
            *bits = self.scalar.encode(value).ok_or(Error::Argument { name: "value", problem })?;
        }
        Ok(bits)
    }

    /// Appends a value in its form in memory.
    pub(super) fn write(self, value: Bits, out: &mut Vec<u8>) -> Result<(), Error> {
        out.try_reserve(self.size())?;
        for bits in &value[..self.components()] {
            match self.scalar {
                ScalarType::U8 => out.push(*bits as u8),
                ScalarType::U16 => out.extend_from_slice(&(*bits as u16).to_ne_bytes()),
                ScalarType::U32 | ScalarType::F32 => out.extend_from_slice(&bits.to_ne_bytes()),
            }
        }
        Ok(())
    }

    /// Returns the value with the bytes `raw` in memory.
    #[inline]
    pub(super) fn read(self, raw: &[u8]) -> Bits {
        let mut bits = [0; 4];
        for (bits, raw) in bits.iter_mut().zip(raw.chunks_exact(self.scalar.size())) {
            *bits = match *raw {
                [a] => a.into(),
                [a, b] => u16::from_ne_bytes([a, b]).into(),
                [a, b, c, d] => u32::from_ne_bytes([a, b, c, d]),
                _ => 0,
            };
        }
        bits
    }

    pub(crate) fn decode(self, bits: Bits) -> [f64; 4] {
        let mut value = [0.0; 4];
        for (value, &bits) in value.iter_mut().zip(&bits).take(self.components()) {
            *value = self.scalar.decode(bits);
        }
        value
    }
}
