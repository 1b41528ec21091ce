//! What cuts say, for whoever reads them: the function of a cell, and the surfaces.

use super::CellIds;
use super::surfaces::{SurfaceKind, SurfacesRef};

/// The function that the solid is in a PARTIAL cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellFunction {
    pub(crate) ids: CellIds,
    pub(crate) table: u8,
}

impl CellFunction {
    /// The numbers of the surfaces on which it depends: one to three, ascending.
    pub fn surfaces(&self) -> &[u32] {
        &self.ids
    }

    /// The truth table: bit m is set if points lie in the solid that are on the positive side of those surfaces i for which bit i
    /// of m is set, and on the negative side of the others. Bits of m beyond the surfaces do not matter.
    pub fn table(&self) -> u8 {
        self.table
    }
}

/// A surface of an extended octree: where a function is zero, which is given in exact numbers.
#[derive(Debug, Clone, Copy)]
pub struct StoredSurface<'a> {
    surfaces: SurfacesRef<'a>,
    id: usize,
    kind: SurfaceKind,
}

impl<'a> StoredSurface<'a> {
    /// `None` if there is none of this number, or it is damaged.
    pub(crate) fn new(surfaces: SurfacesRef<'a>, id: u32) -> Option<StoredSurface<'a>> {
        let (kind, _) = surfaces.get(id as usize)?;
        Some(StoredSurface { surfaces, id: id as usize, kind })
    }

    /// What kind of function it is.
    pub fn kind(&self) -> SurfaceKind {
        self.kind
    }

    /// How many numbers it has.
    pub fn numbers(&self) -> usize {
        self.kind.numbers() as usize
    }

    /// A number, as the doubles whose sum it is; none for zero, and for a number that the kind does not have.
    pub fn number(&self, i: usize) -> &'a [f64] {
        self.surfaces.get(self.id).and_then(|(_, mut numbers)| numbers.nth(i)).unwrap_or(&[])
    }

    /// The maps that place the figure, the rows of `[M | t]` each, in the order in which they are applied.
    pub fn placements(&self) -> impl Iterator<Item = &'a [[f64; 4]; 3]> + use<'a> {
        self.surfaces.placements(self.id)
    }

    /// Of a slab that can be told from others: the fingerprint of what it was made from, and its number there.
    pub fn origin(&self) -> Option<([u64; 2], u32)> {
        self.surfaces.identity(self.id)
    }
}
