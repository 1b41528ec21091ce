//! The volume of a set and its first and second moments.

use super::array::Each;
use super::{Interval, PAIRS};
use core::array::from_fn as array;

const ZERO: Interval = Interval::exactly(0.0);

/// The volume of a set of points, and its moments about a point, in model units. The intervals contain the
/// true values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeMoments {
    /// The reference point p of the moments. It lies near the centroid, to avoid cancellation.
    pub point: [f64; 3],
    /// The volume. Not negative.
    pub volume: Interval,
    /// ∫ (x − p)
    pub first: [Interval; 3],
    /// ∫ (x − p)(x − p)ᵀ, the elements xx, yy, zz, xy, xz, yz.
    pub second: [Interval; 6],
}

impl VolumeMoments {
    /// The centroid; `None` if the volume may be 0.
    pub fn centroid(&self) -> Option<[Interval; 3]> {
        let is_some = self.volume.lower > 0.0;
        is_some.then(|| array(|k| Interval::exactly(self.point[k]).plus(self.first[k].over(self.volume))))
    }

    /// The tensor of inertia about the origin of the model, for density 1: ∫ (|x|² δij − xi xj).
    pub fn inertia_about_origin(&self) -> [[Interval; 3]; 3] {
        let p = self.point.each(Interval::exactly);
        tensor(array(|k| {
            let (i, j) = PAIRS[k];
            let square = if i == j { p[i].square() } else { p[i].times(p[j]) };
            let mixed = p[i].times(self.first[j]).plus(p[j].times(self.first[i]));
            self.second[k].plus(mixed).plus(square.times(self.volume))
        }))
    }

    /// The tensor of inertia about the set's own centroid.
    pub fn inertia_about_centroid(&self) -> [[Interval; 3]; 3] {
        if self.volume.lower > 0.0 {
            return tensor(array(|k| {
                let (i, j) = PAIRS[k];
                let first = &self.first;
                let product = if i == j { first[i].square() } else { first[i].times(first[j]) };
                self.second[k].minus(product.over(self.volume))
            }));
        }
        // The set may be anything between nothing and the maximum that the second moments allow. M ≽ 0, so
        // that Mij² ≤ Mii Mjj.
        tensor(array(|k| {
            let (i, j) = PAIRS[k];
            let [a, b] = [i, j].each(|axis| Interval::between(0.0, self.second[axis].upper.max(0.0)));
            let radius = a.times(b).root().upper;
            Interval::between(if i == j { 0.0 } else { -radius }, radius)
        }))
    }
}

/// The tensor of inertia from second moments. The second moments of one axis are not negative.
fn tensor(second: [Interval; 6]) -> [[Interval; 3]; 3] {
    let mut tensor = [[ZERO; 3]; 3];
    for (k, (i, j)) in (0..6).zip(PAIRS) {
        tensor[i][j] = if i == j {
            let sum = second[(i + 1) % 3].plus(second[(i + 2) % 3]);
            sum.not_negative()
        } else {
            second[k].negated()
        };
        tensor[j][i] = tensor[i][j];
    }
    tensor
}
