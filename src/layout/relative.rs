//! The placement of one placed solid in the coordinates of another one.

use super::orientation::stretch;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Affine, Bounds, Composed, Interval};

/// The placement of a solid B in the coordinates of a placed solid A, rounded, with the possible effect of
/// rounding on distances.
pub(super) struct Relative {
    pub(super) placement: Affine,
    /// The maximal displacement of B's points by rounding (model units).
    off: f64,
    /// The maximal relative change of lengths by the placement of A.
    stretch: f64,
}

impl Relative {
    /// Computes the relative placement. `bounds` is B's bounding box.
    pub(super) fn new(a: &Affine, b: &Affine, bounds: &Bounds) -> Result<Relative, Error> {
        let placement = after(&a.inverse()?, b)?;
        let there = Composed::from(a).after(&placement);
        let mut square = 0.0;
        for (row, (errors, wanted)) in there.rows().iter().zip(there.errors().iter().zip(b.rows())) {
            let off = |j: usize| {
                let difference = row[j] - wanted[j];
                difference.abs() * (1.0 + f64::EPSILON) + errors[j]
            };
            let reach = |j: usize| bounds.min[j].abs().max(bounds.max[j].abs());
            let most = (0..3).map(|j| off(j) * reach(j)).sum::<f64>() + off(3);
            square += most * most;
        }
        let off = sqrt(square) * (1.0 + 1e-12);
        Ok(Relative { placement, off, stretch: stretch(a) })
    }

    /// The placement of B for an A that is not moved.
    pub(super) fn of(b: &Affine) -> Relative {
        Relative { placement: *b, off: 0.0, stretch: 0.0 }
    }

    /// Returns the distance in the coordinates of A that ensures a distance of `least` in those of the model;
    /// not 0.
    pub(super) fn needed(&self, least: f64) -> f64 {
        let needed = (least + self.off) / (1.0 - self.stretch);
        let needed = if self.off == 0.0 && self.stretch == 0.0 { needed } else { needed * (1.0 + 1e-12) };
        needed.max(LEAST)
    }

    /// Converts a distance to the coordinates of the model.
    pub(super) fn distance(&self, own: Interval) -> Interval {
        if self.off == 0.0 && self.stretch == 0.0 {
            return own;
        }
        let lower = (own.lower * (1.0 - self.stretch) - self.off) * (1.0 - 1e-12);
        let upper = (own.upper * (1.0 + self.stretch) + self.off) * (1.0 + 1e-12);
        // (Solids that touch do so to rounding.)
        Interval::between(lower.max(0.0), upper.max(0.0))
    }
}

/// The least distance in a query.
const LEAST: f64 = 1.0 / (1u128 << 100) as f64;

/// Composes two maps, `inner` first, then `outer`, rounded.
pub(super) fn after(outer: &Affine, inner: &Affine) -> Result<Affine, Error> {
    let rows = *Composed::from(outer).after(inner).rows();
    // (A number that nearly vanishes by rounding counts as zero.)
    let is_noise = |c: f64| c.abs() < 1.0 / (1u64 << 60) as f64;
    Affine::new(rows.each(|row| row.each(|c| if is_noise(c) { 0.0 } else { c })))
}

#[cfg(test)]
mod tests {
    use super::super::orientation::Orientations;
    use super::*;

    #[test]
    fn rounding_is_bounded() {
        let bounds = Bounds::new([-3.0, 2.0, 100.0], [5.0, 4.0, 130.0]).unwrap();
        let maps = Orientations::Free(40).maps(3).unwrap();
        let moved = |map: &Affine, k: usize| {
            let mut rows = *map.rows();
            (0..3).for_each(|i| rows[i][3] = 17.0 / (3 + i + k) as f64 - 40.0);
            Affine::new(rows).unwrap()
        };
        for (k, pair) in maps.windows(2).enumerate() {
            let (a, b) = (moved(&pair[0], k), moved(&pair[1], k + 1));
            let relative = Relative::new(&a, &b, &bounds).unwrap();
            assert!(relative.off < 1e-11, "{}", relative.off);
            for corner in bounds.corners() {
                let (p, q) = (a.apply(relative.placement.apply(corner)), b.apply(corner));
                let away = (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt();
                assert!(away <= relative.off + 1e-12, "{away} {}", relative.off);
            }
            assert!(relative.needed(1.0) >= 1.0 && relative.needed(1.0) < 1.0 + 1e-10);
        }
    }

    #[test]
    fn moves_by_whole_numbers_are_exact() {
        let bounds = Bounds::new([0.0; 3], [1.0; 3]).unwrap();
        let to = |x: f64| Affine::translation([x, 2.0, 3.0]).unwrap();
        let relative = Relative::new(&to(5.0), &to(7.5), &bounds).unwrap();
        assert_eq!((relative.off, relative.needed(2.0)), (0.0, 2.0));
        assert_eq!(relative.placement, Affine::translation([2.5, 0.0, 0.0]).unwrap());
    }
}
