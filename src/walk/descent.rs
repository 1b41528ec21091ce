//! Depth-first walks through the cells of a solid.

use crate::control::Job;
use crate::error::Error;
use crate::lattice::Cell;
use crate::solid::{Verdict, Worker};
use crate::walk::split_one;

/// The next move of a walk.
pub(crate) enum Step<P> {
    /// To the children of the cell.
    Into(P),
    /// To the cell after this one.
    Past,
    /// The end of the walk.
    End,
}

/// Walks depth first through the cells below a cell. `step` gets each child and returns the next move.
/// Returns `false` if `step` ended the walk. No part is kept. The recursion is as deep as the frame, at most
/// 20 levels.
pub(crate) fn descend<W: Worker>(
    worker: &mut W,
    cell: Cell,
    part: &W::Part,
    job: &Job<'_>,
    step: &mut impl FnMut(Cell, Verdict<W::Part>) -> Step<W::Part>,
) -> Result<bool, Error> {
    job.check()?;
    let mark = worker.mark();
    for (octant, verdict) in (0..8).zip(split_one(worker, cell, part, job.control())?) {
        let child = cell.child(octant);
        let goes_on = match step(child, verdict) {
            Step::Into(part) => descend(worker, child, &part, job, step)?,
            Step::Past => true,
            Step::End => false,
        };
        if !goes_on {
            return Ok(false);
        }
    }
    worker.release(mark);
    Ok(true)
}
