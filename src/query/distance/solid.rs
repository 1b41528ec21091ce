//! The distance of points from any solid, without an octree.

use super::DistanceTo;
use super::place::Place;
use super::slabs;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, Cube, Frame, Interval, MAX_DEPTH, axes, valid};
use crate::memory;
use crate::octree::Tag;
use crate::query::StopReason;
use crate::solid::{
    Ask, AskDirect, AskWhole, Classifier, Direct, DynSolid, NearestSurface, Parts, Verdict, Worker,
};
use crate::walk::Proven;
use crate::walk::Queue;
use crate::walk::split_one;
use alloc::vec::Vec;
use core::cmp::Reverse;

/// The proven bounds of a point's distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointDistance {
    /// The distance, in model units. `upper` is ∞ as long as no point of the target is proven. `lower` is ∞
    /// too if the target is proven to be empty.
    pub distance: Interval,
    /// The reason why the search ended.
    pub stop_reason: StopReason,
    /// Number of cell splits.
    pub splits: u64,
    /// The nearest point of the boundary, if known. It is known whenever a solid answers distances itself.
    /// For other solids it is known if the upper bound is finite, unless the queried point may lie on the
    /// side of the boundary where the distance is 0.
    pub nearest: Option<NearPoint>,
}

/// A point of a solid's boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearPoint {
    /// The point (model units), up to rounding: the nearest point, or a point whose distance also lies in the
    /// interval. If the interval of a distance from the boundary contains 0, the point may lie within the
    /// solid, next to the boundary.
    pub point: [f64; 3],
    /// The number of the point's surface; for a mesh, of its triangle. If the point lies on several surfaces,
    /// this is one that bounds the solid next to the point, if such a surface is found.
    pub surface: Option<u32>,
}

impl PointDistance {
    /// Builds the answer from the nearest point of the boundary.
    fn direct(near: &NearestSurface, to: DistanceTo, tolerance: f64) -> PointDistance {
        let NearestSurface { distance: away, is_inside, point, surface } = *near;
        let zero = Interval::exactly(0.0);
        let distance = match (to, is_inside) {
            (DistanceTo::Boundary, Some(true)) => away.negated(),
            (DistanceTo::Boundary, Some(false)) => away,
            (DistanceTo::Boundary, None) => Interval::between(-away.upper, away.upper),
            (DistanceTo::Solid, Some(true)) | (DistanceTo::Complement, Some(false)) => zero,
            (DistanceTo::Solid, Some(false)) | (DistanceTo::Complement, Some(true)) => away,
            (DistanceTo::Solid | DistanceTo::Complement, None) => Interval::between(0.0, away.upper),
        };
        let is_known = distance.width() <= tolerance;
        let stop_reason = if is_known { StopReason::Tolerance } else { StopReason::Exhausted };
        PointDistance { distance, stop_reason, splits: 0, nearest: Some(NearPoint { point, surface }) }
    }
}

/// The maximal number of cells that [`distances`] splits for a point if `control.max_splits` sets no other
/// limit: about a tenth of a second.
pub const DISTANCE_SPLITS: u64 = 1 << 16;

/// Returns the distances of points (model units) from a solid, its complement or its boundary, one answer for
/// each point. Points may lie outside of the universe, where the solid is described by its
/// [`exterior`](Classifier::exterior). A point with a coordinate that is not a finite number gets the
/// interval `[0, ∞]`, or all numbers for [`DistanceTo::Boundary`].
///
/// The cells of `frame` that may be nearest are split first. The search for a point ends, and `stop_reason`
/// says why:
/// - `Tolerance`: the interval is no wider than `tolerance` (model units), or both ends are ∞.
/// - `Exhausted`: no cell is left whose split would help; or, for a solid without slabs, the nearest
///   undecided cell cannot be split, and the interval is no wider than twice the diagonal of the frame's
///   finest cells.
/// - `Budget`: `control.max_splits` cells were split, or [`DISTANCE_SPLITS`] if that is `None`; or the stored
///   data comes near to `control.max_bytes`.
///
/// Where the solid provides slabs of a cell ([`Enclosure`](crate::solid::Enclosure)), these bound the solid's
/// distance: each level then makes the interval about four times as narrow, and a plane face is known at
/// once. Without slabs a level makes the interval half as wide. The answer includes a boundary point that
/// attains the upper bound ([`PointDistance::nearest`]).
///
/// A closed mesh in the universe answers each point from a tree over its triangles, in microseconds and to
/// the rounding of doubles (about 10^-12 of the distance and of the triangle). It also returns the nearest
/// point and its triangle. The first query builds the tree, and determines the triangles that bound the solid
/// ([`MeshSolid`](crate::MeshSolid)). If the nearest triangle intersects another one, the interval is up to
/// 2^-31 of the mesh's extent wide. If the nearest point of that triangle then lies within the solid or
/// outside of it, and is therefore not on the boundary, cells are used. A mesh with holes answers in the same
/// way where its winding number is surely not one half in the ball around the point that is free of
/// triangles. For other points, usually those next to a hole, cells are used.
///
/// A point usually takes some dozen splits a level. It takes more splits if more of the surface is about as
/// near: for a ball's centre the bounds are only as good as cells as large as the budget allows. The answers
/// do not depend on the number of threads.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; the solid's own errors;
/// [`Error::OutOfMemory`] and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::{DistanceTo, distances}};
/// let frame = Frame::new([-2.0; 3], 4.0, 20)?;
/// let (ball, points) = (Csg::ball([0.0; 3], 1.0)?, [[3.0, 0.0, 4.0], [0.0, 0.5, 0.0]]);
/// let found = distances(&ball, &frame, &points, DistanceTo::Boundary, 1e-9, &Control::default())?;
/// assert!(found[0].distance.contains(4.0) && found[0].distance.width() <= 1e-9);
/// let near = found[0].nearest.unwrap().point;
/// assert!((near[0] - 0.6).abs() < 1e-4 && (near[2] - 0.8).abs() < 1e-4);
/// assert!(found[1].distance.contains(-0.5) && found[1].distance.width() <= 1e-9);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn distances(
    solid: &dyn DynSolid,
    frame: &Frame,
    points: &[[f64; 3]],
    to: DistanceTo,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Vec<PointDistance>, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    job.check()?;
    let classifier = Proven(solid.on(frame, control)?);
    let exterior = classifier.exterior();
    // The whole boundary of a bounded solid lies in the universe.
    let is_direct = exterior == Tag::Empty && classifier.is_direct(Direct::Distances, control)?;
    let found = control.run(points.len() > CHUNK, |parallel| {
        job.each(parallel, points.chunks(CHUNK), |chunk| {
            let mut worker = classifier.worker()?;
            let root = match if is_direct { worker.root()? } else { Verdict::Undecided } {
                Verdict::Partial(part) => Some(part),
                _ => None,
            };
            let mut found = memory::with_capacity(chunk.len())?;
            for &point in chunk {
                if let Some(root) = &root
                    && let Some(near) = worker.nearest(root, point)?
                {
                    found.push(PointDistance::direct(&near, to, tolerance));
                    continue;
                }
                let mark = worker.mark();
                found.push(distance(&mut worker, exterior, frame, point, to, tolerance, &job)?);
                worker.release(mark);
            }
            Ok(found)
        })
    })?;
    let mut distances = memory::with_capacity(points.len())?;
    distances.extend(found.into_iter().flatten());
    Ok(distances)
}

/// A proven upper bound of the distance, and a point of the solid that attains it (model units).
type Found = (f64, [f64; 3]);

/// Number of points in one worker's task.
const CHUNK: usize = 1 << 4;

fn distance<W: Worker>(
    worker: &mut W,
    exterior: Tag,
    frame: &Frame,
    point: [f64; 3],
    to: DistanceTo,
    tolerance: f64,
    job: &Job<'_>,
) -> Result<PointDistance, Error> {
    let Some(place) = Place::new(frame, point) else {
        let distance = to.unknown();
        return Ok(PointDistance { distance, stop_reason: StopReason::Exhausted, splits: 0, nearest: None });
    };
    let budget = job.control().max_splits.unwrap_or(DISTANCE_SPLITS);
    let (mut left, mut is_spent) = (budget, false);
    let mut near = [None; 2];
    let distance = to.ask(|hollow| {
        let mut search = Search {
            worker,
            frame,
            place,
            point,
            hollow,
            // Near the boundary the interval combines both searches.
            tolerance: if to == DistanceTo::Boundary { 0.5 * tolerance } else { tolerance },
            upper: f64::INFINITY,
            nearest: None,
            settled: f64::INFINITY,
            has_slabs: false,
            open: Queue::new(),
            job,
        };
        is_spent |= search.run(exterior, &mut left)?;
        near[usize::from(hollow)] = search.nearest;
        Ok(search.found())
    })?;
    let is_known = distance.width() <= tolerance || distance.lower == f64::INFINITY;
    let stop_reason = match (is_known, is_spent) {
        (true, _) => StopReason::Tolerance,
        (false, true) => StopReason::Budget,
        (false, false) => StopReason::Exhausted,
    };
    let point = match to {
        DistanceTo::Boundary if distance.upper < 0.0 => near[1],
        DistanceTo::Boundary => near[0],
        // (If the target contains the queried point, no boundary point is known.)
        _ if distance.lower <= 0.0 => None,
        DistanceTo::Solid => near[0],
        DistanceTo::Complement => near[1],
    };
    let nearest = point.map(|point| NearPoint { point, surface: None });
    Ok(PointDistance { distance, stop_reason, splits: budget - left, nearest })
}

/// The least possible distance of the target in a cell (the bits of a non-negative double), the cell's height
/// above the deepest level, the cell's serial number.
type Key = Reverse<(u64, u8, u64)>;

struct Search<'a, W: Worker> {
    worker: &'a mut W,
    frame: &'a Frame,
    place: Place<'a>,
    point: [f64; 3],
    /// Whether the target is the complement.
    hollow: bool,
    tolerance: f64,
    /// The least proven distance of the target, and a point that attains it, unless that point lies beyond
    /// the universe.
    upper: f64,
    nearest: Option<[f64; 3]>,
    /// The least possible distance of the target in cells that are not split any further.
    settled: f64,
    /// Whether the solid has provided slabs.
    has_slabs: bool,
    /// Cells that can be split.
    open: Queue<Key, (Cell, W::Part)>,
    job: &'a Job<'a>,
}

impl<W: Worker> Search<'_, W> {
    /// Runs the search. Returns whether the budget ended it.
    fn run(&mut self, exterior: Tag, left: &mut u64) -> Result<bool, Error> {
        let outside = self.place.distance(self.place.square_from_outside());
        match if self.hollow { exterior.complement() } else { exterior } {
            Tag::Empty => {}
            Tag::Full => self.reach(outside, None),
            Tag::Partial | Tag::Branch => self.settled = outside.lower,
        }
        let root = self.worker.root()?;
        self.note(Cell::ROOT, root, 0.0)?;
        loop {
            let found = self.found();
            if found.lower == f64::INFINITY || found.width() <= self.tolerance {
                return Ok(false);
            }
            let begin = self.begin();
            if begin >= self.upper || self.settled <= begin && found.width() <= self.resolution() {
                return Ok(false);
            }
            let Some((cell, part)) = self.open.pop() else { return Ok(false) };
            if *left == 0 || self.is_full() {
                // The cell still counts.
                self.settled = self.settled.min(begin);
                return Ok(true);
            }
            *left -= 1;
            self.job.check()?;
            let children = split_one(self.worker, cell, &part, self.job.control())?;
            for (octant, child) in (0..8).zip(children) {
                self.note(cell.child(octant), child, begin)?;
            }
        }
    }

    /// True if the parts in memory take much of the bytes that the caller allows.
    fn is_full(&self) -> bool {
        let allowed = self.job.control().max_bytes;
        allowed.is_some_and(|limit| self.worker.scratch_bytes() as u64 > limit / 4)
    }

    /// The least possible distance of the target in the first open cell.
    fn begin(&self) -> f64 {
        self.open.peek().map_or(f64::INFINITY, |entry| f64::from_bits(entry.key.0.0))
    }

    /// The resolution of cells: unlimited with slabs; without slabs, twice the diagonal of a finest cell.
    fn resolution(&self) -> f64 {
        if self.has_slabs { 0.0 } else { 2.0 * sqrt(3.0) * self.frame.cell_size() }
    }

    fn found(&self) -> Interval {
        Interval::between(self.upper.min(self.settled).min(self.begin()), self.upper)
    }

    /// Records a proven part of the target.
    fn reach(&mut self, distance: Interval, point: Option<[f64; 3]>) {
        if distance.upper < self.upper {
            (self.upper, self.nearest) = (distance.upper, point);
        }
        self.settled = self.settled.min(distance.lower);
    }

    /// Takes in the verdict of a cell whose part of the target is no nearer than `least`.
    fn note(&mut self, cell: Cell, verdict: Verdict<W::Part>, least: f64) -> Result<(), Error> {
        let distance = self.place.distance(self.place.square_from(cell));
        let mut least = least.max(distance.lower);
        match if self.hollow { verdict.complement() } else { verdict } {
            Verdict::Empty => {}
            // A cell that is no nearer than a proven part does not matter.
            _ if least >= self.upper => {}
            Verdict::Full => self.reach(distance, Some(self.place.nearest_in(cell, self.point))),
            Verdict::Undecided => self.settled = self.settled.min(least),
            Verdict::Partial(part) => {
                let (nearest, proven) = self.by_slabs(cell, &part)?;
                least = least.max(nearest);
                if let Some((upper, point)) = proven.filter(|proven| proven.0 < self.upper) {
                    (self.upper, self.nearest) = (upper, Some(point));
                }
                if least < self.upper && cell.level < self.frame.depth() {
                    let key = Reverse((least.to_bits(), MAX_DEPTH - cell.level, self.open.met()));
                    self.open.push(key, (cell, part))?;
                } else if least < self.upper {
                    self.settled = self.settled.min(least);
                }
            }
        }
        Ok(())
    }

    /// Returns a lower bound of the distance of the solid in a PARTIAL cell from its slabs, ∞ if the cell has
    /// no part of the solid; and a proven upper bound, with a point that attains it.
    fn by_slabs(&mut self, cell: Cell, part: &W::Part) -> Result<(f64, Option<Found>), Error> {
        let Some(enclosure) = self.worker.enclosure(cell, part)? else { return Ok((0.0, None)) };
        self.has_slabs = true;
        let enclosure = if self.hollow { enclosure.complement() } else { enclosure };
        let cube = Cube { frame: self.frame, cell };
        let half = Interval::exactly(cube.half_edge());
        let seen = cube.centre_from(self.point).each(|c| c.negated().over(half));
        let to_model = |halves: f64| Interval::exactly(halves).times(half);
        let lower = slabs::lower(&enclosure, &seen);
        let upper = slabs::upper(&enclosure, &seen).map(|(upper, at)| {
            let (low, high) = cube.bounds();
            let point = axes(|k| 0.5 * low[k] + 0.5 * high[k] + cube.half_edge() * at[k]);
            (to_model(upper).upper, point)
        });
        Ok((if lower == f64::INFINITY { lower } else { to_model(lower).lower }, upper))
    }
}
