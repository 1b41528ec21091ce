//! Rays through cell centres: their intervals inside the solid of a cell's words.

use super::Program;
use super::word::Op;
use super::worker::{CsgPart, Scratch};
use crate::dexel::Beam;
use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::solid::csg::Join;
use crate::solid::half_space::sweep::Sweep;
use alloc::vec::Vec;

/// The most half-spaces that are evaluated on every ray of a large cell. A cell with more is split first.
const FEW: usize = 8;

/// The height in levels up to which a cell is not split for that reason.
const SMALL: u8 = 3;

/// Scratch memory that is kept from cell to cell.
#[derive(Default)]
pub(crate) struct Rays {
    sweep: Sweep,
    words: Vec<Op>,
    stack: Vec<bool>,
    table: Option<u64>,
}

impl Rays {
    /// Adds the intervals of all rays of a beam in a cell. Returns `false` if the cell should be split, or if
    /// some word is not a half-space.
    pub(crate) fn find(
        &mut self,
        program: &Program,
        scratch: &Scratch,
        cell: Cell,
        part: CsgPart,
        beam: &mut Beam,
    ) -> Result<bool, Error> {
        if program.paper || !self.gather(program, scratch, part)? {
            return Ok(false);
        }
        let height = beam.depth() - cell.level;
        if self.sweep.half_spaces.len() > FEW && height > SMALL {
            return Ok(false);
        }
        let Rays { sweep, words, stack, table } = self;
        sweep.find(&program.half_spaces, beam, |inside| value(words, *table, inside, stack))?;
        Ok(true)
    }

    /// Decodes the words of a part. Returns `false` if there are words other than half-spaces and operations
    /// on them.
    fn gather(&mut self, program: &Program, scratch: &Scratch, part: CsgPart) -> Result<bool, Error> {
        let half_spaces = &mut self.sweep.half_spaces;
        half_spaces.clear();
        self.words.clear();
        self.table = None;
        let list = Scratch::list(program, &scratch.words, part);
        if part.is_table() {
            let (variables, table) = list.split_at(list.len() - 2);
            // Variables keep their numbers in the table.
            for word in variables {
                let (i, index) = word.variable();
                while half_spaces.len() <= i {
                    memory::push(half_spaces, u32::MAX)?;
                }
                half_spaces[i] = index;
            }
            self.table = Some(u64::from(table[0].bits()) | u64::from(table[1].bits()) << 32);
            return Ok(self.sweep.are_known(&program.half_spaces));
        }
        for word in list {
            let op = match word.op() {
                Op::HalfSpace { index, complement } => {
                    let known = half_spaces.iter().position(|&known| known == index);
                    let i = match known {
                        Some(i) => i,
                        None => {
                            memory::push(half_spaces, index)?;
                            half_spaces.len() - 1
                        }
                    };
                    Op::HalfSpace { index: i as u32, complement }
                }
                op @ Op::Join { .. } => op,
                _ => return Ok(false),
            };
            memory::push(&mut self.words, op)?;
        }
        Ok(!self.sweep.half_spaces.is_empty() && self.sweep.are_known(&program.half_spaces))
    }
}

/// Returns the value of the words, or of the table, at a point. `inside` says in which half-spaces the point
/// lies.
#[inline]
fn value(words: &[Op], table: Option<u64>, inside: &[bool], stack: &mut Vec<bool>) -> Result<bool, Error> {
    if let Some(table) = table {
        let index = inside.iter().enumerate().fold(0, |index, (i, &inside)| index | u32::from(inside) << i);
        return Ok(table >> index & 1 != 0);
    }
    if let [Op::HalfSpace { complement, .. }] = words[..] {
        return Ok(inside[0] ^ complement);
    }
    stack.clear();
    for word in words {
        let value = match *word {
            Op::HalfSpace { index, complement } => inside[index as usize] ^ complement,
            Op::Join { join, complement, count } => {
                let first = stack.len() - count as usize;
                let mut operands = stack.drain(first..);
                let joined = match join {
                    Join::Intersection => operands.all(|one| one),
                    Join::Union => operands.any(|one| one),
                    Join::Parity => operands.filter(|&one| one).count() % 2 == 1,
                };
                joined ^ complement
            }
            _ => false,
        };
        memory::push(stack, value)?;
    }
    Ok(stack.last().copied().unwrap_or(false))
}
