//! The nodes of a lazy octree.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame, MAX_DEPTH};
use crate::octree::view::LevelCounts;
use crate::octree::{Node, Proof, Statistics, Tag};
use crate::solid::{
    Classifier, FreeParts, OCTANTS, OneByOne, Question, Solid, Verdict, WholeQuestion, Worker,
};
use alloc::vec::Vec;

/// The known tags of the eight children of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Children {
    node: Node,
    /// Bit k: child k is PARTIAL, and splitting it does not help.
    hopeless: u8,
}

impl Children {
    /// The children with the verdicts of a solid, none of them split yet.
    pub(super) fn new<P>(verdicts: &[Verdict<P>; 8]) -> Children {
        let mut children = Children { node: Node { lower: 0, upper: 0 }, hopeless: 0 };
        for (octant, verdict) in (0..8).zip(verdicts) {
            children.set(octant, verdict.tag(), matches!(verdict, Verdict::Undecided));
        }
        children
    }

    fn set(&mut self, octant: u8, tag: Tag, hopeless: bool) {
        let put = |bits: u8, bit: bool| bits & !(1 << octant) | (bit as u8) << octant;
        self.node.lower = put(self.node.lower, tag.lower());
        self.node.upper = put(self.node.upper, tag.upper());
        self.hopeless = put(self.hopeless, hopeless);
    }

    fn is_hopeless(&self, octant: u8) -> bool {
        self.hopeless >> octant & 1 != 0
    }

    /// The common tag of all eight children, if nothing more can be found out about any of them.
    fn merged(&self) -> Option<Tag> {
        match (self.node.lower, self.node.upper, self.hopeless) {
            (0, 0, _) => Some(Tag::Empty),
            (0xFF, 0xFF, _) => Some(Tag::Full),
            (0, 0xFF, 0xFF) => Some(Tag::Partial),
            _ => None,
        }
    }

    fn is_branching(&self) -> bool {
        self.node.lower & !self.node.upper != 0
    }

    /// The numbers of FULL and of PARTIAL children.
    fn counts(&self) -> (u64, u64) {
        let Node { lower, upper } = self.node;
        ((lower & upper).count_ones().into(), (!lower & upper).count_ones().into())
    }

    /// The tags in octant order.
    pub(super) fn tags(&self) -> [Tag; 8] {
        self.node.tags()
    }
}

/// A cell that was split.
#[derive(Debug, Clone, Copy)]
struct Split {
    children: Children,
    /// Block that describes the split children, or `NONE`.
    block: u32,
}

/// No block.
const NONE: u32 = u32::MAX;

impl Split {
    const UNUSED: Split =
        Split { children: Children { node: Node { lower: 0, upper: 0 }, hopeless: 0 }, block: NONE };
}

/// The address of a cell: a child of a split.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    split: usize,
    octant: u8,
}

/// The split cells of an octree, eight siblings to a block, for changing it in place.
///
/// A block exists as long as one of its eight cells is split. Unused blocks form a list and are reused before
/// new blocks are allocated.
pub(super) struct Nodes {
    frame: Frame,
    pub(super) exterior: Tag,
    pub(super) proof: Proof,
    /// Block b is `splits[8 * b..8 * b + 8]`. The universe is child 0 of the first of block 0.
    splits: Vec<Split>,
    /// First block of the list of unused blocks. The first split of each unused block names the next block.
    unused: u32,
    blocks: usize,
    counts: [LevelCounts; MAX_DEPTH as usize + 1],
}

impl Nodes {
    /// Bytes of a block.
    pub(super) const BLOCK: u64 = 8 * size_of::<Split>() as u64;

    /// The universe.
    pub(super) const ROOT: Place = Place { split: 0, octant: 0 };

    /// Creates an octree with the given verdict on the universe and no splits.
    pub(super) fn new<P>(
        frame: Frame,
        root: &Verdict<P>,
        exterior: Tag,
        proof: Proof,
    ) -> Result<Nodes, Error> {
        let counts = [LevelCounts::default(); MAX_DEPTH as usize + 1];
        let mut nodes = Nodes { frame, exterior, proof, splits: Vec::new(), unused: NONE, blocks: 0, counts };
        nodes.take_block()?;
        nodes.splits[0].children.set(0, root.tag(), matches!(root, Verdict::Undecided));
        nodes.counts[0].full = (root.tag() == Tag::Full) as u64;
        nodes.counts[0].partial = (root.tag() == Tag::Partial) as u64;
        Ok(nodes)
    }

    pub(super) fn frame(&self) -> &Frame {
        &self.frame
    }

    pub(super) fn tag(&self, place: Place) -> Tag {
        self.splits[place.split].children.node.tag(place.octant)
    }

    /// Returns whether splitting a PARTIAL cell is known not to help.
    pub(super) fn is_hopeless(&self, place: Place) -> bool {
        self.splits[place.split].children.is_hopeless(place.octant)
    }

    /// Returns a child of a BRANCH.
    pub(super) fn child(&self, place: Place, octant: u8) -> Place {
        Place { split: self.own(place), octant }
    }

    /// Returns the index of the split of a BRANCH.
    fn own(&self, place: Place) -> usize {
        8 * self.splits[place.split].block as usize + place.octant as usize
    }

    /// Returns the children of a BRANCH.
    pub(super) fn children(&self, place: Place) -> Children {
        self.splits[self.own(place)].children
    }

    /// Returns the places from the universe towards `cell`, and the level of the last place: `cell` itself,
    /// or the last cell that is no BRANCH.
    pub(super) fn way(&self, cell: Cell) -> ([Place; MAX_DEPTH as usize + 1], u8) {
        let mut way = [Nodes::ROOT; MAX_DEPTH as usize + 1];
        for level in 0..cell.level {
            let place = way[level as usize];
            if self.tag(place) != Tag::Branch {
                return (way, level);
            }
            way[level as usize + 1] = self.child(place, cell.ancestor(level + 1).octant());
        }
        (way, cell.level)
    }

    /// Makes a PARTIAL cell of `level` a BRANCH with these children. If the children agree, the cell takes
    /// their tag.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`]; then nothing has changed.
    pub(super) fn open(&mut self, place: Place, level: u8, children: Children) -> Result<(), Error> {
        if let Some(tag) = children.merged() {
            self.count(level, Tag::Partial, -1);
            self.count(level, tag, 1);
            self.splits[place.split].children.set(place.octant, tag, tag == Tag::Partial);
            return Ok(());
        }
        if self.splits[place.split].block == NONE {
            self.splits[place.split].block = self.take_block()?;
        }
        self.count(level, Tag::Partial, -1);
        self.splits[place.split].children.set(place.octant, Tag::Branch, false);
        let own = self.own(place);
        self.splits[own] = Split { children, block: NONE };
        self.count(level, Tag::Branch, 1);
        let (full, partial) = children.counts();
        self.counts[level as usize + 1].full += full;
        self.counts[level as usize + 1].partial += partial;
        Ok(())
    }

    /// Merges the children of a cell of `level`, if it is a BRANCH and they agree.
    pub(super) fn merge(&mut self, place: Place, level: u8) {
        if self.tag(place) != Tag::Branch {
            return;
        }
        let children = self.children(place);
        let Some(tag) = children.merged() else { return };
        let (full, partial) = children.counts();
        self.counts[level as usize + 1].full -= full;
        self.counts[level as usize + 1].partial -= partial;
        self.count(level, Tag::Branch, -1);
        self.count(level, tag, 1);
        let parent = &mut self.splits[place.split];
        parent.children.set(place.octant, tag, tag == Tag::Partial);
        if !parent.children.is_branching() {
            let block = core::mem::replace(&mut parent.block, NONE);
            self.splits[8 * block as usize].block = core::mem::replace(&mut self.unused, block);
            self.blocks -= 1;
        }
    }

    /// Records that splitting a PARTIAL cell does not help.
    pub(super) fn give_up(&mut self, place: Place) {
        self.splits[place.split].children.set(place.octant, Tag::Partial, true);
    }

    /// Marks every PARTIAL cell as one that may be split.
    pub(super) fn forget_hopeless(&mut self) {
        self.splits.iter_mut().for_each(|split| split.children.hopeless = 0);
    }

    fn count(&mut self, level: u8, tag: Tag, change: i64) {
        let counts = &mut self.counts[level as usize];
        let of = match tag {
            Tag::Empty => return,
            Tag::Branch => &mut counts.nodes,
            Tag::Partial => &mut counts.partial,
            Tag::Full => &mut counts.full,
        };
        *of = of.wrapping_add_signed(change);
    }

    /// Takes an unused block. Existing blocks do not move when a block is taken.
    fn take_block(&mut self) -> Result<u32, Error> {
        let block = match self.unused {
            NONE => {
                let block = u32::try_from(self.splits.len() / 8).ok().filter(|&block| block != NONE);
                let block = block.ok_or(Error::OutOfMemory)?;
                self.splits.try_reserve(8)?;
                self.splits.extend([Split::UNUSED; 8]);
                block
            }
            block => {
                self.unused = self.splits[8 * block as usize].block;
                self.splits[8 * block as usize].block = NONE;
                block
            }
        };
        self.blocks += 1;
        Ok(block)
    }

    /// The memory of the blocks in bytes.
    pub(super) fn bytes(&self) -> u64 {
        self.blocks as u64 * Nodes::BLOCK
    }

    /// The number of cells that are split and not merged.
    pub(super) fn count_nodes(&self) -> u64 {
        self.counts.iter().map(|level| level.nodes).sum()
    }

    /// Returns whether a cell of `level` is PARTIAL.
    pub(super) fn is_undecided_at(&self, level: u8) -> bool {
        self.counts[level as usize].partial > 0
    }

    pub(super) fn statistics(&self) -> Statistics {
        Statistics::new(&self.frame, &self.counts[..=self.frame.depth() as usize])
    }
}

/// The known part of the octree as a solid: unsplit cells stay undecided.
impl<'n> Solid for &'n Nodes {
    type Classifier = &'n Nodes;

    fn on(&self, _: &Frame, _: &Control<'_>) -> Result<&'n Nodes, Error> {
        Ok(self)
    }
}

impl Classifier for &Nodes {
    type Worker = Self;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<Self, Error> {
        Ok(self)
    }

    fn exterior(&self) -> Tag {
        self.exterior
    }

    fn proof(&self) -> Proof {
        self.proof
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl FreeParts for &Nodes {
    type Part = usize;
}

impl OneByOne for &Nodes {}

impl Worker for &Nodes {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<usize>, Error> {
        Ok(self.verdict(Nodes::ROOT))
    }

    fn split(&mut self, _: Cell, part: &usize) -> Result<[Verdict<usize>; 8], Error> {
        Ok(OCTANTS.each(|octant| self.verdict(Place { split: *part, octant })))
    }

    fn answer(&mut self, _: Cell, _: &usize, _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl Nodes {
    fn verdict(&self, place: Place) -> Verdict<usize> {
        match self.tag(place) {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Partial => Verdict::Undecided,
            Tag::Branch => Verdict::Partial(self.own(place)),
        }
    }
}
