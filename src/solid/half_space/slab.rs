//! Planes with a width: surfaces whose exact place is unknown.

use super::bounds::{Octants, Sides};
use super::linear;
use super::map::ExactMap;
use super::tangent::Tangent;
use super::{HalfSpace, PlacedHalfSpace, Surface};
use crate::cut::Slab;
use crate::lattice::Each;
use crate::lattice::exact::{Dyadic, sqrt};
use crate::lattice::{Cube, Interval, axes};
use crate::octree::cuts::{CellSlab, Origin};
use alloc::sync::Arc;

/// A plane with a width: a point p with `normal` · p < `inner` is inside, and one with `normal` · p > `outer`
/// is outside. Nothing is known of other points.
pub(crate) struct ThickPlane {
    pub(crate) normal: [f64; 3],
    pub(crate) inner: f64,
    pub(crate) outer: f64,
    pub(crate) identity: Option<SlabIdentity>,
    /// The slab in whole numbers, if it was made for one cell and is given in units of a universe.
    pub(crate) cell_slab: Option<CellSlab>,
}

impl HalfSpace {
    /// Returns the slab of a cell in model space, rounded outward.
    pub(crate) fn layer(cube: &Cube<'_>, slab: &Slab) -> HalfSpace {
        let Cube { frame, cell } = cube;
        // The centres of cells are exact in units of the universe.
        let unit = |axis: usize| (2 * u64::from(cell.at[axis]) + 1) as f64 / (2u64 << cell.level) as f64;
        let centre = axes(|axis| {
            Interval::exactly(frame.edge())
                .times(Interval::exactly(unit(axis)))
                .plus(Interval::exactly(frame.origin()[axis]))
        });
        let along = (0..3).fold(Interval::exactly(0.0), |sum, axis| {
            sum.plus(Interval::exactly(slab.normal[axis]).times(centre[axis]))
        });
        let half = Interval::exactly(cube.half_edge());
        let offset = |own: f64| half.times(Interval::exactly(own)).plus(along);
        HalfSpace::slab(slab.normal, offset(slab.inner).lower, offset(slab.outer).upper, None)
    }

    /// Returns a slab of a cell, in units of the universe.
    pub(crate) fn of_cell(slab: CellSlab, identity: Option<SlabIdentity>) -> HalfSpace {
        let [x, y, z, inner, outer] = slab.numbers();
        let (normal, cell_slab) = ([x, y, z], Some(slab));
        HalfSpace(Arc::new(Surface::Slab(ThickPlane { normal, inner, outer, identity, cell_slab })))
    }

    /// Returns the normal and the ends of a plane with a width; `None` for others.
    pub(crate) fn layer_ends(&self) -> Option<([f64; 3], [f64; 2])> {
        match &*self.0 {
            &Surface::Slab(ThickPlane { normal, inner, outer, .. }) => Some((normal, [inner, outer])),
            _ => None,
        }
    }

    /// Returns a layer, with no identity of its own, that is `times` as wide. `None` if it would be wider
    /// than `most`, or if the half-space has no width.
    pub(crate) fn widened(&self, times: f64, most: f64) -> Option<HalfSpace> {
        let (normal, [inner, outer]) = self.layer_ends()?;
        let length = sqrt(normal.iter().map(|c| c * c).sum::<f64>());
        let (width, room) = (times * (outer - inner), 0.5 * (times - 1.0) * (outer - inner));
        let is_thin = width > 0.0 && width <= most * length;
        is_thin.then(|| HalfSpace::slab(normal, (inner - room).next_down(), (outer + room).next_up(), None))
    }
}

impl PlacedHalfSpace {
    /// Returns the unit of the half-space's own space, in model units before it is moved: the edge of the
    /// universe for a slab of a cell, 1 for others.
    pub(crate) fn unit(&self) -> f64 {
        match (&*self.half_space.0, self.placements.first()) {
            (Surface::Slab(ThickPlane { cell_slab: Some(_), .. }), Some(universe)) => universe.rows()[0][0],
            _ => 1.0,
        }
    }
}

/// The identity of a slab. A slab stands for an unknown set, so that only its origin distinguishes it: two
/// slabs with the same coefficients may stand for two sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SlabIdentity {
    /// A fingerprint of the solid from which the slab was made, and of how the solid was built.
    pub(crate) origin: Origin,
    /// The slab's number within its origin.
    pub(crate) number: u64,
}

impl SlabIdentity {
    /// The identity as exact numbers.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = Dyadic> {
        let [low, high] = self.origin;
        [low, high, self.number]
            .into_iter()
            .flat_map(|word| [word as u32, (word >> 32) as u32])
            .map(|half| Dyadic::new(f64::from(half)))
    }
}

/// A plane with a width on a universe, in unit coordinates.
pub(crate) struct PlacedSlab {
    normal: [f64; 3],
    /// The offsets, moved outward by more than all roundings on the universe.
    inner: f64,
    outer: f64,
    /// More than the distance by which the offsets were moved.
    slack: f64,
}

impl PlacedSlab {
    pub(crate) fn new(given: &ThickPlane, map: &ExactMap) -> PlacedSlab {
        let [x, y, z] = given.normal.each(Dyadic::new);
        let [a, b, c, d] = map.linear(&[x, y, z, Dyadic::zero()]);
        // With w positive, the inequalities keep their direction.
        let turned = |c: Dyadic| if map.w.sign() < 0 { -&c } else { c };
        let [a, b, c, d, w] = [a, b, c, d, map.w.clone()].each(turned);
        let scale = -linear::magnitude([&a, &b, &c]);
        let [inner, outer] = [given.inner, given.outer].each(|offset| {
            // An offset is infinite if only one side is known.
            let exact =
                offset.is_finite().then(|| (&(&Dyadic::new(offset) * &w) - &d).shifted(scale).rounded());
            exact.unwrap_or(offset)
        });
        let normal = [a, b, c].each(|c| c.shifted(scale).rounded());
        // A term is rounded at most eight times on [−1, 2]³.
        let slack = |offset: f64| {
            let size: f64 = normal.iter().map(|c| 2.0 * c.abs()).sum::<f64>() + offset.abs();
            if size.is_finite() { 16.0 * f64::EPSILON * size } else { 0.0 }
        };
        let (below, above) = (slack(inner), slack(outer));
        PlacedSlab { normal, inner: inner - below, outer: outer + above, slack: below.max(above) }
    }

    pub(crate) fn slack(&self) -> f64 {
        self.slack
    }

    fn at(&self, t: [f64; 3]) -> f64 {
        let [a, b, c] = self.normal;
        (a * t[0] + b * t[1]) + c * t[2]
    }

    /// Returns for which of the eight cells all points are inside, and for which all are outside.
    pub(crate) fn sides(&self, at: &Octants) -> Sides {
        let mut sides = Sides { inside: 0, outside: 0 };
        for k in 0..8 {
            let (low, high) = at.octant(k);
            let corner =
                |upper: bool| axes(|i| if (self.normal[i] > 0.0) == upper { high[i] } else { low[i] });
            sides.inside |= u8::from(self.at(corner(true)) <= self.inner) << k;
            sides.outside |= u8::from(self.at(corner(false)) >= self.outer) << k;
        }
        sides
    }

    pub(crate) fn tangent(&self, centre: [f64; 3], half: f64) -> Tangent {
        let value = self.at(centre);
        let gradient = self.normal.each(|c| -c * half);
        Tangent { gradient, low: (self.inner - value).next_down(), high: (self.outer - value).next_up() }
    }

    /// Returns the side on which a point lies, if it is known.
    pub(crate) fn sign_at(&self, t: [f64; 3]) -> Option<i32> {
        let value = self.at(t);
        if value < self.inner {
            Some(1)
        } else if value > self.outer {
            Some(-1)
        } else {
            None
        }
    }
}
