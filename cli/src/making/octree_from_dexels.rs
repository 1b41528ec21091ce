//! Octrees from tri-dexel models.

use crate::failure::{Failure, Of};
use crate::making::job::Job;
use crate::progress::watched;
use crate::report::octree::Info;
use crate::words::{count, counted, seconds};
use leafless::attribute::dexel_materials;
use leafless::op::{octree_from_dexel_ends, octree_from_dexels};
use leafless::{Control, Error, Metadata, Octree, TriDexel};
use serde::Serialize;

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    seconds: f64,
    /// The criterion for cells: their centres, or the ends of intervals.
    by: &'static str,
    /// Intervals that contain no centre of a cell, and are lost if centres decide.
    without_centres: u64,
    #[serde(flatten)]
    info: Info,
}

/// Returns the octree of a tri-dexel model, by the centres of cells or `by_ends`, with its materials as a
/// channel.
pub fn octree(model: &TriDexel, by_ends: bool, control: &Control<'_>) -> Result<Octree, Error> {
    let octree = match by_ends {
        true => octree_from_dexel_ends(model.view(), control)?,
        false => octree_from_dexels(model.view(), control)?,
    };
    match dexel_materials(model.view(), octree.view(), &Control { progress: None, ..*control })? {
        Some(channel) => octree.with_channel(channel),
        None => Ok(octree),
    }
}

/// Makes the octree of a tri-dexel model, and saves it.
pub fn make(job: &Job, model: &TriDexel, by_ends: bool) -> Result<(), Failure> {
    let Job { input, output, start, .. } = job;
    let octree = watched("convert", job.threads, |control| octree(model, by_ends, control)).of(input)?;
    let mut metadata = Metadata::common([model.metadata()]).of(input)?;
    metadata.insert("rule", if by_ends { "ends of sampled rays" } else { "sampled" });
    let octree = octree.with_metadata(metadata);
    let bytes = output.save(&octree)?;
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        seconds: start.elapsed().as_secs_f64(),
        by: if by_ends { "ends" } else { "centres" },
        without_centres: model.view().without_centres(),
        info: Info::new(&octree, bytes),
    };
    output.tell(job.json, &report, |Report { seconds: time, without_centres, info, .. }| {
        let lost = match *without_centres {
            0 => String::new(),
            _ if by_ends => String::new(),
            lost => {
                format!("; {} between the centres of cells not seen", counted(lost, "interval", "intervals"))
            }
        };
        format!(
            "{output}: octree of depth {}, volume {}, {}{}, {} bytes, in {}{lost}\n",
            octree.frame().depth(),
            info.volume_text(),
            if octree.channels().is_empty() { "" } else { "channel material, " },
            counted(info.nodes, "node", "nodes"),
            count(bytes),
            seconds(*time),
        )
    })
}
