//! `leafless interfere --poses`: one solid under many placements.

use crate::failure::{Failure, Of};
use crate::progress::watched;
use crate::report::bounds::verdict_word;
use crate::sink::print_told;
use crate::source::input::Input;
use crate::source::placing::{after, matrix};
use crate::words::{count, number, table};
use leafless::query::{Ball, interference_at};
use leafless::{Affine, AnySolid, Control, Frame, Interference};
use serde::Serialize;
use std::path::Path;

/// What is asked under all placements.
pub struct Asked<'a> {
    pub inputs: &'a [Input; 2],
    pub solids: &'a [AnySolid; 2],
    /// Where to look, and where the second solid is known.
    pub frames: [&'a Frame; 2],
}

/// One placement.
#[derive(Serialize)]
struct Pose {
    verdict: &'static str,
    /// A ball that lies in both.
    centre: Option<[f64; 3]>,
    radius: Option<f64>,
    splits: u64,
}

#[derive(Serialize)]
struct Report {
    a: String,
    b: String,
    depth: u8,
    origin: [f64; 3],
    edge: f64,
    poses: Vec<Pose>,
}

/// The placements in a file: a line for each, as --place takes it. Empty lines and lines that begin with # are skipped.
pub fn read(path: &Path, first: &Affine) -> Result<Vec<Affine>, Failure> {
    let of_file = |problem: String| Failure::Usage(format!("{}: {problem}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| of_file(error.to_string()))?;
    let mut placements = Vec::new();
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.trim();
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        let placement = matrix(text).map_err(|problem| of_file(format!("line {line}: {problem}")))?;
        let whole = after(&placement, first).map_err(|error| of_file(format!("line {line}: {error}")))?;
        placements.push(whole);
    }
    Ok(placements)
}

impl Asked<'_> {
    pub fn run(&self, placements: &[Affine], control: &Control<'_>, json: bool) -> Result<(), Failure> {
        let ([a, b], [first, second], [frame, own]) = (self.inputs, self.solids, self.frames);
        let found = watched("interfere", 0, |watching| {
            let control = Control { max_splits: control.max_splits, ..*watching };
            interference_at(first, second, own, placements, frame, f64::INFINITY, &control)
        });
        let report = Report {
            a: a.to_string(),
            b: b.to_string(),
            depth: frame.depth(),
            origin: frame.origin(),
            edge: frame.edge(),
            poses: found.of(a)?.iter().map(Pose::new).collect(),
        };
        print_told(json, &report, text)
    }
}

impl Pose {
    fn new(found: &Interference) -> Pose {
        let ball = found.ball.map(|Ball { centre, radius }| (centre, radius));
        Pose {
            verdict: verdict_word(found.verdict),
            centre: ball.map(|(centre, _)| centre),
            radius: ball.map(|(_, radius)| radius),
            splits: found.splits.iter().sum(),
        }
    }
}

/// The same for people.
fn text(report: &Report) -> String {
    let head = ["pose", "verdict", "a ball in both: radius", "around", "splits"].map(String::from);
    let rows: Vec<_> = (1..)
        .zip(&report.poses)
        .map(|(pose, own): (u64, &Pose)| {
            [
                count(pose),
                own.verdict.into(),
                own.radius.map(number).unwrap_or_default(),
                own.centre.map(|centre| centre.map(number).join(" ")).unwrap_or_default(),
                count(own.splits),
            ]
        })
        .collect();
    table(&head, &rows)
}
