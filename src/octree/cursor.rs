//! The octree as in the papers: node by node, eight 2-bit tags each.

use super::links::Step;
use super::path::{NOWHERE, Path};
use super::tag::Tag;
use super::view::{MAX_ELEMENT_LEVELS, OctreeRef, starts_half_way};
use super::word::Planes;
use crate::lattice::Cell;
use crate::lattice::Each;
use yoke::Yokeable;

/// An internal node of the leaf-free octree: the tags of a cell's eight children.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Node {
    /// Bit k: child k is surely solid.
    pub lower: u8,
    /// Bit k: child k is possibly solid.
    pub upper: u8,
}

impl Node {
    /// Returns the tag of child `octant` (0 to 7).
    pub const fn tag(self, octant: u8) -> Tag {
        Tag::from_bits(self.lower >> octant & 1 != 0, self.upper >> octant & 1 != 0)
    }

    /// Returns the eight tags in octant order.
    pub fn tags(self) -> [Tag; 8] {
        [0, 1, 2, 3, 4, 5, 6, 7].each(|octant| self.tag(octant))
    }

    /// Returns the node of an element's own cell, from the tags of its octants.
    fn of_octants(planes: Planes) -> Node {
        let mut node = Node { lower: 0, upper: 0 };
        for k in 0..8 {
            let tag = planes.octant(k);
            node.lower |= (tag.lower() as u8) << k;
            node.upper |= (tag.upper() as u8) << k;
        }
        node
    }

    /// Returns the node of octant `k` of an element.
    fn of_octant(planes: Planes, k: u32) -> Node {
        Node { lower: (planes.lower >> (8 * k)) as u8, upper: (planes.upper >> (8 * k)) as u8 }
    }
}

/// A position in an octree that moves along its links, one octree level at a step. It needs no allocation.
/// Octrees of even and of odd depth look the same through it.
///
/// Over unchecked bytes, a walk is bounded, too. In a sound tree the elements of a level ascend with their
/// cells in Morton order. A cursor compares each element that it enters with the last one of the level. A
/// link that violates this order leads nowhere, and its cell reads as PARTIAL. So a walk that takes the
/// octants of every cell in ascending order visits no element twice. (Whether a damaged link is noticed
/// depends on the earlier positions of the cursor.)
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, Tag, build, octree::Cursor};
/// let frame = Frame::new([0.0; 3], 1.0, 5)?;
/// let ball = build(&Csg::ball([0.5; 3], 0.4)?, &frame, Rule::Certified, &Control::default())?;
/// let mut cursor = Cursor::new(ball.view());
/// while cursor.tag() == Tag::Branch {
///     cursor.descend(0);
/// }
/// assert_eq!((cursor.tag(), cursor.cell().level), (Tag::Empty, 2));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Clone, Yokeable)]
pub struct Cursor<'a> {
    tree: OctreeRef<'a>,
    cell: Cell,
    tag: Tag,
    /// The octants from the universe to the cell, three bits each: the cell's place in Morton order.
    morton: u64,
    /// Elements from the root to the one that describes the current cell's children.
    path: Path,
    /// The last element that was entered on each level: the Morton index of its own cell, and its index.
    entered: [Option<(u64, usize)>; MAX_ELEMENT_LEVELS],
}

impl<'a> Cursor<'a> {
    /// Returns a cursor on the universe.
    pub fn new(tree: &OctreeRef<'a>) -> Cursor<'a> {
        let mut cursor = Cursor {
            tree: *tree,
            cell: Cell::ROOT,
            tag: tree.root,
            morton: 0,
            path: NOWHERE,
            entered: [None; MAX_ELEMENT_LEVELS],
        };
        if cursor.tag == Tag::Branch {
            cursor.enter(0, 0);
        }
        cursor
    }

    /// Returns the current cell.
    pub fn cell(&self) -> Cell {
        self.cell
    }

    /// Returns the tag of the current cell.
    pub fn tag(&self) -> Tag {
        self.tag
    }

    /// Returns the node of the current cell, if the cell is a BRANCH.
    pub fn node(&self) -> Option<Node> {
        (self.tag == Tag::Branch).then(|| match self.position(self.cell.level) {
            (e, None) => Node::of_octants(self.path[e].1),
            (e, Some(k)) => Node::of_octant(self.path[e].1, k),
        })
    }

    /// Moves to the child in `octant` (0 to 7) of a BRANCH. On any other cell, the cursor stays and returns
    /// `false`.
    pub fn descend(&mut self, octant: u8) -> bool {
        if self.tag != Tag::Branch || octant >= 8 {
            return false;
        }
        let (e, half) = self.position(self.cell.level);
        self.cell = self.cell.child(octant);
        self.morton = self.morton << 3 | octant as u64;
        let (n, planes) = self.path[e];
        match half {
            None => self.tag = planes.octant(octant as u32),
            Some(k) => match self.tree.step(e, n, planes, 8 * k + octant as u32) {
                Step::Into(child) => {
                    self.tag = Tag::Branch;
                    self.enter(e + 1, child);
                }
                Step::Settled(tag) => self.tag = tag,
            },
        }
        true
    }

    /// Moves to the parent. Returns `false` if the cursor is on the universe.
    pub fn ascend(&mut self) -> bool {
        if self.cell.level == 0 {
            return false;
        }
        self.cell = self.cell.parent();
        self.morton >>= 3;
        self.tag = Tag::Branch;
        true
    }

    /// Moves up to the nearest cell that contains `cell`, which lies in the universe.
    pub(super) fn rise_towards(&mut self, cell: Cell) {
        let shared = self.cell.level.min(cell.level);
        let (mine, other) = (self.cell.ancestor(shared).at, cell.ancestor(shared).at);
        let changed = (0..3).fold(0, |changed, axis| changed | (mine[axis] ^ other[axis]));
        let level = shared - (u32::BITS - changed.leading_zeros()) as u8;
        if level < self.cell.level {
            self.morton >>= 3 * (self.cell.level - level);
            self.cell = self.cell.ancestor(level);
            self.tag = Tag::Branch;
        }
    }

    pub(super) fn tree(&self) -> &OctreeRef<'a> {
        &self.tree
    }

    /// Returns the elements from the root to the one that contains the cell.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the place of the node of a cell at `level`: the element level, and the octant of the element
    /// unless the cell is the element's own.
    fn position(&self, level: u8) -> (usize, Option<u32>) {
        let padded = level as usize + starts_half_way(self.tree.frame.depth()) as usize;
        let k = if padded.is_multiple_of(2) {
            None
        } else if level == 0 {
            Some(0)
        } else {
            Some(self.cell.octant() as u32)
        };
        (padded / 2, k)
    }

    /// Enters the element `index` of level `e`, which describes the current cell, unless it is damaged or out
    /// of order.
    fn enter(&mut self, e: usize, index: usize) {
        let ordered =
            self.entered[e].is_none_or(|(morton, last)| self.morton.cmp(&morton) == index.cmp(&last));
        match self.tree.entry(index).filter(|_| ordered) {
            Some(planes) => {
                self.path[e] = (index, planes);
                self.entered[e] = Some((self.morton, index));
            }
            None => self.tag = Tag::Partial,
        }
    }
}
