//! `leafless voxelize`: from a mesh or a volume to a solid.

use crate::failure::Failure;
use crate::making::job::Job;
use crate::making::like::Like;
use crate::making::octree_of_dexel_surface;
use crate::making::octree_of_mesh::{self, Voxelizing};
use crate::making::surfaces::Surfaces;
use crate::options::{bounds, octree_rules, threads};
use crate::sink::Output;
use crate::source::content::Content;
use crate::source::file::Found;
use crate::source::input::Input;
use crate::source::mesh::Reading;
use crate::source::placing::Placing;
use clap::Args;
use leafless::{Frame, Rule};
use std::ffi::OsString;
use std::time::Instant;

/// Cuts the cube around a mesh into 2^N × 2^N × 2^N cells. Only cells near the surface are stored one by one.
/// By the certified rule every cell is proven inside, proven outside, or undecided because the surface may
/// pass through it. No cell that the surface passes through is missed.
///
/// The mesh should be closed: every edge is shared by an even number of triangles that face the same side.
/// Where the mesh has holes or inverted facets, the winding number decides what is inside. Cells near them
/// may stay undecided, and a warning says so. Bodies may overlap. Vertices that differ by no more than single
/// precision can express are merged, and the report tells how many.
///
/// With --surfaces the input may also be a tri-dexel model that stores normals. Its surface is reconstructed
/// from the ends and normals of its intervals (as by `leafless mesh --method dual`), and the octree keeps
/// this surface. Certified cells are certified with respect to the reconstructed surface. Nothing is proven
/// about the part that the model was sampled from.
///
/// The file records the input's name, length and checksum, the rule, and the unit if it is known. Equal input
/// gives equal bytes, for any number of threads.
#[derive(Args)]
pub struct Arguments {
    /// Mesh (STL, OBJ, PLY, OFF or 3MF), volume (NRRD, MetaImage) or, with --surfaces, tri-dexel model
    /// (.lfl), or `-` for standard input
    #[arg(value_name = "MESH")]
    input: OsString,
    /// File to write (.lfl), or `-` for standard output, in which case the summary goes to standard error;
    /// written completely or not at all
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// Print one JSON object with timings, counts, the mesh report and the volume (on standard error if the
    /// solid goes to standard output)
    #[arg(long)]
    json: bool,
    /// Levels of the octree, 1 to 20. Each level halves the cells and the error, and makes the file about
    /// four times as long. Optional with --surfaces and --like, and for a volume, whose voxels are then the
    /// finest cells
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=leafless::lattice::MAX_DEPTH as i64))]
    depth: Option<u8>,
    #[command(flatten)]
    surfaces: Surfaces,
    /// What the finest cells that the surface passes through become
    #[arg(long, value_parser = octree_rules(), default_value = "certified")]
    rule: Rule,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Lower corner and edge length of the cube that is cut into cells, in the units of the mesh after
    /// conversion and moves. Solids with the same bounds and depth can be combined. What sticks out is cut
    /// off, and reported [default: a cube around the mesh whose edge and cells are powers of two, so that
    /// faces at round numbers lie between cells; if the mesh's bounds are not round numbers, the cube around
    /// its middle with 33/32 of its longest extent as its edge]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    like: Like,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    placing: Placing,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { rule, surfaces, placing, threads, json, .. } = *arguments;
    let (bounds, depth) = arguments.like.frame(arguments.bounds, arguments.depth, surfaces.are_kept())?;
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    let job = Job { input, output, start: Instant::now(), depth, bounds, threads, json };
    let (input, reading) = (&job.input, &arguments.reading);
    surfaces.check_rule(rule)?;
    job.output.check()?;
    job.output.check_spares(input, "mesh")?;
    job.output.check_name()?;
    let found = Found::look(input, reading.told())?;
    let wanted = Voxelizing { reading, placing: &placing, rule, surfaces };
    match found.content {
        Content::Solid if surfaces.are_kept() => octree_of_dexel_surface::make(&job, found, &wanted),
        _ => octree_of_mesh::make(&job, found, &wanted),
    }
}
