//! What walks through the cells of a solid: whatever asks a solid for more than one split, to build, to
//! measure or to draw, asks by way of this room.
//!
//! - Every cell in turn: `split` (one cell, or many by several threads), `descent` (depth first), `gathered`
//!   (level by level, kept for a second look).
//! - One place after another: `trail` (the way to a cell, which the next one shares), `edge` (where an edge
//!   crosses the surface), `zone` (where a walk leads at all), `hull` (where the solid lies).
//! - The most promising first: `queue`, and `subject` (the solid in a search that remembers parts).
//! - What may be believed on the way: `proven`.

mod descent;
mod edge;
mod gathered;
mod hull;
mod proven;
mod queue;
mod split;
mod subject;
mod trail;
mod zone;

pub(crate) use descent::{Step, descend};
pub(crate) use edge::Edge;
pub(crate) use gathered::{Gathered, LEVELS};
pub(crate) use hull::hull;
pub(crate) use proven::{Proven, ProvenWorker};
pub(crate) use queue::Queue;
pub(crate) use split::{Part, each, each_known, split_each, split_one};
pub(crate) use subject::Subject;
pub(crate) use trail::Trail;
pub(crate) use zone::Reach;
pub use zone::Zone;
