//! Surfaces of which Taylor's formula tells where they are.

use super::quadratic::Quadratic;
use crate::lattice::exact::sqrt;

/// The surface in a cell on which a function is 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Taylor {
    /// The function.
    pub(crate) f: Quadratic,
    /// No gradient in the cell is further from that at the centre.
    pub(crate) bend: f64,
    /// A line that does not lie in the surface meets it no more often.
    pub(crate) degree: u32,
}

impl Taylor {
    /// The same surface, with the negative of the function.
    pub(crate) fn complement(&self) -> Taylor {
        Taylor { f: self.f.complement(), ..*self }
    }

    /// The length of the gradient at the centre.
    pub(super) fn steepness(&self) -> f64 {
        let [x, y, z] = self.f.gradient;
        sqrt((x * x + y * y) + z * z)
    }

    /// More than the sine of the angle between the gradient at the centre and any other; 1 and more, or no
    /// number, if nothing is known.
    pub(super) fn sine(&self) -> f64 {
        self.bend / self.steepness() * (1.0 + 16.0 * f64::EPSILON)
    }

    /// No gradient in the cell is further from that at the centre than this angle; ∞ if nothing is known.
    pub(crate) fn cone(&self) -> f64 {
        let sine = self.sine();
        // (The arc sine is off by less than a last place.)
        if sine < 1.0 {
            (libm::asin(sine) + f64::EPSILON) * (1.0 + 4.0 * f64::EPSILON)
        } else {
            f64::INFINITY
        }
    }
}
