//! The program `leafless`: solids from mesh files to queries, on the command line.
//!
//! A subcommand (`commands`) defines its arguments and runs its task. `source` makes a solid on a frame from
//! a file of any kind; `making` makes new solids, meshes and pictures; `report` describes them, and `sink`
//! writes results to a file or to standard output. `show` displays pictures on the terminal. A folder uses
//! only the folders below it: from the bottom up these are `source`, `report` and `sink`, `show` and
//! `making`, and `commands`. No subcommand uses another one.
//!
//! Every failure is one line on standard error that names the file. The exit code is 0 for success, 1 for
//! failure, 2 for wrong usage. A signal ends the program at once (see `signals`).

#![deny(unsafe_code)]

mod commands;
mod failure;
mod help;
mod making;
mod memory;
mod options;
mod progress;
mod report;
mod rows;
mod show;
mod signals;
mod sink;
mod source;
mod words;

use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use commands::*;
use failure::{Failure, complain};
use std::process::ExitCode;

/// The beginning of the help: what the program does, and an example.
const ABOUT: &str = "\
Makes solids from meshes, scenes and volumes, combines them exactly, and answers questions about them.
Example: `leafless voxelize part.stl -o part.lfl --depth 9`, then `leafless measure part.lfl`.";

/// The end of the help.
const NOTES: &str = "\
`leafless COMMAND --help` lists the arguments and options of a command, with examples.

A solid is stored as an octree in a file (.lfl), and queried there without loading it. Answers are certified \
by default: `inside` and `outside` are proven, and a volume is an interval that contains the true value. A file \
named `-` is standard input or standard output. Files are mapped into memory: do not let another program \
change a file in place while it is read. Long work shows a progress bar at a terminal; elsewhere, lines on \
standard error report the progress, every five and later every thirty seconds.";

/// The command line.
#[derive(Parser)]
#[command(name = "leafless", version, propagate_version = true)]
#[command(about = ABOUT, long_about = None, after_help = NOTES)]
struct Arguments {
    /// Most memory to take, such as 512M or 2G; results that would take more are refused [default: what the
    /// machine has to spare, at most 16G]
    #[arg(long, global = true, value_name = "SIZE", value_parser = memory::size, display_order = 900)]
    max_memory: Option<u64>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[command(about = "Make a solid from a mesh or a volume")]
    Voxelize(voxelize::Arguments),
    #[command(about = "Make a solid from a scene of primitives and set operations (.csg, as from OpenSCAD)")]
    Csg(csg::Arguments),
    #[command(about = "Make a tri-dexel model (intervals along rays) from any input")]
    Dexelize(dexelize::Arguments),
    #[command(about = "Convert between octree, tri-dexel model and triangle mesh, or move one of them")]
    Convert(convert::Arguments),
    #[command(about = "Show what a file contains, and what is wrong with a mesh")]
    Info(info::Arguments),
    #[command(about = "Check a file completely: exit code 0 if it is good, otherwise 1")]
    Verify(verify::Arguments),
    #[command(about = "Unite solids: the points of any of them")]
    Union(boolean::Arguments),
    #[command(about = "Intersect solids: the points that all of them have in common")]
    Intersection(boolean::Arguments),
    #[command(about = "Subtract all other solids from the first one")]
    Difference(boolean::Arguments),
    #[command(about = "Keep the points that lie in an odd number of the solids (of two: in only one)")]
    Xor(boolean::Arguments),
    #[command(about = "Invert a solid: the points outside of it")]
    Complement(boolean::ComplementArguments),
    #[command(about = "Tell whether points on standard input lie inside a solid")]
    Contains(contains::Arguments),
    #[command(about = "Tell how far points on standard input are from a solid, a mesh or a scene")]
    Distance(distance::Arguments),
    #[command(about = "List the neighbours of cells on standard input")]
    Neighbours(neighbours::Arguments),
    #[command(about = "Tell where rays on standard input first hit a solid, a mesh or a scene")]
    Ray(ray::Arguments),
    #[command(about = "Make a picture (PNG), or show it on the terminal")]
    Render(render::Arguments),
    #[command(about = "Write a height map: how far the solid reaches in each column of cells")]
    Heights(heights::Arguments),
    #[command(about = "Write the surface as a triangle mesh (STL, PLY, OBJ, OFF, 3MF)")]
    Mesh(mesh::Arguments),
    #[command(about = "Write the cells of a solid as a volume (NRRD or raw)")]
    Bitmap(bitmap::Arguments),
    #[command(about = "Write the voxels as records (NPZ or CSV), or make a solid from records")]
    Voxels(voxels::Arguments),
    #[command(about = "Tell whether two solids overlap, by how much, and how far apart they are")]
    Interfere(interfere::Arguments),
    #[command(about = "Pack copies of parts into a container without overlap, or check a layout")]
    Layout(layout::Arguments),
    #[command(about = "Tell how far two boundaries deviate from each other (Hausdorff distance)")]
    Deviation(deviation::Arguments),
    #[command(about = "Measure volume, area, centroid, inertia and bounds, as certified intervals")]
    Measure(measure::Arguments),
    #[command(about = "Bound the part of a solid that lies in a ball, a box or another solid")]
    Within(within::Arguments),
    #[command(about = "Give a solid a channel of values: a colour, a temperature, a material")]
    Attribute(attribute::Arguments),
    #[command(about = "Tell which value a channel has at points on standard input")]
    Sample(sample::Arguments),
    #[command(about = "Tell the least, greatest and mean value and the integral of a channel")]
    Summary(summary::Arguments),
    #[command(about = "Run the main workflow on a mechanical part that the program makes itself")]
    Demo(demo::Arguments),
}

/// The command line with its help texts.
fn command_line() -> clap::Command {
    help::with_help(Arguments::command())
}

/// Runs the program with the arguments of the process. Returns its exit code.
pub fn main() -> ExitCode {
    signals::watch();
    let parsed = command_line().try_get_matches();
    let arguments = match parsed.and_then(|mut matches| Arguments::from_arg_matches_mut(&mut matches)) {
        Ok(arguments) => arguments,
        Err(error) => return refuse_usage(&error),
    };
    if let Some(bytes) = arguments.max_memory {
        memory::allow(bytes);
    }
    let result = match &arguments.command {
        Command::Voxelize(arguments) => voxelize::run(arguments),
        Command::Csg(arguments) => csg::run(arguments),
        Command::Dexelize(arguments) => dexelize::run(arguments),
        Command::Convert(arguments) => convert::run(arguments),
        Command::Info(arguments) => info::run(arguments),
        Command::Verify(arguments) => verify::run(arguments),
        Command::Union(arguments) => boolean::run(making::operands::Operation::Union, arguments),
        Command::Intersection(arguments) => {
            boolean::run(making::operands::Operation::Intersection, arguments)
        }
        Command::Difference(arguments) => boolean::run(making::operands::Operation::Difference, arguments),
        Command::Xor(arguments) => boolean::run(making::operands::Operation::Xor, arguments),
        Command::Complement(arguments) => boolean::run_complement(arguments),
        Command::Contains(arguments) => contains::run(arguments),
        Command::Attribute(arguments) => attribute::run(arguments),
        Command::Sample(arguments) => sample::run(arguments),
        Command::Summary(arguments) => summary::run(arguments),
        Command::Distance(arguments) => distance::run(arguments),
        Command::Neighbours(arguments) => neighbours::run(arguments),
        Command::Ray(arguments) => ray::run(arguments),
        Command::Render(arguments) => render::run(arguments),
        Command::Heights(arguments) => heights::run(arguments),
        Command::Mesh(arguments) => mesh::run(arguments),
        Command::Bitmap(arguments) => bitmap::run(arguments),
        Command::Voxels(arguments) => voxels::run(arguments),
        Command::Interfere(arguments) => interfere::run(arguments),
        Command::Layout(arguments) => layout::run(arguments),
        Command::Deviation(arguments) => deviation::run(arguments),
        Command::Measure(arguments) => measure::run(arguments),
        Command::Within(arguments) => within::run(arguments),
        Command::Demo(arguments) => demo::run(arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // The reader has seen enough, as `head` has.
        Err(Failure::ReaderGone) => ExitCode::SUCCESS,
        // Half a solid is useless. The reader knows why it left, so there is no message.
        Err(Failure::Undelivered) => ExitCode::from(1),
        Err(Failure::Failed(line)) => {
            complain(&line);
            ExitCode::from(1)
        }
        Err(Failure::Usage(line)) => {
            complain(&line);
            ExitCode::from(2)
        }
    }
}

/// Prints help and version as they are, and errors in one line.
fn refuse_usage(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp
        | ErrorKind::DisplayVersion
        | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            // If this cannot be printed, nobody is there to read about it.
            let _ = error.print();
        }
        _ => complain(&usage_line(&error.to_string())),
    }
    ExitCode::from(error.exit_code() as u8)
}

/// Joins the lines of an error of `clap` into one: the complaint and its hints, without the synopsis.
fn usage_line(text: &str) -> String {
    let complaint = text.split("\nUsage:").next().unwrap_or(text);
    let complaint = complaint.split("\nFor more information").next().unwrap_or(complaint);
    let complaint = complaint.strip_prefix("error: ").unwrap_or(complaint);
    let paragraphs = complaint.split("\n\n").map(|paragraph| {
        let words: Vec<&str> = paragraph.split_whitespace().collect();
        words.join(" ")
    });
    let paragraphs: Vec<String> = paragraphs.filter(|paragraph| !paragraph.is_empty()).collect();
    format!("{} (see `leafless --help`)", paragraphs.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_of_the_arguments_is_sound() {
        fn check(command: &clap::Command) {
            // Without debug assertions, as in a release, clap itself does not check this.
            let mut names = std::collections::BTreeSet::new();
            for argument in command.get_arguments() {
                assert!(names.insert(argument.get_id().to_string()), "{} {argument}", command.get_name());
                let long = argument.get_long().map(|long| format!("--{long}"));
                assert!(long.is_none_or(|long| names.insert(long)), "{} {argument}", command.get_name());
            }
            command.get_subcommands().for_each(check);
        }
        check(&Arguments::command());
        Arguments::command().debug_assert();
    }

    #[test]
    fn usage_errors_are_one_line() {
        for arguments in [
            &["leafless", "voxelise"][..],
            &["leafless", "voxelize"],
            &["leafless", "voxelize", "a", "-o", "b", "--depth", "21"],
            &["leafless", "voxelize", "a", "-o", "b", "--depth", "3", "--rule", "exact"],
            &["leafless", "info"],
            &["leafless", "info", "a", "b"],
            &["leafless", "union", "a", "-o", "b"],
        ] {
            let Err(error) = Arguments::try_parse_from(arguments) else { panic!("{arguments:?} was taken") };
            let line = usage_line(&error.to_string());
            assert!(!line.contains('\n') && !line.starts_with("error") && line.len() < 200, "{line}");
        }
    }
}
