//! Intervals as text for people.

use super::Interval;
use alloc::format;
use alloc::string::String;
use core::fmt;

/// The number of digits of the uncertainty that are printed, minus one.
const DOUBT_DIGITS: i32 = 1;

/// The powers of ten that are written out; others use scientific notation.
const PLAIN_POWERS: core::ops::Range<i32> = -4..9;

/// Prints the significant digits: `42345.1 ± 0.2`, or `3.9 to 12.1` where the interval is wide. Bounds are
/// rounded outward: the printed range contains the interval.
///
/// ```
/// use leafless::Interval;
/// let volume = Interval::new(42345.0, 42345.3).unwrap();
/// assert_eq!(volume.to_string(), "42345.15 ± 0.16");
/// assert_eq!(Interval::new(0.0, 0.0125).unwrap().to_string(), "0 to 0.0125");
/// assert_eq!(Interval::exactly(2.0).to_string(), "2");
/// ```
impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&text(*self))
    }
}

impl Interval {
    /// Both bounds as text, rounded outward to about a thousandth of the width: `["0", "0.0125"]`.
    pub fn bounds_text(&self) -> [String; 2] {
        let (lower, upper) = (self.lower, self.upper);
        let width = upper - lower;
        if !(width > 1e-12 * lower.abs().max(upper.abs()) && width.is_finite()) {
            return [number(lower), number(upper)];
        }
        let digits = 3 - exponent(width);
        let unit = ten_to(-digits);
        // A number that is a multiple of the unit up to rounding stays as it is.
        let down = |x: f64| {
            let near = round_to(x, digits);
            if near <= x { near } else { round_to(near - unit, digits) }
        };
        [number(down(lower)), number(-down(-upper))]
    }
}

fn text(interval: Interval) -> String {
    let (lower, upper) = (interval.lower, interval.upper);
    match (lower.is_finite(), upper.is_finite()) {
        (false, false) => return "unknown".into(),
        (true, false) => return format!("at least {}", number(rounded_down(lower))),
        (false, true) => return format!("at most {}", number(-rounded_down(-upper))),
        (true, true) if lower == upper => return number(lower),
        (true, true) => {}
    }
    let (width, greatest) = (upper - lower, lower.abs().max(upper.abs()));
    // Doubles have no more than 16 significant digits.
    if width < 1e-12 * greatest {
        return format!("{} to {}", number(lower), number(upper));
    }
    if width > 0.2 * greatest {
        let [lower, upper] = interval.bounds_text();
        return format!("{lower} to {upper}");
    }
    let power = exponent(greatest);
    let scale = if PLAIN_POWERS.contains(&power) { 1.0 } else { ten_to(power) };
    let (lower, upper) = (lower / scale, upper / scale);
    let digits = DOUBT_DIGITS - exponent((upper - lower) / 2.0);
    let unit = ten_to(-digits);
    let middle = round_to(lower + (upper - lower) / 2.0, digits);
    let errors = 1e-15 * middle.abs();
    let doubt = (middle - lower).max(upper - middle) + errors;
    let doubt = round_to(libm::ceil(doubt / unit * (1.0 + 1e-12)) * unit, digits);
    let places = digits.max(0) as usize;
    let text = format!("{middle:.places$} ± {doubt:.places$}");
    if scale == 1.0 { text } else { format!("({text})e{power}") }
}

/// A number in full precision, in scientific notation if it is very large or small.
fn number(x: f64) -> String {
    let mut text = format!("{x:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
    text
}

/// A number rounded down to six digits.
fn rounded_down(x: f64) -> f64 {
    if x == 0.0 {
        return x;
    }
    let digits = 5 - exponent(x.abs());
    let near = round_to(x, digits);
    if near <= x { near } else { round_to(near - ten_to(-digits), digits) }
}

/// The exponent of the first digit of a positive number.
fn exponent(x: f64) -> i32 {
    // Uses the formatter, because a logarithm may be off by one at powers of ten.
    format!("{x:e}").split_once('e').and_then(|parts| parts.1.parse().ok()).unwrap_or(0)
}

/// The double nearest to a power of ten.
fn ten_to(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(f64::INFINITY)
}

/// The double nearest to `x` rounded to `digits` digits after the decimal point; negative counts round before
/// the point.
fn round_to(x: f64, digits: i32) -> f64 {
    if digits >= 0 {
        format!("{x:.*}", digits as usize).parse().unwrap_or(x)
    } else {
        let unit = ten_to(-digits);
        libm::round(x / unit) * unit
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString;

    #[test]
    fn intervals_have_the_digits_that_mean_something() {
        for (lower, upper, text) in [
            (42345.0, 42345.3, "42345.15 ± 0.16"),
            (1.0, 1.0, "1"),
            (4.4, 1204.0, "4 to 1204"),
            (0.0, 0.0125, "0 to 0.0125"),
            (-0.5, 0.5, "-0.5 to 0.5"),
            (99_900.0, 100_100.0, "100000 ± 110"),
            (1.999e-7, 2.001e-7, "(2.00000 ± 0.00101)e-7"),
            (5e12, 5.01e12, "(5.0050 ± 0.0051)e12"),
            (1.0, 1.0 + f64::EPSILON, "1 to 1.0000000000000002"),
            (1.4, f64::INFINITY, "at least 1.4"),
            (1.23456789, f64::INFINITY, "at least 1.23456"),
            (f64::NEG_INFINITY, -1.23456789, "at most -1.23456"),
            (f64::NEG_INFINITY, f64::INFINITY, "unknown"),
        ] {
            assert_eq!(Interval::new(lower, upper).unwrap().to_string(), text);
        }
    }

    #[test]
    fn what_is_printed_contains_the_interval() {
        // Multiples of 2^-20 are whole numbers of 10^-20.
        let exactly = |n: i64| n as i128 * 5i128.pow(20);
        let decimal = |text: &str| {
            let (sign, text) = text.strip_prefix('-').map_or((1, text), |rest| (-1, rest));
            let (whole, part) = text.split_once('.').unwrap_or((text, ""));
            let part = format!("{part:0<20}");
            assert_eq!(part.len(), 20, "{text}");
            sign * (whole.parse::<i128>().unwrap() * 10i128.pow(20) + part.parse::<i128>().unwrap())
        };
        let mut state = 1u64;
        let mut random = |bits: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> (64 - bits)) as i64
        };
        for i in 0..20_000 {
            let lower = random(10 + i % 40) - (1 << 8);
            let upper = lower + 1 + random(4 + i / 7 % 44);
            let [a, b] = [lower, upper].map(|n| n as f64 / (1 << 20) as f64);
            let text = Interval::new(a, b).unwrap().to_string();
            // Full precision names the doubles themselves.
            if text.contains('e') || text == format!("{} to {}", number(a), number(b)) {
                continue;
            }
            let (from, to) = match text.split_once(" ± ") {
                Some((middle, doubt)) => (decimal(middle) - decimal(doubt), decimal(middle) + decimal(doubt)),
                None => {
                    let (from, to) = text.split_once(" to ").unwrap();
                    (decimal(from), decimal(to))
                }
            };
            assert!(from <= exactly(lower) && exactly(upper) <= to, "{a:?} to {b:?}: {text}");
            let width = exactly(upper) - exactly(lower);
            assert!((to - from) as f64 <= 1.35 * width as f64, "{a:?} to {b:?}: {text}");
        }
    }
}
