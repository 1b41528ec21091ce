//! Verdicts of eight cells at once, and Kleene's logic on them.

use crate::octree::Tag;
use crate::solid::csg::Join;
use crate::solid::half_space::bounds::Sides;
use alloc::vec::Vec;

/// The verdicts of eight cells: bit k of `lower` is set if cell k is surely solid, bit k of `upper` if it is
/// possibly solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Kleene {
    pub(crate) lower: u8,
    pub(crate) upper: u8,
}

impl Kleene {
    pub(crate) const FULL: Kleene = Kleene { lower: 0xFF, upper: 0xFF };
    pub(crate) const EMPTY: Kleene = Kleene { lower: 0, upper: 0 };
    pub(crate) const UNKNOWN: Kleene = Kleene { lower: 0, upper: 0xFF };

    #[inline(always)]
    pub(crate) fn complemented(self, complement: bool) -> Kleene {
        if complement { Kleene { lower: !self.upper, upper: !self.lower } } else { self }
    }

    #[inline(always)]
    pub(crate) fn and(self, other: Kleene) -> Kleene {
        Kleene { lower: self.lower & other.lower, upper: self.upper & other.upper }
    }

    #[inline(always)]
    pub(crate) fn or(self, other: Kleene) -> Kleene {
        Kleene { lower: self.lower | other.lower, upper: self.upper | other.upper }
    }

    #[inline(always)]
    pub(crate) fn xor(self, other: Kleene) -> Kleene {
        let known = self.decided() & other.decided();
        let value = self.lower ^ other.lower;
        Kleene { lower: value & known, upper: value | !known }
    }

    #[inline(always)]
    pub(crate) fn decided(self) -> u8 {
        self.lower | !self.upper
    }

    #[inline(always)]
    pub(crate) fn partial(self) -> u8 {
        self.upper & !self.lower
    }

    /// Removes the last `count` operands, and returns their join.
    pub(crate) fn join_last(operands: &mut Vec<Kleene>, join: Join, count: u32) -> Kleene {
        let first = operands.len() - count as usize;
        let kleene = Kleene::join(join, &operands[first..]);
        operands.truncate(first);
        kleene
    }

    fn join(join: Join, operands: &[Kleene]) -> Kleene {
        let fold = |start, step: fn(Kleene, Kleene) -> Kleene| operands.iter().copied().fold(start, step);
        match join {
            Join::Intersection => fold(Kleene::FULL, Kleene::and),
            Join::Union => fold(Kleene::EMPTY, Kleene::or),
            Join::Parity => fold(Kleene::EMPTY, Kleene::xor),
        }
    }

    #[inline(always)]
    pub(crate) fn of(sides: Sides, complement: bool) -> Kleene {
        Kleene { lower: sides.inside, upper: !sides.outside }.complemented(complement)
    }

    pub(crate) fn of_tags(tags: [Tag; 8]) -> Kleene {
        let mut kleene = Kleene::EMPTY;
        for (k, tag) in tags.iter().enumerate() {
            kleene.lower |= (tag.lower() as u8) << k;
            kleene.upper |= (tag.upper() as u8) << k;
        }
        kleene
    }
}
