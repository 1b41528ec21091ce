//! Voxels as a translucent volume: cells are projected in the order in which they are seen.

mod coordinates;
mod layer;
mod light_path;
mod sides;
#[cfg(test)]
mod tests;
mod voxel;
mod walk;

pub use layer::{Compositing, VolumeLayer};
