//! Batches of cells or points, for expressions whose other solids prefer them.
//!
//! The queries of all cells to the other solids are gathered first, and asked together. Then the cells are
//! split or sampled one by one, as usual, with these answers at hand.

use super::Program;
use super::at_hand::{AtHand, Splits};
use super::kleene::Kleene;
use super::word::{Op, Word};
use super::worker::{CsgPart, Other, Scratch, Slot};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::solid::ErasedPart;
use crate::solid::half_space::bounds::Octants;
use crate::solid::{Batch, Parts, Verdict};
use alloc::vec::{IntoIter, Vec};

/// The most words of an expression that are evaluated for a point, or for a part without the way to its cell.
const MOST_WORDS: usize = 64;

impl Scratch {
    /// Lists for each of the other solids the queries that splitting or sampling cells will make, in that
    /// order.
    fn questions(
        &mut self,
        program: &Program,
        cells: &[(Cell, CsgPart)],
    ) -> Result<Vec<Vec<(Cell, ErasedPart)>>, Error> {
        let mut questions = memory::filled(program.solids.len(), Vec::new())?;
        for &(cell, part) in cells {
            self.open_solids(program, part, |solid, part| {
                memory::push(&mut questions[solid as usize], (cell, part))
            })?;
        }
        Ok(questions)
    }

    /// Visits the other solids that are open in a cell, with their parts.
    fn open_solids(
        &mut self,
        program: &Program,
        part: CsgPart,
        mut show: impl FnMut(u32, ErasedPart) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if part.is_table() {
            return Ok(());
        }
        for i in 0..part.words() {
            if let Op::Solid { index, .. } = Scratch::list(program, &self.words, part)[i].op()
                && let Some((solid, part)) = self.slot(program, index)?
            {
                show(solid, part)?;
            }
        }
        Ok(())
    }

    /// Returns whether a cell needs answers that are not at hand. It does only if a solid ended early.
    fn lacks(
        &mut self,
        program: &Program,
        part: CsgPart,
        left: impl Fn(&AtHand, usize) -> usize,
    ) -> Result<bool, Error> {
        let mut needed = memory::filled(program.solids.len(), 0)?;
        self.open_solids(program, part, |solid, _| {
            needed[solid as usize] += 1;
            Ok(())
        })?;
        Ok((0..).zip(needed).any(|(solid, needed)| needed > left(&self.at_hand, solid)))
    }

    /// Returns for which of the other solids the universe is PARTIAL with a part that is available without
    /// another query (a worker of a host's function would query again). All solids must have been queried for
    /// the universe.
    pub(crate) fn recalls(&mut self) -> Result<Vec<bool>, Error> {
        memory::collected(self.workers.iter_mut().map(|other| match other {
            Some(Other { worker, root: Verdict::Partial(_) }) => {
                worker.likes_many() && worker.recall(Cell::ROOT).is_some()
            }
            _ => false,
        }))
    }

    /// Splits many cells; see [`Batch::split_many`].
    pub(crate) fn split_many(
        &mut self,
        program: &Program,
        cells: &[(Cell, CsgPart)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<CsgPart>; 8]>,
    ) -> Result<(), Error> {
        verdicts.try_reserve(cells.len())?;
        let mut done = Ok(());
        let mut splits: Vec<Splits> = memory::with_capacity(program.solids.len())?;
        for (solid, cells) in (0..).zip(self.questions(program, cells)?) {
            let mut own = Splits::default();
            if !cells.is_empty() && done.is_ok() {
                let worker = &mut Scratch::other(&mut self.workers, program, solid)?.worker;
                let mut found = Vec::new();
                own.height = worker.mark();
                done = worker.split_many(&cells, control, &mut found);
                own.verdicts = found.into_iter();
            }
            splits.push(own);
        }
        self.at_hand.splits = splits;
        for &(cell, part) in cells {
            // (Without memory to find out, the answer is true.)
            if done.is_err()
                && self.lacks(program, part, |at_hand, i| at_hand.splits[i].verdicts.len()).unwrap_or(true)
            {
                break;
            }
            let eight = self.split(program, cell, part);
            match eight {
                Ok(eight) => verdicts.push(eight),
                Err(error) => {
                    done = Err(error);
                    break;
                }
            }
        }
        self.at_hand = AtHand::default();
        done
    }

    /// Samples many cells; see [`Batch::sample_many`].
    pub(crate) fn sample_many(
        &mut self,
        program: &Program,
        cells: &[(Cell, CsgPart)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        inside.try_reserve(cells.len())?;
        let mut done = Ok(());
        let mut samples: Vec<IntoIter<Option<bool>>> = memory::with_capacity(program.solids.len())?;
        for (solid, cells) in (0..).zip(self.questions(program, cells)?) {
            let mut found = Vec::new();
            if !cells.is_empty() && done.is_ok() {
                let worker = &mut Scratch::other(&mut self.workers, program, solid)?.worker;
                done = worker.sample_many(&cells, control, &mut found);
            }
            samples.push(found.into_iter());
        }
        self.at_hand.samples = samples;
        for &(cell, part) in cells {
            if done.is_err()
                && self.lacks(program, part, |at_hand, i| at_hand.samples[i].len()).unwrap_or(true)
            {
                break;
            }
            match self.contains(program, part, cell) {
                Ok(answer) => inside.push(answer),
                Err(error) => {
                    done = Err(error);
                    break;
                }
            }
        }
        self.at_hand = AtHand::default();
        done
    }

    /// Answers whether points lie inside, from the other solids' answers, and from the half-spaces in the
    /// points' finest cells. See [`Batch::inside`].
    pub(crate) fn inside(
        &mut self,
        program: &Program,
        part: CsgPart,
        points: &[[f64; 3]],
        answers: &mut [Option<bool>],
    ) -> Result<(), Error> {
        // (Half-spaces alone are as fast by cells.) Two solids may both say that a point on a common face is
        // outside, although their union contains it. So with several solids, cells decide. The words of a
        // table are no operations.
        if program.solids.len() != 1 || program.paper || part.is_table() || part.words() > MOST_WORDS {
            return Ok(());
        }
        let mut known = memory::with_capacity(program.solids.len())?;
        for solid in 0..program.solids.len() as u32 {
            let mut own = memory::filled(points.len(), None)?;
            Scratch::other(&mut self.workers, program, solid)?.worker.inside(points, &mut own)?;
            known.push(own);
        }
        if known.iter().flatten().all(Option::is_none) {
            return Ok(());
        }
        let Scratch { words, operands, slots, evaluations, .. } = self;
        let words = Scratch::list(program, words, part);
        for (i, (&point, answer)) in points.iter().zip(answers).enumerate() {
            let Some(at) = program.frame.cell_of(point) else { continue };
            let cell = Cell { level: program.frame.depth(), at };
            let (octants, bit) = (Octants::of(cell.parent()), 1u8 << cell.octant());
            operands.clear();
            operands.try_reserve(words.len())?;
            for word in words {
                let kleene = match word.op() {
                    Op::HalfSpace { index, complement } => {
                        let sides = program.half_spaces[index as usize].sides(&octants, bit, evaluations)?;
                        Kleene::of(sides, complement)
                    }
                    Op::Solid { index, complement } => {
                        let slot = (index as usize).checked_sub(program.solids.len());
                        let solid = slot.map_or(index, |slot| slots[slot].solid);
                        let kleene = match known[solid as usize][i] {
                            Some(true) => Kleene::FULL,
                            Some(false) => Kleene::EMPTY,
                            None => Kleene::UNKNOWN,
                        };
                        kleene.complemented(complement)
                    }
                    Op::Join { join, complement, count } => {
                        Kleene::join_last(operands, join, count).complemented(complement)
                    }
                    Op::Group { index } => program.groups.kleene(index as usize, &octants),
                    Op::Unknown | Op::Primitive { .. } => Kleene::UNKNOWN,
                };
                operands.push(kleene);
            }
            let Some(kleene) = operands.pop() else { continue };
            if kleene.decided() & bit != 0 {
                *answer = Some(kleene.lower & bit != 0);
            }
        }
        Ok(())
    }

    /// Returns the part of a cell without the way to it, if there is one other solid and it can recall its
    /// own part. The part has the words of the whole expression, which give the same answers in the cell as
    /// the cell's own words. (With several solids, all would be queried, decided ones included.) See
    /// [`Batch::recall`].
    pub(crate) fn recall(
        &mut self,
        program: &Program,
        root: CsgPart,
        cell: Cell,
    ) -> Result<Option<CsgPart>, Error> {
        if program.solids.len() != 1 || program.paper || root.words() > MOST_WORDS {
            return Ok(None);
        }
        let (start, first) = (self.start(program)?, self.words.len());
        self.words.try_reserve(root.words())?;
        for i in 0..root.words() {
            let word = Scratch::list(program, &self.words, root)[i];
            let word = match word.op() {
                _ if root.is_table() => word,
                Op::Group { .. } => {
                    self.release(first);
                    return Ok(None);
                }
                Op::Solid { index: solid, complement } => {
                    let worker = &mut Scratch::other(&mut self.workers, program, solid)?.worker;
                    let height = worker.mark();
                    let Some(part) = worker.recall(cell) else {
                        self.release(first);
                        return Ok(None);
                    };
                    let index = self.keep(program, Slot { solid, part, words: first, height })?;
                    Word::new(Op::Solid { index, complement })
                }
                _ => word,
            };
            self.words.push(word);
        }
        Ok(Some(CsgPart { start, ..root }))
    }
}
