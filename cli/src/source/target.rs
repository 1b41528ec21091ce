//! A solid that answers many questions.

use crate::failure::Failure;
use crate::options::{bounds, threads};
use crate::source::file::Taking;
use crate::source::input::Input;
use crate::source::solid::Source;
use clap::Args;
use leafless::solid::Prepared;
use leafless::{Affine, Frame, Octree, Proof};

/// The options of reading and examining a solid that is queried.
#[derive(Args)]
pub struct Looking {
    /// Take the cells of a solid from a file (.lfl) as the solid itself, whatever the cells prove about their
    /// source. A file that is written still records what the cells prove
    #[arg(long)]
    cells: bool,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    pub threads: usize,
    /// Lower corner and edge length of the cube to examine, for a mesh or scene [default: the cube around it]
    #[arg(long, value_name = "X0,Y0,Z0,EDGE", value_parser = bounds, allow_hyphen_values = true)]
    bounds: Option<Frame>,
    #[command(flatten)]
    taking: Taking,
}

impl Looking {
    /// Reads a solid. `depth` is the one that the user gave. Without it, a mesh, a scene, or an octree whose
    /// cells keep surfaces is split to `deepest`.
    pub fn target(&self, input: &Input, depth: Option<u8>, deepest: u8) -> Result<Target, Failure> {
        Ok(self.target_and_proof(input, depth, deepest)?.0)
    }

    /// Reads a solid, and also returns what the cells of its file prove about their source. This is
    /// independent of --cells: a result that is written proves no more.
    pub fn target_and_proof(
        &self,
        input: &Input,
        depth: Option<u8>,
        deepest: u8,
    ) -> Result<(Target, Proof), Failure> {
        let source = Source::read(input, &self.taking)?;
        let proof = source.proof();
        Ok((Target::of(source.taken(self.cells), input, self.bounds.as_ref(), depth, deepest)?, proof))
    }
}

/// A solid that is queried.
pub enum Target {
    /// A stored octree whose cells are proven and keep no surfaces: it is queried in place.
    Cells(Box<Octree>),
    /// Any other solid, on a frame.
    Solid(Box<(Prepared, Frame)>),
}

impl Target {
    fn of(
        source: Source,
        input: &Input,
        bounds: Option<&Frame>,
        depth: Option<u8>,
        deepest: u8,
    ) -> Result<Target, Failure> {
        match source {
            Source::Octree(octree)
                if octree.view().proof().is_certified()
                    && octree.view().cuts().is_none()
                    && depth.is_none()
                    && bounds.is_none() =>
            {
                Ok(Target::Cells(octree))
            }
            source => {
                let frame = source.frame_to(input, bounds, depth, deepest)?;
                let solid = Prepared::new(source.placed(input, &Affine::IDENTITY, &frame)?);
                Ok(Target::Solid(Box::new((solid, frame))))
            }
        }
    }

    /// Returns the frame of the queries.
    pub fn frame(&self) -> &Frame {
        match self {
            Target::Cells(octree) => octree.frame(),
            Target::Solid(target) => &target.1,
        }
    }
}
