//! The samples of an octree: its finest cells, inside or outside.

use crate::error::{Damage, Error};
use crate::lattice::Each;
use crate::lattice::morton;
use crate::octree::{OctreeRef, Tag};

/// A cell of the 64-ary tree of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Node {
    /// No sample in the node lies inside.
    Void,
    /// All samples in the node lie inside.
    Solid,
    /// An element or a brick.
    At(usize),
}

/// The sets of cells, among 64, that are wholly inside or wholly outside.
#[derive(Clone, Copy)]
pub(super) struct Sets {
    pub solid: u64,
    pub void: u64,
    /// The cells that contain an element, with its parent.
    branch: u64,
    parent: usize,
    /// Cells that are inside, but reach beyond the end of the samples.
    long: u64,
}

impl Sets {
    pub const VOID: Sets = Sets { solid: 0, void: !0, branch: 0, parent: 0, long: 0 };
    const SOLID: Sets = Sets { solid: !0, void: 0, branch: 0, parent: 0, long: 0 };
}

/// The samples of an octree. The lattice has 4^levels cells per axis, the smallest such number that suffices.
/// Everything around the universe is outside.
#[derive(Clone, Copy)]
pub(super) struct Samples<'a> {
    tree: OctreeRef<'a>,
    /// Whether PARTIAL cells count as inside.
    partial: bool,
    /// Samples per axis; everything beyond counts as outside.
    end: u32,
}

impl<'a> Samples<'a> {
    /// The finest cells of a tree as samples, limited to the first `end` on each axis.
    ///
    /// # Errors
    /// [`Error::Damaged`] if links of the tree are damaged.
    pub fn new(tree: &OctreeRef<'a>, partial: bool, end: u32) -> Result<Samples<'a>, Error> {
        // Elements are also visited as neighbours. With sound links each is visited as often as it has
        // neighbours.
        tree.ensure_links()?;
        Ok(Samples { tree: *tree, partial, end: end.min(tree.frame().cells()) })
    }

    /// The tree.
    pub(super) fn tree(&self) -> &OctreeRef<'a> {
        &self.tree
    }

    /// Returns whether PARTIAL cells count as inside.
    pub fn counts_partial(&self) -> bool {
        self.partial
    }

    /// Samples per axis.
    pub fn end(&self) -> u32 {
        self.end
    }

    /// Element levels.
    pub fn levels(&self) -> usize {
        self.tree.levels()
    }

    /// Blocks of 4³ samples per axis of the lattice.
    pub fn blocks(&self) -> i32 {
        1 << (2 * (self.levels() - 1))
    }

    /// The root of the lattice.
    pub fn root(&self) -> Node {
        match self.tree.root_tag() {
            Tag::Empty => Node::Void,
            Tag::Full => Node::Solid,
            Tag::Partial if self.partial => Node::Solid,
            Tag::Partial => Node::Void,
            Tag::Branch => Node::At(0),
        }
    }

    /// Returns the sets of a node of element level `e` at this place, measured in nodes of that level.
    #[inline(always)]
    pub fn sets(&self, e: usize, node: Node, at: [i32; 3]) -> Result<Sets, Error> {
        let mut sets = match node {
            Node::Void => return Ok(Sets::VOID),
            Node::Solid => Sets::SOLID,
            Node::At(index) => {
                let damage =
                    || Damage::Dictionary { brick: index.saturating_sub(self.tree.planes.len()) as u64 };
                let mut planes = self.tree.entry(index).ok_or_else(damage)?;
                if e == 0 {
                    planes = planes.masked(self.tree.root_cells());
                }
                let branch = if e + 1 < self.levels() { planes.branch() } else { 0 };
                let solid = if self.partial { planes.upper } else { planes.full() };
                Sets { solid, void: !(solid | branch), branch, parent: index, long: 0 }
            }
        };
        let size = 1i64 << (2 * (self.levels() - 1 - e));
        let last = at.each(|a| 4 * i64::from(a) + 4);
        if last.iter().any(|last| last * size > i64::from(self.end)) {
            self.cut(&mut sets, last, size);
        }
        Ok(sets)
    }

    /// Cuts off the cells beyond the end.
    #[cold]
    fn cut(&self, sets: &mut Sets, last: [i64; 3], size: i64) {
        let end = i64::from(self.end);
        let (mut beyond, mut across) = (0, 0);
        for axis in 0..3 {
            for k in 0..4 {
                let low = (last[axis] - 4 + k) * size;
                let slab = morton::SLAB[axis][k as usize];
                beyond |= if low >= end { slab } else { 0 };
                across |= if low < end && end < low + size { slab } else { 0 };
            }
        }
        sets.long = sets.solid & across & !beyond;
        sets.solid &= !(across | beyond);
        sets.void |= beyond;
    }

    /// Returns the content of cell `c` of a node whose cells are `sets`.
    #[inline(always)]
    pub fn child(&self, sets: &Sets, c: u32) -> Result<Node, Error> {
        if sets.void >> c & 1 != 0 {
            Ok(Node::Void)
        } else if (sets.solid | sets.long) >> c & 1 != 0 {
            Ok(Node::Solid)
        } else {
            let child = self.tree.child(sets.parent, sets.branch, c);
            Ok(Node::At(child.ok_or(Damage::Link { element: sets.parent as u64 })?))
        }
    }
}
