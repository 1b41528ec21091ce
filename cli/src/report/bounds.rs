//! Reports of bounds: volumes as intervals, the proof of cells, and the reason why a search ended.

use crate::words::number;
use leafless::query::{GapVerdict, Overlap, StopReason};
use leafless::{Interval, Proof};
use serde::Serialize;

/// A certified volume in cubic model units.
#[derive(Serialize)]
pub struct Volume {
    lower: f64,
    upper: f64,
}

impl Volume {
    /// Returns the interval.
    pub fn interval(&self) -> Interval {
        Interval::new(self.lower, self.upper).unwrap_or(Interval::ALL)
    }

    /// Returns the undecided volume.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

impl From<Interval> for Volume {
    fn from(interval: Interval) -> Volume {
        Volume { lower: interval.lower, upper: interval.upper }
    }
}

/// Bounds of a non-negative number; null where unknown.
#[derive(Serialize)]
pub struct Range {
    pub lower: Option<f64>,
    pub upper: Option<f64>,
}

impl Range {
    /// Builds the bounds. If `clipped`, they hold for the universe only, and a lower bound of 0 becomes
    /// unknown.
    pub fn new(interval: Interval, clipped: bool) -> Range {
        let upper = interval.upper.is_finite().then_some(interval.upper);
        Range { lower: (!clipped || interval.lower > 0.0).then_some(interval.lower), upper }
    }

    /// Returns the report for people.
    pub fn text(&self) -> String {
        match (self.lower, self.upper) {
            (None, None) => "unknown".into(),
            (lower, upper) => {
                let (lower, upper) = (lower.unwrap_or(0.0), upper.unwrap_or(f64::INFINITY));
                Interval::new(lower, upper).unwrap_or(Interval::ALL).to_string()
            }
        }
    }
}

/// Returns, in a word, whether solids are far enough apart.
pub fn gap_word(verdict: GapVerdict) -> &'static str {
    match verdict {
        GapVerdict::Yes => "yes",
        GapVerdict::No => "no",
        GapVerdict::Undecided => "undecided",
    }
}

/// Returns, in a word, why a search ended.
pub fn stop_word(reason: StopReason) -> &'static str {
    match reason {
        StopReason::Tolerance => "tolerance",
        StopReason::Budget => "budget",
        StopReason::Exhausted => "exhausted",
    }
}

/// The proof of cells: which statements hold for the solid that the cells were made from.
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
    /// True if all cells are proven.
    pub fn is_certified(&self) -> bool {
        self.full && self.empty
    }

    /// Returns the unproven statements and a remedy, if there are any.
    pub fn doubt(&self) -> Option<String> {
        (!self.is_certified()).then(|| format!("{} (--cells takes the cells for the solid)", self.text()))
    }

    /// Returns the report for people.
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

/// Returns a verdict in a word.
pub fn verdict_word(verdict: Overlap) -> &'static str {
    match verdict {
        Overlap::Disjoint => "disjoint",
        Overlap::Overlapping => "overlapping",
        Overlap::Undecided => "undecided",
    }
}
