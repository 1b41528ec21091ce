//! Verdicts of eight cells at once, and Kleene's logic on them.

use super::Join;
use super::bounds::Sides;
use crate::octree::Tag;
use alloc::vec::Vec;

/// The verdicts of eight cells: bit k of `lower` says that cell k is surely solid, of `upper` that it is
/// possibly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Kleene {
    pub(super) lower: u8,
    pub(super) upper: u8,
}

impl Kleene {
    pub(super) const FULL: Kleene = Kleene { lower: 0xFF, upper: 0xFF };
    pub(super) const EMPTY: Kleene = Kleene { lower: 0, upper: 0 };
    pub(super) const UNKNOWN: Kleene = Kleene { lower: 0, upper: 0xFF };

    #[inline(always)]
    pub(super) fn complemented(self, complement: bool) -> Kleene {
        if complement { Kleene { lower: !self.upper, upper: !self.lower } } else { self }
    }

    #[inline(always)]
    pub(super) fn and(self, other: Kleene) -> Kleene {
        Kleene { lower: self.lower & other.lower, upper: self.upper & other.upper }
    }

    #[inline(always)]
    pub(super) fn or(self, other: Kleene) -> Kleene {
        Kleene { lower: self.lower | other.lower, upper: self.upper | other.upper }
    }

    #[inline(always)]
    pub(super) fn xor(self, other: Kleene) -> Kleene {
        let known = self.decided() & other.decided();
        let value = self.lower ^ other.lower;
        Kleene { lower: value & known, upper: value | !known }
    }

    #[inline(always)]
    pub(super) fn decided(self) -> u8 {
        self.lower | !self.upper
    }

    #[inline(always)]
    pub(super) fn partial(self) -> u8 {
        self.upper & !self.lower
    }

    /// Takes the last `count` operands, and joins them.
    pub(super) fn join_last(operands: &mut Vec<Kleene>, join: Join, count: u32) -> Kleene {
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
    pub(super) fn of(sides: Sides, complement: bool) -> Kleene {
        Kleene { lower: sides.inside, upper: !sides.outside }.complemented(complement)
    }

    pub(super) fn of_tags(tags: [Tag; 8]) -> Kleene {
        let mut kleene = Kleene::EMPTY;
        for (k, tag) in tags.iter().enumerate() {
            kleene.lower |= (tag.lower() as u8) << k;
            kleene.upper |= (tag.upper() as u8) << k;
        }
        kleene
    }
}
