//! The distance of points from a solid.
//!
//! A solid S lies between two sets of cells: the FULL cells, and the cells that are FULL or PARTIAL. The
//! distance from the second set is a lower bound of the distance from S. The distance from the first set is
//! an upper bound. The space outside of the universe counts as one more cell, with the exterior's tag.

mod field;
mod nearest;
mod place;
mod slabs;
mod solid;
mod stored;
mod walk;

pub use nearest::NearCell;
pub use solid::{DISTANCE_SPLITS, NearPoint, PointDistance, distances};

use crate::error::Error;
use crate::lattice::Interval;

/// The target of a distance query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum DistanceTo {
    /// To the solid: 0 for its points.
    Solid = 0,
    /// To the complement of the solid: 0 for points outside.
    Complement = 1,
    /// To the boundary, with a sign: positive outside of the solid, negative inside.
    Boundary = 2,
}

impl DistanceTo {
    /// The answer for a point that has no place.
    fn unknown(self) -> Interval {
        let lower = if self == DistanceTo::Boundary { f64::NEG_INFINITY } else { 0.0 };
        Interval::between(lower, f64::INFINITY)
    }

    /// Computes the answer by one or two searches: `search(hollow)` is the distance from the solid, or from
    /// its complement.
    fn ask(self, mut search: impl FnMut(bool) -> Result<Interval, Error>) -> Result<Interval, Error> {
        match self {
            DistanceTo::Solid => search(false),
            DistanceTo::Complement => search(true),
            DistanceTo::Boundary => {
                let outside = search(false)?;
                // A point that is proven outside of one lies in the other.
                if outside.lower > 0.0 {
                    return Ok(outside);
                }
                let inside = search(true)?;
                let inside = inside.negated();
                let both = Interval::between(inside.lower, outside.upper);
                Ok(if inside.upper < 0.0 { inside } else { both })
            }
        }
    }
}
