//! The slabs of a cell: what those half-spaces and other solids know of it that are open there.

use super::Program;
use super::table::{MOST, Table};
use super::word::{Op, Word};
use super::worker::{CsgPart, Scratch};
use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::solid::csg::Join;
use crate::solid::half_space::bounds::{centre, half_edge};
use crate::solid::{Ask, Enclosure, Slab, SlabJoin};
use alloc::vec::Vec;

impl Scratch {
    /// What the half-spaces that are open in a cell know of it. One to three that are joined by one operation
    /// give a slab each; of other expressions those that the solid lies in, or that lie in the solid, bound it
    /// from one side.
    fn slabs_of_half_spaces(&self, program: &Program, cell: Cell, part: CsgPart) -> Option<Enclosure> {
        let (literals, one_sided, complement) = self.literals(program, part)?;
        let enclosure = intersection(program, cell, literals, one_sided)?;
        Some(if complement { enclosure.complement() } else { enclosure })
    }

    /// What the open operands of a cell know of it, whatever they are, joined by the cell's words. Operands of which nothing is
    /// known leave one side open, and so do more slabs than there is room for.
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
        // An operand that stays undecided leaves most of the cell in doubt, whatever the others know.
        if words.len() > MOST_JOINED || words.iter().any(|word| matches!(word.op(), Op::Unknown)) {
            return Ok(None);
        }
        let mut stack: Vec<Option<Enclosure>> = memory::with_capacity(part.words())?;
        for i in 0..part.words() {
            let known = match Scratch::list(program, &self.words, part)[i].op() {
                Op::HalfSpace { index, complement } => {
                    let known = intersection(program, cell, [Some((index, false)), None, None], false);
                    if complement { known.map(|known| known.complement()) } else { known }
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
                        // The boundary of one operand may lie on either side of the other's.
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

    /// Half-spaces, or their complements, whose intersection is the part, or, if the first flag is set, contains it;
    /// if the second one is set, the part's complement is meant.
    pub(crate) fn literals(&self, program: &Program, part: CsgPart) -> Option<(Literals, bool, bool)> {
        if program.paper || part.len == 0 {
            return None;
        }
        let words = Scratch::list(program, &self.words, part);
        // A union is the complement of an intersection, so that complements have the same bits.
        if part.is_table() {
            let (half_spaces, table) = Scratch::table_of(words);
            let around = |table: Table| around(half_spaces, table);
            match around(table) {
                Some((literals, one_sided)) => Some((literals, one_sided, false)),
                None => around(Table(!table.0)).map(|(literals, one_sided)| (literals, one_sided, true)),
            }
        } else {
            let [word] = words else { return None };
            let Op::HalfSpace { index, complement } = word.op() else { return None };
            Some(([Some((index, false)), None, None], false, complement))
        }
    }
}

/// Most words whose operands are asked for slabs one by one.
const MOST_JOINED: usize = 64;

/// Up to three half-spaces, or their complements.
pub(crate) type Literals = [Option<(u32, bool)>; 3];

/// What is known of a cell of the intersection of half-spaces, or, if `one_sided`, of a solid that lies in it.
fn intersection(program: &Program, cell: Cell, literals: Literals, mut one_sided: bool) -> Option<Enclosure> {
    let (centre, half) = (centre(cell), half_edge(cell));
    let mut slabs = [Slab::NONE; 3];
    let mut count = 0;
    for (index, complement) in literals.into_iter().flatten() {
        let tangent = program.half_spaces[index as usize].tangent(centre, half);
        // Where the gradient vanishes there is no slab.
        match tangent.filter(|tangent| tangent.gradient != [0.0; 3]) {
            Some(tangent) => {
                let slab = tangent.slab();
                slabs[count] = if complement { slab.complement() } else { slab };
                count += 1;
            }
            None => one_sided = true,
        }
    }
    if one_sided {
        slabs.iter_mut().for_each(|slab| slab.inner = f64::NEG_INFINITY);
    }
    // Of several surfaces each has normals of its own.
    let cone = match literals {
        [Some((index, _)), None, None] if !one_sided => {
            program.half_spaces[index as usize].taylor(centre, half).map_or(f64::INFINITY, |f| f.cone())
        }
        _ => f64::INFINITY,
    };
    (count > 0).then_some(Enclosure { slabs, join: SlabJoin::All, cone })
}

/// Half-spaces, or their complements, in all of which the points of a table lie; with `false` if it is their
/// intersection. `None` if there is no such half-space.
fn around(half_spaces: &[Word], table: Table) -> Option<(Literals, bool)> {
    let mut literals = [None; MOST];
    let (mut all, mut count) = (Table::FULL, 0);
    for word in half_spaces {
        let (i, index) = word.variable();
        for complement in [false, true] {
            let literal = Table::of(i, complement);
            if table.0 & !literal.0 == 0 {
                literals[count] = Some((index, complement));
                all.0 &= literal.0;
                count += 1;
            }
        }
    }
    let first = [literals[0], literals[1], literals[2]];
    (count > 0).then_some((first, count > 3 || all != table))
}
