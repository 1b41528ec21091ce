//! Queries about solids: queries that a stored octree answers in place, and queries that any solid answers.
//!
//! | query | for stored octrees | for any solid |
//! |---|---|---|
//! | does the solid contain a point? | `point` | `contains` |
//! | is a box or a region inside, outside or across the boundary? | `classify_box` | `classify_box`, `classify_in` |
//! | where does a ray meet the solid? | `ray` | `ray` |
//! | which cells of a column are solid, and how high is the column? | `columns` | `columns` |
//! | how much of the solid lies in a region? | `content` | `content` |
//! | volume, area, centroid, inertia | | `measure` |
//! | bounding box | | `extent` |
//! | area of the section with a plane | | `section` |
//! | distance from a point | `distance` | `distance` |
//! | distance to another solid, minimum gap, overlap | | `clearance`, `gap_at_least`, `interference` |
//! | distance between two boundaries | | `deviation` |
//! | solid cells of a box, as bits | `bitmap` | |
//!
//! # Adding a query about any solid
//!
//! A query is one file or one folder here. No query uses another one. `StopReason` and `Tolerance`, which
//! several queries share, stand in `measure`. `classify_box` is the shortest to read, `extent` shows a search
//! with a queue, `section` uses every technique.
//!
//! 1. **Solid.** A public function takes any [`Solid`](crate::Solid), a [`Frame`](crate::Frame) and a
//!    [`Control`](crate::Control), and puts the solid on the frame once, by `Solid::on`. A method of
//!    `OctreeRef` beside it may answer the same query for a stored octree in place.
//! 2. **Proof.** `walk::Proven` wraps the classifier: FULL and EMPTY verdicts that are not proven become
//!    PARTIAL, so that the answer claims no more than the solid does.
//! 3. **Budget.** A query that splits on demand obeys `control.max_splits`, or a default that is a public
//!    constant, and reports in its answer whether the budget was spent. A query that keeps parts of cells
//!    obeys `control.max_bytes` by `Subject::takes`; the documentation of that field lists these queries.
//! 4. **Walk.** `walk::split_one` splits a cell, `walk::descend` goes depth first, `walk::Queue` best first,
//!    `walk::Subject` counts splits and keeps parts. A long search frees the memory of parts that it no
//!    longer needs (`Subject::is_wasteful`, `keep` with `Queue::change`). Slabs (`Question::Enclosure`) make
//!    an answer better by an order. The module `cut` computes the part of a cell that planes cut off. The
//!    slabs of a host may hold NaN, infinities and contradictions: such a cell counts as unknown.
//! 5. **Job.** `Job` regularly checks for a cancel and reports progress; all shares of the progress add up to
//!    `WHOLE`. `parallel::each` shares out independent work in an order that does not depend on the number of
//!    threads.
//! 6. **Doors.** Export the name below (and at the root of the library, if every user needs it). Add a row to
//!    the table above and to the table of `lib.rs`; a module in `tests/queries` with a dense oracle and a
//!    ball's formula, and its row in `tests/README.md`; a line in the operations of
//!    `tests/memory/failures.rs`; a function in `capi/src` (the recipe stands in its `lib.rs`); a call in the
//!    fuzz target `measures`; an entry in CHANGELOG.md; and a row in `tests/octrees/proof_table.rs` if the
//!    result is a solid.

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
