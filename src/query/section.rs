//! The area of a solid's section with a plane.

use super::{StopReason, Tolerance};
use crate::control::{Control, Job, WHOLE};
use crate::cut::{SETTLED, Section};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use crate::lattice::{Cell, Frame, Interval, MAX_DEPTH, valid};
use crate::octree::Proof;
use crate::solid::{Ask, Classifier, DynSolid, Verdict, Worker};
use crate::walk::Part;
use crate::walk::Proven;
use crate::walk::Queue;
use crate::walk::Subject;
use core::cmp::Reverse;

/// A plane in any position: the points p with normal · (p − point) = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPlane {
    point: [f64; 3],
    normal: [f64; 3],
}

impl SectionPlane {
    /// Builds the plane through a point (model units) and perpendicular to `normal`. The normal may have any
    /// length and either direction.
    ///
    /// # Errors
    /// [`Error::Argument`] if `normal` is zero, or if the magnitude of a nonzero number is not between 2^-256
    /// and 2^256.
    pub fn new(point: [f64; 3], normal: [f64; 3]) -> Result<SectionPlane, Error> {
        valid::numbers("point", &point)?;
        valid::numbers("normal", &normal)?;
        if normal == [0.0; 3] {
            return Err(Error::Argument { name: "normal", problem: "must not be zero" });
        }
        Ok(SectionPlane { point, normal })
    }

    /// The axis that the normal is nearest to.
    fn axis(&self) -> usize {
        let size = self.normal.each(f64::abs);
        (0..3).fold(0, |most, axis| if size[axis] > size[most] { axis } else { most })
    }

    /// The ratio of an area in the plane to its projection along that axis.
    fn steepness(&self) -> Interval {
        let nearest = Interval::exactly(self.normal[self.axis()].abs());
        let squares = self.normal.each(|c| Interval::exactly(c).over(nearest).square());
        squares[0].plus(squares[1]).plus(squares[2]).root()
    }
}

/// The area of a solid's section with a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionArea {
    /// The area in square model units. The interval contains the true area.
    pub area: Interval,
    /// The proof of the solid: which verdicts are proven. Unproven verdicts count as undecided.
    pub proof: Proof,
    /// Whether the solid continues, or may continue, outside of the universe. The area is then that of the
    /// section inside.
    pub clipped: bool,
    /// The reason why the search ended.
    pub stop_reason: StopReason,
    /// Number of cell splits.
    pub splits: u64,
}

/// The maximal number of splits of [`section_area`] if `control.max_splits` sets no other limit: some
/// seconds, and some hundred megabytes at the most.
pub const SECTION_SPLITS: u64 = 1 << 20;

/// Returns the area of the section of `solid` with a plane, in the universe of `frame`. The result does not
/// depend on the number of threads, since there is only one.
///
/// The search splits only cells that the plane runs through, the cells with the widest interval first. It
/// ends, and the result's `stop_reason` says why:
/// - `Tolerance`: the interval is no wider than `tolerance` (a plain number is relative to the middle of the
///   interval).
/// - `Exhausted`: no cell is left whose split would help. The undecided cells have the size of the frame's
///   finest cells, or the solid provides nothing more about them, or only rounding is in doubt, about 2^-40
///   of the area.
/// - `Budget`: `control.max_splits` cells were split, or [`SECTION_SPLITS`] if that is `None`. The search
///   ends for the same reason when the stored parts of the solid come near to `control.max_bytes`.
///
/// Where the solid provides slabs of a cell ([`Enclosure`](crate::solid::Enclosure)), only the region between
/// the slabs is in doubt. With N splits the width then decreases with 1/N² on curved surfaces. Plane faces
/// are known to rounding as soon as no cell holds more than three of them. Without slabs the width decreases
/// with 1/N. Time and memory are linear in the splits but for a logarithm.
///
/// # Faces in the plane
/// If faces of the solid lie in the plane, the sections on both sides of it differ. The result is the limit
/// of the areas from one side:
/// - For a plane perpendicular to an axis it is the limit from above, just as a point between two cells lies
///   in the upper cell. In the universe's upper face it is the limit from below. If the plane belongs to the
///   lattice, the cells above it count. A box with faces in planes of the lattice therefore has an exact
///   area, also where it is cut in a face.
/// - For any other plane the interval contains the limits from both sides. A face in such a plane stays in
///   doubt. So does a face in a plane that is perpendicular to an axis but not in the lattice. All cells of
///   such a face are split as deep as the frame or the budget allows.
///
/// # Errors
/// [`Error::Argument`] if a number of `tolerance` is negative or NaN; the solid's own errors, as
/// [`build`](crate::build); [`Error::Cancelled`]; [`Error::OutOfMemory`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::{SectionPlane, section_area}};
/// let frame = Frame::new([-1.0; 3], 2.0, 20)?;
/// let ball = Csg::ball([0.1, 0.0, 0.0], 0.75)?;
/// // At a distance of 0.25 from the centre.
/// let plane = SectionPlane::new([0.35, 0.0, 0.0], [1.0, 0.0, 0.0])?;
/// let found = section_area(&ball, &frame, &plane, 1e-6, &Control::default())?;
/// assert!(found.area.contains(std::f64::consts::PI * 0.5) && found.area.width() <= 2e-6);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn section_area(
    solid: &dyn DynSolid,
    frame: &Frame,
    plane: &SectionPlane,
    tolerance: impl Into<Tolerance>,
    control: &Control<'_>,
) -> Result<SectionArea, Error> {
    let tolerance = tolerance.into();
    valid::tolerance("tolerance", tolerance.relative)?;
    valid::tolerance("tolerance", tolerance.absolute)?;
    let job = Job::new(control);
    job.check()?;
    let classifier = Proven(solid.on(frame, control)?);
    // The square of the universe's half edge is 2^BITS units.
    let unit =
        Interval::exactly(frame.edge()).square().times(Interval::exactly(0.25 / (1u128 << BITS) as f64));
    let mut search = Search {
        subject: Subject::new(&classifier, control)?,
        job: &job,
        told: 0,
        unit: unit.times(plane.steepness()),
        sums: [0; 2],
        open: Queue::new(),
    };
    let stop_reason = match Placed::new(plane, frame) {
        Some(placed) => search.run(&placed, tolerance, control.max_splits.unwrap_or(SECTION_SPLITS))?,
        None => StopReason::Tolerance,
    };
    job.advance(WHOLE - search.told);
    Ok(SectionArea {
        area: search.area(),
        proof: classifier.proof(),
        clipped: search.subject.is_clipped(),
        stop_reason,
        splits: search.subject.splits,
    })
}

/// Fraction bits of the square of a finest cell's half edge, and of the square of the universe's half edge.
const SHARE_BITS: u32 = 44;
const BITS: u32 = SHARE_BITS + 2 * MAX_DEPTH as u32;

/// Bits of a plane's largest step, and of a start so large that no steps in the universe lead back to zero.
const STEP_BITS: i64 = 80;
const FAR_BITS: i64 = STEP_BITS + MAX_DEPTH as i64 + 6;

/// A bound above the error of a plane's function anywhere in the universe: each step is off by less than 3,
/// the start by less than 64, and no coordinate is larger than 2^21.
const SLACK: i128 = 1 << 25;

/// A plane on the lattice. Coordinates t count halves of the finest cells of the deepest frame, from the
/// lower corner of the universe: points of the plane have start + steps · t = 0.
struct Placed {
    /// The axes; the axis that the normal is nearest to comes last.
    order: [usize; 3],
    /// The normal's components along the first two axes, divided by its component along the last.
    slopes: [f64; 2],
    start: i128,
    steps: [i128; 3],
    /// The layer of finest cells, along the plane's axis, that a plane perpendicular to that axis runs
    /// through.
    layer: Option<u32>,
    depth: u8,
}

impl Placed {
    /// Returns `None` if the plane is far from the universe, or perpendicular to an axis and outside of the
    /// universe. (Other planes outside of the universe simply meet no cell.)
    fn new(plane: &SectionPlane, frame: &Frame) -> Option<Placed> {
        let SectionPlane { point, normal } = *plane;
        let last = plane.axis();
        let order = [(last + 1) % 3, (last + 2) % 3, last];
        let slopes = [normal[order[0]] / normal[last], normal[order[1]] / normal[last]];
        let layer = if slopes == [0.0; 2] { Some(frame.cell_at(last, point[last])?) } else { None };
        let half = Dyadic::new(frame.edge()).shifted(-i64::from(MAX_DEPTH) - 1);
        let steps = normal.each(|c| &Dyadic::new(c) * &half);
        let start = (0..3).fold(Dyadic::zero(), |sum, axis| {
            let from = &Dyadic::new(frame.origin()[axis]) - &Dyadic::new(point[axis]);
            &sum + &(&Dyadic::new(normal[axis]) * &from)
        });
        let power = STEP_BITS - steps[last].magnitude()?;
        let start = start.shifted(power);
        if start.magnitude().is_some_and(|magnitude| magnitude >= FAR_BITS) {
            return None;
        }
        let steps = steps.each(|step| rounded(&step.shifted(power)));
        Some(Placed { order, slopes, start: rounded(&start), steps, layer, depth: frame.depth() })
    }

    /// Returns the plane in the cell's own coordinates; `None` if the plane does not run through the cell.
    fn within(&self, cell: Cell) -> Option<Section> {
        let half = 1i128 << (MAX_DEPTH - cell.level);
        let last = self.order[2];
        let mut value = self.start;
        for axis in 0..3 {
            value += self.steps[axis] * (2 * i128::from(cell.at[axis]) + 1) * half;
        }
        let meets = match self.layer {
            Some(layer) => cell.at[last] == layer >> (self.depth - cell.level),
            None => value.abs() <= self.steps.iter().map(|step| step.abs()).sum::<i128>() * half + SLACK,
        };
        // Both numbers are rounded. The contribution of SLACK is 2^-55 at the most.
        let offset = value as f64 / (self.steps[last] * half) as f64;
        meets.then(|| Section::new(self.order, self.slopes, offset))
    }
}

/// Rounds a number below 2^107: off by less than 16, or by less than 3 if the number is below 2^82.
fn rounded(number: &Dyadic) -> i128 {
    let high = number.rounded();
    let low = (number - &Dyadic::new(high)).rounded();
    high as i128 + low as i128
}

/// The amount in doubt, and the serial number.
type Key = (i128, Reverse<u64>);

/// A cell that can be split, and its part of the sums.
type Open<P> = (Cell, Verdict<P>, [i128; 2]);

struct Search<'a, C: Classifier> {
    subject: Subject<'a, C>,
    job: &'a Job<'a>,
    /// The progress reported so far.
    told: usize,
    /// One unit of the sums, in square model units.
    unit: Interval,
    /// The sums of lower and upper bounds of the projected area. As integers they are the same in any order.
    sums: [i128; 2],
    open: Queue<Key, Open<Part<C>>>,
}

impl<C: Classifier> Search<'_, C> {
    /// Splits cells, the cells with the widest interval first.
    fn run(&mut self, plane: &Placed, tolerance: Tolerance, budget: u64) -> Result<StopReason, Error> {
        let root = self.subject.worker.root()?;
        self.note(plane, Cell::ROOT, root)?;
        loop {
            let area = self.area();
            let wanted = tolerance.absolute.max(tolerance.relative * (0.5 * (area.lower + area.upper)));
            if area.width() <= wanted {
                return Ok(StopReason::Tolerance);
            }
            if self.open.peek().is_none() {
                return Ok(StopReason::Exhausted);
            }
            if self.subject.splits >= budget || !self.tidy()? {
                return Ok(StopReason::Budget);
            }
            self.report(budget)?;
            let Some((cell, verdict, known)) = self.open.pop() else { return Ok(StopReason::Exhausted) };
            self.sums = [0, 1].each(|side| self.sums[side] - known[side]);
            let Verdict::Partial(part) = verdict else { continue };
            for (octant, verdict) in (0..8).zip(self.subject.split(cell, &part)?) {
                self.note(plane, cell.child(octant), verdict)?;
            }
        }
    }

    /// Takes in the verdict of a cell.
    fn note(&mut self, plane: &Placed, cell: Cell, verdict: Verdict<Part<C>>) -> Result<(), Error> {
        if matches!(verdict, Verdict::Empty) {
            return Ok(());
        }
        let Some(section) = plane.within(cell) else { return Ok(()) };
        let all = Interval::between(0.0, section.whole().upper);
        let area = match &verdict {
            Verdict::Full => section.whole(),
            Verdict::Partial(part) => {
                let enclosure = self.subject.worker.enclosure(cell, part)?;
                enclosure.map_or(all, |enclosure| section.of(&enclosure))
            }
            Verdict::Empty | Verdict::Undecided => all,
        };
        const SHARE: f64 = (1u64 << SHARE_BITS) as f64;
        let shift = 2 * u32::from(MAX_DEPTH - cell.level);
        // The casts are of integers below 2^47.
        let known =
            [libm::floor(area.lower * SHARE), libm::ceil(area.upper * SHARE)].each(|x| (x as i128) << shift);
        self.sums = [0, 1].each(|side| self.sums[side] + known[side]);
        let is_open = cell.level < plane.depth && area.width() > SETTLED;
        if is_open && matches!(verdict, Verdict::Partial(_)) {
            self.open.push((known[1] - known[0], Reverse(self.open.met())), (cell, verdict, known))?;
        }
        Ok(())
    }

    /// The present bounds of the area.
    fn area(&self) -> Interval {
        let [lower, upper] = self.sums.each(|sum| Interval::of_integer(sum).times(self.unit));
        Interval::between(lower.lower, upper.upper)
    }

    /// Checks for a cancel and reports the spent share of the budget.
    fn report(&mut self, budget: u64) -> Result<(), Error> {
        let done = (self.subject.splits as f64 / budget as f64 * WHOLE as f64) as usize;
        if done >= self.told + WHOLE / 256 {
            self.job.advance(done - self.told);
            self.told = done;
        }
        self.job.check()
    }

    /// Frees the memory of parts that are not in use. Returns `false` if the parts in use take too much of
    /// the allowed bytes.
    fn tidy(&mut self) -> Result<bool, Error> {
        let subject = &mut self.subject;
        let is_full = subject.takes(4);
        if !is_full && !subject.is_wasteful() {
            return Ok(true);
        }
        self.open.change(|cells| {
            subject.keep(cells.iter_mut().map(|entry| &mut entry.item.1))?;
            // Half of the allowance must be free, or the next step would end here again.
            Ok(!(is_full && subject.takes(8)))
        })
    }
}
