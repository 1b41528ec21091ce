//! Octrees of volumes.

use crate::failure::{Failure, Of};
use crate::making::job::{Job, named};
use crate::progress::watched;
use crate::report::octree::Info;
use crate::report::volume;
use crate::source::input::Input;
use crate::source::volume::Voxels;
use crate::words::{count, number, seconds};
use leafless::{Frame, Octree, Rule, Solid, build};
use serde::Serialize;

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    seconds: f64,
    volume_file: volume::Info,
    threshold: f64,
    #[serde(flatten)]
    info: Info,
}

/// Makes an octree of a volume and saves it, on the frame of the voxels or on the requested one.
pub fn make(job: &Job, rule: Rule, volume: &Voxels) -> Result<(), Failure> {
    let Job { input, output, start, threads, .. } = job;
    let bounds = volume.solid.bounds().map(|bounds| (bounds.min, bounds.max));
    let frame = match (&job.bounds, job.depth, &volume.frame, bounds) {
        (Some(bounds), Some(depth), ..) => Some(bounds.with_depth(depth).of(input)?),
        (Some(_), None, ..) => {
            return Err(Failure::Usage("--bounds needs --depth".into()));
        }
        (None, Some(depth), Some(frame), _) => Some(frame.with_depth(depth).of(input)?),
        (None, Some(depth), None, Some((min, max))) => Some(Frame::fitted(min, max, depth).of(input)?),
        _ => None,
    };
    let octree = match &frame {
        Some(frame) => on(volume, input, frame, rule, *threads)?,
        None => of_voxels(volume, input, *threads)?,
    };
    let bytes = output.save(&octree)?;
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        seconds: start.elapsed().as_secs_f64(),
        volume_file: volume::Info::new(volume),
        threshold: volume.threshold,
        info: Info::new(&octree, bytes),
    };
    output.tell(job.json, &report, |report| {
        format!(
            "{output}: octree of depth {}, volume {}, {} nodes, {} bytes, in {}\n",
            octree.frame().depth(),
            report.info.volume_text(),
            count(report.info.nodes),
            count(bytes),
            seconds(report.seconds),
        )
    })
}

/// Returns the octree whose finest cells are the voxels.
pub fn of_voxels(volume: &Voxels, input: &Input, threads: usize) -> Result<Octree, Failure> {
    on(volume, input, voxels(volume, input)?, Rule::Sampled, threads)
}

/// Returns the frame whose finest cells are the voxels.
pub fn voxels<'a>(volume: &'a Voxels, input: &Input) -> Result<&'a Frame, Failure> {
    volume.frame.as_ref().ok_or_else(|| {
        let problem = "its voxels are no cubes along the axes, so that its cells need --bounds and --depth of \
                       `leafless voxelize`";
        Failure::of(input, problem)
    })
}

/// Returns the octree on a frame.
pub fn on(
    volume: &Voxels,
    input: &Input,
    frame: &Frame,
    rule: Rule,
    threads: usize,
) -> Result<Octree, Failure> {
    let octree =
        watched("voxelize", threads, |control| build(&volume.solid, frame, rule, control)).of(input)?;
    let mut metadata = named(input);
    metadata.insert("threshold", number(volume.threshold));
    if let Some(unit) = volume.unit {
        metadata.insert("units", unit.symbol());
    }
    Ok(octree.with_metadata(metadata))
}
