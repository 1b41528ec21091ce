//! `leafless verify`: is a file good?

use crate::failure::Failure;
use crate::input::Input;
use crate::output::{count, print};
use clap::Args;
use std::ffi::OsString;

/// Checks every checksum, the order and the links of all nodes, that the tree is in canonical form, and that
/// the level table describes it. The exit code is 0 if the file is good and 1, with the reason, if it is not.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), or `-` for standard input
    file: OsString,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    let (octree, bytes) = input.octree(true)?;
    let (depth, nodes) = (octree.frame().depth(), octree.statistics().nodes());
    let line = format!("{input}: good: depth {depth}, {} nodes, {} bytes\n", count(nodes), count(bytes));
    print(line.as_bytes())
}
