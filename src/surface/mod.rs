//! Surfaces: closed triangle meshes of solids.
//!
//! A surface separates *samples* that lie inside from those that lie outside. The samples of an octree are
//! its finest cells, at their centres. Around the universe everything is outside.
//!
//! All methods share one walk, which finds the blocks of 4³ samples that the surface passes through, with
//! their samples as 64-bit words; so extraction costs as much as there is surface. The vertices of a block
//! have consecutive numbers, and the number of one is found by counting bits. Everything is counted before
//! memory is asked for.
//!
//! From the bottom up, each file uses only files named before it: `table` (marching cubes, cell by cell),
//! `masks` (blocks as words), `key` (the order of blocks), `samples` (an octree as samples), `size` (what is
//! known of a surface beforehand), `blocks` (the walk), `lattice` (where samples lie), `chunks` (threads),
//! `resolve` (undecided cells), `cubes` (marching cubes), `snapped` and `simple` (simple marching cubes),
//! `plane`, `points`, `bon` (coplanar cells merged), `outline` (regions), `sweep` (their triangles),
//! `published` (cells of several sizes as they are), `shrink` (coplanar shrink), `weld` (vertices at one
//! place), `solid` (any solid), `volume` (samples of a field), `loops` (the sheets in a cube), `qef` (the
//! point that fits planes best), `hermite` (crossings with normals, and how rays tell them), `vanished`
//! (bodies without triangles), `dual` (dual contouring), `nets` (surface nets), `dexel` (tri-dexel models),
//! `dexel_solid` (these as solids).
//!
//! `boundary` goes another way: where a solid knows its surfaces, these are cut to the pieces that bound it,
//! and nothing is sampled. `contour` is dual contouring with cells of several sizes, of any solid. `simplify`
//! takes vertices out of meshes.
//!
//! Solids that are no octrees are sampled at the corners of the lattice, as an octree whose cells have these
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
