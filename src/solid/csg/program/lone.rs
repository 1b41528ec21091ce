//! Cells in which a solid of another kind is the only open operand: all queries are passed on to it, bulk
//! forms included.

use super::Program;
use super::word::{Op, Word};
use super::worker::{CsgPart, Scratch, Slot};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Ray};
use crate::memory;
use crate::octree::Planes;
use crate::solid::{
    AnyWorker, AskWhole, Direct, ErasedPart, Parts, Question, RayQuestion, RayTrace, Verdict, Worker,
};
use alloc::vec::Vec;

/// The only open operand of a cell: a part of another solid, or of its complement.
#[derive(Clone, Copy)]
pub(crate) struct Lone {
    pub(crate) solid: u32,
    pub(crate) part: ErasedPart,
    pub(crate) complement: bool,
}

/// The latest trace. Cells along a ray ask for the same trace.
#[derive(Default)]
pub(crate) struct LastTrace {
    /// The operand, the ray, and whether the trace ends at the first entry.
    of: Option<(u32, Ray, bool)>,
    trace: Option<RayTrace>,
}

impl Scratch {
    /// Returns the trace of a ray through the only open operand, if there is only one and it answers.
    #[inline(never)]
    pub(crate) fn trace_of_lone(
        &mut self,
        program: &Program,
        (cell, part): (Cell, CsgPart),
        question: RayQuestion<'_>,
        last: &mut LastTrace,
    ) -> Result<(), Error> {
        let Some(Lone { solid, part, complement }) = self.lone(program, part)? else { return Ok(()) };
        let RayQuestion { ray, is_first_enough, trace } = question;
        let known = last.trace.get_or_insert(RayTrace::UNKNOWN);
        let of = Some((solid, *ray, is_first_enough));
        if last.of != of {
            last.of = None;
            known.clear();
            let worker = &mut Scratch::other(&mut self.workers, program, solid)?.worker;
            worker.answer(cell, &part, Question::Ray(RayQuestion { ray, is_first_enough, trace: known }))?;
            // A solid that answers for the whole universe gives the same trace in all cells. (A nested
            // expression may not.)
            if known.is_known()
                && program.solids[solid as usize].is_direct(Direct::Rays, &Control::threads(1))?
            {
                last.of = of;
            }
        }
        trace.crossings.clear();
        trace.crossings.try_reserve(known.crossings.len())?;
        trace.crossings.extend_from_slice(&known.crossings);
        (trace.begins_inside, trace.until) = (known.begins_inside, known.until);
        if complement {
            trace.complement();
        }
        Ok(())
    }

    /// Returns whether a look for a lone operand is worthwhile.
    #[inline(always)]
    pub(crate) fn may_be_lone(&self, program: &Program, part: CsgPart) -> bool {
        part.len == 1 && !program.solids.is_empty()
    }

    pub(crate) fn lone(&mut self, program: &Program, part: CsgPart) -> Result<Option<Lone>, Error> {
        if !self.may_be_lone(program, part) {
            return Ok(None);
        }
        let Op::Solid { index, complement } = Scratch::list(program, &self.words, part)[0].op() else {
            return Ok(None);
        };
        Ok(self.slot(program, index)?.map(|(solid, part)| Lone { solid, part, complement }))
    }

    /// Runs `ask` with the worker and the part of the only open operand, if there is only one. Returns the
    /// answer, and whether the complement is meant.
    pub(crate) fn ask_lone<T>(
        &mut self,
        program: &Program,
        part: CsgPart,
        ask: impl FnOnce(&mut AnyWorker<'static>, &ErasedPart) -> Result<T, Error>,
    ) -> Result<Option<(T, bool)>, Error> {
        let Some(Lone { solid, part, complement }) = self.lone(program, part)? else { return Ok(None) };
        let other = Scratch::other(&mut self.workers, program, solid)?;
        Ok(Some((ask(&mut other.worker, &part)?, complement)))
    }

    /// Passes a question on to the only open operand. Returns `false` if there is not exactly one.
    #[inline(never)]
    pub(crate) fn answer_of_lone(
        &mut self,
        program: &Program,
        cell: Cell,
        part: CsgPart,
        question: &mut Question<'_>,
    ) -> Result<bool, Error> {
        let ask =
            |worker: &mut AnyWorker<'static>, part: &ErasedPart| worker.answer(cell, part, question.again());
        let answered = self.ask_lone(program, part, ask)?;
        if let Some(((), true)) = answered {
            question.again().complement()?;
        }
        Ok(answered.is_some())
    }

    /// Returns the worker and the part of the only open operand, if its worker exists already.
    pub(crate) fn look_at_lone(
        &self,
        program: &Program,
        part: CsgPart,
    ) -> Option<(&AnyWorker<'static>, ErasedPart, bool)> {
        if part.len != 1 {
            return None;
        }
        let Op::Solid { index, complement } = Scratch::list(program, &self.words, part)[0].op() else {
            return None;
        };
        let slot = self.slots.get((index as usize).checked_sub(program.solids.len())?)?;
        let other = self.workers[slot.solid as usize].as_ref()?;
        Some((&other.worker, slot.part, complement))
    }

    /// Splits the only open operand by two levels, if there is only one.
    #[inline(never)]
    pub(crate) fn lone64(
        &mut self,
        program: &Program,
        cell: Cell,
        part: CsgPart,
        parts: &mut Vec<(u8, CsgPart)>,
    ) -> Result<Option<Planes>, Error> {
        let Some(Lone { solid, part, complement }) = self.lone(program, part)? else { return Ok(None) };
        let mut passing = core::mem::take(&mut self.passing);
        passing.clear();
        let worker = &mut Scratch::other(&mut self.workers, program, solid)?.worker;
        let height = worker.mark();
        let planes = worker.split64(cell, &part, &mut passing)?;
        parts.try_reserve(passing.len())?;
        for (c, part) in passing.drain(..) {
            parts.push((c, self.lone_part(program, solid, part, complement, height)?));
        }
        self.passing = passing;
        Ok(Some(if complement { planes.complement() } else { planes }))
    }

    /// Makes the part of a cell in which only one operand is open.
    fn lone_part(
        &mut self,
        program: &Program,
        solid: u32,
        part: ErasedPart,
        complement: bool,
        height: usize,
    ) -> Result<CsgPart, Error> {
        let start = self.start(program)?;
        let index = self.keep(program, Slot { solid, part, words: self.words.len(), height })?;
        memory::push(&mut self.words, Word::new(Op::Solid { index, complement }))?;
        Ok(CsgPart { start, len: 1 })
    }

    /// Returns the eight cells of the only open operand, if there is only one.
    #[inline(never)]
    pub(crate) fn lone8(
        &mut self,
        program: &Program,
        cell: Cell,
        part: CsgPart,
    ) -> Result<Option<[Verdict<CsgPart>; 8]>, Error> {
        let Some(Lone { solid, part, complement }) = self.lone(program, part)? else { return Ok(None) };
        let Scratch { workers, at_hand, .. } = self;
        let (height, split) = Scratch::split_other(workers, at_hand, program, solid, cell, &part)?;
        let mut verdicts = [Verdict::Undecided; 8];
        for (verdict, other) in verdicts.iter_mut().zip(split) {
            let own = other.try_map(|part| self.lone_part(program, solid, part, complement, height))?;
            *verdict = if complement { own.complement() } else { own };
        }
        Ok(Some(verdicts))
    }
}
