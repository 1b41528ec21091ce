//! Surfaces that are bounded by Taylor's formula.

use super::quadratic::Quadratic;
use crate::lattice::exact::sqrt;

/// The zero set of a function in a cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Taylor {
    /// The function.
    pub(crate) f: Quadratic,
    /// A bound of the difference between any gradient in the cell and the gradient at the centre.
    pub(crate) bend: f64,
    /// The greatest number of intersections with a line that does not lie in the surface.
    pub(crate) degree: u32,
}

impl Taylor {
    /// The same surface, with the function negated.
    pub(crate) fn complement(&self) -> Taylor {
        Taylor { f: self.f.complement(), ..*self }
    }

    /// The length of the gradient at the centre.
    pub(super) fn steepness(&self) -> f64 {
        let [x, y, z] = self.f.gradient;
        sqrt((x * x + y * y) + z * z)
    }

    /// A bound of the sine of the angle between the gradient at the centre and any other gradient; 1 or more,
    /// or NaN, if it is unknown.
    pub(super) fn sine(&self) -> f64 {
        self.bend / self.steepness() * (1.0 + 16.0 * f64::EPSILON)
    }

    /// A bound of the angle between the gradient at the centre and any other gradient in the cell; ∞ if it is
    /// unknown.
    pub(crate) fn cone(&self) -> f64 {
        let sine = self.sine();
        // (The error of the arc sine is below a unit in the last place.)
        if sine < 1.0 {
            (libm::asin(sine) + f64::EPSILON) * (1.0 + 4.0 * f64::EPSILON)
        } else {
            f64::INFINITY
        }
    }
}
