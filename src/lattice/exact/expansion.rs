//! Sums of doubles that do not overlap, so that the largest term has the sign of the sum (Shewchuk, *Adaptive
//! precision floating-point arithmetic*, 1997). This code is not performance-critical.

use super::{grow, sign, two_product};
use alloc::vec::Vec;

/// An exact real number: non-overlapping terms of increasing magnitude, without zeros.
#[derive(Debug, Clone, Default)]
pub(crate) struct Expansion(Vec<f64>);

impl Expansion {
    /// The sum of `terms`.
    pub(crate) fn sum(terms: impl IntoIterator<Item = f64>) -> Expansion {
        let mut sum = Expansion::default();
        terms.into_iter().for_each(|term| sum.add(term));
        sum
    }

    fn add(&mut self, term: f64) {
        let count = self.0.len();
        self.0.push(0.0);
        let kept = grow(&mut self.0, count, term);
        self.0.truncate(kept);
    }

    pub(crate) fn plus(mut self, other: &Expansion) -> Expansion {
        other.0.iter().for_each(|&term| self.add(term));
        self
    }

    pub(crate) fn minus(mut self, other: &Expansion) -> Expansion {
        other.0.iter().for_each(|&term| self.add(-term));
        self
    }

    pub(crate) fn times(&self, other: &Expansion) -> Expansion {
        let mut product = Expansion::default();
        for &a in &self.0 {
            for &b in &other.0 {
                let (high, low) = two_product(a, b);
                product.add(low);
                product.add(high);
            }
        }
        product
    }

    /// The number as a double, with a relative error of at most 2^-52.
    pub(crate) fn estimate(&self) -> f64 {
        self.0.iter().sum()
    }

    /// The sign: −1, 0 or 1.
    pub(crate) fn sign(&self) -> i32 {
        self.0.last().map_or(0, |&term| sign(term))
    }
}

/// The sign of a value that is known up to an error; `None` if the error leaves it open. Without an error,
/// zero is a sign.
#[inline(always)]
pub(crate) fn certain(value: f64, error: f64) -> Option<i32> {
    if value > error || value < -error || error == 0.0 { Some(sign(value)) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_cancel_exactly() {
        let a = Expansion::sum([1e20, 1.0, 1e-20]);
        let b = Expansion::sum([1e20, -1.0, 1e-20]);
        let squares = Expansion::sum([1e20, 1e-20]);
        // (s + 1)(s − 1) − s² + 1 = 0 with s = 1e20 + 1e-20.
        let zero = a.times(&b).minus(&squares.times(&squares)).plus(&Expansion::sum([1.0]));
        assert_eq!(zero.sign(), 0);
        assert_eq!(zero.plus(&Expansion::sum([1e-60])).sign(), 1);
    }
}
