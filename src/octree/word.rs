//! Sixty-four tags in two words, and the set algebra on them.
//!
//! The algebra is Kleene's three-valued logic, applied to all cells of a block at once. A branch is the
//! contradictory pair (lower without upper). The plain word operations are right for branches except where a
//! branch meets PARTIAL. [`Planes::clash`] returns those cells; code that combines trees must descend there.

use super::tag::Tag;
use bytemuck::{Pod, Zeroable};

/// The tags of the 64 cells of an element, in Morton order: cell c is bit c of both words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Pod, Zeroable)]
#[repr(C)]
pub struct Planes {
    /// Surely solid.
    pub lower: u64,
    /// Possibly solid.
    pub upper: u64,
}

/// Low bit of every byte.
const LOW: u64 = 0x0101_0101_0101_0101;

/// Returns one bit per octant (in its byte's low bit) where all eight cells of `word` are set.
#[inline(always)]
const fn octants_all(word: u64) -> u64 {
    let a = word & word >> 4;
    let b = a & a >> 2;
    (b & b >> 1) & LOW
}

impl Planes {
    /// Returns 64 cells that all have `tag`.
    #[inline(always)]
    pub const fn uniform(tag: Tag) -> Planes {
        Planes { lower: if tag.lower() { !0 } else { 0 }, upper: if tag.upper() { !0 } else { 0 } }
    }

    /// Returns decided cells: `solid` are FULL, the others EMPTY.
    #[inline(always)]
    pub const fn binary(solid: u64) -> Planes {
        Planes { lower: solid, upper: solid }
    }

    /// Returns the tag of cell `c` (0 to 63).
    #[inline(always)]
    pub const fn tag(self, c: u32) -> Tag {
        Tag::from_bits(self.lower >> c & 1 != 0, self.upper >> c & 1 != 0)
    }

    /// Sets the tag of cell `c`.
    #[inline(always)]
    pub const fn set(&mut self, c: u32, tag: Tag) {
        self.lower = self.lower & !(1 << c) | (tag.lower() as u64) << c;
        self.upper = self.upper & !(1 << c) | (tag.upper() as u64) << c;
    }

    /// Returns the cells that are BRANCH.
    #[inline(always)]
    pub const fn branch(self) -> u64 {
        self.lower & !self.upper
    }

    /// Returns the cells that are PARTIAL.
    #[inline(always)]
    pub const fn partial(self) -> u64 {
        !self.lower & self.upper
    }

    /// Returns the cells that are FULL.
    #[inline(always)]
    pub const fn full(self) -> u64 {
        self.lower & self.upper
    }

    /// Returns the cells that are EMPTY.
    #[inline(always)]
    pub const fn empty(self) -> u64 {
        !self.lower & !self.upper
    }

    /// Returns the common tag of all cells of `real`; `None` if they differ or are branches. Cells outside
    /// `real` do not count.
    #[inline(always)]
    pub const fn merged(self, real: u64) -> Option<Tag> {
        let (lower, upper) = (self.lower & real, self.upper & real);
        if upper == 0 {
            if lower == 0 { Some(Tag::Empty) } else { None }
        } else if upper != real {
            None
        } else if lower == 0 {
            Some(Tag::Partial)
        } else if lower == real {
            Some(Tag::Full)
        } else {
            None
        }
    }

    /// Returns the octree's tag of octant `k`: its own tag if its eight cells agree and are no branches;
    /// otherwise BRANCH, because the octant is then an internal node.
    #[inline(always)]
    pub const fn octant(self, k: u32) -> Tag {
        match ((self.lower >> (8 * k)) as u8, (self.upper >> (8 * k)) as u8) {
            (0, 0) => Tag::Empty,
            (0, 0xFF) => Tag::Partial,
            (0xFF, 0xFF) => Tag::Full,
            _ => Tag::Branch,
        }
    }

    /// Returns the octants that are completely EMPTY, FULL and PARTIAL, as the low bits of their bytes. The
    /// others are internal nodes.
    #[inline(always)]
    pub const fn octants(self) -> [u64; 3] {
        [octants_all(self.empty()), octants_all(self.full()), octants_all(self.partial())]
    }

    /// Returns the complement. BRANCH and PARTIAL map to themselves.
    #[inline(always)]
    pub const fn complement(self) -> Planes {
        Planes { lower: !self.upper, upper: !self.lower }
    }

    /// Returns the complement if `flip`, otherwise the same cells.
    #[inline(always)]
    pub const fn complement_if(self, flip: bool) -> Planes {
        if flip { self.complement() } else { self }
    }

    /// Returns the union; wrong in the cells of [`clash`](Self::clash).
    #[inline(always)]
    pub const fn union(self, b: Planes) -> Planes {
        Planes { lower: self.lower | b.lower, upper: self.upper | b.upper }
    }

    /// Returns the intersection; wrong in the cells of [`clash`](Self::clash).
    #[inline(always)]
    pub const fn intersection(self, b: Planes) -> Planes {
        Planes { lower: self.lower & b.lower, upper: self.upper & b.upper }
    }

    /// Returns the symmetric difference; wrong in the cells of [`clash`](Self::clash), where PARTIAL is
    /// right.
    #[inline(always)]
    pub const fn xor(self, b: Planes) -> Planes {
        self.intersection(b.complement()).union(self.complement().intersection(b))
    }

    /// Returns the cells where one operand is BRANCH and the other PARTIAL.
    #[inline(always)]
    pub const fn clash(self, b: Planes) -> u64 {
        (self.lower ^ b.lower) & (self.upper ^ b.upper) & (self.lower ^ self.upper)
    }

    /// Returns the same cells, with every cell outside `real` made EMPTY.
    #[inline(always)]
    pub const fn masked(self, real: u64) -> Planes {
        Planes { lower: self.lower & real, upper: self.upper & real }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAGS: [Tag; 4] = [Tag::Empty, Tag::Branch, Tag::Partial, Tag::Full];

    /// Kleene logic on one cell; `None` where the trees below decide.
    fn oracle(a: Tag, b: Tag, op: fn(bool, bool) -> bool) -> Option<Tag> {
        let values = |tag| match tag {
            Tag::Empty => Some(&[false][..]),
            Tag::Full => Some(&[true][..]),
            Tag::Partial => Some(&[false, true][..]),
            Tag::Branch => None,
        };
        let constant = |known: &[bool], flip: bool| {
            // One operand is a branch: the cell is decided only if the other operand decides alone.
            let f = |k: bool, x: bool| if flip { op(x, k) } else { op(k, x) };
            let results = known.iter().flat_map(|&k| [f(k, false), f(k, true)]);
            let mut results = results.collect::<alloc::vec::Vec<_>>();
            results.dedup();
            (results.len() == 1).then(|| if results[0] { Tag::Full } else { Tag::Empty })
        };
        match (values(a), values(b)) {
            (Some(a), Some(b)) => {
                let mut any = [false; 2];
                for &x in a {
                    for &y in b {
                        any[op(x, y) as usize] = true;
                    }
                }
                Some(match any {
                    [true, false] => Tag::Empty,
                    [false, true] => Tag::Full,
                    _ => Tag::Partial,
                })
            }
            (Some(a), None) => constant(a, false),
            (None, Some(b)) => constant(b, true),
            (None, None) => None,
        }
    }

    #[test]
    fn every_pair_of_tags() {
        type Op = (fn(Planes, Planes) -> Planes, fn(bool, bool) -> bool);
        let ops: [Op; 4] = [
            (Planes::union, |a, b| a | b),
            (Planes::intersection, |a, b| a & b),
            (|a, b| a.intersection(b.complement()), |a, b| a & !b),
            (Planes::xor, |a, b| a ^ b),
        ];
        for (words, bits) in ops {
            for a in TAGS {
                for b in TAGS {
                    let (pa, pb) = (Planes::uniform(a), Planes::uniform(b));
                    let clash = pa.clash(pb);
                    assert_eq!(clash, if [(1, 2), (2, 1)].contains(&(a as u8, b as u8)) { !0 } else { 0 });
                    if clash == 0 {
                        let expected = oracle(a, b, bits).unwrap_or(Tag::Branch);
                        assert_eq!(words(pa, pb), Planes::uniform(expected), "{a:?} {b:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn octants_and_merging() {
        let mut planes = Planes::uniform(Tag::Full);
        assert_eq!(planes.merged(!0), Some(Tag::Full));
        planes.set(9, Tag::Partial);
        assert_eq!(planes.merged(!0), None);
        assert_eq!(planes.merged(0xFF), Some(Tag::Full));
        assert_eq!(
            (planes.octant(0), planes.octant(1), planes.tag(9)),
            (Tag::Full, Tag::Branch, Tag::Partial)
        );
        assert_eq!(planes.octants(), [0, LOW & !(1 << 8), 0]);
        let mut branches = Planes::uniform(Tag::Branch);
        assert_eq!(branches.merged(!0), None);
        assert_eq!(branches.octants(), [0; 3]);
        branches.set(63, Tag::Empty);
        assert_eq!(branches.octant(7), Tag::Branch);
        for tag in [Tag::Empty, Tag::Partial, Tag::Full] {
            assert_eq!(Planes::uniform(tag).merged(!0), Some(tag));
            assert_eq!(Planes::uniform(tag).octant(5), tag);
            assert_eq!(Tag::from_code(tag as u8), tag);
            assert_eq!(Planes::uniform(tag).complement(), Planes::uniform(tag.complement()));
        }
    }
}
