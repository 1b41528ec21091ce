//! The names of the values of the library's enumerations in Python.

use crate::arguments::other_type;
use crate::error::refused;
use crate::from_package;
use leafless::query::{DistanceTo, GapVerdict, Obstacle, Overlap, StopReason};
use leafless::surface::Resolve;
use leafless::{FillRule, Rule, Tag};
use pyo3::prelude::*;

/// An enumeration whose values have names.
pub trait Word: Copy + 'static {
    /// The parameter that takes the name.
    const NAME: &'static str;
    /// All names, with their values.
    const ALL: &'static [(&'static str, Self)];
}

/// Returns the value of a name.
pub fn value<W: Word>(py: Python<'_>, word: &str) -> PyResult<W> {
    value_of(py, W::NAME, word)
}

/// Returns the value of a name that another parameter takes.
pub fn value_of<W: Word>(py: Python<'_>, name: &str, word: &str) -> PyResult<W> {
    match W::ALL.iter().find(|(own, _)| *own == word) {
        Some(&(_, value)) => Ok(value),
        None => {
            let words: Vec<_> = W::ALL.iter().map(|(own, _)| format!("'{own}'")).collect();
            Err(refused(py, name, format!("must be one of {}, not '{word}'", words.join(", "))))
        }
    }
}

/// Reads a tag, from its name or from the package's constant.
pub fn tag(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Tag> {
    let py = given.py();
    if given.is_instance(&from_package!(py, "leafless._answers", "Tag")?)? {
        let word = given.getattr("name")?.extract::<String>()?.to_lowercase();
        return value_of(py, name, &word);
    }
    match given.extract::<&str>() {
        Ok(word) => value_of(py, name, word),
        Err(_) => Err(other_type(given, name, "a str or a Tag")),
    }
}

/// Returns the name of a value.
pub fn word<W: Word + PartialEq>(value: W) -> &'static str {
    W::ALL.iter().find(|(_, own)| *own == value).map_or("unknown", |(word, _)| word)
}

macro_rules! words {
    ($($kind:ty as $name:literal { $($word:literal => $value:expr),* $(,)? })*) => {$(
        impl Word for $kind {
            const NAME: &'static str = $name;
            const ALL: &'static [(&'static str, $kind)] = &[$(($word, $value)),*];
        }
    )*};
}

words! {
    Rule as "rule" {
        "certified" => Rule::Certified,
        "sampled" => Rule::Sampled,
        "inner" => Rule::Inner,
        "outer" => Rule::Outer,
    }
    FillRule as "fill" {
        "nonzero" => FillRule::NonZero,
        "positive" => FillRule::Positive,
        "evenodd" => FillRule::EvenOdd,
    }
    DistanceTo as "to" {
        "boundary" => DistanceTo::Boundary,
        "solid" => DistanceTo::Solid,
        "complement" => DistanceTo::Complement,
    }
    Obstacle as "on" {
        "outer" => Obstacle::Upper,
        "inner" => Obstacle::Full,
    }
    Resolve<'static> as "resolve" {
        "outer" => Resolve::Outer,
        "inner" => Resolve::Inner,
    }
    Tag as "tag" {
        "empty" => Tag::Empty,
        "branch" => Tag::Branch,
        "partial" => Tag::Partial,
        "full" => Tag::Full,
    }
    StopReason as "stop_reason" {
        "tolerance" => StopReason::Tolerance,
        "budget" => StopReason::Budget,
        "exhausted" => StopReason::Exhausted,
    }
    Overlap as "verdict" {
        "disjoint" => Overlap::Disjoint,
        "overlapping" => Overlap::Overlapping,
        "undecided" => Overlap::Undecided,
    }
    GapVerdict as "verdict" {
        "yes" => GapVerdict::Yes,
        "no" => GapVerdict::No,
        "undecided" => GapVerdict::Undecided,
    }
}
