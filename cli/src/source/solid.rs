//! Solids, and the shapes from which they are made, from files of any kind.

use crate::failure::{Failure, Of};
use crate::source::content::Content;
use crate::source::file::{Found, Stored, Taking};
use crate::source::input::Input;
use crate::source::mesh::{ends_at_vertices, frame_around, reach_of, warn_of_openness};
use crate::source::moved::{self, Onto};
use crate::source::placing::Placing;
use crate::source::scene::{bounds_of, frame_of};
use crate::source::volume::Voxels;
use leafless::exchange::{LengthUnit, MeshFile};
use leafless::lattice::MAX_DEPTH;
use leafless::scene::Scene;
use leafless::{
    Affine, AnySolid, Control, Csg, Error, FillRule, Frame, MeshSolid, Octree, Proof, Rule, Solid, TriDexel,
    TriangleMesh, build,
};

/// The name of a solid's file in messages.
const SOLID: &str = "a solid";

/// The lower and the upper corner of a box.
pub type Corners = ([f64; 3], [f64; 3]);

/// A file's shape, other than a tri-dexel model.
pub enum Source {
    /// A solid (.lfl).
    Octree(Box<Octree>),
    /// A mesh, its fill rule, and the unit of its coordinates if it is known.
    Mesh(TriangleMesh, FillRule, Option<LengthUnit>),
    /// A scene.
    Scene(Scene),
    /// A volume.
    Volume(Box<Voxels>),
}

/// The shape of a file of any kind.
pub enum Shape {
    /// A tri-dexel model (.lfl).
    Dexels(Box<TriDexel>),
    /// Anything else.
    Source(Source),
}

impl Shape {
    /// Reads a file of any kind. A file that does not contain a stored solid also gets a fingerprint. Files
    /// of solids are verified.
    pub fn read(input: &Input, taking: &Taking) -> Result<(Shape, Option<String>), Failure> {
        let (shape, fingerprint) = Shape::before_moving(input, taking)?;
        Ok((shape.moved(input, &taking.placing)?, fingerprint))
    }

    /// Reads a file of any kind, and leaves a stored solid where its file says.
    pub fn before_moving(input: &Input, taking: &Taking) -> Result<(Shape, Option<String>), Failure> {
        Shape::of(input, Found::look(input, taking.reading.told())?, taking)
    }

    /// Reads one of several files of all kinds: each option applies to the files for which it has a meaning.
    pub fn among_others(input: &Input, taking: &Taking, placing: &Placing) -> Result<Shape, Failure> {
        let found = Found::look(input, taking.reading.told())?;
        let taking = taking.about(found.content, placing);
        Ok(Shape::of(input, found, &taking)?.0)
    }

    fn of(input: &Input, found: Found<'_>, taking: &Taking) -> Result<(Shape, Option<String>), Failure> {
        if found.content != Content::Solid {
            let fingerprint = found.fingerprint();
            return Ok((Shape::Source(Source::of(input, found, taking)?), Some(fingerprint)));
        }
        taking.refuse(input, SOLID)?;
        let shape = match found.stored(true)?.0 {
            Stored::Dexels(model) => Shape::Dexels(Box::new(model)),
            Stored::Octree(octree) => Shape::Source(Source::Octree(Box::new(octree))),
        };
        Ok((shape, None))
    }

    /// True for a stored solid.
    pub fn is_stored(&self) -> bool {
        matches!(self, Shape::Dexels(_) | Shape::Source(Source::Octree(_)))
    }

    /// Returns the shape; a stored solid is moved.
    fn moved(self, input: &Input, placing: &Placing) -> Result<Shape, Failure> {
        match (self, placing.map()) {
            (Shape::Dexels(model), Some(map)) => {
                Ok(Shape::Dexels(Box::new(moved::dexels(input, &model, map, Onto::Image, 0)?)))
            }
            (Shape::Source(source), _) => Ok(Shape::Source(source.moved(input, placing)?)),
            (shape, None) => Ok(shape),
        }
    }
}

impl Source {
    /// Reads a solid, a mesh, a scene or a volume. Answers about a solid are proven, so its file is verified.
    pub fn read(input: &Input, taking: &Taking) -> Result<Source, Failure> {
        Source::before_moving(input, taking)?.moved(input, &taking.placing)
    }

    /// Reads the same, and leaves a solid from a file where the file says.
    pub fn before_moving(input: &Input, taking: &Taking) -> Result<Source, Failure> {
        Source::of(input, Found::look(input, taking.reading.told())?, taking)
    }

    fn moved(self, input: &Input, placing: &Placing) -> Result<Source, Failure> {
        match (self, placing.map()) {
            (Source::Octree(octree), Some(map)) => {
                Ok(Source::Octree(Box::new(moved::octree(input, *octree, map, Onto::Image, 0)?)))
            }
            (source, _) => Ok(source),
        }
    }

    fn of(input: &Input, found: Found<'_>, taking: &Taking) -> Result<Source, Failure> {
        let Taking { reading, drawing, placing } = taking;
        match found.content {
            Content::Solid => {
                taking.refuse(input, SOLID)?;
                Ok(Source::Octree(Box::new(found.octree()?)))
            }
            Content::Scene => {
                reading.refuse(input, "a scene")?;
                Ok(Source::Scene(found.scene(drawing, placing)?))
            }
            Content::Volume => {
                drawing.refuse(input, "a volume")?;
                Ok(Source::Volume(Box::new(found.volume(reading, placing)?)))
            }
            Content::Mesh => {
                drawing.refuse(input, "a mesh")?;
                let (MeshFile { mesh, unit, .. }, fill) = found.mesh(reading, placing)?;
                warn_of_openness(input, &mesh.report().of(input)?, fill);
                Ok(Source::Mesh(mesh, fill, unit))
            }
        }
    }

    /// Returns what the cells of a solid from a file prove. Other shapes are what they claim to be, so
    /// everything is proven.
    pub fn proof(&self) -> Proof {
        match self {
            Source::Octree(octree) => octree.proof(),
            Source::Mesh(..) | Source::Scene(_) | Source::Volume(_) => Proof::CERTIFIED,
        }
    }

    /// Returns the source; with `cells`, the cells of a solid from a file count as the solid itself.
    pub fn taken(self, cells: bool) -> Source {
        match self {
            Source::Octree(octree) if cells => Source::Octree(Box::new(octree.with_proof(Proof::CERTIFIED))),
            source => source,
        }
    }

    /// True for an octree from a file that consists of its cells only. An octree whose cells keep surfaces is
    /// queried like scenes and meshes: its own cells are large, and say little.
    pub fn is_of_cells(&self) -> bool {
        matches!(self, Source::Octree(octree) if octree.view().cuts().is_none())
    }

    /// True if the surfaces may be known exactly under a placement, on a frame: those of a scene, and those
    /// that the cells of an unmoved octree keep.
    pub fn has_exact_surfaces(&self, placement: &Affine, frame: &Frame) -> bool {
        match self {
            Source::Octree(octree) => {
                octree.view().cuts().is_some()
                    && placement.is_identity()
                    && octree.frame().same_universe(frame)
            }
            Source::Scene(_) => true,
            Source::Mesh(..) | Source::Volume(_) => false,
        }
    }

    /// Returns the unit of the coordinates, if it is known.
    pub fn unit(&self) -> Option<LengthUnit> {
        match self {
            Source::Octree(octree) => octree.metadata().get("units")?.parse().ok(),
            Source::Mesh(_, _, unit) => *unit,
            Source::Scene(_) => None,
            Source::Volume(volume) => volume.unit,
        }
    }

    /// Returns the frame of a solid, or of a volume's voxels.
    pub fn own_frame(&self) -> Option<&Frame> {
        match self {
            Source::Octree(octree) => Some(octree.frame()),
            Source::Volume(volume) => volume.frame.as_ref(),
            Source::Mesh(..) | Source::Scene(_) => None,
        }
    }

    /// Returns the frame for queries: a solid's own, or a frame around the mesh or scene, which can be split
    /// to any depth.
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

    /// Returns the same frame, or one in the cube that the user gave for a mesh or a scene.
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

    /// Returns the same frame if the depth is optional: without a depth, a shape that has no cells, or whose
    /// cells keep surfaces, is split to `deepest`.
    pub fn frame_to(
        &self,
        input: &Input,
        bounds: Option<&Frame>,
        depth: Option<u8>,
        deepest: u8,
    ) -> Result<Frame, Failure> {
        let has_size = match self {
            Source::Octree(_) => self.is_of_cells(),
            source => source.own_frame().is_some(),
        };
        self.frame_in(input, bounds, depth.or((!has_size).then_some(deepest)))
    }

    /// True if the solid does not extend beyond its bounds.
    pub fn ends_at_bounds(&self, input: &Input) -> Result<bool, Failure> {
        match self {
            Source::Octree(_) | Source::Scene(_) | Source::Volume(_) => Ok(true),
            Source::Mesh(mesh, ..) => ends_at_vertices(mesh).of(input),
        }
    }

    /// Returns the corners of a box around the solid: its universe, or the bounds of the mesh or the scene.
    pub fn bounds(&self, input: &Input) -> Result<Corners, Failure> {
        Ok(match self {
            Source::Octree(octree) => {
                let frame = octree.frame();
                (frame.origin(), frame.origin().map(|low| low + frame.edge()))
            }
            Source::Mesh(mesh, ..) => reach_of(mesh),
            Source::Scene(scene) => bounds_of(input, scene)?,
            Source::Volume(volume) => {
                let bounds = volume.solid.bounds().ok_or_else(|| Failure::of(input, "has no bounds"))?;
                (bounds.min, bounds.max)
            }
        })
    }

    /// Returns the solid under a placement, for queries about cells of `frame`. It is moved in the best way
    /// that its kind allows.
    pub fn placed(self, input: &Input, placement: &Affine, frame: &Frame) -> Result<AnySolid, Failure> {
        let solid = match self {
            Source::Octree(octree) => return moved::solid_of(input, *octree, placement, frame),
            Source::Mesh(mesh, fill, _) => AnySolid::new(MeshSolid::new(mesh, fill).of(input)?),
            Source::Scene(scene) => AnySolid::new(scene.solid(frame).of(input)?),
            Source::Volume(volume) => volume.solid,
        };
        solid.placed(placement).of(input)
    }
}

/// Returns the cells of a solid on a frame. An octree of the same cube brings its channels along, and the
/// surfaces that its cells keep decide.
pub fn cells_of<S: Solid>(
    solid: &S,
    octree: Option<&Octree>,
    frame: &Frame,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    let cells = build(solid, frame, Rule::Certified, control)?;
    Ok(match octree.filter(|octree| octree.frame().same_universe(frame)) {
        Some(octree) => cells.with_metadata_from(octree).with_channels_from(octree),
        None => cells,
    })
}

/// Returns the number of half-spaces that were evaluated for a solid.
pub fn evaluations(solid: &AnySolid) -> u64 {
    solid.get::<Csg>().map_or(0, Csg::evaluations)
}
