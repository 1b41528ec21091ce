//! Stored octrees: what builds them, their laws, their Booleans, their channels and voxel records, and what
//! they prove.

#[path = "../../fuzz/bodies/aligned.rs"]
mod aligned;
#[path = "../common/mod.rs"]
mod common;

mod adaptive;
mod bitmap;
mod boolean;
mod build;
mod channel_queries;
mod channels;
mod corpus;
mod lazy;
mod neighbours;
mod proof;
mod proof_table;
mod shards;
mod voxels;
