//! Whether two polynomials bound the same half-space, or one the other's complement: their coefficients on
//! the universe are proportional.

use super::Placed;
use crate::lattice::exact::{Dyadic, sqrt};
use alloc::boxed::Box;

/// A number that proportional coefficients share, but for rounding: weights of no simple ratios.
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
    /// The coefficients as doubles, and how many they are; `None` if it is no plane and no quadric.
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

    /// A number between −3 and 3 that all planes have that are the same from either side, and all quadrics,
    /// to 10⁻¹⁴; `None` of others.
    pub(crate) fn likeness(&self) -> Option<f64> {
        let (c, count) = self.rounded()?;
        let first = c.iter().copied().find(|&c| c != 0.0)?;
        let length = sqrt(c.iter().map(|c| c * c).sum());
        let sum = c.iter().zip(WEIGHTS).map(|(c, weight)| c * weight).sum::<f64>();
        let kind = if count == 4 { 0.0 } else { 1e-3 };
        Some(sum.copysign(sum * first) / length + kind)
    }

    /// Whether the coefficients are proportional, exactly: `Some(true)` if that is by a negative factor.
    pub(crate) fn is_turned(&self, other: &Placed) -> Option<bool> {
        let ((a, count), (b, other_count)) = (self.rounded()?, other.rounded()?);
        if count != other_count {
            return None;
        }
        let largest = (0..count).max_by(|&i, &j| a[i].abs().total_cmp(&a[j].abs()))?;
        let factor = b[largest] / a[largest];
        let size = factor.abs() * a[largest].abs();
        // Most that are not are told apart by doubles.
        let is_near = |i: usize| (b[i] - factor * a[i]).abs() <= 1e-14 * size;
        if !(0..count).all(is_near) {
            return None;
        }
        let (a, b) = (self.exact(), other.exact());
        let is_same = (0..count).all(|i| &a[i] * &b[largest] == &b[i] * &a[largest]);
        is_same.then(|| a[largest].sign() != b[largest].sign())
    }
}
