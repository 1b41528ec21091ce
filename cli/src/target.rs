//! A solid that many questions are put to.

use crate::failure::Failure;
use crate::input::Input;
use crate::source::Source;
use leafless::{Affine, Frame, Octree, Prepared};

/// What is asked.
pub enum Target {
    /// A stored octree whose cells prove what they say: it is asked where it lies.
    Cells(Box<Octree>),
    /// Anything else, on a frame.
    Solid(Box<(Prepared, Frame)>),
}

impl Target {
    /// `bounds` and `depth` are those that the user gave; without a depth a mesh or a scene is split to `deepest`.
    pub fn of(
        source: Source,
        input: &Input,
        bounds: Option<&Frame>,
        depth: Option<u8>,
        deepest: u8,
    ) -> Result<Target, Failure> {
        match source {
            Source::Octree(octree)
                if octree.view().proof().is_certified() && depth.is_none() && bounds.is_none() =>
            {
                Ok(Target::Cells(octree))
            }
            source => {
                let depth = depth.or(source.own_frame().is_none().then_some(deepest));
                let frame = source.frame_in(input, bounds, depth)?;
                let solid = Prepared::new(source.placed(input, &Affine::IDENTITY, &frame)?);
                Ok(Target::Solid(Box::new((solid, frame))))
            }
        }
    }

    /// The frame that it is asked on.
    pub fn frame(&self) -> &Frame {
        match self {
            Target::Cells(octree) => octree.frame(),
            Target::Solid(target) => &target.1,
        }
    }
}
