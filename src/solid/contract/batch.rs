//! Questions about many cells or points at once.

use super::{Ask, Parts, Verdict, Worker};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use alloc::vec::Vec;

/// Questions about many cells or points at once.
///
/// A host program's function may take milliseconds a call, or may answer a thousand boxes as fast as one. For
/// such a solid a caller gathers cells and queries a whole level at once, with all its threads. No method has
/// a default, so that batches work through every wrapper. A worker that gains nothing from batches implements
/// [`OneByOne`], in one line.
///
/// # Laws
/// The answers are the same as those of the single forms, [`Worker::split`] and
/// [`Question::Centre`](super::Question::Centre). The parts in the verdicts of one call live together: the
/// memory of one is not released before that of the others.
pub trait Batch: Parts {
    /// Returns whether answers are expensive, or cheaper in batches. A caller then gathers cells for
    /// [`split_many`](Self::split_many), and uses threads even for few cells.
    fn likes_many(&self) -> bool;

    /// Splits many PARTIAL cells: appends the result of [`Worker::split`] for each cell, in their order.
    /// `control` can cancel the call half-way. Results that were appended before an error are valid.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors), and [`Error::Cancelled`].
    fn split_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<Self::Part>; 8]>,
    ) -> Result<(), Error>;

    /// Samples the centres of many PARTIAL cells of the frame's depth: appends the answer to
    /// [`Question::Centre`](super::Question::Centre) for each cell, in their order. `control` can cancel the
    /// call half-way. Results that were appended before an error are valid.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors), and [`Error::Cancelled`].
    fn sample_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error>;

    /// Decides whether points of the universe (model units) lie in the solid. Sets `answers[i]` for
    /// `points[i]` where the answer is known without a descent. On the boundary either answer is correct. The
    /// caller descends for the points that are left open.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error>;

    /// The part of a PARTIAL cell, computed without the path to the cell. `Some` if the part depends on the
    /// cell alone; then no caller replays splits. A worker that returns `Some` for one cell returns it for
    /// all cells.
    fn recall(&mut self, cell: Cell) -> Option<Self::Part>;
}

/// A worker that answers one question after the other and cannot decide points. This trait alone gives it
/// [`Batch`].
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

/// Implements [`Batch::split_many`] for a worker that splits one cell after the other.
///
/// # Errors
/// [Those of every question](Worker#errors), and [`Error::Cancelled`].
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

/// Implements [`Batch::sample_many`] for a worker that samples one centre after the other.
///
/// # Errors
/// [Those of every question](Worker#errors), and [`Error::Cancelled`].
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
