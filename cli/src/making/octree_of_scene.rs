//! Octrees of scenes.

use crate::failure::{Failure, Of, complain};
use crate::making::job::{Job, Timings, facts, proven_rule};
use crate::making::surfaces::{Surfaces, deep_enough};
use crate::options::{name_of, rule_name};
use crate::progress::watched;
use crate::report::octree::Info;
use crate::report::scene::Curves;
use crate::source::content::Content;
use crate::source::file::Found;
use crate::source::placing::Placing;
use crate::source::scene::{Drawing, bounds_of, frame_of};
use crate::words::{count, number};
use clap::ValueEnum;
use leafless::lattice::MAX_DEPTH;
use leafless::solid::{Adaptive, SplitCounter, Touch};
use leafless::{Rule, SurfaceOptions, build, build_extended};
use serde::Serialize;
use std::time::Instant;

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum TouchName {
    /// Contact is not overlap: a cell touched from outside is empty
    Exact,
    /// As in the paper of the method: a cell touched from outside is undecided
    Paper,
}

/// The way in which space is split.
pub struct Splitting {
    pub rule: Rule,
    /// Thickness of layers that are not split. Without it, all cells are split to the depth.
    pub adaptive: Option<f64>,
    pub surfaces: Surfaces,
    pub touch: TouchName,
}

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    rule: &'static str,
    touch: String,
    /// Thickness of layers that are not split; null if all are split.
    adaptive: Option<f64>,
    /// Thickness of the layers in which cells keep surfaces: 0 if only exact surfaces are kept, null if none
    /// are.
    surfaces: Option<f64>,
    timings: Timings,
    /// Number of split cells; null for a scene with meshes or octrees, which are processed in bulk.
    splits: Option<u64>,
    /// Number of half-spaces that were evaluated, at a point or over a box.
    evaluations: u64,
    /// Volume of the undecided cells.
    undecided_volume: f64,
    /// The way in which the curves of the scene were drawn.
    curves: Curves,
    #[serde(flatten)]
    info: Info,
}

/// Makes an octree of a scene, and saves it.
pub fn make(
    job: &Job,
    found: Found<'_>,
    (drawing, placing): (&Drawing, &Placing),
    splitting: Splitting,
) -> Result<(), Failure> {
    let Job { input, output, start, .. } = job;
    let Splitting { rule, adaptive, surfaces, touch } = splitting;
    let problem = match found.content {
        Content::Scene => None,
        Content::Solid => Some("is a solid already, not a scene"),
        Content::Mesh => Some("is a mesh, not a scene: use `leafless voxelize`"),
        Content::Volume => Some("is a volume, not a scene: use `leafless voxelize`"),
    };
    if let Some(problem) = problem {
        return Err(Failure::of(input, problem));
    }
    let (scene, fingerprint) = (found.scene(drawing, placing)?, found.fingerprint());
    // The text is not needed any more.
    drop(found);
    let frame = frame_of(input, &scene, job.bounds.as_ref(), job.depth.unwrap_or(MAX_DEPTH))?;
    let tolerance = match surfaces.part() {
        Some(_) => surfaces.tolerance(bounds_of(input, &scene)?),
        None => None,
    };
    let frame = match (job.depth, tolerance) {
        (None, Some(tolerance)) => deep_enough(frame, tolerance),
        _ => frame,
    };
    let solid = scene.solid(&frame).of(input)?.with_touch(match touch {
        TouchName::Exact => Touch::Exact,
        TouchName::Paper => Touch::Paper,
    });
    // Counting the splits would turn off the bulk processing of meshes and octrees.
    let counted = (solid.nesting() == 0).then(|| SplitCounter::new(solid.clone()));
    let read = start.elapsed().as_secs_f64();

    let building = Instant::now();
    let options = SurfaceOptions { tolerance };
    let octree = watched("csg", job.threads, |control| match (&counted, adaptive) {
        (Some(counted), None) if surfaces.are_kept() => build_extended(counted, &frame, &options, control),
        (None, None) if surfaces.are_kept() => build_extended(&solid, &frame, &options, control),
        (Some(counted), Some(t)) => build(&Adaptive::new(counted, t)?, &frame, rule, control),
        (Some(counted), None) => build(counted, &frame, rule, control),
        (None, Some(t)) => build(&Adaptive::new(&solid, t)?, &frame, rule, control),
        (None, None) => build(&solid, &frame, rule, control),
    });
    let octree = octree.of(input)?;
    let rule = proven_rule(rule, &octree);
    let mut metadata = facts(input, fingerprint, rule, None);
    if let Some(thickness) = adaptive {
        metadata.insert("adaptive", number(thickness));
    }
    if let Some(tolerance) = tolerance {
        metadata.insert("surfaces", number(tolerance));
    }
    if let TouchName::Paper = touch {
        metadata.insert("touch", name_of(touch));
    }
    let octree = octree.with_metadata(metadata);
    let build = building.elapsed().as_secs_f64();

    let saving = Instant::now();
    let bytes = output.save(&octree)?;
    let save = saving.elapsed().as_secs_f64();

    if octree.view().is_clipped() {
        let warning = "the solid may extend beyond the bounds, where it was cut off";
        complain(&format!("{input}: warning: {warning}"));
    }
    let mut info = Info::new(&octree, bytes);
    let splits = counted.as_ref().map(SplitCounter::splits);
    if let Some(splits) = &splits {
        info.note_splits(splits);
    }
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        rule: rule_name(rule),
        touch: name_of(touch),
        adaptive,
        surfaces: surfaces.are_kept().then_some(tolerance.unwrap_or(0.0)),
        timings: Timings { read, build, save, total: start.elapsed().as_secs_f64() },
        splits: splits.map(|splits| splits.iter().sum()),
        evaluations: solid.evaluations(),
        undecided_volume: info.volume.width(),
        curves: scene.report().into(),
        info,
    };
    output.tell(job.json, &report, |report| {
        let more = format!(
            "{}{}splits  {}{} evaluations of half-spaces\n",
            report.curves.text().map_or(String::new(), |curves| format!("curves  {curves}\n")),
            report.info.keeps(),
            report.splits.map_or(String::new(), |splits| count(splits) + ", "),
            count(report.evaluations),
        );
        job.summary(report.rule, &octree, &report.info, &more, &report.timings)
    })
}
