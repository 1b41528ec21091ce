//! Solids of either kind, and what one can be made of: from files of any kind.

use crate::failure::{Failure, Of};
use crate::source::Source;
use crate::source::input::Input;
use crate::source::mesh::Reading;
use crate::source::scene::Drawing;
use leafless::{TriDexel, file};

/// What was read.
pub enum Shape {
    /// A tri-dexel model (.lfl).
    Dexels(Box<TriDexel>),
    /// Anything else.
    Source(Source),
}

impl Shape {
    /// Reads a file of any kind; of one that holds no solid yet, a fingerprint, too. Files of solids are verified.
    pub fn read(
        input: &Input,
        reading: &Reading,
        drawing: &Drawing,
    ) -> Result<(Shape, Option<String>), Failure> {
        let refuse = || {
            reading.refuse(input, "a solid")?;
            drawing.refuse(input, "a solid")
        };
        if let Some((model, _)) = input.dexels(true)? {
            refuse()?;
            return Ok((Shape::Dexels(Box::new(model)), None));
        }
        if input.begins_as_solid() {
            return Ok((Shape::Source(Source::read(input, reading, drawing)?), None));
        }
        let bytes = input.read()?;
        if file::probe_bytes(&bytes).is_ok_and(|probe| probe.dexels.is_some()) {
            refuse()?;
            let model = file::dexels::from_bytes(&bytes).of(input)?;
            return Ok((Shape::Dexels(Box::new(model)), None));
        }
        let fingerprint = format!("crc32:{:08x} bytes:{}", crc32fast::hash(&bytes), bytes.len());
        let source = Source::of_bytes(input, bytes, reading, drawing)?;
        let is_new = !matches!(source, Source::Octree(_));
        Ok((Shape::Source(source), is_new.then_some(fingerprint)))
    }
}
