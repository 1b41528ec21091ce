//! Octrees of tri-dexel models.

use crate::failure::{Failure, Of};
use crate::making::job::Job;
use crate::progress::watched;
use crate::report::octree::Info;
use crate::words::{count, counted, seconds};
use leafless::op::octree_from_dexels;
use leafless::{Metadata, TriDexel};
use serde::Serialize;

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    seconds: f64,
    /// Intervals that hold no centre of a cell, and are lost.
    without_centres: u64,
    #[serde(flatten)]
    info: Info,
}

/// Makes the octree of a tri-dexel model, and saves it.
pub fn make(job: &Job, model: &TriDexel) -> Result<(), Failure> {
    let Job { input, output, start, .. } = job;
    let octree =
        watched("convert", job.threads, |control| octree_from_dexels(model.view(), control)).of(input)?;
    let mut metadata = Metadata::common([model.metadata()]).of(input)?;
    metadata.insert("rule", "sampled");
    let octree = octree.with_metadata(metadata);
    let bytes = output.save(&octree)?;
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        seconds: start.elapsed().as_secs_f64(),
        without_centres: model.view().without_centres(),
        info: Info::new(&octree, bytes),
    };
    output.tell(job.json, &report, |Report { seconds: time, without_centres, info, .. }| {
        let lost = match *without_centres {
            0 => String::new(),
            lost => {
                format!("; {} between the centres of cells not seen", counted(lost, "interval", "intervals"))
            }
        };
        format!(
            "{output}: octree of depth {}, volume {}, {}, {} bytes, in {}{lost}\n",
            octree.frame().depth(),
            info.volume_text(),
            counted(info.nodes, "node", "nodes"),
            count(bytes),
            seconds(*time),
        )
    })
}
