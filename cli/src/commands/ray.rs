//! `leafless ray`: the first hits of rays.

use crate::failure::{Failure, Of};
use crate::progress::watched;
use crate::rows::{Questions, serve};
use crate::sink::{self, print};
use crate::source::input::Input;
use crate::source::target::{Looking, Target};
use crate::words::number;
use clap::{Args, ValueEnum};
use leafless::lattice::MAX_DEPTH;
use leafless::query::{Obstacle, RayHit};
use leafless::{Control, Error, Ray, cast_rays};
use serde::Serialize;
use std::ffi::OsString;
use std::fmt::Write;

/// Reads rays from standard input, one a line: the x, y and z of a point in the solid's units, and of a
/// direction of any length, separated by blanks, tabs or commas. Empty lines and lines that begin with # are
/// skipped.
///
/// Prints one line for each ray: `miss`, or a lower and an upper bound of the first hit, in lengths of the
/// direction, and the outward normal there (0 0 0 if the ray starts in the cell that stops it). Before the
/// lower bound the ray is proven to be outside, at the upper bound it is proven to be inside. The upper bound
/// is `inf` if the ray is nowhere proven to be inside. Answers are printed as soon as lines arrive, so that
/// another program can ask and wait.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage)
    file: OsString,
    /// What stops a ray
    #[arg(long, value_enum, default_value_t = On::Upper)]
    on: On,
    /// Print one line of JSON for each ray: an object, or `null` for a miss. `surface` is the number of the
    /// triangle of a mesh that is hit, counted from 0. It is `null` at a hole, for a ray that starts inside,
    /// and for inputs that do not answer rays themselves
    #[arg(long)]
    json: bool,
    /// Finest level to which cells that a ray meets are split, 1 to 20 [default: the depth of the solid, or
    /// 20 for a mesh or scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Most cells to split for a ray: a ray along a surface would take a million. Bounds are wider in cells
    /// that are left unsplit
    #[arg(long, value_name = "N", default_value_t = 1 << 14)]
    splits: u64,
    #[command(flatten)]
    looking: Looking,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum On {
    /// Cells that are proven to be solid
    Full,
    /// Cells that may be solid, so that a miss is proven
    Upper,
}

impl From<On> for Obstacle {
    fn from(on: On) -> Obstacle {
        match on {
            On::Full => Obstacle::Full,
            On::Upper => Obstacle::Upper,
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::file(&arguments.file, "rays")?;
    let target = arguments.looking.target(&input, arguments.depth, MAX_DEPTH)?;
    serve(&mut Batch { input, target, arguments, rays: Vec::new(), text: String::new() })
}

fn cast(
    target: &Target,
    rays: &[Ray],
    on: Obstacle,
    control: &Control<'_>,
) -> Result<Vec<Option<RayHit>>, Error> {
    match target {
        Target::Cells(octree) => {
            let mut hits = vec![None; rays.len()];
            octree.cast_rays(rays, on, &mut hits)?;
            Ok(hits)
        }
        Target::Solid(target) => cast_rays(&target.0, &target.1, rays, on, control),
    }
}

/// Rays that are cast together.
struct Batch<'a> {
    input: Input,
    target: Target,
    arguments: &'a Arguments,
    rays: Vec<Ray>,
    text: String,
}

/// A hit; an infinite end is null.
#[derive(Serialize)]
struct Hit {
    t_lower: f64,
    t_upper: Option<f64>,
    normal: [f64; 3],
    level: u8,
    cell: [u32; 3],
    surface: Option<u32>,
}

impl Questions<6> for Batch<'_> {
    fn ask(&mut self, [x, y, z, dx, dy, dz]: [f64; 6]) -> Result<(), String> {
        self.rays.push(Ray::new([x, y, z], [dx, dy, dz]).map_err(|error| error.to_string())?);
        Ok(())
    }

    fn answer(&mut self) -> Result<(), Failure> {
        if self.rays.is_empty() {
            return Ok(());
        }
        let Batch { input, target, arguments, rays, text } = self;
        let hits = watched("ray", arguments.looking.threads, |control| {
            let control = Control { max_splits: Some(arguments.splits), ..*control };
            cast(target, rays, arguments.on.into(), &control)
        });
        rays.clear();
        text.clear();
        for hit in hits.of(input)? {
            if arguments.json {
                text.push_str(&json(hit)?);
            } else {
                plain(text, hit);
            }
        }
        print(text.as_bytes())
    }
}

fn json(hit: Option<RayHit>) -> Result<String, Failure> {
    sink::json_line(&hit.map(|RayHit { t, cell, normal, surface }| Hit {
        t_lower: t.lower,
        t_upper: t.upper.is_finite().then_some(t.upper),
        normal,
        level: cell.level,
        cell: cell.at,
        surface,
    }))
}

fn plain(text: &mut String, hit: Option<RayHit>) {
    let Some(RayHit { t, normal: [x, y, z], .. }) = hit else {
        text.push_str("miss\n");
        return;
    };
    let [lower, upper, x, y, z] = [t.lower, t.upper, x, y, z].map(number);
    // Writing to a string does not fail.
    let _ = writeln!(text, "{lower} {upper} {x} {y} {z}");
}
