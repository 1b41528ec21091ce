//! What makes octrees: building from a solid, splitting on demand, and the set algebra of stored trees.

mod boolean;
mod build;
pub(crate) mod gathered;
mod lazy;
mod rule;

pub use boolean::{complement, difference, intersection, intersection_of, union, union_of, xor, xor_of};
use build::build_on;
pub use build::{build, compact, resolve};
pub(crate) use gathered::split_one;
pub(crate) use lazy::Trail;
pub use lazy::{LazyOctree, Refinement, Zone};
pub use rule::Rule;
