//! Numbers as people read them.

use leafless::Interval;
use std::fmt::Write;

/// A count, with commas: 1,234,567.
pub fn count(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A count and what is counted: "1 body", "2 bodies".
pub fn counted(number: u64, one: &str, many: &str) -> String {
    format!("{} {}", count(number), if number == 1 { one } else { many })
}

/// A number in full precision, in scientific notation if it is very large or small.
pub fn number(x: f64) -> String {
    let mut text = String::new();
    push_number(&mut text, x);
    text
}

/// Appends a [`number`].
pub fn push_number(text: &mut String, x: f64) {
    // (A string takes whatever is written to it.)
    let _ = write!(text, "{x:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
}

/// What is known of a number, with the digits that mean something: `42345.1 ± 0.2`, or `3.9 to 12.1` where
/// the interval is wide. Rounded outward: what is printed contains the interval.
pub fn measured(interval: Interval) -> String {
    let (lower, upper) = (interval.lower, interval.upper);
    match (lower.is_finite(), upper.is_finite()) {
        (false, false) => return "unknown".into(),
        (true, false) => return format!("at least {}", number(rounded_down(lower))),
        (false, true) => return format!("at most {}", number(-rounded_down(-upper))),
        (true, true) if lower == upper => return number(lower),
        (true, true) => {}
    }
    let (width, greatest) = (upper - lower, lower.abs().max(upper.abs()));
    // Doubles have no more than 16 digits.
    if width < 1e-12 * greatest {
        return format!("{} to {}", number(lower), number(upper));
    }
    if width > 0.2 * greatest {
        let [lower, upper] = ends(interval);
        return format!("{lower} to {upper}");
    }
    // Beyond these numbers the power of ten stands behind.
    let power = exponent(greatest);
    let scale = if (-4..9).contains(&power) { 1.0 } else { 10f64.powi(power) };
    let (lower, upper) = (lower / scale, upper / scale);
    // Two digits of the doubt.
    let digits = 1 - exponent((upper - lower) / 2.0);
    let unit = 10f64.powi(-digits);
    let middle = round_to(lower + (upper - lower) / 2.0, digits);
    let errors = 1e-15 * middle.abs();
    let doubt = (middle - lower).max(upper - middle) + errors;
    let doubt = round_to((doubt / unit * (1.0 + 1e-12)).ceil() * unit, digits);
    let places = digits.max(0) as usize;
    let text = format!("{middle:.places$} ± {doubt:.places$}");
    if scale == 1.0 { text } else { format!("({text})e{power}") }
}

/// Both ends of an interval, rounded outward to a thousandth of its width or so.
pub fn ends(interval: Interval) -> [String; 2] {
    let (lower, upper) = (interval.lower, interval.upper);
    let width = upper - lower;
    if !(width > 1e-12 * lower.abs().max(upper.abs()) && width.is_finite()) {
        return [number(lower), number(upper)];
    }
    let digits = 3 - exponent(width);
    let unit = 10f64.powi(-digits);
    // A number that is a multiple of the unit but for a rounding stays as it is.
    let down = |x: f64| {
        let near = round_to(x, digits);
        if near <= x { near } else { round_to(near - unit, digits) }
    };
    [number(down(lower)), number(-down(-upper))]
}

/// Six digits of a number, not greater than it.
fn rounded_down(x: f64) -> f64 {
    if x == 0.0 {
        return x;
    }
    let digits = 5 - exponent(x.abs());
    let near = round_to(x, digits);
    if near <= x { near } else { round_to(near - 10f64.powi(-digits), digits) }
}

/// The exponent of the first digit of a positive number.
fn exponent(x: f64) -> i32 {
    // Written out because a logarithm may be off by one at powers of ten.
    format!("{x:e}").split_once('e').and_then(|parts| parts.1.parse().ok()).unwrap_or(0)
}

/// The double next to a number that is rounded to so many digits behind the point; negative ones are before it.
fn round_to(x: f64, digits: i32) -> f64 {
    if digits >= 0 {
        format!("{x:.*}", digits as usize).parse().unwrap_or(x)
    } else {
        let unit = 10f64.powi(-digits);
        (x / unit).round() * unit
    }
}

/// Appends a line to a text: a name, and a value in a column behind it.
pub fn put_line(text: &mut String, name: &str, value: &str) {
    // (A string takes whatever is written to it.)
    let _ = writeln!(text, "{name:<16}{value}");
}

/// A duration in the unit that suits it.
pub fn seconds(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.1} µs", s * 1e6),
        s if s < 1.0 => format!("{:.1} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}

/// A number for a table: six digits tell where to look.
pub fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    number(rounded)
}

/// Lines whose columns are aligned to the right.
pub fn table<R: AsRef<[String]>>(head: &R, rows: &[R]) -> String {
    let all = || [head].into_iter().chain(rows).map(AsRef::as_ref);
    let width = |column: usize| all().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for row in all() {
        for (column, cell) in row.iter().enumerate() {
            let gap = if column == 0 { "" } else { "  " };
            let _ = write!(text, "{gap}{cell:>width$}", width = width(column));
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert_eq!(measured(Interval::new(lower, upper).unwrap()), text);
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
            let text = measured(Interval::new(a, b).unwrap());
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

    #[test]
    fn numbers_read_well() {
        for (number, text) in [(0, "0"), (999, "999"), (1000, "1,000"), (1_234_567, "1,234,567")] {
            assert_eq!(count(number), text);
        }
        for (x, text) in
            [(0.0, "0"), (1.5, "1.5"), (-3.0, "-3"), (1e300, "1e300"), (0.1 + 0.2, "0.30000000000000004")]
        {
            assert_eq!(number(x), text);
        }
        assert_eq!(counted(1, "body", "bodies"), "1 body");
        assert_eq!(
            (seconds(2e-6), seconds(0.0123), seconds(61.0)),
            ("2.0 µs".into(), "12.3 ms".into(), "61.00 s".into())
        );
    }
}
