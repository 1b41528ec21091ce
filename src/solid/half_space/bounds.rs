//! The sides of one half-space for the eight children of a cell.

use crate::lattice::Cell;
use crate::lattice::Each;
use crate::lattice::axes;
use core::cmp::Ordering;
use wide::f64x4;

/// The eight children of a cell in unit coordinates: the universe is [0, 1]³.
pub(crate) struct Octants {
    /// The cell's lower corner. (A vector would lie in memory, where it is slow to load after its parts.)
    pub(crate) low: [f64; 3],
    /// The edge of a child.
    pub(crate) half: f64,
}

impl Octants {
    /// The children of `cell`.
    #[inline(always)]
    pub(crate) fn of(cell: Cell) -> Octants {
        let edge = edge(cell.level as u32);
        Octants { low: cell.at.each(|i| i as f64 * edge), half: 0.5 * edge }
    }

    /// [0, 2]³, whose first child is the universe.
    pub(crate) fn of_universe() -> Octants {
        Octants { low: [0.0; 3], half: 1.0 }
    }

    /// The lower corner, one lane an axis; the last lane is 0.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> f64x4 {
        let [x, y, z] = self.low;
        f64x4::new([x, y, z, 0.0])
    }

    /// The centres of the children (those of the lower, then those of the upper z), and half their edge.
    #[inline(always)]
    pub(crate) fn centres(&self) -> ([[f64x4; 3]; 2], f64) {
        let [low_x, low_y, low_z] = self.low;
        let quarter = 0.5 * self.half;
        let (x, y, z) = (low_x + quarter, low_y + quarter, low_z + quarter);
        let xs = f64x4::new([x, x + self.half, x, x + self.half]);
        let ys = f64x4::new([y, y, y + self.half, y + self.half]);
        ([[xs, ys, f64x4::splat(z)], [xs, ys, f64x4::splat(z + self.half)]], quarter)
    }

    /// The children that exist, as bits: of the universe, which is the first itself, only that one.
    pub(crate) fn all(&self) -> u8 {
        if self.half == 1.0 { 1 } else { 0xFF }
    }

    /// The lower and the upper corner of child `k`.
    pub(crate) fn octant(&self, k: u32) -> ([f64; 3], [f64; 3]) {
        let at = axes(|axis| self.low[axis] + (k >> axis & 1) as f64 * self.half);
        (at, at.each(|t| t + self.half))
    }
}

/// For each child, the sum of `constant` and one value for each axis. The values are given for the lower and
/// the upper half.
#[inline(always)]
pub(crate) fn sums(constant: f64, halves: [f64x4; 2]) -> [f64x4; 2] {
    let [first, second] = [halves[0].to_array(), halves[1].to_array()];
    let x = f64x4::new([first[0], second[0], first[0], second[0]]);
    let y = f64x4::new([first[1], first[1], second[1], second[1]]);
    let xy = (f64x4::splat(constant) + x) + y;
    [xy + f64x4::splat(first[2]), xy + f64x4::splat(second[2])]
}

/// A mask of the children for which a comparison holds.
#[inline(always)]
pub(crate) fn mask([a, b]: [f64x4; 2]) -> u8 {
    (a.to_bitmask() | b.to_bitmask() << 4) as u8
}

/// 2^-level.
fn edge(level: u32) -> f64 {
    f64::from_bits((1023 - level as u64) << 52)
}

/// The centre of a cell.
pub(crate) fn centre(cell: Cell) -> [f64; 3] {
    let half = edge(cell.level as u32 + 1);
    cell.at.each(|i| (2 * i as u64 + 1) as f64 * half)
}

/// Half the edge of a cell.
#[inline(always)]
pub(crate) fn half_edge(cell: Cell) -> f64 {
    edge(cell.level as u32 + 1)
}

/// The children (bit k) for which f ≥ 0 is proven, and those for which f ≤ 0 is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Sides {
    pub(crate) inside: u8,
    pub(crate) outside: u8,
}

impl Sides {
    /// Returns the sides that follow from the least and the greatest values, whose error is below `error`,
    /// and the children for which they leave a side open.
    #[inline(always)]
    pub(crate) fn with_error(least: [f64x4; 2], most: [f64x4; 2], error: f64) -> (Sides, u8) {
        let (above, below) = (f64x4::splat(error), f64x4::splat(-error));
        // Written out, since calls for arrays are not always inlined.
        let inside = mask([least[0].simd_ge(above), least[1].simd_ge(above)]);
        let outside = mask([most[0].simd_le(below), most[1].simd_le(below)]);
        let doubt = mask([least[0].simd_gt(below), least[1].simd_gt(below)]) & !inside
            | mask([most[0].simd_lt(above), most[1].simd_lt(above)]) & !outside;
        (Sides { inside, outside }, doubt)
    }

    /// Completes the sides for the children `doubt`, by the exact sign of the least (`Less`) and of the
    /// greatest value over a box (lower and upper corner).
    #[cold]
    pub(crate) fn settled(
        mut self,
        at: &Octants,
        doubt: u8,
        extreme_sign: impl Fn([f64; 3], [f64; 3], Ordering) -> i32,
    ) -> Sides {
        for k in (0..8).filter(|k| doubt >> k & 1 != 0) {
            let (low, high) = at.octant(k);
            if extreme_sign(low, high, Ordering::Less) >= 0 {
                self.inside |= 1 << k;
            }
            if extreme_sign(low, high, Ordering::Greater) <= 0 {
                self.outside |= 1 << k;
            }
        }
        self
    }
}
