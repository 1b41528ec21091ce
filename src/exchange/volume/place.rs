//! Positions of the samples of a file.

use crate::error::{Error, VolumeFileError};
use crate::lattice::Affine;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::solid::VoxelGrid;

/// The positions of samples as a file states them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axes {
    /// The vector from one sample to the next, for each of the file's axes.
    pub(super) steps: [[f64; 3]; 3],
    /// The position of the first sample, or of the lower corner of its voxel.
    pub(super) origin: [f64; 3],
    pub(super) is_corner: bool,
}

impl Axes {
    /// Returns samples with these distances along the axes.
    pub(super) fn along(spacing: [f64; 3], origin: [f64; 3]) -> Axes {
        let mut steps = [[0.0; 3]; 3];
        for axis in 0..3 {
            steps[axis][axis] = spacing[axis];
        }
        Axes { steps, origin, is_corner: false }
    }

    /// Returns the grid, and the map that moves the grid to the stated position, if the file's axes are not
    /// x, y and z.
    pub(super) fn placed(&self, extents: [u32; 3]) -> Result<(VoxelGrid, Option<Affine>), Error> {
        let wrong = |_| VolumeFileError::Place;
        let is_straight = (0..3).all(|axis| {
            (0..3).all(|i| if i == axis { self.steps[axis][i] > 0.0 } else { self.steps[axis][i] == 0.0 })
        });
        if is_straight {
            let spacing = axes(|axis| self.steps[axis][axis]);
            let grid = if self.is_corner {
                VoxelGrid::new(extents, self.origin, spacing)
            } else {
                VoxelGrid::with_first_sample(extents, self.origin, spacing)
            };
            return Ok((grid.map_err(wrong)?, None));
        }
        let spacing = self.steps.each(|[x, y, z]| match [x.abs(), y.abs(), z.abs()] {
            // Along a single axis nothing is rounded.
            [only, 0.0, 0.0] | [0.0, only, 0.0] | [0.0, 0.0, only] => only,
            _ => sqrt(x * x + y * y + z * z),
        });
        let first = if self.is_corner { spacing.each(|edge| 0.5 * edge) } else { [0.0; 3] };
        let grid = VoxelGrid::with_first_sample(extents, first, spacing).map_err(wrong)?;
        if self.is_flat(spacing) {
            return Err(VolumeFileError::Place.into());
        }
        // Components that can only be rounding errors become zero.
        let part = |c: f64| if c.abs() < 1.0 / (1u64 << 60) as f64 { 0.0 } else { c };
        let row = |i: usize| {
            let [a, b, c] = axes(|axis| part(self.steps[axis][i] / spacing[axis]));
            [a, b, c, self.origin[i]]
        };
        let placement = Affine::new([row(0), row(1), row(2)]).map_err(wrong)?;
        Ok((grid, Some(placement)))
    }

    /// Returns whether the directions lie in one plane, up to the rounding of decimal numbers: their
    /// parallelepiped then has less than 2^-40 of the volume that it would have with right angles.
    fn is_flat(&self, spacing: [f64; 3]) -> bool {
        let [a, b, c] = axes(|axis| self.steps[axis].each(|x| x / spacing[axis]));
        let cross = axes(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            a[j] * b[k] - a[k] * b[j]
        });
        let volume = cross[0] * c[0] + cross[1] * c[1] + cross[2] * c[2];
        volume.abs() < 1.0 / (1u64 << 40) as f64
    }
}
