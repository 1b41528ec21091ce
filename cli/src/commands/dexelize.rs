//! `leafless dexelize`: from a solid of any kind to a tri-dexel model.

use crate::commands::conversion;
use crate::commands::voxelize::{clipping, facts};
use crate::failure::{Failure, Of, complain};
use crate::options::{bounds, name_of, resolution, threads};
use crate::progress::watched;
use crate::report::dexels::Info;
use crate::report::octree::short;
use crate::sink::{self, Output};
use crate::source::Source;
use crate::source::input::Input;
use crate::source::mesh::Reading;
use crate::source::scene::Drawing;
use crate::source::shape::Shape;
use crate::words::{count, counted, number, seconds};
use clap::{Args, ValueEnum};
use leafless::{
    Affine, DexelEnds, DexelFormat, DexelNormals, DexelOptions, Frame, MeshSolid, Metadata, Octree, Rule,
    Solid, Tag, TriDexel, dexelize,
};
use serde::Serialize;
use std::ffi::OsString;
use std::time::Instant;

/// Writes a tri-dexel model: along rays through the centres of N × N × N cells, in three directions, the intervals
/// that lie inside. Where a ray enters and leaves is known as finely as a fixed-point number can tell, not as finely as
/// cells are.
///
/// Rays of meshes, scenes of half-spaces and stored octrees are exact. A stored octree has a frame of its own, and
/// cells that may be undecided: these count as outside by the rule inner and as inside by the rule outer.
///
/// The file records the input's name, length and checksum, the rule, and the unit if it is known. Equal input
/// gives equal bytes, for any number of threads.
#[derive(Args)]
pub struct Arguments {
    /// Mesh (STL, OBJ, PLY, OFF or 3MF), scene (.csg), volume (NRRD, MetaImage) or octree (.lfl), or `-` for standard
    /// input
    #[arg(value_name = "FILE")]
    input: OsString,
    /// File to write, or `-` for standard output, whose summary then goes to standard error; it is written
    /// whole or not at all
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// Cells to an axis of the cube, a power of two from 2 to 524288. Without it: 256, or those of an octree or a volume
    #[arg(long, value_name = "N", value_parser = resolution)]
    resolution: Option<u8>,
    /// Axes that rays run along: of x, y and z one, two or all
    #[arg(long, default_value = "xyz", value_name = "AXES", value_parser = directions)]
    directions: Directions,
    /// How the ends of intervals are stored
    #[arg(long, value_enum, default_value_t = EndsName::Fixed)]
    ends: EndsName,
    /// How the surface's normals at ends are stored, which keep edges sharp in `leafless mesh --method dual`
    #[arg(long, value_enum, default_value_t = NormalsName::None)]
    normals: NormalsName,
    /// Store on which triangle of the mesh or half-space of the scene an end lies
    #[arg(long)]
    surfaces: bool,
    /// Store that all of it is of this material, a number of your own
    #[arg(long, value_name = "M")]
    material: Option<u32>,
    /// What intervals are
    #[arg(long, value_enum, default_value_t = RuleName::Sampled)]
    rule: RuleName,
    /// Lower corner and edge length of the cube, in the units of the mesh once it is converted and scaled. Models can
    /// be combined if they were given the same bounds and resolution. What sticks out is cut off, and reported. Without
    /// it: the cube that `leafless voxelize` takes
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    drawing: Drawing,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Print one JSON object with what each direction holds (on standard error if the model goes to standard output)
    #[arg(long)]
    json: bool,
}

/// Levels of the lattice, if nobody says how many.
const DEPTH: u8 = 8;
/// Which axes rays run along.
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
    /// Not at all
    None,
    /// In 16 bits, within a degree
    #[value(name = "16")]
    Bits16,
    /// In 32 bits, within 0.005 degrees
    #[value(name = "32")]
    Bits32,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum RuleName {
    /// Those of the solid on each ray
    Sampled,
    /// Those of cells that are wholly inside: the result lies within the solid
    Inner,
    /// Those of cells that are not wholly outside: the result contains what the solid holds of each ray
    Outer,
}

impl From<RuleName> for Rule {
    fn from(name: RuleName) -> Rule {
        match name {
            RuleName::Sampled => Rule::Sampled,
            RuleName::Inner => Rule::Inner,
            RuleName::Outer => Rule::Outer,
        }
    }
}

impl Arguments {
    /// What `leafless convert` asks for.
    pub fn converting(wanted: &conversion::Arguments) -> Arguments {
        Arguments {
            input: wanted.input.clone(),
            output: wanted.output.clone(),
            resolution: wanted.resolution,
            directions: Directions([true; 3]),
            ends: EndsName::Fixed,
            normals: NormalsName::None,
            surfaces: false,
            material: None,
            rule: match wanted.resolve {
                None => RuleName::Sampled,
                Some(conversion::ResolveName::Inner) => RuleName::Inner,
                Some(conversion::ResolveName::Outer) => RuleName::Outer,
            },
            bounds: wanted.bounds,
            reading: wanted.reading.clone(),
            drawing: wanted.drawing.clone(),
            threads: wanted.threads,
            json: wanted.json,
        }
    }

    fn options(&self) -> DexelOptions {
        let format = DexelFormat {
            ends: match self.ends {
                EndsName::Fixed => DexelEnds::Fixed,
                EndsName::Double => DexelEnds::Double,
            },
            normals: match self.normals {
                NormalsName::None => DexelNormals::None,
                NormalsName::Bits16 => DexelNormals::Bits16,
                NormalsName::Bits32 => DexelNormals::Bits32,
            },
            surfaces: self.surfaces,
            materials: false,
        };
        DexelOptions { directions: self.directions.0, format, rule: self.rule.into() }
    }

    /// The lattice that the solid is asked on.
    fn frame(&self, input: &Input, source: &Source) -> Result<Frame, Failure> {
        match source {
            Source::Octree(octree) => {
                let cells = octree.frame().cells();
                if self.bounds.is_some() {
                    return Err(Failure::Usage(format!(
                        "--bounds is not for {input}: an octree has its own"
                    )));
                }
                match self.resolution {
                    Some(depth) if depth > octree.frame().depth() => {
                        let problem =
                            format!("an octree of {cells} cells to an axis: it has no smaller ones");
                        Err(Failure::Usage(format!("--resolution contradicts {input}, {problem}")))
                    }
                    depth => octree.frame().with_depth(depth.unwrap_or(octree.frame().depth())).of(input),
                }
            }
            source => match (self.bounds, self.resolution) {
                (Some(bounds), depth) => bounds.with_depth(depth.unwrap_or(DEPTH)).of(input),
                (None, None) if source.own_frame().is_some() => source.frame(input, None),
                (None, depth) => source.frame(input, Some(depth.unwrap_or(DEPTH))),
            },
        }
    }
}

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    rule: String,
    /// Cells to an axis.
    resolution: u32,
    /// Rays that cross the solid, in all directions.
    rays: u64,
    /// Rays that pierce an open mesh an odd number of times, in all directions.
    odd_rays: u64,
    /// The mean over all directions: an estimate, in cubic model units.
    volume: f64,
    seconds: f64,
    #[serde(flatten)]
    info: Info,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    output.check()?;
    if let (Some(from), Some(to)) = (input.path(), output.path())
        && from.canonicalize().is_ok_and(|from| to.canonicalize().is_ok_and(|to| from == to))
    {
        return Err(Failure::of(&output, "is the input itself, which is not overwritten"));
    }
    let (shape, fingerprint) = Shape::read(&input, &arguments.reading, &arguments.drawing)?;
    let Shape::Source(source) = shape else {
        return Err(Failure::of(&input, "is a tri-dexel model already"));
    };
    let frame = arguments.frame(&input, &source)?;
    let metadata = metadata(&input, &source, fingerprint, arguments)?;
    warn(&input, &source, &frame);
    let (model, odd) = made(source, &input, &frame, arguments)?;
    let model = model.with_metadata(metadata);
    let bytes = output.save_dexels(&model)?;
    let info = Info::new(&model, bytes).with_odd(odd);
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        rule: name_of(arguments.rule),
        resolution: frame.cells(),
        rays: info.rays(),
        odd_rays: info.odd_rays(),
        volume: info.mean_volume(),
        seconds: start.elapsed().as_secs_f64(),
        info,
    };
    output.report(&if arguments.json { sink::json(&report)? } else { report.summary() })
}

/// The model, and how many rays of each direction pierce an open mesh an odd number of times.
fn made(
    source: Source,
    input: &Input,
    frame: &Frame,
    arguments: &Arguments,
) -> Result<(TriDexel, [u64; 3]), Failure> {
    match source {
        Source::Octree(octree) => {
            // Cells that are cut further than the lattice goes are undecided there.
            let is_coarser = frame.depth() < octree.frame().depth();
            if arguments.rule == RuleName::Sampled && (is_coarser || !octree.view().is_binary()) {
                let problem = "has undecided cells, which are neither inside nor outside: choose --rule inner or --rule \
                               outer (of `leafless convert` --resolve), or make it anew from its source with --rule sampled";
                return Err(Failure::of(input, problem));
            }
            Ok((of_solid::<Octree>(&octree, input, frame, arguments)?, [0; 3]))
        }
        Source::Mesh(mesh, fill, _) => {
            let solid = MeshSolid::new(mesh, fill).of(input)?;
            let odd = watched("dexelize", arguments.threads, |control| solid.odd_rays(frame, control));
            Ok((of_solid(&solid, input, frame, arguments)?, odd.of(input)?))
        }
        source => {
            let solid = source.placed(input, &Affine::IDENTITY, frame)?;
            Ok((of_solid(&solid, input, frame, arguments)?, [0; 3]))
        }
    }
}

fn of_solid<S: Solid>(
    solid: &S,
    input: &Input,
    frame: &Frame,
    arguments: &Arguments,
) -> Result<TriDexel, Failure> {
    let made = watched("dexelize", arguments.threads, |control| {
        let model = dexelize(solid, frame, &arguments.options(), control)?;
        match arguments.material {
            Some(material) => model.view().with_material(material, control),
            None => Ok(model),
        }
    });
    made.of(input)
}

/// Says what of the solid the model does not hold.
fn warn(input: &Input, source: &Source, frame: &Frame) {
    if let Source::Octree(octree) = source {
        if octree.view().exterior() != Tag::Empty {
            let problem = "the solid may go on outside of its bounds, which a tri-dexel model does not tell";
            complain(&format!("{input}: warning: {problem}"));
        }
        return;
    }
    let Ok((min, max)) = source.bounds(input) else {
        // Nobody knows how far a scene reaches that takes in half-spaces.
        let problem = "the solid may go on outside of the bounds, where it was cut off";
        return complain(&format!("{input}: warning: {problem}"));
    };
    let sticks_out = |axis: usize| {
        let low = frame.origin()[axis];
        min[axis] < low || max[axis] > low + frame.edge()
    };
    if (0..3).any(sticks_out) {
        complain(&format!("{input}: warning: {}", clipping(frame, min, max)));
    }
}

/// What the model's file says of its making: nothing that differs from run to run.
fn metadata(
    input: &Input,
    source: &Source,
    fingerprint: Option<String>,
    arguments: &Arguments,
) -> Result<Metadata, Failure> {
    if let Source::Octree(octree) = source {
        let mut metadata = Metadata::common([octree.metadata()]).of(input)?;
        if let Some(rule) = octree.metadata().get("rule") {
            metadata.insert("rule", rule);
        }
        if arguments.rule != RuleName::Sampled {
            metadata.insert("rule", name_of(arguments.rule));
        }
        return Ok(metadata);
    }
    let mut metadata = facts(input, fingerprint.unwrap_or_default(), arguments.rule, source.unit());
    if let Source::Volume(volume) = source {
        metadata.insert("threshold", number(volume.threshold));
    }
    Ok(metadata)
}

impl Report {
    fn summary(&self) -> String {
        let n = self.resolution;
        let odd = match self.odd_rays {
            0 => String::new(),
            odd => {
                let rays = counted(odd, "ray pierces", "rays pierce");
                format!(", {rays} the open mesh an odd number of times")
            }
        };
        format!(
            "{}: tri-dexel model of {n} x {n} x {n} cells along {}, volume about {}, {}, {} bytes{odd}, in {}\n",
            self.output,
            self.info.axes(),
            short(self.volume),
            counted(self.info.intervals, "interval", "intervals"),
            count(self.info.bytes),
            seconds(self.seconds),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resolutions_are_powers_of_two() {
        for depth in 1..=19u8 {
            assert_eq!(resolution(&(1u32 << depth).to_string()), Ok(depth));
        }
        for (text, near) in [
            ("0", "2 is the"),
            ("1", "2 is the"),
            ("3", "2 and 4 are"),
            ("300", "256 and 512 are"),
            ("524287", "262144 and 524288 are"),
            ("524289", "524288 is the"),
            ("1048576", "524288 is the"),
            ("18446744073709551615", "524288 is the"),
            ("-4", "from 2 to 524288"),
            ("many", "from 2 to 524288"),
        ] {
            let error = resolution(text).unwrap_err();
            assert!(error.contains(near), "{text}: {error}");
        }
    }

    #[test]
    fn directions_are_letters() {
        assert_eq!(directions("xyz"), Ok(Directions([true; 3])));
        assert_eq!(directions("zx"), Ok(Directions([true, false, true])));
        for text in ["", "w", "xx", "x,y", "X"] {
            assert!(directions(text).is_err(), "{text}");
        }
    }
}
