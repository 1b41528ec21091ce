//! `leafless mesh`: the surface of a solid.

use crate::commands::conversion;
use crate::failure::{Failure, Of};
use crate::making::dexel_surface::{self, Followed};
use crate::options::{bounds, name_of, threads};
use crate::progress::watched;
use crate::sink::written::{self, Losses};
use crate::sink::{self, Output, write_file};
use crate::source::Source;
use crate::source::input::Input;
use crate::source::mesh::{Reading, format_name};
use crate::source::scene::Drawing;
use crate::source::shape::Shape;
use crate::words::{counted, number};
use clap::{Args, ValueEnum};
use leafless::exchange::{LengthUnit, MeshFormat, WriteOptions, write_mesh};
use leafless::{
    Affine, AnySolid, Control, DexelFormat, DexelNormals, DexelOptions, Error, Frame, MAX_DEPTH, MeshReport,
    Octree, Resolve, Rule, Snap, TriDexel, TriangleMesh, VertexPlacement, build, coplanar_shrink,
    coplanar_shrink_of, dexelize, marching_cubes, marching_cubes_of, published_shrink, published_shrink_of,
    smc, smc_of,
};
use serde::Serialize;
use std::ffi::OsString;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Writes the surface of a solid as a closed triangle mesh.
///
/// The surface separates samples that lie inside from those outside. Samples of a mesh or a scene are the corners of
/// cells, and vertices lie where the edges between corners cross the surface. Samples of a volume are its voxels, and of
/// a solid from a file (.lfl) its cells at their finest level; what is undecided there has no sign, so that --resolve must say what it counts as.
/// Samples of a tri-dexel model are the centres of its cells, and vertices lie where its rays leave the solid.
#[derive(Args)]
pub struct Arguments {
    /// Solid or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-`
    /// for standard input
    file: OsString,
    /// Where to write: the extension .ply, .stl, .obj, .off or .3mf tells the format; `-` is standard output
    #[arg(short, long, value_name = "OUTPUT")]
    output: OsString,
    /// Format to write. Without it: what the extension of the output says, or PLY for standard output
    #[arg(long, value_enum)]
    write: Option<WriteName>,
    /// Write STL and PLY as text
    #[arg(long)]
    text: bool,
    /// Write normals at vertices, in PLY and OBJ
    #[arg(long)]
    normals: bool,
    /// Write the file also if rounding to its coordinates breaks the surface: STL has 32-bit ones. Without it such a file
    /// is refused
    #[arg(long)]
    lossy: bool,
    /// How the surface is made
    #[arg(long, value_enum, default_value_t = Method::Mc)]
    method: Method,
    /// Where the methods smc, shrink and shrink-published move vertices to
    #[arg(long, value_enum, default_value_t = SnapName::Fat)]
    snap: SnapName,
    /// Where --method mc puts vertices of a mesh, scene or volume
    #[arg(long, value_enum, default_value_t = At::Crossing)]
    vertices: At,
    /// What undecided cells count as. Given for a mesh or scene, its cells are the samples, made as `leafless voxelize`
    /// makes them, and not the corners
    #[arg(long, value_enum)]
    resolve: Option<ResolveName>,
    /// Level of the cells of a mesh or scene, 1 to 19. Without it: 8, and of a volume the voxels. Of a solid from a file
    /// its own or a coarser one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Lower corner and edge length of the cube to look at, for a mesh or scene. Without it: the cube around it
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    drawing: Drawing,
    /// Also count pairs of triangles that intersect each other
    #[arg(long)]
    intersections: bool,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The depth of meshes and scenes, if none is asked for.
const DEPTH: u8 = 8;

#[derive(Debug, Clone, Copy, ValueEnum)]
enum WriteName {
    Ply,
    Stl,
    Obj,
    Off,
    #[value(name = "3mf")]
    ThreeMf,
}

impl From<WriteName> for MeshFormat {
    fn from(name: WriteName) -> MeshFormat {
        match name {
            WriteName::Ply => MeshFormat::Ply,
            WriteName::Stl => MeshFormat::Stl,
            WriteName::Obj => MeshFormat::Obj,
            WriteName::Off => MeshFormat::Off,
            WriteName::ThreeMf => MeshFormat::ThreeMf,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Method {
    /// Marching cubes
    Mc,
    /// Dual contouring, which keeps edges and corners: of a tri-dexel model with normals. Of a mesh, a scene or a volume
    /// one is made first
    Dual,
    /// Simple marching cubes: all vertices are samples, all normals have one of 13 directions
    Smc,
    /// The surface of smc, with one region of few triangles for all that lies in one plane; no cracks
    Shrink,
    /// Coplanar shrink as it was published, to compare with: it has cracks
    ShrinkPublished,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum SnapName {
    /// To the samples outside
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

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum At {
    /// Half-way between an inside and an outside sample
    Midpoint,
    /// Where the line between them crosses the surface
    Crossing,
}

impl Arguments {
    /// What `leafless convert` asks for.
    pub fn converting(wanted: &conversion::Arguments) -> Arguments {
        Arguments {
            file: wanted.input.clone(),
            output: wanted.output.clone(),
            write: None,
            text: false,
            normals: false,
            lossy: wanted.lossy,
            method: Method::Mc,
            snap: SnapName::Fat,
            vertices: At::Crossing,
            resolve: wanted.resolve.map(|resolve| match resolve {
                conversion::ResolveName::Inner => ResolveName::Inner,
                conversion::ResolveName::Outer => ResolveName::Outer,
            }),
            depth: wanted.resolution,
            bounds: wanted.bounds,
            reading: wanted.reading.clone(),
            drawing: wanted.drawing.clone(),
            intersections: false,
            threads: wanted.threads,
            json: wanted.json,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ResolveName {
    /// Outside: the surface is that of what is proven to be solid
    Inner,
    /// Inside: the surface is that of what may be solid
    Outer,
    /// Where the mesh or the scene says: at the cell's centre
    Source,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let start = Instant::now();
    let (input, output) = (Input::from(&*arguments.file), Output::from(&*arguments.output));
    output.check()?;
    let format = format(arguments, output.path())?;
    if arguments.normals && !matches!(format, MeshFormat::Ply | MeshFormat::Obj) {
        let name = format_name(format).to_uppercase();
        return Err(Failure::Usage(format!(
            "--normals is for PLY and OBJ: {name} has no normals at vertices"
        )));
    }
    let (unit, mesh, followed) = match Shape::read(&input, &arguments.reading, &arguments.drawing)?.0 {
        Shape::Dexels(model) => {
            let unit = model.metadata().get("units").and_then(|unit| unit.parse().ok());
            let (mesh, followed) = of_dexels(&model, &input, arguments)?;
            (unit, mesh, Some(followed))
        }
        Shape::Source(source) if arguments.method == Method::Dual => {
            let unit = source.unit();
            let (mesh, followed) = dual(source, &input, arguments)?;
            (unit, mesh, Some(followed))
        }
        Shape::Source(source) => (source.unit(), extract(source, &input, arguments)?, None),
    };
    let options = WriteOptions { text: arguments.text, unit, normals: arguments.normals };
    let (kept, losses) = written::kept(&mesh, format, &options, arguments.lossy, &output)?;
    let bytes = write_mesh(&mesh, format, &options).of(&output)?;
    // What is told is what a reader gets.
    let mesh = kept.mesh;
    match output.path() {
        Some(path) => write_file(path, &bytes)?,
        None => sink::print(&bytes)?,
    }
    let report = mesh.report().of(&input)?;
    let intersecting = if arguments.intersections {
        let pairs =
            watched("intersections", arguments.threads, |control| mesh.intersecting_pairs(0, control));
        Some(pairs.of(&input)?)
    } else {
        None
    };
    let told = Report {
        input: input.to_string(),
        output: output.to_string(),
        method: name_of(arguments.method),
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
        losses,
        intersecting: intersecting.as_ref().map(|pairs| pairs.count),
        all_intersecting_pairs: intersecting.as_ref().map(|pairs| pairs.is_complete),
        followed,
        seconds: start.elapsed().as_secs_f64(),
    };
    output.report(&if arguments.json { sink::json(&told)? } else { told.summary(&report) })
}

/// The format to write.
fn format(arguments: &Arguments, path: Option<&Path>) -> Result<MeshFormat, Failure> {
    if let Some(name) = arguments.write {
        return Ok(name.into());
    }
    let Some(path) = path else { return Ok(MeshFormat::Ply) };
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.and_then(MeshFormat::from_extension).ok_or_else(|| {
        let problem =
            "has none of the extensions .ply, .stl, .obj, .off and .3mf: name the format with --write";
        Failure::Usage(format!("{}: {problem}", path.display()))
    })
}

/// The surface of a tri-dexel model.
fn of_dexels(
    model: &TriDexel,
    input: &Input,
    arguments: &Arguments,
) -> Result<(TriangleMesh, Followed), Failure> {
    let given = [
        ("--depth", arguments.depth.is_some()),
        ("--bounds", arguments.bounds.is_some()),
        ("--resolve", arguments.resolve.is_some()),
        ("--vertices", arguments.vertices != At::Crossing),
    ];
    if let Some((option, _)) = given.into_iter().find(|option| option.1) {
        let problem = "is a tri-dexel model, whose rays leave nothing to choose";
        return Err(Failure::Usage(format!("{option} is not for {input}: it {problem}")));
    }
    match arguments.method {
        Method::Mc => dexel_surface::cubes(model, input, arguments.threads),
        Method::Dual => dexel_surface::dual(model, input, arguments.threads),
        method => {
            let name = name_of(method);
            let problem = "is a tri-dexel model, for which there are mc and dual";
            Err(Failure::Usage(format!("--method {name} is not for {input}: it {problem}")))
        }
    }
}

/// The surface of anything else by dual contouring: of a tri-dexel model that is made for it.
fn dual(source: Source, input: &Input, arguments: &Arguments) -> Result<(TriangleMesh, Followed), Failure> {
    if let Source::Octree(_) = source {
        let problem = "is an octree, whose cells know no normals, which dual contouring needs: make a tri-dexel model \
                       of what it was made of, by `leafless dexelize --normals 32`";
        return Err(Failure::of(input, problem));
    }
    if arguments.resolve.is_some() {
        return Err(Failure::Usage("--resolve does not go with --method dual, which asks rays".into()));
    }
    let has_own = source.own_frame().is_some() && arguments.depth.is_none();
    let depth = if has_own { None } else { Some(arguments.depth.unwrap_or(DEPTH)) };
    let frame = source.frame_in(input, arguments.bounds.as_ref(), depth)?;
    let solid = source.placed(input, &Affine::IDENTITY, &frame)?;
    let format = DexelFormat { normals: DexelNormals::Bits32, ..Default::default() };
    let options = DexelOptions { format, ..Default::default() };
    let model = watched("dexelize", arguments.threads, |control| dexelize(&solid, &frame, &options, control));
    dexel_surface::dual(&model.of(input)?, input, arguments.threads)
}

fn extract(source: Source, input: &Input, arguments: &Arguments) -> Result<TriangleMesh, Failure> {
    let resolve = match (arguments.resolve, &source) {
        (None, _) => None,
        (Some(ResolveName::Inner), _) => Some(Resolve::Inner),
        (Some(ResolveName::Outer), _) => Some(Resolve::Outer),
        (Some(ResolveName::Source), Source::Octree(_)) => {
            let problem =
                "a solid from a file has no source: undecided cells can be resolved as inner or outer";
            return Err(Failure::of(input, problem));
        }
        (Some(ResolveName::Source), _) => None,
    };
    if let Source::Octree(octree) = source {
        if arguments.bounds.is_some() {
            return Err(Failure::Usage("--bounds is for meshes and scenes: a solid has its own".into()));
        }
        let octree = coarser(*octree, input, arguments)?;
        if resolve.is_none() && !octree.view().is_binary() {
            let problem = "has undecided cells, which are neither inside nor outside: choose --resolve inner or \
                           --resolve outer, or make it anew from its source with --rule sampled";
            return Err(Failure::of(input, problem));
        }
        return watched("mesh", arguments.threads, |control| of_cells(&octree, resolve, arguments, control))
            .of(input);
    }
    let is_plain = arguments.depth.is_none() && arguments.bounds.is_none() && arguments.resolve.is_none();
    if let Source::Volume(voxels) = &source
        && is_plain
        && arguments.method == Method::Mc
        && arguments.vertices == At::Crossing
    {
        return voxels.surface(input, arguments.threads);
    }
    // A volume has its own samples, if its voxels are cubes.
    let has_own = source.own_frame().is_some() && arguments.depth.is_none();
    let depth = if has_own { None } else { Some(arguments.depth.unwrap_or(DEPTH)) };
    let frame = source.frame_in(input, arguments.bounds.as_ref(), depth)?;
    let solid = source.placed(input, &Affine::IDENTITY, &frame)?;
    watched("mesh", arguments.threads, |control| match arguments.resolve {
        None if !has_own => of_solid(&solid, &frame, arguments, control),
        _ => {
            let rule = if resolve.is_some() { Rule::Certified } else { Rule::Sampled };
            let octree = build(&solid, &frame, rule, control)?;
            of_cells(&octree, resolve, arguments, control)
        }
    })
    .of(input)
}

/// The octree with cells no smaller than --depth says; those that are cut further are undecided.
fn coarser(octree: Octree, input: &Input, arguments: &Arguments) -> Result<Octree, Failure> {
    let own = octree.frame().depth();
    match arguments.depth {
        None => Ok(octree),
        Some(depth) if depth > own => {
            Err(Failure::Usage(format!("--depth {depth} is beyond the depth of {input}, which is {own}")))
        }
        Some(depth) => {
            let frame = octree.frame().with_depth(depth).of(input)?;
            watched("mesh", arguments.threads, |control| {
                build(octree.view(), &frame, Rule::Certified, control)
            })
            .of(input)
        }
    }
}

/// The surface of an octree.
fn of_cells(
    octree: &Octree,
    resolve: Option<Resolve<'_>>,
    arguments: &Arguments,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let snap = arguments.snap.into();
    match arguments.method {
        Method::Dual => unreachable!("dual contouring asks rays"),
        Method::Mc => marching_cubes(octree.view(), resolve, control),
        Method::Smc => smc(octree.view(), snap, resolve, control),
        Method::Shrink => coplanar_shrink(octree.view(), snap, resolve, control),
        Method::ShrinkPublished => published_shrink(octree.view(), snap, resolve, control),
    }
}

/// The surface of a solid that is sampled at the corners of cells.
fn of_solid(
    solid: &AnySolid,
    frame: &Frame,
    arguments: &Arguments,
    control: &Control<'_>,
) -> Result<TriangleMesh, Error> {
    let placement = match arguments.vertices {
        At::Midpoint => VertexPlacement::Midpoint,
        At::Crossing => VertexPlacement::Crossing,
    };
    let snap = arguments.snap.into();
    match arguments.method {
        Method::Dual => unreachable!("dual contouring asks rays"),
        Method::Mc => marching_cubes_of(solid, frame, placement, control),
        Method::Smc => smc_of(solid, frame, snap, control),
        Method::Shrink => coplanar_shrink_of(solid, frame, snap, control),
        Method::ShrinkPublished => published_shrink_of(solid, frame, snap, control),
    }
}

/// What is told of a surface, as a reader gets it back from the file.
#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    method: String,
    format: &'static str,
    /// What a 3MF says; others have none.
    unit: Option<&'static str>,
    vertices: u64,
    triangles: u64,
    /// Whether there is no triangle.
    empty: bool,
    /// Whether the surface bounds a solid. An empty one does not, as `leafless info` has it.
    closed: bool,
    manifold: bool,
    /// Edges that an odd number of triangles use.
    open_edges: u64,
    /// Edges that more than two triangles use.
    non_manifold_edges: u64,
    components: u64,
    euler: i64,
    area: f64,
    volume: f64,
    #[serde(flatten)]
    losses: Losses,
    /// Pairs of triangles that intersect, if they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    intersecting: Option<u64>,
    /// Whether these are all.
    #[serde(skip_serializing_if = "Option::is_none")]
    all_intersecting_pairs: Option<bool>,
    /// How exactly the surface follows rays, if it does.
    #[serde(flatten)]
    followed: Option<Followed>,
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
