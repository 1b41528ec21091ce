//! Do two solids overlap, and by how much?

mod children;
mod search;

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Affine, Cell, Frame, Interval, valid};
use crate::memory;
use crate::octree::Proof;
use crate::parallel;
use crate::parallel::each;
use crate::solid::{Solid, TransformClassifier};
use crate::walk::Proven;
use alloc::vec::Vec;
use search::Search;

/// Whether the interiors of two solids have points in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Overlap {
    /// Proven: they have none. The solids may touch.
    Disjoint = 0,
    /// Proven: a cell lies in both.
    Overlapping = 1,
    /// Not decided at the frame's depth, or before the splits were spent; or both solids go on outside of the
    /// universe, where they may overlap.
    Undecided = 2,
}

/// What is known of two solids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interference {
    /// Whether they overlap.
    pub verdict: Overlap,
    /// A cell that lies in both, if they are proven to overlap.
    pub witness: Option<Cell>,
    /// The volume of what they have in common, in cubic model units; the upper bound is infinite if `clipped`.
    pub volume: Interval,
    /// Cells that were split, of the first solid and of the second.
    pub splits: [u64; 2],
    /// The finest level of which cells were looked at.
    pub level: u8,
    /// What of the first and of the second solid is proven: what is not counts as undecided.
    pub proofs: [Proof; 2],
    /// Whether both solids may go on outside of the universe. Then they are not proven to be disjoint. (If one
    /// of them lies inside, all that they have in common does.)
    pub clipped: bool,
}

/// Whether `a` and `b` overlap; a solid under a placement is moved first (see
/// [`AnySolid::placed`](crate::AnySolid::placed)). What is looked at is the universe of `frame`. Once an overlap is
/// proven its volume is refined until the interval is no wider than `tolerance` (cubic model units); infinity ends the
/// work with the proof.
///
/// The work ends at the frame's depth, or once `control.max_splits` cells of both are split or what is remembered of
/// them comes near to `control.max_bytes`, with what is known by then. Memory is linear in the cells that are not
/// decided. One thread; a host program's shape is asked about several cells at once, by as many threads as `control`
/// allows.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; what the solids refuse;
/// [`Error::OutOfMemory`], and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, interference, query::Overlap};
/// let frame = Frame::new([0.0; 3], 128.0, 10)?;
/// let (a, b) = (Csg::ball([50.0; 3], 30.0)?, Csg::ball([83.0; 3], 30.0)?);
/// let found = interference(&a, &b, &frame, f64::INFINITY, &Control::default())?;
/// assert_eq!(found.verdict, Overlap::Overlapping);
/// assert!(found.volume.lower > 0.0 && found.splits.iter().sum::<u64>() <= 80);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn interference<A: Solid, B: Solid>(
    a: &A,
    b: &B,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Interference, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    let (a, b) = (Proven(a.on(frame, control)?), Proven(b.on(frame, control)?));
    let search = Search::new(&a, &b, control)?;
    let found = control.run(search.likes_many(), |parallel| {
        search.run(tolerance, if parallel { parallel::threads() } else { 1 }, &job)
    })?;
    job.advance(WHOLE);
    Ok(found)
}

/// As [`interference`] of `a` with `b` under each of the `placements`, in their order; the first of both is
/// known on `frame`, the second on its `own` frame, and both are prepared once. The same for any number of
/// threads; `control.max_splits` concerns each placement.
///
/// # Errors
/// As [`interference`].
pub fn interference_at<A: Solid, B: Solid>(
    a: &A,
    b: &B,
    own: &Frame,
    placements: &[Affine],
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Vec<Interference>, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    let bounds = b.bounds();
    let (a, b) = (Proven(a.on(frame, control)?), b.on(own, control)?);
    let one = |placement: &Affine| {
        let around = bounds.and_then(|bounds| bounds.placed(placement));
        let b = Proven(TransformClassifier::new(b.clone(), placement, frame, around));
        let found = Search::new(&a, &b, control)?.run(tolerance, 1, &job)?;
        job.advance(WHOLE / placements.len());
        Ok::<_, Error>(found)
    };
    let mut found = memory::with_capacity(placements.len())?;
    control.run(placements.len() > 1, |parallel| {
        // By pieces, so that what is collected behind the scenes stays small.
        for piece in placements.chunks(PIECE) {
            found.extend(each(parallel, piece.iter(), one)?);
        }
        Ok(found)
    })
}

/// Placements that are handed to the threads at once.
const PIECE: usize = 4096;
