//! What is told of what is known: volumes as intervals, what cells prove, and why a search ended.

use crate::words::number;
use leafless::query::{Overlap, StopReason};
use leafless::{Interval, Proof};
use serde::Serialize;

/// A certified volume in cubic model units.
#[derive(Serialize)]
pub struct Volume {
    lower: f64,
    upper: f64,
}

impl Volume {
    /// The interval.
    pub fn interval(&self) -> Interval {
        Interval::new(self.lower, self.upper).unwrap_or(Interval::ALL)
    }

    /// How much is undecided.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

impl From<Interval> for Volume {
    fn from(interval: Interval) -> Volume {
        Volume { lower: interval.lower, upper: interval.upper }
    }
}

/// Why a search ended, in a word.
pub fn stop_word(reason: StopReason) -> &'static str {
    match reason {
        StopReason::Tolerance => "tolerance",
        StopReason::Budget => "budget",
        StopReason::Exhausted => "exhausted",
    }
}

/// What cells prove of the solid that they were made from.
#[derive(Serialize)]
pub struct Proven {
    full: bool,
    empty: bool,
    displacement: f64,
}

impl From<Proof> for Proven {
    fn from(proof: Proof) -> Proven {
        Proven { full: proof.full, empty: proof.empty, displacement: proof.displacement() }
    }
}

impl Proven {
    /// Whether all cells say what is true.
    pub fn is_certified(&self) -> bool {
        self.full && self.empty
    }

    /// What is not proven, if that is anything, and what can be done.
    pub fn doubt(&self) -> Option<String> {
        (!self.is_certified()).then(|| format!("{} (--cells takes the cells for the solid)", self.text()))
    }

    /// The same for people.
    pub fn text(&self) -> String {
        let proven = match (self.full, self.empty) {
            (true, true) => "inside and outside",
            (true, false) => "inside only; what is called outside need not be",
            (false, true) => "outside only; what is called inside need not be",
            (false, false) => "nothing: cells are called inside or outside as they were sampled",
        };
        match self.displacement {
            0.0 => proven.into(),
            moved => format!("{proven}; of surfaces that were moved by {} or less", number(moved)),
        }
    }
}

/// A verdict in a word.
pub fn verdict_word(verdict: Overlap) -> &'static str {
    match verdict {
        Overlap::Disjoint => "disjoint",
        Overlap::Overlapping => "overlapping",
        Overlap::Undecided => "undecided",
    }
}
