//! The table of surfaces: each is the boundary of the points where a function is positive, given in exact
//! numbers.

use super::cell_slab::CellSlab;
use crate::error::{Damage, Error};
use crate::lattice::Each;
use crate::lattice::{Affine, Frame, valid};
use crate::memory;
use alloc::vec::Vec;
use bytemuck::{Pod, Zeroable};
use core::cmp::Ordering;
use hashbrown::HashMap;

/// The kind of function of a [`StoredSurface`](super::StoredSurface).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
#[non_exhaustive]
pub enum SurfaceKind {
    /// a x + b y + c z + d: four numbers.
    Plane = 0,
    /// A polynomial of degree two: its ten coefficients, of x², y², z², xy, yz, zx, x, y, z and 1.
    Quadric = 1,
    /// A sum of powers: A, a, n, B, b, m, C, c, k and D of A (x − a)^n + B (y − b)^m + C (z − c)^k + D.
    Powers = 2,
    /// A torus: R, q, s and t of q − (√((s x)² + (s y)²) − R)² − (s z + t)².
    Torus = 3,
    /// A plane with a width: its normal, and the two offsets between which the boundary lies (the first is
    /// that of the inner side, which counts as positive).
    /// [`StoredSurface::origin`](super::StoredSurface::origin) identifies the slab.
    Slab = 4,
}

impl SurfaceKind {
    /// Returns the number of numbers of a surface.
    pub(crate) const fn numbers(self) -> u32 {
        match self {
            SurfaceKind::Plane | SurfaceKind::Torus => 4,
            SurfaceKind::Slab => 5,
            SurfaceKind::Quadric | SurfaceKind::Powers => 10,
        }
    }

    const fn of(code: u32) -> Option<SurfaceKind> {
        Some(match code {
            0 => SurfaceKind::Plane,
            1 => SurfaceKind::Quadric,
            2 => SurfaceKind::Powers,
            3 => SurfaceKind::Torus,
            4 => SurfaceKind::Slab,
            _ => return None,
        })
    }
}

/// A surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct SurfaceRecord {
    /// A [`SurfaceKind`] in the lowest byte. For a slab, the bits above it contain the index of its origin,
    /// plus one, or 0 if it has none.
    pub kind: u32,
    /// The number of doubles whose sum each number is, three bits each, from the lowest on. A slab that has
    /// an origin may have one more number, a word of 64 bits: the number of the slab within its origin.
    /// Without that word, it is the index of the record.
    pub terms: u32,
    /// Index of its first double.
    pub first: u32,
    /// Index of the first map that places it, plus one; 0 for none.
    pub placement: u32,
}

/// Most doubles of a number.
pub(crate) const MOST_TERMS: usize = 7;

/// Most maps that place a surface. This bounds the work and the memory for a surface.
pub(crate) const MOST_MAPS: usize = 64;

impl SurfaceRecord {
    fn doubles(&self) -> usize {
        before(self.terms, 10)
    }

    fn kind(&self) -> Option<SurfaceKind> {
        SurfaceKind::of(self.kind & 0xFF)
    }

    /// Returns the index of the origin, plus one; 0 for none.
    fn origin(&self) -> u32 {
        self.kind >> 8
    }
}

/// Returns the number of doubles of the first `numbers` numbers.
fn before(terms: u32, numbers: usize) -> usize {
    (0..numbers).map(|i| (terms >> (3 * i) & 7) as usize).sum()
}

/// The numbers of a surface, each as the doubles whose sum it is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Numbers<'a> {
    Stored { terms: u32, doubles: &'a [f64] },
    Slab([f64; 5]),
}

impl Numbers<'_> {
    /// Returns the doubles of a number; none for zero.
    pub(crate) fn get(&self, i: usize) -> &[f64] {
        match self {
            Numbers::Stored { terms, doubles } => {
                let first = before(*terms, i);
                doubles
                    .get(first..first + (terms.checked_shr(3 * i as u32).unwrap_or(0) & 7) as usize)
                    .unwrap_or(&[])
            }
            Numbers::Slab(numbers) => match numbers.get(i) {
                Some(number) if *number != 0.0 => core::slice::from_ref(number),
                _ => &[],
            },
        }
    }

    /// Returns all doubles, number by number.
    fn doubles(&self, kind: SurfaceKind) -> impl Iterator<Item = f64> + Clone + '_ {
        (0..kind.numbers() as usize).flat_map(|i| self.get(i).iter().copied())
    }

    /// Returns the number of doubles of each number, three bits each.
    fn terms(&self, kind: SurfaceKind) -> u32 {
        (0..kind.numbers()).fold(0, |all, i| all | (self.get(i as usize).len() as u32) << (3 * i))
    }
}

/// An affine map.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Placement {
    /// Rows of `[M | t]`.
    pub rows: [[f64; 4]; 3],
    /// Index of the next map, plus one; 0 for none. It comes before this one in the table.
    pub outer: u64,
}

/// The source of slabs: a fingerprint of 128 bits, the lower half first.
pub(crate) type Origin = [u64; 2];

/// Slabs of cells with the same origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct CellSlabGroup {
    /// The origin; two zeros if there is none.
    pub origin: Origin,
    /// Number of slabs of cells up to the last one of the group.
    pub end: u64,
}

/// The universe of a tree, whose units its slabs of cells use.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Universe {
    pub origin: [f64; 3],
    pub edge: f64,
}

impl Universe {
    pub(crate) fn of(frame: &Frame) -> Universe {
        Universe { origin: frame.origin(), edge: frame.edge() }
    }

    /// Returns the rows of the map from its units to model space.
    pub(crate) fn rows(&self) -> [[f64; 4]; 3] {
        let ([x, y, z], edge) = (self.origin, self.edge);
        [[edge, 0.0, 0.0, x], [0.0, edge, 0.0, y], [0.0, 0.0, edge, z]]
    }
}

/// Surfaces in memory: first those of records, then slabs of cells.
#[derive(Debug, Clone, Default)]
pub(crate) struct Surfaces {
    pub records: Vec<SurfaceRecord>,
    pub doubles: Vec<f64>,
    pub placements: Vec<Placement>,
    pub origins: Vec<Origin>,
    pub slabs: Vec<CellSlab>,
    pub groups: Vec<CellSlabGroup>,
    pub universe: Universe,
}

/// Surfaces, borrowed. They are equal if all bits are equal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfacesRef<'a> {
    pub records: &'a [SurfaceRecord],
    pub doubles: &'a [f64],
    pub placements: &'a [Placement],
    pub origins: &'a [Origin],
    pub slabs: &'a [CellSlab],
    pub groups: &'a [CellSlabGroup],
    pub universe: Universe,
}

impl Surfaces {
    pub(crate) fn view(&self) -> SurfacesRef<'_> {
        SurfacesRef {
            records: &self.records,
            doubles: &self.doubles,
            placements: &self.placements,
            origins: &self.origins,
            slabs: &self.slabs,
            groups: &self.groups,
            universe: self.universe,
        }
    }
}

/// A writer that puts surfaces into a table one after the other. Maps and origins that several surfaces share
/// are stored once.
pub(crate) struct SurfaceWriter {
    all: Surfaces,
    places: HashMap<(u64, [[u64; 4]; 3]), u64>,
    origins: HashMap<Origin, u32>,
}

impl SurfaceWriter {
    pub(crate) fn new(universe: Universe) -> SurfaceWriter {
        let all = Surfaces { universe, ..Surfaces::default() };
        SurfaceWriter { all, places: HashMap::new(), origins: HashMap::new() }
    }

    /// Appends a surface. Its placements are the given maps in the order in which they are applied, last one
    /// first.
    ///
    /// # Errors
    ///
    /// [`Error::Limit`] if a number is the sum of more than seven doubles, if there are more than 64 maps, or
    /// too many doubles or origins; [`Error::OutOfMemory`].
    pub(crate) fn put<'n>(
        &mut self,
        kind: SurfaceKind,
        numbers: impl Iterator<Item = &'n [f64]>,
        identity: Option<(Origin, u64)>,
        placements: impl Iterator<Item = &'n [[f64; 4]; 3]>,
    ) -> Result<(), Error> {
        let mut outer = 0;
        for (rows, count) in placements.zip(1..) {
            if count > MOST_MAPS {
                let what = "placements of a surface within each other";
                return Err(Error::Limit { what, limit: MOST_MAPS as u64 });
            }
            self.places.try_reserve(1)?;
            let next = self.all.placements.len() as u64 + 1;
            let place = *self.places.entry((outer, rows.each(|row| row.each(f64::to_bits)))).or_insert(next);
            if place == next {
                memory::push(&mut self.all.placements, Placement { rows: *rows, outer })?;
            }
            outer = place;
        }
        let too_many = |_| Error::Limit { what: "doubles of all surfaces", limit: u32::MAX.into() };
        let (first, mut terms) = (u32::try_from(self.all.doubles.len()).map_err(too_many)?, 0);
        for (i, own) in (0..kind.numbers()).zip(numbers) {
            if own.len() > MOST_TERMS {
                let what = "doubles for an exact number of a surface";
                return Err(Error::Limit { what, limit: MOST_TERMS as u64 });
            }
            terms |= (own.len() as u32) << (3 * i);
            self.all.doubles.try_reserve(own.len())?;
            self.all.doubles.extend_from_slice(own);
        }
        let mut place = 0;
        if let Some((origin, which)) = identity {
            self.origins.try_reserve(1)?;
            let next = self.all.origins.len() as u32 + 1;
            place = *self.origins.entry(origin).or_insert(next);
            if place == next {
                if place > MOST_ORIGINS {
                    return Err(Error::Limit { what: "origins of slabs", limit: MOST_ORIGINS.into() });
                }
                memory::push(&mut self.all.origins, origin)?;
            }
            if which != self.all.records.len() as u64 {
                terms |= 1 << (3 * kind.numbers());
                memory::push(&mut self.all.doubles, f64::from_bits(which))?;
            }
        }
        let record = SurfaceRecord { kind: kind as u32 | place << 8, terms, first, placement: outer as u32 };
        memory::push(&mut self.all.records, record)
    }

    /// Appends a slab of a cell. Slabs of one origin follow each other, and all surfaces of other kinds come
    /// before them.
    pub(crate) fn put_cell_slab(&mut self, slab: CellSlab, origin: Origin) -> Result<(), Error> {
        memory::push(&mut self.all.slabs, slab)?;
        let end = self.all.slabs.len() as u64;
        match self.all.groups.last_mut() {
            Some(group) if group.origin == origin => group.end = end,
            _ => memory::push(&mut self.all.groups, CellSlabGroup { origin, end })?,
        }
        Ok(())
    }

    pub(crate) fn finish(self) -> Surfaces {
        self.all
    }
}

/// Most origins of slabs that are not made for a cell.
const MOST_ORIGINS: u32 = (1 << 24) - 1;

impl PartialEq for Surfaces {
    fn eq(&self, other: &Self) -> bool {
        self.view() == other.view()
    }
}

impl PartialEq for SurfacesRef<'_> {
    fn eq(&self, other: &Self) -> bool {
        // (Unverified doubles may be NaN.)
        fn bits<T: Pod>(all: &[T]) -> &[u64] {
            bytemuck::cast_slice(all)
        }
        self.records == other.records
            && bits(self.doubles) == bits(other.doubles)
            && bits(self.placements) == bits(other.placements)
            && self.origins == other.origins
            && (self.slabs, self.groups) == (other.slabs, other.groups)
    }
}

impl<'a> SurfacesRef<'a> {
    pub(crate) const NONE: SurfacesRef<'static> = SurfacesRef {
        records: &[],
        doubles: &[],
        placements: &[],
        origins: &[],
        slabs: &[],
        groups: &[],
        universe: Universe { origin: [0.0; 3], edge: 1.0 },
    };

    pub(crate) fn len(&self) -> usize {
        self.records.len() + self.slabs.len()
    }

    /// Returns the bytes of the arrays.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.records)
            + size_of_val(self.doubles)
            + size_of_val(self.placements)
            + size_of_val(self.origins)
            + size_of_val(self.slabs)
            + size_of_val(self.groups)
    }

    /// Returns the slab of a cell that is the surface of this number.
    pub(crate) fn cell_slab(&self, id: usize) -> Option<CellSlab> {
        self.slabs.get(id.checked_sub(self.records.len())?).copied()
    }

    /// Returns the group of a slab of a cell.
    pub(crate) fn group(&self, id: usize) -> Option<(usize, &'a CellSlabGroup)> {
        let place = id.checked_sub(self.records.len())? as u64;
        let group = self.groups.partition_point(|group| group.end <= place);
        Some((group, self.groups.get(group)?))
    }

    /// Returns the kind of a surface, and its numbers, in its own space; `None` where the table is damaged.
    pub(crate) fn get(&self, id: usize) -> Option<(SurfaceKind, Numbers<'a>)> {
        let Some(record) = self.records.get(id) else {
            return Some((SurfaceKind::Slab, Numbers::Slab(self.cell_slab(id)?.numbers())));
        };
        let first = record.first as usize;
        let doubles = self.doubles.get(first..first.checked_add(record.doubles())?)?;
        Some((record.kind()?, Numbers::Stored { terms: record.terms, doubles }))
    }

    /// Returns the identity of a slab, if it is known: its origin, and its number there.
    pub(crate) fn identity(&self, id: usize) -> Option<(Origin, u64)> {
        let Some(record) = self.records.get(id) else {
            let (_, group) = self.group(id)?;
            return (group.origin != [0; 2]).then_some((group.origin, self.cell_slab(id)?.number()));
        };
        let (kind, numbers) = self.get(id)?;
        let origin = (kind == SurfaceKind::Slab).then(|| record.origin().checked_sub(1))??;
        let word = numbers.get(SurfaceKind::Slab.numbers() as usize).first();
        Some((*self.origins.get(origin as usize)?, word.map_or(id as u64, |word| word.to_bits())))
    }

    /// Compares a surface with another one, of the same table or not, by the number of words that they take,
    /// the kind, the numbers of doubles, the doubles, the maps, and for slabs the identity.
    pub(crate) fn order(&self, id: usize, others: &SurfacesRef<'_>, other: usize) -> Ordering {
        let [own, theirs] = [(self, id), (others, other)].each(|(table, id)| {
            let (kind, numbers) =
                table.get(id).unwrap_or((SurfaceKind::Plane, Numbers::Stored { terms: 0, doubles: &[] }));
            (table, id, kind, numbers)
        });
        fn words<'w>(
            (table, id, kind, numbers): &'w (&SurfacesRef<'w>, usize, SurfaceKind, Numbers<'w>),
        ) -> (usize, impl Iterator<Item = u64> + 'w) {
            let universe = table.cell_slab(*id).map(|_| table.universe.rows());
            let maps =
                table.placements(*id).copied().chain(universe).flat_map(|rows| rows.into_iter().flatten());
            let doubles = numbers.doubles(*kind);
            let count = doubles.clone().count() + maps.clone().count();
            let (origin, number) = table.identity(*id).unwrap_or_default();
            let bits = doubles.chain(maps).map(f64::to_bits);
            let words = [*kind as u64, numbers.terms(*kind).into()].into_iter().chain(bits);
            (count, words.chain(origin).chain([number]))
        }
        let ((count, words), (others_count, others)) = (words(&own), words(&theirs));
        count.cmp(&others_count).then_with(|| words.cmp(others))
    }

    /// Returns the maps that place the surface of a record, in the order in which they are applied; at most
    /// one more than is legal. (Slabs of cells are in units of the universe.)
    pub(crate) fn placements(&self, id: usize) -> impl Iterator<Item = &'a [[f64; 4]; 3]> + Clone + use<'a> {
        let placements = self.placements;
        let mut next = self.records.get(id).map_or(0, |record| u64::from(record.placement));
        core::iter::from_fn(move || {
            let index = usize::try_from(next.checked_sub(1)?).ok()?;
            let placement = placements.get(index)?;
            // (Each map leads to an earlier one, so that every chain ends.)
            next = placement.outer.min(index as u64);
            Some(&placement.rows)
        })
        .take(MOST_MAPS + 1)
    }

    /// Checks that the groups contain all slabs of cells one after the other, and that no two groups have the
    /// same origin. O(n log n).
    pub(crate) fn check_groups(&self) -> Result<(), Error> {
        let slabs = self.slabs.len() as u64;
        let wrong =
            |end: u64| Error::from(Damage::Surface { surface: self.records.len() as u64 + end.min(slabs) });
        let mut end = 0;
        for group in self.groups {
            if group.end <= end {
                return Err(wrong(end));
            }
            end = group.end;
        }
        if end != slabs {
            return Err(wrong(end));
        }
        let mut origins = memory::collected((0..self.groups.len()).map(|g| (self.groups[g].origin, g)))?;
        origins.sort_unstable();
        let again = origins.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| pair[1].1).min();
        match again {
            // (The first group of an origin is not one of these.)
            Some(again) => Err(wrong(self.groups[again - 1].end)),
            None => Ok(()),
        }
    }

    /// Checks that all surfaces are complete, in the order of first use, and valid in an octree of this
    /// depth; the groups of slabs of cells are not checked. O(n).
    pub(crate) fn check(&self, depth: u8) -> Result<(), Damage> {
        let (mut doubles, mut placements, mut origins) = (0, 0, 0);
        for (id, record) in self.records.iter().enumerate() {
            let wrong = Damage::Surface { surface: id as u64 };
            let has_origin = record.origin() != 0;
            let may_be = record.kind().is_some_and(|kind| match record.terms >> (3 * kind.numbers()) {
                0 => !has_origin || kind == SurfaceKind::Slab,
                // A number that equals the index of the record is not stored.
                1 => self.identity(id).is_some_and(|(_, number)| number != id as u64),
                _ => false,
            });
            if !may_be || record.first as usize != doubles || u64::from(record.origin()) > origins + 1 {
                return Err(wrong);
            }
            doubles += record.doubles();
            let is_one =
                |(kind, numbers)| Figure::new(kind, &numbers).is_some_and(|figure| figure.is_surface());
            if !self.get(id).is_some_and(is_one) {
                return Err(wrong);
            }
            origins = origins.max(record.origin().into());
            if self.placements(id).count() > MOST_MAPS {
                return Err(wrong);
            }
            // New maps follow each other.
            let mut last = u64::from(record.placement);
            let newest = placements.max(last);
            while last > placements {
                let outer = self.placements.get(last as usize - 1).map_or(u64::MAX, |map| map.outer);
                if outer != last - 1 && (outer > placements || last != placements + 1) {
                    return Err(wrong);
                }
                last = outer;
            }
            placements = newest;
        }
        let ends = (doubles, placements, origins);
        if ends != (self.doubles.len(), self.placements.len() as u64, self.origins.len() as u64) {
            return Err(Damage::Surface { surface: self.records.len() as u64 });
        }
        // The map from units of the universe must be valid for placing surfaces.
        let has_map = self.slabs.is_empty() || Affine::new(self.universe.rows()).is_ok();
        for (place, slab) in self.slabs.iter().enumerate() {
            if !has_map || !slab.is_valid(depth) {
                return Err(Damage::Surface { surface: (self.records.len() + place) as u64 });
            }
        }
        for (index, Placement { rows, .. }) in self.placements.iter().enumerate() {
            let is_negative_zero = |c: &f64| c.to_bits() == (-0.0f64).to_bits();
            if rows.as_flattened().iter().any(is_negative_zero) || Affine::new(*rows).is_err() {
                return Err(Damage::Placement { placement: index as u64 });
            }
        }
        Ok(())
    }
}

/// The numbers of a surface, with their meaning.
struct Figure<'a> {
    kind: SurfaceKind,
    /// Each number with its doubles.
    numbers: [&'a [f64]; 10],
}

impl<'a> Figure<'a> {
    /// Returns `None` if the doubles of a number are not in the form of an exact number: none of them zero,
    /// each at most 2^-53 of the one before.
    fn new(kind: SurfaceKind, numbers: &'a Numbers<'a>) -> Option<Figure<'a>> {
        let mut own = [&[][..]; 10];
        for (i, to) in own.iter_mut().enumerate().take(kind.numbers() as usize) {
            let number = numbers.get(i);
            // (A product with 2^53 is exact or infinite, one with 2^-53 may be rounded.)
            let fits = |pair: &[f64]| pair[1].abs() * (2.0 / f64::EPSILON) <= pair[0].abs();
            let is_sum = number.iter().all(|c| c.is_finite() && *c != 0.0) && number.windows(2).all(fits);
            if !is_sum {
                return None;
            }
            *to = number;
        }
        Some(Figure { kind, numbers: own })
    }

    /// Returns the sign of a number.
    fn sign(&self, i: usize) -> i32 {
        self.numbers[i].first().map_or(0, |c| if *c > 0.0 { 1 } else { -1 })
    }

    /// Returns a number that is a single double.
    fn double(&self, i: usize) -> Option<f64> {
        match *self.numbers[i] {
            [] => Some(0.0),
            [number] => Some(number),
            _ => None,
        }
    }

    /// Returns a number that is a single double and an integer.
    fn whole(&self, i: usize) -> Option<u32> {
        let number = self.double(i)?;
        (number == f64::from(number as u32)).then_some(number as u32)
    }

    /// True if the numbers define a surface.
    fn is_surface(&self) -> bool {
        let is_constant = |linear: core::ops::Range<usize>| linear.clone().all(|i| self.sign(i) == 0);
        match self.kind {
            SurfaceKind::Plane => !is_constant(0..3),
            SurfaceKind::Quadric => !is_constant(0..9),
            SurfaceKind::Powers => {
                let is_number = |i: usize| {
                    self.double(i).is_some_and(|number| valid::numbers("surface", &[number]).is_ok())
                };
                let is_exponent = |i: usize| self.whole(i).is_some_and(|n| (1..=64).contains(&n));
                let is_high = |i: usize| self.sign(i - 2) != 0 && self.whole(i) > Some(2);
                [0, 1, 3, 4, 6, 7, 9].into_iter().all(is_number)
                    && [2, 5, 8].into_iter().all(is_exponent)
                    && [2, 5, 8].into_iter().any(is_high)
            }
            SurfaceKind::Torus => (0..3).all(|i| self.sign(i) > 0),
            SurfaceKind::Slab => {
                let is_double = (0..5).all(|i| self.double(i).is_some());
                is_double && !is_constant(0..3) && self.double(3) <= self.double(4)
            }
        }
    }
}
