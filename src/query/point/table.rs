//! Point queries by a table of the first levels.

use super::Membership;
use super::descent::{Descend, Packed};
use crate::dispatch::with_popcount;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, morton};
use crate::memory;
use crate::octree::Tag;
use crate::octree::links::Step;
use crate::octree::view::OctreeRef;
use alloc::vec::Vec;
use yoke::Yokeable;

/// A point query with a table of all cells of one level, where most points are decided. For random points it
/// is about twice as fast as [`OctreeRef::contains`].
///
/// The table takes 4 · 8^level bytes: 1 MiB for level 6, 64 MiB for level 8. It belongs to the process and is
/// no part of the file.
///
/// ```
/// use leafless::{Control, Csg, Frame, Membership, Rule, build, query::PointTable};
/// let frame = Frame::new([-1.0; 3], 2.0, 10)?;
/// let ball = build(&Csg::ball([0.0; 3], 0.9)?, &frame, Rule::Certified, &Control::default())?;
/// let table = PointTable::new(ball.view(), 6)?;
/// assert_eq!((table.level(), table.contains([0.1, 0.2, 0.3])), (6, Membership::Inside));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Clone, Yokeable)]
pub struct PointTable<'a> {
    tree: OctreeRef<'a>,
    /// For each cell of the level, z slowest: the cell's tag, and for a BRANCH, two bits higher, the index of
    /// the element in the cell.
    entries: Vec<u32>,
    /// The level of the cells, and the level of the elements in them.
    level: u8,
    element_level: usize,
}

/// The finest level of a table.
const FINEST: u8 = 8;

impl<'a> PointTable<'a> {
    /// Builds a table of the cells of `level`, or of the next coarser level that the tree's arrays lead to.
    /// The arrays hold two levels each, and the deepest array holds the finest cells. A level beyond 8, or
    /// beyond the tree's depth, is reduced to these. Complexity: O(8^level).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn new(tree: &OctreeRef<'a>, level: u8) -> Result<PointTable<'a>, Error> {
        let is_coarse = |&e: &usize| tree.cell_level(e) <= level.min(FINEST);
        let above = (0..tree.levels()).rev().find(is_coarse).filter(|_| tree.root == Tag::Branch);
        let (element_level, level) = above.map_or((0, 0), |e| (e + 1, tree.cell_level(e)));
        let entries = memory::filled(1 << (3 * level), Tag::Partial as u32)?;
        let mut table = PointTable { tree: *tree, entries, level, element_level };
        match above {
            Some(_) => table.enter(0, 0, [0; 3]),
            // A BRANCH begins at the root element.
            None => table.entries[0] = tree.root as u32,
        }
        Ok(table)
    }

    /// The level of the table's cells.
    pub fn level(&self) -> u8 {
        self.level
    }

    /// Returns whether the solid contains a point, like [`OctreeRef::contains`].
    #[inline]
    pub fn contains(&self, point: [f64; 3]) -> Membership {
        let Some(at) = self.tree.frame.cell_of(point) else { return Membership::Undecided };
        match (self.locate(at), &self.tree.cuts) {
            (Tag::Partial, Some(cuts)) => self.tree.contains_by_cuts(cuts, point),
            (tag, _) => tag.into(),
        }
    }

    /// Returns the tag of a finest cell, like [`OctreeRef::tag_at`].
    #[inline]
    pub fn tag_at(&self, at: [u32; 3]) -> Tag {
        // The number of cells is a power of two, so one comparison tests all three coordinates.
        if at[0] | at[1] | at[2] >= self.tree.frame.cells() { Tag::Partial } else { self.locate(at) }
    }

    /// Answers many points at once, like [`OctreeRef::contains_many`].
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    pub fn contains_many(&self, points: &[[f64; 3]], answers: &mut [Membership]) -> Result<(), Error> {
        if points.len() != answers.len() {
            return Err(Error::Argument { name: "answers", problem: "must be as long as points" });
        }
        points.iter().zip(answers).for_each(|(&point, answer)| *answer = self.contains(point));
        Ok(())
    }

    /// Returns the tag of a finest cell of the universe.
    #[inline(always)]
    fn locate(&self, at: [u32; 3]) -> Tag {
        let below = self.tree.frame.depth() - self.level;
        let entry = self.entries.get(self.place(at.each(|a| a >> below))).copied();
        let entry = entry.unwrap_or(Tag::Partial as u32);
        match Tag::from_bits(entry & 1 != 0, entry & 2 != 0) {
            Tag::Branch => {
                let from = (entry as usize >> 2, self.element_level);
                with_popcount(Descend { tree: &self.tree, at: Packed::new(at), from })
            }
            tag => tag,
        }
    }

    /// The index of a cell's entry.
    #[inline(always)]
    fn place(&self, [x, y, z]: [u32; 3]) -> usize {
        (z as usize) << (2 * self.level) | (y as usize) << self.level | x as usize
    }

    /// Fills in the cells of element `index` of level `e`, whose own cell is `at`. Each entry is written at
    /// most once, whatever the bytes. The recursion is as deep as the table has element levels.
    fn enter(&mut self, e: usize, index: usize, at: [u32; 3]) {
        let Some(planes) = self.tree.entry(index) else { return };
        let mut cells = if e == 0 { self.tree.root_cells() } else { !0 };
        while cells != 0 {
            let c = cells.trailing_zeros();
            cells &= cells - 1;
            let [x, y, z] = morton::position(c);
            let at = [4 * at[0] + x, 4 * at[1] + y, 4 * at[2] + z];
            match self.tree.step(e, index, planes, c) {
                Step::Into(child) if e + 1 == self.element_level => {
                    // A sound tree has fewer elements on such levels. A greater index is damage.
                    let child = u32::try_from(child).ok().filter(|&child| child < 1 << 30);
                    let place = self.place(at);
                    self.entries[place] =
                        child.map_or(Tag::Partial as u32, |child| child << 2 | Tag::Branch as u32);
                }
                Step::Into(child) => self.enter(e + 1, child, at),
                Step::Settled(tag) => self.fill(Cell { level: self.tree.cell_level(e), at }, tag),
            }
        }
    }

    /// Writes a cell's tag to all of its entries.
    fn fill(&mut self, cell: Cell, tag: Tag) {
        let shift = self.level - cell.level;
        let [x, y, z] = cell.at.each(|a| a << shift);
        for z in z..z + (1 << shift) {
            for y in y..y + (1 << shift) {
                let place = self.place([x, y, z]);
                self.entries[place..place + (1 << shift)].fill(tag as u32);
            }
        }
    }
}
