//! `leafless dexelize`: from a solid of any kind to a tri-dexel model.

use crate::failure::Failure;
use crate::making::dexels::{Storing, make};
use crate::making::job::Job;
use crate::options::{bounds, resolution, rules, threads};
use crate::sink::Output;
use crate::source::file::Taking;
use crate::source::input::Input;
use clap::builder::TypedValueParser;
use clap::{Args, ValueEnum};
use leafless::dexel::{DexelEnds, DexelFormat, DexelNormals};
use leafless::op::DexelOptions;
use leafless::{Frame, Rule};
use std::ffi::OsString;
use std::time::Instant;

/// Writes a tri-dexel model: the intervals that lie inside, along rays through the centres of N × N × N
/// cells, in three directions. The points where a ray enters and leaves are as precise as fixed-point numbers
/// allow; their precision does not depend on the size of the cells.
///
/// Rays through meshes, scenes of half-spaces and stored octrees are exact. A stored octree has its own
/// frame, and its cells may be undecided. Undecided cells count as inside, and a note says so; the rule inner
/// leaves them out.
///
/// The file records the input's name, length and checksum, the rule, and the unit if it is known. Equal input
/// gives equal bytes, for any number of threads.
#[derive(Args)]
pub struct Arguments {
    /// Mesh (STL, OBJ, PLY, OFF or 3MF), scene (.csg), volume (NRRD, MetaImage) or octree (.lfl), or `-` for
    /// standard input
    #[arg(value_name = "FILE")]
    input: OsString,
    /// File to write (.lfl), or `-` for standard output, in which case the summary goes to standard error;
    /// written completely or not at all
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// How the ends of intervals are stored
    #[arg(long, value_enum, default_value_t = EndsName::Fixed, help_heading = "Stored in the model")]
    ends: EndsName,
    /// How the surface's normals at the ends of intervals are stored. Normals keep edges sharp in `leafless
    /// mesh --method dual`
    #[arg(long, value_enum, default_value_t = NormalsName::None, help_heading = "Stored in the model")]
    normals: NormalsName,
    /// Store which triangle of the mesh or half-space of the scene each end lies on
    #[arg(long, help_heading = "Stored in the model")]
    surfaces: bool,
    /// Store this material, a number of your choice, for the whole model
    #[arg(long, value_name = "M", help_heading = "Stored in the model")]
    material: Option<u32>,
    /// Print one JSON object with the contents of each direction (on standard error if the model goes to
    /// standard output)
    #[arg(long)]
    json: bool,
    /// Cells along an axis of the cube, a power of two from 2 to 524288 [default: 256, or those of an octree
    /// or a volume]
    #[arg(long, value_name = "N", value_parser = resolution)]
    resolution: Option<u8>,
    /// Axes that rays run along: one, two or all of x, y and z
    #[arg(long, default_value = "xyz", value_name = "AXES", value_parser = directions)]
    directions: Directions,
    /// What the intervals contain
    #[arg(long, value_parser = dexel_rules(), default_value = "sampled")]
    rule: Rule,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Lower corner and edge length of the cube, in the units of the mesh after conversion and scaling.
    /// Models with the same bounds and resolution can be combined. What sticks out is cut off, and reported
    /// [default: the cube that `leafless voxelize` takes]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    taking: Taking,
}

/// The axes that rays run along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Directions([bool; 3]);

fn directions(text: &str) -> Result<Directions, String> {
    let mut directions = [false; 3];
    for letter in text.chars() {
        match "xyz".find(letter) {
            Some(axis) if !directions[axis] => directions[axis] = true,
            _ => return Err("expected x, y and z, one of them at least and each once: xyz".into()),
        }
    }
    if directions == [false; 3] {
        return Err("expected one of x, y and z at least".into());
    }
    Ok(Directions(directions))
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum EndsName {
    /// 8 bytes an interval, to 2^-31 of the cube's edge
    Fixed,
    /// 16 bytes an interval, to 2^-36 of the cube's edge
    Double,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum NormalsName {
    /// Not stored
    None,
    /// In 16 bits, within a degree
    #[value(name = "16")]
    Bits16,
    /// In 32 bits, within 0.005 degrees
    #[value(name = "32")]
    Bits32,
}

fn dexel_rules() -> impl TypedValueParser<Value = Rule> {
    rules([
        (Rule::Sampled, "The points of each ray that lie in the solid"),
        (Rule::Inner, "Cells that are wholly inside: the result lies within the solid"),
        (Rule::Outer, "Cells that are not wholly outside: the result contains the solid on each ray"),
    ])
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { resolution: depth, directions, rule, bounds, threads, json, .. } = *arguments;
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    let job = Job { input, output, start: Instant::now(), depth, bounds, threads, json };
    let format = DexelFormat {
        ends: match arguments.ends {
            EndsName::Fixed => DexelEnds::Fixed,
            EndsName::Double => DexelEnds::Double,
        },
        normals: match arguments.normals {
            NormalsName::None => DexelNormals::None,
            NormalsName::Bits16 => DexelNormals::Bits16,
            NormalsName::Bits32 => DexelNormals::Bits32,
        },
        surfaces: arguments.surfaces,
        materials: false,
    };
    let options = DexelOptions { directions: directions.0, format, ..Default::default() };
    make(&job, &arguments.taking, rule, Storing { options, material: arguments.material })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_letters() {
        assert_eq!(directions("xyz"), Ok(Directions([true; 3])));
        assert_eq!(directions("zx"), Ok(Directions([true, false, true])));
        for text in ["", "w", "xx", "x,y", "X"] {
            assert!(directions(text).is_err(), "{text}");
        }
    }
}
