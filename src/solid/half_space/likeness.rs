//! A test whether two polynomials bound the same half-space, or one the complement of the other: whether
//! their coefficients on the universe are proportional.

use super::Placed;
use crate::lattice::exact::{Dyadic, sqrt};
use alloc::boxed::Box;

/// Weights without simple ratios, whose weighted sum is the same for proportional coefficients, up to
/// rounding.
const WEIGHTS: [f64; 10] = [
    0.577_215_664_9,
    1.324_717_957_2,
    0.915_965_594_2,
    1.202_056_903_2,
    0.662_743_419_3,
    1.451_369_234_9,
    0.834_626_841_7,
    1.705_211_140_1,
    0.764_223_653_6,
    1.098_685_805_5,
];

impl Placed {
    /// Returns the coefficients as doubles, and their number; `None` if the surface is neither a plane nor a
    /// quadric.
    fn rounded(&self) -> Option<([f64; 10], usize)> {
        let mut all = [0.0; 10];
        let count = match self {
            Placed::Plane(plane) => {
                all[..4].copy_from_slice(plane.rounded());
                4
            }
            Placed::Quadric(quadric) => {
                let exact = quadric.exact();
                all.iter_mut().zip(exact).for_each(|(c, exact)| *c = exact.rounded());
                10
            }
            _ => return None,
        };
        Some((all, count))
    }

    fn exact(&self) -> Box<[Dyadic]> {
        match self {
            Placed::Plane(plane) => Box::new(plane.exact()),
            Placed::Quadric(quadric) => Box::new(quadric.exact().clone()),
            _ => Box::new([]),
        }
    }

    /// Returns a number between −3 and 3 that agrees to 10⁻¹⁴ for planes that bound the same half-space or
    /// complements, and likewise for quadrics. `None` for other surfaces.
    pub(crate) fn likeness(&self) -> Option<f64> {
        let (c, count) = self.rounded()?;
        let first = c.iter().copied().find(|&c| c != 0.0)?;
        let length = sqrt(c.iter().map(|c| c * c).sum());
        let sum = c.iter().zip(WEIGHTS).map(|(c, weight)| c * weight).sum::<f64>();
        let kind = if count == 4 { 0.0 } else { 1e-3 };
        Some(sum.copysign(sum * first) / length + kind)
    }

    /// Decides exactly whether the coefficients are proportional: `Some(true)` for a negative factor,
    /// `Some(false)` for a positive one.
    pub(crate) fn is_turned(&self, other: &Placed) -> Option<bool> {
        let ((a, count), (b, other_count)) = (self.rounded()?, other.rounded()?);
        if count != other_count {
            return None;
        }
        let largest = (0..count).max_by(|&i, &j| a[i].abs().total_cmp(&a[j].abs()))?;
        let factor = b[largest] / a[largest];
        let size = factor.abs() * a[largest].abs();
        // Doubles exclude most pairs that are not proportional.
        let is_near = |i: usize| (b[i] - factor * a[i]).abs() <= 1e-14 * size;
        if !(0..count).all(is_near) {
            return None;
        }
        let (a, b) = (self.exact(), other.exact());
        let is_same = (0..count).all(|i| &a[i] * &b[largest] == &b[i] * &a[largest]);
        is_same.then(|| a[largest].sign() != b[largest].sign())
    }
}
