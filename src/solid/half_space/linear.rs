//! Linear functions of the unit coordinates.

use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use wide::f64x4;

/// f(x, y, z) = a x + b y + c z + d, with exact and with rounded coefficients.
pub(crate) struct Linear {
    pub(crate) exact: [Dyadic; 4],
    pub(crate) c: [f64; 4],
    /// More than the error of a rounded value on the universe, and of the coordinates for which f is exact.
    pub(crate) error: f64,
}

/// The exponent of the largest coefficient.
pub(crate) fn magnitude<'a>(exact: impl IntoIterator<Item = &'a Dyadic>) -> i64 {
    exact.into_iter().filter_map(Dyadic::magnitude).max().unwrap_or(0)
}

/// The value of a x + b y + c z + d at `t`, for the coefficients a to d.
pub(crate) fn value(exact: &[Dyadic; 4], t: &[Dyadic; 3]) -> Dyadic {
    (0..3).fold(exact[3].clone(), |sum, axis| &sum + &(&exact[axis] * &t[axis]))
}

/// Returns whether no sum of products is rounded. The factors are `coefficients` (doubles) and multiples of
/// 2^-`places`; no sum is greater than `size`. This holds if `size` is below 2^53 times the finest grain.
pub(crate) fn is_exact(coefficients: &[Dyadic], places: i64, size: f64) -> bool {
    let grain = coefficients.iter().filter_map(Dyadic::grain).min().unwrap_or(0) - places;
    Dyadic::new(size).magnitude().is_none_or(|m| m + 1 - grain <= 53)
}

impl Linear {
    pub(super) fn heap_bytes(&self) -> usize {
        self.exact.iter().map(Dyadic::heap_bytes).sum()
    }

    /// Returns the function with the coefficients a to d. They must not all be zero, nor, rounded, near the
    /// ends of the range of doubles.
    pub(crate) fn new(exact: [Dyadic; 4]) -> Linear {
        let c = exact.each_ref().each(Dyadic::rounded);
        // Coefficients, products and sums are rounded: at most six roundings a term.
        let error = 8.0 * f64::EPSILON * c.iter().map(|c| c.abs()).sum::<f64>();
        Linear { exact, c, error }
    }

    /// Returns the only axis on which the function depends, if there is exactly one.
    pub(crate) fn axis(&self) -> Option<usize> {
        let mut axes = (0..3).filter(|&axis| !self.exact[axis].is_zero());
        axes.next().filter(|_| axes.next().is_none())
    }

    #[inline(always)]
    pub(crate) fn value(&self, [x, y, z]: [f64; 3]) -> f64 {
        let [a, b, c, d] = self.c;
        ((a * x + b * y) + c * z) + d
    }

    /// The values at four points.
    #[inline(always)]
    pub(crate) fn values(&self, [x, y, z]: [f64x4; 3]) -> f64x4 {
        let [a, b, c, d] = self.c.each(f64x4::splat);
        ((a * x + b * y) + c * z) + d
    }

    /// The greatest difference of a value from the value at the centre of a cube of half edge 1.
    #[inline(always)]
    pub(crate) fn reach(&self) -> f64 {
        (self.c[0].abs() + self.c[1].abs()) + self.c[2].abs()
    }

    pub(crate) fn exactly_at(&self, t: &[Dyadic; 3]) -> Dyadic {
        value(&self.exact, t)
    }
}
