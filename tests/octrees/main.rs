//! Stored octrees: their construction, laws, Booleans, channels, voxel records and proofs.

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
mod values;
mod voxels;
