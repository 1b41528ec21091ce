//! Surfaces: closed triangle meshes of solids.
//!
//! A surface separates *samples* that lie inside from those that lie outside. The samples of an octree are
//! the centres of its finest cells. Everything around the universe is outside.
//!
//! All methods share one walk. It finds the blocks of 4³ samples that the surface crosses, with their samples
//! as 64-bit words, so the cost of extraction is proportional to the size of the surface. The vertices of a
//! block have consecutive numbers, and the number of a vertex is found by counting bits. Everything is
//! counted before memory is allocated.
//!
//! From the bottom up, each file uses only files named before it: `table` (marching cubes, cell by cell),
//! `masks` (blocks as words), `key` (the order of blocks), `samples` (an octree as samples), `size` (lower
//! bounds of a surface's size), `blocks` (the walk), `lattice` (the places of samples), `chunks` (threads),
//! `resolve` (undecided cells), `cubes` (marching cubes), `snapped` and `simple` (simple marching cubes),
//! `plane`, `points`, `bon` (merging coplanar cells), `outline` (regions), `sweep` (their triangles),
//! `published` (cells of several sizes without mending), `shrink` (coplanar shrink), `weld` (merging equal
//! vertices), `solid` (any solid), `volume` (samples of a field), `loops` (the sheets in a cube), `qef` (the
//! point that fits planes best), `hermite` (crossings with normals, also from rays), `vanished` (bodies
//! without triangles), `dual` (dual contouring), `nets` (surface nets), `dexel` (tri-dexel models),
//! `dexel_solid` (tri-dexel models as solids).
//!
//! `boundary` takes another approach: if a solid provides its surfaces, they are cut to the pieces that bound
//! it, and nothing is sampled. `contour` is dual contouring with cells of several sizes, for any solid.
//! `simplify` removes vertices from meshes.
//!
//! Solids that are not octrees are sampled at the corners of the lattice, as an octree whose cells have these
//! corners as centres.

mod blocks;
mod bon;
#[cfg(feature = "std")]
mod boundary;
mod chunks;
#[cfg(feature = "std")]
mod contour;
mod cubes;
mod dexel;
mod dexel_solid;
mod dual;
mod hermite;
mod key;
mod lattice;
mod loops;
mod masks;
mod nets;
mod outline;
mod plane;
mod points;
mod published;
mod qef;
mod resolve;
mod samples;
mod shrink;
mod simple;
#[cfg(feature = "std")]
mod simplify;
mod size;
mod snapped;
mod solid;
mod sweep;
mod table;
#[cfg(test)]
mod tests;
mod vanished;
mod volume;
mod weld;

#[cfg(feature = "std")]
pub use boundary::{Boundary, BoundaryFaces, BoundaryRegion, BoundaryReport, boundary};
#[cfg(feature = "std")]
pub use contour::{Contour, ContourReport, contour};
pub use cubes::{marching_cubes, marching_cubes_in, marching_cubes_reusing};
pub use dexel::{DexelSurfaceReport, dual_contouring_dexels, dual_contouring_solid, marching_cubes_dexels};
pub use dexel_solid::DexelSolid;
pub use nets::surface_nets;
pub use resolve::Resolve;
pub use shrink::{coplanar_shrink, published_shrink};
pub use simple::{Snap, simple_marching_cubes};
#[cfg(feature = "std")]
pub use simplify::{Simplified, SimplifiedReport, simplify};
pub use solid::{
    VertexPlacement, coplanar_shrink_solid, marching_cubes_solid, published_shrink_solid,
    simple_marching_cubes_solid,
};
pub use volume::{marching_cubes_volume, marching_cubes_with_volume};
