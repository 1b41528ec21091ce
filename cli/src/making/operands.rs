//! The operands of set operations: their frames, and their metadata.

use crate::failure::{Failure, Of, complain};
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::words::number;
use leafless::attribute::CarryRule;
use leafless::{Frame, Metadata};

/// A set operation.
#[derive(Debug, Clone, Copy)]
pub enum Operation {
    Union,
    Intersection,
    Difference,
    Xor,
    Complement,
}

impl Operation {
    pub fn name(self) -> &'static str {
        match self {
            Operation::Union => "union",
            Operation::Intersection => "intersection",
            Operation::Difference => "difference",
            Operation::Xor => "symmetric difference",
            Operation::Complement => "complement",
        }
    }
}

/// A set operation with its options.
pub struct Combining<'a> {
    pub operation: Operation,
    /// The options of reading meshes, scenes and volumes.
    pub taking: &'a Taking,
    /// The cube for the combination, and its levels, if no operand has its own.
    pub bounds: Option<Frame>,
    pub depth: Option<u8>,
    /// Rules for channels by their names.
    pub carry: &'a [(String, CarryRule)],
    /// Whether the result drops its surfaces, and the level of its cells if one is given.
    pub plain: Option<Option<u8>>,
    pub threads: usize,
}

/// The frame and the metadata of an operand.
pub struct Place<'a> {
    frame: &'a Frame,
    metadata: &'a Metadata,
}

impl Place<'_> {
    /// Builds the place of an operand.
    pub fn new<'a>(frame: &'a Frame, metadata: &'a Metadata) -> Place<'a> {
        Place { frame, metadata }
    }

    fn text(&self) -> String {
        let frame = self.frame;
        let origin = frame.origin().map(number).join(" ");
        format!("origin {origin}, edge {}, depth {}", number(frame.edge()), frame.depth())
    }
}

/// Refuses operands on different frames; `depth` is the option that sets their resolution.
pub fn check_places(inputs: &[Input], places: &[Place<'_>], depth: &str) -> Result<(), Failure> {
    for (input, place) in inputs.iter().zip(places).skip(1) {
        if place.frame != places[0].frame {
            let (first, other, whole) = (&inputs[0], place.text(), places[0].text());
            let problem = format!("lies on another frame ({other}) than {first} ({whole})");
            let like = if depth == "--depth" {
                format!(", or one by `leafless voxelize --like {first}`")
            } else {
                String::new()
            };
            return Err(Failure::of(
                input,
                format!("{problem}: make both with the same --bounds and {depth}{like}"),
            ));
        }
    }
    Ok(())
}

/// Warns of operands whose units differ from that of the first one.
pub fn warn_of_units(inputs: &[Input], places: &[Place<'_>]) {
    for (input, place) in inputs.iter().zip(places).skip(1) {
        let units = [&places[0], place].map(|place| place.metadata.get("units"));
        if let [Some(first), Some(other)] = units
            && first != other
        {
            let whole = &inputs[0];
            let unlike = format!(
                "its unit is {other}, and that of {whole} is {first}: the numbers are taken as they are"
            );
            complain(&format!("{input}: warning: {unlike}"));
        }
    }
}

/// Returns the metadata of the operands that hold for the result: name and unit, if they are the same in all,
/// and the rule by which cells were resolved, if all state one: the common rule, or `mixed`.
pub fn facts(places: &[Place<'_>]) -> Result<Metadata, Failure> {
    let mut metadata = Metadata::common(places.iter().map(|place| place.metadata)).of("metadata")?;
    let rules: Option<Vec<&str>> = places.iter().map(|place| place.metadata.get("rule")).collect();
    if let Some(rules) = rules {
        let same = rules.iter().all(|rule| *rule == rules[0]);
        metadata.insert("rule", if same { rules[0] } else { "mixed" });
    }
    Ok(metadata)
}
