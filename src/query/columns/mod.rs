//! Columns of finest cells along an axis: the solid cells of each column, and their height.
//!
//! Each column stands for all lines along the axis within it, such as the ray through the centres of its
//! cells.

mod heights;
mod octree;
mod runs;
mod solid;

pub use heights::{Heights, Side};
pub use runs::{ColumnCells, ColumnRuns, Run};
pub use solid::{columns, heights};

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Frame;
use core::ops::Range;

/// A rectangle of columns. A column is a row of finest cells from one side of the universe to the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns {
    axis: usize,
    first: [u32; 2],
    end: [u32; 2],
}

impl Columns {
    /// Selects all columns of a frame along `axis`: 0 is x, 1 y, 2 z.
    ///
    /// # Errors
    /// [`Error::Argument`] if `axis` is greater than 2.
    pub fn all(frame: &Frame, axis: usize) -> Result<Columns, Error> {
        Columns::within(axis, [0; 2], [frame.cells(); 2])
    }

    /// Selects the columns along `axis` whose cells have coordinates from `first` to before `end` on the
    /// other two axes. These axes stand in the order x, y, z.
    ///
    /// # Errors
    /// [`Error::Argument`] if `axis` is greater than 2, or `first` lies beyond `end`.
    pub fn within(axis: usize, first: [u32; 2], end: [u32; 2]) -> Result<Columns, Error> {
        if axis > 2 {
            return Err(Error::Argument { name: "axis", problem: "must be 0, 1 or 2" });
        }
        if (0..2).any(|i| first[i] > end[i]) {
            return Err(Error::Argument { name: "end", problem: "must not lie before first" });
        }
        Ok(Columns { axis, first, end })
    }

    /// The axis that the columns run along: 0 is x, 1 y, 2 z.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// The coordinates of the first column's cells on the other two axes, in the order x, y, z.
    pub fn first(&self) -> [u32; 2] {
        self.first
    }

    /// The number of columns beside each other along each of these axes.
    pub fn size(&self) -> [u32; 2] {
        [0, 1].each(|i| self.end[i] - self.first[i])
    }

    /// The number of columns.
    pub fn count(&self) -> u64 {
        let [width, height] = self.size();
        width as u64 * height as u64
    }

    /// Returns the index of a column in results, from the coordinates of its cells on the other two axes;
    /// `None` if the column is not selected. The first of the axes varies fastest.
    pub fn index(&self, at: [u32; 2]) -> Option<usize> {
        let inside = (0..2).all(|i| (self.first[i]..self.end[i]).contains(&at[i]));
        inside.then(|| self.place([0, 1].each(|i| at[i] - self.first[i])))
    }

    /// Returns the index of a column from the steps from the first column.
    fn place(&self, steps: [u32; 2]) -> usize {
        steps[1] as usize * self.size()[0] as usize + steps[0] as usize
    }

    /// The other two axes.
    fn across(&self) -> [usize; 2] {
        [[1, 2], [0, 2], [0, 1]][self.axis]
    }

    /// Returns the number of columns, if they are columns of a frame, and memory can hold an entry for each.
    fn counted(&self, frame: &Frame) -> Result<usize, Error> {
        if self.end.iter().any(|&end| end > frame.cells()) {
            return Err(Error::Argument { name: "columns", problem: "reach beyond the universe" });
        }
        usize::try_from(self.count()).map_err(|_| Error::OutOfMemory)
    }

    /// Returns the part of a cube that lies in these columns; `None` if that part is empty. `low` is the
    /// cube's lowest finest cell.
    fn shadow(&self, low: [u32; 3], edge: u32) -> Option<Shadow> {
        let across = self.across();
        let range = |i: usize| {
            let start = low[across[i]].max(self.first[i]);
            let end = (low[across[i]] + edge).min(self.end[i]);
            (start < end).then(|| start - self.first[i]..end - self.first[i])
        };
        let start = low[self.axis];
        Some(Shadow { steps: [range(0)?, range(1)?], cells: start..start + edge })
    }
}

/// A box of finest cells in columns.
struct Shadow {
    /// The columns, as steps from the first.
    steps: [Range<u32>; 2],
    /// The cells in each.
    cells: Range<u32>,
}

impl Shadow {
    /// The indices of the shadow's columns.
    fn places(&self, columns: Columns) -> impl Iterator<Item = usize> + '_ {
        self.steps[1].clone().flat_map(move |v| self.steps[0].clone().map(move |u| columns.place([u, v])))
    }
}

/// A receiver of the cells that are neither EMPTY nor split. The cells of each column come in ascending
/// order, or in descending order if the walk says so.
trait Visitor {
    fn meet(&mut self, is_full: bool, shadow: &Shadow) -> Result<(), Error>;

    /// Returns whether these cells, all of which come next, change nothing.
    fn skips(&self, shadow: &Shadow) -> bool;
}
