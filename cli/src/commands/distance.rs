//! `leafless distance`: the distance of points from a solid.

use crate::failure::{Failure, Of};
use crate::options::tolerance;
use crate::progress::watched;
use crate::rows::{Questions, serve};
use crate::sink::{self, print};
use crate::source::input::Input;
use crate::source::target::{Looking, Target};
use crate::words::number;
use clap::{Args, ValueEnum};
use leafless::lattice::MAX_DEPTH;
use leafless::query::{DISTANCE_SPLITS, DistanceTo, distances};
use leafless::{Control, Error, Interval};
use serde::Serialize;
use std::ffi::OsString;
use std::fmt::Write;

/// Reads points from standard input, one a line: x, y and z in the solid's units, separated by blanks, tabs
/// or commas. Empty lines and lines that begin with # are skipped.
///
/// Prints one line for each point: a lower and an upper bound of its distance. The upper bound is `inf` where
/// nothing is proven to be solid; both are `inf` if it is proven that there is no solid. Answers are printed
/// as soon as lines arrive, so that another program can ask and wait.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage)
    file: OsString,
    /// What the distance is measured to
    #[arg(long, value_enum, default_value_t = To::Solid)]
    target: To,
    /// Distance from the boundary, negative inside: short for --target boundary
    #[arg(long, conflicts_with = "target")]
    signed: bool,
    /// Print one line of JSON for each point; infinite bounds are `null`
    #[arg(long)]
    json: bool,
    /// Greatest width of the interval, in the solid's units. Does not apply to a solid from a file (.lfl),
    /// whose cells give the bounds [default: a millionth of the edge of the cube that is examined]
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Finest level to which cells are split, 1 to 20 [default: the depth of the solid, or 20 for a mesh or
    /// scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Most cells to split for a point. Without a limit, a point that is about equally near to much of the
    /// surface would take very many
    #[arg(long, value_name = "N", default_value_t = DISTANCE_SPLITS)]
    splits: u64,
    #[command(flatten)]
    looking: Looking,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum To {
    /// The solid: 0 for points inside
    Solid,
    /// The complement of the solid: 0 for points outside
    Complement,
    /// The boundary: negative inside
    Boundary,
}

impl From<To> for DistanceTo {
    fn from(to: To) -> DistanceTo {
        match to {
            To::Solid => DistanceTo::Solid,
            To::Complement => DistanceTo::Complement,
            To::Boundary => DistanceTo::Boundary,
        }
    }
}

/// Tolerance without --tolerance, relative to the cube's edge.
const FINE: f64 = 1e-6;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::file(&arguments.file, "points")?;
    let target = arguments.looking.target(&input, arguments.depth, MAX_DEPTH)?;
    serve(&mut Batch { input, target, arguments, points: Vec::new(), text: String::new() })
}

/// Points that are answered together.
struct Batch<'a> {
    input: Input,
    target: Target,
    arguments: &'a Arguments,
    points: Vec<[f64; 3]>,
    text: String,
}

impl Batch<'_> {
    fn measure(&self, control: &Control<'_>) -> Result<Vec<Interval>, Error> {
        let Arguments { target: to, signed, tolerance, .. } = *self.arguments;
        let to = if signed { DistanceTo::Boundary } else { to.into() };
        match &self.target {
            Target::Cells(octree) => {
                let mut answers = vec![Interval::exactly(0.0); self.points.len()];
                octree.distances(&self.points, to, &mut answers, control)?;
                Ok(answers)
            }
            Target::Solid(target) => {
                let (solid, frame) = &**target;
                let tolerance = tolerance.unwrap_or(FINE * frame.edge());
                let control = Control { max_splits: Some(self.arguments.splits), ..*control };
                let found = distances(solid, frame, &self.points, to, tolerance, &control)?;
                Ok(found.into_iter().map(|found| found.distance).collect())
            }
        }
    }
}

/// An interval whose infinite ends are null.
#[derive(Serialize)]
struct Distance {
    lower: Option<f64>,
    upper: Option<f64>,
}

impl Questions<3> for Batch<'_> {
    fn ask(&mut self, point: [f64; 3]) -> Result<(), String> {
        self.points.push(point);
        Ok(())
    }

    fn answer(&mut self) -> Result<(), Failure> {
        if self.points.is_empty() {
            return Ok(());
        }
        let answers = watched("distance", self.arguments.looking.threads, |control| self.measure(control));
        self.points.clear();
        self.text.clear();
        for answer in answers.of(&self.input)? {
            let (lower, upper) = (answer.lower, answer.upper);
            if self.arguments.json {
                let [lower, upper] = [lower, upper].map(|end| end.is_finite().then_some(end));
                self.text.push_str(&sink::json_line(&Distance { lower, upper })?);
            } else {
                // Writing to a string does not fail.
                let _ = writeln!(self.text, "{} {}", number(lower), number(upper));
            }
        }
        print(self.text.as_bytes())
    }
}
