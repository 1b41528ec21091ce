//! Surfaces of solids of any kind, as triangle meshes.

use crate::failure::{Failure, Of, complain};
use crate::making::askew;
use crate::making::bearing::Bearing;
use crate::making::dexel_surface::{self, Followed};
use crate::making::faces::{Faces, Region};
use crate::making::job::Job;
use crate::options::{UNDECIDED, name_of};
use crate::progress::watched;
use crate::report::cuts::Cuts;
use crate::report::octree::Info;
use crate::sink::Output;
use crate::sink::written::{self, Losses, Writing};
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::mesh::format_name;
use crate::source::solid::{Shape, Source};
use crate::source::volume::Voxels;
use crate::words::{counted, number, short};
use clap::ValueEnum;
use leafless::dexel::{DexelFormat, DexelNormals};
use leafless::exchange::{LengthUnit, MeshFormat, WriteOptions, read_mesh, write_mesh};
use leafless::mesh::MeshReport;
use leafless::op::DexelOptions;
use leafless::surface::{
    BoundaryReport, ContourReport, Resolve, Snap, VertexPlacement, boundary, contour, coplanar_shrink,
    coplanar_shrink_solid, marching_cubes_solid, marching_cubes_volume, published_shrink,
    published_shrink_solid, simple_marching_cubes, simple_marching_cubes_solid, simplify, surface_nets,
};
use leafless::{
    Affine, AnySolid, Control, Error, Frame, Interval, Octree, Rule, TriDexel, TriangleMesh, build, dexelize,
    marching_cubes,
};
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// The warning about layers.
const LAYERS: &str = "its cells keep layers in which the surface lies, which decide no points: this is the surface of what may be solid, by \
                      --method nets, and with --resolve inner that of what is proven to be";

/// Depth of meshes, scenes, and octrees whose cells keep surfaces, without --depth.
const DEPTH: u8 = 8;

/// The same depth for the method faces, where cells end by themselves.
const DEEP: u8 = 14;

/// The same depth for the method adaptive, where a cell has one vertex.
const FINE: u8 = 12;

/// Tolerance of curved faces without --tolerance, relative to the longest extent.
const FACES: f64 = 1e-3;

/// The requested surface and file.
#[derive(Default)]
pub struct Wanted {
    /// Without it: as sharp as the known shape allows.
    pub method: Option<Method>,
    pub snap: Option<SnapName>,
    pub vertices: Option<At>,
    /// Greatest distance of the surface from the solid (model units), for the methods that guarantee one.
    pub tolerance: Option<f64>,
    pub resolve: Option<ResolveName>,
    /// The format to write. Without it, the name of the output decides.
    pub format: Option<MeshFormat>,
    pub text: bool,
    pub normals: bool,
    pub lossy: bool,
    pub intersections: bool,
    /// Whether a mesh is written as it is.
    pub copy: bool,
    /// Whether plane faces are written as polygons.
    pub polygons: bool,
    /// Name of the values for the triangles.
    pub channel: Option<String>,
    /// Greatest move of the surface when triangles are removed from it (model units).
    pub simplify: Option<f64>,
}

impl Wanted {
    /// True if vertices lie where edges cross the surface.
    fn is_crossed(&self, method: Method) -> bool {
        method == Method::Mc && self.vertices != Some(At::Midpoint) && self.resolve.is_none()
    }
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub enum Method {
    /// Marching cubes: the surface between samples at equal distances
    Mc,
    /// Surface nets: smoother, with a vertex in each cube between samples
    Nets,
    /// Dual contouring of a tri-dexel model with normals: keeps edges and corners
    Dual,
    /// The surfaces themselves, plane faces exactly, with few triangles
    Faces,
    /// Adaptive dual contouring: few triangles where flat, sharp edges
    Adaptive,
    /// Simple marching cubes: vertices are samples, normals have 13 directions
    Smc,
    /// The surface of smc, with few triangles for each coplanar part; no cracks
    Shrink,
    /// Coplanar shrink as published, for comparison: it has cracks
    ShrinkPublished,
}

#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub enum SnapName {
    /// To the samples outside
    #[default]
    Fat,
    /// To the samples inside
    Thin,
}

impl From<SnapName> for Snap {
    fn from(name: SnapName) -> Snap {
        match name {
            SnapName::Fat => Snap::Fat,
            SnapName::Thin => Snap::Thin,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Default, ValueEnum)]
pub enum At {
    /// Half-way between an inside and an outside sample
    Midpoint,
    /// Where the line between them crosses the surface
    #[default]
    Crossing,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ResolveName {
    /// Outside: the surface is that of the part that is proven to be solid
    Inner,
    /// Inside: the surface is that of the part that may be solid
    Outer,
    /// As the mesh or the scene says at the cell's centre
    Source,
}

/// Makes the surface of a file, and writes it.
pub fn make(job: &Job, taking: &Taking, wanted: &Wanted) -> Result<(), Failure> {
    let Job { input, output, .. } = job;
    output.check()?;
    let format = format(wanted.format, output.path())?;
    if wanted.normals && !matches!(format, MeshFormat::Ply | MeshFormat::Obj) {
        let name = format_name(format).to_uppercase();
        return Err(Failure::Usage(format!(
            "--normals is for PLY and OBJ: {name} has no normals at vertices"
        )));
    }
    let shape = Shape::before_moving(input, taking)?.0;
    let is_stored = shape.is_stored();
    let mut method = match wanted.method {
        Some(method) => method,
        None => usual(&shape, input, wanted),
    };
    if wanted.tolerance.is_some() && !matches!(method, Method::Faces | Method::Adaptive) {
        let name = name_of(method);
        let problem = "is for --method faces and adaptive: others have the cells of --depth";
        return Err(Failure::Usage(format!("--tolerance {problem} (this is --method {name})")));
    }
    if wanted.polygons {
        polygons_of(wanted, method, format)?;
    }
    if wanted.polygons && is_stored {
        taking.placing.refuse(input, "--polygons tells its faces where they are stored")?;
    }
    let bearing = wanted.channel.as_deref().map(|name| Bearing::of(&shape, input, name, job.threads));
    let bearing = bearing.transpose()?;
    bearing.as_ref().map(|bearing| bearing.called(format)).transpose()?;
    let certain = match &shape {
        // Vertices that are samples lie beside the surface. Those of the other methods lie on it, or between
        // samples.
        Shape::Source(source) if method.moves_to_samples() => certain_volume(source).of(input)?,
        _ => None,
    };
    let is_copy = wanted.copy && matches!(shape, Shape::Source(Source::Mesh(..)));
    let Found { mesh, unit, faces, followed } = surface_of(shape, job, wanted, &mut method)?;
    // (Moving the mesh afterwards would leave the faces behind.)
    let mut faces = faces.filter(|_| !is_stored || taking.placing.map().is_none());
    if let Some(certain) = certain.filter(|certain| !certain.contains(mesh.volume())) {
        let (volume, name) = (short(mesh.volume()), name_of(method));
        let [least, greatest] = [certain.lower, certain.upper].map(short);
        let problem = format!(
            "the surface by --method {name} has a volume of {volume}, and the solid one from {least} to {greatest}"
        );
        complain(&format!("{input}: warning: {problem}: --method mc, and smaller cells, come nearer"));
    }
    let mesh = match &bearing {
        Some(bearing) => bearing.on(mesh, format, input, job.threads)?,
        None => mesh,
    };
    // The surface of a stored solid is sharper than the surface of a solid that is remade in another place.
    let mesh = if is_stored { taking.placing.mesh(mesh).of(input)? } else { mesh };
    let mut mesh = mesh;
    if let Some(most) = wanted.simplify {
        mesh = simplified(mesh, is_copy, most, job)?;
        // (The faces have other triangles now.)
        faces = None;
    }
    let method = if is_copy { "copy".into() } else { name_of(method) };
    write(job, format, wanted, Made { mesh, unit, method, followed, faces })
}

/// A surface, in the place that the file gives it.
struct Found {
    mesh: TriangleMesh,
    unit: Option<LengthUnit>,
    faces: Option<Faces>,
    followed: Option<Followed>,
}

/// Makes the surface of a shape by a method, which may be changed.
fn surface_of(shape: Shape, job: &Job, wanted: &Wanted, method: &mut Method) -> Result<Found, Failure> {
    let (unit, mesh, faces, followed) = match shape {
        Shape::Dexels(model) => {
            let unit = model.metadata().get("units").and_then(|unit| unit.parse().ok());
            let (mesh, followed) = of_dexels(&model, job, wanted, *method)?;
            (unit, mesh, None, Some(followed))
        }
        Shape::Source(Source::Mesh(mesh, _, unit)) if wanted.copy => (unit, mesh, None, None),
        Shape::Source(source) if matches!(method, Method::Faces | Method::Adaptive) => {
            let unit = source.unit();
            let (mesh, by, faces, followed) = to_tolerance(source, job, wanted, *method)?;
            *method = by;
            (unit, mesh, faces, followed)
        }
        Shape::Source(source) if asks_rays(&source, wanted, *method) => {
            let unit = source.unit();
            let (mesh, followed) = by_rays(source, job, wanted, *method)?;
            (unit, mesh, None, Some(followed))
        }
        Shape::Source(source) => (source.unit(), extract(source, job, wanted, *method)?, None, None),
    };
    Ok(Found { mesh, unit, faces, followed })
}

/// Makes the surface of a file by the default method; a mesh stays as it is.
pub fn usual_surface(input: &Input, threads: usize) -> Result<TriangleMesh, Failure> {
    let job = Job {
        input: input.clone(),
        output: Output::Standard,
        start: Instant::now(),
        depth: None,
        bounds: None,
        threads,
        json: false,
    };
    let wanted = Wanted { copy: true, ..Wanted::default() };
    let shape = Shape::before_moving(input, &Taking::default())?.0;
    let mut method = usual(&shape, input, &wanted);
    Ok(surface_of(shape, &job, &wanted, &mut method)?.mesh)
}

/// Returns the mesh with fewer triangles. Its distance from the solid is known if it was known before, or if
/// the mesh is the solid.
fn simplified(mesh: TriangleMesh, is_solid: bool, most: f64, job: &Job) -> Result<TriangleMesh, Failure> {
    let input = &job.input;
    let is_known = is_solid || mesh.deviation() > 0.0;
    let found = watched("simplify", job.threads, |control| simplify(&mesh, most, control)).of(input)?;
    let simple = found.into_mesh();
    if is_known { Ok(simple) } else { simple.with_deviation(0.0).of(input) }
}

impl Method {
    fn moves_to_samples(self) -> bool {
        matches!(self, Method::Smc | Method::Shrink | Method::ShrinkPublished)
    }
}

/// Returns the default method: the one that uses most of the known shape, or the one that an option belongs
/// to.
fn usual(shape: &Shape, input: &Input, wanted: &Wanted) -> Method {
    let (method, option) = match shape {
        // (It refuses these options.)
        Shape::Dexels(model) if model.view().format().normals == DexelNormals::None => (Method::Mc, None),
        Shape::Dexels(_) => (Method::Dual, None),
        _ if wanted.snap.is_some() => (Method::Smc, Some("--snap")),
        _ if wanted.vertices.is_some() => (Method::Mc, Some("--vertices")),
        Shape::Source(source) if source.is_of_cells() => (Method::Nets, None),
        Shape::Source(_) if wanted.resolve.is_some() => (Method::Nets, Some("--resolve")),
        Shape::Source(Source::Scene(scene)) if scene.report().meshes.is_empty() => (Method::Faces, None),
        // (Layers of a curved mesh cross each other in countless finest cells.)
        Shape::Source(Source::Octree(octree)) if Cuts::new(octree).is_some_and(|cuts| cuts.has_layers()) => {
            (Method::Mc, None)
        }
        Shape::Source(Source::Octree(_)) => (Method::Faces, None),
        Shape::Source(Source::Scene(_) | Source::Volume(_)) if wanted.tolerance.is_some() => {
            (Method::Adaptive, Some("--tolerance"))
        }
        // (Contours take minutes where several meshes are cut with each other; rays are as sharp.)
        Shape::Source(Source::Scene(_)) => (Method::Dual, None),
        // (As a solid a volume consists of boxes; marching cubes interpolates between its samples.)
        Shape::Source(Source::Volume(_)) => (Method::Mc, None),
        Shape::Source(Source::Mesh(..)) => (Method::Faces, None),
    };
    if let Some(option) = option {
        complain(&format!("{input}: note: {option} makes it --method {}", name_of(method)));
    }
    method
}

/// A surface that was made.
pub struct Made {
    pub mesh: TriangleMesh,
    pub unit: Option<LengthUnit>,
    /// Name of the method.
    pub method: String,
    /// Statistics of the rays that the surface follows, if it does.
    pub followed: Option<Followed>,
    /// Its faces, if they are known.
    pub faces: Option<Faces>,
}

/// Refuses options that exclude polygons.
fn polygons_of(wanted: &Wanted, method: Method, format: MeshFormat) -> Result<(), Failure> {
    let problem = if method != Method::Faces {
        "is for --method faces, which provides plane faces"
    } else if !matches!(format, MeshFormat::Obj | MeshFormat::Off) {
        "is for OBJ and OFF: other formats have triangles only"
    } else if wanted.normals {
        "does not go with --normals"
    } else if wanted.channel.is_some() {
        "does not go with --channel, whose values are on triangles"
    } else if wanted.simplify.is_some() {
        "does not go with --simplify, which makes triangles only: --tolerance makes fewer of them"
    } else {
        return Ok(());
    };
    Err(Failure::Usage(format!("--polygons {problem}")))
}

/// Writes a surface, and reports on it.
pub fn write(job: &Job, format: MeshFormat, wanted: &Wanted, made: Made) -> Result<(), Failure> {
    let Job { input, output, start, .. } = job;
    let Made { mesh, unit, method, followed, faces } = made;
    let options = WriteOptions {
        text: wanted.text,
        unit,
        normals: wanted.normals,
        deviation: Some(mesh.deviation()).filter(|&deviation| deviation > 0.0),
    };
    let (is_lossy, tolerance, threads) = (wanted.lossy, wanted.tolerance, job.threads);
    let writing = Writing { is_lossy, tolerance, threads };
    let kept = written::kept(&mesh, format, &options, writing, output)?;
    let deviation = options.deviation.map(|deviation| deviation + kept.deviation);
    let bytes = match &faces {
        Some(faces) if wanted.polygons => faces.file(format, &options).of(output)?,
        _ => write_mesh(&kept.written, format, &options).of(output)?,
    };
    // The report describes the mesh that a reader gets: readers triangulate polygons.
    let mesh = match wanted.polygons {
        true => Cow::Owned(read_mesh(&bytes, &Default::default()).of(output)?.mesh),
        false => kept.read,
    };
    let losses = kept.losses;
    output.write(&bytes)?;
    let report = mesh.report().of(input)?;
    let intersecting = if wanted.intersections {
        let pairs = watched("intersections", job.threads, |control| mesh.intersecting_pairs(0, control));
        Some(pairs.of(input)?)
    } else {
        None
    };
    let told = Report {
        input: input.to_string(),
        output: output.to_string(),
        method,
        format: format_name(format),
        unit: unit.filter(|_| format == MeshFormat::ThreeMf).map(LengthUnit::symbol),
        vertices: report.vertices,
        triangles: report.triangles,
        empty: report.triangles == 0,
        closed: report.is_closed() && report.triangles > 0,
        manifold: report.is_manifold() && report.triangles > 0,
        open_edges: report.boundary_edges,
        non_manifold_edges: report.non_manifold_edges,
        components: report.bodies,
        euler: report.euler_characteristic,
        area: mesh.area(),
        volume: mesh.volume(),
        deviation,
        losses,
        intersecting: intersecting.as_ref().map(|pairs| pairs.count),
        all_intersecting_pairs: intersecting.as_ref().map(|pairs| pairs.is_complete),
        followed,
        regions: faces.as_ref().map(Faces::regions),
        seconds: start.elapsed().as_secs_f64(),
    };
    output.tell(job.json, &told, |told| told.summary(&report))
}

/// Returns the format to write.
fn format(named: Option<MeshFormat>, path: Option<&Path>) -> Result<MeshFormat, Failure> {
    if let Some(format) = named {
        return Ok(format);
    }
    let Some(path) = path else { return Ok(MeshFormat::Ply) };
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.and_then(MeshFormat::from_extension).ok_or_else(|| {
        let problem =
            "has none of the extensions .ply, .stl, .obj, .off and .3mf: name the format with --write";
        Failure::Usage(format!("{}: {problem}", path.display()))
    })
}

/// Returns certain bounds of the volume of a solid: that of a closed mesh to a hundredth, and that of an
/// octree as its cells prove it.
fn certain_volume(source: &Source) -> Result<Option<Interval>, Error> {
    match source {
        Source::Octree(octree) if octree.proof().is_certified() && !octree.view().is_clipped() => {
            Ok(Some(Info::new(octree, 0).volume.interval()))
        }
        Source::Mesh(mesh, ..) => {
            let report = mesh.report()?;
            let bodies = report.overlapping_bodies + report.undecided_bodies + report.inside_out_bodies;
            let volume = mesh.volume();
            let is_known = report.is_closed() && report.triangles > 0 && bodies == 0 && volume > 0.0;
            Ok(Interval::new(0.99 * volume, 1.01 * volume).filter(|_| is_known))
        }
        _ => Ok(None),
    }
}

/// Makes the surface of a tri-dexel model.
fn of_dexels(
    model: &TriDexel,
    job: &Job,
    wanted: &Wanted,
    method: Method,
) -> Result<(TriangleMesh, Followed), Failure> {
    let input = &job.input;
    let given = [
        ("--depth", job.depth.is_some()),
        ("--bounds", job.bounds.is_some()),
        ("--resolve", wanted.resolve.is_some()),
        ("--vertices", wanted.vertices == Some(At::Midpoint)),
        ("--snap", wanted.snap.is_some() && !method.moves_to_samples()),
    ];
    if let Some((option, _)) = given.into_iter().find(|option| option.1) {
        let problem = "is a tri-dexel model, whose rays determine the samples";
        return Err(Failure::Usage(format!("{option} is not for {input}: it {problem}")));
    }
    match method {
        Method::Mc => dexel_surface::cubes(model, input, job.threads),
        Method::Dual => dexel_surface::dual(model, input, job.threads),
        method => {
            let name = name_of(method);
            let problem = "is a tri-dexel model, for which there are mc and dual";
            Err(Failure::Usage(format!("--method {name} is not for {input}: it {problem}")))
        }
    }
}

/// True if the surface follows rays: by dual contouring, and for octrees whose cells keep surfaces, which
/// have their own lattice.
fn asks_rays(source: &Source, wanted: &Wanted, method: Method) -> bool {
    let keeps_surfaces = matches!(source, Source::Octree(_)) && !source.is_of_cells();
    method == Method::Dual || keeps_surfaces && wanted.is_crossed(method)
}

/// Makes the surface of any other shape that follows rays, by way of a tri-dexel model.
fn by_rays(
    source: Source,
    job: &Job,
    wanted: &Wanted,
    method: Method,
) -> Result<(TriangleMesh, Followed), Failure> {
    let input = &job.input;
    if source.is_of_cells() {
        let problem = "is an octree, whose cells have no normals, which dual contouring needs: make a \
                       tri-dexel model from its source, by `leafless dexelize --normals 32`";
        return Err(Failure::of(input, problem));
    }
    if wanted.resolve.is_some() {
        return Err(Failure::Usage("--resolve does not go with --method dual, which follows rays".into()));
    }
    let frame = source.frame_to(input, job.bounds.as_ref(), job.depth, DEPTH)?;
    let solid = source.placed(input, &Affine::IDENTITY, &frame)?;
    by_rays_of(&solid, &frame, job, method)
}

fn by_rays_of(
    solid: &AnySolid,
    frame: &Frame,
    job: &Job,
    method: Method,
) -> Result<(TriangleMesh, Followed), Failure> {
    let input = &job.input;
    let format = DexelFormat { normals: DexelNormals::Bits32, ..Default::default() };
    let options = DexelOptions { format, ..Default::default() };
    let model = watched("dexelize", job.threads, |control| dexelize(solid, frame, &options, control));
    let model = model.of(input)?;
    match method {
        Method::Dual => dexel_surface::dual(&model, input, job.threads),
        _ => dexel_surface::cubes(&model, input, job.threads),
    }
}

/// Makes the surface within a tolerance, and returns it with the method used. If no method is named, another
/// one replaces a method that fails.
fn to_tolerance(
    source: Source,
    job: &Job,
    wanted: &Wanted,
    method: Method,
) -> Result<(TriangleMesh, Method, Option<Faces>, Option<Followed>), Failure> {
    let (input, is_named) = (&job.input, wanted.method.is_some());
    if wanted.resolve.is_some() {
        let name = name_of(method);
        return Err(Failure::Usage(format!(
            "--resolve does not go with --method {name}: it is for samples of cells"
        )));
    }
    let knows_surfaces = match &source {
        Source::Scene(_) | Source::Mesh(..) => true,
        Source::Octree(_) => !source.is_of_cells(),
        _ => false,
    };
    if method == Method::Faces && !knows_surfaces {
        let problem =
            "is no scene, no mesh and no solid whose cells keep surfaces: --method faces is for these";
        return Err(Failure::of(input, problem));
    }
    let tolerance = tolerance(&source, job, wanted)?;
    let bounds = source.bounds(input)?;
    let deepest = if method == Method::Faces { DEEP } else { FINE };
    let frame = source.frame_to(input, job.bounds.as_ref(), job.depth, deepest)?;
    let of_cells = match &source {
        Source::Octree(_) => Some(source.frame_to(input, job.bounds.as_ref(), job.depth, DEPTH)?),
        _ => None,
    };
    let solid = source.placed(input, &Affine::IDENTITY, &frame)?;
    if method == Method::Faces
        && let Some((mesh, faces)) = by_surfaces(&solid, &frame, tolerance, job, is_named)?
    {
        return Ok((mesh, Method::Faces, faces, None));
    }
    if let Some(frame) = of_cells.filter(|_| !is_named) {
        let (mesh, method, followed) = of_layers(&solid, &frame, job, wanted)?;
        return Ok((mesh, method, None, followed));
    }
    let frame =
        if job.depth.is_none() && frame.depth() > FINE { frame.with_depth(FINE).of(input)? } else { frame };
    if let Some(mesh) = by_contour(&solid, &frame, tolerance, job, is_named)? {
        return Ok((mesh, Method::Adaptive, None, None));
    }
    let problem = "its surface extends beyond the cube that is examined";
    complain(&format!("{input}: note: {problem}, and is cut off there by --method mc"));
    let depth = job.depth.unwrap_or(DEPTH);
    let frame = match job.bounds {
        Some(_) => frame.with_depth(depth),
        None => askew::cube(bounds.0, bounds.1, depth),
    };
    let frame = frame.of(input)?;
    let mesh = watched("mesh", job.threads, |control| of_solid(&solid, &frame, wanted, Method::Mc, control));
    Ok((mesh.of(input)?, Method::Mc, None, None))
}

/// Makes the surface of an octree whose cells keep surfaces in layers, or in many cells no surface: by rays
/// if points can be decided, otherwise from its cells.
fn of_layers(
    solid: &AnySolid,
    frame: &Frame,
    job: &Job,
    wanted: &Wanted,
) -> Result<(TriangleMesh, Method, Option<Followed>), Failure> {
    let input = &job.input;
    let coarse = frame.with_depth(frame.depth().min(2)).of(input)?;
    let sampled =
        build(&solid, &coarse, Rule::Sampled, &Control { threads: job.threads, ..Control::default() });
    if !matches!(sampled, Err(Error::NotSampled)) {
        let (mesh, followed) = by_rays_of(solid, frame, job, Method::Mc)?;
        return Ok((mesh, Method::Mc, Some(followed)));
    }
    complain(&format!("{input}: note: {LAYERS}"));
    let mesh = watched("mesh", job.threads, |control| {
        let octree = build(solid, frame, Rule::Certified, control)?;
        of_cells(&octree, Some(Resolve::Outer), wanted, Method::Nets, control)
    });
    Ok((mesh.of(input)?, Method::Nets, None))
}

/// Makes the surface of a solid that provides its surfaces. Returns nothing if it does not, and the method is
/// not named.
fn by_surfaces(
    solid: &AnySolid,
    frame: &Frame,
    tolerance: f64,
    job: &Job,
    is_named: bool,
) -> Result<Option<(TriangleMesh, Option<Faces>)>, Failure> {
    let input = &job.input;
    let found = watched("mesh", job.threads, |control| match boundary(solid, frame, tolerance, control) {
        Err(Error::Argument { name: "solid" | "frame", .. }) if !is_named => Ok(None),
        found => found.map(Some),
    });
    let Some(found) = found.of(input)? else { return Ok(None) };
    let &BoundaryReport { intersecting_pairs, deviation, .. } = found.report();
    warn_of_pairs(input, intersecting_pairs);
    // (A mesh provides no surfaces.)
    let is_known = !found.surfaces().is_empty();
    let faces = is_known.then(|| Faces::of(&found)).transpose().of(input)?;
    let mesh = with_deviation(found.into_mesh(), deviation, tolerance, input)?;
    Ok(Some((mesh, faces)))
}

/// Returns the mesh with its proven distance from the solid, if there is one.
fn with_deviation(
    mesh: TriangleMesh,
    deviation: f64,
    tolerance: f64,
    input: &Input,
) -> Result<TriangleMesh, Failure> {
    if deviation > tolerance {
        let (proven, wanted) = (short(deviation), short(tolerance));
        complain(&if deviation.is_finite() {
            format!("{input}: warning: the mesh is proven to be within {proven} of the solid, not {wanted}")
        } else {
            format!("{input}: warning: how far the mesh is from the solid is not proven")
        });
    }
    if deviation.is_finite() { mesh.with_deviation(deviation).of(input) } else { Ok(mesh) }
}

/// Returns the greatest distance of a surface from the solid; by default relative to the longest extent.
fn tolerance(source: &Source, job: &Job, wanted: &Wanted) -> Result<f64, Failure> {
    let (low, high) = source.bounds(&job.input)?;
    let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    Ok(wanted.tolerance.unwrap_or(FACES * size))
}

fn warn_of_pairs(input: &Input, pairs: u64) {
    if pairs > 0 {
        let pairs = counted(pairs, "pair", "pairs");
        complain(&format!(
            "{input}: warning: {pairs} of triangles intersect: a greater --depth may tell them apart"
        ));
    }
}

/// Makes the surface in cells that end where one vertex suffices. Returns nothing if the solid extends beyond
/// the cube, and the method is not named.
fn by_contour(
    solid: &AnySolid,
    frame: &Frame,
    tolerance: f64,
    job: &Job,
    is_named: bool,
) -> Result<Option<TriangleMesh>, Failure> {
    let input = &job.input;
    let found = watched("mesh", job.threads, |control| match contour(solid, frame, tolerance, control) {
        Err(Error::Argument { name: "frame", .. }) if !is_named => Ok(None),
        found => found.map(Some),
    });
    let Some(found) = found.of(input)? else { return Ok(None) };
    let &ContourReport { intersecting_pairs, deviation, .. } = found.report();
    warn_of_pairs(input, intersecting_pairs);
    with_deviation(found.into_mesh(), deviation, tolerance, input).map(Some)
}

fn extract(source: Source, job: &Job, wanted: &Wanted, method: Method) -> Result<TriangleMesh, Failure> {
    let input = &job.input;
    let resolve = match (wanted.resolve, &source) {
        (None, _) => None,
        (Some(ResolveName::Inner), _) => Some(Resolve::Inner),
        (Some(ResolveName::Outer), _) => Some(Resolve::Outer),
        (Some(ResolveName::Source), source) if source.is_of_cells() => {
            let problem = "a solid from a file has no source to ask: --resolve can be inner or outer";
            return Err(Failure::of(input, problem));
        }
        (Some(ResolveName::Source), _) => None,
    };
    if let Source::Octree(octree) = &source
        && source.is_of_cells()
    {
        if job.bounds.is_some() {
            return Err(Failure::Usage("--bounds is for meshes and scenes: a solid has its own".into()));
        }
        let octree = coarser(octree, job)?;
        let is_open = resolve.is_none() && !octree.view().is_binary();
        if is_open {
            complain(&format!("{input}: {UNDECIDED}"));
        }
        let resolve = if is_open { Some(Resolve::Outer) } else { resolve };
        return watched("mesh", job.threads, |control| of_cells(&octree, resolve, wanted, method, control))
            .of(input);
    }
    let is_plain = job.depth.is_none() && job.bounds.is_none() && wanted.resolve.is_none();
    if let Source::Volume(voxels) = &source
        && is_plain
        && wanted.is_crossed(method)
    {
        return of_volume(voxels, job);
    }
    // A volume has its own samples, if its voxels are cubes; an octree has those of its lattice at any depth.
    let has_own =
        source.own_frame().is_some() && (job.depth.is_none() || matches!(source, Source::Octree(_)));
    let frame = match &source {
        Source::Mesh(..) | Source::Scene(_) if wanted.is_crossed(method) && job.bounds.is_none() => {
            let (low, high) = source.bounds(input)?;
            askew::cube(low, high, job.depth.unwrap_or(DEPTH)).of(input)?
        }
        source => source.frame_to(input, job.bounds.as_ref(), job.depth, DEPTH)?,
    };
    let solid = source.placed(input, &Affine::IDENTITY, &frame)?;
    watched("mesh", job.threads, |control| match wanted.resolve {
        None if !has_own && method != Method::Nets => of_solid(&solid, &frame, wanted, method, control),
        _ => {
            let rule = if resolve.is_some() { Rule::Certified } else { Rule::Sampled };
            let octree = build(&solid, &frame, rule, control)?;
            of_cells(&octree, resolve, wanted, method, control)
        }
    })
    .of(input)
}

/// Makes the surface of a volume by marching cubes, with vertices where the samples cross the threshold.
fn of_volume(voxels: &Voxels, job: &Job) -> Result<TriangleMesh, Failure> {
    let mesh = watched("mesh", job.threads, |control| marching_cubes_volume(&voxels.volume, control));
    let mesh = mesh.of(&job.input)?;
    match &voxels.placement {
        Some(placement) => mesh.placed(placement).of(&job.input),
        None => Ok(mesh),
    }
}

/// Returns the octree with cells no smaller than --depth says; cells that are split further become undecided.
fn coarser(octree: &Octree, job: &Job) -> Result<Octree, Failure> {
    let input = &job.input;
    let own = octree.frame().depth();
    match job.depth {
        None => Ok(octree.clone()),
        Some(depth) if depth > own => {
            Err(Failure::Usage(format!("--depth {depth} is beyond the depth of {input}, which is {own}")))
        }
        Some(depth) => {
            let frame = octree.frame().with_depth(depth).of(input)?;
            watched("mesh", job.threads, |control| build(octree.view(), &frame, Rule::Certified, control))
                .of(input)
        }
    }
}

/// Makes the surface of an octree.
fn of_cells(
    octree: &Octree,
    resolve: Option<Resolve<'_>>,
    wanted: &Wanted,
    method: Method,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let snap = wanted.snap.unwrap_or_default().into();
    match method {
        Method::Dual | Method::Faces | Method::Adaptive => {
            unreachable!("this method does not sample the cells of an octree")
        }
        Method::Mc => marching_cubes(octree.view(), resolve, control),
        Method::Nets => surface_nets(octree.view(), resolve, control),
        Method::Smc => simple_marching_cubes(octree.view(), snap, resolve, control),
        Method::Shrink => coplanar_shrink(octree.view(), snap, resolve, control),
        Method::ShrinkPublished => published_shrink(octree.view(), snap, resolve, control),
    }
}

/// Makes the surface of a solid that is sampled at the corners of cells.
pub fn of_solid(
    solid: &AnySolid,
    frame: &Frame,
    wanted: &Wanted,
    method: Method,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let placement = match wanted.vertices.unwrap_or_default() {
        At::Midpoint => VertexPlacement::Midpoint,
        At::Crossing => VertexPlacement::Crossing,
    };
    let snap = wanted.snap.unwrap_or_default().into();
    match method {
        Method::Dual | Method::Faces | Method::Adaptive | Method::Nets => {
            unreachable!("this method does not sample the corners of cells")
        }
        Method::Mc => marching_cubes_solid(solid, frame, placement, control),
        Method::Smc => simple_marching_cubes_solid(solid, frame, snap, control),
        Method::Shrink => coplanar_shrink_solid(solid, frame, snap, control),
        Method::ShrinkPublished => published_shrink_solid(solid, frame, snap, control),
    }
}

/// The report on a surface, as a reader gets it back from the file.
#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    method: String,
    format: &'static str,
    /// The unit in a 3MF; other formats have none.
    unit: Option<&'static str>,
    vertices: u64,
    triangles: u64,
    /// True if there is no triangle.
    empty: bool,
    /// True if the surface bounds a solid. An empty surface does not, as in `leafless info`.
    closed: bool,
    manifold: bool,
    /// Number of edges that an odd number of triangles use.
    open_edges: u64,
    /// Number of edges that more than two triangles use.
    non_manifold_edges: u64,
    components: u64,
    euler: i64,
    area: f64,
    volume: f64,
    /// Proven bound of the distance between surface and boundary, in both directions; null if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    deviation: Option<f64>,
    #[serde(flatten)]
    losses: Losses,
    /// Number of pairs of triangles that intersect, if they were counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    intersecting: Option<u64>,
    /// True if these are all pairs.
    #[serde(skip_serializing_if = "Option::is_none")]
    all_intersecting_pairs: Option<bool>,
    /// Statistics of the rays that the surface follows, if it does.
    #[serde(flatten)]
    followed: Option<Followed>,
    /// The parts of the boundary on one surface each, if they are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    regions: Option<Vec<Region>>,
    seconds: f64,
}

impl Report {
    fn summary(&self, report: &MeshReport) -> String {
        let mut text = String::new();
        let sound = match (self.closed, self.manifold) {
            _ if self.empty && self.losses.has_lost() => "empty: rounding leaves no triangle".to_owned(),
            _ if self.empty => {
                "empty: there are no triangles, because no surface passes between samples".to_owned()
            }
            (true, true) => "closed, 2-manifold".to_owned(),
            (true, false) => {
                let edges = counted(report.non_manifold_edges, "edge", "edges");
                format!("closed; at {edges} more than two triangles meet")
            }
            (false, _) => format!("open at {}", counted(report.boundary_edges, "edge", "edges")),
        };
        // Writing to memory does not fail.
        let _ = writeln!(
            text,
            "{}: {}, {}, {}; {sound}\n{}, Euler characteristic {}\narea {}, volume {}; {:.2} s",
            self.output,
            self.format,
            counted(self.vertices, "vertex", "vertices"),
            counted(self.triangles, "triangle", "triangles"),
            counted(self.components, "component", "components"),
            self.euler,
            number(self.area),
            number(self.volume),
            self.seconds,
        );
        if let Some(deviation) = self.deviation {
            let _ = writeln!(text, "within {} of the solid: proven", short(deviation));
        }
        if let Some(losses) = self.losses.text() {
            let _ = writeln!(text, "{losses}");
        }
        if let Some(followed) = &self.followed {
            let _ = writeln!(text, "{}", followed.text());
        }
        if let Some(pairs) = self.intersecting {
            let more = if self.all_intersecting_pairs == Some(false) { " or more" } else { "" };
            let _ = writeln!(text, "{}{more} of triangles that intersect", counted(pairs, "pair", "pairs"));
        }
        text
    }
}
