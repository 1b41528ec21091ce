//! `leafless union`, `intersection`, `difference`, `xor` and `complement`.

use crate::failure::{Failure, Of};
use crate::making::dexel_boolean;
use crate::making::octree_of_volume::of_voxels;
use crate::making::operands::{Operation, Place, check_places, facts, warn_of_units};
use crate::progress::watched;
use crate::report::octree::Info;
use crate::sink::Output;
use crate::source::file::Stored;
use crate::source::input::Input;
use crate::source::volume::Sampling;
use crate::words::{count, counted, seconds};
use clap::Args;
use leafless::exchange::VolumeFormat;
use leafless::{CarryRule, Control, Error, Octree, OctreeRef, TriDexel, carry_channels};
use std::ffi::OsString;
use std::time::Instant;

/// The solids must lie on one frame: voxelize them with the same --bounds and --depth. The result may replace
/// one of them. Tri-dexel models can be combined with each other, made with the same --bounds and --resolution.
#[derive(Args)]
pub struct Arguments {
    /// Solids or tri-dexel models (.lfl) or volumes (NRRD, MetaImage), two or more; one of them may be `-` for standard input
    #[arg(required = true, num_args = 2.., value_name = "FILE")]
    files: Vec<OsString>,
    #[command(flatten)]
    common: Common,
}

/// Solid where there was none, and none where there was some; also outside of the bounds, but for tri-dexel models, which
/// end at them.
#[derive(Args)]
pub struct ComplementArguments {
    /// Solid or tri-dexel model (.lfl) or volume (NRRD, MetaImage), or `-` for standard input
    file: OsString,
    #[command(flatten)]
    common: Common,
}

#[derive(Args)]
struct Common {
    /// File to write, or `-` for standard output; it is written whole or not at all
    #[arg(short, long, value_name = "OUT.lfl")]
    output: OsString,
    /// Threads to use; 0: as many as there are processors. The result is the same
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = crate::options::threads)]
    threads: usize,
    #[command(flatten)]
    sampling: Sampling,
    /// Whose value of a channel counts where several solids have one: that of the first, the last, the greatest, or
    /// the mean. Without it: that of the first
    #[arg(long, value_name = "NAME=left|right|max|mean", value_parser = carry)]
    carry: Vec<(String, CarryRule)>,
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

pub fn run(operation: Operation, arguments: &Arguments) -> Result<(), Failure> {
    let inputs: Vec<Input> = arguments.files.iter().map(|name| Input::from(&**name)).collect();
    if inputs.iter().filter(|input| input.path().is_none()).count() > 1 {
        return Err(Failure::Usage("only one of the solids can be standard input".into()));
    }
    combine(operation, &inputs, &arguments.common)
}

pub fn run_complement(arguments: &ComplementArguments) -> Result<(), Failure> {
    combine(Operation::Complement, &[Input::from(&*arguments.file)], &arguments.common)
}

/// Reads the operands, at least one (a difference has two), combines them, saves the result.
fn combine(operation: Operation, inputs: &[Input], common: &Common) -> Result<(), Failure> {
    let start = Instant::now();
    let output = Output::from(&*common.output);
    output.check()?;
    let octrees = match operands(inputs, common)? {
        Operands::Octrees(octrees) => octrees,
        Operands::Dexels(models) => {
            return dexel_boolean::combine(operation, inputs, &models, &output, common.threads, start);
        }
    };
    let places: Vec<Place> =
        octrees.iter().map(|octree| Place::new(octree.frame(), octree.metadata())).collect();
    check_places(inputs, &places, "--depth")?;
    let trees: Vec<OctreeRef<'_>> = octrees.iter().map(|octree| *octree.view()).collect();
    let name = operation.name();
    let result = watched(name, common.threads, |control| of(operation, &trees[0], &trees, control));
    let result = carried(result.of(name)?, &octrees, common).of(name)?.with_metadata(facts(&places)?);
    warn_of_units(inputs, &places);
    let bytes = output.save(&result)?;
    let info = Info::new(&result, bytes);
    output.report(&format!(
        "{output}: {name} of {}, volume {}, {} nodes, {} bytes, in {}\n",
        counted(inputs.len() as u64, "solid", "solids"),
        info.volume_text(),
        count(info.nodes),
        count(bytes),
        seconds(start.elapsed().as_secs_f64()),
    ))
}

/// The result with the channels of the operands.
fn carried(result: Octree, octrees: &[Octree], common: &Common) -> Result<Octree, String> {
    if octrees.iter().all(|octree| octree.channels().is_empty()) {
        return Ok(result);
    }
    let operands: Vec<&Octree> = octrees.iter().collect();
    let rule = |name: &str| {
        let told = common.carry.iter().rev().find(|(known, _)| known == name);
        told.map_or(CarryRule::Left, |(_, rule)| *rule)
    };
    watched("channels", common.threads, |control| carry_channels(&result, &operands, rule, control))
}

/// What is combined: all of one kind.
enum Operands {
    Octrees(Vec<Octree>),
    Dexels(Vec<TriDexel>),
}

/// Reads all operands, of which there is one at least. What is proven of the result is proven only if the operands are
/// what their makers wrote.
fn operands(inputs: &[Input], common: &Common) -> Result<Operands, Failure> {
    let (mut octrees, mut models) = (Vec::new(), Vec::new());
    for (i, input) in inputs.iter().enumerate() {
        match operand(input, common)? {
            Stored::Octree(octree) => octrees.push(octree),
            Stored::Dexels(model) => models.push(model),
        }
        if !octrees.is_empty() && !models.is_empty() {
            let kinds = ["an octree", "a tri-dexel model"];
            let [this, first] = if models.len() == i { kinds } else { [kinds[1], kinds[0]] };
            let problem = format!("is {this}, and {} is {first}: `leafless convert`", inputs[0]);
            return Err(Failure::of(input, format!("{problem} makes one of the other's kind")));
        }
    }
    if models.is_empty() {
        return Ok(Operands::Octrees(octrees));
    }
    if !common.carry.is_empty() {
        return Err(Failure::Usage("--carry is for octrees: tri-dexel models have no channels".into()));
    }
    Ok(Operands::Dexels(models))
}

/// A solid from a file, or the voxels of a volume that are inside.
fn operand(input: &Input, common: &Common) -> Result<Stored, Failure> {
    if input.begins_as_solid() {
        return Ok(Stored::read(input, true)?.0);
    }
    let bytes = input.read()?;
    if common.sampling.is_raw() || VolumeFormat::detect(&bytes).is_some() {
        let volume = common.sampling.read(input, &bytes)?;
        return Ok(Stored::Octree(of_voxels(&volume, input, common.threads)?));
    }
    Stored::of_bytes(input, &bytes)
}

fn of(
    operation: Operation,
    first: &OctreeRef<'_>,
    trees: &[OctreeRef<'_>],
    control: &Control<'_>,
) -> Result<Octree, Error> {
    match (operation, trees) {
        (Operation::Union, _) => leafless::union_of(trees, control),
        (Operation::Intersection, _) => leafless::intersection_of(trees, control),
        (Operation::Xor, _) => leafless::xor_of(trees, control),
        (Operation::Difference, [_, tool]) => leafless::difference(first, tool, control),
        (Operation::Difference, _) => {
            let tools = leafless::union_of(&trees[1..], control)?;
            leafless::difference(first, tools.view(), control)
        }
        (Operation::Complement, _) => leafless::complement(first, control),
    }
}
