//! Solids: shapes that can split a cell into classified children.
//!
//! The library needs one operation of a shape: *split this PARTIAL cell into its eight children, classified*.
//! Every shape is a [`Solid`]: primitives, triangle meshes, stored octrees, a host program's callback. An
//! algorithm puts the solid on a frame, takes a [`Worker`] and queries it. Each producer is one file and does
//! not depend on the others.
//!
//! # A new solid
//!
//! [`Solid`] has an example. Beyond [`root`](Worker::root) and [`split`](Worker::split), every method that a
//! worker implements improves the results, one step at a time. `examples/metaball.rs` climbs the first three
//! steps and prints the gain of each.
//!
//! | a worker that | gains |
//! |---|---|
//! | splits cells, and is [`FreeParts`] and [`OneByOne`] | octrees by [`Rule::Certified`](crate::Rule::Certified), `Inner` and `Outer`, points, boxes, rays, Booleans, pictures: all to the size of a cell. After N splits the error of a volume is of the order N^-½. |
//! | answers [`Question::Centre`] | [`Rule::Sampled`](crate::Rule::Sampled), tri-dexel models, marching cubes of sampled cells |
//! | answers [`Question::Enclosure`] | second order: volume, centroid and inertia to N^-1 (plane faces: N^-2), a bounding box in some hundred splits, rays and vertices to a curvature times a cell's square, octrees that end where the surface is known to a tolerance ([`Adaptive`]) |
//! | answers [`Question::Moments`], [`Question::Area`] | third order: volume and moments to N^-1.5, areas |
//! | answers [`Question::Crossing`] | surface vertices that lie on the surface, with normals, without a search |
//! | answers [`Question::Surfaces`], [`WholeQuestion::Surfaces`] | extended octrees, which keep the surfaces and are as exact as the solid |
//! | answers [`Question::Layers`], [`WholeQuestion::Layers`] | the same where surfaces are known within a width |
//! | answers [`WholeQuestion::Facets`], or [`WholeQuestion::Pieces`] | the distance of its boundary from another boundary, to rounding and without cells |
//! | answers [`WholeQuestion::Walls`], implements [`Batch::inside`] | the distance from another solid, to rounding and without cells |
//! | answers [`Question::Ray`], [`Question::Nearest`], implements [`Batch::inside`] | single rays, distances and points in microseconds |
//! | answers [`Question::Chords`], implements [`fill`](Worker::fill) | speed only: tri-dexel models, octrees |
//! | implements [`Batch`] in place of [`OneByOne`] | threads and whole levels at once, for slow functions; points without a descent ([`Batch::inside`]); cells without the path to them ([`Batch::recall`]) |
//! | implements [`Parts`] in place of [`FreeParts`] | parts that are lists in scratch memory, so that children look only at the primitives that cut their parent |
//!
//! Each trait states its laws. A test of a new solid compares the solid with a slow oracle cell by cell, and
//! has its row in `tests/octrees/proof_table.rs`.
//!
//! # A new wrapper
//!
//! A solid that wraps another one implements all of [`Parts`], [`Batch`], [`Classifier::proof`] and the two
//! `answer` methods. They have no defaults, because a default would silently lose what the inner solid
//! answers. A wrapper forwards every question that it does not change, including questions that are added in
//! future versions. The other methods have defaults that are correct, but slower or less certain.

mod contract;
// Helpers of the contract: fingerprints, copies of stored cells, and forwarding.
mod fingerprint;
mod motion;
mod subtree;
mod surface_cell;
mod trace;

// Producers: none depends on another. (Half-spaces are no solid by themselves; expressions are made of them.)
mod callback;
mod csg;
pub(crate) mod half_space;
mod mesh;
pub(crate) mod stored;
mod volume;

// Wrappers: solids that are made from a solid of any kind.
mod adaptive;
mod any;
pub(crate) mod joint;
#[cfg(feature = "std")]
mod prepared;
mod split_counter;
mod transform;

pub use crate::cut::{Crossing, Enclosure, Segment, Slab, SlabJoin};
pub use adaptive::Adaptive;
pub use callback::{Callback, GradientRange, TangentBalls};
pub use contract::{
    AnyClassifier, AnySolid, AnyWorker, Ask, AskWhole, Batch, Chords, Classifier, Direct, DynSolid,
    FreeParts, LayersQuestion, OneByOne, Parts, Question, Solid, Verdict, WholeQuestion, Worker,
    sample_one_by_one, split_one_by_one,
};
pub(crate) use contract::{AskDirect, AskLayers, ErasedPart, OCTANTS, forward, split_twice};
pub use csg::{Csg, Touch};
#[cfg(feature = "scene")]
pub(crate) use csg::{Fan, Figure, cos_degrees, sin_degrees, wedge};
pub use fingerprint::{Fingerprint, Fingerprinter};
pub(crate) use half_space::{Form, Round};
pub use half_space::{HalfSpace, OpenSurfaces, PlacedHalfSpace, SurfaceShape};
pub use mesh::MeshSolid;
pub use motion::Motion;
#[cfg(feature = "std")]
pub use prepared::Prepared;
pub use split_counter::SplitCounter;
pub use stored::ShardedOctree;
pub use subtree::Subtree;
pub use trace::{
    BoundaryFacets, BoundaryPieces, BoxContent, NearestSurface, RayCrossing, RayQuestion, RayTrace,
};
pub use transform::Transform;
pub(crate) use transform::TransformClassifier;
pub use volume::{Band, SampleArray, Samples, Volume, VoxelGrid};
