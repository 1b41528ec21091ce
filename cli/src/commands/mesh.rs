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

/// Without --method, the input decides how the surface is made. Faces: a scene, and a solid from a file
/// (.lfl) whose cells keep surfaces, give their surfaces themselves; a closed mesh gives its triangles,
/// merged within --tolerance. Adaptive: a mesh that is not closed, or whose triangles intersect, is split
/// into cells of several sizes. Both methods keep sharp edges, make few triangles, and report a proven bound
/// of their distance from the solid. Dual: a scene that contains meshes, and a tri-dexel model with normals,
/// get vertices where rays leave the solid, with sharp edges. Mc (marching cubes): a tri-dexel model without
/// normals, a solid that keeps layers of a mesh, and a volume. Nets (surface nets): a solid that consists of
/// cells only.
///
/// By the method faces, curved faces become chords within --tolerance. The method adaptive takes any input,
/// and its surface is about as near as --tolerance says. The method dual first makes a tri-dexel model of a
/// mesh, a scene or a volume, and the method nets an octree.
///
/// The methods other than faces and adaptive separate samples inside from samples outside. The samples of a
/// mesh or a scene are the corners of cells, and vertices lie where the edges between corners cross the
/// surface. The samples of a volume are its voxels, those of a tri-dexel model the centres of its cells, and
/// those of a solid from a file its cells at the finest level; undecided cells count as inside, unless
/// --resolve says otherwise. A solid whose cells keep surfaces is split to --depth; with --method mc and
/// dual, vertices lie where rays through cell centres cross these surfaces.
#[derive(Args)]
pub struct Arguments {
    /// Solid or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD,
    /// MetaImage), or `-` for standard input
    file: OsString,
    /// File to write, with the extension .ply, .stl, .obj, .off or .3mf, or `-` for standard output
    #[arg(short, long, value_name = "OUTPUT")]
    output: OsString,
    /// How the surface is made [default: as sharp as the input allows, see Details]
    #[arg(long, value_enum)]
    method: Option<Method>,
    /// Remove triangles from the surface after any method, moving it by at most T, in model units. Edges of
    /// the shape and values of triangles stay
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    simplify: Option<f64>,
    /// Put the values of a channel, or the colours or materials of a mesh, on the triangles. PLY stores any
    /// values, 3MF colours and materials, OBJ materials. Three or four numbers are a colour; one is the
    /// number of a material in OBJ and 3MF. The channel of a tri-dexel model is "material"
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// Also count pairs of triangles that intersect
    #[arg(long)]
    intersections: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Greatest distance of the surface from the solid by the methods faces and adaptive, in model units. The
    /// report tells the distance [default: a thousandth of the longest extent]
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Level of the cells of a mesh, a scene, or a solid whose cells keep surfaces, 1 to 19: of all cells, or
    /// of the smallest ones by the methods faces and adaptive. A solid from a file may have its own level or
    /// a coarser one [default: 8; faces 14; adaptive 12; the voxels of a volume]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// What undecided cells count as. Given for a mesh or scene, the samples are its cells, made as `leafless
    /// voxelize` makes them, instead of the corners, and the default method is nets
    #[arg(long, value_enum)]
    resolve: Option<ResolveName>,
    /// Where --method mc puts the vertices of a mesh, scene or volume. Given without --method, it implies mc
    /// [default: crossing]
    #[arg(long, value_enum)]
    vertices: Option<At>,
    /// Where the methods smc, shrink and shrink-published move vertices to. Given without --method, it
    /// implies smc [default: fat]
    #[arg(long, value_enum)]
    snap: Option<SnapName>,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Lower corner and edge length of the cube to examine, for a mesh or scene [default: a cube around it;
    /// where vertices lie on the surface, the cube is chosen so that usually no face lies in its lattice]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    /// Format to write [default: by the extension of the output; PLY for standard output]
    #[arg(long, value_parser = formats(["ply", "stl", "obj", "off", "3mf"]))]
    write: Option<MeshFormat>,
    /// Write normals at vertices, in PLY and OBJ
    #[arg(long)]
    normals: bool,
    /// Write plane faces as polygons, in OBJ and OFF, with --method faces. In an OBJ each face is a group,
    /// and so are all faces of one surface. (--json tells the kind and the numbers of the surfaces, with or
    /// without polygons)
    #[arg(long)]
    polygons: bool,
    /// Write STL and PLY as text
    #[arg(long)]
    text: bool,
    /// Write the file even if rounding to its coordinates breaks the surface: STL has 32-bit coordinates.
    /// Broken places are first repaired by moving vertices to adjacent coordinates. Without --lossy, a
    /// surface that is still broken after that is not written
    #[arg(long)]
    lossy: bool,
    #[command(flatten)]
    taking: Taking,
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
