//! The stored properties of a tri-dexel model, in one byte.

use crate::dexel::{DexelEnds, DexelFormat, DexelNormals};
use crate::lattice::Each;

/// The stored properties of intervals, and the directions that have rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Form {
    pub format: DexelFormat,
    pub directions: [bool; 3],
}

/// Set if ends are doubles; part of the format, like all of these bits.
const DOUBLE: u8 = 1;
/// Two bits: 0 for no normals, 1 for normals of 16 bits, 2 for normals of 32 bits.
const NORMALS_SHIFT: u32 = 1;
const SURFACES: u8 = 1 << 3;
const MATERIALS: u8 = 1 << 4;
/// Three bits, for the directions x, y and z.
const DIRECTIONS_SHIFT: u32 = 5;

impl Form {
    /// Decodes the byte; `None` for no direction, and for normals of an unknown kind.
    pub fn from_bits(bits: u8) -> Option<Form> {
        let normals = match bits >> NORMALS_SHIFT & 3 {
            0 => DexelNormals::None,
            1 => DexelNormals::Bits16,
            2 => DexelNormals::Bits32,
            _ => return None,
        };
        let directions = [0, 1, 2].each(|axis| bits >> (DIRECTIONS_SHIFT + axis) & 1 != 0);
        let ends = if bits & DOUBLE != 0 { DexelEnds::Double } else { DexelEnds::Fixed };
        let format =
            DexelFormat { ends, normals, surfaces: bits & SURFACES != 0, materials: bits & MATERIALS != 0 };
        directions.contains(&true).then_some(Form { format, directions })
    }

    pub fn bits(&self) -> u8 {
        let Form { format, directions } = self;
        let normals = match format.normals {
            DexelNormals::None => 0,
            DexelNormals::Bits16 => 1,
            DexelNormals::Bits32 => 2,
        };
        let flag = |is: bool, bit: u8| if is { bit } else { 0 };
        let axes =
            (0..3).map(|axis| u8::from(directions[axis]) << (DIRECTIONS_SHIFT + axis as u32)).sum::<u8>();
        flag(format.ends == DexelEnds::Double, DOUBLE)
            | normals << NORMALS_SHIFT
            | flag(format.surfaces, SURFACES)
            | flag(format.materials, MATERIALS)
            | axes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_byte_that_means_something_is_written_again() {
        let good =
            (0..=u8::MAX).filter(|&bits| Form::from_bits(bits).is_some_and(|form| form.bits() == bits));
        // Seven sets of directions, two single bits, two kinds of ends, three kinds of normals.
        assert_eq!(good.count(), 7 * 4 * 2 * 3);
        let refused = (0..=u8::MAX).filter(|&bits| Form::from_bits(bits).is_none());
        assert!(refused.clone().all(|bits| bits >> 5 == 0 || bits & 6 == 6));
        assert_eq!(refused.count(), 256 - 168);
    }
}
