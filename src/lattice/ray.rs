//! Half-lines and segments.

use super::array::Each;
use super::exact::two_diff;
use super::{axes, valid};
use crate::error::Error;

/// A half-line or a segment: the points from + t · direction with 0 ≤ t ≤ t_last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    pub(crate) from: [f64; 3],
    /// For each axis, the sum of two doubles.
    pub(crate) direction: [[f64; 2]; 3],
    pub(crate) last: f64,
}

impl Ray {
    /// Makes the half-line from `origin` (model units) along `direction`, which may have any length. t counts
    /// multiples of `direction`, so t is a distance if `direction` has length 1.
    ///
    /// # Errors
    /// [`Error::Argument`] if `direction` is zero, or if a number is neither zero nor of a magnitude between
    /// 2^-256 and 2^256.
    #[inline]
    pub fn new(origin: [f64; 3], direction: [f64; 3]) -> Result<Ray, Error> {
        valid::numbers("origin", &origin)?;
        valid::numbers("direction", &direction)?;
        Ray::along(origin, direction.each(|c| [c, 0.0]), f64::INFINITY)
    }

    /// Makes the segment between two points (model units); t runs from 0 at `from` to 1 at `to`. The
    /// direction is the exact difference of the points.
    ///
    /// # Errors
    /// [`Error::Argument`] if the points are equal, or if a coordinate is neither zero nor of a magnitude
    /// between 2^-256 and 2^256.
    pub fn between(from: [f64; 3], to: [f64; 3]) -> Result<Ray, Error> {
        valid::numbers("from", &from)?;
        valid::numbers("to", &to)?;
        let direction = axes(|axis| {
            let (high, low) = two_diff(to[axis], from[axis]);
            [high, low]
        });
        Ray::along(from, direction, 1.0)
    }

    /// Limits the ray to t ≤ `last`. A ray that ends earlier stays as it is.
    ///
    /// # Errors
    /// [`Error::Argument`] if `last` is neither ∞ nor between 2^-256 and 2^256.
    #[inline]
    pub fn until(self, last: f64) -> Result<Ray, Error> {
        if last == f64::INFINITY {
            return Ok(self);
        }
        valid::length("last", last)?;
        Ok(Ray { last: last.min(self.last), ..self })
    }

    #[inline]
    fn along(from: [f64; 3], direction: [[f64; 2]; 3], last: f64) -> Result<Ray, Error> {
        if direction.iter().all(|&[high, _]| high == 0.0) {
            return Err(Error::Argument { name: "direction", problem: "must not be zero" });
        }
        Ok(Ray { from, direction, last })
    }

    /// Makes the half-line along an axis, up (1) or down (−1).
    pub(crate) fn along_axis(from: [f64; 3], axis: usize, sign: f64) -> Ray {
        let mut direction = [[0.0; 2]; 3];
        direction[axis][0] = sign;
        Ray { from, direction, last: f64::INFINITY }
    }
}
