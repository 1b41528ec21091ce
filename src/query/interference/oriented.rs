//! Two stored octrees under a placement: both trees descend in pairs of cells, as oriented boxes.
//!
//! A pair of cells is dropped as soon as an axis separates them. Fifteen axes are tried: the normals of the
//! faces of both boxes, and the products of an edge of one with an edge of the other. The larger cell of a
//! pair is split first, and its eight children are tested against the other cell at once. Two FULL cells that
//! no axis separates overlap, and a ball in both is the proof ([`super::pose`] does the arithmetic).
//!
//! The pair with the deepest overlap comes first. A collision is therefore found after few pairs, and its
//! cost does not grow with the resolution. If nothing overlaps, the order does not matter: all pairs have to
//! be separated.

use super::pose::{Extent, Place, Pose, least_volume};
use super::{Ball, Interference, Overlap};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, Cell, Cube, Interval};
use crate::memory;
use crate::octree::links::Step;
use crate::octree::view::starts_half_way;
use crate::octree::{OctreeRef, Planes, Proof, Tag};
use crate::solid::{Classifier, OCTANTS, Verdict, Worker};
use alloc::vec::Vec;

/// A solid that consists of a stored octree.
#[derive(Clone, Copy)]
pub(super) struct Stored<'t> {
    tree: OctreeRef<'t>,
    /// Whether the solid is the complement.
    flip: bool,
    proof: Proof,
    /// An upper bound of the solid's volume, in finest cells.
    most: f64,
}

/// Returns the tree of a solid, if the solid is nothing but a stored octree with all cells proven, and ends
/// inside of the universe.
pub(super) fn stored<'w, C: Classifier>(
    classifier: &C,
    worker: &'w mut C::Worker,
) -> Result<Option<Stored<'w>>, Error> {
    let proof = classifier.proof();
    if !proof.is_certified() || classifier.exterior() != Tag::Empty {
        return Ok(None);
    }
    let Verdict::Partial(mut part) = worker.root()? else { return Ok(None) };
    let half_way = starts_half_way(classifier.frame().depth());
    if half_way {
        // The root of such a tree is half an element, which no subtree names. The root's children have
        // subtrees.
        let children = worker.split(Cell::ROOT, &part)?;
        match first_of_one_tree(worker, &children) {
            Some(first) => part = first,
            None => return Ok(None),
        }
    }
    let Some(found) = worker.subtree(&part) else { return Ok(None) };
    if !half_way && (found.level, found.index) != (0, 0) {
        return Ok(None);
    }
    let mut stored = Stored { tree: *found.tree, flip: found.flip, proof, most: 0.0 };
    stored.most = stored.volume_within(&stored.root(), 3);
    Ok(Some(stored))
}

/// Returns a child of the root that identifies the tree, if all children belong to one tree.
fn first_of_one_tree<W: Worker>(worker: &W, children: &[Verdict<W::Part>; 8]) -> Option<W::Part> {
    let part = children.iter().find_map(|verdict| match verdict {
        Verdict::Partial(part) => Some(part),
        _ => None,
    })?;
    let first = worker.subtree(part)?;
    let root = first.tree.entry(0)?;
    let is_same = |(k, verdict): (u8, &Verdict<W::Part>)| {
        let Verdict::Partial(part) = verdict else {
            let tag = if first.flip { root.tag(k.into()).complement() } else { root.tag(k.into()) };
            return tag != Tag::Branch && tag == verdict.tag();
        };
        let Step::Into(index) = first.tree.step(0, 0, root, k.into()) else { return false };
        worker.subtree(part).is_some_and(|own| {
            (own.level, own.index, own.flip) == (1, index, first.flip) && core::ptr::eq(own.tree, first.tree)
        })
    };
    OCTANTS.into_iter().zip(children).all(is_same).then(|| part.clone())
}

/// The kind of a node's cell.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// A cell described by all of an element.
    Element,
    /// A cell described by an octant of an element.
    Octant(u8),
    Full,
    Partial,
}

/// A cell of a stored octree that is not EMPTY.
#[derive(Clone, Copy)]
struct Node {
    place: Place,
    /// The place of the description, if the cell is cut: element level and index.
    level: u8,
    kind: Kind,
    index: usize,
}

impl Node {
    fn is_cut(&self) -> bool {
        !matches!(self.kind, Kind::Full | Kind::Partial)
    }
}

/// The children of a cut cell, as bits.
struct Eight {
    planes: Planes,
    full: u8,
    partial: u8,
    cut: u8,
}

/// The cells of an element in the lower halves of their octants along each axis.
const LOWER: [u64; 3] = [0x5555_5555_5555_5555, 0x3333_3333_3333_3333, 0x0F0F_0F0F_0F0F_0F0F];

/// The cells in the upper half of an element along each axis.
const UPPER_HALF: [u64; 3] = [0xFF00_FF00_FF00_FF00, 0xFFFF_0000_FFFF_0000, 0xFFFF_FFFF_0000_0000];

/// Collects the low bits of the eight bytes.
fn low_bits(word: u64) -> u8 {
    (word.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u8
}

impl Stored<'_> {
    fn root(&self) -> Node {
        let depth = self.tree.frame().depth();
        let kind = if starts_half_way(depth) { Kind::Octant(0) } else { Kind::Element };
        Node { place: Place { at: [0; 3], log: depth }, level: 0, kind, index: 0 }
    }

    fn eight(&self, node: &Node) -> Eight {
        // (A missing entry is undecided.)
        let planes = self.tree.entry(node.index).unwrap_or(Planes::uniform(Tag::Partial));
        let planes = planes.complement_if(self.flip);
        match node.kind {
            Kind::Octant(octant) => {
                let (lower, upper) =
                    ((planes.lower >> (8 * octant)) as u8, (planes.upper >> (8 * octant)) as u8);
                Eight { planes, full: lower & upper, partial: !lower & upper, cut: lower & !upper }
            }
            _ => {
                let [empty, full, partial] = planes.octants().each(low_bits);
                Eight { planes, full, partial, cut: !(empty | full | partial) }
            }
        }
    }

    /// Returns a box around the non-EMPTY part of a node, in quarters of the node's edge, or halves.
    fn extent(&self, node: &Node) -> Extent {
        let planes = match node.kind {
            Kind::Element | Kind::Octant(_) => self.tree.entry(node.index),
            Kind::Full | Kind::Partial => None,
        };
        let Some(planes) = planes.map(|planes| planes.complement_if(self.flip)) else {
            return node.place.part([0; 3], [4; 3]);
        };
        let some = planes.lower | planes.upper;
        let (mut low, mut high) = ([0; 3], [4; 3]);
        for axis in 0..3 {
            // The occupied slabs across the axis, as bits.
            if let Kind::Octant(octant) = node.kind {
                let some = some >> (8 * octant) & 0xFF;
                let lower = LOWER[axis] & 0xFF;
                low[axis] = if some & lower == 0 { 2 } else { 0 };
                high[axis] = if some & !lower == 0 { 2 } else { 4 };
            } else {
                let lower = LOWER[axis];
                let upper_half = UPPER_HALF[axis];
                let slabs = u32::from(some & lower & !upper_half != 0)
                    | u32::from(some & !lower & !upper_half != 0) << 1
                    | u32::from(some & lower & upper_half != 0) << 2
                    | u32::from(some & !lower & upper_half != 0) << 3;
                low[axis] = slabs.trailing_zeros().min(3);
                high[axis] = (32 - slabs.leading_zeros()).max(low[axis] + 1);
            }
        }
        node.place.part(low, high)
    }

    /// Returns child `k` of a node. The child is not EMPTY.
    fn child(&self, node: &Node, eight: &Eight, k: u8) -> Node {
        let place = node.place.child(k);
        let settled = |kind| Node { place, kind, ..*node };
        if eight.full >> k & 1 != 0 {
            return settled(Kind::Full);
        }
        if eight.cut >> k & 1 == 0 {
            return settled(Kind::Partial);
        }
        let Kind::Octant(octant) = node.kind else { return settled(Kind::Octant(k)) };
        // (BRANCH is its own complement.)
        let cell = u32::from(8 * octant + k);
        match self.tree.step(node.level.into(), node.index, eight.planes, cell) {
            Step::Into(index) => Node { place, level: node.level + 1, kind: Kind::Element, index },
            Step::Settled(_) => settled(Kind::Partial),
        }
    }

    /// Returns an upper bound of the volume in a node, in finest cells. Only `levels` levels are visited.
    fn volume_within(&self, node: &Node, levels: u8) -> f64 {
        let edge = node.place.edge();
        if levels == 0 || !node.is_cut() {
            return edge * edge * edge;
        }
        let eight = self.eight(node);
        let some = eight.full | eight.partial | eight.cut;
        OCTANTS
            .into_iter()
            .filter(|k| some >> k & 1 != 0)
            .map(|k| self.volume_within(&self.child(node, &eight, k), levels - 1))
            .sum()
    }
}

/// Two cells that no axis has separated so far.
#[derive(Clone, Copy)]
struct Pair {
    a: Node,
    b: Node,
}

/// The number of ranks of pairs.
const RANKS: usize = 64;

/// The waiting pairs. A search leaves its memory to the next search.
pub(super) struct Waiting {
    /// The pairs by rank; within a rank the latest comes first.
    pairs: [Vec<Pair>; RANKS],
    /// The ranks in use, as bits.
    ranks: u64,
    count: usize,
}

impl Default for Waiting {
    fn default() -> Self {
        Waiting { pairs: [const { Vec::new() }; RANKS], ranks: 0, count: 0 }
    }
}

impl Waiting {
    fn clear(&mut self) {
        self.pairs.iter_mut().for_each(Vec::clear);
        (self.ranks, self.count) = (0, 0);
    }

    fn push(&mut self, rank: u32, pair: Pair) -> Result<(), Error> {
        memory::push(&mut self.pairs[rank as usize], pair)?;
        self.ranks |= 1 << rank;
        self.count += 1;
        Ok(())
    }

    fn pop(&mut self) -> Option<Pair> {
        let rank = self.ranks.checked_ilog2()?;
        let pairs = &mut self.pairs[rank as usize];
        let pair = pairs.pop();
        if pairs.is_empty() {
            self.ranks &= !(1 << rank);
        }
        self.count -= 1;
        pair
    }
}

/// Returns the rank of a pair whose boxes overlap by `depth`, as a share of their sizes, from 0 to about 2.
fn rank(depth: f32, steps: u32) -> u32 {
    // If depth had no price, the search would never leave a contact.
    let steep = (depth.max(0.0) * 32.0) as u32;
    (steep + 24).saturating_sub(steps).min(RANKS as u32 - 1)
}

/// Two stored octrees, the second of which is moved.
pub(super) struct Oriented<'t> {
    a: Stored<'t>,
    b: Stored<'t>,
}

/// A search under one placement.
struct Search<'s, 't> {
    solids: &'s Oriented<'t>,
    pose: Pose,
    waiting: &'s mut Waiting,
    splits: [u64; 2],
    /// The least edge of the visited cells in the first tree, as a power of two.
    least: u8,
    /// Whether there are cells that possibly overlap, without proof.
    doubt: bool,
    proof: Option<(Ball, Option<Cell>)>,
}

impl<'t> Oriented<'t> {
    pub(super) fn new(a: Stored<'t>, b: Stored<'t>) -> Self {
        Oriented { a, b }
    }

    /// Returns the interference of the two solids, with the second one placed.
    pub(super) fn interference(
        &self,
        placement: &Affine,
        waiting: &mut Waiting,
        control: &Control<'_>,
        job: &Job<'_>,
    ) -> Result<Interference, Error> {
        job.check()?;
        let pose = Pose::new(placement, self.a.tree.frame(), self.b.tree.frame());
        waiting.clear();
        let least = self.a.tree.frame().depth();
        let mut search =
            Search { solids: self, pose, waiting, splits: [0; 2], least, doubt: false, proof: None };
        search.run(control, job)?;
        Ok(search.found(placement))
    }
}

impl Search<'_, '_> {
    fn run(&mut self, control: &Control<'_>, job: &Job<'_>) -> Result<(), Error> {
        let budget = control.max_splits.unwrap_or(u64::MAX);
        let most = control.max_bytes.map_or(usize::MAX, |bytes| bytes as usize / size_of::<Pair>());
        let (a, b) = (self.solids.a.root(), self.solids.b.root());
        self.waiting.push(0, Pair { a, b })?;
        let mut steps = 0u64;
        while let Some(pair) = self.waiting.pop() {
            if steps == budget || self.waiting.count > most {
                self.doubt = true;
                break;
            }
            steps += 1;
            if steps.is_multiple_of(64) {
                job.check()?;
            }
            // Once there is doubt, PARTIAL cells add nothing.
            if self.doubt && [pair.a.kind, pair.b.kind].contains(&Kind::Partial) {
                continue;
            }
            self.split(&pair)?;
            if self.proof.is_some() {
                break;
            }
        }
        Ok(())
    }

    /// Splits the larger cell of a pair. It is a cut cell.
    fn split(&mut self, pair: &Pair) -> Result<(), Error> {
        let Pair { a, b } = pair;
        let of_a = a.is_cut() && (!b.is_cut() || self.pose.is_larger(&a.place, &b.place));
        let (node, stored) = if of_a { (a, &self.solids.a) } else { (b, &self.solids.b) };
        let other = if of_a { self.solids.b.extent(b) } else { self.solids.a.extent(a) };
        let eight = stored.eight(node);
        self.splits[usize::from(!of_a)] += 1;
        let mut some = eight.full | eight.cut;
        if !self.doubt {
            some |= eight.partial;
        }
        let (mut left, depths) = self.pose.overlapping(&node.place, of_a, &other, some);
        let log = self.solids.a.tree.frame().depth();
        while left != 0 {
            let k = left.trailing_zeros() as u8;
            left &= left - 1;
            let child = stored.child(node, &eight, k);
            let pair = if of_a { Pair { a: child, b: *b } } else { Pair { a: *a, b: child } };
            self.least = self.least.min(pair.a.place.log);
            if pair.a.is_cut() || pair.b.is_cut() {
                let steps = u32::from(log - pair.a.place.log);
                self.waiting.push(rank(depths[usize::from(k)], steps), pair)?;
            } else {
                self.decide(&pair);
                if self.proof.is_some() {
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// Decides a pair of cells, neither of which is cut.
    fn decide(&mut self, pair: &Pair) {
        let (a, b) = (&pair.a.place, &pair.b.place);
        if pair.a.kind == Kind::Full && pair.b.kind == Kind::Full {
            self.proof = self.pose.ball(a, b);
        }
        self.doubt |= self.proof.is_none() && !self.pose.is_apart(a, b);
    }

    fn found(&self, placement: &Affine) -> Interference {
        let (a, b) = (&self.solids.a, &self.solids.b);
        let frame = a.tree.frame();
        let (verdict, witness, ball) = match self.proof {
            // A cell that lies in both contains a ball.
            Some((_, Some(cell))) => {
                let ball = Ball::in_cell(&Cube { frame, cell }, [0.0; 3], 1.0);
                (Overlap::Overlapping, Some(cell), Some(ball))
            }
            Some((ball, None)) => (Overlap::Overlapping, None, Some(ball)),
            None if self.doubt => (Overlap::Undecided, None, None),
            None => (Overlap::Disjoint, None, None),
        };
        let most = if verdict == Overlap::Disjoint { 0.0 } else { self.pose.most(a.most, b.most) };
        let least = least_volume(frame, witness, ball);
        Interference {
            verdict,
            witness,
            ball,
            volume: Interval::between(least, most.max(least)),
            splits: self.splits,
            level: frame.depth() - self.least,
            proofs: [a.proof, b.proof.moved(placement.stretched(b.proof.displacement()))],
            clipped: false,
        }
    }
}
