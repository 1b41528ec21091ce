//! `leafless convert`: from each kind of solid to the others. Other subcommands do the work.

use crate::content::Content;
use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::mesh::Reading;
use crate::output::{self, Output, count, counted, seconds};
use crate::progress::watched;
use crate::report::Info;
use crate::scene::Drawing;
use crate::voxelize::{self, bounds, threads};
use crate::{csg, dexelize, surface};
use clap::{Args, ValueEnum};
use leafless::exchange::MeshFormat;
use leafless::{Frame, Metadata, TriDexel, octree_of_dexels};
use serde::Serialize;
use std::ffi::OsString;
use std::time::Instant;

/// Makes an octree, a tri-dexel model or a triangle mesh of any of them, or of a scene or a volume, as
/// `leafless voxelize`, `csg`, `dexelize` and `mesh` do where nothing more is asked for.
///
/// Of a tri-dexel model an octree has the cells whose centres lie inside. Of an octree a tri-dexel model has just
/// the cells, exactly; undecided ones count as --resolve says. An octree of a mesh or a scene is certified, and its
/// undecided cells stay so without --resolve.
#[derive(Args)]
// Of meshes, `--to` says the unit everywhere else.
#[command(mut_arg("to", |unit| unit.long("to-unit")))]
pub struct Arguments {
    /// Octree or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-`
    /// for standard input
    #[arg(value_name = "FILE")]
    pub input: OsString,
    /// File to write, or `-` for standard output; it is written whole or not at all
    #[arg(short, long, value_name = "OUT")]
    pub output: OsString,
    /// What to make. The extension .ply, .stl, .obj, .off or .3mf of the output says that it is a mesh; .lfl says nothing,
    /// as octrees and tri-dexel models both have it
    #[arg(id = "target", long = "to", value_enum, value_name = "KIND")]
    pub kind: Option<KindName>,
    /// What cells count as that the surface passes through, or that are undecided
    #[arg(long, value_enum)]
    pub resolve: Option<ResolveName>,
    /// Cells to an axis of the cube around a mesh or scene, a power of two. Without it: 256, and of a volume the voxels
    #[arg(long, value_name = "N", value_parser = dexelize::resolution)]
    pub resolution: Option<u8>,
    /// Lower corner and edge length of the cube, for a mesh or scene. Without it: the cube around it
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    pub bounds: Option<Frame>,
    #[command(flatten)]
    pub reading: Reading,
    #[command(flatten)]
    pub drawing: Drawing,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    pub threads: usize,
    /// Print one JSON object, that of the subcommand that does the work
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub enum KindName {
    /// An octree (.lfl)
    Octree,
    /// A tri-dexel model (.lfl)
    Dexels,
    /// A triangle mesh
    Mesh,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub enum ResolveName {
    /// Outside
    Inner,
    /// Inside
    Outer,
}

impl From<ResolveName> for voxelize::RuleName {
    fn from(name: ResolveName) -> voxelize::RuleName {
        match name {
            ResolveName::Inner => voxelize::RuleName::Inner,
            ResolveName::Outer => voxelize::RuleName::Outer,
        }
    }
}

/// The depth of meshes and scenes, if none is asked for.
const DEPTH: u8 = 8;

impl Arguments {
    /// The levels of an octree of a mesh or a scene.
    pub fn depth(&self) -> u8 {
        self.resolution.unwrap_or(DEPTH)
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    match kind(arguments, &output)? {
        KindName::Mesh => surface::run(&surface::Arguments::converting(arguments)),
        KindName::Dexels => dexelize::run(&dexelize::Arguments::converting(arguments)),
        KindName::Octree => to_octree(&input, &output, arguments),
    }
}

/// What to make.
fn kind(arguments: &Arguments, output: &Output) -> Result<KindName, Failure> {
    let extension = output.path().and_then(|path| path.extension()?.to_str());
    let is_mesh = extension.is_some_and(|extension| MeshFormat::from_extension(extension).is_some());
    match arguments.kind {
        None if is_mesh => Ok(KindName::Mesh),
        None => {
            let choices = "--to octree, --to dexels or --to mesh";
            let problem = "its name does not say what it is to be";
            Err(Failure::Usage(format!("{output}: {problem}: choose {choices}")))
        }
        Some(KindName::Octree | KindName::Dexels) if is_mesh => {
            let problem = "its name is that of a mesh, which neither an octree nor a tri-dexel model is";
            Err(Failure::Usage(format!("{output}: {problem}")))
        }
        Some(kind) => Ok(kind),
    }
}

fn to_octree(input: &Input, output: &Output, arguments: &Arguments) -> Result<(), Failure> {
    if input.path().is_none_or(|path| !path.is_file()) {
        let problem = "must be a regular file, because it is looked at first; `leafless voxelize` and `leafless csg` \
                       can read what comes through a pipe";
        return Err(Failure::of(input, problem));
    }
    if let Some((model, _)) = input.dexels(true)? {
        return of_dexels(&model, input, output, arguments);
    }
    if input.begins_as_solid() {
        // A damaged file is told to be damaged.
        input.octree(true)?;
        return Err(Failure::of(input, "is an octree already"));
    }
    match Content::of(input, &input.read()?, arguments.reading.told())? {
        Content::Scene => {
            arguments.reading.refuse(input, "a scene")?;
            csg::run(&csg::Arguments::converting(arguments))
        }
        Content::Mesh | Content::Volume | Content::Solid => {
            arguments.drawing.refuse(input, "no scene")?;
            voxelize::run(&voxelize::Arguments::converting(arguments))
        }
    }
}

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    seconds: f64,
    #[serde(flatten)]
    info: Info,
}

/// Makes the octree of a tri-dexel model.
fn of_dexels(model: &TriDexel, input: &Input, output: &Output, arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    output.check()?;
    arguments.reading.refuse(input, "a tri-dexel model")?;
    arguments.drawing.refuse(input, "a tri-dexel model")?;
    let given = [
        ("--resolve", arguments.resolve.is_some()),
        ("--resolution", arguments.resolution.is_some()),
        ("--bounds", arguments.bounds.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|option| option.1) {
        let problem = "is a tri-dexel model, whose cells are decided by their centres";
        return Err(Failure::Usage(format!("{option} is not for {input}: it {problem}")));
    }
    let octree =
        watched("convert", arguments.threads, |control| octree_of_dexels(model.view(), control)).of(input)?;
    let mut metadata = Metadata::common([model.metadata()]).of(input)?;
    metadata.insert("rule", "sampled");
    let octree = octree.with_metadata(metadata);
    let bytes = output.save(&octree)?;
    let info = Info::new(&octree, bytes);
    let time = start.elapsed().as_secs_f64();
    if arguments.json {
        let (input, output_name) = (input.to_string(), output.to_string());
        let report = Report { input, output: output_name, seconds: time, info };
        return output.report(&output::json(&report)?);
    }
    output.report(&format!(
        "{output}: octree of depth {}, volume {}, {}, {} bytes, in {}\n",
        octree.frame().depth(),
        info.volume_text(),
        counted(info.nodes, "node", "nodes"),
        count(bytes),
        seconds(time),
    ))
}
