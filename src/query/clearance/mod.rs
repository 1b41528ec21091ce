//! The distance between two solids.

mod depth;
mod facets;
mod nodes;
mod piece;
mod polish;
mod ready;
mod search;
mod simplex;

use super::StopReason;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, Bounds, Cell, Frame, Interval, axes, valid};
use crate::memory;
use crate::octree::Proof;
use crate::parallel::each;
use crate::solid::{
    AnyClassifier, AskWhole, Classifier, DynSolid, Motion, Solid, Transform, TransformClassifier,
};
use crate::walk::Proven;
use alloc::vec::Vec;
use facets::{Boundary, ByFacets, Pair};
use piece::Place;
pub(crate) use ready::{Asked, Ready};
use search::{Found, Goal, Search};

/// Proven bounds of the distance between two solids, with the points that attain it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// The least distance between points of the two solids, in model units: 0 if they touch or overlap. The
    /// upper bound is infinite as long as one of the solids has no proven point. The lower bound is infinite
    /// too if one of the solids is proven to be empty. The lower bound is 0 if `clipped`.
    pub distance: Interval,
    /// A point of the first solid and a point of the second (model units). Their distance is at most the
    /// upper bound, except for the rounding of their coordinates to doubles. For a mesh with a
    /// [`displacement`](crate::TriangleMesh::displacement) the point is one of the mesh. If the solids are
    /// proven to overlap with a `depth`, both points are the same. The points are present whenever the upper
    /// bound is finite.
    pub points: Option<[[f64; 3]; 2]>,
    /// For each of the points, a unit vector that leads out of the solid there, if the point lies next to a
    /// surface with a known direction. The vector is normal to the surface, except for rounding and for the
    /// surface's curvature within the cell.
    pub normals: [Option<[f64; 3]>; 2],
    /// The cells of the first and of the second solid that hold these points. They are cells of the frame's
    /// depth if the points come from triangles.
    pub nearest: Option<[Cell; 2]>,
    /// For solids that overlap: the radius (model units) of a ball that is proven to lie in both. The largest
    /// such ball is at least as large. 0 if no ball was found, as for solids that only touch.
    pub depth: f64,
    /// The reason why the search ended.
    pub stop_reason: StopReason,
    /// Number of cell splits in the first solid and in the second. 0 where triangles determine the distance.
    pub splits: [u64; 2],
    /// The proofs of the first and of the second solid: which verdicts are proven. Unproven verdicts count as
    /// undecided.
    pub proofs: [Proof; 2],
    /// Whether one of the solids continues, or may continue, outside of the universe, where it may come
    /// nearer to the other.
    pub clipped: bool,
}

/// The verdict on a minimum gap: whether two solids are at least a given distance apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum GapVerdict {
    /// Proven: no two points of the solids are nearer.
    Yes = 0,
    /// Proven: two points are nearer. The evidence contains them.
    No = 1,
    /// Not decided at the frame's depth, or before the splits were spent; or a solid may continue outside of
    /// the universe, and come nearer there.
    Undecided = 2,
}

/// A verdict on a minimum gap, with the evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// The answer.
    pub verdict: GapVerdict,
    /// The bounds of the distance when the search ended. The search does not compute `depth`, which is 0.
    pub evidence: Clearance,
}

/// The maximal number of steps of [`clearance`] if `control.max_splits` sets no other limit: some seconds,
/// and some hundred megabytes at the most.
pub const CLEARANCE_SPLITS: u64 = 1 << 20;

/// Returns the least distance between `a` and `b`, with a point of each solid at that distance. To move a
/// solid first, put it under a placement (see [`AnySolid::placed`](crate::AnySolid::placed)). The search
/// covers the universe of `frame`.
///
/// The search ends, and the result's `stop_reason` says why:
/// - `Tolerance`: the interval is no wider than `tolerance` (model units).
/// - `Exhausted`: the cells of the frame's depth cannot raise the lower bound, and the interval is no wider
///   than twice their diagonal, which is the resolution of cells for most solids; or no pair of cells is
///   left; or a solid may continue outside of the universe, which keeps the lower bound at 0.
/// - `Budget`: `control.max_splits` steps were taken, or [`CLEARANCE_SPLITS`] if that is `None`. A step
///   visits the children of one cell. A cell whose children are visited again, next to another cell, counts
///   once more. The search ends for the same reason when the stored parts of a solid come near to
///   `control.max_bytes`.
///
/// If the boundaries of both solids are known to consist of triangles
/// ([`WholeQuestion::Walls`](crate::solid::WholeQuestion::Walls)), the search compares triangles instead of
/// cells. This applies to closed meshes in the universe. The bodies of such a mesh may overlap, unless the
/// rule is [`FillRule::Positive`](crate::FillRule::Positive), or triangles lie on each other, or vertices
/// were moved. The distance is then known to rounding, about 10^-13 of the meshes' sizes and of their
/// distance. A step is 64 pairs of boxes around triangles. The preparation takes O(t). Finding the nearest
/// place of two parts takes about ten to a hundred microseconds, or O(t) where surfaces run alongside each
/// other. Only the depth of an overlap is found by cells.
///
/// If both solids provide slabs of cells ([`Enclosure`](crate::solid::Enclosure)), each level makes the
/// interval about four times as narrow, and plane faces are known at once. If they provide the surfaces too
/// ([`OpenSurfaces`](crate::solid::OpenSurfaces)), as expressions and extended octrees do, balls and
/// cylinders are known at once: a pin in a bore with the same play all around takes some hundred splits.
/// Without slabs a level makes the interval half as wide. The upper bound is then finite once the search has
/// met a FULL cell of each solid. The work grows with the area where the distance is about the least one,
/// measured in cells as large as the tolerance.
///
/// The search looks for points of both solids first, with up to half of the budget. If nothing else is left
/// to do, it spends all of the budget on the points. Memory is linear in the steps and in the size of the
/// compared solids. It uses one thread.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; the solids' own errors;
/// [`Error::OutOfMemory`] and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, clearance};
/// let frame = Frame::new([0.0; 3], 128.0, 10)?;
/// let (a, b) = (Csg::ball([50.0; 3], 30.0)?, Csg::ball([86.0; 3], 30.0)?);
/// let found = clearance(&a, &b, &frame, 1e-9, &Control::default())?;
/// assert!(found.distance.contains(36.0 * 3f64.sqrt() - 60.0) && found.distance.width() <= 1e-9);
/// let [p, q] = found.points.unwrap();
/// assert!((p[0] - (50.0 + 30.0 / 3f64.sqrt())).abs() < 1e-3 && (q[2] - (86.0 - 30.0 / 3f64.sqrt())).abs() < 1e-3);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn clearance(
    a: &dyn DynSolid,
    b: &dyn DynSolid,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Clearance, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    job.check()?;
    let is_mesh = b.motion() == Motion::Vertices;
    let (a, b) = (Proven(a.on(frame, control)?), Proven(b.on(frame, control)?));
    let found = both_apart((&a, &b), is_mesh, Goal::width(tolerance), &job)?;
    job.advance(WHOLE);
    Ok(found)
}

/// Returns the [`clearance`] of `a` and `b` under each of the `placements`, in their order. The solid `a`
/// stands on `frame`, `b` on its `own` frame; both are prepared once. The results do not depend on the number
/// of threads. `control.max_splits` applies to each placement. Meshes whose triangles determine the distance
/// are moved exactly, and are prepared once. Expressions are moved exactly ([`Motion::Exact`]). Octrees that
/// keep their surfaces are moved with these surfaces, as [`Transform`] moves them. All other solids are moved
/// by their cells.
///
/// # Errors
/// As [`clearance`].
///
/// ```
/// use leafless::{Affine, Control, Csg, Frame, query::clearance_at};
/// let frame = Frame::new([-8.0; 3], 16.0, 8)?;
/// let (a, b) = (Csg::ball([0.0; 3], 1.0)?, Csg::ball([0.0; 3], 2.0)?);
/// let places = [4.0, 5.0].map(|x| Affine::translation([x, 0.0, 0.0]).unwrap());
/// let found = clearance_at(&a, &b, &frame, &places, &frame, 1e-3, &Control::default())?;
/// assert!(found[0].distance.contains(1.0) && found[1].distance.contains(2.0));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn clearance_at(
    a: &dyn DynSolid,
    b: &dyn DynSolid,
    own: &Frame,
    placements: &[Affine],
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Vec<Clearance>, Error> {
    valid::tolerance("tolerance", tolerance)?;
    at_each((a, b), own, placements, frame, Goal::width(tolerance), control)
}

/// Returns whether no point of `a` is nearer than `least` (model units) to a point of `b`. The search ends as
/// soon as the answer is proven. This is faster than computing the distance: if the solids are much further
/// apart, or much nearer, a few cells decide. The search covers the universe of `frame`.
///
/// Budget, memory and threads are as for [`clearance`]. If the distance equals `least` to the last digit, the
/// budget may end without a proof.
///
/// # Errors
/// [`Error::Argument`] if `least` is not between 2^-256 and 2^256 (to find out whether solids overlap, use
/// [`interference`](crate::interference)); the solids' own errors; [`Error::OutOfMemory`] and
/// [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::{GapVerdict, gap_at_least}};
/// let frame = Frame::new([0.0; 3], 128.0, 10)?;
/// let (a, b) = (Csg::ball([50.0; 3], 30.0)?, Csg::ball([86.0; 3], 30.0)?);
/// let gap = |least| gap_at_least(&a, &b, &frame, least, &Control::default());
/// assert_eq!(gap(2.3)?.verdict, GapVerdict::Yes);
/// let found = gap(2.4)?;
/// assert!(found.verdict == GapVerdict::No && found.evidence.points.is_some());
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn gap_at_least(
    a: &dyn DynSolid,
    b: &dyn DynSolid,
    frame: &Frame,
    least: f64,
    control: &Control<'_>,
) -> Result<Gap, Error> {
    valid::length("least", least)?;
    let job = Job::new(control);
    job.check()?;
    let is_mesh = b.motion() == Motion::Vertices;
    let (a, b) = (Proven(a.on(frame, control)?), Proven(b.on(frame, control)?));
    let evidence = both_apart((&a, &b), is_mesh, Goal::AtLeast(least), &job)?;
    job.advance(WHOLE);
    Ok(Gap::new(evidence, least))
}

/// Returns [`gap_at_least`] of `a` and `b` under each of the `placements`. Frames and placements have the
/// same meaning as for [`clearance_at`].
///
/// # Errors
/// As [`gap_at_least`].
pub fn gap_at_least_at(
    a: &dyn DynSolid,
    b: &dyn DynSolid,
    own: &Frame,
    placements: &[Affine],
    frame: &Frame,
    least: f64,
    control: &Control<'_>,
) -> Result<Vec<Gap>, Error> {
    valid::length("least", least)?;
    let found = at_each((a, b), own, placements, frame, Goal::AtLeast(least), control)?;
    memory::collected(found.into_iter().map(|evidence| Gap::new(evidence, least)))
}

impl Gap {
    fn new(evidence: Clearance, least: f64) -> Gap {
        let verdict = match evidence.distance {
            distance if distance.lower >= least => GapVerdict::Yes,
            distance if distance.upper < least => GapVerdict::No,
            _ => GapVerdict::Undecided,
        };
        Gap { verdict, evidence }
    }
}

/// Number of placements handed to the threads at once.
const PIECE: usize = 4096;

fn at_each(
    (a, b): (&dyn DynSolid, &dyn DynSolid),
    own: &Frame,
    placements: &[Affine],
    frame: &Frame,
    wanted: Goal,
    control: &Control<'_>,
) -> Result<Vec<Clearance>, Error> {
    let job = Job::new(control);
    job.check()?;
    let solid = b;
    let (a, b) = (Proven(a.on(frame, control)?), Proven(b.on(own, control)?));
    let boundaries = boundaries((&a, &b), solid.motion() == Motion::Vertices, control)?;
    let boundaries = boundaries.as_ref().map(|[own, other]| [own, other]);
    let moved = Moved::new(solid, own, &b, control)?;
    let one = |placement: &Affine| {
        let found = moved.apart_from(&a, boundaries, placement, wanted, &job)?;
        job.advance(WHOLE / placements.len());
        Ok::<_, Error>(found)
    };
    let mut found = memory::with_capacity(placements.len())?;
    control.run(placements.len() > 1, |parallel| {
        // Work in batches, so that the results collected in the background stay small.
        for piece in placements.chunks(PIECE) {
            found.extend(each(parallel, piece.iter(), one)?);
        }
        Ok(found)
    })
}

/// A solid on its own frame, for comparison with others in many placements.
struct Moved<'m> {
    solid: &'m dyn DynSolid,
    own: &'m Frame,
    classifier: &'m Proven<AnyClassifier<'m>>,
    bounds: Option<Bounds>,
    keeps_surfaces: bool,
    /// Whether the part outside of the universe does not count.
    is_clipped: bool,
    /// Whether the depth of an overlap is wanted.
    asks_depth: bool,
}

impl<'m> Moved<'m> {
    fn new(
        solid: &'m dyn DynSolid,
        own: &'m Frame,
        classifier: &'m Proven<AnyClassifier<'m>>,
        control: &Control<'_>,
    ) -> Result<Self, Error> {
        let keeps_surfaces =
            solid.home().is_some() && classifier.surfaces(control)?.is_some_and(|list| !list.is_empty());
        let bounds = solid.bounds();
        Ok(Moved { solid, own, classifier, bounds, keeps_surfaces, is_clipped: true, asks_depth: true })
    }

    /// Returns the distance from `a` under a placement. `boundaries` are the boundaries of both solids, if
    /// both consist of triangles.
    fn apart_from<A: Classifier>(
        &self,
        a: &A,
        boundaries: Option<[&Boundary; 2]>,
        placement: &Affine,
        wanted: Goal,
        job: &Job<'_>,
    ) -> Result<Clearance, Error> {
        let (frame, control) = (a.frame(), job.control());
        if self.solid.motion() == Motion::Exact
            && let Some(moved) = self.solid.placed(placement)?
        {
            return apart(a, &Proven(moved.on(frame, control)?), wanted, self.asks_depth, job);
        }
        let around = self.bounds.and_then(|bounds| bounds.placed(placement));
        let moved = Proven(TransformClassifier::new(self.classifier.0.clone(), placement, frame, around));
        match (boundaries, around) {
            (Some(boundaries), Some(around)) if !self.is_clipped || around.is_within(frame) => {
                let pair = Pair {
                    solids: (a, self.classifier),
                    boundaries,
                    placement: Some(placement).filter(|placement| !placement.is_identity()),
                };
                apart_by_facets(&pair, (a, &moved), wanted, self.asks_depth, job)
            }
            _ if self.keeps_surfaces => {
                let moved = Transform::new(self.solid, self.own, placement).on(frame, control)?;
                apart(a, &Proven(moved), wanted, self.asks_depth, job)
            }
            _ => apart(a, &moved, wanted, self.asks_depth, job),
        }
    }
}

/// Returns the boundaries of two solids, if both consist of triangles. A solid that is not a mesh answers
/// immediately and is therefore queried first: `is_mesh` says whether the second solid is a mesh.
fn boundaries<A: Classifier, B: Classifier>(
    (a, b): (&A, &B),
    is_mesh: bool,
    control: &Control<'_>,
) -> Result<Option<[Boundary; 2]>, Error> {
    if is_mesh {
        let Some(own) = Boundary::of(a, control)? else { return Ok(None) };
        return Ok(Boundary::of(b, control)?.map(|other| [own, other]));
    }
    let Some(other) = Boundary::of(b, control)? else { return Ok(None) };
    Ok(Boundary::of(a, control)?.map(|own| [own, other]))
}

/// Returns the clearance of two solids on one frame, from triangles or from cells.
fn both_apart<A: Classifier, B: Classifier>(
    (a, b): (&A, &B),
    is_mesh: bool,
    wanted: Goal,
    job: &Job<'_>,
) -> Result<Clearance, Error> {
    match boundaries((a, b), is_mesh, job.control())? {
        Some([own, other]) => {
            let pair = Pair { solids: (a, b), boundaries: [&own, &other], placement: None };
            apart_by_facets(&pair, (a, b), wanted, true, job)
        }
        None => apart(a, b, wanted, true, job),
    }
}

/// Returns the clearance from triangles. If the solids overlap and the depth is wanted, the cells of
/// `on_frame` determine it.
fn apart_by_facets<A: Classifier, B: Classifier, C: Classifier>(
    pair: &Pair<'_, A, B>,
    on_frame: (&A, &C),
    wanted: Goal,
    asks_depth: bool,
    job: &Job<'_>,
) -> Result<Clearance, Error> {
    let (a, b) = on_frame;
    let (frame, control) = (a.frame(), job.control());
    let budget = control.max_splits.unwrap_or(CLEARANCE_SPLITS);
    let ByFacets { mut distance, mut points, normals, mut stop_reason, is_open } =
        pair.distance(wanted, budget, job)?;
    let (mut depth, mut splits) = (0.0, [0; 2]);
    let asks_depth = asks_depth && matches!(wanted, Goal::Width { .. });
    if asks_depth && (distance.upper == 0.0 || is_open) {
        let mut search = Search::new(a, b, wanted, budget, control)?;
        if let Some((centre, radius)) = depth::common_ball(&mut search, job)? {
            (distance, stop_reason) = (Interval::exactly(0.0), StopReason::Tolerance);
            depth = radius;
            points = Some([modelled(frame, &centre.each(Interval::exactly)); 2]);
        }
        splits = [search.a.subject.splits, search.b.subject.splits];
    }
    let cell = |point| Some(Cell { level: frame.depth(), at: frame.cell_of(point)? });
    let nearest = points.and_then(|[p, q]| Some([cell(p)?, cell(q)?]));
    let proofs = [a.proof(), b.proof()];
    Ok(Clearance { distance, points, normals, nearest, depth, stop_reason, splits, proofs, clipped: false })
}

/// Returns the clearance of two solids on one frame from their cells.
fn apart<A: Classifier, B: Classifier>(
    a: &A,
    b: &B,
    wanted: Goal,
    asks_depth: bool,
    job: &Job<'_>,
) -> Result<Clearance, Error> {
    let control = job.control();
    let budget = control.max_splits.unwrap_or(CLEARANCE_SPLITS);
    let mut search = Search::new(a, b, wanted, budget, control)?;
    let Found { distance, reached, stop_reason } = search.run(job)?;
    let frame = a.frame();
    let mut points = reached.map(|reached| reached.points.each(|point| modelled(frame, &point)));
    let mut normals = [None; 2];
    if let Some(reached) = &reached {
        let [p, q] = &reached.points;
        normals = [search.a.normal(reached.nodes[0], p), search.b.normal(reached.nodes[1], q)];
    }
    let mut depth = 0.0;
    if asks_depth
        && matches!(wanted, Goal::Width { .. })
        && distance.upper == 0.0
        && let Some((centre, radius)) = depth::common_ball(&mut search, job)?
    {
        depth = radius;
        points = Some([modelled(frame, &centre.each(Interval::exactly)); 2]);
        normals = [None; 2];
    }
    // A part outside of the universe may come arbitrarily near.
    let clipped = search.a.subject.is_clipped() || search.b.subject.is_clipped();
    let distance = if clipped { Interval::between(0.0, distance.upper) } else { distance };
    let is_wide = match wanted {
        Goal::Width { tolerance, below } => distance.width() > tolerance && distance.lower < below,
        Goal::AtLeast(least) => distance.lower < least && distance.upper >= least,
    };
    let stop_reason = match stop_reason {
        // No cell of the universe can raise the lower bound.
        StopReason::Tolerance if clipped && is_wide => StopReason::Exhausted,
        other => other,
    };
    Ok(Clearance {
        distance,
        points,
        normals,
        nearest: reached.map(|reached| [search.a.cell(reached.nodes[0]), search.b.cell(reached.nodes[1])]),
        depth,
        stop_reason,
        splits: [search.a.subject.splits, search.b.subject.splits],
        proofs: [a.proof(), b.proof()],
        clipped,
    })
}

/// A point in model units, up to rounding.
fn modelled(frame: &Frame, place: &Place) -> [f64; 3] {
    axes(|axis| {
        let cells = 0.5 * (place[axis].lower + place[axis].upper);
        frame.origin()[axis] + cells * frame.cell_size()
    })
}
