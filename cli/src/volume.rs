//! Volumes from files, NRRD and MetaImage: which voxels are inside, and what is told of them.

use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::output::{self, Output, count, counted, number, seconds};
use crate::progress::watched;
use crate::report::Info;
use clap::Args;
use leafless::exchange::{LengthUnit, SampleKind, VolumeFile, open_volume, read_volume, volume_data_file};
use leafless::{AnySolid, Band, Control, Frame, Metadata, Octree, Rule, Solid, build};
use serde::Serialize;
use std::time::Instant;

/// Which voxels of a volume are inside.
#[derive(Args)]
pub struct Sampling {
    /// Least sample of a volume (NRRD, MetaImage) that is inside. Without it: the middle of the range of the samples'
    /// type, 0 for floating point numbers
    #[arg(long, value_name = "T", value_parser = threshold, allow_hyphen_values = true)]
    threshold: Option<f64>,
}

fn threshold(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if f64::is_finite(value) => Ok(value),
        _ => Err("expected a number".into()),
    }
}

/// A volume as a solid.
pub struct Voxels {
    pub solid: AnySolid,
    /// The frame whose finest cells are voxels, if voxels are cubes along the axes.
    pub frame: Option<Frame>,
    pub unit: Option<LengthUnit>,
    file: VolumeFile,
    threshold: f64,
}

impl Sampling {
    /// Refuses the options for volumes where something else is read: `what` it is.
    pub fn refuse(&self, input: &Input, what: &str) -> Result<(), Failure> {
        match self.threshold {
            Some(_) => Err(Failure::Usage(format!("--threshold is for volumes: {input} is {what}"))),
            None => Ok(()),
        }
    }

    /// The volume in a file with these bytes, whose samples may be in another file beside it.
    pub fn read(&self, input: &Input, bytes: &[u8]) -> Result<Voxels, Failure> {
        let file = match (input.path(), volume_data_file(bytes).of(input)?) {
            (Some(path), Some(_)) => open_volume(path).of(input)?,
            _ => read_volume(bytes, None).of(input)?,
        };
        if file.rounded > 0 {
            let samples = counted(file.rounded, "sample was", "samples were");
            output::complain(&format!("{input}: warning: {samples} rounded to single precision"));
        }
        let threshold = self.threshold.unwrap_or(file.kind.half_range());
        let band = Band::at_least(threshold).of(input)?;
        let solid = file.solid(Some(band), &Control::default()).of(input)?;
        let frame = if file.placement.is_none() { file.grid.frame().ok() } else { None };
        Ok(Voxels { solid, frame, unit: file.unit, file, threshold })
    }
}

impl Voxels {
    /// The octree whose finest cells are the voxels.
    pub fn octree(&self, input: &Input, threads: usize) -> Result<Octree, Failure> {
        let frame = self.frame.as_ref().ok_or_else(|| {
            let problem = "its voxels are no cubes along the axes, so that its cells need --bounds and --depth of \
                           `leafless voxelize`";
            Failure::of(input, problem)
        })?;
        self.octree_on(input, frame, Rule::Sampled, threads)
    }

    fn octree_on(&self, input: &Input, frame: &Frame, rule: Rule, threads: usize) -> Result<Octree, Failure> {
        let octree =
            watched("voxelize", threads, |control| build(&self.solid, frame, rule, control)).of(input)?;
        let mut metadata = Metadata::new();
        if let Some(stem) = input.path().and_then(|path| path.file_stem()) {
            metadata.insert("name", stem.to_string_lossy());
        }
        metadata.insert("threshold", number(self.threshold));
        if let Some(unit) = self.unit {
            metadata.insert("units", unit.symbol());
        }
        Ok(octree.with_metadata(metadata))
    }

    /// Makes a solid's file: on the frame of the voxels, or on the one that the user wants.
    pub fn save(&self, input: &Input, output: &Output, job: &Job) -> Result<(), Failure> {
        let start = Instant::now();
        let bounds = self.solid.bounds().map(|bounds| (bounds.min, bounds.max));
        let frame = match (&job.bounds, job.depth, &self.frame, bounds) {
            (Some(bounds), Some(depth), ..) => Some(bounds.with_depth(depth).of(input)?),
            (Some(_), None, ..) => {
                return Err(Failure::Usage("--bounds needs --depth".into()));
            }
            (None, Some(depth), Some(frame), _) => Some(frame.with_depth(depth).of(input)?),
            (None, Some(depth), None, Some((min, max))) => Some(Frame::fitted(min, max, depth).of(input)?),
            _ => None,
        };
        let octree = match &frame {
            Some(frame) => self.octree_on(input, frame, job.rule, job.threads)?,
            None => self.octree(input, job.threads)?,
        };
        let bytes = output.save(&octree)?;
        let info = Info::new(&octree, bytes);
        if job.json {
            let report = SavedReport {
                input: input.to_string(),
                output: output.to_string(),
                seconds: start.elapsed().as_secs_f64(),
                volume_file: self.told(),
                threshold: self.threshold,
                info,
            };
            return output.report(&output::json(&report)?);
        }
        output.report(&format!(
            "{output}: octree of depth {}, volume {}, {} nodes, {} bytes, in {}\n",
            octree.frame().depth(),
            info.volume_text(),
            count(info.nodes),
            count(bytes),
            seconds(start.elapsed().as_secs_f64()),
        ))
    }

    /// Prints what the volume is.
    pub fn tell(&self, json: bool) -> Result<(), Failure> {
        let told = self.told();
        if json {
            return output::print(output::json(&told)?.as_bytes());
        }
        let [x, y, z] = told.extents;
        let place = |p: [f64; 3]| p.map(number).join(", ");
        let unit = told.unit.map_or_else(String::new, |unit| format!(" {unit}"));
        output::print(
            format!(
                "{} volume, {x} x {y} x {z} samples of type {}\nvoxels {}{unit}, from {}\n",
                told.format,
                told.samples,
                place(told.spacing),
                place(told.corner),
            )
            .as_bytes(),
        )
    }

    fn told(&self) -> Told {
        Told {
            format: self.file.format.to_string(),
            samples: kind(self.file.kind),
            extents: self.file.grid.extents(),
            spacing: self.file.grid.spacing(),
            corner: self.file.grid.corner(),
            is_turned: self.file.placement.is_some(),
            unit: self.unit.map(LengthUnit::symbol),
        }
    }
}

/// What the user wants of a volume's octree.
pub struct Job {
    pub bounds: Option<Frame>,
    pub depth: Option<u8>,
    pub rule: Rule,
    pub threads: usize,
    pub json: bool,
}

/// What a volume's file says.
#[derive(Serialize)]
struct Told {
    format: String,
    samples: &'static str,
    extents: [u32; 3],
    /// Of a volume whose axes are not x, y and z: before it is turned.
    spacing: [f64; 3],
    corner: [f64; 3],
    is_turned: bool,
    unit: Option<&'static str>,
}

#[derive(Serialize)]
struct SavedReport {
    input: String,
    output: String,
    seconds: f64,
    volume_file: Told,
    threshold: f64,
    #[serde(flatten)]
    info: Info,
}

/// The name of a type of samples.
fn kind(kind: SampleKind) -> &'static str {
    match kind {
        SampleKind::Bit => "bit",
        SampleKind::I8 => "i8",
        SampleKind::U8 => "u8",
        SampleKind::I16 => "i16",
        SampleKind::U16 => "u16",
        SampleKind::I32 => "i32",
        SampleKind::U32 => "u32",
        SampleKind::I64 => "i64",
        SampleKind::U64 => "u64",
        SampleKind::F32 => "f32",
        SampleKind::F64 => "f64",
    }
}
