//! `leafless voxels`: the voxels of a solid as records, and records as a solid.

use crate::failure::{Failure, Of};
use crate::memory;
use crate::progress::watched;
use crate::sink::Output;
use crate::sink::csv;
use crate::sink::records::{npz, records};
use crate::source::input::Input;
use crate::source::solid::cells_of;
use crate::source::target::{Looking, Target};
use crate::source::values::find;
use crate::words::count;
use clap::{Args, ValueEnum};
use leafless::attribute::{Attribute, Criterion, Detail};
use leafless::lattice::MAX_DEPTH;
use leafless::voxel::{
    VoxelBoundary, VoxelKind, VoxelOptions, VoxelRecords, VoxelRecordsRef, VoxelTriangles,
};
use leafless::{Octree, Tag, TriangleMesh, exchange};
use serde::Serialize;
use std::ffi::OsString;
use std::path::Path;

/// Writes the voxels of a solid as records, sorted by linear octree code: inside voxels, boundary voxels, and
/// others on request.
///
/// In the text form (.csv) each record is one line: its kind, its level, its code, its minimum corner and its
/// edge. The code has one octal digit for each level of the lattice; only as many digits count as the level
/// says. The binary form (.npz, for NumPy) has the arrays `codes`, `levels`, `kinds` (0 outside, 1 inside, 2
/// boundary, 3 refined), `corners`, `origin`, `edge`, `depth`, `exterior`, `proof`, `boundary` and `seal`;
/// `values` if there are values; `triangle_offsets` and `triangles` if there are triangles.
///
/// The solid that --import makes proves what the records prove: inside voxels prove the inside; outside
/// voxels, and places without a record, prove the outside. If boundary voxels become inside or outside, that
/// side is no longer proven, except for the boundary voxels of a solid in which all cells are decided, which
/// are inside. Records that were changed after they were written prove nothing; `seal` detects the change.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-` for
    /// standard input; with --import, records (.npz)
    file: OsString,
    /// File to write, with the extension .npz or .csv; with --import a solid (.lfl)
    #[arg(short, long, value_name = "OUTPUT")]
    output: OsString,
    /// Channel of the solid whose values are listed and which inside voxels follow [default: the only one, if
    /// there is one]
    #[arg(long, value_name = "NAME", conflicts_with = "import")]
    channel: Option<String>,
    /// Add to each boundary voxel the triangles of this mesh that meet it, counted from 0
    #[arg(long, value_name = "MESH")]
    triangles: Option<OsString>,
    /// List outside voxels, too
    #[arg(long)]
    outside: bool,
    /// List refined voxels, too, each before the voxels that it consists of
    #[arg(long)]
    refined: bool,
    /// Make a solid from records
    #[arg(long, conflicts_with_all = ["write", "coarse", "fine", "tolerance", "boundary_depth", "outside", "refined",
        "boundary", "triangles", "depth", "bounds", "format", "unit", "to", "translate", "rotate", "scale", "place", "fill", "facets", "threshold", "extents",
        "kind", "spacing", "corner", "skip", "big_endian"])]
    import: bool,
    /// What boundary voxels become in the solid
    #[arg(long, value_enum, default_value_t = BecomeName::Partial, requires = "import")]
    boundary_as: BecomeName,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Level of the cells, 1 to 20 [default: the depth of the solid, or 7 for a mesh or scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Which voxels are boundary voxels [default: touching for a solid in which all cells are decided,
    /// otherwise undecided]
    #[arg(long, value_enum)]
    boundary: Option<BoundaryName>,
    /// Level of boundary voxels, 0 to 20 [default: that of the solid's finest cells]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=MAX_DEPTH as i64))]
    boundary_depth: Option<u8>,
    /// Longest edge of inside voxels, in the solid's units [default: that of the solid's cells]
    #[arg(long, value_name = "EDGE", value_parser = length)]
    coarse: Option<f64>,
    /// Edge below which inside voxels are not split, in the solid's units, whatever the channel's values are
    #[arg(long, value_name = "EDGE", value_parser = length, requires = "tolerance")]
    fine: Option<f64>,
    /// Greatest change of the channel's value in an inside voxel that is longer than --fine
    #[arg(long, value_name = "NUMBER", requires = "fine")]
    tolerance: Option<f64>,
    /// Compare only the values at the eight corners of a voxel, as in the published method: their standard
    /// deviation must be no more than the tolerance. Details between the corners are missed
    #[arg(long, requires = "tolerance")]
    corners: bool,
    #[command(flatten)]
    looking: Looking,
    /// Form to write [default: by the extension of the output]
    #[arg(long, value_enum)]
    write: Option<WriteName>,
}

/// Depth of meshes and scenes without --depth.
const DEPTH: u8 = 7;

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum WriteName {
    Npz,
    Csv,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum BoundaryName {
    /// Undecided cells: those that the surface may pass through
    Undecided,
    /// Also inside cells that touch an outside one
    Touching,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum BecomeName {
    /// Undecided
    Partial,
    /// Inside
    Full,
    /// Outside
    Empty,
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(length) if length > 0.0 && f64::is_finite(length) => Ok(length),
        _ => Err("must be a positive number".into()),
    }
}

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    records: u64,
    inside: u64,
    boundary: u64,
    outside: u64,
    refined: u64,
    /// Levels of the lattice: digits of a code.
    depth: u8,
    /// Number of pairs of a boundary voxel and a triangle.
    #[serde(skip_serializing_if = "Option::is_none")]
    triangles: Option<u64>,
    bytes: u64,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (input, output) = (Input::from(&*arguments.file), Output::from(&*arguments.output));
    output.check()?;
    if arguments.import { import(arguments, &input, &output) } else { list(arguments, &input, &output) }
}

/// Returns the attribute that inside voxels follow, and whose values records have.
fn attribute(
    arguments: &Arguments,
    input: &Input,
    octree: &Octree,
) -> Result<Option<Box<dyn Attribute>>, Failure> {
    if arguments.channel.is_none() && octree.channels().len() != 1 {
        return Ok(None);
    }
    let channel = find(octree, input, arguments.channel.as_deref())?;
    Ok(Some(Box::new(channel.clone())))
}

fn list(arguments: &Arguments, input: &Input, output: &Output) -> Result<(), Failure> {
    let form = form(arguments, output.path())?;
    let mesh = arguments.triangles.as_deref().map(|name| mesh(&Input::from(name))).transpose()?;
    let looking = &arguments.looking;
    let (target, proof) = looking.target_and_proof(input, arguments.depth, DEPTH)?;
    let octree = match target {
        Target::Cells(octree) => *octree,
        Target::Solid(target) => watched("voxelize", looking.threads, |control| {
            let (solid, frame) = &*target;
            cells_of(solid, solid.solid().get::<Octree>(), frame, control)
        })
        .of(input)?,
    };
    // Even with --cells, records prove no more than the cells proved in their file.
    let octree = octree.with_proof(octree.proof().and(proof));
    let attribute = attribute(arguments, input, &octree)?;
    let options = options(arguments, &octree, attribute.is_some())?;
    let listed = watched("voxels", looking.threads, |control| {
        let records = VoxelRecords::of(octree.view(), &options, attribute.as_deref(), control)?;
        let triangles = mesh.map(|mesh| records.view().triangles(&mesh, control)).transpose()?;
        Ok((records, triangles))
    });
    let (records, triangles) = listed.of(input)?;
    let (view, triangles) = (records.view(), triangles.as_ref());
    let bytes = match form {
        WriteName::Csv => output.stream(|out| csv::write(&view, triangles, out))?,
        WriteName::Npz => {
            memory::afford_file((records.bytes_each() as u64 + 24) * view.len() as u64).of(output)?;
            let bytes = npz(&view, triangles);
            output.write(&bytes)?;
            bytes.len() as u64
        }
    };
    report(arguments, input, output, &view, triangles, bytes)
}

fn import(arguments: &Arguments, input: &Input, output: &Output) -> Result<(), Failure> {
    let bytes = input.read()?;
    let records = records(&bytes).of(input)?;
    let boundary = match arguments.boundary_as {
        BecomeName::Partial => Tag::Partial,
        BecomeName::Full => Tag::Full,
        BecomeName::Empty => Tag::Empty,
    };
    let octree =
        watched("import", arguments.looking.threads, |control| records.view().to_octree(boundary, control));
    let saved = output.save(&octree.of(input)?)?;
    report(arguments, input, output, &records.view(), None, saved)
}

fn report(
    arguments: &Arguments,
    input: &Input,
    output: &Output,
    view: &VoxelRecordsRef<'_>,
    triangles: Option<&VoxelTriangles>,
    bytes: u64,
) -> Result<(), Failure> {
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        records: view.len() as u64,
        inside: view.count(VoxelKind::Inside),
        boundary: view.count(VoxelKind::Boundary),
        outside: view.count(VoxelKind::Outside),
        refined: view.count(VoxelKind::Refined),
        depth: view.frame().depth(),
        triangles: triangles.map(|found| found.triangles().len() as u64),
        bytes,
    };
    output.tell(arguments.json, &report, Report::text)
}

impl Report {
    fn text(&self) -> String {
        let kinds = [
            (self.inside, "inside"),
            (self.boundary, "boundary"),
            (self.outside, "outside"),
            (self.refined, "refined"),
        ];
        let told = kinds.iter().filter(|(number, _)| *number > 0);
        let told: Vec<String> = told.map(|(number, name)| format!("{} {name}", count(*number))).collect();
        let triangles = self.triangles.map_or(String::new(), |n| format!(", {} triangles in them", count(n)));
        let kinds = if told.is_empty() { "none".into() } else { told.join(", ") };
        format!("{}: {} voxels ({kinds}){triangles}\n", self.output, count(self.records))
    }
}

/// Returns the form to write.
fn form(arguments: &Arguments, path: Option<&Path>) -> Result<WriteName, Failure> {
    if let Some(name) = arguments.write {
        return Ok(name);
    }
    let extension = path.and_then(|path| path.extension()).and_then(|extension| extension.to_str());
    match extension {
        Some(extension) if extension.eq_ignore_ascii_case("npz") => Ok(WriteName::Npz),
        Some(extension) if extension.eq_ignore_ascii_case("csv") => Ok(WriteName::Csv),
        _ => Err(Failure::Usage(
            "the output has neither of the extensions .npz and .csv: name the form with --write".into(),
        )),
    }
}

/// Returns the options for the voxels to list.
fn options(arguments: &Arguments, octree: &Octree, has_attribute: bool) -> Result<VoxelOptions, Failure> {
    let refused = |error: leafless::Error| Failure::Usage(error.to_string());
    if arguments.tolerance.is_some() && !has_attribute {
        return Err(Failure::Usage(
            "--tolerance is for solids with a channel: name it with --channel".into(),
        ));
    }
    let touching = match arguments.boundary {
        Some(name) => name == BoundaryName::Touching,
        None => octree.view().is_binary(),
    };
    let boundary = if touching { VoxelBoundary::Touching } else { VoxelBoundary::Undecided };
    let mut options =
        VoxelOptions::new().boundary(boundary).outside(arguments.outside).refined(arguments.refined);
    if let Some(depth) = arguments.boundary_depth {
        options = options.boundary_depth(depth);
    }
    let detail = match (arguments.coarse, arguments.fine.zip(arguments.tolerance)) {
        (None, None) => None,
        (Some(coarse), None) => Some(Detail::uniform(coarse).map_err(refused)?),
        (coarse, Some((fine, tolerance))) => {
            let criterion = if arguments.corners { Criterion::Variance } else { Criterion::Range };
            let coarse = coarse.unwrap_or(f64::INFINITY);
            Some(Detail::new(coarse, fine, tolerance, criterion).map_err(refused)?)
        }
    };
    Ok(match detail {
        Some(detail) => options.detail(detail),
        None => options,
    })
}

/// Reads a mesh as it is in its file.
fn mesh(input: &Input) -> Result<TriangleMesh, Failure> {
    let bytes = input.read()?;
    let read = exchange::read_mesh(&bytes, &exchange::MeshOptions::default()).of(input)?;
    Ok(read.mesh)
}
