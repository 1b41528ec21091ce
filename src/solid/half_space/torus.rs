//! The torus.

use super::bounds::{Octants, Sides};
use super::linear;
use super::linear::Linear;
use super::map::ExactMap;
use super::tangent::Tangent;
use crate::cut::{Quadratic, Taylor};
use crate::lattice::Each;
use crate::lattice::PAIRS;
use crate::lattice::axes;
use crate::lattice::exact::{Dyadic, sign, sqrt};
use core::cmp::Ordering;
use wide::f64x4;

/// The points (x, y, z) such that (`scale` x, `scale` y, `scale` z + `shift`) is at most √`square` from the
/// circle of radius `major` > 0 around the z axis in the plane z = 0.
#[derive(PartialEq, Eq, Hash)]
pub(crate) struct Torus {
    pub(crate) major: Dyadic,
    pub(crate) square: Dyadic,
    pub(crate) scale: Dyadic,
    pub(crate) shift: Dyadic,
}

/// A point nearer to the axis than this counts as on the axis: 2^-400.
const NEAR: f64 = f64::from_bits((1023 - 400) << 52);

/// A torus on a universe, in its own space up to a positive factor. With ρ² = x² + y², f = minor² − (ρ −
/// major)² − z² = 2 major ρ − (ρ² + z² + gap).
pub(crate) struct PlacedTorus {
    /// x, y and z.
    lines: [Linear; 3],
    exact_major: Dyadic,
    /// major² − minor².
    gap: Dyadic,
    major: f64,
    /// minor².
    square: f64,
    /// The image of half the diagonal of a cube of half edge 1: its squared length, and the length of its
    /// projection along z.
    diagonal: f64,
    radius: f64,
    /// Whether x, y and z depend on one axis each.
    aligned: bool,
    /// More than the error of any value on the universe.
    error: f64,
}

impl PlacedTorus {
    pub(super) fn heap_bytes(&self) -> usize {
        let lines = self.lines.iter().map(Linear::heap_bytes).sum::<usize>();
        lines + self.exact_major.heap_bytes() + self.gap.heap_bytes()
    }

    /// Returns the image of the torus under the map on the universe.
    pub(crate) fn new(given: &Torus, map: &ExactMap) -> PlacedTorus {
        let w = if map.w.sign() < 0 { -&map.w } else { map.w.clone() };
        let (major, square) = (&w * &given.major, &w.pow(2) * &given.square);
        let mut rows = map.rows.each_ref().each(|row| row.each_ref().each(|c| c * &given.scale));
        rows[2][3] = &rows[2][3] + &(&map.w * &given.shift);
        let sizes = rows.each_ref().each(linear::magnitude);
        let minor = square.magnitude().map(|power| power.div_euclid(2) + 1);
        let scale = -sizes.into_iter().chain(major.magnitude()).chain(minor).max().unwrap_or(0);
        let (major, square) = (major.shifted(scale), square.shifted(2 * scale));
        let lines = rows.each_ref().each(|row| Linear::new(row.each_ref().each(|c| c.shifted(scale))));
        let mut diagonal: f64 = 0.0;
        let mut radius: f64 = 0.0;
        for signs in [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]] {
            let [x, y, z] = lines.each_ref().each(|line| (0..3).map(|k| signs[k] * line.c[k]).sum::<f64>());
            diagonal = diagonal.max(x * x + y * y + z * z);
            radius = radius.max(x * x + y * y);
        }
        let size = lines.iter().flat_map(|line| line.c).chain([major.rounded(), sqrt(square.rounded())]);
        let size: f64 = size.map(f64::abs).sum();
        PlacedTorus {
            gap: &major.pow(2) - &square,
            major: major.rounded(),
            square: square.rounded(),
            diagonal,
            radius: sqrt(radius),
            aligned: lines.iter().all(|line| line.axis().is_some()),
            // A term is rounded at most twenty times, and the errors of its arguments count with the
            // gradient, which is at most four times the size.
            error: 256.0 * f64::EPSILON * size * size,
            lines,
            exact_major: major,
        }
    }

    /// Returns for which of the eight cells f is proven not negative, and not positive.
    pub(crate) fn sides(&self, at: &Octants) -> Sides {
        let (centres, reach) = at.centres();
        let ranges = centres.each(|centre| {
            let (least, most) = self.box_range(centre, reach);
            if self.aligned {
                return (least, most);
            }
            let (low, high) = self.taylor_range(centre, reach);
            (least.fast_max(low), most.fast_min(high))
        });
        let (sides, doubt) =
            Sides::with_error([ranges[0].0, ranges[1].0], [ranges[0].1, ranges[1].1], self.error);
        if doubt == 0 || !self.aligned { sides } else { self.settle(at, sides, doubt) }
    }

    /// The range of f over the boxes around the images of four cubes; exact if the map takes axes to axes.
    #[inline(always)]
    fn box_range(&self, centre: [f64x4; 3], reach: f64) -> (f64x4, f64x4) {
        let zero = f64x4::ZERO;
        let squares = self.lines.each_ref().each(|line| {
            let middle = line.values(centre).abs();
            let spread = f64x4::splat(reach * line.reach());
            let (near, far) = ((middle - spread).fast_max(zero), middle + spread);
            (near * near, far * far)
        });
        let [x, y, z] = squares;
        let (major, square) = (f64x4::splat(self.major), f64x4::splat(self.square));
        let (inward, outward) = (roots(x.0 + y.0) - major, roots(x.1 + y.1) - major);
        let near = inward.fast_max(-outward).fast_max(zero);
        let far = outward.fast_max(-inward);
        (square - far * far - z.1, square - near * near - z.0)
    }

    /// Bounds by Taylor's formula about the centres c of four cubes, at a displacement d from the centre. ρ
    /// is convex, so it is not below its tangent. It is above the tangent by at most b² / 2a, where b is the
    /// part of d across the radius, and a ≤ ρ the sum of the radius at c and the part of d along it. −|d|² is
    /// the rest of f.
    #[inline(always)]
    fn taylor_range(&self, centre: [f64x4; 3], reach: f64) -> (f64x4, f64x4) {
        let zero = f64x4::ZERO;
        let splat = f64x4::splat;
        let [x, y, z] = self.lines.each_ref().each(|line| line.values(centre));
        let rho = roots(x * x + y * y);
        let off = rho - splat(self.major);
        let value = splat(self.square) - off * off - z * z;
        // On the axis any direction, or none, serves for the tangent. Near it, squares underflow, and the
        // length of the direction is lost.
        let share = rho.simd_gt(splat(NEAR)).select(off / rho, zero);
        let (slope_x, slope_y) = (x * share, y * share);
        let slopes = axes(|axis| {
            let [a, b, c] = self.lines.each_ref().each(|line| splat(line.c[axis]));
            ((slope_x * a + slope_y * b) + z * c).abs()
        });
        let spread = ((slopes[0] + slopes[1]) + slopes[2]) * splat(2.0 * reach);
        let across = splat(reach * self.radius);
        let near = rho - across;
        let bend = (splat(self.major) / near - f64x4::ONE).fast_max(zero) * (across * across);
        let bend = near.simd_ge(across).select(bend, splat(f64::INFINITY));
        (value - spread - splat(reach * reach * self.diagonal), value + spread + bend)
    }

    /// Returns linear bounds of f over a cube, as in [`taylor_range`](Self::taylor_range).
    pub(crate) fn tangent(&self, centre: [f64; 3], half: f64) -> Tangent {
        let [x, y, z] = self.lines.each_ref().each(|line| line.value(centre));
        let rho = sqrt(x * x + y * y);
        let off = rho - self.major;
        let value = self.square - off * off - z * z;
        let share = if rho > NEAR { off / rho } else { 0.0 };
        let (slope_x, slope_y) = (x * share, y * share);
        let gradient = axes(|axis| {
            let [a, b, c] = self.lines.each_ref().each(|line| line.c[axis]);
            -2.0 * half * ((slope_x * a + slope_y * b) + z * c)
        });
        let across = half * self.radius;
        let near = rho - across;
        let bend = match near >= across {
            true => (self.major / near - 1.0).max(0.0) * (across * across),
            false => f64::INFINITY,
        };
        // On the axis the tangent of ρ may be any, and the bound from below allows for none. The bound from
        // above is infinite there, since ρ has no bounded second derivative.
        Tangent::new(value, gradient, (-(half * half * self.diagonal), bend), self.error)
    }

    /// Returns f to second order over a cube. Every term of f is quadratic except ρ, whose third derivative
    /// along a line is at most 2 / √3 ρ².
    pub(crate) fn taylor(&self, centre: [f64; 3], half: f64) -> Taylor {
        let Tangent { gradient, low, high } = self.tangent(centre, half);
        let [x, y, z] = self.lines.each_ref().each(|line| line.value(centre));
        let rho = sqrt(x * x + y * y);
        let (across, along) = (half * self.radius, half * sqrt(self.diagonal));
        let near = rho - across;
        let slack = 1.0 + 64.0 * f64::EPSILON;
        if near <= across.max(NEAR) {
            let error = (0.5 * (high - low)).next_up();
            let f = Quadratic { value: 0.5 * (low + high), gradient, squares: [0.0; 6], error };
            return Taylor { f, bend: f64::INFINITY, degree: 4 };
        }
        let columns = axes(|axis| self.lines.each_ref().each(|line| half * line.c[axis]));
        // The second derivative of ρ acts around the axis.
        let around = columns.each(|[a, b, _]| (x * b - y * a) / rho);
        let share = self.major / rho;
        let squares = PAIRS.each(|(i, j)| {
            let ([a, b, c], [d, e, f]) = (columns[i], columns[j]);
            share * (around[i] * around[j]) - ((a * d + b * e) + c * f)
        });
        let off = rho - self.major;
        let value = self.square - off * off - z * z;
        let rest = self.major * (0.3850 * (across / near) * (across / near)) * across;
        // The second derivative of f is 2 along the radius and the axis, and 2 |1 − major / ρ| around the
        // axis.
        let most = (self.major / near - 1.0).max(1.0);
        let bend = (2.0 * most * (along * along) + self.error * half) * slack;
        let f = Quadratic { value, gradient, squares, error: (self.error + rest) * slack };
        Taylor { f, bend, degree: 4 }
    }

    /// Decides exactly the cells that rounding leaves open, if the map takes axes to axes.
    #[cold]
    fn settle(&self, at: &Octants, mut sides: Sides, doubt: u8) -> Sides {
        for k in (0..8).filter(|k| doubt >> k & 1 != 0) {
            let (low, high) = at.octant(k);
            let ends = [low.each(Dyadic::new), high.each(Dyadic::new)];
            let squares = self.lines.each_ref().each(|line| {
                let [a, b] = ends.each_ref().each(|end| line.exactly_at(end));
                let (square_a, square_b) = (a.pow(2), b.pow(2));
                let across = a.sign() * b.sign() < 0;
                let (near, far) = match square_a.cmp(&square_b) {
                    Ordering::Less => (square_a, square_b),
                    _ => (square_b, square_a),
                };
                (if across { Dyadic::zero() } else { near }, far)
            });
            let [x, y, z] = squares;
            let (inner, outer) = (&x.0 + &y.0, &x.1 + &y.1);
            let signs = |z: &Dyadic| [&inner, &outer].each(|rho| self.sign_of(rho, z));
            let ring = self.exact_major.pow(2);
            let around = inner < ring && ring < outer;
            let [a, b] = signs(&z.1);
            if a.min(b) >= 0 {
                sides.inside |= 1 << k;
            }
            let [a, b] = signs(&z.0);
            let most = if around { self.sign_of(&ring, &z.0) } else { a.max(b) };
            if most <= 0 {
                sides.outside |= 1 << k;
            }
        }
        sides
    }

    /// The exact sign of f for given ρ² and z².
    fn sign_of(&self, rho: &Dyadic, z: &Dyadic) -> i32 {
        sign_with_root(&-&(&(rho + z) + &self.gap), &self.exact_major.shifted(1), rho)
    }

    /// The exact sign at a point of the universe.
    pub(crate) fn sign_at(&self, t: [f64; 3]) -> i32 {
        let [x, y, z] = self.lines.each_ref().each(|line| line.value(t));
        let off = sqrt(x * x + y * y) - self.major;
        let value = self.square - off * off - z * z;
        if value.abs() > self.error { sign(value) } else { self.exact_sign_at(t) }
    }

    #[cold]
    fn exact_sign_at(&self, t: [f64; 3]) -> i32 {
        let t = t.each(Dyadic::new);
        let [x, y, z] = self.lines.each_ref().each(|line| line.exactly_at(&t).pow(2));
        self.sign_of(&(&x + &y), &z)
    }

    /// The sign to which the shift (ε, ε², ε³) moves a zero, to first order.
    #[cold]
    pub(crate) fn shifted_sign_at(&self, t: [f64; 3]) -> i32 {
        let t = t.each(Dyadic::new);
        let [x, y, z] = self.lines.each_ref().each(|line| line.exactly_at(&t));
        let rho = &x.pow(2) + &y.pow(2);
        let slope = |axis: usize| {
            let [a, b, c] = self.lines.each_ref().each(|line| &line.exact[axis]);
            let (along, up) = (&(&x * a) + &(&y * b), &z * c);
            if rho.is_zero() {
                // At the axis ρ grows in every direction.
                sign_with_root(&-&up, &self.exact_major, &(&a.pow(2) + &b.pow(2)))
            } else {
                // Half the derivative times ρ: major · along − ρ (along + up).
                sign_with_root(&(&self.exact_major * &along), &-&(&along + &up), &rho)
            }
        };
        (0..3).map(slope).find(|&sign| sign != 0).unwrap_or(0)
    }
}

/// The exact sign of a + b √s, with s ≥ 0.
fn sign_with_root(a: &Dyadic, b: &Dyadic, s: &Dyadic) -> i32 {
    let root = if s.is_zero() { 0 } else { b.sign() };
    match (a.sign(), root) {
        (0, sign) | (sign, 0) => sign,
        (one, other) if one == other => one,
        (sign, _) => match a.pow(2).cmp(&(&b.pow(2) * s)) {
            Ordering::Greater => sign,
            Ordering::Equal => 0,
            Ordering::Less => -sign,
        },
    }
}

/// Correctly rounded square roots.
#[inline(always)]
fn roots(values: f64x4) -> f64x4 {
    f64x4::new(values.to_array().each(sqrt))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Cell;

    #[test]
    fn signs_with_roots() {
        let of = |a, b, s| sign_with_root(&Dyadic::new(a), &Dyadic::new(b), &Dyadic::new(s));
        assert_eq!(of(-3.0, 1.0, 9.0), 0);
        assert_eq!(of(-3.0, 1.0, 9.0f64.next_up()), 1);
        assert_eq!(of(3.0, -1.0, 9.0f64.next_up()), -1);
        assert_eq!((of(0.0, -1.0, 2.0), of(1.0, -1.0, 0.0), of(0.0, 1.0, 0.0)), (-1, 1, 0));
        assert_eq!((of(1.0, 1.0, 2.0), of(-1.0, -1.0, 2.0)), (1, -1));
    }

    #[test]
    fn as_near_to_the_axis_as_squares_underflow() {
        // The centre of cell (300, 300, 200) lies on z = ½ and 1.2 · 2^-536 off the axis; x and z change
        // together.
        let [u, w] = [300.5, 200.5].map(|i| i / 512.0);
        let (steep, flat) = (77.0 / 32.0, 2f64.powi(-10));
        let rows = [
            [1.0, -1.0, 0.0, 1.2 * 2f64.powi(-536)],
            [0.0, 0.0, 1.0, -w],
            [flat + steep, flat - steep, 0.0, 0.5 - 2.0 * flat * u],
        ];
        let map = ExactMap { rows: rows.map(|row| row.map(Dyadic::new)), w: Dyadic::new(1.0) };
        let [major, square, scale, shift] = [1.0, 1.25 + 6e-5, 1.0, 0.0].map(Dyadic::new);
        let torus = PlacedTorus::new(&Torus { major, square, scale, shift }, &map);
        assert_eq!(torus.sign_at([301.0, 300.0, 200.0].map(|i| i / 512.0)), -1);
        let parent = Cell { level: 8, at: [150, 150, 100] };
        assert_eq!(torus.sides(&Octants::of(parent)).inside & 1, 0, "with a corner outside");
    }
}
