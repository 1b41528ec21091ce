//! `leafless verify`: a complete check of a file.

use crate::failure::Failure;
use crate::report::dexels;
use crate::sink::print;
use crate::source::file::Stored;
use crate::source::input::Input;
use crate::words::count;
use clap::Args;
use leafless::Octree;
use std::ffi::OsString;

/// Checks every checksum, the order and the links of all nodes, that the tree is in canonical form, and that
/// the level table describes it. For a tri-dexel model it checks the order of all intervals.
///
/// The exit code is 0 if the file is good; otherwise it is 1, and the reason is printed.
#[derive(Args)]
pub struct Arguments {
    /// Solid or tri-dexel model (.lfl), or `-` for standard input
    file: OsString,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    let what = match Stored::read(&input, true)? {
        (Stored::Octree(octree), bytes) => summary(&octree, bytes),
        (Stored::Dexels(model), bytes) => dexels::summary(&model, bytes),
    };
    print(format!("{input}: good: {what}\n").as_bytes())
}

fn summary(octree: &Octree, bytes: u64) -> String {
    let (depth, nodes) = (octree.frame().depth(), octree.statistics().nodes());
    format!("depth {depth}, {} nodes, {} bytes", count(nodes), count(bytes))
}
