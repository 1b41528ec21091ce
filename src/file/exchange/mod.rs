//! Formats of other programs.

mod any;
mod detect;
mod stl;
#[cfg(feature = "threemf")]
mod threemf;
mod unit;

#[cfg(feature = "std")]
pub use any::open_mesh;
pub use any::{MeshFile, MeshFormat, MeshOptions, read_mesh};
pub use stl::{read_stl, write_stl};
pub use unit::LengthUnit;
