//! Questions: such as a stored octree answers in place, and such as any solids answer.

mod bitmap;
mod clearance;
mod columns;
mod content;
mod descent;
mod distance;
mod extent;
mod interference;
mod measure;
mod point;
mod probe;
mod proven;
mod queue;
mod ray;
mod reach;
mod region;
mod subject;
mod within;

pub use clearance::{CLEARANCE_SPLITS, Clearance, clearance};
pub use columns::{ColumnCells, ColumnRuns, Columns, Heights, Run, Side, columns, heights};
pub use content::{CellsIn, cells_in, volume_in};
pub use distance::{DISTANCE_SPLITS, DistanceTo, NearCell, PointDistance, distances};
pub use extent::{BOUNDING_BOX_SPLITS, Extent, bounding_box};
pub use interference::{Interference, Overlap, interference, interference_of};
pub use measure::{
    AREA_SPLITS, MEASURE_SPLITS, MassProperties, StopReason, SurfaceArea, Tolerance, measure, surface_area,
};
pub use point::{Membership, PointCursor, PointTable};
pub use probe::contains;
pub(crate) use ray::Touch;
pub use ray::{Obstacle, Ray, RayHit, RaySpans, Sight, cast_rays, line_of_sight, ray_spans};
pub use region::{Region, classify_box};
pub use within::classify_in;
