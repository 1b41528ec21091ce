//! Points of any solid, without an octree.

use super::Membership;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::solid::{AskWhole, Batch, Classifier, Direct, Solid};
use crate::walk::Trail;
use alloc::vec::Vec;

/// Whether a solid contains points (model units), `answers[i]` for `points[i]`: a point in a cell of `frame`
/// that is undecided at the frame's depth, outside of the universe, or not a number is
/// [`Membership::Undecided`]. A point on the boundary may be answered either way.
///
/// What a solid knows of points itself comes first (a host program's function). Of the others each is sought
/// among the cells down to its own, in an order in which neighbours follow one another, so that they share
/// the way. O(depth) splits a point at the most; the same answers for any number of threads.
///
/// # Errors
/// [`Error::Argument`] if the slices differ in length; what the solid refuses; [`Error::OutOfMemory`], and
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
pub fn contains<S: Solid>(
    solid: &S,
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

/// A point: its finest cell's place in Morton order, that cell, and the point's own place.
type Wanted = (u64, [u32; 3], usize);

/// Points that one worker takes on.
const CHUNK: usize = 1 << 12;

/// Morton order.
fn order([x, y, z]: [u32; 3]) -> u64 {
    let spread = |v: u32| (0..21).fold(0, |spread: u64, bit| spread | ((v >> bit & 1) as u64) << (3 * bit));
    spread(x) | spread(y) << 1 | spread(z) << 2
}

/// Where points lie, which are given in Morton order of their finest cells.
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
