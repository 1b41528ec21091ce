//! `leafless measure`: volume, centroid, inertia and bounds of a solid.

use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::mesh::Reading;
use crate::output::{self, count, measured};
use crate::progress::watched;
use crate::report::{Proven, Volume, stop_word};
use crate::scene::{Curves, Drawing};
use crate::source::{Source, evaluations};
use crate::voxelize::{bounds, threads};
use clap::Args;
use leafless::{
    Affine, Control, Extent, Frame, Interval, MAX_DEPTH, MassProperties, Prepared, StopReason, bounding_box,
    measure,
};
use serde::Serialize;
use std::ffi::OsString;
use std::fmt::Write;

/// Measures a solid of density 1 without making an octree of it: the largest undecided cells are split first,
/// until the volume is known well enough. All numbers are intervals that hold the true ones.
///
/// A solid from a file (.lfl) knows no more about its undecided cells, so its own bounds are told, as well as
/// it was made; a mesh or a scene is split as deep as it takes.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF) or scene (.csg), or `-` for standard input
    file: OsString,
    /// How wide the interval of the volume may be, relative to its middle; 0 goes on to the depth. Without
    /// it: 0.01, or 0 if --splits is given
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Cells to split at most
    #[arg(long, value_name = "N")]
    splits: Option<u64>,
    /// Deepest level to split to, 1 to 20. Without it: as deep as the solid is, or 20 for a mesh or scene
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Lower corner and edge length of the cube to measure in, for a mesh or scene. Without it: the cube
    /// around it
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    /// Take the cells of a solid from a file (.lfl) for the solid itself, whatever they prove of what they
    /// were made from
    #[arg(long)]
    cells: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    drawing: Drawing,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(tolerance) if tolerance >= 0.0 && f64::is_finite(tolerance) => Ok(tolerance),
        _ => Err("expected a number not below 0".into()),
    }
}

/// Sides of the bounding box are told to this part of the universe's edge, unless a greater tolerance is
/// asked for.
const SIDES: f64 = 0.001;

/// Lower and upper bounds of the elements of a vector or a matrix.
#[derive(Serialize)]
struct Bounds<T> {
    lower: T,
    upper: T,
}

impl From<[Interval; 3]> for Bounds<[f64; 3]> {
    fn from(vector: [Interval; 3]) -> Bounds<[f64; 3]> {
        Bounds { lower: vector.map(|x| x.lower), upper: vector.map(|x| x.upper) }
    }
}

impl From<[[Interval; 3]; 3]> for Bounds<[[f64; 3]; 3]> {
    fn from(matrix: [[Interval; 3]; 3]) -> Bounds<[[f64; 3]; 3]> {
        let of = |end: fn(Interval) -> f64| matrix.map(|row| row.map(end));
        Bounds { lower: of(|x| x.lower), upper: of(|x| x.upper) }
    }
}

#[derive(Serialize)]
struct Report {
    input: String,
    volume: Volume,
    /// What of the solid is proven; what is not counts as undecided.
    proof: Proven,
    /// Absent (null) if nothing is proven to be inside.
    centroid: Option<Bounds<[f64; 3]>>,
    /// About the centroid.
    inertia: Bounds<[[f64; 3]; 3]>,
    inertia_about_origin: Bounds<[[f64; 3]; 3]>,
    /// Corners of the bounding box; absent (null) if the solid is proven empty.
    min: Option<Bounds<[f64; 3]>>,
    max: Option<Bounds<[f64; 3]>>,
    /// Why it ended.
    measured: &'static str,
    /// Without those for the bounding box.
    splits: u64,
    evaluations: u64,
    level: u8,
    depth: u8,
    origin: [f64; 3],
    edge: f64,
    clipped: bool,
    /// How the curves of a scene were drawn; else absent (null).
    curves: Option<Curves>,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    let source = Source::read(&input, &arguments.reading, &arguments.drawing)?.taken(arguments.cells);
    if let (Some(_), Some(_)) = (source.own_frame(), &arguments.bounds) {
        return Err(Failure::Usage("--bounds is for meshes and scenes: a solid has its own".into()));
    }
    let curves = source.curves();
    let is_stored = source.own_frame().is_some();
    let frame = match (&arguments.bounds, arguments.depth) {
        (Some(bounds), depth) => bounds.with_depth(depth.unwrap_or(MAX_DEPTH)).of(&input)?,
        (None, depth) => source.frame(&input, depth)?,
    };
    let solid = Prepared::new(source.placed(&input, &Affine::IDENTITY, &frame)?);
    let tolerance = arguments.tolerance.unwrap_or(if arguments.splits.is_some() { 0.0 } else { 0.01 });
    let found = watched("measure", arguments.threads, |control| {
        let control = Control { max_splits: arguments.splits, ..*control };
        let mass = measure(&solid, &frame, tolerance, &control)?;
        let evaluated = evaluations(solid.solid());
        let quiet = Control { progress: None, ..control };
        let extent = bounding_box(&solid, &frame, tolerance.max(SIDES) * frame.edge(), &quiet)?;
        Ok((mass, extent, evaluated))
    });
    let (mass, extent, evaluated) = found.of(&input)?;
    let text = if arguments.json {
        output::json(&Report { curves, ..report(&input, &frame, &mass, &extent, evaluated) })?
    } else {
        text(&mass, &extent, curves.as_ref(), is_stored)
    };
    output::print(text.as_bytes())
}

fn report(input: &Input, frame: &Frame, mass: &MassProperties, extent: &Extent, evaluations: u64) -> Report {
    Report {
        input: input.to_string(),
        volume: mass.volume.into(),
        proof: mass.proof.into(),
        centroid: mass.centroid.map(Into::into),
        inertia: mass.inertia_about_centroid.into(),
        inertia_about_origin: mass.inertia_about_origin.into(),
        min: extent.corners.map(|[min, _]| min.into()),
        max: extent.corners.map(|[_, max]| max.into()),
        measured: stop_word(mass.stop_reason),
        splits: mass.splits,
        evaluations,
        level: mass.level,
        depth: frame.depth(),
        origin: frame.origin(),
        edge: frame.edge(),
        clipped: mass.clipped,
        curves: None,
    }
}

/// The same for people.
fn text(mass: &MassProperties, extent: &Extent, curves: Option<&Curves>, is_stored: bool) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{name:<16}{value}");
    };
    line("volume", measured(mass.volume));
    if let Some(doubt) = Proven::from(mass.proof).doubt() {
        line("proven", doubt);
    }
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        if let Some(centroid) = mass.centroid {
            line(&format!("centroid {name}"), measured(centroid[axis]));
        }
    }
    for (name, tensor) in
        [("inertia", &mass.inertia_about_centroid), ("about origin", &mass.inertia_about_origin)]
    {
        for (i, j, axes) in
            [(0, 0, "xx"), (1, 1, "yy"), (2, 2, "zz"), (0, 1, "xy"), (0, 2, "xz"), (1, 2, "yz")]
        {
            line(&format!("{name} {axes}"), measured(tensor[i][j]));
        }
    }
    if let Some([min, max]) = extent.corners {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            line(&format!("least {name}"), measured(min[axis]));
            line(&format!("greatest {name}"), measured(max[axis]));
        }
    }
    if let Some(curves) = curves.and_then(Curves::text) {
        line("curves", curves);
    }
    let ended = match (mass.stop_reason, is_stored) {
        (StopReason::Tolerance, _) => "",
        (StopReason::Budget, _) => ", which were all that may be split",
        (StopReason::Exhausted, true) => ", and the file knows no more",
        (StopReason::Exhausted, false) => ", and there is nothing left to split at this depth",
    };
    line("splits", format!("{}, to level {}{ended}", count(mass.splits), mass.level));
    if mass.clipped {
        line("clipped", "this is the part inside of the bounds; the solid may go on outside".into());
    }
    text
}
