//! Tri-dexel models of solids of any kind.

use crate::failure::{Failure, Of, complain};
use crate::making::job::{Job, facts};
use crate::making::octree_of_mesh::clipping;
use crate::options::rule_name;
use crate::progress::watched;
use crate::report::dexels::Info;
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::solid::{Shape, Source};
use crate::words::{count, counted, number, seconds};
use leafless::op::DexelOptions;
use leafless::{Affine, Frame, MeshSolid, Metadata, Octree, Rule, Solid, Tag, TriDexel, dexelize};
use serde::Serialize;

/// Levels of the lattice without --resolution.
const DEPTH: u8 = 8;

/// The stored properties of a model.
#[derive(Default)]
pub struct Storing {
    pub options: DexelOptions,
    /// The material of the whole model.
    pub material: Option<u32>,
}

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    rule: &'static str,
    /// Cells along an axis.
    resolution: u32,
    /// Number of rays that cross the solid, in all directions.
    rays: u64,
    /// Number of rays that pierce an open mesh an odd number of times, in all directions.
    odd_rays: u64,
    /// Estimate of the direction with the most rays that cross the solid, in cubic model units.
    volume: f64,
    /// The least and the greatest estimate of the directions.
    volume_range: [f64; 2],
    seconds: f64,
    #[serde(flatten)]
    info: Info,
}

/// Makes a tri-dexel model of a file, and saves it.
pub fn make(job: &Job, taking: &Taking, rule: Rule, mut storing: Storing) -> Result<(), Failure> {
    let Job { input, output, start, .. } = job;
    output.check()?;
    output.check_spares(input, "input")?;
    output.check_name()?;
    let (shape, fingerprint) = Shape::read(input, taking)?;
    let Shape::Source(source) = shape else {
        return Err(Failure::of(input, "is a tri-dexel model already"));
    };
    let frame = frame(job, &source)?;
    let rule = decided(rule, input, &source, &frame);
    storing.options.rule = rule;
    let metadata = metadata(input, &source, fingerprint, rule)?;
    warn(input, &source, &frame);
    let (model, odd) = made(source, job, &frame, &storing)?;
    let model = model.with_metadata(metadata);
    let bytes = output.save_dexels(&model)?;
    let info = Info::new(&model, bytes).with_odd(odd);
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        rule: rule_name(rule),
        resolution: frame.cells(),
        rays: info.rays(),
        odd_rays: info.odd_rays(),
        volume: info.best_volume(),
        volume_range: info.volume_range(),
        seconds: start.elapsed().as_secs_f64(),
        info,
    };
    output.tell(job.json, &report, Report::summary)
}

/// Returns the lattice on which the solid is queried.
fn frame(job: &Job, source: &Source) -> Result<Frame, Failure> {
    let input = &job.input;
    match source {
        Source::Octree(octree) if source.is_of_cells() => {
            let cells = octree.frame().cells();
            if job.bounds.is_some() {
                return Err(Failure::Usage(format!("--bounds is not for {input}: an octree has its own")));
            }
            match job.depth {
                Some(depth) if depth > octree.frame().depth() => {
                    let problem = format!("an octree of {cells} cells to an axis: it has no smaller ones");
                    Err(Failure::Usage(format!("--resolution contradicts {input}, {problem}")))
                }
                depth => octree.frame().with_depth(depth.unwrap_or(octree.frame().depth())).of(input),
            }
        }
        source => match job.bounds {
            Some(bounds) => bounds.with_depth(job.depth.unwrap_or(DEPTH)).of(input),
            None => source.frame_to(input, None, job.depth, DEPTH),
        },
    }
}

/// Returns the rule by which cells are decided. An octree cannot be queried at the centres of undecided
/// cells, or of cells that are split further than the lattice.
fn decided(rule: Rule, input: &Input, source: &Source, frame: &Frame) -> Rule {
    let is_open = match source {
        Source::Octree(octree) if source.is_of_cells() => {
            frame.depth() < octree.frame().depth() || !octree.view().is_binary()
        }
        _ => false,
    };
    if rule != Rule::Sampled || !is_open {
        return rule;
    }
    let note = "note: its undecided cells count as inside; --rule inner (of `leafless convert` --resolve) leaves them out";
    complain(&format!("{input}: {note}"));
    Rule::Outer
}

/// Returns the model, and the numbers of rays of each direction that pierce an open mesh an odd number of
/// times.
fn made(
    source: Source,
    job: &Job,
    frame: &Frame,
    storing: &Storing,
) -> Result<(TriDexel, [u64; 3]), Failure> {
    let input = &job.input;
    let is_of_cells = source.is_of_cells();
    match source {
        Source::Octree(octree) if is_of_cells => {
            Ok((of_solid::<Octree>(&octree, job, frame, storing)?, [0; 3]))
        }
        Source::Mesh(mesh, fill, _) => {
            let solid = MeshSolid::new(mesh, fill).of(input)?;
            let odd = watched("dexelize", job.threads, |control| solid.odd_rays(frame, control));
            Ok((of_solid(&solid, job, frame, storing)?, odd.of(input)?))
        }
        source => {
            let solid = source.placed(input, &Affine::IDENTITY, frame)?;
            Ok((of_solid(&solid, job, frame, storing)?, [0; 3]))
        }
    }
}

fn of_solid<S: Solid>(solid: &S, job: &Job, frame: &Frame, storing: &Storing) -> Result<TriDexel, Failure> {
    let made = watched("dexelize", job.threads, |control| {
        let model = dexelize(solid, frame, &storing.options, control)?;
        match storing.material {
            Some(material) => model.view().with_material(material, control),
            None => Ok(model),
        }
    });
    made.of(&job.input)
}

/// Warns of parts of the solid that the model does not contain.
fn warn(input: &Input, source: &Source, frame: &Frame) {
    if let Source::Octree(octree) = source {
        if octree.view().exterior() != Tag::Empty {
            let problem = "the solid may extend beyond its bounds; a tri-dexel model does not record that";
            complain(&format!("{input}: warning: {problem}"));
        }
        return;
    }
    let Ok((min, max)) = source.bounds(input) else {
        // The extent of a scene with half-spaces is unknown.
        let problem = "the solid may extend beyond the bounds, where it was cut off";
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

/// Returns the metadata of the model: nothing that differs from run to run.
fn metadata(
    input: &Input,
    source: &Source,
    fingerprint: Option<String>,
    rule: Rule,
) -> Result<Metadata, Failure> {
    if let Source::Octree(octree) = source {
        let mut metadata = Metadata::common([octree.metadata()]).of(input)?;
        if let Some(known) = octree.metadata().get("rule") {
            metadata.insert("rule", known);
        }
        if rule != Rule::Sampled {
            metadata.insert("rule", rule_name(rule));
        }
        return Ok(metadata);
    }
    let mut metadata = facts(input, fingerprint.unwrap_or_default(), rule, source.unit());
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
            "{}: tri-dexel model of {n} x {n} x {n} cells along {}, {}, {}, {} bytes{odd}, in {}\n",
            self.output,
            self.info.axes(),
            self.info.volume_text(),
            counted(self.info.intervals, "interval", "intervals"),
            count(self.info.bytes),
            seconds(self.seconds),
        )
    }
}
