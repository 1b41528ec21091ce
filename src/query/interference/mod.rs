//! The overlap of two solids, and its volume.

mod oriented;
mod pose;
mod search;

use super::measure::volume_within;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Affine, Cell, Cube, Frame, Interval, axes, valid};
use crate::memory;
use crate::octree::{Proof, Tag};
use crate::parallel;
use crate::parallel::each_with;
use crate::solid::joint::Joint;
use crate::solid::{AskWhole, Classifier, DynSolid, Motion, Solid, Transform, TransformClassifier};
use crate::walk::Proven;
use alloc::vec::Vec;
use oriented::{Oriented, Waiting};
use search::Search;

/// The verdict on an overlap: whether the interiors of two solids have points in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Overlap {
    /// Proven: the interiors have no common points. The solids may touch.
    Disjoint = 0,
    /// Proven: a ball lies in both solids.
    Overlapping = 1,
    /// Not decided at the frame's depth, or before the splits were spent; or both solids may continue outside
    /// of the universe, and overlap there.
    Undecided = 2,
}

/// A closed ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// The centre (model units).
    pub centre: [f64; 3],
    /// The radius (model units), which is positive. 0 if rounding consumes it, so that the ball is a single
    /// rounded point.
    pub radius: f64,
}

impl Ball {
    /// Builds a ball in a cell. The coordinates count half edges from the cell's centre.
    fn in_cell(cube: &Cube<'_>, at: [f64; 3], radius: f64) -> Ball {
        let (lower, upper) = cube.bounds();
        let half = cube.half_edge();
        let centre = axes(|k| 0.5 * lower[k] + 0.5 * upper[k] + half * at[k]);
        // A bound of the centre's rounding error, including that of the cell's ends.
        let size = (0..3).map(|k| lower[k].abs().max(upper[k].abs())).sum::<f64>();
        let radius = radius * half * (1.0 - 4.0 * f64::EPSILON) - 16.0 * f64::EPSILON * size;
        Ball { centre, radius: radius.max(0.0) }
    }

    /// A lower bound of the ball's volume.
    fn volume(&self) -> f64 {
        4.18 * self.radius * self.radius * self.radius
    }
}

/// The proven verdict on the overlap of two solids, with its witness and volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interference {
    /// Whether the solids overlap.
    pub verdict: Overlap,
    /// A cell of the frame with points of both solids, if the proof of an overlap found one. It always does,
    /// except for stored octrees under placements.
    pub witness: Option<Cell>,
    /// If the solids are proven to overlap: a ball that is proven to lie in both, within that cell, if there
    /// is one. It is not the largest such ball.
    pub ball: Option<Ball>,
    /// The volume of the intersection, in cubic model units. The upper bound is infinite if `clipped`.
    pub volume: Interval,
    /// Number of cell splits in the first solid and in the second.
    pub splits: [u64; 2],
    /// The finest level of the visited cells.
    pub level: u8,
    /// The proofs of the first and of the second solid: which verdicts are proven. Unproven verdicts count as
    /// undecided.
    pub proofs: [Proof; 2],
    /// Whether both solids may continue outside of the universe. They are then not proven to be disjoint. (If
    /// one solid lies inside, the whole intersection does.)
    pub clipped: bool,
}

/// Returns whether `a` and `b` overlap, and the volume of their intersection. To move a solid first, put it
/// under a placement (see [`AnySolid::placed`](crate::AnySolid::placed)). The search covers the universe of
/// `frame`. Once an overlap is proven, its volume is measured until the interval is no wider than `tolerance`
/// (cubic model units). With an infinite tolerance the work ends with the proof.
///
/// If both solids are made of surfaces (expressions of half-spaces, and octrees that keep their surfaces),
/// the search uses the joint function of both solids in a cell. A plane, a quadric or another surface that
/// bounds both solids counts as one surface, however both were placed. Solids that touch in it from opposite
/// sides are `Disjoint` by proof. So are solids on two planes or quadrics that touch: for any two of these
/// surfaces, exact numbers decide whether a point lies inside of both. If a solid is only known between two
/// planes (a mesh, a host's function), solids in contact stay `Undecided` within that width.
///
/// The work ends, with the results so far, at the frame's depth, or once `control.max_splits` cells of both
/// are split or the stored parts come near to `control.max_bytes`. Memory is linear in the undecided cells.
/// The search uses one thread, except for a host program's shape, which is queried about several cells at
/// once. The measurement uses as many threads as `control` allows. The result does not depend on their
/// number.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; the solids' own errors;
/// [`Error::OutOfMemory`] and [`Error::Cancelled`].
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
pub fn interference(
    a: &dyn DynSolid,
    b: &dyn DynSolid,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Interference, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    let (a, b) = (Proven(a.on(frame, control)?), Proven(b.on(frame, control)?));
    let found = of_classifiers(a, b, tolerance, control, &job)?;
    job.advance(WHOLE);
    Ok(found)
}

/// Returns the interference of two solids on one frame.
fn of_classifiers<A: Classifier, B: Classifier>(
    a: A,
    b: B,
    tolerance: f64,
    control: &Control<'_>,
    job: &Job<'_>,
) -> Result<Interference, Error> {
    let proofs = [a.proof(), b.proof()];
    let clipped = a.exterior() != Tag::Empty && b.exterior() != Tag::Empty;
    let both = Joint::new(a, b, control)?;
    let search = Search::new(&both, control)?;
    let mut found = control.run(search.likes_many(), |parallel| {
        search.run(clipped, if parallel { parallel::threads() } else { 1 }, job)
    })?;
    if found.verdict == Overlap::Overlapping && found.volume.width() > tolerance {
        // A split of the intersection is one split of each solid.
        let own = Control { progress: None, ..*control };
        let measured = volume_within(&both, tolerance, found.left / 2, &own)?;
        // (Both intervals contain the true volume.)
        found.volume = found.volume.common(measured.volume).unwrap_or(measured.volume);
        found.level = found.level.max(measured.level);
        for (splits, partial) in found.splits.iter_mut().zip(found.partial) {
            *splits += u64::from(partial) * measured.splits;
        }
    }
    let least = found.witness.map_or(0.0, |(_, ball)| ball.volume());
    let volume = Interval::between(found.volume.lower.max(least), found.volume.upper);
    Ok(Interference {
        verdict: found.verdict,
        witness: found.witness.map(|(cell, _)| cell),
        ball: found.witness.map(|(_, ball)| ball),
        volume: if clipped { Interval::between(volume.lower, f64::INFINITY) } else { volume },
        splits: found.splits,
        level: found.level,
        proofs,
        clipped,
    })
}

/// Returns the [`interference`] of `a` with `b` under each of the `placements`, in their order. The solid `a`
/// stands on `frame`, `b` on its `own` frame; both are prepared once. An expression of half-spaces is moved
/// itself ([`Motion::Exact`]), so that contacts are decided. The results do not depend on the number of
/// threads. `control.max_splits` applies to each placement.
///
/// # Stored octrees
/// Two [`Octree`](crate::Octree)s, or views of them, also behind [`AnySolid`](crate::AnySolid), are not
/// searched by cells of `frame`. Instead both trees descend in pairs of cells, as boxes that the placement
/// turns. This loses no precision, and an overlap by less than a cell is found, too; [`Interference::ball`]
/// is the proof. `splits` counts cells of both trees. The trees must be certified and without surfaces, must
/// have at least one cut octant of the universe, must end inside of their universes, and must stand on
/// exactly the given frames. Any affine placement is allowed. If a finite `tolerance` requires the volume of
/// an overlap, the search by cells follows.
///
/// If that is not decisive, an octree that keeps its surfaces is moved with these, as [`Transform`] moves it.
/// Contacts are then decided as by [`interference`].
///
/// A placement takes a few microseconds, and more if the solids nearly touch: the work grows with the area
/// where the gap is as narrow as a cell, measured in such cells.
///
/// ```
/// use leafless::query::{Overlap, interference_at};
/// use leafless::{Affine, Control, Csg, Frame, Rule, build};
/// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 7)?, Control::default());
/// let block = build(&Csg::cuboid([-1.0, -1.0, -0.25], [1.0, 1.0, 0.25])?, &frame, Rule::Certified, &control)?;
/// let turned = |z| Affine::new([[0.8, -0.6, 0.0, 0.0], [0.6, 0.8, 0.0, 0.0], [0.0, 0.0, 1.0, z]]);
/// let placements = [turned(0.501)?, turned(0.499)?];
/// let found = interference_at(&block, &block, &frame, &placements, &frame, f64::INFINITY, &control)?;
/// assert_eq!([found[0].verdict, found[1].verdict], [Overlap::Disjoint, Overlap::Overlapping]);
/// assert!(found[1].ball.is_some());
/// # Ok::<(), leafless::Error>(())
/// ```
///
/// # Errors
/// As [`interference`].
pub fn interference_at(
    a: &dyn DynSolid,
    b: &dyn DynSolid,
    own: &Frame,
    placements: &[Affine],
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Vec<Interference>, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    let (bounds, solid) = (b.bounds(), b);
    // (Other solids are not queried for a stored tree, because the query may cost a split.)
    let is_home = a.home() == Some(*frame) && b.home() == Some(*own);
    let (a, b) = (a.on(frame, control)?, b.on(own, control)?);
    let mut workers = (a.worker()?, b.worker()?);
    let oriented = match is_home {
        true => oriented::stored(&a, &mut workers.0)?.zip(oriented::stored(&b, &mut workers.1)?),
        false => None,
    };
    let oriented = oriented.map(|(a, b)| Oriented::new(a, b));
    let keeps_surfaces = solid.home().is_some() && b.surfaces(control)?.is_some_and(|list| !list.is_empty());
    let a = Proven(a);
    // The threads are shared out by placements.
    let alone = Control { threads: 1, ..*control };
    let one = |waiting: &mut Waiting, placement: &Affine| {
        if solid.motion() == Motion::Exact
            && let Some(moved) = solid.placed(placement)?
        {
            let found =
                of_classifiers(a.clone(), Proven(moved.on(frame, control)?), tolerance, &alone, &job)?;
            job.advance(WHOLE / placements.len());
            return Ok(found);
        }
        let known = match &oriented {
            Some(oriented) => Some(oriented.interference(placement, waiting, control, &job)?),
            None => None,
        };
        let found = match known.filter(|known| is_enough(known, placement, tolerance)) {
            Some(known) => known,
            None => {
                let spent = known.map_or(0, |known| known.splits.iter().sum::<u64>());
                let left = control.max_splits.map(|most| most.saturating_sub(spent));
                let around = bounds.and_then(|bounds| bounds.placed(placement));
                let b = Proven(TransformClassifier::new(b.clone(), placement, frame, around));
                let own = Control { max_splits: left, ..alone };
                let found = of_classifiers(a.clone(), b, tolerance, &own, &job)?;
                known.map_or(found, |known| found.with(&known))
            }
        };
        // Moving surfaces takes some thousand splits, which only close contacts justify.
        let found = if keeps_surfaces && found.verdict == Overlap::Undecided {
            let moved = Transform::new(solid, own, placement).on(frame, control)?;
            of_classifiers(a.clone(), Proven(moved), tolerance, &alone, &job)?.with(&found)
        } else {
            found
        };
        job.advance(WHOLE / placements.len());
        Ok::<_, Error>(found)
    };
    let mut found = memory::with_capacity(placements.len())?;
    control.run(placements.len() > 1, |parallel| {
        // Work in batches, so that the results collected in the background stay small.
        for piece in placements.chunks(PIECE) {
            found.extend(each_with(parallel, piece.iter(), Waiting::default, one)?);
        }
        Ok(found)
    })
}

/// True if oriented boxes gave the complete answer. Cells on planes of the lattice may decide contacts along
/// these planes.
fn is_enough(known: &Interference, placement: &Affine, tolerance: f64) -> bool {
    let is_certain = known.verdict != Overlap::Undecided || !placement.is_monomial();
    is_certain && known.volume.width() <= tolerance
}

impl Interference {
    /// Combines the results of two searches about the same solids.
    fn with(self, known: &Interference) -> Interference {
        let lower = self.volume.lower.max(known.volume.lower);
        let stronger = if self.verdict == Overlap::Undecided { known } else { &self };
        // A ball lies in the cell of its own search.
        let Interference { witness, ball, .. } =
            if self.ball.is_some() || known.ball.is_none() { self } else { *known };
        Interference {
            verdict: stronger.verdict,
            witness,
            ball,
            volume: Interval::between(lower, self.volume.upper.min(known.volume.upper).max(lower)),
            splits: [self.splits[0] + known.splits[0], self.splits[1] + known.splits[1]],
            level: self.level.max(known.level),
            ..self
        }
    }
}

/// Number of placements handed to the threads at once.
const PIECE: usize = 4096;
