//! Questions about many cells, and about points, at once.

use super::{Ask, Parts, Verdict, Worker};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use alloc::vec::Vec;

/// How a worker answers questions about many cells or points at once.
///
/// A host program's function may take milliseconds a call, or answer a thousand boxes as fast as one. A
/// caller that meets such a solid gathers cells, and asks a level at once, with all its threads. So that this
/// works through every wrapper, no method has a default. A worker that gains nothing from many questions at
/// once says so in one line: [`OneByOne`].
///
/// # Laws
/// The answers are those of the single forms: of [`Worker::split`] and of
/// [`Question::Centre`](super::Question::Centre). All verdicts of one call have parts that live together: the
/// memory of none of them is released before that of the others.
pub trait Batch: Parts {
    /// Whether answers are dear, or come more cheaply many at a time. A caller then gathers cells for
    /// [`split_many`](Self::split_many), and uses threads even for few of them.
    fn likes_many(&self) -> bool;

    /// Splits many PARTIAL cells: appends what [`Worker::split`] says of each, in their order. `control` can
    /// cancel the call half-way. What was appended before an error is right.
    ///
    /// # Errors
    /// As all questions, and [`Error::Cancelled`].
    fn split_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<Self::Part>; 8]>,
    ) -> Result<(), Error>;

    /// Samples the centres of many PARTIAL cells of the frame's depth: appends what
    /// [`Question::Centre`](super::Question::Centre) answers for each, in their order. `control` can cancel
    /// the call half-way. What was appended before an error is right.
    ///
    /// # Errors
    /// As all questions, and [`Error::Cancelled`].
    fn sample_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error>;

    /// Whether points of the universe (model units) lie in the solid: sets `answers[i]` for `points[i]` where
    /// that is known without a descent. On the boundary either answer is right. Where nothing is set, the
    /// caller descends.
    ///
    /// # Errors
    /// As all questions.
    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error>;

    /// The part of a PARTIAL cell without the way to it, if the part depends on the cell alone; then no
    /// caller replays splits. A worker that answers for one cell answers for all.
    fn recall(&mut self, cell: Cell) -> Option<Self::Part>;
}

/// A worker that answers one question after the other, and knows nothing of points: it has [`Batch`] by this
/// line alone.
pub trait OneByOne {}

impl<W: Worker + OneByOne> Batch for W {
    fn likes_many(&self) -> bool {
        false
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<Self::Part>; 8]>,
    ) -> Result<(), Error> {
        split_one_by_one(self, cells, control, verdicts)
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        sample_one_by_one(self, cells, control, inside)
    }

    fn inside(&mut self, _: &[[f64; 3]], _: &mut [Option<bool>]) -> Result<(), Error> {
        Ok(())
    }

    fn recall(&mut self, _: Cell) -> Option<Self::Part> {
        None
    }
}

/// [`Batch::split_many`] of a worker that splits one cell after the other.
///
/// # Errors
/// As all questions, and [`Error::Cancelled`].
pub fn split_one_by_one<W: Worker + ?Sized>(
    worker: &mut W,
    cells: &[(Cell, W::Part)],
    control: &Control<'_>,
    verdicts: &mut Vec<[Verdict<W::Part>; 8]>,
) -> Result<(), Error> {
    verdicts.try_reserve(cells.len())?;
    for (cell, part) in cells {
        control.check()?;
        verdicts.push(worker.split(*cell, part)?);
    }
    Ok(())
}

/// [`Batch::sample_many`] of a worker that samples one centre after the other.
///
/// # Errors
/// As all questions, and [`Error::Cancelled`].
pub fn sample_one_by_one<W: Worker + ?Sized>(
    worker: &mut W,
    cells: &[(Cell, W::Part)],
    control: &Control<'_>,
    inside: &mut Vec<Option<bool>>,
) -> Result<(), Error> {
    inside.try_reserve(cells.len())?;
    for (cell, part) in cells {
        control.check()?;
        inside.push(worker.sample(*cell, part)?);
    }
    Ok(())
}
