//! Formats of other programs.
//!
//! Formats of polygons are read only with the feature `std`, which cutting polygons into triangles needs.

mod any;
#[cfg(feature = "std")]
mod bytes;
#[cfg(feature = "std")]
mod decimal;
mod detect;
#[cfg(feature = "std")]
mod obj;
#[cfg(feature = "std")]
mod off;
#[cfg(feature = "std")]
mod ply;
#[cfg(feature = "std")]
mod polygons;
mod stl;
#[cfg(all(test, feature = "std"))]
mod tests;
#[cfg(feature = "std")]
mod text;
#[cfg(feature = "threemf")]
mod threemf;
mod unit;

#[cfg(feature = "std")]
pub use any::open_mesh;
pub use any::{MeshFile, MeshFormat, MeshOptions, read_mesh};
#[cfg(feature = "std")]
pub use obj::read_obj;
#[cfg(feature = "std")]
pub use off::read_off;
#[cfg(feature = "std")]
pub use ply::read_ply;
#[cfg(feature = "scene")]
pub(super) use polygons::Polygons;
pub use stl::{read_stl, write_stl};
pub use unit::LengthUnit;
