//! A cell together with its frame.

use super::array::Each;
use super::axes;
use super::{Cell, Frame, Interval};

/// A cell as a piece of model space, with the frame that places it.
#[derive(Debug, Clone, Copy)]
pub struct Cube<'f> {
    /// The frame of the universe.
    pub frame: &'f Frame,
    /// The octant of the universe.
    pub cell: Cell,
}

impl<'f> Cube<'f> {
    /// The child in `octant`.
    #[inline]
    pub fn child(&self, octant: u8) -> Cube<'f> {
        Cube { frame: self.frame, cell: self.cell.child(octant) }
    }

    /// The lattice planes that bound the cube: `(lower, upper)` per axis, counted in finest cells of the
    /// frame. A cube at the frame's depth has `upper = lower + 1`.
    #[inline]
    pub fn planes(&self) -> ([u32; 3], [u32; 3]) {
        let shift = self.frame.depth() - self.cell.level;
        (self.cell.at.each(|a| a << shift), self.cell.at.each(|a| (a + 1) << shift))
    }

    /// A box in model units that contains the cube: its corners, rounded outward to the nearest doubles
    /// (exact on frames whose corners are representable).
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (lower, upper) = self.planes();
        let mut min = [0.0; 3];
        let mut max = [0.0; 3];
        for axis in 0..3 {
            min[axis] = self.frame.plane(axis, lower[axis]).lower;
            max[axis] = self.frame.plane(axis, upper[axis]).upper;
        }
        (min, max)
    }

    /// Half the edge in model units, exact.
    pub fn half_edge(&self) -> f64 {
        0.5 * self.frame.edge() / (1u64 << self.cell.level) as f64
    }

    /// The vector from a point (model units) to the cube's centre, rounded outward.
    pub fn centre_from(&self, point: [f64; 3]) -> [Interval; 3] {
        let (lower, upper) = self.planes();
        axes(|axis| {
            let middle = lower[axis] as i64 + upper[axis] as i64;
            self.frame.rounded_offset(axis, point[axis], middle).negated()
        })
    }
}
