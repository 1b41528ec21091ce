//! Exact arithmetic of two kinds.
//!
//! * Sums of doubles, for the sign of a short polynomial in the doubles that define a shape: [`sign_of_sum`]
//!   and [`sign_of_products`] where the number of terms is known, an [`Expansion`] where it is not. They use
//!   error-free transformations, which turn the sum or product of two doubles into a pair `(rounded, error)`
//!   (Dekker 1971, Knuth 1969). All of it holds under round-to-nearest as long as nothing overflows or
//!   underflows. The ranges that frames and shapes accept (2^±256) guarantee that for polynomials up to
//!   degree three.
//! * [`Dyadic`], an integer of any length times a power of two, for numbers that grow: coefficients of
//!   half-spaces, nested placements, polynomials of any degree. It never overflows, and it is slow.
//!
//! Both decide the cases that floating point with an error bound leaves open. That filter is the caller's
//! task.

mod double_double;
mod dyadic;
mod expansion;

pub(crate) use double_double::DoubleDouble;
pub(crate) use dyadic::{Dyadic, cross, dot};
pub(crate) use expansion::{Expansion, certain};

/// `a + b` as `(rounded, error)` with `rounded + error = a + b` exactly.
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

/// `a − b` as `(rounded, error)`.
#[inline(always)]
pub fn two_diff(a: f64, b: f64) -> (f64, f64) {
    two_sum(a, -b)
}

#[inline(always)]
fn halves(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let c = SPLITTER * a;
    let high = c - (c - a);
    (high, a - high)
}

/// `a · b` as `(rounded, error)`, without a fused multiply so that every platform computes the same.
#[inline(always)]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let (ah, al) = halves(a);
    let (bh, bl) = halves(b);
    (product, al * bl - (((product - ah * bh) - al * bh) - ah * bl))
}

/// The square root, correctly rounded, and therefore the same on every platform. (glam's `length` makes a
/// function call for it.)
#[inline(always)]
pub fn sqrt(x: f64) -> f64 {
    #[cfg(feature = "std")]
    return x.sqrt();
    #[cfg(not(feature = "std"))]
    return libm::sqrt(x);
}

/// The largest double ≤ `a · b`.
pub fn product_down(a: f64, b: f64) -> f64 {
    let (product, error) = two_product(a, b);
    if error < 0.0 { product.next_down() } else { product }
}

/// The smallest double ≥ `a · b`.
pub fn product_up(a: f64, b: f64) -> f64 {
    let (product, error) = two_product(a, b);
    if error > 0.0 { product.next_up() } else { product }
}

/// Adds `value` to the expansion in `terms[..count]` (non-overlapping, increasing magnitude) and returns the
/// new count; zeros are dropped. `terms` needs room for one more term (Shewchuk 1997, Grow-Expansion).
#[inline]
fn grow(terms: &mut [f64], count: usize, value: f64) -> usize {
    let mut carry = value;
    let mut kept = 0;
    for i in 0..count {
        let (sum, error) = two_sum(carry, terms[i]);
        carry = sum;
        if error != 0.0 {
            terms[kept] = error;
            kept += 1;
        }
    }
    if carry != 0.0 {
        terms[kept] = carry;
        kept += 1;
    }
    kept
}

/// The exact sign (−1, 0, 1) of the sum of the values.
pub fn sign_of_sum<const N: usize>(values: &[f64; N]) -> i32 {
    let mut terms = [0.0; N];
    let count = values.iter().fold(0, |count, &value| grow(&mut terms, count, value));
    // The last term of an expansion outweighs all other terms together.
    terms[..count].last().map_or(0, |&term| sign(term))
}

/// The exact sign (−1, 0, 1) of the sum of the products of up to twelve pairs.
pub fn sign_of_products(pairs: &[(f64, f64)]) -> i32 {
    let mut terms = [0.0; 24];
    let mut count = 0;
    for &(a, b) in pairs {
        let (high, low) = two_product(a, b);
        count = grow(&mut terms, count, low);
        count = grow(&mut terms, count, high);
    }
    terms[..count].last().map_or(0, |&term| sign(term))
}

/// The sign of a number: −1, 0 or 1.
#[inline]
pub fn sign(value: f64) -> i32 {
    (value > 0.0) as i32 - (value < 0.0) as i32
}

/// ⌊x⌋ for |x| < 2^62. (`core` has no floor, and without SSE4.1 the library call costs more than this.)
#[inline(always)]
pub fn floor(x: f64) -> i64 {
    let truncated = x as i64;
    truncated - (x < truncated as f64) as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_products_lose_nothing() {
        assert_eq!(two_sum(1.0, 1e-30), (1.0, 1e-30));
        let (p, e) = two_product(1.0 + f64::EPSILON, 1.0 + f64::EPSILON);
        assert_eq!((p, e), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
        assert_eq!(sign_of_sum(&[1e30, 1.0, -1e30, -1.0, 1e-200]), 1);
        assert_eq!(sign_of_sum(&[0.1, 0.2, -0.3]), 1);
        assert_eq!(sign_of_sum(&[3.0, -1.0, -2.0]), 0);
        assert_eq!(sign_of_sum(&[]), 0);
        assert_eq!(sign_of_products(&[(1.0 + f64::EPSILON, 1.0 - f64::EPSILON), (-1.0, 1.0)]), -1);
    }

    #[test]
    fn directed_products() {
        assert_eq!((product_down(3.0, 0.5), product_up(3.0, 0.5)), (1.5, 1.5));
        assert_eq!(product_up(0.1, 0.1), product_down(0.1, 0.1).next_up());
    }

    #[test]
    fn floor_rounds_down() {
        for (x, expected) in [(0.0, 0), (-0.5, -1), (1.999, 1), (-2.0, -2), (1e6 + 0.5, 1_000_000)] {
            assert_eq!(floor(x), expected);
        }
    }
}
