//! The position of a region of any shape relative to a solid.

use super::Region;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::octree::Tag;
use crate::solid::{Classifier, DynSolid, Verdict, Worker};
use crate::walk::Proven;
use crate::walk::split_one;

/// Returns the position of a region relative to a solid, as far as the cells of `frame` determine it. The
/// region is a ball ([`Csg::ball`](crate::Csg::ball)) or any other solid. [`Region::Inside`] means that all
/// of the region lies in the solid. [`Region::Outside`] means that the interiors are disjoint; this includes
/// a region that is proven to be empty. [`Region::Crossing`] means that a part of the region lies in the
/// solid and another part does not. Where region and solid continue outside of the universe, their exteriors
/// are compared.
///
/// The search ends as soon as the answer is known, or once `control.max_splits` cells of both are split.
/// Cells outside of the region are never split. The time is therefore about that of building the intersection
/// of both, near the region's boundary and near the solid's. It uses one thread.
///
/// # Errors
/// The own errors of the solid and of the region; [`Error::OutOfMemory`] and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::{Region, classify_in}};
/// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 8)?, Control::default());
/// let block = Csg::cuboid([-1.0; 3], [1.0; 3])?;
/// let ask = |centre: [f64; 3]| classify_in(&block, &Csg::ball(centre, 0.5)?, &frame, &control);
/// assert_eq!(ask([0.0, 0.4, 0.0])?, Region::Inside);
/// assert_eq!(ask([0.0, 0.6, 0.0])?, Region::Crossing);
/// assert_eq!(ask([0.0, 1.4, 1.4])?, Region::Outside);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn classify_in(
    solid: &dyn DynSolid,
    region: &dyn DynSolid,
    frame: &Frame,
    control: &Control<'_>,
) -> Result<Region, Error> {
    let job = Job::new(control);
    job.check()?;
    let (solid, region) = (Proven(solid.on(frame, control)?), Proven(region.on(frame, control)?));
    let exteriors = [solid.exterior(), region.exterior()];
    let mut survey = Survey {
        solid: solid.worker()?,
        region: region.worker()?,
        known: Known::default(),
        depth: frame.depth(),
        left: control.max_splits.unwrap_or(u64::MAX),
        job: &job,
    };
    survey.known.note(exteriors[0], exteriors[1]);
    let roots = (survey.solid.root()?, survey.region.root()?);
    survey.cell(Cell::ROOT, roots.0, roots.1)?;
    Ok(survey.known.answer())
}

/// The parts of the region met so far, in the solid and outside.
#[derive(Default)]
struct Known {
    inside: Met,
    outside: Met,
}

#[derive(Default)]
struct Met {
    surely: bool,
    perhaps: bool,
}

impl Known {
    /// Takes in a cell.
    fn note(&mut self, solid: Tag, region: Tag) {
        if region == Tag::Empty {
            return;
        }
        for (met, tag) in [(&mut self.inside, Tag::Full), (&mut self.outside, Tag::Empty)] {
            met.surely |= solid == tag && region == Tag::Full;
            met.perhaps |= solid == tag || solid == Tag::Partial;
        }
    }

    /// True if a cell with this verdict of the solid cannot add to the answer.
    fn has(&self, solid: Tag) -> bool {
        self.is_crossing()
            || solid == Tag::Full && self.inside.surely
            || solid == Tag::Empty && self.outside.surely
    }

    fn is_crossing(&self) -> bool {
        self.inside.surely && self.outside.surely
    }

    fn answer(&self) -> Region {
        match (self.inside.perhaps, self.outside.perhaps) {
            _ if self.is_crossing() => Region::Crossing,
            (false, _) => Region::Outside,
            (true, false) => Region::Inside,
            (true, true) => Region::Undecided,
        }
    }
}

struct Survey<'a, S, R> {
    solid: S,
    region: R,
    known: Known,
    depth: u8,
    left: u64,
    job: &'a Job<'a>,
}

impl<S: Worker, R: Worker> Survey<'_, S, R> {
    /// Takes in a cell. The recursion is as deep as the frame, 20 levels at the most.
    fn cell(&mut self, cell: Cell, solid: Verdict<S::Part>, region: Verdict<R::Part>) -> Result<(), Error> {
        let (tag, of_region) = (solid.tag(), region.tag());
        if of_region == Tag::Empty || self.known.has(tag) {
            return Ok(());
        }
        let can_split = cell.level < self.depth
            && match (&solid, &region) {
                // Where one of the two cannot be split, splitting the other may still decide.
                (Verdict::Partial(_), _) => true,
                (_, Verdict::Partial(_)) => tag != Tag::Partial,
                _ => false,
            };
        if !can_split || self.left == 0 {
            self.known.note(tag, of_region);
            return Ok(());
        }
        self.job.check()?;
        let marks = (self.solid.mark(), self.region.mark());
        let control = self.job.control();
        let of_solid =
            self.children(&solid, |survey, part| split_one(&mut survey.solid, cell, part, control))?;
        let of_region =
            self.children(&region, |survey, part| split_one(&mut survey.region, cell, part, control))?;
        for (octant, (solid, region)) in (0..8).zip(of_solid.into_iter().zip(of_region)) {
            self.cell(cell.child(octant), solid, region)?;
        }
        self.solid.release(marks.0);
        self.region.release(marks.1);
        Ok(())
    }

    /// Returns the verdicts of a cell's children: the cell's own verdict for each, if the cell cannot be
    /// split.
    fn children<P>(
        &mut self,
        verdict: &Verdict<P>,
        split: impl FnOnce(&mut Self, &P) -> Result<[Verdict<P>; 8], Error>,
    ) -> Result<[Verdict<P>; 8], Error> {
        Ok(match verdict {
            Verdict::Empty => [const { Verdict::Empty }; 8],
            Verdict::Full => [const { Verdict::Full }; 8],
            Verdict::Undecided => [const { Verdict::Undecided }; 8],
            Verdict::Partial(part) => {
                self.left = self.left.saturating_sub(1);
                return split(self, part);
            }
        })
    }
}
