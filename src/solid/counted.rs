//! A solid that counts what it is asked.

use super::{Fingerprint, Scratch, Solid, Verdict};
use crate::error::Error;
use crate::lattice::{Cube, Frame, MAX_DEPTH};
use crate::octree::Tag;
use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A solid that counts its splits, level by level, and the half-spaces that were evaluated for them. It answers as the
/// solid that it wraps; bulk production is turned off, so that every split is counted.
///
/// ```
/// use leafless::{Control, Counted, Csg, Frame, Rule, build};
/// // The sphere of a published table: 65 cells of levels 0 to 2 are split.
/// let sphere = Counted::new(Csg::ball([64.0; 3], 64.0)?);
/// build(&sphere, &Frame::new([0.0; 3], 128.0, 3)?, Rule::Certified, &Control::default())?;
/// assert_eq!(sphere.splits()[..3].iter().sum::<u64>(), 65);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug)]
pub struct Counted<S> {
    solid: S,
    splits: [AtomicU64; MAX_DEPTH as usize],
    evaluations: AtomicU64,
}

impl<S: Solid> Counted<S> {
    /// Counts from zero.
    pub fn new(solid: S) -> Counted<S> {
        Counted { solid, splits: Default::default(), evaluations: AtomicU64::new(0) }
    }

    /// How many cells of each level were split so far.
    pub fn splits(&self) -> [u64; MAX_DEPTH as usize] {
        self.splits.each_ref().map(|count| count.load(Relaxed))
    }

    /// How many half-spaces were evaluated so far, each at a point or over a box.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.load(Relaxed)
    }

    /// Adds what `work` evaluates.
    fn count<T>(&self, scratch: &mut S::Scratch, work: impl FnOnce(&mut S::Scratch) -> T) -> T {
        let before = scratch.evaluations();
        let result = work(scratch);
        // (Less than before, if it is another solid's memory that this one replaced.)
        self.evaluations.fetch_add(scratch.evaluations().saturating_sub(before), Relaxed);
        result
    }
}

impl<S: Solid> Solid for Counted<S> {
    type Part = S::Part;
    type Scratch = S::Scratch;

    fn root(&self, scratch: &mut S::Scratch, frame: &Frame) -> Result<Verdict<S::Part>, Error> {
        self.count(scratch, |scratch| self.solid.root(scratch, frame))
    }

    fn split(
        &self,
        scratch: &mut S::Scratch,
        cube: &Cube<'_>,
        part: &S::Part,
    ) -> Result<[Verdict<S::Part>; 8], Error> {
        if let Some(count) = self.splits.get(cube.cell.level as usize) {
            count.fetch_add(1, Relaxed);
        }
        self.count(scratch, |scratch| self.solid.split(scratch, cube, part))
    }

    fn sample(
        &self,
        scratch: &mut S::Scratch,
        cube: &Cube<'_>,
        part: &S::Part,
    ) -> Result<Option<bool>, Error> {
        self.count(scratch, |scratch| self.solid.sample(scratch, cube, part))
    }

    fn sample64(
        &self,
        scratch: &mut S::Scratch,
        cube: &Cube<'_>,
        parts: &[(u8, S::Part)],
    ) -> Result<Option<u64>, Error> {
        self.count(scratch, |scratch| self.solid.sample64(scratch, cube, parts))
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        self.solid.exterior(frame)
    }

    fn nesting(&self) -> u32 {
        self.solid.nesting()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.solid.fingerprint()
    }

    fn hand_over(&self, from: &S::Scratch, part: &S::Part, to: &mut S::Scratch) -> Result<S::Part, Error> {
        self.solid.hand_over(from, part, to)
    }
}
