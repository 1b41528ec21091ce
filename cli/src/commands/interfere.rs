//! `leafless interfere`: the overlap and the distance of two solids.

use super::poses;
use crate::failure::{Failure, Of};
use crate::options::{bounds, seconds};
use crate::progress::{watched, within_time};
use crate::report::bounds::{Proven, Range, gap_word, stop_word, verdict_word};
use crate::sink::print_told;
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::placing::from_file;
use crate::source::solid::{Corners, Source, evaluations};
use crate::words::{count, number, put_line};
use clap::Args;
use leafless::lattice::Cube;
use leafless::query::{Gap, GapVerdict, Overlap, StopReason, gap_at_least};
use leafless::solid::{AskWhole, Prepared, Solid};
use leafless::{
    Affine, Clearance, Control, Error, Frame, Interference, Interval, Proof, clearance, interference,
};
use serde::Serialize;
use std::ffi::OsString;

/// Tells whether two solids have inner points in common. `disjoint` and `overlapping` are proven. `undecided`
/// comes with the reason: the depth or the number of splits is too small, the cells of a file do not prove
/// enough, or both solids may extend outside the bounds. Solids that touch are disjoint, and their clearance
/// is 0. For scenes and for solids that keep surfaces, this is proven even if they touch along a common
/// surface.
///
/// The volume that the solids have in common and the clearance, the least distance between them, are
/// intervals that contain the true values. The clearance of two closed meshes is computed from their
/// triangles, up to rounding. For other solids, an upper bound of the clearance needs cells that are proven
/// to be inside. Unknown numbers are null in JSON.
#[derive(Args)]
#[command(mut_arg("place", |place| place.visible_alias("place-b")))]
pub struct Arguments {
    /// First solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-`
    /// for standard input
    #[arg(value_name = "A")]
    a: OsString,
    /// Second solid, mesh, scene or volume. The moves --translate, --rotate, --scale and --place apply to it
    #[arg(value_name = "B")]
    b: OsString,
    /// Tell only whether the distance of the solids is at least D, in model units, and print two points that
    /// are nearer if there are any. The exit code is 0 if the distance is proven, and otherwise 1
    #[arg(long, value_name = "D", conflicts_with = "seconds", allow_hyphen_values = true)]
    gap_at_least: Option<f64>,
    /// Tell only the verdict, for B under each of the matrices in a file: one line for each, as --place takes
    /// it, applied after the other moves. With --gap-at-least, tell for each pose whether the solids are that
    /// far apart
    #[arg(long, value_name = "FILE", conflicts_with = "seconds")]
    poses: Option<std::path::PathBuf>,
    /// With --poses, tell also the clearance in each pose, and a point of each solid at that distance
    #[arg(long, requires = "poses", conflicts_with = "gap_at_least")]
    clearance: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Finest level of cells, 1 to 20 [default: that of the first solid, or 10 for a mesh or scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=leafless::lattice::MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Take the cells of solids from files (.lfl) as the solids themselves, whatever the cells prove about
    /// their source
    #[arg(long)]
    cells: bool,
    /// Time limit in seconds: the command then ends with the bounds found so far. The result then depends on
    /// the machine
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    seconds: Option<f64>,
    /// Most cells to split for each of the three answers [default: 100000, or no limit with --seconds]
    #[arg(long, value_name = "N")]
    splits: Option<u64>,
    /// Lower corner and edge length of the cube to examine [default: the cube around both]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    taking: Taking,
}

/// A cell in model units, and a ball in it that lies in both solids.
#[derive(Serialize)]
struct Witness {
    level: u8,
    at: [u32; 3],
    min: [f64; 3],
    max: [f64; 3],
    centre: [f64; 3],
    radius: f64,
}

/// Returns why a verdict is undecided, in a word and in a sentence.
fn reason(found: &Interference, is_spent: bool) -> Option<(&'static str, &'static str)> {
    let certified = |proof: Proof| proof.full && proof.empty;
    match found.verdict {
        // (What lies outside the universe of such a solid is not proven, either.)
        Overlap::Undecided if !found.proofs.into_iter().all(certified) => {
            Some(("unproven", "the cells of a file do not prove enough; --cells takes them as the solid"))
        }
        Overlap::Undecided if found.clipped => {
            Some(("clipped", "both solids may extend beyond the bounds; give larger --bounds"))
        }
        Overlap::Undecided if is_spent => {
            Some(("budget", "all splits are used; give more --splits or --seconds"))
        }
        Overlap::Undecided => {
            Some(("depth", "cells of the finest level are undecided; give a greater --depth"))
        }
        Overlap::Disjoint | Overlap::Overlapping => None,
    }
}

#[derive(Serialize)]
struct Report {
    a: String,
    b: String,
    verdict: &'static str,
    /// The reason why nothing is decided: "clipped", "unproven", "budget" or "depth"; otherwise null.
    reason: Option<&'static str>,
    overlap: Range,
    clearance: Range,
    /// A point of each solid, at the distance of the clearance's upper bound; null if the solids overlap.
    points: Option<[[f64; 3]; 2]>,
    /// The reason why the search for the clearance ended.
    clearance_measured: &'static str,
    witness: Option<Witness>,
    /// The proof of each solid; unproven cells count as undecided.
    proof_a: Proven,
    proof_b: Proven,
    /// Splits of both solids, for the verdict.
    splits: u64,
    splits_a: u64,
    splits_b: u64,
    evaluations: u64,
    /// The finest level of the cells that were examined for the verdict.
    level: u8,
    depth: u8,
    origin: [f64; 3],
    edge: f64,
    /// True if a solid may extend beyond the cube that was examined.
    clipped: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let inputs = [&arguments.a, &arguments.b].map(|name| Input::from(&**name));
    if inputs.iter().all(|input| input.path().is_none()) {
        return Err(Failure::Usage("only one of the solids can be standard input".into()));
    }
    let [a, b] = &inputs;
    let placement = arguments.taking.placing.map().copied().unwrap_or(Affine::IDENTITY);
    // A source that is moved as a solid blurs no more than its cells, and keeps what is known about a mesh.
    let taking = arguments.taking.unmoved();
    let [first, second] =
        [Source::read(a, &taking)?, Source::read(b, &taking)?].map(|source| source.taken(arguments.cells));
    let placements = match &arguments.poses {
        Some(path) => from_file(path, &placement)?,
        None => vec![placement],
    };
    let frame = match &arguments.bounds {
        Some(bounds) => bounds.with_depth(arguments.depth.unwrap_or(10)).of(a)?,
        None => {
            let both = (first.bounds(a)?, second.bounds(b)?);
            let around = if first.ends_at_bounds(a)? && second.ends_at_bounds(b)? {
                Frame::fitted
            } else {
                Frame::around
            };
            common_frame(first.own_frame(), both, &placements, arguments.depth, around).of(a)?
        }
    };
    let is_exact =
        first.has_exact_surfaces(&Affine::IDENTITY, &frame) && second.has_exact_surfaces(&placement, &frame);
    if arguments.poses.is_some() {
        let own = match second.own_frame() {
            Some(own) => *own,
            None => {
                let (min, max) = second.bounds(b)?;
                Frame::around(min, max, frame.depth()).of(b)?
            }
        };
        let solids =
            [first.placed(a, &Affine::IDENTITY, &frame)?, second.placed(b, &Affine::IDENTITY, &own)?];
        let control = Control { max_splits: Some(arguments.splits.unwrap_or(SPLITS)), ..Control::default() };
        let asked = poses::Asked { inputs: &inputs, solids: &solids, frames: [&frame, &own] };
        let wanted = match arguments.gap_at_least {
            Some(least) => poses::Wanted::Gap(least),
            None if arguments.clearance => {
                let [first, second] = &solids;
                let is_exact = is_exact
                    || has_walls(first, &frame, &control).of(a)?
                        && has_walls(second, &own, &control).of(b)?;
                poses::Wanted::Clearance(tolerance(is_exact, &frame))
            }
            None => poses::Wanted::Verdict,
        };
        return asked.run(&placements, wanted, &control, arguments.json);
    }
    let first = Prepared::new(first.placed(a, &Affine::IDENTITY, &frame)?);
    let second = Prepared::new(second.placed(b, &placement, &frame)?);
    if let Some(least) = arguments.gap_at_least {
        return gap(arguments, least, [&first, &second], &frame, a);
    }
    let splits = arguments.splits.or(if arguments.seconds.is_some() { None } else { Some(SPLITS) });
    let asked = watched("interfere", 0, |control| {
        let control = Control { max_splits: splits, ..*control };
        let both = [&first, &second];
        let ask = |control: &Control<'_>| ask(both, is_exact, &frame, control);
        within_time(arguments.seconds, &control, ask, |asked| !asked.is_spent)
    });
    let Answers { found, near, evaluations, is_spent } = asked.of(a)?;
    let reason = reason(&found, is_spent);
    let report = Report::new(&inputs, &frame, &found, &near, evaluations, reason.map(|reason| reason.0));
    print_told(arguments.json, &report, |report| text(&found, report, reason.map(|reason| reason.1)))
}

/// The report of --gap-at-least.
#[derive(Serialize)]
struct GapReport {
    /// "yes", "no" or "undecided".
    gap_at_least: &'static str,
    least: f64,
    clearance: Range,
    points: Option<[[f64; 3]; 2]>,
    splits: u64,
    clipped: bool,
}

/// Tells whether the distance is at least `least`. A possible smaller distance is a failure.
fn gap(
    arguments: &Arguments,
    least: f64,
    [first, second]: [&Prepared; 2],
    frame: &Frame,
    a: &Input,
) -> Result<(), Failure> {
    let found = watched("interfere", 0, |control| {
        let max_splits = Some(arguments.splits.unwrap_or(SPLITS));
        gap_at_least(first, second, frame, least, &Control { max_splits, ..*control })
    });
    let Gap { verdict, evidence } = found.of(a)?;
    let report = GapReport {
        gap_at_least: gap_word(verdict),
        least,
        clearance: Range::new(evidence.distance, evidence.clipped),
        points: evidence.points,
        splits: evidence.splits.iter().sum(),
        clipped: evidence.clipped,
    };
    print_told(arguments.json, &report, |report| {
        let mut text = String::new();
        put_line(&mut text, "gap", &format!("at least {}: {}", number(least), report.gap_at_least));
        put_line(&mut text, "clearance", &report.clearance.text());
        if let Some(points) = &report.points {
            put_line(&mut text, "points", &ends(points));
        }
        put_line(&mut text, "splits", &count(report.splits));
        text
    })?;
    match verdict {
        GapVerdict::Yes => Ok(()),
        GapVerdict::No => Err(Failure::Failed(format!("the solids are nearer than {}", number(least)))),
        GapVerdict::Undecided => {
            let hint = "give a greater --depth, more --splits or larger --bounds";
            Err(Failure::Failed(format!(
                "whether the solids are nearer than {} is undecided: {hint}",
                number(least)
            )))
        }
    }
}

/// Formats two points for people.
fn ends([p, q]: &[[f64; 3]; 2]) -> String {
    format!("{} and {}", p.map(number).join(" "), q.map(number).join(" "))
}

/// Returns the cube that contains both: the own cube of a solid, doubled until it is large enough, so that
/// its cells stay whole; otherwise the cube that `around` makes of their bounds.
pub fn common_frame(
    own: Option<&Frame>,
    ((mut min, mut max), (low, high)): (Corners, Corners),
    placements: &[Affine],
    depth: Option<u8>,
    around: fn([f64; 3], [f64; 3], u8) -> Result<Frame, Error>,
) -> Result<Frame, Error> {
    for (placement, k) in placements.iter().flat_map(|placement| (0..8).map(move |k| (placement, k))) {
        let corner = placement.apply([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low } else { high }[axis]));
        for axis in 0..3 {
            min[axis] = min[axis].min(corner[axis]);
            max[axis] = max[axis].max(corner[axis]);
        }
    }
    let Some(own) = own else { return around(min, max, depth.unwrap_or(10)) };
    let mut frame = match depth {
        Some(depth) => own.with_depth(depth)?,
        None => *own,
    };
    while frame.depth() < leafless::lattice::MAX_DEPTH {
        let (origin, edge) = (frame.origin(), frame.edge());
        if (0..3).all(|axis| min[axis] >= origin[axis] && max[axis] <= origin[axis] + edge) {
            break;
        }
        // Towards the side where more is missing.
        let grown = [0, 1, 2].map(|axis| {
            let above = max[axis] - (origin[axis] + edge) >= origin[axis] - min[axis];
            if above { origin[axis] } else { origin[axis] - edge }
        });
        frame = Frame::new(grown, 2.0 * edge, frame.depth() + 1)?;
    }
    Ok(frame)
}

/// Splits for each answer without --splits and --seconds.
const SPLITS: u64 = 100_000;

/// Accuracy of the common volume, relative to it.
const DIGITS: f64 = 1e-5;

/// The answers.
struct Answers {
    found: Interference,
    near: Clearance,
    /// Evaluated half-spaces, for the verdict.
    evaluations: u64,
    /// True if more splits might improve the answers.
    is_spent: bool,
}

/// Returns the tolerance of a clearance: almost exact if surfaces are known, otherwise that of the cells.
fn tolerance(is_exact: bool, frame: &Frame) -> f64 {
    if is_exact { 1e-9 * frame.edge() } else { 4.0 * frame.cell_size() }
}

/// True if distances from a solid can be computed from triangles.
fn has_walls<S: Solid>(solid: &S, frame: &Frame, control: &Control<'_>) -> Result<bool, Error> {
    Ok(solid.on(frame, control)?.walls(control)?.is_some())
}

/// Computes the verdict, then the common volume or the clearance.
fn ask(
    [a, b]: [&Prepared; 2],
    is_exact: bool,
    frame: &Frame,
    control: &Control<'_>,
) -> Result<Answers, Error> {
    let spends = |splits: [u64; 2]| control.max_splits.is_some_and(|most| splits.iter().sum::<u64>() >= most);
    let mut found = interference(a, b, frame, f64::INFINITY, control)?;
    let evaluations = evaluations(a.solid()) + evaluations(b.solid());
    if found.verdict == Overlap::Overlapping {
        // First a rough volume, then the accuracy relative to it.
        let some = Control { max_splits: control.max_splits.map(|most| most / 8), ..*control };
        let mut measured = interference(a, b, frame, 0.0, &some)?;
        let wanted = DIGITS * measured.volume.lower;
        if measured.volume.width() > wanted {
            measured = interference(a, b, frame, wanted, control)?;
        }
        found.volume = measured.volume;
        let near = Clearance {
            distance: Interval::exactly(0.0),
            points: None,
            normals: [None; 2],
            nearest: None,
            depth: 0.0,
            stop_reason: StopReason::Tolerance,
            splits: [0, 0],
            proofs: found.proofs,
            clipped: found.clipped,
        };
        return Ok(Answers { found, near, evaluations, is_spent: spends(measured.splits) });
    }
    let is_exact = is_exact || has_walls(a, frame, control)? && has_walls(b, frame, control)?;
    let near = clearance(a, b, frame, tolerance(is_exact, frame), control)?;
    let is_open = found.verdict == Overlap::Undecided && spends(found.splits);
    Ok(Answers { found, is_spent: is_open || near.stop_reason == StopReason::Budget, near, evaluations })
}

impl Report {
    fn new(
        [a, b]: &[Input; 2],
        frame: &Frame,
        found: &Interference,
        near: &Clearance,
        evaluations: u64,
        reason: Option<&'static str>,
    ) -> Report {
        Report {
            a: a.to_string(),
            b: b.to_string(),
            verdict: verdict_word(found.verdict),
            reason,
            overlap: Range::new(found.volume, found.clipped),
            clearance: Range::new(near.distance, near.clipped),
            points: near.points,
            clearance_measured: stop_word(near.stop_reason),
            witness: found.witness.zip(found.ball).map(|(cell, ball)| {
                let (min, max) = Cube { frame, cell }.bounds();
                Witness { level: cell.level, at: cell.at, min, max, centre: ball.centre, radius: ball.radius }
            }),
            proof_a: found.proofs[0].into(),
            proof_b: found.proofs[1].into(),
            splits: found.splits.iter().sum(),
            splits_a: found.splits[0],
            splits_b: found.splits[1],
            evaluations,
            level: found.level,
            depth: frame.depth(),
            origin: frame.origin(),
            edge: frame.edge(),
            clipped: near.clipped,
        }
    }
}

/// Returns the report for people.
fn text(found: &Interference, report: &Report, reason: Option<&str>) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| put_line(&mut text, name, &value);
    line("verdict", reason.map_or(report.verdict.into(), |reason| format!("{}: {reason}", report.verdict)));
    line("overlap", report.overlap.text());
    // (The clearance of overlapping solids is 0, and nothing was searched.)
    let ended = match report.clearance_measured {
        "budget" if report.clearance.upper != Some(0.0) => " (as far as the splits go)",
        _ => "",
    };
    line("clearance", format!("{}{ended}", report.clearance.text()));
    if let Some(Witness { centre, radius, .. }) = &report.witness {
        let around = centre.map(number).join(" ");
        line("witness", format!("a ball of radius {} around {around} lies in both", number(*radius)));
    }
    if let Some(points) = &report.points {
        line("nearest", ends(points));
    }
    for (input, proven) in [(&report.a, &report.proof_a), (&report.b, &report.proof_b)] {
        if let Some(doubt) = proven.doubt() {
            line("proven", format!("of {input}: {doubt}"));
        }
    }
    let [a, b] = found.splits.map(count);
    line("splits", format!("{} ({a} and {b})", count(report.splits)));
    if report.clipped {
        line("bounds", "a solid may go on outside of the cube that was looked at".into());
    }
    text
}
