//! Bounds of a half-space's function in a cell: a linear function, and a range of the rest.

use crate::lattice::Each;
use crate::solid::Slab;

/// Bounds of a function over a cube: at x, measured from the centre in half edges, it lies between
/// gradient · x + `low` and gradient · x + `high`. Bounds may be infinite.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tangent {
    pub(crate) gradient: [f64; 3],
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Tangent {
    /// Makes bounds from the value at the centre, the slopes along the axes in units of half edges, the least
    /// and the greatest remainder, and more than the error of all these.
    #[inline(always)]
    pub(crate) fn new(value: f64, gradient: [f64; 3], (least, most): (f64, f64), error: f64) -> Tangent {
        // The sums here are rounded, too.
        let error = error + 4.0 * f64::EPSILON * (value.abs() + error);
        let slack = 4.0 * f64::EPSILON;
        Tangent {
            gradient,
            low: value + (least - slack * least.abs()) - error,
            high: value + (most + slack * most.abs()) + error,
        }
    }

    /// Returns the slab of the points where the function is not negative.
    #[inline(always)]
    pub(crate) fn slab(&self) -> Slab {
        Slab { normal: self.gradient.each(|c| -c), inner: self.low, outer: self.high }
    }
}
