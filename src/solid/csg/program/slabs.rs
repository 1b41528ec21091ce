//! Slabs and moments of a cell, from the half-spaces and other solids that are open there.

use super::Program;
use super::word::{Op, Word};
use super::worker::{CsgPart, Scratch};
use crate::error::Error;
use crate::lattice::{Cell, CellMoments};
use crate::memory;
use crate::solid::csg::Join;
use crate::solid::half_space::function;
use crate::solid::half_space::literals::Literals;
use crate::solid::{Ask, Enclosure};
use alloc::vec::Vec;

impl Scratch {
    /// Returns the enclosure from the half-spaces that are open in a cell. One to three half-spaces under one
    /// operation give a slab each. In other expressions, the half-spaces that contain the solid, or lie in
    /// it, bound it from one side.
    fn slabs_of_half_spaces(&self, program: &Program, cell: Cell, part: CsgPart) -> Option<Enclosure> {
        self.literals(program, part)?.enclosure(&program.half_spaces, cell)
    }

    /// Returns the moments of the solid in a cell, if more is known of them than slabs give.
    pub(crate) fn moments(&self, program: &Program, cell: Cell, part: CsgPart) -> Option<CellMoments> {
        if program.paper || !part.is_table() {
            return self.literals(program, part)?.moments(&program.half_spaces, cell);
        }
        let (half_spaces, table) = Scratch::table_of(Scratch::list(program, &self.words, part));
        let variables = half_spaces.iter().map(|word| word.variable());
        function::moments(variables, table, &program.half_spaces, cell)
    }

    /// Returns the enclosure from the open operands of a cell, of any kind, joined by the cell's words. An
    /// operand without an enclosure leaves one side open, and so do more slabs than there is room for.
    #[inline]
    pub(crate) fn slabs(
        &mut self,
        program: &Program,
        cell: Cell,
        part: CsgPart,
    ) -> Result<Option<Enclosure>, Error> {
        if program.solids.is_empty() {
            return Ok(self.slabs_of_half_spaces(program, cell, part));
        }
        self.joined_slabs(program, cell, part)
    }

    #[inline(never)]
    fn joined_slabs(
        &mut self,
        program: &Program,
        cell: Cell,
        part: CsgPart,
    ) -> Result<Option<Enclosure>, Error> {
        let words = Scratch::list(program, &self.words, part);
        let is_solid = |word: &Word| matches!(word.op(), Op::Solid { .. });
        if program.paper || part.is_table() || !words.iter().any(is_solid) {
            return Ok(self.slabs_of_half_spaces(program, cell, part));
        }
        // An operand that stays undecided leaves most of the cell undecided, whatever the other operands
        // give.
        if words.len() > MOST_JOINED || words.iter().any(|word| matches!(word.op(), Op::Unknown)) {
            return Ok(None);
        }
        let mut stack: Vec<Option<Enclosure>> = memory::with_capacity(part.words())?;
        for i in 0..part.words() {
            let known = match Scratch::list(program, &self.words, part)[i].op() {
                Op::HalfSpace { index, complement } => {
                    Literals::one(index, complement).enclosure(&program.half_spaces, cell)
                }
                Op::Solid { index, complement } => {
                    let known = match self.slot(program, index)? {
                        Some((solid, part)) => Scratch::other(&mut self.workers, program, solid)?
                            .worker
                            .enclosure(cell, &part)?,
                        None => None,
                    };
                    if complement { known.map(|known| known.complement()) } else { known }
                }
                Op::Join { join, complement, count } => {
                    let operands = &stack[stack.len() - count as usize..];
                    let known = match join {
                        Join::Intersection => Enclosure::of_intersection(operands.iter().copied()),
                        Join::Union => {
                            let others = operands.iter().map(|known| known.map(|known| known.complement()));
                            Enclosure::of_intersection(others).map(|known| known.complement())
                        }
                        // The boundary of one operand may lie on either side of the other operand's boundary.
                        Join::Parity => (count == 1).then(|| operands[0]).flatten(),
                    };
                    stack.truncate(stack.len() - count as usize);
                    if complement { known.map(|known| known.complement()) } else { known }
                }
                Op::Unknown | Op::Group { .. } | Op::Primitive { .. } => None,
            };
            stack.push(known);
        }
        Ok(stack.pop().flatten())
    }

    /// Returns the half-spaces that are a part, or that bound it.
    pub(crate) fn literals(&self, program: &Program, part: CsgPart) -> Option<Literals> {
        if program.paper || part.len == 0 {
            return None;
        }
        let words = Scratch::list(program, &self.words, part);
        if part.is_table() {
            let (half_spaces, table) = Scratch::table_of(words);
            return Literals::of_table(half_spaces.iter().map(|word| word.variable()), table);
        }
        let [word] = words else { return None };
        let Op::HalfSpace { index, complement } = word.op() else { return None };
        Some(Literals::one(index, complement))
    }
}

/// The most words whose operands are queried for slabs one by one.
const MOST_JOINED: usize = 64;
