//! The surfaces of two solids under common numbers.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::solid::half_space::Placed;
use crate::solid::half_space::possible::possible;
use crate::solid::half_space::record::Pool;
use crate::solid::half_space::table::Table;
use crate::solid::{AskWhole, Classifier, OpenSurfaces, PlacedHalfSpace};
use alloc::vec::Vec;

/// Closed forms are looked at in the cells of each so manieth level: they are dear, and the same everywhere.
const CONTACT: u8 = 4;

/// The surfaces of two solids. A surface that bounds both has one number, whichever side of it the one and the other lie on.
pub(crate) struct Common {
    surfaces: Vec<PlacedHalfSpace>,
    /// On the universe.
    pub(super) all: Vec<Placed>,
    /// For each surface of each solid's list its number, and whether its function is the negative there.
    names: [Vec<(u32, bool)>; 2],
}

impl Common {
    /// `None` if one of them has no surfaces. O(surfaces).
    pub(super) fn of<A: Classifier, B: Classifier>(
        a: &A,
        b: &B,
        control: &Control<'_>,
    ) -> Result<Option<Common>, Error> {
        let of_a = a.surfaces(control)?.unwrap_or_default();
        if of_a.is_empty() {
            return Ok(None);
        }
        let of_b = b.surfaces(control)?.unwrap_or_default();
        if of_b.is_empty() {
            return Ok(None);
        }
        let mut numbered = Numbered::default();
        let names = [numbered.names(&of_a, control)?, numbered.names(&of_b, control)?];
        let mut all = memory::with_capacity(numbered.surfaces.len())?;
        for surface in &numbered.surfaces {
            control.check()?;
            all.push(surface.on(a.frame())?);
        }
        Ok(Some(Common { surfaces: numbered.surfaces, all, names }))
    }

    pub(super) fn bytes(&self) -> usize {
        let names: usize = self.names.iter().map(memory::bytes_of).sum();
        memory::bytes_of(&self.surfaces)
            + memory::bytes_of(&self.all)
            + self.all.iter().map(Placed::heap_bytes).sum::<usize>()
            + names
    }

    /// The function of both solids' functions in a cell; `None` if they have too many surfaces.
    pub(super) fn both(
        &self,
        cell: Cell,
        a: &OpenSurfaces,
        b: &OpenSurfaces,
    ) -> Result<Option<OpenSurfaces>, Error> {
        let mut both = OpenSurfaces::constant(false);
        let Some((of_a, of_b)) = self.named(&mut both, 0, a).zip(self.named(&mut both, 1, b)) else {
            return Ok(None);
        };
        self.possible(cell, &both.with_table(Table(of_a.0 & of_b.0)).shortened()).map(Some)
    }

    /// The table of the function of one solid, by the numbers in `both`, to which its surfaces are added.
    fn named(&self, both: &mut OpenSurfaces, solid: usize, own: &OpenSurfaces) -> Option<Table> {
        let (mut places, mut table) = ([0; OpenSurfaces::MOST], own.table());
        for (i, index) in own.variables() {
            let &(number, negated) = self.names[solid].get(index as usize)?;
            places[i] = both.number(number)?;
            if negated {
                table = table.negated(i);
            }
        }
        Some(table.spread(&places[..own.indices().len()]))
    }

    /// The same function on the combinations of signs that are possible in a cell, of as few surfaces as that takes.
    pub(super) fn possible(&self, cell: Cell, own: &OpenSurfaces) -> Result<OpenSurfaces, Error> {
        if own.settled().is_some() {
            return Ok(*own);
        }
        let mut possible = possible(own.indices().iter().map(|&index| &self.all[index as usize]), cell);
        if cell.level > 0 && cell.level.is_multiple_of(CONTACT) {
            possible.0 &= self.not_excluded(own)?.0;
        }
        Ok(own.with_table(own.table().simplified(possible)).shortened())
    }

    /// The combinations of signs that closed forms of two surfaces leave.
    fn not_excluded(&self, own: &OpenSurfaces) -> Result<Table, Error> {
        let mut left = Table::FULL;
        for (i, a) in own.variables() {
            for (j, b) in own.variables().filter(|&(j, _)| j > i) {
                let [a, b] = [a, b].map(|index| &self.surfaces[index as usize]);
                if let Some((negative_a, negative_b)) = a.excluded(b)? {
                    left.0 &= !(Table::of(i, negative_a).0 & Table::of(j, negative_b).0);
                }
            }
        }
        Ok(left)
    }
}

/// Surfaces that are numbered as they are met.
#[derive(Default)]
struct Numbered {
    pool: Pool,
    /// For each number of the pool that of the surface, and whether its function is the negative of the pool's.
    places: Vec<(u32, bool)>,
    surfaces: Vec<PlacedHalfSpace>,
}

impl Numbered {
    fn names(&mut self, list: &[PlacedHalfSpace], control: &Control<'_>) -> Result<Vec<(u32, bool)>, Error> {
        let mut names = memory::with_capacity(list.len())?;
        for surface in list {
            control.check()?;
            let next = self.surfaces.len() as u32;
            names.push(match self.pool.number(surface)? {
                Some((known, negated)) => match self.places.get(known as usize) {
                    Some(&(place, first)) => (place, negated != first),
                    None => {
                        memory::push(&mut self.places, (next, negated))?;
                        memory::push(&mut self.surfaces, surface.clone())?;
                        (next, false)
                    }
                },
                // What has no exact numbers is like no other.
                None => {
                    memory::push(&mut self.surfaces, surface.clone())?;
                    (next, false)
                }
            });
        }
        Ok(names)
    }
}
