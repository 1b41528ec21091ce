//! Where does a ray meet a solid?
//!
//! A solid is a closed set, and so are the unions of its FULL cells and of its FULL and PARTIAL cells. Where a ray
//! enters the first, it is proven inside; before it enters the second, it is proven outside. So a ray that runs in
//! a face of a cell, or touches an edge or a corner of it, meets that cell.

mod beam;
mod course;
mod cut;
mod line;
mod march;
mod octree;
mod search;
mod solid;
#[cfg(feature = "render")]
mod touch;
mod trace;
mod way;

pub use solid::{Sight, cast_rays, line_of_sight, ray_spans};
#[cfg(feature = "render")]
pub(crate) use touch::TouchedCell;

use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::exact::two_diff;
use crate::lattice::{Cell, Interval, valid};
use alloc::vec::Vec;

/// A half-line or a segment: the points from + t · direction with 0 ≤ t ≤ t_last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    from: [f64; 3],
    /// The sum of two doubles an axis.
    direction: [[f64; 2]; 3],
    last: f64,
}

impl Ray {
    /// The half-line from `origin` (model units) along `direction`, which may have any length. t counts multiples of
    /// `direction`, so t is a distance if `direction` has length 1.
    ///
    /// # Errors
    /// [`Error::Argument`] if `direction` is zero, or if a number is not zero and not of a magnitude between 2^-256
    /// and 2^256.
    #[inline]
    pub fn new(origin: [f64; 3], direction: [f64; 3]) -> Result<Ray, Error> {
        valid::numbers("origin", &origin)?;
        valid::numbers("direction", &direction)?;
        Ray::along(origin, direction.map(|c| [c, 0.0]), f64::INFINITY)
    }

    /// The segment between two points (model units); t runs from 0 at `from` to 1 at `to`. The direction is the
    /// exact difference of the points.
    ///
    /// # Errors
    /// [`Error::Argument`] if the points are equal, or if a coordinate is not zero and not of a magnitude between
    /// 2^-256 and 2^256.
    pub fn between(from: [f64; 3], to: [f64; 3]) -> Result<Ray, Error> {
        valid::numbers("from", &from)?;
        valid::numbers("to", &to)?;
        let direction = axes(|axis| {
            let (high, low) = two_diff(to[axis], from[axis]);
            [high, low]
        });
        Ray::along(from, direction, 1.0)
    }

    /// The part of the ray with t ≤ `last`, or all of it if it ends before.
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
}

/// Which cells stop a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Obstacle {
    /// What is proven to be solid: FULL cells.
    Full = 0,
    /// What may be solid: FULL and PARTIAL cells.
    Upper = 1,
}

/// Where a ray meets a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// The least t at which the ray is in the solid lies in this interval: before `lower` the ray is proven
    /// outside, at `upper` inside. `upper` is ∞ if the ray is nowhere proven inside; then it may miss the solid.
    pub t: Interval,
    /// The first cell that stopped the ray.
    pub cell: Cell,
    /// The outward normal of the face by which the ray enters that cell, or of the surface where the solid knows
    /// slabs. Its length is 1 but for rounding. Zero if the ray starts in the cell.
    pub normal: [f64; 3],
}

/// The intervals of t in which a ray is in a solid. Intervals ascend, and no two of a list meet. An interval may be
/// a single point, where a ray touches an edge or a corner of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct RaySpans {
    /// Where the ray is proven inside, rounded inward.
    pub inner: Vec<Interval>,
    /// Where the ray is not proven outside, rounded outward. These intervals contain those of `inner`.
    pub outer: Vec<Interval>,
}
