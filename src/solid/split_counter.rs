//! A solid that counts what it is asked.

use super::forward::{forward_solid, forward_worker};
use super::{Classifier, Solid, Verdict, Worker};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Frame, Interval, MAX_DEPTH, VolumeMoments};
use crate::octree::{Proof, Tag};
use alloc::sync::Arc;
use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A solid that counts how often it is put on a frame, and its splits, level by level. It answers as the
/// solid that it wraps; bulk production is turned off, so that every split is counted.
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build, solid::SplitCounter};
/// // The sphere of a published table: 65 cells of levels 0 to 2 are split.
/// let sphere = SplitCounter::new(Csg::ball([64.0; 3], 64.0)?);
/// build(&sphere, &Frame::new([0.0; 3], 128.0, 3)?, Rule::Certified, &Control::default())?;
/// assert_eq!(sphere.splits()[..3].iter().sum::<u64>(), 65);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug)]
pub struct SplitCounter<S> {
    solid: S,
    counts: Arc<Counts>,
}

#[derive(Debug, Default)]
struct Counts {
    splits: [AtomicU64; MAX_DEPTH as usize],
    frames: AtomicU64,
}

impl<S: Solid> SplitCounter<S> {
    /// Counts from zero.
    pub fn new(solid: S) -> SplitCounter<S> {
        SplitCounter { solid, counts: Arc::default() }
    }

    /// The solid that is counted.
    pub fn solid(&self) -> &S {
        &self.solid
    }

    /// How many cells of each level were split so far.
    pub fn splits(&self) -> [u64; MAX_DEPTH as usize] {
        self.counts.splits.each_ref().map(|count| count.load(Relaxed))
    }

    /// How often the solid was put on a frame.
    pub fn frames(&self) -> u64 {
        self.counts.frames.load(Relaxed)
    }
}

impl<S: Solid> Solid for SplitCounter<S> {
    type Classifier = CountingClassifier<S::Classifier>;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<Self::Classifier, Error> {
        self.counts.frames.fetch_add(1, Relaxed);
        Ok(CountingClassifier { inner: self.solid.on(frame, control)?, counts: self.counts.clone() })
    }

    forward_solid!(@description self => self.solid);
}

/// A solid on a frame whose splits are counted.
#[derive(Debug, Clone)]
pub struct CountingClassifier<C> {
    inner: C,
    counts: Arc<Counts>,
}

impl<C: Classifier> Classifier for CountingClassifier<C> {
    type Worker = CountingWorker<C::Worker>;

    fn frame(&self) -> &Frame {
        self.inner.frame()
    }

    fn worker(&self) -> Result<Self::Worker, Error> {
        Ok(CountingWorker { inner: self.inner.worker()?, counts: self.counts.clone() })
    }

    fn exterior(&self) -> Tag {
        self.inner.exterior()
    }

    fn proof(&self) -> Proof {
        self.inner.proof()
    }

    fn moments(&self, control: &Control<'_>) -> Result<Option<VolumeMoments>, Error> {
        self.inner.moments(control)
    }

    fn area(&self, control: &Control<'_>) -> Result<Option<Interval>, Error> {
        self.inner.area(control)
    }

    fn is_off_lattice(&self) -> bool {
        self.inner.is_off_lattice()
    }
}

/// A worker whose splits are counted.
pub struct CountingWorker<W> {
    inner: W,
    counts: Arc<Counts>,
}

impl<W: Worker> Worker for CountingWorker<W> {
    type Part = W::Part;

    fn split(&mut self, cell: Cell, part: &W::Part) -> Result<[Verdict<W::Part>; 8], Error> {
        if let Some(count) = self.counts.splits.get(cell.level as usize) {
            count.fetch_add(1, Relaxed);
        }
        self.inner.split(cell, part)
    }

    fn hand_over(&mut self, from: &Self, part: &W::Part) -> Result<W::Part, Error> {
        self.inner.hand_over(&from.inner, part)
    }

    forward_worker!(memory W::Part, self => self.inner);
    forward_worker!(answers W::Part, self => self.inner);
}
