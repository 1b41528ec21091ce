//! Integers times powers of two. Every double is such a number, and so are sums and products of them. This
//! code is not performance-critical.

use crate::lattice::Each;
use alloc::vec::Vec;
use core::cmp::Ordering;
use core::ops::{Add, Mul, Neg, Sub};
use num_bigint::{BigInt, Sign};
use num_traits::{ToPrimitive, Zero};

/// The number `mantissa · 2^exponent`; the mantissa is odd or zero.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Dyadic {
    mantissa: BigInt,
    exponent: i64,
}

/// Doubles whose sum is an exact number, in memory of fixed size. So the failure to store a surface cannot be
/// mistaken for a failed allocation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Terms {
    doubles: [f64; 8],
    count: usize,
}

impl core::ops::Deref for Terms {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.doubles[..self.count]
    }
}

impl Dyadic {
    /// The approximate number of bytes of the digits, without the number itself.
    pub(crate) fn heap_bytes(&self) -> usize {
        self.mantissa.bits().div_ceil(64) as usize * size_of::<u64>()
    }

    pub(crate) fn zero() -> Dyadic {
        Dyadic { mantissa: BigInt::zero(), exponent: 0 }
    }

    /// Converts a finite double, exactly.
    pub(crate) fn new(value: f64) -> Dyadic {
        debug_assert!(value.is_finite());
        let bits = value.to_bits();
        let (fraction, biased) = ((bits & ((1 << 52) - 1)) as i64, (bits >> 52 & 0x7FF) as i64);
        let magnitude = if biased == 0 { fraction } else { fraction | 1 << 52 };
        let mantissa = BigInt::from(if value.is_sign_negative() { -magnitude } else { magnitude });
        Dyadic::normal(mantissa, biased.max(1) - 1075)
    }

    fn normal(mantissa: BigInt, exponent: i64) -> Dyadic {
        match mantissa.trailing_zeros() {
            None => Dyadic::zero(),
            Some(0) => Dyadic { mantissa, exponent },
            Some(zeros) => Dyadic { mantissa: mantissa >> zeros, exponent: exponent + zeros as i64 },
        }
    }

    /// The sign: −1, 0 or 1.
    pub(crate) fn sign(&self) -> i32 {
        match self.mantissa.sign() {
            Sign::Minus => -1,
            Sign::NoSign => 0,
            Sign::Plus => 1,
        }
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.sign() == 0
    }

    /// This times 2^`power`.
    pub(crate) fn shifted(&self, power: i64) -> Dyadic {
        let exponent = if self.is_zero() { 0 } else { self.exponent + power };
        Dyadic { mantissa: self.mantissa.clone(), exponent }
    }

    /// This to the power `n`.
    pub(crate) fn pow(&self, n: u32) -> Dyadic {
        Dyadic { mantissa: self.mantissa.pow(n), exponent: self.exponent * n as i64 }
    }

    /// The exponent e for which 2^e ≤ |this| < 2^(e + 1); `None` for zero.
    pub(crate) fn magnitude(&self) -> Option<i64> {
        (!self.is_zero()).then(|| self.mantissa.bits() as i64 - 1 + self.exponent)
    }

    /// The exponent of the lowest bit: the number is a multiple of 2 to that power; `None` for zero.
    pub(crate) fn grain(&self) -> Option<i64> {
        (!self.is_zero()).then_some(self.exponent)
    }

    /// The number of bits of the mantissa.
    pub(crate) fn bits(&self) -> u64 {
        self.mantissa.bits()
    }

    /// The mantissa's bytes, in two's complement with the lowest first, and the exponent.
    pub(crate) fn bytes(&self) -> (Vec<u8>, i64) {
        (self.mantissa.to_signed_bytes_le(), self.exponent)
    }

    /// Writes the number in a form that `read` can read.
    pub(crate) fn write(&self, to: &mut Vec<u8>) {
        let (mantissa, exponent) = self.bytes();
        to.extend(exponent.to_le_bytes());
        to.extend((mantissa.len() as u32).to_le_bytes());
        to.extend(mantissa);
    }

    /// Reads a number, and advances `from` beyond it.
    pub(crate) fn read(from: &mut &[u8]) -> Dyadic {
        let (mut exponent, mut length) = ([0; 8], [0; 4]);
        exponent.copy_from_slice(&from[..8]);
        length.copy_from_slice(&from[8..12]);
        let (mantissa, rest) = from[12..].split_at(u32::from_le_bytes(length) as usize);
        *from = rest;
        let mantissa = BigInt::from_signed_bytes_le(mantissa);
        Dyadic { mantissa, exponent: i64::from_le_bytes(exponent) }
    }

    /// The number rounded towards zero to a double. The error is less than 2^-52 of the number, or less than
    /// 2^-1020; infinite beyond the range of doubles.
    pub(crate) fn rounded(&self) -> f64 {
        let bits = self.mantissa.bits() as i64;
        // The 53 leading bits; the others are cut off.
        let cut = (bits - 53).max(0);
        let kept = (self.mantissa.magnitude() >> cut as u64).to_f64().unwrap_or(f64::INFINITY);
        let magnitude = scaled(kept, self.exponent + cut);
        if self.sign() < 0 { -magnitude } else { magnitude }
    }

    /// Doubles whose sum is exactly this number, the largest first. Each is at most 2^-53 of the one before;
    /// zero has none. `None` if there are more than `most`, which is 8 or less, or if the number leaves the
    /// range of doubles.
    pub(crate) fn expansion(&self, most: usize) -> Option<Terms> {
        let mut terms = Terms { doubles: [0.0; 8], count: 0 };
        let mut rest = self.clone();
        while !rest.is_zero() {
            // The nearer of the two neighbouring doubles.
            let inner = rest.rounded();
            let outer = if inner > 0.0 { inner.next_up() } else { inner.next_down() };
            if terms.count == most || !outer.is_finite() || inner == 0.0 {
                return None;
            }
            let [to_inner, to_outer] = [inner, outer].each(|term| &rest - &Dyadic::new(term));
            let is_outer = (&to_inner + &to_outer).sign() == rest.sign();
            *terms.doubles.get_mut(terms.count)? = if is_outer { outer } else { inner };
            terms.count += 1;
            rest = if is_outer { to_outer } else { to_inner };
        }
        Some(terms)
    }

    /// The exact sum of doubles.
    pub(crate) fn sum(terms: &[f64]) -> Dyadic {
        terms.iter().fold(Dyadic::zero(), |sum, &term| &sum + &Dyadic::new(term))
    }

    /// Divides numbers by a common factor, so that they become integers without a common divisor, and the
    /// first number that is not zero becomes positive. Returns whether that changed the signs. Lists of
    /// numbers are proportional exactly if their primitive forms are equal.
    pub(crate) fn make_primitive(numbers: &mut [Dyadic]) -> bool {
        let grain = numbers.iter().filter_map(Dyadic::grain).min().unwrap_or(0);
        let whole = |number: &Dyadic| &number.mantissa << (number.exponent - grain).max(0) as u64;
        let mut common = BigInt::zero();
        for number in numbers.iter().filter(|number| !number.is_zero()) {
            let mut rest = whole(number);
            while !rest.is_zero() {
                (common, rest) = (rest.clone(), &common % &rest);
            }
        }
        let first = numbers.iter().find(|number| !number.is_zero()).map_or(1, Dyadic::sign);
        if common.is_zero() {
            return false;
        }
        if (common.sign() == Sign::Minus) != (first < 0) {
            common = -common;
        }
        for number in numbers.iter_mut().filter(|number| !number.is_zero()) {
            *number = Dyadic::normal(whole(number) / &common, 0);
        }
        first < 0
    }

    /// The number as a double, if it is exactly one.
    pub(crate) fn exactly(&self) -> Option<f64> {
        let value = self.rounded();
        (value.is_finite() && Dyadic::new(value) == *self).then_some(value)
    }
}

/// The dot product a · b in three dimensions.
pub(crate) fn dot(a: [&Dyadic; 3], b: [&Dyadic; 3]) -> Dyadic {
    &(&(a[0] * b[0]) + &(a[1] * b[1])) + &(a[2] * b[2])
}

/// The cross product a × b in three dimensions.
pub(crate) fn cross(a: &[Dyadic], b: &[Dyadic]) -> [Dyadic; 3] {
    [(1, 2), (2, 0), (0, 1)].each(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Dyadic) -> Ordering {
        (self - other).sign().cmp(&0)
    }
}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Dyadic) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// `value · 2^exponent`, in steps that overflow only if the result does.
fn scaled(mut value: f64, mut exponent: i64) -> f64 {
    let power = |e: i64| f64::from_bits(((1023 + e) as u64) << 52);
    while exponent > 1000 && value.is_finite() && value != 0.0 {
        (value, exponent) = (value * power(1000), exponent - 1000);
    }
    while exponent < -1000 && value != 0.0 {
        (value, exponent) = (value * power(-1000), exponent + 1000);
    }
    if value == 0.0 || !value.is_finite() { value } else { value * power(exponent) }
}

impl Add for &Dyadic {
    type Output = Dyadic;

    fn add(self, other: &Dyadic) -> Dyadic {
        if self.is_zero() {
            return other.clone();
        }
        if other.is_zero() {
            return self.clone();
        }
        let (low, high) = if self.exponent <= other.exponent { (self, other) } else { (other, self) };
        let shift = (high.exponent - low.exponent) as u64;
        Dyadic::normal(&low.mantissa + (&high.mantissa << shift), low.exponent)
    }
}

impl Sub for &Dyadic {
    type Output = Dyadic;

    fn sub(self, other: &Dyadic) -> Dyadic {
        self + &-other
    }
}

impl Mul for &Dyadic {
    type Output = Dyadic;

    fn mul(self, other: &Dyadic) -> Dyadic {
        let mantissa = &self.mantissa * &other.mantissa;
        // A product of odd numbers is odd.
        let exponent = if mantissa.is_zero() { 0 } else { self.exponent + other.exponent };
        Dyadic { mantissa, exponent }
    }
}

impl Neg for &Dyadic {
    type Output = Dyadic;

    fn neg(self) -> Dyadic {
        Dyadic { mantissa: -&self.mantissa, exponent: self.exponent }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_come_back() {
        for value in [0.0, 1.0, -0.1, 1e300, -5e-324, f64::MAX, f64::MIN_POSITIVE, 0.5f64.next_up()] {
            assert_eq!(Dyadic::new(value).exactly(), Some(value));
        }
    }

    #[test]
    fn numbers_are_sums_of_doubles() {
        let d = Dyadic::new;
        let numbers = [d(0.0), d(-0.1), &d(0.1) * &d(0.3), d(0.7).pow(5), &d(1e200) - &d(1e-200)];
        for (number, count) in numbers.iter().zip([0, 1, 2, 5, 2]) {
            assert_eq!(number.expansion(7).map(|terms| terms.len()), Some(count));
            let terms = number.expansion(7).unwrap();
            assert_eq!(&Dyadic::sum(&terms), number);
            assert!(
                terms.len() == count
                    && terms.windows(2).all(|pair| pair[1].abs() < pair[0].abs() * f64::EPSILON)
            );
            assert_eq!(number.expansion(count.saturating_sub(1)).is_some(), count == 0);
        }
        // Beyond the range of doubles at both ends.
        assert_eq!((d(1e300).pow(2).expansion(7), d(1e-300).pow(2).expansion(7)), (None, None));
    }

    #[test]
    fn proportional_numbers_have_one_form() {
        let primitive = |numbers: [f64; 4], times: f64| {
            let mut numbers = numbers.map(|c| &Dyadic::new(c) * &Dyadic::new(times));
            let turned = Dyadic::make_primitive(&mut numbers);
            (numbers, turned)
        };
        let given = [0.0, -0.3, 1.7, 1e-9];
        let (one, turned) = primitive(given, 1.0);
        assert!(turned && one[1].sign() > 0);
        for times in [0.1, 3.0, -7.25, 1e30, -1e-30] {
            assert_eq!(primitive(given, times), (one.clone(), times > 0.0), "{times}");
        }
        let whole = [6.0, -9.0, 0.0, 1.5].map(Dyadic::new);
        assert_eq!(primitive([6.0, -9.0, 0.0, 1.5], 1.0).0, [4.0, -6.0, 0.0, 1.0].map(Dyadic::new));
        assert_ne!(primitive(given, 1.0).0, whole);
        assert!(!primitive([0.0; 4], 1.0).1);
    }

    #[test]
    fn nothing_is_lost() {
        let d = Dyadic::new;
        let sum = &(&d(1e300) + &d(1e-300)) - &d(1e300);
        assert_eq!(sum.exactly(), Some(1e-300));
        let product = &d(0.1) * &d(0.1);
        assert_eq!(product.exactly(), None);
        assert!((product.rounded() - 0.01).abs() < 1e-17);
        assert_eq!(d(3.0).pow(40).cmp(&d(3f64.powi(40))), Ordering::Greater);
        assert_eq!((&d(0.3) - &(&d(0.1) + &d(0.2))).sign(), -1);
        assert_eq!(d(1e-300).pow(3).rounded(), 0.0);
        assert_eq!(d(-1e300).pow(3).rounded(), f64::NEG_INFINITY);
        assert_eq!((d(6.0).magnitude(), d(6.0).grain(), d(0.0).grain()), (Some(2), Some(1), None));
    }
}
