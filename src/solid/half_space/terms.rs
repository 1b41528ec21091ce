//! A function of half-spaces as a union of disjoint intersections.

use super::table::Table;
use crate::lattice::Each;

/// An intersection of up to three half-spaces: for each, `None`, or whether its complement is meant.
pub(crate) type Term = [Option<bool>; 3];

/// Disjoint intersections whose union is a function of up to three half-spaces.
#[derive(Clone, Copy)]
pub(crate) struct Terms {
    terms: [Term; Terms::MOST],
    count: usize,
    cost: u32,
}

impl Terms {
    /// The most terms: the parity of three half-spaces has four.
    const MOST: usize = 4;

    const NONE: Terms = Terms { terms: [[None; 3]; Terms::MOST], count: 0, cost: 0 };

    /// Returns the cheapest terms that are found for a function of half-spaces 0 to 2 by testing one
    /// half-space after the other, or the terms of its complement if they are cheaper; `true` for the
    /// complement. A function and its complement give the same terms. Terms with more than one `curved`
    /// half-space are expensive, because their moments are less precise.
    pub(crate) fn cheapest(table: Table, curved: [bool; 3]) -> (Terms, bool) {
        let [own, other] = [table, Table(!table.0)].each(|table| Terms::of(table, [None; 3], curved));
        // At equal cost, the function is taken that is false where no half-space holds.
        let is_other = if own.cost == other.cost { table.0 & 1 != 0 } else { other.cost < own.cost };
        if is_other { (other, true) } else { (own, false) }
    }

    /// Returns the terms of the function itself.
    pub(crate) fn exactly(table: Table) -> Terms {
        Terms::of(table, [None; 3], [false; 3])
    }

    /// Returns the terms of a function within a term. (At most three calls deep.)
    fn of(table: Table, term: Term, curved: [bool; 3]) -> Terms {
        match table {
            Table::EMPTY => return Terms::NONE,
            Table::FULL => {
                let bends = (0..3).filter(|&i| term[i].is_some() && curved[i]).count();
                let cost = 1 + if bends > 1 { 16 } else { 0 };
                return Terms { terms: [term, [None; 3], [None; 3], [None; 3]], count: 1, cost };
            }
            _ => {}
        }
        let mut best: Option<Terms> = None;
        for i in (0..3).filter(|&i| table.depends_on(i)) {
            let mut all = Terms::NONE;
            for not in [false, true] {
                let mut part = term;
                part[i] = Some(not);
                let own = Terms::of(table.with(i, !not), part, curved);
                all.cost += own.cost;
                for term in own.each() {
                    if let Some(to) = all.terms.get_mut(all.count) {
                        *to = *term;
                        all.count += 1;
                    }
                }
            }
            if best.is_none_or(|best| all.cost < best.cost) {
                best = Some(all);
            }
        }
        best.unwrap_or(Terms::NONE)
    }

    pub(crate) fn each(&self) -> impl Iterator<Item = &Term> {
        self.terms[..self.count].iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_is_the_union_of_its_terms_and_no_two_overlap() {
        for bits in 0..=255u64 {
            let table = Table(bits * 0x0101_0101_0101_0101);
            for curved in [[false; 3], [true, false, true], [true; 3]] {
                let (terms, complement) = Terms::cheapest(table, curved);
                let (opposite, flipped) = Terms::cheapest(Table(!table.0), curved);
                assert!(terms.each().eq(opposite.each()) && complement != flipped);
                for (terms, complement) in [(terms, complement), (Terms::exactly(table), false)] {
                    let mut union = 0;
                    for term in terms.each() {
                        let own = (0..3).filter_map(|i| Some(Table::of(i, term[i]?).0));
                        let own = own.fold(!0, |all, one| all & one);
                        assert_eq!(union & own, 0, "{bits:b}");
                        union |= own;
                    }
                    assert_eq!(if complement { !union } else { union }, table.0, "{bits:b}");
                }
            }
        }
        let [a, b, c] = [0, 1, 2].map(|i| Table::of(i, false).0);
        let count = |table: u64| Terms::exactly(Table(table)).each().count();
        assert_eq!([count(a & b & c), count(a ^ b), count(a & b | c), count(a ^ b ^ c)], [1, 2, 2, 4]);
    }
}
