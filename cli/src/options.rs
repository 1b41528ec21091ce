//! Values of options that several subcommands have.

use clap::ValueEnum;
use leafless::{Frame, Rule};

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum RuleName {
    /// They stay undecided: volumes are intervals that hold the truth
    Certified,
    /// They are inside if their centre is
    Sampled,
    /// They are outside: the result lies within the solid
    Inner,
    /// They are inside: the result contains the solid
    Outer,
}

impl From<RuleName> for Rule {
    fn from(name: RuleName) -> Rule {
        match name {
            RuleName::Certified => Rule::Certified,
            RuleName::Sampled => Rule::Sampled,
            RuleName::Inner => Rule::Inner,
            RuleName::Outer => Rule::Outer,
        }
    }
}

/// The name of an option's value, as the user writes it.
pub fn name_of(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// The universe of `--bounds`; its depth is a placeholder.
pub fn bounds(text: &str) -> Result<Frame, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z, edge]) => Frame::new([x, y, z], edge, 1).map_err(|error| error.to_string()),
        _ => Err("expected four numbers: x0,y0,z0,edge".into()),
    }
}

/// A number of threads: far more than processors help nobody.
pub fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 0..=1024) => Ok(threads),
        _ => Err("expected a number from 0 to 1024".into()),
    }
}

/// Most levels of a lattice.
const MOST: u8 = 19;

/// The levels of a lattice of so many cells to an axis.
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
