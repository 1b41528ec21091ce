//! Boxes in model space.

use super::exact::{sign_of_sum, two_product, two_sum};
use super::{Affine, Frame};

/// A box between two corners, in model units, with min ≤ max on every axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub min: [f64; 3],
    /// Upper corner.
    pub max: [f64; 3],
}

impl Bounds {
    /// The box between two corners; `None` unless all coordinates are finite and min ≤ max on every axis.
    pub fn new(min: [f64; 3], max: [f64; 3]) -> Option<Bounds> {
        let good = |axis: usize| min[axis] <= max[axis] && min[axis].is_finite() && max[axis].is_finite();
        (0..3).all(good).then_some(Bounds { min, max })
    }

    /// A box that contains the universe of a frame: it, rounded outward.
    pub fn of(frame: &Frame) -> Bounds {
        let max = frame.origin().map(|low| match two_sum(low, frame.edge()) {
            (sum, error) if error > 0.0 => sum.next_up(),
            (sum, _) => sum,
        });
        Bounds { min: frame.origin(), max }
    }

    /// The least box that contains both.
    #[must_use]
    pub fn hull(&self, other: &Bounds) -> Bounds {
        Bounds {
            min: [0, 1, 2].map(|axis| self.min[axis].min(other.min[axis])),
            max: [0, 1, 2].map(|axis| self.max[axis].max(other.max[axis])),
        }
    }

    /// What both have in common, which may be a face; `None` if there is nothing.
    pub fn common(&self, other: &Bounds) -> Option<Bounds> {
        Bounds::new(
            [0, 1, 2].map(|axis| self.min[axis].max(other.min[axis])),
            [0, 1, 2].map(|axis| self.max[axis].min(other.max[axis])),
        )
    }

    /// The same with `margin` more on every side, rounded outward.
    #[must_use]
    pub fn grown(&self, margin: f64) -> Bounds {
        if margin == 0.0 {
            return *self;
        }
        Bounds {
            min: self.min.map(|low| (low - margin).next_down()),
            max: self.max.map(|high| (high + margin).next_up()),
        }
    }

    /// A box around the image under a map, rounded outward; `None` beyond the doubles.
    pub fn placed(&self, placement: &Affine) -> Option<Bounds> {
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for (i, row) in placement.rows().iter().enumerate() {
            let (mut least, mut most, mut size) = (row[3], row[3], row[3].abs());
            // Where nothing is rounded; in numbers this small errors get lost.
            let is_tellable = |c: f64| c == 0.0 || c.abs() > 1e-100;
            let mut is_exact = self.min.iter().chain(&self.max).all(|&end| is_tellable(end));
            for axis in 0..3 {
                let [a, b] = [self.min[axis], self.max[axis]].map(|end| two_product(row[axis], end));
                let (a, b) = if a.0 <= b.0 { (a, b) } else { (b, a) };
                let (lower, upper) = (two_sum(least, a.0), two_sum(most, b.0));
                is_exact &= [a.1, b.1, lower.1, upper.1] == [0.0; 4];
                (least, most, size) = (lower.0, upper.0, size + a.0.abs().max(b.0.abs()));
            }
            // Each summand is rounded at most six times.
            let error = if is_exact { 0.0 } else { 16.0 * f64::EPSILON * size + f64::MIN_POSITIVE };
            (min[i], max[i]) = (least - error, most + error);
        }
        Bounds::new(min, max)
    }

    /// Whether the box lies in the universe of a frame; exact.
    pub fn is_within(&self, frame: &Frame) -> bool {
        (0..3).all(|axis| {
            let origin = frame.origin()[axis];
            self.min[axis] >= origin && sign_of_sum(&[origin, frame.edge(), -self.max[axis]]) >= 0
        })
    }
}
