//! The borrowed view on which all reading code is written.

use super::brick::Bricks;
use super::cuts::CutsRef;
use super::proof::Proof;
use super::tag::Tag;
use super::word::Planes;
use crate::lattice::{Frame, MAX_DEPTH};
use bytemuck::{Pod, Zeroable};
use yoke::Yokeable;

/// Element levels of the deepest tree.
pub(crate) const MAX_ELEMENT_LEVELS: usize = (MAX_DEPTH as usize).div_ceil(2);

/// Element levels of a tree of `depth`: two octree levels to an element. The last of them are bricks.
pub(crate) const fn element_levels(depth: u8) -> usize {
    (depth as usize).div_ceil(2)
}

/// Whether the universe is not the root element's own cell but its first octant, because a tree of odd depth
/// starts half-way into it.
pub(crate) const fn starts_half_way(depth: u8) -> bool {
    !depth.is_multiple_of(2)
}

/// The cells of the root element that belong to the universe.
pub(crate) const fn root_cells(depth: u8) -> u64 {
    if starts_half_way(depth) { 0xFF } else { !0 }
}

/// What is counted on one octree level; the level table of a file is an array of these.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LevelCounts {
    /// Internal nodes of the level: its cells that are cut.
    pub nodes: u64,
    /// FULL cells of the level.
    pub full: u64,
    /// PARTIAL cells of the level.
    pub partial: u64,
}

/// A borrowed octree: everything that only reads is a method of this type, whether the arrays lie in a `Vec`,
/// in a static or in a mapped file. Copying it copies slices and indices, some three hundred bytes, and no
/// cell.
///
/// # How a solid is stored
///
/// The octree has **no leaves**. Only cells that are cut *and split* have a node, a node is eight 2-bit
/// [`Tag`]s, and one array entry, an *element*, carries two octree levels: the 64 grandchildren of a cell as
/// two words ([`Planes`]). Byte k of the two words is exactly the node of octant k, so nothing of the octree
/// is lost; a link is just never spent on every other level. (The leaf-free octree: 改进的八叉树数据结构, 许胤龙 (Xu
/// Yinlong), 陈国良 (Chen Guoliang) and others, 计算机科学 27 (6), 2000; the nearest relatives are OctoMap's `.bt`
/// stream and sparse 64-trees.)
///
/// Elements lie in level order: level by level, in Morton order within a level. So the children of an
/// element follow each other, a subtree is one contiguous range per level, and a child is found by rank:
///
/// ```text
/// child(n, c) = base[n / 1024] + rel[n] + (branches of n before cell c)
/// ```
///
/// The deepest elements have no branches; they are *bricks* of 4³ cells, numbered on after the elements. A
/// binary solid (nothing PARTIAL) needs only one of a brick's two words, and few distinct bricks occur on a
/// smooth surface, so a file usually stores 16-bit indices into a dictionary of them.
///
/// Of an odd depth, the root element uses only its first octant and its other cells are EMPTY. A universe
/// that is all one tag has no element at all.
///
/// # Trust
///
/// A view may lie over bytes that nobody has checked. Reading is then still memory-safe, terminates, and does
/// bounded work; a damaged link or index reads as PARTIAL, or makes a bulk operation return
/// [`Error::Damaged`](crate::Error::Damaged). A flipped tag cannot be told from a true one that way: only the
/// checksums and [`check`](OctreeRef::check) find it. Also a [`Cursor`](crate::octree::Cursor) that walks
/// over all of an unchecked tree meets no element twice.
#[derive(Debug, Clone, Copy, Yokeable)]
pub struct OctreeRef<'a> {
    pub(crate) frame: Frame,
    pub(crate) root: Tag,
    pub(crate) exterior: Tag,
    pub(crate) proof: Proof,
    pub(crate) planes: &'a [Planes],
    pub(crate) rel: &'a [u16],
    pub(crate) base: &'a [u64],
    pub(crate) bricks: Bricks<'a>,
    /// `starts[e]`: index of the first element of element level e; `starts[levels]`: one past the last brick.
    pub(crate) starts: [usize; MAX_ELEMENT_LEVELS + 1],
    /// The stored level table, if there is one.
    pub(crate) table: Option<&'a [LevelCounts]>,
    /// Whether all links are known to be sound: they were made here or checked, and nobody else can change
    /// them.
    pub(crate) is_linked: bool,
    /// What PARTIAL cells keep of the surfaces that cross them, if they do.
    pub(crate) cuts: Option<CutsRef<'a>>,
}

impl<'a> OctreeRef<'a> {
    /// Where the tree lies.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The tag of the whole universe; BRANCH if it is cut.
    pub fn root_tag(&self) -> Tag {
        self.root
    }

    /// What is known of the space outside of the universe: EMPTY if the solid is proven to end inside, FULL
    /// for the complement of such a solid, PARTIAL if the universe clips the solid.
    pub fn exterior(&self) -> Tag {
        self.exterior
    }

    /// Whether the solid may go on outside of the universe.
    pub fn is_clipped(&self) -> bool {
        self.exterior == Tag::Partial
    }

    /// What the cells prove of the solid that the tree was made from.
    pub fn proof(&self) -> Proof {
        self.proof
    }

    /// The same tree, of whose cells this is said; see [`Octree::with_proof`](crate::Octree::with_proof).
    #[must_use]
    pub fn with_proof(&self, proof: Proof) -> OctreeRef<'a> {
        OctreeRef { proof, ..*self }
    }

    /// Whether every cell is decided: no PARTIAL anywhere.
    pub fn is_binary(&self) -> bool {
        self.bricks.one_plane() && self.root != Tag::Partial
    }

    /// Elements (two octree levels each, without bricks).
    pub fn element_count(&self) -> u64 {
        self.planes.len() as u64
    }

    /// Bricks (elements of the deepest level).
    pub fn brick_count(&self) -> u64 {
        self.bricks.len() as u64
    }

    /// Element levels, bricks included.
    #[inline(always)]
    pub(crate) fn levels(&self) -> usize {
        element_levels(self.frame.depth())
    }

    /// Cells of the root element that belong to the universe.
    pub(crate) fn root_cells(&self) -> u64 {
        root_cells(self.frame.depth())
    }

    /// Octree level of the cells that an element of element level `e` describes.
    pub(crate) fn cell_level(&self, e: usize) -> u8 {
        2 * (e as u8 + 1) - starts_half_way(self.frame.depth()) as u8
    }
}
