//! Pictures.

#[cfg(feature = "png")]
mod gear;
mod mesh_solid;
mod raster;
mod surface;
mod volume;
