//! A host program's own shape, classified by its functions.

mod gradient;
mod placement;
mod tangent;

pub use gradient::GradientRange;
pub use tangent::TangentBalls;

use super::{
    Batch, Classifier, Enclosure, Fingerprint, Fingerprinter, FreeParts, OCTANTS, Question, Solid, Verdict,
    WholeQuestion, Worker,
};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::lattice::{Affine, Bounds, Cell, Cube, Frame, Interval};
use crate::memory;
use crate::octree::{Proof, Tag};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use placement::{Corners, Placement};

/// Decides points, if the host can.
type Contains<'a> = Box<dyn Fn(&[[f64; 3]], &mut [bool]) -> Result<(), Error> + Send + Sync + 'a>;

/// Classifies many boxes at once.
type ClassifyMany<'a> = Box<dyn Fn(&[Corners], &mut [Verdict<()>]) -> Result<(), Error> + Send + Sync + 'a>;

/// Bounds the distances of points from the surface.
type Distance<'a> = Box<dyn Fn(&[[f64; 3]], &mut [f64]) -> Result<(), Error> + Send + Sync + 'a>;

/// Returns more data about a box, given by its corners and its middle.
type Local<'a, T> = Box<dyn Fn([f64; 3], [f64; 3], [f64; 3]) -> Result<Option<T>, Error> + Send + Sync + 'a>;

/// A shape that a host program classifies, for example by a B-rep kernel, a distance field, or a simulation.
///
/// ```
/// use leafless::{Callback, Control, Frame, Rule, Verdict, build};
/// // A slab 0.25 ≤ z ≤ 0.5, known only through boxes.
/// let slab = Callback::new(|min, max| {
///     Ok(match (min[2], max[2]) {
///         (low, high) if high <= 0.25 || low >= 0.5 => Verdict::Empty,
///         (low, high) if low >= 0.25 && high <= 0.5 => Verdict::Full,
///         _ => Verdict::Partial(()),
///     })
/// });
/// let tree = build(&slab, &Frame::new([0.0; 3], 1.0, 6)?, Rule::Certified, &Control::default())?;
/// assert_eq!(tree.statistics().volume(), leafless::Interval::exactly(0.25));
/// # Ok::<(), leafless::Error>(())
/// ```
///
/// # Panics
/// The methods that add to a callback panic once it has been put on a frame or moved.
pub struct Callback<'a, F> {
    functions: Arc<Functions<'a, F>>,
    /// The placement of a moved shape.
    placement: Option<Placement>,
}

struct Functions<'a, F> {
    classify: F,
    classify_many: Option<ClassifyMany<'a>>,
    contains: Option<Contains<'a>>,
    /// Whether `contains` decides one point at a time.
    contains_one: bool,
    distance: Option<Distance<'a>>,
    gradient: Option<Local<'a, GradientRange>>,
    tangent: Option<Local<'a, TangentBalls>>,
    exterior: Tag,
    bounds: Option<Bounds>,
    fingerprint: Option<Fingerprint>,
}

/// The panic message for changes to a callback that is already shared.
const SHARED: &str = "functions can be added to a callback only before it is put on a frame or moved";

impl<'a, F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync> Callback<'a, F> {
    /// Makes a solid from a function that classifies the box `(min, max)` in model units. The box contains
    /// the cell. (It is the cell itself on frames whose lattice planes are doubles.) FULL and EMPTY must be
    /// proven for the whole box. The function is called from several threads at once. It must give the same
    /// answer for the same box, and boxes within a FULL or EMPTY box must be FULL or EMPTY, too. An error of
    /// the function, such as [`Error::Callback`], ends the operation, which returns that error.
    pub fn new(classify: F) -> Callback<'a, F> {
        let functions = Arc::new(Functions {
            classify,
            classify_many: None,
            contains: None,
            contains_one: false,
            distance: None,
            gradient: None,
            tangent: None,
            exterior: Tag::Partial,
            bounds: None,
            fingerprint: None,
        });
        Callback { functions, placement: None }
    }

    fn with(mut self, set: impl FnOnce(&mut Functions<'a, F>)) -> Callback<'a, F> {
        assert!(self.placement.is_none(), "{SHARED}");
        set(Arc::get_mut(&mut self.functions).expect(SHARED));
        self
    }

    /// Adds a function that classifies several boxes (lower and upper corner each) at once, for hosts that do
    /// that faster than one by one. Its answers must be those of the single form. The function gets as many
    /// verdicts to set as there are boxes, all of them undecided.
    #[must_use]
    pub fn with_classify_many(
        self,
        classify: impl Fn(&[Corners], &mut [Verdict<()>]) -> Result<(), Error> + Send + Sync + 'a,
    ) -> Callback<'a, F> {
        self.with(|functions| functions.classify_many = Some(Box::new(classify)))
    }

    /// Adds a function that decides single points (model units). The sampled rule needs it.
    #[must_use]
    pub fn with_contains(
        self,
        contains: impl Fn([f64; 3]) -> Result<bool, Error> + Send + Sync + 'a,
    ) -> Callback<'a, F> {
        self.with_contains_many(move |points, inside| {
            for (point, inside) in points.iter().zip(inside) {
                *inside = contains(*point)?;
            }
            Ok(())
        })
        .with(|functions| functions.contains_one = true)
    }

    /// As [`with_contains`](Self::with_contains), for several points at once. The function gets as many
    /// answers to set as there are points.
    #[must_use]
    pub fn with_contains_many(
        self,
        contains: impl Fn(&[[f64; 3]], &mut [bool]) -> Result<(), Error> + Send + Sync + 'a,
    ) -> Callback<'a, F> {
        self.with(|functions| {
            functions.contains = Some(Box::new(contains));
            functions.contains_one = false;
        })
    }

    /// Adds a function that bounds distances. For each point (model units) it sets a number whose magnitude
    /// is at most the point's distance from the surface. The number is negative where the point lies inside,
    /// and positive where it lies outside. 0 or NaN means unknown. This function is called first: a cell
    /// whose middle is further from the surface than from its corners is decided, and its box is not
    /// classified.
    #[must_use]
    pub fn with_distance(
        self,
        distance: impl Fn(&[[f64; 3]], &mut [f64]) -> Result<(), Error> + Send + Sync + 'a,
    ) -> Callback<'a, F> {
        self.with(|functions| functions.distance = Some(Box::new(distance)))
    }

    /// Adds a function that bounds the host's own f over boxes, where the solid is f ≤ 0. It gets the box
    /// `(min, max)`, as the classifying function does, and a point next to the box's middle. `None` means
    /// that nothing is known about the box.
    ///
    /// The function is called for undecided cells when an algorithm uses their
    /// [enclosures](Question::Enclosure): [`measure`](crate::measure), [`bounding_box`](crate::bounding_box)
    /// and [`Adaptive`](crate::solid::Adaptive) need far fewer splits with it. No verdict depends on it.
    ///
    /// ```
    /// use leafless::{Callback, Control, Frame, Interval, Verdict, measure, solid::GradientRange};
    /// // A paraboloid, z ≥ x² + y², by f = x² + y² − z: its values over a box, and its gradient.
    /// let square = |low: f64, high: f64| Interval::new(if low * high < 0.0 { 0.0 } else { (low * low).min(high * high) }, (low * low).max(high * high)).unwrap();
    /// let bowl = Callback::new(move |min, max| {
    ///     let (x, y) = (square(min[0], max[0]), square(min[1], max[1]));
    ///     // The margin exceeds the rounding errors.
    ///     Ok(match (x.lower + y.lower - max[2] - 1e-14, x.upper + y.upper - min[2] + 1e-14) {
    ///         (least, _) if least >= 0.0 => Verdict::Empty,
    ///         (_, most) if most <= 0.0 => Verdict::Full,
    ///         _ => Verdict::Partial(()),
    ///     })
    /// })
    /// .with_gradient(|min, max, [x, y, z]| {
    ///     let value = x * x + y * y - z;
    ///     let slope = |axis: usize| Interval::new(2.0 * min[axis], 2.0 * max[axis]).unwrap();
    ///     Ok(Some(GradientRange {
    ///         value: Interval::new(value - 1e-14, value + 1e-14).unwrap(),
    ///         gradient: [slope(0), slope(1), Interval::exactly(-1.0)],
    ///     }))
    /// });
    /// let found = measure(&bowl, &Frame::new([-1.0; 3], 2.0, 16)?, 1e-3, &Control::default())?;
    /// assert!(found.volume.contains(0.5 * std::f64::consts::PI) && found.volume.width() < 2e-3);
    /// assert!(found.splits < 40_000);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    #[must_use]
    pub fn with_gradient(
        self,
        gradient: impl Fn([f64; 3], [f64; 3], [f64; 3]) -> Result<Option<GradientRange>, Error> + Send + Sync + 'a,
    ) -> Callback<'a, F> {
        self.with(|functions| functions.gradient = Some(Box::new(gradient)))
    }

    /// Adds a function that returns the position and the curvature of the surface next to the middle of a
    /// box. It gets the same arguments as the function of [`with_gradient`](Self::with_gradient), and is
    /// called for the same purposes. If there are both functions, this one is called where the other one
    /// proves nothing.
    #[must_use]
    pub fn with_tangent(
        self,
        tangent: impl Fn([f64; 3], [f64; 3], [f64; 3]) -> Result<Option<TangentBalls>, Error> + Send + Sync + 'a,
    ) -> Callback<'a, F> {
        self.with(|functions| functions.tangent = Some(Box::new(tangent)))
    }

    /// Adds a promise about the space around the universe: EMPTY if the shape ends inside. Without the
    /// promise the shape counts as clipped by the universe. BRANCH means PARTIAL. The promise does not apply
    /// to the shape under an affine map, because its universe is another one. The box of
    /// [`with_bounds`](Self::with_bounds) moves with the shape.
    #[must_use]
    pub fn with_exterior(self, exterior: Tag) -> Callback<'a, F> {
        self.with(|functions| {
            functions.exterior = if exterior == Tag::Branch { Tag::Partial } else { exterior };
        })
    }

    /// Adds a promise that the shape lies in a box. On frames whose universe contains the box the shape then
    /// ends inside, whatever else was promised about the space around.
    #[must_use]
    pub fn with_bounds(self, bounds: Bounds) -> Callback<'a, F> {
        self.with(|functions| functions.bounds = Some(bounds))
    }

    /// Adds a fingerprint: the promise that all shapes with this fingerprint are the same.
    #[must_use]
    pub fn with_fingerprint(self, fingerprint: Fingerprint) -> Callback<'a, F> {
        self.with(|functions| functions.fingerprint = Some(fingerprint))
    }
}

impl<'a, F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync> Solid for Callback<'a, F> {
    type Classifier = CallbackOnFrame<'a, F>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<CallbackOnFrame<'a, F>, Error> {
        Ok(CallbackOnFrame { functions: self.functions.clone(), placement: self.placement, frame: *frame })
    }

    fn bounds(&self) -> Option<Bounds> {
        match &self.placement {
            Some(placement) => placement.bounds,
            None => self.functions.bounds,
        }
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let own = self.functions.fingerprint?;
        let Some(placement) = &self.placement else { return Some(own) };
        let all = Fingerprinter::new("placed callback").part(own);
        Some(placement.back.numbers().fold(all, |all, number| all.numbers(&[number])).finish())
    }

    /// A cell is classified by the box around its inverse image, with as many calls as before. A surface that
    /// is not parallel to the lattice blurs by about a cell. Nothing blurs where the placement permutes axes,
    /// with signs and powers of two as scales and an offset, as far as coordinates are not rounded. The
    /// centres of cells are moved back and rounded, and the host decides them. Other points are decided only
    /// where nothing is rounded.
    fn placed(&self, placement: &Affine) -> Result<Option<Self>, Error> {
        let placement = match &self.placement {
            Some(before) => before.then(placement),
            None => Placement::new(placement, self.functions.bounds),
        };
        Ok(Some(Callback { functions: self.functions.clone(), placement: Some(placement) }))
    }
}

/// A host's shape on a frame: both handle and worker.
pub struct CallbackOnFrame<'a, F> {
    functions: Arc<Functions<'a, F>>,
    placement: Option<Placement>,
    frame: Frame,
}

impl<F> Clone for CallbackOnFrame<'_, F> {
    fn clone(&self) -> Self {
        CallbackOnFrame { functions: self.functions.clone(), placement: self.placement, frame: self.frame }
    }
}

impl<'a, F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync> Classifier
    for CallbackOnFrame<'a, F>
{
    type Worker = CallbackOnFrame<'a, F>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<CallbackOnFrame<'a, F>, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        let (bounds, promised) = match &self.placement {
            Some(placement) => (placement.bounds, Tag::Partial),
            None => (self.functions.bounds, self.functions.exterior),
        };
        if bounds.is_some_and(|bounds| bounds.is_within(&self.frame)) { Tag::Empty } else { promised }
    }

    /// The host promises that FULL and EMPTY are proven.
    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl<F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync> CallbackOnFrame<'_, F> {
    /// The box in the host's own space that represents a cell.
    fn corners(&self, cell: Cell) -> Corners {
        let (min, max) = Cube { frame: &self.frame, cell }.bounds();
        match &self.placement {
            Some(placement) => placement.corners(min, max),
            None => [min, max],
        }
    }

    /// The rounded centre of a cell of the frame's depth, in the host's own space.
    fn centre(&self, cell: Cell) -> [f64; 3] {
        let centre = centre(&self.frame, cell);
        match &self.placement {
            Some(placement) => {
                placement.back.image(&centre.each(Interval::exactly)).each(|c| 0.5 * c.lower + 0.5 * c.upper)
            }
            None => centre,
        }
    }

    /// Lets the host decide points of its own space, if it can.
    fn host_contains(&self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        let Some(contains) = self.functions.contains.as_ref().filter(|_| !points.is_empty()) else {
            return Ok(());
        };
        let mut inside = memory::filled(points.len(), false)?;
        contains(points, &mut inside)?;
        answers.iter_mut().zip(inside).for_each(|(answer, inside)| *answer = Some(inside));
        Ok(())
    }

    /// Classifies cells: the distances decide first, and the host's boxes decide the rest. An error comes
    /// with the number of cells, counted from the first, whose verdicts are known.
    fn classify(
        &self,
        cells: &[Cell],
        control: &Control<'_>,
        verdicts: &mut [Verdict<()>],
    ) -> Result<(), (usize, Error)> {
        // The host is never called with an empty list.
        if cells.is_empty() {
            return Ok(());
        }
        verdicts.fill(Verdict::Partial(()));
        let open = self.by_distance(cells, verdicts).map_err(|error| (0, error))?;
        let boxed = |i: usize| self.corners(cells[i]);
        let Some(classify_many) = &self.functions.classify_many else {
            for i in open {
                // A cancellation waits for one call at most.
                control.check().map_err(|error| (i, error))?;
                let [min, max] = boxed(i);
                verdicts[i] = (self.functions.classify)(min, max).map_err(|error| (i, error))?;
            }
            return Ok(());
        };
        if open.is_empty() {
            return Ok(());
        }
        let (mut boxes, mut answers) = (Vec::new(), Vec::new());
        boxes.try_reserve_exact(open.len()).map_err(|_| (0, Error::OutOfMemory))?;
        answers.try_reserve_exact(open.len()).map_err(|_| (0, Error::OutOfMemory))?;
        boxes.extend(open.iter().map(|&i| boxed(i)));
        answers.resize(open.len(), Verdict::Undecided);
        control.check().and_then(|()| classify_many(&boxes, &mut answers)).map_err(|error| (0, error))?;
        open.into_iter().zip(answers).for_each(|(i, answer)| verdicts[i] = answer);
        Ok(())
    }

    /// The enclosure of a cell, from the host's f, or from its surface next to the middle.
    fn slabs(&self, cell: Cell) -> Result<Option<Enclosure>, Error> {
        let Functions { gradient, tangent, .. } = &*self.functions;
        let cube = Cube { frame: &self.frame, cell };
        let [min, max] = self.corners(cell);
        let middle = middle(min, max);
        if let Some(gradient) = gradient
            && let Some(range) = gradient(min, max, middle)?
        {
            let known = match &self.placement {
                Some(placement) => placement.enclosure(&range, middle, &cube),
                None => range.enclosure(&cube, middle),
            };
            if known.is_some() {
                return Ok(known);
            }
        }
        let Some(tangent) = tangent else { return Ok(None) };
        let Some(balls) = tangent(min, max, middle)? else { return Ok(None) };
        let slab = match &self.placement {
            Some(placement) => {
                let centre = placement.centre(&cube);
                let reach =
                    |axis: usize| (max[axis] - centre[axis].lower).max(centre[axis].upper - min[axis]);
                let half = reach(0).max(reach(1)).max(reach(2)).next_up();
                let to_centre = axes(|axis| centre[axis].minus(Interval::exactly(balls.point[axis])));
                balls.slab(half, to_centre).and_then(|slab| placement.slab(&slab, half, &cube))
            }
            None => balls.slab(cube.half_edge(), cube.centre_from(balls.point)),
        };
        Ok(slab.and_then(|slab| Enclosure::of_one(slab, f64::INFINITY)))
    }

    /// Decides cells by the distances of their middles; returns the cells that are left open.
    fn by_distance(&self, cells: &[Cell], verdicts: &mut [Verdict<()>]) -> Result<Vec<usize>, Error> {
        let mut open = memory::with_capacity(cells.len())?;
        let Some(distance) = &self.functions.distance else {
            open.extend(0..cells.len());
            return Ok(open);
        };
        let (mut points, mut found) = (Vec::new(), Vec::new());
        points.try_reserve_exact(cells.len())?;
        found.try_reserve_exact(cells.len())?;
        points.extend(cells.iter().map(|&cell| {
            let [min, max] = self.corners(cell);
            middle(min, max)
        }));
        found.resize(cells.len(), f64::NAN);
        distance(&points, &mut found)?;
        for (i, (&cell, found)) in cells.iter().zip(found).enumerate() {
            let [min, max] = self.corners(cell);
            // The distance of the corner that is farthest from the middle. Each step is rounded up by far
            // less than a part in 2^48.
            let reach = |axis: usize| (max[axis] - points[i][axis]).max(points[i][axis] - min[axis]);
            let square = (0..3).map(|axis| reach(axis) * reach(axis)).sum::<f64>();
            let radius = sqrt(square) * (1.0 + 16.0 * f64::EPSILON) + f64::MIN_POSITIVE;
            if found >= radius {
                verdicts[i] = Verdict::Empty;
            } else if found <= -radius {
                verdicts[i] = Verdict::Full;
            } else {
                open.push(i);
            }
        }
        Ok(open)
    }
}

impl<F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync> FreeParts
    for CallbackOnFrame<'_, F>
{
    type Part = ();
}

impl<F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync> Batch for CallbackOnFrame<'_, F> {
    fn likes_many(&self) -> bool {
        true
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, ())],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<()>; 8]>,
    ) -> Result<(), Error> {
        let mut children = memory::with_capacity(8 * cells.len())?;
        children.extend(cells.iter().flat_map(|(cell, ())| OCTANTS.each(|octant| cell.child(octant))));
        let first = verdicts.len();
        verdicts.try_reserve(cells.len())?;
        verdicts.resize(first + cells.len(), [Verdict::Undecided; 8]);
        let done = self.classify(&children, control, verdicts[first..].as_flattened_mut());
        done.map_err(|(known, error)| {
            verdicts.truncate(first + known / 8);
            error
        })
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, ())],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        control.check()?;
        let points = memory::collected(cells.iter().map(|(cell, ())| self.centre(*cell)))?;
        let first = inside.len();
        inside.try_reserve(cells.len())?;
        inside.resize(first + cells.len(), None);
        // A function that decides one point at a time can be cancelled between points.
        let piece = if self.functions.contains_one { 1 } else { cells.len().max(1) };
        for (k, points) in points.chunks(piece).enumerate() {
            let start = first + k * piece;
            let done = control
                .check()
                .and_then(|()| self.host_contains(points, &mut inside[start..start + points.len()]));
            if done.is_err() {
                inside.truncate(start);
                return done;
            }
        }
        Ok(())
    }

    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        let Some(placement) = &self.placement else { return self.host_contains(points, answers) };
        if self.functions.contains.is_none() {
            return Ok(());
        }
        // The host decides the points that move without rounding. The places of the others are not known
        // exactly enough.
        let (mut exact, mut places) = (Vec::new(), Vec::new());
        for (place, &point) in points.iter().enumerate() {
            if let Some(image) = placement.back.exact_image(point) {
                memory::push(&mut exact, image)?;
                memory::push(&mut places, place)?;
            }
        }
        let mut found = memory::filled(exact.len(), None)?;
        self.host_contains(&exact, &mut found)?;
        places.into_iter().zip(found).for_each(|(place, found)| answers[place] = found);
        Ok(())
    }

    fn recall(&mut self, _: Cell) -> Option<()> {
        Some(())
    }
}

impl<F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync> Worker
    for CallbackOnFrame<'_, F>
{
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        let mut verdict = [Verdict::Undecided];
        self.classify(&[Cell::ROOT], &Control::default(), &mut verdict).map_err(|(_, error)| error)?;
        Ok(verdict[0])
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        let mut verdicts = [Verdict::Undecided; 8];
        let children = OCTANTS.each(|octant| cell.child(octant));
        self.classify(&children, &Control::default(), &mut verdicts).map_err(|(_, error)| error)?;
        Ok(verdicts)
    }

    fn answer(&mut self, cell: Cell, _: &(), question: Question<'_>) -> Result<(), Error> {
        match question {
            Question::Centre(inside) => {
                let mut answer = [None];
                self.host_contains(&[self.centre(cell)], &mut answer)?;
                *inside = answer[0];
            }
            Question::Enclosure(known) => *known = self.slabs(cell)?,
            _ => {}
        }
        Ok(())
    }

    fn sample64(&mut self, cell: Cell, parts: &[(u8, ())]) -> Result<Option<u64>, Error> {
        let Some(contains) = &self.functions.contains else { return Ok(None) };
        if parts.is_empty() {
            return Ok(Some(0));
        }
        let (mut points, mut inside) = ([[0.0; 3]; 64], [false; 64]);
        let parts = parts.get(..64).unwrap_or(parts);
        for ((c, ()), point) in parts.iter().zip(&mut points) {
            *point = self.centre(cell.child(c >> 3).child(c & 7));
        }
        let count = parts.len();
        contains(&points[..count], &mut inside[..count])?;
        let bits = parts.iter().zip(inside).map(|((c, ()), inside)| (inside as u64) << (c & 63));
        Ok(Some(bits.fold(0, |all, bit| all | bit)))
    }
}

/// A point of a box, next to its middle.
fn middle(min: [f64; 3], max: [f64; 3]) -> [f64; 3] {
    axes(|axis| min[axis] + 0.5 * (max[axis] - min[axis]))
}

/// The centre of a cell of the frame's depth.
fn centre(frame: &Frame, cell: Cell) -> [f64; 3] {
    let size = frame.cell_size();
    let mut centre = frame.origin();
    for axis in 0..3 {
        centre[axis] += (cell.at[axis] as f64 + 0.5) * size;
    }
    centre
}
