//! Number types that a PLY header names.

/// The type of a number.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum NumberKind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl NumberKind {
    /// Returns the type with this name.
    pub fn of(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Converts a colour channel of this type to the range from 0 to 255.
    #[inline]
    pub fn channel(self, value: f64) -> f64 {
        match self {
            Self::F32 | Self::F64 => value * 255.0,
            Self::U16 => value / 257.0,
            _ => value,
        }
    }

    /// Returns the number of bytes of a binary number.
    #[inline]
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}
