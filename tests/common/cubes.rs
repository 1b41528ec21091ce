//! Solids of tests: functions of cubes, without anything that is remembered.

// Each test program uses its own part of this.
#![allow(dead_code)]

use leafless::{Block, Cell, Classifier, Cube, Error, Frame, Tag, Verdict, Worker};

/// A shape whose verdict of a cell needs nothing but the cell. Types that have it become solids by [`solid_of_cubes`].
pub trait Cubes: Clone + Send + Sync {
    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error>;

    fn sample(&self, _: &Cube<'_>) -> Result<Option<bool>, Error> {
        Ok(None)
    }

    fn fill(&self, _: &Cube<'_>, _: &mut Block) -> Result<bool, Error> {
        Ok(false)
    }

    fn exterior(&self, _: &Frame) -> Tag {
        Tag::Partial
    }
}

/// A shape on a frame: handle and worker.
#[derive(Clone)]
pub struct OnFrame<T> {
    shape: T,
    frame: Frame,
}

impl<T> OnFrame<T> {
    pub fn new(shape: T, frame: &Frame) -> OnFrame<T> {
        OnFrame { shape, frame: *frame }
    }
}

impl<T: Cubes> Classifier for OnFrame<T> {
    type Worker = OnFrame<T>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<OnFrame<T>, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        self.shape.exterior(&self.frame)
    }
}

impl<T: Cubes> Worker for OnFrame<T> {
    type Part = ();

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        self.shape.verdict(&Cube { frame: &self.frame, cell: Cell::ROOT })
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        let mut verdicts = [Verdict::Undecided; 8];
        for (octant, verdict) in (0..8).zip(&mut verdicts) {
            *verdict = self.shape.verdict(&Cube { frame: &self.frame, cell: cell.child(octant) })?;
        }
        Ok(verdicts)
    }

    fn sample(&mut self, cell: Cell, _: &()) -> Result<Option<bool>, Error> {
        self.shape.sample(&Cube { frame: &self.frame, cell })
    }

    fn fill(&mut self, cell: Cell, _: &(), block: &mut Block) -> Result<bool, Error> {
        self.shape.fill(&Cube { frame: &self.frame, cell }, block)
    }
}

/// Makes types with [`Cubes`] solids: `solid_of_cubes!(Ball, Dense<'a>: 'a)`.
#[macro_export]
macro_rules! solid_of_cubes {
    ($($type:ty $(: $life:lifetime)?),*) => {$(
        impl $(<$life>)? leafless::Solid for $type {
            type Classifier = $crate::common::cubes::OnFrame<$type>;

            fn on(
                &self,
                frame: &leafless::Frame,
                _: &leafless::Control<'_>,
            ) -> Result<Self::Classifier, leafless::Error> {
                Ok($crate::common::cubes::OnFrame::new(self.clone(), frame))
            }
        }
    )*};
}
