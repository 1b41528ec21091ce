//! One byte for each PARTIAL cell.

/// A record of one byte: the truth table of three surfaces, even if there are fewer. A table that does not
/// depend on the last surfaces is a table of two surfaces, or of one. So the table determines the number of
/// surfaces. The tables that depend on no surface have other meanings: nothing is known, or the cell is
/// split. (Tables that depend on a surface, but not on one before it, are not used.)
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Head(pub(crate) u8);

impl Head {
    /// Nothing is known.
    pub(crate) const NONE: Head = Head(0);
    /// Eight records follow elsewhere.
    pub(crate) const SPLIT: Head = Head(0xFF);

    /// The table after all sides are known: the solid is empty.
    pub(crate) const NOWHERE: Head = Head(0);
    /// The table after all sides are known: the solid is everything.
    pub(crate) const EVERYWHERE: Head = Head(0xFF);

    /// For each surface, the table of the points where it is positive.
    const HOLDS: [u8; 3] = [0xAA, 0xCC, 0xF0];

    /// True if a table depends on a surface.
    const fn depends_on(table: u8, i: usize) -> bool {
        (table & Head::HOLDS[i]) >> (1 << i) != table & !Head::HOLDS[i]
    }

    const fn count(table: u8) -> u8 {
        let depends = [Head::depends_on(table, 0), Head::depends_on(table, 1), Head::depends_on(table, 2)];
        match depends {
            [true, true, true] => 3,
            [true, true, false] => 2,
            [true, false, false] => 1,
            [false, false, false] => 0,
            _ => Head::INVALID,
        }
    }

    const INVALID: u8 = 8;

    const COUNTS: [u8; 256] = {
        let mut counts = [0; 256];
        let mut table = 0;
        while table < 256 {
            counts[table] = Head::count(table as u8);
            table += 1;
        }
        counts
    };

    pub(crate) fn is_split(self) -> bool {
        self == Head::SPLIT
    }

    pub(crate) fn is_valid(self) -> bool {
        Head::COUNTS[usize::from(self.0)] != Head::INVALID
    }

    /// Returns the table for a known side of one of its surfaces; if all values are the same, it is no longer
    /// a table of any surface.
    pub(crate) fn on_side(table: u8, surface: usize, is_positive: bool) -> u8 {
        let (holds, shift) = (Head::HOLDS[surface], 1 << surface);
        if is_positive {
            let kept = table & holds;
            kept | kept >> shift
        } else {
            let kept = table & !holds;
            kept | kept << shift
        }
    }

    /// Returns the table of the same surfaces with one of them negated.
    pub(crate) fn negated(table: u8, surface: usize) -> u8 {
        let (holds, shift) = (Head::HOLDS[surface], 1 << surface);
        (table & holds) >> shift | (table & !holds) << shift
    }

    /// True if a table depends on a surface.
    pub(crate) fn needs(table: u8, surface: usize) -> bool {
        Head::depends_on(table, surface)
    }

    /// Returns the number of surfaces of the record; 0 for a damaged one.
    pub(crate) fn surfaces(self) -> usize {
        usize::from(Head::COUNTS[usize::from(self.0)] & 3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_tell_how_many_surfaces_there_are() {
        let count = |n: u8| (0..=255).filter(|&table| Head::COUNTS[table as usize] == n).count();
        // Functions of n bits that depend on all of them: 2, 2, 10, 218.
        assert_eq!([count(0), count(1), count(2), count(3)], [2, 2, 10, 218]);
        assert_eq!(count(Head::INVALID), 24);
        assert_eq!((Head(0xAA).surfaces(), Head(0x88).surfaces(), Head(0xF0).surfaces()), (1, 2, 0));
        for (table, surface) in (0..=255).flat_map(|table| [0, 1, 2].map(|surface| (table, surface))) {
            for is_positive in [false, true] {
                let own = Head::on_side(table, surface, is_positive);
                for m in 0..8u8 {
                    let there = if is_positive { m | 1 << surface } else { m & !(1 << surface) };
                    assert_eq!(own >> m & 1, table >> there & 1);
                }
                assert!(!Head::needs(own, surface));
            }
        }
        assert!(!Head(0xF0).is_valid() && Head::NONE.is_valid() && Head::SPLIT.surfaces() == 0);
    }
}
