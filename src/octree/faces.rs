//! The faces between cells of some tags and all others: the boundary of what the tags stand for.

use super::cells::{CellFilter, Cells, TaggedCell};
use super::direction::Direction;
use super::neighbour::Neighbour;
use super::tag::Tag;
use super::view::OctreeRef;
use crate::error::Error;
use crate::lattice::Cell;
use yoke::Yokeable;

/// A square between two leaves of which one has a tag that was asked for, and the other has none: a whole
/// face of the smaller one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BoundaryFace {
    /// The leaf that has such a tag.
    pub inner: TaggedCell,
    /// The leaf that has none; `None` outside of the universe.
    pub outer: Option<TaggedCell>,
    /// The way from the inner leaf to the outer one, along one axis.
    pub direction: Direction,
}

impl BoundaryFace {
    /// The smaller of the two leaves, of which this is a whole face; the inner one if they are equal.
    pub(crate) fn smaller(&self) -> Cell {
        match self.outer {
            Some(outer) if outer.cell.level > self.inner.cell.level => outer.cell,
            _ => self.inner.cell,
        }
    }
}

/// The faces between cells that a [`CellFilter`] wants and leaves of other tags, in the Morton order of the
/// wanted cells. See [`OctreeRef::boundary_faces`].
#[derive(Clone, Yokeable)]
pub struct BoundaryFaces<'a> {
    inner: Cells<'a>,
    /// The cell whose faces are under way, and how many of these have been looked at.
    current: Option<(TaggedCell, usize)>,
    /// The smaller leaves at the last of them.
    smaller: Option<Cells<'a>>,
    /// How many elements smaller leaves may still be sought in.
    visits: usize,
}

impl<'a> OctreeRef<'a> {
    /// The faces between leaves that `filter` wants and leaves of other tags: with FULL, the boundary of what
    /// is surely solid; with FULL and PARTIAL, of what is possibly solid. What the
    /// [exterior](OctreeRef::exterior) is decides about faces on the boundary of the universe. Where cells of
    /// different sizes meet there is one face for each of the smaller ones, so that the faces are disjoint.
    /// They come in the Morton order of the inner cells, for each of these in the order of
    /// [`Direction::FACES`], and for each face in the Morton order of the outer cells. A box and levels of
    /// the filter are those of the inner cells. BRANCH cells do not count.
    ///
    /// O(elements + leaves), with no allocation. In a sound tree an element touches six leaves that are
    /// larger than its cell, at most, one on each side. So six times as many elements as there are may be met
    /// beside cells; over damaged bytes, everything beyond is PARTIAL.
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
    /// Goes on with the faces of `cell`, or of the leaf that contains it, or of the first wanted cell after
    /// it in Morton order. O(depth).
    ///
    /// # Errors
    /// [`Error::Argument`] if `cell` does not lie in the universe, or is finer than the finest cells.
    pub fn seek(&mut self, cell: Cell) -> Result<(), Error> {
        self.inner.seek(cell)?;
        (self.current, self.smaller) = (None, None);
        self.visits = self.inner.tree().visits_beside();
        Ok(())
    }

    /// The next outer leaf that is smaller than the inner one, if such are under way.
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
