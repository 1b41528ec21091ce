//! Columns of stored octrees: one walk over the elements, in Morton order.

use super::runs::CellLists;
use super::{ColumnCells, Columns, Heights, Side, Visitor};
use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::morton;
use crate::octree::links::Windows;
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Tag};

impl OctreeRef<'_> {
    /// Returns the solid cells of the octree in these columns, whatever they prove of the solid that the tree
    /// was made from. Complexity: O(cells in the columns + columns · cells along each), counting cells as
    /// they are stored. No element is read twice, whatever the bytes. It uses one thread.
    ///
    /// # Errors
    /// [`Error::Argument`] if the columns reach beyond the universe; [`Error::OutOfMemory`].
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build, query::{Columns, Run}};
    /// let frame = Frame::new([0.0; 3], 8.0, 3)?;
    /// let plate = build(&Csg::cuboid([0.0; 3], [8.0, 8.0, 2.0])?, &frame, Rule::Certified, &Control::default())?;
    /// let columns = Columns::all(&frame, 2)?;
    /// let cells = plate.view().columns(&columns)?;
    /// let index = columns.index([3, 5]).expect("there is such a column");
    /// assert_eq!(cells.full.column(index), [Run { start: 0, length: 2 }]);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn columns(&self, columns: &Columns) -> Result<ColumnCells, Error> {
        let count = columns.counted(self.frame())?;
        let mut lists = CellLists::new(*columns, count)?;
        walk(self, columns, &mut lists)?;
        ColumnCells::gathered(columns, count, &[lists])
    }

    /// Returns the reach of the octree's solid cells in these columns, whatever they prove of the solid that
    /// the tree was made from. The cost is that of [`columns`](Self::columns).
    ///
    /// # Errors
    /// As [`columns`](Self::columns).
    pub fn heights(&self, columns: &Columns, side: Side) -> Result<Heights, Error> {
        let mut heights = Heights::new(*self.frame(), *columns, side, columns.counted(self.frame())?)?;
        walk(self, columns, &mut heights)?;
        Ok(heights)
    }
}

/// Passes all cells in the columns to a visitor, in Morton order.
fn walk(tree: &OctreeRef<'_>, columns: &Columns, visitor: &mut impl Visitor) -> Result<(), Error> {
    let mut walk = Walk { tree, columns: *columns, windows: Windows::new(tree), visitor };
    match tree.root {
        Tag::Branch => walk.element(0, 0, [0; 3]),
        Tag::Empty => Ok(()),
        tag => walk.meet(tag, [0; 3], tree.frame().cells()),
    }
}

struct Walk<'t, 'a, 'v, V> {
    tree: &'t OctreeRef<'a>,
    columns: Columns,
    windows: Windows,
    visitor: &'v mut V,
}

impl<V: Visitor> Walk<'_, '_, '_, V> {
    fn meet(&mut self, tag: Tag, low: [u32; 3], edge: u32) -> Result<(), Error> {
        match self.columns.shadow(low, edge) {
            Some(shadow) => self.visitor.meet(tag == Tag::Full, &shadow),
            None => Ok(()),
        }
    }

    /// Walks the part of element `index` of level `e` that lies in the columns; `low` is the element's lowest
    /// finest cell. The recursion is as deep as the tree has element levels, ten at the most.
    fn element(&mut self, e: usize, index: usize, low: [u32; 3]) -> Result<(), Error> {
        let (levels, cells) = (self.tree.levels(), self.tree.frame().cells());
        let shift = 2 * (levels - 1 - e);
        let Some(planes) = self.tree.entry(index) else {
            return self.meet(Tag::Partial, low, (4 << shift).min(cells));
        };
        let mut left = !planes.empty();
        // The root of a tree of odd depth is greater than the universe.
        let mut within = [[0, cells]; 3];
        for (i, axis) in self.columns.across().into_iter().enumerate() {
            within[axis] = [self.columns.first[i], self.columns.end[i]];
        }
        for axis in 0..3 {
            let first = within[axis][0].max(low[axis]);
            let end = within[axis][1].min(low[axis] + (4 << shift));
            if first >= end {
                return Ok(());
            }
            left &= morton::slabs(axis, (first - low[axis]) >> shift, (end - 1 - low[axis]) >> shift);
        }
        let corner = |c: u32| {
            let at = morton::position(c);
            axes(|axis| low[axis] + (at[axis] << shift))
        };
        while left != 0 {
            let c = left.trailing_zeros();
            let octant = planes.octant(c >> 3);
            if octant != Tag::Branch {
                left &= !(0xFF << (8 * (c >> 3)));
                self.meet(octant, corner(c & !7), 2 << shift)?;
                continue;
            }
            left &= left - 1;
            match planes.tag(c) {
                Tag::Branch => {
                    let below = (e + 1).min(levels - 1);
                    match self.windows.child(self.tree, index, planes.branch(), c, below) {
                        Ok(child) if e + 1 < levels => self.element(e + 1, child, corner(c))?,
                        // The tree is damaged.
                        _ => self.meet(Tag::Partial, corner(c), 1 << shift)?,
                    }
                }
                tag => self.meet(tag, corner(c), 1 << shift)?,
            }
        }
        Ok(())
    }
}

impl Octree {
    /// Returns the solid cells in columns. See [`OctreeRef::columns`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::columns`].
    pub fn columns(&self, columns: &Columns) -> Result<ColumnCells, Error> {
        self.view().columns(columns)
    }

    /// Returns the heights of columns. See [`OctreeRef::heights`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::columns`].
    pub fn heights(&self, columns: &Columns, side: Side) -> Result<Heights, Error> {
        self.view().heights(columns, side)
    }
}
