//! `leafless info`: what a solid or a mesh consists of.

use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::mesh::{self, Reading};
use crate::output;
use crate::report::Info;
use clap::Args;
use leafless::file;
use std::ffi::OsString;

/// Of a solid only the file's header and level table are read, so this takes the same short time for files of
/// any size. Run `leafless verify` to know whether the rest of the file is good.
///
/// Of a mesh everything is read: what its triangles bound, and what is wrong with them.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl) or mesh (STL, OBJ, PLY, OFF, 3MF), or `-` for standard input
    file: OsString,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    reading: Reading,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    // A damaged solid is not to be taken for some mesh.
    let is_solid = input.path().is_some_and(|path| path.extension().is_some_and(|name| name == "lfl"));
    let (octree, bytes) = if is_solid || input.begins_as_solid() {
        input.octree(false)?
    } else {
        let bytes = input.read()?;
        if !bytes.starts_with(&file::MAGIC) && arguments.reading.format_of(&input, &bytes).is_some() {
            let length = bytes.len() as u64;
            let mesh = arguments.reading.mesh(&input, bytes)?;
            return mesh::tell(&input, &mesh, length, arguments.json);
        }
        (file::from_bytes(&bytes).of(&input)?, bytes.len() as u64)
    };
    let info = Info::new(&octree, bytes);
    let text = if arguments.json { output::json(&info)? } else { info.text() };
    output::print(text.as_bytes())
}
