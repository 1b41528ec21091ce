//! `leafless convert`: from each kind of solid to the others.

use crate::failure::{Failure, Of};
use crate::making::dexels::{self, Storing};
use crate::making::job::Job;
use crate::making::octree_of_mesh::{self, Voxelizing};
use crate::making::octree_of_scene::{self, Splitting, TouchName};
use crate::making::surface::{self, Method, Wanted};
use crate::making::surfaces::Surfaces;
use crate::making::{octree_from_dexels, plain};
use crate::options::{ResolveName, bounds, resolution, threads, tolerance};
use crate::sink::Output;
use crate::source::content::Content;
use crate::source::file::{Found, Stored, Taking};
use crate::source::input::Input;
use crate::source::moved::Onto;
use crate::{making, source};
use clap::{Args, ValueEnum};
use leafless::exchange::MeshFormat;
use leafless::{Frame, Octree, Rule, TriDexel};
use std::ffi::OsString;
use std::time::Instant;

/// Makes an octree, a tri-dexel model or a triangle mesh from any of the three, or from a scene or a volume,
/// as `leafless voxelize`, `csg`, `dexelize` and `mesh` do with their default options.
///
/// From a tri-dexel model to an octree: a cell is inside if its centre is. Materials become the channel
/// `material`. With --by-ends a cell is inside or outside if all rays through it are so all the way, and
/// undecided if an interval begins or ends in it, so that features thinner than a cell are not lost. Neither
/// way proves anything about the part between the rays.
///
/// From an octree to a tri-dexel model: the model contains exactly the cells; undecided cells count as
/// --resolve says. From an octree whose cells keep surfaces to one without: the surfaces decide the cells.
///
/// From a mesh or a scene to an octree: the octree is certified, and without --resolve its undecided cells
/// stay undecided. From a mesh to a mesh: the triangles stay, unless --resolution, --bounds or --resolve asks
/// for samples.
///
/// --translate, --rotate, --scale and --place move any of them. Without --to, an octree or tri-dexel model
/// then stays what it is, with its surfaces and channels. It lies on the image of its own cube or, if that
/// image is not parallel to the axes, on a cube around the image. An octree that is moved by whole cells and
/// quarter turns stays exact; otherwise its cells blur by about one cell.
#[derive(Args)]
pub struct Arguments {
    /// Octree or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD,
    /// MetaImage), or `-` for standard input
    #[arg(value_name = "FILE")]
    input: OsString,
    /// File to write, or `-` for standard output; written completely or not at all
    #[arg(short, long, value_name = "OUT")]
    output: OsString,
    /// What to make. The extension .lfl does not decide, as octrees and tri-dexel models both have it
    /// [default: a mesh if the output has the extension .ply, .stl, .obj, .off or .3mf; what the input is if
    /// it is moved]
    #[arg(id = "target", long = "to", value_enum, value_name = "KIND")]
    kind: Option<KindName>,
    /// Remove triangles from a mesh, moving its surface by at most T, in model units. Edges of the shape and
    /// values of triangles stay. How far the surface moved is proven
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    simplify: Option<f64>,
    /// Print one JSON object, that of the subcommand that does the work
    #[arg(long)]
    json: bool,
    /// Cells along an axis of the cube around a mesh or scene, a power of two from 2 to 524288. Without it, a
    /// mesh that becomes a mesh keeps its triangles [default: 256; the voxels of a volume]
    #[arg(long, value_name = "N", value_parser = resolution)]
    resolution: Option<u8>,
    /// What undecided cells count as, and cells that the surface passes through
    #[arg(long, value_enum)]
    resolve: Option<ResolveName>,
    /// Decide the cells of an octree by the ends of a tri-dexel model's intervals instead of by the centres
    /// of the cells
    #[arg(long, conflicts_with = "resolve")]
    by_ends: bool,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Lower corner and edge length of the cube, for a mesh, a scene, or an input that is moved [default: the
    /// cube around it]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    /// Write an STL even if rounding to its 32-bit coordinates breaks the surface
    #[arg(long)]
    lossy: bool,
    #[command(flatten)]
    taking: Taking,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum KindName {
    /// An octree (.lfl)
    Octree,
    /// A tri-dexel model (.lfl)
    Dexels,
    /// A triangle mesh
    Mesh,
}

/// Depth of octrees without --resolution.
const DEPTH: u8 = 8;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { resolution: depth, resolve, bounds, simplify, lossy, threads, json, .. } = *arguments;
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    let job = Job { input, output, start: Instant::now(), depth, bounds, threads, json };
    let taking = &arguments.taking;
    let kind = kind(arguments, &job)?;
    if simplify.is_some() && kind != Some(KindName::Mesh) {
        return Err(Failure::Usage("--simplify is for --to mesh: it takes out triangles".into()));
    }
    let Some(kind) = kind else { return moved(&job, taking, resolve) };
    let by_ends = arguments.by_ends;
    if by_ends && kind != KindName::Octree {
        return Err(Failure::Usage("--by-ends is for --to octree".into()));
    }
    match kind {
        KindName::Mesh => {
            let resolve = resolve.map(|resolve| match resolve {
                ResolveName::Inner => surface::ResolveName::Inner,
                ResolveName::Outer => surface::ResolveName::Outer,
            });
            let copy = job.depth.is_none() && bounds.is_none() && resolve.is_none();
            // The user requests cells of one size.
            let is_sampled = job.depth.is_some() || bounds.is_some();
            let method = if is_sampled { Some(Method::Mc) } else { resolve.map(|_| Method::Nets) };
            let wanted = Wanted { method, resolve, simplify, lossy, copy, ..Default::default() };
            surface::make(&job, taking, &wanted)
        }
        KindName::Dexels => {
            let rule = resolve.map_or(Rule::Sampled, Rule::from);
            dexels::make(&job, taking, rule, Storing::default())
        }
        KindName::Octree => to_octree(&job, taking, resolve, by_ends),
    }
}

/// Returns the kind to make; `None` keeps the kind of the file, in another place.
fn kind(arguments: &Arguments, job: &Job) -> Result<Option<KindName>, Failure> {
    let Job { input, output, .. } = job;
    let extension = output.path().and_then(|path| path.extension()?.to_str());
    let is_mesh = extension.is_some_and(|extension| MeshFormat::from_extension(extension).is_some());
    match arguments.kind {
        None if is_mesh => Ok(Some(KindName::Mesh)),
        None if arguments.taking.placing.map().is_some() && input.begins_as_solid() => Ok(None),
        None => {
            let choices = "--to octree, --to dexels or --to mesh";
            let problem = "its name does not say what to make";
            Err(Failure::Usage(format!("{output}: {problem}: choose {choices}")))
        }
        Some(KindName::Octree | KindName::Dexels) if is_mesh => {
            let problem = "its name is that of a mesh, but an octree or a tri-dexel model is to be written";
            Err(Failure::Usage(format!("{output}: {problem}")))
        }
        kind => Ok(kind),
    }
}

/// Moves a stored solid to another place.
fn moved(job: &Job, taking: &Taking, resolve: Option<ResolveName>) -> Result<(), Failure> {
    let Job { input, output, .. } = job;
    output.check()?;
    output.check_spares(input, "input")?;
    taking.refuse(input, "a solid")?;
    if resolve.is_some() {
        return Err(Failure::Usage(format!(
            "--resolve is not for {input}: it stays what it is, but for its place"
        )));
    }
    let stored = Stored::read(input, true)?.0;
    let own = match &stored {
        Stored::Octree(octree) => octree.frame(),
        Stored::Dexels(model) => model.frame(),
    };
    let depth = job.depth.unwrap_or(own.depth());
    let frame = job.bounds.map(|bounds| bounds.with_depth(depth)).transpose().of(input)?;
    let onto = match (&frame, job.depth) {
        (Some(frame), _) => Onto::Frame(frame),
        (None, None) => Onto::Image,
        (None, Some(_)) => {
            return Err(Failure::Usage(format!("--resolution needs --bounds where {input} is moved")));
        }
    };
    making::moved::save(job, &source::moved::stored(input, stored, &taking.placing, onto, job.threads)?)
}

fn from_octree(
    job: &Job,
    taking: &Taking,
    octree: Octree,
    resolve: Option<ResolveName>,
) -> Result<(), Failure> {
    let Job { input, output, .. } = job;
    if octree.view().cuts().is_none() {
        return match taking.placing.map() {
            Some(_) => moved(job, taking, resolve),
            None => Err(Failure::of(input, "is an octree already")),
        };
    }
    output.check()?;
    output.check_spares(input, "input")?;
    taking.refuse(input, "an octree")?;
    if job.bounds.is_some() {
        return Err(Failure::Usage(format!("--bounds is not for {input}: an octree has its own")));
    }
    let octree = match taking.placing.map() {
        Some(map) => source::moved::octree(input, octree, map, Onto::Image, job.threads)?,
        None => octree,
    };
    plain::make(job, &octree, job.depth.unwrap_or(DEPTH), resolve.map_or(Rule::Certified, Rule::from))
}

fn from_dexels(
    job: &Job,
    taking: &Taking,
    model: TriDexel,
    (resolve, by_ends): (Option<ResolveName>, bool),
) -> Result<(), Failure> {
    let Job { input, output, .. } = job;
    output.check()?;
    taking.refuse(input, "a tri-dexel model")?;
    let given = [
        ("--resolve", resolve.is_some()),
        ("--resolution", job.depth.is_some()),
        ("--bounds", job.bounds.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|option| option.1) {
        let problem = "is a tri-dexel model, whose cells are decided by their centres";
        return Err(Failure::Usage(format!("{option} is not for {input}: it {problem}")));
    }
    let model = match taking.placing.map() {
        Some(map) => source::moved::dexels(input, &model, map, Onto::Image, job.threads)?,
        None => model,
    };
    octree_from_dexels::make(job, &model, by_ends)
}

fn refused_by_ends(input: &Input) -> Failure {
    Failure::Usage(format!("--by-ends is for tri-dexel models, which {input} is not"))
}

fn to_octree(job: &Job, taking: &Taking, resolve: Option<ResolveName>, by_ends: bool) -> Result<(), Failure> {
    let Job { input, output, .. } = job;
    if input.path().is_none_or(|path| !path.is_file()) {
        let problem = "must be a regular file, because its kind is examined first; `leafless voxelize` \
                       and `leafless csg` can read from a pipe";
        return Err(Failure::of(input, problem));
    }
    if input.begins_as_solid() {
        // A damaged file is reported as damaged.
        return match Stored::read(input, true)?.0 {
            Stored::Dexels(model) => from_dexels(job, taking, model, (resolve, by_ends)),
            Stored::Octree(_) if by_ends => Err(refused_by_ends(input)),
            Stored::Octree(octree) => from_octree(job, taking, octree, resolve),
        };
    }
    if by_ends {
        return Err(refused_by_ends(input));
    }
    let found = Found::look(input, taking.reading.told())?;
    let rule = resolve.map_or(Rule::Certified, Rule::from);
    let depth = job.depth.unwrap_or(DEPTH);
    if found.content == Content::Scene {
        taking.reading.refuse(input, "a scene")?;
        output.check()?;
        output.check_spares(input, "scene")?;
        let splitting = Splitting { rule, adaptive: None, surfaces: Surfaces::NONE, touch: TouchName::Exact };
        let job = &Job { depth: Some(depth), ..job.clone() };
        return octree_of_scene::make(job, found, (&taking.drawing, &taking.placing), splitting);
    }
    taking.drawing.refuse(input, "no scene")?;
    output.check()?;
    output.check_spares(input, "mesh")?;
    let Taking { reading, placing, .. } = taking;
    let wanted = Voxelizing { reading, placing, rule, surfaces: Surfaces::NONE };
    octree_of_mesh::make(&Job { depth: Some(depth), ..job.clone() }, found, &wanted)
}
