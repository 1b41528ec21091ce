//! `leafless within`: the part of a solid in a ball, a box or another solid.

use crate::failure::{Failure, Of};
use crate::options::{bounds, numbers};
use crate::progress::watched;
use crate::report::bounds::Volume;
use crate::sink::print_told;
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::solid::Source;
use crate::words::{count, number};
use clap::Args;
use leafless::lattice::MAX_DEPTH;
use leafless::query::{CellsIn, cells_in, volume_in};
use leafless::{Affine, AnySolid, Control, Csg, Error, Frame, Interval, Octree};
use serde::Serialize;
use std::ffi::OsString;

/// Counts the finest cells of a solid that lie in a ball, a box or another solid, and bounds the volume that
/// both have in common. No octree of the solid is made.
///
/// Each number is a certain and a possible one. A cell that the boundary of the region cuts may lie in it, so
/// the counts hold for cells that lie in the region completely, whose centre lies in it, or that only meet
/// it. The cells of a solid from a file (.lfl) are taken as they are, FULL or PARTIAL.
#[derive(Args)]
#[command(group = clap::ArgGroup::new("region").required(true))]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-` for
    /// standard input. The moves --translate, --rotate, --scale and --place apply to it, not to the region
    file: OsString,
    /// The region is a ball: its centre and its radius
    #[arg(long, group = "region", value_name = "X,Y,Z,R", value_parser = ball, allow_hyphen_values = true)]
    ball: Option<Csg>,
    /// The region is a box: its lower and its upper corner
    #[arg(long = "box", group = "region", value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = cuboid, allow_hyphen_values = true)]
    cuboid: Option<Csg>,
    /// The region is the solid, mesh, scene or volume in this file
    #[arg(long = "in", group = "region", value_name = "FILE")]
    other: Option<OsString>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Level of the cells, 1 to 20 [default: the depth of the solid, or 8 for a mesh or scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Take the cells of a region from a file (.lfl) as the region itself, whatever the cells prove about
    /// their source; with --depth, also those of the solid
    #[arg(long)]
    cells: bool,
    /// Most cells to split, of both, for each of the two answers. Cells that are not split are not certain
    #[arg(long, default_value_t = SPLITS, value_name = "N")]
    splits: u64,
    /// Lower corner and edge length of the cube of cells, for a mesh or scene [default: the cube around it]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    taking: Taking,
}

/// Splits that take about a second.
const SPLITS: u64 = 1 << 20;
/// Levels of cells of shapes without cells.
const DEPTH: u8 = 8;

fn ball(text: &str) -> Result<Csg, String> {
    match numbers(text) {
        Some([x, y, z, radius]) => Csg::ball([x, y, z], radius).map_err(|error| error.to_string()),
        None => Err("expected four numbers: x,y,z,radius".into()),
    }
}

fn cuboid(text: &str) -> Result<Csg, String> {
    match numbers(text) {
        Some([a, b, c, x, y, z]) => Csg::cuboid([a, b, c], [x, y, z]).map_err(|error| error.to_string()),
        None => Err("expected six numbers: x0,y0,z0,x1,y1,z1".into()),
    }
}

/// A certain and a possible number.
#[derive(Serialize)]
struct Range {
    least: u64,
    most: u64,
}

impl Range {
    fn text(&self) -> String {
        let Range { least, most } = *self;
        if least == most { count(least) } else { format!("{} to {}", count(least), count(most)) }
    }
}

#[derive(Serialize)]
struct Cells {
    /// FULL cells.
    full: Range,
    /// FULL and PARTIAL cells.
    upper: Range,
}

#[derive(Serialize)]
struct Report {
    input: String,
    region: String,
    cells: Cells,
    volume: Volume,
    depth: u8,
    origin: [f64; 3],
    edge: f64,
}

/// The solid: an octree is queried about its own cells, other solids about those of a frame.
enum Subject {
    Octree(Box<Octree>),
    Solid(AnySolid),
}

impl Subject {
    fn ask(
        &self,
        region: &AnySolid,
        frame: &Frame,
        control: &Control<'_>,
    ) -> Result<(CellsIn, Interval), Error> {
        Ok(match self {
            Subject::Octree(octree) => {
                (octree.cells_in(region, control)?, octree.volume_in(region, control)?)
            }
            Subject::Solid(solid) => {
                (cells_in(solid, region, frame, control)?, volume_in(solid, region, frame, control)?)
            }
        })
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    let source = Source::read(&input, &arguments.taking)?.taken(arguments.cells);
    let frame = source.frame_to(&input, arguments.bounds.as_ref(), arguments.depth, DEPTH)?;
    let (region, name) = region(arguments, &frame)?;
    let subject = match source {
        Source::Octree(octree) if arguments.depth.is_none() && octree.view().cuts().is_none() => {
            Subject::Octree(octree)
        }
        source => Subject::Solid(source.placed(&input, &Affine::IDENTITY, &frame)?),
    };
    let found = watched("within", 1, |control| {
        subject.ask(&region, &frame, &Control { max_splits: Some(arguments.splits), ..*control })
    });
    let (cells, volume) = found.of(&input)?;
    let cells = Cells {
        full: Range { least: cells.full_least, most: cells.full_most },
        upper: Range { least: cells.upper_least, most: cells.upper_most },
    };
    let report = Report {
        input: input.to_string(),
        region: name,
        cells,
        volume: volume.into(),
        depth: frame.depth(),
        origin: frame.origin(),
        edge: frame.edge(),
    };
    print_told(arguments.json, &report, |Report { cells, .. }| {
        format!(
            "FULL cells      {}\nor PARTIAL      {}\nof edge         {}\nvolume          {}\n",
            cells.full.text(),
            cells.upper.text(),
            number(frame.cell_size()),
            volume,
        )
    })
}

/// Returns the region, and its name.
fn region(arguments: &Arguments, frame: &Frame) -> Result<(AnySolid, String), Failure> {
    if let Some(ball) = &arguments.ball {
        return Ok((AnySolid::new(ball.clone()), "ball".into()));
    }
    if let Some(cuboid) = &arguments.cuboid {
        return Ok((AnySolid::new(cuboid.clone()), "box".into()));
    }
    let Some(other) = &arguments.other else {
        return Err(Failure::Usage("one of --ball, --box and --in is needed".into()));
    };
    let input = Input::from(&**other);
    let source = Source::read(&input, &arguments.taking.unmoved())?.taken(arguments.cells);
    Ok((source.placed(&input, &Affine::IDENTITY, frame)?, input.to_string()))
}
