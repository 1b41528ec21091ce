//! `leafless info`: the contents of a file.

use crate::failure::{Failure, Of};
use crate::progress::at_work;
use crate::report::fitness::Fitness;
use crate::report::{dexels, mesh, octree, scene, volume};
use crate::sink::print_told;
use crate::source::content::Content;
use crate::source::file::{Found, Stored, Taking};
use crate::source::input::Input;
use clap::Args;
use std::ffi::OsString;

/// For a solid, only the file's header and level table are read, so the command is quick for files of any
/// size. `leafless verify` checks the rest of the file. For a tri-dexel model (.lfl), all intervals are read.
///
/// For a mesh, everything is read: the report tells what its triangles bound and what is wrong with them. For
/// a scene, the report tells its bounds, how its curves are drawn, and what is wrong with the meshes in it;
/// `leafless measure` tells its volume.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-` for
    /// standard input
    file: OsString,
    /// Tell in one line whether a mesh is fit for printing and for making a solid: it is closed, all facets
    /// face outward, no triangles intersect, repeat others or have no thickness between them, and no edge has
    /// more than two triangles. The exit code is 0 if the mesh is fit; otherwise it is 1, and the reasons are
    /// printed
    #[arg(long)]
    check: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    taking: Taking,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (input, taking, as_json) = (&Input::from(&*arguments.file), &arguments.taking, arguments.json);
    let Taking { reading, drawing, placing } = taking;
    let found = Found::look(input, reading.told())?;
    let bytes = found.length();
    if arguments.check && found.content != Content::Mesh {
        let problem = "is not a mesh; `leafless verify` checks the file of a solid";
        return Err(Failure::Usage(format!("--check is for meshes: {input} {problem}")));
    }
    match found.content {
        Content::Solid => {
            taking.refuse(input, "a solid")?;
            placing.refuse(input, "the report describes the file; `leafless convert` makes a moved solid")?;
            match found.stored(false)? {
                (Stored::Octree(octree), bytes) => {
                    print_told(as_json, &octree::Info::new(&octree, bytes), octree::Info::text)
                }
                (Stored::Dexels(model), bytes) => {
                    print_told(as_json, &dexels::Info::new(&model, bytes), dexels::Info::text)
                }
            }
        }
        Content::Scene => {
            reading.refuse(input, "a scene")?;
            let info = scene::Info::new(input, &found.scene(drawing, placing)?, bytes)?;
            print_told(as_json, &info, scene::Info::text)
        }
        Content::Volume => {
            drawing.refuse(input, "a volume")?;
            print_told(as_json, &volume::Info::new(&found.volume(reading, placing)?), volume::Info::text)
        }
        Content::Mesh => {
            drawing.refuse(input, "a mesh")?;
            let (file, fill) = found.mesh(reading, placing)?;
            if arguments.check {
                let fitness = at_work("info", || Fitness::new(input, &file.mesh))?;
                return match (fitness.fit, as_json) {
                    (true, _) => print_told(as_json, &fitness, Fitness::text),
                    (false, true) => print_told(true, &fitness, Fitness::text)
                        .and_then(|()| Err(Failure::of(input, fitness.verdict()))),
                    (false, false) => Err(Failure::of(input, fitness.verdict())),
                };
            }
            let info = at_work("info", || mesh::Info::new(input, &file, fill, bytes))?;
            let report = file.mesh.report().of(input)?;
            print_told(as_json, &info, |info| info.text(&report))
        }
    }
}
