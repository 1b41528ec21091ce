//! How far apart are two solids?

mod nodes;
mod search;

use super::StopReason;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Frame, Interval, valid};
use crate::octree::Proof;
use crate::solid::Solid;
use crate::walk::Proven;
use search::Search;

/// What is known of the distance between two solids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// The least distance between points of the two, in model units: 0 if they touch or overlap. The upper
    /// bound is infinite as long as one of them has no cell that is proven to be full, and the lower one too
    /// if one of them is proven to be empty. The lower bound is 0 if `clipped`.
    pub distance: Interval,
    /// Cells of the first and of the second solid with points that are no further apart than the upper bound.
    pub nearest: Option<[Cell; 2]>,
    /// Why the search ended.
    pub stop_reason: StopReason,
    /// Cells that were split, of the first solid and of the second.
    pub splits: [u64; 2],
    /// What of the first and of the second solid is proven: what is not counts as undecided.
    pub proofs: [Proof; 2],
    /// Whether one of the solids may go on outside of the universe, where it may come nearer to the other.
    pub clipped: bool,
}

/// Steps that [`clearance`] takes if `control.max_splits` sets no other limit: some seconds, and some hundred
/// megabytes at the most.
pub const CLEARANCE_SPLITS: u64 = 1 << 20;

/// The least distance between `a` and `b`; a solid under a placement is moved first (see
/// [`AnySolid::placed`](crate::AnySolid::placed)). What is looked at is the universe of `frame`.
///
/// The search ends, and the result's `stop_reason` says why:
/// - `Tolerance`: the interval is no wider than `tolerance` (model units).
/// - `Exhausted`: the cells of the frame's depth cannot raise the lower bound, and the interval is no wider
///   than twice their diagonal, which is what cells can tell of most solids; or no pair of cells is left; or a
///   solid may go on outside of the universe, which keeps the lower bound at 0.
/// - `Budget`: `control.max_splits` steps were taken, or [`CLEARANCE_SPLITS`] if that is `None`. A step looks
///   at the children of one cell. A cell whose children are looked at again, next to another cell, counts once
///   more. Or what is remembered of a solid comes near to `control.max_bytes`.
///
/// The upper bound is finite once the search has met a FULL cell of each solid. It looks for them first, with
/// up to half of the budget. With nothing else left to do, it spends all of the budget on that.
///
/// The work grows with the area where the distance is about the least one, measured in cells as large as the
/// tolerance. Memory is linear in the steps and in what is compared. One thread.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; what the solids refuse;
/// [`Error::OutOfMemory`], and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, clearance};
/// let frame = Frame::new([0.0; 3], 128.0, 10)?;
/// let (a, b) = (Csg::ball([50.0; 3], 30.0)?, Csg::ball([86.0; 3], 30.0)?);
/// let found = clearance(&a, &b, &frame, 0.5, &Control::default())?;
/// assert!(found.distance.contains(36.0 * 3f64.sqrt() - 60.0) && found.distance.width() <= 0.5);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn clearance<A: Solid, B: Solid>(
    a: &A,
    b: &B,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Clearance, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    job.check()?;
    let (a, b) = (Proven(a.on(frame, control)?), Proven(b.on(frame, control)?));
    let budget = control.max_splits.unwrap_or(CLEARANCE_SPLITS);
    let found = Search::new(&a, &b, tolerance, budget, control)?.run(&job)?;
    job.advance(WHOLE);
    Ok(found)
}
