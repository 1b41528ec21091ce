//! Questions: about points and boxes, which a stored octree answers in place, and measures of any solid.

mod measure;
mod point;
mod region;

pub use measure::{Measured, Measures, measure};
pub use point::{Membership, PointCursor};
pub use region::Region;
