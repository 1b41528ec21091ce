//! Numbers of two doubles, with about 106 bits.
//!
//! (Dekker 1971; Hida, Li and Bailey 2001.) The last bits are rounded, so that such numbers alone decide
//! nothing. They make errors so small that exact arithmetic is hardly ever needed.

use super::{sqrt, two_product, two_sum};
use core::ops::{Add, Mul, Neg, Sub};

/// The sum of two doubles, the second of which is at most half a unit in the last place of the first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct DoubleDouble {
    pub high: f64,
    pub low: f64,
}

impl DoubleDouble {
    /// A bound of the relative error of a sum of magnitudes, a product or a root.
    pub const EPSILON: f64 = 16.0 * f64::EPSILON * f64::EPSILON;

    /// The sum of two doubles.
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> DoubleDouble {
        let (high, low) = two_sum(a, b);
        DoubleDouble { high, low }
    }

    /// The product of two doubles.
    #[inline(always)]
    pub fn product(a: f64, b: f64) -> DoubleDouble {
        let (high, low) = two_product(a, b);
        DoubleDouble { high, low }
    }

    /// The square root; 0 for a negative number.
    #[inline]
    pub fn root(self) -> DoubleDouble {
        if self.high <= 0.0 {
            return DoubleDouble::default();
        }
        // One Newton step doubles the number of correct digits.
        let root = sqrt(self.high);
        let rest = self - DoubleDouble::product(root, root);
        DoubleDouble::sum(root, rest.high / (2.0 * root))
    }

    /// The quotient as a double, with an error of little more than a unit in the last place.
    #[inline]
    pub fn quotient(self, by: DoubleDouble) -> f64 {
        let quotient = self.high / by.high;
        let rest = self - by * DoubleDouble::from(quotient);
        quotient + rest.high / by.high
    }
}

impl From<f64> for DoubleDouble {
    #[inline(always)]
    fn from(high: f64) -> DoubleDouble {
        DoubleDouble { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;

    #[inline(always)]
    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let (s, e) = two_sum(self.high, other.high);
        let (t, f) = two_sum(self.low, other.low);
        let (s, e) = two_sum(s, e + t);
        DoubleDouble::sum(s, e + f)
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;

    #[inline(always)]
    fn neg(self) -> DoubleDouble {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;

    #[inline(always)]
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;

    #[inline(always)]
    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        let (high, low) = two_product(self.high, other.high);
        DoubleDouble::sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Dyadic;
    use super::*;

    fn exactly(x: DoubleDouble) -> Dyadic {
        &Dyadic::new(x.high) + &Dyadic::new(x.low)
    }

    /// Returns whether the difference is at most `size` times the relative error.
    fn is_near(found: DoubleDouble, expected: &Dyadic, size: f64) -> bool {
        let off = &exactly(found) - expected;
        off.rounded().abs() <= size * DoubleDouble::EPSILON
    }

    #[test]
    fn errors_are_as_small_as_stated() {
        let mut state = 11u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let unit = (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
            unit * 2f64.powi((state >> 5 & 15) as i32 - 8)
        };
        for _ in 0..20_000 {
            let [a, b] = [0; 2].map(|_| DoubleDouble::sum(random(), random() * 2f64.powi(-54)));
            let (x, y) = (exactly(a), exactly(b));
            let size = a.high.abs() + b.high.abs();
            assert!(is_near(a + b, &(&x + &y), size));
            assert!(is_near(a - b, &(&x - &y), size));
            assert!(is_near(a * b, &(&x * &y), (a.high * b.high).abs()));
            let root = (a * a).root();
            assert!(
                is_near(root, &if a.high < 0.0 { -&x } else { x.clone() }, a.high.abs()),
                "{a:?} {root:?}"
            );
            let quotient = a.quotient(b);
            let back = &Dyadic::new(quotient) * &y;
            assert!((&back - &x).rounded().abs() <= 4.0 * f64::EPSILON * a.high.abs());
        }
        assert_eq!(DoubleDouble::from(-1.0).root(), DoubleDouble::default());
    }
}
