//! Planes: polynomials of degree one.

use super::bounds::{Octants, Sides};
use super::linear;
use super::map::ExactMap;
use super::tangent::Tangent;
use crate::cut::{Quadratic, Taylor};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{Dyadic, certain};
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::cmp::Ordering;
use wide::f64x4;

/// A plane on a universe: a x + b y + c z + d in unit coordinates. Expressions have many planes, so this type
/// is small.
pub(crate) struct Plane {
    /// The coefficients a to d. The largest has a magnitude of one.
    c: [f64; 4],
    /// The least value at a corner of a unit cube minus the value at its lower corner (not positive); and the
    /// difference of the greatest and the least value at the corners.
    fall: f64,
    reach: f64,
    /// More than the error of any value on [−1, 2]³; zero if values on the lattice have no error.
    error: f64,
    /// The exact coefficients, one behind the other; empty if they are equal to the doubles.
    exact: Box<[u8]>,
}

impl Plane {
    pub(super) fn heap_bytes(&self) -> usize {
        self.exact.len()
    }

    /// The coefficients, rounded.
    pub(super) fn rounded(&self) -> &[f64; 4] {
        &self.c
    }

    /// Returns the image of the plane `given` under the map on the universe, whose lattice has 2^depth cells
    /// along an axis.
    pub(crate) fn new(given: &[Dyadic; 4], map: &ExactMap, depth: u8) -> Plane {
        let exact = map.linear(given);
        // Only the sign counts: the largest coefficient is scaled to a magnitude of one.
        let scale = -linear::magnitude(&exact);
        let exact = exact.each(|c| if map.w.sign() < 0 { -&c.shifted(scale) } else { c.shifted(scale) });
        let c = exact.each_ref().each(Dyadic::rounded);
        // No partial sum is larger than four times this.
        let size: f64 = c.iter().map(|c| c.abs()).sum();
        let is_double = exact.iter().all(|c| c.exactly().is_some());
        let is_exact = is_double && linear::is_exact(&exact, depth as i64 + 1, 4.0 * size);
        let mut bytes = Vec::new();
        exact.iter().filter(|_| !is_double).for_each(|c| c.write(&mut bytes));
        Plane {
            c,
            fall: (c[0].min(0.0) + c[1].min(0.0)) + c[2].min(0.0),
            reach: (c[0].abs() + c[1].abs()) + c[2].abs(),
            // At most fourteen roundings a term.
            error: if is_exact { 0.0 } else { 32.0 * f64::EPSILON * size },
            exact: bytes.into_boxed_slice(),
        }
    }

    /// Returns the least values over the eight cells, and the difference of the greatest and the least
    /// values.
    #[inline(always)]
    fn least(&self, at: &Octants) -> ([f64x4; 2], f64) {
        let ([x, y, z], [a, b, c, d]) = (at.low, self.c);
        let first = ((a * x + b * y) + c * z) + (d + self.fall * at.half);
        let lower = f64x4::new([0.0, a, b, a + b]) * at.half + first;
        ([lower, lower + c * at.half], self.reach * at.half)
    }

    /// Returns for which of the eight cells the value is proven not negative, and not positive.
    #[inline(always)]
    pub(crate) fn sides(&self, at: &Octants) -> Sides {
        let (least, reach) = self.least(at);
        let (sides, doubt) = Sides::with_error(least, [least[0] + reach, least[1] + reach], self.error);
        if doubt == 0 {
            return sides;
        }
        sides.settled(at, doubt, |low, high, which| {
            let exact = self.exact();
            let less = if which == Ordering::Less { 1 } else { -1 };
            let corner = axes(|i| if exact[i].sign() == less { low[i] } else { high[i] }).each(Dyadic::new);
            linear::value(&exact, &corner).sign()
        })
    }

    /// Returns the values at the centres of the eight cells, and more than their error.
    #[inline(always)]
    pub(crate) fn centres(&self, at: &Octants) -> ([f64x4; 2], f64) {
        let (least, reach) = self.least(at);
        ([least[0] + 0.5 * reach, least[1] + 0.5 * reach], self.error)
    }

    /// Returns linear bounds of the value over a cube; their gap is rounding only.
    #[inline(always)]
    pub(crate) fn tangent(&self, centre: [f64; 3], half: f64) -> Tangent {
        let [a, b, c, d] = self.c;
        let value = ((a * centre[0] + b * centre[1]) + c * centre[2]) + d;
        let gradient = [a * half, b * half, c * half];
        if self.error == 0.0 {
            return Tangent { gradient, low: value, high: value };
        }
        Tangent::new(value, gradient, (0.0, 0.0), self.error)
    }

    /// Returns the value to second order over a cube.
    pub(crate) fn taylor(&self, centre: [f64; 3], half: f64) -> Taylor {
        let Tangent { gradient, low, high } = self.tangent(centre, half);
        let error = (0.5 * (high - low)).next_up();
        let f = Quadratic { value: 0.5 * (low + high), gradient, squares: [0.0; 6], error };
        Taylor { f, bend: self.error * half, degree: 1 }
    }

    /// Returns whether the plane may be a plane of the lattice.
    pub(crate) fn is_of_lattice(&self, depth: u8) -> bool {
        let exact = self.exact();
        let mut axes = (0..3).filter(|&axis| exact[axis].sign() != 0);
        let (Some(axis), None) = (axes.next(), axes.next()) else { return false };
        let cells = (1u64 << depth) as f64;
        let nearest = libm::round(-self.c[3] / self.c[axis] * cells);
        // Planes far outside the universe do not matter.
        if !(-2.0..=2.0 * cells).contains(&nearest) {
            return false;
        }
        let mut point = [0.0; 3];
        [nearest - 1.0, nearest, nearest + 1.0].into_iter().any(|plane| {
            point[axis] = plane / cells;
            linear::value(&exact, &point.each(Dyadic::new)).sign() == 0
        })
    }

    /// The exact sign at a point of the lattice, or of a lattice with half its cells.
    #[inline]
    pub(crate) fn sign_at(&self, t: [f64; 3]) -> i32 {
        let [a, b, c, d] = self.c;
        let value = ((a * t[0] + b * t[1]) + c * t[2]) + d;
        certain(value, self.error)
            .unwrap_or_else(|| linear::value(&self.exact(), &t.each(Dyadic::new)).sign())
    }

    /// Returns the function on a ray along `axis` through a point: the factors of 1 and s for the coordinate
    /// s, and 0.
    #[inline]
    pub(crate) fn along(&self, axis: usize, point: [f64; 3]) -> [f64; 3] {
        let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
        [(self.c[i] * point[i] + self.c[j] * point[j]) + self.c[3], self.c[axis], 0.0]
    }

    /// More than the error of a value anywhere on [−1, 2]³, not only on the lattice.
    pub(crate) fn rounding(&self) -> f64 {
        self.error.max(32.0 * f64::EPSILON * self.c.iter().map(|c| c.abs()).sum::<f64>())
    }

    /// The exact sign at a point off the lattice.
    pub(crate) fn sign_off_lattice(&self, t: [f64; 3]) -> i32 {
        let [a, b, c, d] = self.c;
        let value = ((a * t[0] + b * t[1]) + c * t[2]) + d;
        let exact = || linear::value(&self.exact(), &t.each(Dyadic::new)).sign();
        certain(value, self.rounding()).unwrap_or_else(exact)
    }

    /// The sign to which the shift (ε, ε², ε³) moves a zero.
    #[cold]
    pub(crate) fn shifted_sign(&self) -> i32 {
        self.exact()[..3].iter().map(Dyadic::sign).find(|&sign| sign != 0).unwrap_or(0)
    }

    #[cold]
    pub(super) fn exact(&self) -> [Dyadic; 4] {
        let mut rest = &*self.exact;
        self.c.each(|c| if self.exact.is_empty() { Dyadic::new(c) } else { Dyadic::read(&mut rest) })
    }
}
