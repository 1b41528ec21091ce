//! Attributes: what has a value at every point, or at some.
//!
//! A colour, a temperature, the material of the nearest body, the samples of a volume, a channel of a stored
//! octree: all of them are an [`Attribute`]. Whoever wants values (a channel that is filled, the records of
//! voxels) asks it for the values at points, and for the range of the values in a box.

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
use crate::lattice::{Bounds, Interval};

/// What is known of the values of an attribute in the interior of a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ValueRange {
    /// Nothing.
    Unknown,
    /// No point has a value.
    Nowhere,
    /// Every point has a value, and component k of it lies in interval k. Intervals beyond the components do
    /// not count.
    Within([Interval; 4]),
}

impl ValueRange {
    /// The range of a value that is the same everywhere in the box.
    pub fn exactly(value: Option<[f64; 4]>) -> ValueRange {
        value.map_or(ValueRange::Nowhere, |value| ValueRange::Within(value.map(Interval::exactly)))
    }

    /// The width of the widest of the first `components` intervals; 0 if nothing has a value, ∞ if nothing
    /// is known.
    pub fn width(&self, components: usize) -> f64 {
        match self {
            ValueRange::Unknown => f64::INFINITY,
            ValueRange::Nowhere => 0.0,
            ValueRange::Within(ranges) => {
                // A width that is not a number is that of an unbounded interval.
                let widths = ranges.iter().take(components).map(Interval::width);
                widths.fold(0.0, |most, width| if width <= most { most } else { width.max(most) })
            }
        }
    }
}

/// Something that has a value of one to four numbers at points of model space.
///
/// A value has four places; those beyond the attribute's components are 0. Threads may ask at once. The same
/// question must always get the same answer.
pub trait Attribute: Sync {
    /// How many numbers a value has: 1 to 4.
    fn components(&self) -> usize;

    /// Writes the values at `points` to `values`, which is as long; `None` where there is no value.
    ///
    /// # Errors
    /// What the source of the values reports.
    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error>;

    /// What is known of the values in the interior of a box. The answer must be proven: a wrong range hides
    /// details that nobody looks for any more. By default nothing is known.
    ///
    /// # Errors
    /// What the source of the values reports.
    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let _ = bounds;
        Ok(ValueRange::Unknown)
    }

    /// About how many bytes of memory (or of mapped files) the attribute keeps alive: its own, and those of
    /// the meshes, channels and samples that it shares with others. 0, the default, if nobody knows.
    fn kept_bytes(&self) -> u64 {
        0
    }

    /// The value at one point.
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
