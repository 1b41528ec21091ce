//! Moments of a set in a cell, in the cell's own coordinates.

/// Volume, first and second moments of a set in the cube [-1, 1]³: a cell, measured from its centre in half
/// edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CubeMoments {
    /// The volume; at most 8.
    pub volume: f64,
    /// ∫ x.
    pub first: [f64; 3],
    /// ∫ x xᵀ: xx, yy, zz, xy, xz, yz.
    pub second: [f64; 6],
}

/// The two axes of each second moment.
pub(crate) const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The index in [`PAIRS`] of the product of two axes.
pub(crate) const PLACES: [[usize; 3]; 3] = [[0, 3, 4], [3, 1, 5], [4, 5, 2]];

impl CubeMoments {
    /// The moments of the empty set.
    pub const EMPTY: CubeMoments = CubeMoments { volume: 0.0, first: [0.0; 3], second: [0.0; 6] };

    /// The moments of the whole cube.
    pub const FULL: CubeMoments = CubeMoments {
        volume: 8.0,
        first: [0.0; 3],
        second: [8.0 / 3.0, 8.0 / 3.0, 8.0 / 3.0, 0.0, 0.0, 0.0],
    };

    /// The moments of the rest of the cube.
    #[must_use]
    pub fn complement(&self) -> CubeMoments {
        let mut rest = CubeMoments::FULL;
        rest.volume -= self.volume;
        (0..3).for_each(|i| rest.first[i] -= self.first[i]);
        (0..6).for_each(|i| rest.second[i] -= self.second[i]);
        rest
    }

    /// The mean of these moments and others.
    #[must_use]
    pub(crate) fn mean(&self, other: &CubeMoments) -> CubeMoments {
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        CubeMoments {
            volume: mean(self.volume, other.volume),
            first: core::array::from_fn(|i| mean(self.first[i], other.first[i])),
            second: core::array::from_fn(|i| mean(self.second[i], other.second[i])),
        }
    }
}

/// The moments of a solid in a cell, with an error bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellMoments {
    /// Approximate moments.
    pub moments: CubeMoments,
    /// A bound of the error of each moment. Not negative; 8 or more means that nothing is known.
    pub error: f64,
}

impl CellMoments {
    /// The moments of the union with another set in the same cell that this one does not overlap.
    #[must_use]
    pub(crate) fn plus(&self, other: &CellMoments) -> CellMoments {
        let (own, theirs) = (&self.moments, &other.moments);
        let moments = CubeMoments {
            volume: own.volume + theirs.volume,
            first: core::array::from_fn(|i| own.first[i] + theirs.first[i]),
            second: core::array::from_fn(|i| own.second[i] + theirs.second[i]),
        };
        // The sums are rounded.
        CellMoments {
            moments,
            error: (self.error + other.error) * (1.0 + f64::EPSILON) + 16.0 * f64::EPSILON,
        }
    }

    /// The moments of the complement.
    #[must_use]
    pub fn complement(&self) -> CellMoments {
        // The subtraction is rounded.
        let error = self.error + 16.0 * f64::EPSILON;
        CellMoments { moments: self.moments.complement(), error }
    }
}
