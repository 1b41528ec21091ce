//! Leafless is a solid-modelling kernel. A solid is an octree **without leaves**, in dense arrays that are
//! also its file: mapped, and queried in place.
//!
//! Three ideas carry everything:
//!
//! 1. **A solid is what can split a cell.** Primitives, triangle meshes, stored octrees and a host program's
//!    callback are all a [`Solid`]; whatever wants a shape puts it on a frame ([`Solid::on`]) and only calls
//!    [`Worker::split`].
//! 2. **Certified.** inner ⊆ true ⊆ outer: a FULL cell is proven inside, an EMPTY one proven outside, and
//!    doubt stays PARTIAL through every operation. So a volume is an interval that contains the truth.
//!    (Whoever wants a plain yes or no builds by another [`Rule`], and then the answers are about the tree,
//!    not the shape.)
//! 3. **Closed and exact.** On one lattice the Booleans are exact set algebra, and their results canonical:
//!    the same bits for any number of threads on any platform.
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
//! What the cells of an octree prove travels with it ([`Proof`]), through every operation and in its file.
//!
//! What everyone uses stands at the root; everything else is in the module of its topic. A name that ends
//! with `_of` is about any number of operands.
//!
//! The modules from the bottom up; none uses one above it:
//!
//! | module | what it holds |
//! |---|---|
//! | `lattice` | cells, cubes, frames: integers and model space |
//! | `cut` | cubes that planes and curved surfaces cut: slabs, moments, areas |
//! | `octree` | tags, the word algebra, views, the writer, checks, statistics |
//! | `mesh` | triangle meshes as data: welding, topology, defects, repair |
//! | `dexel` | intervals along the rays of a lattice |
//! | `solid` | what can split a cell: one file or folder a producer |
//! | `walk` | what walks through the cells of a solid, for all that stands above |
//! | `op` | building, splitting on demand, and the set algebra of stored trees |
//! | `query` | points, boxes and rays, measures, interference |
//! | `layout` | placements of solids in a container |
//! | `attribute` | what has a value at points, inside or outside of solids |
//! | `voxel` | voxels as records, sorted by code |
//! | `surface` | triangle meshes of solids |
//! | `render` | pictures of solids, meshes and volumes |
//! | `file` | the file format |
//! | `exchange` | the files of other programs |
//! | `scene` | the language of OpenSCAD's CSG dumps |
//!
//! Below them all lie `error`, `memory` (allocations that may be refused), `parallel` (work that threads
//! share), `control` (limits, cancelling) and `dispatch` (run-time choice of instructions). The C interface
//! and the program are packages of their own, `capi` and `cli`.
//!
//! Where is …
//!
//! | question | file |
//! |---|---|
//! | … the one operation that all is made of? | `solid/mod.rs` |
//! | … a sphere, a prism, a torus? | `solid/csg/primitive.rs`, `faceted.rs`; `solid/half_space/torus.rs` |
//! | … the sign of a polynomial decided exactly? | `lattice/exact/` |
//! | … the winding number of an open mesh? | `solid/mesh/winding.rs` |
//! | … a hole in a mesh found, a crack closed? | `mesh/defects.rs`, `mesh/sew.rs` |
//! | … the union of two stored octrees? | `op/boolean.rs`; of ones that keep surfaces `op/extended/combine.rs` |
//! | … a child of an element found? | `octree/links.rs` |
//! | … the cell beside a cell, all cells of a tag, the faces between them? | `octree/neighbour.rs`, `cells.rs`, `faces.rs` |
//! | … what cells prove? | `octree/proof.rs` |
//! | … an STL read? | `exchange/stl.rs` |
//! | … a bitmap or an array of samples a solid, and an octree a bitmap? | `solid/volume/`, `query/bitmap.rs` |
//! | … a byte of a file checked? | `file/header.rs`, `object.rs`, `section.rs`, `layout.rs`, `tree.rs`, `tridexel.rs` |
//! | … an allocation refused? | `memory.rs` |
//! | … where a ray meets a solid, how high it is? | `query/ray/`, `query/columns/` |
//! | … a ray of a mesh, of a half-space? | `solid/mesh/chords.rs`, `solid/half_space/lines.rs` |
//! | … a closed triangle mesh of a solid? | `surface/cubes.rs`, `simple.rs`, `shrink.rs`, `solid.rs`, `volume.rs`, `dexel.rs` |
//! | … plane faces as polygons, the kind of a surface and its radius? | `surface/boundary/regions.rs`, `solid/half_space/shape.rs` |
//! | … a mesh that an STL keeps? | `mesh/single.rs` |
//! | … a picture taken, a triangle drawn, a plane section, a volume, a legend? | `render/tile.rs`, `coverage.rs`, `slice.rs`, `volume/`, `legend.rs` |
//! | … the normal of a surface of which only cells are known? | `render/normals.rs` |
//! | … the list of voxels, their depth order? | `voxel/walk.rs`, `records.rs`, `order.rs` |
//! | … the volume of a solid, the distance of two, or of a point? | `query/measure/`, `query/clearance/`, `query/distance/` |
//! | … how far two boundaries are from each other? | `query/deviation/` |
//! | … the area of a plane section? | `query/section.rs`, `cut/section.rs` |

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

// What everyone uses. Everything else is in the module of its topic.
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

/// The README's example is compiled and run.
#[cfg(all(doctest, feature = "mmap"))]
#[doc = include_str!("../README.md")]
struct Readme;
