//! Results from sources: octrees, tri-dexel models, surfaces, pictures.
//!
//! A subcommand describes its task in a `job`; each file here makes one kind of result. Nothing here depends
//! on the arguments of a subcommand, so several subcommands can share it.

pub mod askew;
pub mod bearing;
pub mod boolean;
pub mod clipped;
pub mod combined_surface;
pub mod dexel_surface;
pub mod dexels;
pub mod faces;
pub mod job;
pub mod laid;
pub mod laid_picture;
pub mod like;
pub mod moved;
pub mod octree_from_dexels;
pub mod octree_of_dexel_surface;
pub mod octree_of_mesh;
pub mod octree_of_scene;
pub mod octree_of_volume;
pub mod operand;
pub mod operands;
pub mod part;
pub mod picture;
pub mod plain;
pub mod surface;
pub mod surfaces;
