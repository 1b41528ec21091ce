//! `leafless union`, `intersection`, `difference`, `xor` and `complement`.

use crate::failure::Failure;
use crate::making::boolean::{Combining, combine};
use crate::making::operands::Operation;
use crate::sink::Output;
use crate::source::input::Input;
use crate::source::volume::Sampling;
use clap::Args;
use leafless::attribute::CarryRule;
use std::ffi::OsString;

/// The solids must lie on one frame: voxelize them with the same --bounds and --depth. The result may replace
/// one of them. Tri-dexel models can be combined with each other, made with the same --bounds and --resolution.
///
/// If a solid keeps surfaces (`leafless csg --surfaces`), the result keeps them, too, and is as exact. Give all tools in one
/// command: they are cut at once, and what is larger than they are is copied once. A solid without surfaces takes part with its cells.
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
    /// Drop the surfaces that undecided cells of the result keep, so that the cells are left alone, which may be few and large. With a
    /// level, 1 to 20, the surfaces first decide the cells of that level
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, value_parser = clap::value_parser!(u8).range(1..=leafless::lattice::MAX_DEPTH as i64))]
    plain: Option<Option<u8>>,
}

impl Common {
    fn combine(&self, operation: Operation, inputs: &[Input]) -> Result<(), Failure> {
        let Common { threads, sampling, carry, plain, .. } = self;
        let combining = Combining { operation, sampling, carry, plain: *plain, threads: *threads };
        combine(&combining, inputs, &Output::from(&*self.output))
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

pub fn run(operation: Operation, arguments: &Arguments) -> Result<(), Failure> {
    let inputs: Vec<Input> = arguments.files.iter().map(|name| Input::from(&**name)).collect();
    if inputs.iter().filter(|input| input.path().is_none()).count() > 1 {
        return Err(Failure::Usage("only one of the solids can be standard input".into()));
    }
    arguments.common.combine(operation, &inputs)
}

pub fn run_complement(arguments: &ComplementArguments) -> Result<(), Failure> {
    arguments.common.combine(Operation::Complement, &[Input::from(&*arguments.file)])
}
