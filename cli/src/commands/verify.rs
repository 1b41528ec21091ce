//! `leafless verify`: is a file good?

use crate::failure::{Failure, Of};
use crate::report::dexels;
use crate::sink::print;
use crate::source::input::Input;
use crate::words::count;
use clap::Args;
use leafless::{Octree, file};
use std::ffi::OsString;

/// Checks every checksum, the order and the links of all nodes, that the tree is in canonical form, and that
/// the level table describes it; of a tri-dexel model the order of all intervals. The exit code is 0 if the file is good and 1, with the reason, if it is not.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), or `-` for standard input
    file: OsString,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    let good = |what: String| print(format!("{input}: good: {what}\n").as_bytes());
    if let Some((model, bytes)) = input.dexels(true)? {
        return good(dexels::summary(&model, bytes));
    }
    if input.path().is_none_or(|path| !path.is_file()) {
        // What comes through a pipe can be read once.
        let bytes = input.read()?;
        if file::probe_bytes(&bytes).is_ok_and(|probe| probe.dexels.is_some()) {
            let model = file::dexels::from_bytes(&bytes).of(&input)?;
            return good(dexels::summary(&model, bytes.len() as u64));
        }
        return good(summary(&file::from_bytes(&bytes).of(&input)?, bytes.len() as u64));
    }
    let (octree, bytes) = input.octree(true)?;
    good(summary(&octree, bytes))
}

fn summary(octree: &Octree, bytes: u64) -> String {
    let (depth, nodes) = (octree.frame().depth(), octree.statistics().nodes());
    format!("depth {depth}, {} nodes, {} bytes", count(nodes), count(bytes))
}
