//! Exact affine maps.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{Dyadic, cross, dot};
use crate::lattice::{Affine, Frame};

/// The most bits of an entry, and the greatest exponent between one and w: enough for some hundred nested
/// rotations.
pub(crate) const MOST_BITS: u64 = 1 << 14;

/// The unit of that limit in messages.
pub(crate) const MOST_BITS_ARE: &str =
    "bits for the exact numbers of nested placements (some hundred rotations within each other)";

/// The exact map x ↦ (R x + r) / w, from the universe's unit coordinates into the space of a shape under any
/// number of placements.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct ExactMap {
    /// The rows of `[R | r]`.
    pub(crate) rows: [[Dyadic; 4]; 3],
    /// The divisor, not zero.
    pub(crate) w: Dyadic,
}

impl ExactMap {
    /// Returns the identity.
    pub(crate) fn identity() -> ExactMap {
        let rows = axes(|i| [0, 1, 2, 3].each(|j| Dyadic::new(if i == j { 1.0 } else { 0.0 })));
        ExactMap { rows, w: Dyadic::new(1.0) }
    }

    /// Returns the map from unit coordinates, in which the universe is [0, 1]³, to model space.
    pub(crate) fn from_universe(frame: &Frame) -> ExactMap {
        let edge = Dyadic::new(frame.edge());
        let rows = axes(|i| {
            let mut row = [0, 1, 2, 3].each(|_| Dyadic::zero());
            row[i] = edge.clone();
            row[3] = Dyadic::new(frame.origin()[i]);
            row
        });
        ExactMap { rows, w: Dyadic::new(1.0) }
    }

    /// Returns the composition of a linear function with the map, `given` ∘ map, times w. `given` are the
    /// four coefficients.
    pub(crate) fn linear(&self, given: &[Dyadic; 4]) -> [Dyadic; 4] {
        let [a, b, c, d] = given.each_ref();
        let [x, y, z] = &self.rows;
        let mut sums = [0, 1, 2, 3].each(|j| dot([a, b, c], [&x[j], &y[j], &z[j]]));
        sums[3] = &sums[3] + &(d * &self.w);
        sums
    }

    /// Returns the map into the space of a shape that `placement` puts into this map's target. With M and t
    /// of the placement, this is x ↦ adj(M) (R x + r − w t) / (w det M).
    ///
    /// # Errors
    /// [`Error::Limit`] if the exact entries become too long.
    pub(crate) fn of_placed(&self, placement: &Affine) -> Result<ExactMap, Error> {
        let m = placement.rows().each(|row| row.each(Dyadic::new));
        let cofactors = axes(|i| cross(&m[(i + 1) % 3], &m[(i + 2) % 3]));
        let determinant = dot([&m[0][0], &m[0][1], &m[0][2]], cofactors[0].each_ref());
        let moved = axes(|i| {
            let mut row = self.rows[i].clone();
            row[3] = &row[3] - &(&self.w * &m[i][3]);
            row
        });
        // The adjugate is the transpose of the cofactors.
        let rows = axes(|i| [0, 1, 2, 3].each(|j| dot(axes(|k| &cofactors[k][i]), axes(|k| &moved[k][j]))));
        // With w of a magnitude of one, sums of entries and products are as long as their exponents differ.
        let w = &self.w * &determinant;
        let scale = -w.magnitude().unwrap_or(0);
        let map = ExactMap { rows: rows.each(|row| row.each(|c| c.shifted(scale))), w: w.shifted(scale) };
        let too_long = |entry: &Dyadic| {
            let far = entry.magnitude().is_some_and(|m| m.unsigned_abs() > MOST_BITS);
            far || entry.bits() > MOST_BITS
        };
        if map.rows.iter().flatten().chain([&map.w]).any(too_long) {
            return Err(Error::Limit { what: MOST_BITS_ARE, limit: MOST_BITS });
        }
        Ok(map)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_of_a_placement() {
        let frame = Frame::new([1.0, 2.0, 3.0], 8.0, 3).unwrap();
        let placement =
            Affine::new([[0.0, -2.0, 0.5, 3.0], [1.0, 0.25, 0.0, -1.0], [0.0, 4.0, 1.0, 7.0]]).unwrap();
        let map = ExactMap::from_universe(&frame).of_placed(&placement).unwrap();
        // A point of the shape, its image, and the image's unit coordinates.
        let local = [0.5, -3.0, 2.0];
        let image = placement.apply(local);
        let unit = axes(|i| Dyadic::new((image[i] - frame.origin()[i]) / 8.0));
        for i in 0..3 {
            let row = &map.rows[i];
            let value = &dot([&row[0], &row[1], &row[2]], unit.each_ref()) + &row[3];
            assert_eq!(value, &map.w * &Dyadic::new(local[i]), "{i}");
        }
    }

    #[test]
    fn what_is_too_far_apart() {
        let frame = Frame::new([1.0; 3], 8.0, 3).unwrap();
        let nested = |scales: [f64; 3], count: usize| {
            let mut rows = [[0.0; 4]; 3];
            (0..3).for_each(|i| rows[i][i] = scales[i]);
            let placement = Affine::new(rows).unwrap();
            (0..count).try_fold(ExactMap::from_universe(&frame), |map, _| map.of_placed(&placement))
        };
        let (large, small) = (2f64.powi(60), 2f64.powi(-60));
        assert!(nested([large, 1.0, small], 200).is_ok());
        assert!(matches!(nested([large, 1.0, small], 300), Err(Error::Limit { .. })));
        assert!(nested([-1.0, 1.0, 1.0], 10_000).is_ok());
    }
}
