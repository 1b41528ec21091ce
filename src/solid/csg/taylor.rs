//! What half-spaces know of a cell by Taylor's formula.

use crate::lattice::exact::sqrt;

/// A function over a cube: at x, measured from the centre in half edges, it is value + gradient · x + Σ second x xᵀ,
/// up to `error`. What is infinite or no number says that nothing is known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Taylor {
    pub(super) value: f64,
    pub(super) gradient: [f64; 3],
    /// Of the products xx, yy, zz, xy, xz, yz.
    pub(super) second: [f64; 6],
    pub(super) error: f64,
    /// No gradient in the cube is further from that at the centre.
    pub(super) bend: f64,
    /// A line that does not lie in the surface meets it no more often.
    pub(super) degree: u32,
}

impl Taylor {
    /// The length of the gradient at the centre.
    pub(super) fn steepness(&self) -> f64 {
        let [x, y, z] = self.gradient;
        sqrt((x * x + y * y) + z * z)
    }

    /// More than the sine of the angle between the gradient at the centre and any other; 1 and more, or no number, if
    /// nothing is known.
    pub(super) fn sine(&self) -> f64 {
        self.bend / self.steepness() * (1.0 + 16.0 * f64::EPSILON)
    }

    /// No gradient in the cube is further from that at the centre than this angle; ∞ if nothing is known.
    pub(super) fn cone(&self) -> f64 {
        let sine = self.sine();
        // (The arc sine is off by less than a last place.)
        if sine < 1.0 {
            (libm::asin(sine) + f64::EPSILON) * (1.0 + 4.0 * f64::EPSILON)
        } else {
            f64::INFINITY
        }
    }
}

/// How far x ↦ the gradient of Σ second x xᵀ reaches over [-1, 1]³, with some last places for what is rounded.
pub(super) fn bend_of(second: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = second.map(f64::abs);
    let rows = [2.0 * xx + xy + xz, xy + 2.0 * yy + yz, xz + yz + 2.0 * zz];
    let squares = rows.map(|row| row * row);
    sqrt((squares[0] + squares[1]) + squares[2]) * (1.0 + 16.0 * f64::EPSILON)
}
