//! What a solid proves, and no more.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, CellMoments, Frame, Interval, VolumeMoments};
use crate::octree::{Planes, Proof, Tag};
use crate::solid::{Classifier, Enclosure, Subtree, Verdict, Worker, split_twice};
use alloc::vec::Vec;

/// A solid on a frame, of whose verdicts those are believed that are proven: a FULL or an EMPTY cell of which
/// that does not hold is undecided. What all searches ask.
#[derive(Clone)]
pub(crate) struct Proven<C>(pub(crate) C);

impl<C: Classifier> Classifier for Proven<C> {
    type Worker = ProvenWorker<C::Worker>;

    fn frame(&self) -> &Frame {
        self.0.frame()
    }

    fn worker(&self) -> Result<Self::Worker, Error> {
        Ok(ProvenWorker { inner: self.0.worker()?, proof: self.0.proof() })
    }

    fn exterior(&self) -> Tag {
        match (self.0.exterior(), self.0.proof()) {
            (Tag::Full, proof) if !proof.full => Tag::Partial,
            (Tag::Empty, proof) if !proof.empty => Tag::Partial,
            (exterior, _) => exterior,
        }
    }

    fn proof(&self) -> Proof {
        self.0.proof()
    }

    fn moments(&self, control: &Control<'_>) -> Result<Option<VolumeMoments>, Error> {
        if self.0.proof().is_certified() { self.0.moments(control) } else { Ok(None) }
    }

    fn area(&self, control: &Control<'_>) -> Result<Option<Interval>, Error> {
        if self.0.proof().is_certified() { self.0.area(control) } else { Ok(None) }
    }

    fn is_off_lattice(&self) -> bool {
        self.0.proof().is_certified() && self.0.is_off_lattice()
    }
}

pub(crate) struct ProvenWorker<W> {
    inner: W,
    proof: Proof,
}

/// A verdict as far as it is proven. Where nothing is, there is no reason to split.
fn proven<P>(proof: Proof, verdict: Verdict<P>) -> Verdict<P> {
    match verdict {
        Verdict::Full if !proof.full => Verdict::Undecided,
        Verdict::Empty if !proof.empty => Verdict::Undecided,
        Verdict::Partial(_) if !proof.full && !proof.empty => Verdict::Undecided,
        verdict => verdict,
    }
}

impl<W: Worker> Worker for ProvenWorker<W> {
    type Part = W::Part;

    fn frame(&self) -> &Frame {
        self.inner.frame()
    }

    fn root(&mut self) -> Result<Verdict<W::Part>, Error> {
        Ok(proven(self.proof, self.inner.root()?))
    }

    #[inline(always)]
    fn split(&mut self, cell: Cell, part: &W::Part) -> Result<[Verdict<W::Part>; 8], Error> {
        // As a rule all is proven, and nothing is looked at or copied.
        if self.proof.is_certified() {
            return self.inner.split(cell, part);
        }
        Ok(self.inner.split(cell, part)?.map(|verdict| proven(self.proof, verdict)))
    }

    fn mark(&self) -> usize {
        self.inner.mark()
    }

    fn scratch_bytes(&self) -> usize {
        self.inner.scratch_bytes()
    }

    fn release(&mut self, mark: usize) {
        self.inner.release(mark);
    }

    fn hand_over(&mut self, from: &Self, part: &W::Part) -> Result<W::Part, Error> {
        self.inner.hand_over(&from.inner, part)
    }

    fn recall(&mut self, cell: Cell) -> Option<W::Part> {
        self.inner.recall(cell)
    }

    fn split64(
        &mut self,
        cell: Cell,
        part: &W::Part,
        parts: &mut Vec<(u8, W::Part)>,
    ) -> Result<Planes, Error> {
        if self.proof.is_certified() {
            return self.inner.split64(cell, part, parts);
        }
        split_twice(self, cell, part, parts)
    }

    fn subtree(&self, part: &W::Part) -> Option<Subtree<'_>> {
        if self.proof.is_certified() { self.inner.subtree(part) } else { None }
    }

    fn enclosure(&mut self, cell: Cell, part: &W::Part) -> Result<Option<Enclosure>, Error> {
        let mut found = self.inner.enclosure(cell, part)?;
        for slab in found.iter_mut().flat_map(|enclosure| &mut enclosure.slabs) {
            if !self.proof.full {
                slab.inner = f64::NEG_INFINITY;
            }
            if !self.proof.empty {
                slab.outer = f64::INFINITY;
            }
        }
        Ok(found)
    }

    fn moments(&mut self, cell: Cell, part: &W::Part) -> Result<Option<CellMoments>, Error> {
        if self.proof.is_certified() { self.inner.moments(cell, part) } else { Ok(None) }
    }

    fn area(&mut self, cell: Cell, part: &W::Part) -> Result<Option<Interval>, Error> {
        if self.proof.is_certified() { self.inner.area(cell, part) } else { Ok(None) }
    }

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
        if !self.proof.is_certified() {
            for verdict in verdicts[before..].as_flattened_mut() {
                *verdict = proven(self.proof, verdict.clone());
            }
        }
        Ok(())
    }
}
