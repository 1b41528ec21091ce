//! Following links: the one place where children are found.
//!
//! Unchecked bytes may contain any link, so the target of a link must be checked. There are two ways:
//!
//! * Single links are compared with the level that they should lead to ([`OctreeRef::step`]; [`Links`] for
//!   points, where every instruction counts). A descent then ends, because the level rises with each link.
//! * A traversal of a whole tree passes [`Windows`]: it does not visit an element twice.

use super::tag::Tag;
use super::view::{MAX_ELEMENT_LEVELS, OctreeRef};
use super::word::Planes;
use crate::error::Damage;
use core::ops::Range;

/// The content of a cell of an element.
pub(crate) enum Step {
    /// A cell that is not cut, or about which damage leaves nothing known.
    Settled(Tag),
    /// The element or brick with this index, on the next level.
    Into(usize),
}

/// Returns the child in cell `c` of an element whose BRANCH cells are `branch`: its rank is the number of
/// branches before the cell.
#[inline(always)]
fn nth_child(base: u64, rel: u16, branch: u64, c: u32) -> usize {
    let rank = (branch & ((1u64 << c) - 1)).count_ones() as usize;
    (base as usize).wrapping_add(rel as usize).wrapping_add(rank)
}

impl OctreeRef<'_> {
    /// Returns the element or brick with this index.
    #[inline(always)]
    pub(crate) fn entry(&self, index: usize) -> Option<Planes> {
        match self.planes.get(index) {
            Some(&planes) => Some(planes),
            None => self.bricks.get(index - self.planes.len()),
        }
    }

    /// Returns the index of the first child of element `n`, whether or not it has one: children are numbered
    /// consecutively.
    #[inline(always)]
    pub(crate) fn first_child(&self, n: usize) -> Option<usize> {
        let base = *self.base.get(n >> 10)?;
        let rel = *self.rel.get(n)?;
        usize::try_from(base.checked_add(rel as u64)?).ok()
    }

    /// Returns the index of the child in cell `c` of element `n`, whose BRANCH cells are `branch`. The caller
    /// must compare it with a level or a window. Invalid sums wrap, as they do in the point queries, so that
    /// all code that follows single links agrees even where the links are damaged.
    #[inline(always)]
    pub(crate) fn child(&self, n: usize, branch: u64, c: u32) -> Option<usize> {
        Some(nth_child(*self.base.get(n >> 10)?, *self.rel.get(n)?, branch, c))
    }

    /// Returns the index at which the children of the elements of level `e` from `n` on begin; `n` may be one
    /// past the level.
    pub(crate) fn children_from(&self, n: usize, e: usize) -> usize {
        let end = self.starts[e + 2];
        if n == self.starts[e + 1] {
            end
        } else {
            self.first_child(n).map_or(usize::MAX, |first| first.min(end))
        }
    }

    /// True if `index` lies on element level `e`.
    #[inline(always)]
    pub(crate) fn on_level(&self, index: usize, e: usize) -> bool {
        self.starts[e] <= index && index < self.starts[e + 1]
    }

    /// Returns the content of cell `c` of element `index` of level `e`, whose cells are `planes`.
    #[inline(always)]
    pub(crate) fn step(&self, e: usize, index: usize, planes: Planes, c: u32) -> Step {
        match planes.tag(c) {
            Tag::Branch => {
                let child = self.child(index, planes.branch(), c);
                let on_next = |&child: &usize| e + 1 < self.levels() && self.on_level(child, e + 1);
                child.filter(on_next).map_or(Step::Settled(Tag::Partial), Step::Into)
            }
            tag => Step::Settled(tag),
        }
    }
}

/// The arrays that a descent reads, cut to one length so that an index needs to be checked only once.
#[derive(Clone, Copy)]
pub(crate) struct Links<'a> {
    planes: &'a [Planes],
    rel: &'a [u16],
    base: &'a [u64],
}

impl<'a> Links<'a> {
    #[inline(always)]
    pub fn new(tree: &OctreeRef<'a>) -> Links<'a> {
        let count = tree.planes.len().min(tree.rel.len());
        Links { planes: &tree.planes[..count], rel: &tree.rel[..count], base: tree.base }
    }

    /// Returns the cells of element `index`; PARTIAL if there is no such element.
    #[inline(always)]
    pub fn planes(&self, index: usize) -> Planes {
        self.planes.get(index).copied().unwrap_or(Planes::uniform(Tag::Partial))
    }

    /// Returns the tag of cell `c` of element `index`, the child there, and whether the link leads to
    /// `level`, the children's range of indices. The child is meaningful only for a BRANCH whose link is
    /// sound.
    #[inline(always)]
    pub fn step(&self, index: usize, c: u32, level: &[usize]) -> (Tag, usize, bool) {
        let (Some(planes), Some(&rel), Some(&base)) =
            (self.planes.get(index), self.rel.get(index), self.base.get(index >> 10))
        else {
            return (Tag::Partial, 0, false);
        };
        let branch = planes.branch();
        // The range check catches an invalid sum.
        let child = nth_child(base, rel, branch, c);
        let sound = child.wrapping_sub(level[0]) < level[1] - level[0];
        (planes.tag(c), child, sound & (branch >> c & 1 != 0))
    }
}

/// Returns the index ranges of the element levels below the root, from the top.
#[inline(always)]
pub(crate) fn levels_below<'t>(tree: &'t OctreeRef<'_>) -> impl Iterator<Item = (u32, &'t [usize])> {
    let levels = tree.levels();
    let shifts = (1..levels as u32).rev().map(|below| 2 * below);
    shifts.zip(tree.starts[1..levels + 1].windows(2))
}

/// The elements that a depth-first traversal has passed, for each level, so that hostile bytes cannot make it
/// visit anything twice.
///
/// In a sound tree a depth-first traversal visits the elements of each level in ascending order. So one index
/// per level, the first one that has not been passed, decides in O(1) whether a link is admissible. All
/// visits together never exceed the number of elements.
#[derive(Clone)]
pub(crate) struct Windows {
    next: [usize; MAX_ELEMENT_LEVELS],
    end: [usize; MAX_ELEMENT_LEVELS],
}

impl Windows {
    /// Returns the windows of a whole tree.
    pub(crate) fn new(tree: &OctreeRef<'_>) -> Windows {
        let mut windows = Windows { next: [0; MAX_ELEMENT_LEVELS], end: [0; MAX_ELEMENT_LEVELS] };
        windows.next.copy_from_slice(&tree.starts[..MAX_ELEMENT_LEVELS]);
        windows.end.copy_from_slice(&tree.starts[1..]);
        windows
    }

    /// Splits off the windows of the subtrees below the admitted elements `range` of level `e`, and passes
    /// them. Several threads that visit the subtrees below ranges split off one after another never overlap.
    pub(crate) fn below(
        &mut self,
        tree: &OctreeRef<'_>,
        e: usize,
        range: Range<usize>,
    ) -> Result<Windows, Damage> {
        let mut windows = self.clone();
        let (mut first, mut end) = (range.start, range.end);
        for level in e..tree.levels() {
            if level > e {
                self.admit(range.start, level, first, end)?;
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

    /// Takes back the admission of element `first` of level `e` and of those behind it. They are admitted
    /// again when they are copied.
    pub(crate) fn put_back(&mut self, e: usize, first: usize) {
        self.next[e] = self.next[e].min(first);
    }

    /// Returns the child of element `n` (BRANCH cells `branch`) in cell `c`, which lies on level `e`.
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
