//! The distance of points from the cells of a stored octree.

use super::DistanceTo;
use super::place::{NOWHERE, Place, Square};
use super::walk::{Visitor, walk};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Interval, morton};
use crate::memory;
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Planes, Tag};

/// The squares of the least distances.
struct Least {
    /// Whether the target is the complement.
    hollow: bool,
    /// From cells that are not proven outside of the target.
    outer: Square,
    /// From cells that are proven inside.
    inner: Square,
}

impl Least {
    fn tag(&self, tag: Tag) -> Tag {
        if self.hollow { tag.complement() } else { tag }
    }
}

/// Returns the cells of a set that have no other cell of the set in front of them, as seen from the point.
/// The nearest cell is one of them.
fn exposed(cells: u64, sides: [Option<bool>; 3]) -> u64 {
    (0..3).fold(cells, |exposed, axis| match sides[axis] {
        Some(above) => exposed & !morton::shifted(cells, axis, !above),
        None => exposed,
    })
}

impl Visitor for Least {
    fn chosen(&self, planes: Planes, real: u64, sides: [Option<bool>; 3]) -> Option<u64> {
        let planes = planes.complement_if(self.hollow);
        let (full, partial) = (planes.full() & real, planes.partial() & real);
        Some(exposed(full | partial, sides) | exposed(full, sides))
    }

    fn wants(&self, square: Square, _: Cell, tag: Tag) -> bool {
        match self.tag(tag) {
            Tag::Empty => false,
            Tag::Partial => square < self.outer,
            Tag::Full | Tag::Branch => square < self.inner,
        }
    }

    fn meet(&mut self, square: Square, _: Cell, tag: Tag) -> Result<(), Error> {
        self.outer = self.outer.min(square);
        if self.tag(tag) == Tag::Full {
            self.inner = square;
        }
        Ok(())
    }
}

/// Returns the squares of the distances from cells that are not proven outside, and from cells that are
/// proven inside.
pub(super) fn least(tree: &OctreeRef<'_>, place: &Place<'_>, hollow: bool) -> Result<[Square; 2], Error> {
    let mut least = Least { hollow, outer: NOWHERE, inner: NOWHERE };
    match least.tag(tree.exterior) {
        Tag::Empty => {}
        Tag::Full => least.meet(place.square_from_outside(), Cell::ROOT, tree.exterior)?,
        Tag::Partial | Tag::Branch => least.outer = place.square_from_outside(),
    }
    walk(tree, place, &mut least)?;
    Ok([least.outer, least.inner])
}

/// Number of points in one thread's task.
const CHUNK: usize = 1 << 8;

impl OctreeRef<'_> {
    /// Returns the distance of a point (model units) from the solid, its complement or its boundary, as the
    /// octree's cells and its exterior determine it, whatever they prove of the solid that the tree was made
    /// from. The point may lie outside of the universe. If a coordinate is not a finite number, the interval
    /// is `[0, ∞]`, or all numbers for [`DistanceTo::Boundary`]. `upper` is ∞ if there is no FULL cell.
    /// `lower` is ∞ too if there is no PARTIAL cell either.
    ///
    /// Rounding adds about 2^-56 of the universe's edge to the interval's width; for a point further than
    /// four edges away, 2^-57 of its distance. A point 2^37 edges away or more at depth 20 is replaced by a
    /// nearer one, and the interval contains both distances.
    ///
    /// The search usually reads some dozen elements. Whatever the bytes, each of the two searches reads no
    /// more elements than the tree has.
    ///
    /// # Errors
    /// None at present: the search allocates nothing.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build, query::DistanceTo};
    /// let frame = Frame::new([-2.0; 3], 4.0, 8)?;
    /// let ball = build(&Csg::ball([0.0; 3], 1.0)?, &frame, Rule::Certified, &Control::default())?;
    /// let far = ball.view().distance([3.0, 0.0, 4.0], DistanceTo::Solid)?;
    /// assert!(far.contains(4.0) && far.width() < 0.06);
    /// let centre = ball.view().distance([0.0; 3], DistanceTo::Boundary)?;
    /// assert!(centre.contains(-1.0) && centre.width() < 0.06);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn distance(&self, point: [f64; 3], to: DistanceTo) -> Result<Interval, Error> {
        let Some(place) = Place::new(&self.frame, point) else { return Ok(to.unknown()) };
        to.ask(|hollow| {
            let [outer, inner] = least(self, &place, hollow)?;
            Ok(Interval::between(place.distance(outer).lower, place.distance(inner).upper))
        })
    }

    /// Computes the distances of many points, `answers[i]` for `points[i]`: the same as
    /// [`distance`](Self::distance), on the threads of `control`.
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length; [`Error::OutOfMemory`] and [`Error::Cancelled`].
    pub fn distances(
        &self,
        points: &[[f64; 3]],
        to: DistanceTo,
        answers: &mut [Interval],
        control: &Control<'_>,
    ) -> Result<(), Error> {
        if points.len() != answers.len() {
            return Err(Error::Argument { name: "answers", problem: "must be as long as points" });
        }
        let job = Job::new(control);
        job.check()?;
        let found = control.run(points.len() > CHUNK, |parallel| {
            job.each(parallel, points.chunks(CHUNK), |chunk| {
                job.check()?;
                let mut found = memory::with_capacity(chunk.len())?;
                for &point in chunk {
                    found.push(self.distance(point, to)?);
                }
                Ok(found)
            })
        })?;
        for (answer, found) in answers.iter_mut().zip(found.into_iter().flatten()) {
            *answer = found;
        }
        Ok(())
    }
}

impl Octree {
    /// Returns the distance of a point. See [`OctreeRef::distance`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::distance`].
    pub fn distance(&self, point: [f64; 3], to: DistanceTo) -> Result<Interval, Error> {
        self.view().distance(point, to)
    }

    /// Computes the distances of many points. See [`OctreeRef::distances`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::distances`].
    pub fn distances(
        &self,
        points: &[[f64; 3]],
        to: DistanceTo,
        answers: &mut [Interval],
        control: &Control<'_>,
    ) -> Result<(), Error> {
        self.view().distances(points, to, answers, control)
    }
}
