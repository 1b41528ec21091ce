//! Walks through the cells of a solid. Every algorithm that needs more than one split, to build, to measure
//! or to draw, uses this module.
//!
//! - Every cell in turn: `split` (one cell, or many by several threads), `descent` (depth first), `gathered`
//!   (level by level, kept for a second pass).
//! - One place after another: `trail` (the path to a cell, which the next cell shares), `edge` (the crossing
//!   of an edge with the surface), `zone` (the region of a walk), `hull` (the box of the solid).
//! - The most promising cell first: `queue`, and `subject` (the solid in a search that keeps parts).
//! - Trust in verdicts: `proven`.

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
