//! Functions of position in the user's notation: `20 + 3*sin(x)*y`.

use exmex::{BinOp, Express, FlatEx, MakeOperators, MatchLiteral, Operator};
use leafless::attribute::{Attribute, ValueRange};
use leafless::{Bounds, Error, Interval};
use std::fmt::Debug;
use std::str::FromStr;

/// Functions of x, y and z, one for each number of a value.
pub struct Expressions {
    values: Vec<FlatEx<f64, Operators, Literals>>,
    ranges: Vec<FlatEx<Range, Operators, Literals>>,
    /// The variables of each expression, among x, y and z, in this order.
    variables: Vec<Vec<usize>>,
}

exmex::literal_matcher_from_pattern!(Literals, r"^([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?");

/// The syntax of an expression, for the help.
pub const SYNTAX: &str = "x y z, numbers, + - * / ^, parentheses, pi, e, and the functions abs sqrt exp ln sin cos \
                          floor ceil round min(a,b) max(a,b). A minus before a number or name binds most tightly: \
                          -x^2 is (-x)^2";

/// Most characters of an expression, which is evaluated at every cell.
const LONGEST: usize = 1 << 14;

impl Expressions {
    /// Parses one to four expressions.
    pub fn parse(texts: &[String]) -> Result<Expressions, String> {
        if !(1..=4).contains(&texts.len()) {
            return Err("a value has one to four expressions".into());
        }
        let mut all = Expressions { values: Vec::new(), ranges: Vec::new(), variables: Vec::new() };
        for text in texts {
            if text.len() > LONGEST {
                return Err(format!(
                    "an expression may have {LONGEST} characters, and this one has {}",
                    text.len()
                ));
            }
            let infix = infix(text).map_err(|problem| format!("\"{text}\": {problem}"))?;
            let refused = |error: exmex::ExError| format!("\"{text}\": {}", error.msg());
            let value = FlatEx::<f64, Operators, Literals>::parse(&infix).map_err(refused)?;
            let range = FlatEx::<Range, Operators, Literals>::parse(&infix).map_err(refused)?;
            let mut variables = Vec::new();
            for name in value.var_names() {
                let place = ["x", "y", "z"].iter().position(|known| known == name);
                let unknown = || format!("\"{text}\": {name} is unknown. Known are {SYNTAX}");
                variables.push(place.ok_or_else(unknown)?);
            }
            all.values.push(value);
            all.ranges.push(range);
            all.variables.push(variables);
        }
        Ok(all)
    }

    fn value(&self, point: [f64; 3]) -> Option<[f64; 4]> {
        let mut value = [0.0; 4];
        for (k, expression) in self.values.iter().enumerate() {
            let mut variables = [0.0; 3];
            for (variable, &axis) in variables.iter_mut().zip(&self.variables[k]) {
                *variable = point[axis];
            }
            let found = expression.eval(&variables[..self.variables[k].len()]).ok()?;
            value[k] = Some(found).filter(|found| !found.is_nan())?;
        }
        Some(value)
    }
}

/// Returns the expression with functions of two arguments written between these, as in `((a)min(b))`. The
/// parser accepts nested functions only in this form.
fn infix(text: &str) -> Result<String, &'static str> {
    const FUNCTIONS: [&str; 2] = ["min", "max"];
    // For each open parenthesis: its function, if it has two arguments, and whether the first argument is
    // complete.
    let mut open: Vec<(Option<&str>, bool)> = Vec::new();
    let (mut written, mut rest) = (String::with_capacity(2 * text.len()), text);
    while let Some(c) = rest.chars().next() {
        let word = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let behind = rest[word..].trim_start();
        if let Some(name) = FUNCTIONS.into_iter().find(|&name| name == &rest[..word])
            && let Some(behind) = behind.strip_prefix('(')
        {
            open.push((Some(name), false));
            written.push_str("((");
            rest = behind;
            continue;
        }
        match (c, open.last_mut()) {
            ('(', _) => {
                open.push((None, true));
                written.push('(');
            }
            (')', _) => match open.pop() {
                None => return Err("parentheses do not match"),
                Some((Some(_), false)) => return Err("min and max take two numbers each: min(a,b)"),
                Some((function, _)) => written.push_str(if function.is_some() { "))" } else { ")" }),
            },
            (',', Some((Some(name), is_second @ false))) => {
                written.extend([")", name, "("]);
                *is_second = true;
            }
            (',', _) => {
                return Err("a comma stands between the two numbers of min and max alone: min(a,min(b,c))");
            }
            _ => {
                let end = word.max(c.len_utf8());
                written.push_str(&rest[..end]);
                rest = &rest[end..];
                continue;
            }
        }
        rest = &rest[1..];
    }
    if open.is_empty() { Ok(written) } else { Err("parentheses do not match") }
}

impl Attribute for Expressions {
    fn components(&self) -> usize {
        self.values.len()
    }

    /// A point at which a function is not defined has no value.
    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        for (value, &point) in values.iter_mut().zip(points) {
            *value = self.value(point);
        }
        Ok(())
    }

    /// Computes the range by interval arithmetic.
    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let mut ranges = [Interval::exactly(0.0); 4];
        for (k, expression) in self.ranges.iter().enumerate() {
            let mut variables = [Range::default(); 3];
            for (variable, &axis) in variables.iter_mut().zip(&self.variables[k]) {
                *variable = Range { lower: bounds.min[axis], upper: bounds.max[axis] };
            }
            match expression.eval(&variables[..self.variables[k].len()]) {
                Ok(range) if range.is_known() => ranges[k] = Interval::new(range.lower, range.upper).unwrap(),
                _ => return Ok(ValueRange::Unknown),
            }
        }
        Ok(ValueRange::Within(ranges))
    }
}

/// All values that an expression may have, including its rounded results. Unknown if the expression may be
/// undefined.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Range {
    lower: f64,
    upper: f64,
}

const UNKNOWN: Range = Range { lower: f64::NAN, upper: f64::NAN };

impl FromStr for Range {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Range, Self::Err> {
        text.parse().map(Range::exactly)
    }
}

impl Range {
    fn exactly(value: f64) -> Range {
        Range { lower: value, upper: value }
    }

    fn is_known(&self) -> bool {
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
trait Number: Clone + Debug + Default + FromStr + Send + Sync + 'static {
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

/// The operators, for both kinds of numbers.
#[derive(Debug, Clone)]
struct Operators;

impl<T: Number> MakeOperators<T> for Operators {
    fn make<'a>() -> Vec<Operator<'a, T>> {
        let binary = |apply: fn(T, T) -> T, prio, is_commutative| BinOp { apply, prio, is_commutative };
        vec![
            Operator::make_bin_unary("-", binary(T::subtract, 1, false), T::negate),
            Operator::make_bin_unary("+", binary(T::add, 0, true), |a| a),
            Operator::make_bin("*", binary(T::multiply, 2, true)),
            Operator::make_bin("/", binary(T::divide, 3, false)),
            Operator::make_bin("^", binary(T::power, 4, false)),
            Operator::make_bin("min", binary(T::least, 0, true)),
            Operator::make_bin("max", binary(T::greatest, 0, true)),
            Operator::make_unary("abs", T::abs),
            Operator::make_unary("sqrt", T::sqrt),
            Operator::make_unary("exp", T::exp),
            Operator::make_unary("ln", T::ln),
            Operator::make_unary("sin", T::sin),
            Operator::make_unary("cos", T::cos),
            Operator::make_unary("floor", T::floor),
            Operator::make_unary("ceil", T::ceil),
            Operator::make_unary("round", T::round),
            Operator::make_constant("pi", T::constant(std::f64::consts::PI)),
            Operator::make_constant("e", T::constant(std::f64::consts::E)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Expressions {
        Expressions::parse(&[text.to_owned()]).unwrap()
    }

    #[test]
    fn expressions_mean_what_they_say() {
        let p = [0.5, -2.0, 3.0];
        for (text, value) in [
            ("x", 0.5),
            ("x + y*z", -5.5),
            ("x - y - z", -0.5),
            ("z/x/2", 3.0),
            ("2*z^2 - 1", 17.0),
            ("2^3^2", 64.0),
            ("-x^2", 0.25),
            ("(x+y)*z", -4.5),
            ("min(x, y) + max(x, z)", 1.0),
            ("min(x + 1, y*2) - 1", -5.0),
            ("min(1, max(0, x))", 0.5),
            ("min(max(x, y), min(max(y, z), z*2)) + max (1, 2)", 2.5),
            ("max(-1, min(x + min(y, z), 2) ^ 2)", 2.25),
            ("abs(y) + sqrt(z+1)", 4.0),
            ("floor(x) + ceil(x) + round(z/2)", 3.0),
            ("sin(0) + cos(0)", 1.0),
            ("exp(ln(z))", libm::exp(libm::log(3.0))),
            ("pi - pi + e - e + 1e3", 1000.0),
            ("7", 7.0),
        ] {
            assert_eq!(parse(text).value(p), Some([value, 0.0, 0.0, 0.0]), "{text}");
        }
        for text in ["sqrt(y)", "ln(y)", "0/0", "min(sqrt(y), 1)"] {
            assert_eq!(parse(text).value(p), None, "{text}");
        }
        for text in [
            "",
            "x +",
            "w",
            "x y",
            "foo(x)",
            "(x",
            "1..2",
            "x^^2",
            "x;y",
            "é",
            "min(x)",
            "min(x, y, z)",
            "x, y",
            "sin(x, y)",
            "min(x, y",
            "max((x, y), 1)",
        ] {
            assert!(Expressions::parse(&[text.to_owned()]).is_err(), "{text}");
        }
        let colour = Expressions::parse(&["x".into(), "2*y".into()]).unwrap();
        assert_eq!(colour.value(p), Some([0.5, -4.0, 0.0, 0.0]));
    }

    /// The value of an expression at a point of a box lies in its range over the box.
    #[test]
    fn ranges_hold_all_values() {
        let mut state = 9u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut known = 0;
        for text in [
            "x",
            "x+y*z",
            "x-y/z",
            "x*x - 2*x*y",
            "x^2 + y^3 - z^4",
            "x^-1",
            "x^0.5",
            "2^x",
            "-x^3",
            "abs(x)*y",
            "sqrt(abs(x)) + exp(y/4)",
            "ln(x^2 + 1)",
            "sin(x)*cos(y)",
            "sin(3*x + y)",
            "cos(x/9)",
            "min(x, y*z)",
            "max(x^2, y) - 0.1",
            "min(1, max(0, x*y))",
            "floor(x*2) + ceil(y) - round(z)",
            "1/(x^2 + 1)",
            "(x - 0.3)/(y - 0.7)",
            "1e300*x*1e10",
        ] {
            let expression = parse(text);
            for _ in 0..300 {
                let min = [0; 3].map(|_| 8.0 * random() - 4.0);
                let size = random() * random() * 4.0;
                let max = min.map(|low| low + size * random());
                let range = expression.range(&Bounds { min, max }).unwrap();
                let ValueRange::Within(ranges) = range else { continue };
                known += 1;
                for k in 0..20 {
                    let point = [0, 1, 2].map(|axis| {
                        let part = if k < 8 { f64::from(k >> axis & 1) } else { random() };
                        min[axis] + (max[axis] - min[axis]) * part
                    });
                    let value = expression.value(point).unwrap()[0];
                    assert!(ranges[0].contains(value), "{text} at {point:?}: {value} not in {:?}", ranges[0]);
                }
            }
        }
        assert!(known > 4000, "{known}");
    }
}
