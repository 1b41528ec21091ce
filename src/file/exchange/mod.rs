//! Formats of other programs.

mod any;
mod bytes;
mod decimal;
mod detect;
mod obj;
mod off;
mod ply;
mod polygons;
mod stl;
#[cfg(test)]
mod tests;
mod text;
#[cfg(feature = "threemf")]
mod threemf;
mod unit;

#[cfg(feature = "std")]
pub use any::open_mesh;
pub use any::{MeshFile, MeshFormat, MeshOptions, read_mesh};
pub use obj::read_obj;
pub use off::read_off;
pub use ply::read_ply;
pub use stl::{read_stl, write_stl};
pub use unit::LengthUnit;
