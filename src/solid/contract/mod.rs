//! The contract of solids: a shape, a shape on a frame, and a worker that splits cells.
//!
//! The traits stand here. `parts` says where a worker keeps its data about cells, `batch` how it answers many
//! questions at once, `question` what else it may be asked. `erased` has the object-safe counterparts.

mod batch;
mod erased;
pub(crate) mod forward;
mod parts;
mod question;
mod verdict;

pub use batch::{Batch, OneByOne, sample_one_by_one, split_one_by_one};
pub(crate) use erased::ErasedPart;
pub use erased::{AnyClassifier, AnySolid, AnyWorker, DynSolid};
pub use parts::{FreeParts, Parts};
pub use question::{Ask, AskWhole, Chords, Direct, LayersQuestion, Question, WholeQuestion};
pub(crate) use question::{AskDirect, AskLayers};
pub use verdict::Verdict;

use super::{Fingerprint, Motion, Subtree};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Cell, Frame};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::{Block, Planes, Proof, Tag};
use alloc::vec::Vec;

/// A shape in model space.
///
/// A shape is queried in three steps. [`on`](Solid::on) puts the shape on the lattice of a frame, once, and
/// returns a [`Classifier`]: a handle that costs nothing to copy and that threads, queries and poses share.
/// Each thread takes a [`Worker`] from the classifier. The worker has scratch memory and answers the
/// questions.
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
///     // No preparation is needed here. A mesh would sort its triangles.
///     fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<OnFrame, Error> {
///         Ok(OnFrame { shape: *self, frame: *frame })
///     }
///
///     fn bounds(&self) -> Option<Bounds> {
///         Bounds::new([-self.0; 3], [self.0; 3])
///     }
/// }
///
/// /// The shape on a frame. It needs no scratch memory, so that the handle is its own worker.
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
///         // A margin of some last places covers the rounding errors: a verdict is a proof.
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
/// // The cell alone decides its verdict: the worker remembers nothing about it.
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
///     // The worker answers only for centres. (Slabs would come next: `Question::Enclosure`.)
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
/// The result of [`on`](Solid::on) depends on the shape and the frame alone.
///
/// # Repeated queries
/// Every query first puts the solid on its frame. That takes O(1) for octrees made by this library and for a
/// host's functions. It takes O(n) in the half-spaces of an expression, in the triangles of a mesh, and in
/// the links of a mapped octree. For many single queries in a row, wrap the solid in
/// [`Prepared`](super::Prepared), which keeps the prepared classifier.
pub trait Solid: Send + Sync {
    /// The type of the shape on a frame.
    type Classifier: Classifier;

    /// Puts the shape on the lattice of a frame. All work that grows with the size of the model is done here.
    ///
    /// # Errors
    /// If the shape is not available on this frame ([`Error::FrameMismatch`] for stored octrees), if memory
    /// runs out, or if `control` cancels the work. The work may use the threads of `control`.
    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<Self::Classifier, Error>;

    /// A box in model space that certainly contains the shape, if one is known.
    fn bounds(&self) -> Option<Bounds> {
        None
    }

    /// The only frame on which the shape is exact, if there is only one: the frame of a stored octree.
    fn home(&self) -> Option<Frame> {
        None
    }

    /// The fingerprint of the shape: two shapes with the same fingerprint give the same verdicts. `None`, the
    /// default, means that the shape has no fingerprint. An octree that was refined on demand can then not be
    /// resumed with it.
    fn fingerprint(&self) -> Option<Fingerprint> {
        None
    }

    /// The shape under an affine map, if its kind can be moved more directly than by
    /// [`Transform`](super::Transform). `None`, the default, means that it cannot. [`AnySolid::placed`] moves
    /// all kinds.
    ///
    /// # Errors
    /// If memory runs out, or an error of the kind of solid.
    fn placed(&self, placement: &Affine) -> Result<Option<Self>, Error>
    where
        Self: Sized,
    {
        let _ = placement;
        Ok(None)
    }

    /// The mesh whose solid this is, if the solid consists of that mesh alone; a picture then draws its
    /// triangles. `None`, the default, if that is not known.
    fn sole_mesh(&self) -> Option<&TriangleMesh> {
        None
    }

    /// The precision of the shape under affine maps.
    fn motion(&self) -> Motion {
        Motion::Conservative
    }

    /// The approximate number of bytes of memory (or of mapped files) that the shape keeps alive: its own,
    /// and those of the meshes, octrees and samples that it shares with other shapes. An expression counts
    /// each of its parts once, but two parts that share a mesh count the mesh twice. 0, the default, means
    /// unknown. A solid that consists of small structs only may return 0.
    fn kept_bytes(&self) -> u64 {
        0
    }
}

/// A shape on a frame: a cheap shared handle for threads, queries and poses.
pub trait Classifier: Clone + Send + Sync {
    /// The type of the workers: the classifier with scratch memory.
    type Worker: Worker;

    /// The frame.
    fn frame(&self) -> &Frame;

    /// Creates a worker, which keeps alive everything that it needs. O(1) in the size of the model.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    fn worker(&self) -> Result<Self::Worker, Error>;

    /// The state of the space around the universe: EMPTY if the shape is proven to end inside the universe,
    /// FULL if the space is proven solid, PARTIAL otherwise.
    fn exterior(&self) -> Tag {
        Tag::Partial
    }

    /// The proof of the verdicts. [`Proof::CERTIFIED`] means that FULL and EMPTY are proven for the whole
    /// cell. The verdicts of a stored octree prove as much as its cells do. The verdicts of a solid that is
    /// known only at points prove nothing.
    fn proof(&self) -> Proof;

    /// Answers a question about the whole shape, if the shape knows more than its cells show. Any other shape
    /// just returns `Ok(())`.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error>;

    /// The approximate number of bytes of memory that the handle and its clones keep alive beyond those of
    /// the solid ([`Solid::kept_bytes`]). 0, the default, means unknown.
    fn kept_bytes(&self) -> u64 {
        0
    }

    /// The classifier as one of any kind. Only [`AnyClassifier`] has a method of its own.
    fn erased<'c>(self) -> AnyClassifier<'c>
    where
        Self: 'c,
    {
        AnyClassifier::new(self)
    }
}

/// A classifier with scratch memory, which answers the questions.
///
/// A worker remembers something about each PARTIAL cell: the *part* of the cell ([`Parts`], or
/// [`FreeParts`]). It may answer many questions at once ([`Batch`], or [`OneByOne`]).
///
/// # Laws
/// 1. A FULL or EMPTY verdict is proven, unless [`Classifier::proof`] says otherwise. Contact is not overlap:
///    FULL means that the whole (closed) cell lies in the solid, EMPTY that the interiors are disjoint.
/// 2. A verdict depends on the cell and the shape alone. It does not depend on the path to the cell, on the
///    thread, or on earlier questions.
/// 3. Replaying the splits from the root recovers the part of any cell.
/// 4. An enclosure and a crossing are proven as verdicts are. A crossing has the same bits whichever cell is
///    queried for it.
///
/// All laws concern the shape inside the universe.
///
/// # Errors
/// Every question fails with [`Error::OutOfMemory`] if memory runs out, and with the error of a host
/// program's function ([`Error::Callback`], for example) if that function stops the work.
pub trait Worker: Batch {
    /// The frame.
    fn frame(&self) -> &Frame;

    /// Returns the verdict on the universe. O(1) in the size of the model.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    fn root(&mut self) -> Result<Verdict<Self::Part>, Error>;

    /// Splits a PARTIAL cell above the frame's depth and returns the verdicts on its children in octant
    /// order.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    fn split(&mut self, cell: Cell, part: &Self::Part) -> Result<[Verdict<Self::Part>; 8], Error>;

    /// Answers a further question about a PARTIAL cell: fills in the place for the answer in the question, or
    /// leaves it as it is. A worker that has nothing but verdicts returns `Ok(())`.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    fn answer(&mut self, cell: Cell, part: &Self::Part, question: Question<'_>) -> Result<(), Error>;

    // ---- the same answers in less time: the defaults are correct ------------------------------------------

    /// Splits two levels at once, which is the granularity of storage. Returns the tags of the 64
    /// grandchildren in Morton order. The parts of the grandchildren that can be split are appended to
    /// `parts` with their indices, in ascending order.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    fn split64(
        &mut self,
        cell: Cell,
        part: &Self::Part,
        parts: &mut Vec<(u8, Self::Part)>,
    ) -> Result<Planes, Error> {
        split_twice(self, cell, part, parts)
    }

    /// Classifies a PARTIAL cell of 64³ finest cells at once, where that is faster than descent. It fills in
    /// what `block` requests, with exactly the result of a descent by [`split`](Self::split), and returns
    /// `true`. The default returns `false`: the caller must descend.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    fn fill(&mut self, cell: Cell, part: &Self::Part, block: &mut Block) -> Result<bool, Error> {
        let _ = (cell, part, block);
        Ok(false)
    }

    /// Samples the centres of many cells at once, which is the granularity of storage. `parts` holds the
    /// parts of some of the 64 grandchildren of a cell, with their indices. The grandchildren have the
    /// frame's depth. Bit c of the result is set if the centre of grandchild c lies in the solid.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
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

    /// The stored cells that make up a PARTIAL cell, if they are stored in the form of octrees on this frame.
    /// A writer of octrees copies them.
    fn subtree(&self, part: &Self::Part) -> Option<Subtree<'_>> {
        let _ = part;
        None
    }
}

/// A borrowed solid.
impl<S: Solid + ?Sized> Solid for &S {
    forward::forward_solid!(S::Classifier, self => (**self));
}

/// The octants in order.
pub(crate) const OCTANTS: [u8; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// Splits two levels by splitting twice.
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
