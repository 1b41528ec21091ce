//! Walking depth first through the cells of a solid.

use crate::control::Job;
use crate::error::Error;
use crate::lattice::Cell;
use crate::solid::{Verdict, Worker};
use crate::walk::split_one;

/// Where a walk goes from a cell.
pub(crate) enum Step<P> {
    /// To its children.
    Into(P),
    /// To what comes after it.
    Past,
    /// Nowhere.
    End,
}

/// Walks depth first through what lies below a cell: `step` is shown each child, and says where to go.
/// `false` if it ended the walk. No part is kept. The recursion is as deep as the frame, 20 levels at the
/// most.
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
