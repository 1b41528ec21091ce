//! Intervals that contain a true value.

use super::exact::{sign_of_sum, sqrt, two_product, two_sum};

/// A closed interval `[lower, upper]` of doubles that contains a real quantity.
///
/// The bounds are read as fields, `interval.lower` and `interval.upper` ([`IntervalEnds`]), and cannot be
/// changed. They are numbers or infinities, and `lower <= upper`: [`new`](Interval::new) rejects anything
/// else.
///
/// ```
/// use leafless::Interval;
/// let interval = Interval::new(1.0, 2.0).unwrap();
/// assert_eq!((interval.lower, interval.upper), (1.0, 2.0));
/// assert!(Interval::new(2.0, 1.0).is_none() && Interval::new(1.0, f64::NAN).is_none());
/// ```
///
/// ```compile_fail
/// let mut interval = leafless::Interval::exactly(1.0);
/// interval.upper = 0.0;
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct Interval(IntervalEnds);

/// The bounds of an [`Interval`], for reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalEnds {
    /// The lower bound.
    pub lower: f64,
    /// The upper bound.
    pub upper: f64,
}

impl core::ops::Deref for Interval {
    type Target = IntervalEnds;

    #[inline(always)]
    fn deref(&self) -> &IntervalEnds {
        &self.0
    }
}

impl core::fmt::Debug for Interval {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Interval").field("lower", &self.lower).field("upper", &self.upper).finish()
    }
}

impl Interval {
    /// The interval of all numbers: nothing is known.
    pub const ALL: Interval = Interval::between(f64::NEG_INFINITY, f64::INFINITY);

    /// Makes the interval from `lower` to `upper`. `None` if `lower > upper`, or if one of them is NaN.
    pub const fn new(lower: f64, upper: f64) -> Option<Interval> {
        if lower <= upper { Some(Interval(IntervalEnds { lower, upper })) } else { None }
    }

    /// Makes the interval between bounds that are known to be in order. Bounds from a caller, or from two
    /// different sources, may contradict each other: use [`new`](Interval::new) for those.
    #[inline(always)]
    pub(crate) const fn between(lower: f64, upper: f64) -> Interval {
        debug_assert!(lower <= upper, "an interval's bounds are in order");
        Interval(IntervalEnds { lower, upper })
    }

    /// The interval of a number that is known exactly. If `value` is NaN, nothing is known:
    /// [`ALL`](Interval::ALL).
    #[inline(always)]
    pub const fn exactly(value: f64) -> Interval {
        if value.is_nan() { Interval::ALL } else { Interval::between(value, value) }
    }

    /// Returns whether `value` lies in the interval.
    pub fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// `upper − lower`, rounded to nearest.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

/// Arithmetic that rounds outward: the result contains the exact result for any numbers in the operands. A
/// bound that is a double is exact. A result that leaves the range of doubles is still valid, if as wide as
/// `[1.8e308, ∞]`. A solid that computes with intervals proves its verdicts and slabs.
///
/// ```
/// use leafless::Interval;
/// let (a, b) = (Interval::exactly(0.1), Interval::new(-1.0, 2.0).unwrap());
/// let sum = a.times(b).plus(b.square());
/// assert!(sum.lower <= -0.1 && sum.upper >= 4.2);
/// assert_eq!(Interval::exactly(9.0).root(), Interval::exactly(3.0));
/// assert_eq!(Interval::exactly(1.0).over(b), Interval::ALL);
/// ```
impl Interval {
    /// The interval of an integer below 2^120 in magnitude.
    pub(crate) fn of_integer(value: i128) -> Interval {
        let nearest = value as f64;
        let error = value - nearest as i128;
        let lower = if error < 0 { nearest.next_down() } else { nearest };
        let upper = if error > 0 { nearest.next_up() } else { nearest };
        Interval::between(lower, upper)
    }

    /// The negated numbers.
    #[must_use]
    pub fn negated(self) -> Interval {
        Interval::between(-self.upper, -self.lower)
    }

    /// The sum.
    #[must_use]
    pub fn plus(self, other: Interval) -> Interval {
        let lower = rounded(two_sum(self.lower, other.lower), true).lower;
        let upper = rounded(two_sum(self.upper, other.upper), true).upper;
        Interval::between(lower, upper)
    }

    /// The difference.
    #[must_use]
    pub fn minus(self, other: Interval) -> Interval {
        self.plus(other.negated())
    }

    /// The product. A factor of 0 makes it 0, whatever the other factor is.
    #[must_use]
    pub fn times(self, other: Interval) -> Interval {
        let [a, b] = [self.lower, self.upper];
        let [c, d] = [other.lower, other.upper];
        let [ac, ad, bc, bd] = [product(a, c), product(a, d), product(b, c), product(b, d)];
        let lower = ac.lower.min(ad.lower).min(bc.lower.min(bd.lower));
        let upper = ac.upper.max(ad.upper).max(bc.upper.max(bd.upper));
        Interval::between(lower, upper)
    }

    /// The square, which is never negative.
    #[must_use]
    pub fn square(self) -> Interval {
        self.times(self).not_negative()
    }

    /// The quotient by a positive number; all numbers if `divisor` may be 0.
    #[must_use]
    pub fn over(self, divisor: Interval) -> Interval {
        if divisor.lower <= 0.0 {
            return Interval::ALL;
        }
        let lower = if self.lower < 0.0 { divisor.lower } else { divisor.upper };
        let upper = if self.upper < 0.0 { divisor.upper } else { divisor.lower };
        Interval::between(quotient(self.lower, lower).lower, quotient(self.upper, upper).upper)
    }

    /// The square root of a number that is not negative. A negative bound counts as 0.
    #[must_use]
    pub fn root(self) -> Interval {
        let of = |x: f64| {
            let x = x.max(0.0);
            let root = sqrt(x);
            let is_exact = x == 0.0 || is_splittable(x) && two_product(root, root) == (x, 0.0);
            if is_exact { Interval::exactly(root) } else { around(root) }
        };
        Interval::between(of(self.lower).lower.max(0.0), of(self.upper).upper)
    }

    /// The intersection with another interval of the same number. `None` if it is empty: then one of the
    /// intervals is wrong, or no such number exists.
    pub fn common(self, other: Interval) -> Option<Interval> {
        Interval::new(self.lower.max(other.lower), self.upper.min(other.upper))
    }

    /// The interval of a number that is known not to be negative. (A negative upper bound contradicts that,
    /// and counts as 0.)
    #[must_use]
    pub fn not_negative(self) -> Interval {
        Interval::between(self.lower.max(0.0), self.upper.max(0.0))
    }

    /// The least interval that contains both.
    #[must_use]
    pub fn joined(self, other: Interval) -> Interval {
        Interval::between(self.lower.min(other.lower), self.upper.max(other.upper))
    }
}

/// The interval between the neighbours of `value`; beyond the largest double, it ends at infinity.
fn around(value: f64) -> Interval {
    Interval::between(value.next_down(), value.next_up())
}

/// The number `value + error`, where `value` is the nearest double; `reliable` means that the error is exact.
#[inline(always)]
fn rounded((value, error): (f64, f64), reliable: bool) -> Interval {
    if reliable && value.is_finite() && !error.is_nan() {
        let lower = if error < 0.0 { value.next_down() } else { value };
        let upper = if error > 0.0 { value.next_up() } else { value };
        Interval::between(lower, upper)
    } else if value.is_nan() {
        Interval::ALL
    } else {
        around(value)
    }
}

#[inline(always)]
fn product(a: f64, b: f64) -> Interval {
    // An infinite bound stands for numbers of any size, and zero times each of them is zero.
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

/// Returns whether the error of a product of such numbers is exact, if the product is such a number, too.
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
        Interval::new(lower, upper).unwrap()
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

    #[test]
    fn bounds_are_in_order_or_refused() {
        let (nan, inf) = (f64::NAN, f64::INFINITY);
        for (lower, upper) in
            [(1.0, 0.0), (nan, 1.0), (1.0, nan), (nan, nan), (inf, -inf), (f64::MIN_POSITIVE, 0.0)]
        {
            assert_eq!(Interval::new(lower, upper), None, "{lower} {upper}");
        }
        for (lower, upper) in [(0.0, 0.0), (-0.0, 0.0), (0.0, -0.0), (-inf, inf), (inf, inf), (1.0, 2.0)] {
            let interval = Interval::new(lower, upper).unwrap();
            assert_eq!((interval.lower, interval.upper), (lower, upper));
        }
        assert_eq!(Interval::exactly(nan), Interval::ALL);
        assert_eq!(of(0.0, 2.0).common(of(1.0, 3.0)), Some(of(1.0, 2.0)));
        assert_eq!(of(0.0, 1.0).common(of(1.0, 3.0)), Some(Interval::exactly(1.0)));
        assert_eq!(of(0.0, 1.0).common(of(2.0, 3.0)), None);
        assert_eq!(of(0.0, 1.0).joined(of(2.0, 3.0)), of(0.0, 3.0));
        assert_eq!(of(-2.0, -1.0).not_negative(), Interval::exactly(0.0));
        assert_eq!(of(-2.0, 1.0).not_negative(), of(0.0, 1.0));
    }

    /// Applies every operation to every pair from a set of difficult bounds. The bounds must stay in order,
    /// which the constructor asserts.
    #[test]
    fn arithmetic_keeps_the_order() {
        let inf = f64::INFINITY;
        let numbers =
            [-inf, f64::MIN, -1.0, -f64::MIN_POSITIVE, -5e-324, 0.0, 5e-324, 0.1, 1.0, f64::MAX, inf];
        let pairs =
            || numbers.iter().enumerate().flat_map(|(i, &a)| numbers[i..].iter().map(move |&b| of(a, b)));
        for a in pairs() {
            for c in [a.negated(), a.square(), a.root(), a.not_negative()] {
                assert!(c.lower <= c.upper, "{a:?} {c:?}");
            }
            for b in pairs() {
                for c in [a.plus(b), a.minus(b), a.times(b), a.over(b), a.joined(b)] {
                    assert!(c.lower <= c.upper, "{a:?} {b:?} {c:?}");
                }
            }
        }
    }
}
