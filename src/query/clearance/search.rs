//! The search for the least distance.
//!
//! Every cell of the first solid has with it those cells of the second that may be nearest to it. The cell
//! whose nearest companion is least far away comes first: of the two the larger one that is cut is split,
//! each cell of either solid once only however many others it is compared with. Two FULL cells bound the
//! distance from above, and what lies further apart than the least such bound is forgotten. Such a bound is
//! what the search begins with, and ends with if its budget does: by going where the cells are small and
//! near.
//!
//! (The companions make the difference to a heap of pairs: of two faces that are parallel all the pairs that
//! lie a little askew would have to be looked at, and a cell needs its nearest companion only.)

use super::Clearance;
use super::nodes::Nodes;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Interval;
use crate::lattice::exact::{product_down, product_up, sqrt, two_product};
use crate::memory;
use crate::query::queue::Queue;
use crate::solid::Classifier;
use alloc::vec::Vec;
use core::cmp::Reverse;

/// How far a cell of the second solid is from one of the first: the squares of the least distance, in finest
/// cells, and of the greatest; and the node.
type Companion = (u64, u64, usize);

/// A cell of the first solid with those of the second that may be nearest to it.
struct Group {
    node: usize,
    nearest: Companion,
    companions: Vec<Companion>,
}

/// A place in the queue: the lesser numbers come first; among equals, what was met later, which is finer.
type Rank = (Reverse<[u64; 2]>, u64);

/// The greatest distance from the nearest companion comes first in a rank, or the least one.
fn rank(&(least, greatest, _): &Companion, diving: bool) -> Reverse<[u64; 2]> {
    Reverse(if diving { [greatest, least] } else { [least, greatest] })
}

/// Steps of the search for a first upper bound.
const DIVE: u64 = 4096;

/// What is under way.
pub(super) struct Search<'s, A: Classifier, B: Classifier> {
    a: Nodes<'s, A>,
    b: Nodes<'s, B>,
    open: Queue<Rank, Group>,
    /// Whether small cells that are near come first.
    diving: bool,
    /// The least square of the least distance in a pair that no more will be known of.
    settled: Option<u64>,
    /// The least square of a distance that is not exceeded, and the nodes.
    reached: Option<(u64, [usize; 2])>,
}

impl<'s, A: Classifier, B: Classifier> Search<'s, A, B> {
    pub(super) fn new(a: &'s A, b: &'s B, control: &'s Control<'s>) -> Result<Self, Error> {
        let (a, b) = (Nodes::new(a, control)?, Nodes::new(b, control)?);
        let is_empty = a.nodes.is_empty() || b.nodes.is_empty();
        let mut search = Search { a, b, open: Queue::new(), diving: true, settled: None, reached: None };
        if !is_empty {
            search.meet(0, [0])?;
        }
        Ok(search)
    }

    /// Searches until the distance is known as well as that, or the budget is spent.
    pub(super) fn run(&mut self, tolerance: f64, budget: u64, job: &Job<'_>) -> Result<(), Error> {
        let reserve = if budget == u64::MAX { 0 } else { budget / 8 };
        let mut left = budget;
        for _ in 0..DIVE.min(budget / 4) {
            if self.reached.is_some() || !self.step(job)? {
                break;
            }
            left -= 1;
        }
        self.order(false);
        while let Some(least) = self.open.peek().map(|group| group.item.nearest.0) {
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
        self.open.change(|groups| {
            groups.iter_mut().for_each(|group| group.key.0 = rank(&group.item.nearest, diving));
        });
    }

    /// Splits a cell of the first group; false if there is none.
    fn step(&mut self, job: &Job<'_>) -> Result<bool, Error> {
        job.check()?;
        while let Some(Group { node: a, nearest: (least, _, b), companions }) = self.open.pop() {
            if self.is_beyond(least) {
                continue;
            }
            let companions = companions.iter().map(|&(.., node)| node);
            // The larger one, so that neither is split without need.
            let (level_a, level_b) = (self.a.cell(a).level, self.b.cell(b).level);
            if self.a.can_be_split(a) && (!self.b.can_be_split(b) || level_a <= level_b) {
                for child in self.a.children(a)? {
                    self.meet(child, companions.clone())?;
                }
            } else {
                let children = self.b.children(b)?;
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
            let rank = (rank(&nearest, self.diving), self.open.met());
            self.open.push(rank, Group { node: a, nearest, companions })?;
        }
        Ok(())
    }

    /// What is known if this is the least distance in the groups.
    fn distance(&self, open: Option<u64>) -> Interval {
        let reached = self.reached.map(|(reached, _)| reached);
        let least = [open, self.settled, reached].into_iter().flatten().min();
        let size = self.a.subject.classifier.frame().cell_size();
        Interval {
            lower: least.map_or(f64::INFINITY, |square| product_down(root(square).lower, size)),
            upper: reached.map_or(f64::INFINITY, |square| product_up(root(square).upper, size)),
        }
    }

    /// What is known.
    pub(super) fn found(self) -> Clearance {
        Clearance {
            distance: self.distance(self.open.iter().map(|group| group.nearest.0).min()),
            nearest: self.reached.map(|(_, [a, b])| [self.a.cell(a), self.b.cell(b)]),
            splits: [self.a.subject.splits, self.b.subject.splits],
            proofs: [self.a.subject.classifier.proof(), self.b.subject.classifier.proof()],
            clipped: self.a.subject.is_clipped() || self.b.subject.is_clipped(),
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
