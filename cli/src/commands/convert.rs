//! `leafless convert`: from each kind of solid to the others. Other subcommands do the work.

use crate::commands::conversion::{Arguments, KindName};
use crate::commands::voxelize;
use crate::commands::{csg, dexelize, mesh};
use crate::failure::{Failure, Of};
use crate::progress::watched;
use crate::report::octree::Info;
use crate::sink::{self, Output};
use crate::source::content::Content;
use crate::source::input::Input;
use crate::words::{count, counted, seconds};
use leafless::exchange::MeshFormat;
use leafless::{Metadata, TriDexel, octree_of_dexels};
use serde::Serialize;
use std::time::Instant;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    match kind(arguments, &output)? {
        KindName::Mesh => mesh::run(&mesh::Arguments::converting(arguments)),
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
    /// Intervals that hold no centre of a cell, and are lost.
    without_centres: u64,
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
    let (time, without_centres) = (start.elapsed().as_secs_f64(), model.view().without_centres());
    if arguments.json {
        let (input, output_name) = (input.to_string(), output.to_string());
        let report = Report { input, output: output_name, seconds: time, without_centres, info };
        return output.report(&sink::json(&report)?);
    }
    let lost = match without_centres {
        0 => String::new(),
        lost => format!("; {} between the centres of cells not seen", counted(lost, "interval", "intervals")),
    };
    output.report(&format!(
        "{output}: octree of depth {}, volume {}, {}, {} bytes, in {}{lost}\n",
        octree.frame().depth(),
        info.volume_text(),
        counted(info.nodes, "node", "nodes"),
        count(bytes),
        seconds(time),
    ))
}
