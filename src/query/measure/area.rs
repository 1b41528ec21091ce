//! Certified area of any solid's boundary.

use super::faces::WithFaces;
use super::quantity::{self, Quantity};
use super::walk::walk;
use super::{StopReason, Tolerance};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::{Cell, Frame, Interval, MAX_DEPTH, valid};
use crate::octree::{Proof, Tag};
use crate::solid::{AnyClassifier, Ask, AskWhole, Classifier, DynSolid, Worker};
use crate::walk::Proven;
use core::ops::AddAssign;

/// The area of a solid's boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceArea {
    /// The area in square model units. The interval contains the true area; its upper end is infinite where
    /// nothing is known.
    pub area: Interval,
    /// Whether the solid continues, or may continue, outside of the universe. The area is then that of the
    /// boundary inside.
    pub clipped: bool,
    /// The reason why the measurement ended.
    pub stop_reason: StopReason,
    /// The finest level of the visited cells.
    pub level: u8,
    /// Number of cell splits.
    pub splits: u64,
}

/// The maximal number of splits in the measurement of an area if `max_splits` sets no other limit: some
/// seconds.
pub const AREA_SPLITS: u64 = 1 << 23;

/// The number of frames tried.
const FRAMES: u8 = 8;

/// Measures the area of the boundary of `solid` in the universe of `frame`. As in
/// [`measure`](crate::measure), the measurement runs to a `tolerance` (a plain number is relative to the
/// middle of the interval), with at most `max_splits` of `control` ([`AREA_SPLITS`] if that is `None`), and
/// with the same result for any number of threads.
///
/// With N splits the width decreases with 1/N on curved surfaces and where plane ones meet. A closed mesh
/// whose triangles do not intersect is not split.
///
/// A boundary piece between two cells belongs to neither of them. If a solid ends inside of the universe and
/// its boundary has pieces in planes of the lattice, its area is measured on another lattice, whose planes
/// are elsewhere. Three solids stay on their own lattice: an extended octree
/// ([`build_extended`](crate::build_extended)), an octree without PARTIAL cells, and a clipped expression.
/// Their cells count the pieces in faces between cells where the solid differs on the two sides. An extended
/// octree therefore has the area of its source, as exact after as many splits. A cell that keeps slabs has no
/// upper bound, and neither has a cell that is given up.
///
/// The area is unknown for an octree with PARTIAL cells that keep no surfaces, for a host program's
/// functions, and for a clipped mesh with faces in planes of the lattice.
///
/// # Errors
/// As [`measure`](crate::measure).
///
/// ```
/// use leafless::{Control, Csg, Frame, query::surface_area};
/// let frame = Frame::new([-1.0; 3], 2.0, 20)?;
/// let ball = surface_area(&Csg::ball([0.1, 0.0, 0.0], 0.75)?, &frame, 1e-3, &Control::default())?;
/// assert!(ball.area.contains(4.0 * std::f64::consts::PI * 0.75f64.powi(2)));
/// assert!(ball.area.width() <= 1e-3 * ball.area.upper);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn surface_area(
    solid: &dyn DynSolid,
    frame: &Frame,
    tolerance: impl Into<Tolerance>,
    control: &Control<'_>,
) -> Result<SurfaceArea, Error> {
    let tolerance = tolerance.into();
    valid::tolerance("tolerance", tolerance.relative)?;
    valid::tolerance("tolerance", tolerance.absolute)?;
    let classifier = Proven(solid.on(frame, control)?);
    let clipped = !matches!(classifier.exterior(), Tag::Empty | Tag::Full);
    // The result without any splits.
    let told = |area: Interval| {
        let wanted = tolerance.absolute.max(tolerance.relative * (0.5 * (area.lower + area.upper)));
        let is_met = area.upper < f64::INFINITY && area.width() <= wanted;
        let stop_reason = if is_met { StopReason::Tolerance } else { StopReason::Exhausted };
        SurfaceArea { area, clipped, stop_reason, level: 0, splits: 0 }
    };
    if !clipped && let Some(area) = classifier.area(control)? {
        return Ok(told(area));
    }
    let search = Search { tolerance, clipped, control };
    if classifier.is_off_lattice() {
        return search.run(&classifier);
    }
    if !clipped
        && solid.home().is_none()
        && classifier.proof() == Proof::CERTIFIED
        && let Some(other) = off_lattice(solid, frame, control)?
    {
        return search.run(&other);
    }
    match WithFaces::new(classifier, control)? {
        Some(with_faces) => search.run(&with_faces),
        None => Ok(told(Area::NOTHING)),
    }
}

struct Search<'a, 'c> {
    tolerance: Tolerance,
    clipped: bool,
    control: &'a Control<'c>,
}

impl Search<'_, '_> {
    /// Splits cells of a solid whose whole boundary lies in cells.
    fn run<C: Classifier>(&self, classifier: &C) -> Result<SurfaceArea, Error> {
        let budget = self.control.max_splits.unwrap_or(AREA_SPLITS);
        let walked = walk::<Area, _>(classifier, self.tolerance, budget, self.control)?;
        let Found { lower, upper, unbounded } = walked.found;
        // Half the universe's edge is 2^(BITS / 2) units.
        let edge = Interval::exactly(classifier.frame().edge());
        let unit = edge.square().times(Interval::exactly(0.25 / (1u128 << BITS) as f64));
        let most = if unbounded > 0 { f64::INFINITY } else { Interval::of_integer(upper).times(unit).upper };
        let area = Interval::between(Interval::of_integer(lower).times(unit).lower, most);
        let (stop_reason, level, splits) = (walked.stop_reason, walked.level, walked.splits);
        Ok(SurfaceArea { area, clipped: self.clipped, stop_reason, level, splits })
    }
}

/// Returns the solid on a larger frame whose lattice planes hold no piece of the boundary, if such a frame is
/// found.
fn off_lattice<'s>(
    solid: &(dyn DynSolid + 's),
    frame: &Frame,
    control: &Control<'_>,
) -> Result<Option<Proven<AnyClassifier<'s>>>, Error> {
    let depth = (frame.depth() + 1).min(MAX_DEPTH);
    for k in 0..FRAMES {
        // Multiples of the golden ratio: dimensions of parts are unlikely to coincide with them.
        let shift = [0.381_966_011_250_105, 0.236_067_977_499_790, 0.618_033_988_749_895];
        let origin = axes(|axis| frame.origin()[axis] - (shift[axis] + 0.01 * k as f64) * frame.edge());
        let Ok(other) = Frame::new(origin, 2.0 * frame.edge(), depth) else { continue };
        let classifier = Proven(solid.on(&other, control)?);
        if classifier.is_off_lattice() && matches!(classifier.exterior(), Tag::Empty | Tag::Full) {
            return Ok(Some(classifier));
        }
    }
    Ok(None)
}

/// Fraction bits of the square of the universe's half edge.
const BITS: u32 = SHARE_BITS + 2 * MAX_DEPTH as u32;

/// Fraction bits of the square of a finest cell's half edge.
const SHARE_BITS: u32 = 44;

/// The area of a boundary, in fixed point: sums are the same in any order.
struct Area {
    /// For each level, the sums of lower and upper bounds, in squares of the cells' half edges.
    levels: [[i128; 2]; MAX_DEPTH as usize + 1],
    unbounded: u64,
}

/// The bounds of an area, and the number of cells without an upper bound.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    lower: i128,
    upper: i128,
    unbounded: u64,
}

impl AddAssign for Found {
    fn add_assign(&mut self, other: Found) {
        self.lower += other.lower;
        self.upper += other.upper;
        self.unbounded += other.unbounded;
    }
}

impl quantity::Found for Found {
    fn least(&self) -> f64 {
        self.lower as f64
    }

    fn doubt(&self) -> f64 {
        if self.unbounded > 0 { f64::INFINITY } else { (self.upper - self.lower) as f64 }
    }
}

impl Quantity for Area {
    type Known = Interval;
    type Found = Found;

    const DIMENSION: u8 = 2;
    const SIZE: f64 = 6.0;
    const UNIVERSE: f64 = 24.0 * (1u128 << BITS) as f64;
    const NOTHING: Interval = Interval::between(0.0, f64::INFINITY);

    fn known<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part) -> Result<Interval, Error> {
        // No area is negative: an answer with a negative upper bound is ignored.
        Ok(worker.area(cell, part)?.filter(|area| area.upper >= 0.0).unwrap_or(Area::NOTHING))
    }

    fn doubt(known: &Interval) -> f64 {
        (known.width() / 24.0).min(1.0)
    }

    fn new() -> Area {
        Area { levels: [[0; 2]; MAX_DEPTH as usize + 1], unbounded: 0 }
    }

    fn full(&mut self, _: Cell) {}

    fn open(&mut self, cell: Cell, known: &Interval) {
        // A surface with endless folds may have more area. It counts as unbounded.
        const MOST: f64 = (1u64 << 20) as f64;
        const SHARE: f64 = (1u64 << SHARE_BITS) as f64;
        let [lower, upper] = &mut self.levels[cell.level as usize];
        *lower += (known.lower.clamp(0.0, MOST) * SHARE) as i128;
        if known.upper <= MOST {
            *upper += (known.upper * SHARE) as i128 + 1;
        } else {
            self.unbounded += 1;
        }
    }

    fn finish(self) -> Found {
        let mut found = Found { unbounded: self.unbounded, ..Found::default() };
        for (level, [lower, upper]) in (0u32..).zip(self.levels) {
            let shift = 2 * (MAX_DEPTH as u32 - level);
            found.lower += lower << shift;
            found.upper += upper << shift;
        }
        found
    }
}
