//! A task for any kind of result, and the common parts of all octrees that are made.

use crate::options::rule_name;
use crate::report::octree::Info;
use crate::sink::Output;
use crate::source::input::Input;
use crate::words::{count, number, seconds};
use leafless::exchange::LengthUnit;
use leafless::{Frame, Metadata, Octree, Rule};
use serde::Serialize;
use std::time::Instant;

/// A task: the input, the output, and the form of the report.
#[derive(Clone)]
pub struct Job {
    pub input: Input,
    pub output: Output,
    /// Time when the work began.
    pub start: Instant,
    /// Levels of cells. Without it: those of the source, or levels that suit the result.
    pub depth: Option<u8>,
    /// The cube to examine; its depth is a placeholder. Without it: the source's own cube, or the one around
    /// it.
    pub bounds: Option<Frame>,
    pub threads: usize,
    pub json: bool,
}

impl Job {
    /// Returns the report on an octree for people; `more` is a part of it.
    pub fn summary(&self, rule: &str, octree: &Octree, info: &Info, more: &str, timings: &Timings) -> String {
        let frame = octree.frame();
        let Timings { read, build, save, total } = *timings;
        let [read, build, save, total] = [read, build, save, total].map(seconds);
        format!(
            "{}: {rule} octree of depth {}, cells of {}\n\
             volume  {}{}\n\
             {more}\
             nodes   {} (a classical octree has {})\n\
             bytes   {}{}\n\
             time    {total}: read {read}, build {build}, save {save}\n",
            self.output,
            frame.depth(),
            number(frame.cell_size()),
            info.volume_text(),
            info.volume_note(),
            count(info.nodes),
            count(info.classical_nodes),
            count(info.bytes),
            info.bytes_per_node.map_or(String::new(), |each| format!(", {each:.2} a node")),
        )
    }
}

/// Times, in seconds.
#[derive(Serialize)]
pub struct Timings {
    /// Reading the source; merging the vertices of a mesh, closing its cracks, and checking that it is
    /// closed.
    pub read: f64,
    pub build: f64,
    pub save: f64,
    pub total: f64,
}

/// Returns the rule that an octree's file names. A result is no more certified than its source.
pub fn proven_rule(rule: Rule, octree: &Octree) -> Rule {
    let proof = octree.proof();
    match (rule, proof.full, proof.empty) {
        (Rule::Certified, true, false) => Rule::Inner,
        (Rule::Certified, false, true) => Rule::Outer,
        (Rule::Certified, false, false) => Rule::Sampled,
        _ => rule,
    }
}

/// Returns the first metadata of a result: nothing that differs from run to run.
pub fn named(input: &Input) -> Metadata {
    let mut metadata = Metadata::new();
    if let Some(stem) = input.path().and_then(|path| path.file_stem()) {
        metadata.insert("name", stem.to_string_lossy());
    }
    metadata
}

/// Returns the metadata of a result that a rule made from a file with this fingerprint.
pub fn facts(input: &Input, fingerprint: String, rule: Rule, unit: Option<LengthUnit>) -> Metadata {
    let mut metadata = named(input);
    metadata.insert("source", fingerprint);
    metadata.insert("rule", rule_name(rule));
    if let Some(unit) = unit {
        metadata.insert("units", unit.symbol());
    }
    metadata
}
