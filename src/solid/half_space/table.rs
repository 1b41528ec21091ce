//! The truth table of an expression in a cell that few half-spaces cut.

use super::bounds::Sides;

/// The most half-spaces of a table: 2^6 combinations are the bits of one word.
pub(crate) const MOST: usize = 6;

/// A function of up to six half-spaces: bit i is its value where exactly the half-spaces with bits in i hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Table(pub(crate) u64);

/// For each half-space, the bits of the combinations in which it holds.
const HOLDS: [u64; MOST] = [
    0xAAAA_AAAA_AAAA_AAAA,
    0xCCCC_CCCC_CCCC_CCCC,
    0xF0F0_F0F0_F0F0_F0F0,
    0xFF00_FF00_FF00_FF00,
    0xFFFF_0000_FFFF_0000,
    0xFFFF_FFFF_0000_0000,
];

impl Table {
    pub(crate) const EMPTY: Table = Table(0);
    pub(crate) const FULL: Table = Table(!0);

    /// Returns half-space `i`, or its complement.
    pub(crate) fn of(i: usize, complement: bool) -> Table {
        Table(if complement { !HOLDS[i] } else { HOLDS[i] })
    }

    /// Returns the function where half-space `i` holds, or does not; the result does not depend on `i`.
    #[inline(always)]
    pub(crate) fn with(self, i: usize, holds: bool) -> Table {
        let shift = 1 << i;
        Table(if holds {
            let kept = self.0 & HOLDS[i];
            kept | kept >> shift
        } else {
            let kept = self.0 & !HOLDS[i];
            kept | kept << shift
        })
    }

    /// Returns the function with half-space `i` replaced by its complement.
    #[inline(always)]
    pub(crate) fn negated(self, i: usize) -> Table {
        let shift = 1 << i;
        Table((self.0 & HOLDS[i]) >> shift | (self.0 & !HOLDS[i]) << shift)
    }

    /// Returns whether the function depends on half-space `i`.
    #[inline(always)]
    pub(crate) fn depends_on(self, i: usize) -> bool {
        (self.0 & HOLDS[i]) >> (1 << i) != self.0 & !HOLDS[i]
    }

    /// Returns the function in cell `k`, given the known sides of half-space `i`.
    #[inline(always)]
    pub(crate) fn known(self, i: usize, sides: Sides, k: u32) -> Table {
        if sides.inside >> k & 1 != 0 {
            self.with(i, true)
        } else if sides.outside >> k & 1 != 0 {
            self.with(i, false)
        } else {
            self
        }
    }

    /// Returns the function with half-space `i` replaced by half-space `to`, or (`complement`) by its
    /// complement. Values at impossible combinations do not matter.
    pub(crate) fn renamed(self, i: usize, to: usize, complement: bool) -> Table {
        let [inside, outside] = [self.with(i, !complement), self.with(i, complement)];
        Table(inside.0 & HOLDS[to] | outside.0 & !HOLDS[to])
    }

    /// Returns the function at a point, given whether half-space `i` holds there.
    pub(crate) fn at(self, i: usize, inside: Option<bool>) -> Table {
        inside.map_or(self, |inside| self.with(i, inside))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_of_two_half_spaces() {
        for bits in 0..16u64 {
            // The same four values for all combinations of the other half-spaces.
            let table = Table((0..16).fold(0, |all, i| all | bits << (4 * i)));
            let value = |a: bool, b: bool| bits >> (a as u64 | (b as u64) << 1) & 1 != 0;
            for (a, b) in [(false, false), (false, true), (true, false), (true, true)] {
                let at = table.with(0, a).with(1, b);
                assert_eq!(at, if value(a, b) { Table::FULL } else { Table::EMPTY });
                assert_eq!(table.with(1, b).with(0, a), at);
                assert_eq!(table.with(0, a), table.with(5, b).with(0, a));
            }
            let depends = |i: usize| table.with(i, false) != table.with(i, true);
            assert!((0..MOST).all(|i| table.depends_on(i) == depends(i)));
        }
    }
}
