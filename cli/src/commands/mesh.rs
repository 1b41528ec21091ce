//! `leafless mesh`: the surface of a solid.

use crate::failure::Failure;
use crate::making::job::Job;
use crate::making::surface::{At, Method, ResolveName, SnapName, Wanted, make};
use crate::options::{bounds, formats, threads, tolerance};
use crate::sink::Output;
use crate::source::file::Taking;
use crate::source::input::Input;
use clap::Args;
use leafless::Frame;
use leafless::exchange::MeshFormat;
use leafless::lattice::MAX_DEPTH;
use std::ffi::OsString;
use std::time::Instant;

/// Where --method does not say how, what is known of the shape does. A scene has its surfaces themselves
/// (faces), and so has a solid from a file (.lfl) whose cells keep surfaces; a closed mesh has its triangles,
/// merged within --tolerance. A mesh that is not closed, or whose triangles intersect, has cells of several
/// sizes (adaptive). Both are sharp, have few triangles, and say what is proven of their distance from the
/// solid. A scene with meshes in it has vertices where rays leave the solid, with sharp edges (dual), and so
/// has a tri-dexel model (mc if it has no normals). A solid from a file that is no more than cells has
/// surface nets (nets), one that keeps layers of a mesh, and a volume, marching cubes (mc).
///
/// All other methods separate samples that lie inside from those outside. Samples of a mesh or a scene are
/// the corners of cells, and vertices lie where the edges between corners cross the surface. Samples of a
/// volume are its voxels, of a tri-dexel model the centres of its cells, and of a solid from a file its cells
/// at their finest level; what is undecided there counts as inside, unless --resolve says otherwise. A solid
/// whose cells keep surfaces is split to --depth; with --method mc and dual, vertices lie where rays through
/// cell centres cross these surfaces.
#[derive(Args)]
pub struct Arguments {
    /// Solid or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD,
    /// MetaImage), or `-` for standard input
    file: OsString,
    /// Where to write: the extension .ply, .stl, .obj, .off or .3mf tells the format; `-` is standard output
    #[arg(short, long, value_name = "OUTPUT")]
    output: OsString,
    /// Format to write. Without it: what the extension of the output says, or PLY for standard output
    #[arg(long, value_parser = formats(["ply", "stl", "obj", "off", "3mf"]))]
    write: Option<MeshFormat>,
    /// Write STL and PLY as text
    #[arg(long)]
    text: bool,
    /// Write normals at vertices, in PLY and OBJ
    #[arg(long)]
    normals: bool,
    /// Write the file also if rounding to its coordinates breaks the surface: STL has 32-bit ones. What
    /// rounding breaks is mended first, by moving vertices to places next to theirs. Without --lossy a file
    /// is refused that is broken after that
    #[arg(long)]
    lossy: bool,
    /// How the surface is made. Without it: as sharp as what is known allows
    #[arg(long, value_enum)]
    method: Option<Method>,
    /// Where the methods smc, shrink and shrink-published move vertices to. Without it: fat. Given without
    /// --method: smc
    #[arg(long, value_enum)]
    snap: Option<SnapName>,
    /// Where --method mc puts vertices of a mesh, scene or volume. Without it: crossing. Given without
    /// --method: mc
    #[arg(long, value_enum)]
    vertices: Option<At>,
    /// How far the surface may be from the solid by the methods faces and adaptive, in model units. Without
    /// it: a thousandth of the longest extent. How far it is, the report says
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Take triangles out of the surface once it is made, whatever made it, and move it by this at the most,
    /// in model units. Edges of the shape and values of triangles stay
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    simplify: Option<f64>,
    /// Write plane faces as polygons, into OBJ and OFF, with --method faces. In an OBJ each face is a group,
    /// and all faces of one surface are another. (--json tells the kind and the numbers of the surfaces, with
    /// polygons or without)
    #[arg(long)]
    polygons: bool,
    /// Put the values of a channel, or of the colours or materials of a mesh, on the triangles: PLY has a
    /// place for any, 3MF for colours and materials, OBJ for materials. Three or four numbers are a colour,
    /// one is the number of a material in OBJ and 3MF. The channel of a tri-dexel model is "material"
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// What undecided cells count as. Given for a mesh or scene, its cells are the samples, made as
    /// `leafless voxelize` makes them, and not the corners; without --method: nets
    #[arg(long, value_enum)]
    resolve: Option<ResolveName>,
    /// Level of the cells of a mesh, a scene, or a solid whose cells keep surfaces, 1 to 19: of all of them,
    /// or by the methods faces and adaptive of the smallest. Without it: 8, by faces 14, by adaptive 12, and
    /// of a volume the voxels. Of a solid from a file its own or a coarser one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Lower corner and edge length of the cube to look at, for a mesh or scene. Without it: a cube around
    /// it, in whose lattice no face lies as a rule where vertices lie on the surface
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    taking: Taking,
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

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { depth, bounds, threads, json, .. } = *arguments;
    let (input, output) = (Input::from(&*arguments.file), Output::from(&*arguments.output));
    let job = Job { input, output, start: Instant::now(), depth, bounds, threads, json };
    let Arguments {
        method,
        snap,
        vertices,
        tolerance,
        resolve,
        text,
        normals,
        lossy,
        intersections,
        polygons,
        simplify,
        write: format,
        ..
    } = *arguments;
    let wanted = Wanted {
        method,
        snap,
        vertices,
        tolerance,
        resolve,
        format,
        text,
        normals,
        lossy,
        intersections,
        copy: false,
        polygons,
        simplify,
        channel: arguments.channel.clone(),
    };
    make(&job, &arguments.taking, &wanted)
}
