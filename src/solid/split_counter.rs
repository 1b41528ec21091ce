//! A solid that counts its questions.

use super::forward::{forward_batch, forward_classifier, forward_parts, forward_solid};
use super::{Batch, Classifier, Parts, Question, Solid, Verdict, Worker};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Frame, MAX_DEPTH};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A solid that counts its splits, level by level, and how often it is put on a frame. It answers as the
/// wrapped solid does. Bulk production is turned off, so that every split is counted.
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
    /// Wraps a solid, with all counts at zero.
    pub fn new(solid: S) -> SplitCounter<S> {
        SplitCounter { solid, counts: Arc::default() }
    }

    /// The wrapped solid.
    pub fn solid(&self) -> &S {
        &self.solid
    }

    /// Returns the number of cells of each level that were split so far.
    pub fn splits(&self) -> [u64; MAX_DEPTH as usize] {
        self.counts.splits.each_ref().map(|count| count.load(Relaxed))
    }

    /// Returns how often the solid was put on a frame.
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

    fn worker(&self) -> Result<Self::Worker, Error> {
        Ok(CountingWorker { inner: self.inner.worker()?, counts: self.counts.clone() })
    }

    forward_classifier!(self => self.inner);
}

/// A worker whose splits are counted.
pub struct CountingWorker<W> {
    inner: W,
    counts: Arc<Counts>,
}

impl<W: Worker> CountingWorker<W> {
    fn count(&self, cell: Cell) {
        if let Some(count) = self.counts.splits.get(cell.level as usize) {
            count.fetch_add(1, Relaxed);
        }
    }
}

impl<W: Worker> Parts for CountingWorker<W> {
    fn hand_over(&mut self, from: &Self, part: &W::Part) -> Result<W::Part, Error> {
        self.inner.hand_over(&from.inner, part)
    }

    forward_parts!(W::Part, self => self.inner);
}

impl<W: Worker> Batch for CountingWorker<W> {
    fn likes_many(&self) -> bool {
        self.inner.likes_many()
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, W::Part)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<W::Part>; 8]>,
    ) -> Result<(), Error> {
        cells.iter().for_each(|(cell, _)| self.count(*cell));
        self.inner.split_many(cells, control, verdicts)
    }

    forward_batch!(answers W::Part, self => self.inner);
}

impl<W: Worker> Worker for CountingWorker<W> {
    fn frame(&self) -> &Frame {
        self.inner.frame()
    }

    fn root(&mut self) -> Result<Verdict<W::Part>, Error> {
        self.inner.root()
    }

    fn split(&mut self, cell: Cell, part: &W::Part) -> Result<[Verdict<W::Part>; 8], Error> {
        self.count(cell);
        self.inner.split(cell, part)
    }

    /// Rays are answered by descent, so that their splits are counted.
    fn answer(&mut self, cell: Cell, part: &W::Part, question: Question<'_>) -> Result<(), Error> {
        match question {
            Question::Chords(_) => Ok(()),
            question => self.inner.answer(cell, part, question),
        }
    }

    fn sample64(&mut self, cell: Cell, parts: &[(u8, W::Part)]) -> Result<Option<u64>, Error> {
        self.inner.sample64(cell, parts)
    }
}
