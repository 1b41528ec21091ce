//! The bounding box of a solid.

use super::StopReason;
use crate::control::{Control, Job, WHOLE};
use crate::cut::reach;
use crate::error::Error;
use crate::lattice::{Cell, Frame, Interval, MAX_DEPTH, valid};
use crate::octree::Proof;
use crate::solid::{Ask, Classifier, DynSolid, Parts, Verdict, Worker};
use crate::walk::Part;
use crate::walk::Proven;
use crate::walk::Queue;
use crate::walk::Subject;
use core::cmp::Reverse;

/// The proven bounds of the bounding box of a solid's part inside of the universe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// The lower and the upper corner, in model units: intervals that contain the true corners. `None` if the
    /// solid is proven empty.
    pub corners: Option<[[Interval; 3]; 2]>,
    /// Whether the solid is proven not to be empty. If the solid is proven neither empty nor occupied, it may
    /// be empty, and the corners bound the region that it may occupy.
    pub occupied: bool,
    /// The proof of the solid: which verdicts are proven. Unproven verdicts count as undecided.
    pub proof: Proof,
    /// Whether the solid continues, or may continue, outside of the universe.
    pub clipped: bool,
    /// The reason why the search ended. [`Tolerance`](StopReason::Tolerance) means that no interval is wider
    /// than the greater of the requested tolerance and 2^-44 of the universe's edge, except for the rounding
    /// of the corners to doubles.
    pub stop_reason: StopReason,
    /// Number of cell splits.
    pub splits: u64,
}

/// The maximal number of splits of [`bounding_box`] if `control.max_splits` sets no other limit: some
/// seconds, and some hundred megabytes at the most.
pub const BOUNDING_BOX_SPLITS: u64 = 1 << 20;

/// Returns the bounding box of `solid` in the universe of `frame`: six intervals, one for each side. The
/// result does not depend on the number of threads, since there is only one.
///
/// The search splits only cells that may reach beyond the proven part of the solid, the farthest-reaching
/// cells first. It ends, and the result's `stop_reason` says why:
/// - `Tolerance`: no interval is wider than the greater of `tolerance` (model units) and 2^-44 of the
///   universe's edge.
/// - `Exhausted`: the outermost undecided cells cannot be split, and either the interval is no wider than one
///   of the frame's finest cells, or nothing else is left to split.
/// - `Budget`: `control.max_splits` cells were split, or [`BOUNDING_BOX_SPLITS`] if that is `None`. Each side
///   gets its share of the splits that the sides before it have left. The search ends for the same reason
///   when the stored parts of a side come near to `control.max_bytes`.
///
/// Where the solid provides slabs of a cell ([`Enclosure`](crate::solid::Enclosure)), a linear program bounds
/// the solid's reach there. A corner of three plane faces is exact to rounding as soon as a cell holds no
/// more than these, wherever the faces lie: a tilted plate takes 28 splits. At a curved side each level makes
/// the interval four times as narrow. A level takes about ten splits a side. Where the solid touches the side
/// along a line or a circle, as an upright cylinder does, each level takes twice as many splits as the level
/// before. The tip of a cone, and a corner of more than three faces, are located to within a few finest
/// cells.
///
/// Without slabs, a curved side takes about n splits, where n is the edge of the universe divided by the
/// tolerance. A flat side takes n², unless it lies on a plane of the lattice, because each cell in front of
/// it must be proven empty.
///
/// Time and memory are linear in the splits but for a logarithm.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; the solid's own errors, as
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
pub fn bounding_box(
    solid: &dyn DynSolid,
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
    // The width is large if nothing is proven solid.
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

/// The edge of the universe is 2^`UNITS` units: finer than doubles resolve, and all lattice planes are
/// integers.
const UNITS: u32 = 60;
const EDGE: u64 = 1 << UNITS;

/// Rounding alone may leave an interval this wide.
const ROUNDING: u64 = EDGE >> 44;

/// A distance farther than any plane. (Differences saturate: the proven inside of a self-contradictory host
/// may lie in front of the solid's bound.)
const NOWHERE: u64 = u64::MAX;

/// The first possible position of the solid in a cell, the cell's height above the deepest level, the cell's
/// serial number.
type Key = Reverse<(u64, u8, u64)>;

/// A search for the six sides. Sides 0 to 2 are the lower ones along x, y and z, 3 to 5 the upper ones. A
/// position at a side is the distance from the universe's face there, in units.
struct Search<'a, C: Classifier> {
    subject: Subject<'a, C>,
    frame: &'a Frame,
    job: &'a Job<'a>,
    /// Target width of an interval, in units.
    goal: u64,
    /// The proven start of the solid: the first FULL cell, or the first point that an enclosure proves
    /// inside.
    inner: [u64; 6],
    /// The lower bound of the solid's start.
    outer: [u64; 6],
    /// The lower bound of the start within undecided cells that cannot be split, seen from the present side.
    stuck: u64,
    /// Cells that can be split.
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

/// The position where a cell begins, seen from a side.
fn start(side: usize, cell: Cell) -> u64 {
    let (at, edge) = (u64::from(cell.at[side % 3]), EDGE >> cell.level);
    if side < 3 { at * edge } else { EDGE - (at + 1) * edge }
}

impl<C: Classifier> Search<'_, C> {
    /// True if the solid is proven empty: no part of the universe may hold a part of it, or along some axis
    /// it would end before it begins.
    fn is_empty(&self) -> bool {
        let ends_first = |axis: usize| {
            let [near, far] = [self.outer[axis], self.outer[axis + 3]];
            self.inner[axis] == NOWHERE && near > EDGE.saturating_sub(far)
        };
        self.outer.contains(&NOWHERE) || (0..3).any(ends_first)
    }

    /// The width of a side's interval.
    fn width(&self, side: usize) -> u64 {
        self.inner[side].saturating_sub(self.outer[side])
    }

    /// Splits cells in order of the solid's first possible position, the smallest first among equals. Returns
    /// `false` if the share of splits ended the search.
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
            // If a cell that cannot be split begins first, other cells could only raise the inner bound.
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

    /// Takes in the verdict of a cell. In the cell's parent, the solid does not begin before `parent`.
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

    /// Takes in a point of the solid, given in half edges from a cell's centre.
    fn note_point(&mut self, cell: Cell, point: [f64; 3]) {
        for side in 0..6 {
            let axis = side % 3;
            let reach = if side < 3 { -point[axis] } else { point[axis] };
            // Add one unit where the distance is not a whole number of units.
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
            // With nothing proven solid, a side may lie anywhere in the region that the solid may occupy.
            let reach = |side: usize, other: usize| match self.inner[side] {
                NOWHERE => EDGE.saturating_sub(self.outer[other]),
                // Only a self-contradictory host has a proven part in front of the outer bound.
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

    /// The coordinate that lies `units` above the universe's lower face.
    fn coordinate(&self, axis: usize, units: u64) -> Interval {
        let shift = UNITS - u32::from(self.frame.depth());
        if units.trailing_zeros() >= shift {
            return self.frame.plane(axis, (units >> shift) as u32);
        }
        // The quotient is exact, because the divisor is a power of two.
        let unit = Interval::exactly(self.frame.edge() / EDGE as f64);
        let origin = Interval::exactly(self.frame.origin()[axis]);
        origin.plus(Interval::of_integer(units.into()).times(unit))
    }
}

/// Returns the distance, rounded down, from the universe's face at a side to the points of a cell that reach
/// `reach` (−1 to 1, in half edges) from the cell's centre towards that side.
fn distance(side: usize, cell: Cell, reach: f64) -> u64 {
    let half = half(cell);
    // The product is exact, because one factor is a power of two, and at most half an edge of the universe.
    let beyond = libm::ceil(reach.clamp(-1.0, 1.0) * half as f64) as i64;
    (start(side, cell) + half).saturating_add_signed(-beyond)
}
