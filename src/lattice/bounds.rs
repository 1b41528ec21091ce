//! Boxes in model space.

use super::array::Each;
use super::axes;
use super::composed::{Composed, RoundedSum};
use super::exact::{sign_of_sum, two_sum};
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
    /// Makes the box between two corners; `None` unless all coordinates are finite and min ≤ max on every
    /// axis.
    pub fn new(min: [f64; 3], max: [f64; 3]) -> Option<Bounds> {
        let good = |axis: usize| min[axis] <= max[axis] && min[axis].is_finite() && max[axis].is_finite();
        (0..3).all(good).then_some(Bounds { min, max })
    }

    /// The universe of a frame, rounded outward to a box.
    pub fn of(frame: &Frame) -> Bounds {
        let max = frame.origin().each(|low| match two_sum(low, frame.edge()) {
            (sum, error) if error > 0.0 => sum.next_up(),
            (sum, _) => sum,
        });
        Bounds { min: frame.origin(), max }
    }

    /// The eight corners; x varies fastest and z slowest.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        core::array::from_fn(|k| {
            axes(|axis| if k >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] })
        })
    }

    /// The least box that contains both boxes.
    #[must_use]
    pub fn hull(&self, other: &Bounds) -> Bounds {
        Bounds {
            min: axes(|axis| self.min[axis].min(other.min[axis])),
            max: axes(|axis| self.max[axis].max(other.max[axis])),
        }
    }

    /// The intersection of both boxes, which may be a face; `None` if it is empty.
    pub fn common(&self, other: &Bounds) -> Option<Bounds> {
        Bounds::new(
            axes(|axis| self.min[axis].max(other.min[axis])),
            axes(|axis| self.max[axis].min(other.max[axis])),
        )
    }

    /// The box enlarged by `margin` on every side, rounded outward.
    #[must_use]
    pub fn grown(&self, margin: f64) -> Bounds {
        if margin == 0.0 {
            return *self;
        }
        Bounds {
            min: self.min.each(|low| (low - margin).next_down()),
            max: self.max.each(|high| (high + margin).next_up()),
        }
    }

    /// A box around the image under a map, rounded outward; `None` if it exceeds the range of doubles.
    pub fn placed(&self, placement: &Affine) -> Option<Bounds> {
        self.under(&placement.into())
    }

    /// A box around the image under a composition of maps, rounded outward; `None` if it exceeds the range of
    /// doubles.
    pub(crate) fn under(&self, map: &Composed) -> Option<Bounds> {
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for (i, (row, errors)) in map.rows.iter().zip(&map.errors).enumerate() {
            let factors = [row[0], row[1], row[2]];
            let end = |upper: bool| {
                let corner = axes(|k| if (row[k] > 0.0) == upper { self.max[k] } else { self.min[k] });
                RoundedSum::of(factors, corner, row[3])
            };
            let reach = |k: usize| errors[k] * self.min[k].abs().max(self.max[k].abs());
            let off = ((reach(0) + reach(1)) + (reach(2) + errors[3])) * (1.0 + 1e-12);
            let outward = |sum: RoundedSum, sense: f64| {
                let off = if off == 0.0 { 0.0 } else { off + f64::EPSILON * sum.value.abs() };
                sum.value + sense * (sum.error + off)
            };
            (min[i], max[i]) = (outward(end(false), -1.0), outward(end(true), 1.0));
        }
        Bounds::new(min, max)
    }

    /// Returns whether the box lies in the universe of a frame; exact.
    pub fn is_within(&self, frame: &Frame) -> bool {
        (0..3).all(|axis| {
            let origin = frame.origin()[axis];
            self.min[axis] >= origin && sign_of_sum(&[origin, frame.edge(), -self.max[axis]]) >= 0
        })
    }
}
