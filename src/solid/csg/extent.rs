//! Boxes that contain a solid and its complement.

use crate::lattice::Affine;

/// What a solid surely does not reach beyond, in model units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Extent {
    /// It is empty.
    Nothing,
    /// The box between two corners.
    Box([f64; 3], [f64; 3]),
    /// Nobody knows.
    Unbounded,
}

impl Extent {
    /// Of the union of two solids.
    pub(super) fn hull(self, other: Extent) -> Extent {
        match (self, other) {
            (Extent::Nothing, extent) | (extent, Extent::Nothing) => extent,
            (Extent::Box(a, b), Extent::Box(c, d)) => Extent::Box(
                [0, 1, 2].map(|axis| a[axis].min(c[axis])),
                [0, 1, 2].map(|axis| b[axis].max(d[axis])),
            ),
            _ => Extent::Unbounded,
        }
    }

    /// Of the intersection of two solids.
    pub(super) fn common(self, other: Extent) -> Extent {
        match (self, other) {
            (Extent::Unbounded, extent) | (extent, Extent::Unbounded) => extent,
            (Extent::Box(a, b), Extent::Box(c, d)) => {
                let low = [0, 1, 2].map(|axis| a[axis].max(c[axis]));
                let high = [0, 1, 2].map(|axis| b[axis].min(d[axis]));
                if (0..3).any(|axis| low[axis] > high[axis]) {
                    Extent::Nothing
                } else {
                    Extent::Box(low, high)
                }
            }
            _ => Extent::Nothing,
        }
    }

    /// Of the solid under a placement, rounded outward.
    pub(super) fn placed(self, placement: &Affine) -> Extent {
        let Extent::Box(low, high) = self else { return self };
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for (i, row) in placement.rows().iter().enumerate() {
            let (mut least, mut most, mut size) = (row[3], row[3], row[3].abs());
            for axis in 0..3 {
                let (a, b) = (row[axis] * low[axis], row[axis] * high[axis]);
                (least, most, size) = (least + a.min(b), most + a.max(b), size + a.abs().max(b.abs()));
            }
            // Each summand is rounded at most six times.
            let error = 16.0 * f64::EPSILON * size + f64::MIN_POSITIVE;
            (min[i], max[i]) = (least - error, most + error);
        }
        if min.iter().chain(&max).all(|c| c.is_finite()) { Extent::Box(min, max) } else { Extent::Unbounded }
    }
}
