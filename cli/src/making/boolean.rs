//! The set operations on solids of either kind.

use crate::failure::{Failure, Of, complain};
use crate::making::combined_surface;
use crate::making::operand::Common;
use crate::making::operands::{Combining, Operation, Place, check_places, facts, warn_of_units};
use crate::progress::watched;
use crate::report::{dexels, octree};
use crate::sink::Output;
use crate::source::file::Stored;
use crate::source::input::Input;
use crate::source::placing::Placing;
use crate::source::solid::Shape;
use crate::words::{count, counted, seconds, short};
use leafless::attribute::{CarryRule, carry_channels};
use leafless::exchange::MeshFormat;
use leafless::{Control, Error, Octree, OctreeRef, Rule, TriDexel};
use std::time::Instant;

/// Reads the operands, at least one (two for a difference), moves them, combines them, and saves the result.
pub fn combine(combining: &Combining, files: &[(Input, Placing)], output: &Output) -> Result<(), Failure> {
    let (start, operation) = (Instant::now(), combining.operation);
    output.check()?;
    let extension = output.path().and_then(|path| path.extension()?.to_str());
    if let Some(format) = extension.and_then(MeshFormat::from_extension) {
        return combined_surface::make(combining, files, output, format);
    }
    let operands = operands(files, combining)?;
    let inputs: Vec<Input> = files.iter().map(|file| file.0.clone()).collect();
    let inputs = &inputs[..];
    let (places, depth): (Vec<Place>, _) = match &operands {
        Operands::Octrees(octrees) => {
            (octrees.iter().map(|octree| Place::new(octree.frame(), octree.metadata())).collect(), "--depth")
        }
        Operands::Dexels(models) => {
            (models.iter().map(|model| Place::new(model.frame(), model.metadata())).collect(), "--resolution")
        }
    };
    check_places(inputs, &places, depth)?;
    let (name, threads, number) = (operation.name(), combining.threads, inputs.len() as u64);
    let (solids, result, bytes, time) = match &operands {
        Operands::Octrees(octrees) => {
            let trees: Vec<OctreeRef<'_>> = octrees.iter().map(|octree| *octree.view()).collect();
            let result = watched(name, threads, |control| of(operation, &trees, control));
            let result = plain(result.of(name)?, combining).of(name)?;
            let result = carried(result, octrees, combining).of(name)?;
            let result = result.with_metadata(facts(&places)?);
            warn_of_units(inputs, &places);
            warn_of_clipping(files, octrees, &result);
            let bytes = output.save(&result)?;
            // The report on the result may take longer than making it.
            let time = start.elapsed();
            let info = octree::Info::new(&result, bytes);
            let kept = info.kept_text().map_or(String::new(), |kept| format!(", {kept}"));
            let nodes = counted(info.nodes, "node", "nodes");
            // The size of cells is stated only for stored solids.
            let is_made = inputs.iter().any(|input| !input.begins_as_solid());
            let cells = if is_made {
                format!(", cells of {}", short(result.frame().cell_size()))
            } else {
                String::new()
            };
            let told = format!("volume {}{cells}, {nodes}{kept}", info.volume_text());
            (counted(number, "solid", "solids"), told, bytes, time)
        }
        Operands::Dexels(models) => {
            check_directions(inputs, models)?;
            let result = watched(name, threads, |control| of_dexels(operation, models, control)).of(name)?;
            let result = result.with_metadata(facts(&places)?);
            warn_of_units(inputs, &places);
            let bytes = output.save_dexels(&result)?;
            let info = dexels::Info::new(&result, bytes);
            let intervals = counted(info.intervals, "interval", "intervals");
            let told = format!("{}, {intervals}", info.volume_text());
            (counted(number, "tri-dexel model", "tri-dexel models"), told, bytes, start.elapsed())
        }
    };
    let (bytes, time) = (count(bytes), seconds(time.as_secs_f64()));
    output.report(&format!("{output}: {name} of {solids}, {result}, {bytes} bytes, in {time}\n"))
}

/// Returns the result without surfaces, if --plain is given.
fn plain(result: Octree, combining: &Combining) -> Result<Octree, String> {
    match combining.plain {
        None => Ok(result),
        Some(None) => Ok(result.without_cuts()),
        Some(Some(depth)) => watched("cells", combining.threads, |control| {
            leafless::op::plain(&result, depth, Rule::Certified, control)
        }),
    }
}

/// Warns of operands that extend beyond the common frame, if the result lacks those parts.
fn warn_of_clipping(files: &[(Input, Placing)], octrees: &[Octree], result: &Octree) {
    if !result.view().is_clipped() {
        return;
    }
    let stored = files.iter().find(|(input, _)| input.begins_as_solid());
    let frame = stored.map_or("the common cube".into(), |(input, _)| format!("the frame of {input}"));
    for ((input, placing), octree) in files.iter().zip(octrees) {
        if !octree.view().is_clipped() || input.begins_as_solid() && placing.map().is_none() {
            continue;
        }
        let place = if placing.map().is_some() { "where it was moved to " } else { "" };
        complain(&format!("{input}: warning: {place}it may extend beyond {frame}, and was cut off"));
    }
}

/// Refuses tri-dexel models whose rays run along different axes.
fn check_directions(inputs: &[Input], models: &[TriDexel]) -> Result<(), Failure> {
    let axes = |model: &TriDexel| dexels::Info::new(model, 0).axes();
    for (input, model) in inputs.iter().zip(models).skip(1) {
        if model.view().directions() != models[0].view().directions() {
            let (first, other) = (axes(&models[0]), axes(model));
            let problem = format!("has rays along {other}, and {} along {first}", inputs[0]);
            return Err(Failure::of(input, format!("{problem}: make both with the same --directions")));
        }
    }
    Ok(())
}

/// Returns the result with the channels of the operands.
fn carried(result: Octree, octrees: &[Octree], combining: &Combining) -> Result<Octree, String> {
    if octrees.iter().all(|octree| octree.channels().is_empty()) {
        return Ok(result);
    }
    let operands: Vec<&Octree> = octrees.iter().collect();
    let rule = |name: &str| {
        let told = combining.carry.iter().rev().find(|(known, _)| known == name);
        told.map_or(CarryRule::Left, |(_, rule)| *rule)
    };
    watched("channels", combining.threads, |control| carry_channels(&result, &operands, rule, control))
}

/// The operands, all of one kind.
enum Operands {
    Octrees(Vec<Octree>),
    Dexels(Vec<TriDexel>),
}

/// Reads all operands; there is at least one. The files are verified, as the result is proven only if the
/// operands are intact.
fn operands(files: &[(Input, Placing)], combining: &Combining) -> Result<Operands, Failure> {
    let read = |(input, placing): &(Input, Placing)| Shape::among_others(input, combining.taking, placing);
    let shapes = files.iter().map(read).collect::<Result<Vec<_>, Failure>>()?;
    let common = Common::new(files, &shapes, (combining.bounds, combining.depth))?;
    let (mut octrees, mut models) = (Vec::new(), Vec::new());
    for (i, ((input, placing), shape)) in files.iter().zip(shapes).enumerate() {
        match common.place(input, placing, shape, combining.threads)? {
            Stored::Octree(octree) => octrees.push(octree),
            Stored::Dexels(model) => models.push(model),
        }
        if !octrees.is_empty() && !models.is_empty() {
            let kinds = ["an octree", "a tri-dexel model"];
            let [this, first] = if models.len() == i { kinds } else { [kinds[1], kinds[0]] };
            let problem = format!("is {this}, and {} is {first}: `leafless convert`", files[0].0);
            return Err(Failure::of(input, format!("{problem} makes one of the other's kind")));
        }
    }
    if models.is_empty() {
        return Ok(Operands::Octrees(octrees));
    }
    if !combining.carry.is_empty() {
        return Err(Failure::Usage("--carry is for octrees: tri-dexel models have no channels".into()));
    }
    if combining.plain.is_some() {
        return Err(Failure::Usage("--plain is for octrees: tri-dexel models keep no surfaces".into()));
    }
    Ok(Operands::Dexels(models))
}

fn of(operation: Operation, trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    match operation {
        Operation::Union => leafless::op::union_of(trees, control),
        Operation::Intersection => leafless::op::intersection_of(trees, control),
        Operation::Xor => leafless::op::xor_of(trees, control),
        Operation::Difference => leafless::op::difference_of(trees, control),
        Operation::Complement => leafless::complement(&trees[0], control),
    }
}

fn of_dexels(operation: Operation, models: &[TriDexel], control: &Control<'_>) -> Result<TriDexel, Error> {
    let (first, others) = (&models[0], &models[1..]);
    if let Operation::Complement = operation {
        return first.view().complement(control);
    }
    others.iter().try_fold(first.clone(), |whole, other| {
        let (whole, other) = (whole.view(), other.view());
        match operation {
            Operation::Union => whole.union(other, control),
            Operation::Intersection => whole.intersection(other, control),
            // The points that lie in an odd number of operands, combined one after the other.
            Operation::Xor => whole.xor(other, control),
            Operation::Difference | Operation::Complement => whole.difference(other, control),
        }
    })
}
