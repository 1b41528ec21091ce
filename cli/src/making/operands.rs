//! The operands of set operations: where they lie, and what their files say.

use crate::failure::{Failure, Of, complain};
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::words::number;
use leafless::attribute::CarryRule;
use leafless::{Frame, Metadata};

/// What is made of the solids.
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

/// What is made of solids.
pub struct Combining<'a> {
    pub operation: Operation,
    /// How meshes, scenes and volumes among them are taken.
    pub taking: &'a Taking,
    /// The cube that they are combined on, and its levels, if none of them has its own.
    pub bounds: Option<Frame>,
    pub depth: Option<u8>,
    /// Rules for channels by their names.
    pub carry: &'a [(String, CarryRule)],
    /// Whether the result has no surfaces, and the level of its cells if that is asked for.
    pub plain: Option<Option<u8>>,
    pub threads: usize,
}

/// Where an operand lies, and what its file says.
pub struct Place<'a> {
    frame: &'a Frame,
    metadata: &'a Metadata,
}

impl Place<'_> {
    /// That of an operand.
    pub fn new<'a>(frame: &'a Frame, metadata: &'a Metadata) -> Place<'a> {
        Place { frame, metadata }
    }

    fn text(&self) -> String {
        let frame = self.frame;
        let origin = frame.origin().map(number).join(" ");
        format!("origin {origin}, edge {}, depth {}", number(frame.edge()), frame.depth())
    }
}

/// Refuses operands that lie on different frames; `depth` is the option that says how fine they are.
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

/// Complains of operands whose units differ from that of the first one.
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

/// What the operands' files say that holds of the result: name and unit, if it is the same in all; and by
/// which rule cells were resolved, if they say it: the common one, or `mixed`.
pub fn facts(places: &[Place<'_>]) -> Result<Metadata, Failure> {
    let mut metadata = Metadata::common(places.iter().map(|place| place.metadata)).of("metadata")?;
    let rules: Option<Vec<&str>> = places.iter().map(|place| place.metadata.get("rule")).collect();
    if let Some(rules) = rules {
        let same = rules.iter().all(|rule| *rule == rules[0]);
        metadata.insert("rule", if same { rules[0] } else { "mixed" });
    }
    Ok(metadata)
}
