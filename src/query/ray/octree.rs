//! Rays on stored octrees.

use super::beam::{Beam, RAYS};
use super::course::{Clear, Course};
use super::cut::CutLine;
use super::line::Line;
use super::march::March;
use super::search::{Cells, First, Stays};
use super::trace::Trace;
use super::way::Way;
use super::{Obstacle, Ray, RayHit, RaySpans};
use crate::dispatch::{Hot, with_vectors};
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::octree::cuts::{CellCut, CutsRef};
use crate::octree::links::Step;
use crate::octree::view::{OctreeRef, starts_half_way};
use crate::octree::{Octree, Planes, Tag};
use crate::solid::{Enclosure, OCTANTS, Verdict};
use core::array;

impl OctreeRef<'_> {
    /// Returns the first intersection of a ray with the octree's cells, and with the surfaces that PARTIAL
    /// cells keep, whatever they prove of the solid that the tree was made from. `None` if nothing stops the
    /// ray. The outside of the universe does not count. The search visits at most 3 · 2^depth cells, usually
    /// about a dozen, whatever the bytes.
    pub fn cast_ray(&self, ray: &Ray, on: Obstacle) -> Option<RayHit> {
        match &self.cuts {
            None => cast_one(self, ray, on),
            Some(cuts) => cast_by_cuts(self, ray, ByCuts { cuts, on }),
        }
    }

    /// Casts many rays, `hits[i]` for `rays[i]`. The answers equal those of [`cast_ray`](Self::cast_ray), but
    /// come faster. It uses one thread. Rays that run side by side take the least time if they stand next to
    /// each other in the list: groups of 32 share the search for the first cells that may stop any of them.
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Ray, Rule, build, query::Obstacle};
    /// let frame = Frame::new([-2.0; 3], 4.0, 8)?;
    /// let ball = build(&Csg::ball([0.0; 3], 1.0)?, &frame, Rule::Certified, &Control::default())?;
    /// let rays = [Ray::new([-2.0, 0.1, 0.1], [1.0, 0.0, 0.0])?; 3];
    /// let mut hits = [None; 3];
    /// ball.view().cast_rays(&rays, Obstacle::Upper, &mut hits)?;
    /// let hit = hits[0].expect("the ball is hit");
    /// assert!(hit.t.contains(2.0 - 0.98f64.sqrt()) && hit.normal == [-1.0, 0.0, 0.0]);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn cast_rays(&self, rays: &[Ray], on: Obstacle, hits: &mut [Option<RayHit>]) -> Result<(), Error> {
        match &self.cuts {
            None => cast_all(self, rays, on, hits),
            Some(cuts) => cast_all_by_cuts(self, rays, ByCuts { cuts, on }, hits),
        }
    }

    /// Returns the intervals in which a ray is in the octree's cells, whatever they prove of the solid that
    /// the tree was made from. The outside of the universe does not count. Complexity: O(cells along the ray
    /// · depth).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn ray_spans(&self, ray: &Ray) -> Result<RaySpans, Error> {
        let line = Line::new(&self.frame, *ray);
        if let Some(cuts) = &self.cuts {
            let mut stays = Stays::default();
            if with_vectors(FindStays { tree: self, cuts, line: &line, stays: &mut stays })? {
                return stays.spans(&line);
            }
        }
        exact_spans(self, &line)
    }
}

/// A query about rays.
pub(super) trait Question: Copy {
    type Answer;

    /// Returns the answer for a ray that nothing stops where it is `clear`.
    fn cast(self, way: &mut Way<'_, '_>, ray: &Ray, course: &Course, clear: Clear) -> Option<Self::Answer>;
}

/// The query for a tree whose PARTIAL cells keep no surfaces.
impl Question for Obstacle {
    type Answer = RayHit;

    #[inline(always)]
    fn cast(self, way: &mut Way<'_, '_>, ray: &Ray, course: &Course, clear: Clear) -> Option<RayHit> {
        match March::run(way, ray, course, clear, true) {
            Some(March { outer: None, .. }) => None,
            Some(march) => of_march(self, &march, way.tree, ray),
            None => exactly(self, way.tree, ray),
        }
    }
}

#[inline(never)]
fn of_march(on: Obstacle, march: &March, tree: &OctreeRef<'_>, ray: &Ray) -> Option<RayHit> {
    let outer = march.outer.map(|(met, _)| met);
    First::of(&Line::new(&tree.frame, *ray), outer, march.inner).hit(on)
}

/// Computes the answer exactly, for rays where rounding errors decide. This is slow.
#[cold]
pub(super) fn exactly(on: Obstacle, tree: &OctreeRef<'_>, ray: &Ray) -> Option<RayHit> {
    // Splitting a stored tree's cells cannot fail.
    First::search(&mut Stored(tree), &Line::new(&tree.frame, *ray)).ok()?.hit(on)
}

/// Computes the spans exactly. This is slow.
pub(super) fn exact_spans(tree: &OctreeRef<'_>, line: &Line<'_>) -> Result<RaySpans, Error> {
    Stays::search(&mut Stored(tree), line)
}

/// The query for a tree with cuts.
#[derive(Clone, Copy)]
struct ByCuts<'t, 'a> {
    cuts: &'t CutsRef<'a>,
    on: Obstacle,
}

impl Question for ByCuts<'_, '_> {
    type Answer = RayHit;

    #[inline(always)]
    fn cast(self, way: &mut Way<'_, '_>, ray: &Ray, course: &Course, clear: Clear) -> Option<RayHit> {
        let ByCuts { cuts, on } = self;
        let tree = way.tree;
        let (line, mut first) = (Line::new(&tree.frame, *ray), First::default());
        match (Trace { cuts, line: &line, course, clear }).show(way, &mut first) {
            Ok(true) => first.hit(on),
            _ => exactly(on, tree, ray),
        }
    }
}

/// Answers a query about many rays.
pub(super) fn cast_all<Q: Question>(
    tree: &OctreeRef<'_>,
    rays: &[Ray],
    question: Q,
    answers: &mut [Option<Q::Answer>],
) -> Result<(), Error> {
    if rays.len() != answers.len() {
        return Err(Error::Argument { name: "hits", problem: "must be as long as rays" });
    }
    with_vectors(CastAll { tree, rays, question, answers });
    Ok(())
}

/// Answers a query about one ray.
pub(super) fn cast_one<Q: Question>(tree: &OctreeRef<'_>, ray: &Ray, question: Q) -> Option<Q::Answer> {
    with_vectors(Cast { tree, ray, question })
}

/// Answers a query about a tree with cuts, in code separate from that of plain trees.
#[cold]
#[inline(never)]
fn cast_by_cuts(tree: &OctreeRef<'_>, ray: &Ray, question: ByCuts<'_, '_>) -> Option<RayHit> {
    cast_one(tree, ray, question)
}

#[cold]
#[inline(never)]
fn cast_all_by_cuts(
    tree: &OctreeRef<'_>,
    rays: &[Ray],
    question: ByCuts<'_, '_>,
    hits: &mut [Option<RayHit>],
) -> Result<(), Error> {
    cast_all(tree, rays, question, hits)
}

/// Finds the stays of a ray in a tree with cuts; `false` if rounding errors may change them.
struct FindStays<'s, 't, 'a> {
    tree: &'t OctreeRef<'a>,
    cuts: &'t CutsRef<'a>,
    line: &'s Line<'t>,
    stays: &'s mut Stays,
}

impl Hot for FindStays<'_, '_, '_> {
    type Output = Result<bool, Error>;

    #[inline(always)]
    fn run(self) -> Result<bool, Error> {
        let FindStays { tree, cuts, line, stays } = self;
        let course = Course::new(&tree.frame, &line.ray);
        Trace { cuts, line, course: &course, clear: Clear::UNKNOWN }.show(&mut Way::new(tree), stays)
    }
}

struct Cast<'t, 'a, Q: Question> {
    tree: &'t OctreeRef<'a>,
    ray: &'t Ray,
    question: Q,
}

impl<Q: Question> Hot for Cast<'_, '_, Q> {
    type Output = Option<Q::Answer>;

    #[inline(always)]
    fn run(self) -> Option<Q::Answer> {
        let course = Course::new(self.tree.frame(), self.ray);
        self.question.cast(&mut Way::new(self.tree), self.ray, &course, Clear::UNKNOWN)
    }
}

struct CastAll<'t, 'a, Q: Question> {
    tree: &'t OctreeRef<'a>,
    rays: &'t [Ray],
    question: Q,
    answers: &'t mut [Option<Q::Answer>],
}

impl<Q: Question> Hot for CastAll<'_, '_, Q> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut way = Way::new(self.tree);
        for (rays, answers) in self.rays.chunks(RAYS).zip(self.answers.chunks_mut(RAYS)) {
            let courses: [Course; RAYS] =
                array::from_fn(|i| Course::new(self.tree.frame(), &rays[i.min(rays.len() - 1)]));
            let clear =
                Beam::of(&courses, self.tree.frame()).map_or(Clear::UNKNOWN, |beam| beam.clear(self.tree));
            if clear.until == f64::INFINITY {
                answers.iter_mut().for_each(|answer| *answer = None);
                continue;
            }
            for ((ray, course), answer) in rays.iter().zip(&courses).zip(answers) {
                *answer = self.question.cast(&mut way, ray, course, clear);
            }
        }
    }
}

/// A stored octree, whose cells are split as they are stored.
struct Stored<'t, 'a>(&'t OctreeRef<'a>);

/// The place of an undecided cell's description.
#[derive(Clone, Copy)]
enum Described {
    /// The element level, the element, and the octant unless it is the element's own cell.
    Planes(usize, usize, Option<u8>),
    /// The record of a PARTIAL cell.
    Record(usize),
}

impl Stored<'_, '_> {
    fn verdict(&self, e: usize, index: usize, planes: Planes, c: u32) -> Verdict<Described> {
        match self.0.step(e, index, planes, c) {
            Step::Into(child) => Verdict::Partial(Described::Planes(e + 1, child, None)),
            Step::Settled(tag) => self.settled(tag, |cuts| cuts.record(index, planes, c)),
        }
    }

    fn settled(&self, tag: Tag, record: impl FnOnce(&CutsRef<'_>) -> usize) -> Verdict<Described> {
        match (tag, &self.0.cuts) {
            (Tag::Empty, _) => Verdict::Empty,
            (Tag::Full, _) => Verdict::Full,
            (Tag::Partial, Some(cuts)) => recorded(cuts, record(cuts)),
            _ => Verdict::Undecided,
        }
    }
}

/// Returns the verdict of a PARTIAL cell with a record.
fn recorded(cuts: &CutsRef<'_>, record: usize) -> Verdict<Described> {
    match cuts.at(record) {
        CellCut::None => Verdict::Undecided,
        CellCut::Table { .. } | CellCut::Split(_) => Verdict::Partial(Described::Record(record)),
    }
}

impl Cells for Stored<'_, '_> {
    type Part = Described;

    fn root(&mut self) -> Result<Verdict<Described>, Error> {
        let half = starts_half_way(self.0.frame.depth());
        Ok(match self.0.root {
            Tag::Branch => Verdict::Partial(Described::Planes(0, 0, half.then_some(0))),
            tag => self.settled(tag, |_| CutsRef::ROOT),
        })
    }

    fn split(&mut self, _: Cell, part: &Described) -> Result<Option<[Verdict<Described>; 8]>, Error> {
        let (e, index, octant) = match (*part, &self.0.cuts) {
            (Described::Planes(e, index, octant), _) => (e, index, octant),
            (Described::Record(record), Some(cuts)) => {
                let CellCut::Split(first) = cuts.at(record) else { return Ok(None) };
                return Ok(Some(OCTANTS.each(|k| recorded(cuts, first + usize::from(k)))));
            }
            (Described::Record(_), None) => return Ok(None),
        };
        let planes = self.0.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
        Ok(Some(OCTANTS.each(|k| match octant {
            Some(octant) => self.verdict(e, index, planes, (8 * octant + k).into()),
            None => match planes.octant(k.into()) {
                Tag::Branch => Verdict::Partial(Described::Planes(e, index, Some(k))),
                tag => self.settled(tag, |cuts| cuts.record(index, planes, 8 * u32::from(k))),
            },
        })))
    }

    fn enclosure(&mut self, _: Cell, _: &Described) -> Result<Option<Enclosure>, Error> {
        Ok(None)
    }

    fn table(&self, part: &Described, line: &Line<'_>, times: [f64; 2]) -> Option<CutLine<'_>> {
        let (Described::Record(record), Some(cuts)) = (*part, &self.0.cuts) else { return None };
        let CellCut::Table { ids, table } = cuts.at(record) else { return None };
        Some(CutLine::new(&cuts.surfaces, &ids, table, line, times))
    }

    fn mark(&self) -> usize {
        0
    }

    fn release(&mut self, _: usize) {}
}

impl Octree {
    /// Returns the first intersection of a ray. See [`OctreeRef::cast_ray`] for the full contract.
    pub fn cast_ray(&self, ray: &Ray, on: Obstacle) -> Option<RayHit> {
        self.view().cast_ray(ray, on)
    }

    /// Casts many rays. See [`OctreeRef::cast_rays`] for the full contract.
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    pub fn cast_rays(&self, rays: &[Ray], on: Obstacle, hits: &mut [Option<RayHit>]) -> Result<(), Error> {
        self.view().cast_rays(rays, on, hits)
    }

    /// Returns the spans of a ray. See [`OctreeRef::ray_spans`] for the full contract.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn ray_spans(&self, ray: &Ray) -> Result<RaySpans, Error> {
        self.view().ray_spans(ray)
    }
}
