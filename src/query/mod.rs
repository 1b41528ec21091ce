//! Questions: such as a stored octree answers in place, and such as any solids answer.
//!
//! | question | of stored octrees | of any solids |
//! |---|---|---|
//! | does it contain a point? | `point` | `contains` |
//! | how does a box, a region lie to it? | `classify_box` | `classify_box`, `classify_in` |
//! | where does a ray meet it? | `ray` | `ray` |
//! | which cells of a column are solid, how high is it? | `columns` | `columns` |
//! | how much of it lies in a region? | `content` | `content` |
//! | what are its volume, area, centroid, inertia? | | `measure` |
//! | where does it begin and end? | | `extent` |
//! | how large is its section with a plane? | | `section` |
//! | how far is a point? | `distance` | `distance` |
//! | how far is another solid, is that enough, do both overlap? | | `clearance`, `gap_at_least`, `interference` |
//! | how far are two boundaries from each other? | | `deviation` |
//! | which cells of a box are solid, as bits? | `bitmap` | |
//!
//! # A new question about any solids
//!
//! It is one file, or one folder, here. No question uses another one; `StopReason` and `Tolerance`, which
//! several have, stand in `measure`. `classify_box` is the shortest to read, `extent` shows a search with a
//! queue, `section` has all of it.
//!
//! 1. **Solid.** A public function takes any [`Solid`](crate::Solid), a [`Frame`](crate::Frame) and a
//!    [`Control`](crate::Control), and puts the solid on the frame once, by `Solid::on`. A method of
//!    `OctreeRef` beside it may answer the same of a stored octree in place.
//! 2. **Proof.** `walk::Proven` wraps the classifier: FULL and EMPTY that are not proven become PARTIAL, so
//!    that the answer claims no more than the solid does.
//! 3. **Budget.** What splits on demand heeds `control.max_splits`, or a default that is a public constant,
//!    and tells in its answer whether it was spent. What keeps parts of cells heeds `control.max_bytes` by
//!    `Subject::takes`; the documentation of that field lists the questions that do.
//! 4. **Walk.** `walk::split_one` splits a cell, `walk::descend` goes depth first, `walk::Queue` best first,
//!    `walk::Subject` counts splits and keeps parts. A search that runs long gives back the memory of parts
//!    that it does not need any more (`Subject::is_wasteful`, `keep` with `Queue::change`). Slabs
//!    (`Question::Enclosure`) make an answer better by an order. What planes cut off a cell is computed in
//!    `cut`. The slabs of a host may hold NaN, infinities and contradictions: such a cell counts as unknown.
//! 5. **Job.** `Job` checks for a cancel now and then and reports progress, of which all shares make up
//!    `WHOLE`; `parallel::each` shares out what is independent, in an order that does not depend on the
//!    number of threads.
//! 6. **Doors.** The name below (at the root of the library too, if everyone uses it), and in the table above
//!    and that of `lib.rs`; a module in `tests/queries` with a dense oracle and a ball's formula, and its row
//!    in `tests/README.md`; a line in the operations of `tests/memory/failures.rs`; a function in `capi/src`
//!    (the recipe stands in its `lib.rs`); the fuzz target `measures`; CHANGELOG.md; and a row in
//!    `tests/octrees/proof_table.rs` if a solid comes out.

mod bitmap;
mod classify_box;
mod classify_in;
mod clearance;
mod columns;
mod contains;
mod content;
mod deviation;
mod distance;
mod extent;
mod interference;
mod measure;
mod point;
mod ray;
mod section;

pub use classify_box::{Region, classify_box};
pub use classify_in::classify_in;
pub(crate) use clearance::{Asked, Ready};
pub use clearance::{
    CLEARANCE_SPLITS, Clearance, Gap, GapVerdict, clearance, clearance_at, gap_at_least, gap_at_least_at,
};
pub use columns::{ColumnCells, ColumnRuns, Columns, Heights, Run, Side, columns, heights};
pub use contains::contains;
pub use content::{CellsIn, cells_in, volume_in};
pub use deviation::{DEVIATION_SPLITS, Deviation, OneWay, Within, Witness, deviation};
#[cfg(feature = "std")]
pub(crate) use deviation::{Reference, Remade, meshes_apart};
pub use distance::{DISTANCE_SPLITS, DistanceTo, NearCell, NearPoint, PointDistance, distances};
pub use extent::{BOUNDING_BOX_SPLITS, Extent, bounding_box};
pub use interference::{Ball, Interference, Overlap, interference, interference_at};
pub use measure::{
    AREA_SPLITS, MEASURE_SPLITS, MassProperties, MassSum, StopReason, SurfaceArea, Tolerance, measure,
    measure_in, surface_area,
};
pub use point::{Membership, PointCursor, PointTable};
#[cfg(feature = "render")]
pub(crate) use ray::TouchedCell;
pub use ray::{Obstacle, Ray, RayHit, RaySpans, Sight, cast_rays, line_of_sight, ray_spans};
pub use section::{SECTION_SPLITS, SectionArea, SectionPlane, section_area};
