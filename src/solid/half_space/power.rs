//! Sums of powers, each of one coordinate.

use super::bounds::{Octants, Sides, sums};
use super::linear;
use super::linear::Linear;
use super::map::ExactMap;
use super::tangent::Tangent;
use crate::cut::{Quadratic, Taylor};
use crate::lattice::Each;
use crate::lattice::PAIRS;
use crate::lattice::axes;
use crate::lattice::exact::{Dyadic, sign};
use crate::memory;
use alloc::vec::Vec;
use core::cmp::Ordering;
use wide::f64x4;

/// Σ coefficient · (coordinate − centre)^exponent + constant, as given: one term for each axis, some of which
/// may be zero.
#[derive(PartialEq)]
pub(crate) struct Powers {
    pub(crate) terms: [(f64, f64, u32); 3],
    pub(crate) constant: f64,
}

/// A value below all relevant ones, and above all losses by underflow.
const TINY: f64 = f64::from_bits((1023 - 800) << 52);

/// A sum of powers on a universe: Σ weight · line^exponent + constant, in unit coordinates.
pub(crate) struct PlacedPowers {
    terms: Vec<Term>,
    exact_constant: Dyadic,
    constant: f64,
    /// The terms by axis, if each term depends on one axis.
    aligned: Option<Aligned>,
}

/// A term of the sum. The line's largest coefficient has a magnitude of one.
struct Term {
    line: Linear,
    exponent: u32,
    exact_weight: Dyadic,
    weight: f64,
}

/// The terms by the axis on which they depend, one lane an axis: weight · (slope · t + offset)^exponent.
struct Aligned {
    weight: f64x4,
    slope: f64x4,
    offset: f64x4,
    /// For each bit of the exponents minus one, a mask of the lanes whose bit is set: repeated squaring of
    /// the base has a factor there.
    factors: Vec<f64x4>,
    /// Whether a power of a negative base is negative.
    odd: f64x4,
    /// The values where a base is zero: for an even power 0 as `least` or as `most`, otherwise infinite.
    least: f64x4,
    most: f64x4,
    /// The errors of the base, and the errors of the weighted power relative to its factors.
    base_error: f64x4,
    base_share: f64x4,
    power_share: f64x4,
    constant: f64,
    constant_error: f64,
}

impl PlacedPowers {
    pub(super) fn heap_bytes(&self) -> usize {
        let terms = self.terms.iter().map(|term| term.line.heap_bytes() + term.exact_weight.heap_bytes());
        let factors = self.aligned.as_ref().map_or(0, |aligned| memory::bytes_of(&aligned.factors));
        memory::bytes_of(&self.terms) + terms.sum::<usize>() + factors + self.exact_constant.heap_bytes()
    }

    /// Returns the image of `given` under the map on the universe, up to a positive factor.
    pub(crate) fn new(given: &Powers, map: &ExactMap) -> PlacedPowers {
        let present = || (0..3).filter(|&axis| given.terms[axis].0 != 0.0);
        let highest = present().map(|axis| given.terms[axis].2).max().unwrap_or(0);
        // (line / w)^n, times |w|^highest.
        let w = if map.w.sign() < 0 { -&map.w } else { map.w.clone() };
        let mut lines = Vec::with_capacity(3);
        for axis in present() {
            let (coefficient, centre, exponent) = given.terms[axis];
            let mut line = map.rows[axis].clone();
            line[3] = &line[3] - &(&map.w * &Dyadic::new(centre));
            let size = linear::magnitude(&line);
            let line = line.each(|c| c.shifted(-size));
            let mut weight = &Dyadic::new(coefficient) * &w.pow(highest - exponent);
            if map.w.sign() < 0 && exponent % 2 == 1 {
                weight = -&weight;
            }
            lines.push((line, exponent, weight.shifted(size * exponent as i64)));
        }
        let constant = &Dyadic::new(given.constant) * &w.pow(highest);
        let weights = lines.iter().map(|(_, _, weight)| weight).chain([&constant]);
        let scale = -linear::magnitude(weights);
        let terms: Vec<Term> = lines
            .into_iter()
            .map(|(line, exponent, weight)| {
                let exact_weight = weight.shifted(scale);
                let weight = exact_weight.rounded();
                Term { line: Linear::new(line), exponent, exact_weight, weight }
            })
            .collect();
        let exact_constant = constant.shifted(scale);
        let constant = exact_constant.rounded();
        let aligned = terms.iter().all(|term| term.line.axis().is_some());
        let aligned = aligned.then(|| Aligned::new(&terms, constant));
        PlacedPowers { terms, exact_constant, constant, aligned }
    }

    /// Returns for which of the eight cells the sum is proven not negative, and not positive.
    pub(crate) fn sides(&self, at: &Octants) -> Sides {
        match &self.aligned {
            Some(aligned) => {
                let (sides, doubt) = aligned.sides(at);
                if doubt == 0 {
                    return sides;
                }
                sides.settled(at, doubt, |low, high, which| self.extreme_sign(low, high, which))
            }
            None => self.bounds(at),
        }
    }

    /// The exact sign of the least (`Less`) or the greatest value over a box, if each term depends on one
    /// axis.
    fn extreme_sign(&self, low: [f64; 3], high: [f64; 3], which: Ordering) -> i32 {
        let ends = [low.each(Dyadic::new), high.each(Dyadic::new)];
        let sum = self.terms.iter().fold(self.exact_constant.clone(), |sum, term| {
            let [a, b] = ends.each_ref().each(|end| term.line.exactly_at(end));
            let weighted = |base: &Dyadic| &term.exact_weight * &base.pow(term.exponent);
            let (at_a, at_b) = (weighted(&a), weighted(&b));
            let mut extreme = if at_a.cmp(&at_b) == which { at_a } else { at_b };
            // An even power has the extreme 0 where its base is 0.
            let zero = Dyadic::zero();
            if term.exponent % 2 == 0 && a.sign() * b.sign() < 0 && zero.cmp(&extreme) == which {
                extreme = zero;
            }
            &sum + &extreme
        });
        sum.sign()
    }

    /// The exact sign at a point of the universe.
    pub(crate) fn sign_at(&self, t: [f64; 3]) -> i32 {
        let (mut value, mut error) = (self.constant, 8.0 * f64::EPSILON * self.constant.abs() + TINY);
        for term in &self.terms {
            let base = term.line.value(t);
            let most = base.abs() + term.line.error;
            let power = power(f64x4::splat(most), term.exponent - 1).to_array()[0] * term.weight;
            let negative = term.exponent % 2 == 1 && base < 0.0;
            value += if negative { -(power * most) } else { power * most };
            error += power.abs() * term.error(most);
        }
        if value > error || value < -error { sign(value) } else { self.exact_sign_at(t) }
    }

    #[cold]
    fn exact_sign_at(&self, t: [f64; 3]) -> i32 {
        let t = t.each(Dyadic::new);
        let value = |term: &Term| &term.exact_weight * &term.line.exactly_at(&t).pow(term.exponent);
        self.terms.iter().fold(self.exact_constant.clone(), |sum, term| &sum + &value(term)).sign()
    }

    /// The sign to which the shift (ε, ε², ε³) moves a zero, to first order.
    #[cold]
    pub(crate) fn shifted_sign_at(&self, t: [f64; 3]) -> i32 {
        let t = t.each(Dyadic::new);
        let rises: Vec<Dyadic> = self
            .terms
            .iter()
            .map(|term| {
                let power = term.line.exactly_at(&t).pow(term.exponent - 1);
                &(&term.exact_weight * &Dyadic::new(term.exponent as f64)) * &power
            })
            .collect();
        let slope = |axis: usize| {
            let parts = self.terms.iter().zip(&rises).map(|(term, rise)| rise * &term.line.exact[axis]);
            parts.fold(Dyadic::zero(), |sum, part| &sum + &part).sign()
        };
        (0..3).map(slope).find(|&sign| sign != 0).unwrap_or(0)
    }

    /// Returns linear bounds of the sum over a cube, as in [`bounds`](Self::bounds).
    pub(crate) fn tangent(&self, centre: [f64; 3], half: f64) -> Tangent {
        let mut value = self.constant;
        let (mut gradient, mut least, mut most) = ([0.0; 3], 0.0, 0.0);
        let mut error = 32.0 * f64::EPSILON * self.constant.abs() + TINY;
        let power = |base: f64, exponent: u32| power(f64x4::splat(base), exponent).to_array()[0];
        for term in &self.terms {
            let Term { line, exponent, weight, .. } = term;
            let n = *exponent as f64;
            let spread = half * line.reach();
            let middle = line.value(centre);
            let rise = power(middle, exponent - 1);
            let there = rise * middle;
            let slope = n * rise;
            let step = slope * spread;
            let rests = [
                (power(middle - spread, *exponent) - there) + step,
                (power(middle + spread, *exponent) - there) - step,
            ];
            let (floor, ceiling) = (rests[0].min(rests[1]).min(0.0), rests[0].max(rests[1]).max(0.0));
            let (floor, ceiling) = if *weight < 0.0 { (ceiling, floor) } else { (floor, ceiling) };
            value += weight * there;
            (least, most) = (least + weight * floor, most + weight * ceiling);
            for axis in 0..3 {
                gradient[axis] += weight * slope * line.c[axis] * half;
            }
            let farthest = middle.abs() + spread + line.error;
            error += (weight * 32.0 * n * n * line.error).abs() * power(farthest, exponent - 1);
        }
        Tangent::new(value, gradient, (least, most), error)
    }

    /// Returns the sum to second order over a cube: each term depends on one quantity u alone, and so do its
    /// derivatives.
    pub(crate) fn taylor(&self, centre: [f64; 3], half: f64) -> Taylor {
        let mut value = self.constant;
        let (mut gradient, mut squares) = ([0.0; 3], [0.0; 6]);
        let mut error = 32.0 * f64::EPSILON * self.constant.abs() + TINY;
        let mut bend = TINY;
        for Term { line, exponent, weight, .. } in &self.terms {
            let n = *exponent as f64;
            let spread = half * line.reach();
            let middle = line.value(centre);
            // The base to the power of the exponent minus `k`; 0 if the derivative vanishes.
            let power = |base: f64, k: u32| match exponent.checked_sub(k) {
                Some(rest) => power(f64x4::splat(base), rest).to_array()[0],
                None => 0.0,
            };
            let along = axes(|axis| half * line.c[axis]);
            let slope = weight * n * power(middle, 1);
            let curvature = weight * (0.5 * n * (n - 1.0)) * power(middle, 2);
            value += weight * power(middle, 0);
            for axis in 0..3 {
                gradient[axis] += slope * along[axis];
            }
            for (sum, (i, j)) in squares.iter_mut().zip(PAIRS) {
                *sum += curvature * (along[i] * along[j]);
            }
            let farthest = middle.abs() + spread + line.error;
            let weight = weight.abs();
            let rest =
                weight * (n * (n - 1.0) * (n - 2.0) / 6.0) * power(farthest, 3) * (spread * spread * spread);
            // The base and the powers are rounded: each power at most 2 n times.
            let off = 32.0 * n * n * n * line.error;
            error += rest * (1.0 + 64.0 * n * f64::EPSILON) + weight * off * power(farthest, 1);
            bend += 1.0001
                * weight
                * n
                * spread
                * ((n - 1.0) * power(farthest, 2) * (spread + off)
                    + 64.0 * n * f64::EPSILON * power(farthest, 1));
        }
        Taylor { f: Quadratic { value, gradient, squares, error }, bend, degree: self.degree() }
    }

    pub(crate) fn degree(&self) -> u32 {
        self.terms.iter().map(|term| term.exponent).max().unwrap_or(0)
    }

    /// Returns whether the surface may contain a plane of a lattice. It cannot if, on the planes across each
    /// axis, the sum is unbounded along another axis.
    pub(crate) fn may_hold_lattice_plane(&self) -> bool {
        let grows = |axis: usize| {
            let along = || self.terms.iter().filter(|term| !term.line.exact[axis].is_zero());
            let sign = |term: &Term| term.exact_weight.sign();
            let first = along().next().map(sign);
            along().count() == 1
                || (first.is_some()
                    && along().all(|term| term.exponent % 2 == 0 && first == Some(sign(term))))
        };
        (0..3).any(|axis| !(0..3).any(|other| other != axis && grows(other)))
    }

    /// Bounds for mixed axes. Each term depends on one quantity u alone. So the remainder after the linear
    /// part of Taylor's formula about the centre has its extremes at the centre and at the ends of u's range.
    /// (An odd power has one more extreme, opposite the centre, which the farther end exceeds.)
    fn bounds(&self, at: &Octants) -> Sides {
        let (halves, reach) = at.centres();
        let ranges = halves.each(|centre| {
            let splat = f64x4::splat;
            let zero = f64x4::ZERO;
            let mut value = splat(self.constant);
            let (mut least, mut most, mut slopes) = (value, value, [zero; 3]);
            let (mut rest_least, mut rest_most) = (zero, zero);
            let mut error = splat(32.0 * f64::EPSILON * self.constant.abs() + TINY);
            for term in &self.terms {
                let Term { line, exponent, .. } = term;
                let (n, weight) = (splat(*exponent as f64), splat(term.weight));
                let odd = exponent % 2 == 1;
                let spread = splat(reach * line.reach());
                let middle = line.values(centre);
                let (low, high) = (middle - spread, middle + spread);
                let rise = power(middle, exponent - 1);
                let [at_low, at_high] = [low, high].each(|u| power(u, *exponent));
                let there = rise * middle;
                let slope = n * rise;
                // The remainder.
                let step = slope * spread;
                let rests = [(at_low - there) + step, (at_high - there) - step];
                let (mut floor, mut ceiling) =
                    (zero.fast_min(rests[0]).fast_min(rests[1]), zero.fast_max(rests[0]).fast_max(rests[1]));
                // The term itself.
                let (mut bottom, mut top) = (at_low.fast_min(at_high), at_low.fast_max(at_high));
                if !odd {
                    let across = low.simd_lt(zero) & high.simd_gt(zero);
                    bottom = across.select(zero, bottom);
                }
                if term.weight < 0.0 {
                    (bottom, top, floor, ceiling) = (top, bottom, ceiling, floor);
                }
                value += weight * there;
                (least, most) = (least + weight * bottom, most + weight * top);
                (rest_least, rest_most) = (rest_least + weight * floor, rest_most + weight * ceiling);
                for axis in 0..3 {
                    slopes[axis] += weight * slope * splat(line.c[axis]);
                }
                // Let e be the error of the line, which is more than the roundings of u, and |u| the greatest
                // magnitude. Then all parts together have an error of less than 17 n² e |u|^(n − 1).
                let farthest = middle.abs() + spread + splat(line.error);
                let share = 32.0 * (*exponent as f64) * (*exponent as f64) * line.error;
                error += (weight * splat(share)).abs() * power(farthest, exponent - 1);
            }
            let spread = (slopes[0].abs() + slopes[1].abs() + slopes[2].abs()) * splat(reach);
            let least = least.fast_max(value - spread + rest_least) - error;
            let most = most.fast_min(value + spread + rest_most) + error;
            (least, most)
        });
        Sides::with_error([ranges[0].0, ranges[1].0], [ranges[0].1, ranges[1].1], 0.0).0
    }
}

impl Term {
    /// More than the error of (base ± line's error)^exponent, as a multiple of (|base| + error)^(exponent −
    /// 1).
    fn error(&self, most: f64) -> f64 {
        let n = self.exponent as f64;
        4.0 * n * self.line.error + 4.0 * (n + 8.0) * f64::EPSILON * most
    }
}

/// base^exponent, with an error of `exponent` roundings.
#[inline(always)]
fn power(mut base: f64x4, mut exponent: u32) -> f64x4 {
    let mut product = f64x4::ONE;
    while exponent > 1 {
        if exponent & 1 != 0 {
            product *= base;
        }
        base *= base;
        exponent >>= 1;
    }
    if exponent == 1 { product * base } else { product }
}

impl Aligned {
    fn new(terms: &[Term], constant: f64) -> Aligned {
        let mut exponents = [1; 4];
        let [mut weight, mut slope, mut offset, mut odd] = [[0.0; 4]; 4];
        let [mut base_error, mut base_share, mut power_share] = [[0.0; 4]; 3];
        let (mut least, mut most) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        let mask = |lanes: [f64; 4]| f64x4::new(lanes).simd_gt(f64x4::ZERO);
        for term in terms {
            let Some(axis) = term.line.axis() else { continue };
            exponents[axis] = term.exponent;
            (weight[axis], slope[axis], offset[axis]) = (term.weight, term.line.c[axis], term.line.c[3]);
            (base_error[axis], base_share[axis]) = (term.line.error, term.weight.abs() * term.error(0.0));
            power_share[axis] = term.weight.abs() * (term.error(1.0) - term.error(0.0));
            if term.exponent % 2 == 1 {
                odd[axis] = 1.0;
            } else if term.weight > 0.0 {
                least[axis] = 0.0;
            } else {
                most[axis] = 0.0;
            }
        }
        let bits = exponents.iter().map(|n| u32::BITS - (n - 1).leading_zeros()).max().unwrap_or(0);
        let factor = |bit: u32| mask(exponents.each(|n: u32| ((n - 1) >> bit & 1) as f64));
        Aligned {
            weight: f64x4::new(weight),
            slope: f64x4::new(slope),
            offset: f64x4::new(offset),
            factors: (0..bits).map(factor).collect(),
            odd: mask(odd),
            least: f64x4::new(least),
            most: f64x4::new(most),
            base_error: f64x4::new(base_error),
            base_share: f64x4::new(base_share),
            power_share: f64x4::new(power_share),
            constant,
            constant_error: 8.0 * f64::EPSILON * constant.abs() + TINY,
        }
    }

    /// The base, the weighted power and its error, at one coordinate of each axis.
    #[inline(always)]
    fn along(&self, t: f64x4) -> (f64x4, f64x4, f64x4) {
        let base = self.slope * t + self.offset;
        let most = base.abs() + self.base_error;
        let (mut power, mut square) = (f64x4::ONE, most);
        for factor in &self.factors {
            power = factor.select(power * square, power);
            square *= square;
        }
        let value = self.weight * power * most;
        let negative = self.odd & base.simd_lt(f64x4::ZERO);
        (base, negative.select(-value, value), power * (self.base_share + self.power_share * most))
    }

    /// The sides of the eight cells, and the cells for which rounding leaves a side open.
    #[inline(always)]
    fn sides(&self, at: &Octants) -> (Sides, u8) {
        let low = at.lanes();
        let middle = low + at.half;
        let high = middle + at.half;
        let (base_a, a, error_a) = self.along(low);
        let (base_b, b, error_b) = self.along(middle);
        let (base_c, c, error_c) = self.along(high);
        let [x, y, z, _] = error_a.fast_max(error_b).fast_max(error_c).to_array();
        let error = ((x + y) + z) + self.constant_error;
        let (up, down) = (f64x4::splat(f64::INFINITY), f64x4::splat(f64::NEG_INFINITY));
        let (first, second) =
            ((base_a * base_b).simd_lt(f64x4::ZERO), (base_b * base_c).simd_lt(f64x4::ZERO));
        let least = [(a, b, first), (b, c, second)]
            .each(|(a, b, across)| a.fast_min(b).fast_min(across.select(self.least, up)));
        let most = [(a, b, first), (b, c, second)]
            .each(|(a, b, across)| a.fast_max(b).fast_max(across.select(self.most, down)));
        Sides::with_error(sums(self.constant, least), sums(self.constant, most), error)
    }
}
