//! Questions: such as a stored octree answers in place, and such as any solids answer.

mod clearance;
mod extent;
mod interference;
mod measure;
mod point;
mod probe;
mod region;

pub use clearance::{Clearance, clearance};
pub use extent::{Extent, bounding_box};
pub use interference::{Interference, Overlap, interference, interference_of};
pub use measure::{Measured, Measures, measure};
pub use point::{Membership, PointCursor};
pub use probe::{classify_box, contains};
pub use region::Region;

use crate::error::Error;

/// Refuses what cannot be the width of an interval.
fn check_tolerance(tolerance: f64) -> Result<(), Error> {
    if tolerance >= 0.0 {
        return Ok(());
    }
    Err(Error::Argument { name: "tolerance", problem: "must be a number, and not negative" })
}
