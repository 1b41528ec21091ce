//! Reports of layouts.

use crate::report::bounds::gap_word;
use crate::source::plan::{Ends, Measures, Other, Plan, name_of};
use crate::words::{count, counted, number, put_line, seconds};
use leafless::Interval;
use leafless::layout::{SearchEnd, SearchReport, Standing};
use leafless::query::GapVerdict;
use serde::Serialize;
use std::fmt::Write;

/// The number of placed copies of an item.
#[derive(Serialize)]
pub struct Item {
    pub name: String,
    pub count: u64,
    pub placed: u64,
    pub left: u64,
}

/// The result of a search.
#[derive(Serialize)]
pub struct Found {
    container: String,
    pub items: Vec<Item>,
    placed: u64,
    left: u64,
    #[serde(flatten)]
    measures: Measures,
    tests: u64,
    splits: u64,
    rounds: u64,
    /// The reason for its end: "complete", "rounds", "budget" or "time".
    end: &'static str,
    outputs: Vec<String>,
    seconds: f64,
}

impl Found {
    pub fn new(
        container: String,
        items: Vec<Item>,
        measures: Measures,
        search: &SearchReport,
        outputs: Vec<String>,
        seconds: f64,
    ) -> Found {
        let &SearchReport { placed, left, rounds, tests, splits, end } = search;
        let end = match end {
            SearchEnd::Complete => "complete",
            SearchEnd::Rounds => "rounds",
            SearchEnd::Budget => "budget",
            SearchEnd::Cancelled => "time",
        };
        Found { container, items, placed, left, measures, tests, splits, rounds, end, outputs, seconds }
    }

    /// Returns the copies that were not placed, if there are any.
    pub fn rest(&self) -> Option<String> {
        let names = self.items.iter().filter(|item| item.left > 0);
        let names: Vec<String> = names.map(|item| format!("{} of {}", count(item.left), item.name)).collect();
        let copies = counted(self.left, "copy is", "copies are");
        let hint = match self.end {
            "time" => "more --seconds may place more",
            "budget" => "more --tests or --splits may place more",
            _ => "more --rounds or --cells, or another --seed, may place more",
        };
        (self.left > 0).then(|| format!("{copies} left, {}: {hint}", names.join(", ")))
    }

    /// Returns the report for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let of = |placed, all| format!("{} of {}", count(placed), count(all));
        put_line(&mut text, "container", &self.container);
        put_line(&mut text, "placed", &of(self.placed, self.placed + self.left));
        for item in &self.items {
            put_line(&mut text, "", &format!("{} {}", of(item.placed, item.count), item.name));
        }
        let Measures { filled_part, height, mass, mass_unit, centroid, smallest_gap, .. } = &self.measures;
        let told = |ends: &Ends| ends.interval().to_string();
        put_line(&mut text, "filled", &format!("{} of the container's volume", told(filled_part)));
        put_line(&mut text, "height", &told(height));
        put_line(&mut text, "mass", format!("{} {}", told(mass), mass_unit.name()).trim_end());
        let centre = centroid.as_ref().map(|centre| centre.each_ref().map(told).join(", "));
        put_line(&mut text, "centroid", &centre.unwrap_or_else(|| "unknown".into()));
        put_line(&mut text, "smallest gap", &smallest_gap.as_ref().map_or_else(|| "none".into(), told));
        let end = match self.end {
            "complete" => "all copies are placed",
            "rounds" => "all rounds are made",
            "budget" => "the tests or the splits are spent",
            _ => "the time is over",
        };
        let work = [
            counted(self.rounds, "round", "rounds"),
            counted(self.tests, "test", "tests"),
            counted(self.splits, "split", "splits"),
        ];
        put_line(&mut text, "end", &format!("{end}; {}, {}", work.join(", "), seconds(self.seconds)));
        text
    }
}

/// A proven or possible obstruction of a copy.
#[derive(Serialize)]
pub struct Conflict {
    placed: usize,
    name: String,
    other: Other,
    /// Name of the other body, if it is a copy or an obstacle.
    other_name: Option<String>,
    /// Whether the two are proven to stand as they should: "no" or "undecided".
    verdict: &'static str,
    gap: Ends,
}

/// The result of a check.
#[derive(Serialize)]
pub struct Checked {
    layout: String,
    copies: u64,
    /// Number of copies that are proven to stand as they should.
    proven: u64,
    /// Number of copies that are proven not to.
    wrong: u64,
    undecided: u64,
    /// The conflicts, each pair once.
    conflicts: Vec<Conflict>,
    clearance: f64,
    wall_clearance: f64,
    splits: u64,
}

impl Checked {
    pub fn new(layout: String, plan: &Plan, standings: &[Standing]) -> Checked {
        let name = |number: usize| {
            plan.placed.get(number).map_or_else(String::new, |standing| standing.name.clone())
        };
        let mut conflicts = vec![];
        for (placed, standing) in standings.iter().enumerate() {
            for conflict in &standing.conflicts {
                let other = Other::from(conflict.other);
                let other_name = match other {
                    Other::Wall => None,
                    Other::Obstacle(number) => plan.obstacles.get(number).map(|file| name_of(file)),
                    // (The other copy has reported this pair.)
                    Other::Placed(number) if number < placed => continue,
                    Other::Placed(number) => Some(name(number)),
                };
                conflicts.push(Conflict {
                    placed,
                    name: name(placed),
                    other,
                    other_name,
                    verdict: gap_word(conflict.verdict),
                    gap: conflict.gap.into(),
                });
            }
        }
        let count_of =
            |verdict| standings.iter().filter(|standing| standing.verdict == verdict).count() as u64;
        Checked {
            layout,
            copies: standings.len() as u64,
            proven: count_of(GapVerdict::Yes),
            wrong: count_of(GapVerdict::No),
            undecided: count_of(GapVerdict::Undecided),
            conflicts,
            clearance: plan.clearance,
            wall_clearance: plan.wall_clearance,
            splits: standings.iter().map(|standing| standing.splits).sum(),
        }
    }

    /// Returns the copies that are wrong or not proven, if there are any.
    pub fn problem(&self) -> Option<String> {
        let copies = counted(self.copies, "copy", "copies");
        let told = match (self.wrong, self.undecided) {
            (0, 0) => return None,
            (0, open) => format!("of {copies} {} undecided", counted(open, "is", "are")),
            (wrong, 0) => format!("of {copies} {} in conflict", counted(wrong, "is", "are")),
            (wrong, open) => {
                let open = counted(open, "is", "are");
                format!("of {copies} {} in conflict, and {open} undecided", counted(wrong, "is", "are"))
            }
        };
        Some(told)
    }

    /// Returns the report for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        put_line(&mut text, "copies", &count(self.copies));
        put_line(&mut text, "proven", &count(self.proven));
        put_line(&mut text, "in conflict", &count(self.wrong));
        put_line(&mut text, "undecided", &count(self.undecided));
        for conflict in &self.conflicts {
            let Conflict { placed, name, other, other_name, gap, .. } = conflict;
            let other_name = other_name.as_deref().unwrap_or_default();
            let (other, least) = match other {
                Other::Wall => ("the wall".into(), self.wall_clearance),
                Other::Obstacle(number) => (format!("obstacle {number}, {other_name},"), self.clearance),
                Other::Placed(number) => (format!("copy {number}, {other_name},"), self.clearance),
            };
            let sure = if conflict.verdict == "no" { "" } else { "may " };
            let verb = match (conflict.verdict == "no", gap.interval() == Interval::exactly(0.0)) {
                (true, true) => "touches or overlaps",
                (true, false) => "is too near to",
                (false, _) => "be too near to",
            };
            let gap = gap.interval().to_string();
            let least = number(least);
            // (Writing to memory does not fail.)
            let _ = writeln!(
                text,
                "copy {placed}, {name}, {sure}{verb} {other}: the gap is {gap}, and {least} at least is asked for"
            );
        }
        put_line(&mut text, "splits", &count(self.splits));
        text
    }
}
