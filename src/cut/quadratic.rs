//! Functions to second order.

use crate::lattice::Each;
use crate::lattice::exact::sqrt;

/// A function over the cube [-1, 1]³ to second order: a cell, measured from its centre in half edges.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quadratic {
    /// The value at the centre.
    pub(crate) value: f64,
    pub(crate) gradient: [f64; 3],
    /// Half the second derivatives: xx, yy, zz, xy, xz, yz.
    pub(crate) squares: [f64; 6],
    /// The greatest difference between the function and value + gradient · x + xᵀ squares x. Infinite or NaN
    /// means unknown.
    pub(crate) error: f64,
}

impl Quadratic {
    /// The negated function.
    pub(crate) fn complement(&self) -> Quadratic {
        Quadratic {
            value: -self.value,
            gradient: self.gradient.each(|c| -c),
            squares: self.squares.each(|c| -c),
            error: self.error,
        }
    }

    /// The greatest magnitudes of the second-order terms in the cube.
    fn seconds(&self) -> [f64; 6] {
        let [xx, yy, zz, xy, xz, yz] = self.squares.each(f64::abs);
        [xx, yy, zz, 2.0 * xy, 2.0 * xz, 2.0 * yz]
    }

    /// The sum of the greatest magnitudes of the second-order terms.
    pub(super) fn curvature(&self) -> f64 {
        self.seconds().iter().sum()
    }

    /// The sum of the greatest magnitudes of all terms.
    pub(crate) fn size(&self) -> f64 {
        self.gradient.each(f64::abs).iter().chain(&self.seconds()).sum::<f64>() + self.value.abs()
    }

    /// A bound of the difference between any gradient in the cube and the gradient at the centre, with a
    /// margin for rounding.
    pub(crate) fn bend(&self) -> f64 {
        let [xx, yy, zz, xy, xz, yz] = self.squares.each(f64::abs);
        let rows = [(xx + xy) + xz, (xy + yy) + yz, (xz + yz) + zz];
        let [x, y, z] = rows.each(|row| row * row);
        2.0 * sqrt((x + y) + z) * (1.0 + 16.0 * f64::EPSILON)
    }
}
