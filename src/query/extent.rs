//! Where a solid begins and ends along each axis.

use super::{Measured, check_tolerance};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame, Interval, MAX_DEPTH};
use crate::octree::Tag;
use crate::op::split_one;
use crate::solid::{Classifier, Solid, Verdict, Worker};
use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Reverse;

/// What is proven of the bounding box of a solid's part inside of the universe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// The lower and the upper corner, in model units: intervals that contain the truth. `None` if the solid is proven
    /// empty.
    pub corners: Option<[[Interval; 3]; 2]>,
    /// Whether the solid is proven not to be empty. If neither is proven, the corners are those of what the solid may
    /// be, and it may be empty.
    pub occupied: bool,
    /// Whether the solid may go on outside of the universe, or does.
    pub clipped: bool,
    /// Why it ended; [`Tolerance`](Measured::Tolerance) means that no interval is wider than was asked for, or than
    /// one of the frame's finest cells.
    pub measured: Measured,
    /// How many times a cell was split.
    pub splits: u64,
}

/// The bounding box of `solid` in the universe of `frame`: each of its sides until the interval is at most `tolerance`
/// (model units) or one finest cell wide, `max_splits` of `control` are spent, or nothing is left to split. The result
/// does not depend on the number of threads, since there is only one.
///
/// Only cells are split that may reach beyond what is proven solid, those first that reach farthest. With n the edge of
/// the universe over the tolerance that takes some n splits for a curved side and, unless it lies on a plane of the
/// lattice, n² for a flat one, because each cell in front of it must be proven empty. Time is linear in the splits but
/// for a logarithm, and so is memory. Set `max_splits` if it may be that nothing is proven full, as of a sheet without
/// thickness: then no tolerance is met, and all that is undecided is split. Each side gets its share of what those before
/// it have left.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; what the solid refuses, as
/// [`build`](crate::build); [`Error::Cancelled`]; [`Error::OutOfMemory`].
///
/// ```
/// use leafless::{Ball, Control, Frame, bounding_box};
/// let frame = Frame::new([-1.0; 3], 2.0, 20)?;
/// let extent = bounding_box(&Ball::new([0.1, 0.0, 0.0], 0.75)?, &frame, 0.001, &Control::default())?;
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
    check_tolerance(tolerance)?;
    let job = Job::new(control);
    // The cast rounds down, and saturates.
    let goal = ((tolerance / frame.cell_size()) as u32).max(1);
    let classifier = solid.on(frame, control)?;
    let mut search = Search { frame, job: &job, goal, inner: [NOWHERE; 6], outer: [NOWHERE; 6] };
    let budget = control.max_splits.unwrap_or(u64::MAX);
    let (mut left, mut unfinished) = (budget, false);
    let mut worker = classifier.worker()?;
    let mark = worker.mark();
    for side in 0..6 {
        let share = left / (6 - side as u64);
        let mut own = share;
        unfinished |= !search.side(side, &mut worker, &mut own)?;
        worker.release(mark);
        left -= share - own;
        job.advance(WHOLE / 6 + if side == 0 { WHOLE % 6 } else { 0 });
    }
    // Both are nowhere if the solid is empty, and the difference is large if nothing is proven FULL.
    let wide = (0..6).any(|side| search.inner[side].saturating_sub(search.outer[side]) > goal);
    Ok(Extent {
        corners: search.corners(),
        occupied: search.inner[0] != NOWHERE,
        clipped: classifier.exterior() != Tag::Empty,
        measured: match (wide, unfinished) {
            (false, _) => Measured::Tolerance,
            (true, true) => Measured::Budget,
            (true, false) => Measured::Exhausted,
        },
        splits: budget - left,
    })
}

/// Farther than any plane. (Differences saturate: a host that contradicts itself may put a solid before its bounds.)
const NOWHERE: u32 = u32::MAX;

/// Sides are numbered: 0 to 2 the lower ones along x, y and z, 3 to 5 the upper ones. What lies at a side is told by
/// its distance from the universe's face there, in finest cells.
struct Search<'a> {
    frame: &'a Frame,
    job: &'a Job<'a>,
    /// How many finest cells an interval may be wide.
    goal: u32,
    /// Where the first FULL cell that was met begins.
    inner: [u32; 6],
    /// Where the first cell begins that is not EMPTY.
    outer: [u32; 6],
}

impl Search<'_> {
    /// Where a cell begins, seen from a side.
    fn start(&self, side: usize, cell: Cell) -> u32 {
        let (lower, upper) = Cube { frame: self.frame, cell }.planes();
        if side < 3 { lower[side] } else { self.frame.cells() - upper[side - 3] }
    }

    /// Splits the cells that begin first, and of those the smallest. `false` if the budget has ended it.
    fn side<W: Worker>(&mut self, side: usize, worker: &mut W, left: &mut u64) -> Result<bool, Error> {
        self.job.check()?;
        let mut open = Open { cells: Vec::new(), queue: BinaryHeap::new(), stuck: NOWHERE };
        let root = worker.root()?;
        self.note(side, Cell::ROOT, root, &mut open)?;
        loop {
            let next = open.queue.peek().copied();
            let start = next.map_or(NOWHERE, |Reverse((start, ..))| start);
            self.outer[side] = self.inner[side].min(open.stuck).min(start);
            let is_known = self.inner[side].saturating_sub(self.outer[side]) <= self.goal;
            let Some(Reverse((_, _, index))) = next.filter(|_| !is_known) else { return Ok(true) };
            if *left == 0 {
                return Ok(false);
            }
            *left -= 1;
            self.job.check()?;
            open.queue.pop();
            let (cell, part) = open.cells[index].clone();
            let children = split_one(worker, cell, &part, self.job.control())?;
            for (octant, verdict) in (0..8).zip(children) {
                self.note(side, cell.child(octant), verdict, &mut open)?;
            }
        }
    }

    fn note<P>(
        &mut self,
        side: usize,
        cell: Cell,
        verdict: Verdict<P>,
        open: &mut Open<P>,
    ) -> Result<(), Error> {
        let start = self.start(side, cell);
        match verdict {
            Verdict::Empty => {}
            Verdict::Full => {
                for side in 0..6 {
                    self.inner[side] = self.inner[side].min(self.start(side, cell));
                }
            }
            Verdict::Partial(part) if cell.level < self.frame.depth() => {
                open.cells.try_reserve(1)?;
                open.queue.try_reserve(1)?;
                open.queue.push(Reverse((start, MAX_DEPTH - cell.level, open.cells.len())));
                open.cells.push((cell, part));
            }
            Verdict::Undecided | Verdict::Partial(_) => open.stuck = open.stuck.min(start),
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
            let cells = self.frame.cells();
            corners[0][axis] =
                Interval { lower: plane(self.outer[near]).lower, upper: plane(reach(near, far)).upper };
            corners[1][axis] = Interval {
                lower: plane(cells.saturating_sub(reach(far, near))).lower,
                upper: plane(cells.saturating_sub(self.outer[far])).upper,
            };
        }
        Some(corners)
    }
}

/// Undecided cells, seen from one side.
struct Open<P> {
    cells: Vec<(Cell, P)>,
    /// Where each begins, its height above the deepest level, its index.
    queue: BinaryHeap<Reverse<(u32, u8, usize)>>,
    /// Where the first begins that cannot be split.
    stuck: u32,
}
