//! A solid that is split only until its surface is known to a tolerance.

use super::forward::{forward_answers, forward_batch, forward_classifier, forward_parts};
use super::{
    Ask, Batch, Classifier, Enclosure, Fingerprint, Fingerprinter, Motion, Parts, Solid, Verdict, Worker,
};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::lattice::{Bounds, Cell, Cube, Frame, valid};
use alloc::vec::Vec;

/// A solid that is not split where its surface is known to a tolerance. An octree of it stays coarse where
/// the surface is flat, and is fine at edges and where the surface is curved.
///
/// A cell is not split if the surface in it is known to lie within a layer thinner than the tolerance. Such a
/// cell is [`Verdict::Undecided`], and PARTIAL in an octree. The solid itself knows more about the cell: its
/// [`Enclosure`]. The distance between the inner and the outer side of each slab is at most the tolerance. A
/// solid without enclosures is split as usual.
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build, solid::Adaptive};
/// let ball = Csg::ball([0.0; 3], 0.9)?;
/// let frame = Frame::new([-1.0; 3], 2.0, 9)?;
/// let whole = build(&ball, &frame, Rule::Certified, &Control::default())?;
/// let coarse = build(&Adaptive::new(ball, 0.001)?, &frame, Rule::Certified, &Control::default())?;
/// assert!(coarse.statistics().nodes() * 50 < whole.statistics().nodes());
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Adaptive<S> {
    solid: S,
    tolerance: f64,
}

impl<S: Solid> Adaptive<S> {
    /// Wraps a solid, with a tolerance in model units.
    ///
    /// # Errors
    /// [`Error::Argument`] if `tolerance` is negative or not a number.
    pub fn new(solid: S, tolerance: f64) -> Result<Adaptive<S>, Error> {
        valid::tolerance("tolerance", tolerance)?;
        Ok(Adaptive { solid, tolerance })
    }

    /// The solid without the tolerance.
    pub fn solid(&self) -> &S {
        &self.solid
    }
}

impl<S: Solid> Solid for Adaptive<S> {
    type Classifier = AdaptiveClassifier<S::Classifier>;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<Self::Classifier, Error> {
        Ok(AdaptiveClassifier { inner: self.solid.on(frame, control)?, tolerance: self.tolerance })
    }

    fn bounds(&self) -> Option<Bounds> {
        self.solid.bounds()
    }

    fn home(&self) -> Option<Frame> {
        self.solid.home()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let inner = self.solid.fingerprint()?;
        Some(Fingerprinter::new("adaptive").part(inner).numbers(&[self.tolerance]).finish())
    }

    fn motion(&self) -> Motion {
        Motion::Conservative
    }

    fn kept_bytes(&self) -> u64 {
        self.solid.kept_bytes()
    }
}

/// An adaptive solid on a frame.
#[derive(Debug, Clone)]
pub struct AdaptiveClassifier<C> {
    inner: C,
    tolerance: f64,
}

impl<C: Classifier> Classifier for AdaptiveClassifier<C> {
    type Worker = AdaptiveWorker<C::Worker>;

    fn worker(&self) -> Result<Self::Worker, Error> {
        Ok(AdaptiveWorker { inner: self.inner.worker()?, tolerance: self.tolerance })
    }

    forward_classifier!(self => self.inner);
}

/// A worker on an adaptive solid.
pub struct AdaptiveWorker<W> {
    inner: W,
    tolerance: f64,
}

impl<W: Worker> AdaptiveWorker<W> {
    /// Makes the verdicts undecided for those children whose surface is known to the tolerance.
    fn enough(
        &mut self,
        cell: Cell,
        mut verdicts: [Verdict<W::Part>; 8],
    ) -> Result<[Verdict<W::Part>; 8], Error> {
        for (octant, verdict) in (0..8).zip(&mut verdicts) {
            let Verdict::Partial(part) = verdict else { continue };
            let child = cell.child(octant);
            let half_edge = Cube { frame: self.inner.frame(), cell: child }.half_edge();
            if let Some(enclosure) = self.inner.enclosure(child, part)?
                && thickness(&enclosure) * half_edge <= self.tolerance
            {
                *verdict = Verdict::Undecided;
            }
        }
        Ok(verdicts)
    }
}

/// The greatest distance between the two sides of a slab, in half edges of the cell.
fn thickness(enclosure: &Enclosure) -> f64 {
    let mut most = None;
    for slab in &enclosure.slabs {
        let square = slab.normal.iter().map(|c| c * c).sum::<f64>();
        if square > 0.0 {
            // (A distance that is infinite or NaN counts as infinite.)
            let own = (slab.outer - slab.inner) / sqrt(square);
            most = Some(if own >= 0.0 { own.max(most.unwrap_or(0.0)) } else { f64::INFINITY });
        }
    }
    most.unwrap_or(f64::INFINITY)
}

impl<W: Worker> Parts for AdaptiveWorker<W> {
    fn hand_over(&mut self, from: &Self, part: &W::Part) -> Result<W::Part, Error> {
        self.inner.hand_over(&from.inner, part)
    }

    forward_parts!(W::Part, self => self.inner);
}

impl<W: Worker> Batch for AdaptiveWorker<W> {
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
        for (k, (cell, _)) in (before..verdicts.len()).zip(cells) {
            match self.enough(*cell, verdicts[k].clone()) {
                Ok(eight) => verdicts[k] = eight,
                Err(error) => {
                    verdicts.truncate(k);
                    return Err(error);
                }
            }
        }
        done
    }

    forward_batch!(answers W::Part, self => self.inner);
}

impl<W: Worker> Worker for AdaptiveWorker<W> {
    fn split(&mut self, cell: Cell, part: &W::Part) -> Result<[Verdict<W::Part>; 8], Error> {
        let verdicts = self.inner.split(cell, part)?;
        self.enough(cell, verdicts)
    }

    forward_answers!(W::Part, self => self.inner);
}
