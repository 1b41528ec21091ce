//! The leaf-free octree: two bits a cell, internal nodes only, in dense arrays.
//!
//! [`OctreeRef`] describes the storage of a solid, and does all reading. [`Octree`] owns or shares the
//! arrays. The writer (crate-internal) is the one place where trees are made. [`Cursor`] walks the octree
//! node by node as if it were stored that way.

mod arrays;
pub(crate) mod block;
pub(crate) mod brick;
mod cells;
pub(crate) mod channel;
mod check;
mod cursor;
pub(crate) mod cuts;
pub(crate) mod dictionary;
mod direction;
mod extended;
mod faces;
pub(crate) mod links;
pub(crate) mod metadata;
mod neighbour;
#[allow(clippy::module_inception)]
pub(crate) mod octree;
mod open_cells;
mod path;
mod proof;
mod shard_statistics;
pub(crate) mod stats;
mod tag;
pub(crate) mod view;
pub(crate) mod word;
pub(crate) mod writer;

pub use block::Block;
pub use cells::{CellFilter, Cells, TaggedCell};
pub(crate) use channel::{Channel, ChannelRef, ScalarType, ValueType};
pub use cursor::{Cursor, Node};
pub use cuts::{CellFunction, CutCounts, StoredSurface, SurfaceKind};
pub use direction::Direction;
pub use faces::{BoundaryFace, BoundaryFaces};
pub use metadata::{Metadata, MetadataLimit};
pub use octree::Octree;
pub use proof::Proof;
pub use stats::{LevelStatistics, Statistics};
pub use tag::Tag;
pub use view::OctreeRef;
pub use word::Planes;
