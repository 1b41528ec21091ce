//! What `leafless convert` is asked for.

use crate::options::{RuleName, bounds, resolution, threads};
use crate::source::mesh::Reading;
use crate::source::scene::Drawing;
use clap::{Args, ValueEnum};
use leafless::Frame;
use std::ffi::OsString;

/// Makes an octree, a tri-dexel model or a triangle mesh of any of them, or of a scene or a volume, as
/// `leafless voxelize`, `csg`, `dexelize` and `mesh` do where nothing more is asked for.
///
/// Of a tri-dexel model an octree has the cells whose centres lie inside. Of an octree a tri-dexel model has just
/// the cells, exactly; undecided ones count as --resolve says. An octree of a mesh or a scene is certified, and its
/// undecided cells stay so without --resolve.
#[derive(Args)]
// Of meshes, `--to` says the unit everywhere else.
#[command(mut_arg("to", |unit| unit.long("to-unit")))]
pub struct Arguments {
    /// Octree or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-`
    /// for standard input
    #[arg(value_name = "FILE")]
    pub input: OsString,
    /// File to write, or `-` for standard output; it is written whole or not at all
    #[arg(short, long, value_name = "OUT")]
    pub output: OsString,
    /// What to make. The extension .ply, .stl, .obj, .off or .3mf of the output says that it is a mesh; .lfl says nothing,
    /// as octrees and tri-dexel models both have it
    #[arg(id = "target", long = "to", value_enum, value_name = "KIND")]
    pub kind: Option<KindName>,
    /// What cells count as that the surface passes through, or that are undecided
    #[arg(long, value_enum)]
    pub resolve: Option<ResolveName>,
    /// Cells to an axis of the cube around a mesh or scene, a power of two. Without it: 256, and of a volume the voxels
    #[arg(long, value_name = "N", value_parser = resolution)]
    pub resolution: Option<u8>,
    /// Lower corner and edge length of the cube, for a mesh or scene. Without it: the cube around it
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    pub bounds: Option<Frame>,
    #[command(flatten)]
    pub reading: Reading,
    #[command(flatten)]
    pub drawing: Drawing,
    /// Write an STL also if rounding to its 32-bit coordinates breaks the surface
    #[arg(long)]
    pub lossy: bool,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    pub threads: usize,
    /// Print one JSON object, that of the subcommand that does the work
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub enum KindName {
    /// An octree (.lfl)
    Octree,
    /// A tri-dexel model (.lfl)
    Dexels,
    /// A triangle mesh
    Mesh,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub enum ResolveName {
    /// Outside
    Inner,
    /// Inside
    Outer,
}

/// The depth of meshes and scenes, if none is asked for.
const DEPTH: u8 = 8;

impl Arguments {
    /// The levels of an octree of a mesh or a scene.
    pub fn depth(&self) -> u8 {
        self.resolution.unwrap_or(DEPTH)
    }
}

impl From<ResolveName> for RuleName {
    fn from(name: ResolveName) -> RuleName {
        match name {
            ResolveName::Inner => RuleName::Inner,
            ResolveName::Outer => RuleName::Outer,
        }
    }
}
