//! Point queries for points that lie near each other.

use super::Membership;
use super::cuts::DescendCuts;
use super::descent::{Packed, brick, settled};
use crate::dispatch::{Hot, with_popcount};
use crate::octree::cuts::CutsRef;
use crate::octree::links::{Links, levels_below};
use crate::octree::view::{MAX_ELEMENT_LEVELS, OctreeRef};
use crate::octree::{Planes, Tag};
use yoke::Yokeable;

/// A point query that remembers the path to the last answer. It is made for points that lie near each other,
/// such as along a line or in scan order. A point in the same element as the last one costs no memory access.
#[derive(Clone, Yokeable)]
pub struct PointCursor<'a> {
    tree: OctreeRef<'a>,
    /// A cell in the element that gave the last answer. Initially it lies outside of any universe.
    last: [u32; 3],
    /// Elements on the path to `last`, valid up to level `reached`.
    path: [usize; MAX_ELEMENT_LEVELS],
    reached: usize,
    /// The cells of the element that gave the last answer, and the binary logarithm of their edge.
    planes: Planes,
    shift: u32,
}

impl<'a> PointCursor<'a> {
    /// Builds a cursor without a last answer.
    pub fn new(tree: &OctreeRef<'a>) -> PointCursor<'a> {
        PointCursor {
            tree: *tree,
            last: [u32::MAX; 3],
            path: [0; MAX_ELEMENT_LEVELS],
            reached: 0,
            planes: Planes::uniform(Tag::Branch),
            shift: 0,
        }
    }

    /// Returns whether the solid contains a point, like [`OctreeRef::contains`].
    #[inline]
    pub fn contains(&mut self, point: [f64; 3]) -> Membership {
        let Some(at) = self.tree.frame.cell_of(point) else { return Membership::Undecided };
        match (self.locate(at), &self.tree.cuts) {
            (Tag::Partial, Some(cuts)) => self.decide(cuts, point, at),
            (tag, _) => tag.into(),
        }
    }

    /// Returns the tag of a finest cell, like [`OctreeRef::tag_at`].
    #[inline]
    pub fn tag_at(&mut self, at: [u32; 3]) -> Tag {
        // The number of cells is a power of two, so one comparison tests all three coordinates.
        if at[0] | at[1] | at[2] >= self.tree.frame.cells() { Tag::Partial } else { self.locate(at) }
    }

    /// Returns the tag of a finest cell of the universe.
    #[inline]
    fn locate(&mut self, at: [u32; 3]) -> Tag {
        let changed = self.changed(at);
        // Two bits a level.
        if changed >> (self.shift + 2) == 0 {
            let tag = self.planes.tag(Packed::new(at).cell(self.shift));
            if tag != Tag::Branch {
                return tag;
            }
        }
        with_popcount(Move { cursor: self, at, changed })
    }

    /// Returns the answer of the cut of the PARTIAL cell that was just located.
    fn decide(&self, cuts: &CutsRef<'_>, point: [f64; 3], at: [u32; 3]) -> Membership {
        let index = self.path[self.reached];
        let way = DescendCuts { tree: &self.tree, cuts, point, at, from: (0, 0) };
        // (A damaged link leads to no PARTIAL cell.)
        let c = Packed::new(at).cell(self.shift);
        if self.tree.root == Tag::Branch && self.planes.tag(c) == Tag::Partial {
            way.settled(Tag::Partial, index, self.planes, c, self.shift)
        } else {
            way.run()
        }
    }

    /// The bits in which coordinates differ from those of the last cell.
    #[inline(always)]
    fn changed(&self, at: [u32; 3]) -> u32 {
        (at[0] ^ self.last[0]) | (at[1] ^ self.last[1]) | (at[2] ^ self.last[2])
    }
}

/// A move into another element.
struct Move<'c, 'a> {
    cursor: &'c mut PointCursor<'a>,
    at: [u32; 3],
    changed: u32,
}

impl Hot for Move<'_, '_> {
    type Output = Tag;

    #[inline(always)]
    fn run(self) -> Tag {
        let Move { cursor, at, changed } = self;
        let tree = cursor.tree;
        if tree.root != Tag::Branch {
            return tree.root;
        }
        // Elements above the highest changed bit are on both paths.
        let highest = (31 - (changed | 1).leading_zeros()) as usize / 2;
        let mut e = (tree.levels() - 1).saturating_sub(highest).min(cursor.reached);
        cursor.last = at;
        let at = Packed::new(at);
        let links = Links::new(&tree);
        for (shift, level) in levels_below(&tree).skip(e) {
            let (tag, child, goes_on) = links.step(cursor.path[e], at.cell(shift), level);
            if !goes_on {
                cursor.reached = e;
                cursor.shift = shift;
                cursor.planes = links.planes(cursor.path[e]);
                return settled(tag);
            }
            e += 1;
            cursor.path[e] = child;
        }
        cursor.reached = e;
        cursor.shift = 0;
        cursor.planes = brick(&tree, cursor.path[e]);
        settled(cursor.planes.tag(at.cell(0)))
    }
}
