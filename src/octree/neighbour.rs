//! Neighbours of cells: the classical algorithm, up to the least common ancestor and down again.
//!
//! The coordinates of two cells determine their least common ancestor (Samet 1989, *Neighbor finding in
//! images represented by octrees*). The elements above the first cell are known from the way to it, so only
//! the way down is read.

use super::cells::{CellFilter, Cells, TaggedCell};
use super::cursor::Cursor;
use super::direction::Direction;
use super::links::Step;
use super::path::{Path, Place};
use super::tag::Tag;
use super::view::{OctreeRef, starts_half_way};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, morton};

/// A neighbour of a cell.
pub(super) struct Neighbour {
    pub found: TaggedCell,
    /// The place of the element that contains its children, if it is a BRANCH.
    pub place: Option<Place>,
}

impl<'a> OctreeRef<'a> {
    /// Returns the neighbour of `cell` in `direction`: the cell of the same size, or the larger leaf that
    /// contains it. `None` outside the universe. `path` leads to the cell.
    #[inline(always)]
    pub(super) fn neighbour(&self, path: &Path, cell: Cell, direction: Direction) -> Option<Neighbour> {
        let (level, steps) = (cell.level as usize, direction.steps());
        let mut at = [0; 3];
        let mut changed = 0;
        for axis in 0..3 {
            // Below 0, the coordinate wraps to a number beyond the last cell.
            at[axis] = cell.at[axis].wrapping_add_signed(steps[axis] as i32);
            changed |= at[axis] ^ cell.at[axis];
        }
        if changed >> level != 0 {
            return None;
        }
        let half = starts_half_way(self.frame.depth()) as usize;
        let above = 32 - changed.leading_zeros() as usize;
        let mut e = (level - above + half) / 2;
        let (mut index, mut planes) = path[e];
        loop {
            let cells = self.cell_level(e);
            let leaf = |level: u8, tag: Tag| {
                let cell = Cell { level: cell.level, at }.ancestor(level);
                Some(Neighbour { found: TaggedCell { cell, tag }, place: None })
            };
            if cell.level < cells {
                // One of the element's octants.
                let [x, y, z] = at;
                let tag = planes.octant(morton::index(2 * x, 2 * y, 2 * z) / 8);
                let place = Place { level: e, index, at: at.each(|a| a >> 1) };
                let place = (tag == Tag::Branch).then_some(place);
                return Some(Neighbour {
                    found: TaggedCell { cell: Cell { level: cell.level, at }, tag },
                    place,
                });
            }
            let shift = cell.level - cells;
            let c = morton::index(at[0] >> shift, at[1] >> shift, at[2] >> shift);
            let octant = planes.octant(c / 8);
            // The universe is cut, whatever damaged bytes say about its children.
            if octant != Tag::Branch && cells > 1 {
                return leaf(cells - 1, octant);
            }
            let child = match self.step(e, index, planes, c) {
                Step::Settled(tag) => return leaf(cells, tag),
                Step::Into(child) => child,
            };
            let Some(of_child) = self.entry(child) else { return leaf(cells, Tag::Partial) };
            if shift == 0 {
                let place = Place { level: e + 1, index: child, at };
                let found = TaggedCell { cell: Cell { level: cell.level, at }, tag: Tag::Branch };
                return Some(Neighbour { found, place: Some(place) });
            }
            (e, index, planes) = (e + 1, child, of_child);
        }
    }

    /// Returns the leaves with a tag in `filter` that lie in `cell`, whose element is at `place`, and touch
    /// its neighbour against `direction`. At most `visits` elements below are entered.
    pub(super) fn leaves_towards(
        &self,
        cell: Cell,
        place: Place,
        direction: Direction,
        filter: CellFilter,
        visits: usize,
    ) -> Cells<'a> {
        let shift = self.frame.depth() - cell.level;
        let mut min = cell.at.each(|a| a << shift);
        let mut max = cell.at.each(|a| (a + 1) << shift);
        for (axis, step) in direction.steps().into_iter().enumerate() {
            match step {
                1 => max[axis] = min[axis] + 1,
                -1 => min[axis] = max[axis] - 1,
                _ => {}
            }
        }
        Cells::below(self, place, filter.within(min, max), visits)
    }
}

impl<'a> Cursor<'a> {
    /// Returns the neighbour of the cursor's cell in `direction`, through a face, an edge or a vertex: the
    /// cell of the same size, which is a BRANCH if it is split, or the larger leaf that contains it. `None`
    /// outside the universe. The cursor stays where it is.
    ///
    /// O(depth), and amortised O(1) along a walk: only elements below the common ancestor are read.
    ///
    /// ```
    /// use leafless::{Cell, Control, Csg, Frame, Rule, Tag, build, octree::{Cursor, Direction}};
    /// let frame = Frame::new([0.0; 3], 4.0, 2)?;
    /// let bar = build(&Csg::cuboid([0.0; 3], [3.0, 1.0, 1.0])?, &frame, Rule::Certified, &Control::default())?;
    /// let mut cursor = Cursor::new(bar.view());
    /// cursor.seek(Cell { level: 2, at: [2, 0, 0] })?;
    /// let beside = |steps| cursor.neighbour(Direction::new(steps).unwrap());
    /// // The same size, and the larger cell above.
    /// assert_eq!(beside([1, 0, 0]).unwrap().tag, Tag::Empty);
    /// assert_eq!(beside([0, 0, 1]).unwrap().cell.level, 2);
    /// assert_eq!(beside([0, 0, -1]), None);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn neighbour(&self, direction: Direction) -> Option<TaggedCell> {
        self.tree().neighbour(self.path(), self.cell(), direction).map(|neighbour| neighbour.found)
    }

    /// Returns all leaves that touch the cursor's cell in `direction`: the one that
    /// [`neighbour`](Self::neighbour) returns or, if that is a BRANCH, the leaves in it that touch the cell's
    /// face, edge or vertex, in Morton order. There are none outside the universe. O(leaves · depth). Over
    /// damaged bytes, no element is visited twice.
    pub fn neighbours(&self, direction: Direction) -> impl Iterator<Item = TaggedCell> + use<'a> {
        let tree = self.tree();
        let neighbour = tree.neighbour(self.path(), self.cell(), direction);
        let within = neighbour.as_ref().and_then(|Neighbour { found, place }| {
            let leaves = CellFilter::leaves();
            place.map(|place| tree.leaves_towards(found.cell, place, direction, leaves, usize::MAX))
        });
        let alone = neighbour.filter(|neighbour| neighbour.place.is_none());
        alone.map(|neighbour| neighbour.found).into_iter().chain(within.into_iter().flatten())
    }

    /// Moves to `cell`, or to the leaf that contains it. Returns true if the cursor is on the cell itself.
    /// O(levels below the common ancestor of both cells).
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] if `cell` does not lie in the universe, or is finer than the finest cells. The
    /// cursor then stays where it is.
    pub fn seek(&mut self, cell: Cell) -> Result<bool, Error> {
        let cell = self.tree().checked(cell)?;
        self.rise_towards(cell);
        while self.cell().level < cell.level {
            let octant = cell.ancestor(self.cell().level + 1).octant();
            if !self.descend(octant) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
