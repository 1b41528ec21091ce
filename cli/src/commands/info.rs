//! `leafless info`: what a solid, a mesh or a scene consists of.

use crate::failure::{Failure, Of};
use crate::report::dexels;
use crate::report::octree::Info;
use crate::sink;
use crate::source::content::Content;
use crate::source::input::Input;
use crate::source::mesh::{self, Reading};
use crate::source::scene::{self, Drawing};
use clap::Args;
use leafless::file;
use std::ffi::OsString;

/// Of a solid only the file's header and level table are read, so this takes the same short time for files of
/// any size. Run `leafless verify` to know whether the rest of the file is good. Of a tri-dexel model (.lfl) all
/// intervals are read.
///
/// Of a mesh everything is read: what its triangles bound, and what is wrong with them. Of a scene the bounds
/// are told, how its curves are drawn, and what is wrong with the meshes in it; `leafless measure` tells its volume.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-` for standard input
    file: OsString,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    drawing: Drawing,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    let (octree, bytes) = if input.begins_as_solid() {
        arguments.reading.refuse(&input, "a solid")?;
        arguments.drawing.refuse(&input, "a solid")?;
        if let Some((model, length)) = input.dexels(false)? {
            return dexels::tell(&model, length, arguments.json);
        }
        input.octree(false)?
    } else {
        let bytes = input.read()?;
        let length = bytes.len() as u64;
        match Content::of(&input, &bytes, arguments.reading.told())? {
            Content::Solid => {
                arguments.reading.refuse(&input, "a solid")?;
                arguments.drawing.refuse(&input, "a solid")?;
                if file::probe_bytes(&bytes).is_ok_and(|probe| probe.dexels.is_some()) {
                    return dexels::tell(
                        &file::dexels::from_bytes(&bytes).of(&input)?,
                        length,
                        arguments.json,
                    );
                }
                (file::from_bytes(&bytes).of(&input)?, length)
            }
            Content::Scene => {
                arguments.reading.refuse(&input, "a scene")?;
                return scene::tell(&input, &bytes, &arguments.drawing, arguments.json);
            }
            Content::Volume => {
                arguments.drawing.refuse(&input, "a volume")?;
                return arguments.reading.volume(&input, &bytes)?.tell(arguments.json);
            }
            Content::Mesh => {
                arguments.drawing.refuse(&input, "a mesh")?;
                let mesh = arguments.reading.mesh(&input, bytes)?;
                let fill = arguments.reading.fill(mesh.format);
                mesh::check_closed(&input, &mesh.mesh, fill)?;
                return mesh::tell(&input, &mesh, fill, length, arguments.json);
            }
        }
    };
    let info = Info::new(&octree, bytes);
    let text = if arguments.json { sink::json(&info)? } else { info.text() };
    sink::print(text.as_bytes())
}
