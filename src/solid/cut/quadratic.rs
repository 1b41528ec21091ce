//! Functions to second order.

/// A function over the cube [-1, 1]³ to second order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quadratic {
    /// At the centre.
    pub(crate) value: f64,
    pub(crate) gradient: [f64; 3],
    /// Half the second derivatives: xx, yy, zz, xy, xz, yz.
    pub(crate) squares: [f64; 6],
    /// The function differs by at most this from value + gradient · x + xᵀ squares x.
    pub(crate) error: f64,
}

impl Quadratic {
    /// The negative.
    pub(crate) fn complement(&self) -> Quadratic {
        Quadratic {
            value: -self.value,
            gradient: self.gradient.map(|c| -c),
            squares: self.squares.map(|c| -c),
            error: self.error,
        }
    }
}
