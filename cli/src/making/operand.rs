//! Operands of set operations: files of any kind, on one frame.

use crate::failure::{Failure, Of, complain};
use crate::making::job::named;
use crate::making::octree_of_volume;
use crate::options::rule_name;
use crate::progress::watched;
use crate::source::file::Stored;
use crate::source::input::Input;
use crate::source::moved::{self, Onto};
use crate::source::placing::Placing;
use crate::source::solid::{Shape, Source};
use crate::words::number;
use leafless::{Affine, Frame, Octree, Rule, SurfaceOptions, build, build_extended};

/// Depth of the common frame if no operand has its own, without --depth.
const DEPTH: u8 = 10;

/// Thickness of the layers of a mesh's surface if another operand keeps surfaces, relative to the mesh's
/// longest side.
const LAYERS: f64 = 1e-4;

/// The requested frame: a cube, and levels of cells.
pub type Wanted = (Option<Frame>, Option<u8>);

/// The common frame of the operands.
pub struct Common {
    pub frame: Frame,
    /// True if the cells of an operand keep surfaces, so that the others must.
    keeps_surfaces: bool,
}

impl Common {
    /// Returns the frame of the first stored solid; otherwise that of the voxels if the first operand is a
    /// volume; otherwise a cube around all operands.
    pub fn new(
        files: &[(Input, Placing)],
        shapes: &[Shape],
        (bounds, depth): Wanted,
    ) -> Result<Common, Failure> {
        let first = &files[0].0;
        let keeps_surfaces = shapes.iter().any(|shape| match shape {
            Shape::Source(Source::Octree(octree)) => octree.view().cuts().is_some(),
            _ => false,
        });
        let stored = files.iter().zip(shapes).find_map(|((input, _), shape)| match shape {
            Shape::Dexels(model) => Some((input, *model.frame())),
            Shape::Source(Source::Octree(octree)) => Some((input, *octree.frame())),
            Shape::Source(_) => None,
        });
        if let Some((input, frame)) = stored {
            let given = [("--bounds", bounds.is_some()), ("--depth", depth.is_some())];
            return match given.into_iter().find(|option| option.1) {
                Some((option, _)) => Err(Failure::Usage(format!(
                    "{option} is for meshes, scenes and volumes: {input} is a solid, which has its own"
                ))),
                None => Ok(Common { frame, keeps_surfaces }),
            };
        }
        let voxels = match &shapes[0] {
            Shape::Source(Source::Volume(volume)) => volume.frame,
            _ => None,
        };
        let frame = match (bounds, voxels) {
            (Some(bounds), _) => bounds.with_depth(depth.unwrap_or(DEPTH)).of(first)?,
            (None, Some(voxels)) => depth.map_or(Ok(voxels), |depth| voxels.with_depth(depth)).of(first)?,
            (None, None) => around(files, shapes, depth.unwrap_or(DEPTH))?,
        };
        Ok(Common { frame, keeps_surfaces })
    }

    /// Puts an operand on the frame. An operand that is stored on it stays as it is.
    pub fn place(
        &self,
        input: &Input,
        placing: &Placing,
        shape: Shape,
        threads: usize,
    ) -> Result<Stored, Failure> {
        let stored = match shape {
            Shape::Dexels(model) => Stored::Dexels(*model),
            Shape::Source(Source::Octree(octree)) => Stored::Octree(*octree),
            Shape::Source(Source::Volume(volume)) => {
                let octree = octree_of_volume::on(&volume, input, &self.frame, Rule::Sampled, threads)?;
                return Ok(Stored::Octree(octree));
            }
            Shape::Source(source) => return Ok(Stored::Octree(self.cells(input, source, threads)?)),
        };
        moved::stored(input, stored, placing, Onto::Frame(&self.frame), threads)
    }

    /// Returns the cells of a mesh or a scene. They keep its surfaces if those of another operand do.
    fn cells(&self, input: &Input, source: Source, threads: usize) -> Result<Octree, Failure> {
        let mut metadata = named(input);
        metadata.insert("rule", rule_name(Rule::Certified));
        if let Some(unit) = source.unit() {
            metadata.insert("units", unit.symbol());
        }
        let has_meshes = match &source {
            Source::Scene(scene) => !scene.report().meshes.is_empty(),
            _ => true,
        };
        let tolerance = match source.bounds(input) {
            Ok((min, max)) if self.keeps_surfaces && has_meshes => {
                let longest = (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max);
                let thickness = LAYERS * longest;
                let kept = "note: its surface is kept in layers that are no thicker than";
                complain(&format!(
                    "{input}: {kept} {}: `leafless voxelize` and `csg` choose other ones",
                    number(thickness)
                ));
                Some(thickness)
            }
            _ => None,
        };
        let solid = source.placed(input, &Affine::IDENTITY, &self.frame)?;
        let made = watched("cells", threads, |control| match self.keeps_surfaces {
            true => build_extended(&solid, &self.frame, &SurfaceOptions { tolerance }, control),
            false => build(&solid, &self.frame, Rule::Certified, control),
        });
        Ok(made.of(input)?.with_metadata(metadata))
    }
}

/// Returns a cube around all operands, none of which is stored.
fn around(files: &[(Input, Placing)], shapes: &[Shape], depth: u8) -> Result<Frame, Failure> {
    let (low, high, ends) = reach(files, shapes)?;
    // A solid that may extend beyond its bounds needs a margin.
    if ends { Frame::fitted(low, high, depth) } else { Frame::around(low, high, depth) }.of(&files[0].0)
}

/// Returns the corners of a box around all operands, none of which is stored, and whether no operand extends
/// beyond it.
pub fn reach(files: &[(Input, Placing)], shapes: &[Shape]) -> Result<([f64; 3], [f64; 3], bool), Failure> {
    let (mut low, mut high, mut ends) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], true);
    for ((input, _), shape) in files.iter().zip(shapes) {
        let Shape::Source(source) = shape else { continue };
        let (min, max) = source.bounds(input)?;
        for axis in 0..3 {
            low[axis] = low[axis].min(min[axis]);
            high[axis] = high[axis].max(max[axis]);
        }
        ends &= source.ends_at_bounds(input)?;
    }
    Ok((low, high, ends))
}
