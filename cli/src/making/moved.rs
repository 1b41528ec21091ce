//! Stored solids in another place.

use crate::failure::Failure;
use crate::making::job::Job;
use crate::report::{dexels, octree};
use crate::source::file::Stored;
use crate::words::{count, counted, seconds};
use serde::Serialize;

#[derive(Serialize)]
struct Report<I> {
    input: String,
    output: String,
    seconds: f64,
    #[serde(flatten)]
    info: I,
}

impl<I> Report<I> {
    fn new(job: &Job, info: I) -> Report<I> {
        let Job { input, output, start, .. } = job;
        let seconds = start.elapsed().as_secs_f64();
        Report { input: input.to_string(), output: output.to_string(), seconds, info }
    }
}

/// Saves a solid that was moved.
pub fn save(job: &Job, moved: &Stored) -> Result<(), Failure> {
    let output = &job.output;
    match moved {
        Stored::Octree(octree) => {
            let bytes = output.save(octree)?;
            let report = Report::new(job, octree::Info::new(octree, bytes));
            output.tell(job.json, &report, |Report { seconds: time, info, .. }| {
                format!(
                    "{output}: moved octree of depth {}, volume {}, {}{}, {} bytes, in {}\n",
                    octree.frame().depth(),
                    info.volume_text(),
                    counted(info.nodes, "node", "nodes"),
                    info.kept_text().map_or(String::new(), |kept| format!(", {kept}")),
                    count(bytes),
                    seconds(*time),
                )
            })
        }
        Stored::Dexels(model) => {
            let bytes = output.save_dexels(model)?;
            let report = Report::new(job, dexels::Info::new(model, bytes));
            output.tell(job.json, &report, |Report { seconds: time, info, .. }| {
                format!(
                    "{output}: moved tri-dexel model, {}, {}, {} bytes, in {}\n",
                    info.volume_text(),
                    counted(info.intervals, "interval", "intervals"),
                    count(bytes),
                    seconds(*time),
                )
            })
        }
    }
}
