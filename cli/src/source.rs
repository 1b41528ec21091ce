//! Solids to ask questions about: from files of any kind.

use crate::failure::{Failure, Of};
use crate::input::Input;
use crate::mesh::{Reading, openness};
use crate::output;
use crate::scene::{bounds_of, read_scene};
use leafless::exchange::MeshFormat;
use leafless::scene::Scene;
use leafless::{
    Affine, AnySolid, Csg, FillRule, Frame, MeshSolid, Octree, Proof, Transform, TriangleMesh, file,
};
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

    /// The same; of a solid from a file the cells themselves, if that is asked for, and not what they prove.
    pub fn taken(self, cells: bool) -> Source {
        match self {
            Source::Octree(octree) if cells => Source::Octree(Box::new(octree.with_proof(Proof::CERTIFIED))),
            source => source,
        }
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

    /// The solid under a placement, to be asked about cells of `frame`, moved in the best way that its kind
    /// knows.
    pub fn placed(self, input: &Input, placement: &Affine, frame: &Frame) -> Result<AnySolid, Failure> {
        let solid = match self {
            Source::Octree(octree) if placement.is_identity() && !octree.frame().same_universe(frame) => {
                return Ok(AnySolid::new(Transform::of(*octree, placement)));
            }
            Source::Octree(octree) => AnySolid::new(*octree),
            Source::Mesh(mesh, fill) => AnySolid::new(MeshSolid::new(mesh, fill).of(input)?),
            Source::Scene(scene) => AnySolid::new(scene.solid(frame).of(input)?),
        };
        solid.placed(placement).of(input)
    }
}

/// Half-spaces that were evaluated for a solid.
pub fn evaluations(solid: &AnySolid) -> u64 {
    solid.get::<Csg>().map_or(0, Csg::evaluations)
}
