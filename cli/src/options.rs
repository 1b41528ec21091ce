//! Values of options that several subcommands share.

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use leafless::exchange::MeshFormat;
use leafless::{Frame, Rule};
use std::str::FromStr;

/// Returns the parser of the rules of an octree; `certified` is the first one.
pub fn octree_rules() -> impl TypedValueParser<Value = Rule> {
    rules([
        (Rule::Certified, "They stay undecided: volumes are intervals that contain the true value"),
        (Rule::Sampled, "They are inside if their centre is"),
        (Rule::Inner, "They are outside: the result lies within the solid"),
        (Rule::Outer, "They are inside: the result contains the solid"),
    ])
}

/// Returns the parser of some rules with their help texts.
pub fn rules<const N: usize>(known: [(Rule, &'static str); N]) -> impl TypedValueParser<Value = Rule> {
    let values = known.map(|(rule, help)| PossibleValue::new(rule_name(rule)).help(help));
    let of = move |name: String| known.into_iter().find(|(rule, _)| rule_name(*rule) == name);
    PossibleValuesParser::new(values).try_map(move |name| of(name).map(|known| known.0).ok_or("is no rule"))
}

/// Returns the name of an option's value, as the user writes it.
pub fn name_of(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// The rule for undecided cells.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub enum ResolveName {
    /// Outside
    Inner,
    /// Inside
    Outer,
}

/// The note on undecided cells if the user named no rule.
pub const UNDECIDED: &str = "note: its undecided cells count as inside; --resolve inner leaves them out";

impl From<ResolveName> for Rule {
    fn from(name: ResolveName) -> Rule {
        match name {
            ResolveName::Inner => Rule::Inner,
            ResolveName::Outer => Rule::Outer,
        }
    }
}

/// Returns the name of a rule, as the user writes it.
pub fn rule_name(rule: Rule) -> &'static str {
    match rule {
        Rule::Certified => "certified",
        Rule::Sampled => "sampled",
        Rule::Inner => "inner",
        Rule::Outer => "outer",
    }
}

/// Parses a finite number that is `good`; otherwise the error says that `what` is expected.
pub fn number(text: &str, what: &str, good: impl Fn(f64) -> bool) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && good(*number));
    number.ok_or_else(|| format!("expected {what}"))
}

/// Parses numbers between commas.
pub fn list<T: FromStr>(text: &str) -> Option<Vec<T>> {
    text.split(',').map(|number| number.trim().parse().ok()).collect()
}

/// Parses exactly `N` numbers between commas.
pub fn numbers<T: FromStr, const N: usize>(text: &str) -> Option<[T; N]> {
    list(text)?.try_into().ok()
}

/// Parses the cube of `--bounds`; its depth is a placeholder.
pub fn bounds(text: &str) -> Result<Frame, String> {
    match numbers(text) {
        Some([x, y, z, edge]) => Frame::new([x, y, z], edge, 1).map_err(|error| error.to_string()),
        None => Err("expected four numbers: x0,y0,z0,edge".into()),
    }
}

/// Returns the parser of mesh formats, which are listed in this order.
pub fn formats(names: [&'static str; 5]) -> impl TypedValueParser<Value = MeshFormat> {
    PossibleValuesParser::new(names)
        .try_map(|name| MeshFormat::from_extension(&name).ok_or("is no format of meshes"))
}

/// Parses the width of an interval.
pub fn tolerance(text: &str) -> Result<f64, String> {
    number(text, "a number not below 0", |tolerance| tolerance >= 0.0)
}

/// Parses a time limit in seconds.
pub fn seconds(text: &str) -> Result<f64, String> {
    number(text, "a number of seconds above 0", |seconds| seconds > 0.0 && seconds < 1e9)
}

/// Parses a number of threads. More than 1024 would help nobody.
pub fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 0..=1024) => Ok(threads),
        _ => Err("expected a number from 0 to 1024".into()),
    }
}

/// Most levels of a lattice.
const MOST: u8 = 19;

/// Parses the number of cells along an axis, and returns the levels of that lattice.
pub fn resolution(text: &str) -> Result<u8, String> {
    let most = 1u64 << MOST;
    let Ok(cells) = text.parse::<u64>() else {
        return Err(format!("expected a power of two from 2 to {most}"));
    };
    if cells.is_power_of_two() && (2..=most).contains(&cells) {
        return Ok(cells.trailing_zeros() as u8);
    }
    let near = match cells {
        0..2 => "2 is the nearest one".into(),
        _ if cells > most => format!("{most} is the nearest one"),
        _ => {
            let below = 1u64 << cells.ilog2();
            format!("{below} and {} are the nearest ones", 2 * below)
        }
    };
    Err(format!("expected a power of two from 2 to {most}: {near}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_four_numbers_that_make_a_frame() {
        let frame = bounds("-1, 2.5,3e1,4").unwrap();
        assert_eq!((frame.origin(), frame.edge()), ([-1.0, 2.5, 30.0], 4.0));
        for text in [
            "",
            "1,2,3",
            "1,2,3,4,5",
            "1,2,3,x",
            "0,0,0,0",
            "0,0,0,-1",
            "0,nan,0,1",
            "0,0,0,inf",
            "0,0,0,nan",
        ] {
            assert!(bounds(text).is_err(), "{text}");
        }
    }

    #[test]
    fn resolutions_are_powers_of_two() {
        for depth in 1..=19u8 {
            assert_eq!(resolution(&(1u32 << depth).to_string()), Ok(depth));
        }
        for (text, near) in [
            ("0", "2 is the"),
            ("1", "2 is the"),
            ("3", "2 and 4 are"),
            ("300", "256 and 512 are"),
            ("524287", "262144 and 524288 are"),
            ("524289", "524288 is the"),
            ("1048576", "524288 is the"),
            ("18446744073709551615", "524288 is the"),
            ("-4", "from 2 to 524288"),
            ("many", "from 2 to 524288"),
        ] {
            let error = resolution(text).unwrap_err();
            assert!(error.contains(near), "{text}: {error}");
        }
    }
}
