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
    Ask, AskDirect, AskWhole, Classifier, Direct, DynSolid, Enclosure, RayTrace, Verdict, Worker,
};
use crate::walk::Proven;
use crate::walk::split_one;
use alloc::vec::Vec;

/// The verdict on a line of sight: whether two points see each other past a solid.
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

/// Returns the first intersections of rays with a solid, as far as the cells of `frame` and the slabs of its
/// finest cells determine them: one entry for each ray, `None` if nothing stops it. The outside of the
/// universe does not count. A ray splits the PARTIAL cells that it passes up to the first FULL cell: O(depth)
/// splits across a surface, up to O(2^depth) along one. Each ray may split `control.max_splits` cells; cells
/// that were not split count as PARTIAL. The answers do not depend on the number of threads.
///
/// A mesh answers each ray from a tree over its triangles, in microseconds and to the rounding of doubles,
/// whatever the frame's depth is. The first query builds the tree ([`MeshSolid`](crate::MeshSolid)). A mesh
/// with holes also tests all edges of its holes. It uses cells for rays that come very near to such an edge,
/// and for all rays if there are more than 16 384 edges.
///
/// # Errors
/// The solid's own errors; [`Error::OutOfMemory`] and [`Error::Cancelled`].
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
pub fn cast_rays(
    solid: &dyn DynSolid,
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

/// Returns the intervals in which a ray is in a solid, as far as the cells of `frame` and the slabs of its
/// finest cells determine them. The outside of the universe does not count. The ray splits all PARTIAL cells
/// that it passes, at most `control.max_splits`; cells that were not split count as PARTIAL. It uses one
/// thread.
///
/// # Errors
/// As [`cast_rays`].
pub fn ray_spans(
    solid: &dyn DynSolid,
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

/// Returns whether two points (model units) see each other past a solid, as far as the cells of `frame`
/// determine it. If the solid may continue outside of the universe and an end lies there, the answer is not
/// [`Sight::Clear`]. The cost is that of one ray of [`cast_rays`].
///
/// # Errors
/// [`Error::Argument`] as for [`Ray::between`]; the other errors as for [`cast_rays`].
pub fn line_of_sight(
    solid: &dyn DynSolid,
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
    // (The state of the space around the universe may take long to compute.)
    let all_known = || {
        frame.cell_of(from).is_some() && frame.cell_of(to).is_some() || classifier.exterior() == Tag::Empty
    };
    Ok(match stops {
        (true, _) => Sight::Blocked,
        (false, false) if all_known() => Sight::Clear,
        _ => Sight::Undecided,
    })
}

/// The traces of rays, from a solid that computes them itself.
struct Traces<P> {
    /// The root's part; `None` if the solid computes no traces, or the whole universe is decided.
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

    /// Returns the trace of a ray, if the solid computes it.
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

    /// Returns the stops of a ray in the universe, if the solid computes them.
    fn stops<W: Worker<Part = P>>(
        &mut self,
        worker: &mut W,
        line: &Line<'_>,
    ) -> Result<Option<Stops>, Error> {
        let Some(trace) = self.find(worker, &line.ray, true)? else { return Ok(None) };
        if !direct::ends_before(trace, line) {
            return Ok(Some(Stops::new(trace, line)));
        }
        // The ray enters the solid outside of the universe, and may leave it again.
        Ok(self.find(worker, &line.ray, false)?.map(|trace| Stops::new(trace, line)))
    }
}

/// Number of rays in one worker's task.
const CHUNK: usize = 1 << 8;

/// A solid in the query of one ray.
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
