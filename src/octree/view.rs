//! The borrowed view on which all reading code is written.

use super::brick::Bricks;
use super::cuts::CutsRef;
use super::proof::Proof;
use super::tag::Tag;
use super::word::Planes;
use crate::lattice::{Frame, MAX_DEPTH};
use bytemuck::{Pod, Zeroable};
use yoke::Yokeable;

/// Number of element levels of the deepest tree.
pub(crate) const MAX_ELEMENT_LEVELS: usize = (MAX_DEPTH as usize).div_ceil(2);

/// Returns the number of element levels of a tree of `depth`: an element has two octree levels. The last
/// level consists of bricks.
pub(crate) const fn element_levels(depth: u8) -> usize {
    (depth as usize).div_ceil(2)
}

/// True if the universe is the first octant of the root element, and not the root element's own cell, because
/// a tree of odd depth starts half-way into it.
pub(crate) const fn starts_half_way(depth: u8) -> bool {
    !depth.is_multiple_of(2)
}

/// Returns the cells of the root element that belong to the universe.
pub(crate) const fn root_cells(depth: u8) -> u64 {
    if starts_half_way(depth) { 0xFF } else { !0 }
}

/// The counts of one octree level; the level table of a file is an array of these.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LevelCounts {
    /// Number of internal nodes of the level: its cells that are cut.
    pub nodes: u64,
    /// Number of FULL cells of the level.
    pub full: u64,
    /// Number of PARTIAL cells of the level.
    pub partial: u64,
}

/// A borrowed octree. All operations that only read are methods of this type, whether the arrays lie in a
/// `Vec`, in a static or in a mapped file. Copying it copies slices and indices, about three hundred bytes,
/// and no cells.
///
/// # How a solid is stored
///
/// The octree has **no leaves**. Only cells that are cut *and split* have a node, and a node is eight 2-bit
/// [`Tag`]s. One array entry, an *element*, contains two octree levels: the 64 grandchildren of a cell as two
/// words ([`Planes`]). Byte k of the two words is exactly the node of octant k, so the octree is stored
/// completely; only the links of every other level are saved. (The leaf-free octree: 改进的八叉树数据结构, 许胤龙 (Xu
/// Yinlong), 陈国良 (Chen Guoliang) and others, 计算机科学 27 (6), 2000; the nearest relatives are OctoMap's `.bt`
/// stream and sparse 64-trees.)
///
/// Elements are stored in level order: level by level, in Morton order within a level. So the children of an
/// element follow each other, a subtree is one contiguous range on each level, and a child is found by rank:
///
/// ```text
/// child(n, c) = base[n / 1024] + rel[n] + (branches of n before cell c)
/// ```
///
/// The deepest elements have no branches; they are *bricks* of 4³ cells, numbered after the elements. A
/// binary solid (nothing PARTIAL) needs only one of a brick's two words. A smooth surface has few distinct
/// bricks, so a file usually stores 16-bit indices into a dictionary of them.
///
/// In a tree of odd depth, the root element uses only its first octant, and its other cells are EMPTY. A
/// universe with a single tag has no element at all.
///
/// # Trust
///
/// A view may lie over unchecked bytes. Reading is then still memory-safe, terminates, and does bounded work.
/// A damaged link or index reads as PARTIAL, or makes a bulk operation return
/// [`Error::Damaged`](crate::Error::Damaged). A flipped tag cannot be distinguished from a true one in this
/// way: only the checksums and [`check`](OctreeRef::check) find it. A walk with a
/// [`Cursor`](crate::octree::Cursor) over a whole unchecked tree visits no element twice.
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
    /// True if all links are known to be sound: they were made here or checked, and no other code can change
    /// them.
    pub(crate) is_linked: bool,
    /// The surfaces that PARTIAL cells keep, if they keep any.
    pub(crate) cuts: Option<CutsRef<'a>>,
}

impl<'a> OctreeRef<'a> {
    /// Returns the frame of the tree.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Returns the tag of the whole universe; BRANCH if it is cut.
    pub fn root_tag(&self) -> Tag {
        self.root
    }

    /// Returns the tag of the space outside the universe: EMPTY if the solid is proven to end inside, FULL
    /// for the complement of such a solid, PARTIAL if the universe clips the solid.
    pub fn exterior(&self) -> Tag {
        self.exterior
    }

    /// True if the solid may extend beyond the universe.
    pub fn is_clipped(&self) -> bool {
        self.exterior == Tag::Partial
    }

    /// Returns the proof: which tags hold for the solid that the tree was made from.
    pub fn proof(&self) -> Proof {
        self.proof
    }

    /// Returns the same tree with another proof; see [`Octree::with_proof`](crate::Octree::with_proof).
    #[must_use]
    pub fn with_proof(&self, proof: Proof) -> OctreeRef<'a> {
        OctreeRef { proof, ..*self }
    }

    /// True if every cell is decided, that is, no cell is PARTIAL.
    pub fn is_binary(&self) -> bool {
        self.bricks.one_plane() && self.root != Tag::Partial
    }

    /// Returns the number of elements (two octree levels each), without bricks.
    pub fn element_count(&self) -> u64 {
        self.planes.len() as u64
    }

    /// Returns the number of bricks (elements of the deepest level).
    pub fn brick_count(&self) -> u64 {
        self.bricks.len() as u64
    }

    /// Returns the number of element levels, including bricks.
    #[inline(always)]
    pub(crate) fn levels(&self) -> usize {
        element_levels(self.frame.depth())
    }

    /// Returns the cells of the root element that belong to the universe.
    pub(crate) fn root_cells(&self) -> u64 {
        root_cells(self.frame.depth())
    }

    /// Returns the octree level of the cells that an element of element level `e` describes.
    pub(crate) fn cell_level(&self, e: usize) -> u8 {
        2 * (e as u8 + 1) - starts_half_way(self.frame.depth()) as u8
    }
}
