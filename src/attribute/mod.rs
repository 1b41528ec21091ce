//! Attributes: values at every point of space, or at some points.
//!
//! A colour, a temperature, the material of the nearest body, the samples of a volume, a channel of a stored
//! octree: all of them are an [`Attribute`]. An algorithm that needs values (to fill a channel, or to make
//! the records of voxels) queries the attribute for the values at points, and for the range of the values in
//! a box.

mod carry;
mod channel;
mod detail;
mod dexel_materials;
mod edit;
mod fill;
mod function;
mod materials;
mod sampled;
mod source;
mod summary;
mod surface;
mod triangles;
mod value_region;
mod volume;

pub use crate::octree::channel::{Channel, ChannelRef, ScalarType, ValueType};
pub use carry::{CarryRule, ChannelOperand, carry_channel, carry_channels};
pub use channel::MovedAttribute;
pub use detail::{Criterion, Detail};
pub use dexel_materials::dexel_materials;
pub use function::{ConstantAttribute, FunctionAttribute};
pub use materials::{MaterialProperties, materials};
pub use sampled::{FillOptions, fill_channel};
pub use summary::ChannelSummary;
pub use surface::SurfaceAttribute;
pub use triangles::sample_triangles;
pub use value_region::ValueRegion;
pub use volume::{Interpolation, VolumeAttribute};

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Interval};

/// The range of an attribute's values in the interior of a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ValueRange {
    /// Nothing is known.
    Unknown,
    /// No point has a value.
    Nowhere,
    /// Every point has a value, whose component k lies in interval k. Intervals beyond the components do not
    /// count.
    Within([Interval; 4]),
}

impl ValueRange {
    /// Makes the range of a value that is the same everywhere in the box.
    pub fn exactly(value: Option<[f64; 4]>) -> ValueRange {
        value.map_or(ValueRange::Nowhere, |value| ValueRange::Within(value.each(Interval::exactly)))
    }

    /// The width of the widest of the first `components` intervals; 0 if no point has a value, ∞ if nothing
    /// is known.
    pub fn width(&self, components: usize) -> f64 {
        match self {
            ValueRange::Unknown => f64::INFINITY,
            ValueRange::Nowhere => 0.0,
            ValueRange::Within(ranges) => {
                // A NaN width belongs to an unbounded interval.
                let widths = ranges.iter().take(components).map(Interval::width);
                widths.fold(0.0, |most, width| if width <= most { most } else { width.max(most) })
            }
        }
    }
}

/// A function that has values of one to four numbers at points of model space.
///
/// A value has four places; those beyond the attribute's components are 0. Several threads may query the
/// attribute at once. The same query must always give the same answer.
pub trait Attribute: Sync {
    /// The number of components of a value: 1 to 4.
    fn components(&self) -> usize;

    /// Writes the values at `points` to `values`, which has the same length; `None` where there is no value.
    ///
    /// # Errors
    /// Those of the source of the values.
    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error>;

    /// Returns the range of the values in the interior of a box. The answer must be proven: a wrong range
    /// hides details from every later search. By default nothing is known.
    ///
    /// # Errors
    /// Those of the source of the values.
    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let _ = bounds;
        Ok(ValueRange::Unknown)
    }

    /// The approximate number of bytes of memory (or of mapped files) that the attribute keeps alive: its
    /// own, and those of the meshes, channels and samples that it shares with others. 0, the default, means
    /// unknown.
    fn kept_bytes(&self) -> u64 {
        0
    }

    /// Returns the value at one point.
    ///
    /// # Errors
    /// As [`values`](Self::values).
    fn value(&self, point: [f64; 3]) -> Result<Option<[f64; 4]>, Error> {
        let mut value = [None];
        self.values(&[point], &mut value)?;
        Ok(value[0])
    }
}

impl<A: Attribute + ?Sized> Attribute for &A {
    fn components(&self) -> usize {
        (**self).components()
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        (**self).values(points, values)
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        (**self).range(bounds)
    }

    fn kept_bytes(&self) -> u64 {
        (**self).kept_bytes()
    }
}
