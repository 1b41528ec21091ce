//! A host program's own shape, through its functions.

use super::{Fingerprint, Solid, Verdict};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame};
use crate::octree::Tag;
use alloc::boxed::Box;

/// Decides points, where the host can.
type Contains<'a> = Box<dyn Fn(&[[f64; 3]], &mut [bool]) -> Result<(), Error> + Send + Sync + 'a>;

/// Classifies many boxes at once.
type ClassifyMany<'a> =
    Box<dyn Fn(&[[[f64; 3]; 2]], &mut [Verdict<()>]) -> Result<(), Error> + Send + Sync + 'a>;

/// A shape that a host program classifies: how a B-rep kernel, a distance field, or a simulation takes part.
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
pub struct Callback<'a, F> {
    classify: F,
    classify_many: Option<ClassifyMany<'a>>,
    contains: Option<Contains<'a>>,
    exterior: Tag,
    fingerprint: Option<Fingerprint>,
}

impl<'a, F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Sync> Callback<'a, F> {
    /// A solid from a function that classifies the box `(min, max)` in model units. The box contains the
    /// cell (it is the cell itself on frames whose lattice planes are doubles), and FULL and EMPTY must be
    /// proven for all of it. The function is called from several threads at once, and must give the same
    /// answer to the same box. An error, such as [`Error::Callback`], ends the operation and is what that
    /// returns.
    pub fn new(classify: F) -> Callback<'a, F> {
        Callback { classify, classify_many: None, contains: None, exterior: Tag::Partial, fingerprint: None }
    }

    /// The same solid with a function that classifies several boxes (lower and upper corner each) at once, for hosts
    /// that do that faster than one by one; its answers must be those of the single form. It gets as many verdicts to
    /// set as there are boxes, all of them undecided.
    #[must_use]
    pub fn with_classify_many(
        mut self,
        classify: impl Fn(&[[[f64; 3]; 2]], &mut [Verdict<()>]) -> Result<(), Error> + Send + Sync + 'a,
    ) -> Callback<'a, F> {
        self.classify_many = Some(Box::new(classify));
        self
    }

    /// The same solid with a function that decides single points (model units): the sampled rule needs it.
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
    }

    /// As [`with_contains`](Self::with_contains), for several points at once. It gets as many answers to set as there
    /// are points.
    #[must_use]
    pub fn with_contains_many(
        mut self,
        contains: impl Fn(&[[f64; 3]], &mut [bool]) -> Result<(), Error> + Send + Sync + 'a,
    ) -> Callback<'a, F> {
        self.contains = Some(Box::new(contains));
        self
    }

    /// The same solid with a promise about the space around the universe: EMPTY if the shape ends inside.
    /// Without it the shape counts as clipped by the universe. BRANCH means PARTIAL.
    #[must_use]
    pub fn with_exterior(mut self, exterior: Tag) -> Callback<'a, F> {
        self.exterior = if exterior == Tag::Branch { Tag::Partial } else { exterior };
        self
    }

    /// The same solid with a fingerprint: the promise that every shape that is given this one is the same.
    #[must_use]
    pub fn with_fingerprint(mut self, fingerprint: Fingerprint) -> Callback<'a, F> {
        self.fingerprint = Some(fingerprint);
        self
    }

    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error> {
        let (min, max) = cube.bounds();
        (self.classify)(min, max)
    }
}

impl<F: Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Sync> Solid for Callback<'_, F> {
    type Part = ();
    type Scratch = ();

    fn root(&self, _: &mut (), frame: &Frame) -> Result<Verdict<()>, Error> {
        self.verdict(&Cube { frame, cell: Cell::ROOT })
    }

    fn split(&self, _: &mut (), cube: &Cube<'_>, _: &()) -> Result<[Verdict<()>; 8], Error> {
        let mut verdicts = [Verdict::Undecided; 8];
        if let Some(classify) = &self.classify_many {
            let boxes = [0, 1, 2, 3, 4, 5, 6, 7].map(|octant| <[_; 2]>::from(cube.child(octant).bounds()));
            classify(&boxes, &mut verdicts)?;
            return Ok(verdicts);
        }
        for (octant, verdict) in (0..8).zip(&mut verdicts) {
            *verdict = self.verdict(&cube.child(octant))?;
        }
        Ok(verdicts)
    }

    fn sample(&self, _: &mut (), cube: &Cube<'_>, _: &()) -> Result<Option<bool>, Error> {
        let Some(contains) = &self.contains else { return Ok(None) };
        let mut inside = [false];
        contains(&[centre(cube)], &mut inside)?;
        Ok(Some(inside[0]))
    }

    fn sample64(&self, _: &mut (), cube: &Cube<'_>, parts: &[(u8, ())]) -> Result<Option<u64>, Error> {
        let Some(contains) = &self.contains else { return Ok(None) };
        let (mut points, mut inside) = ([[0.0; 3]; 64], [false; 64]);
        let parts = parts.get(..64).unwrap_or(parts);
        for ((c, ()), point) in parts.iter().zip(&mut points) {
            *point = centre(&cube.child(c >> 3).child(c & 7));
        }
        let count = parts.len();
        contains(&points[..count], &mut inside[..count])?;
        let bits = parts.iter().zip(inside).map(|((c, ()), inside)| (inside as u64) << (c & 63));
        Ok(Some(bits.fold(0, |all, bit| all | bit)))
    }

    fn exterior(&self, _: &Frame) -> Tag {
        self.exterior
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.fingerprint
    }
}

/// The centre of a cell of the frame's depth.
fn centre(cube: &Cube<'_>) -> [f64; 3] {
    let frame = cube.frame;
    let size = frame.cell_size();
    let mut centre = frame.origin();
    for axis in 0..3 {
        centre[axis] += (cube.cell.at[axis] as f64 + 0.5) * size;
    }
    centre
}
