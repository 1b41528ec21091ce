//! What makes octrees: building from a solid, splitting on demand, and the set algebra of stored trees.

mod boolean;
mod build;
mod lazy;

pub use boolean::{complement, difference, intersection, intersection_of, union, union_of, xor, xor_of};
pub use build::{build, compact, resolve};
pub use lazy::{LazyOctree, Refined, Zone};
