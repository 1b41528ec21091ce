//! Triangle meshes as solids.
//!
//! The solid is the set of points with a non-zero winding number (or a positive or an odd one, on request).
//! So overlapping bodies, nested shells and inverted shells have a meaning. Where a mesh is not closed, the
//! winding number is not an integer, and by convention the nearest integer decides.
//!
//! Classification is certified: the cells that a triangle cuts stay PARTIAL, and none is ever missed. Every
//! other cell of a closed mesh lies wholly on one side. The side follows from an exact integer: the winding
//! number of the cell's lowest centre, carried from cell to cell along lines that count the triangles they
//! pierce. For this, caps close an open mesh (`mesh/boundary`). The caps' own winding number is then
//! subtracted, with bounds of its error and its gradient (`winding`, `open`).
//!
//! A single ray, point, box or distance is answered without cells, from a tree over the triangles and from
//! the rim of the mesh's holes (`direct`, `open_trace`).
//!
//! Beyond verdicts, cells provide the moments of the solid within them, the area of the boundary and its
//! slab, from the triangles that cut them (`integral`, `slab`).
//!
//! From the bottom up, each file uses only files named before it: `placed` (vertices on the lattice),
//! `crossing` (where lines of centres pierce triangles), `overlap` (which cells a triangle cuts), `rim`
//! (winding numbers of caps from the boundary's edges alone), `rim_line` (the same along a line), `terms`
//! (contributions of caps and edges to sums), `winding` (the caps' winding number), `reach` (how far an open
//! surface's solid may reach), `scan` (blocks of 64³ cells), `chords` (rays through centres), `on_frame` (a
//! mesh on a frame, and the state of a cell), `local` (triangles in a cell's coordinates), `base` (a point of
//! known winding number), `fronts` (on which sides of triangles the solid lies), `integral` (moments and
//! areas), `slab` (enclosures), `layers` (functions of planes with a width), `segment` (crossings), `direct`
//! (rays, points and distances without cells), `open_trace` (rays of an open surface without cells), `open`
//! (cells of an open surface), `open_rays` (rays through it), `mesh_solid` (the solid, its classifier and its
//! workers), `parity` (rays that pierce an open mesh an odd number of times).

mod base;
mod chords;
mod crossing;
mod direct;
mod fronts;
mod integral;
mod layers;
mod local;
mod mesh_solid;
mod on_frame;
mod open;
mod open_rays;
mod open_trace;
mod overlap;
mod parity;
mod placed;
mod reach;
mod rim;
mod rim_line;
mod scan;
mod segment;
mod slab;
mod terms;
mod winding;

pub use mesh_solid::MeshSolid;
