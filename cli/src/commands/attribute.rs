//! `leafless attribute`: a channel of values inside a solid.

use crate::failure::{Failure, Of};
use crate::options::{list, threads};
use crate::progress::watched;
use crate::report::channel::ChannelInfo;
use crate::sink::Output;
use crate::source::expression::{Expressions, SYNTAX};
use crate::source::input::Input;
use crate::source::values::{Values, find};
use crate::source::volume::Sampling;
use crate::words::{count, seconds};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use leafless::attribute::{
    CarryRule, Channel, ChannelOperand, ConstantAttribute, Criterion, Detail, FillOptions, Interpolation,
    ScalarType, ValueType, carry_channel, fill_channel,
};
use leafless::lattice::MAX_DEPTH;
use leafless::{Control, Octree};
use serde::Serialize;
use std::ffi::OsString;
use std::time::Instant;

/// Gives a solid a channel: a value of one to four numbers at every point inside. The values come from a
/// function, a volume, a mesh or a channel of another solid, and are taken at the centres of cells. Equal
/// neighbours are stored as one. The channel is stored in the solid's file, and the Boolean commands carry it
/// along.
///
/// Without --tolerance every cell of the channel's finest level gets its own value, unless a larger cell is
/// proven to have one value. With --coarse, --fine and --tolerance, cells are split as far as the values
/// demand it.
#[derive(Args)]
#[command(group = clap::ArgGroup::new("values").required(true).args(["from", "bodies", "expr", "value", "remove"]))]
pub struct Arguments {
    /// Solid (.lfl)
    file: OsString,
    /// Name of the channel. An existing channel of this name is replaced, or changed with --in
    #[arg(long, value_name = "NAME")]
    name: String,
    /// Take the values from this file: the samples of a volume (NRRD, MetaImage, raw), the colours or
    /// materials of a mesh (3MF, PLY) at the nearest point of its surface, or the channel of the same name of
    /// another solid (.lfl)
    #[arg(long, value_name = "FILE")]
    from: Option<OsString>,
    /// Take the values from a function of x, y and z; given up to four times, once for each number of a value
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true, long_help = expression_help())]
    expr: Vec<String>,
    /// Take one value everywhere: one to four numbers
    #[arg(long, value_name = "V,…", value_parser = numbers, allow_hyphen_values = true)]
    value: Option<Numbers>,
    /// Take the number of the nearest body of this mesh (STL, OBJ, PLY, OFF, 3MF). Bodies are counted from 0,
    /// in the order of their first triangles
    #[arg(long, value_name = "MESH")]
    bodies: Option<OsString>,
    /// Remove the channel
    #[arg(long)]
    remove: bool,
    /// File to write, or `-` for standard output [default: the solid's own file]
    #[arg(short, long, value_name = "OUT.lfl")]
    output: Option<OsString>,
    /// Change an existing channel, and only inside this solid (.lfl), which must lie in the same cube
    #[arg(long = "in", value_name = "REGION.lfl", conflicts_with = "remove")]
    region: Option<OsString>,
    /// Keep values outside the solid, too
    #[arg(long)]
    everywhere: bool,
    /// Which values of the mesh of --from to take [default: those of the channel's name, or the only ones]
    #[arg(long, value_name = "NAME", requires = "from")]
    pick: Option<String>,
    /// Take the sample of the nearest voxel of a volume, without interpolation
    #[arg(long, requires = "from")]
    nearest: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Levels of the channel's cells, 1 to 20 [default: those of the solid, or 8 if its cells keep surfaces]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Split cells until the values in a cell are proven to differ by no more than this, in each number;
    /// where nothing is proven, down to the edge --fine
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Longest edge of a cell inside the solid, in the solid's units [default: no limit]
    #[arg(long, value_name = "EDGE", requires = "tolerance", allow_hyphen_values = true)]
    coarse: Option<f64>,
    /// Edge at which cells are no longer split, in the solid's units [default: the edge of the finest cells]
    #[arg(long, value_name = "EDGE", requires = "tolerance", allow_hyphen_values = true)]
    fine: Option<f64>,
    /// Compare only the values at the eight corners of a cell, as in the published method: their standard
    /// deviation must be no more than the tolerance. Details between the corners are missed
    #[arg(long, requires = "tolerance")]
    corners: bool,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Type in which numbers are stored [default: f32, or the type of the channel that is copied or changed]
    #[arg(long, value_parser = scalars(), value_name = "TYPE", help_heading = "Stored with the values")]
    store: Option<ScalarType>,
    /// Unit of the values: a text
    #[arg(long, value_name = "TEXT", help_heading = "Stored with the values")]
    unit: Option<String>,
    /// What the values mean: a text, such as colour, density or material
    #[arg(long, value_name = "TEXT", help_heading = "Stored with the values")]
    meaning: Option<String>,
    #[command(flatten)]
    sampling: Sampling,
}

fn expression_help() -> String {
    format!(
        "Take the values from a function of x, y and z; given up to four times, once for each number of a value.\n\nA function consists of {SYNTAX}. A point at which it is not defined has no value"
    )
}

#[derive(Debug, Clone)]
struct Numbers(Vec<f64>);

fn numbers(text: &str) -> Result<Numbers, String> {
    let numbers = list(text).filter(|numbers| (1..=4).contains(&numbers.len()));
    numbers.map(Numbers).ok_or_else(|| "expected one to four numbers between commas".into())
}

fn scalars() -> impl TypedValueParser<Value = ScalarType> {
    const KINDS: [ScalarType; 4] = [ScalarType::U8, ScalarType::U16, ScalarType::U32, ScalarType::F32];
    PossibleValuesParser::new(KINDS.map(ScalarType::name))
        .try_map(|name| KINDS.into_iter().find(|kind| kind.name() == name).ok_or("is no type of numbers"))
}

#[derive(Serialize)]
struct Report {
    output: String,
    channel: Option<ChannelInfo>,
    bytes: u64,
    seconds: f64,
}

/// Depth of a new channel of a solid whose cells keep surfaces, without --depth.
const DEPTH: u8 = 8;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let input = Input::from(&*arguments.file);
    let output = Output::from(arguments.output.as_deref().unwrap_or(&arguments.file));
    output.check()?;
    let (octree, _) = input.octree(true)?;
    let changed = if arguments.remove {
        find(&octree, &input, Some(&arguments.name))?;
        octree.without_channel(&arguments.name)
    } else {
        octree.with_channel(made(arguments, &input, &octree)?)
    };
    let changed = changed.of(&input)?;
    let bytes = output.save(&changed)?;
    let report = Report {
        output: output.to_string(),
        channel: changed.channel(&arguments.name).map(ChannelInfo::new),
        bytes,
        seconds: start.elapsed().as_secs_f64(),
    };
    output.tell(arguments.json, &report, Report::text)
}

impl Report {
    fn text(&self) -> String {
        let channel = self.channel.as_ref().map_or_else(|| "channel removed".into(), ChannelInfo::text);
        format!("{}: {channel}; {} bytes, in {}\n", self.output, count(self.bytes), seconds(self.seconds))
    }
}

fn made(arguments: &Arguments, input: &Input, octree: &Octree) -> Result<Channel, Failure> {
    let old = match &arguments.region {
        Some(_) => Some(find(octree, input, Some(&arguments.name))?),
        None => None,
    };
    let values = values(arguments, octree)?;
    let kind = arguments.store.or(values.kind);
    let own_depth = match octree.view().cuts() {
        // The solid's own cells end at any size, and its frame is as deep as possible.
        Some(_) => DEPTH.min(octree.frame().depth()),
        None => octree.frame().depth(),
    };
    let (kind, depth) = match old {
        Some(old) => (old.value_type().scalar(), arguments.depth.unwrap_or(old.frame().depth())),
        None => (kind.unwrap_or(ScalarType::F32), arguments.depth.unwrap_or(own_depth)),
    };
    let frame = octree.frame().with_depth(depth).of(input)?;
    let value_type = ValueType::new(kind, values.attribute.components() as u8).of(input)?;
    let options = FillOptions {
        value_type,
        frame,
        solid: if arguments.everywhere { None } else { Some(octree.view()) },
        detail: detail(arguments, frame.cell_size())?,
    };
    let fill = |control: &Control<'_>| fill_channel(&*values.attribute, &options, control);
    let channel = watched("attribute", arguments.threads, fill);
    let channel = channel.map_err(|error| refused(&error, input, &arguments.name, kind))?;
    let (channel, mut metadata) = match (old, &arguments.region) {
        (Some(old), Some(region)) => {
            let region = Input::from(&**region);
            let (inside, _) = region.octree(true)?;
            let changed = watched("attribute", arguments.threads, |control| {
                let all = Octree::uniform(*octree.frame(), leafless::Tag::Full, leafless::Tag::Empty)?;
                let operands = [
                    ChannelOperand { solid: inside.view(), channel: channel.view()? },
                    ChannelOperand { solid: all.view(), channel: old.view()? },
                ];
                carry_channel(octree.view(), &operands, CarryRule::Left, control)
            });
            (changed.of(&region)?, old.metadata().clone())
        }
        _ => (channel, values.metadata),
    };
    metadata.insert("name", &*arguments.name);
    for (key, value) in [("unit", &arguments.unit), ("meaning", &arguments.meaning)] {
        if let Some(value) = value {
            metadata.insert(key, &**value);
        }
    }
    Ok(channel.with_metadata(metadata))
}

fn refused(error: &str, input: &Input, name: &str, kind: ScalarType) -> Failure {
    if error.contains("the channel's type") {
        let problem = format!(
            "a value of {name} is infinite, or beyond the range of {}: choose another function or --store",
            kind.name()
        );
        return Failure::of(input, problem);
    }
    Failure::of(input, error)
}

fn detail(arguments: &Arguments, cell: f64) -> Result<Option<Detail>, Failure> {
    let Some(tolerance) = arguments.tolerance else { return Ok(None) };
    let criterion = if arguments.corners { Criterion::Variance } else { Criterion::Range };
    let fine = arguments.fine.unwrap_or(cell);
    let coarse = arguments.coarse.unwrap_or(f64::INFINITY);
    let detail = Detail::new(coarse, fine, tolerance, criterion);
    detail.map(Some).map_err(|error| Failure::Usage(error.to_string()))
}

fn values(arguments: &Arguments, octree: &Octree) -> Result<Values, Failure> {
    if let Some(Numbers(numbers)) = &arguments.value {
        let constant = ConstantAttribute::new(numbers).map_err(|error| Failure::Usage(error.to_string()))?;
        return Ok(Values::plain(Box::new(constant)));
    }
    if let Some(bodies) = &arguments.bodies {
        return Values::of_bodies(&Input::from(&**bodies), octree);
    }
    let Some(from) = &arguments.from else {
        let expressions = Expressions::parse(&arguments.expr).map_err(Failure::Usage)?;
        return Ok(Values::plain(Box::new(expressions)));
    };
    let Arguments { name, pick, sampling, nearest, .. } = arguments;
    let interpolation = if *nearest { Interpolation::Nearest } else { Interpolation::Trilinear };
    Values::of_file(&Input::from(&**from), name, pick.as_deref(), sampling, interpolation, octree)
}
