//! The places of samples in model space.

use crate::error::{Error, MeshError};
use crate::lattice::{Frame, LARGEST};

/// The lattice of cell centres of a frame.
#[derive(Clone, Copy)]
pub(super) struct Lattice {
    origin: [f64; 3],
    /// Half the edge of a cell.
    half: f64,
}

impl Lattice {
    /// Creates the lattice of the centres of a frame's cells.
    ///
    /// # Errors
    /// [`Error::Argument`] or [`MeshError::TooLarge`] if doubles cannot distinguish the vertices of a surface
    /// there.
    pub fn new(frame: &Frame) -> Result<Lattice, Error> {
        let (origin, half) = (frame.origin(), 0.5 * frame.cell_size());
        let farthest = origin.iter().fold(0.0, |most: f64, o| most.max(o.abs())) + 2.0 * frame.edge();
        // Coordinates below the least magnitude count as zero. This constant ensures that at most one
        // coordinate does.
        const LEAST: f64 = f64::from_bits((1023 - 254) << 52);
        if farthest > LARGEST {
            return Err(MeshError::TooLarge { vertex: 0 }.into());
        }
        if half < LEAST || half < 8.0 * f64::EPSILON * farthest {
            let problem = "so far from the origin, or so small, that doubles cannot tell its cells apart";
            return Err(Error::Argument { name: "frame", problem });
        }
        Ok(Lattice { origin, half })
    }

    /// The edge of a cell.
    pub fn cell(&self) -> f64 {
        2.0 * self.half
    }

    /// The coordinate on an axis, `k` half cells behind the frame's origin; odd numbers are samples. A
    /// greater `k` has a greater coordinate.
    #[inline(always)]
    pub fn coordinate(&self, axis: usize, k: i32) -> f64 {
        self.position(axis, 0.5 * f64::from(k))
    }

    /// The coordinate on an axis at a number of cells behind the frame's origin.
    #[inline(always)]
    pub fn position(&self, axis: usize, cells: f64) -> f64 {
        let x = self.origin[axis] + (2.0 * cells) * self.half;
        if x.abs() < crate::lattice::SMALLEST { 0.0 } else { x }
    }
}
