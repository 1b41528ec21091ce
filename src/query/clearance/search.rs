//! The search for the least distance.
//!
//! Each cell of the first solid is stored with the cells of the second solid that may be nearest to it (its
//! *companions*): a *group*. The group whose nearest companion is least far away comes first, which raises
//! the lower bound. The search splits the larger cells of the group. It splits each cell of either solid only
//! once, however many other cells it is compared with.
//!
//! Cut cells are as far apart as the solids' parts in them. The module `piece` bounds this distance by slabs,
//! to second order.
//!
//! Two FULL cells bound the distance from above, and so do points that slabs prove. They are searched where
//! the lower bound is: from time to time the search *plunges* from the first group to small, near cells. If
//! the plunge finds nothing, any FULL cell of either solid serves. Where the surfaces are known, `polish`
//! moves the points to them.
//!
//! A pair that is further apart than the upper bound minus the tolerance does not affect the lower bound,
//! since the search ends once all other pairs are examined. Such companions are put off, so that groups stay
//! small.
//!
//! (Companions are the advantage over a heap of pairs: for two parallel faces, the heap would have to process
//! all slightly oblique pairs, although a cell needs only its nearest companion.)

use super::nodes::Nodes;
use super::piece::{self, Bodies, Place};
use super::polish::{Polished, Side, polished};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{product_down, product_up, sqrt, two_product};
use crate::lattice::{Interval, axes};
use crate::memory;
use crate::query::StopReason;
use crate::solid::{Classifier, OpenSurfaces};
use crate::walk::Queue;
use alloc::vec::Vec;
use core::cmp::Reverse;

/// The distance of a cell of the second solid from a cell of the first: the least and the greatest distance,
/// in finest cells, and the node. The distances are the bits of non-negative doubles, whose order is the
/// order of the doubles.
type Companion = (u64, u64, usize);

/// A cell of the first solid with the cells of the second that may be nearest to it.
struct Group {
    node: usize,
    companions: Vec<usize>,
    /// The companion with the smallest least distance.
    nearest: Companion,
    /// The companion with the smallest greatest distance.
    closest: Companion,
    /// Among the companions whose least distance is about the smallest: the one with the smallest greatest
    /// distance.
    likeliest: Companion,
}

/// A distance without its last digits. (Inherited bounds and recomputed bounds differ in those digits.)
fn about(least: u64) -> u64 {
    least >> 20
}

impl Group {
    /// Adds a companion to the group of a cell. The first companion creates the group.
    fn add(group: &mut Option<Group>, node: usize, this: Companion) -> Result<(), Error> {
        let empty = || Group { node, companions: Vec::new(), nearest: this, closest: this, likeliest: this };
        let group = group.get_or_insert_with(empty);
        group.nearest = group.nearest.min(this);
        if this.1 < group.closest.1 {
            group.closest = this;
        }
        if (about(this.0), this.1) < (about(group.likeliest.0), group.likeliest.1) {
            group.likeliest = this;
        }
        memory::push(&mut group.companions, this.2)
    }

    /// A lower bound of the distance of all companions.
    fn least(&self) -> f64 {
        f64::from_bits(self.nearest.0)
    }
}

/// A rank in the queue: lesser numbers come first; among equals the group met later, which is finer.
type Rank = (Reverse<[u64; 3]>, u64);

/// The number of steps of the search for a first upper bound.
const DIVE: u64 = 4096;

/// The number of steps of a plunge; the number of other steps between two plunges; for solids with slabs, the
/// number of splits between two plunges.
const PLUNGE: u64 = 64;
const BETWEEN: u64 = 256;
const SPLITS_BETWEEN: u64 = 64;

/// The number of steps after which a plunge ends if the upper bound no longer falls.
const STALLED: u64 = 16;

/// The factor between the doubts in two cells from which on the difference counts.
const ALIKE: f64 = 4.0;

/// The maximal number of successive pairs of cells in which points are moved to the surfaces.
const CELLS_ON: usize = 4;

/// The number of successive plunges in vain that end a search in which slabs can no longer raise the lower
/// bound.
const IN_VAIN: u32 = 6;

/// Points or cells of both solids.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reached {
    /// An upper bound of their distance, in finest cells.
    pub(super) upper: f64,
    pub(super) nodes: [usize; 2],
    pub(super) points: [Place; 2],
}

/// The goal of the search.
#[derive(Debug, Clone, Copy)]
pub(super) enum Goal {
    /// An interval no wider than `tolerance`, unless the distance is at least `below` (model units).
    Width { tolerance: f64, below: f64 },
    /// Whether the distance is at least this (model units).
    AtLeast(f64),
}

impl Goal {
    /// An interval no wider than `tolerance` (model units), at any distance.
    pub(super) fn width(tolerance: f64) -> Goal {
        Goal::Width { tolerance, below: f64::INFINITY }
    }
}

/// Distances in finest cells.
struct Bounds {
    /// The least distance of the pairs that cannot be refined.
    settled: f64,
    /// The least proven upper bound, and where it is attained.
    reached: Option<Reached>,
    /// A sufficient lower bound.
    goal: f64,
}

/// The state of the search.
pub(super) struct Search<'s, A: Classifier, B: Classifier> {
    pub(super) a: Nodes<'s, A>,
    pub(super) b: Nodes<'s, B>,
    open: Queue<Rank, Group>,
    /// Whether small, near cells come first.
    plunging: bool,
    bounds: Bounds,
    /// The nearest points that were met since the last plunge began, and the distance of the points that were
    /// last moved to the surfaces.
    candidate: Option<Reached>,
    polished: f64,
    wanted: Goal,
    /// The rest of the budget.
    pub(super) left: u64,
}

/// The result of the search.
pub(super) struct Found {
    pub(super) distance: Interval,
    pub(super) reached: Option<Reached>,
    pub(super) stop_reason: StopReason,
}

impl<'s, A: Classifier, B: Classifier> Search<'s, A, B> {
    pub(super) fn new(
        a: &'s A,
        b: &'s B,
        wanted: Goal,
        budget: u64,
        control: &'s Control<'s>,
    ) -> Result<Self, Error> {
        let size = a.frame().cell_size();
        let goal = match wanted {
            Goal::Width { below: f64::INFINITY, .. } => f64::INFINITY,
            Goal::AtLeast(distance) | Goal::Width { below: distance, .. } => {
                let mut goal = distance / size;
                while product_down(goal, size) < distance {
                    goal = goal.next_up();
                }
                goal
            }
        };
        let bounds = Bounds { settled: f64::INFINITY, reached: None, goal };
        let (a, b) = (Nodes::new(a, control)?, Nodes::new(b, control)?);
        Ok(Search {
            a,
            b,
            open: Queue::new(),
            plunging: false,
            bounds,
            candidate: None,
            polished: f64::INFINITY,
            wanted,
            left: budget,
        })
    }

    /// Searches until the goal is reached, the budget is spent, or the cells cannot improve the result.
    pub(super) fn run(&mut self, job: &Job<'_>) -> Result<Found, Error> {
        if !self.a.is_empty() && !self.b.is_empty() {
            self.meet(0, [0], 0.0)?;
        }
        // (A gap may be proven without points.)
        if matches!(self.wanted, Goal::Width { .. }) {
            let budget = self.left;
            self.plunge(DIVE.min(budget / 4), job)?;
            if self.bounds.reached.is_none() {
                self.find_full(budget / 4, job)?;
            }
        }
        let (mut steps, mut in_vain, mut since) = (0, 0, self.left);
        let stop_reason = loop {
            let distance = self.distance();
            let least =
                self.open.peek().map(|group| group.item.least()).filter(|&least| !self.is_beyond(least));
            // True if the lower bound is final.
            let is_final = least.is_none_or(|least| self.bounds.settled <= least);
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
            let is_in_vain = !self.has_lore() || in_vain >= IN_VAIN;
            let is_exhausted =
                least.is_none() || is_final && distance.width() <= self.resolution() && is_in_vain;
            if is_exhausted || self.is_spent() {
                let before = self.reached();
                self.polish(self.bounds.reached)?;
                if self.reached() < before {
                    continue;
                }
                break if is_exhausted { StopReason::Exhausted } else { StopReason::Budget };
            }
            let is_due = if self.has_lore() {
                since - self.left >= SPLITS_BETWEEN
            } else {
                steps % BETWEEN == 0 && distance.width() > self.resolution()
            };
            if is_final || is_due {
                let before = self.reached();
                self.plunge(PLUNGE, job)?;
                in_vain = if is_final && self.reached() == before { in_vain + 1 } else { 0 };
                since = self.left;
            } else {
                self.step(job)?;
            }
            steps += 1;
        };
        Ok(Found { distance: self.distance(), reached: self.bounds.reached, stop_reason })
    }

    /// True if the steps or the memory that the caller allows are spent.
    pub(super) fn is_spent(&self) -> bool {
        self.left == 0 || self.a.subject.takes(4) || self.b.subject.takes(4)
    }

    /// True if both solids have provided more about cells than their verdicts.
    fn has_lore(&self) -> bool {
        self.a.has_lore() && self.b.has_lore()
    }

    /// The upper bound of the distance, in finest cells.
    fn reached(&self) -> f64 {
        self.bounds.reached.map_or(f64::INFINITY, |reached| reached.upper)
    }

    /// Goes from the first group to small, near cells until the upper bound falls, and further as long as
    /// slabs lower the bound.
    fn plunge(&mut self, steps: u64, job: &Job<'_>) -> Result<(), Error> {
        let Some(group) = self.open.pop() else { return Ok(()) };
        let (before, least) = (self.reached(), group.least().min(self.bounds.settled));
        let others = core::mem::replace(&mut self.open, Queue::new());
        (self.plunging, self.candidate) = (true, None);
        self.push(group)?;
        let spared = self.left.saturating_sub(steps);
        let (mut reached, mut since) = (before, self.left);
        while self.left > spared && !self.is_spent() && !self.is_known(self.between(least)) {
            if self.reached() < reached {
                (reached, since) = (self.reached(), self.left);
            }
            // Slabs lower the bound further on the way down; cells do not.
            let is_lowest = !self.has_lore() || since - self.left >= STALLED;
            if reached < before && is_lowest || !self.step(job)? {
                break;
            }
        }
        let met = core::mem::replace(&mut self.open, others);
        self.plunging = false;
        self.polish(self.candidate)?;
        met.into_items().try_for_each(|group| self.push(group))
    }

    /// Takes any FULL cells of both solids as an upper bound.
    fn find_full(&mut self, budget: u64, job: &Job<'_>) -> Result<(), Error> {
        let mut left = budget;
        if let Some(a) = self.a.find_full(&mut left, job)?
            && let Some(b) = self.b.find_full(&mut left, job)?
        {
            self.reach_cells(a, b);
        }
        self.left -= budget - left;
        Ok(())
    }

    fn push(&mut self, group: Group) -> Result<(), Error> {
        let order = if !self.plunging {
            let (least, greatest, _) = group.nearest;
            [least, greatest, 0]
        } else if self.has_lore() {
            // The finest cells come first: the least distance by slabs is a better guide than the greatest
            // distance.
            let (least, greatest, b) = group.likeliest;
            let levels = self.a.cell(group.node).level + self.b.cell(b).level;
            [u64::from(u8::MAX - levels), about(least), greatest]
        } else {
            let (least, greatest, _) = group.closest;
            [greatest, least, 0]
        };
        self.open.push((Reverse(order), self.open.met()), group)
    }

    /// Splits the larger cells of the first group. Returns `false` if there is no group.
    fn step(&mut self, job: &Job<'_>) -> Result<bool, Error> {
        job.check()?;
        while let Some(Group { node: a, companions, nearest, closest, likeliest }) = self.open.pop() {
            if self.is_beyond(f64::from_bits(nearest.0)) {
                continue;
            }
            let (.., b) = match (self.plunging, self.has_lore()) {
                (false, _) => nearest,
                (true, false) => closest,
                (true, true) => likeliest,
            };
            let least = f64::from_bits(nearest.0);
            if self.a.can_be_split(a) && (!self.b.can_be_split(b) || self.is_first_due(a, b)) {
                self.left = self.left.saturating_sub(1);
                for child in self.a.children(a)? {
                    self.meet(child, companions.iter().copied(), least)?;
                }
            } else {
                self.split_companions(a, b, companions, least)?;
            }
            return Ok(true);
        }
        Ok(false)
    }

    /// Returns whether the first of two cells is to be split. For a lower bound the cell with the greater
    /// doubt is split, and among equals the larger one, so that neither is split without need. (Points are
    /// found in small cells of both.)
    fn is_first_due(&self, a: usize, b: usize) -> bool {
        // (A round solid is bounded by its core. The doubt in a cell next to the core says little.)
        let are_alike = self.plunging || self.a.is_round(a) && self.b.is_round(b);
        let [of_a, of_b] = if are_alike { [0.0; 2] } else { [self.a.doubt(a), self.b.doubt(b)] };
        let is_alike = of_a.max(of_b) <= ALIKE * of_a.min(of_b);
        if is_alike { self.a.cell(a).level <= self.b.cell(b).level } else { of_a > of_b }
    }

    /// Splits the companion `b` of `a`, and also all others of its size if a proof needs them.
    fn split_companions(
        &mut self,
        a: usize,
        b: usize,
        mut companions: Vec<usize>,
        least: f64,
    ) -> Result<(), Error> {
        let level = self.b.cell(b).level;
        let count = companions.len();
        // (Other companions wait for the next step: a better upper bound may make them needless.)
        let enough = if self.has_lore() { self.left.saturating_sub(SPLITS_BETWEEN) } else { 0 };
        for i in 0..count {
            let node = companions[i];
            if self.left <= enough && node != b {
                continue;
            }
            let is_due = node == b || !self.plunging && self.left > 1 && self.b.cell(node).level <= level;
            if is_due && self.b.can_be_split(node) {
                self.left = self.left.saturating_sub(1);
                let children = self.b.children(node)?;
                companions.try_reserve(children.len())?;
                companions.extend(children);
                companions[i] = usize::MAX;
            }
        }
        self.meet(a, companions.into_iter().filter(|&node| node != usize::MAX), least)
    }

    /// True if nothing at this distance can lower the upper bound.
    fn is_beyond(&self, least: f64) -> bool {
        least >= self.reached()
    }

    /// Returns the least and the greatest distance of two cells.
    fn apart(&self, a: usize, b: usize) -> (Interval, f64) {
        let ((low_a, high_a), (low_b, high_b)) = (self.a.extent(a), self.b.extent(b));
        let (mut least, mut greatest) = (0, 0);
        for axis in 0..3 {
            let gap = low_b[axis].saturating_sub(high_a[axis]).max(low_a[axis].saturating_sub(high_b[axis]));
            let span = high_a[axis].max(high_b[axis]) - low_a[axis].min(low_b[axis]);
            least += gap as u64 * gap as u64;
            greatest += span as u64 * span as u64;
        }
        (root(least), root(greatest).upper)
    }

    /// Adds a cell of the first solid with companions. All companions are parts of cells that are proven to
    /// be at least `known` apart from this cell. Companions that do not affect the lower bound are put off in
    /// a group of their own.
    fn meet(&mut self, a: usize, nodes: impl IntoIterator<Item = usize>, known: f64) -> Result<(), Error> {
        let (full, can_be_split) = (self.a.is_full(a), self.a.can_be_split(a));
        let mut groups: [Option<Group>; 2] = [None, None];
        let mut bodies = None;
        for b in nodes {
            let (cells, mut greatest) = self.apart(a, b);
            let mut least = cells.lower.max(known);
            if self.is_beyond(least) {
                continue;
            }
            let splits = can_be_split || self.b.can_be_split(b);
            if full && self.b.is_full(b) {
                self.reach_cells(a, b);
            } else if least < self.bounds.goal {
                least = least.max(self.look(a, b, &mut bodies, least)?);
                if (self.plunging || !splits) && !self.is_beyond(least) {
                    greatest = greatest.min(self.reach_points(a, b).unwrap_or(greatest)).max(least);
                }
                if self.is_beyond(least) {
                    continue;
                }
            }
            if splits {
                let group = &mut groups[usize::from(least >= self.bounds.goal)];
                Group::add(group, a, (least.to_bits(), greatest.to_bits(), b))?;
            } else {
                self.bounds.settled = self.bounds.settled.min(least);
            }
        }
        if let Some(Group { likeliest: (.., b), .. }) = groups[0]
            && !self.plunging
            && self.has_lore()
        {
            self.reach_points(a, b);
        }
        groups.into_iter().flatten().try_for_each(|group| self.push(group))
    }

    /// Returns a lower bound of the distance of the solids' parts in two cells that are at least `least`
    /// apart.
    fn look(&mut self, a: usize, b: usize, bodies: &mut Option<Bodies>, least: f64) -> Result<f64, Error> {
        self.a.learn(a)?;
        self.b.learn(b)?;
        let (own, other) = (self.a.piece(a), self.b.piece(b));
        if !own.says_more() && !other.says_more() {
            return Ok(0.0);
        }
        let around = piece::lower_around(&own, &other);
        if around >= self.bounds.goal {
            return Ok(around);
        }
        let of_a = bodies.get_or_insert_with(|| Bodies::outer(&own));
        let known = least.max(around);
        Ok(around.max(piece::lower((&own, of_a), (&other, &Bodies::outer(&other)), known)))
    }

    /// Records points of the parts in two cells, if such points are proven, and returns their distance.
    fn reach_points(&mut self, a: usize, b: usize) -> Option<f64> {
        let (distance, points) = piece::upper(&self.a.piece(a), &self.b.piece(b))?;
        let found = Reached { upper: distance.upper, nodes: [a, b], points };
        if self.candidate.is_none_or(|best| found.upper < best.upper) {
            self.candidate = Some(found);
        }
        self.reach(found);
        Some(distance.upper)
    }

    /// Records two FULL cells.
    fn reach_cells(&mut self, a: usize, b: usize) {
        let (least, _) = self.apart(a, b);
        let ((low_a, high_a), (low_b, high_b)) = (self.a.extent(a), self.b.extent(b));
        let ends: [[f64; 2]; 3] = axes(|axis| {
            let (low, high) = (low_a[axis].max(low_b[axis]), high_a[axis].min(high_b[axis]));
            let common = 0.5 * (f64::from(low) + f64::from(high));
            match (high_a[axis] <= low_b[axis], high_b[axis] <= low_a[axis]) {
                (true, _) => [high_a[axis], low_b[axis]].each(f64::from),
                (_, true) => [low_a[axis], high_b[axis]].each(f64::from),
                _ => [common; 2],
            }
        });
        let points = [0, 1].each(|k| axes(|axis| Interval::exactly(ends[axis][k])));
        self.reach(Reached { upper: least.upper, nodes: [a, b], points });
    }

    /// Moves points to the surfaces, where these are known.
    fn polish(&mut self, from: Option<Reached>) -> Result<(), Error> {
        let Some(Reached { upper, nodes: [mut a, mut b], points }) = from else { return Ok(()) };
        if upper == self.polished {
            return Ok(());
        }
        (self.polished, self.candidate) = (upper, None);
        let before = self.reached();
        let mut about = points.each(|point| point.each(|c| 0.5 * (c.lower + c.upper)));
        // The nearest points may lie in neighbouring cells.
        for _ in 0..CELLS_ON {
            let (Some(own), Some(other)) = (side(&self.a, a), side(&self.b, b)) else { break };
            let Polished { proven, beyond } = polished([&own, &other], about, self.reached());
            if let Some((distance, points)) = proven {
                self.reach(Reached { upper: distance.upper, nodes: [a, b], points });
            }
            let Some(next) = beyond else { break };
            let (at, to) = (self.a.at(next[0], a, &mut self.left)?, self.b.at(next[1], b, &mut self.left)?);
            let (Some(at), Some(to)) = (at, to) else { break };
            if (at, to) == (a, b) {
                break;
            }
            (a, b, about) = (at, to, next);
        }
        if self.reached() < before {
            self.polished = self.reached();
        }
        Ok(())
    }

    /// Records an upper bound, unless a better one is known.
    fn reach(&mut self, found: Reached) {
        if found.upper >= self.reached() {
            return;
        }
        self.bounds.reached = Some(found);
        let Goal::Width { tolerance, .. } = self.wanted else { return };
        // Find the first lower bound that meets the goal. The floating-point estimate is only slightly off.
        let about = found.upper - tolerance / self.a.subject.classifier.frame().cell_size();
        let mut goal = if about > 0.0 { about } else { 0.0 };
        let grain = found.upper.next_up() - found.upper;
        while goal < found.upper && !self.is_known(self.between(goal)) {
            goal = (goal + grain).max(goal.next_up());
        }
        self.bounds.goal = goal.min(found.upper).min(self.bounds.goal);
    }

    fn is_known(&self, distance: Interval) -> bool {
        match self.wanted {
            Goal::Width { tolerance, below } => {
                distance.lower >= below || self.bounds.reached.is_some() && distance.width() <= tolerance
            }
            Goal::AtLeast(least) => distance.lower >= least || distance.upper < least,
        }
    }

    /// The resolution of cells for most solids: twice the diagonal of a finest cell.
    fn resolution(&self) -> f64 {
        2.0 * sqrt(3.0) * self.a.subject.classifier.frame().cell_size()
    }

    /// The interval of the distance if `least` is the least distance of all pairs that are still open.
    fn between(&self, least: f64) -> Interval {
        let (reached, size) = (self.reached(), self.a.subject.classifier.frame().cell_size());
        let of = |cells: f64, rounded: fn(f64, f64) -> f64| {
            if cells < f64::INFINITY { rounded(cells, size) } else { cells }
        };
        Interval::between(of(least.min(reached), product_down), of(reached, product_up))
    }

    /// The present interval of the distance.
    fn distance(&self) -> Interval {
        let open = self.open.peek().map_or(f64::INFINITY, |group| group.item.least());
        self.between(open.min(self.bounds.settled))
    }
}

/// The solid in a cell, if all of it is known.
fn side<'n, C: Classifier>(nodes: &'n Nodes<'_, C>, node: usize) -> Option<Side<'n>> {
    let (low, high) = nodes.extent(node);
    let ends = [low.each(f64::from), high.each(f64::from)];
    let cells = f64::from(nodes.subject.classifier.frame().cells());
    if nodes.is_full(node) {
        return Some(Side { ends, cells, open: None });
    }
    let open = nodes.lore(node)?.open?;
    let mut forms = [None; OpenSurfaces::MOST];
    for (place, &index) in forms.iter_mut().zip(open.indices()) {
        *place = Some(nodes.form(index)?);
    }
    Some(Side { ends, cells, open: Some((open, forms)) })
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
