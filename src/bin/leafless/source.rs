//! Solids to ask questions about: from files of any kind.

use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::mesh::{Reading, openness};
use crate::output;
use crate::scene::{bounds_of, read_scene};
use leafless::file::{MeshFormat, Scene};
use leafless::{Affine, AnySolid, FillRule, Frame, MeshSolid, Octree, Transform, TriangleMesh, file};
use std::path::Path;

/// Of a box, the lower and the upper one.
pub type Corners = ([f64; 3], [f64; 3]);

/// What was read.
pub enum Source {
    /// A solid (.lfl).
    Octree(Box<Octree>),
    /// A mesh, and which points count as inside.
    Mesh(TriangleMesh, FillRule),
    /// A scene.
    Scene(Scene),
}

impl Source {
    /// Reads a solid or a mesh. Answers about a solid are proven, so its file is verified.
    pub fn read(input: &Input, reading: &Reading) -> Result<Source, Failure> {
        if input.begins_as_solid() {
            return Ok(Source::Octree(Box::new(input.octree(true)?.0)));
        }
        if input
            .path()
            .and_then(Path::extension)
            .is_some_and(|extension| extension.eq_ignore_ascii_case("csg"))
        {
            return Ok(Source::Scene(read_scene(input)?.0));
        }
        let bytes = input.read()?;
        if bytes.starts_with(&file::MAGIC) {
            return Ok(Source::Octree(Box::new(file::from_bytes(&bytes).of(input)?)));
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
            Source::Mesh(..) | Source::Scene(_) => None,
        }
    }

    /// Corners of what is around the solid: its universe, or the bounds of the mesh or the scene.
    pub fn bounds(&self, input: &Input) -> Result<Corners, Failure> {
        Ok(match self {
            Source::Octree(octree) => {
                let frame = octree.frame();
                (frame.origin(), frame.origin().map(|low| low + frame.edge()))
            }
            Source::Mesh(mesh, _) => mesh.bounds(),
            Source::Scene(scene) => bounds_of(input, scene)?,
        })
    }

    /// The solid under a placement, to be asked about cells of `frame`. A mesh is moved by its vertices, so that nothing
    /// blurs.
    pub fn placed(self, input: &Input, placement: &Affine, frame: &Frame) -> Result<AnySolid, Failure> {
        Ok(match self {
            Source::Octree(octree) if placement.is_identity() && octree.frame().same_universe(frame) => {
                AnySolid::new(*octree)
            }
            Source::Octree(octree) => {
                let own = *octree.frame();
                AnySolid::new(Transform::new(*octree, &own, placement))
            }
            Source::Mesh(mesh, fill) => {
                let mesh = if placement.is_identity() { mesh } else { mesh.placed(placement).of(input)? };
                AnySolid::new(MeshSolid::new(mesh, frame, fill).of(input)?)
            }
            Source::Scene(scene) => {
                let scene = scene.placed(placement).of(input)?;
                AnySolid::new(scene.solid(frame).of(input)?)
            }
        })
    }
}
