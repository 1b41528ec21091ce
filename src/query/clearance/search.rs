//! The search for the least distance.
//!
//! Every cell of the first solid has with it those cells of the second that may be nearest to it: a *group*.
//! The group whose nearest companion is least far away comes first, which raises the lower bound. The larger
//! of its cells are split, each cell of either solid once only however many others it is compared with.
//!
//! Two FULL cells bound the distance from above. They are looked for where the lower bound is: now and then
//! the search *plunges* from the first group to small cells that are near. Where that finds nothing, any FULL
//! cell of either solid will do.
//!
//! A pair that is further apart than the upper bound less the tolerance does not matter to the lower bound,
//! since the search ends once all others are looked into. Such companions are put off, so that groups stay
//! small.
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
use crate::query::StopReason;
use crate::solid::Classifier;
use crate::walk::Queue;
use alloc::vec::Vec;
use core::cmp::Reverse;

/// How far a cell of the second solid is from one of the first: the squares of the least distance, in finest
/// cells, and of the greatest; and the node.
type Companion = (u64, u64, usize);

/// A cell of the first solid with those of the second that may be nearest to it.
struct Group {
    node: usize,
    companions: Vec<usize>,
    /// The companion whose least distance is the least.
    nearest: Companion,
    /// The companion whose greatest distance is the least.
    closest: Companion,
}

impl Group {
    /// Adds a companion to the group of a cell, which begins with it.
    fn add(group: &mut Option<Group>, node: usize, this: Companion) -> Result<(), Error> {
        let empty = || Group { node, companions: Vec::new(), nearest: this, closest: this };
        let group = group.get_or_insert_with(empty);
        group.nearest = group.nearest.min(this);
        if this.1 < group.closest.1 {
            group.closest = this;
        }
        memory::push(&mut group.companions, this.2)
    }
}

/// A place in the queue: the lesser numbers come first; among equals, what was met later, which is finer.
type Rank = (Reverse<[u64; 2]>, u64);

/// Steps of the search for a first upper bound.
const DIVE: u64 = 4096;

/// Steps of a plunge, and how many others come between two of them.
const PLUNGE: u64 = 64;
const BETWEEN: u64 = 256;

/// Squares of distances in finest cells.
struct Bounds {
    /// The least of a pair that no more will be known of.
    settled: Option<u64>,
    /// The least that is not exceeded, and the nodes.
    reached: Option<(u64, [usize; 2])>,
    /// A lower bound of this is enough.
    goal: u64,
}

/// What is under way.
pub(super) struct Search<'s, A: Classifier, B: Classifier> {
    a: Nodes<'s, A>,
    b: Nodes<'s, B>,
    open: Queue<Rank, Group>,
    /// Whether small cells that are near come first.
    plunging: bool,
    bounds: Bounds,
    tolerance: f64,
    /// What is left of the budget.
    left: u64,
}

impl<'s, A: Classifier, B: Classifier> Search<'s, A, B> {
    pub(super) fn new(
        a: &'s A,
        b: &'s B,
        tolerance: f64,
        budget: u64,
        control: &'s Control<'s>,
    ) -> Result<Self, Error> {
        let bounds = Bounds { settled: None, reached: None, goal: u64::MAX };
        let (a, b) = (Nodes::new(a, control)?, Nodes::new(b, control)?);
        Ok(Search { a, b, open: Queue::new(), plunging: false, bounds, tolerance, left: budget })
    }

    /// Searches until the distance is known as well as the tolerance says, the budget is spent, or the cells
    /// have no more to tell.
    pub(super) fn run(mut self, job: &Job<'_>) -> Result<Clearance, Error> {
        if !self.a.is_empty() && !self.b.is_empty() {
            self.meet(0, [0])?;
        }
        let budget = self.left;
        self.plunge(DIVE.min(budget / 4), job)?;
        if self.bounds.reached.is_none() {
            self.find_full(budget / 4, job)?;
        }
        let mut steps = 0;
        let stop_reason = loop {
            let distance = self.distance();
            let least =
                self.open.peek().map(|group| group.item.nearest.0).filter(|&least| !self.is_beyond(least));
            // Whether the lower bound is what it will be.
            let is_final =
                least.is_none_or(|least| self.bounds.settled.is_some_and(|settled| settled <= least));
            // The distance from an empty solid is known, too.
            if self.is_known(distance) {
                break StopReason::Tolerance;
            }
            if is_final && self.bounds.reached.is_none() {
                self.find_full(self.left, job)?;
                if self.bounds.reached.is_some() {
                    continue;
                }
                break if self.is_spent() { StopReason::Budget } else { StopReason::Exhausted };
            }
            if least.is_none() || is_final && distance.width() <= self.resolution() {
                break StopReason::Exhausted;
            }
            if self.is_spent() {
                break StopReason::Budget;
            }
            if is_final || steps % BETWEEN == 0 && distance.width() > self.resolution() {
                self.plunge(PLUNGE, job)?;
            } else {
                self.step(job)?;
            }
            steps += 1;
        };
        Ok(self.found(stop_reason))
    }

    /// Whether the steps or the memory that the caller allows are spent.
    fn is_spent(&self) -> bool {
        self.left == 0 || self.a.subject.takes(4) || self.b.subject.takes(4)
    }

    /// From the first group to small cells that are near, until the upper bound falls.
    fn plunge(&mut self, steps: u64, job: &Job<'_>) -> Result<(), Error> {
        let Some(group) = self.open.pop() else { return Ok(()) };
        let before = self.bounds.reached;
        let others = core::mem::replace(&mut self.open, Queue::new());
        self.plunging = true;
        self.push(group)?;
        let spared = self.left.saturating_sub(steps);
        let is_open = |search: &Self| search.left > spared && search.bounds.reached == before;
        while is_open(self) && !self.is_spent() && self.step(job)? {}
        let met = core::mem::replace(&mut self.open, others);
        self.plunging = false;
        met.into_items().try_for_each(|group| self.push(group))
    }

    /// Any FULL cells of both are an upper bound.
    fn find_full(&mut self, budget: u64, job: &Job<'_>) -> Result<(), Error> {
        let mut left = budget;
        if let Some(a) = self.a.find_full(&mut left, job)?
            && let Some(b) = self.b.find_full(&mut left, job)?
        {
            let (least, ..) = self.apart(a, b);
            self.reach(least, [a, b]);
        }
        self.left -= budget - left;
        Ok(())
    }

    fn push(&mut self, group: Group) -> Result<(), Error> {
        let order = if self.plunging {
            let (least, greatest, _) = group.closest;
            [greatest, least]
        } else {
            let (least, greatest, _) = group.nearest;
            [least, greatest]
        };
        self.open.push((Reverse(order), self.open.met()), group)
    }

    /// Splits the larger cells of the first group; false if there is none.
    fn step(&mut self, job: &Job<'_>) -> Result<bool, Error> {
        job.check()?;
        while let Some(Group { node: a, companions, nearest, closest }) = self.open.pop() {
            if self.is_beyond(nearest.0) {
                continue;
            }
            let (.., b) = if self.plunging { closest } else { nearest };
            // The larger one, so that neither is split without need.
            let (level_a, level_b) = (self.a.cell(a).level, self.b.cell(b).level);
            if self.a.can_be_split(a) && (!self.b.can_be_split(b) || level_a <= level_b) {
                self.left = self.left.saturating_sub(1);
                for child in self.a.children(a)? {
                    self.meet(child, companions.iter().copied())?;
                }
            } else {
                self.split_companions(a, b, companions)?;
            }
            return Ok(true);
        }
        Ok(false)
    }

    /// Splits the companion `b` of `a`, and if a proof needs them all the others of its size, too.
    fn split_companions(&mut self, a: usize, b: usize, mut companions: Vec<usize>) -> Result<(), Error> {
        let level = self.b.cell(b).level;
        let count = companions.len();
        for i in 0..count {
            let node = companions[i];
            let is_due = node == b || !self.plunging && self.left > 1 && self.b.cell(node).level <= level;
            if is_due && self.b.can_be_split(node) {
                self.left = self.left.saturating_sub(1);
                let children = self.b.children(node)?;
                companions.try_reserve(children.len())?;
                companions.extend(children);
                companions[i] = usize::MAX;
            }
        }
        self.meet(a, companions.into_iter().filter(|&node| node != usize::MAX))
    }

    /// Whether nothing at this distance can lower the upper bound.
    fn is_beyond(&self, least: u64) -> bool {
        self.bounds.reached.is_some_and(|(reached, _)| least >= reached)
    }

    /// The squares of the least and of the greatest distance of two cells.
    fn apart(&self, a: usize, b: usize) -> (u64, u64) {
        let ((low_a, high_a), (low_b, high_b)) = (self.a.extent(a), self.b.extent(b));
        let (mut least, mut greatest) = (0, 0);
        for axis in 0..3 {
            let gap = low_b[axis].saturating_sub(high_a[axis]).max(low_a[axis].saturating_sub(high_b[axis]));
            let span = high_a[axis].max(high_b[axis]) - low_a[axis].min(low_b[axis]);
            least += gap as u64 * gap as u64;
            greatest += span as u64 * span as u64;
        }
        (least, greatest)
    }

    /// Takes in a cell of the first solid with companions. Those that do not matter to the lower bound are put
    /// off in a group of their own.
    fn meet(&mut self, a: usize, nodes: impl IntoIterator<Item = usize>) -> Result<(), Error> {
        let (full, can_be_split) = (self.a.is_full(a), self.a.can_be_split(a));
        let mut groups: [Option<Group>; 2] = [None, None];
        for b in nodes {
            let (least, greatest) = self.apart(a, b);
            if self.is_beyond(least) {
                continue;
            }
            if full && self.b.is_full(b) {
                self.reach(least, [a, b]);
            }
            if can_be_split || self.b.can_be_split(b) {
                let group = &mut groups[usize::from(least >= self.bounds.goal)];
                Group::add(group, a, (least, greatest, b))?;
            } else {
                self.bounds.settled = Some(self.bounds.settled.map_or(least, |settled| settled.min(least)));
            }
        }
        groups.into_iter().flatten().try_for_each(|group| self.push(group))
    }

    /// Takes in an upper bound.
    fn reach(&mut self, least: u64, nodes: [usize; 2]) {
        self.bounds.reached = Some((least, nodes));
        // The first square that is known well enough; what floating point says is off by a few at the most.
        let cells = root(least).upper - self.tolerance / self.a.subject.classifier.frame().cell_size();
        let about = if cells > 0.0 { cells * cells } else { 0.0 };
        let mut goal = (about as u64).saturating_sub(2).min(least);
        while goal < least && !self.is_known(self.between(Some(goal))) {
            goal += 1;
        }
        self.bounds.goal = goal;
    }

    fn is_known(&self, distance: Interval) -> bool {
        distance.lower == f64::INFINITY || self.bounds.reached.is_some() && distance.width() <= self.tolerance
    }

    /// What cells can tell of most solids: twice the diagonal of a finest one.
    fn resolution(&self) -> f64 {
        2.0 * sqrt(3.0) * self.a.subject.classifier.frame().cell_size()
    }

    /// What is known if this is the least distance of all that is not reached.
    fn between(&self, least: Option<u64>) -> Interval {
        let reached = self.bounds.reached.map(|(reached, _)| reached);
        let least = [least, reached].into_iter().flatten().min();
        let size = self.a.subject.classifier.frame().cell_size();
        Interval::between(
            least.map_or(f64::INFINITY, |square| product_down(root(square).lower, size)),
            reached.map_or(f64::INFINITY, |square| product_up(root(square).upper, size)),
        )
    }

    /// What is known.
    fn distance(&self) -> Interval {
        let open = self.open.peek().map(|group| group.item.nearest.0);
        self.between([open, self.bounds.settled].into_iter().flatten().min())
    }

    /// The answer.
    fn found(self, stop_reason: StopReason) -> Clearance {
        // What goes on outside of the universe may come as near as it likes.
        let clipped = self.a.subject.is_clipped() || self.b.subject.is_clipped();
        let distance = match (self.distance(), clipped) {
            (distance, true) => Interval::between(0.0, distance.upper),
            (distance, false) => distance,
        };
        let is_wide = distance.width() > self.tolerance;
        let stop_reason = match stop_reason {
            // No cell of the universe can raise the lower bound.
            StopReason::Tolerance if clipped && is_wide => StopReason::Exhausted,
            other => other,
        };
        Clearance {
            distance,
            nearest: self.bounds.reached.map(|(_, [a, b])| [self.a.cell(a), self.b.cell(b)]),
            stop_reason,
            splits: [self.a.subject.splits, self.b.subject.splits],
            proofs: [self.a.subject.classifier.proof(), self.b.subject.classifier.proof()],
            clipped,
        }
    }
}

/// The root of an integer below 2^53.
fn root(square: u64) -> Interval {
    let square = square as f64;
    let root = sqrt(square);
    match two_product(root, root) {
        exact if exact == (square, 0.0) => Interval::exactly(root),
        _ => Interval::between(root.next_down(), root.next_up()),
    }
}
