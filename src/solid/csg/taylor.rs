//! What half-spaces know of a cell by Taylor's formula.

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

/// How far x ↦ the gradient of Σ second x xᵀ reaches over [-1, 1]³, with some last places for what is rounded.
pub(super) fn bend_of(second: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = second.map(f64::abs);
    let rows = [2.0 * xx + xy + xz, xy + 2.0 * yy + yz, xz + yz + 2.0 * zz];
    let squares = rows.map(|row| row * row);
    crate::lattice::exact::sqrt((squares[0] + squares[1]) + squares[2]) * (1.0 + 16.0 * f64::EPSILON)
}
