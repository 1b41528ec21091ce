//! Tri-dexel models.

#[path = "../../fuzz/bodies/dexel_algebra.rs"]
mod dexel_algebra;

mod ends;
mod faces;
mod made_of;
mod models;
mod open;
mod real_meshes;
mod surface;
