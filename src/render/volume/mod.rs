//! Voxels as a translucent volume: cells are projected in their order along the view.

mod coordinates;
mod layer;
mod light_path;
mod sides;
#[cfg(test)]
mod tests;
mod voxel;
mod walk;

pub use layer::{Compositing, VolumeLayer};
