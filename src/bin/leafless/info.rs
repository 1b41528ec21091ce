//! `leafless info`: what a solid consists of.

use crate::failure::Failure;
use crate::input::Input;
use crate::output;
use crate::report::Info;
use clap::Args;
use std::ffi::OsString;

/// Only the file's header and level table are read, so this takes the same short time for files of any size. Run
/// `leafless verify` to know whether the rest of the file is good.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), or `-` for standard input
    file: OsString,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (octree, bytes) = Input::from(&*arguments.file).octree(false)?;
    let info = Info::new(&octree, bytes);
    let text = if arguments.json { output::json(&info)? } else { info.text() };
    output::print(text.as_bytes())
}
