//! The cells of a stored octree that are nearest to a point.

use super::place::{Place, Square};
use super::walk::{Visitor, walk};
use crate::error::Error;
use crate::lattice::{Cell, Interval, MAX_DEPTH};
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Planes, Tag, TaggedCell};
use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Ordering;

/// A cell near a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearCell {
    /// The cell and its tag.
    pub found: TaggedCell,
    /// The cell's point nearest to the given point, in model units: each coordinate is the given point's own,
    /// or a rounded coordinate of the cell's faces.
    pub point: [f64; 3],
    /// The distance of the closed cell from the given point, rounded outward.
    pub distance: Interval,
}

impl OctreeRef<'_> {
    /// Returns the `count` cells nearest to `point` (model units) whose tag is among `tags`, the nearest
    /// first. Equally near cells come in Morton order. The result is shorter if the tree has fewer such
    /// cells. A cell is closed, as large as the octree stores it, and never a BRANCH. The point may lie
    /// outside of the universe.
    ///
    /// With `count` 1 and the tag FULL, the result is the nearest cell that is proven solid. With EMPTY and
    /// PARTIAL, it is the nearest cell that is not.
    ///
    /// Cells are compared by their exact distance from a point next to the given one. Its distance from the
    /// given point is at most 2^-56 of the universe's edge or, far outside, 2^-57 of the distance.
    ///
    /// Complexity: O(count · log count) in addition to the visited cells. Whatever the bytes, the search
    /// visits no more cells than the tree has.
    ///
    /// # Errors
    /// [`Error::Argument`] if a coordinate is not a finite number; [`Error::OutOfMemory`].
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, Tag, build};
    /// let frame = Frame::new([0.0; 3], 4.0, 2)?;
    /// let bar = build(&Csg::cuboid([0.0; 3], [3.0, 1.0, 1.0])?, &frame, Rule::Certified, &Control::default())?;
    /// let near = bar.view().nearest_cells([2.5, 0.5, 3.0], &[Tag::Full], 2)?;
    /// assert_eq!((near[0].found.cell.at, near[0].point), ([2, 0, 0], [2.5, 0.5, 1.0]));
    /// assert_eq!((near[1].found.cell.at, near[0].distance.lower), ([1, 0, 0], 2.0));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn nearest_cells(&self, point: [f64; 3], tags: &[Tag], count: usize) -> Result<Vec<NearCell>, Error> {
        let place = Place::new(&self.frame, point)
            .ok_or(Error::Argument { name: "point", problem: "every coordinate must be a finite number" })?;
        let mut kept = Kept { tags, count, cells: BinaryHeap::new() };
        if count > 0 {
            walk(self, &place, &mut kept)?;
        }
        let mut cells = Vec::new();
        cells.try_reserve_exact(kept.cells.len())?;
        cells.extend(kept.cells.into_sorted_vec().into_iter().map(|near| NearCell {
            found: near.found,
            point: place.nearest_in(near.found.cell, point),
            distance: place.distance(near.square),
        }));
        Ok(cells)
    }
}

impl Octree {
    /// Returns the cells nearest to a point. See [`OctreeRef::nearest_cells`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::nearest_cells`].
    pub fn nearest_cells(&self, point: [f64; 3], tags: &[Tag], count: usize) -> Result<Vec<NearCell>, Error> {
        self.view().nearest_cells(point, tags, count)
    }
}

/// A candidate for the nearest cells.
struct Near {
    square: Square,
    /// The cell's Morton number.
    order: u64,
    found: TaggedCell,
}

impl Near {
    fn key(&self) -> (Square, u64) {
        (self.square, self.order)
    }
}

impl Ord for Near {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }
}

impl PartialOrd for Near {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Near {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Near {}

/// The nearest cells so far; the furthest is on top.
struct Kept<'t> {
    tags: &'t [Tag],
    count: usize,
    cells: BinaryHeap<Near>,
}

/// The Morton number of a cell's first part on the finest possible level.
fn order(cell: Cell) -> u64 {
    let [x, y, z] = cell.first_at(MAX_DEPTH).at;
    let spread =
        |v: u32| (0..MAX_DEPTH).fold(0, |spread: u64, bit| spread | u64::from(v >> bit & 1) << (3 * bit));
    spread(x) | spread(y) << 1 | spread(z) << 2
}

impl Visitor for Kept<'_> {
    fn chosen(&self, _: Planes, _: u64, _: [Option<bool>; 3]) -> Option<u64> {
        None
    }

    fn wants(&self, square: Square, cell: Cell, tag: Tag) -> bool {
        if tag != Tag::Branch && !self.tags.contains(&tag) {
            return false;
        }
        match self.cells.peek() {
            Some(last) if self.cells.len() == self.count => {
                square < last.square || square == last.square && order(cell) < last.order
            }
            _ => true,
        }
    }

    fn meet(&mut self, square: Square, cell: Cell, tag: Tag) -> Result<(), Error> {
        let near = Near { square, order: order(cell), found: TaggedCell { cell, tag } };
        if self.cells.len() < self.count {
            self.cells.try_reserve(1)?;
            self.cells.push(near);
        } else if let Some(mut last) = self.cells.peek_mut() {
            *last = near;
        }
        Ok(())
    }
}
