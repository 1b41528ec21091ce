//! Records by their depth, as they are seen.

use super::record::VoxelKind;
use super::records::VoxelRecordsRef;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Cube, valid};
use crate::memory;
use alloc::vec::Vec;

/// From where voxels are looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viewpoint {
    /// From infinitely far away, in this direction (of any length).
    Parallel([f64; 3]),
    /// From this point (model units), which may lie among the voxels.
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
    /// The indices of the records from front to back: a voxel comes before every other one of which it hides
    /// a part. Refined voxels are left out, and what they consist of is there. From back to front it is the
    /// reverse.
    ///
    /// The octants of a cell are put in order, and no two records are compared: an octant on the near side of
    /// the planes through the cell's centre hides those on the far side, never the other way round.
    /// O(n · levels). Exact.
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
    /// [`Error::Argument`] if the direction is zero or a number is not finite (of an eye also one beyond
    /// ±2^256 or, but zero, below 2^-256), [`Error::OutOfMemory`], [`Error::Cancelled`].
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
        // Octant k of the near corner's numbering is octant k ^ near.
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
