//! Intervals that contain the truth.

use super::exact::{sign_of_sum, sqrt, two_product, two_sum};

/// A closed interval `[lower, upper]` of doubles that contains a real quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Nothing below is possible.
    pub lower: f64,
    /// Nothing above is possible.
    pub upper: f64,
}

impl Interval {
    /// The interval of a number that is known exactly.
    pub const fn exactly(value: f64) -> Interval {
        Interval { lower: value, upper: value }
    }

    /// Whether `value` lies in the interval.
    pub fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// `upper − lower`, rounded to nearest.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

/// Arithmetic that rounds outward: the result contains what the operation gives for any numbers in the
/// operands. A bound that is a double is met exactly. Where a result leaves the range of doubles it is still
/// true, if as wide as `[1.8e308, ∞]`.
impl Interval {
    /// Of an integer below 2^120 in magnitude.
    pub(crate) fn of_integer(value: i128) -> Interval {
        let nearest = value as f64;
        let error = value - nearest as i128;
        let lower = if error < 0 { nearest.next_down() } else { nearest };
        let upper = if error > 0 { nearest.next_up() } else { nearest };
        Interval { lower, upper }
    }

    pub(crate) fn negated(self) -> Interval {
        Interval { lower: -self.upper, upper: -self.lower }
    }

    pub(crate) fn plus(self, other: Interval) -> Interval {
        Interval {
            lower: rounded(two_sum(self.lower, other.lower), true).lower,
            upper: rounded(two_sum(self.upper, other.upper), true).upper,
        }
    }

    pub(crate) fn minus(self, other: Interval) -> Interval {
        self.plus(other.negated())
    }

    pub(crate) fn times(self, other: Interval) -> Interval {
        let [a, b] = [self.lower, self.upper];
        let [c, d] = [other.lower, other.upper];
        let [ac, ad, bc, bd] = [product(a, c), product(a, d), product(b, c), product(b, d)];
        Interval {
            lower: ac.lower.min(ad.lower).min(bc.lower.min(bd.lower)),
            upper: ac.upper.max(ad.upper).max(bc.upper.max(bd.upper)),
        }
    }

    /// The square, which is never negative.
    pub(crate) fn square(self) -> Interval {
        let Interval { lower, upper } = self.times(self);
        Interval { lower: lower.max(0.0), upper }
    }

    /// Divided by a positive number; all numbers if `divisor` may be 0.
    pub(crate) fn over(self, divisor: Interval) -> Interval {
        if divisor.lower <= 0.0 {
            return Interval { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
        }
        let lower = if self.lower < 0.0 { divisor.lower } else { divisor.upper };
        let upper = if self.upper < 0.0 { divisor.upper } else { divisor.lower };
        Interval { lower: quotient(self.lower, lower).lower, upper: quotient(self.upper, upper).upper }
    }

    /// The square root of a number that is not negative, whatever its bounds say.
    pub(crate) fn root(self) -> Interval {
        let of = |x: f64| {
            let x = x.max(0.0);
            let root = sqrt(x);
            let is_exact = x == 0.0 || is_splittable(x) && two_product(root, root) == (x, 0.0);
            if is_exact { Interval::exactly(root) } else { around(root) }
        };
        Interval { lower: of(self.lower).lower.max(0.0), upper: of(self.upper).upper }
    }

    /// With what else is known of the same number.
    pub(crate) fn within(self, other: Interval) -> Interval {
        Interval { lower: self.lower.max(other.lower), upper: self.upper.min(other.upper) }
    }
}

/// A number between the neighbours of `value`, or beyond the largest double on the same side.
fn around(value: f64) -> Interval {
    Interval { lower: value.next_down(), upper: value.next_up() }
}

/// The number `value + error` with `value` the nearest double, if the error is one that can be relied on.
#[inline(always)]
fn rounded((value, error): (f64, f64), reliable: bool) -> Interval {
    if reliable && value.is_finite() && !error.is_nan() {
        let lower = if error < 0.0 { value.next_down() } else { value };
        let upper = if error > 0.0 { value.next_up() } else { value };
        Interval { lower, upper }
    } else if value.is_nan() {
        Interval { lower: f64::NEG_INFINITY, upper: f64::INFINITY }
    } else {
        around(value)
    }
}

#[inline(always)]
fn product(a: f64, b: f64) -> Interval {
    // A bound of infinity stands for numbers of any size, and zero times each is zero.
    if a == 0.0 || b == 0.0 {
        return Interval::exactly(0.0);
    }
    let (value, error) = two_product(a, b);
    rounded((value, error), is_splittable(a) && is_splittable(b) && is_splittable(value))
}

/// The quotient of `a` and a positive `b`.
fn quotient(a: f64, b: f64) -> Interval {
    if a == 0.0 {
        return Interval::exactly(0.0);
    }
    let value = a / b;
    let (whole, part) = two_product(value, b);
    let rest = sign_of_sum(&[a, -whole, -part]);
    rounded((value, rest as f64), is_splittable(a) && is_splittable(b) && is_splittable(value))
}

/// Whether the error of a product of such numbers is exact, the product being one itself.
#[inline(always)]
fn is_splittable(x: f64) -> bool {
    /// 2^900
    const LARGE: f64 = f64::from_bits((1023 + 900) << 52);
    (1.0 / LARGE..=LARGE).contains(&x.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(lower: f64, upper: f64) -> Interval {
        Interval { lower, upper }
    }

    #[test]
    fn exact_results_stay_exact() {
        let three = Interval::exactly(3.0);
        assert_eq!(three.times(of(-0.5, 2.0)), of(-1.5, 6.0));
        assert_eq!(three.plus(of(-0.5, 2.0)), of(2.5, 5.0));
        assert_eq!(of(-6.0, 9.0).over(three), of(-2.0, 3.0));
        assert_eq!(of(-2.0, 3.0).square(), of(0.0, 9.0));
        assert_eq!(of(4.0, 9.0).root(), of(2.0, 3.0));
        assert_eq!(Interval::of_integer(-(1 << 100)), Interval::exactly(-(2f64.powi(100))));
    }

    #[test]
    fn inexact_ones_take_two_neighbours() {
        let tenth = Interval::exactly(0.1);
        for result in [
            tenth.times(tenth),
            tenth.plus(Interval::exactly(0.2)),
            Interval::exactly(1.0).over(Interval::exactly(3.0)),
            Interval::of_integer((1 << 60) + 1),
            Interval::of_integer(-(1 << 60) - 1),
        ] {
            assert_eq!(result.lower.next_up(), result.upper, "{result:?}");
        }
        let third = Interval::exactly(1.0).over(Interval::exactly(3.0));
        assert!(third.lower * 3.0 <= 1.0 && third.contains(1.0 / 3.0));
        // 2^60 + 1 lies above its nearest double.
        assert_eq!(Interval::of_integer((1 << 60) + 1).lower, 2f64.powi(60));
        assert!(of(2.0, 2.0).root().contains(core::f64::consts::SQRT_2));
    }

    #[test]
    fn the_ends_of_the_range_are_true() {
        let (tiny, huge) = (Interval::exactly(f64::MIN_POSITIVE), Interval::exactly(f64::MAX));
        let below = tiny.times(tiny);
        assert!(below.lower <= 0.0 && below.upper > 0.0);
        assert_eq!(huge.times(huge), of(f64::MAX, f64::INFINITY));
        assert_eq!(huge.plus(huge), of(f64::MAX, f64::INFINITY));
        assert_eq!(huge.negated().plus(huge.negated()), of(f64::NEG_INFINITY, f64::MIN));
        let all = of(f64::NEG_INFINITY, f64::INFINITY);
        assert_eq!(all.plus(all), all);
        assert_eq!(all.times(Interval::exactly(0.0)), Interval::exactly(0.0));
        assert_eq!(of(1.0, 2.0).over(of(0.0, 1.0)), all);
        assert_eq!(of(0.0, f64::INFINITY).times(of(-1.0, 2.0)), all);
    }
}
