//! `leafless csg`: from a scene to a solid.

use crate::commands::conversion;
use crate::failure::{Failure, Of, complain};
use crate::options::{RuleName, bounds, name_of, threads};
use crate::progress::watched;
use crate::report::octree::Info;
use crate::sink::{self, Output};
use crate::source::input::Input;
use crate::source::scene::{Curves, Drawing, frame_of, read_scene};
use crate::words::{count, number, seconds};
use clap::{Args, ValueEnum};
use leafless::{Adaptive, Frame, Metadata, Octree, SplitCounter, Touch, build};
use serde::Serialize;
use std::ffi::OsString;
use std::time::Instant;

/// Splits space where the surface of a scene passes, down to cells of 2^-N of its extent. By the certified
/// rule every cell is proven inside, proven outside, or undecided.
///
/// A scene is a text in the language of the CSG dumps that OpenSCAD writes (`openscad -o part.csg
/// part.scad`): group union difference intersection multmatrix color render cube sphere cylinder polyhedron
/// linear_extrude rotate_extrude square circle polygon, import of meshes, and some of ours:
/// halfspace([a,b,c,d]) power([A,a,n1],[B,b,n2],[C,c,n3],R) quadric([10 numbers]) torus(major,minor)
/// mesh("file.stl") octree("file.lfl"). Curved surfaces are exact, but for those with a $fn of 12 or less, which
/// are the prisms and pyramids that OpenSCAD draws: --fn exact or --fn polygon decides for all.
///
/// The file records the scene's name, length and checksum, and the rule. Equal input gives equal bytes, for
/// any number of threads.
#[derive(Args)]
pub struct Arguments {
    /// Scene (.csg), or `-` for standard input
    #[arg(value_name = "SCENE")]
    input: OsString,
    /// File to write, or `-` for standard output, whose summary then goes to standard error; it is written
    /// whole or not at all
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// Levels of the octree, 1 to 20: each halves the cells, and the error, and makes the file some four
    /// times as long
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=leafless::MAX_DEPTH as i64))]
    depth: u8,
    /// What becomes of the finest cells that the surface passes through
    #[arg(long, value_enum, default_value_t = RuleName::Certified)]
    rule: RuleName,
    /// Leave cells whole in which the surface is known to lie within a layer of this thickness, in the units of
    /// the scene: flat faces take few cells, curves more, and edges as many as the depth allows. Such cells are
    /// undecided
    #[arg(long, value_name = "T", value_parser = thickness, allow_hyphen_values = true)]
    adaptive: Option<f64>,
    /// What counts as touching
    #[arg(long, value_enum, default_value_t = TouchName::Exact)]
    touch: TouchName,
    /// Lower corner and edge length of the cube to cut into cells, in the units of the scene. Solids can be
    /// combined if they were given the same bounds and depth. What sticks out is cut off, and reported.
    /// Without it: a cube around the scene whose edge and cells are powers of two, so that faces at round
    /// numbers lie between cells; if the scene's bounds are no round numbers, the cube around their middle, its
    /// edge 33/32 of their longest extent
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    drawing: Drawing,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Print one JSON object with timings, splits, evaluations of half-spaces and the volume, level by level
    /// (on standard error if the solid goes to standard output)
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// What `leafless convert` asks for.
    pub fn converting(wanted: &conversion::Arguments) -> Arguments {
        Arguments {
            input: wanted.input.clone(),
            output: wanted.output.clone(),
            depth: wanted.depth(),
            rule: wanted.resolve.map_or(RuleName::Certified, RuleName::from),
            adaptive: None,
            touch: TouchName::Exact,
            bounds: wanted.bounds,
            drawing: wanted.drawing.clone(),
            threads: wanted.threads,
            json: wanted.json,
        }
    }
}

fn thickness(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(thickness) if thickness >= 0.0 && f64::is_finite(thickness) => Ok(thickness),
        _ => Err("expected a length not below 0".into()),
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum TouchName {
    /// Contact is not overlap: a cell that the solid touches from outside is empty
    Exact,
    /// As in the paper that the method comes from: such a cell is undecided
    Paper,
}

/// Seconds.
#[derive(Serialize)]
struct Timings {
    read: f64,
    build: f64,
    save: f64,
    total: f64,
}

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    rule: String,
    touch: String,
    /// The thickness of layers that are not split; absent (null) if all are.
    adaptive: Option<f64>,
    timings: Timings,
    /// Cells that were split; null if there are meshes or octrees in the scene, which work in bulk.
    splits: Option<u64>,
    /// Half-spaces that were evaluated, at a point or over a box.
    evaluations: u64,
    /// Volume of the undecided cells.
    undecided_volume: f64,
    /// How the curves of the scene were drawn.
    curves: Curves,
    #[serde(flatten)]
    info: Info,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    output.check()?;
    if arguments.adaptive.is_some() {
        let useless = match (arguments.rule, arguments.touch) {
            (RuleName::Certified, TouchName::Exact) => None,
            (RuleName::Certified, TouchName::Paper) => Some("--touch paper, by which no layers are known"),
            _ => Some("a --rule but certified: the cells that it leaves whole are undecided"),
        };
        if let Some(useless) = useless {
            return Err(Failure::Usage(format!("--adaptive does not go with {useless}")));
        }
    }
    if let (Some(from), Some(to)) = (input.path(), output.path())
        && from.canonicalize().is_ok_and(|from| to.canonicalize().is_ok_and(|to| from == to))
    {
        return Err(Failure::of(&output, "is the scene itself, which is not overwritten"));
    }
    let (scene, source) = read_scene(&input, &arguments.drawing)?;
    let frame = frame_of(&input, &scene, arguments.bounds.as_ref(), arguments.depth)?;
    let touch = match arguments.touch {
        TouchName::Exact => Touch::Exact,
        TouchName::Paper => Touch::Paper,
    };
    let solid = scene.solid(&frame).of(&input)?.with_touch(touch);
    // To count splits turns off what meshes and octrees do in bulk.
    let counted = (solid.nesting() == 0).then(|| SplitCounter::new(solid.clone()));
    let read = start.elapsed().as_secs_f64();

    let building = Instant::now();
    let rule = arguments.rule.into();
    let octree = watched("csg", arguments.threads, |control| match (&counted, arguments.adaptive) {
        (Some(counted), Some(t)) => build(&Adaptive::new(counted, t)?, &frame, rule, control),
        (Some(counted), None) => build(counted, &frame, rule, control),
        (None, Some(t)) => build(&Adaptive::new(&solid, t)?, &frame, rule, control),
        (None, None) => build(&solid, &frame, rule, control),
    });
    let octree = octree.of(&input)?.with_metadata(facts(&input, source, arguments));
    let build = building.elapsed().as_secs_f64();

    let saving = Instant::now();
    let bytes = output.save(&octree)?;
    let save = saving.elapsed().as_secs_f64();

    if octree.view().is_clipped() {
        let warning = "the solid may go on outside of the bounds, where it was cut off";
        complain(&format!("{input}: warning: {warning}"));
    }
    let mut info = Info::new(&octree, bytes);
    let splits = counted.as_ref().map(SplitCounter::splits);
    if let Some(splits) = &splits {
        info.note_splits(splits);
    }
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        rule: name_of(arguments.rule),
        touch: name_of(arguments.touch),
        adaptive: arguments.adaptive,
        timings: Timings { read, build, save, total: start.elapsed().as_secs_f64() },
        splits: splits.map(|splits| splits.iter().sum()),
        evaluations: solid.evaluations(),
        undecided_volume: info.volume.width(),
        curves: scene.report().into(),
        info,
    };
    output.report(&if arguments.json { sink::json(&report)? } else { summary(&report, &octree) })
}

/// What the solid's file says of its making: nothing that differs from run to run.
fn facts(input: &Input, source: String, arguments: &Arguments) -> Metadata {
    let mut metadata = Metadata::new();
    if let Some(stem) = input.path().and_then(|path| path.file_stem()) {
        metadata.insert("name", stem.to_string_lossy());
    }
    metadata.insert("source", source);
    metadata.insert("rule", name_of(arguments.rule));
    if let Some(thickness) = arguments.adaptive {
        metadata.insert("adaptive", number(thickness));
    }
    if let TouchName::Paper = arguments.touch {
        metadata.insert("touch", name_of(arguments.touch));
    }
    metadata
}

fn summary(report: &Report, octree: &Octree) -> String {
    let (frame, info) = (octree.frame(), &report.info);
    let [read, build, save, total] =
        [report.timings.read, report.timings.build, report.timings.save, report.timings.total].map(seconds);
    format!(
        "{}: {} octree of depth {}, cells of {}\n\
         volume  {}{}\n\
         {}\
         splits  {}{} evaluations of half-spaces\n\
         nodes   {} (a classical octree has {})\n\
         bytes   {}{}\n\
         time    {total}: read {read}, build {build}, save {save}\n",
        report.output,
        report.rule,
        frame.depth(),
        number(frame.cell_size()),
        info.volume_text(),
        info.volume_note(),
        report.curves.text().map_or(String::new(), |curves| format!("curves  {curves}\n")),
        report.splits.map_or(String::new(), |splits| count(splits) + ", "),
        count(report.evaluations),
        count(info.nodes),
        count(info.classical_nodes),
        count(info.bytes),
        info.bytes_per_node.map_or(String::new(), |each| format!(", {each:.2} a node")),
    )
}
