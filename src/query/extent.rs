//! Where a solid begins and ends along each axis.

use super::StopReason;
use super::proven::Proven;
use super::queue::Queue;
use super::subject::Subject;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame, Interval, MAX_DEPTH, valid};
use crate::octree::Proof;
use crate::op::gathered::Part;
use crate::solid::{Classifier, Solid, Verdict, Worker};
use core::cmp::Reverse;

/// What is proven of the bounding box of a solid's part inside of the universe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// The lower and the upper corner, in model units: intervals that contain the truth. `None` if the solid
    /// is proven empty.
    pub corners: Option<[[Interval; 3]; 2]>,
    /// Whether the solid is proven not to be empty. If neither is proven, the corners are those of what the
    /// solid may be, and it may be empty.
    pub occupied: bool,
    /// What of the solid is proven: what is not counts as undecided.
    pub proof: Proof,
    /// Whether the solid may go on outside of the universe, or does.
    pub clipped: bool,
    /// Why it ended; [`Tolerance`](StopReason::Tolerance) means that no interval is wider than was asked for,
    /// or than one of the frame's finest cells.
    pub stop_reason: StopReason,
    /// How many times a cell was split.
    pub splits: u64,
}

/// The bounding box of `solid` in the universe of `frame`: each of its sides until the interval is at most
/// `tolerance` (model units) or one finest cell wide, `max_splits` of `control` are spent, or nothing is left
/// to split. The result does not depend on the number of threads, since there is only one.
///
/// Only cells are split that may reach beyond what is proven solid, those first that reach farthest. With n
/// the edge of the universe over the tolerance that takes some n splits for a curved side and, unless it lies
/// on a plane of the lattice, n² for a flat one, because each cell in front of it must be proven empty. Time
/// is linear in the splits but for a logarithm, and so is memory. Set `max_splits` if it may be that nothing
/// is proven full, as of a sheet without thickness: then no tolerance is met, and all that is undecided is
/// split. Each side gets its share of what those before it have left.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; what the solid refuses, as
/// [`build`](crate::build); [`Error::Cancelled`]; [`Error::OutOfMemory`].
///
/// ```
/// use leafless::{Control, Csg, Frame, bounding_box};
/// let frame = Frame::new([-1.0; 3], 2.0, 20)?;
/// let extent = bounding_box(&Csg::ball([0.1, 0.0, 0.0], 0.75)?, &frame, 0.001, &Control::default())?;
/// let [min, max] = extent.corners.unwrap();
/// assert!(min[0].contains(-0.65) && max[0].contains(0.85) && max[0].width() <= 0.001);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn bounding_box<S: Solid>(
    solid: &S,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Extent, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    // The cast rounds down, and saturates.
    let goal = ((tolerance / frame.cell_size()) as u32).max(1);
    let classifier = Proven(solid.on(frame, control)?);
    let mut search = Search {
        subject: Subject::new(&classifier, control)?,
        frame,
        job: &job,
        goal,
        inner: [NOWHERE; 6],
        outer: [NOWHERE; 6],
        stuck: NOWHERE,
        open: Queue::new(),
    };
    let budget = control.max_splits.unwrap_or(u64::MAX);
    let mut unfinished = false;
    let mark = search.subject.worker.mark();
    for side in 0..6 {
        let share = (budget - search.subject.splits) / (6 - side as u64);
        unfinished |= !search.side(side, share)?;
        search.subject.worker.release(mark);
        job.advance(WHOLE / 6 + if side == 0 { WHOLE % 6 } else { 0 });
    }
    // Both are nowhere if the solid is empty, and the difference is large if nothing is proven FULL.
    let wide = (0..6).any(|side| search.inner[side].saturating_sub(search.outer[side]) > goal);
    Ok(Extent {
        corners: search.corners(),
        occupied: search.inner[0] != NOWHERE,
        proof: classifier.proof(),
        clipped: search.subject.is_clipped(),
        stop_reason: match (wide, unfinished) {
            (false, _) => StopReason::Tolerance,
            (true, true) => StopReason::Budget,
            (true, false) => StopReason::Exhausted,
        },
        splits: search.subject.splits,
    })
}

/// Farther than any plane. (Differences saturate: a host that contradicts itself may put a solid before its
/// bounds.)
const NOWHERE: u32 = u32::MAX;

/// Where a cell begins, its height above the deepest level, the order of meeting.
type Key = Reverse<(u32, u8, u64)>;

/// Sides are numbered: 0 to 2 the lower ones along x, y and z, 3 to 5 the upper ones. What lies at a side is
/// told by its distance from the universe's face there, in finest cells.
struct Search<'a, C: Classifier> {
    subject: Subject<'a, C>,
    frame: &'a Frame,
    job: &'a Job<'a>,
    /// How many finest cells an interval may be wide.
    goal: u32,
    /// Where the first FULL cell that was met begins.
    inner: [u32; 6],
    /// Where the first cell begins that is not EMPTY.
    outer: [u32; 6],
    /// Where the first cell begins, seen from the present side, that is undecided and cannot be split.
    stuck: u32,
    /// Those that can be split.
    open: Queue<Key, (Cell, Part<C>)>,
}

impl<C: Classifier> Search<'_, C> {
    /// Where a cell begins, seen from a side.
    fn start(&self, side: usize, cell: Cell) -> u32 {
        let (lower, upper) = Cube { frame: self.frame, cell }.planes();
        if side < 3 { lower[side] } else { self.frame.cells() - upper[side - 3] }
    }

    /// Splits the cells that begin first, and of those the smallest. `false` if the share has ended it.
    fn side(&mut self, side: usize, share: u64) -> Result<bool, Error> {
        self.job.check()?;
        let last = self.subject.splits + share;
        (self.stuck, self.open) = (NOWHERE, Queue::new());
        let root = self.subject.worker.root()?;
        self.note(side, Cell::ROOT, root)?;
        loop {
            let start = self.open.peek().map_or(NOWHERE, |entry| entry.key.0.0);
            self.outer[side] = self.inner[side].min(self.stuck).min(start);
            let is_known = self.inner[side].saturating_sub(self.outer[side]) <= self.goal;
            let Some((cell, part)) = self.open.pop().filter(|_| !is_known) else { return Ok(true) };
            if self.subject.splits == last {
                return Ok(false);
            }
            self.job.check()?;
            for (octant, verdict) in (0..8).zip(self.subject.split(cell, &part)?) {
                self.note(side, cell.child(octant), verdict)?;
            }
        }
    }

    fn note(&mut self, side: usize, cell: Cell, verdict: Verdict<Part<C>>) -> Result<(), Error> {
        let start = self.start(side, cell);
        match verdict {
            Verdict::Empty => {}
            Verdict::Full => {
                for side in 0..6 {
                    self.inner[side] = self.inner[side].min(self.start(side, cell));
                }
            }
            Verdict::Partial(part) if cell.level < self.frame.depth() => {
                let key = Reverse((start, MAX_DEPTH - cell.level, self.open.met()));
                self.open.push(key, (cell, part))?;
            }
            Verdict::Undecided | Verdict::Partial(_) => self.stuck = self.stuck.min(start),
        }
        Ok(())
    }

    fn corners(&self) -> Option<[[Interval; 3]; 2]> {
        if self.outer[0] == NOWHERE {
            return None;
        }
        let mut corners = [[Interval::exactly(0.0); 3]; 2];
        for axis in 0..3 {
            // With nothing proven FULL, each side may be wherever the solid may be.
            let reach = |side: usize, other: usize| match self.inner[side] {
                NOWHERE => self.frame.cells().saturating_sub(self.outer[other]),
                inner => inner,
            };
            let (near, far) = (axis, axis + 3);
            let plane = |i: u32| self.frame.plane(axis, i);
            let between = |a: u32, b: u32| Interval { lower: plane(a).lower, upper: plane(b).upper };
            let opposite = |i: u32| self.frame.cells().saturating_sub(i);
            corners[0][axis] = between(self.outer[near], reach(near, far));
            corners[1][axis] = between(opposite(reach(far, near)), opposite(self.outer[far]));
        }
        Some(corners)
    }
}
