//! A CSG expression as a solid: its classifier and its workers.

use super::Program;
use super::chords::Rays;
use super::kleene::Kleene;
use super::lone::LastTrace;
use super::worker::{Ask, CsgPart, Scratch};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Bounds, Cell, Frame};
use crate::mesh::TriangleMesh;
use crate::octree::{Block, Planes, Proof, Tag};
use crate::solid::csg::Csg;
use crate::solid::{
    AskWhole, Batch, Classifier, Direct, Fingerprint, LayersQuestion, OCTANTS, Parts, Question, Solid,
    Subtree, Verdict, WholeQuestion, Worker, sample_one_by_one, split_one_by_one,
};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::sync::atomic::Ordering::Relaxed;

/// An expression on a frame: a cheap handle.
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
    last_trace: LastTrace,
}

impl Solid for Csg {
    type Classifier = CsgClassifier;

    /// O(n) in the expression written out, plus the sorting of operations with many operands, plus the time
    /// for the other solids.
    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<CsgClassifier, Error> {
        let mut program = Program::new(self, frame, control)?;
        let mut scratch = Scratch::new(&program)?;
        let mut universe = scratch.begin(&program)?;
        self.count(scratch.evaluations);
        program.likes_many = scratch.workers.iter().flatten().any(|other| other.worker.likes_many());
        if program.likes_many {
            program.recalls = scratch.recalls()?;
        }
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

    fn kept_bytes(&self) -> u64 {
        self.bytes_of_expression()
    }

    fn sole_mesh(&self) -> Option<&TriangleMesh> {
        self.mesh_of_expression()
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
            last_trace: LastTrace::default(),
        })
    }

    fn exterior(&self) -> Tag {
        self.program.exterior
    }

    fn proof(&self) -> Proof {
        self.program.proof
    }

    fn kept_bytes(&self) -> u64 {
        self.program.bytes()
    }

    /// Answers for the whole of the only solid, if the expression is nothing but that solid. Also answers for
    /// half-spaces in planes of the lattice.
    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error> {
        let program = &*self.program;
        match question {
            WholeQuestion::OffLattice(known) => {
                let depth = program.frame.depth();
                *known = program.solids.iter().all(AskWhole::is_off_lattice)
                    && !program.half_spaces.iter().any(|half_space| half_space.may_hold_lattice_plane(depth));
                Ok(())
            }
            WholeQuestion::Surfaces(known) => {
                *known = Some(program.surfaces(false, control)?);
                Ok(())
            }
            WholeQuestion::Layers(known) => {
                *known = Some(program.surfaces(true, control)?);
                Ok(())
            }
            question => {
                if let Some(solid) = program.sole() {
                    return solid.answer_whole(question, control);
                }
                // The question stays unanswered for the whole universe. But it is passed on, for cells in
                // which one solid alone is open, and for points that one solid knows.
                if let WholeQuestion::Direct(kind @ (Direct::Rays | Direct::Points), _) = question {
                    for solid in &program.solids {
                        solid.is_direct(kind, control)?;
                    }
                }
                Ok(())
            }
        }
    }
}

impl Drop for CsgWorker {
    fn drop(&mut self) {
        self.program.root.evaluations.fetch_add(self.scratch.evaluations, Relaxed);
    }
}

impl Parts for CsgWorker {
    type Part = CsgPart;

    fn mark(&self) -> usize {
        self.scratch.mark()
    }

    fn release(&mut self, mark: usize) {
        self.scratch.release(mark);
    }

    fn scratch_bytes(&self) -> usize {
        self.scratch.bytes()
    }

    fn hand_over(&mut self, from: &Self, part: &CsgPart) -> Result<CsgPart, Error> {
        self.scratch.copy(&self.program, &from.scratch, *part)
    }
}

impl Batch for CsgWorker {
    fn likes_many(&self) -> bool {
        self.program.likes_many
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, CsgPart)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<CsgPart>; 8]>,
    ) -> Result<(), Error> {
        if !self.program.likes_many {
            return split_one_by_one(self, cells, control, verdicts);
        }
        self.scratch.split_many(&self.program, cells, control, verdicts)
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, CsgPart)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        if !self.program.likes_many {
            return sample_one_by_one(self, cells, control, inside);
        }
        self.scratch.sample_many(&self.program, cells, control, inside)
    }

    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        let Verdict::Partial(part) = self.universe else { return Ok(()) };
        self.scratch.inside(&self.program, part, points, answers)
    }

    fn recall(&mut self, cell: Cell) -> Option<CsgPart> {
        let Verdict::Partial(part) = self.universe else { return None };
        if !self.program.likes_many {
            return None;
        }
        self.scratch.recall(&self.program, part, cell).ok().flatten()
    }
}

impl Worker for CsgWorker {
    fn frame(&self) -> &Frame {
        &self.program.frame
    }

    fn root(&mut self) -> Result<Verdict<CsgPart>, Error> {
        Ok(self.universe)
    }

    #[inline]
    fn split(&mut self, cell: Cell, part: &CsgPart) -> Result<[Verdict<CsgPart>; 8], Error> {
        self.scratch.split(&self.program, cell, *part)
    }

    /// A solid that is open alone answers itself.
    #[inline]
    fn answer(&mut self, cell: Cell, part: &CsgPart, mut question: Question<'_>) -> Result<(), Error> {
        let (program, scratch, part) = (&*self.program, &mut self.scratch, *part);
        if let Question::Centre(inside) = question {
            *inside = scratch.contains(program, part, cell)?;
            return Ok(());
        }
        if let Question::Surfaces(known) = question {
            *known = scratch.open_surfaces(program, cell, part, None)?;
            return Ok(());
        }
        if let Question::Layers(LayersQuestion { tolerance, own, known }) = question {
            *known = scratch.open_surfaces(program, cell, part, Some((tolerance, own)))?;
            return Ok(());
        }
        if let Question::Ray(question) = question {
            return scratch.trace_of_lone(program, (cell, part), question, &mut self.last_trace);
        }
        if scratch.may_be_lone(program, part) && scratch.answer_of_lone(program, cell, part, &mut question)? {
            return Ok(());
        }
        match question {
            Question::Enclosure(known) => *known = scratch.slabs(program, cell, part)?,
            Question::Moments(known) => *known = scratch.moments(program, cell, part),
            Question::Area(known) => *known = scratch.area(program, cell, part)?,
            Question::Chords(chords) => {
                *chords.found = self.rays.find(program, scratch, cell, part, chords.beam)?;
            }
            Question::Centre(_)
            | Question::Crossing(..)
            | Question::Surfaces(_)
            | Question::Layers(_)
            | Question::Ray(_)
            | Question::Nearest(..)
            | Question::Box(..) => {}
        }
        Ok(())
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

    fn subtree(&self, part: &CsgPart) -> Option<Subtree<'_>> {
        let (worker, part, complement) = self.scratch.look_at_lone(&self.program, *part)?;
        let subtree = worker.subtree(&part)?;
        Some(if complement { subtree.complement() } else { subtree })
    }

    fn sample64(&mut self, cell: Cell, parts: &[(u8, CsgPart)]) -> Result<Option<u64>, Error> {
        self.scratch.contained(&self.program, cell, parts)
    }
}
