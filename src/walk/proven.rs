//! A classifier that trusts only proven verdicts.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::octree::{Planes, Proof, Tag};
use crate::solid::forward::forward_parts;
use crate::solid::{
    Ask, Batch, Classifier, Parts, Question, Subtree, Verdict, WholeQuestion, Worker, split_twice,
};
use alloc::vec::Vec;

/// A classifier that trusts only proven verdicts. A FULL or EMPTY verdict that is not proven becomes
/// undecided. All searches use it.
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

    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error> {
        if self.0.proof().is_certified() { self.0.answer_whole(question, control) } else { Ok(()) }
    }
}

pub(crate) struct ProvenWorker<W> {
    inner: W,
    proof: Proof,
}

/// The verdict, if it is proven; otherwise undecided. Splitting would not help then.
fn proven<P>(proof: Proof, verdict: Verdict<P>) -> Verdict<P> {
    match verdict {
        Verdict::Full if !proof.full => Verdict::Undecided,
        Verdict::Empty if !proof.empty => Verdict::Undecided,
        Verdict::Partial(_) if !proof.full && !proof.empty => Verdict::Undecided,
        verdict => verdict,
    }
}

impl<W: Worker> Parts for ProvenWorker<W> {
    fn hand_over(&mut self, from: &Self, part: &W::Part) -> Result<W::Part, Error> {
        self.inner.hand_over(&from.inner, part)
    }

    forward_parts!(W::Part, self => self.inner);
}

impl<W: Worker> Batch for ProvenWorker<W> {
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
        let done = self.inner.split_many(cells, control, verdicts);
        if !self.proof.is_certified() {
            for verdict in verdicts[before..].as_flattened_mut() {
                *verdict = proven(self.proof, verdict.clone());
            }
        }
        done
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, W::Part)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        let before = inside.len();
        let done = self.inner.sample_many(cells, control, inside);
        inside[before..].iter_mut().for_each(|inside| *inside = self.proven_point(*inside));
        done
    }

    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        self.inner.inside(points, answers)?;
        answers.iter_mut().for_each(|answer| *answer = self.proven_point(*answer));
        Ok(())
    }

    fn recall(&mut self, cell: Cell) -> Option<W::Part> {
        self.inner.recall(cell)
    }
}

impl<W: Worker> ProvenWorker<W> {
    /// The answer for a point, if it is proven.
    fn proven_point(&self, inside: Option<bool>) -> Option<bool> {
        inside.filter(|&inside| if inside { self.proof.full } else { self.proof.empty })
    }
}

impl<W: Worker> Worker for ProvenWorker<W> {
    fn frame(&self) -> &Frame {
        self.inner.frame()
    }

    fn root(&mut self) -> Result<Verdict<W::Part>, Error> {
        Ok(proven(self.proof, self.inner.root()?))
    }

    #[inline(always)]
    fn split(&mut self, cell: Cell, part: &W::Part) -> Result<[Verdict<W::Part>; 8], Error> {
        // Usually everything is proven, and nothing is examined or copied.
        if self.proof.is_certified() {
            return self.inner.split(cell, part);
        }
        Ok(self.inner.split(cell, part)?.each(|verdict| proven(self.proof, verdict)))
    }

    /// If the solid proves only one side, answers about a cell are kept for that side only.
    #[inline]
    fn answer(&mut self, cell: Cell, part: &W::Part, question: Question<'_>) -> Result<(), Error> {
        if self.proof.is_certified() {
            return self.inner.answer(cell, part, question);
        }
        match question {
            Question::Centre(inside) => {
                *inside = self.inner.sample(cell, part)?;
                *inside = self.proven_point(*inside);
            }
            Question::Enclosure(known) => {
                *known = self.inner.enclosure(cell, part)?;
                for slab in known.iter_mut().flat_map(|enclosure| &mut enclosure.slabs) {
                    if !self.proof.full {
                        slab.inner = f64::NEG_INFINITY;
                    }
                    if !self.proof.empty {
                        slab.outer = f64::INFINITY;
                    }
                }
            }
            Question::Moments(_)
            | Question::Area(_)
            | Question::Crossing(..)
            | Question::Chords(_)
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
}
