//! Numbers with an error bound, where speed matters more than tightness.

use super::exact::sqrt;

/// A real number that differs from `value` by at most `error`.
///
/// An operation takes about as long as two operations on plain doubles. (An [`Interval`](super::Interval)
/// keeps exact bounds, and takes ten times as long.) Where a result leaves the range of doubles, the error is
/// infinite or NaN, and the sign is unknown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    pub value: f64,
    pub error: f64,
}

/// A bound of the relative error of a rounded result.
const ROUNDING: f64 = f64::EPSILON;

/// The factor that covers the up to eight roundings in the computation of an error.
const SLACK: f64 = 1.0 + 8.0 * f64::EPSILON;

/// A bound of the error of a subnormal result.
const TINY: f64 = f64::MIN_POSITIVE;

impl Ball {
    pub const ZERO: Ball = Ball { value: 0.0, error: 0.0 };

    #[inline(always)]
    pub fn exactly(value: f64) -> Ball {
        Ball { value, error: 0.0 }
    }

    #[inline(always)]
    fn rounded(value: f64, error: f64) -> Ball {
        Ball { value, error: (error + ROUNDING * value.abs()) * SLACK }
    }

    /// The sum of doubles.
    #[inline(always)]
    pub fn sum(terms: &[f64]) -> Ball {
        match *terms {
            [] => Ball::ZERO,
            [one] => Ball::exactly(one),
            [first, ref rest @ ..] => {
                rest.iter().fold(Ball::exactly(first), |sum, &term| sum.plus(Ball::exactly(term)))
            }
        }
    }

    #[inline(always)]
    pub fn plus(self, other: Ball) -> Ball {
        Ball::rounded(self.value + other.value, self.error + other.error)
    }

    #[inline(always)]
    pub fn minus(self, other: Ball) -> Ball {
        Ball::rounded(self.value - other.value, self.error + other.error)
    }

    #[inline(always)]
    pub fn times(self, other: Ball) -> Ball {
        let error =
            self.value.abs() * other.error + other.value.abs() * self.error + self.error * other.error;
        Ball::rounded(self.value * other.value, error + TINY)
    }

    /// The number with `radius` added to its error.
    #[inline(always)]
    pub fn widened(self, radius: f64) -> Ball {
        Ball { value: self.value, error: (self.error + radius) * SLACK }
    }

    /// The reciprocal; an unknown number if the divisor may be 0.
    #[inline(always)]
    pub fn reciprocal(self) -> Ball {
        let least = self.value.abs() * (1.0 - 2.0 * ROUNDING) - self.error;
        let value = 1.0 / self.value;
        let is_sure = least > TINY && value.is_finite();
        let error = if is_sure { self.error * value.abs() / least + TINY } else { f64::INFINITY };
        Ball::rounded(value, error)
    }

    /// The square root of a number that is not negative.
    #[inline(always)]
    pub fn root(self) -> Ball {
        let largest = self.value + self.error;
        if self.value > self.error {
            let value = sqrt(self.value);
            Ball::rounded(value, self.error / value + TINY)
        } else {
            // Any number from 0 to the root of the largest value.
            let half = 0.5 * sqrt(largest.max(0.0) * SLACK) * SLACK;
            Ball { value: half, error: half + TINY }
        }
    }

    /// The power with an exponent of 1 to 64.
    #[inline]
    pub fn power(self, exponent: u32) -> Ball {
        let mut product = self;
        let mut rest = 31 - exponent.leading_zeros();
        while rest > 0 {
            rest -= 1;
            product = product.times(product);
            if exponent >> rest & 1 != 0 {
                product = product.times(self);
            }
        }
        product
    }

    /// The largest possible magnitude.
    #[inline(always)]
    pub fn magnitude(self) -> f64 {
        (self.value.abs() + self.error) * SLACK
    }

    /// Returns whether the number is positive (`true`) or negative (`false`); `None` if the sign is unknown.
    #[inline(always)]
    pub fn is_positive(self) -> Option<bool> {
        if self.value > self.error {
            Some(true)
        } else if self.value < -self.error {
            Some(false)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Interval;
    use alloc::vec::Vec;

    /// Compares each operation with intervals that are known to be correct, for the centres and ends of the
    /// operands.
    #[test]
    fn results_contain_what_the_numbers_give() {
        let values = [0.0, 1.0, -1.0, 0.1, -3.7, 1e-300, -1e-160, 1e160, 7.0 / 3.0, 1e15 + 0.5, 2.2e-308];
        let errors = [0.0, 1e-320, 1e-16, 0.25, 1.0, 1e140];
        let mut balls = Vec::new();
        for value in values {
            balls.extend(errors.map(|error| Ball { value, error }));
        }
        // (An end that is rounded outward does not lie in the ball.)
        let points = |ball: &Ball| {
            let ends = [ball.value - 0.99 * ball.error, ball.value + 0.99 * ball.error];
            let is_within = |x: f64| (x - ball.value).abs() <= ball.error;
            [ball.value, ends[0], ends[1]].map(|x| if is_within(x) { x } else { ball.value })
        };
        let holds = |ball: Ball, truth: Interval| {
            // (A result that is not finite promises nothing.)
            let [low, high] = [ball.value - ball.error, ball.value + ball.error];
            let is_silent = !(low.is_finite() && high.is_finite());
            is_silent || low.next_down() <= truth.lower && truth.upper <= high.next_up()
        };
        for a in &balls {
            for b in &balls {
                for (x, y) in points(a).into_iter().flat_map(|x| points(b).map(|y| (x, y))) {
                    let [ix, iy] = [x, y].map(Interval::exactly);
                    assert!(holds(a.plus(*b), ix.plus(iy)), "{a:?} {b:?}");
                    assert!(holds(a.minus(*b), ix.minus(iy)), "{a:?} {b:?}");
                    assert!(holds(a.times(*b), ix.times(iy)), "{a:?} {b:?}");
                }
            }
            for x in points(a) {
                let ix = Interval::exactly(x);
                if x != 0.0 {
                    let one = Interval::exactly(1.0);
                    let truth = if x > 0.0 { one.over(ix) } else { one.over(ix.negated()).negated() };
                    assert!(holds(a.reciprocal(), truth), "{a:?} {x:e}");
                }
                if x >= 0.0 {
                    assert!(holds(a.root(), ix.root()), "{a:?} {x:e}");
                }
                for n in [1, 2, 3, 7, 64] {
                    let truth = (1..n).fold(ix, |all, _| all.times(ix));
                    if truth.lower.is_finite() && truth.upper.is_finite() {
                        let own = a.power(n);
                        // Both bounds contain the true result, so that they must overlap.
                        let meets =
                            own.value - own.error <= truth.upper && truth.lower <= own.value + own.error;
                        assert!(meets || !own.error.is_finite() || own.value.is_nan(), "{a:?} {x:e} {n}");
                    }
                }
            }
        }
    }
}
