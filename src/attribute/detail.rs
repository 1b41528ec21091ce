//! The resolution at which an attribute is followed inside a solid.

use super::{Attribute, ValueRange};
use crate::error::Error;
use crate::lattice::Bounds;
use crate::lattice::axes;

/// The criterion by which a cell no longer than the coarse limit is fine enough.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Criterion {
    /// The variance of the values at the eight corners is at most the square of the tolerance (Zhu, Tang and
    /// Dong 2002). The variance of several components is the sum of their variances. Details between the
    /// corners are missed.
    Variance,
    /// The attribute's range over the cell is proven to be no wider than the tolerance in any component. No
    /// detail is missed. A cell whose range is unknown is split, whatever the tolerance is.
    Range,
}

/// The resolution at which an attribute is followed inside a solid. A cell is split until its edge is at most
/// `coarse` *and* the attribute hardly changes in it, or until its edge is at most `fine`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detail {
    coarse: f64,
    fine: f64,
    tolerance: f64,
    criterion: Criterion,
}

impl Detail {
    /// Makes a rule with edges `coarse` and `fine` in model units, and `tolerance` in the attribute's units.
    ///
    /// # Errors
    /// [`Error::Argument`] unless 0 < fine ≤ coarse and 0 ≤ tolerance; `coarse` and `tolerance` may be
    /// infinite.
    pub fn new(coarse: f64, fine: f64, tolerance: f64, criterion: Criterion) -> Result<Detail, Error> {
        // A comparison with NaN is false.
        let refused = |name, problem| Err(Error::Argument { name, problem });
        if !(fine > 0.0 && fine <= coarse) {
            return refused("fine", "must be positive and at most the coarse edge");
        }
        if tolerance.is_nan() || tolerance < 0.0 {
            return refused("tolerance", "must be a number that is not negative");
        }
        Ok(Detail { coarse, fine, tolerance, criterion })
    }

    /// Makes the rule for uniform cells: the edge is at most `edge`, whatever the attribute is.
    ///
    /// # Errors
    /// [`Error::Argument`] unless `edge` is positive.
    pub fn uniform(edge: f64) -> Result<Detail, Error> {
        Detail::new(edge, edge, f64::INFINITY, Criterion::Variance)
    }

    /// The fine limit in model units: no cell with this edge or a shorter one is split.
    pub fn fine(&self) -> f64 {
        self.fine
    }

    /// The edge above which every inside cell is split.
    pub(crate) fn coarse(&self) -> f64 {
        self.coarse
    }

    /// Returns whether a cell of this edge, with these bounds, need not be split.
    ///
    /// # Errors
    /// Those of the attribute.
    pub fn is_fine(&self, attribute: &dyn Attribute, bounds: &Bounds, edge: f64) -> Result<bool, Error> {
        if edge <= self.fine {
            return Ok(true);
        }
        if edge > self.coarse {
            return Ok(false);
        }
        match self.criterion {
            Criterion::Range => {
                let range = attribute.range(bounds)?;
                Ok(range != ValueRange::Unknown && range.width(attribute.components()) <= self.tolerance)
            }
            Criterion::Variance => self.is_even(attribute, bounds),
        }
    }

    fn is_even(&self, attribute: &dyn Attribute, bounds: &Bounds) -> Result<bool, Error> {
        if self.tolerance == f64::INFINITY {
            return Ok(true);
        }
        let corner =
            |k: usize| axes(|axis| if k >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] });
        let points: [[f64; 3]; 8] = core::array::from_fn(corner);
        let mut values = [None; 8];
        attribute.values(&points, &mut values)?;
        let known = values.iter().flatten().count();
        if known < values.len() {
            // A cell with values at some of its corners only is not even.
            return Ok(known == 0);
        }
        let mut variance = 0.0;
        for component in 0..attribute.components() {
            let numbers = values.iter().flatten().map(|value| value[component]);
            let mean = numbers.clone().sum::<f64>() / 8.0;
            variance += numbers.map(|number| (number - mean) * (number - mean)).sum::<f64>() / 8.0;
        }
        Ok(variance <= self.tolerance * self.tolerance)
    }
}
