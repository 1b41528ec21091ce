//! The leaf-free octree: two bits a cell, internal nodes only, in dense arrays.
//!
//! [`OctreeRef`] explains how a solid is stored and does all reading; [`Octree`] owns or shares the arrays;
//! the writer (crate-internal) is the one place where trees come into being; [`Cursor`] walks the octree node
//! by node as if it were stored that way.

pub(crate) mod block;
pub(crate) mod brick;
mod check;
mod cursor;
pub(crate) mod dictionary;
pub(crate) mod links;
pub(crate) mod metadata;
#[allow(clippy::module_inception)]
pub(crate) mod octree;
mod proof;
pub(crate) mod stats;
mod tag;
pub(crate) mod view;
pub(crate) mod word;
pub(crate) mod writer;

pub use block::Block;
pub use cursor::{Cursor, Node};
pub use metadata::Metadata;
pub use octree::Octree;
pub use proof::Proof;
pub use stats::{LevelStatistics, Statistics};
pub use tag::Tag;
pub use view::OctreeRef;
pub use word::Planes;
