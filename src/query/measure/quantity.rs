//! What is measured of a solid.

use crate::error::Error;
use crate::lattice::Cell;
use crate::solid::Worker;
use core::ops::AddAssign;

/// A sum over the cells of a solid, which adds up cells of any levels in any order.
pub(super) trait Quantity: Sized + Sync {
    /// What is known of an open cell.
    type Known;

    /// The sum.
    type Found: Found;

    /// 3 for a volume, 2 for an area.
    const DIMENSION: u8;

    /// What a universe of edge 1 may have of it, in model units and in those of what is found.
    const SIZE: f64;
    const UNIVERSE: f64;

    /// What is known of a cell that cannot be split.
    const NOTHING: Self::Known;

    fn known<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part) -> Result<Self::Known, Error>;

    /// How much of what a cell may have is in doubt, as a share.
    fn doubt(known: &Self::Known) -> f64;

    fn new() -> Self;

    fn full(&mut self, cell: Cell);

    fn open(&mut self, cell: Cell, known: &Self::Known);

    fn finish(self) -> Self::Found;
}

/// What is found of a quantity, in units of its own.
pub(super) trait Found: Copy + Default + AddAssign + Send {
    /// What is proven.
    fn least(&self) -> f64;

    /// How much more there may be.
    fn doubt(&self) -> f64;
}
