//! Polynomials of degree two: quadrics.

use super::bounds::{Octants, Sides, sums};
use super::linear;
use super::map::ExactMap;
use super::tangent::Tangent;
use crate::cut::{Quadratic, Taylor};
use crate::lattice::Each;
use crate::lattice::exact::{DoubleDouble, Dyadic, certain};
use alloc::boxed::Box;
use core::cmp::Ordering;
use wide::f64x4;

/// The products of (x, y, z, 1) to which the coefficients of a quadric belong: squares, mixed products,
/// linear terms, 1.
const PAIRS: [(usize, usize); 10] =
    [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3), (3, 3)];

/// The index of a coefficient in [`PAIRS`].
pub(super) const fn place(a: usize, b: usize) -> usize {
    [[0, 3, 5, 6], [3, 1, 4, 7], [5, 4, 2, 8], [6, 7, 8, 9]][a][b]
}

/// The exact coefficients of a polynomial of degree two.
pub(crate) type Coefficients = [Dyadic; 10];

/// Returns the polynomial that has the sign of `given` at the image of its argument: `given` ∘ `map`, times
/// w².
pub(crate) fn substitute(given: &Coefficients, map: &ExactMap) -> Coefficients {
    let zero = Dyadic::zero();
    let entry = |i: usize, j: usize| match (i, j) {
        (3, 3) => &map.w,
        (3, _) => &zero,
        _ => &map.rows[i][j],
    };
    PAIRS.each(|(j, k)| {
        let mut sum = Dyadic::zero();
        for ((a, b), coefficient) in PAIRS.iter().zip(given).filter(|(_, c)| !c.is_zero()) {
            let mut product = entry(*a, j) * entry(*b, k);
            if j != k {
                product = &product + &(entry(*a, k) * entry(*b, j));
            }
            sum = &sum + &(coefficient * &product);
        }
        sum
    })
}

/// A quadric on a universe, in unit coordinates.
pub(crate) struct Quadric {
    exact: Box<Coefficients>,
    /// The coefficients in 106 bits.
    fine: [DoubleDouble; 10],
    form: Form,
}

enum Form {
    /// Without mixed products: the extremes over a box follow from the extremes along each axis.
    Separable(Separable),
    /// With mixed products.
    Mixed(Mixed),
}

/// f = constant + Σ (square tᵢ + linear) tᵢ; one lane an axis.
struct Separable {
    constant: f64,
    linear: f64x4,
    square: f64x4,
    /// The vertex of the parabola along each axis, and its value there: as `least` if the parabola opens
    /// upward, as `most` if it opens downward, otherwise infinite.
    vertex: f64x4,
    least: f64x4,
    most: f64x4,
    /// More than the error of any value on [−1, 2]³; zero if values on the lattice have no error.
    error: f64,
}

/// All ten coefficients, in the order of [`PAIRS`].
struct Mixed {
    c: [f64; 10],
    /// The bounds of the quadratic part alone over a cube of half edge 1; over half edge h, times h².
    squares: (f64, f64),
    /// Tighter bounds of the same: the mixed products together have their extremes, and a form of one sign
    /// has 0. (Verdicts use `squares`, so that trees do not change.)
    remainder: (f64, f64),
    error: f64,
}

impl Quadric {
    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&*self.exact) + self.exact.iter().map(Dyadic::heap_bytes).sum::<usize>()
    }

    pub(super) fn exact(&self) -> &Coefficients {
        &self.exact
    }

    /// Returns the image of the quadric `given` under the map on the universe, whose lattice has 2^depth
    /// cells along an axis.
    pub(crate) fn new(given: &Coefficients, map: &ExactMap, depth: u8) -> Quadric {
        let exact = substitute(given, map);
        // Only the sign counts: the largest coefficient is scaled to a magnitude of one.
        let scale = -linear::magnitude(&exact);
        let exact = exact.each(|c| c.shifted(scale));
        let c = exact.each_ref().each(Dyadic::rounded);
        // The sum of the magnitudes of all terms on [−1, 2]³, which bounds all values.
        let size: f64 = 4.0 * c.iter().map(|c| c.abs()).sum::<f64>();
        let form = if exact[3..6].iter().all(Dyadic::is_zero) {
            Form::Separable(Separable::new(&exact, c, size, depth))
        } else {
            let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max].each(|extreme| {
                c[..3].iter().map(|&c| extreme(c, 0.0)).sum::<f64>()
                    + c[3..6].iter().map(|c| extreme(c.abs(), -c.abs())).sum::<f64>()
            });
            // At most twenty roundings a term.
            let squares = (least, most);
            Form::Mixed(Mixed {
                c,
                squares,
                remainder: remainder(&exact, &c),
                error: 64.0 * f64::EPSILON * size,
            })
        };
        let fine = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]
            .each(|i| DoubleDouble::sum(c[i], (&exact[i] - &Dyadic::new(c[i])).rounded()));
        Quadric { exact: Box::new(exact), fine, form }
    }

    /// Returns for which of the eight cells the polynomial is proven not negative, and not positive.
    #[inline(always)]
    pub(crate) fn sides(&self, at: &Octants) -> Sides {
        match &self.form {
            Form::Separable(separable) => {
                let (sides, doubt) = separable.sides(at);
                if doubt == 0 {
                    return sides;
                }
                sides.settled(at, doubt, |low, high, which| self.extreme_sign(low, high, which))
            }
            Form::Mixed(mixed) => mixed.sides(at),
        }
    }

    /// Returns the values at the centres of the eight cells, and more than their error.
    #[inline(always)]
    pub(crate) fn centres(&self, at: &Octants) -> ([f64x4; 2], f64) {
        match &self.form {
            Form::Separable(separable) => (separable.centres(at), separable.error),
            Form::Mixed(mixed) => (at.centres().0.each(|centre| mixed.value(centre)), mixed.error),
        }
    }

    /// Returns linear bounds of the value over a cube.
    #[inline(always)]
    pub(crate) fn tangent(&self, centre: [f64; 3], half: f64) -> Tangent {
        match &self.form {
            Form::Separable(separable) => separable.tangent(centre, half),
            Form::Mixed(mixed) => mixed.tangent(centre, half),
        }
    }

    /// Returns the value to second order over a cube.
    pub(crate) fn taylor(&self, centre: [f64; 3], half: f64) -> Taylor {
        let square = half * half;
        let (value, gradient, squares, error) = match &self.form {
            Form::Separable(separable) => {
                let t = f64x4::new([centre[0], centre[1], centre[2], 0.0]);
                let [x, y, z, _] = ((separable.square * t * 2.0 + separable.linear) * half).to_array();
                let [xx, yy, zz, _] = (separable.square * square).to_array();
                (separable.value(centre), [x, y, z], [xx, yy, zz, 0.0, 0.0, 0.0], separable.error)
            }
            Form::Mixed(mixed) => {
                let [xx, yy, zz, xy, yz, zx, ..] = mixed.c;
                let gradient = mixed.slopes(centre).each(|slope| slope * half);
                let value = mixed.value(centre.each(f64x4::splat)).to_array()[0];
                let [xy, zx, yz] = [xy, zx, yz].each(|c| 0.5 * c);
                (value, gradient, [xx, yy, zz, xy, zx, yz].each(|c| c * square), mixed.error)
            }
        };
        // A slope is a sum of four terms, which are at most twice the coefficients.
        let slope = 16.0 * f64::EPSILON * half * self.size();
        let f = Quadratic { value, gradient, squares, error: error + 4.0 * slope };
        Taylor { f, bend: f.bend() + 2.0 * slope, degree: 2 }
    }

    /// The sum of the magnitudes of all coefficients.
    pub(crate) fn size(&self) -> f64 {
        match &self.form {
            Form::Separable(separable) => {
                let [x, y, z, _] = (separable.square.abs() + separable.linear.abs()).to_array();
                ((x + y) + z) + separable.constant.abs()
            }
            Form::Mixed(mixed) => mixed.c.iter().map(|c| c.abs()).sum(),
        }
    }

    /// Returns whether the square of a coordinate has no term.
    pub(crate) fn is_linear_along(&self, axis: usize) -> bool {
        self.exact[place(axis, axis)].is_zero()
    }

    /// Returns whether the surface may contain a plane of a lattice.
    pub(crate) fn may_hold_lattice_plane(&self) -> bool {
        let zero = |i: usize, j: usize| self.exact[place(i, j)].is_zero();
        // On such a plane, the other squares, their mixed product and the slopes all vanish.
        [(0, 1, 2), (1, 2, 0), (2, 0, 1)].into_iter().any(|(k, i, j)| {
            let may_be_flat = |other: usize| !zero(k, other) || zero(other, 3);
            zero(i, i) && zero(j, j) && zero(i, j) && may_be_flat(i) && may_be_flat(j)
        })
    }

    /// The exact sign of the least (`Less`) or the greatest value over a box, without mixed products.
    fn extreme_sign(&self, low: [f64; 3], high: [f64; 3], which: Ordering) -> i32 {
        let mut sum = self.exact[place(3, 3)].clone();
        let mut vertices: [Option<(Dyadic, Dyadic)>; 3] = [None, None, None];
        for axis in 0..3 {
            let (square, linear) = (&self.exact[place(axis, axis)], &self.exact[place(axis, 3)]);
            let along = |t: f64| {
                let t = Dyadic::new(t);
                (&(&(square * &t) + linear) * &t, (&(&square.shifted(1) * &t) + linear).sign())
            };
            let ((at_low, slope_low), (at_high, slope_high)) = (along(low[axis]), along(high[axis]));
            let bends = square.sign() == if which == Ordering::Less { 1 } else { -1 };
            if bends && slope_low * slope_high < 0 {
                // The fraction −linear² / (4 square).
                vertices[axis] = Some((-&(linear * linear), square.shifted(2)));
            } else {
                sum = &sum + if at_low.cmp(&at_high) == which { &at_low } else { &at_high };
            }
        }
        // Over a common denominator, whose sign counts.
        let mut denominator = Dyadic::new(1.0);
        for (numerator, own) in vertices.iter().flatten() {
            sum = &(&sum * own) + &(numerator * &denominator);
            denominator = &denominator * own;
        }
        sum.sign() * denominator.sign()
    }

    /// The exact sign at a point of [−1, 2]³.
    #[inline]
    pub(crate) fn sign_at(&self, t: [f64; 3]) -> i32 {
        let (value, error) = match &self.form {
            Form::Separable(separable) => (separable.value(t), separable.error),
            Form::Mixed(mixed) => (mixed.value(t.each(f64x4::splat)).to_array()[0], mixed.error),
        };
        certain(value, error).unwrap_or_else(|| self.exact_sign_at(t))
    }

    /// Returns the polynomial on a ray along `axis` through a point: the factors of 1, s and s² for the
    /// coordinate s.
    #[inline]
    pub(crate) fn along(&self, axis: usize, point: [f64; 3]) -> [f64; 3] {
        let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
        let (u, v) = (point[i], point[j]);
        match &self.form {
            Form::Separable(separable) => {
                let (square, linear) = (separable.square.as_array(), separable.linear.as_array());
                let rest = (square[i] * u + linear[i]) * u + (square[j] * v + linear[j]) * v;
                [separable.constant + rest, linear[axis], square[axis]]
            }
            Form::Mixed(Mixed { c, .. }) => {
                let rest =
                    (c[i] * u + c[place(i, 3)]) * u + (c[j] * v + c[place(j, 3)] + c[place(i, j)] * u) * v;
                let slope = c[place(axis, 3)] + c[place(axis, i)] * u + c[place(axis, j)] * v;
                [c[9] + rest, slope, c[axis]]
            }
        }
    }

    /// Returns the polynomial on a ray in numbers of 106 bits. Its error is at most [`DoubleDouble::EPSILON`]
    /// times 64 times [`size`](Self::size), since coordinates are at most 1.
    pub(crate) fn finely_along(&self, axis: usize, point: [f64; 3]) -> [DoubleDouble; 3] {
        let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
        let [u, v] = [point[i], point[j]].each(DoubleDouble::from);
        let c = |a: usize, b: usize| self.fine[place(a, b)];
        let rest = (c(i, i) * u + c(i, 3)) * u + (c(j, j) * v + c(j, 3) + c(i, j) * u) * v;
        let slope = c(axis, 3) + c(axis, i) * u + c(axis, j) * v;
        [c(3, 3) + rest, slope, c(axis, axis)]
    }

    /// More than the error of a value anywhere on [−1, 2]³, not only on the lattice.
    pub(crate) fn rounding(&self) -> f64 {
        match &self.form {
            Form::Separable(_) => 128.0 * f64::EPSILON * self.size(),
            Form::Mixed(mixed) => mixed.error,
        }
    }

    /// The exact sign at a point off the lattice.
    pub(crate) fn sign_off_lattice(&self, t: [f64; 3]) -> i32 {
        let value = match &self.form {
            Form::Separable(separable) => separable.value(t),
            Form::Mixed(mixed) => mixed.value(t.each(f64x4::splat)).to_array()[0],
        };
        certain(value, self.rounding()).unwrap_or_else(|| self.exact_sign_at(t))
    }

    #[cold]
    fn exact_sign_at(&self, t: [f64; 3]) -> i32 {
        let t = [Dyadic::new(t[0]), Dyadic::new(t[1]), Dyadic::new(t[2]), Dyadic::new(1.0)];
        let terms = PAIRS.iter().zip(self.exact.iter()).filter(|(_, c)| !c.is_zero());
        terms.fold(Dyadic::zero(), |sum, (&(a, b), c)| &sum + &(c * &(&t[a] * &t[b]))).sign()
    }

    /// The sign to which the shift (ε, ε², ε³) moves a zero, to first order.
    #[cold]
    pub(crate) fn shifted_sign_at(&self, t: [f64; 3]) -> i32 {
        let t = [Dyadic::new(t[0]), Dyadic::new(t[1]), Dyadic::new(t[2]), Dyadic::new(1.0)];
        let slope = |axis: usize| {
            let sum = (0..4)
                .fold(Dyadic::zero(), |sum, other| &sum + &(&self.exact[place(axis, other)] * &t[other]));
            // The square counts twice.
            (&sum + &(&self.exact[place(axis, axis)] * &t[axis])).sign()
        };
        (0..3).map(slope).find(|&sign| sign != 0).unwrap_or(0)
    }
}

/// Returns bounds of the quadratic part over [-1, 1]³.
fn remainder(exact: &Coefficients, c: &[f64; 10]) -> (f64, f64) {
    // The mixed products are linear in each coordinate, so that their extremes are at corners. Opposite
    // corners have the same value.
    let [xy, yz, zx] = [c[3], c[4], c[5]];
    let corners = [(xy + yz) + zx, (yz - xy) - zx, (xy - yz) - zx, (zx - xy) - yz];
    let squares = |extreme: fn(f64, f64) -> f64| c[..3].iter().map(|&c| extreme(c, 0.0)).sum::<f64>();
    let least = squares(f64::min) + corners.into_iter().fold(f64::INFINITY, f64::min);
    let most = squares(f64::max) + corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
    match definite(exact) {
        1 => (0.0, most),
        -1 => (least, 0.0),
        _ => (least, most),
    }
}

/// Returns 1 if the quadratic part is nowhere negative, −1 if it is nowhere positive, by the signs of all
/// principal minors; otherwise 0.
fn definite(exact: &Coefficients) -> i32 {
    let [xx, yy, zz, xy, yz, zx, ..] = exact;
    let sign = [xx, yy, zz].each(Dyadic::sign).into_iter().find(|&sign| sign != 0).unwrap_or(0);
    let pair = |a: &Dyadic, b: &Dyadic, mixed: &Dyadic| &(a * b).shifted(2) - &mixed.pow(2);
    // Half of the determinant.
    let products = &(&(xx * yy) * zz).shifted(2) + &(&(xy * yz) * zx);
    let taken = &(&(xx * &yz.pow(2)) + &(yy * &zx.pow(2))) + &(zz * &xy.pow(2));
    let determinant = &products - &taken;
    let has_one = [xx, yy, zz].iter().all(|c| c.sign() * sign >= 0)
        && [pair(xx, yy, xy), pair(yy, zz, yz), pair(zz, xx, zx)].iter().all(|minor| minor.sign() >= 0)
        && determinant.sign() * sign >= 0;
    if has_one { sign } else { 0 }
}

impl Separable {
    fn new(exact: &Coefficients, c: [f64; 10], size: f64, depth: u8) -> Separable {
        let (mut vertex, mut least, mut most) =
            ([f64::INFINITY; 4], [f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        // The finest coordinates are those of cell centres. A vertex is exact if its value is no finer than
        // the other values.
        let places = 2 * (depth as i64 + 1);
        let grain = exact.iter().filter_map(Dyadic::grain).min().unwrap_or(0) - places;
        let mut is_exact = exact.iter().all(|c| c.exactly().is_some());
        let mut size = size;
        for axis in 0..3 {
            let (square, linear) = (c[place(axis, axis)], c[place(axis, 3)]);
            let at = -linear / (2.0 * square);
            // Rounding can move a vertex out of the universe only if the values at the ends are as good.
            if square == 0.0 || !(-1.0..=2.0).contains(&at) {
                continue;
            }
            let value = 0.5 * linear * at;
            let t = Dyadic::new(at);
            let double = &exact[place(axis, axis)].shifted(1);
            let exactly = &exact[place(axis, 3)] * &t.shifted(-1);
            is_exact &= (&(double * &t) + &exact[place(axis, 3)]).is_zero()
                && exactly == Dyadic::new(value)
                && exactly.grain().is_none_or(|bit| bit >= grain);
            vertex[axis] = at;
            *if square > 0.0 { &mut least[axis] } else { &mut most[axis] } = value;
            size += value.abs();
        }
        is_exact &= linear::is_exact(exact, places, size);
        Separable {
            constant: c[place(3, 3)],
            linear: f64x4::new([c[place(0, 3)], c[place(1, 3)], c[place(2, 3)], 0.0]),
            square: f64x4::new([c[0], c[1], c[2], 0.0]),
            vertex: f64x4::new(vertex),
            least: f64x4::new(least),
            most: f64x4::new(most),
            // At most eight roundings a term.
            error: if is_exact { 0.0 } else { 32.0 * f64::EPSILON * size },
        }
    }

    /// The sides of the eight cells, and the cells for which rounding leaves a side open.
    #[inline(always)]
    fn sides(&self, at: &Octants) -> (Sides, u8) {
        let low = at.lanes();
        let middle = low + at.half;
        let high = middle + at.half;
        let along = |t: f64x4| (self.square * t + self.linear) * t;
        let (a, b, c) = (along(low), along(middle), along(high));
        let first = low.simd_lt(self.vertex) & self.vertex.simd_lt(middle);
        let second = middle.simd_le(self.vertex) & self.vertex.simd_lt(high);
        let (up, down) = (f64x4::splat(f64::INFINITY), f64x4::splat(f64::NEG_INFINITY));
        let least = [
            a.fast_min(b).fast_min(first.select(self.least, up)),
            b.fast_min(c).fast_min(second.select(self.least, up)),
        ];
        let most = [
            a.fast_max(b).fast_max(first.select(self.most, down)),
            b.fast_max(c).fast_max(second.select(self.most, down)),
        ];
        Sides::with_error(sums(self.constant, least), sums(self.constant, most), self.error)
    }

    /// The values at the centres of the eight cells.
    #[inline(always)]
    fn centres(&self, at: &Octants) -> [f64x4; 2] {
        let first = at.lanes() + 0.5 * at.half;
        sums(self.constant, [first, first + at.half].each(|t| (self.square * t + self.linear) * t))
    }

    /// The squares are the remainder.
    #[inline(always)]
    fn tangent(&self, centre: [f64; 3], half: f64) -> Tangent {
        let t = f64x4::new([centre[0], centre[1], centre[2], 0.0]);
        let double = self.square * t * 2.0;
        let [x, y, z, _] = ((double + self.linear) * half).to_array();
        let [a, b, c, _] = (double.abs() + self.linear.abs()).to_array();
        let rest = self.square * (half * half);
        let sum = |rest: f64x4| {
            let [x, y, z, _] = rest.to_array();
            (x + y) + z
        };
        let rests = (sum(rest.fast_min(f64x4::ZERO)), sum(rest.fast_max(f64x4::ZERO)));
        let error = self.error + 4.0 * f64::EPSILON * half * ((a + b) + c);
        Tangent::new(self.value(centre), [x, y, z], rests, error)
    }

    #[inline(always)]
    fn value(&self, t: [f64; 3]) -> f64 {
        let t = f64x4::new([t[0], t[1], t[2], 0.0]);
        let [x, y, z, _] = ((self.square * t + self.linear) * t).to_array();
        ((self.constant + x) + y) + z
    }
}

impl Mixed {
    #[inline(always)]
    fn sides(&self, at: &Octants) -> Sides {
        let (centres, quarter) = at.centres();
        let (a, b) = (self.range(centres[0], quarter), self.range(centres[1], quarter));
        Sides::with_error([a.0, b.0], [a.1, b.1], self.error).0
    }

    /// Returns bounds over four cubes of half edge `reach`, by Taylor's formula about each centre: exact
    /// except for the mixed terms.
    #[inline(always)]
    fn range(&self, [x, y, z]: [f64x4; 3], reach: f64) -> (f64x4, f64x4) {
        let [xx, yy, zz, xy, yz, zx, x1, y1, z1, _] = self.c;
        let value = self.value([x, y, z]);
        let (mixed_x, mixed_y, mixed_z) = (y * xy + z * zx, x * xy + z * yz, x * zx + y * yz);
        let (from_x, from_y, from_z) = (x * xx * 2.0, y * yy * 2.0, z * zz * 2.0);
        let slopes = (from_x + (mixed_x + x1)).abs()
            + (from_y + (mixed_y + y1)).abs()
            + (from_z + (mixed_z + z1)).abs();
        let spread = slopes * reach;
        let (least, most) = (reach * reach * self.squares.0, reach * reach * self.squares.1);
        (value - spread + least, value + spread + most)
    }

    #[inline(always)]
    fn tangent(&self, centre: [f64; 3], half: f64) -> Tangent {
        let value = self.value(centre.each(f64x4::splat)).to_array()[0];
        let gradient = self.slopes(centre);
        let (least, most) = self.remainder;
        // `error` is more than four times the size of the coefficients in roundings, and so more than the
        // error of a slope times an edge of the universe.
        let error = self.error + self.error * half;
        Tangent::new(
            value,
            gradient.each(|slope| slope * half),
            (half * half * least, half * half * most),
            error,
        )
    }

    #[inline(always)]
    fn slopes(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [xx, yy, zz, xy, yz, zx, x1, y1, z1, _] = self.c;
        [
            2.0 * xx * x + ((xy * y + zx * z) + x1),
            2.0 * yy * y + ((xy * x + yz * z) + y1),
            2.0 * zz * z + ((zx * x + yz * y) + z1),
        ]
    }

    /// The values at four points.
    #[inline(always)]
    fn value(&self, [x, y, z]: [f64x4; 3]) -> f64x4 {
        let [xx, yy, zz, xy, yz, zx, x1, y1, z1, constant] = self.c;
        (x * xx + (y * xy + x1)) * x + constant + (y * yy + (z * yz + y1)) * y + (z * zz + (x * zx + z1)) * z
    }
}
