//! The operands of a large operation, grouped by place.
//!
//! An operand of a union is empty outside its box, and an operand of an intersection is full outside the box
//! of its complement. So among thousands of operands, a cell needs only those whose boxes it meets. Operands
//! smaller than the cell's children only need to be known to be there: no such operand covers a child, and
//! the levels below decide whether it is empty there. So a cell's words contain groups, which are taken apart
//! on the way down, and the first split does not visit all operands. (Finest cells are decided by every
//! operand that they meet, as without groups.)

use super::kleene::Kleene;
use super::word::{Op, Word};
use crate::error::Error;
use crate::memory;
use crate::solid::csg::Join;
use crate::solid::csg::extent::UnitBox;
use crate::solid::half_space::bounds::Octants;
use alloc::vec::Vec;
use core::ops::Range;

/// An operand of an operation that is being written.
pub(crate) struct Operand {
    /// Where its words begin. They end where the words of the next operand begin.
    pub(crate) start: usize,
    /// The bounding boxes of the operand and of its complement, if known.
    pub(crate) extent: Option<UnitBox>,
    pub(crate) opposite: Option<UnitBox>,
}

/// A group of operands, or a single operand.
struct Group {
    /// The box outside which the members change nothing.
    low: [f64; 3],
    high: [f64; 3],
    /// The longest edge of the box.
    size: f64,
    /// The operation that joins the members. Outside the box, the result of an intersection is FULL, any
    /// other result EMPTY.
    join: Join,
    members: Members,
}

enum Members {
    /// The words of a single operand.
    Words(Range<usize>),
    Groups(Range<usize>),
}

/// Operations with fewer operands are not grouped, because groups would save no time.
const FEW: usize = 16;

/// The number of members of a group.
const MEMBERS: usize = 8;

impl Group {
    /// Returns the verdicts of the group in the eight cells `at`.
    #[inline]
    fn kleene(&self, at: &Octants) -> Kleene {
        // The bits of the children in the lower and in the upper half of each axis.
        const LOWER: [u8; 3] = [0x55, 0x33, 0x0F];
        let mut met = 0xFF;
        for axis in 0..3 {
            let (low, middle) = (at.low[axis], at.low[axis] + at.half);
            let high = middle + at.half;
            if self.high[axis] <= low || self.low[axis] >= middle {
                met &= !LOWER[axis];
            }
            if self.high[axis] <= middle || self.low[axis] >= high {
                met &= LOWER[axis];
            }
        }
        match self.join {
            Join::Intersection => Kleene { lower: !met, upper: 0xFF },
            Join::Union | Join::Parity => Kleene { lower: 0, upper: met },
        }
    }

    fn meets(&self, low: [f64; 3], high: [f64; 3]) -> bool {
        (0..3).all(|axis| self.high[axis] > low[axis] && self.low[axis] < high[axis])
    }
}

/// The outcome of a group in a cell.
pub(crate) enum Taken {
    /// No operand of the group changes anything in the cell.
    Nothing,
    /// Words of one operand were written.
    Written,
}

/// All groups of an expression.
#[derive(Default)]
pub(crate) struct Groups {
    groups: Vec<Group>,
    /// The words of the grouped operands.
    grouped: Vec<Word>,
}

impl Groups {
    /// The bytes of the lists.
    pub(crate) fn bytes(&self) -> usize {
        memory::bytes_of(&self.groups) + memory::bytes_of(&self.grouped)
    }

    /// Moves the small operands at the end of `words` into groups, and writes the groups' words instead.
    /// Returns the new number of operands.
    pub(crate) fn gather(
        &mut self,
        join: Join,
        operands: &[Operand],
        words: &mut Vec<Word>,
    ) -> Result<usize, Error> {
        if operands.len() < FEW {
            return Ok(operands.len());
        }
        let first = operands[0].start;
        let mut rest: Vec<Word> = Vec::new();
        let mut found: Vec<Group> = Vec::new();
        let mut count = 0;
        for (i, operand) in operands.iter().enumerate() {
            let end = operands.get(i + 1).map_or(words.len(), |next| next.start);
            let own = &words[operand.start..end];
            let unit = match join {
                Join::Intersection => operand.opposite,
                Join::Union | Join::Parity => operand.extent,
            };
            let longest =
                |(low, high): &UnitBox| (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
            match unit {
                // Operands that do not meet the universe change nothing there.
                Some((low, high)) if (0..3).any(|axis| high[axis] <= 0.0 || low[axis] >= 1.0) => {}
                // Operands that could cover the universe are evaluated themselves, not grouped.
                Some(unit) if longest(&unit) < 0.5 => {
                    let start = self.grouped.len();
                    self.grouped.try_reserve(own.len())?;
                    self.grouped.extend_from_slice(own);
                    let members = Members::Words(start..self.grouped.len());
                    let (low, high) = unit;
                    memory::push(&mut found, Group { low, high, size: longest(&unit), join, members })?;
                }
                _ => {
                    rest.try_reserve(own.len())?;
                    rest.extend_from_slice(own);
                    count += 1;
                }
            }
        }
        words.truncate(first);
        words.try_reserve(rest.len() + MEMBERS)?;
        words.extend_from_slice(&rest);
        // In the Morton order of their middles, neighbours come together.
        found.sort_by_cached_key(|group| {
            let middle = |axis: usize| {
                let at = 0.5 * (group.low[axis] + group.high[axis]);
                // Ten bits, with two zeros before each.
                let bits = (at.clamp(0.0, 1.0) * 1023.0) as u32;
                (0..10).fold(0, |spread, bit| spread | (bits >> bit & 1) << (3 * bit))
            };
            middle(0) | middle(1) << 1 | middle(2) << 2
        });
        while found.len() > MEMBERS {
            let mut above = Vec::new();
            let mut left = found.into_iter().peekable();
            while left.peek().is_some() {
                let start = self.groups.len();
                self.groups.try_reserve(MEMBERS)?;
                self.groups.extend(left.by_ref().take(MEMBERS));
                memory::push(&mut above, self.around(join, start..self.groups.len()))?;
            }
            found = above;
        }
        for group in found {
            let index = self.groups.len() as u32;
            memory::push(&mut self.groups, group)?;
            words.push(Word::new(Op::Group { index }));
            count += 1;
        }
        Ok(count)
    }

    fn around(&self, join: Join, members: Range<usize>) -> Group {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for member in &self.groups[members.clone()] {
            for axis in 0..3 {
                low[axis] = low[axis].min(member.low[axis]);
                high[axis] = high[axis].max(member.high[axis]);
            }
        }
        let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        Group { low, high, size, join, members: Members::Groups(members) }
    }

    /// Writes the words of a group in a cell (lower and upper corner): the group itself if it is smaller than
    /// the cell's children and the children are not finest cells, otherwise the members that the cell meets.
    /// The recursion is as deep as the hierarchy.
    pub(crate) fn take_apart(
        &self,
        group: usize,
        (low, high): ([f64; 3], [f64; 3]),
        finest: bool,
        words: &mut Vec<Word>,
    ) -> Result<Taken, Error> {
        let own = &self.groups[group];
        if !own.meets(low, high) {
            return Ok(Taken::Nothing);
        }
        if !finest && own.size < 0.5 * (high[0] - low[0]) {
            memory::push(words, Word::new(Op::Group { index: group as u32 }))?;
            return Ok(Taken::Written);
        }
        match &own.members {
            Members::Words(range) => {
                let own = &self.grouped[range.clone()];
                words.try_reserve(own.len())?;
                words.extend_from_slice(own);
                Ok(Taken::Written)
            }
            Members::Groups(members) => {
                let mut count = 0;
                for member in members.clone() {
                    let taken = self.take_apart(member, (low, high), finest, words)?;
                    count += matches!(taken, Taken::Written) as u32;
                }
                if count > 1 {
                    memory::push(words, Word::new(Op::Join { join: own.join, complement: false, count }))?;
                }
                Ok(if count == 0 { Taken::Nothing } else { Taken::Written })
            }
        }
    }

    /// Returns the verdicts of a group in the eight cells `at`.
    pub(crate) fn kleene(&self, group: usize, at: &Octants) -> Kleene {
        self.groups[group].kleene(at)
    }

    /// The value of an empty group.
    pub(crate) fn neutral(&self, group: usize) -> bool {
        self.groups[group].join == Join::Intersection
    }
}
