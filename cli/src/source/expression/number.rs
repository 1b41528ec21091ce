//! The numbers that expressions compute with: values at points, and ranges of values over boxes.

/// All values that an expression may have, including its rounded results. Unknown if the expression may be
/// undefined.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Range {
    pub lower: f64,
    pub upper: f64,
}

const UNKNOWN: Range = Range { lower: f64::NAN, upper: f64::NAN };

impl Range {
    pub fn exactly(value: f64) -> Range {
        Range { lower: value, upper: value }
    }

    pub fn is_known(&self) -> bool {
        self.lower <= self.upper && self.lower.is_finite() && self.upper.is_finite()
    }

    /// Returns the range of results that are rounded by less than two units in the last place.
    fn around(ends: [f64; 2]) -> Range {
        if ends.iter().any(|end| !end.is_finite()) {
            return UNKNOWN;
        }
        let [a, b] = ends;
        let out = |x: f64, up: bool| if up { x.next_up().next_up() } else { x.next_down().next_down() };
        Range { lower: out(a.min(b), false), upper: out(a.max(b), true) }
    }

    /// Returns the image under a function that is monotone on the range.
    fn monotone(self, function: impl Fn(f64) -> f64) -> Range {
        if self.is_known() { Range::around([function(self.lower), function(self.upper)]) } else { UNKNOWN }
    }

    /// Returns the image under a monotone step function, whose results are exact.
    fn stepwise(self, function: impl Fn(f64) -> f64) -> Range {
        Range { lower: function(self.lower), upper: function(self.upper) }
    }
}

/// A number that the operators act on: the value at a point, or a range.
pub trait Number: Copy + Default {
    fn constant(value: f64) -> Self;
    fn add(a: Self, b: Self) -> Self;
    fn subtract(a: Self, b: Self) -> Self;
    fn multiply(a: Self, b: Self) -> Self;
    fn divide(a: Self, b: Self) -> Self;
    fn power(a: Self, b: Self) -> Self;
    fn least(a: Self, b: Self) -> Self;
    fn greatest(a: Self, b: Self) -> Self;
    fn negate(a: Self) -> Self;
    fn abs(a: Self) -> Self;
    fn sqrt(a: Self) -> Self;
    fn exp(a: Self) -> Self;
    fn ln(a: Self) -> Self;
    fn sin(a: Self) -> Self;
    fn cos(a: Self) -> Self;
    fn floor(a: Self) -> Self;
    fn ceil(a: Self) -> Self;
    fn round(a: Self) -> Self;
}

impl Number for f64 {
    fn constant(value: f64) -> f64 {
        value
    }
    fn add(a: f64, b: f64) -> f64 {
        a + b
    }
    fn subtract(a: f64, b: f64) -> f64 {
        a - b
    }
    fn multiply(a: f64, b: f64) -> f64 {
        a * b
    }
    fn divide(a: f64, b: f64) -> f64 {
        a / b
    }
    fn power(a: f64, b: f64) -> f64 {
        libm::pow(a, b)
    }
    fn least(a: f64, b: f64) -> f64 {
        if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
    }
    fn greatest(a: f64, b: f64) -> f64 {
        if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
    }
    fn negate(a: f64) -> f64 {
        -a
    }
    fn abs(a: f64) -> f64 {
        a.abs()
    }
    fn sqrt(a: f64) -> f64 {
        libm::sqrt(a)
    }
    fn exp(a: f64) -> f64 {
        libm::exp(a)
    }
    fn ln(a: f64) -> f64 {
        libm::log(a)
    }
    fn sin(a: f64) -> f64 {
        libm::sin(a)
    }
    fn cos(a: f64) -> f64 {
        libm::cos(a)
    }
    fn floor(a: f64) -> f64 {
        libm::floor(a)
    }
    fn ceil(a: f64) -> f64 {
        libm::ceil(a)
    }
    fn round(a: f64) -> f64 {
        libm::round(a)
    }
}

impl Number for Range {
    fn constant(value: f64) -> Range {
        Range::exactly(value)
    }
    fn add(a: Range, b: Range) -> Range {
        Range::around([a.lower + b.lower, a.upper + b.upper])
    }
    fn subtract(a: Range, b: Range) -> Range {
        Range::around([a.lower - b.upper, a.upper - b.lower])
    }
    fn multiply(a: Range, b: Range) -> Range {
        hull([a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper])
    }
    fn divide(a: Range, b: Range) -> Range {
        if b.lower <= 0.0 && b.upper >= 0.0 {
            return UNKNOWN;
        }
        hull([a.lower / b.lower, a.lower / b.upper, a.upper / b.lower, a.upper / b.upper])
    }
    fn power(a: Range, b: Range) -> Range {
        let exponent = b.lower;
        let is_whole = b.lower == b.upper && exponent == libm::floor(exponent) && exponent.abs() <= 1e6;
        if !a.is_known() || !b.is_known() {
            return UNKNOWN;
        }
        // From 0 on, the function is monotone in the base and in the exponent, unless it has a pole.
        let ends = [a.lower, a.upper].map(|x| [libm::pow(x, b.lower), libm::pow(x, b.upper)]);
        let all = hull([ends[0][0], ends[0][1], ends[1][0], ends[1][1]]);
        if a.lower > 0.0 || is_whole && (exponent > 0.0 && a.lower >= 0.0 || a.upper < 0.0) {
            all
        } else if is_whole && exponent == 0.0 {
            Range::exactly(1.0)
        } else if is_whole && exponent > 0.0 {
            // For a base of both signs, odd powers are monotone, and even powers are least at 0.
            let odd = exponent % 2.0 != 0.0;
            if odd { all } else { Range { lower: 0.0, ..all } }
        } else {
            UNKNOWN
        }
    }
    fn least(a: Range, b: Range) -> Range {
        if a.is_known() && b.is_known() {
            Range { lower: a.lower.min(b.lower), upper: a.upper.min(b.upper) }
        } else {
            UNKNOWN
        }
    }
    fn greatest(a: Range, b: Range) -> Range {
        if a.is_known() && b.is_known() {
            Range { lower: a.lower.max(b.lower), upper: a.upper.max(b.upper) }
        } else {
            UNKNOWN
        }
    }
    fn negate(a: Range) -> Range {
        Range { lower: -a.upper, upper: -a.lower }
    }
    fn abs(a: Range) -> Range {
        if a.lower <= 0.0 && a.upper >= 0.0 {
            return Range { lower: 0.0, upper: a.upper.max(-a.lower) };
        }
        let ends = [a.lower.abs(), a.upper.abs()];
        Range { lower: ends[0].min(ends[1]), upper: ends[0].max(ends[1]) }
    }
    fn sqrt(a: Range) -> Range {
        a.monotone(libm::sqrt)
    }
    fn exp(a: Range) -> Range {
        a.monotone(libm::exp)
    }
    fn ln(a: Range) -> Range {
        a.monotone(libm::log)
    }
    fn sin(a: Range) -> Range {
        wave(a, libm::sin, std::f64::consts::FRAC_PI_2)
    }
    fn cos(a: Range) -> Range {
        wave(a, libm::cos, 0.0)
    }
    fn floor(a: Range) -> Range {
        a.stepwise(libm::floor)
    }
    fn ceil(a: Range) -> Range {
        a.stepwise(libm::ceil)
    }
    fn round(a: Range) -> Range {
        a.stepwise(libm::round)
    }
}

fn hull(ends: [f64; 4]) -> Range {
    if ends.iter().any(|end| end.is_nan()) {
        return UNKNOWN;
    }
    let least = ends.iter().fold(f64::INFINITY, |a, &b| a.min(b));
    let greatest = ends.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
    Range::around([least, greatest])
}

/// Returns the image under a sine wave with a maximum at `crest` and every 2π.
fn wave(a: Range, function: impl Fn(f64) -> f64, crest: f64) -> Range {
    use std::f64::consts::{PI, TAU};
    if !a.is_known() {
        return UNKNOWN;
    }
    // Beyond this, doubles are too coarse to know the phase.
    if a.lower.abs().max(a.upper.abs()) > 1e9 || a.upper - a.lower >= TAU {
        return Range { lower: -1.0, upper: 1.0 };
    }
    let within = Range::around([function(a.lower), function(a.upper)]);
    // True if a turning point may lie in the range, with more tolerance than any rounding needs.
    let meets = |turn: f64| ((a.upper - turn) / TAU + 1e-6).floor() >= ((a.lower - turn) / TAU - 1e-6).ceil();
    Range {
        lower: if meets(crest + PI) { -1.0 } else { within.lower.max(-1.0) },
        upper: if meets(crest) { 1.0 } else { within.upper.min(1.0) },
    }
}
