//! `leafless interfere --poses`: one solid under many placements. With `--clearance` the report contains the
//! distance of the solids in each of them, with `--gap-at-least` whether the distance is large enough.

use crate::failure::{Failure, Of};
use crate::progress::watched;
use crate::report::bounds::{Range, gap_word, verdict_word};
use crate::sink::print_told;
use crate::source::input::Input;
use crate::words::{count, number, table};
use leafless::query::{Ball, Gap, GapVerdict, clearance_at, gap_at_least_at, interference_at};
use leafless::{Affine, AnySolid, Clearance, Control, Frame, Interference};
use serde::Serialize;

/// The solids under all placements.
pub struct Asked<'a> {
    pub inputs: &'a [Input; 2],
    pub solids: &'a [AnySolid; 2],
    /// The frame to examine, and the frame of the second solid.
    pub frames: [&'a Frame; 2],
}

/// The question about each placement.
#[derive(Clone, Copy)]
pub enum Wanted {
    /// The overlap verdict.
    Verdict,
    /// The verdict and the clearance, to a tolerance.
    Clearance(f64),
    /// Whether the distance is at least this number.
    Gap(f64),
}

/// One placement.
#[derive(Serialize)]
struct Pose {
    verdict: &'static str,
    /// The centre of a ball that lies in both.
    centre: Option<[f64; 3]>,
    radius: Option<f64>,
    #[serde(flatten)]
    near: Option<Near>,
    splits: u64,
}

/// The distance of the solids.
#[derive(Serialize)]
struct Near {
    clearance: Range,
    /// A point of each solid, at the distance of the upper bound; null if none are known.
    points: Option<[[f64; 3]; 2]>,
}

/// The answer of --gap-at-least for one placement.
#[derive(Serialize)]
struct PoseGap {
    /// "yes", "no" or "undecided".
    gap_at_least: &'static str,
    #[serde(flatten)]
    near: Near,
    splits: u64,
}

#[derive(Serialize)]
struct Report<P> {
    a: String,
    b: String,
    depth: u8,
    origin: [f64; 3],
    edge: f64,
    /// The required distance, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    least: Option<f64>,
    poses: Vec<P>,
}

impl Asked<'_> {
    pub fn run(
        &self,
        placements: &[Affine],
        wanted: Wanted,
        control: &Control<'_>,
        json: bool,
    ) -> Result<(), Failure> {
        match wanted {
            Wanted::Verdict => self.verdicts(placements, None, control, json),
            Wanted::Clearance(tolerance) => self.verdicts(placements, Some(tolerance), control, json),
            Wanted::Gap(least) => self.gaps(placements, least, control, json),
        }
    }

    fn report<P>(&self, least: Option<f64>, poses: Vec<P>) -> Report<P> {
        let ([a, b], [frame, _]) = (self.inputs, self.frames);
        let (origin, edge) = (frame.origin(), frame.edge());
        Report { a: a.to_string(), b: b.to_string(), depth: frame.depth(), origin, edge, least, poses }
    }

    /// Reports whether the solids overlap and, to a tolerance, how far they are apart.
    fn verdicts(
        &self,
        placements: &[Affine],
        tolerance: Option<f64>,
        control: &Control<'_>,
        json: bool,
    ) -> Result<(), Failure> {
        let ([first, second], [frame, own]) = (self.solids, self.frames);
        let found = watched("interfere", 0, |watching| {
            let control = Control { max_splits: control.max_splits, ..*watching };
            let found = interference_at(first, second, own, placements, frame, f64::INFINITY, &control)?;
            let near = match tolerance {
                Some(tolerance) => clearance_at(first, second, own, placements, frame, tolerance, &control)?,
                None => Vec::new(),
            };
            Ok((found, near))
        });
        let (found, near) = found.of(&self.inputs[0])?;
        let mut near = near.iter();
        let poses = found.iter().map(|found| Pose::new(found, near.next())).collect();
        print_told(json, &self.report(None, poses), |report| text(report, tolerance.is_some()))
    }

    /// Reports whether the distances are large enough. A possible smaller distance is a failure.
    fn gaps(
        &self,
        placements: &[Affine],
        least: f64,
        control: &Control<'_>,
        json: bool,
    ) -> Result<(), Failure> {
        let ([first, second], [frame, own]) = (self.solids, self.frames);
        let found = watched("interfere", 0, |watching| {
            let control = Control { max_splits: control.max_splits, ..*watching };
            gap_at_least_at(first, second, own, placements, frame, least, &control)
        });
        let found = found.of(&self.inputs[0])?;
        let poses = found.iter().map(PoseGap::new).collect();
        print_told(json, &self.report(Some(least), poses), text_of_gaps)?;
        let count_of = |verdict| found.iter().filter(|gap| gap.verdict == verdict).count() as u64;
        match [GapVerdict::No, GapVerdict::Undecided].map(count_of) {
            [0, 0] => Ok(()),
            [near, open] => Err(Failure::Failed(format!(
                "the solids are nearer than {} in {} of {} places, and that is undecided in {}",
                number(least),
                count(near),
                count(found.len() as u64),
                count(open)
            ))),
        }
    }
}

impl Pose {
    fn new(found: &Interference, near: Option<&Clearance>) -> Pose {
        let ball = found.ball.map(|Ball { centre, radius }| (centre, radius));
        let splits = found.splits.iter().chain(near.iter().flat_map(|near| &near.splits)).sum();
        Pose {
            verdict: verdict_word(found.verdict),
            centre: ball.map(|(centre, _)| centre),
            radius: ball.map(|(_, radius)| radius),
            near: near.map(Near::new),
            splits,
        }
    }
}

impl Near {
    fn new(found: &Clearance) -> Near {
        Near { clearance: Range::new(found.distance, found.clipped), points: found.points }
    }

    /// Returns the interval and the points, for people.
    fn cells(&self) -> [String; 2] {
        let points = self.points.map(|ends| ends.map(|end| end.map(number).join(" ")).join(" and "));
        [self.clearance.text(), points.unwrap_or_default()]
    }
}

impl PoseGap {
    fn new(found: &Gap) -> PoseGap {
        PoseGap {
            gap_at_least: gap_word(found.verdict),
            near: Near::new(&found.evidence),
            splits: found.evidence.splits.iter().sum(),
        }
    }
}

/// Returns the report for people.
fn text(report: &Report<Pose>, has_clearance: bool) -> String {
    let near: &[&str] = if has_clearance { &["clearance", "nearest"] } else { &[] };
    let head = [&["pose", "verdict", "a ball in both: radius", "around"], near, &["splits"]].concat();
    let head = head.into_iter().map(String::from).collect();
    let rows: Vec<Vec<String>> = (1..)
        .zip(&report.poses)
        .map(|(pose, own): (u64, &Pose)| {
            let centre = own.centre.map(|centre| centre.map(number).join(" "));
            let mut row = vec![
                count(pose),
                own.verdict.into(),
                own.radius.map(number).unwrap_or_default(),
                centre.unwrap_or_default(),
            ];
            row.extend(own.near.iter().flat_map(Near::cells));
            row.push(count(own.splits));
            row
        })
        .collect();
    table(&head, &rows)
}

/// Returns the report for people.
fn text_of_gaps(report: &Report<PoseGap>) -> String {
    let least = report.least.unwrap_or_default();
    let head = [
        "pose".into(),
        format!("at least {}", number(least)),
        "clearance".into(),
        "points".into(),
        "splits".into(),
    ];
    let rows: Vec<_> = (1..)
        .zip(&report.poses)
        .map(|(pose, own): (u64, &PoseGap)| {
            let [clearance, points] = own.near.cells();
            [count(pose), own.gap_at_least.into(), clearance, points, count(own.splits)]
        })
        .collect();
    table(&head, &rows)
}
