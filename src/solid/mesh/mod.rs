//! Triangle meshes as solids.
//!
//! The truth for a closed mesh is the set of points with a non-zero winding number (or an odd one, on
//! request), so that overlapping bodies, nested shells and shells turned inside out have a meaning.
//!
//! Classification is certified: the cells that a triangle cuts stay PARTIAL and none is ever missed, every
//! other cell is wholly on one side, and which side is an exact integer, the winding number of its lowest
//! centre, carried from cell to cell along lines that count the triangles they pierce.

mod boundary;
mod crossing;
mod defects;
mod open;
mod overlap;
mod placed;
#[cfg(feature = "std")]
mod polygon;
#[cfg(feature = "std")]
mod polyhedron;
mod report;
mod scan;
mod sew;
mod split;
mod surface;
mod topology;
mod weld;
mod winding;

pub use defects::{DefectKind, MeshDefect};
#[cfg(feature = "std")]
pub(crate) use polygon::triangulate_facet;
#[cfg(feature = "std")]
pub use polyhedron::{Polyhedron, PolyhedronArrays};
pub use report::MeshReport;
pub use split::{MeshPart, MeshScratch, MeshSolid};
pub use surface::{FillRule, TriangleMesh};
pub(crate) use weld::FacetWelder;
