//! Cells in which a solid answers rays: they need no further splits.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame, Ray};
use crate::octree::{Block, Planes};
use crate::solid::forward::{forward_batch, forward_classifier, forward_parts};
use crate::solid::{Batch, Classifier, Parts, Question, RayQuestion, RayTrace, Subtree, Verdict, Worker};
use alloc::vec::Vec;

/// Traces a ray in one of a solid's PARTIAL cells. The trace is valid within the cell, up to its first entry
/// into the solid.
///
/// If only one operand is open in a cell, it answers for the expression: an expression in which one mesh is
/// open returns the trace of the mesh.
pub fn ask<W: Worker>(
    worker: &mut W,
    cell: Cell,
    part: &W::Part,
    ray: &Ray,
    trace: &mut RayTrace,
) -> Result<(), Error> {
    trace.clear();
    worker.answer(cell, part, Question::Ray(RayQuestion { ray, is_first_enough: true, trace }))
}

/// A solid on a frame that leaves cells undecided in which it answers rays.
///
/// A closed mesh answers rays in all cells, and an expression in those in which no other operand is open.
#[derive(Clone)]
pub struct Told<C>(pub C);

impl<C: Classifier> Classifier for Told<C> {
    type Worker = ToldWorker<C::Worker>;

    fn worker(&self) -> Result<Self::Worker, Error> {
        let probe = probe(self.0.frame())?;
        Ok(ToldWorker { inner: self.0.worker()?, probe, trace: RayTrace::UNKNOWN })
    }

    forward_classifier!(self => self.0);
}

/// A ray that meets nothing, so that a solid answers it at once.
pub fn probe(frame: &Frame) -> Result<Ray, Error> {
    Ray::new(frame.origin().each(|low| low - frame.edge()), [-1.0; 3])
}

pub struct ToldWorker<W> {
    inner: W,
    probe: Ray,
    trace: RayTrace,
}

impl<W: Worker> ToldWorker<W> {
    fn is_told(&mut self, cell: Cell, part: &W::Part) -> Result<bool, Error> {
        ask(&mut self.inner, cell, part, &self.probe, &mut self.trace)?;
        Ok(self.trace.is_known())
    }

    fn left(&mut self, cell: Cell, verdict: &mut Verdict<W::Part>) -> Result<(), Error> {
        if let Verdict::Partial(part) = verdict
            && self.is_told(cell, part)?
        {
            *verdict = Verdict::Undecided;
        }
        Ok(())
    }
}

impl<W: Worker> Parts for ToldWorker<W> {
    fn hand_over(&mut self, from: &Self, part: &W::Part) -> Result<W::Part, Error> {
        self.inner.hand_over(&from.inner, part)
    }

    forward_parts!(W::Part, self => self.inner);
}

impl<W: Worker> Batch for ToldWorker<W> {
    fn likes_many(&self) -> bool {
        self.inner.likes_many()
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, W::Part)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<W::Part>; 8]>,
    ) -> Result<(), Error> {
        let before = verdicts.len();
        self.inner.split_many(cells, control, verdicts)?;
        for ((cell, _), split) in cells.iter().zip(&mut verdicts[before..]) {
            for (k, verdict) in (0..).zip(split) {
                self.left(cell.child(k), verdict)?;
            }
        }
        Ok(())
    }

    forward_batch!(answers W::Part, self => self.inner);
}

impl<W: Worker> Worker for ToldWorker<W> {
    fn frame(&self) -> &Frame {
        self.inner.frame()
    }

    fn root(&mut self) -> Result<Verdict<W::Part>, Error> {
        let mut root = self.inner.root()?;
        self.left(Cell::ROOT, &mut root)?;
        Ok(root)
    }

    fn answer(&mut self, cell: Cell, part: &W::Part, question: Question<'_>) -> Result<(), Error> {
        self.inner.answer(cell, part, question)
    }

    fn sample64(&mut self, cell: Cell, parts: &[(u8, W::Part)]) -> Result<Option<u64>, Error> {
        self.inner.sample64(cell, parts)
    }

    fn split(&mut self, cell: Cell, part: &W::Part) -> Result<[Verdict<W::Part>; 8], Error> {
        let mut split = self.inner.split(cell, part)?;
        for (k, verdict) in (0..).zip(&mut split) {
            self.left(cell.child(k), verdict)?;
        }
        Ok(split)
    }

    fn split64(
        &mut self,
        cell: Cell,
        part: &W::Part,
        parts: &mut Vec<(u8, W::Part)>,
    ) -> Result<Planes, Error> {
        let (first, mut kept) = (parts.len(), parts.len());
        let planes = self.inner.split64(cell, part, parts)?;
        for i in first..parts.len() {
            let c = parts[i].0;
            if !self.is_told(cell.child(c >> 3).child(c & 7), &parts[i].1)? {
                parts.swap(kept, i);
                kept += 1;
            }
        }
        parts.truncate(kept);
        Ok(planes)
    }

    fn fill(&mut self, cell: Cell, part: &W::Part, block: &mut Block) -> Result<bool, Error> {
        self.inner.fill(cell, part, block)
    }

    fn subtree(&self, part: &W::Part) -> Option<Subtree<'_>> {
        self.inner.subtree(part)
    }
}
