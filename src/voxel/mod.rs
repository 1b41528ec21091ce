//! Voxel records: the list of a solid's voxels, sorted by linear octree code (Zhu, Tang and Dong 2002).
//!
//! A record consists of the kind of a voxel (outside, inside, boundary), its cell, and the value of an
//! attribute in it. The cells of a record list have any sizes: inside voxels follow an attribute, boundary
//! voxels have a level of their own. [`Voxels`] produces records one by one, [`VoxelRecords`] keeps them in
//! arrays.
//!
//! The voxels of a tri-dexel model, which lie between its rays, are rows along y instead ([`DexelVoxels`]).

mod code;
mod descent;
mod dexel;
mod fraction;
mod import;
mod moved;
mod options;
mod order;
mod record;
mod records;
mod symmetry;
mod touch;
mod transform;
mod triangles;
mod uniform;
mod walk;

pub use code::LinearCode;
pub use dexel::{DexelVoxels, LongVoxel, dexel_voxels};
pub use import::VoxelSolid;
pub use options::{VoxelBoundary, VoxelOptions};
pub use order::Viewpoint;
pub use record::{VoxelKind, VoxelRecord};
pub use records::{VoxelRecords, VoxelRecordsRef};
pub use symmetry::Symmetry;
pub use triangles::VoxelTriangles;
pub use walk::Voxels;
