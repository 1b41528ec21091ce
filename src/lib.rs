//! Leafless is a solid-modelling kernel. It builds solids as octrees with certified cells, combines them by
//! exact Booleans, and answers queries about points, rays, volumes and distances.
//!
//! A [`Solid`] is a shape: a primitive or a set operation of primitives ([`Csg`]), a triangle mesh
//! ([`MeshSolid`]), a volume of samples ([`Volume`]), a stored octree, or a callback of the host program
//! ([`Callback`]). A [`Frame`] is a cube in model space, divided into 2^depth cells per axis. [`build`] turns
//! a solid on a frame into an [`Octree`], whose cells are FULL, EMPTY or PARTIAL (undecided). The octree
//! stores no leaves. Its dense arrays are also its file, which is mapped and queried in place.
//!
//! ```
//! use leafless::{Control, Csg, Frame, Membership, Rule, build, difference};
//!
//! let frame = Frame::new([-1.0; 3], 2.0, 8)?; // the cube [-1, 1]³, 256 cells per axis
//! let control = Control::default();
//! let block = build(&Csg::cuboid([-0.75; 3], [0.75; 3])?, &frame, Rule::Certified, &control)?;
//! let ball = build(&Csg::ball([0.0; 3], 0.9)?, &frame, Rule::Certified, &control)?;
//! let part = difference(block.view(), ball.view(), &control)?;
//!
//! assert_eq!(part.contains([0.0, 0.0, 0.0]), Membership::Outside);
//! assert_eq!(part.contains([0.74, 0.74, 0.74]), Membership::Inside);
//! let volume = part.statistics().volume();
//! assert!(volume.lower < 0.68186 && 0.68188 < volume.upper);
//! # Ok::<(), leafless::Error>(())
//! ```
//!
//! # First steps
//!
//! | task | where |
//! |---|---|
//! | describe a shape | [`Csg`], [`MeshSolid`], [`Volume`], [`Callback`], or the trait [`Solid`] |
//! | choose the cube and the cell size | [`Frame`] |
//! | build an octree, or split cells on demand | [`build`], [`LazyOctree`] |
//! | keep exact surfaces in the cells | [`build_extended`] |
//! | combine octrees | [`union`], [`intersection`], [`difference`], [`xor`], [`complement`] |
//! | classify points, cast rays | [`contains`], [`cast_rays`] |
//! | compute volume, mass properties, a bounding box | [`measure`], [`bounding_box`] |
//! | compare two solids | [`interference`], [`clearance`], [`deviation`] |
//! | extract a triangle mesh | [`marching_cubes`] and the module [`surface`] |
//! | read and write Leafless files | the module [`file`](mod@file) |
//! | read and write STL, OBJ, PLY, OFF, 3MF and volumes | the module [`exchange`] |
//! | limit threads, memory or work; cancel; watch progress | [`Control`] |
//!
//! # Three principles
//!
//! 1. **A solid is anything that can split a cell.** Every shape implements [`Solid`]. An algorithm puts the
//!    shape on a frame ([`Solid::on`]) and then only calls [`Worker::split`], which divides an undecided cell
//!    into eight classified children.
//! 2. **Results are certified.** Inner bound ⊆ true solid ⊆ outer bound: a FULL cell is proven to lie inside,
//!    an EMPTY cell is proven to lie outside, and an undecided cell stays PARTIAL through every operation.
//!    A volume is therefore an interval that contains the true volume. ([`Rule`] has other ways to build, for
//!    a plain yes or no. The answers are then about the octree, and no longer about the shape.) [`Proof`]
//!    records what the cells of an octree prove. Every operation passes it on, and files store it.
//! 3. **Booleans are closed and exact.** On one lattice they are exact set algebra, and their results are
//!    canonical: the same bits for any number of threads, on any platform.
//!
//! # Modules
//!
//! The most used items are at the root of the crate; all others are in the module of their topic. A function
//! whose name ends with `_of` takes any number of operands.
//!
//! The modules from the bottom up; no module uses a module below it in this table:
//!
//! | module | contents |
//! |---|---|
//! | `lattice` | cells, cubes and frames: integer coordinates and model space |
//! | `cut` | cubes cut by planes and curved surfaces: slabs, moments, areas |
//! | `octree` | tags, the word algebra, views, the writer, checks, statistics |
//! | `mesh` | triangle meshes as data: welding, topology, defects, repair |
//! | `dexel` | intervals along the rays of a lattice |
//! | `solid` | solids: one file or folder for each kind |
//! | `walk` | traversals of the cells of a solid, used by the modules that follow |
//! | `op` | building, splitting on demand, and the set algebra of stored octrees |
//! | `query` | points, boxes and rays, measures, interference |
//! | `layout` | placements of solids in a container |
//! | `attribute` | values at points inside or outside of solids |
//! | `voxel` | voxels as records, sorted by code |
//! | `surface` | triangle meshes of solids |
//! | `file` | the Leafless file format |
//! | `exchange` | file formats of other programs |
//! | `render` | pictures of solids, meshes and volumes, and their PNG files |
//! | `scene` | the language of OpenSCAD's CSG dumps |
//!
//! All of them may use `error`, `memory` (fallible allocation), `parallel` (work shared between threads),
//! `control` (limits and cancelling) and `dispatch` (run-time choice of instructions). The C interface and
//! the command-line program are packages of their own, `capi` and `cli`.
//!
//! # Finding your way in the sources
//!
//! | topic | file |
//! |---|---|
//! | the one operation that every solid provides | `solid/mod.rs` |
//! | spheres, prisms, tori | `solid/csg/primitive.rs`, `faceted.rs`; `solid/half_space/torus.rs` |
//! | the exact sign of a polynomial | `lattice/exact/` |
//! | the winding number of an open mesh | `solid/mesh/winding.rs` |
//! | finding holes in a mesh, closing cracks | `mesh/defects.rs`, `mesh/sew.rs` |
//! | the union of two stored octrees | `op/boolean.rs`; of octrees that keep surfaces: `op/extended/combine.rs` |
//! | finding a child of an element | `octree/links.rs` |
//! | neighbours of a cell, all cells of a tag, faces between cells | `octree/neighbour.rs`, `cells.rs`, `faces.rs` |
//! | what the cells prove | `octree/proof.rs` |
//! | reading an STL | `exchange/stl.rs` |
//! | a bitmap or samples as a solid; an octree as a bitmap | `solid/volume/`, `query/bitmap.rs` |
//! | checking the bytes of a file | `file/header.rs`, `object.rs`, `section.rs`, `layout.rs`, `tree.rs`, `tridexel.rs` |
//! | refusing an allocation | `memory.rs` |
//! | rays that meet a solid, height maps | `query/ray/`, `query/columns/` |
//! | rays through a mesh, through a half-space | `solid/mesh/chords.rs`, `solid/half_space/lines.rs` |
//! | a closed triangle mesh of a solid | `surface/cubes.rs`, `simple.rs`, `shrink.rs`, `solid.rs`, `volume.rs`, `dexel.rs` |
//! | plane faces as polygons, the kind of a surface and its radius | `surface/boundary/regions.rs`, `solid/half_space/shape.rs` |
//! | a mesh that survives the rounding of STL | `mesh/single.rs` |
//! | pictures: tiles, triangles, plane sections, volumes, legends | `render/tile.rs`, `coverage.rs`, `slice.rs`, `volume/`, `legend.rs` |
//! | surface normals where only cells are stored | `render/normals.rs` |
//! | the list of voxels, their depth order | `voxel/walk.rs`, `records.rs`, `order.rs` |
//! | the volume of a solid, the distance of two solids, the distance of a point | `query/measure/`, `query/clearance/`, `query/distance/` |
//! | how far two boundaries deviate from each other | `query/deviation/` |
//! | the area of a plane section | `query/section.rs`, `cut/section.rs` |

#![no_std]
#![deny(unsafe_code)]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

pub mod attribute;
mod control;
mod cut;
pub mod dexel;
mod dispatch;
pub mod error;
pub mod exchange;
pub mod file;
pub mod lattice;
pub mod layout;
#[cfg(feature = "std")]
mod lock;
#[doc(hidden)]
pub mod memory;
pub mod mesh;
pub mod octree;
pub mod op;
mod parallel;
pub mod query;
#[cfg(feature = "render")]
pub mod render;
#[cfg(feature = "scene")]
pub mod scene;
pub mod solid;
pub mod surface;
pub mod voxel;
mod walk;

// The most used items. All others are in the module of their topic.
pub use control::Control;
pub use dexel::TriDexel;
pub use error::Error;
pub use lattice::{Affine, Bounds, Cell, Frame, Interval, Shard};
pub use mesh::{FillRule, TriangleMesh};
pub use octree::{Metadata, Octree, OctreeRef, Proof, Tag};
pub use op::{
    LazyOctree, Rule, SurfaceOptions, build, build_extended, build_shard, compact, complement, dexelize,
    difference, intersection, union, xor,
};
pub use query::{
    Clearance, Deviation, Interference, MassProperties, Membership, Ray, Tolerance, bounding_box, cast_rays,
    clearance, contains, deviation, interference, measure,
};
pub use solid::{AnySolid, Callback, Classifier, Csg, MeshSolid, Solid, Verdict, Volume, Worker};
pub use surface::marching_cubes;

/// The examples of the README and of the guide, which are compiled and run.
#[cfg(all(doctest, feature = "mmap"))]
mod guide {
    #[doc = include_str!("../README.md")]
    pub struct Readme;
    #[doc = include_str!("../docs/questions/section.md")]
    pub struct Section;
    #[doc = include_str!("../docs/cells.md")]
    pub struct Cells;
    #[doc = include_str!("../docs/meshes-in.md")]
    pub struct MeshesIn;
    #[doc = include_str!("../docs/half-spaces.md")]
    pub struct HalfSpaces;
    #[doc = include_str!("../docs/meshes-out.md")]
    pub struct MeshesOut;
    #[doc = include_str!("../docs/files.md")]
    pub struct Files;
    #[doc = include_str!("../docs/rust.md")]
    pub struct Rust;
    #[doc = include_str!("../docs/own-solid.md")]
    pub struct OwnSolid;
    #[doc = include_str!("../docs/own-query.md")]
    pub struct OwnQuery;
}
