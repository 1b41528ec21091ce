//! Triangle meshes as data: welding, how triangles hang together, what is wrong with them and how much of
//! that can be mended; solids of plane faces, which become meshes.
//!
//! Nothing here knows of cells. What the surface encloses, and how a cell of it is split, is `solid/mesh/`.
//!
//! From the bottom up, each file uses only files named before it: `positions` (equal vertices), `topology`
//! (edges and bodies), `boundary` (loops of edges), `surface` (the mesh); on the mesh `weld`, `sew`,
//! `placement`, `defects`, `overlap` and `report`; `polygon` (triangulation) and `polyhedron`.

mod boundary;
mod defects;
mod overlap;
mod placement;
#[cfg(feature = "std")]
mod polygon;
#[cfg(feature = "std")]
mod polyhedron;
mod positions;
mod report;
mod sew;
mod surface;
mod topology;
mod turned;
mod weld;

pub(crate) use boundary::Loops;
pub use defects::{DefectKind, MeshDefect};
#[cfg(feature = "std")]
pub(crate) use polygon::flatness;
#[cfg(feature = "std")]
pub(crate) use polygon::triangulate_facet;
#[cfg(feature = "std")]
pub use polyhedron::{Polyhedron, PolyhedronArrays};
pub use report::MeshReport;
#[cfg(feature = "std")]
pub(crate) use surface::Faces;
pub use surface::{FillRule, TriangleMesh};
pub(crate) use weld::FacetWelder;
