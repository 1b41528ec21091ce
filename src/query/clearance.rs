//! How far apart are two solids?
//!
//! Every cell of the first solid has with it those cells of the second that may be nearest to it. The cell whose nearest
//! companion is least far away comes first: of the two the larger one that is cut is split, each cell of either solid
//! once only however many others it is compared with. Two FULL cells bound the distance from above, and what lies further
//! apart than the least such bound is forgotten. Such a bound is what the search begins with, and ends with if its budget
//! does: by going where the cells are small and near.
//!
//! (The companions make the difference to a heap of pairs: of two faces that are parallel all the pairs that lie a little
//! askew would have to be looked at, and a cell needs its nearest companion only.)

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::exact::{product_down, product_up, sqrt, two_product};
use crate::lattice::{Cell, Cube, Frame, Interval};
use crate::memory;
use crate::octree::Tag;
use crate::op::split_one;
use crate::solid::{Classifier, Solid, Verdict, Worker};
use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::{Ordering, Reverse};

/// What is known of the distance between two solids inside of the universe of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// The least distance between points of the two, in model units: 0 if they touch or overlap. The upper bound is
    /// infinite as long as one of them has no cell that is proven to be full, and the lower one too if one of them is
    /// proven to be empty.
    pub distance: Interval,
    /// Cells of the first and of the second solid with points that are no further apart than the upper bound.
    pub nearest: Option<[Cell; 2]>,
    /// Cells that were split, of the first solid and of the second.
    pub splits: [u64; 2],
    /// Whether one of the solids may go on outside of the universe, of which nothing is said.
    pub clipped: bool,
}

/// The distance between `a` and `b`, each as it is in the universe of `frame`: a solid under a placement is moved first
/// (see [`AnySolid::placed`](crate::AnySolid::placed)). The work ends when the interval is no wider than `tolerance` (model units), at the
/// frame's depth, or once `control.max_splits` cells of both are split, with what is known by then; a cell whose children
/// are looked at again, next to another one, counts once more, because that is where the work is.
///
/// About twice the diagonal of a finest cell is what can be had for any solids. The work grows with the area where the
/// distance is about the least one, and with the distance, both measured in cells as large as the tolerance. Memory
/// is linear in the splits and in what is compared. One thread.
///
/// # Errors
/// [`Error::Argument`] if `tolerance` is negative or not a number; what the solids refuse; [`Error::OutOfMemory`], and
/// [`Error::Cancelled`].
///
/// ```
/// use leafless::{Ball, Control, Frame, clearance};
/// let frame = Frame::new([0.0; 3], 128.0, 10)?;
/// let (a, b) = (Ball::new([50.0; 3], 30.0)?, Ball::new([86.0; 3], 30.0)?);
/// let found = clearance(&a, &b, &frame, 0.5, &Control::default())?;
/// assert!(found.distance.contains(36.0 * 3f64.sqrt() - 60.0) && found.distance.width() <= 0.5);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn clearance<A: Solid, B: Solid>(
    a: &A,
    b: &B,
    frame: &Frame,
    tolerance: f64,
    control: &Control<'_>,
) -> Result<Clearance, Error> {
    super::check_tolerance(tolerance)?;
    let job = Job::new(control);
    job.check()?;
    let (a, b) = (a.on(frame, control)?, b.on(frame, control)?);
    let mut search = Search::new(&a, &b)?;
    search.run(tolerance, control.max_splits.unwrap_or(u64::MAX), &job)?;
    job.advance(WHOLE);
    Ok(search.found())
}

/// What is known of a cell.
enum Known<P> {
    Full,
    Undecided,
    Part(P),
    /// Split, into those nodes that are not EMPTY.
    Split {
        first: usize,
        count: usize,
    },
}

/// A cell that is not EMPTY.
struct Node<P> {
    cell: Cell,
    known: Known<P>,
}

/// The cells of a solid that were looked at.
struct Cells<'s, C: Classifier> {
    classifier: &'s C,
    worker: C::Worker,
    nodes: Vec<Node<Part<C>>>,
    splits: u64,
}

type Part<C> = <<C as Classifier>::Worker as Worker>::Part;

impl<'s, C: Classifier> Cells<'s, C> {
    fn new(classifier: &'s C) -> Result<Self, Error> {
        let mut cells = Cells { classifier, worker: classifier.worker()?, nodes: Vec::new(), splits: 0 };
        let root = cells.worker.root()?;
        cells.add(Cell::ROOT, root)?;
        Ok(cells)
    }

    fn frame(&self) -> &'s Frame {
        self.classifier.frame()
    }

    fn add(&mut self, cell: Cell, verdict: Verdict<Part<C>>) -> Result<(), Error> {
        let known = match verdict {
            Verdict::Empty => return Ok(()),
            Verdict::Full => Known::Full,
            Verdict::Undecided => Known::Undecided,
            // No finer cells are asked for.
            Verdict::Partial(_) if cell.level == self.frame().depth() => Known::Undecided,
            Verdict::Partial(part) => Known::Part(part),
        };
        memory::push(&mut self.nodes, Node { cell, known })?;
        Ok(())
    }

    fn is_full(&self, node: usize) -> bool {
        matches!(self.nodes[node].known, Known::Full)
    }

    /// Whether there are finer cells.
    fn can_be_split(&self, node: usize) -> bool {
        matches!(self.nodes[node].known, Known::Part(_) | Known::Split { .. })
    }

    /// The children of a node that can be split; those of no other.
    fn children(&mut self, node: usize, control: &Control<'_>) -> Result<core::ops::Range<usize>, Error> {
        let Node { cell, known } = &self.nodes[node];
        let cell = *cell;
        if let Known::Part(part) = known {
            self.splits += 1;
            let children = split_one(&mut self.worker, cell, part, control)?;
            let first = self.nodes.len();
            for (octant, child) in (0..8).zip(children) {
                self.add(cell.child(octant), child)?;
            }
            self.nodes[node].known = Known::Split { first, count: self.nodes.len() - first };
        }
        Ok(match self.nodes[node].known {
            Known::Split { first, count } => first..first + count,
            _ => 0..0,
        })
    }

    /// The least and the greatest coordinates, in finest cells.
    fn extent(&self, node: usize) -> ([u32; 3], [u32; 3]) {
        Cube { frame: self.frame(), cell: self.nodes[node].cell }.planes()
    }

    fn level(&self, node: usize) -> u8 {
        self.nodes[node].cell.level
    }
}

/// How far a cell of the second solid is from one of the first: the squares of the least distance, in finest cells, and
/// of the greatest; and the node.
type Companion = (u64, u64, usize);

/// A cell of the first solid with those of the second that may be nearest to it.
struct Group {
    /// The lesser comes first; among equals, what was met later, which is finer.
    rank: ([u64; 2], Reverse<u64>),
    node: usize,
    nearest: Companion,
    companions: Vec<Companion>,
}

impl Group {
    /// Puts it in its place by the greatest distance from its nearest companion, or the least.
    fn rank(&mut self, diving: bool) {
        let (least, greatest, _) = self.nearest;
        self.rank.0 = if diving { [greatest, least] } else { [least, greatest] };
    }
}

impl Ord for Group {
    fn cmp(&self, other: &Self) -> Ordering {
        // A heap has the greatest first.
        other.rank.cmp(&self.rank)
    }
}

impl PartialOrd for Group {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Group {
    fn eq(&self, other: &Self) -> bool {
        self.rank == other.rank
    }
}

impl Eq for Group {}

/// Steps of the search for a first upper bound.
const DIVE: u64 = 4096;

/// What is under way.
struct Search<'s, A: Classifier, B: Classifier> {
    a: Cells<'s, A>,
    b: Cells<'s, B>,
    open: BinaryHeap<Group>,
    /// Whether small cells that are near come first.
    diving: bool,
    /// Groups that were met.
    met: u64,
    /// The least square of the least distance in a pair that no more will be known of.
    settled: Option<u64>,
    /// The least square of a distance that is not exceeded, and the nodes.
    reached: Option<(u64, [usize; 2])>,
}

impl<'s, A: Classifier, B: Classifier> Search<'s, A, B> {
    fn new(a: &'s A, b: &'s B) -> Result<Self, Error> {
        let (a, b) = (Cells::new(a)?, Cells::new(b)?);
        let mut search =
            Search { a, b, open: BinaryHeap::new(), diving: true, met: 0, settled: None, reached: None };
        if !search.a.nodes.is_empty() && !search.b.nodes.is_empty() {
            search.meet(0, [0])?;
        }
        Ok(search)
    }

    fn run(&mut self, tolerance: f64, budget: u64, job: &Job<'_>) -> Result<(), Error> {
        let reserve = if budget == u64::MAX { 0 } else { budget / 8 };
        let mut left = budget;
        for _ in 0..DIVE.min(budget / 4) {
            if self.reached.is_some() || !self.step(job)? {
                break;
            }
            left -= 1;
        }
        self.order(false);
        while let Some(least) = self.open.peek().map(|group| group.nearest.0) {
            // The lower bound may be what it will be without a sign of an upper one.
            let hopeless = self.reached.is_none() && self.settled.is_some_and(|settled| settled <= least);
            if hopeless || self.is_beyond(least) || self.distance(Some(least)).width() <= tolerance {
                break;
            }
            if left <= reserve {
                return self.finish(tolerance, least, left, job);
            }
            self.step(job)?;
            left -= 1;
        }
        Ok(())
    }

    /// What remains goes into the upper bound, while the lower one stays.
    fn finish(&mut self, tolerance: f64, least: u64, left: u64, job: &Job<'_>) -> Result<(), Error> {
        self.order(true);
        for _ in 0..left {
            if self.distance(Some(least)).width() <= tolerance || !self.step(job)? {
                break;
            }
        }
        Ok(())
    }

    /// Puts small cells that are near first, or those that may be least far away.
    fn order(&mut self, diving: bool) {
        self.diving = diving;
        let mut open = core::mem::take(&mut self.open).into_vec();
        open.iter_mut().for_each(|group| group.rank(diving));
        self.open = open.into();
    }

    /// Splits a cell of the first group; false if there is none.
    fn step(&mut self, job: &Job<'_>) -> Result<bool, Error> {
        job.check()?;
        while let Some(Group { node: a, nearest: (least, _, b), companions, .. }) = self.open.pop() {
            if self.is_beyond(least) {
                continue;
            }
            let companions = companions.iter().map(|&(.., node)| node);
            // The larger one, so that neither is split without need.
            if self.a.can_be_split(a) && (!self.b.can_be_split(b) || self.a.level(a) <= self.b.level(b)) {
                for child in self.a.children(a, job.control())? {
                    self.meet(child, companions.clone())?;
                }
            } else {
                let children = self.b.children(b, job.control())?;
                self.meet(a, companions.filter(|&node| node != b).chain(children))?;
            }
            return Ok(true);
        }
        Ok(false)
    }

    /// Whether nothing at this distance can lower the upper bound.
    fn is_beyond(&self, least: u64) -> bool {
        self.reached.is_some_and(|(reached, _)| least >= reached)
    }

    /// Takes in a cell of the first solid with companions.
    fn meet(&mut self, a: usize, nodes: impl IntoIterator<Item = usize>) -> Result<(), Error> {
        let (low_a, high_a) = self.a.extent(a);
        let (full, can_be_split) = (self.a.is_full(a), self.a.can_be_split(a));
        let mut companions: Vec<Companion> = Vec::new();
        for b in nodes {
            let (low_b, high_b) = self.b.extent(b);
            let (mut least, mut greatest) = (0, 0);
            for axis in 0..3 {
                let gap =
                    low_b[axis].saturating_sub(high_a[axis]).max(low_a[axis].saturating_sub(high_b[axis]));
                let span = high_a[axis].max(high_b[axis]) - low_a[axis].min(low_b[axis]);
                least += gap as u64 * gap as u64;
                greatest += span as u64 * span as u64;
            }
            if self.is_beyond(least) {
                continue;
            }
            if full && self.b.is_full(b) {
                self.reached = Some((least, [a, b]));
            }
            if can_be_split || self.b.can_be_split(b) {
                memory::push(&mut companions, (least, greatest, b))?;
            } else {
                self.settled = Some(self.settled.map_or(least, |settled| settled.min(least)));
            }
        }
        if let Some(&nearest) = companions.iter().min() {
            self.open.try_reserve(1)?;
            let mut group = Group { rank: ([0; 2], Reverse(self.met)), node: a, nearest, companions };
            group.rank(self.diving);
            self.open.push(group);
            self.met += 1;
        }
        Ok(())
    }

    /// What is known if this is the least distance in the groups.
    fn distance(&self, open: Option<u64>) -> Interval {
        let reached = self.reached.map(|(reached, _)| reached);
        let least = [open, self.settled, reached].into_iter().flatten().min();
        let size = self.a.frame().cell_size();
        Interval {
            lower: least.map_or(f64::INFINITY, |square| product_down(root(square).lower, size)),
            upper: reached.map_or(f64::INFINITY, |square| product_up(root(square).upper, size)),
        }
    }

    fn found(self) -> Clearance {
        Clearance {
            distance: self.distance(self.open.iter().map(|group| group.nearest.0).min()),
            nearest: self.reached.map(|(_, [a, b])| [self.a.nodes[a].cell, self.b.nodes[b].cell]),
            splits: [self.a.splits, self.b.splits],
            clipped: self.a.classifier.exterior() != Tag::Empty || self.b.classifier.exterior() != Tag::Empty,
        }
    }
}

/// The root of an integer below 2^53.
fn root(square: u64) -> Interval {
    let square = square as f64;
    let root = sqrt(square);
    match two_product(root, root) {
        exact if exact == (square, 0.0) => Interval::exactly(root),
        _ => Interval { lower: root.next_down(), upper: root.next_up() },
    }
}
