//! The one operation that makes channels: splitting a cell whose value is not settled.

use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::channel::Bits;

/// The state of a cell of the lattice.
pub(super) enum Known<P> {
    /// Any value will do, or none, because the cell does not matter.
    Free,
    /// The whole cell has one value, or none.
    Settled(Option<Bits>),
    /// Not settled. The part keeps the data for the cells below.
    Open(P),
}

/// Values on the lattice of a frame, found cell by cell.
pub(super) trait Source: Sync {
    /// The data about an open cell.
    type Part: Clone + Send + Sync;

    /// The state of the universe.
    fn root(&self) -> Result<Known<Self::Part>, Error>;

    /// The states of the eight children of an open cell above the finest level.
    fn split(&self, cell: Cell, part: &Self::Part) -> Result<[Known<Self::Part>; 8], Error>;

    /// Settles open finest cells, at most 64: writes their values, or `None`, to `values`.
    fn settle(&self, cells: &[(Cell, Self::Part)], values: &mut [Option<Bits>]) -> Result<(), Error>;
}
