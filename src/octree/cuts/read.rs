//! Public access to cuts: the function of a cell, and the surfaces.

use super::CellIds;
use super::surfaces::{Numbers, SurfaceKind, SurfacesRef};

/// The function of surfaces that describes the solid in a PARTIAL cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellFunction {
    pub(crate) ids: CellIds,
    pub(crate) table: u8,
}

impl CellFunction {
    /// Returns the numbers of the surfaces on which the function depends: one to three, ascending.
    pub fn surfaces(&self) -> &[u32] {
        &self.ids
    }

    /// Returns the truth table. Bit m is set if a point lies in the solid that is on the positive side of
    /// those surfaces i for which bit i of m is set, and on the negative side of the others. Bits of m beyond
    /// the surfaces do not matter.
    pub fn table(&self) -> u8 {
        self.table
    }
}

/// A surface of an extended octree: the zeros of a function, which is given in exact numbers.
#[derive(Debug, Clone, Copy)]
pub struct StoredSurface<'a> {
    surfaces: SurfacesRef<'a>,
    id: usize,
    kind: SurfaceKind,
    numbers: Numbers<'a>,
}

impl<'a> StoredSurface<'a> {
    /// Returns the surface; `None` if there is none of this number, or it is damaged.
    pub(crate) fn new(surfaces: SurfacesRef<'a>, id: u32) -> Option<StoredSurface<'a>> {
        let (kind, numbers) = surfaces.get(id as usize)?;
        Some(StoredSurface { surfaces, id: id as usize, kind, numbers })
    }

    /// Returns the kind of the function.
    pub fn kind(&self) -> SurfaceKind {
        self.kind
    }

    /// Returns the number of its numbers.
    pub fn numbers(&self) -> usize {
        self.kind.numbers() as usize
    }

    /// Returns a number, as the doubles whose sum it is. The slice is empty for zero, and for a number that
    /// the kind does not have.
    pub fn number(&self, i: usize) -> &[f64] {
        if i < self.numbers() { self.numbers.get(i) } else { &[] }
    }

    /// Returns the maps that place the figure, the rows of `[M | t]` each, in the order in which they are
    /// applied. (A slab that was made for one cell is given in units of the universe, and placed by the map
    /// from there to model space.)
    pub fn placements(&self) -> impl Iterator<Item = [[f64; 4]; 3]> + use<'a> {
        let universe = self.surfaces.cell_slab(self.id).map(|_| self.surfaces.universe.rows());
        self.surfaces.placements(self.id).copied().chain(universe)
    }

    /// Returns the origin of a slab that can be distinguished from others: the fingerprint of its source, and
    /// its number there. Numbers from 2^63 on are those of slabs that were made for one cell.
    pub fn origin(&self) -> Option<([u64; 2], u64)> {
        self.surfaces.identity(self.id)
    }
}
