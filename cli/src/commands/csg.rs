//! `leafless csg`: from a scene to a solid.

use crate::failure::Failure;
use crate::making::job::Job;
use crate::making::like::Like;
use crate::making::octree_of_scene::{self, Splitting, TouchName};
use crate::making::surfaces::Surfaces;
use crate::options::{bounds, number, octree_rules, threads};
use crate::sink::Output;
use crate::source::file::Found;
use crate::source::input::Input;
use crate::source::placing::Placing;
use crate::source::scene::Drawing;
use clap::Args;
use leafless::{Frame, Rule};
use std::ffi::OsString;
use std::time::Instant;

/// Splits space where the surface of a scene passes, down to cells of 2^-N of its extent. By the certified
/// rule every cell is proven inside, proven outside, or undecided.
///
/// A scene is a text in the language of the CSG dumps that OpenSCAD writes (`openscad -o part.csg
/// part.scad`): group union difference intersection multmatrix translate rotate scale mirror color render
/// cube sphere cylinder polyhedron linear_extrude rotate_extrude square circle polygon, import of meshes.
/// Leafless adds: halfspace([a,b,c,d]) power([A,a,n1],[B,b,n2],[C,c,n3],R) quadric([10 numbers])
/// torus(major,minor) mesh("file.stl") octree("file.lfl"). Curved surfaces are exact, except those with a $fn
/// of 12 or less: these are the prisms and pyramids that OpenSCAD draws. --fn exact or --fn polygon decides
/// for all curves.
///
/// The file records the scene's name, length and checksum, and the rule. Equal input gives equal bytes, for
/// any number of threads.
#[derive(Args)]
pub struct Arguments {
    /// Scene (.csg), or `-` for standard input
    #[arg(value_name = "SCENE")]
    input: OsString,
    /// File to write (.lfl), or `-` for standard output, in which case the summary goes to standard error;
    /// written completely or not at all
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// Print one JSON object with timings, splits, evaluations of half-spaces and the volume, level by level
    /// (on standard error if the solid goes to standard output)
    #[arg(long)]
    json: bool,
    /// Levels of the octree, 1 to 20. Each level halves the cells and the error, and makes the file about
    /// four times as long. Optional with --surfaces and --like
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=leafless::lattice::MAX_DEPTH as i64), required_unless_present_any = ["surfaces", "like"])]
    depth: Option<u8>,
    #[command(flatten)]
    surfaces: Surfaces,
    /// What the finest cells that the surface passes through become
    #[arg(long, value_parser = octree_rules(), default_value = "certified")]
    rule: Rule,
    /// Do not split cells in which the surface is known to lie within a layer of this thickness, in the units
    /// of the scene. Flat faces then take few cells, curved ones more, and edges as many as the depth allows.
    /// Such cells are undecided
    #[arg(long, value_name = "T", value_parser = thickness, allow_hyphen_values = true)]
    adaptive: Option<f64>,
    /// What counts as contact of a solid and a cell
    #[arg(long, value_enum, default_value_t = TouchName::Exact)]
    touch: TouchName,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Lower corner and edge length of the cube that is cut into cells, in the units of the scene. Solids
    /// with the same bounds and depth can be combined. What sticks out is cut off, and reported [default: a
    /// cube around the scene whose edge and cells are powers of two, so that faces at round numbers lie
    /// between cells; if the scene's bounds are not round numbers, the cube around their middle with 33/32 of
    /// the longest extent as its edge]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    like: Like,
    #[command(flatten)]
    placing: Placing,
    #[command(flatten)]
    drawing: Drawing,
}

fn thickness(text: &str) -> Result<f64, String> {
    number(text, "a length not below 0", |thickness| thickness >= 0.0)
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { rule, adaptive, surfaces, touch, threads, json, .. } = *arguments;
    let (bounds, depth) = arguments.like.frame(arguments.bounds, arguments.depth, surfaces.are_kept())?;
    let (input, output) = (Input::from(&*arguments.input), Output::from(&*arguments.output));
    let job = Job { input, output, start: Instant::now(), depth, bounds, threads, json };
    job.output.check()?;
    surfaces.check_rule(rule)?;
    if surfaces.are_kept() {
        let useless = match (touch, adaptive) {
            (TouchName::Exact, None) => None,
            (_, Some(_)) => Some("--adaptive: cells end where few surfaces are left"),
            _ => Some("--touch paper, which provides no surfaces"),
        };
        if let Some(useless) = useless {
            return Err(surfaces.refusal(useless));
        }
    }
    if adaptive.is_some() {
        let useless = match (rule, touch) {
            (Rule::Certified, TouchName::Exact) => None,
            (Rule::Certified, TouchName::Paper) => Some("--touch paper, which provides no layers"),
            _ => Some("a --rule other than certified: the cells that it leaves whole are undecided"),
        };
        if let Some(useless) = useless {
            return Err(Failure::Usage(format!("--adaptive does not go with {useless}")));
        }
    }
    job.output.check_spares(&job.input, "scene")?;
    job.output.check_name()?;
    let found = Found::look(&job.input, None)?;
    let splitting = Splitting { rule, adaptive, surfaces, touch };
    octree_of_scene::make(&job, found, (&arguments.drawing, &arguments.placing), splitting)
}
