//! The set operations on tri-dexel models.

use crate::failure::{Failure, Of};
use crate::making::operands::{Operation, Place, check_places, facts, warn_of_units};
use crate::progress::watched;
use crate::report::dexels::Info;
use crate::sink::Output;
use crate::source::input::Input;
use crate::words::short;
use crate::words::{count, counted, seconds};
use leafless::{Control, Error, TriDexel};
use std::time::Instant;

/// Combines models, at least one (a difference has two), and saves the result.
pub fn combine(
    operation: Operation,
    inputs: &[Input],
    models: &[TriDexel],
    output: &Output,
    threads: usize,
    start: Instant,
) -> Result<(), Failure> {
    let places: Vec<Place> = models.iter().map(|model| Place::new(model.frame(), model.metadata())).collect();
    check_places(inputs, &places, "--resolution")?;
    let axes = |model: &TriDexel| Info::new(model, 0).axes();
    for (input, model) in inputs.iter().zip(models).skip(1) {
        if model.view().directions() != models[0].view().directions() {
            let (first, other) = (axes(&models[0]), axes(model));
            let problem = format!("has rays along {other}, and {} along {first}", inputs[0]);
            return Err(Failure::of(input, format!("{problem}: make both with the same --directions")));
        }
    }
    let name = operation.name();
    let result = watched(name, threads, |control| of(operation, models, control)).of(name)?;
    let result = result.with_metadata(facts(&places)?);
    warn_of_units(inputs, &places);
    let bytes = output.save_dexels(&result)?;
    let info = Info::new(&result, bytes);
    output.report(&format!(
        "{output}: {name} of {}, volume about {}, {}, {} bytes, in {}\n",
        counted(inputs.len() as u64, "tri-dexel model", "tri-dexel models"),
        short(info.mean_volume()),
        counted(info.intervals, "interval", "intervals"),
        count(bytes),
        seconds(start.elapsed().as_secs_f64()),
    ))
}

fn of(operation: Operation, models: &[TriDexel], control: &Control<'_>) -> Result<TriDexel, Error> {
    let (first, others) = (&models[0], &models[1..]);
    if let Operation::Complement = operation {
        return first.view().complement(control);
    }
    others.iter().try_fold(first.clone(), |whole, other| {
        let (whole, other) = (whole.view(), other.view());
        match operation {
            Operation::Union => whole.union(other, control),
            Operation::Intersection => whole.intersection(other, control),
            // What lies in an odd number of them, one after the other.
            Operation::Xor => whole.xor(other, control),
            Operation::Difference | Operation::Complement => whole.difference(other, control),
        }
    })
}
