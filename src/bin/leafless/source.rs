//! Solids to ask questions about: from files of any kind.

use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::mesh::{Reading, openness};
use crate::output;
use leafless::file::MeshFormat;
use leafless::{Affine, AnySolid, FillRule, Frame, MeshSolid, Octree, Transform, TriangleMesh, file};

/// What was read.
pub enum Source {
    /// A solid (.lfl).
    Octree(Octree),
    /// A mesh, and which points count as inside.
    Mesh(TriangleMesh, FillRule),
}

impl Source {
    /// Reads a solid or a mesh. Answers about a solid are proven, so its file is verified.
    pub fn read(input: &Input, reading: &Reading) -> Result<Source, Failure> {
        if input.begins_as_solid() {
            return Ok(Source::Octree(input.octree(true)?.0));
        }
        let bytes = input.read()?;
        if bytes.starts_with(&file::MAGIC) {
            return Ok(Source::Octree(file::from_bytes(&bytes).of(input)?));
        }
        let read = reading.mesh(input, bytes)?;
        let fill = match read.format {
            MeshFormat::ThreeMf => FillRule::Positive,
            _ => FillRule::NonZero,
        };
        if let Some(how) = openness(&read.mesh.report().of(input)?) {
            let whole = "the mesh does not bound a solid";
            let warning =
                format!("{input}: warning: {whole}: {how}; the winding number decides what is inside");
            output::complain(&warning);
        }
        Ok(Source::Mesh(read.mesh, fill))
    }

    /// The frame of a solid.
    pub fn own_frame(&self) -> Option<&Frame> {
        match self {
            Source::Octree(octree) => Some(octree.frame()),
            Source::Mesh(..) => None,
        }
    }

    /// Corners of what is around the solid: its universe, or the bounds of the mesh.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        match self {
            Source::Octree(octree) => {
                let frame = octree.frame();
                (frame.origin(), frame.origin().map(|low| low + frame.edge()))
            }
            Source::Mesh(mesh, _) => mesh.bounds(),
        }
    }

    /// The solid under a placement, to be asked about cells of `frame`. A mesh is moved by its vertices, so that nothing
    /// blurs.
    pub fn placed(self, input: &Input, placement: &Affine, frame: &Frame) -> Result<AnySolid, Failure> {
        Ok(match self {
            Source::Octree(octree) if placement.is_identity() && octree.frame().same_universe(frame) => {
                AnySolid::new(octree)
            }
            Source::Octree(octree) => {
                let own = *octree.frame();
                AnySolid::new(Transform::new(octree, &own, placement))
            }
            Source::Mesh(mesh, fill) => {
                let mesh = if placement.is_identity() { mesh } else { mesh.placed(placement).of(input)? };
                AnySolid::new(MeshSolid::new(mesh, frame, fill).of(input)?)
            }
        })
    }
}
