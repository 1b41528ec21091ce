//! The borrowed view on which all reading code is written.

use super::brick::Bricks;
use super::tag::Tag;
use super::word::Planes;
use crate::error::Damage;
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
/// in a static or in a mapped file. Copying it copies a few pointers.
///
/// # How a solid is stored
///
/// The octree has **no leaves**. Only cells that are cut *and split* have a node, a node is eight 2-bit
/// [`Tag`]s, and one array entry, an *element*, carries two octree levels: the 64 grandchildren of a cell as
/// two words ([`Planes`]). Byte k of the two words is exactly the node of octant k, so nothing of the octree is
/// lost; a link is just never spent on every other level. (The leaf-free octree: Peng, Tang et al. 2000; the
/// nearest relatives are OctoMap's `.bt` stream and sparse 64-trees.)
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
/// A view may lie over bytes that nobody has checked. Reading is then still memory-safe, terminates, and
/// does bounded work; a damaged link or index reads as PARTIAL, or makes a bulk operation return
/// [`Error::Damaged`](crate::Error::Damaged). A flipped tag cannot be told from a true one that way: only the
/// checksums and [`check`](OctreeRef::check) find it. Also a [`Cursor`](crate::Cursor) that walks over all of an
/// unchecked tree meets no element twice.
#[derive(Debug, Clone, Copy, Yokeable)]
pub struct OctreeRef<'a> {
    pub(crate) frame: Frame,
    pub(crate) root: Tag,
    pub(crate) exterior: Tag,
    pub(crate) planes: &'a [Planes],
    pub(crate) rel: &'a [u16],
    pub(crate) base: &'a [u64],
    pub(crate) bricks: Bricks<'a>,
    /// `starts[e]`: index of the first element of element level e; `starts[levels]`: one past the last brick.
    pub(crate) starts: [usize; MAX_ELEMENT_LEVELS + 1],
    /// The stored level table, if there is one.
    pub(crate) table: Option<&'a [LevelCounts]>,
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

    /// The element or brick with this index.
    #[inline(always)]
    pub(crate) fn entry(&self, index: usize) -> Option<Planes> {
        match self.planes.get(index) {
            Some(&planes) => Some(planes),
            None => self.bricks.get(index - self.planes.len()),
        }
    }

    /// Index of the first child of element `n`, whether or not it has one: children are numbered through.
    #[inline(always)]
    pub(crate) fn first_child(&self, n: usize) -> Option<usize> {
        let base = *self.base.get(n >> 10)?;
        let rel = *self.rel.get(n)?;
        usize::try_from(base.checked_add(rel as u64)?).ok()
    }

    /// Index of the child in cell `c` of element `n`, whose BRANCH cells are `branch`. Nothing is known of it
    /// before it is compared with a level or a window: wild sums wrap, as they do in the point queries, so that
    /// all that follow single links agree also where these are damaged.
    #[inline(always)]
    pub(crate) fn child(&self, n: usize, branch: u64, c: u32) -> Option<usize> {
        let (base, rel) = (*self.base.get(n >> 10)?, *self.rel.get(n)?);
        let rank = (branch & ((1u64 << c) - 1)).count_ones() as usize;
        Some((base as usize).wrapping_add(rel as usize).wrapping_add(rank))
    }

    /// Where the children of the elements of level `e` from `n` on begin; `n` may be one past the level.
    pub(crate) fn children_from(&self, n: usize, e: usize) -> usize {
        let end = self.starts[e + 2];
        if n == self.starts[e + 1] {
            end
        } else {
            self.first_child(n).map_or(usize::MAX, |first| first.min(end))
        }
    }

    /// Whether `index` lies on element level `e`.
    #[inline(always)]
    pub(crate) fn on_level(&self, index: usize, e: usize) -> bool {
        self.starts[e] <= index && index < self.starts[e + 1]
    }
}

/// What a depth-first traversal has already passed, per level: how hostile bytes are kept from making it
/// visit anything twice.
///
/// In a sound tree a depth-first traversal meets the elements of each level in ascending order. So one index
/// per level, the first that has not been passed, decides in O(1) whether a link is admissible; all visits
/// together never exceed the number of elements.
#[derive(Clone)]
pub(crate) struct Windows {
    next: [usize; MAX_ELEMENT_LEVELS],
    end: [usize; MAX_ELEMENT_LEVELS],
}

impl Windows {
    /// All of a tree.
    pub(crate) fn new(tree: &OctreeRef<'_>) -> Windows {
        let mut windows = Windows { next: [0; MAX_ELEMENT_LEVELS], end: [0; MAX_ELEMENT_LEVELS] };
        windows.next.copy_from_slice(&tree.starts[..MAX_ELEMENT_LEVELS]);
        windows.end.copy_from_slice(&tree.starts[1..]);
        windows
    }

    /// Cuts off the windows of the subtree below element `index` of level `e`, which has been admitted, and
    /// passes it: what several threads visit below elements that were cut off one after another never overlaps.
    #[cfg(feature = "parallel")]
    pub(crate) fn below(&mut self, tree: &OctreeRef<'_>, e: usize, index: usize) -> Result<Windows, Damage> {
        let mut windows = self.clone();
        let (mut first, mut end) = (index, index + 1);
        for level in e..tree.levels() {
            if level > e {
                self.admit(index, level, first, end)?;
            }
            (windows.next[level], windows.end[level]) = (first, end);
            if level + 1 < tree.levels() {
                (first, end) = (tree.children_from(first, level), tree.children_from(end, level));
            }
        }
        Ok(windows)
    }

    /// Admits the range `first..end` of level `e` below element `parent`, and passes it.
    #[inline(always)]
    pub(crate) fn admit(&mut self, parent: usize, e: usize, first: usize, end: usize) -> Result<(), Damage> {
        if self.next[e] <= first && first <= end && end <= self.end[e] {
            self.next[e] = end;
            Ok(())
        } else {
            Err(Damage::Link { element: parent as u64 })
        }
    }

    /// The child of element `n` (BRANCH cells `branch`) in cell `c`, which lies on level `e`.
    #[inline(always)]
    pub(crate) fn child(
        &mut self,
        tree: &OctreeRef<'_>,
        n: usize,
        branch: u64,
        c: u32,
        e: usize,
    ) -> Result<usize, Damage> {
        let child = tree.child(n, branch, c).ok_or(Damage::Link { element: n as u64 })?;
        self.admit(n, e, child, child.saturating_add(1))?;
        Ok(child)
    }
}
