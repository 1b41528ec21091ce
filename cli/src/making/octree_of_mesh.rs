//! Octrees of meshes, and of volumes given in their place.

use crate::failure::{Failure, Of, complain};
use crate::making::job::{Job, Timings, facts};
use crate::making::octree_of_volume;
use crate::making::surfaces::{Surfaces, deep_enough};
use crate::options::rule_name;
use crate::progress::watched;
use crate::report::mesh::Mesh;
use crate::report::octree::Info;
use crate::sink::json;
use crate::source::content::Content;
use crate::source::file::Found;
use crate::source::mesh::{Reading, fill_name, format_name, frame_around, in_words, warn_of_openness};
use crate::source::placing::Placing;
use crate::words::{counted, number};
use leafless::error::MeshError;
use leafless::exchange::{LengthUnit, MeshFile};
use leafless::lattice::MAX_DEPTH;
use leafless::mesh::MeshReport;
use leafless::{Error, Frame, MeshSolid, Rule, SurfaceOptions, TriangleMesh, build, build_extended};
use serde::Serialize;
use std::fmt::Write;
use std::time::Instant;

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    rule: &'static str,
    fill: &'static str,
    /// Thickness of the layers in which cells keep the surface; null if they keep none.
    surfaces: Option<f64>,
    format: &'static str,
    /// Null if the unit is unknown.
    unit: Option<&'static str>,
    /// Objects of a 3MF that are not solids.
    skipped: u64,
    timings: Timings,
    /// Departures of the file from its format that did not prevent reading it.
    warnings: Vec<String>,
    mesh: Mesh,
    /// Volume of the undecided cells.
    undecided_volume: f64,
    #[serde(flatten)]
    info: Info,
}

/// The options of reading a mesh or a volume, and of keeping its surfaces.
pub struct Voxelizing<'a> {
    pub reading: &'a Reading,
    pub placing: &'a Placing,
    pub rule: Rule,
    pub surfaces: Surfaces,
}

/// Makes an octree of a mesh or a volume, and saves it.
pub fn make(job: &Job, found: Found<'_>, wanted: &Voxelizing) -> Result<(), Failure> {
    let Job { input, output, start, .. } = job;
    let Voxelizing { reading, placing, rule, surfaces } = *wanted;
    if found.content == Content::Volume {
        if surfaces.are_kept() {
            return Err(surfaces.refusal(&format!("a volume, which {input} is")));
        }
        return octree_of_volume::make(job, rule, &found.volume(reading, placing)?);
    }
    if job.depth.is_none() && !surfaces.are_kept() {
        let problem =
            "the following required arguments were not provided: --depth <N> (see `leafless --help`)";
        return Err(Failure::Usage(problem.into()));
    };
    match found.content {
        Content::Solid => return Err(Failure::of(input, "is a solid already, not a mesh")),
        Content::Scene => return Err(Failure::of(input, "is a scene, not a mesh: use `leafless csg`")),
        Content::Mesh | Content::Volume => {}
    }
    if surfaces.are_kept() && surfaces.part().is_none() {
        let problem = "the surface of a mesh is not known exactly: give the thickness of the layers \
                       around it, relative to its longest side: --surfaces=1e-4";
        return Err(Failure::Usage(format!("--surfaces: {input} is a mesh, and {problem}")));
    }
    let fingerprint = found.fingerprint();
    let (file, fill) = found.mesh(reading, placing)?;
    let MeshFile { mesh, format, unit, skipped, warnings, .. } = file;
    let mesh_report = mesh.report().of(input)?;
    if mesh_report.triangles == 0 {
        return Err(Failure::of(input, MeshError::Empty));
    }
    // The mesh is moved into the solid below.
    let told = if job.json { Some(Mesh::new(&mesh).of(input)?) } else { None };
    let (min, max) = mesh.bounds();
    let tolerance = surfaces.tolerance((min, max));
    let frame = frame_for(job, &mesh, tolerance).of(input)?;
    let read = start.elapsed().as_secs_f64();

    let building = Instant::now();
    let solid = MeshSolid::new(mesh, fill).of(input)?;
    let octree = watched("voxelize", job.threads, |control| match tolerance {
        Some(_) => build_extended(&solid, &frame, &SurfaceOptions { tolerance }, control),
        None => build(&solid, &frame, rule, control),
    });
    let mut metadata = facts(input, fingerprint, rule, unit);
    if let Some(tolerance) = tolerance {
        metadata.insert("surfaces", number(tolerance));
    }
    let octree = octree.of(input)?.with_metadata(metadata);
    let build = building.elapsed().as_secs_f64();

    let saving = Instant::now();
    let bytes = output.save(&octree)?;
    let save = saving.elapsed().as_secs_f64();

    warn_of_openness(input, &mesh_report, fill);
    if octree.view().is_clipped() {
        complain(&format!("{input}: warning: {}", clipping(&frame, min, max)));
    }
    let timings = Timings { read, build, save, total: start.elapsed().as_secs_f64() };
    let info = Info::new(&octree, bytes);
    let Some(mesh) = told else {
        let head = head(job, &mesh_report, skipped);
        let keeps = info.keeps();
        return output.report(&(head + &job.summary(rule_name(rule), &octree, &info, &keeps, &timings)));
    };
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        rule: rule_name(rule),
        fill: fill_name(fill),
        surfaces: tolerance,
        format: format_name(format),
        unit: unit.map(LengthUnit::symbol),
        skipped,
        timings,
        warnings: in_words(&warnings),
        mesh,
        undecided_volume: info.volume.width(),
        info,
    };
    output.report(&json(&report)?)
}

/// Returns the frame on which a mesh is split, whose surface may be kept within a tolerance.
pub fn frame_for(job: &Job, mesh: &TriangleMesh, tolerance: Option<f64>) -> Result<Frame, Error> {
    let depth = job.depth.unwrap_or(MAX_DEPTH);
    let frame = match &job.bounds {
        Some(bounds) => bounds.with_depth(depth)?,
        None => frame_around(mesh, depth)?,
    };
    Ok(match (job.depth, tolerance) {
        (None, Some(tolerance)) => deep_enough(frame, tolerance),
        _ => frame,
    })
}

/// Describes where the mesh sticks out of the bounds. If it does not, it is open, and its solid may.
pub fn clipping(frame: &Frame, min: [f64; 3], max: [f64; 3]) -> String {
    let mut text = String::new();
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let start = frame.origin()[axis];
        let end = start + frame.edge();
        if min[axis] < start || max[axis] > end {
            let [from, to, start, end] = [min[axis], max[axis], start, end].map(number);
            let _ = write!(text, "; {name} from {from} to {to}, bounds {start} to {end}");
        }
    }
    if text.is_empty() {
        return "the solid of the open mesh may extend beyond the bounds, where it was cut off".into();
    }
    format!("the mesh sticks out of the bounds and was cut off{text}")
}

/// Returns the report on the mesh for people, in one line.
fn head(job: &Job, mesh: &MeshReport, skipped: u64) -> String {
    let mut text = format!(
        "{}: {}, {}",
        job.input,
        counted(mesh.triangles, "triangle", "triangles"),
        counted(mesh.bodies, "body", "bodies"),
    );
    if mesh.degenerate > 0 {
        let _ =
            write!(text, ", {} dropped", counted(mesh.degenerate, "degenerate facet", "degenerate facets"));
    }
    if mesh.sewn > 0 {
        let moved = counted(mesh.sewn, "vertex", "vertices");
        let _ = write!(text, ", {moved} moved by {} or less to close hair cracks", number(mesh.displacement));
    }
    if skipped > 0 {
        let left_out = counted(skipped, "object that is no solid", "objects that are no solids");
        let _ = write!(text, ", {left_out} left out");
    }
    text + "\n"
}
