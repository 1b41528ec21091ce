//! Octrees whose PARTIAL cells keep the surfaces that cross them.
//!
//! - `build`: from any solid.
//! - `combine`: the set algebra of stored trees, where one of them keeps surfaces.
//! - `element`: how cells become elements, from the finest up; both do it in the same way.
//! - `function`: the functions of few surfaces that cells end with.
//! - `joint`: the surfaces of several trees, each once.

mod build;
mod combine;
mod element;
mod function;
mod joint;

pub use build::{SurfaceOptions, build_extended, build_extended_shard, plain};
pub(super) use combine::{Combination, combine, combine_cells};
