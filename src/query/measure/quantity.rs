//! The measured quantity of a solid.

use crate::error::Error;
use crate::lattice::Cell;
use crate::solid::Worker;
use core::ops::AddAssign;

/// A sum over the cells of a solid, which accepts cells of any levels in any order.
pub(super) trait Quantity: Sized + Sync {
    /// The knowledge about an open cell.
    type Known;

    /// The sum.
    type Found: Found;

    /// 3 for a volume, 2 for an area.
    const DIMENSION: u8;

    /// The quantity of a universe of edge 1, in model units and in the units of the sum.
    const SIZE: f64;
    const UNIVERSE: f64;

    /// The knowledge about a cell that cannot be split.
    const NOTHING: Self::Known;

    fn known<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part) -> Result<Self::Known, Error>;

    /// The doubt, as a share of a cell's possible quantity.
    fn doubt(known: &Self::Known) -> f64;

    fn new() -> Self;

    fn full(&mut self, cell: Cell);

    fn open(&mut self, cell: Cell, known: &Self::Known);

    fn finish(self) -> Self::Found;
}

/// The bounds of a quantity, in units of its own.
pub(super) trait Found: Copy + Default + AddAssign + Send {
    /// The lower bound.
    fn least(&self) -> f64;

    /// The difference between the upper and the lower bound.
    fn doubt(&self) -> f64;
}
