//! The descent of one point in a stored octree.

use crate::dispatch::{Hot, with_popcount};
use crate::octree::links::{Links, levels_below};
use crate::octree::view::OctreeRef;
use crate::octree::{Planes, Tag};

/// The coordinates of a finest cell side by side in one word. A few shifts give the cell's place in each
/// element on the path.
#[derive(Clone, Copy, Default)]
pub(super) struct Packed(u64);

/// The number of bits for a coordinate in a [`Packed`].
const FIELD: u32 = 21;

impl Packed {
    #[inline(always)]
    pub(super) fn new(at: [u32; 3]) -> Packed {
        Packed(at[0] as u64 | (at[1] as u64) << FIELD | (at[2] as u64) << (2 * FIELD))
    }

    /// The Morton index in the element whose cells have an edge of 2^shift.
    #[inline(always)]
    pub(super) fn cell(self, shift: u32) -> u32 {
        const FIELDS: u64 = 1 | 1 << FIELD | 1 << (2 * FIELD);
        let pairs = self.0 >> shift & (3 * FIELDS);
        // Move bits 0 and 1 of a field to 0 and 3, then interleave the fields.
        let spread = (pairs * 5) & (9 * FIELDS);
        (spread | spread >> (FIELD - 1) | spread >> (2 * FIELD - 2)) as u32 & 63
    }
}

/// The descent of one point from an element, on a level that has elements below it.
pub(super) struct Descend<'t, 'a> {
    pub(super) tree: &'t OctreeRef<'a>,
    pub(super) at: Packed,
    /// The element, and its level.
    pub(super) from: (usize, usize),
}

impl Descend<'_, '_> {
    /// Returns the tag of a finest cell of the universe.
    #[inline(always)]
    pub(super) fn from_root(tree: &OctreeRef<'_>, at: Packed) -> Tag {
        with_popcount(Descend { tree, at, from: (0, 0) })
    }
}

impl Hot for Descend<'_, '_> {
    type Output = Tag;

    #[inline(always)]
    fn run(self) -> Tag {
        let Descend { tree, at, from: (mut index, level) } = self;
        if tree.root != Tag::Branch {
            return tree.root;
        }
        let links = Links::new(tree);
        for (shift, level) in levels_below(tree).skip(level) {
            let (tag, child, goes_on) = links.step(index, at.cell(shift), level);
            if !goes_on {
                return settled(tag);
            }
            index = child;
        }
        settled(brick(tree, index).tag(at.cell(0)))
    }
}

/// Returns the brick with this index; damage reads as undecided.
#[inline(always)]
pub(super) fn brick(tree: &OctreeRef<'_>, index: usize) -> Planes {
    let brick = tree.bricks.get(index.wrapping_sub(tree.planes.len()));
    brick.unwrap_or(Planes::uniform(Tag::Partial))
}

/// Converts a branch without an element to undecided.
#[inline(always)]
pub(super) fn settled(tag: Tag) -> Tag {
    if tag == Tag::Branch { Tag::Partial } else { tag }
}
