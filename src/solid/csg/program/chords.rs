//! Rays through cell centres: where they enter and leave what a cell's words say.
//!
//! The roots of all half-spaces on a ray cut it into pieces, on each of which the words have one value.

use super::Program;
use super::word::Op;
use super::worker::{CsgPart, Scratch};
use crate::dexel::{Beam, BeamEnd, OTHERS};
use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::solid::csg::Join;
use crate::solid::half_space::lines::{Line, Root};
use alloc::vec::Vec;

/// Most half-spaces that are evaluated on every ray of a large cell; one with more is split first.
const FEW: usize = 8;

/// Levels of a cell that is not split for that any more.
const SMALL: u8 = 3;

/// Memory that is kept from cell to cell.
#[derive(Default)]
pub(crate) struct Rays {
    /// The half-spaces, and what they are on the ray at hand.
    half_spaces: Vec<u32>,
    inside: Vec<bool>,
    roots: Vec<Root>,
    words: Vec<Op>,
    stack: Vec<bool>,
    table: Option<u64>,
}

impl Rays {
    /// Adds the intervals of all rays of a beam in a cell. `false` if the cell is better split, or some word is not a
    /// half-space.
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
        if self.half_spaces.len() > FEW && height > SMALL {
            return Ok(false);
        }
        let cells = f64::from(1u32 << beam.depth());
        let [u, v] = OTHERS[beam.axis()];
        let [columns, rows] = beam.rays();
        let span = beam.span();
        let mut line = Line {
            axis: beam.axis(),
            point: [0.0; 3],
            cells,
            low: f64::from(span.start) / cells,
            high: f64::from(span.end) / cells,
        };
        for row in rows {
            line.point[v] = (f64::from(row) + 0.5) / cells;
            for column in columns.clone() {
                line.point[u] = (f64::from(column) + 0.5) / cells;
                self.ray(program, &line, [column, row], beam)?;
            }
        }
        Ok(true)
    }

    /// Takes the words of a part apart; `false` if there are others than half-spaces and operations on them.
    fn gather(&mut self, program: &Program, scratch: &Scratch, part: CsgPart) -> Result<bool, Error> {
        self.half_spaces.clear();
        self.words.clear();
        self.table = None;
        let list = Scratch::list(program, &scratch.words, part);
        if part.is_table() {
            let (variables, table) = list.split_at(list.len() - 2);
            // Variables keep their numbers in the table.
            for word in variables {
                let (i, index) = word.variable();
                while self.half_spaces.len() <= i {
                    memory::push(&mut self.half_spaces, u32::MAX)?;
                }
                self.half_spaces[i] = index;
            }
            self.table = Some(u64::from(table[0].bits()) | u64::from(table[1].bits()) << 32);
            return Ok(self.are_known(program));
        }
        for word in list {
            let op = match word.op() {
                Op::HalfSpace { index, complement } => {
                    let known = self.half_spaces.iter().position(|&known| known == index);
                    let i = match known {
                        Some(i) => i,
                        None => {
                            memory::push(&mut self.half_spaces, index)?;
                            self.half_spaces.len() - 1
                        }
                    };
                    Op::HalfSpace { index: i as u32, complement }
                }
                op @ Op::Join { .. } => op,
                _ => return Ok(false),
            };
            memory::push(&mut self.words, op)?;
        }
        Ok(!self.half_spaces.is_empty() && self.are_known(program))
    }

    /// Whether no function is the host's, of which only boxes are known.
    fn are_known(&self, program: &Program) -> bool {
        let half_space = |&index: &u32| program.half_spaces.get(index as usize);
        self.half_spaces.iter().filter_map(half_space).all(|half_space| half_space.degree().is_some())
    }

    /// The intervals on one ray.
    #[inline]
    fn ray(&mut self, program: &Program, line: &Line, ray: [u32; 2], beam: &mut Beam) -> Result<(), Error> {
        self.roots.clear();
        self.inside.clear();
        for (i, &index) in (0u32..).zip(&self.half_spaces) {
            let inside = match program.half_spaces.get(index as usize) {
                Some(half_space) => line.roots(half_space, i, &mut self.roots)?,
                None => false,
            };
            memory::push(&mut self.inside, inside)?;
        }
        let mut now = self.value()?;
        if self.roots.is_empty() && !now {
            return Ok(());
        }
        if self.half_spaces.len() > 1 {
            self.roots.sort_unstable_by(|a, b| a.at.total_cmp(&b.at).then(a.which.cmp(&b.which)));
        }
        let mut start = BeamEnd::between(beam.span().start);
        for i in 0..self.roots.len() {
            let Root { at, which } = self.roots[i];
            self.inside[which as usize] ^= true;
            let next = self.value()?;
            if next != now {
                let mut end = BeamEnd { at, ..start };
                if beam.is_marked() {
                    let index = self.half_spaces[which as usize];
                    let normal = line.normal(&program.half_spaces[index as usize], at);
                    // The half-space begins here where its normal, which leads out, leads back.
                    let turned = self.inside[which as usize] != next;
                    end = end.on(index, if turned { normal.map(|c| -c) } else { normal });
                }
                if next {
                    start = end;
                } else {
                    beam.push(ray, start, end)?;
                }
                now = next;
            }
        }
        if now {
            beam.push(ray, start, BeamEnd::between(beam.span().end))?;
        }
        Ok(())
    }

    /// What the words say where half-spaces are as they are.
    #[inline]
    fn value(&mut self) -> Result<bool, Error> {
        if let Some(table) = self.table {
            let index =
                self.inside.iter().enumerate().fold(0, |index, (i, &inside)| index | u32::from(inside) << i);
            return Ok(table >> index & 1 != 0);
        }
        let Rays { words, stack, inside, .. } = self;
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
}
