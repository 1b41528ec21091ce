//! `leafless`: solids from mesh files to queries, on the command line.
//!
//! A subcommand (`commands`) holds its arguments, and says what it wants. A file of any kind becomes a solid
//! on a frame in `source`; what is made of it is made in `making`; `report` knows what is told of it, and
//! `sink` takes it to a file or to standard output. `show` puts pictures on the terminal. A folder uses only
//! those below it: from the bottom up these are `source`, `report` and `sink`, `show` and `making`, and
//! `commands`; no subcommand uses another.
//!
//! Every failure is one line on standard error that names the file; the exit code is 0 for success, 1 for
//! failure, 2 for wrong usage. A signal ends the program at once (see `signals`).

#![deny(unsafe_code)]

mod commands;
mod failure;
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

/// Turns meshes into solids, cuts and joins them exactly, and answers questions about them.
///
/// A solid is kept as an octree in a file (.lfl) that is queried where it lies, without loading it. Unless
/// another rule is asked for, answers are certified: what is called inside or outside is proven, and a volume
/// is an interval that holds the true one.
#[derive(Parser)]
#[command(name = "leafless", version, propagate_version = true, max_term_width = 100)]
#[command(after_help = "\
Try `leafless demo` first. A file named `-` is standard input or standard output.
Files are mapped, not loaded: let no other program rewrite one in place while it is read here. Long work \
shows a bar at a terminal; elsewhere a line on standard error tells every five seconds, later every thirty, how far it is.")]
struct Arguments {
    /// Most memory to take, as 512M or 2G; what would take more is refused. Without it: what the machine has
    /// to spare, and 16G at most
    #[arg(long, global = true, value_name = "SIZE", value_parser = memory::size)]
    max_memory: Option<u64>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[command(
        about = "Make a solid from a mesh (STL, OBJ, PLY, OFF, 3MF) or a volume (NRRD, MetaImage, raw)"
    )]
    Voxelize(voxelize::Arguments),
    #[command(
        about = "Make a solid from a scene: primitives and set operations, as OpenSCAD exports them (.csg)"
    )]
    Csg(csg::Arguments),
    #[command(
        about = "Make a tri-dexel model, intervals along rays, of a solid, a mesh, a scene or a volume"
    )]
    Dexelize(dexelize::Arguments),
    #[command(about = "Make an octree, a tri-dexel model or a triangle mesh of any of them")]
    Convert(convert::Arguments),
    #[command(
        about = "Show what a solid consists of (depth, nodes, cells, volume), a mesh (bodies, holes, defects) or a scene"
    )]
    Info(info::Arguments),
    #[command(about = "Check a file completely: exit code 0 if it is good, 1 with the reason if not")]
    Verify(verify::Arguments),
    #[command(about = "All points of any of the solids")]
    Union(boolean::Arguments),
    #[command(about = "The points that the solids have in common")]
    Intersection(boolean::Arguments),
    #[command(about = "The first solid without all the others")]
    Difference(boolean::Arguments),
    #[command(about = "The points that lie in an odd number of the solids (of two: in just one of them)")]
    Xor(boolean::Arguments),
    #[command(about = "Everything but the solid")]
    Complement(boolean::ComplementArguments),
    #[command(about = "Say of points on standard input whether the solid contains them")]
    Contains(contains::Arguments),
    #[command(about = "Say how far points on standard input are from a solid, a mesh or a scene")]
    Distance(distance::Arguments),
    #[command(about = "Say what lies beside cells on standard input")]
    Neighbours(neighbours::Arguments),
    #[command(about = "Say where rays on standard input first meet a solid, a mesh or a scene")]
    Ray(ray::Arguments),
    #[command(about = "Make a picture (PNG), or show one on the terminal")]
    Render(render::Arguments),
    #[command(
        about = "Write how far a solid, a mesh or a scene reaches in each column of cells: a height map"
    )]
    Heights(heights::Arguments),
    #[command(about = "Write the surface of a solid, a mesh or a scene as a triangle mesh")]
    Mesh(mesh::Arguments),
    #[command(about = "Write the cells of a solid as a volume (NRRD or raw)")]
    Bitmap(bitmap::Arguments),
    #[command(
        about = "Write the voxels of a solid, a mesh or a scene as records (NPZ or CSV), or make a solid of records"
    )]
    Voxels(voxels::Arguments),
    #[command(about = "Say whether two solids or meshes overlap, by how much, and how far they are apart")]
    Interfere(interfere::Arguments),
    #[command(
        about = "Place as many copies of parts in a container as go in, proven to be apart; or check such a layout"
    )]
    Layout(layout::Arguments),
    #[command(about = "Say how far the boundaries of two solids or meshes are from each other")]
    Deviation(deviation::Arguments),
    #[command(
        about = "Volume, centroid, inertia and bounds of a solid or a mesh, as intervals that hold the true ones"
    )]
    Measure(measure::Arguments),
    #[command(
        about = "Say how much of a solid lies in a ball, a box or another solid: cells, and the volume in common"
    )]
    Within(within::Arguments),
    #[command(about = "Give a solid a channel: a colour, a temperature, a material at every point inside")]
    Attribute(attribute::Arguments),
    #[command(about = "Say which value a channel has at points on standard input")]
    Sample(sample::Arguments),
    #[command(
        about = "Say what a channel amounts to in a solid: least, greatest, mean, integral; or for each material"
    )]
    Summary(summary::Arguments),
    #[command(about = "Show the main job end to end on a mechanical part that the program makes itself")]
    Demo(demo::Arguments),
}

/// The command line, with help that says of each command first what it does, and then how.
fn command_line() -> clap::Command {
    let mut all = Arguments::command();
    for own in all.get_subcommands_mut() {
        if let (Some(about), Some(long)) = (own.get_about(), own.get_long_about()) {
            let text = format!("{about}.\n\n{long}");
            *own = own.clone().long_about(text);
        }
    }
    all
}

fn main() -> ExitCode {
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
        // Whoever reads has seen enough, as `head` has.
        Err(Failure::ReaderGone) => ExitCode::SUCCESS,
        // Half a solid is none; but the reader knows best why it left.
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

/// Shows help and version as they are, and errors in one line.
fn refuse_usage(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp
        | ErrorKind::DisplayVersion
        | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            // Nobody is left to be told if this cannot be printed.
            let _ = error.print();
        }
        _ => complain(&usage_line(&error.to_string())),
    }
    ExitCode::from(error.exit_code() as u8)
}

/// What `clap` says over several lines, in one: the complaint and its hints, without the synopsis.
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
            // Where debug assertions are off, as in a release, clap itself does not look.
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
