//! Solids to ask questions about: from files of any kind.

pub mod content;
pub mod expression;
pub mod input;
pub mod mesh;
pub mod scene;
pub mod shape;
pub mod target;
pub mod volume;

use crate::failure::{Failure, Of, complain};
use crate::source::content::Content;
use crate::source::input::Input;
use crate::source::mesh::{Reading, check_closed, ends_at_vertices, frame_around, openness};
use crate::source::scene::{Curves, Drawing, bounds_of, frame_of, scene_of};
use crate::source::volume::Voxels;
use leafless::exchange::LengthUnit;
use leafless::scene::Scene;
use leafless::{
    Affine, AnySolid, Csg, FillRule, Frame, MAX_DEPTH, MeshSolid, Octree, Proof, Solid, Transform,
    TriangleMesh, file,
};

/// What a file of a solid is called.
const SOLID: &str = "a solid";

/// Of a box, the lower and the upper one.
pub type Corners = ([f64; 3], [f64; 3]);

/// What was read.
pub enum Source {
    /// A solid (.lfl).
    Octree(Box<Octree>),
    /// A mesh, which points count as inside, and the unit of its coordinates if it is known.
    Mesh(TriangleMesh, FillRule, Option<LengthUnit>),
    /// A scene.
    Scene(Scene),
    /// A volume.
    Volume(Box<Voxels>),
}

impl Source {
    /// Reads a solid, a mesh, a scene or a volume. Answers about a solid are proven, so its file is verified.
    pub fn read(input: &Input, reading: &Reading, drawing: &Drawing) -> Result<Source, Failure> {
        if input.begins_as_solid() {
            reading.refuse(input, SOLID)?;
            drawing.refuse(input, SOLID)?;
            return Ok(Source::Octree(Box::new(input.octree(true)?.0)));
        }
        Source::of_bytes(input, input.read()?, reading, drawing)
    }

    /// The same of a file with these bytes.
    pub fn of_bytes(
        input: &Input,
        bytes: Vec<u8>,
        reading: &Reading,
        drawing: &Drawing,
    ) -> Result<Source, Failure> {
        match Content::of(input, &bytes, reading.told())? {
            Content::Solid => {
                reading.refuse(input, SOLID)?;
                drawing.refuse(input, SOLID)?;
                return Ok(Source::Octree(Box::new(file::from_bytes(&bytes).of(input)?)));
            }
            Content::Scene => {
                reading.refuse(input, "a scene")?;
                return Ok(Source::Scene(scene_of(input, &bytes, drawing)?.0));
            }
            Content::Volume => {
                drawing.refuse(input, "a volume")?;
                return Ok(Source::Volume(Box::new(reading.volume(input, &bytes)?)));
            }
            Content::Mesh => drawing.refuse(input, "a mesh")?,
        }
        let read = reading.mesh(input, bytes)?;
        let fill = reading.fill(read.format);
        check_closed(input, &read.mesh, fill)?;
        if fill != FillRule::EvenOdd
            && let Some(how) = openness(&read.mesh.report().of(input)?)
        {
            let whole = "the mesh does not bound a solid";
            let warning =
                format!("{input}: warning: {whole}: {how}; the winding number decides what is inside");
            complain(&warning);
        }
        Ok(Source::Mesh(read.mesh, fill, read.unit))
    }

    /// What the cells of a solid from a file prove; of anything else, which is what it says it is, all.
    pub fn proof(&self) -> Proof {
        match self {
            Source::Octree(octree) => octree.proof(),
            Source::Mesh(..) | Source::Scene(_) | Source::Volume(_) => Proof::CERTIFIED,
        }
    }

    /// The same; of a solid from a file the cells themselves, if that is asked for, and not what they prove.
    pub fn taken(self, cells: bool) -> Source {
        match self {
            Source::Octree(octree) if cells => Source::Octree(Box::new(octree.with_proof(Proof::CERTIFIED))),
            source => source,
        }
    }

    /// How the curves of a scene were drawn.
    pub fn curves(&self) -> Option<Curves> {
        match self {
            Source::Scene(scene) => Some(scene.report().into()),
            Source::Octree(_) | Source::Mesh(..) | Source::Volume(_) => None,
        }
    }

    /// The unit of its coordinates, if it is known.
    pub fn unit(&self) -> Option<LengthUnit> {
        match self {
            Source::Octree(octree) => octree.metadata().get("units")?.parse().ok(),
            Source::Mesh(_, _, unit) => *unit,
            Source::Scene(_) => None,
            Source::Volume(volume) => volume.unit,
        }
    }

    /// The frame of a solid, or of a volume's voxels.
    pub fn own_frame(&self) -> Option<&Frame> {
        match self {
            Source::Octree(octree) => Some(octree.frame()),
            Source::Volume(volume) => volume.frame.as_ref(),
            Source::Mesh(..) | Source::Scene(_) => None,
        }
    }

    /// The frame to ask it on: a solid's own, or one around the mesh or scene, which can be split to any depth.
    pub fn frame(&self, input: &Input, depth: Option<u8>) -> Result<Frame, Failure> {
        match (self, depth) {
            (Source::Octree(octree), None) => Ok(*octree.frame()),
            (Source::Octree(octree), Some(depth)) => octree.frame().with_depth(depth).of(input),
            (Source::Mesh(mesh, ..), depth) => frame_around(mesh, depth.unwrap_or(MAX_DEPTH)).of(input),
            (Source::Scene(scene), depth) => frame_of(input, scene, None, depth.unwrap_or(MAX_DEPTH)),
            (Source::Volume(volume), depth) => match (&volume.frame, depth) {
                (Some(frame), None) => Ok(*frame),
                (Some(frame), Some(depth)) => frame.with_depth(depth).of(input),
                (None, depth) => {
                    let (min, max) = self.bounds(input)?;
                    Frame::fitted(min, max, depth.unwrap_or(MAX_DEPTH)).of(input)
                }
            },
        }
    }

    /// The same in a cube that the user may have given, for a mesh or a scene.
    pub fn frame_in(
        &self,
        input: &Input,
        bounds: Option<&Frame>,
        depth: Option<u8>,
    ) -> Result<Frame, Failure> {
        match bounds {
            Some(_) if self.own_frame().is_some() => {
                Err(Failure::Usage("--bounds is for meshes and scenes: a solid has its own".into()))
            }
            Some(bounds) => bounds.with_depth(depth.unwrap_or(MAX_DEPTH)).of(input),
            None => self.frame(input, depth),
        }
    }

    /// Whether nothing of it lies beyond its bounds.
    pub fn ends_at_bounds(&self, input: &Input) -> Result<bool, Failure> {
        match self {
            Source::Octree(_) | Source::Scene(_) | Source::Volume(_) => Ok(true),
            Source::Mesh(mesh, ..) => ends_at_vertices(mesh).of(input),
        }
    }

    /// Corners of what is around the solid: its universe, or the bounds of the mesh or the scene.
    pub fn bounds(&self, input: &Input) -> Result<Corners, Failure> {
        Ok(match self {
            Source::Octree(octree) => {
                let frame = octree.frame();
                (frame.origin(), frame.origin().map(|low| low + frame.edge()))
            }
            Source::Mesh(mesh, ..) => mesh.bounds(),
            Source::Scene(scene) => bounds_of(input, scene)?,
            Source::Volume(volume) => {
                let bounds = volume.solid.bounds().ok_or_else(|| Failure::of(input, "has no bounds"))?;
                (bounds.min, bounds.max)
            }
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
            Source::Mesh(mesh, fill, _) => AnySolid::new(MeshSolid::new(mesh, fill).of(input)?),
            Source::Scene(scene) => AnySolid::new(scene.solid(frame).of(input)?),
            Source::Volume(volume) => volume.solid,
        };
        solid.placed(placement).of(input)
    }
}

/// Half-spaces that were evaluated for a solid.
pub fn evaluations(solid: &AnySolid) -> u64 {
    solid.get::<Csg>().map_or(0, Csg::evaluations)
}
