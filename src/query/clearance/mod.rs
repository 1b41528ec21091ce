//! How far apart are two solids?

mod nodes;
mod search;

use super::proven::Proven;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Frame, Interval, valid};
use crate::octree::Proof;
use crate::solid::Solid;
use search::Search;

/// What is known of the distance between two solids inside of the universe of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// The least distance between points of the two, in model units: 0 if they touch or overlap. The upper
    /// bound is infinite as long as one of them has no cell that is proven to be full, and the lower one too
    /// if one of them is proven to be empty.
    pub distance: Interval,
    /// Cells of the first and of the second solid with points that are no further apart than the upper bound.
    pub nearest: Option<[Cell; 2]>,
    /// Cells that were split, of the first solid and of the second.
    pub splits: [u64; 2],
    /// What of the first and of the second solid is proven: what is not counts as undecided.
    pub proofs: [Proof; 2],
    /// Whether one of the solids may go on outside of the universe, of which nothing is said.
    pub clipped: bool,
}

/// The distance between `a` and `b`, each as it is in the universe of `frame`: a solid under a placement is
/// moved first (see [`AnySolid::placed`](crate::AnySolid::placed)). The work ends when the interval is no
/// wider than `tolerance` (model units), at the frame's depth, or once `control.max_splits` cells of both are
/// split, with what is known by then; a cell whose children are looked at again, next to another one, counts
/// once more, because that is where the work is.
///
/// About twice the diagonal of a finest cell is what can be had for any solids. The work grows with the area
/// where the distance is about the least one, and with the distance, both measured in cells as large as the
/// tolerance. Memory is linear in the splits and in what is compared. One thread.
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
    let mut search = Search::new(&a, &b, control)?;
    search.run(tolerance, control.max_splits.unwrap_or(u64::MAX), &job)?;
    job.advance(WHOLE);
    Ok(search.found())
}
