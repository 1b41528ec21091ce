//! Octrees and tri-dexel models from solids: building, splitting on demand, and the set algebra of stored
//! trees.

mod boolean;
mod build;
mod dexel_centres;
mod dexel_edit;
mod dexel_ends;
mod dexelize;
mod extended;
mod lazy;
mod rule;
mod shards;

pub use crate::walk::Zone;
pub use boolean::{
    complement, difference, difference_of, intersection, intersection_of, union, union_of, xor, xor_of,
};
pub(crate) use build::build_on;
pub use build::{build, build_shard, compact, resolve};
pub use dexel_centres::octree_from_dexels;
pub use dexel_ends::octree_from_dexel_ends;
pub use dexelize::{DexelOptions, dexelize};
pub use extended::{SurfaceOptions, build_extended, build_extended_shard, plain};
pub use lazy::{LazyOctree, Refinement};
pub use rule::Rule;
pub use shards::{join, shard};
