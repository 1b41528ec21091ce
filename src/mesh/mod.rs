//! Triangle meshes as data: welding, connectivity, defects and their repair. Also solids of plane faces,
//! which become meshes.
//!
//! This module does not use cells. `solid/mesh/` classifies points against a mesh and splits cells.
//!
//! From the bottom up, each file uses only files named before it: `positions` (equal vertices), `attributes`
//! (data on triangles), `topology` (edges and bodies), `boundary` (loops of edges), `signs` (exact
//! determinants), `surface` (the mesh); on the mesh `normals`, `weld`, `sew`, `placement`, `defects`,
//! `overlap` and `report`; `tree` (boxes around triangles), `nearest`, `self_pairs` (pairs whose boxes meet),
//! `intersections`, `triangle_pair`, `discs` and `apart` (the distance of two meshes), `planes` (planes of
//! triangles), `sheets` (winding numbers on both sides), `sides` (the same, triangle by triangle), `pieces`
//! (of triangles that intersect others), `moments` (volume and inertia), `links` (edge collapses and flips)
//! and `single` (single precision); `polygon` (triangulation), `shells` (nesting), `polyhedron` and its
//! `faces`.

mod apart;
mod attributes;
mod body;
mod boundary;
mod defects;
mod discs;
#[cfg(feature = "std")]
mod faces;
mod history;
mod in_box;
mod intersections;
mod links;
mod moments;
mod nearest;
mod normals;
mod overlap;
mod pieces;
mod pierce;
mod placement;
mod planes;
#[cfg(feature = "std")]
pub(crate) mod polygon;
#[cfg(feature = "std")]
mod polyhedron;
mod positions;
mod report;
mod self_pairs;
mod sew;
mod sheets;
#[cfg(feature = "std")]
mod shells;
mod sides;
mod signs;
mod single;
mod topology;
mod tree;
mod triangle_mesh;
mod triangle_pair;
mod turned;
mod weld;

pub(crate) use apart::{Apart, Enough, Facets, MeshPair, NearTriangles};
pub use attributes::{AttributeDomain, MeshAttribute};
pub(crate) use boundary::Loops;
pub use defects::{DefectKind, MeshDefect};
pub(crate) use discs::Discs;
#[cfg(feature = "std")]
pub use faces::PolyhedronPart;
pub use history::MeshHistory;
pub use intersections::{IntersectingPair, IntersectingPairs};
pub use moments::MeshMoments;
pub(crate) use nearest::{NearVisitor, NearestPoint, TriangleTree};
pub(crate) use pieces::Pieces;
pub(crate) use pierce::{Hit, Shift, Wanted};
pub(crate) use planes::{FacetPlane, FacetPlanes};
#[cfg(feature = "std")]
pub(crate) use polygon::flatness;
#[cfg(feature = "std")]
pub(crate) use polygon::triangulate_facet;
#[cfg(feature = "std")]
pub(crate) use polyhedron::PLANE;
#[cfg(feature = "std")]
pub use polyhedron::{Polyhedron, PolyhedronArrays};
pub use report::MeshReport;
#[cfg(feature = "std")]
pub(crate) use shells::{Extent, outside, volume};
pub(crate) use sides::Sides;
pub use single::SinglePrecision;
#[cfg(feature = "std")]
pub(crate) use topology::DisjointSets;
#[cfg(feature = "render")]
pub(crate) use topology::{Edge, for_each_edge};
#[cfg(feature = "std")]
pub(crate) use triangle_mesh::Faces;
pub use triangle_mesh::{FillRule, TriangleMesh};
pub(crate) use weld::FacetWelder;
