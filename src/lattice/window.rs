//! Boxes of finest cells.

use super::{Cube, Frame, valid};
use crate::error::Error;

/// The finest cells from `first` to `last` along each axis.
#[derive(Clone, Copy)]
pub(crate) struct Window {
    pub(crate) first: [u32; 3],
    pub(crate) last: [u32; 3],
}

impl Window {
    /// Makes the window of the cells whose interiors meet the box `[min, max]` (model units); a flat box may
    /// lie in a face. Also returns whether a part of the box lies outside the universe. `None` if the whole
    /// box does.
    ///
    /// # Errors
    /// [`Error::Argument`] if min > max on an axis, or a coordinate is NaN.
    pub(crate) fn new(frame: &Frame, min: [f64; 3], max: [f64; 3]) -> Result<Option<(Self, bool)>, Error> {
        valid::ordered("max", min, max)?;
        let (mut window, mut clipped) = (Window { first: [0; 3], last: [0; 3] }, false);
        for axis in 0..3 {
            let Some((first, last, outside)) = frame.cells_between(axis, min[axis], max[axis]) else {
                return Ok(None);
            };
            (window.first[axis], window.last[axis]) = (first, last);
            clipped |= outside;
        }
        Ok(Some((window, clipped)))
    }

    /// Returns whether the window and a cube overlap.
    #[inline]
    pub(crate) fn meets(&self, cube: &Cube<'_>) -> bool {
        let (lower, upper) = cube.planes();
        (0..3).all(|axis| lower[axis] <= self.last[axis] && self.first[axis] < upper[axis])
    }
}
