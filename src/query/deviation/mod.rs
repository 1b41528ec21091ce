//! The distance between the boundaries of two solids (Hausdorff distance).

mod cells;
mod piece;
mod polygon;
#[cfg(feature = "std")]
mod reference;
mod search;
mod slabs;
mod surface;

use super::StopReason;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Frame, Interval, valid};
#[cfg(feature = "std")]
use crate::memory;
#[cfg(feature = "std")]
use crate::mesh::TriangleMesh;
use crate::octree::{Proof, Tag};
use crate::solid::{AskWhole, Classifier, DynSolid};
use crate::walk::Proven;
#[cfg(feature = "std")]
use alloc::vec::Vec;
#[cfg(feature = "std")]
pub(crate) use reference::{Reference, Remade};
#[cfg(feature = "std")]
use search::Beyond;
use search::Search;
use surface::{Seen, Surface};

/// Proven bounds of the distances between the boundaries of two solids, in both directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// The greatest distance of a point of the first boundary from the second boundary.
    pub a_to_b: OneWay,
    /// The greatest distance of a point of the second boundary from the first boundary.
    pub b_to_a: OneWay,
    /// The reason why the search ended: the weaker of both directions' reasons.
    pub stop_reason: StopReason,
    /// Number of cell splits in the first solid and in the second; 0 for a solid whose boundary is known to
    /// consist of triangles.
    pub splits: [u64; 2],
    /// Number of cuts of the first boundary's pieces, and of the second boundary's pieces.
    pub cuts: [u64; 2],
    /// The proofs of the first and of the second solid: which verdicts are proven. Unproven verdicts count as
    /// undecided.
    pub proofs: [Proof; 2],
    /// Whether the first solid and the second may continue outside of the universe. The search considers only
    /// the boundary points inside of the universe, but their distances from all of the other boundary.
    pub clipped: [bool; 2],
}

/// Proven bounds of the greatest distance of a boundary's points from another boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneWay {
    /// The greatest distance of a point of the one boundary from the nearest point of the other, in model
    /// units. 0 if the first solid has no boundary; infinite if the second has none and the first has.
    pub distance: Interval,
    /// The place where the lower bound is attained, if the bound is greater than 0.
    pub at: Option<Witness>,
}

/// A witness: a place where two boundaries are far from each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Witness {
    /// A point next to the first boundary (model units).
    pub point: [f64; 3],
    /// An upper bound of the point's distance from the first boundary: 0 if the point is a vertex of a mesh.
    pub apart: f64,
    /// The nearest point next to the second boundary, as far as that boundary is known.
    pub nearest: [f64; 3],
}

/// The verdict on a maximal distance: whether two boundaries are within a distance of each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Within {
    /// Proven: no point of either boundary is further from the other than the given distance.
    Yes = 0,
    /// Proven: a point of one boundary is further from the other than the given distance.
    No = 1,
    /// Neither is proven.
    Undecided = 2,
}

impl Deviation {
    /// Returns the greater of both directions: the Hausdorff distance of the boundaries.
    pub fn distance(&self) -> Interval {
        let (one, other) = (self.a_to_b.distance, self.b_to_a.distance);
        Interval::between(one.lower.max(other.lower), one.upper.max(other.upper))
    }

    /// Returns whether the boundaries are within a distance (model units) of each other. For two solids that
    /// end inside of the universe, a distance of 0 tests whether they have the same boundary.
    pub fn within(&self, distance: f64) -> Within {
        let known = self.distance();
        if known.upper <= distance {
            Within::Yes
        } else if known.lower > distance {
            Within::No
        } else {
            Within::Undecided
        }
    }
}

/// The maximal number of cells of a solid that [`deviation`] splits if `control.max_splits` sets no other
/// limit; and a 64th of the maximal number of cuts of pieces.
pub const DEVIATION_SPLITS: u64 = 1 << 18;

/// The precision of a comparison with a limit, as a part of the limit.
#[cfg(feature = "std")]
const EXACT: f64 = 1.0 / 128.0;

/// The maximal number of cuts of a triangle in a comparison with a limit.
#[cfg(feature = "std")]
const BEYOND: u64 = 1 << 10;

/// Cells determine the boundary to the tolerance divided by this.
const CELLS: f64 = 12.0;

/// The ratio of cuts of pieces to cell splits in the budget.
const CUTS: u64 = 64;

/// Returns the distances between the boundaries of `a` and `b`, in both directions (the Hausdorff distance is
/// the greater one). To move a solid first, put it under a placement (see
/// [`AnySolid::placed`](crate::AnySolid::placed)). The search covers the universe of `frame`.
///
/// The boundary of a closed mesh whose triangles do not intersect is known exactly. Triangles within the
/// solid, such as those of a body inside of another one, do not belong to the boundary. Triangles that
/// intersect others are cut into pieces, which are known exactly except within a twelfth of `tolerance`
/// (model units) of the intersections. (Where triangles lie on each other, or 524 288 pieces are too few,
/// cells are used.) For any other solid, cells of `frame` are split until the slabs of each locate the
/// boundary to a twelfth of `tolerance`. Faces between FULL and EMPTY cells are known exactly. Undecided
/// cells widen the intervals. Both boundaries then consist of plane pieces. The search cuts these pieces and
/// finds the answer to rounding (about 10^-12 of the coordinates).
///
/// The result's `stop_reason` means:
/// - `Tolerance`: both intervals are no wider than `tolerance`. Two solids that are proven and have the same
///   [fingerprint](crate::Solid::fingerprint) have the distance 0.
/// - `Exhausted`: neither cells nor pieces can improve the result. The cells of a solid without slabs locate
///   the boundary to about four times the diagonal of a finest cell.
/// - `Budget`: `control.max_splits` cells of a solid were split, or [`DEVIATION_SPLITS`] if that is `None`,
///   or 64 times as many pieces cut; or the stored data comes near to `control.max_bytes`. The largest doubt
///   is processed first.
///
/// Complexity: O(n log n) for meshes of n triangles whose surfaces lie close to each other, some microseconds
/// a triangle. Memory is linear in the triangles and in the cells: a curved surface with the area s and the
/// greatest curvature c has about c · s / `tolerance` cells. The result does not depend on the number of
/// threads, which share the pieces. One thread splits cells.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; the solids' own errors;
/// [`Error::OutOfMemory`] and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, deviation, query::Within};
/// let frame = Frame::new([-2.0; 3], 4.0, 20)?;
/// let (a, b) = (Csg::cuboid([-1.0; 3], [1.0; 3])?, Csg::cuboid([-1.0; 3], [1.0, 1.0, 1.25])?);
/// let found = deviation(&a, &b, &frame, 1e-6, &Control::default())?;
/// assert!(found.distance().contains(0.25) && found.distance().width() <= 1e-6);
/// assert_eq!((found.within(0.3), found.within(0.2)), (Within::Yes, Within::No));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn deviation(
    a: &dyn DynSolid,
    b: &dyn DynSolid,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Deviation, Error> {
    valid::tolerance("tolerance", tolerance)?;
    let job = Job::new(control);
    job.check()?;
    let is_alike = a.fingerprint().is_some_and(|own| b.fingerprint() == Some(own));
    let (a, b) = (Proven(a.on(frame, control)?), Proven(b.on(frame, control)?));
    // (Boundaries that lie somewhere near the same mesh may differ from each other.)
    let is_exact = |proof: Proof| proof.is_certified() && proof.displacement() == 0.0;
    let is_same = is_alike && is_exact(a.proof()) && is_exact(b.proof());
    let mut found = Deviation {
        a_to_b: OneWay { distance: Interval::exactly(0.0), at: None },
        b_to_a: OneWay { distance: Interval::exactly(0.0), at: None },
        stop_reason: StopReason::Tolerance,
        splits: [0; 2],
        cuts: [0; 2],
        proofs: [a.proof(), b.proof()],
        clipped: [a.exterior() != Tag::Empty, b.exterior() != Tag::Empty],
    };
    if !is_same {
        let budget = control.max_splits.unwrap_or(DEVIATION_SPLITS);
        let surfaces =
            [surface(&a, tolerance / CELLS, budget, &job)?, surface(&b, tolerance / CELLS, budget, &job)?];
        let seen = [surfaces[0].seen(control)?, surfaces[1].seen(control)?];
        let budget = budget.saturating_mul(CUTS);
        let mut reasons = [StopReason::Tolerance; 2];
        for (k, reason) in reasons.iter_mut().enumerate() {
            let search = Search { from: &seen[k], to: &seen[1 - k], tolerance, budget };
            let worth = seen.iter().any(Seen::is_large);
            let (way, cuts, own) = control.run(worth, |parallel| search.run(parallel, &job))?;
            *reason = match own {
                StopReason::Exhausted if surfaces.iter().any(|surface| surface.is_cut_short) => {
                    StopReason::Budget
                }
                own => own,
            };
            found.cuts[k] = cuts;
            *(if k == 0 { &mut found.a_to_b } else { &mut found.b_to_a }) = way;
        }
        found.splits = [surfaces[0].splits, surfaces[1].splits];
        let is_any = |reason| reasons.contains(&reason);
        found.stop_reason = [StopReason::Budget, StopReason::Exhausted]
            .into_iter()
            .find(|&reason| is_any(reason))
            .unwrap_or(StopReason::Tolerance);
    }
    job.advance(WHOLE);
    Ok(found)
}

/// Returns an upper bound of the distance between the triangles of two meshes, in both directions, and the
/// triangles of the second mesh near which the distance is not proven to be within the limit (model units; in
/// no order, some more than once). The bound is only as exact as `limit` requires. Unlike [`deviation`] of
/// closed meshes, the comparison uses all triangles, whatever they enclose.
#[cfg(feature = "std")]
pub(crate) fn meshes_apart(
    a: &TriangleMesh,
    b: &TriangleMesh,
    limit: f64,
    control: &Control<'_>,
) -> Result<(f64, Vec<u32>), Error> {
    let job = Job::new(control);
    let surfaces = [Surface::of_triangles(a)?, Surface::of_triangles(b)?];
    let seen = [surfaces[0].seen(control)?, surfaces[1].seen(control)?];
    if seen[0].is_empty() || seen[1].is_empty() {
        let far = if seen[0].is_empty() && seen[1].is_empty() { 0.0 } else { f64::INFINITY };
        return Ok((far, Vec::new()));
    }
    let worth = seen.iter().any(Seen::is_large);
    let (mut most, mut beyond) = (0.0, Vec::new());
    for k in 0..2 {
        let (from, to) = (&seen[k], &seen[1 - k]);
        let search = Search { from, to, tolerance: limit * EXACT, budget: DEVIATION_SPLITS };
        let (own, list) = control.run(worth, |parallel| {
            search.beyond((1.0 - EXACT) * limit, &|_, _| true, BEYOND, parallel, &job)
        })?;
        job.advance(WHOLE / 2);
        most = f64::max(most, own);
        for Beyond { triangle, nearest, .. } in list {
            let of_second = if k == 0 { nearest } else { Some(triangle) };
            if let Some(triangle) = of_second {
                memory::push(&mut beyond, triangle)?;
            }
        }
    }
    Ok((most, beyond))
}

/// Returns the boundary of a solid: exactly, or to a tolerance by at most `budget` cells.
fn surface<C: Classifier>(solid: &C, tolerance: f64, budget: u64, job: &Job<'_>) -> Result<Surface, Error> {
    match solid.facets(job.control())? {
        Some(facets) => Surface::of_facets(facets),
        None => match solid.pieces(tolerance, job.control())? {
            Some(pieces) => Surface::of_pieces(pieces),
            None => cells::surface(solid, tolerance, budget, job),
        },
    }
}
