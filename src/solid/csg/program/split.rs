//! A CSG expression as a solid.

use super::Program;
use super::chords::Rays;
use super::kleene::Kleene;
use super::worker::{Ask, CsgPart, Scratch};
use crate::control::Control;
use crate::dexel::Beam;
use crate::error::Error;
use crate::lattice::{Bounds, Cell, CellMoments, Frame, Interval, VolumeMoments};
use crate::octree::{Block, Planes, Proof, Tag};
use crate::solid::csg::Csg;
use crate::solid::{
    Classifier, Crossing, Enclosure, Fingerprint, OCTANTS, Segment, Solid, Subtree, Verdict, Worker,
};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::sync::atomic::Ordering::Relaxed;

/// An expression on a frame: the handle.
#[derive(Clone)]
pub struct CsgClassifier {
    program: Arc<Program>,
    universe: Verdict<CsgPart>,
}

/// A worker on an expression.
pub struct CsgWorker {
    program: Arc<Program>,
    universe: Verdict<CsgPart>,
    scratch: Scratch,
    rays: Rays,
}

impl Solid for Csg {
    type Classifier = CsgClassifier;

    /// O(n) in the expression written out, but for operations of many operands, which sort them; and what the
    /// other solids in it take.
    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<CsgClassifier, Error> {
        let mut program = Program::new(self, frame, control)?;
        let mut scratch = Scratch::new(&program)?;
        let mut universe = scratch.begin(&program)?;
        self.count(scratch.evaluations);
        if let Verdict::Partial(part) = universe {
            let (words, part) = scratch.into_words(&program, part)?;
            program.words = words;
            universe = Verdict::Partial(part);
        }
        Ok(CsgClassifier { program: Arc::new(program), universe })
    }

    fn bounds(&self) -> Option<Bounds> {
        self.bounds_of_expression()
    }

    fn home(&self) -> Option<Frame> {
        self.root.home.as_deref().copied()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.fingerprint_of_expression()
    }

    fn placed(&self, placement: &crate::lattice::Affine) -> Result<Option<Csg>, Error> {
        Csg::placed(self, placement).map(Some)
    }

    fn motion(&self) -> crate::solid::csg::Motion {
        self.motion_of_expression()
    }
}

impl Classifier for CsgClassifier {
    type Worker = CsgWorker;

    fn frame(&self) -> &Frame {
        &self.program.frame
    }

    fn worker(&self) -> Result<CsgWorker, Error> {
        let scratch = Scratch::new(&self.program)?;
        Ok(CsgWorker {
            program: self.program.clone(),
            universe: self.universe,
            scratch,
            rays: Rays::default(),
        })
    }

    fn exterior(&self) -> Tag {
        self.program.exterior
    }

    fn proof(&self) -> Proof {
        self.program.proof
    }

    fn moments(&self, control: &Control<'_>) -> Result<Option<VolumeMoments>, Error> {
        self.program.sole().map_or(Ok(None), |solid| solid.moments(control))
    }

    fn area(&self, control: &Control<'_>) -> Result<Option<Interval>, Error> {
        self.program.sole().map_or(Ok(None), |solid| solid.area(control))
    }

    fn is_off_lattice(&self) -> bool {
        let depth = self.program.frame.depth();
        self.program.solids.iter().all(Classifier::is_off_lattice)
            && !self.program.half_spaces.iter().any(|half_space| half_space.may_hold_lattice_plane(depth))
    }
}

impl Drop for CsgWorker {
    fn drop(&mut self) {
        self.program.root.evaluations.fetch_add(self.scratch.evaluations, Relaxed);
    }
}

impl Worker for CsgWorker {
    type Part = CsgPart;

    fn frame(&self) -> &Frame {
        &self.program.frame
    }

    fn root(&mut self) -> Result<Verdict<CsgPart>, Error> {
        Ok(self.universe)
    }

    #[inline]
    fn split(&mut self, cell: Cell, part: &CsgPart) -> Result<[Verdict<CsgPart>; 8], Error> {
        let (program, scratch) = (&*self.program, &mut self.scratch);
        if scratch.may_be_lone(program, *part)
            && let Some(verdicts) = scratch.lone8(program, cell, *part)?
        {
            return Ok(verdicts);
        }
        let cells = scratch.cells(program, *part, Ask::Split(cell))?;
        Ok(OCTANTS.map(|k| cells.kleene.verdict(k.into(), cells.parts[k as usize])))
    }

    fn mark(&self) -> usize {
        self.scratch.mark()
    }

    fn scratch_bytes(&self) -> usize {
        self.scratch.bytes()
    }

    fn release(&mut self, mark: usize) {
        self.scratch.release(mark);
    }

    fn hand_over(&mut self, from: &Self, part: &CsgPart) -> Result<CsgPart, Error> {
        self.scratch.copy(&self.program, &from.scratch, *part)
    }

    fn split64(
        &mut self,
        cell: Cell,
        part: &CsgPart,
        parts: &mut Vec<(u8, CsgPart)>,
    ) -> Result<Planes, Error> {
        let (program, scratch) = (&*self.program, &mut self.scratch);
        if scratch.may_be_lone(program, *part)
            && let Some(planes) = scratch.lone64(program, cell, *part, parts)?
        {
            return Ok(planes);
        }
        parts.try_reserve(64)?;
        let octants = scratch.cells(program, *part, Ask::Split(cell))?;
        let mut planes = Planes::uniform(Tag::Empty);
        for k in OCTANTS {
            let (lower, upper) = (octants.kleene.lower >> k & 1 != 0, octants.kleene.upper >> k & 1 != 0);
            let part = octants.parts[k as usize];
            let mut cells =
                Kleene { lower: if lower { 0xFF } else { 0 }, upper: if upper { 0xFF } else { 0 } };
            if upper && !lower && part.len > 0 {
                let split = scratch.cells(program, part, Ask::Split(cell.child(k)))?;
                cells = split.kleene;
                let mut partial = cells.partial();
                while partial != 0 {
                    let c = partial.trailing_zeros() as u8;
                    partial &= partial - 1;
                    if split.parts[c as usize].len > 0 {
                        parts.push((8 * k + c, split.parts[c as usize]));
                    }
                }
            }
            planes.lower |= (cells.lower as u64) << (8 * k);
            planes.upper |= (cells.upper as u64) << (8 * k);
        }
        Ok(planes)
    }

    fn fill(&mut self, cell: Cell, part: &CsgPart, block: &mut Block) -> Result<bool, Error> {
        let (program, scratch) = (&*self.program, &mut self.scratch);
        let filled = scratch.ask_lone(program, *part, |worker, part| worker.fill(cell, part, block))?;
        if let Some((true, true)) = filled {
            block.complement();
        }
        Ok(filled.is_some_and(|(filled, _)| filled))
    }

    fn chords(&mut self, cell: Cell, part: &CsgPart, beam: &mut Beam) -> Result<bool, Error> {
        let (program, scratch) = (&*self.program, &mut self.scratch);
        let before = beam.len();
        let found = scratch.ask_lone(program, *part, |worker, part| worker.chords(cell, part, beam))?;
        match found {
            Some((found, complement)) => {
                if found && complement {
                    beam.complement(before)?;
                }
                Ok(found)
            }
            None => self.rays.find(program, scratch, cell, *part, beam),
        }
    }

    fn subtree(&self, part: &CsgPart) -> Option<Subtree<'_>> {
        let (worker, part, complement) = self.scratch.look_at_lone(&self.program, *part)?;
        let subtree = worker.subtree(&part)?;
        Some(if complement { subtree.complement() } else { subtree })
    }

    fn sample(&mut self, cell: Cell, part: &CsgPart) -> Result<Option<bool>, Error> {
        self.scratch.contains(&self.program, *part, cell)
    }

    fn sample64(&mut self, cell: Cell, parts: &[(u8, CsgPart)]) -> Result<Option<u64>, Error> {
        self.scratch.contained(&self.program, cell, parts)
    }

    fn enclosure(&mut self, cell: Cell, part: &CsgPart) -> Result<Option<Enclosure>, Error> {
        let (program, scratch) = (&*self.program, &mut self.scratch);
        if !scratch.may_be_lone(program, *part) {
            return Ok(scratch.slabs(program, cell, *part));
        }
        let found = scratch.ask_lone(program, *part, |worker, part| worker.enclosure(cell, part))?;
        if found.is_none() {
            return Ok(scratch.slabs(program, cell, *part));
        }
        Ok(found.and_then(|(enclosure, complement)| match (enclosure, complement) {
            (Some(enclosure), true) => Some(enclosure.complement()),
            (enclosure, _) => enclosure,
        }))
    }

    fn moments(&mut self, cell: Cell, part: &CsgPart) -> Result<Option<CellMoments>, Error> {
        let (program, scratch) = (&*self.program, &mut self.scratch);
        let found = scratch.ask_lone(program, *part, |worker, part| worker.moments(cell, part))?;
        if found.is_none() {
            return Ok(scratch.moments(program, cell, *part));
        }
        Ok(found.and_then(|(moments, complement)| match (moments, complement) {
            (Some(moments), true) => Some(moments.complement()),
            (moments, _) => moments,
        }))
    }

    fn area(&mut self, cell: Cell, part: &CsgPart) -> Result<Option<Interval>, Error> {
        let (program, scratch) = (&*self.program, &mut self.scratch);
        if !scratch.may_be_lone(program, *part) {
            return Ok(scratch.area(program, cell, *part));
        }
        let found = scratch.ask_lone(program, *part, |worker, part| worker.area(cell, part))?;
        Ok(found.map_or_else(|| scratch.area(program, cell, *part), |(area, _)| area))
    }

    fn crossing(&mut self, cell: Cell, part: &CsgPart, segment: &Segment) -> Result<Option<Crossing>, Error> {
        let (program, scratch) = (&*self.program, &mut self.scratch);
        let found = scratch.ask_lone(program, *part, |worker, part| worker.crossing(cell, part, segment))?;
        Ok(found.and_then(|(crossing, complement)| match (crossing, complement) {
            (Some(crossing), true) => Some(crossing.complement()),
            (crossing, _) => crossing,
        }))
    }
}
