//! The table of surfaces: each is the boundary of the points where a function is positive, given in numbers that are exact.

use crate::error::Damage;
use alloc::vec::Vec;
use bytemuck::{Pod, Zeroable};

/// What kind of function a surface has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub(crate) enum SurfaceKind {
    /// a x + b y + c z + d: four numbers.
    Plane = 0,
    /// A polynomial of degree two: ten numbers, in the order of [`HalfSpace::quadric`](crate::solid::HalfSpace::quadric).
    Quadric = 1,
    /// A sum of powers: coefficient, centre and exponent an axis, and the constant.
    Powers = 2,
    /// A torus: radius of its circle, square of the other one, scale and shift.
    Torus = 3,
    /// A plane with a width: normal, and the two offsets between which the boundary lies.
    Slab = 4,
}

impl SurfaceKind {
    /// Numbers of a surface.
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

/// Surfaces in memory.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Surfaces {
    pub records: Vec<SurfaceRecord>,
    pub doubles: Vec<f64>,
    pub placements: Vec<Placement>,
}

/// Surfaces, borrowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SurfacesRef<'a> {
    pub records: &'a [SurfaceRecord],
    pub doubles: &'a [f64],
    pub placements: &'a [Placement],
}

impl Surfaces {
    pub(crate) fn view(&self) -> SurfacesRef<'_> {
        SurfacesRef { records: &self.records, doubles: &self.doubles, placements: &self.placements }
    }
}

impl<'a> SurfacesRef<'a> {
    pub(crate) fn len(&self) -> usize {
        self.records.len()
    }

    /// The kind of a surface, and its numbers, each as the doubles whose sum it is; `None` where the table is damaged.
    pub(crate) fn get(&self, id: usize) -> Option<(SurfaceKind, impl Iterator<Item = &'a [f64]> + use<'a>)> {
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

    /// The maps that a surface is placed by, in the order in which they are applied; at most as many as there are.
    pub(crate) fn placements(&self, id: usize) -> impl Iterator<Item = &'a [[f64; 4]; 3]> + use<'a> {
        let placements = self.placements;
        let mut next = self.records.get(id).map_or(0, |record| u64::from(record.placement));
        core::iter::from_fn(move || {
            let index = usize::try_from(next.checked_sub(1)?).ok()?;
            let placement = placements.get(index)?;
            // (Each leads to an earlier one, so that every chain ends.)
            next = placement.outer.min(index as u64);
            Some(&placement.rows)
        })
    }

    /// Checks that all is there, and that numbers are numbers.
    pub(crate) fn check(&self) -> Result<(), Damage> {
        let wrong = |what: bool| if what { Err(Damage::Cuts) } else { Ok(()) };
        let mut next = 0;
        for record in self.records {
            let kind = SurfaceKind::of(record.kind).ok_or(Damage::Cuts)?;
            wrong(record.terms >> (3 * kind.numbers()) != 0 || record.first as usize != next)?;
            wrong(record.placement as usize > self.placements.len())?;
            next += record.doubles();
        }
        wrong(next != self.doubles.len() || !self.doubles.iter().all(|number| number.is_finite()))?;
        for (index, placement) in self.placements.iter().enumerate() {
            wrong(placement.outer > index as u64)?;
            wrong(!placement.rows.as_flattened().iter().all(|number| number.is_finite()))?;
        }
        Ok(())
    }
}
