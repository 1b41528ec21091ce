//! The linear octree code of a cell.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, MAX_DEPTH};
use core::fmt;

/// The linear octree code of a cell: its octants from the root to the cell, one octal digit each, followed by
/// zeros up to a fixed length, the depth of the lattice. So it is also the Morton code of the cell's minimum
/// corner on the finest lattice. The number of significant digits is the cell's level.
///
/// In a digit bit 0 is x, bit 1 is y, bit 2 is z. Codes are ordered as the cells are in Morton order, with a
/// cell before the cells in it.
///
/// ```
/// use leafless::{Cell, voxel::LinearCode};
/// let code = LinearCode::new(Cell { level: 3, at: [1, 2, 7] }, 5)?;
/// assert_eq!((code.to_string().as_str(), code.number()), ("46500", 0o46500));
/// assert_eq!((code.digit(0), code.digit(1), code.digit(2)), (4, 6, 5));
/// assert_eq!(LinearCode::parse("46500", 3)?, code);
/// assert_eq!(code.cell().at, [1, 2, 7]);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinearCode {
    number: u64,
    level: u8,
    depth: u8,
}

impl LinearCode {
    /// Makes the code of `cell` on a lattice of `depth` levels.
    ///
    /// # Errors
    /// [`Error::Argument`] if `depth` exceeds [`MAX_DEPTH`], or if the cell lies outside the universe or is
    /// finer than the lattice.
    pub fn new(cell: Cell, depth: u8) -> Result<LinearCode, Error> {
        let refused = |name, problem| Err(Error::Argument { name, problem });
        if depth > MAX_DEPTH {
            return refused("depth", "must be at most 20");
        }
        if cell.level > depth || cell.at.iter().any(|&a| a >> cell.level != 0) {
            return refused("cell", "lies outside of the universe, or is finer than the finest cells");
        }
        Ok(LinearCode { number: number_of(cell, depth), level: cell.level, depth })
    }

    /// Makes the code with this number, of a cell of `level`.
    ///
    /// # Errors
    /// [`Error::Argument`] unless `level` ≤ `depth` ≤ [`MAX_DEPTH`], the number has at most `depth` digits,
    /// and the digits beyond the first `level` are zero.
    pub fn from_number(number: u64, level: u8, depth: u8) -> Result<LinearCode, Error> {
        if depth > MAX_DEPTH {
            return Err(Error::Argument { name: "depth", problem: "must be at most 20" });
        }
        if level > depth {
            return Err(Error::Argument { name: "level", problem: "must be at most the depth" });
        }
        if number >> (3 * depth) != 0 || number & (size(level, depth) - 1) != 0 {
            let problem =
                "must have as many octal digits as there are levels, and zeros beyond the cell's own";
            return Err(Error::Argument { name: "code", problem });
        }
        Ok(LinearCode { number, level, depth })
    }

    /// Parses the text form. The first `level` digits are significant.
    ///
    /// # Errors
    /// As [`from_number`](Self::from_number); also if the text does not consist of 0 to 20 octal digits.
    pub fn parse(text: &str, level: u8) -> Result<LinearCode, Error> {
        let octal = text.bytes().all(|digit| (b'0'..=b'7').contains(&digit));
        if text.len() > MAX_DEPTH as usize || !octal {
            return Err(Error::Argument { name: "code", problem: "must be 0 to 20 octal digits" });
        }
        let number = text.bytes().fold(0, |number, digit| number << 3 | u64::from(digit - b'0'));
        LinearCode::from_number(number, level, text.len() as u8)
    }

    /// All digits as one number: the sort key of voxel records.
    pub fn number(self) -> u64 {
        self.number
    }

    /// The cell's level: the number of significant digits.
    pub fn level(self) -> u8 {
        self.level
    }

    /// The depth of the lattice: the number of digits.
    pub fn depth(self) -> u8 {
        self.depth
    }

    /// The octant on the path from level `k` to level `k + 1`; 0 beyond the significant digits.
    pub fn digit(self, k: u8) -> u8 {
        if k < self.level { (self.number >> (3 * (self.depth - 1 - k)) & 7) as u8 } else { 0 }
    }

    /// The cell.
    pub fn cell(self) -> Cell {
        cell_of(self.number, self.level, self.depth)
    }

    /// The code of the parent. The universe is its own parent.
    #[must_use]
    pub fn parent(self) -> LinearCode {
        let level = self.level.saturating_sub(1);
        LinearCode { number: self.number & !(size(level, self.depth) - 1), level, ..self }
    }

    /// Returns whether the other cell, of the same lattice, lies in this one or equals it.
    pub fn contains(self, other: LinearCode) -> bool {
        let inside = other.number & !(size(self.level, self.depth) - 1) == self.number;
        self.depth == other.depth && self.level <= other.level && inside
    }
}

/// Writes the digits, as many as the lattice has levels.
impl fmt::Display for LinearCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits: [u8; MAX_DEPTH as usize] = core::array::from_fn(|k| b'0' + self.digit(k as u8));
        f.write_str(core::str::from_utf8(&digits[..self.depth.into()]).unwrap_or_default())
    }
}

/// The number of finest cells in a cell of `level`: the range of its codes.
#[inline(always)]
pub(super) fn size(level: u8, depth: u8) -> u64 {
    1 << (3 * (depth - level))
}

/// The number of a valid cell.
#[inline(always)]
pub(super) fn number_of(cell: Cell, depth: u8) -> u64 {
    let [x, y, z] = cell.at.each(|a| spread(a as u64));
    (x | y << 1 | z << 2) << (3 * (depth - cell.level))
}

/// The cell of a valid number.
#[inline(always)]
pub(super) fn cell_of(number: u64, level: u8, depth: u8) -> Cell {
    let own = number >> (3 * (depth - level));
    Cell { level, at: [own, own >> 1, own >> 2].each(|bits| gather(bits) as u32) }
}

/// Moves the low 21 bits to every third bit.
#[inline(always)]
fn spread(bits: u64) -> u64 {
    let bits = (bits | bits << 32) & 0x001F_0000_0000_FFFF;
    let bits = (bits | bits << 16) & 0x001F_0000_FF00_00FF;
    let bits = (bits | bits << 8) & 0x100F_00F0_0F00_F00F;
    let bits = (bits | bits << 4) & 0x10C3_0C30_C30C_30C3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

/// Moves every third bit to the low 21 bits.
#[inline(always)]
fn gather(bits: u64) -> u64 {
    let bits = bits & 0x1249_2492_4924_9249;
    let bits = (bits | bits >> 2) & 0x10C3_0C30_C30C_30C3;
    let bits = (bits | bits >> 4) & 0x100F_00F0_0F00_F00F;
    let bits = (bits | bits >> 8) & 0x001F_0000_FF00_00FF;
    let bits = (bits | bits >> 16) & 0x001F_0000_0000_FFFF;
    (bits | bits >> 32) & 0x001F_FFFF
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString;

    #[test]
    fn digits_lead_from_the_root_to_the_cell() {
        for depth in 0..=MAX_DEPTH {
            let mut cell = Cell::ROOT;
            let mut state = 88172645463325252u64;
            for level in 0..=depth {
                let code = LinearCode::new(cell, depth).unwrap();
                assert_eq!((code.cell(), code.level(), code.depth()), (cell, level, depth));
                assert_eq!(code.to_string().len(), depth as usize);
                assert_eq!(LinearCode::parse(&code.to_string(), level).unwrap(), code);
                assert_eq!(LinearCode::from_number(code.number(), level, depth).unwrap(), code);
                assert_eq!(code.parent().cell(), cell.parent());
                assert!(code.parent().contains(code) && (level == 0 || !code.contains(code.parent())));
                assert!(level == 0 || code.digit(level - 1) == cell.octant());
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                cell = cell.child((state % 8) as u8);
            }
        }
    }

    #[test]
    fn what_is_refused() {
        assert!(LinearCode::new(Cell { level: 3, at: [8, 0, 0] }, 5).is_err());
        assert!(LinearCode::new(Cell { level: 6, at: [0; 3] }, 5).is_err());
        assert!(LinearCode::new(Cell { level: 40, at: [0; 3] }, 50).is_err());
        for (number, level, depth) in
            [(0o10, 1, 1), (0o1, 0, 1), (0o11, 1, 2), (0, 3, 2), (0, 0, 21), (u64::MAX, 20, 20)]
        {
            assert!(LinearCode::from_number(number, level, depth).is_err(), "{number:o} {level} {depth}");
        }
        for text in ["8", "-1", "0 ", "000000000000000000000", "é"] {
            assert!(LinearCode::parse(text, 0).is_err(), "{text}");
        }
        assert!(LinearCode::parse("", 0).is_ok() && LinearCode::parse("", 1).is_err());
    }
}
