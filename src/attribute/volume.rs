//! The samples of a volume as an attribute.

use super::{Attribute, ValueRange};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Bounds, Interval};
use crate::solid::{Solid, Volume};

/// The greatest number of samples that are visited for a range.
const MOST_SAMPLES: u64 = 4096;

/// The value between the samples of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Interpolation {
    /// The sample of the voxel that contains the point. A point on a face between voxels belongs to the upper
    /// one.
    Nearest,
    /// The trilinear interpolation of the eight samples around the point; see [`Volume::value_at`].
    #[default]
    Trilinear,
}

/// The samples of a [`Volume`] as an attribute of one number. There is no value outside the grid, or where a
/// sample that counts is NaN. The volume's band does not matter.
#[derive(Debug, Clone)]
pub struct VolumeAttribute<'a> {
    volume: Volume<'a>,
    interpolation: Interpolation,
}

impl<'a> VolumeAttribute<'a> {
    /// Makes the attribute of a volume's samples.
    pub fn new(volume: Volume<'a>, interpolation: Interpolation) -> VolumeAttribute<'a> {
        VolumeAttribute { volume, interpolation }
    }
}

impl Attribute for VolumeAttribute<'_> {
    fn components(&self) -> usize {
        1
    }

    fn kept_bytes(&self) -> u64 {
        self.volume.kept_bytes()
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        for (value, &point) in values.iter_mut().zip(points) {
            let found = match self.interpolation {
                Interpolation::Nearest => {
                    self.volume.grid().voxel_of(point).and_then(|at| self.volume.sample(at))
                }
                Interpolation::Trilinear => self.volume.value_at(point),
            };
            *value = found.filter(|found| !found.is_nan()).map(|found| [found, 0.0, 0.0, 0.0]);
        }
        Ok(())
    }

    /// The range of all samples that count in the box; unknown if there are too many, or if one is NaN.
    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let grid = self.volume.grid();
        let Some(common) = bounds.common(&grid.bounds()) else { return Ok(ValueRange::Nowhere) };
        if common != *bounds {
            return Ok(ValueRange::Unknown);
        }
        // The points lie strictly below the upper faces of the box.
        let last = axes(|axis| bounds.max[axis].next_down().max(bounds.min[axis]));
        let (Some(mut first), Some(mut last)) = (grid.voxel_of(bounds.min), grid.voxel_of(last)) else {
            return Ok(ValueRange::Unknown);
        };
        if self.interpolation == Interpolation::Trilinear {
            first = first.each(|a| a.saturating_sub(1));
            last = axes(|axis| (last[axis] + 1).min(grid.extents()[axis] - 1));
        }
        let counts = axes(|axis| u64::from(last[axis] - first[axis]) + 1);
        if counts.iter().try_fold(1u64, |all, &count| all.checked_mul(count)).is_none_or(|n| n > MOST_SAMPLES)
        {
            return Ok(ValueRange::Unknown);
        }
        let (mut lower, mut upper) = (f64::INFINITY, f64::NEG_INFINITY);
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                for x in first[0]..=last[0] {
                    match self.volume.sample([x, y, z]) {
                        Some(sample) if !sample.is_nan() => {
                            lower = sample.min(lower);
                            upper = sample.max(upper);
                        }
                        _ => return Ok(ValueRange::Unknown),
                    }
                }
            }
        }
        if self.interpolation == Interpolation::Trilinear {
            // Seven interpolations, each of two products and a sum that are rounded.
            let rounding = 32.0 * f64::EPSILON * lower.abs().max(upper.abs());
            (lower, upper) = (lower - rounding, upper + rounding);
        }
        // Infinite samples have no mean.
        let Some(range) = Interval::new(lower, upper) else { return Ok(ValueRange::Unknown) };
        let zero = Interval::exactly(0.0);
        Ok(ValueRange::Within([range, zero, zero, zero]))
    }
}
