//! Do two solids overlap, and by how much?
//!
//! Both solids are asked about the cells of one frame. A cell where one of them is EMPTY is done, a cell where both are
//! FULL proves an overlap, and of any other the sides that are cut are split: so a cell of either is split once at the
//! most, and only where the other one is.
//!
//! Which cell comes first does not matter to a proof that nothing overlaps, which needs them all. A proof of overlap
//! needs a single one, so the search begins where it is likely: a cut cell with FULL siblings lies deeper in the solid
//! than one with EMPTY ones. For the volume of the overlap the largest cells come first.

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Affine, Cell, Frame, Interval};
use crate::memory;
use crate::octree::Tag;
use crate::octree::stats::volume_of;
use crate::op::{gathered, split_one};
use crate::solid::{Classifier, Solid, TransformClassifier, Verdict, Worker};
use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Ordering;

/// Whether the interiors of two solids have points in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Overlap {
    /// Proven: they have none. The solids may touch.
    Disjoint = 0,
    /// Proven: a cell lies in both.
    Overlapping = 1,
    /// Not decided at the frame's depth, or before the splits were spent.
    Undecided = 2,
}

/// What is known of two solids inside of the universe of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interference {
    /// Whether they overlap.
    pub verdict: Overlap,
    /// A cell that lies in both, if they are proven to overlap.
    pub witness: Option<Cell>,
    /// The volume of what they have in common, in cubic model units.
    pub volume: Interval,
    /// Cells that were split, of the first solid and of the second.
    pub splits: [u64; 2],
    /// The finest level of which cells were looked at.
    pub level: u8,
    /// Whether both solids may go on outside of the universe, of which nothing is said.
    pub clipped: bool,
}

/// Whether `a` and `b` overlap, each as it is in the universe of `frame`: a solid under a placement is moved first (see
/// [`AnySolid::placed`](crate::AnySolid::placed)). Once an overlap is proven its volume is refined until the interval is no wider than `tolerance` (cubic
/// model units); infinity ends the work with the proof.
///
/// The work ends at the frame's depth, or once `control.max_splits` cells of both are split, with what is known by then.
/// Memory is linear in the cells that are not decided. One thread; a host program's shape is asked about several cells at
/// once, by as many threads as `control` allows.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; what the solids refuse; [`Error::OutOfMemory`], and
/// [`Error::Cancelled`].
///
/// ```
/// use leafless::{Ball, Control, Frame, Overlap, interference};
/// let frame = Frame::new([0.0; 3], 128.0, 10)?;
/// let (a, b) = (Ball::new([50.0; 3], 30.0)?, Ball::new([83.0; 3], 30.0)?);
/// let found = interference(&a, &b, &frame, f64::INFINITY, &Control::default())?;
/// assert_eq!(found.verdict, Overlap::Overlapping);
/// assert!(found.volume.lower > 0.0 && found.splits.iter().sum::<u64>() <= 80);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn interference<A: Solid, B: Solid>(
    a: &A,
    b: &B,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Interference, Error> {
    super::check_tolerance(tolerance)?;
    let job = Job::new(control);
    let (a, b) = (a.on(frame, control)?, b.on(frame, control)?);
    let mut search = Search::new(&a, &b, control.max_splits)?;
    let found = control.run(search.likes_many(), |parallel| {
        search.threads = if parallel { gathered::threads() } else { 1 };
        search.run(tolerance, &job)
    })?;
    job.advance(WHOLE);
    Ok(found)
}

/// As [`interference`] of `a` with `b` under each of the `placements`, in their order; the first of both is known on
/// `frame`, the second on its `own` frame, and both are prepared once. The same for any number of threads;
/// `control.max_splits` concerns each placement.
///
/// # Errors
/// As [`interference`].
pub fn interference_of<A: Solid, B: Solid>(
    a: &A,
    b: &B,
    own: &Frame,
    placements: &[Affine],
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Vec<Interference>, Error> {
    super::check_tolerance(tolerance)?;
    let job = Job::new(control);
    let bounds = b.bounds();
    let (a, b) = (a.on(frame, control)?, b.on(own, control)?);
    let one = |placement: &Affine| {
        let around = bounds.and_then(|bounds| bounds.placed(placement));
        let b = TransformClassifier::new(b.clone(), placement, frame, around);
        let found = Search::new(&a, &b, control.max_splits)?.run(tolerance, &job)?;
        job.advance(WHOLE / placements.len());
        Ok::<_, Error>(found)
    };
    let mut found = memory::with_capacity(placements.len())?;
    control.run(placements.len() > 1, |parallel| {
        #[cfg(feature = "parallel")]
        if parallel {
            use rayon::prelude::*;
            // By pieces, so that what is collected behind the scenes stays small.
            for piece in placements.chunks(PIECE) {
                let done: Result<Vec<_>, Error> = piece.par_iter().map(one).collect();
                found.extend(done?);
            }
            return Ok(found);
        }
        let _ = parallel;
        for placement in placements {
            found.push(one(placement)?);
        }
        Ok::<_, Error>(found)
    })
}

/// Placements that are handed to the threads at once.
#[cfg(feature = "parallel")]
const PIECE: usize = 4096;

/// What is known of a cell that is not EMPTY.
#[derive(Clone)]
enum Known<P> {
    Full,
    Undecided,
    Part(P),
}

impl<P> Known<P> {
    fn new(verdict: Verdict<P>) -> Option<Known<P>> {
        match verdict {
            Verdict::Empty => None,
            Verdict::Full => Some(Known::Full),
            Verdict::Undecided => Some(Known::Undecided),
            Verdict::Partial(part) => Some(Known::Part(part)),
        }
    }

    fn is_full(&self) -> bool {
        matches!(self, Known::Full)
    }

    fn is_part(&self) -> bool {
        matches!(self, Known::Part(_))
    }
}

/// A cell in which neither solid is EMPTY and one can be split.
struct Pair<P, Q> {
    cell: Cell,
    a: Known<P>,
    b: Known<Q>,
    /// The greater comes first; among equals, what was met earlier.
    rank: u64,
    met: u64,
}

impl<P, Q> Ord for Pair<P, Q> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rank.cmp(&other.rank).then(other.met.cmp(&self.met))
    }
}

impl<P, Q> PartialOrd for Pair<P, Q> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<P, Q> PartialEq for Pair<P, Q> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<P, Q> Eq for Pair<P, Q> {}

/// One of the solids with its worker.
struct Side<'s, C: Classifier> {
    classifier: &'s C,
    worker: C::Worker,
    splits: u64,
    /// Height of the memory when all parts in it were last in use.
    used: usize,
}

type Part<C> = <<C as Classifier>::Worker as Worker>::Part;

impl<'s, C: Classifier> Side<'s, C> {
    fn new(classifier: &'s C) -> Result<Self, Error> {
        Ok(Side { classifier, worker: classifier.worker()?, splits: 0, used: 0 })
    }

    /// The children, EMPTY ones as None, and how likely it is for each that it lies in the solid.
    fn split(
        &mut self,
        cell: Cell,
        known: &Known<Part<C>>,
        control: &Control<'_>,
    ) -> Result<Children<Part<C>>, Error> {
        Ok(match known {
            Known::Full => ([const { Some(Known::Full) }; 8], [1.0; 8]),
            Known::Undecided => ([const { Some(Known::Undecided) }; 8], [0.0; 8]),
            Known::Part(part) => {
                self.splits += 1;
                let children = split_one(&mut self.worker, cell, part, control)?;
                known_children(children)
            }
        })
    }

    /// The children of several cells, where the solid is better asked about them at once.
    fn split_many<'k>(
        &mut self,
        cells: impl Iterator<Item = (Cell, &'k Known<Part<C>>)>,
        threads: usize,
        control: &Control<'_>,
    ) -> Result<Vec<Children<Part<C>>>, Error>
    where
        Part<C>: 'k,
    {
        let (mut all, mut asked, mut places) = (Vec::new(), Vec::new(), Vec::new());
        for (cell, known) in cells {
            all.try_reserve(1)?;
            asked.try_reserve(1)?;
            places.try_reserve(1)?;
            match known {
                Known::Part(part) if self.worker.likes_many() => {
                    asked.push((cell, part.clone()));
                    places.push(all.len());
                    all.push(([const { None }; 8], [0.0; 8]));
                }
                known => all.push(self.split(cell, known, control)?),
            }
        }
        self.splits += asked.len() as u64;
        let found =
            gathered::each(self.classifier, &mut self.worker, &asked, threads, |own, cells, verdicts| {
                own.split_many(cells, control, verdicts)
            })?;
        for (place, children) in places.into_iter().zip(found) {
            all[place] = known_children(children);
        }
        Ok(all)
    }

    /// Whether most of the memory is held by parts that are not in use any more.
    fn is_wasteful(&self) -> bool {
        self.worker.mark() > 4 * self.used + 4096
    }

    /// Moves parts into memory of their own.
    fn keep<'k>(&mut self, parts: impl Iterator<Item = &'k mut Known<Part<C>>>) -> Result<(), Error>
    where
        Part<C>: 'k,
    {
        let mut worker = self.classifier.worker()?;
        for known in parts {
            if let Known::Part(part) = known {
                *part = worker.hand_over(&self.worker, part)?;
            }
        }
        self.used = worker.mark();
        self.worker = worker;
        Ok(())
    }
}

/// What is known of eight siblings.
fn known_children<P>(verdicts: [Verdict<P>; 8]) -> Children<P> {
    let tags = [0, 1, 2, 3, 4, 5, 6, 7].map(|k: usize| verdicts[k].tag());
    (verdicts.map(Known::new), likelihoods(&tags))
}

/// Pairs of which a host program's shape is asked at once. (It does not depend on the threads, and so the result does
/// not either.)
const GATHERED: usize = 16;

type Children<P> = ([Option<Known<P>>; 8], [f64; 8]);

/// A guess for each of eight siblings, between 0 and 1, how much of it lies in the solid: from those that share a face.
fn likelihoods(tags: &[Tag; 8]) -> [f64; 8] {
    let weight = |tag| match tag {
        Tag::Full => 1.0,
        Tag::Empty => -1.0,
        _ => 0.0,
    };
    [0, 1, 2, 3, 4, 5, 6, 7].map(|k: usize| {
        let around: f64 = [1, 2, 4].iter().map(|axis| weight(tags[k ^ axis])).sum();
        match tags[k] {
            Tag::Full => 1.0,
            _ => (3.5 + around) / 7.0,
        }
    })
}

/// Pairs of the cells of two classifiers.
type Pairs<A, B> = Vec<Pair<Part<A>, Part<B>>>;

/// What is under way.
struct Search<'s, A: Classifier, B: Classifier> {
    frame: &'s Frame,
    a: Side<'s, A>,
    b: Side<'s, B>,
    /// Splits that may still be made.
    left: u64,
    open: BinaryHeap<Pair<Part<A>, Part<B>>>,
    /// Pairs that were met.
    met: u64,
    /// In finest cells: what is FULL of both, open, and not to be decided.
    full: u64,
    waiting: u64,
    undecided: u64,
    witness: Option<Cell>,
    level: u8,
    /// Threads that may ask a host program.
    threads: usize,
}

impl<'s, A: Classifier, B: Classifier> Search<'s, A, B> {
    fn new(a: &'s A, b: &'s B, splits: Option<u64>) -> Result<Self, Error> {
        Ok(Search {
            frame: a.frame(),
            a: Side::new(a)?,
            b: Side::new(b)?,
            left: splits.unwrap_or(u64::MAX),
            open: BinaryHeap::new(),
            met: 0,
            full: 0,
            waiting: 0,
            undecided: 0,
            witness: None,
            level: 0,
            threads: 1,
        })
    }

    /// Whether a solid is better asked about several cells at once.
    fn likes_many(&self) -> bool {
        self.a.worker.likes_many() || self.b.worker.likes_many()
    }

    fn run(mut self, tolerance: f64, job: &Job<'_>) -> Result<Interference, Error> {
        job.check()?;
        if let Some(a) = Known::new(self.a.worker.root()?)
            && let Some(b) = Known::new(self.b.worker.root()?)
        {
            self.meet(Cell::ROOT, a, b, 1.0)?;
        }
        let mut searching = true;
        while let Some(pair) = self.open.pop() {
            job.check()?;
            if searching && self.witness.is_some() {
                searching = false;
                if tolerance < f64::INFINITY {
                    self.open.push(pair);
                    self.largest_first();
                    continue;
                }
            }
            let splits = pair.a.is_part() as u64 + pair.b.is_part() as u64;
            let precise = !searching && self.volume().width() <= tolerance;
            if precise || splits > self.left {
                break;
            }
            self.left -= splits;
            self.waiting -= self.cells(pair.cell);
            if self.likes_many() {
                let pairs = self.gather(pair)?;
                self.split_many(pairs, searching, job.control())?;
            } else {
                self.split(&pair, searching, job.control())?;
            }
            self.tidy()?;
        }
        Ok(self.found())
    }

    fn found(self) -> Interference {
        let undecided = self.waiting + self.undecided > 0;
        let open = |solid: Tag| solid != Tag::Empty;
        Interference {
            verdict: match self.witness {
                Some(_) => Overlap::Overlapping,
                None if undecided => Overlap::Undecided,
                None => Overlap::Disjoint,
            },
            witness: self.witness,
            volume: self.volume(),
            splits: [self.a.splits, self.b.splits],
            level: self.level,
            clipped: open(self.a.classifier.exterior()) && open(self.b.classifier.exterior()),
        }
    }

    fn volume(&self) -> Interval {
        volume_of(self.frame, self.full, self.full + self.waiting + self.undecided)
    }

    /// Finest cells in a cell.
    fn cells(&self, cell: Cell) -> u64 {
        1 << (3 * (self.frame.depth() - cell.level))
    }

    /// Takes in a cell in which neither is EMPTY.
    fn meet(&mut self, cell: Cell, a: Known<Part<A>>, b: Known<Part<B>>, rank: f64) -> Result<(), Error> {
        let cells = self.cells(cell);
        self.level = self.level.max(cell.level);
        if a.is_full() && b.is_full() {
            self.full += cells;
            self.witness.get_or_insert(cell);
        } else if cell.level == self.frame.depth() || !(a.is_part() || b.is_part()) {
            self.undecided += cells;
        } else {
            self.open.try_reserve(1)?;
            // Doubles that are not negative have the order of their bits.
            self.open.push(Pair { cell, a, b, rank: rank.to_bits(), met: self.met });
            self.met += 1;
            self.waiting += cells;
        }
        Ok(())
    }

    fn split(
        &mut self,
        pair: &Pair<Part<A>, Part<B>>,
        searching: bool,
        control: &Control<'_>,
    ) -> Result<(), Error> {
        let (of_a, likely_a) = self.a.split(pair.cell, &pair.a, control)?;
        if of_a.iter().all(Option::is_none) {
            // The other one need not be split, and is not.
            self.left += pair.b.is_part() as u64;
            return Ok(());
        }
        let of_b = self.b.split(pair.cell, &pair.b, control)?;
        self.meet_children(pair.cell, (of_a, likely_a), of_b, searching)
    }

    /// Takes up the pairs that come next, after a first one.
    fn gather(&mut self, first: Pair<Part<A>, Part<B>>) -> Result<Pairs<A, B>, Error> {
        let mut pairs = memory::with_capacity(GATHERED)?;
        pairs.push(first);
        while pairs.len() < GATHERED
            && let Some(pair) = self.open.pop()
        {
            let splits = pair.a.is_part() as u64 + pair.b.is_part() as u64;
            if splits > self.left {
                self.open.push(pair);
                break;
            }
            self.left -= splits;
            self.waiting -= self.cells(pair.cell);
            pairs.push(pair);
        }
        Ok(pairs)
    }

    /// As [`split`](Self::split) of several pairs, each solid being asked about all of its cells at once.
    fn split_many(
        &mut self,
        mut pairs: Pairs<A, B>,
        searching: bool,
        control: &Control<'_>,
    ) -> Result<(), Error> {
        let mut of_a =
            self.a.split_many(pairs.iter().map(|pair| (pair.cell, &pair.a)), self.threads, control)?;
        for i in (0..pairs.len()).rev() {
            if of_a[i].0.iter().all(Option::is_none) {
                // The other one need not be split, and is not.
                self.left += pairs[i].b.is_part() as u64;
                pairs.remove(i);
                of_a.remove(i);
            }
        }
        let of_b = self.b.split_many(pairs.iter().map(|pair| (pair.cell, &pair.b)), self.threads, control)?;
        for ((pair, of_a), of_b) in pairs.iter().zip(of_a).zip(of_b) {
            self.meet_children(pair.cell, of_a, of_b, searching)?;
        }
        Ok(())
    }

    /// Takes in the children of a cell.
    fn meet_children(
        &mut self,
        parent: Cell,
        (of_a, likely_a): Children<Part<A>>,
        (of_b, likely_b): Children<Part<B>>,
        searching: bool,
    ) -> Result<(), Error> {
        for (k, (a, b)) in of_a.into_iter().zip(of_b).enumerate() {
            let (Some(a), Some(b)) = (a, b) else { continue };
            let cell = parent.child(k as u8);
            let rank = if searching { likely_a[k] * likely_b[k] * decay(cell.level) } else { size(cell) };
            self.meet(cell, a, b, rank)?;
        }
        Ok(())
    }

    fn largest_first(&mut self) {
        let mut open = core::mem::take(&mut self.open).into_vec();
        open.iter_mut().for_each(|pair| pair.rank = size(pair.cell).to_bits());
        self.open = open.into();
    }

    /// Gives back memory that only parts hold which are not in use.
    fn tidy(&mut self) -> Result<(), Error> {
        let (tidy_a, tidy_b) = (self.a.is_wasteful(), self.b.is_wasteful());
        if tidy_a || tidy_b {
            let mut open = core::mem::take(&mut self.open).into_vec();
            if tidy_a {
                self.a.keep(open.iter_mut().map(|pair| &mut pair.a))?;
            }
            if tidy_b {
                self.b.keep(open.iter_mut().map(|pair| &mut pair.b))?;
            }
            self.open = open.into();
        }
        Ok(())
    }
}

/// What a cell's level costs in the search for an overlap: without it the search would never come back from a contact.
/// (A product of its own: the library's powers differ between platforms, and the order of the search with them.)
fn decay(level: u8) -> f64 {
    (0..level).fold(1.0, |product, _| product * 0.8)
}

/// The order of cells by size.
fn size(cell: Cell) -> f64 {
    (u8::MAX - cell.level) as f64
}
