//! Checks of numeric arguments: one check and one message for each kind of argument.

use crate::error::Error;

/// The largest accepted magnitude, 2^256: no intermediate result of the library overflows.
pub(crate) const LARGEST: f64 = f64::from_bits((1023 + 256) << 52);
/// The smallest accepted magnitude except zero, 2^-256: nothing underflows.
pub(crate) const SMALLEST: f64 = 1.0 / LARGEST;

/// The message for numbers that [`is_moderate`] rejects.
pub(crate) const IMMODERATE: &str = "every number must be zero or of a magnitude between 2^-256 and 2^256";

/// Returns whether exact arithmetic accepts a number: zero, or a magnitude between 2^-256 and 2^256.
#[inline]
pub(crate) fn is_moderate(value: f64) -> bool {
    value == 0.0 || (SMALLEST..=LARGEST).contains(&value.abs())
}

#[inline]
fn check(accepted: bool, name: &'static str, problem: &'static str) -> Result<(), Error> {
    if accepted { Ok(()) } else { Err(Error::Argument { name, problem }) }
}

/// Checks coordinates and coefficients: each is zero or of a magnitude between 2^-256 and 2^256.
#[inline]
pub(crate) fn numbers(name: &'static str, values: &[f64]) -> Result<(), Error> {
    check(values.iter().all(|&value| is_moderate(value)), name, IMMODERATE)
}

/// Checks a length or a scale: between 2^-256 and 2^256.
#[inline]
pub(crate) fn length(name: &'static str, value: f64) -> Result<(), Error> {
    check((SMALLEST..=LARGEST).contains(&value), name, "must be between 2^-256 and 2^256")
}

/// Checks a box, which may be flat and may be infinite.
pub(crate) fn ordered(name: &'static str, min: [f64; 3], max: [f64; 3]) -> Result<(), Error> {
    let problem = "must be numbers with min ≤ max on every axis";
    // A comparison with NaN is false.
    check((0..3).all(|axis| min[axis] <= max[axis]), name, problem)
}

/// Checks the greatest width of an interval, or the greatest distance from a surface.
pub(crate) fn tolerance(name: &'static str, value: f64) -> Result<(), Error> {
    check(value >= 0.0, name, "must be a number, and not negative")
}
