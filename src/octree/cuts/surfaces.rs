//! The table of surfaces: each is the boundary of the points where a function is positive, given in numbers that are exact.

use crate::error::{Damage, Error};
use crate::lattice::{Affine, valid};
use crate::memory;
use alloc::vec::Vec;
use bytemuck::{Pod, Zeroable};
use core::cmp::Ordering;
use hashbrown::HashMap;

/// What kind of function a [`StoredSurface`](super::StoredSurface) has.
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
    /// A plane with a width: its normal, the two offsets between which the boundary lies (the first is that of the inner side, which
    /// counts as positive), and which of all slabs it is: the number of its origin, plus one, and its number there; two zeros if it
    /// has none. See [`StoredSurface::origin`](super::StoredSurface::origin).
    Slab = 4,
}

impl SurfaceKind {
    /// Numbers of a surface.
    pub(crate) const fn numbers(self) -> u32 {
        match self {
            SurfaceKind::Plane | SurfaceKind::Torus => 4,
            SurfaceKind::Slab => 7,
            SurfaceKind::Quadric | SurfaceKind::Powers => 10,
        }
    }

    /// Numbers that say where a surface is, and not which of all it is.
    pub(crate) const fn figures(self) -> u32 {
        match self {
            SurfaceKind::Slab => 5,
            _ => self.numbers(),
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
    /// A [`SurfaceKind`].
    pub kind: u32,
    /// Of how many doubles each number is the sum, three bits a number, from the lowest on.
    pub terms: u32,
    /// Its first double.
    pub first: u32,
    /// The first map that it is placed by, plus one; 0 for none.
    pub placement: u32,
}

/// Most doubles of a number.
pub(crate) const MOST_TERMS: usize = 7;

/// Most maps that a surface is placed by. It bounds the work and the memory for a surface.
pub(crate) const MOST_MAPS: usize = 64;

impl SurfaceRecord {
    fn doubles(&self) -> usize {
        (0..10).map(|i| (self.terms >> (3 * i) & 7) as usize).sum()
    }
}

/// An affine map.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Placement {
    /// Rows of `[M | t]`.
    pub rows: [[f64; 4]; 3],
    /// The map that follows, plus one; 0 for none. It comes before this one in the table.
    pub outer: u64,
}

/// What slabs were made from: a fingerprint of 128 bits, the lower half first.
pub(crate) type Origin = [u64; 2];

/// Surfaces in memory.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Surfaces {
    pub records: Vec<SurfaceRecord>,
    pub doubles: Vec<f64>,
    pub placements: Vec<Placement>,
    pub origins: Vec<Origin>,
}

/// Surfaces, borrowed. They are equal if all bits are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfacesRef<'a> {
    pub records: &'a [SurfaceRecord],
    pub doubles: &'a [f64],
    pub placements: &'a [Placement],
    pub origins: &'a [Origin],
}

impl Surfaces {
    pub(crate) fn view(&self) -> SurfacesRef<'_> {
        SurfacesRef {
            records: &self.records,
            doubles: &self.doubles,
            placements: &self.placements,
            origins: &self.origins,
        }
    }
}

/// Puts surfaces into a table one after the other; maps and origins that several share stand once.
#[derive(Default)]
pub(crate) struct SurfaceWriter {
    all: Surfaces,
    places: HashMap<(u64, [[u64; 4]; 3]), u64>,
    origins: HashMap<Origin, u32>,
}

impl SurfaceWriter {
    /// A surface, whose placements are those maps in the order in which they are applied, last one first.
    ///
    /// # Errors
    /// [`Error::Limit`] if a number is the sum of more than seven doubles, if there are more than 64 maps, or too many doubles;
    /// [`Error::OutOfMemory`].
    pub(crate) fn put<'n>(
        &mut self,
        kind: SurfaceKind,
        numbers: impl Iterator<Item = &'n [f64]>,
        identity: Option<(Origin, u32)>,
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
            let place = *self.places.entry((outer, rows.map(|row| row.map(f64::to_bits)))).or_insert(next);
            if place == next {
                memory::push(&mut self.all.placements, Placement { rows: *rows, outer })?;
            }
            outer = place;
        }
        let too_many = |_| Error::Limit { what: "doubles of all surfaces", limit: u32::MAX.into() };
        let (first, mut terms) = (u32::try_from(self.all.doubles.len()).map_err(too_many)?, 0);
        let mut number = |i: u32, own: &[f64]| {
            if own.len() > MOST_TERMS {
                let what = "doubles for an exact number of a surface";
                return Err(Error::Limit { what, limit: MOST_TERMS as u64 });
            }
            terms |= (own.len() as u32) << (3 * i);
            self.all.doubles.try_reserve(own.len())?;
            self.all.doubles.extend_from_slice(own);
            Ok(())
        };
        for (i, own) in (0..kind.figures()).zip(numbers) {
            number(i, own)?;
        }
        if let Some((origin, which)) = identity {
            self.origins.try_reserve(1)?;
            let next = self.all.origins.len() as u32 + 1;
            let place = *self.origins.entry(origin).or_insert(next);
            if place == next {
                memory::push(&mut self.all.origins, origin)?;
            }
            for (i, whole) in (kind.figures()..).zip([place, which]) {
                let double = [f64::from(whole)];
                number(i, if whole == 0 { &[] } else { &double })?;
            }
        }
        let record = SurfaceRecord { kind: kind as u32, terms, first, placement: outer as u32 };
        memory::push(&mut self.all.records, record)
    }

    pub(crate) fn finish(self) -> Surfaces {
        self.all
    }
}

impl PartialEq for SurfacesRef<'_> {
    fn eq(&self, other: &Self) -> bool {
        // (Doubles that nobody has verified may be no numbers.)
        fn bits<T: Pod>(all: &[T]) -> &[u64] {
            bytemuck::cast_slice(all)
        }
        self.records == other.records
            && bits(self.doubles) == bits(other.doubles)
            && bits(self.placements) == bits(other.placements)
            && self.origins == other.origins
    }
}

impl<'a> SurfacesRef<'a> {
    pub(crate) const NONE: SurfacesRef<'static> =
        SurfacesRef { records: &[], doubles: &[], placements: &[], origins: &[] };

    pub(crate) fn len(&self) -> usize {
        self.records.len()
    }

    /// The kind of a surface, and its numbers, each as the doubles whose sum it is; `None` where the table is damaged.
    pub(crate) fn get(
        &self,
        id: usize,
    ) -> Option<(SurfaceKind, impl Iterator<Item = &'a [f64]> + Clone + use<'a>)> {
        let record = *self.records.get(id)?;
        let kind = SurfaceKind::of(record.kind)?;
        let first = record.first as usize;
        let mut rest = self.doubles.get(first..first + record.doubles())?;
        let numbers = (0..kind.numbers()).map(move |i| {
            let (own, others) = rest.split_at((record.terms >> (3 * i) & 7) as usize);
            rest = others;
            own
        });
        Some((kind, numbers))
    }

    /// Which of all slabs a slab is, if that is known: its origin, and its number there.
    pub(crate) fn identity(&self, id: usize) -> Option<(Origin, u32)> {
        let (kind, numbers) = self.get(id)?;
        let mut whole = numbers.skip(5).map(|number| number.iter().sum::<f64>() as u32);
        let origin = (kind == SurfaceKind::Slab).then(|| whole.next())??.checked_sub(1)?;
        Some((*self.origins.get(origin as usize)?, whole.next()?))
    }

    /// What surfaces are ordered by, and records that tell of one surface: the number of words that they take; the kind, of how
    /// many doubles each number is the sum, the doubles, and the maps; and, of slabs, which they are.
    fn words(&self, id: usize) -> (usize, impl Iterator<Item = u64> + use<'a>) {
        let (kind, numbers) = self.get(id).unzip();
        let figures = kind.map_or(0, SurfaceKind::figures) as usize;
        let doubles = numbers.into_iter().flatten().take(figures).flatten();
        let maps = self.placements(id).flat_map(|rows| rows.as_flattened());
        let count = 2 + doubles.clone().count() + maps.clone().count();
        let terms = self.records.get(id).map_or(0, |record| record.terms & ((1 << (3 * figures)) - 1));
        let (origin, number) = self.identity(id).unwrap_or_default();
        let which = origin.into_iter().chain([number.into()]);
        let bits = doubles.chain(maps).map(|c| c.to_bits());
        (count, [kind.map_or(0, |kind| kind as u64), terms.into()].into_iter().chain(bits).chain(which))
    }

    /// Compares a surface with another one, of the same table or not, by their words.
    pub(crate) fn order(&self, id: usize, others: &SurfacesRef<'_>, other: usize) -> Ordering {
        let ((count, words), (others_count, others)) = (self.words(id), others.words(other));
        count.cmp(&others_count).then_with(|| words.cmp(others))
    }

    /// The maps that a surface is placed by, in the order in which they are applied; at most one more than is legal.
    pub(crate) fn placements(&self, id: usize) -> impl Iterator<Item = &'a [[f64; 4]; 3]> + Clone + use<'a> {
        let placements = self.placements;
        let mut next = self.records.get(id).map_or(0, |record| u64::from(record.placement));
        core::iter::from_fn(move || {
            let index = usize::try_from(next.checked_sub(1)?).ok()?;
            let placement = placements.get(index)?;
            // (Each leads to an earlier one, so that every chain ends.)
            next = placement.outer.min(index as u64);
            Some(&placement.rows)
        })
        .take(MOST_MAPS + 1)
    }

    /// Checks that all is there, in the order of first use, and that every surface is one. O(n).
    pub(crate) fn check(&self) -> Result<(), Damage> {
        let (mut doubles, mut placements, mut origins) = (0, 0, 0);
        for (id, record) in self.records.iter().enumerate() {
            let wrong = Damage::Surface { surface: id as u64 };
            let kind = SurfaceKind::of(record.kind).filter(|kind| record.terms >> (3 * kind.numbers()) == 0);
            if kind.is_none() || record.first as usize != doubles {
                return Err(wrong);
            }
            doubles += record.doubles();
            let origin = self.get(id).and_then(|(kind, numbers)| Figure::new(kind, numbers)?.origin());
            let Some(origin) = origin.filter(|&origin| origin <= origins + 1) else { return Err(wrong) };
            origins = origins.max(origin);
            if self.placements(id).count() > MOST_MAPS {
                return Err(wrong);
            }
            // Of new maps each follows the one before.
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
        for (index, Placement { rows, .. }) in self.placements.iter().enumerate() {
            let is_negative_zero = |c: &f64| c.to_bits() == (-0.0f64).to_bits();
            if rows.as_flattened().iter().any(is_negative_zero) || Affine::new(*rows).is_err() {
                return Err(Damage::Placement { placement: index as u64 });
            }
        }
        Ok(())
    }
}

/// The numbers of a surface, of which it is known what they are.
struct Figure<'a> {
    kind: SurfaceKind,
    /// Each with its doubles.
    numbers: [&'a [f64]; 10],
}

impl<'a> Figure<'a> {
    /// `None` if the doubles of a number are not as an exact number is written: none of them zero, each at most 2^-53 of the one
    /// before.
    fn new(kind: SurfaceKind, numbers: impl Iterator<Item = &'a [f64]>) -> Option<Figure<'a>> {
        let mut own = [&[][..]; 10];
        for (to, number) in own.iter_mut().zip(numbers) {
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

    /// The sign of a number.
    fn sign(&self, i: usize) -> i32 {
        self.numbers[i].first().map_or(0, |c| if *c > 0.0 { 1 } else { -1 })
    }

    /// A number that is one double.
    fn double(&self, i: usize) -> Option<f64> {
        match *self.numbers[i] {
            [] => Some(0.0),
            [number] => Some(number),
            _ => None,
        }
    }

    /// The same that is a whole number.
    fn whole(&self, i: usize) -> Option<u32> {
        let number = self.double(i)?;
        (number == f64::from(number as u32)).then_some(number as u32)
    }

    /// The origin of a slab, 0 for none; `None` if the numbers make no surface.
    fn origin(&self) -> Option<u64> {
        let is_constant = |linear: core::ops::Range<usize>| linear.clone().all(|i| self.sign(i) == 0);
        let some = |is: bool, origin: u32| is.then_some(u64::from(origin));
        match self.kind {
            SurfaceKind::Plane => some(!is_constant(0..3), 0),
            SurfaceKind::Quadric => some(!is_constant(0..9), 0),
            SurfaceKind::Powers => {
                for i in [0, 1, 3, 4, 6, 7, 9] {
                    valid::numbers("surface", &[self.double(i)?]).ok()?;
                }
                let is_exponent = |i: usize| self.whole(i).is_some_and(|n| (1..=64).contains(&n));
                let is_high = |i: usize| self.sign(i - 2) != 0 && self.whole(i) > Some(2);
                some([2, 5, 8].into_iter().all(is_exponent) && [2, 5, 8].into_iter().any(is_high), 0)
            }
            SurfaceKind::Torus => some((0..3).all(|i| self.sign(i) > 0), 0),
            SurfaceKind::Slab => {
                for i in 0..3 {
                    self.double(i)?;
                }
                let (origin, number) = (self.whole(5)?, self.whole(6)?);
                let is_ordered = self.double(3)? <= self.double(4)?;
                some(!is_constant(0..3) && is_ordered && (origin != 0 || number == 0), origin)
            }
        }
    }
}
