//! The surfaces that cross a cell, and the function of their signs that the solid is.

use super::HalfSpace;
use super::table::{self, Table};
use crate::lattice::Affine;
use alloc::sync::Arc;

/// A half-space under placements.
#[derive(Clone)]
pub struct PlacedHalfSpace {
    /// The half-space, in the space in which it was defined.
    pub half_space: HalfSpace,
    /// The maps that move it into model space, the last map first.
    pub placements: Arc<[Affine]>,
}

impl PlacedHalfSpace {
    /// Returns the half-space under one more placement.
    #[must_use]
    pub(crate) fn placed(&self, placement: &Affine) -> PlacedHalfSpace {
        let placements = core::iter::once(placement).chain(&*self.placements).copied().collect();
        PlacedHalfSpace { half_space: self.half_space.clone(), placements }
    }
}

/// Up to six surfaces that cross a PARTIAL cell, and the Boolean function of their signs that the solid is.
///
/// # Law
/// At a point of the open cell at which none of the surfaces' functions is zero, the table gives the solid
/// for the signs there. A layer, which is a plane with a width, has no sign at points within its width. Where
/// the table has the same value for all signs of the layers in whose widths a point lies, the solid has that
/// value at the point. Otherwise nothing is known of the point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OpenSurfaces {
    indices: [u32; OpenSurfaces::MOST],
    count: u8,
    table: Table,
}

impl OpenSurfaces {
    /// The number of the first layer that is made for a cell alone; lists are shorter than this.
    pub const OWN: u32 = 1 << 31;

    /// The most surfaces of a cell.
    pub const MOST: usize = table::MOST;

    /// The constant function, without surfaces.
    pub(crate) fn constant(inside: bool) -> OpenSurfaces {
        let table = if inside { Table::FULL } else { Table::EMPTY };
        OpenSurfaces { indices: [0; OpenSurfaces::MOST], count: 0, table }
    }

    /// The function `table` of distinct surfaces; `None` if they are too many.
    pub(crate) fn new(of: impl IntoIterator<Item = u32>, table: Table) -> Option<OpenSurfaces> {
        let mut open = OpenSurfaces { table, ..OpenSurfaces::constant(false) };
        for index in of {
            open.number(index)?;
        }
        Some(open)
    }

    /// Returns the number of a surface in the table, and adds the surface if it is new; `None` if there is no
    /// room.
    pub(crate) fn number(&mut self, index: u32) -> Option<usize> {
        if let Some(i) = self.indices().iter().position(|&known| known == index) {
            return Some(i);
        }
        let i = usize::from(self.count);
        *self.indices.get_mut(i)? = index;
        self.count += 1;
        Some(i)
    }

    /// The surfaces, as numbers in the classifier's list
    /// ([`WholeQuestion::Surfaces`](crate::solid::WholeQuestion::Surfaces)).
    pub fn indices(&self) -> &[u32] {
        &self.indices[..usize::from(self.count)]
    }

    /// Returns whether the points are inside at which exactly the functions of the surfaces whose bits are
    /// set in `signs` are positive, and the other functions are negative.
    pub fn inside(&self, signs: u8) -> bool {
        self.table.0 >> (signs & 63) & 1 != 0
    }

    pub(crate) fn table(&self) -> Table {
        self.table
    }

    /// Returns the same surfaces with another function.
    #[must_use]
    pub(crate) fn with_table(self, table: Table) -> OpenSurfaces {
        OpenSurfaces { table, ..self }
    }

    /// Selects between two functions of the same surfaces: the second where surface `i` of the list is
    /// positive, otherwise the first.
    #[cfg(feature = "std")]
    pub(crate) fn choice(i: usize, [below, above]: [OpenSurfaces; 2]) -> OpenSurfaces {
        let is_above = Table::of(i, false).0;
        below.with_table(Table(below.table.0 & !is_above | above.table.0 & is_above))
    }

    /// Returns the same function with renamed surfaces; several surfaces may get the same name.
    #[must_use]
    pub(crate) fn renamed(&self, name: impl Fn(u32) -> u32) -> OpenSurfaces {
        let mut own = OpenSurfaces::constant(false);
        let mut table = self.table;
        for (i, index) in self.variables() {
            // (Numbers ascend, so that no number of a later surface is taken.)
            if let Some(to) = own.number(name(index)) {
                table = table.renamed(i, to, false);
            }
        }
        own.with_table(table)
    }

    /// Returns the same function with only the surfaces on which it depends.
    #[must_use]
    pub(crate) fn shortened(&self) -> OpenSurfaces {
        self.renamed(|index| index)
    }

    /// Returns the surfaces on which the function depends, with their numbers in the table.
    pub(crate) fn variables(&self) -> impl Iterator<Item = (usize, u32)> + Clone {
        let table = self.table;
        self.indices().iter().copied().enumerate().filter(move |&(i, _)| table.depends_on(i))
    }

    /// Returns whether the solid is all of the cell (true) or nothing of it (false); `None` if the surfaces
    /// decide.
    pub(crate) fn settled(&self) -> Option<bool> {
        match self.table {
            Table::FULL => Some(true),
            Table::EMPTY => Some(false),
            _ => None,
        }
    }

    /// Returns the function of the complement.
    #[must_use]
    pub fn complement(self) -> OpenSurfaces {
        self.with_table(Table(!self.table.0))
    }
}
