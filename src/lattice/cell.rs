//! Octants of the universe as integers.

use super::array::Each;

/// An octant of the universe. At `level` the universe is divided into 2^level cells per axis, and this cell
/// has the integer position `at` (0 ≤ at < 2^level). Level 0 is the universe itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Cell {
    /// 0 for the universe, at most [`MAX_DEPTH`](crate::lattice::MAX_DEPTH).
    pub level: u8,
    /// Position in cells of this level: x, y, z.
    pub at: [u32; 3],
}

impl Cell {
    /// The universe.
    pub const ROOT: Cell = Cell { level: 0, at: [0; 3] };

    /// The child in `octant` (0 to 7; bit 0 = x, bit 1 = y, bit 2 = z).
    #[inline]
    pub fn child(self, octant: u8) -> Cell {
        let [x, y, z] = self.at;
        let o = octant as u32;
        Cell { level: self.level + 1, at: [2 * x + (o & 1), 2 * y + (o >> 1 & 1), 2 * z + (o >> 2 & 1)] }
    }

    /// The parent. The universe is its own parent.
    #[inline]
    pub fn parent(self) -> Cell {
        Cell { level: self.level.saturating_sub(1), at: self.at.each(|a| a >> 1) }
    }

    /// The cell of `level` (at most this cell's own) that contains this one.
    #[inline]
    pub(crate) fn ancestor(self, level: u8) -> Cell {
        debug_assert!(level <= self.level);
        Cell { level, at: self.at.each(|a| a >> (self.level - level)) }
    }

    /// The index of the cell among the cells of its level in Morton order: the octants from the universe
    /// down, three bits each.
    #[inline]
    pub fn morton(self) -> u64 {
        (1..=self.level).fold(0, |code, level| code << 3 | u64::from(self.ancestor(level).octant()))
    }

    /// The cell of a level with an index in Morton order; `None` unless `code` < 8^level and the level is at
    /// most [`MAX_DEPTH`](crate::lattice::MAX_DEPTH).
    pub fn from_morton(level: u8, code: u64) -> Option<Cell> {
        let is_there = level <= super::MAX_DEPTH && code >> (3 * level) == 0;
        is_there.then(|| (0..level).rev().fold(Cell::ROOT, |cell, k| cell.child((code >> (3 * k) & 7) as u8)))
    }

    /// Returns whether the cell lies in another one, or equals it.
    #[inline]
    pub(crate) fn is_in(self, other: Cell) -> bool {
        self.level >= other.level && self.ancestor(other.level) == other
    }

    /// The octant of this cell in its parent.
    #[inline]
    pub fn octant(self) -> u8 {
        let [x, y, z] = self.at;
        ((x & 1) | (y & 1) << 1 | (z & 1) << 2) as u8
    }

    /// The first cell of `level` (at least this cell's own level) inside this one.
    #[inline]
    pub fn first_at(self, level: u8) -> Cell {
        debug_assert!(level >= self.level);
        Cell { level, at: self.at.each(|a| a << (level - self.level)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_know_their_parent() {
        let cell = Cell { level: 3, at: [1, 6, 4] };
        for octant in 0..8 {
            let child = cell.child(octant);
            assert_eq!((child.parent(), child.octant(), child.level), (cell, octant, 4));
        }
        assert_eq!(Cell::ROOT.child(5).at, [1, 0, 1]);
        assert_eq!(cell.first_at(5).at, [4, 24, 16]);
        assert_eq!(Cell::from_morton(3, cell.morton()), Some(cell));
        assert_eq!((Cell::ROOT.morton(), Cell::ROOT.child(5).child(3).morton()), (0, 0o53));
        assert_eq!((Cell::from_morton(2, 64), Cell::from_morton(0, 0)), (None, Some(Cell::ROOT)));
        assert_eq!(Cell::from_morton(21, 0), None);
    }
}
