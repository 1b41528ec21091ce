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

/// Cuts the space around a mesh into 2^N × 2^N × 2^N cells, of which only those near the surface are kept
/// apart. By the certified rule every cell is proven inside, proven outside, or undecided because the surface
/// may pass through it; no such cell is ever missed.
///
/// The mesh should be closed: every edge shared by an even number of triangles that face the same side. Where
/// it has holes, or facets that are turned round, the winding number decides what is inside, and cells near
/// them may stay undecided; a warning says so. Bodies may overlap. Vertices that differ by no more than
/// single precision can tell are joined, and it is reported how many.
///
/// With --surfaces a tri-dexel model is taken, too, if it stores normals: its surface is reconstructed from
/// the ends and normals of its intervals (as by `leafless mesh --method dual`), and the octree keeps that.
/// What is certified is then certified of the reconstructed surface. Nothing is proven of the part that the
/// model was sampled from.
///
/// The file records the input's name, length and checksum, the rule, and the unit if it is known. Equal input
/// gives equal bytes, for any number of threads.
#[derive(Args)]
pub struct Arguments {
    /// Mesh (STL, OBJ, PLY, OFF or 3MF), volume (NRRD, MetaImage) or, with --surfaces, tri-dexel model
    /// (.lfl), or `-` for standard input
    #[arg(value_name = "MESH")]
    input: OsString,
    /// File to write, or `-` for standard output, whose summary then goes to standard error; it is written
    /// whole or not at all
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// Levels of the octree, 1 to 20: each halves the cells, and the error, and makes the file some four
    /// times as long. With --surfaces and --like it may be left out, and so may it for a volume: then its
    /// voxels are the finest cells
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=leafless::lattice::MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// What becomes of the finest cells that the surface passes through
    #[arg(long, value_parser = octree_rules(), default_value = "certified")]
    rule: Rule,
    #[command(flatten)]
    surfaces: Surfaces,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    placing: Placing,
    /// Lower corner and edge length of the cube to cut into cells, in the units of the mesh once it is
    /// converted and moved. Solids can be combined if they were given the same bounds and depth. What sticks
    /// out is cut off, and reported. Without it: a cube around the mesh whose edge and cells are powers of
    /// two, so that faces at round numbers lie between cells; if the mesh's bounds are no round numbers, the
    /// cube around its middle, its edge 33/32 of its longest extent
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    like: Like,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Print one JSON object with timings, counts, the mesh report and the volume (on standard error if the
    /// solid goes to standard output)
    #[arg(long)]
    json: bool,
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
