//! Half-spaces that a host program supplies.

use super::bounds::{Octants, Sides};
use super::linear;
use super::map::ExactMap;
use super::points;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Frame, Interval};
use crate::solid::Fingerprint;
use alloc::boxed::Box;
use alloc::sync::Arc;

type Value = dyn Fn([f64; 3]) -> Result<f64, Error> + Send + Sync;
type Range = dyn Fn([f64; 3], [f64; 3]) -> Result<Interval, Error> + Send + Sync;

/// The exponent of the least double: finer numbers are not exact.
const LOWEST: i64 = -1074;

/// A function of the host, by its values at points and its ranges over boxes.
pub(crate) struct Host {
    pub(crate) value: Box<Value>,
    pub(crate) range: Box<Range>,
    pub(crate) fingerprint: Option<Fingerprint>,
}

/// A function of the host on a universe.
pub(crate) struct PlacedHost {
    host: Arc<Host>,
    /// The map into the function's space: the rows of `[R | r]`, and more than the error of each coordinate
    /// of an image.
    rows: [[f64; 4]; 3],
    errors: [f64; 3],
}

impl PlacedHost {
    /// Returns the image of the function under the map on the universe of `frame`.
    pub(crate) fn new(host: &Arc<Host>, map: &ExactMap, frame: &Frame) -> PlacedHost {
        // w = divisor · 2^shift, where the divisor has a magnitude of one.
        let shift = map.w.magnitude().unwrap_or(0);
        let divisor = map.w.shifted(-shift).rounded();
        let exact_divisor = map.w.bits() == 1;
        // The finest coordinates are those of cell centres, and no number is finer than the least double.
        let places = frame.depth() as i64 + 1;
        let lowest = LOWEST + places;
        let mut errors = [0.0; 3];
        let rows = axes(|i| {
            let exact = map.rows[i].each_ref().each(|c| c.shifted(-shift));
            let row = exact.each_ref().each(|c| c.rounded() / divisor);
            let size: f64 = row.iter().map(|c| c.abs()).sum();
            let is_exact = exact_divisor
                && exact.iter().all(|c| c.exactly().is_some() && c.grain().is_none_or(|bit| bit >= lowest))
                && size.is_finite()
                && linear::is_exact(&exact, places, size);
            // At most eight roundings a term.
            errors[i] = if is_exact { 0.0 } else { 16.0 * f64::EPSILON * size + f64::MIN_POSITIVE };
            row
        });
        PlacedHost { host: host.clone(), rows, errors }
    }

    /// Returns the rounded image of a point.
    fn image(&self, t: [f64; 3]) -> [f64; 3] {
        self.rows.each(|[a, b, c, d]| ((a * t[0] + b * t[1]) + c * t[2]) + d)
    }

    /// Returns a box around the image of a box.
    fn image_of_box(&self, low: [f64; 3], high: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let end = |i: usize, upper: bool| {
            let row = self.rows[i];
            let corner = axes(|k| if (row[k] > 0.0) == upper { high[k] } else { low[k] });
            let at = ((row[0] * corner[0] + row[1] * corner[1]) + row[2] * corner[2]) + row[3];
            if upper { at + self.errors[i] } else { at - self.errors[i] }
        };
        (axes(|i| end(i, false)), axes(|i| end(i, true)))
    }

    /// Returns for which of the cells `wanted` the host says that the function is nowhere negative, and
    /// nowhere positive. A cell with an inner and an outer vertex is neither, and its range is not evaluated.
    pub(crate) fn sides(&self, at: &Octants, wanted: u8, evaluations: &mut u64) -> Result<Sides, Error> {
        let wanted = wanted & at.all();
        let mut sides = Sides { inside: 0, outside: 0 };
        let (inner, outer) = points::vertices(at, wanted, |t| {
            *evaluations += 1;
            let value = self.value_at(t)?;
            Ok(value.filter(|&value| value != 0.0).map(|value| value > 0.0))
        })?;
        for k in (0..8).filter(|k| (wanted & !(inner & outer)) >> k & 1 != 0) {
            let (low, high) = at.octant(k);
            let (min, max) = self.image_of_box(low, high);
            if !min.iter().chain(&max).all(|c| c.is_finite()) {
                continue;
            }
            *evaluations += 1;
            let range = (self.host.range)(min, max)?;
            let (lower, upper) = (range.lower, range.upper);
            // A function that is zero everywhere decides nothing.
            if lower >= 0.0 && upper > 0.0 && outer >> k & 1 == 0 {
                sides.inside |= 1 << k;
            }
            if upper <= 0.0 && lower < 0.0 && inner >> k & 1 == 0 {
                sides.outside |= 1 << k;
            }
        }
        Ok(sides)
    }

    /// Returns the value at a point; `None` if the host does not know it.
    pub(crate) fn value_at(&self, t: [f64; 3]) -> Result<Option<f64>, Error> {
        let image = self.image(t);
        if !image.iter().all(|c| c.is_finite()) {
            return Ok(None);
        }
        let value = (self.host.value)(image)?;
        Ok(Some(value).filter(|value| !value.is_nan()))
    }
}
