//! `leafless voxelize`: from a mesh file to a solid.

use crate::commands::conversion;
use crate::failure::{Failure, Of, complain};
use crate::options::{RuleName, bounds, name_of, threads};
use crate::progress::watched;
use crate::report::octree::{Info, Mesh};
use crate::sink::{self, Output};
use crate::source::content::Content;
use crate::source::input::Input;
use crate::source::mesh::{Reading, check_closed, fill_name, format_name, frame_around, in_words, openness};
use crate::source::volume::Job;
use crate::words::{count, counted, number, seconds};
use clap::{Args, ValueEnum};
use leafless::exchange::{LengthUnit, MeshFile};
use leafless::{FillRule, Frame, MeshError, MeshReport, MeshSolid, Metadata, Octree, build};
use serde::Serialize;
use std::ffi::OsString;
use std::fmt::Write;
use std::time::Instant;

/// Cuts the space around a mesh into 2^N × 2^N × 2^N cells, of which only those near the surface are kept
/// apart. By the certified rule every cell is proven inside, proven outside, or undecided because the surface
/// may pass through it; no such cell is ever missed.
///
/// The mesh should be closed: every edge shared by an even number of triangles that face the same side. Where
/// it has holes, or facets that are turned round, the winding number decides what is inside, and cells near
/// them may stay undecided; a warning says so. Bodies may overlap. Vertices that differ by no more than
/// single precision can tell are joined, and it is reported how many.
///
/// The file records the input's name, length and checksum, the rule, and the unit if it is known. Equal input
/// gives equal bytes, for any number of threads.
#[derive(Args)]
pub struct Arguments {
    /// Mesh (STL, OBJ, PLY, OFF or 3MF) or volume (NRRD, MetaImage), or `-` for standard input
    #[arg(value_name = "MESH")]
    input: OsString,
    /// File to write, or `-` for standard output, whose summary then goes to standard error; it is written
    /// whole or not at all
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// Levels of the octree, 1 to 20: each halves the cells, and the error, and makes the file some four
    /// times as long. A volume can do without it: then its voxels are the finest cells
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=leafless::MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// What becomes of the finest cells that the surface passes through
    #[arg(long, value_enum, default_value_t = RuleName::Certified)]
    rule: RuleName,
    #[command(flatten)]
    reading: Reading,
    /// Lower corner and edge length of the cube to cut into cells, in the units of the mesh once it is
    /// converted and scaled. Solids can be combined if they were given the same bounds and depth. What sticks
    /// out is cut off, and reported. Without it: a cube around the mesh whose edge and cells are powers of two,
    /// so that faces at round numbers lie between cells; if the mesh's bounds are no round numbers, the cube
    /// around its middle, its edge 33/32 of its longest extent
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Print one JSON object with timings, counts, the mesh report and the volume (on standard error if the
    /// solid goes to standard output)
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// What `leafless convert` asks for.
    pub fn converting(wanted: &conversion::Arguments) -> Arguments {
        Arguments {
            input: wanted.input.clone(),
            output: wanted.output.clone(),
            depth: Some(wanted.depth()),
            rule: wanted.resolve.map_or(RuleName::Certified, RuleName::from),
            reading: wanted.reading.clone(),
            bounds: wanted.bounds,
            threads: wanted.threads,
            json: wanted.json,
        }
    }
}

/// Seconds.
#[derive(Serialize)]
struct Timings {
    /// Reading the mesh, welding and sewing it, checking that it is closed.
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
    fill: &'static str,
    format: &'static str,
    /// Absent (null) where nobody knows it.
    unit: Option<&'static str>,
    /// Objects of a 3MF that are no solids.
    skipped: u64,
    timings: Timings,
    /// Where the file departs from its format, though it could be read.
    warnings: Vec<String>,
    mesh: Mesh,
    /// Volume of the undecided cells.
    undecided_volume: f64,
    #[serde(flatten)]
    info: Info,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    output.check()?;
    if let (Some(from), Some(to)) = (input.path(), output.path())
        && from.canonicalize().is_ok_and(|from| to.canonicalize().is_ok_and(|to| from == to))
    {
        return Err(Failure::of(&output, "is the mesh itself, which is not overwritten"));
    }

    let bytes = input.read()?;
    if Content::of(&input, &bytes, arguments.reading.told())? == Content::Volume {
        let job = Job {
            bounds: arguments.bounds,
            depth: arguments.depth,
            rule: arguments.rule.into(),
            threads: arguments.threads,
            json: arguments.json,
        };
        return arguments.reading.volume(&input, &bytes)?.save(&input, &output, &job);
    }
    let Some(depth) = arguments.depth else {
        let problem =
            "the following required arguments were not provided: --depth <N> (see `leafless --help`)";
        return Err(Failure::Usage(problem.into()));
    };
    let (MeshFile { mesh, format, unit, skipped, warnings, .. }, source) =
        arguments.reading.read(&input, bytes)?;
    let fill = arguments.reading.fill(format);
    check_closed(&input, &mesh, fill)?;
    let mesh_report = mesh.report().of(&input)?;
    if mesh_report.triangles == 0 {
        return Err(Failure::of(&input, MeshError::Empty));
    }
    // The mesh is about to be taken over.
    let told = if arguments.json { Some(Mesh::new(&mesh).of(&input)?) } else { None };
    let (min, max) = mesh.bounds();
    let frame = match &arguments.bounds {
        Some(bounds) => bounds.with_depth(depth),
        None => frame_around(&mesh, depth),
    };
    let frame = frame.of(&input)?;
    let read = start.elapsed().as_secs_f64();

    let building = Instant::now();
    let solid = MeshSolid::new(mesh, fill).of(&input)?;
    let octree = watched("voxelize", arguments.threads, |control| {
        build(&solid, &frame, arguments.rule.into(), control)
    });
    let octree = octree.of(&input)?.with_metadata(facts(&input, source, arguments.rule, unit));
    let build = building.elapsed().as_secs_f64();

    let saving = Instant::now();
    let bytes = output.save(&octree)?;
    let save = saving.elapsed().as_secs_f64();

    if let Some(how) = openness(&mesh_report)
        && fill != FillRule::EvenOdd
    {
        let whole = "the mesh does not bound a solid";
        complain(&format!("{input}: warning: {whole}: {how}; the winding number decides what is inside"));
    }
    if octree.view().is_clipped() {
        complain(&format!("{input}: warning: {}", clipping(&frame, min, max)));
    }
    let timings = Timings { read, build, save, total: start.elapsed().as_secs_f64() };
    let info = Info::new(&octree, bytes);
    if let Some(mesh) = told {
        let report = Report {
            input: input.to_string(),
            output: output.to_string(),
            rule: name_of(arguments.rule),
            fill: fill_name(fill),
            format: format_name(format),
            unit: unit.map(LengthUnit::symbol),
            skipped,
            timings,
            warnings: in_words(&warnings),
            mesh,
            undecided_volume: info.volume.width(),
            info,
        };
        return output.report(&sink::json(&report)?);
    }
    let read = (&mesh_report, skipped);
    output.report(&summary(&input, &output, arguments.rule, read, &octree, &info, &timings))
}

/// What the solid's file says of its making: nothing that differs from run to run.
pub fn facts(input: &Input, source: String, rule: impl ValueEnum, unit: Option<LengthUnit>) -> Metadata {
    let mut metadata = Metadata::new();
    if let Some(stem) = input.path().and_then(|path| path.file_stem()) {
        metadata.insert("name", stem.to_string_lossy());
    }
    metadata.insert("source", source);
    metadata.insert("rule", name_of(rule));
    if let Some(unit) = unit {
        metadata.insert("units", unit.symbol());
    }
    metadata
}

/// Where the mesh sticks out of the bounds. If it does not, it is open, and what it encloses may.
pub fn clipping(frame: &Frame, min: [f64; 3], max: [f64; 3]) -> String {
    let mut text = String::new();
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let start = frame.origin()[axis];
        let end = start + frame.edge();
        if min[axis] < start || max[axis] > end {
            let [from, to, start, end] = [min[axis], max[axis], start, end].map(number);
            let _ = write!(text, "; {name} from {from} to {to}, bounds {start} to {end}");
        }
    }
    if text.is_empty() {
        return "what the open mesh encloses may go on outside of the bounds, where it was cut off".into();
    }
    format!("the mesh sticks out of the bounds and was cut off{text}")
}

fn summary(
    input: &Input,
    output: &Output,
    rule: RuleName,
    (mesh, skipped): (&MeshReport, u64),
    octree: &Octree,
    info: &Info,
    timings: &Timings,
) -> String {
    let mut text = format!(
        "{input}: {}, {}",
        counted(mesh.triangles, "triangle", "triangles"),
        counted(mesh.bodies, "body", "bodies"),
    );
    if mesh.degenerate > 0 {
        let _ =
            write!(text, ", {} dropped", counted(mesh.degenerate, "degenerate facet", "degenerate facets"));
    }
    if mesh.sewn > 0 {
        let moved = counted(mesh.sewn, "vertex", "vertices");
        let _ = write!(text, ", {moved} moved by {} or less to close hair cracks", number(mesh.displacement));
    }
    if skipped > 0 {
        let _ = write!(
            text,
            ", {} left out",
            counted(skipped, "object that is no solid", "objects that are no solids")
        );
    }
    let frame = octree.frame();
    let _ = write!(
        text,
        "\n{output}: {} octree of depth {}, cells of {}\n\
         volume  {}{}\n\
         nodes   {} (a classical octree has {})\n\
         bytes   {}",
        name_of(rule),
        frame.depth(),
        number(frame.cell_size()),
        info.volume_text(),
        info.volume_note(),
        count(info.nodes),
        count(info.classical_nodes),
        count(info.bytes),
    );
    if let Some(each) = info.bytes_per_node {
        let _ = write!(text, ", {each:.2} a node");
    }
    let Timings { read, build, save, total } = *timings;
    let [read, build, save, total] = [read, build, save, total].map(seconds);
    let _ = writeln!(text, "\ntime    {total}: read {read}, build {build}, save {save}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_four_numbers_that_make_a_frame() {
        let frame = bounds("-1, 2.5,3e1,4").unwrap();
        assert_eq!((frame.origin(), frame.edge()), ([-1.0, 2.5, 30.0], 4.0));
        for text in [
            "",
            "1,2,3",
            "1,2,3,4,5",
            "1,2,3,x",
            "0,0,0,0",
            "0,0,0,-1",
            "0,nan,0,1",
            "0,0,0,inf",
            "0,0,0,nan",
        ] {
            assert!(bounds(text).is_err(), "{text}");
        }
    }
}
