//! Tri-dexel models.

mod ends;
mod faces;
mod made_of;
mod models;
mod open;
mod real_meshes;
mod surface;
