//! The path of a ray through the elements of a stored octree.

use crate::lattice::morton;
use crate::octree::links::Step;
use crate::octree::view::{MAX_ELEMENT_LEVELS, OctreeRef};
use crate::octree::{Planes, Tag};

/// The elements from the root down to a cell. The common part with the previous cell's path is not looked up
/// again.
pub(super) struct Way<'t, 'a> {
    pub(super) tree: &'t OctreeRef<'a>,
    /// A finest cell in the last element.
    place: [u32; 4],
    /// The level of the last element.
    last: usize,
    elements: [usize; MAX_ELEMENT_LEVELS],
    /// The cells of the last element.
    pub(super) planes: Planes,
}

impl<'t, 'a> Way<'t, 'a> {
    /// Starts at the root.
    #[inline(always)]
    pub(super) fn new(tree: &'t OctreeRef<'a>) -> Way<'t, 'a> {
        let planes = tree.entry(0).unwrap_or(Planes::uniform(Tag::Partial));
        Way { tree, place: [0; 4], last: 0, elements: [0; MAX_ELEMENT_LEVELS], planes }
    }

    /// The last element.
    #[inline(always)]
    pub(super) fn element(&self) -> usize {
        self.elements[self.last]
    }

    /// Goes down to the cell that contains a finest cell. Returns the cell's tag, the binary logarithm of its
    /// edge, and its place in the last element.
    #[inline(always)]
    pub(super) fn to(&mut self, place: [u32; 4]) -> (Tag, u32, u32) {
        let tree = self.tree;
        if tree.root != Tag::Branch {
            return (tree.root, tree.frame.depth() as u32, 0);
        }
        let levels = tree.levels();
        let changed = (place[0] ^ self.place[0]) | (place[1] ^ self.place[1]) | (place[2] ^ self.place[2]);
        self.place = place;
        let shared = levels - 1 - (31 - (changed | 1).leading_zeros()) as usize / 2;
        if shared < self.last {
            self.last = shared;
            self.planes = tree.entry(self.elements[shared]).unwrap_or(Planes::uniform(Tag::Partial));
        }
        loop {
            let shift = 2 * (levels - 1 - self.last) as u32;
            let c = morton::index(place[0] >> shift, place[1] >> shift, place[2] >> shift);
            match tree.step(self.last, self.elements[self.last], self.planes, c) {
                Step::Into(child) => {
                    self.last += 1;
                    self.elements[self.last] = child;
                    self.planes = tree.entry(child).unwrap_or(Planes::uniform(Tag::Partial));
                }
                Step::Settled(tag) => return (tag, shift, c),
            }
        }
    }
}
