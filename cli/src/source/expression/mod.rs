//! Functions of position in the user's notation: `20 + 3*sin(x)*y`.

mod grammar;
mod number;
mod program;

use leafless::attribute::{Attribute, ValueRange};
use leafless::{Bounds, Error, Interval};
use number::Range;
use program::Program;

/// Functions of x, y and z, one for each number of a value.
pub struct Expressions(Vec<Program>);

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
        let parse = |text: &String| {
            if text.len() > LONGEST {
                return Err(format!(
                    "an expression may have {LONGEST} characters, and this one has {}",
                    text.len()
                ));
            }
            grammar::parse(text)
        };
        texts.iter().map(parse).collect::<Result<_, _>>().map(Expressions)
    }

    fn value(&self, point: [f64; 3]) -> Option<[f64; 4]> {
        let mut value = [0.0; 4];
        for (number, program) in value.iter_mut().zip(&self.0) {
            *number = Some(program.run(point)).filter(|found| !found.is_nan())?;
        }
        Some(value)
    }
}

impl Attribute for Expressions {
    fn components(&self) -> usize {
        self.0.len()
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
        let box_ranges = [0, 1, 2].map(|axis| Range { lower: bounds.min[axis], upper: bounds.max[axis] });
        let mut ranges = [Interval::exactly(0.0); 4];
        for (found, program) in ranges.iter_mut().zip(&self.0) {
            let range = program.run(box_ranges);
            if !range.is_known() {
                return Ok(ValueRange::Unknown);
            }
            *found = Interval::new(range.lower, range.upper).unwrap();
        }
        Ok(ValueRange::Within(ranges))
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
            ("sqrt(z + 2 + 4) + abs(y + 1 + 0)", 4.0),
            ("floor(z * 2 * 0.25)", 1.0),
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

    #[test]
    fn operators_bind_as_documented() {
        let p = [2.0, 3.0, 5.0];
        for (text, same) in [
            // From left to right, at each level.
            ("x-y+z", "(x-y)+z"),
            ("x+y-z", "(x+y)-z"),
            ("x-y-z", "(x-y)-z"),
            ("x/y*z", "(x/y)*z"),
            ("x*y/z", "(x*y)/z"),
            ("x/y/z", "(x/y)/z"),
            ("x^y^z", "(x^y)^z"),
            ("x^y^z^0.5", "((x^y)^z)^0.5"),
            // Powers, then products, then sums.
            ("x+y*z^x", "x+(y*(z^x))"),
            ("x^y*z+x", "((x^y)*z)+x"),
            ("x-y/z+x*y^2-1", "((x-(y/z))+(x*(y^2)))-1"),
            // Signs bind most tightly.
            ("-x^2", "(-x)^2"),
            ("x^-y^2", "(x^(-y))^2"),
            ("x--y", "x+y"),
            ("x - + - - -y", "x+y"),
            ("-(x+y)^2", "(x+y)^2"),
            ("-sin(x)^2", "sin(x)^2"),
            ("2*-min(x,y)", "-2*x"),
            // White space separates, and has no other meaning.
            ("\t x\n +\r\n2 *  y ", "x+2*y"),
            ("  min ( x , - y )  ", "min(x,-y)"),
            ("( x )", "x"),
            ("- x", "-x"),
        ] {
            assert_eq!(parse(text).value(p), parse(same).value(p), "{text}");
        }
        for (text, value) in [
            ("1e3", 1000.0),
            ("1E3", 1000.0),
            ("1e+3", 1000.0),
            ("25e-2", 0.25),
            (".5", 0.5),
            (".5e1", 5.0),
            ("2.", 2.0),
            ("2.e1", 20.0),
            ("007", 7.0),
            ("0.1", 0.1),
            ("2.-.5", 1.5),
            ("1e3-1", 999.0),
        ] {
            assert_eq!(parse(text).value(p), Some([value, 0.0, 0.0, 0.0]), "{text}");
        }
    }

    #[test]
    fn errors_say_what_is_wrong_and_where() {
        for (text, place, problem) in [
            ("", 1, "ends here: expected a number, a name or ("),
            ("x +", 4, "ends here: expected a number, a name or ("),
            ("x + * y", 5, "expected a number, a name or ("),
            ("x y", 3, "expected an operator"),
            ("2x", 2, "expected an operator"),
            ("1..2", 3, "expected an operator"),
            ("1e", 2, "expected an operator"),
            ("x ; y", 3, "expected an operator"),
            ("é + w", 1, "é is unknown. Known are x y z"),
            ("1 + Sin(x)", 5, "Sin is unknown"),
            ("x1", 1, "x1 is unknown"),
            ("2*(x + (y)", 3, "this parenthesis is not closed"),
            ("min(x, y", 4, "this parenthesis is not closed"),
            ("(x y)", 4, "expected an operator"),
            ("x + y)", 6, "no parenthesis is open"),
            ("()", 2, "expected a number"),
            ("x, y", 2, "a comma stands only between"),
            ("max((x, y), 1)", 7, "a comma stands only between"),
            ("1 + min(x)", 10, "min takes two numbers: min(a,b)"),
            ("max(x, y, z)", 9, "max takes two numbers: max(a,b)"),
            ("sin(x, y)", 6, "sin takes one number: sin(a)"),
            ("sin x", 5, "expected (, as sin takes one number: sin(a)"),
            ("x min y", 3, "expected an operator"),
            ("max", 4, "ends here: expected (, as max"),
            ("sin()", 5, "expected a number"),
        ] {
            let found = Expressions::parse(&[text.into()]).map(drop).unwrap_err();
            assert!(found.starts_with(&format!("\"{text}\": at character {place}: ")), "{found}");
            assert!(found.contains(problem), "{found}");
        }
        let long = format!("{}x{}?", "1 + ".repeat(40), " + yé".repeat(20));
        let found = Expressions::parse(&[long]).map(drop).unwrap_err();
        let excerpt = "+ 1 + 1 + 1 + 1 + 1 + 1 + x + yé + yé + yé + yé + yé + yé + ";
        assert_eq!(found.split('"').nth(1), Some(&*format!("…{excerpt}…")), "{found}");
        assert!(found.contains("character 165: yé is unknown"), "{found}");
    }

    /// Runs on a thread with the smallest stack that any system gives to a program's first thread.
    #[test]
    fn hostile_expressions_are_refused_and_deep_ones_evaluated() {
        let run = || {
            let nested = |depth, open: &str, close: &str| {
                let text = open.repeat(depth) + "x" + &close.repeat(depth);
                Expressions::parse(&[text]).map(|found| found.value([3.0; 3]).unwrap()[0])
            };
            for (open, close) in [("(", ")"), ("1-1*1^(", ")"), ("min(9,1+1*1^", ")"), ("-abs(", ")")] {
                assert!(nested(50, open, close).is_ok(), "{open}");
                let found = nested(51, open, close).unwrap_err();
                assert!(found.contains("more than 50 parentheses are open"), "{found}");
                assert!(nested(2000, open, close).is_err());
                assert!(nested(2000, open, "").is_err());
            }
            assert_eq!(nested(50, "(", ")"), Ok(3.0));
            assert_eq!(nested(50, "max(1,2+-2+1^", ")"), Ok(1.0));
            for hostile in ["(", "min(", "min((", "-(", "x^(", ")", ",", "1+", "-", "^", "x(", "é"] {
                let text = hostile.repeat(LONGEST / hostile.len());
                assert!(Expressions::parse(&[text]).is_err(), "{hostile}");
            }
            // Parentheses beside each other, signs and operators have no limit.
            assert_eq!(nested(8000, "--", ""), Ok(3.0));
            assert_eq!(nested(4000, "", "+(1)"), Ok(4003.0));
            assert_eq!(nested(4000, "2+", "*1"), Ok(8003.0));
            assert!(Expressions::parse(&["1".repeat(LONGEST + 1)]).is_err());
        };
        std::thread::Builder::new().stack_size(1 << 20).spawn(run).unwrap().join().unwrap();
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
