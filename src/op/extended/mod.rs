//! Octrees whose PARTIAL cells keep the surfaces that cross them.
//!
//! - `build`: building from any solid.
//! - `combine`: set operations of stored trees, where one of them keeps surfaces.
//! - `element`: building elements from cells, from the finest up; shared by `build` and `combine`.
//! - `function`: the functions of few surfaces with which cells end.
//! - `joint`: the surfaces of several trees, each once.

mod build;
mod combine;
mod element;
mod function;
mod joint;

pub use build::{SurfaceOptions, build_extended, build_extended_shard, plain};
pub(super) use combine::{Combination, combine, combine_cells};
