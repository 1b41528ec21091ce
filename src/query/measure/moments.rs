//! Volume and its first and second moments, as integers: nothing is rounded before the end.

use crate::lattice::Cell;
use core::ops::{Add, AddAssign};

/// Which two axes each second moment is of.
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Moments of a set of cells, about a point of the lattice of half finest cells. With lengths in half finest
/// cells and volumes in finest cells they are volume, ∫x and 3·∫xy, and integers: below 2^60, 2^81 and 2^104,
/// since the universe has at most 2^20 finest cells per axis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Moments {
    pub(super) volume: i128,
    pub(super) first: [i128; 3],
    /// In the order of [`PAIRS`].
    pub(super) second: [i128; 6],
}

impl Moments {
    /// The same set's moments about `point` (half finest cells, 0 to 2^21) instead of the lattice's origin.
    pub(super) fn about(&self, point: [i128; 3]) -> Moments {
        let mut second = self.second;
        for (moment, (i, j)) in second.iter_mut().zip(PAIRS) {
            let (p, q) = (point[i], point[j]);
            *moment += 3 * (p * q * self.volume - p * self.first[j] - q * self.first[i]);
        }
        let first = [0, 1, 2].map(|axis| self.first[axis] - point[axis] * self.volume);
        Moments { volume: self.volume, first, second }
    }
}

impl Add for Moments {
    type Output = Moments;

    fn add(mut self, other: Moments) -> Moments {
        self += other;
        self
    }
}

impl AddAssign for Moments {
    fn add_assign(&mut self, other: Moments) {
        self.volume += other.volume;
        (0..3).for_each(|i| self.first[i] += other.first[i]);
        (0..6).for_each(|i| self.second[i] += other.second[i]);
    }
}

/// Sums over cells of one level: of their number, positions, and products of positions.
#[derive(Clone, Copy, Default)]
struct LevelSums {
    count: u64,
    first: [u64; 3],
    second: [u64; 6],
}

/// Positions are below 2^20, so that the products of this many cells fit into 64 bits.
const MOST: u64 = 1 << 23;

impl LevelSums {
    #[inline(always)]
    fn add(&mut self, at: [u32; 3]) {
        let at = at.map(u64::from);
        self.count += 1;
        (0..3).for_each(|i| self.first[i] += at[i]);
        for (sum, (i, j)) in self.second.iter_mut().zip(PAIRS) {
            *sum += at[i] * at[j];
        }
    }

    /// Moments of the cells, whose edge is `size` finest cells.
    fn moments(&self, size: i128) -> Moments {
        // A cell at a has its centre at c = size·(2a + 1) half finest cells; it has ∫x = size³·c,
        // 3·∫xy = 3·size³·c·c', and 3·∫x² is larger than 3·size³·c² by size⁵: that is Steiner's theorem.
        let count = self.count as i128;
        let first = self.first.map(|sum| 2 * sum as i128 + count);
        let cube = size * size * size;
        let mut second = [0; 6];
        for ((moment, sum), (i, j)) in second.iter_mut().zip(self.second).zip(PAIRS) {
            let centres = 4 * sum as i128 + first[i] + first[j] - count;
            *moment = cube * size * size * (3 * centres + if i == j { count } else { 0 });
        }
        Moments { volume: cube * count, first: first.map(|sum| cube * size * sum), second }
    }
}

/// Adds up cells of any levels.
#[derive(Clone)]
pub(super) struct Tally {
    depth: u8,
    levels: [LevelSums; crate::lattice::MAX_DEPTH as usize + 1],
    moments: Moments,
}

impl Tally {
    /// Nothing, on a lattice of this depth.
    pub(super) fn new(depth: u8) -> Tally {
        Tally { depth, levels: Default::default(), moments: Moments::default() }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, cell: Cell) {
        let level = &mut self.levels[cell.level as usize];
        level.add(cell.at);
        if level.count == MOST {
            self.flush(cell.level);
        }
    }

    #[cold]
    fn flush(&mut self, level: u8) {
        let sums = core::mem::take(&mut self.levels[level as usize]);
        self.moments += sums.moments(1 << (self.depth - level));
    }

    /// The moments of all cells that were added, about the lattice's origin.
    pub(super) fn finish(mut self) -> Moments {
        (0..=self.depth).for_each(|level| self.flush(level));
        self.moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(depth: u8, cells: &[Cell]) -> Moments {
        let mut tally = Tally::new(depth);
        cells.iter().for_each(|&cell| tally.add(cell));
        tally.finish()
    }

    #[test]
    fn a_cell_is_as_its_children() {
        for cell in [Cell::ROOT, Cell { level: 3, at: [1, 6, 4] }] {
            let children = [0, 1, 2, 3, 4, 5, 6, 7].map(|octant| cell.child(octant));
            assert_eq!(of(20, &[cell]), of(20, &children));
        }
    }

    #[test]
    fn the_largest_universe_fits() {
        let all = of(20, &[Cell::ROOT]);
        assert_eq!(all.volume, 1 << 60);
        assert_eq!(all.first, [1 << 80; 3]);
        // ∫x² = (2^21)²/3 and ∫xy = (2^21)²/4 per volume.
        assert_eq!(all.second, [1 << 102, 1 << 102, 1 << 102, 3 << 100, 3 << 100, 3 << 100]);
        let middle = all.about([1 << 20; 3]);
        assert_eq!((middle.first, middle.second), ([0; 3], [1 << 100, 1 << 100, 1 << 100, 0, 0, 0]));
    }

    #[test]
    fn sums_are_handed_on_before_they_overflow() {
        let last = (1 << 20) - 1;
        let cell = Cell { level: 20, at: [last; 3] };
        let mut tally = Tally::new(20);
        let count = MOST as i128 + 5;
        (0..count).for_each(|_| tally.add(cell));
        let c = 2 * last as i128 + 1;
        let moments = tally.finish();
        assert_eq!(moments.first, [count * c; 3]);
        assert_eq!(
            moments.second[..4],
            [count * (3 * c * c + 1); 3]
                .into_iter()
                .chain([count * 3 * c * c])
                .collect::<alloc::vec::Vec<_>>()
        );
    }
}
