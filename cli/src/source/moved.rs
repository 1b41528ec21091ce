//! Stored solids that are moved: they are queried in their new place, or remade there.

use crate::failure::{Failure, Of, complain};
use crate::progress::watched;
use crate::source::file::Stored;
use crate::source::input::Input;
use crate::source::placing::{Placing, image};
use leafless::attribute::{FillOptions, MovedAttribute, fill_channel};
use leafless::dexel::{DexelFormat, DexelNormals};
use leafless::lattice::MAX_DEPTH;
use leafless::op::DexelOptions;
use leafless::solid::Transform;
use leafless::surface::{dual_contouring_dexels, marching_cubes_dexels};
use leafless::{
    Affine, AnySolid, Bounds, Control, Error, FillRule, Frame, MeshSolid, Octree, Proof, Rule,
    SurfaceOptions, Tag, TriDexel, bounding_box, build, build_extended, dexelize,
};

/// The frame on which a moved solid is made.
#[derive(Clone, Copy)]
pub enum Onto<'a> {
    /// The image of its own frame if that is a cube; otherwise a cube around the image, with cells that are
    /// no larger.
    Image,
    /// This frame.
    Frame(&'a Frame),
}

/// Returns an octree under a placement as a solid, for queries about cells of `frame`.
pub fn solid_of(
    input: &Input,
    octree: Octree,
    placement: &Affine,
    frame: &Frame,
) -> Result<AnySolid, Failure> {
    if placement.is_identity() && !octree.frame().same_universe(frame) {
        return Ok(AnySolid::new(Transform::of(octree, placement)));
    }
    AnySolid::new(octree).placed(placement).of(input)
}

/// Moves a stored solid to the user's placement.
pub fn stored(
    input: &Input,
    stored: Stored,
    placing: &Placing,
    onto: Onto<'_>,
    threads: usize,
) -> Result<Stored, Failure> {
    let Some(map) = placing.map() else { return Ok(stored) };
    Ok(match stored {
        Stored::Octree(own) => Stored::Octree(octree(input, own, map, onto, threads)?),
        Stored::Dexels(own) => Stored::Dexels(dexels(input, &own, map, onto, threads)?),
    })
}

/// Moves an octree by a map. Its surfaces and channels are kept.
pub fn octree(
    input: &Input,
    own: Octree,
    map: &Affine,
    onto: Onto<'_>,
    threads: usize,
) -> Result<Octree, Failure> {
    let frame = match onto {
        Onto::Frame(frame) => *frame,
        Onto::Image => frame_of(&own, map).of(input)?,
    };
    let keeps_surfaces = own.view().cuts().is_some();
    // Cells that prove nothing are samples, and are sampled again.
    let rule = match own.proof() {
        Proof { full: false, empty: false, .. } if own.view().is_binary() => Rule::Sampled,
        _ => Rule::Certified,
    };
    let solid = solid_of(input, own.clone(), map, &frame)?;
    let moved = watched("move", threads, |control| {
        let moved = match (keeps_surfaces, rule) {
            (true, _) => build_extended(&solid, &frame, &SurfaceOptions::default(), control)?,
            // On every lattice, and under every map.
            (false, Rule::Sampled) => {
                build(&Transform::of(own.clone(), map).nearest(), &frame, Rule::Sampled, control)?
            }
            (false, rule) => build(&solid, &frame, rule, control)?,
        };
        with_channels(moved.with_metadata_from(&own), &own, map, control)
    });
    moved.of(input)
}

/// Adds the channels of another octree, moved onto the octree.
fn with_channels(moved: Octree, own: &Octree, map: &Affine, control: &Control<'_>) -> Result<Octree, Error> {
    if own.channels().is_empty() {
        return Ok(moved);
    }
    let back = map.inverse()?;
    own.channels().iter().try_fold(moved, |moved, channel| {
        // The channel's depth relative to the octree stays the same.
        let depth = channel.frame().depth() + moved.frame().depth();
        let depth = depth.saturating_sub(own.frame().depth()).clamp(1, MAX_DEPTH);
        let frame = moved.frame().with_depth(depth)?;
        let value_type = channel.value_type();
        let options = FillOptions { value_type, frame, solid: Some(moved.view()), detail: None };
        let filled = fill_channel(&MovedAttribute::new(channel.clone(), back), &options, control)?;
        moved.with_channel(filled.with_name(channel.name()).with_metadata_from(channel))
    })
}

/// Moves a tri-dexel model by a map: the new model is made of its surface, which is sharp if the model has
/// normals.
pub fn dexels(
    input: &Input,
    own: &TriDexel,
    map: &Affine,
    onto: Onto<'_>,
    threads: usize,
) -> Result<TriDexel, Failure> {
    let view = own.view();
    let format = view.format();
    for (lost, what) in [(format.surfaces, "the surfaces of its ends"), (format.materials, "materials")] {
        if lost {
            complain(&format!("{input}: warning: the moved tri-dexel model does not keep {what}"));
        }
    }
    let moved = watched("move", threads, |control| {
        let mesh = match format.normals {
            DexelNormals::None => marching_cubes_dexels(view, control)?.0,
            _ => dual_contouring_dexels(view, control)?.0,
        };
        let mesh = mesh.placed(map)?;
        let (min, max) = mesh.bounds();
        let frame = match onto {
            Onto::Frame(frame) => *frame,
            Onto::Image => match image(own.frame(), map) {
                Some(image) => image,
                None => fitted(own.frame(), Bounds { min, max }, map)?,
            },
        };
        let format = DexelFormat { surfaces: false, materials: false, ..format };
        let options = DexelOptions { format, directions: view.directions(), rule: Rule::Sampled };
        dexelize(&MeshSolid::new(mesh, FillRule::NonZero)?, &frame, &options, control)
    });
    Ok(moved.of(input)?.with_metadata(own.metadata().clone()))
}

/// Returns the frame that an octree is moved onto, if the user names none.
pub fn frame_of(octree: &Octree, map: &Affine) -> Result<Frame, Error> {
    let own = octree.frame();
    match image(own, map) {
        Some(image) => Ok(image),
        None => {
            let problem = "moves the solid beyond the range of double precision";
            let bounds =
                occupied(octree)?.placed(map).ok_or(Error::Argument { name: "placement", problem })?;
            fitted(own, bounds, map)
        }
    }
}

/// Returns a box around the inside of an octree within its universe.
fn occupied(octree: &Octree) -> Result<Bounds, Error> {
    let universe = Bounds::of(octree.frame());
    if octree.view().exterior() != Tag::Empty {
        return Ok(universe);
    }
    let control = Control { max_splits: Some(1 << 16), ..Control::default() };
    // The proof of the cells does not matter here.
    let cells = octree.clone().with_proof(Proof::CERTIFIED);
    let found = bounding_box(&cells, cells.frame(), 1e-3 * cells.frame().edge(), &control)?;
    let Some([min, max]) = found.corners else { return Ok(universe) };
    Ok(Bounds { min: min.map(|low| low.lower), max: max.map(|high| high.upper) })
}

/// Returns a frame around a box, with cells that are no larger than the images of another frame's cells.
fn fitted(own: &Frame, Bounds { min, max }: Bounds, map: &Affine) -> Result<Frame, Error> {
    let column = |j: usize| map.rows().iter().map(|row| row[j] * row[j]).sum::<f64>().sqrt();
    let cell = own.cell_size() * (0..3).map(column).fold(f64::INFINITY, f64::min);
    let frame = Frame::fitted(min, max, MAX_DEPTH)?;
    let fits = |depth: &u8| frame.with_depth(*depth).is_ok_and(|frame| frame.cell_size() <= cell);
    frame.with_depth((1..MAX_DEPTH).find(fits).unwrap_or(MAX_DEPTH))
}
