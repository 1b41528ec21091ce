//! The materials of tri-dexel models.

use super::sampled::{FillOptions, fill_channel};
use super::{Attribute, ValueRange};
use crate::control::Control;
use crate::dexel::{Passage, TriDexelRef};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, axes};
use crate::octree::{Channel, OctreeRef, ScalarType, ValueType};

/// Computes the channel `material` of an octree of a tri-dexel model. In each cell it is the number of the
/// material at the cell's centre, by the rays that decide about centres ([`TriDexelRef::contains_cell`]); 0
/// where the material is unknown. Cells whose centre lies outside have no value. Where the octree is EMPTY,
/// the channel has the values that take the least memory. `None` if the model stores no materials.
///
/// Cells are as large as rays of one material allow.
///
/// # Errors
/// [`Error::FrameMismatch`] if the octree lies in another cube than the model; [`Error::Damaged`] for damaged
/// arrays or links; and the errors that `control` causes.
///
/// ```
/// use leafless::attribute::dexel_materials;
/// use leafless::{Control, Csg, Frame, TriDexel, dexelize, op::{DexelOptions, octree_from_dexels}};
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 4)?, Control::default());
/// let of = |low: f64, material| {
///     let block = Csg::cuboid([1.0, 1.0, low], [7.0, 7.0, low + 3.0])?;
///     dexelize(&block, &frame, &DexelOptions::default(), &control)?.view().with_material(material, &control)
/// };
/// let (steel, brass) = (of(1.0, 1)?, of(4.0, 2)?);
/// let model = steel.view().union(brass.view(), &control)?;
/// let tree = octree_from_dexels(model.view(), &control)?;
/// let channel = dexel_materials(model.view(), tree.view(), &control)?.expect("the model has materials");
/// let at = |z| channel.view().unwrap().value_at([4.0, 4.0, z]).map(|value| value[0]);
/// assert_eq!((at(2.0), at(5.0)), (Some(1.0), Some(2.0)));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn dexel_materials(
    model: &TriDexelRef<'_>,
    solid: &OctreeRef<'_>,
    control: &Control<'_>,
) -> Result<Option<Channel>, Error> {
    if !model.format().materials {
        return Ok(None);
    }
    model.sound()?;
    let options = FillOptions {
        value_type: ValueType::new(ScalarType::U32, 1)?,
        frame: *model.frame(),
        solid: Some(solid),
        detail: None,
    };
    let channel = fill_channel(&Materials { model: *model }, &options, control)?;
    Ok(Some(channel.with_name("material")))
}

struct Materials<'a> {
    model: TriDexelRef<'a>,
}

impl Attribute for Materials<'_> {
    fn components(&self) -> usize {
        1
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        for (point, value) in points.iter().zip(values) {
            let cell = self.model.frame().cell_of(*point).filter(|&cell| self.model.contains_cell(cell));
            *value = cell.map(|cell| value_of(self.model.material_of_cell(cell)));
        }
        Ok(())
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let frame = self.model.frame();
        let cells = [0, 1, 2].each(|axis| frame.cells_between(axis, bounds.min[axis], bounds.max[axis]));
        let (Some((axis, _)), [Some(x), Some(y), Some(z)]) = (self.model.deciding(), cells) else {
            return Ok(ValueRange::Unknown);
        };
        let cells = [x, y, z];
        // The materials beyond the universe are unknown.
        if cells.iter().any(|&(.., sticks_out)| sticks_out) {
            return Ok(ValueRange::Unknown);
        }
        Ok(match self.model.passage(axis, &axes(|axis| cells[axis].0..cells[axis].1 + 1)) {
            Some(Passage::Inside(material)) => ValueRange::exactly(Some(value_of(material))),
            Some(Passage::Outside) => ValueRange::Nowhere,
            _ => ValueRange::Unknown,
        })
    }
}

fn value_of(material: u32) -> [f64; 4] {
    [f64::from(material), 0.0, 0.0, 0.0]
}
