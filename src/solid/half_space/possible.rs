//! The combinations of signs that occur in a cell.

use super::Placed;
use super::bounds::{centre, half_edge};
use super::table::{MOST, Table};
use super::tangent::Tangent;
use crate::cut::Quadratic;
use crate::lattice::Each;
use crate::lattice::{Cell, axes};

/// Returns the combinations of signs that functions may have in a cell: bit m stands for the combination in
/// which exactly the functions of the bits in m are positive. A combination is left out in two cases: a
/// function is proven to have its sign nowhere, or two functions are proven not to have their signs at one
/// point. The latter proof negates the functions that are to be negative, and finds a positive multiple of
/// the one that, added to the other, is nowhere positive. (For one quadric and one plane, or two quadrics, in
/// all of space there is such a multiple whenever no point has both signs: the S-lemma of Yakubovich, 1971.)
pub(crate) fn possible<'h>(half_spaces: impl Iterator<Item = &'h Placed>, cell: Cell) -> Table {
    met(half_spaces, cell).possible
}

/// The combinations of signs that may occur in a cell, and points where signs surely occur.
pub(crate) struct Met {
    /// The combinations that may occur.
    pub(crate) possible: Table,
    /// Masks of sample points at which each function surely is positive, and surely is negative.
    seen: [[u32; 2]; MOST],
}

impl Met {
    /// Returns whether a point with all of these signs surely exists. A sign is a function and whether it is
    /// negative.
    pub(crate) fn is_seen(&self, signs: &[(usize, bool)]) -> bool {
        signs.iter().fold(!0, |all, &(i, negative)| all & self.seen[i][usize::from(negative)]) != 0
    }
}

/// Returns the combinations of [`possible`], with the signs that surely occur.
pub(crate) fn met<'h>(half_spaces: impl Iterator<Item = &'h Placed>, cell: Cell) -> Met {
    let (mut tangents, mut closely) = ([None; MOST], [None; MOST]);
    let (centre, half) = (centre(cell), half_edge(cell));
    for ((tangent, close), half_space) in tangents.iter_mut().zip(&mut closely).zip(half_spaces) {
        *tangent = half_space.tangent(centre, half);
        *close = half_space.taylor(centre, half).map(|taylor| Close::new(taylor.f));
    }
    let mut possible = !0;
    for (i, a) in tangents.iter().enumerate() {
        for negative in [false, true] {
            if a.is_some_and(|a| is_nowhere(&a, negative)) {
                possible &= !Table::of(i, negative).0;
            }
        }
        for (j, b) in tangents.iter().enumerate().skip(i + 1) {
            let (Some(a), Some(b)) = (a, b) else { continue };
            for (negative_a, negative_b) in [(false, false), (true, false), (false, true), (true, true)] {
                let both = Table::of(i, negative_a).0 & Table::of(j, negative_b).0;
                if possible & both == 0 {
                    continue;
                }
                let is_excluded = || match (&closely[i], &closely[j]) {
                    (Some(a), Some(b)) => a.excludes(negative_a, b, negative_b),
                    _ => false,
                };
                if exclude(a, negative_a, b, negative_b) || is_excluded() {
                    possible &= !both;
                }
            }
        }
    }
    let seen = closely.each(|close| close.map_or([0; 2], |close| [close.positive, close.negative]));
    Met { possible: Table(possible), seen }
}

/// A function to second order, with masks of the 27 sample points (the vertices, the middles of edges and
/// faces, and the centre of the cell) at which it surely is positive, and surely is negative.
#[derive(Clone, Copy)]
struct Close {
    f: Quadratic,
    positive: u32,
    negative: u32,
}

impl Close {
    fn new(f: Quadratic) -> Close {
        let slack = f.error + 16.0 * f64::EPSILON * f.size();
        let (mut positive, mut negative) = (0, 0);
        let at = |i: u32| [i % 3, i / 3 % 3, i / 9].each(|k| f64::from(k) - 1.0);
        for i in 0..27 {
            let [x, y, z] = at(i);
            let ([a, b, c], [xx, yy, zz, xy, xz, yz]) = (f.gradient, f.squares);
            let value = f.value
                + x * (a + x * xx + 2.0 * (y * xy + z * xz))
                + y * (b + y * yy + 2.0 * z * yz)
                + z * (c + z * zz);
            positive |= u32::from(value > slack) << i;
            negative |= u32::from(value < -slack) << i;
        }
        Close { f, positive, negative }
    }

    /// Returns whether no point of the cell has both functions positive (negated as the flags say).
    fn excludes(&self, negative_self: bool, other: &Close, negative_other: bool) -> bool {
        let at = |close: &Close, negative: bool| if negative { close.negative } else { close.positive };
        if at(self, negative_self) & at(other, negative_other) != 0 {
            return false;
        }
        let signed = |f: &Quadratic, negative: bool| if negative { f.complement() } else { *f };
        let (a, b) = (signed(&self.f, negative_self), signed(&other.f, negative_other));
        // For surfaces that are offsets of each other, the terms of second order, or the gradients, cancel at
        // one factor.
        if [a.cancelled(&b, 3..9), a.cancelled(&b, 0..3)]
            .into_iter()
            .flatten()
            .any(|share| greatest(&a, &b, share) <= 0.0)
        {
            return true;
        }
        // The greatest value of the sum is a convex function of the factor, so that it has one minimum.
        let scale = libm::log2(a.size() / b.size());
        let (mut low, mut high) = (scale - 8.0, scale + 8.0);
        let most = |share: f64| greatest(&a, &b, libm::exp2(share));
        let golden = 0.618_033_988_749_894_9;
        let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
        let (mut at_left, mut at_right) = (most(left), most(right));
        for _ in 0..16 {
            if at_left <= 0.0 || at_right <= 0.0 {
                return true;
            }
            if at_left < at_right {
                (high, right, at_right) = (right, left, at_left);
                left = high - golden * (high - low);
                at_left = most(left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + golden * (high - low);
                at_right = most(right);
            }
        }
        false
    }
}

impl Quadratic {
    /// Returns the factor at which the largest of some coefficients of the other function cancels that of
    /// this one: coefficients 0 to 2 are the gradient, 3 to 8 the second order. `None` if both have the same
    /// sign, or there is none.
    fn cancelled(&self, other: &Quadratic, factors: core::ops::Range<usize>) -> Option<f64> {
        let factor = |f: &Quadratic, k: usize| if k < 3 { f.gradient[k] } else { f.squares[k - 3] };
        let greatest = factors.max_by(|&i, &k| factor(other, i).abs().total_cmp(&factor(other, k).abs()))?;
        let share = -factor(self, greatest) / factor(other, greatest);
        (share > 0.0 && share.is_finite()).then_some(share)
    }
}

/// Returns no less than the greatest value of a function plus a multiple of another in the cell.
fn greatest(a: &Quadratic, b: &Quadratic, share: f64) -> f64 {
    let sum = |a: f64, b: f64| a + share * b;
    let (value, error) = (sum(a.value, b.value), sum(a.error, b.error));
    let mut most = value;
    for axis in 0..3 {
        let slope = sum(a.gradient[axis], b.gradient[axis]).abs();
        let bend = sum(a.squares[axis], b.squares[axis]);
        // A concave parabola has its maximum inside, or at the end like all others.
        let is_hill = bend < 0.0 && slope < -2.0 * bend;
        most += if is_hill { 0.25 * slope * slope / -bend } else { slope + bend };
    }
    for mixed in 3..6 {
        most += 2.0 * sum(a.squares[mixed], b.squares[mixed]).abs();
    }
    // At most ten roundings a term.
    most + error + 32.0 * f64::EPSILON * sum(a.size(), b.size())
}

/// A linear function above a function, or above its negative if `negative`: factors and constant.
fn above(t: &Tangent, negative: bool) -> ([f64; 3], f64) {
    if negative { (t.gradient.each(|c| -c), -t.low) } else { (t.gradient, t.high) }
}

/// Returns whether a function is nowhere positive in the cell, or nowhere negative if `negative`.
fn is_nowhere(t: &Tangent, negative: bool) -> bool {
    let (n, p) = above(t, negative);
    let reach: f64 = n.iter().map(|c| c.abs()).sum();
    // (NaN does not compare as less.)
    p + reach + 8.0 * f64::EPSILON * (p.abs() + reach) <= 0.0
}

/// Returns whether no point of the cell has both functions positive (negated as the flags say).
fn exclude(a: &Tangent, negative_a: bool, b: &Tangent, negative_b: bool) -> bool {
    let ((n, p), (m, q)) = (above(a, negative_a), above(b, negative_b));
    let dot = |u: &[f64; 3], v: &[f64; 3]| (u[0] * v[0] + u[1] * v[1]) + u[2] * v[2];
    let share = -dot(&n, &m) / dot(&m, &m);
    if !(share > 0.0 && share.is_finite()) {
        return false;
    }
    let rest: f64 = axes(|k| (n[k] + share * m[k]).abs()).iter().sum();
    let most = (p + share * q) + rest;
    // At most eight roundings a term.
    let size: f64 = p.abs() + share * q.abs() + axes(|k| n[k].abs() + share * m[k].abs()).iter().sum::<f64>();
    // (NaN does not compare as less.)
    most + 16.0 * f64::EPSILON * size <= 0.0
}

impl Table {
    /// Returns the function on the possible combinations, with as few half-spaces as possible. Among several
    /// smallest choices, the choice whose last half-spaces have the lowest numbers is taken. An impossible
    /// combination gets the value of the possible combination that comes first in this order: by the number
    /// of the last half-space whose sign differs, then by the number of the one before, and so on.
    ///
    /// So the result depends only on the values at possible combinations, and the complement of the function
    /// has the complement of the result.
    pub(crate) fn simplified(self, possible: Table) -> Table {
        let counts = |i: usize| self.depends_on(i) || possible.depends_on(i);
        let all = (0..MOST).filter(|&i| counts(i)).fold(0u8, |all, i| all | 1 << i);
        let fewest = (BY_SIZE.iter().filter(|&&kept| kept & !all == 0))
            .find_map(|&kept| self.without(possible, all & !kept));
        // (All half-spaces together are always a choice.)
        let (Table(mut table), Table(mut possible)) = fewest.unwrap_or((self, possible));
        for i in 0..MOST {
            let ((on, off), (can_on, can_off)) = (signs(table, i), signs(possible, i));
            let (on, off) = (on & can_on | off & !can_on, off & can_off | on & !can_off);
            table = off | on << (1 << i);
            let can = can_on | can_off;
            possible = can | can << (1 << i);
        }
        Table(table)
    }

    /// Returns the function without some half-spaces, and the possible combinations of the others; `None` if
    /// the function depends on them.
    fn without(self, possible: Table, half_spaces: u8) -> Option<(Table, Table)> {
        let (mut table, mut possible) = (self.0, possible.0);
        for i in (0..MOST).filter(|&i| half_spaces >> i & 1 != 0) {
            let ((on, off), (can_on, can_off)) = (signs(table, i), signs(possible, i));
            if (on ^ off) & can_on & can_off != 0 {
                return None;
            }
            let (value, can) = (on & can_on | off & can_off, can_on | can_off);
            table = value | value << (1 << i);
            possible = can | can << (1 << i);
        }
        Some((Table(table), Table(possible)))
    }
}

/// The values, or possibilities, of both signs of half-space `i`, at the places of the negative sign.
fn signs(bits: u64, i: usize) -> (u64, u64) {
    ((bits & Table::of(i, false).0) >> (1 << i), bits & Table::of(i, true).0)
}

/// All choices of half-spaces, the smallest first.
const BY_SIZE: [u8; 1 << MOST] = {
    let mut all = [0; 1 << MOST];
    let (mut size, mut next) = (0, 0);
    while size <= MOST as u32 {
        let mut choice = 0u8;
        while choice < 1 << MOST {
            if choice.count_ones() == size {
                all[next] = choice;
                next += 1;
            }
            choice += 1;
        }
        size += 1;
    }
    all
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_of_as_few_half_spaces_as_there_are() {
        let [a, b, c] = [0, 1, 2].map(|i| Table::of(i, false).0);
        // With a within b: a ∧ b is a, a ∨ b is b, and ¬a ∨ b is all.
        let within = Table(!(a & !b));
        assert_eq!(Table(a & b).simplified(within), Table(a));
        assert_eq!(Table(a | b).simplified(within), Table(b));
        assert_eq!(Table(!a | b).simplified(within), Table::FULL);
        assert_eq!(Table(a & !b).simplified(within), Table::EMPTY);
        assert_eq!(Table(a & b & c).simplified(within), Table(a & c));
        // Removing half-spaces one by one in any order misses this: a alone, or c alone, could replace b.
        let either = Table(a & !b & c | !a & b & !c | !a & !b & !c);
        let simple = Table(a & !b & c).simplified(either);
        assert_eq!((0..6).filter(|&i| simple.depends_on(i)).count(), 1);
        // The values at possible combinations never change.
        for bits in 0..=255u64 {
            for can in 1..=255u64 {
                let wide = |bits: u64| bits * 0x0101_0101_0101_0101;
                let simple = Table(wide(bits)).simplified(Table(wide(can)));
                assert_eq!((simple.0 ^ wide(bits)) & wide(can), 0, "{bits:b} {can:b}");
                // Other values do not matter, and complements stay complements.
                assert_eq!(Table(wide(bits & can)).simplified(Table(wide(can))), simple);
                assert_eq!(Table(!wide(bits)).simplified(Table(wide(can))), Table(!simple.0));
                assert_eq!(simple.simplified(Table(wide(can))), simple);
            }
        }
    }
}
