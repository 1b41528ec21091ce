//! Volume and its first and second moments, in fixed point: sums are the same in any order.
//!
//! Whole cells are counted, without any rounding. The moments of cut cells are rounded, to a 2^44th of the
//! cell. The sums include the possible error.

use crate::cut;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Cell, CubeMoments, MAX_DEPTH};
use core::ops::{Add, AddAssign, Sub};

pub(super) use crate::lattice::PAIRS;

/// Fraction bits of all moments.
pub(super) const BITS: u32 = 16;

/// The volume of the universe.
pub(super) const UNIVERSE: i128 = 1 << (3 * MAX_DEPTH as u32 + BITS);

/// Moments of a set, about a point of the lattice of half *grains*. A grain is a 2^20th of the universe's
/// edge. With lengths in half grains and volumes in grains, the moments are volume, ∫x and 3·∫xy, times
/// 2^[`BITS`]. They are integers below 2^76, 2^97 and 2^120.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Moments {
    pub(super) volume: i128,
    pub(super) first: [i128; 3],
    /// In the order of [`PAIRS`].
    pub(super) second: [i128; 6],
    /// The maximal error of the volume. The error of a moment is this times the greatest distances.
    pub(super) error: i128,
}

impl Moments {
    /// Returns the same set's moments about `point` (half grains, 0 to 2^21) instead of the lattice's origin.
    pub(super) fn about(&self, point: [i128; 3]) -> Moments {
        let mut second = self.second;
        for (moment, (i, j)) in second.iter_mut().zip(PAIRS) {
            let (p, q) = (point[i], point[j]);
            *moment += 3 * (p * q * self.volume - p * self.first[j] - q * self.first[i]);
        }
        let first = axes(|axis| self.first[axis] - point[axis] * self.volume);
        Moments { volume: self.volume, first, second, error: self.error }
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
        self.error += other.error;
    }
}

impl Sub for Moments {
    type Output = Moments;

    fn sub(mut self, other: Moments) -> Moments {
        self.volume -= other.volume;
        (0..3).for_each(|i| self.first[i] -= other.first[i]);
        (0..6).for_each(|i| self.second[i] -= other.second[i]);
        self.error += other.error;
        self
    }
}

/// Sums over cells of one level: the number, the positions, and the products of positions.
#[derive(Clone, Copy, Default)]
struct LevelSums {
    count: u64,
    first: [u64; 3],
    second: [u64; 6],
}

/// The maximal number of summands. Positions are below 2^20, so that the products of this many cells fit into
/// 64 bits.
const MOST: u64 = 1 << 23;

impl LevelSums {
    #[inline(always)]
    fn add(&mut self, at: [u32; 3]) {
        let at = at.each(u64::from);
        self.count += 1;
        (0..3).for_each(|i| self.first[i] += at[i]);
        for (sum, (i, j)) in self.second.iter_mut().zip(PAIRS) {
            *sum += at[i] * at[j];
        }
    }

    /// The moments of the cells, whose edge is `size` grains.
    fn moments(&self, size: i128) -> Moments {
        // A cell at a has its centre at c = size·(2a + 1) half finest cells. It has ∫x = size³·c, 3·∫xy =
        // 3·size³·c·c', and 3·∫x² is larger than 3·size³·c² by size⁵ (Steiner's theorem).
        let count = self.count as i128;
        let first = self.first.each(|sum| 2 * sum as i128 + count);
        let cube = size * size * size;
        let mut second = [0; 6];
        for ((moment, sum), (i, j)) in second.iter_mut().zip(self.second).zip(PAIRS) {
            let centres = 4 * sum as i128 + first[i] + first[j] - count;
            *moment = cube * size * size * (3 * centres + if i == j { count } else { 0 });
        }
        Moments {
            volume: (cube * count) << BITS,
            first: first.each(|sum| (cube * size * sum) << BITS),
            second: second.each(|sum| sum << BITS),
            error: 0,
        }
    }
}

/// Fraction bits of the moments of one cut cell, as a share of the cell.
const SHARE_BITS: u32 = 44;

/// Sums over cut cells of one level. A cell at c (half its own edges) with the shares v of the volume, m of
/// the first and s of the second moments about its centre adds v, v c, v c c', m, m c' + m' c and s.
#[derive(Clone, Copy, Default)]
struct CutSums {
    count: u64,
    volume: i128,
    first: [i128; 3],
    second: [i128; 6],
    own_first: [i128; 3],
    mixed: [i128; 6],
    own_second: [i128; 6],
}

/// The maximal number of summands, so that no sum exceeds 2^126.
const MOST_CUT: u64 = 1 << 36;

impl CutSums {
    #[inline(always)]
    fn add(&mut self, at: [u32; 3], cut: &CubeMoments) {
        // Shares are counted in 2^44 eighths of the cell's [-1, 1]³.
        const SHARE: f64 = (1u64 << SHARE_BITS) as f64 / 8.0;
        // Magnitudes are at most 2^44, which leaves the rounding one fraction bit.
        let share = |x: f64| {
            const SHIFT: f64 = (3u64 << 51) as f64;
            let shifted = x * SHARE + SHIFT;
            shifted.to_bits() as i64 - SHIFT.to_bits() as i64
        };
        let c = at.each(|i| 2 * i as i64 + 1);
        let volume = share(cut.volume);
        let first = cut.first.each(share);
        let second = cut.second.each(share);
        self.count += 1;
        self.volume += volume as i128;
        for i in 0..3 {
            self.first[i] += volume as i128 * c[i] as i128;
            self.own_first[i] += first[i] as i128;
        }
        for (k, (i, j)) in PAIRS.into_iter().enumerate() {
            self.second[k] += volume as i128 * (c[i] * c[j]) as i128;
            self.mixed[k] += first[i] as i128 * c[j] as i128 + first[j] as i128 * c[i] as i128;
            self.own_second[k] += second[k] as i128;
        }
    }

    /// The moments of the sets, where the cells' edge is 2^`log` grains.
    fn moments(&self, log: u32) -> Moments {
        // No left-shifted sum exceeds the moments of the universe.
        let scaled = |sum: i128, dimension: u32| {
            let shift = (dimension * log + BITS) as i32 - SHARE_BITS as i32;
            if shift >= 0 { sum << shift } else { sum >> -shift }
        };
        let second = |k: usize| 3 * scaled(self.second[k] + self.mixed[k] + self.own_second[k], 5);
        // The moments' own error, the rounding of their shares, and that of a shift.
        const OWN: i128 = (cut::ERROR / 8.0 * (1u64 << SHARE_BITS) as f64) as i128 + 2;
        Moments {
            volume: scaled(self.volume, 3),
            first: axes(|i| scaled(self.first[i] + self.own_first[i], 4)),
            second: [0, 1, 2, 3, 4, 5].each(second),
            error: scaled(self.count as i128 * OWN, 3) + 2,
        }
    }
}

/// A sum of cells of any levels, whole cells and cut cells.
#[derive(Clone)]
pub(super) struct Tally {
    levels: [LevelSums; MAX_DEPTH as usize + 1],
    cuts: [CutSums; MAX_DEPTH as usize + 1],
    moments: Moments,
}

impl Tally {
    /// The empty sum.
    pub(super) fn new() -> Tally {
        Tally { levels: Default::default(), cuts: Default::default(), moments: Moments::default() }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, cell: Cell) {
        let level = &mut self.levels[cell.level as usize];
        level.add(cell.at);
        if level.count == MOST {
            self.flush(cell.level);
        }
    }

    /// Adds a part of a cell, by its moments in the cell's own coordinates.
    #[inline(always)]
    pub(super) fn add_cut(&mut self, cell: Cell, cut: &CubeMoments) {
        let level = &mut self.cuts[cell.level as usize];
        level.add(cell.at, cut);
        if level.count == MOST_CUT {
            self.flush(cell.level);
        }
    }

    #[cold]
    fn flush(&mut self, level: u8) {
        let log = (MAX_DEPTH - level) as u32;
        let sums = core::mem::take(&mut self.levels[level as usize]);
        self.moments += sums.moments(1 << log);
        let cuts = core::mem::take(&mut self.cuts[level as usize]);
        if cuts.count > 0 {
            self.moments += cuts.moments(log);
        }
    }

    /// Returns the moments of all added cells, about the lattice's origin.
    pub(super) fn finish(mut self) -> Moments {
        (0..=MAX_DEPTH).for_each(|level| self.flush(level));
        self.moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(cells: &[Cell]) -> Moments {
        let mut tally = Tally::new();
        cells.iter().for_each(|&cell| tally.add(cell));
        tally.finish()
    }

    #[test]
    fn a_cell_is_as_its_children() {
        for cell in [Cell::ROOT, Cell { level: 3, at: [1, 6, 4] }] {
            let children = [0, 1, 2, 3, 4, 5, 6, 7].map(|octant| cell.child(octant));
            assert_eq!(of(&[cell]), of(&children));
        }
    }

    #[test]
    fn a_cut_that_takes_nothing_off_is_the_cell() {
        let at = |level: u8| [level as u32 % 2, (1 << level) - 1, (1 << level) / 3];
        for level in 0..=MAX_DEPTH {
            let cell = Cell { level, at: at(level) };
            let mut tally = Tally::new();
            tally.add_cut(cell, &CubeMoments::FULL);
            let (cut, whole) = (tally.finish(), of(&[cell]));
            assert!((cut.volume - whole.volume).abs() <= cut.error && cut.error > 0, "{level}");
            for i in 0..3 {
                assert!((cut.first[i] - whole.first[i]).abs() <= cut.error << 21, "{level}");
            }
            for i in 0..6 {
                assert!((cut.second[i] - whole.second[i]).abs() <= (3 * cut.error) << 42, "{level}");
            }
        }
    }

    #[test]
    fn the_largest_universe_fits() {
        let all = of(&[Cell::ROOT]);
        assert_eq!(all.volume, 1 << (60 + BITS));
        assert_eq!(all.first, [1 << (80 + BITS); 3]);
        // ∫x² = (2^21)²/3 and ∫xy = (2^21)²/4 per volume.
        let second = [1 << 102, 1 << 102, 1 << 102, 3 << 100, 3 << 100, 3 << 100];
        assert_eq!(all.second, second.map(|sum: i128| sum << BITS));
        let middle = all.about([1 << 20; 3]);
        let second = [1 << 100, 1 << 100, 1 << 100, 0, 0, 0].map(|sum: i128| sum << BITS);
        assert_eq!((middle.first, middle.second), ([0; 3], second));
    }

    #[test]
    fn sums_are_handed_on_before_they_overflow() {
        let last = (1 << 20) - 1;
        let cell = Cell { level: 20, at: [last; 3] };
        let mut tally = Tally::new();
        let count = MOST as i128 + 5;
        (0..count).for_each(|_| tally.add(cell));
        let c = 2 * last as i128 + 1;
        let moments = tally.finish();
        assert_eq!(moments.first, [(count * c) << BITS; 3]);
        let squares = [(count * (3 * c * c + 1)) << BITS; 3].into_iter().chain([(count * 3 * c * c) << BITS]);
        assert_eq!(moments.second[..4], squares.collect::<alloc::vec::Vec<_>>());
    }
}
