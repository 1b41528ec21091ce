//! Octrees that keep the reconstructed surface of a tri-dexel model.

use crate::failure::{Failure, Of, complain};
use crate::making::dexel_surface::{Followed, dual};
use crate::making::job::{Job, Timings};
use crate::making::octree_of_mesh::{Voxelizing, clipping, frame_for};
use crate::options::rule_name;
use crate::progress::watched;
use crate::report::octree::Info;
use crate::sink::json;
use crate::source::file::{Found, Stored};
use crate::source::mesh::warn_of_openness;
use crate::words::{counted, number};
use leafless::{FillRule, MeshSolid, Metadata, Rule, SurfaceOptions, build_extended};
use serde::Serialize;
use std::time::Instant;

/// The surface that is certified.
const OF: &str = "surface reconstructed from a tri-dexel model";

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    rule: &'static str,
    /// The surface to which the rule refers.
    certified_of: &'static str,
    /// Thickness of the layers in which cells keep the surface.
    surfaces: f64,
    timings: Timings,
    triangles: usize,
    /// Statistics of the surface that follows the rays.
    surface: Followed,
    #[serde(flatten)]
    info: Info,
}

/// Makes an octree that keeps the surface of a tri-dexel model with normals, and saves it.
pub fn make(job: &Job, found: Found<'_>, wanted: &Voxelizing) -> Result<(), Failure> {
    let Job { input, output, start, .. } = job;
    let Stored::Dexels(model) = found.stored(true)?.0 else {
        return Err(Failure::of(input, "is an octree already, and no mesh"));
    };
    wanted.reading.refuse(input, "a tri-dexel model")?;
    let Some(part) = wanted.surfaces.part() else {
        let problem = "is a tri-dexel model, whose surface is not known exactly: give the thickness of \
                       the layers around it, relative to its longest side: --surfaces=1e-4";
        return Err(Failure::Usage(format!("--surfaces: {input} {problem}")));
    };
    let (mesh, followed) = dual(&model, input, job.threads)?;
    let mesh = wanted.placing.mesh(mesh).of(input)?;
    let mesh_report = mesh.report().of(input)?;
    if mesh_report.triangles == 0 {
        return Err(Failure::of(input, "has no surface: no centre of a cell lies inside"));
    }
    let ((min, max), triangles) = (mesh.bounds(), mesh.triangles().len());
    let tolerance = part * (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max);
    let frame = frame_for(job, &mesh, Some(tolerance)).of(input)?;
    let read = start.elapsed().as_secs_f64();

    let building = Instant::now();
    let solid = MeshSolid::new(mesh, FillRule::NonZero).of(input)?;
    let options = SurfaceOptions { tolerance: Some(tolerance) };
    let octree =
        watched("voxelize", job.threads, |control| build_extended(&solid, &frame, &options, control));
    let mut metadata = Metadata::common([model.metadata()]).of(input)?;
    metadata.insert("rule", rule_name(Rule::Certified));
    metadata.insert("certified of", OF);
    metadata.insert("surfaces", number(tolerance));
    let octree = octree.of(input)?.with_metadata(metadata);
    let build = building.elapsed().as_secs_f64();

    let saving = Instant::now();
    let bytes = output.save(&octree)?;
    let save = saving.elapsed().as_secs_f64();

    warn_of_openness(input, &mesh_report, FillRule::NonZero);
    if octree.view().is_clipped() {
        complain(&format!("{input}: warning: {}", clipping(&frame, min, max)));
    }
    let timings = Timings { read, build, save, total: start.elapsed().as_secs_f64() };
    let info = Info::new(&octree, bytes);
    if job.json {
        let report = Report {
            input: input.to_string(),
            output: output.to_string(),
            rule: rule_name(Rule::Certified),
            certified_of: OF,
            surfaces: tolerance,
            timings,
            triangles,
            surface: followed,
            info,
        };
        return output.report(&json(&report)?);
    }
    let head = format!(
        "{input}: surface of {} from ends and normals, {}\n{input}: what follows is certified of this surface, and of nothing that the \
         model was sampled from\n",
        counted(triangles as u64, "triangle", "triangles"),
        followed.text(),
    );
    let summary = job.summary(rule_name(Rule::Certified), &octree, &info, &info.keeps(), &timings);
    output.report(&(head + &summary))
}
