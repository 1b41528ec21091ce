//! Questions that a stored octree answers in place.

mod point;
mod region;

pub use point::{Membership, PointCursor};
pub use region::Region;
