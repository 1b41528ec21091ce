//! The surfaces of several trees, each once.

use super::function::Known;
use crate::error::{Damage, Error};
use crate::lattice::Frame;
use crate::memory;
use crate::octree::cuts::{Names, Origin, SurfaceKind, SurfaceWriter, Surfaces, SurfacesRef, Universe};
use crate::solid::PlacedHalfSpace;
use crate::solid::half_space::Placed;
use crate::solid::half_space::residue::residue;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::cmp::Ordering;
use core::ops::Range;
use hashbrown::HashMap;
use once_cell::race::OnceBox;

/// The place of a surface: the table of a tree, and the number in that table.
type Place = (u32, u32);

/// The surfaces of several trees with common numbers. Placed forms are computed when they are first needed,
/// because an operation on a large tree touches few of its surfaces.
pub(super) struct JointSurfaces<'a> {
    frame: Frame,
    tables: Vec<SurfacesRef<'a>>,
    places: Vec<Place>,
    /// The table in which each surface was last found. Two equal surfaces in one table stay two, because
    /// functions are of distinct surfaces.
    last: Vec<u32>,
    placed: Vec<OnceBox<Placed>>,
    /// The common name of each surface of each table.
    names: Vec<(u32, bool)>,
    ranges: Vec<Range<usize>>,
}

impl<'a> JointSurfaces<'a> {
    /// Collects the surfaces of the tables. O(surfaces).
    ///
    /// # Errors
    /// [`Damage::Surface`]; [`Error::Limit`] if the exact map of placements is too long;
    /// [`Error::OutOfMemory`].
    pub(super) fn new(frame: &Frame, tables: Vec<SurfacesRef<'a>>) -> Result<JointSurfaces<'a>, Error> {
        let mut own = JointSurfaces {
            frame: *frame,
            tables,
            places: Vec::new(),
            last: Vec::new(),
            placed: Vec::new(),
            names: Vec::new(),
            ranges: Vec::new(),
        };
        let mut known: HashMap<u64, u32> = HashMap::new();
        // (Trees with a common table share its surfaces, even surfaces that cannot be compared.)
        let mut met: HashMap<[(usize, usize); 2], Range<usize>> = HashMap::new();
        for number in 0..own.tables.len() {
            let table = own.tables[number];
            let start = own.names.len();
            // (An empty array may have any address.)
            let place = |address: usize, count: usize| (if count == 0 { 0 } else { address }, count);
            let address = [
                place(table.records.as_ptr() as usize, table.records.len()),
                place(table.slabs.as_ptr() as usize, table.slabs.len()),
            ];
            if let Some(range) = met.get(&address) {
                memory::push(&mut own.ranges, range.clone())?;
                continue;
            }
            own.names.try_reserve(table.len())?;
            for id in 0..table.len() {
                let name = own.name((number as u32, id as u32), &mut known)?;
                own.names.push(name);
            }
            let range = start..own.names.len();
            met.try_reserve(1)?;
            met.insert(address, range.clone());
            memory::push(&mut own.ranges, range)?;
        }
        own.placed.try_reserve(own.places.len())?;
        own.placed.resize_with(own.places.len(), OnceBox::new);
        Ok(own)
    }

    /// Returns the common number of a surface, and whether the surface is negated there.
    fn name(&mut self, place: Place, known: &mut HashMap<u64, u32>) -> Result<(u32, bool), Error> {
        let next = self.places.len() as u32;
        let residue = residue(&self.tables[place.0 as usize], place.1 as usize);
        if let Some(residue) = residue {
            known.try_reserve(1)?;
            let id = *known.entry(residue).or_insert(next);
            if id != next && self.last[id as usize] != place.0 {
                let before = self.places[id as usize];
                let order = self.order_of(before, place);
                let turned = match order {
                    Ordering::Equal => Some(false),
                    _ => self.read(before)?.same(&self.read(place)?)?,
                };
                if let Some(turned) = turned {
                    // If two records describe one surface, the smaller record is kept, unless one is the
                    // negation of the other.
                    if order.is_gt() && !turned {
                        self.places[id as usize] = place;
                    }
                    self.last[id as usize] = place.0;
                    return Ok((id, turned));
                }
            }
        }
        memory::push(&mut self.places, place)?;
        memory::push(&mut self.last, place.0)?;
        Ok((next, false))
    }

    fn read(&self, (table, id): Place) -> Result<PlacedHalfSpace, Error> {
        let read = PlacedHalfSpace::read(&self.tables[table as usize], id as usize);
        read.ok_or(Damage::Surface { surface: id.into() }.into())
    }

    fn order_of(&self, a: Place, b: Place) -> Ordering {
        self.tables[a.0 as usize].order(a.1 as usize, &self.tables[b.0 as usize], b.1 as usize)
    }

    /// The common names of the surfaces of a table.
    pub(super) fn names(&self, table: usize) -> Names<'_> {
        &self.names[self.ranges[table].clone()]
    }

    /// Returns the origin of a slab of a cell, or two zeros; `None` for other surfaces.
    pub(super) fn group(&self, id: u32) -> Option<Origin> {
        let (table, id) = self.places[id as usize];
        let (_, group) = self.tables[table as usize].group(id as usize)?;
        Some(group.origin)
    }

    /// Writes a table of the surfaces with these numbers.
    pub(super) fn written(&self, used: &[u32]) -> Result<Surfaces, Error> {
        let mut all = SurfaceWriter::new(Universe::of(&self.frame));
        let mut maps = Vec::new();
        for &id in used {
            let (table, id) = self.places[id as usize];
            let (table, id) = (&self.tables[table as usize], id as usize);
            if let (Some(slab), Some((_, group))) = (table.cell_slab(id), table.group(id)) {
                all.put_cell_slab(slab, group.origin)?;
                continue;
            }
            let (kind, numbers) = table.get(id).ok_or(Damage::Surface { surface: id as u64 })?;
            maps.clear();
            for map in table.placements(id) {
                memory::push(&mut maps, map)?;
            }
            let numbers = (0..kind.numbers() as usize).map(|i| numbers.get(i));
            all.put(kind, numbers, table.identity(id), maps.iter().rev().copied())?;
        }
        Ok(all.finish())
    }
}

impl Known for JointSurfaces<'_> {
    fn placed(&self, id: u32) -> Result<&Placed, Error> {
        self.placed[id as usize]
            .get_or_try_init(|| Ok(Box::new(self.read(self.places[id as usize])?.on(&self.frame)?)))
    }

    fn order(&self, a: u32, b: u32) -> Ordering {
        // (Slabs without an origin may be equal.)
        self.order_of(self.places[a as usize], self.places[b as usize]).then(a.cmp(&b))
    }

    fn joins(&self, id: u32) -> bool {
        let (table, id) = self.places[id as usize];
        let kind = self.tables[table as usize].get(id as usize).map(|(kind, _)| kind);
        kind.is_some_and(|kind| kind != SurfaceKind::Slab)
    }
}
