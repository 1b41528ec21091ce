//! The subcommands, one in each file: their arguments and their tasks.

pub mod attribute;
pub mod bitmap;
pub mod boolean;
pub mod contains;
pub mod convert;
pub mod csg;
pub mod demo;
pub mod deviation;
pub mod dexelize;
pub mod distance;
pub mod heights;
pub mod info;
pub mod interfere;
pub mod layout;
pub mod measure;
pub mod mesh;
pub mod neighbours;
mod poses;
pub mod ray;
pub mod render;
pub mod sample;
pub mod summary;
pub mod verify;
pub mod voxelize;
pub mod voxels;
pub mod within;
