//! `leafless sample`: the values of a channel at points.

use crate::failure::Failure;
use crate::rows::{Questions, serve};
use crate::sink::print;
use crate::source::input::Input;
use crate::source::values::find;
use crate::words::number;
use clap::Args;
use leafless::attribute::ChannelRef;
use leafless::{Membership, OctreeRef};
use std::ffi::OsString;

/// Reads points from standard input, one a line: x, y and z in the solid's units, separated by blanks, tabs
/// or commas. Empty lines and lines that begin with # are skipped.
///
/// Prints one line for each point: the numbers of the channel's value there, separated by blanks, or `none`
/// where there is no value or the point lies outside the solid. Answers are printed as soon as lines arrive.
#[derive(Args)]
pub struct Arguments {
    /// Solid with channels (.lfl)
    file: OsString,
    /// Name of the channel [default: the only one]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Print the channel's values outside the solid, too
    #[arg(long)]
    everywhere: bool,
    /// Print one line of JSON for each point: an array of numbers, or `null`
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::file(&arguments.file, "points")?;
    let (octree, _) = input.octree(true)?;
    let channel = find(&octree, &input, arguments.name.as_deref())?;
    let view = channel.view().map_err(|error| Failure::of(&input, error))?;
    let solid = if arguments.everywhere { None } else { Some(octree.view()) };
    serve(&mut Batch { channel: view, solid, json: arguments.json, text: String::new() })
}

/// Points that are answered together.
struct Batch<'c> {
    channel: &'c ChannelRef<'c>,
    solid: Option<&'c OctreeRef<'c>>,
    json: bool,
    text: String,
}

impl Questions<3> for Batch<'_> {
    fn ask(&mut self, point: [f64; 3]) -> Result<(), String> {
        let is_outside = self.solid.is_some_and(|solid| solid.contains(point) == Membership::Outside);
        let value = self.channel.value_at(point).filter(|_| !is_outside);
        match value {
            None => self.text.push_str(if self.json { "null" } else { "none" }),
            Some(value) => {
                let numbers = &value[..self.channel.value_type().components()];
                let numbers: Vec<String> = numbers.iter().map(|&x| number(x)).collect();
                let line = if self.json { format!("[{}]", numbers.join(",")) } else { numbers.join(" ") };
                self.text.push_str(&line);
            }
        }
        self.text.push('\n');
        Ok(())
    }

    fn answer(&mut self) -> Result<(), Failure> {
        let printed = print(self.text.as_bytes());
        self.text.clear();
        printed
    }
}
