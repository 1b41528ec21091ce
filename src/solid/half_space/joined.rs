//! One function of few surfaces that agrees with the values of several regions.

use super::bounds::Sides;
use super::table::{MOST, Table};
use crate::lattice::Each;

/// The values of a function that are known from regions.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Joined {
    holds: u64,
    fails: u64,
}

impl Joined {
    /// Takes in a region, in which the function has the values of a table for all combinations of signs that
    /// are possible there. Returns `false` if a region that was taken in before has another value for one of
    /// these combinations.
    pub(crate) fn take(&mut self, value: Table, possible: Table) -> bool {
        self.holds |= value.0 & possible.0;
        self.fails |= !value.0 & possible.0;
        self.holds & self.fails == 0
    }

    /// The function, and the combinations for which it is known.
    pub(crate) fn tables(&self) -> (Table, Table) {
        (Table(self.holds), Table(self.holds | self.fails))
    }
}

impl Sides {
    /// Returns the side on which cell `k` lies; `None` if the surface may cross the cell, or coincides with
    /// it.
    pub(crate) fn side(self, k: u32) -> Option<bool> {
        let [inside, outside] = [self.inside, self.outside].each(|sides| sides >> k & 1 != 0);
        (inside != outside).then_some(inside)
    }
}

impl Table {
    /// The table of a record, as a function of six surfaces.
    pub(crate) fn widened(table: u8) -> Table {
        Table(u64::from(table) * 0x0101_0101_0101_0101)
    }

    /// Returns the combinations that remain if the side of surface `i` is known.
    pub(crate) fn on_side(self, i: usize, inside: Option<bool>) -> Table {
        inside.map_or(self, |inside| Table(self.0 & Table::of(i, !inside).0))
    }

    /// Returns the places of the surfaces on which the function depends, and their number.
    pub(crate) fn needed(self) -> ([usize; MOST], usize) {
        let (mut needed, mut count) = ([0; MOST], 0);
        for i in (0..MOST).filter(|&i| self.depends_on(i)) {
            (needed[count], count) = (i, count + 1);
        }
        (needed, count)
    }

    /// Returns a table whose surface i has the number `places[i]` of another table. The function must depend
    /// on no other surfaces than these.
    pub(crate) fn spread(self, places: &[usize]) -> Table {
        if places.iter().enumerate().all(|(from, &to)| from == to) {
            return self;
        }
        // For each combination of the surfaces' signs, the places where the function holds.
        (0..1u64 << places.len()).filter(|signs| self.0 >> signs & 1 != 0).fold(Table::EMPTY, |all, signs| {
            let here = places
                .iter()
                .enumerate()
                .fold(!0, |here, (from, &to)| here & Table::of(to, signs >> from & 1 == 0).0);
            Table(all.0 | here)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_that_agree_are_one_function() {
        let [a, b] = [0, 1].map(|i| Table::of(i, false));
        // A corner, and beside it one of its faces, where the side of the other surface is known.
        let corner = Table(a.0 & b.0);
        let mut joined = Joined::default();
        assert!(joined.take(corner, Table::FULL));
        assert!(joined.take(a, Table::FULL.on_side(1, Some(true))));
        assert_eq!(joined.tables(), (corner, Table::FULL));
        // Where the side is not known, the face alone is a different function.
        assert!(!joined.take(a, Table::FULL));
        // Impossible combinations do not count.
        let mut joined = Joined::default();
        assert!(joined.take(Table(a.0 | b.0), Table::FULL.on_side(1, Some(false))));
        let (value, possible) = joined.tables();
        assert_eq!(possible, Table::of(1, true));
        assert_eq!(value.simplified(possible), a);
    }

    #[test]
    fn surfaces_in_other_places() {
        let [a, b, c] = [0, 1, 2].map(|i| Table::of(i, false).0);
        assert_eq!(Table(a & !b).spread(&[2, 0]), Table(c & !a));
        assert_eq!(Table(a & !b).spread(&[0, 1]), Table(a & !b));
        assert_eq!(Table(b | c).needed(), ([1, 2, 0, 0, 0, 0], 2));
    }
}
