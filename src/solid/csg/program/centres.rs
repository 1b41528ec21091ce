//! The centres of finest cells that lie inside.

use super::Program;
use super::kleene::Kleene;
use super::word::Op;
use super::worker::{CsgPart, Scratch};
use crate::error::Error;
use crate::lattice::Cell;
use crate::solid::csg::Join;
use crate::solid::half_space::bounds::{Octants, centre};
use crate::solid::half_space::table::Table;
use crate::solid::{Ask, Verdict, Worker};

impl Scratch {
    /// Returns which of the given grandchildren of a cell have their centre inside; `None` if this stays
    /// undecided.
    pub(crate) fn contained(
        &mut self,
        program: &Program,
        cell: Cell,
        parts: &[(u8, CsgPart)],
    ) -> Result<Option<u64>, Error> {
        if let Some(answer) = self.lone_contained(program, cell, parts)? {
            return Ok(answer);
        }
        let mut all = 0;
        for octant in parts.chunk_by(|a, b| a.0 >> 3 == b.0 >> 3) {
            let child = cell.child(octant[0].0 >> 3);
            // The centres of cells that one half-space cuts are decided together.
            let first = octant[0].1;
            let (mut inside, mut outside) = (0, 0);
            if first.len == 1
                && octant.len() > 1
                && octant.iter().all(|(_, part)| part.start == first.start)
                && let Op::HalfSpace { index, complement } =
                    Scratch::list(program, &self.words, first)[0].op()
            {
                (inside, outside) = program.half_spaces[index as usize].centres(&Octants::of(child));
                self.evaluations += octant.len() as u64;
                if complement {
                    (inside, outside) = (outside, inside);
                }
            }
            for &(c, part) in octant {
                let bit = 1u8 << (c & 7);
                if (inside | outside) & bit == 0 {
                    match self.contains(program, part, child.child(c & 7))? {
                        Some(true) => inside |= bit,
                        Some(false) => {}
                        None => return Ok(None),
                    }
                }
                all |= ((inside >> (c & 7) & 1) as u64) << (c & 63);
            }
        }
        Ok(Some(all))
    }

    /// Answers [`contained`](Self::contained), if the same operand is the only open one in all grandchildren.
    fn lone_contained(
        &mut self,
        program: &Program,
        cell: Cell,
        parts: &[(u8, CsgPart)],
    ) -> Result<Option<Option<u64>>, Error> {
        let first = match parts.first() {
            Some(&(_, part)) => self.lone(program, part)?,
            None => None,
        };
        let Some(first) = first else { return Ok(None) };
        let mut passing = core::mem::take(&mut self.passing);
        passing.clear();
        passing.try_reserve(parts.len())?;
        let mut same = true;
        for &(c, part) in parts {
            match self.lone(program, part)? {
                Some(lone) if (lone.solid, lone.complement) == (first.solid, first.complement) => {
                    passing.push((c, lone.part));
                }
                _ => same = false,
            }
        }
        let answer = if same {
            let worker = &mut Scratch::other(&mut self.workers, program, first.solid)?.worker;
            let asked = passing.iter().fold(0u64, |all, &(c, _)| all | 1 << c);
            let inside = worker.sample64(cell, &passing)?;
            Some(inside.map(|inside| if first.complement { asked & !inside } else { inside }))
        } else {
            None
        };
        self.passing = passing;
        Ok(answer)
    }

    /// Returns whether the centre of a cell lies inside, from the cell's words; `None` if this stays
    /// undecided.
    pub(crate) fn contains(
        &mut self,
        program: &Program,
        part: CsgPart,
        cell: Cell,
    ) -> Result<Option<bool>, Error> {
        let centre = centre(cell);
        let Scratch { words, operands, workers, slots, evaluations, at_hand, .. } = self;
        let words = Scratch::list(program, words, part);
        if part.is_table() {
            let (half_spaces, mut table) = Scratch::table_of(words);
            for word in half_spaces {
                let (i, index) = word.variable();
                // Earlier answers may make this one irrelevant.
                if table.depends_on(i) {
                    *evaluations += 1;
                    table = table.at(i, program.half_spaces[index as usize].contains(centre)?);
                }
            }
            return Ok(match table {
                Table::FULL => Some(true),
                Table::EMPTY => Some(false),
                _ => None,
            });
        }
        // One cell needs one bit, but all bits are set alike.
        let all = |inside: bool| if inside { Kleene::FULL } else { Kleene::EMPTY };
        operands.clear();
        operands.try_reserve(words.len())?;
        for word in words {
            let kleene = match word.op() {
                Op::HalfSpace { index, complement } => {
                    *evaluations += 1;
                    let inside = program.half_spaces[index as usize].contains(centre)?;
                    inside.map_or(Kleene::UNKNOWN, all).complemented(complement)
                }
                Op::Solid { index, complement } => {
                    let slot = (index as usize).checked_sub(program.solids.len());
                    let (solid, part) = match slot {
                        Some(slot) => (slots[slot].solid, Verdict::Partial(slots[slot].part)),
                        None => (index, Scratch::other(workers, program, index)?.root),
                    };
                    let inside = match part {
                        Verdict::Partial(part) => match at_hand.sample(solid) {
                            Some(inside) => inside,
                            None => Scratch::other(workers, program, solid)?.worker.sample(cell, &part)?,
                        },
                        _ => None,
                    };
                    inside.map_or(Kleene::UNKNOWN, all).complemented(complement)
                }
                Op::Unknown | Op::Group { .. } => Kleene::UNKNOWN,
                Op::Join { join, complement, count } => {
                    Kleene::join_last(operands, join, count).complemented(complement)
                }
                Op::Primitive { count } => Kleene::join_last(operands, Join::Intersection, count),
            };
            operands.push(kleene);
        }
        Ok(match operands.pop() {
            Some(Kleene::FULL) => Some(true),
            Some(Kleene::EMPTY) => Some(false),
            _ => None,
        })
    }
}
