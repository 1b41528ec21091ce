//! Orders records by their depth for a viewer.

use super::record::VoxelKind;
use super::records::VoxelRecordsRef;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Cube, valid};
use crate::memory;
use alloc::vec::Vec;

/// The position from which voxels are viewed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viewpoint {
    /// Infinitely far away; the direction of view, of any length.
    Parallel([f64; 3]),
    /// An eye point (model units), which may lie among the voxels.
    Perspective([f64; 3]),
}

impl Viewpoint {
    fn check(&self) -> Result<(), Error> {
        let refused = |problem| Err(Error::Argument { name: "direction", problem });
        match self {
            Viewpoint::Perspective(eye) => valid::numbers("eye", eye),
            Viewpoint::Parallel(direction) if direction.iter().any(|x| !x.is_finite()) => {
                refused("every number must be finite")
            }
            Viewpoint::Parallel(direction) if *direction == [0.0; 3] => refused("must not be zero"),
            Viewpoint::Parallel(_) => Ok(()),
        }
    }
}

impl VoxelRecordsRef<'_> {
    /// Returns the indices of the records from front to back: a voxel comes before every other voxel that it
    /// hides in part. Refined voxels are left out; the voxels that they consist of are included. The order
    /// from back to front is the reverse.
    ///
    /// The octants of a cell are ordered, and no two records are compared: an octant on the near side of the
    /// planes through the cell's centre may hide octants on the far side, never the reverse. O(n · levels).
    /// Exact.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build, voxel::{Viewpoint, VoxelOptions, VoxelRecords}};
    /// let (frame, control) = (Frame::new([0.0; 3], 4.0, 2)?, Control::default());
    /// let bar = build(&Csg::cuboid([0.0; 3], [3.0, 1.0, 1.0])?, &frame, Rule::Certified, &control)?;
    /// let records = VoxelRecords::of(bar.view(), &VoxelOptions::new(), None, &control)?;
    /// assert_eq!(records.view().depth_order(&Viewpoint::Parallel([-1.0, 0.0, 0.0]), &control)?, [2, 1, 0]);
    /// assert_eq!(records.view().depth_order(&Viewpoint::Perspective([1.5, 0.5, 9.0]), &control)?[2], 2);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] if the direction is zero or a number is not finite (for an eye point, also if a
    /// magnitude exceeds 2^256 or is below 2^-256 and not zero), [`Error::OutOfMemory`],
    /// [`Error::Cancelled`].
    pub fn depth_order(&self, from: &Viewpoint, control: &Control<'_>) -> Result<Vec<u64>, Error> {
        from.check()?;
        let leaves = self.len() as u64 - self.count(VoxelKind::Refined);
        let mut order = memory::with_capacity(leaves as usize)?;
        let mut put = |index: usize| {
            if order.len().is_multiple_of(4096) {
                control.check()?;
            }
            if self.kind_at(index) != VoxelKind::Refined {
                order.push(index as u64);
            }
            Ok(())
        };
        // Octant k in the numbering of the near corner is octant k ^ near.
        let octants = |near: u8| core::array::from_fn(|k| k as u8 ^ near);
        match *from {
            Viewpoint::Parallel(direction) => {
                let near = (0..3).fold(0, |bits, axis| bits | ((direction[axis] < 0.0) as u8) << axis);
                self.visit(&self.whole(), &|_| octants(near), &mut put)?;
            }
            Viewpoint::Perspective(eye) => {
                let near = |cell: Cell| {
                    let (lower, upper) = Cube { frame: self.frame(), cell }.planes();
                    (0..3).fold(0, |bits, axis| {
                        let middle = lower[axis] as i64 + upper[axis] as i64;
                        bits | ((self.frame().side(axis, eye[axis], middle) > 0) as u8) << axis
                    })
                };
                self.visit(&self.whole(), &|cell| octants(near(cell)), &mut put)?;
            }
        }
        Ok(order)
    }
}
