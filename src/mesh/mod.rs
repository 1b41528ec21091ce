//! Triangle meshes as data: welding, how triangles hang together, what is wrong with them and how much of
//! that can be mended; solids of plane faces, which become meshes.
//!
//! Nothing here knows of cells. What the surface encloses, and how a cell of it is split, is `solid/mesh/`.
//!
//! From the bottom up, each file uses only files named before it: `positions` (equal vertices), `topology`
//! (edges and bodies), `boundary` (loops of edges), `signs` (exact determinants), `surface` (the mesh); on the
//! mesh `normals`, `weld`, `sew`, `placement`, `defects`, `overlap` and `report`; `tree` (boxes around triangles),
//! `intersections`, `sheets` (winding numbers on both sides), `sides` (the same, triangle by triangle) and `moments`
//! (volume and inertia); `polygon` (triangulation) and `polyhedron`.

mod boundary;
mod defects;
mod intersections;
mod moments;
mod normals;
mod overlap;
mod placement;
#[cfg(feature = "std")]
mod polygon;
#[cfg(feature = "std")]
mod polyhedron;
mod positions;
mod report;
mod sew;
mod sheets;
mod sides;
mod signs;
mod surface;
mod topology;
mod tree;
mod turned;
mod weld;

pub(crate) use boundary::Loops;
pub use defects::{DefectKind, MeshDefect};
pub use intersections::{IntersectingPair, IntersectingPairs};
pub use moments::MeshMoments;
#[cfg(feature = "std")]
pub(crate) use polygon::flatness;
#[cfg(feature = "std")]
pub(crate) use polygon::triangulate_facet;
#[cfg(feature = "std")]
pub use polyhedron::{Polyhedron, PolyhedronArrays};
pub use report::MeshReport;
pub(crate) use sides::Sides;
#[cfg(feature = "std")]
pub(crate) use surface::Faces;
pub use surface::{FillRule, TriangleMesh};
pub(crate) use weld::FacetWelder;
