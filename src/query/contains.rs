//! Point membership for any solid, without an octree.

use super::Membership;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::solid::{AskWhole, Batch, Classifier, Direct, DynSolid};
use crate::walk::Trail;
use alloc::vec::Vec;

/// Writes to `answers[i]` whether the solid contains `points[i]` (model units). The answer is
/// [`Membership::Undecided`] for a point in a cell of `frame` that is undecided at the frame's depth, for a
/// point outside of the universe, and for a point that is not a number. A point on the boundary may get
/// either answer.
///
/// A solid that can answer points itself (a host program's function) is asked first. The remaining points are
/// located among the cells, down to each point's finest cell, in an order in which neighbours follow one
/// another and share most of the path. A point takes at most O(depth) splits. The answers do not depend on
/// the number of threads.
///
/// # Errors
/// [`Error::Argument`] if the slices differ in length; the solid's own errors; [`Error::OutOfMemory`] and
/// [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, Membership, contains};
/// let frame = Frame::new([-2.0; 3], 4.0, 20)?;
/// let mut answers = [Membership::Undecided; 2];
/// let points = [[0.0, 0.0, 0.999], [0.0, 0.0, 1.001]];
/// contains(&Csg::ball([0.0; 3], 1.0)?, &frame, &points, &mut answers, &Control::default())?;
/// assert_eq!(answers, [Membership::Inside, Membership::Outside]);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn contains(
    solid: &dyn DynSolid,
    frame: &Frame,
    points: &[[f64; 3]],
    answers: &mut [Membership],
    control: &Control<'_>,
) -> Result<(), Error> {
    if points.len() != answers.len() {
        return Err(Error::Argument { name: "answers", problem: "must be as long as points" });
    }
    let classifier = solid.on(frame, control)?;
    let job = Job::new(control);
    job.check()?;
    classifier.is_direct(Direct::Points, control)?;
    answers.fill(Membership::Undecided);
    let mut wanted: Vec<Wanted> = memory::with_capacity(points.len())?;
    wanted.extend((0..).zip(points).filter_map(|(place, &point)| {
        let at = frame.cell_of(point)?;
        Some((order(at), at, place))
    }));
    wanted.sort_unstable();
    let found = control.run(wanted.len() > CHUNK, |parallel| {
        job.each(parallel, wanted.chunks(CHUNK), |chunk| locate(&classifier, chunk, points, &job))
    })?;
    let proof = classifier.proof();
    for (&(.., place), answer) in wanted.iter().zip(found.into_iter().flatten()) {
        let proven = match answer {
            Membership::Inside => proof.full,
            Membership::Outside => proof.empty,
            Membership::Undecided => false,
        };
        if proven {
            answers[place] = answer;
        }
    }
    Ok(())
}

/// A point to locate: the Morton number of its finest cell, that cell, and the point's index.
type Wanted = (u64, [u32; 3], usize);

/// Number of points in one worker's task.
const CHUNK: usize = 1 << 12;

/// The Morton number of a cell.
fn order([x, y, z]: [u32; 3]) -> u64 {
    let spread = |v: u32| (0..21).fold(0, |spread: u64, bit| spread | ((v >> bit & 1) as u64) << (3 * bit));
    spread(x) | spread(y) << 1 | spread(z) << 2
}

/// Locates points that are sorted by the Morton number of their finest cells.
fn locate<C: Classifier>(
    classifier: &C,
    wanted: &[Wanted],
    points: &[[f64; 3]],
    job: &Job<'_>,
) -> Result<Vec<Membership>, Error> {
    let mut worker = classifier.worker()?;
    let own = memory::collected(wanted.iter().map(|&(.., place)| points[place]))?;
    let mut known = memory::filled(wanted.len(), None)?;
    let mut answers = memory::with_capacity(wanted.len())?;
    worker.inside(&own, &mut known)?;
    if known.iter().all(Option::is_some) {
        answers.extend(known.into_iter().flatten().map(Membership::of));
        return Ok(answers);
    }
    let mut trail = Trail::new(worker)?;
    let level = classifier.frame().depth();
    for (&(_, at, _), known) in wanted.iter().zip(known) {
        answers.push(match known {
            Some(inside) => Membership::of(inside),
            None => {
                job.check()?;
                let cell = Cell { level, at };
                trail.follow(cell.ancestor(level - 1), job.control())?;
                trail.verdict(cell).tag().into()
            }
        });
    }
    Ok(answers)
}
