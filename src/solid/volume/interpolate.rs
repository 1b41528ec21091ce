//! The field between the samples.

use super::{Samples, Volume};
use crate::lattice::Each;
use crate::lattice::axes;

impl Volume<'_> {
    /// The value of the field at a point (model units), interpolated trilinearly between the eight samples
    /// around it. In the outer half of the outermost voxels, where there are samples on one side only, their
    /// values continue unchanged. `None` outside the grid; NaN where one of the samples that count is NaN.
    ///
    /// The solid is the union of voxels, not a level set of this field. Each coordinate in voxels, each
    /// product and each sum is rounded once, in this order: x, y, z. O(1).
    pub fn value_at(&self, point: [f64; 3]) -> Option<f64> {
        self.grid().voxel_of(point)?;
        let (mut low, mut parts) = ([0u32; 3], [0.0; 3]);
        for axis in 0..3 {
            let last = self.grid().extents()[axis] - 1;
            let place = (point[axis] - self.grid().corner()[axis]) / self.grid().spacing()[axis] - 0.5;
            let place = place.clamp(0.0, f64::from(last));
            low[axis] = (place as u32).min(last.saturating_sub(1));
            parts[axis] = place - f64::from(low[axis]);
        }
        let sample = |octant: u32| {
            let at = axes(|axis| low[axis] + (octant >> axis & 1));
            // A sample that does not count may lie beyond the grid.
            self.sample(axes(|axis| at[axis].min(self.grid().extents()[axis] - 1)))
        };
        let mix = |a: f64, b: f64, t: f64| match t {
            0.0 => a,
            1.0 => b,
            _ => a * (1.0 - t) + b * t,
        };
        let mut values = [0.0; 8];
        for (value, octant) in values.iter_mut().zip(0..) {
            *value = sample(octant)?;
        }
        let [a, b, c, d] = [0, 2, 4, 6].each(|k| mix(values[k], values[k + 1], parts[0]));
        Some(mix(mix(a, b, parts[1]), mix(c, d, parts[1]), parts[2]))
    }

    /// The position at which the linearly interpolated field leaves the band between a sample and the next
    /// one along an axis: 0 is the sample at `at`, 1 the next. `None` if both are inside, or neither is.
    ///
    /// Everything beyond the grid is outside, and `at` may be a neighbour of the grid. The answer is ½, the
    /// common face of the voxels, if one of them lies beyond the grid, if the samples are bits, or if a
    /// sample is infinite or NaN. (Such points lie on the boundary of the solid, which consists of voxels;
    /// all other points lie within half a voxel of it.) Otherwise the answer is the quotient (end of the band
    /// − a) / (b − a), rounded to doubles. It lies in [0, 1], and is 0 or 1 where the inner sample equals the
    /// end of the band. The end is the one beyond which the outer sample lies. O(1).
    ///
    /// ```
    /// use leafless::{Control, Volume, solid::{Band, VoxelGrid}};
    /// let grid = VoxelGrid::new([3, 1, 1], [0.0; 3], [1.0; 3])?;
    /// let samples = [0u8, 200, 220];
    /// let volume = Volume::new(samples[..].into(), &grid, Band::at_least(150.0)?, &Control::default())?;
    /// assert_eq!(volume.crossing_between([0, 0, 0], 0), Some(0.75));
    /// assert_eq!(volume.crossing_between([1, 0, 0], 0), None);
    /// assert_eq!(volume.crossing_between([2, 0, 0], 0), Some(0.5));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn crossing_between(&self, at: [i32; 3], axis: usize) -> Option<f64> {
        let mut next = at;
        let coordinate = next.get_mut(axis)?;
        *coordinate = coordinate.checked_add(1)?;
        let value = |at: [i32; 3]| self.sample(at.each(|a| u32::try_from(a).unwrap_or(u32::MAX)));
        let (a, b) = (value(at), value(next));
        let is_inside = |value: Option<f64>| value.is_some_and(|value| self.field.limits.contains(value));
        if is_inside(a) == is_inside(b) {
            return None;
        }
        let (Some(a), Some(b)) = (a, b) else { return Some(0.5) };
        if matches!(self.field.samples, Samples::Bits(_)) {
            return Some(0.5);
        }
        let outer = if is_inside(Some(a)) { b } else { a };
        let end = if outer < self.band.low() { self.band.low() } else { self.band.high() };
        let is_known = a.is_finite() && b.is_finite();
        Some(if is_known { ((end - a) / (b - a)).clamp(0.0, 1.0) } else { 0.5 })
    }
}
