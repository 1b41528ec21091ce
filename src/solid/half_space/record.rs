//! Half-spaces in stored form: exact numbers, each surface once.

use super::map::ExactMap;
use super::power::Powers;
use super::quadric::substitute;
use super::slab::{SlabIdentity, ThickPlane};
use super::torus::Torus;
use super::{HalfSpace, PlacedHalfSpace, Surface};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use crate::lattice::{Affine, Frame};
use crate::memory;
use crate::octree::cuts::{
    CellSlab, MOST_MAPS, MOST_TERMS, Origin, SurfaceKind, SurfaceWriter, Surfaces, SurfacesRef, Universe,
};
use alloc::sync::Arc;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// The identity of a surface: two surfaces are the same if their identities are equal. A plane or a quadric
/// is identified by its polynomial in model space, up to a factor, and any other surface by its figure and
/// its placement.
#[derive(PartialEq, Eq, Hash)]
enum Identity {
    Polynomial(Vec<Dyadic>),
    Figure(SurfaceKind, Vec<Dyadic>, Vec<Dyadic>),
}

impl ExactMap {
    /// The map's numbers in a normal form, which is the same for every form of the same map.
    fn primitive(self) -> Vec<Dyadic> {
        let mut numbers = self.rows.into_iter().flatten().chain([self.w]).collect::<Vec<_>>();
        Dyadic::make_primitive(&mut numbers);
        numbers
    }
}

impl PlacedHalfSpace {
    /// Returns the exact map from another space into the space of the half-space.
    pub(crate) fn map(&self, from: ExactMap) -> Result<ExactMap, Error> {
        self.placements.iter().try_fold(from, |map, placement| map.of_placed(placement))
    }

    /// Returns `Some` if two surfaces are the same; `Some(true)` if one function is positive where the other
    /// is negative.
    pub(crate) fn same(&self, other: &PlacedHalfSpace) -> Result<Option<bool>, Error> {
        Ok(match (self.identity()?, other.identity()?) {
            (Some((own, turned)), Some((others, other_turned))) if own == others => {
                Some(turned != other_turned)
            }
            _ => None,
        })
    }

    /// Returns the identity of the surface, and whether its function is negative where the identity's
    /// function is positive. `None` if the surface has no exact numbers.
    fn identity(&self) -> Result<Option<(Identity, bool)>, Error> {
        let map = || self.map(ExactMap::identity());
        let polynomial = |mut numbers: Vec<Dyadic>| {
            let turned = Dyadic::make_primitive(&mut numbers);
            (Identity::Polynomial(numbers), turned)
        };
        Ok(Some(match &*self.half_space.0 {
            Surface::Plane(plane) => {
                let map = map()?;
                let (numbers, turned) = (map.linear(plane).to_vec(), map.w.sign() < 0);
                let (identity, negative) = polynomial(numbers);
                (identity, negative != turned)
            }
            Surface::Quadric(quadric) => polynomial(substitute(quadric, &map()?).to_vec()),
            Surface::Powers(_) | Surface::Torus(_) => {
                let Some((kind, numbers)) = self.half_space.numbers() else { return Ok(None) };
                (Identity::Figure(kind, numbers, map()?.primitive()), false)
            }
            Surface::Slab(slab) => {
                let (Some(identity), Some((kind, mut numbers))) = (&slab.identity, self.half_space.numbers())
                else {
                    return Ok(None);
                };
                // (A file may claim that two slabs are the same that are not.)
                numbers.extend(identity.numbers());
                (Identity::Figure(kind, numbers, map()?.primitive()), false)
            }
            Surface::Host(_) => return Ok(None),
        }))
    }

    /// Returns the same half-space with its first placements applied to its numbers, as far as this saves
    /// doubles.
    fn shortened(&self) -> Result<PlacedHalfSpace, Error> {
        let (mut half_space, mut left) = (self.half_space.clone(), self.placements.len());
        while let Some(placement) = left.checked_sub(1).map(|last| &self.placements[last]) {
            let moved = match &*half_space.0 {
                Surface::Plane(plane) => {
                    let map = ExactMap::identity().of_placed(placement)?;
                    let numbers = map.linear(plane);
                    HalfSpace::linear(if map.w.sign() < 0 { numbers.each(|c| -&c) } else { numbers })
                }
                Surface::Quadric(quadric) => {
                    HalfSpace::exactly(substitute(quadric, &ExactMap::identity().of_placed(placement)?))
                }
                _ => break,
            };
            match (moved.doubles(), half_space.doubles()) {
                (Some(moved), Some(own)) if moved <= own + 12 => {}
                _ => break,
            }
            (half_space, left) = (moved, left - 1);
        }
        Ok(PlacedHalfSpace { half_space, placements: self.placements[..left].into() })
    }
}

impl HalfSpace {
    /// Returns the kind of the surface and its numbers, without a slab's identity. `None` for functions of
    /// the host.
    fn numbers(&self) -> Option<(SurfaceKind, Vec<Dyadic>)> {
        Some(match &*self.0 {
            Surface::Plane(plane) => (SurfaceKind::Plane, plane.to_vec()),
            Surface::Quadric(quadric) => (SurfaceKind::Quadric, quadric.to_vec()),
            Surface::Powers(Powers { terms, constant }) => {
                let terms = terms
                    .iter()
                    .flat_map(|&(coefficient, centre, exponent)| [coefficient, centre, f64::from(exponent)]);
                (SurfaceKind::Powers, terms.chain([*constant]).map(Dyadic::new).collect())
            }
            Surface::Torus(Torus { major, square, scale, shift }) => {
                (SurfaceKind::Torus, [major, square, scale, shift].each(Clone::clone).to_vec())
            }
            Surface::Slab(ThickPlane { normal: [x, y, z], inner, outer, .. }) => {
                (SurfaceKind::Slab, [*x, *y, *z, *inner, *outer].each(Dyadic::new).to_vec())
            }
            Surface::Host(_) => return None,
        })
    }

    /// The number of doubles that the numbers take.
    fn doubles(&self) -> Option<usize> {
        let (_, numbers) = self.numbers()?;
        numbers.iter().map(|number| Some(number.expansion(MOST_TERMS)?.len())).sum()
    }

    /// Returns the half-space of stored numbers; `None` if they are invalid.
    fn stored(kind: SurfaceKind, numbers: &[Dyadic], identity: Option<SlabIdentity>) -> Option<HalfSpace> {
        let is_constant = |linear: &[Dyadic]| linear.iter().all(Dyadic::is_zero);
        Some(match (kind, numbers) {
            (SurfaceKind::Plane, [a, b, c, d]) => {
                let plane = [a, b, c, d].each(Clone::clone);
                if is_constant(&plane[..3]) {
                    return None;
                }
                HalfSpace::linear(plane)
            }
            (SurfaceKind::Quadric, numbers) => {
                let quadric: [Dyadic; 10] = numbers.to_vec().try_into().ok()?;
                if is_constant(&quadric[..9]) {
                    return None;
                }
                HalfSpace::exactly(quadric)
            }
            (SurfaceKind::Powers, numbers) => {
                let n: Vec<f64> = numbers.iter().map(Dyadic::exactly).collect::<Option<_>>()?;
                let exponent =
                    |n: f64| ((1.0..=64.0).contains(&n) && n == f64::from(n as u32)).then_some(n as u32);
                let term = |i: usize| Some((n[3 * i], n[3 * i + 1], exponent(n[3 * i + 2])?));
                HalfSpace::power([term(0)?, term(1)?, term(2)?], n[9]).ok()?
            }
            (SurfaceKind::Torus, [major, square, scale, shift]) => {
                if [major, square, scale].iter().any(|number| number.sign() <= 0) {
                    return None;
                }
                let [major, square, scale, shift] = [major, square, scale, shift].each(Clone::clone);
                HalfSpace::ring(Torus { major, square, scale, shift })
            }
            (SurfaceKind::Slab, [x, y, z, inner, outer]) => {
                let all = [x, y, z, inner, outer].each(Dyadic::exactly);
                let [Some(x), Some(y), Some(z), Some(inner), Some(outer)] = all else { return None };
                if [x, y, z] == [0.0; 3] || inner > outer {
                    return None;
                }
                HalfSpace::slab([x, y, z], inner, outer, identity)
            }
            _ => return None,
        })
    }

    /// Returns the points where the function is negative.
    fn negated(&self) -> HalfSpace {
        match &*self.0 {
            Surface::Plane(plane) => HalfSpace::linear(plane.each_ref().each(|c| -c)),
            Surface::Quadric(quadric) => HalfSpace::exactly(quadric.each_ref().each(|c| -c)),
            _ => self.clone(),
        }
    }
}

/// A set of distinct surfaces: equal surfaces have one number.
#[derive(Default)]
pub(crate) struct Pool {
    known: HashMap<Identity, u32>,
    pub(crate) surfaces: Vec<PlacedHalfSpace>,
}

impl Pool {
    /// Returns the number of a surface, and whether the numbered function is positive where this one is
    /// negative. `None` if the surface has no exact numbers.
    pub(crate) fn number(&mut self, surface: &PlacedHalfSpace) -> Result<Option<(u32, bool)>, Error> {
        let Some((identity, turned)) = surface.identity()? else { return Ok(None) };
        self.known.try_reserve(1)?;
        let next = self.surfaces.len() as u32;
        let number = *self.known.entry(identity).or_insert(next);
        let mut short = surface.shortened()?;
        if turned {
            short.half_space = short.half_space.negated();
        }
        if number == next {
            memory::push(&mut self.surfaces, short)?;
        } else if let Some(before) = self.surfaces.get_mut(number as usize)
            && short.size() < before.size()
        {
            *before = short;
        }
        Ok(Some((number, turned)))
    }

    /// Returns the surfaces in an order that does not depend on their numbers, and for each number its place
    /// in that order.
    pub(crate) fn sorted(self) -> Result<(Vec<PlacedHalfSpace>, Vec<u32>), Error> {
        let keys = memory::collected(self.surfaces.iter().map(PlacedHalfSpace::size))?;
        let mut order = memory::collected(0..self.surfaces.len())?;
        order.sort_unstable_by(|&a, &b| keys[a].cmp(&keys[b]));
        let mut places = memory::filled(order.len(), 0)?;
        let mut surfaces = memory::with_capacity(order.len())?;
        for (place, &number) in (0..).zip(&order) {
            places[number] = place;
            surfaces.push(self.surfaces[number].clone());
        }
        Ok((surfaces, places))
    }
}

impl PlacedHalfSpace {
    /// The sort key of surfaces, and of records of the same surface; [`SurfacesRef::order`] orders stored
    /// surfaces alike: the number of doubles, the kind, and the doubles themselves.
    pub(crate) fn size(&self) -> (usize, Vec<u64>) {
        let (mut bits, mut doubles) = (Vec::new(), Vec::new());
        if let Some((kind, numbers)) = self.half_space.numbers() {
            let terms = numbers.iter().map(|number| number.expansion(MOST_TERMS)).collect::<Option<Vec<_>>>();
            let terms = terms.unwrap_or_default();
            let counts = (0..).zip(&terms).fold(0, |all, (i, own)| all | (own.len() as u64) << (3 * i));
            bits.extend([kind as u64, counts]);
            doubles = terms.iter().flat_map(|own| own.iter().copied()).collect();
        }
        let maps = self.placements.iter().rev().flat_map(|map| map.rows().as_flattened().iter().copied());
        bits.extend(doubles.into_iter().chain(maps).map(f64::to_bits));
        (bits.len(), bits)
    }

    /// Returns the slab of a cell of a universe, and its origin, or two zeros if it has no origin.
    pub(crate) fn cell_slab(&self, frame: &Frame) -> Option<(CellSlab, Origin)> {
        let Surface::Slab(ThickPlane { cell_slab, identity, .. }) = &*self.half_space.0 else { return None };
        let is_there = matches!(&*self.placements, [only] if *only.rows() == Universe::of(frame).rows());
        let origin = identity.as_ref().map_or([0; 2], |identity| identity.origin);
        // (A tree of less depth than the slab was made for has no such cell.)
        let has_cell = |slab: &CellSlab| slab.is_valid(frame.depth());
        cell_slab.filter(|slab| is_there && has_cell(slab)).map(|slab| (slab, origin))
    }

    /// Writes surfaces of a tree on a frame one after the other. Maps that several surfaces share are written
    /// once. Slabs of cells come at the end, grouped by origin.
    ///
    /// # Errors
    /// [`Error::Limit`] if a number is the sum of more than seven doubles, if a surface has more than 64
    /// maps, or if there are too many doubles; [`Error::OutOfMemory`].
    pub(crate) fn write<'s>(
        surfaces: impl ExactSizeIterator<Item = &'s PlacedHalfSpace>,
        frame: &Frame,
    ) -> Result<Surfaces, Error> {
        let mut all = SurfaceWriter::new(Universe::of(frame));
        for surface in surfaces {
            if let Some((slab, origin)) = surface.cell_slab(frame) {
                all.put_cell_slab(slab, origin)?;
                continue;
            }
            let too_long = || Error::Limit {
                what: "doubles for an exact number of a surface",
                limit: MOST_TERMS as u64,
            };
            let (kind, numbers) = surface.half_space.numbers().ok_or_else(too_long)?;
            let numbers =
                numbers.iter().map(|number| number.expansion(MOST_TERMS)).collect::<Option<Vec<_>>>();
            let numbers = numbers.ok_or_else(too_long)?;
            let identity = match &*surface.half_space.0 {
                Surface::Slab(ThickPlane { identity, .. }) => identity.as_ref().map(|i| (i.origin, i.number)),
                _ => None,
            };
            let placements = surface.placements.iter().map(Affine::rows);
            all.put(kind, numbers.iter().map(|number| &**number), identity, placements)?;
        }
        Ok(all.finish())
    }

    /// Reads a stored surface; `None` if it is damaged.
    pub(crate) fn read(surfaces: &SurfacesRef<'_>, id: usize) -> Option<PlacedHalfSpace> {
        let identity = surfaces.identity(id).map(|(origin, number)| SlabIdentity { origin, number });
        if let Some(slab) = surfaces.cell_slab(id) {
            let placements = Arc::from([Affine::new(surfaces.universe.rows()).ok()?]);
            return Some(PlacedHalfSpace { half_space: HalfSpace::of_cell(slab, identity), placements });
        }
        let (kind, numbers) = surfaces.get(id)?;
        let numbers: Vec<Dyadic> =
            (0..kind.numbers() as usize).map(|i| Dyadic::sum(numbers.get(i))).collect();
        let mut placements =
            surfaces.placements(id).map(|rows| Affine::new(*rows).ok()).collect::<Option<Vec<_>>>()?;
        if placements.len() > MOST_MAPS {
            return None;
        }
        placements.reverse();
        Some(PlacedHalfSpace {
            half_space: HalfSpace::stored(kind, &numbers, identity)?,
            placements: Arc::from(placements),
        })
    }

    /// Returns the half-space on the universe of a frame.
    pub(crate) fn on(&self, frame: &Frame) -> Result<super::Placed, Error> {
        Ok(self.half_space.0.on(&self.map(ExactMap::from_universe(frame))?, frame))
    }
}
