//! A host program's own shape, through two functions.

use super::{Fingerprint, Solid, Verdict};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame};
use crate::octree::Tag;
use alloc::boxed::Box;

/// Decides single points, where the host can.
type Contains<'a> = Box<dyn Fn([f64; 3]) -> Result<bool, Error> + Send + Sync + 'a>;

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
        Callback { classify, contains: None, exterior: Tag::Partial, fingerprint: None }
    }

    /// The same solid with a function that decides single points (model units): the sampled rule needs it.
    #[must_use]
    pub fn with_contains(
        mut self,
        contains: impl Fn([f64; 3]) -> Result<bool, Error> + Send + Sync + 'a,
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
        for (octant, verdict) in (0..8).zip(&mut verdicts) {
            *verdict = self.verdict(&cube.child(octant))?;
        }
        Ok(verdicts)
    }

    fn sample(&self, _: &mut (), cube: &Cube<'_>, _: &()) -> Result<Option<bool>, Error> {
        let frame = cube.frame;
        let size = frame.cell_size();
        let mut centre = frame.origin();
        for axis in 0..3 {
            centre[axis] += (cube.cell.at[axis] as f64 + 0.5) * size;
        }
        self.contains.as_ref().map(|contains| contains(centre)).transpose()
    }

    fn exterior(&self, _: &Frame) -> Tag {
        self.exterior
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.fingerprint
    }
}
