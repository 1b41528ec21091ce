//! The faces between cells with selected tags and all other cells: the boundary of a region of tags.

use super::cells::{CellFilter, Cells, TaggedCell};
use super::direction::Direction;
use super::neighbour::Neighbour;
use super::tag::Tag;
use super::view::OctreeRef;
use crate::error::Error;
use crate::lattice::Cell;
use yoke::Yokeable;

/// A square between a leaf with a selected tag and a leaf with another tag. It is a complete face of the
/// smaller one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BoundaryFace {
    /// The leaf with a selected tag.
    pub inner: TaggedCell,
    /// The leaf with another tag; `None` outside the universe.
    pub outer: Option<TaggedCell>,
    /// The direction from the inner leaf to the outer one, along one axis.
    pub direction: Direction,
}

impl BoundaryFace {
    /// Returns the smaller one of the two leaves, of which this is a complete face; the inner one if they are
    /// equal.
    pub(crate) fn smaller(&self) -> Cell {
        match self.outer {
            Some(outer) if outer.cell.level > self.inner.cell.level => outer.cell,
            _ => self.inner.cell,
        }
    }
}

/// An iterator over the faces between cells that a [`CellFilter`] selects and leaves with other tags, in the
/// Morton order of the selected cells. See [`OctreeRef::boundary_faces`].
#[derive(Clone, Yokeable)]
pub struct BoundaryFaces<'a> {
    inner: Cells<'a>,
    /// The cell whose faces are being returned, and the number of its faces already examined.
    current: Option<(TaggedCell, usize)>,
    /// The smaller leaves at the last of these faces.
    smaller: Option<Cells<'a>>,
    /// Number of elements that may still be searched for smaller leaves.
    visits: usize,
}

impl<'a> OctreeRef<'a> {
    /// Returns the faces between leaves that `filter` selects and leaves with other tags. With FULL, this is
    /// the boundary of the surely solid region; with FULL and PARTIAL, that of the possibly solid region. The
    /// [exterior](OctreeRef::exterior) decides about faces on the boundary of the universe. Where cells of
    /// different sizes meet, there is one face for each smaller cell, so that the faces are disjoint. The
    /// faces are sorted by the Morton order of the inner cells, then by the order of [`Direction::FACES`],
    /// then by the Morton order of the outer cells. The box and the levels of the filter apply to the inner
    /// cells. BRANCH cells do not count.
    ///
    /// O(elements + leaves), without allocation. In a sound tree an element touches at most six leaves that
    /// are larger than its cell, one on each side. So the search for outer leaves may visit six times as many
    /// elements as there are; over damaged bytes, everything beyond that number is PARTIAL.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, Tag, build, octree::CellFilter};
    /// let frame = Frame::new([0.0; 3], 4.0, 2)?;
    /// let bar = Csg::cuboid([1.0; 3], [3.0, 2.0, 2.0])?;
    /// let bar = build(&bar, &frame, Rule::Certified, &Control::default())?;
    /// let faces = bar.view().boundary_faces(CellFilter::tags(&[Tag::Full]));
    /// assert_eq!(faces.count(), 10);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn boundary_faces(&self, filter: CellFilter) -> BoundaryFaces<'a> {
        let inner = self.cells(filter.without_branches());
        BoundaryFaces { inner, current: None, smaller: None, visits: self.visits_beside() }
    }

    fn visits_beside(&self) -> usize {
        6usize.saturating_mul(self.planes.len() + self.bricks.len())
    }
}

impl BoundaryFaces<'_> {
    /// Continues with the faces of `cell`, of the leaf that contains it, or of the first selected cell after
    /// it in Morton order. O(depth).
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] if `cell` does not lie in the universe, or is finer than the finest cells.
    pub fn seek(&mut self, cell: Cell) -> Result<(), Error> {
        self.inner.seek(cell)?;
        (self.current, self.smaller) = (None, None);
        self.visits = self.inner.tree().visits_beside();
        Ok(())
    }

    /// Returns the next outer leaf that is smaller than the inner one, if there is one on the current face.
    #[inline(always)]
    fn next_smaller(&mut self) -> Option<TaggedCell> {
        let smaller = self.smaller.as_mut()?;
        let outer = smaller.next();
        if outer.is_none() {
            self.visits = smaller.visits();
            self.smaller = None;
        }
        outer
    }
}

impl Iterator for BoundaryFaces<'_> {
    type Item = BoundaryFace;

    fn next(&mut self) -> Option<BoundaryFace> {
        loop {
            let Some((inner, looked_at)) = self.current else {
                self.current = Some((self.inner.next()?, 0));
                continue;
            };
            if let Some(outer) = self.next_smaller() {
                let direction = Direction::FACES[looked_at - 1];
                return Some(BoundaryFace { inner, outer: Some(outer), direction });
            }
            let Some(&direction) = Direction::FACES.get(looked_at) else {
                self.current = None;
                continue;
            };
            self.current = Some((inner, looked_at + 1));
            let (tree, filter) = (self.inner.tree(), self.inner.wanted());
            match tree.neighbour(self.inner.path(), inner.cell, direction) {
                None => {
                    if !filter.has(tree.exterior) {
                        return Some(BoundaryFace { inner, outer: None, direction });
                    }
                }
                Some(Neighbour { found, place: Some(place) }) => {
                    let others = filter.others();
                    let smaller = tree.leaves_towards(found.cell, place, direction, others, self.visits);
                    self.smaller = Some(smaller);
                }
                Some(Neighbour { found, place: None }) => {
                    if found.tag != Tag::Branch && !filter.has(found.tag) {
                        return Some(BoundaryFace { inner, outer: Some(found), direction });
                    }
                }
            }
        }
    }
}
