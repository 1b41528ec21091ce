//! `leafless deviation`: the distance between the boundaries of two solids.

use super::interfere::common_frame;
use crate::failure::{Failure, Of};
use crate::options::{bounds, seconds, tolerance};
use crate::progress::{watched, within_time};
use crate::report::bounds::{Proven, stop_word};
use crate::sink::print_told;
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::solid::Source;
use crate::words::{count, number, put_line};
use clap::Args;
use leafless::lattice::MAX_DEPTH;
use leafless::query::{OneWay, StopReason, Within};
use leafless::{Affine, Control, Deviation, Frame, Interval, deviation};
use serde::Serialize;
use std::ffi::OsString;

/// Prints the greatest distance of a point of one boundary from the nearest point of the other boundary, in
/// both directions: as intervals that contain the true numbers, and with the points at which they occur. The
/// greater one is the Hausdorff distance of the boundaries.
///
/// Closed meshes whose triangles do not intersect are compared as they are, up to rounding. For all other
/// inputs, cells are split as far as the tolerance demands. With --within the exit code is 0 if the
/// boundaries are proven to be within that distance of each other, and otherwise 1, with the reason. Unknown
/// numbers are null in JSON.
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
    /// Tell whether the boundaries are within this distance of each other, in model units
    #[arg(long, value_name = "D", value_parser = tolerance, allow_hyphen_values = true)]
    within: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Greatest width of the intervals, in model units [default: a ten-thousandth of the edge of the cube
    /// that is examined]
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Finest level of cells, 1 to 20 [default: that of the solid from a file (.lfl), or 20]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Take the cells of solids from files (.lfl) as the solids themselves, whatever the cells prove about
    /// their source
    #[arg(long)]
    cells: bool,
    /// Time limit in seconds: the command then ends with the bounds found so far. The result then depends on
    /// the machine
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    seconds: Option<f64>,
    /// Most cells of a solid to split [default: 262144, or no limit with --seconds]
    #[arg(long, value_name = "N")]
    splits: Option<u64>,
    /// Lower corner and edge length of the cube to examine [default: the cube around both]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    taking: Taking,
}

/// Tolerance without --tolerance, relative to the cube's edge.
const FINE: f64 = 1e-4;

/// One direction; null where unknown.
#[derive(Serialize)]
struct Way {
    lower: Option<f64>,
    upper: Option<f64>,
    /// A point near the first boundary, a bound of its distance from it, and the nearest point of the other
    /// boundary.
    point: Option<[f64; 3]>,
    apart: Option<f64>,
    nearest: Option<[f64; 3]>,
}

impl From<&OneWay> for Way {
    fn from(way: &OneWay) -> Way {
        let finite = |end: f64| end.is_finite().then_some(end);
        Way {
            lower: finite(way.distance.lower),
            upper: finite(way.distance.upper),
            point: way.at.map(|at| at.point),
            apart: way.at.map(|at| at.apart),
            nearest: way.at.map(|at| at.nearest),
        }
    }
}

#[derive(Serialize)]
struct Report {
    a: String,
    b: String,
    /// With --within: "within", "beyond" or "undecided"; otherwise null.
    verdict: Option<&'static str>,
    within: Option<f64>,
    /// The greater distance of both directions.
    lower: Option<f64>,
    upper: Option<f64>,
    a_to_b: Way,
    b_to_a: Way,
    /// The reason why the search ended.
    measured: &'static str,
    tolerance: f64,
    proof_a: Proven,
    proof_b: Proven,
    splits_a: u64,
    splits_b: u64,
    cuts_a: u64,
    cuts_b: u64,
    depth: u8,
    origin: [f64; 3],
    edge: f64,
    /// True if a solid may extend beyond the cube that was examined.
    clipped_a: bool,
    clipped_b: bool,
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
    let frame = match &arguments.bounds {
        Some(bounds) => bounds.with_depth(arguments.depth.unwrap_or(MAX_DEPTH)).of(a)?,
        None => {
            let both = (first.bounds(a)?, second.bounds(b)?);
            let around = if first.ends_at_bounds(a)? && second.ends_at_bounds(b)? {
                Frame::fitted
            } else {
                Frame::around
            };
            let is_moved = !placement.is_identity();
            let own = first.own_frame().or_else(|| if is_moved { None } else { second.own_frame() });
            let depth = arguments.depth.or(if own.is_some() { None } else { Some(MAX_DEPTH) });
            common_frame(own, both, &[placement], depth, around).of(a)?
        }
    };
    let first = first.placed(a, &Affine::IDENTITY, &frame)?;
    let second = second.placed(b, &placement, &frame)?;
    let tolerance = arguments.tolerance.unwrap_or(FINE * frame.edge());
    let found = watched("deviation", 0, |control| {
        let control = Control { max_splits: arguments.splits, ..*control };
        let ask = |control: &Control<'_>| deviation(&first, &second, &frame, tolerance, control);
        within_time(arguments.seconds, &control, ask, |found| found.stop_reason != StopReason::Budget)
    });
    let found = found.of(a)?;
    let report = Report::new(&inputs, &frame, &found, tolerance, arguments.within);
    print_told(arguments.json, &report, |report| text(&found, report))?;
    let Some(distance) = arguments.within.map(number) else { return Ok(()) };
    match report.verdict {
        Some("within") => Ok(()),
        Some("beyond") => Err(Failure::of(b, format!("is not within {distance} of {a}"))),
        _ => Err(Failure::of(b, format!("is not proven to be within {distance} of {a}"))),
    }
}

impl Report {
    fn new(
        [a, b]: &[Input; 2],
        frame: &Frame,
        found: &Deviation,
        tolerance: f64,
        within: Option<f64>,
    ) -> Report {
        let finite = |end: f64| end.is_finite().then_some(end);
        let distance = found.distance();
        Report {
            a: a.to_string(),
            b: b.to_string(),
            verdict: within.map(|within| match found.within(within) {
                Within::Yes => "within",
                Within::No => "beyond",
                Within::Undecided => "undecided",
            }),
            within,
            lower: finite(distance.lower),
            upper: finite(distance.upper),
            a_to_b: (&found.a_to_b).into(),
            b_to_a: (&found.b_to_a).into(),
            measured: stop_word(found.stop_reason),
            tolerance,
            proof_a: found.proofs[0].into(),
            proof_b: found.proofs[1].into(),
            splits_a: found.splits[0],
            splits_b: found.splits[1],
            cuts_a: found.cuts[0],
            cuts_b: found.cuts[1],
            depth: frame.depth(),
            origin: frame.origin(),
            edge: frame.edge(),
            clipped_a: found.clipped[0],
            clipped_b: found.clipped[1],
        }
    }
}

/// Returns the report for people.
fn text(found: &Deviation, report: &Report) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| put_line(&mut text, name, &value);
    let far = |distance: Interval| {
        // A solid without a boundary is infinitely far.
        if distance.lower == f64::INFINITY {
            "there is nothing to be near to".into()
        } else {
            distance.to_string()
        }
    };
    if let Some(verdict) = report.verdict {
        line("verdict", verdict.into());
    }
    let ended = if found.stop_reason == StopReason::Budget { " (as far as the splits go)" } else { "" };
    line("distance", format!("{}{ended}", far(found.distance())));
    let point = |point: [f64; 3]| point.map(number).join(" ");
    for (name, way) in [("a to b", &found.a_to_b), ("b to a", &found.b_to_a)] {
        let at = way.at.map(|at| format!(", at {}; {} is nearest", point(at.point), point(at.nearest)));
        line(name, format!("{}{}", far(way.distance), at.unwrap_or_default()));
    }
    for (input, proven) in [(&report.a, &report.proof_a), (&report.b, &report.proof_b)] {
        if let Some(doubt) = proven.doubt() {
            line("proven", format!("of {input}: {doubt}"));
        }
    }
    line("splits", format!("{} and {}", count(report.splits_a), count(report.splits_b)));
    if report.clipped_a || report.clipped_b {
        line("bounds", "a solid may go on outside of the cube that was looked at".into());
    }
    text
}
