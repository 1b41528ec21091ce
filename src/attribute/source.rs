//! The one operation that channels are made by: split a cell of which the value is not settled.

use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::channel::Bits;

/// What is known of a cell of the lattice.
pub(super) enum Known<P> {
    /// Any value will do, or none: nobody looks there.
    Free,
    /// The cell has one value, or none.
    Settled(Option<Bits>),
    /// Not settled. A part remembers what matters for the cells below.
    Open(P),
}

/// Values on the lattice of a frame, found cell by cell.
pub(super) trait Source: Sync {
    /// What is remembered about an open cell.
    type Part: Clone + Send + Sync;

    /// The universe.
    fn root(&self) -> Result<Known<Self::Part>, Error>;

    /// The eight children of an open cell that is no finest one.
    fn split(&self, cell: Cell, part: &Self::Part) -> Result<[Known<Self::Part>; 8], Error>;

    /// Settles open finest cells, at most 64: their values, or none, go to `values`.
    fn settle(&self, cells: &[(Cell, Self::Part)], values: &mut [Option<Bits>]) -> Result<(), Error>;
}
