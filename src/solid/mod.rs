//! Solids: everything that can split a cell.
//!
//! The library asks one thing of a shape: *split this PARTIAL cell into its eight children, classified*.
//! Whatever has a shape is a [`Solid`]: primitives, triangle meshes, stored octrees, a host program's
//! callback. Whatever wants a shape puts it on a frame, takes a [`Worker`] and asks that. Each producer is
//! one file, and none knows the others.
//!
//! # A new solid
//!
//! [`Solid`] has an example. What a worker writes beside [`root`](Worker::root) and [`split`](Worker::split)
//! makes answers better, one step at a time (`examples/metaball.rs` climbs the first three steps and prints
//! what each gains):
//!
//! | a worker that | gains |
//! |---|---|
//! | splits cells, and is [`FreeParts`] and [`OneByOne`] | octrees by [`Rule::Certified`](crate::Rule::Certified), `Inner` and `Outer`, points, boxes, rays, Booleans, pictures: all to the size of a cell. After N splits a volume is known to N^-½. |
//! | answers [`Question::Centre`] | [`Rule::Sampled`](crate::Rule::Sampled), tri-dexel models, marching cubes of sampled cells |
//! | answers [`Question::Enclosure`] | second order: volume, centroid and inertia to N^-1 (plane faces: N^-2), a bounding box in some hundred splits, rays and vertices to a curvature times a cell's square, octrees that end where the surface is known to a tolerance ([`Adaptive`]) |
//! | answers [`Question::Moments`], [`Question::Area`] | third order: volume and moments to N^-1.5, areas |
//! | answers [`Question::Crossing`] | vertices of surfaces on the surface, with normals, without a search |
//! | answers [`Question::Surfaces`], [`WholeQuestion::Surfaces`] | extended octrees that keep the surfaces, and are as exact as the solid |
//! | answers [`Question::Layers`], [`WholeQuestion::Layers`] | the same where surfaces are known within a width |
//! | answers [`WholeQuestion::Facets`], or [`WholeQuestion::Pieces`] | how far its boundary is from another one, to rounding and without cells |
//! | answers [`WholeQuestion::Walls`], writes [`Batch::inside`] | how far it is from another solid, to rounding and without cells |
//! | answers [`Question::Ray`], [`Question::Nearest`], writes [`Batch::inside`] | single rays, distances and points in microseconds |
//! | answers [`Question::Chords`], writes [`fill`](Worker::fill) | nothing but speed: tri-dexel models, octrees |
//! | writes [`Batch`] in place of [`OneByOne`] | threads and whole levels at once, for functions that take long; points without a descent ([`Batch::inside`]); cells without the way to them ([`Batch::recall`]) |
//! | writes [`Parts`] in place of [`FreeParts`] | parts that are lists in scratch memory, so that children look only at what cut their parent |
//!
//! Laws for all of them stand with each trait. A test of a new solid compares it with a slow oracle cell by
//! cell, and has its row in `tests/octrees/proof_table.rs`.
//!
//! # A new wrapper
//!
//! A solid that is made of another one writes all of [`Parts`], [`Batch`], [`Classifier::proof`] and the two
//! `answer`s: they have no defaults, because what they say would be lost in silence. Questions that a wrapper
//! does not change are handed on as they are, those of the future included. The other methods have defaults
//! that are right, and slower or less sure.

// The contract: what a solid answers (here), where parts live, many questions at once, and what else can be
// known.
mod batch;
mod parts;
mod question;
mod verdict;
// With it go what tells solids apart, what copies stored cells, and what hands questions on.
mod fingerprint;
pub(crate) mod forward;
mod motion;
mod subtree;
mod surface_cell;
mod trace;

// Producers: none knows another one. (Half-spaces are no solid by themselves; expressions are made of them.)
mod callback;
mod csg;
pub(crate) mod half_space;
mod mesh;
pub(crate) mod stored;
mod volume;

// Wrappers: solids that are made of a solid of any kind.
mod adaptive;
mod any;
mod erased;
pub(crate) mod joint;
#[cfg(feature = "std")]
mod prepared;
mod split_counter;
mod transform;

pub use crate::cut::{Crossing, Enclosure, Segment, Slab, SlabJoin};
pub use adaptive::Adaptive;
pub use batch::{Batch, OneByOne, sample_one_by_one, split_one_by_one};
pub use callback::{Callback, GradientRange, TangentBalls};
pub use csg::{Csg, Touch};
#[cfg(feature = "scene")]
pub(crate) use csg::{Fan, Figure, cos_degrees, sin_degrees, wedge};
pub use erased::{AnyClassifier, AnySolid, AnyWorker, Erasable};
pub use fingerprint::{Fingerprint, Fingerprinter};
pub(crate) use half_space::{Form, Round};
pub use half_space::{HalfSpace, OpenSurfaces, PlacedHalfSpace, SurfaceShape};
pub use mesh::MeshSolid;
pub use motion::Motion;
pub use parts::{FreeParts, Parts};
#[cfg(feature = "std")]
pub use prepared::Prepared;
pub use question::{Ask, AskWhole, Chords, Direct, LayersQuestion, Question, WholeQuestion};
pub(crate) use question::{AskDirect, AskLayers};
pub use split_counter::SplitCounter;
pub use stored::ShardedOctree;
pub use subtree::Subtree;
pub use trace::{
    BoundaryFacets, BoundaryPieces, BoxContent, NearestSurface, RayCrossing, RayQuestion, RayTrace,
};
pub use transform::Transform;
pub(crate) use transform::TransformClassifier;
pub use verdict::Verdict;
pub use volume::{Band, SampleArray, Samples, Volume, VoxelGrid};

use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Cell, Frame};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::{Block, Planes, Proof, Tag};
use alloc::vec::Vec;

/// A shape in model space.
///
/// A shape is asked in three steps. [`on`](Solid::on) puts it on the lattice of a frame, once: the
/// [`Classifier`] is a handle that costs nothing to copy and that threads, queries and poses share. Each
/// thread takes a [`Worker`] from it, which has the scratch memory and answers.
///
/// ```
/// use leafless::{
///     Bounds, Cell, Classifier, Control, Error, Frame, Proof, Rule, Solid, Verdict, Worker, build,
///     lattice::Cube, solid::{FreeParts, OneByOne, Question, WholeQuestion},
/// };
///
/// /// All points p with |x| + |y| + |z| ≤ r.
/// #[derive(Clone, Copy)]
/// struct Octahedron(f64);
///
/// impl Solid for Octahedron {
///     type Classifier = OnFrame;
///
///     // Nothing costs time here. A mesh would sort its triangles.
///     fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<OnFrame, Error> {
///         Ok(OnFrame { shape: *self, frame: *frame })
///     }
///
///     fn bounds(&self) -> Option<Bounds> {
///         Bounds::new([-self.0; 3], [self.0; 3])
///     }
/// }
///
/// /// The shape on a frame. There is no scratch memory, so that the handle is its own worker.
/// #[derive(Clone, Copy)]
/// struct OnFrame {
///     shape: Octahedron,
///     frame: Frame,
/// }
///
/// impl Classifier for OnFrame {
///     type Worker = OnFrame;
///
///     fn frame(&self) -> &Frame {
///         &self.frame
///     }
///
///     fn worker(&self) -> Result<OnFrame, Error> {
///         Ok(*self)
///     }
///
///     fn proof(&self) -> Proof {
///         Proof::CERTIFIED
///     }
///
///     fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
///         Ok(())
///     }
/// }
///
/// impl OnFrame {
///     fn verdict(&self, cell: Cell) -> Verdict<()> {
///         let (min, max) = Cube { frame: &self.frame, cell }.bounds();
///         let far = |axis: usize| min[axis].abs().max(max[axis].abs());
///         let near = |axis: usize| if min[axis] <= 0.0 && max[axis] >= 0.0 { 0.0 } else { min[axis].abs().min(max[axis].abs()) };
///         // Some last places for what is rounded: a verdict is a proof.
///         let (most, least) = (far(0) + far(1) + far(2), near(0) + near(1) + near(2));
///         if most * (1.0 + 4.0 * f64::EPSILON) <= self.shape.0 {
///             Verdict::Full
///         } else if least * (1.0 - 4.0 * f64::EPSILON) >= self.shape.0 {
///             Verdict::Empty
///         } else {
///             Verdict::Partial(())
///         }
///     }
/// }
///
/// // A cell is decided by the cell itself: nothing is remembered about it.
/// impl FreeParts for OnFrame {
///     type Part = ();
/// }
///
/// impl OneByOne for OnFrame {}
///
/// impl Worker for OnFrame {
///     fn frame(&self) -> &Frame {
///         &self.frame
///     }
///
///     fn root(&mut self) -> Result<Verdict<()>, Error> {
///         Ok(self.verdict(Cell::ROOT))
///     }
///
///     fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
///         Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|octant| self.verdict(cell.child(octant))))
///     }
///
///     // Centres are all that it knows beside its cells. (Slabs would come next: `Question::Enclosure`.)
///     fn answer(&mut self, cell: Cell, _: &(), question: Question<'_>) -> Result<(), Error> {
///         if let Question::Centre(inside) = question {
///             let (min, max) = Cube { frame: &self.frame, cell }.bounds();
///             let [x, y, z] = [0, 1, 2].map(|axis| 0.5 * min[axis] + 0.5 * max[axis]);
///             let far = x.abs() + y.abs() + z.abs() - self.shape.0;
///             // A centre on the boundary counts as a point a little further along x.
///             *inside = Some(far < 0.0 || far == 0.0 && x < 0.0);
///         }
///         Ok(())
///     }
/// }
///
/// let frame = Frame::new([-1.0; 3], 2.0, 6)?;
/// let tree = build(&Octahedron(0.75), &frame, Rule::Certified, &Control::default())?;
/// assert!(tree.statistics().volume().contains(4.0 / 3.0 * 0.75 * 0.75 * 0.75));
/// # Ok::<(), Error>(())
/// ```
///
/// # Law
/// What [`on`](Solid::on) returns depends on the shape and the frame alone.
///
/// # One question after the other
/// Every query puts the solid on its frame first: O(1) for octrees that this library made and for a host's
/// functions, O(n) in the half-spaces of an expression, the triangles of a mesh, and the links of an octree
/// that was mapped. Whoever asks one point after the other wraps the solid in [`Prepared`], which keeps what
/// was prepared.
pub trait Solid: Send + Sync {
    /// The shape on a frame.
    type Classifier: Classifier;

    /// The shape on the lattice of a frame. All that costs time in proportion to the model is done here.
    ///
    /// # Errors
    /// If the shape cannot be had in this frame ([`Error::FrameMismatch`] for stored octrees), memory runs
    /// out, or `control` asks for it: the work can be cancelled, and may use its threads.
    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<Self::Classifier, Error>;

    /// A box in model space that the shape surely lies in, if one is known.
    fn bounds(&self) -> Option<Bounds> {
        None
    }

    /// The frame on which the shape is exact, if there is only one: that of a stored octree.
    fn home(&self) -> Option<Frame> {
        None
    }

    /// What tells this shape from others: two with the same fingerprint give the same verdicts. `None`, the
    /// default, if nothing does; then an octree that was refined on demand cannot be taken up again with it.
    fn fingerprint(&self) -> Option<Fingerprint> {
        None
    }

    /// The shape under an affine map, if its kind can be moved otherwise than by [`Transform`]; `None`, the
    /// default, if it cannot. [`AnySolid::placed`] moves all kinds.
    ///
    /// # Errors
    /// If memory runs out, or the kind's own.
    fn placed(&self, placement: &Affine) -> Result<Option<Self>, Error>
    where
        Self: Sized,
    {
        let _ = placement;
        Ok(None)
    }

    /// The mesh whose solid this is, if it is nothing else: a picture draws its triangles. `None`, the
    /// default, if that is not known.
    fn sole_mesh(&self) -> Option<&TriangleMesh> {
        None
    }

    /// What moving the shape does to it.
    fn motion(&self) -> Motion {
        Motion::Conservative
    }

    /// About how many bytes of memory (or of mapped files) the shape keeps alive: its own, and those of the
    /// meshes, octrees and samples that it shares with others. An expression counts each of its parts once,
    /// but two parts that share a mesh count the mesh twice. 0, the default, if nobody knows. A solid in
    /// small structs only may say 0.
    fn kept_bytes(&self) -> u64 {
        0
    }
}

/// A shape on a frame: a cheap shared handle, for threads, queries and poses.
pub trait Classifier: Clone + Send + Sync {
    /// The same with scratch memory.
    type Worker: Worker;

    /// The frame.
    fn frame(&self) -> &Frame;

    /// A worker, which keeps alive what it needs. O(1) in the model.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    fn worker(&self) -> Result<Self::Worker, Error>;

    /// What is known of the space around the universe: EMPTY if the shape is proven to end inside, FULL if
    /// the space is proven solid, else PARTIAL.
    fn exterior(&self) -> Tag {
        Tag::Partial
    }

    /// What the verdicts prove. [`Proof::CERTIFIED`]: all that they say. The verdicts of a stored octree
    /// prove what its cells do; those of a solid that is known at points only prove nothing.
    fn proof(&self) -> Proof;

    /// Answers a question about the whole shape, if the shape knows more than its cells tell. A shape that
    /// does not is done with `Ok(())`.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error>;

    /// About how many bytes of memory the handle and its clones keep alive beyond those of the solid
    /// ([`Solid::kept_bytes`]). 0, the default, if nobody knows.
    fn kept_bytes(&self) -> u64 {
        0
    }
}

/// A classifier with scratch memory: what answers.
///
/// A worker remembers something about PARTIAL cells, their *parts* ([`Parts`], or [`FreeParts`]), and may
/// answer many questions at once ([`Batch`], or [`OneByOne`]).
///
/// # Laws
/// 1. A FULL or EMPTY verdict is proven, unless [`Classifier::proof`] says otherwise. Contact is not overlap:
///    FULL means that the whole (closed) cell lies in the solid, EMPTY that the interiors are disjoint.
/// 2. A verdict depends on the cell and the shape alone: not on the path to the cell, the thread, or what
///    was asked before.
/// 3. The part of any cell can be had again by replaying the splits from the root.
/// 4. An enclosure and a crossing are proven as verdicts are. A crossing has the same bits whichever cell is
///    asked.
///
/// All of it concerns the shape inside of the universe. The errors of all questions are those of memory that
/// runs out, and of a host program's function that stops the work.
pub trait Worker: Batch {
    /// The frame.
    fn frame(&self) -> &Frame;

    /// The universe's verdict. O(1) in the model.
    ///
    /// # Errors
    /// As all questions.
    fn root(&mut self) -> Result<Verdict<Self::Part>, Error>;

    /// Splits a PARTIAL cell, which is above the frame's depth: the verdicts of its children in octant order.
    ///
    /// # Errors
    /// As all questions.
    fn split(&mut self, cell: Cell, part: &Self::Part) -> Result<[Verdict<Self::Part>; 8], Error>;

    /// Answers what else is known of a PARTIAL cell: sets the place in the question, or leaves it. A worker
    /// that knows nothing beyond verdicts is done with `Ok(())`.
    ///
    /// # Errors
    /// As all questions.
    fn answer(&mut self, cell: Cell, part: &Self::Part, question: Question<'_>) -> Result<(), Error>;

    // ---- the same answers in less time: the defaults are right --------------------------------------------------------------

    /// Splits two levels at once, the grain of storage: the tags of the 64 grandchildren in Morton order.
    /// The parts of those that can be split are appended to `parts` with their index, in ascending order.
    ///
    /// # Errors
    /// As all questions.
    fn split64(
        &mut self,
        cell: Cell,
        part: &Self::Part,
        parts: &mut Vec<(u8, Self::Part)>,
    ) -> Result<Planes, Error> {
        split_twice(self, cell, part, parts)
    }

    /// Classifies a PARTIAL cell of 64³ finest cells at once, where that is faster than descent: fills what
    /// `block` asks for with just what descending by [`split`](Self::split) would find, and returns `true`.
    /// The default returns `false`: descend.
    ///
    /// # Errors
    /// As all questions.
    fn fill(&mut self, cell: Cell, part: &Self::Part, block: &mut Block) -> Result<bool, Error> {
        let _ = (cell, part, block);
        Ok(false)
    }

    /// Samples many at once, the grain of storage: of those 64 grandchildren of a cell whose parts are given,
    /// with their index, bit c says whether the centre of cell c lies in the solid. The grandchildren have
    /// the frame's depth.
    ///
    /// # Errors
    /// As all questions.
    fn sample64(&mut self, cell: Cell, parts: &[(u8, Self::Part)]) -> Result<Option<u64>, Error> {
        let mut inside = 0;
        for (c, part) in parts {
            match self.sample(cell.child(c >> 3).child(c & 7), part)? {
                Some(true) => inside |= 1 << (c & 63),
                Some(false) => {}
                None => return Ok(None),
            }
        }
        Ok(Some(inside))
    }

    /// The stored cells that a PARTIAL cell consists of, if they are stored in the form of octrees on this
    /// frame: whoever writes an octree copies them.
    fn subtree(&self, part: &Self::Part) -> Option<Subtree<'_>> {
        let _ = part;
        None
    }
}

/// The worker of a solid.
pub(crate) type WorkerOf<S> = <<S as Solid>::Classifier as Classifier>::Worker;

/// A solid that is borrowed.
impl<S: Solid> Solid for &S {
    forward::forward_solid!(S::Classifier, self => (**self));
}

/// The parts of a solid.
pub(crate) type PartOf<S> = <WorkerOf<S> as Parts>::Part;

/// The octants in their order.
pub(crate) const OCTANTS: [u8; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// Two levels by splitting twice.
pub(crate) fn split_twice<W: Worker + ?Sized>(
    worker: &mut W,
    cell: Cell,
    part: &W::Part,
    parts: &mut Vec<(u8, W::Part)>,
) -> Result<Planes, Error> {
    let mut planes = Planes::uniform(Tag::Empty);
    for (k, child) in (0u8..).zip(worker.split(cell, part)?) {
        let mut octant = Planes::uniform(child.tag()).masked(0xFF << (8 * k));
        if let Verdict::Partial(part) = child {
            for (c, grandchild) in (8 * k..).zip(worker.split(cell.child(k), &part)?) {
                octant.set(c as u32, grandchild.tag());
                if let Verdict::Partial(part) = grandchild {
                    memory::push(parts, (c, part))?;
                }
            }
        }
        planes = planes.union(octant);
    }
    Ok(planes)
}
