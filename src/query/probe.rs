//! Points and boxes of any solid, without an octree.

use super::{Membership, Region};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame};
use crate::memory;
use crate::octree::Tag;
use crate::op::split_one;
use crate::solid::{Classifier, Solid, Verdict, Worker};
use alloc::vec::Vec;

/// Whether a solid contains points (model units), `answers[i]` for `points[i]`: a point in a cell of `frame` that is
/// undecided at the frame's depth, outside of the universe, or not a number is [`Membership::Undecided`]. A point on the
/// boundary may be answered either way.
///
/// What a solid knows of points itself comes first (a host program's function). Of the others each is sought among the
/// cells down to its own, in an order in which neighbours follow one another, so that they share the way. O(depth) splits a
/// point at the most; the same answers for any number of threads.
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
    answers.fill(Membership::Undecided);
    let mut wanted: Vec<(u64, [u32; 3], usize)> = memory::with_capacity(points.len())?;
    wanted.extend((0..).zip(points).filter_map(|(i, &point)| {
        let at = frame.cell_of(point)?;
        Some((order(at), at, i))
    }));
    wanted.sort_unstable();
    let mut found = Vec::new();
    control.run(wanted.len() > CHUNK, |parallel| {
        let one = |chunk: &[(u64, [u32; 3], usize)]| locate(&classifier, chunk, points, &job);
        #[cfg(feature = "parallel")]
        if parallel {
            use rayon::prelude::*;
            found = wanted.par_chunks(CHUNK).map(one).collect::<Result<Vec<_>, Error>>()?;
            return Ok(());
        }
        let _ = parallel;
        for chunk in wanted.chunks(CHUNK) {
            memory::push(&mut found, one(chunk)?)?;
        }
        Ok::<(), Error>(())
    })?;
    for ((.., i), answer) in wanted.iter().zip(found.into_iter().flatten()) {
        answers[*i] = answer;
    }
    Ok(())
}

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
    wanted: &[(u64, [u32; 3], usize)],
    points: &[[f64; 3]],
    job: &Job<'_>,
) -> Result<Vec<Membership>, Error> {
    let mut worker = classifier.worker()?;
    let (mut own, mut known, mut answers) = (Vec::new(), Vec::new(), Vec::new());
    own.try_reserve_exact(wanted.len())?;
    known.try_reserve_exact(wanted.len())?;
    answers.try_reserve_exact(wanted.len())?;
    own.extend(wanted.iter().map(|&(.., i)| points[i]));
    known.resize(wanted.len(), None);
    worker.inside(&own, &mut known)?;
    let root = worker.root()?;
    let depth = worker.frame().depth();
    // The splits on the way to the last point: the height of the memory before, and the children.
    let mut way: Vec<(usize, [Verdict<_>; 8])> = memory::with_capacity(depth.into())?;
    let mut last = [0; 3];
    for (&(_, at, _), known) in wanted.iter().zip(known) {
        if let Some(inside) = known {
            answers.push(if inside { Membership::Inside } else { Membership::Outside });
            continue;
        }
        job.check()?;
        // Levels above the highest bit that differs are on both ways.
        let differ = (0..3).fold(0, |bits, axis| bits | (at[axis] ^ last[axis]));
        let shared = depth as usize - (u32::BITS - differ.leading_zeros()) as usize;
        if let Some(&(mark, _)) = way.get(shared + 1) {
            way.truncate(shared + 1);
            worker.release(mark);
        }
        last = at;
        let cell = Cell { level: depth, at };
        let tag = loop {
            let level = way.len() as u8;
            let verdict = match way.last() {
                Some((_, children)) => &children[cell.ancestor(level).octant() as usize],
                None => &root,
            };
            match verdict {
                Verdict::Partial(part) if level < depth => {
                    let mark = worker.mark();
                    let children = split_one(&mut worker, cell.ancestor(level), part, job.control())?;
                    way.push((mark, children));
                }
                verdict => break verdict.tag(),
            }
        };
        answers.push(tag.into());
    }
    Ok(answers)
}

/// How the box `[min, max]` (model units, min ≤ max) lies to a solid, as far as cells of `frame` tell; what of the box
/// lies outside of the universe is undecided. Ends as soon as the answer is known, or once `control.max_splits` cells are
/// split. One thread.
///
/// # Errors
/// [`Error::Argument`] if min > max on an axis, or a coordinate is not a number; what the solid refuses;
/// [`Error::OutOfMemory`], and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, Region, classify_box};
/// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 12)?, Control::default());
/// let ball = Csg::ball([0.0; 3], 1.0)?;
/// let ask = |min: [f64; 3], max: [f64; 3]| classify_box(&ball, &frame, min, max, &control);
/// assert_eq!(ask([-0.5; 3], [0.5; 3])?, Region::Inside);
/// assert_eq!(ask([0.6; 3], [1.0; 3])?, Region::Outside);
/// assert_eq!(ask([0.5; 3], [1.0; 3])?, Region::Crossing);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn classify_box<S: Solid>(
    solid: &S,
    frame: &Frame,
    min: [f64; 3],
    max: [f64; 3],
    control: &Control<'_>,
) -> Result<Region, Error> {
    if (0..3).any(|axis| min[axis] > max[axis] || min[axis].is_nan() || max[axis].is_nan()) {
        return Err(Error::Argument { name: "max", problem: "must be a number not below min on any axis" });
    }
    let classifier = solid.on(frame, control)?;
    let job = Job::new(control);
    let (mut first, mut last, mut met) = ([0; 3], [0; 3], Met::default());
    for axis in 0..3 {
        let Some((low, high, outside)) = frame.cells_between(axis, min[axis], max[axis]) else {
            return Ok(Region::Undecided);
        };
        (first[axis], last[axis]) = (low, high);
        met.partial |= outside;
    }
    let mut worker = classifier.worker()?;
    let root = worker.root()?;
    let left = control.max_splits.unwrap_or(u64::MAX);
    let mut search = Search { first, last, met, left, job: &job };
    search.visit(&mut worker, Cell::ROOT, root)?;
    let Met { empty, full, partial } = search.met;
    Ok(match (empty, full, partial) {
        (true, true, _) => Region::Crossing,
        (true, false, false) => Region::Outside,
        (false, true, false) => Region::Inside,
        _ => Region::Undecided,
    })
}

/// What has been met in a box.
#[derive(Default)]
struct Met {
    empty: bool,
    full: bool,
    partial: bool,
}

/// A box as its first and last finest cells, and what has been met in it.
struct Search<'j> {
    first: [u32; 3],
    last: [u32; 3],
    met: Met,
    /// Splits that may still be made.
    left: u64,
    job: &'j Job<'j>,
}

impl Search<'_> {
    /// Looks at a cell that has something in common with the box. The recursion is as deep as the frame.
    fn visit<W: Worker>(
        &mut self,
        worker: &mut W,
        cell: Cell,
        verdict: Verdict<W::Part>,
    ) -> Result<(), Error> {
        let part = match verdict {
            Verdict::Partial(part) if cell.level < worker.frame().depth() && self.left > 0 => part,
            verdict => {
                match verdict.tag() {
                    Tag::Empty => self.met.empty = true,
                    Tag::Full => self.met.full = true,
                    _ => self.met.partial = true,
                }
                return Ok(());
            }
        };
        self.job.check()?;
        self.left -= 1;
        let mark = worker.mark();
        for (octant, verdict) in (0..8).zip(split_one(worker, cell, &part, self.job.control())?) {
            let child = cell.child(octant);
            let (lower, upper) = Cube { frame: worker.frame(), cell: child }.planes();
            if (0..3).all(|axis| lower[axis] <= self.last[axis] && self.first[axis] < upper[axis]) {
                self.visit(worker, child, verdict)?;
            }
            if self.met.empty && self.met.full {
                break;
            }
        }
        worker.release(mark);
        Ok(())
    }
}
