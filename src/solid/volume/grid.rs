//! The positions of a volume's voxels in model space.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{product_up, sign_of_sum, two_diff, two_product};
use crate::lattice::{Bounds, Frame, MAX_DEPTH, valid};

/// The greatest number of samples along an axis: 2^20, as many as an octree has cells.
const MOST: u32 = 1 << MAX_DEPTH;

/// The boxes of a volume's samples. On each axis, voxel i reaches from corner + i·spacing to corner + (i +
/// 1)·spacing, with its sample in the middle.
///
/// These planes are *real* numbers, whether or not doubles can represent them; comparisons with them are
/// exact. The sample (x, y, z) has the index x + nx·(y + ny·z): x varies fastest.
///
/// ```
/// use leafless::solid::VoxelGrid;
/// let grid = VoxelGrid::new([200, 300, 400], [0.0; 3], [0.5; 3])?;
/// let frame = grid.frame()?;
/// assert_eq!((frame.depth(), frame.cell_size(), frame.origin()), (9, 0.5, [0.0; 3]));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoxelGrid {
    extents: [u32; 3],
    corner: [f64; 3],
    spacing: [f64; 3],
}

impl VoxelGrid {
    /// Makes a grid of `extents` voxels along x, y and z (1 to 2^20 each). `corner` is the lower corner of
    /// the first voxel (model units; each coordinate is zero or of a magnitude between 2^-256 and 2^256).
    /// `spacing` holds the edges of a voxel (model units, 2^-256 to 2^256).
    ///
    /// # Errors
    /// [`Error::Argument`] names the parameter that is out of range.
    pub fn new(extents: [u32; 3], corner: [f64; 3], spacing: [f64; 3]) -> Result<VoxelGrid, Error> {
        if !extents.iter().all(|extent| (1..=MOST).contains(extent)) {
            return Err(Error::Argument { name: "extents", problem: "each must be 1 to 2^20" });
        }
        valid::numbers("corner", &corner)?;
        spacing.iter().try_for_each(|&edge| valid::length("spacing", edge))?;
        Ok(VoxelGrid { extents, corner: corner.each(|c| c + 0.0), spacing })
    }

    /// Makes a grid whose first sample lies at `sample`, as most file formats specify it. The corner is
    /// `sample` − `spacing` / 2, rounded to doubles. The rounding may move the grid by half a unit in the
    /// last place.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_first_sample(
        extents: [u32; 3],
        sample: [f64; 3],
        spacing: [f64; 3],
    ) -> Result<VoxelGrid, Error> {
        VoxelGrid::new(extents, axes(|axis| sample[axis] - 0.5 * spacing[axis]), spacing)
    }

    /// The numbers of voxels along x, y and z.
    pub fn extents(&self) -> [u32; 3] {
        self.extents
    }

    /// The lower corner of the first voxel, in model units.
    pub fn corner(&self) -> [f64; 3] {
        self.corner
    }

    /// The edges of a voxel, in model units.
    pub fn spacing(&self) -> [f64; 3] {
        self.spacing
    }

    /// The number of samples.
    pub fn count(&self) -> u64 {
        self.extents.iter().map(|&extent| u64::from(extent)).product()
    }

    /// The number of words in a row of bits along x: see [`Samples::Bits`](crate::solid::Samples::Bits).
    pub fn words(&self) -> usize {
        self.extents[0].div_ceil(64) as usize
    }

    /// The position of a sample (model units). The error of each coordinate is some 2^-52, relative to its
    /// summands.
    pub fn centre(&self, at: [u32; 3]) -> [f64; 3] {
        axes(|axis| self.corner[axis] + (f64::from(at[axis]) + 0.5) * self.spacing[axis])
    }

    /// A box that contains all voxels, rounded outward.
    pub fn bounds(&self) -> Bounds {
        let max = axes(|axis| {
            let length = product_up(f64::from(self.extents[axis]), self.spacing[axis]);
            let end = self.corner[axis] + length;
            if sign_of_sum(&[end, -self.corner[axis], -length]) < 0 { end.next_up() } else { end }
        });
        Bounds { min: self.corner, max }
    }

    /// The frame whose finest cells are voxels: it has the same corner and spacing, and the least depth at
    /// which its universe contains all voxels. On this frame a voxel solid has no PARTIAL cell at the finest
    /// level. [`Frame::with_depth`] gives other depths of the same universe.
    ///
    /// # Errors
    /// [`Error::Argument`] if the spacing is not the same on all axes, because cells are cubes. Such a volume
    /// needs another frame, for example [`Frame::around`] its bounds.
    pub fn frame(&self) -> Result<Frame, Error> {
        let [spacing, y, z] = self.spacing;
        if spacing != y || spacing != z {
            return Err(Error::Argument {
                name: "spacing",
                problem: "differs between the axes, and cells are cubes; give bounds and a depth",
            });
        }
        let longest = self.extents.into_iter().max().unwrap_or(1).max(2);
        let depth = longest.next_power_of_two().trailing_zeros() as u8;
        Frame::new(self.corner, spacing * f64::from(1u32 << depth), depth)
    }

    /// The exact sign of `x` − (corner + j·spacing) on an axis.
    pub(super) fn side(&self, axis: usize, x: f64, j: u32) -> i32 {
        let (high, low) = two_diff(x, self.corner[axis]);
        let (product, error) = two_product(f64::from(j), self.spacing[axis]);
        sign_of_sum(&[low, -error, high, -product])
    }

    /// The exact sign of (origin of `frame` + k·cell/2) − (corner + j·spacing) on an axis.
    pub(super) fn plane_side(&self, frame: &Frame, axis: usize, k: u32, j: u32) -> i32 {
        let (high, low) = two_diff(frame.origin()[axis], self.corner[axis]);
        let (cells, cells_error) = two_product(f64::from(k), 0.5 * frame.cell_size());
        let (voxels, voxels_error) = two_product(f64::from(j), self.spacing[axis]);
        sign_of_sum(&[low, cells_error, -voxels_error, high, cells, -voxels])
    }

    /// Returns whether all voxels lie in the universe of a frame; exact.
    pub(super) fn is_within(&self, frame: &Frame) -> bool {
        let end = 2 * frame.cells();
        (0..3).all(|axis| {
            self.plane_side(frame, axis, 0, 0) <= 0
                && self.plane_side(frame, axis, end, self.extents[axis]) >= 0
        })
    }

    /// The voxel that contains a point. A point on a common face belongs to the upper voxel. `None` outside
    /// the grid.
    pub(crate) fn voxel_of(&self, point: [f64; 3]) -> Option<[u32; 3]> {
        let mut voxel = [0; 3];
        for axis in 0..3 {
            let (x, extent) = (point[axis], self.extents[axis]);
            if x.is_nan()
                || x.abs() > valid::LARGEST
                || self.side(axis, x, 0) < 0
                || self.side(axis, x, extent) > 0
            {
                return None;
            }
            let near = ((x - self.corner[axis]) / self.spacing[axis]).clamp(0.0, f64::from(extent)) as u32;
            // The guess is off by less than one voxel, unless the corner is far away; then a search finds the
            // voxel.
            let is_at = |j: u32| self.side(axis, x, j) >= 0 && (j == extent || self.side(axis, x, j + 1) < 0);
            let mut found = [near, near.saturating_sub(1), (near + 1).min(extent)].into_iter();
            let j = match found.find(|&j| is_at(j)) {
                Some(j) => j,
                None => last_at_most(extent, |j| self.side(axis, x, j) >= 0),
            };
            voxel[axis] = j.min(extent - 1);
        }
        Some(voxel)
    }
}

/// The greatest j in 0..=`most` for which `holds` is true, where `holds` is true for all smaller j; 0 if it
/// is true for none.
pub(super) fn last_at_most(most: u32, holds: impl Fn(u32) -> bool) -> u32 {
    let (mut low, mut high) = (0, most);
    while low < high {
        let middle = low + (high - low).div_ceil(2);
        if holds(middle) { low = middle } else { high = middle - 1 }
    }
    low
}
