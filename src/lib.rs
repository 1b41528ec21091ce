//! Leafless is a solid-modelling kernel. A solid is an octree **without leaves**, in dense arrays that are
//! also its file: mapped, and queried in place.
//!
//! Three ideas carry everything:
//!
//! 1. **A solid is what can split a cell.** Primitives, triangle meshes, stored octrees and a host program's
//!    callback are all a [`Solid`]; whatever wants a shape puts it on a frame ([`Solid::on`]) and only calls
//!    [`Worker::split`].
//! 2. **Certified.** inner ⊆ true ⊆ outer: a FULL cell is proven inside, an EMPTY one proven outside, and doubt
//!    stays PARTIAL through every operation. So a volume is an interval that contains the truth. (Whoever wants
//!    a plain yes or no builds by another [`Rule`], and then the answers are about the tree, not the shape.)
//! 3. **Closed and exact.** On one lattice the Booleans are exact set algebra, and their results canonical: the
//!    same bits for any number of threads on any platform.
//!
//! ```
//! use leafless::{Ball, AxisBox, Control, Frame, Membership, Rule, build, difference};
//!
//! let frame = Frame::new([-1.0; 3], 2.0, 8)?; // the cube [-1, 1]³, 256 cells per axis
//! let control = Control::default();
//! let block = build(&AxisBox::new([-0.75; 3], [0.75; 3])?, &frame, Rule::Certified, &control)?;
//! let ball = build(&Ball::new([0.0; 3], 0.9)?, &frame, Rule::Certified, &control)?;
//! let part = difference(block.view(), ball.view(), &control)?;
//!
//! assert_eq!(part.contains([0.0, 0.0, 0.0]), Membership::Outside);
//! assert_eq!(part.contains([0.74, 0.74, 0.74]), Membership::Inside);
//! let volume = part.statistics().volume();
//! assert!(volume.lower < 0.68186 && 0.68188 < volume.upper);
//! # Ok::<(), leafless::Error>(())
//! ```
//!
//! The modules from the bottom up; none uses one above it:
//!
//! | module | what it holds |
//! |---|---|
//! | `lattice` | cells, cubes, frames: integers and model space |
//! | `octree` | tags, the word algebra, views, the writer, checks, statistics |
//! | `mesh` | triangle meshes as data: welding, topology, defects, repair |
//! | `solid` | what can split a cell: one file or folder a producer |
//! | `op` | building, splitting on demand, and the set algebra of stored trees |
//! | `query` | points and boxes, measures, interference |
//! | `file` | the file format |
//! | `exchange` | the files of other programs |
//! | `scene` | the language of OpenSCAD's CSG dumps |
//! | `capi` | the C interface |

#![no_std]
#![deny(unsafe_code)]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

#[cfg(feature = "capi")]
pub mod capi;
mod control;
mod dispatch;
mod error;
pub mod exchange;
pub mod file;
mod lattice;
mod memory;
mod mesh;
mod octree;
mod op;
mod query;
#[cfg(feature = "scene")]
pub mod scene;
mod solid;

pub use control::Control;
pub use error::{
    Damage, Error, FormatError, MeshError, MeshFileError, PackageError, PolyhedronError, SceneError,
};
pub use lattice::{Affine, Bounds, Cell, Cube, Frame, Interval, MAX_DEPTH};
pub use mesh::{DefectKind, FillRule, MeshDefect, MeshReport, TriangleMesh};
#[cfg(feature = "std")]
pub use mesh::{Polyhedron, PolyhedronArrays};
pub use octree::{
    Block, Cursor, LevelStatistics, Metadata, Node, Octree, OctreeRef, Planes, Rule, Statistics, Tag,
};
pub use op::{
    LazyOctree, Refined, Zone, build, compact, complement, difference, intersection, intersection_of,
    resolve, union, union_of, xor, xor_of,
};
pub use query::{
    Clearance, Extent, Interference, Measured, Measures, Membership, Overlap, PointCursor, Region,
    bounding_box, classify_box, clearance, contains, interference, interference_of, measure,
};
pub use solid::{
    AnyClassifier, AnySolid, AnyWorker, AxisBox, Ball, Callback, Classifier, Counted, Crossing, Csg,
    Enclosure, Erasable, Fingerprint, Fingerprinter, HalfSpace, MeshSolid, Motion, Segment, Slab, SlabJoin,
    Solid, Stored, Subtree, Touch, Transform, Verdict, Worker,
};

#[cfg(feature = "std")]
pub use solid::Prepared;

/// The README's example is compiled and run.
#[cfg(all(doctest, feature = "mmap"))]
#[doc = include_str!("../README.md")]
struct Readme;
