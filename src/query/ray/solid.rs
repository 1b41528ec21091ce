//! Rays on any solid, without an octree.

use super::direct::{self, Stops};
use super::line::Line;
use super::search::{Cells, First, Stays};
use super::{Obstacle, Ray, RayHit, RaySpans};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::Tag;
use crate::solid::{
    Ask, AskDirect, AskWhole, Classifier, Direct, Enclosure, RayTrace, Solid, Verdict, Worker,
};
use crate::walk::Proven;
use crate::walk::split_one;
use alloc::vec::Vec;

/// Whether two points see each other past a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Sight {
    /// Proven: no point of the segment lies in the solid.
    Clear = 0,
    /// Proven: some point of the segment lies in the solid, or on its surface.
    Blocked = 1,
    /// Neither could be proven with the cells of the frame.
    Undecided = 2,
}

/// Where rays first meet a solid, as far as cells of `frame` and the slabs of the finest of them tell: one
/// entry a ray, `None` if nothing stops it. What lies outside of the universe does not count. A ray splits
/// the PARTIAL cells that it passes up to the first FULL one: O(depth) splits across a surface, up to
/// O(2^depth) along one. Each ray may split `control.max_splits` cells; cells that were not split count as
/// PARTIAL. The answers are the same for any number of threads.
///
/// A mesh answers each ray from a tree over its triangles, in microseconds and to the rounding of doubles,
/// whatever the frame's depth is; the first question makes the tree ([`MeshSolid`](crate::MeshSolid)). A mesh
/// with holes also looks at all edges of its holes. It asks its cells of rays that come very near to such an
/// edge, and of all rays if there are more than 16 384 edges.
///
/// # Errors
/// What the solid refuses; [`Error::OutOfMemory`], and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, Ray, cast_rays, query::Obstacle};
/// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 16)?, Control::default());
/// let ball = Csg::ball([0.0; 3], 1.0)?;
/// let rays = [Ray::new([-2.0, 0.6, 0.0], [1.0, 0.0, 0.0])?, Ray::new([-2.0, 0.6, 0.0], [0.0, 1.0, 0.0])?];
/// let hits = cast_rays(&ball, &frame, &rays, Obstacle::Full, &control)?;
/// let hit = hits[0].expect("the ball is hit");
/// assert!(hit.t.contains(2.0 - 0.8) && hit.t.width() < 1e-8);
/// assert!((hit.normal[0] + 0.8).abs() < 1e-4 && (hit.normal[1] - 0.6).abs() < 1e-4);
/// assert!(hits[1].is_none());
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn cast_rays<S: Solid>(
    solid: &S,
    frame: &Frame,
    rays: &[Ray],
    on: Obstacle,
    control: &Control<'_>,
) -> Result<Vec<Option<RayHit>>, Error> {
    let classifier = Proven(solid.on(frame, control)?);
    let job = Job::new(control);
    job.check()?;
    let is_direct = classifier.is_direct(Direct::Rays, control)?;
    let found = control.run(rays.len() > CHUNK, |parallel| {
        job.each(parallel, rays.chunks(CHUNK), |chunk| {
            let mut worker = classifier.worker()?;
            let mut traces = Traces::new(&mut worker, is_direct)?;
            let mut hits = memory::with_capacity(chunk.len())?;
            for ray in chunk {
                let line = Line::new(frame, *ray);
                hits.push(match traces.stops(&mut worker, &line)? {
                    Some(stops) => stops.hit(on),
                    None => Asked::new(&mut worker, &job).first(&line)?.hit(on),
                });
            }
            Ok(hits)
        })
    })?;
    let mut hits = memory::with_capacity(rays.len())?;
    hits.extend(found.into_iter().flatten());
    Ok(hits)
}

/// Where a ray is in a solid, as far as cells of `frame` and the slabs of the finest of them tell. What lies
/// outside of the universe does not count. The ray splits all PARTIAL cells that it passes,
/// `control.max_splits` at the most; cells that were not split count as PARTIAL. One thread.
///
/// # Errors
/// As [`cast_rays`].
pub fn ray_spans<S: Solid>(
    solid: &S,
    frame: &Frame,
    ray: &Ray,
    control: &Control<'_>,
) -> Result<RaySpans, Error> {
    let classifier = Proven(solid.on(frame, control)?);
    let (job, line) = (Job::new(control), Line::new(frame, *ray));
    let is_direct = classifier.is_direct(Direct::Rays, control)?;
    let mut worker = classifier.worker()?;
    if let Some(trace) = Traces::new(&mut worker, is_direct)?.find(&mut worker, ray, false)? {
        return direct::spans(trace, &line);
    }
    let mut asked = Asked::new(&mut worker, &job);
    let spans = Stays::search(&mut asked, &line);
    asked.release(0);
    spans
}

/// Whether two points (model units) see each other past a solid, as far as cells of `frame` tell. If the
/// solid may go on outside of the universe and an end lies there, the answer is not [`Sight::Clear`]. Costs
/// as one ray of [`cast_rays`].
///
/// # Errors
/// [`Error::Argument`] as [`Ray::between`]; else as [`cast_rays`].
pub fn line_of_sight<S: Solid>(
    solid: &S,
    frame: &Frame,
    from: [f64; 3],
    to: [f64; 3],
    control: &Control<'_>,
) -> Result<Sight, Error> {
    let ray = Ray::between(from, to)?;
    let classifier = Proven(solid.on(frame, control)?);
    let (job, line) = (Job::new(control), Line::new(frame, ray));
    let is_direct = classifier.is_direct(Direct::Rays, control)?;
    let mut worker = classifier.worker()?;
    let stops = match Traces::new(&mut worker, is_direct)?.stops(&mut worker, &line)? {
        Some(stops) => stops.are(),
        None => Asked::new(&mut worker, &job).first(&line)?.stops(),
    };
    // (What lies around the universe may take long to find out.)
    let all_known = || {
        frame.cell_of(from).is_some() && frame.cell_of(to).is_some() || classifier.exterior() == Tag::Empty
    };
    Ok(match stops {
        (true, _) => Sight::Blocked,
        (false, false) if all_known() => Sight::Clear,
        _ => Sight::Undecided,
    })
}

/// The traces of rays of a solid that tells them.
struct Traces<P> {
    /// The universe, unless nothing is told or all of it is decided.
    root: Option<P>,
    trace: RayTrace,
}

impl<P> Traces<P> {
    fn new<W: Worker<Part = P>>(worker: &mut W, is_direct: bool) -> Result<Self, Error> {
        let root = match if is_direct { worker.root()? } else { Verdict::Undecided } {
            Verdict::Partial(part) => Some(part),
            _ => None,
        };
        Ok(Traces { root, trace: RayTrace::UNKNOWN })
    }

    /// The trace of a ray, if the solid tells it.
    fn find<W: Worker<Part = P>>(
        &mut self,
        worker: &mut W,
        ray: &Ray,
        is_first_enough: bool,
    ) -> Result<Option<&RayTrace>, Error> {
        let Some(root) = &self.root else { return Ok(None) };
        worker.trace(root, ray, is_first_enough, &mut self.trace)?;
        Ok(self.trace.is_known().then_some(&self.trace))
    }

    /// What stops a ray in the universe, if the solid tells it.
    fn stops<W: Worker<Part = P>>(
        &mut self,
        worker: &mut W,
        line: &Line<'_>,
    ) -> Result<Option<Stops>, Error> {
        let Some(trace) = self.find(worker, &line.ray, true)? else { return Ok(None) };
        if !direct::ends_before(trace, line) {
            return Ok(Some(Stops::new(trace, line)));
        }
        // It goes in outside of the universe, and may come out again.
        Ok(self.find(worker, &line.ray, false)?.map(|trace| Stops::new(trace, line)))
    }
}

/// Rays that one worker takes on.
const CHUNK: usize = 1 << 8;

/// A solid that one ray asks.
struct Asked<'w, W> {
    worker: &'w mut W,
    job: &'w Job<'w>,
    left: u64,
}

impl<'w, W: Worker> Asked<'w, W> {
    fn new(worker: &'w mut W, job: &'w Job<'w>) -> Self {
        let left = job.control().max_splits.unwrap_or(u64::MAX);
        Asked { worker, job, left }
    }

    fn first(mut self, line: &Line<'_>) -> Result<First, Error> {
        let mark = self.worker.mark();
        let first = First::search(&mut self, line);
        self.worker.release(mark);
        first
    }
}

impl<W: Worker> Cells for Asked<'_, W> {
    type Part = W::Part;

    fn root(&mut self) -> Result<Verdict<W::Part>, Error> {
        self.worker.root()
    }

    fn split(&mut self, cell: Cell, part: &W::Part) -> Result<Option<[Verdict<W::Part>; 8]>, Error> {
        self.job.check()?;
        if self.left == 0 {
            return Ok(None);
        }
        self.left -= 1;
        split_one(self.worker, cell, part, self.job.control()).map(Some)
    }

    fn enclosure(&mut self, cell: Cell, part: &W::Part) -> Result<Option<Enclosure>, Error> {
        self.worker.enclosure(cell, part)
    }

    fn mark(&self) -> usize {
        self.worker.mark()
    }

    fn release(&mut self, mark: usize) {
        self.worker.release(mark);
    }
}
