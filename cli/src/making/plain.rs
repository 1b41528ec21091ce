//! Octrees without surfaces, from octrees whose cells keep some.

use crate::failure::{Failure, Of};
use crate::making::job::{Job, proven_rule};
use crate::options::rule_name;
use crate::progress::watched;
use crate::report::octree::Info;
use crate::words::{count, counted, seconds};
use leafless::op::plain;
use leafless::{Octree, Rule};
use serde::Serialize;

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    rule: &'static str,
    seconds: f64,
    #[serde(flatten)]
    info: Info,
}

/// Makes the octree whose cells are decided by the surfaces of another one, to a depth, and saves it.
pub fn make(job: &Job, octree: &Octree, depth: u8, rule: Rule) -> Result<(), Failure> {
    let Job { input, output, start, .. } = job;
    let cells = watched("convert", job.threads, |control| plain(octree, depth, rule, control)).of(input)?;
    let rule = proven_rule(rule, &cells);
    let mut metadata = cells.metadata().clone();
    metadata.insert("rule", rule_name(rule));
    let cells = cells.with_metadata(metadata);
    let bytes = output.save(&cells)?;
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        rule: rule_name(rule),
        seconds: start.elapsed().as_secs_f64(),
        info: Info::new(&cells, bytes),
    };
    output.tell(job.json, &report, |Report { seconds: time, info, .. }| {
        format!(
            "{output}: octree of depth {depth} without surfaces, volume {}, {}, {} bytes, in {}\n",
            info.volume_text(),
            counted(info.nodes, "node", "nodes"),
            count(bytes),
            seconds(*time),
        )
    })
}
