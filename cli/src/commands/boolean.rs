//! `leafless union`, `intersection`, `difference`, `xor` and `complement`.

use crate::failure::Failure;
use crate::making::boolean::combine;
use crate::making::operands::{Combining, Operation};
use crate::sink::Output;
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::mesh::Reading;
use crate::source::placing::{Placing, Step};
use crate::source::scene::Drawing;
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, value_parser};
use leafless::Frame;
use leafless::attribute::CarryRule;
use std::ffi::OsString;

/// Solids from files (.lfl) must lie on one frame, that is, in the same cube with the same depth: `leafless
/// voxelize --like part.lfl` makes a solid on the frame of another one. Meshes, scenes and volumes are cut
/// into cells on the frame of the first solid. Without any solid, the frame is that of the voxels of a volume
/// that comes first, or a cube around all operands. The result may replace one of the files. Tri-dexel models
/// can be combined with each other if they were made with the same --bounds and --resolution.
///
/// Meshes, scenes and volumes can also make a triangle mesh: give the output the extension .stl, .ply, .obj,
/// .off or .3mf. The surface is made as `leafless mesh` makes that of a scene.
///
/// --translate, --rotate, --scale and --place move the file that they stand behind, and put it onto the frame
/// of the first file. A solid that is moved by whole cells and quarter turns, or whose cells keep surfaces,
/// stays exact; otherwise its cells blur by about one cell.
///
/// If a solid keeps surfaces (`leafless csg --surfaces`), the result keeps them, too, and is as exact. Give
/// all tools in one command: they are cut at once, and cells larger than the tools are copied once. A solid
/// without surfaces takes part with its cells.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    operands: Operands,
}

/// The complement is solid where the operand is empty, and empty where the operand is solid.
///
/// This also holds outside the cube of the solid. Tri-dexel models are the exception: they end at their
/// bounds.
#[derive(Args)]
pub struct ComplementArguments {
    /// Solid or tri-dexel model (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD,
    /// MetaImage), or `-` for standard input
    file: OsString,
    #[command(flatten)]
    common: Common,
}

#[derive(Args)]
struct Common {
    /// File to write (.lfl), or `-` for standard output; written completely or not at all. The extension of a
    /// mesh format makes a triangle mesh
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// Whose value a channel takes where several solids have one: that of the first (left) or last (right)
    /// solid, the greatest, or the mean [default: left]
    #[arg(long, value_name = "NAME=left|right|max|mean", value_parser = carry)]
    carry: Vec<(String, CarryRule)>,
    /// Levels of the cells of meshes, scenes and volumes without a solid among them, 1 to 20 [default: 10, 8
    /// for a triangle mesh, or those of the voxels]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=leafless::lattice::MAX_DEPTH as i64))]
    depth: Option<u8>,
    /// Drop the surfaces that undecided cells of the result keep. Only the cells remain, and they may be few
    /// and large. With a level N, 1 to 20, the surfaces first decide the cells of that level
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, value_parser = clap::value_parser!(u8).range(1..=leafless::lattice::MAX_DEPTH as i64))]
    plain: Option<Option<u8>>,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = crate::options::threads)]
    threads: usize,
    /// Lower corner and edge length of the cube of cells, for meshes, scenes and volumes without a solid
    /// among them [default: the voxels of a volume that comes first, or the cube around all operands]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = crate::options::bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    drawing: Drawing,
}

impl Common {
    fn combine(&self, operation: Operation, files: &[(Input, Placing)]) -> Result<(), Failure> {
        let Common { threads, reading, drawing, carry, plain, bounds, depth, .. } = self;
        let (bounds, depth, plain, threads) = (*bounds, *depth, *plain, *threads);
        let (reading, drawing, placing) = (reading.clone(), drawing.clone(), Placing::default());
        let taking = &Taking { reading, drawing, placing };
        let combining = Combining { operation, taking, bounds, depth, carry, plain, threads };
        combine(&combining, files, &Output::from(&*self.output))
    }
}

fn carry(text: &str) -> Result<(String, CarryRule), String> {
    let (name, rule) = text.rsplit_once('=').ok_or("expected the name of a channel, =, and a rule")?;
    let rule = match rule {
        "left" => CarryRule::Left,
        "right" => CarryRule::Right,
        "max" => CarryRule::Max,
        "mean" => CarryRule::Mean,
        _ => return Err("the rules are left, right, max and mean".into()),
    };
    Ok((name.into(), rule))
}

/// Files, each with the moves that stand behind it.
struct Operands(Vec<(OsString, Placing)>);

impl Args for Operands {
    fn augment_args(command: Command) -> Command {
        let files =
            Arg::new("files").value_name("FILE").required(true).num_args(1..).action(ArgAction::Append);
        let files = files.value_parser(value_parser!(OsString)).help(
            "Two or more solids or tri-dexel models (.lfl), meshes (STL, OBJ, PLY, OFF, 3MF), scenes (.csg) or volumes (NRRD, MetaImage); \
             one of them may be `-` for standard input. --translate, --rotate, --scale and --place move the file that they stand behind",
        );
        Placing::augment_args(command.arg(files))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Operands::augment_args(command)
    }
}

impl FromArgMatches for Operands {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Operands, clap::Error> {
        let names = matches.get_many::<OsString>("files").into_iter().flatten();
        let places: Vec<usize> = matches.indices_of("files").into_iter().flatten().collect();
        let mut files: Vec<(OsString, Placing)> =
            names.map(|name| (name.clone(), Placing::default())).collect();
        if files.len() < 2 {
            let problem = "2 values required by '<FILE>...'; only 1 was provided";
            return Err(clap::Error::raw(ErrorKind::TooFewValues, problem));
        }
        for step in Step::all(matches) {
            let Some(file) = places.iter().rposition(|&place| place < step.index) else {
                let problem = format!(
                    "--{} stands before the files: it moves the one that it stands behind",
                    step.option
                );
                return Err(clap::Error::raw(ErrorKind::ArgumentConflict, problem));
            };
            files[file].1 = files[file].1.then(&step)?;
        }
        Ok(Operands(files))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Operands::from_arg_matches(matches)?;
        Ok(())
    }
}

pub fn run(operation: Operation, arguments: &Arguments) -> Result<(), Failure> {
    let files = arguments.operands.0.iter().map(|(name, placing)| (Input::from(&**name), *placing));
    let files: Vec<(Input, Placing)> = files.collect();
    if files.iter().filter(|(input, _)| input.path().is_none()).count() > 1 {
        return Err(Failure::Usage("only one of the solids can be standard input".into()));
    }
    arguments.common.combine(operation, &files)
}

pub fn run_complement(arguments: &ComplementArguments) -> Result<(), Failure> {
    arguments.common.combine(Operation::Complement, &[(Input::from(&*arguments.file), Placing::default())])
}
