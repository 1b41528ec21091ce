//! The surfaces of two solids, numbered in common.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::solid::half_space::Placed;
use crate::solid::half_space::contact::Contact;
use crate::solid::half_space::possible::{Met, met};
use crate::solid::half_space::record::Pool;
use crate::solid::half_space::table::Table;
use crate::solid::{AskWhole, Classifier, OpenSurfaces, PlacedHalfSpace};
use alloc::vec::Vec;
use hashbrown::HashMap;
use hashbrown::hash_map::Entry;

/// The combinations of signs of two functions; `true` means negative.
const SIGNS: [(bool, bool); 4] = [(false, false), (false, true), (true, false), (true, true)];

/// The greatest number of pairs of surfaces whose contacts are remembered. (Forgotten contacts are computed
/// again.)
const REMEMBERED: usize = 1 << 12;

/// The combinations of signs that pairs of surfaces exclude, as far as they were requested.
#[derive(Default)]
pub(super) struct Contacts {
    known: HashMap<[u32; 2], Contact>,
    /// The memory of the values beside the table, in bytes.
    heap_bytes: usize,
}

impl Contacts {
    pub(super) fn bytes(&self) -> usize {
        self.known.capacity() * size_of::<([u32; 2], Contact)>() + self.heap_bytes
    }
}

/// The surfaces of two solids. A surface that bounds both solids has one number, even if they lie on opposite
/// sides of it.
pub(crate) struct Common {
    frame: Frame,
    surfaces: Vec<PlacedHalfSpace>,
    /// The surfaces on the universe.
    pub(super) all: Vec<Placed>,
    /// For each surface of each solid's list, its common number, and whether its function has the opposite
    /// sign there.
    names: [Vec<(u32, bool)>; 2],
}

impl Common {
    /// Numbers the surfaces of two solids. `None` if one of them has no surfaces. O(surfaces).
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
        Ok(Some(Common { frame: *a.frame(), surfaces: numbered.surfaces, all, names }))
    }

    pub(super) fn bytes(&self) -> usize {
        let names: usize = self.names.iter().map(memory::bytes_of).sum();
        memory::bytes_of(&self.surfaces)
            + memory::bytes_of(&self.all)
            + self.all.iter().map(Placed::heap_bytes).sum::<usize>()
            + names
    }

    /// The intersection of both solids' functions in a cell; `None` if they have too many surfaces.
    pub(super) fn both(
        &self,
        cell: Cell,
        a: &OpenSurfaces,
        b: &OpenSurfaces,
        contacts: &mut Contacts,
    ) -> Result<Option<OpenSurfaces>, Error> {
        let mut both = OpenSurfaces::constant(false);
        let Some((of_a, of_b)) = self.named(&mut both, 0, a).zip(self.named(&mut both, 1, b)) else {
            return Ok(None);
        };
        self.possible(cell, &both.with_table(Table(of_a.0 & of_b.0)).shortened(), contacts).map(Some)
    }

    /// The table of one solid's function, by the numbers in `both`; its surfaces are added to `both`.
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

    /// The same function on the combinations of signs that are possible in a cell, with as few surfaces as
    /// necessary.
    pub(super) fn possible(
        &self,
        cell: Cell,
        own: &OpenSurfaces,
        contacts: &mut Contacts,
    ) -> Result<OpenSurfaces, Error> {
        if own.settled().is_some() {
            return Ok(*own);
        }
        let met = met(own.indices().iter().map(|&index| &self.all[index as usize]), cell);
        let simple = |possible| own.with_table(own.table().simplified(possible)).shortened();
        let known = simple(met.possible);
        if known.settled().is_some() || cell.level == 0 {
            return Ok(known);
        }
        Ok(match self.left_by_contacts(cell, own, &met, contacts)? {
            left if left == met.possible => known,
            left => simple(left),
        })
    }

    /// The combinations of signs that remain after contacts between surfaces.
    fn left_by_contacts(
        &self,
        cell: Cell,
        own: &OpenSurfaces,
        met: &Met,
        contacts: &mut Contacts,
    ) -> Result<Table, Error> {
        let mut left = met.possible;
        for (i, a) in own.variables() {
            for (j, b) in own.variables().filter(|&(j, _)| j > i) {
                let both = |(negative_a, negative_b)| Table::of(i, negative_a).0 & Table::of(j, negative_b).0;
                // Contacts cannot exclude a combination that certainly occurs.
                let is_open = |&signs: &(bool, bool)| {
                    left.0 & both(signs) != 0 && !met.is_seen(&[(i, signs.0), (j, signs.1)])
                };
                let is_pair_open = SIGNS.iter().any(is_open);
                let are_sheets_possible = self.is_plane(a) != self.is_plane(b);
                let thirds = || {
                    let others = own.variables().filter(move |&(k, _)| k != i && k != j);
                    others.filter(|&(_, index)| are_sheets_possible && self.is_plane(index))
                };
                let is_third_open = |(k, _)| {
                    SIGNS.iter().any(|&signs| {
                        [false, true].into_iter().any(|negative| {
                            left.0 & both(signs) & Table::of(k, negative).0 != 0
                                && !met.is_seen(&[(i, signs.0), (j, signs.1), (k, negative)])
                        })
                    })
                };
                if !is_pair_open && !thirds().any(is_third_open) {
                    continue;
                }
                let sheets = match self.contact([a, b], contacts)? {
                    Contact::Unknown => continue,
                    &Contact::Excluded(negative_a, negative_b) => {
                        left.0 &= !both((negative_a, negative_b));
                        continue;
                    }
                    Contact::Sheets(sheets) => sheets,
                };
                if let Some(signs) = sheets.excluded(cell) {
                    left.0 &= !both(signs);
                    continue;
                }
                for (k, third) in thirds() {
                    let third = self.surfaces[third as usize].linear(&self.frame)?;
                    let excluded = third.and_then(|third| sheets.excluded_with(&third));
                    for (signs, is_negative) in excluded.into_iter().flatten() {
                        left.0 &= !(both(signs) & Table::of(k, is_negative).0);
                    }
                }
            }
        }
        Ok(left)
    }

    fn is_plane(&self, number: u32) -> bool {
        self.surfaces[number as usize].is_plane()
    }

    /// The combinations of signs that two surfaces exclude.
    fn contact<'c>(&self, pair: [u32; 2], contacts: &'c mut Contacts) -> Result<&'c Contact, Error> {
        let Contacts { known, heap_bytes } = contacts;
        if known.len() >= REMEMBERED && !known.contains_key(&pair) {
            known.clear();
            *heap_bytes = 0;
        }
        known.try_reserve(1)?;
        match known.entry(pair) {
            Entry::Occupied(known) => Ok(known.into_mut()),
            Entry::Vacant(place) => {
                let [a, b] = pair.each(|index| &self.surfaces[index as usize]);
                let contact = a.contact(b, &self.frame)?;
                *heap_bytes += contact.heap_bytes();
                Ok(place.insert(contact))
            }
        }
    }
}

/// Surfaces that are numbered in the order in which they are found.
#[derive(Default)]
struct Numbered {
    pool: Pool,
    /// For each number of the pool, the number of the surface, and whether the surface's function has the
    /// opposite sign.
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
                // A surface without exact numbers equals no other.
                None => {
                    memory::push(&mut self.surfaces, surface.clone())?;
                    (next, false)
                }
            });
        }
        Ok(names)
    }
}
