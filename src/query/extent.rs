//! Where a solid begins and ends along each axis.

use super::StopReason;
use crate::control::{Control, Job, WHOLE};
use crate::cut::reach;
use crate::error::Error;
use crate::lattice::{Cell, Frame, Interval, MAX_DEPTH, valid};
use crate::octree::Proof;
use crate::solid::{Ask, Classifier, Parts, Solid, Verdict, Worker};
use crate::walk::Part;
use crate::walk::Proven;
use crate::walk::Queue;
use crate::walk::Subject;
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
    /// Why it ended. [`Tolerance`](StopReason::Tolerance) means that no interval is wider than was asked for,
    /// or than 2^-44 of the universe's edge, except for the rounding of the corners to doubles.
    pub stop_reason: StopReason,
    /// How many times a cell was split.
    pub splits: u64,
}

/// Splits after which [`bounding_box`] ends if `control.max_splits` sets no other limit: some seconds, and
/// some hundred megabytes at the most.
pub const BOUNDING_BOX_SPLITS: u64 = 1 << 20;

/// The bounding box of `solid` in the universe of `frame`: six intervals, one for each side. The result does
/// not depend on the number of threads, since there is only one.
///
/// The search splits only cells that may reach beyond what is proven solid, those first that reach farthest.
/// It ends, and the result's `stop_reason` says why:
/// - `Tolerance`: no interval is wider than `tolerance` (model units), or than 2^-44 of the universe's edge.
/// - `Exhausted`: the outermost undecided cells cannot be split, and either the interval is no wider than one
///   of the frame's finest cells, or nothing else is left to split.
/// - `Budget`: `control.max_splits` cells were split, or [`BOUNDING_BOX_SPLITS`] if that is `None`. Each side
///   gets its share of what the sides before it have left. Or what is remembered of a side comes near to
///   `control.max_bytes`.
///
/// Where the solid knows the slabs of a cell ([`Enclosure`](crate::solid::Enclosure)), a linear program
/// bounds how far it reaches there. A corner of three plane faces is exact to rounding as soon as a cell
/// holds no more than these, wherever the faces lie: a tilted plate takes 28 splits. At a curved side each
/// level makes the interval four times as narrow. A level takes some ten splits a side, and twice as many as
/// the level before where the side is touched along a line or a circle, as an upright cylinder's is. The tip
/// of a cone, and a corner of more than three faces, are known to some finest cells.
///
/// Without slabs, and with n the edge of the universe over the tolerance, a curved side takes some n splits.
/// A flat one takes n², unless it lies on a plane of the lattice, because each cell in front of it must be
/// proven empty.
///
/// Time is linear in the splits but for a logarithm, and so is memory.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; what the solid refuses, as
/// [`build`](crate::build); [`Error::Cancelled`]; [`Error::OutOfMemory`].
///
/// ```
/// use leafless::{Control, Csg, Frame, bounding_box};
/// let frame = Frame::new([-1.0; 3], 2.0, 20)?;
/// let extent = bounding_box(&Csg::ball([0.1, 0.0, 0.0], 0.75)?, &frame, 1e-9, &Control::default())?;
/// let [min, max] = extent.corners.unwrap();
/// assert!((min[0].lower + 0.65).abs() < 2e-9 && max[0].contains(0.85) && max[0].width() <= 2e-9);
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
    let goal = ((tolerance / frame.edge() * EDGE as f64) as u64).max(ROUNDING);
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
    let budget = control.max_splits.unwrap_or(BOUNDING_BOX_SPLITS);
    let mut unfinished = false;
    let mark = search.subject.worker.mark();
    for side in 0..6 {
        let share = (budget - search.subject.splits) / (6 - side as u64);
        unfinished |= !search.side(side, share)?;
        search.subject.worker.release(mark);
        job.advance(WHOLE / 6 + if side == 0 { WHOLE % 6 } else { 0 });
    }
    // The difference is large if nothing is proven solid.
    let wide = !search.is_empty() && (0..6).any(|side| search.width(side) > goal);
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

/// The edge of the universe is 2^`UNITS` units: finer than doubles tell, and all lattice planes are integers.
const UNITS: u32 = 60;
const EDGE: u64 = 1 << UNITS;

/// Rounding alone may keep an interval so wide.
const ROUNDING: u64 = EDGE >> 44;

/// Farther than any plane. (Differences saturate: a host that contradicts itself may put a solid before its
/// bounds.)
const NOWHERE: u64 = u64::MAX;

/// Where the solid may begin in a cell, the cell's height above the deepest level, the order of meeting.
type Key = Reverse<(u64, u8, u64)>;

/// Sides are numbered: 0 to 2 the lower ones along x, y and z, 3 to 5 the upper ones. What lies at a side is
/// told by its distance from the universe's face there, in units.
struct Search<'a, C: Classifier> {
    subject: Subject<'a, C>,
    frame: &'a Frame,
    job: &'a Job<'a>,
    /// How many units an interval may be wide.
    goal: u64,
    /// Where the solid begins as far as is proven: the first FULL cell, or the first point that an enclosure
    /// has inside.
    inner: [u64; 6],
    /// Where the solid may begin.
    outer: [u64; 6],
    /// Where it may begin, seen from the present side, in undecided cells that cannot be split.
    stuck: u64,
    /// Those that can be split.
    open: Queue<Key, (Cell, Part<C>)>,
}

/// The outward direction of a side.
fn outward(side: usize) -> [f64; 3] {
    let mut direction = [0.0; 3];
    direction[side % 3] = if side < 3 { -1.0 } else { 1.0 };
    direction
}

/// Half the edge of a cell.
fn half(cell: Cell) -> u64 {
    EDGE >> (cell.level + 1)
}

/// Where a cell begins, seen from a side.
fn start(side: usize, cell: Cell) -> u64 {
    let (at, edge) = (u64::from(cell.at[side % 3]), EDGE >> cell.level);
    if side < 3 { at * edge } else { EDGE - (at + 1) * edge }
}

impl<C: Classifier> Search<'_, C> {
    /// Whether the solid is proven empty: no part of the universe may hold some of it, or along some axis it
    /// would end before it begins.
    fn is_empty(&self) -> bool {
        let ends_first = |axis: usize| {
            let [near, far] = [self.outer[axis], self.outer[axis + 3]];
            self.inner[axis] == NOWHERE && near > EDGE.saturating_sub(far)
        };
        self.outer.contains(&NOWHERE) || (0..3).any(ends_first)
    }

    /// How much is open at a side.
    fn width(&self, side: usize) -> u64 {
        self.inner[side].saturating_sub(self.outer[side])
    }

    /// Splits the cells in which the solid may begin first, and of those the smallest. `false` if the share
    /// has ended it.
    fn side(&mut self, side: usize, share: u64) -> Result<bool, Error> {
        self.job.check()?;
        let last = self.subject.splits + share;
        let finest = EDGE >> self.frame.depth();
        (self.stuck, self.open) = (NOWHERE, Queue::new());
        let root = self.subject.worker.root()?;
        self.note(side, Cell::ROOT, 0, root)?;
        loop {
            let begin = self.open.peek().map_or(NOWHERE, |entry| entry.key.0.0);
            self.outer[side] = self.inner[side].min(self.stuck).min(begin);
            // Where a cell that cannot be split begins first, others could but raise the inner bound.
            let goal = if self.stuck <= begin { self.goal.max(finest) } else { self.goal };
            if self.width(side) <= goal {
                return Ok(true);
            }
            let Some((cell, part)) = self.open.pop() else { return Ok(true) };
            if self.subject.splits == last || self.subject.takes(4) {
                return Ok(false);
            }
            self.job.check()?;
            for (octant, verdict) in (0..8).zip(self.subject.split(cell, &part)?) {
                self.note(side, cell.child(octant), begin, verdict)?;
            }
        }
    }

    /// Takes in what is known of a cell whose parent's part of the solid does not begin before `parent`.
    fn note(&mut self, side: usize, cell: Cell, parent: u64, verdict: Verdict<Part<C>>) -> Result<(), Error> {
        let mut begin = parent.max(start(side, cell));
        match verdict {
            Verdict::Empty => {}
            Verdict::Full => {
                for side in 0..6 {
                    self.inner[side] = self.inner[side].min(start(side, cell));
                }
            }
            // Such a cell cannot widen the box.
            _ if begin >= self.inner[side] => {}
            Verdict::Undecided => self.stuck = self.stuck.min(begin),
            Verdict::Partial(part) => {
                if let Some(enclosure) = self.subject.worker.enclosure(cell, &part)? {
                    let reach = reach::upper(&enclosure, outward(side));
                    if reach == f64::NEG_INFINITY {
                        return Ok(());
                    }
                    begin = begin.max(distance(side, cell, reach));
                    if begin < self.inner[side]
                        && let Some(point) = reach::witness(&enclosure, outward(side))
                    {
                        self.note_point(cell, point);
                    }
                }
                let can_split = cell.level < self.frame.depth();
                if begin < self.inner[side] && can_split {
                    let key = Reverse((begin, MAX_DEPTH - cell.level, self.open.met()));
                    self.open.push(key, (cell, part))?;
                } else if begin < self.inner[side] {
                    self.stuck = self.stuck.min(begin);
                }
            }
        }
        Ok(())
    }

    /// Takes in a point of the solid, in half edges from a cell's centre.
    fn note_point(&mut self, cell: Cell, point: [f64; 3]) {
        for side in 0..6 {
            let axis = side % 3;
            let reach = if side < 3 { -point[axis] } else { point[axis] };
            // One more where the distance is not a whole number of units.
            let half = half(cell) as f64;
            let uneven = u64::from(libm::ceil(reach * half) != reach * half);
            self.inner[side] = self.inner[side].min(distance(side, cell, reach) + uneven);
        }
    }

    fn corners(&self) -> Option<[[Interval; 3]; 2]> {
        if self.is_empty() {
            return None;
        }
        let mut corners = [[Interval::exactly(0.0); 3]; 2];
        for axis in 0..3 {
            // With nothing proven solid, each side may be wherever the solid may be.
            let reach = |side: usize, other: usize| match self.inner[side] {
                NOWHERE => EDGE.saturating_sub(self.outer[other]),
                // Only a host that contradicts itself has something solid before it may begin.
                inner => inner.max(self.outer[side]),
            };
            let (near, far) = (axis, axis + 3);
            let between = |a: u64, b: u64| {
                Interval::between(self.coordinate(axis, a).lower, self.coordinate(axis, b).upper)
            };
            let opposite = |distance: u64| EDGE.saturating_sub(distance);
            corners[0][axis] = between(self.outer[near], reach(near, far));
            corners[1][axis] = between(opposite(reach(far, near)), opposite(self.outer[far]));
        }
        Some(corners)
    }

    /// The coordinate that lies so many units above the universe's lower face.
    fn coordinate(&self, axis: usize, units: u64) -> Interval {
        let shift = UNITS - u32::from(self.frame.depth());
        if units.trailing_zeros() >= shift {
            return self.frame.plane(axis, (units >> shift) as u32);
        }
        // The quotient is exact, being by a power of two.
        let unit = Interval::exactly(self.frame.edge() / EDGE as f64);
        let origin = Interval::exactly(self.frame.origin()[axis]);
        origin.plus(Interval::of_integer(units.into()).times(unit))
    }
}

/// How far from the universe's face at a side the points of a cell lie, rounded down, that reach so far (−1
/// to 1) from its centre.
fn distance(side: usize, cell: Cell, reach: f64) -> u64 {
    let half = half(cell);
    // The product is exact, being with a power of two, and at most half an edge of the universe.
    let beyond = libm::ceil(reach.clamp(-1.0, 1.0) * half as f64) as i64;
    (start(side, cell) + half).saturating_add_signed(-beyond)
}
