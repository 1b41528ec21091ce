//! Solids: everything that can split a cell.
//!
//! The library asks one thing of a shape: *split this PARTIAL cell into its eight children, classified*.
//! Whatever has a shape is a [`Solid`]: primitives, triangle meshes, stored octrees, a host program's
//! callback. Whatever wants a shape puts it on a frame, takes a [`Worker`] and asks that. Each producer is
//! one file, and none knows the others.

// The contract is below; with it go what tells solids apart, what copies stored cells, and what hands questions on.
mod fingerprint;
mod forward;
mod motion;
mod subtree;

// Producers: none knows another one. (Half-spaces are no solid by themselves; expressions are made of them.)
mod callback;
mod csg;
mod half_space;
mod mesh;
pub(crate) mod stored;
mod volume;

// Wrappers: solids that are made of a solid of any kind.
mod adaptive;
mod any;
mod erased;
#[cfg(feature = "std")]
mod prepared;
mod split_counter;
mod transform;

pub use crate::cut::{Crossing, Enclosure, Segment, Slab, SlabJoin};
pub use adaptive::Adaptive;
pub use callback::{Callback, GradientRange, TangentBalls};
pub use csg::{Csg, Touch};
#[cfg(feature = "scene")]
pub(crate) use csg::{Fan, Figure, cos_degrees, sin_degrees, wedge};
pub use erased::{AnyClassifier, AnySolid, AnyWorker, Erasable};
pub use fingerprint::{Fingerprint, Fingerprinter};
pub use half_space::HalfSpace;
pub use mesh::MeshSolid;
pub use motion::Motion;
#[cfg(feature = "std")]
pub use prepared::Prepared;
pub use split_counter::SplitCounter;
pub use subtree::Subtree;
pub use transform::Transform;
pub(crate) use transform::TransformClassifier;
pub use volume::{Band, SampleArray, Samples, Volume, VoxelGrid};

use crate::control::Control;
use crate::dexel::Beam;
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Cell, CellMoments, Frame, Interval, VolumeMoments};
use crate::memory;
use crate::octree::{Block, Planes, Proof, Tag};
use alloc::vec::Vec;

/// What a solid says of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict<P> {
    /// The cell's interior and the solid's are proven disjoint.
    Empty,
    /// The cell is proven to lie in the solid.
    Full,
    /// Not decided, and splitting does not help.
    Undecided,
    /// Not decided; the part is what the solid remembers about the cell, so that it can split it.
    Partial(P),
}

impl<P> Verdict<P> {
    /// The verdict as a tag.
    #[inline(always)]
    pub fn tag(&self) -> Tag {
        match self {
            Verdict::Empty => Tag::Empty,
            Verdict::Full => Tag::Full,
            Verdict::Undecided | Verdict::Partial(_) => Tag::Partial,
        }
    }

    /// The same verdict with another part.
    #[inline(always)]
    pub fn try_map<Q>(self, part: impl FnOnce(P) -> Result<Q, Error>) -> Result<Verdict<Q>, Error> {
        Ok(match self {
            Verdict::Empty => Verdict::Empty,
            Verdict::Full => Verdict::Full,
            Verdict::Undecided => Verdict::Undecided,
            Verdict::Partial(own) => Verdict::Partial(part(own)?),
        })
    }

    /// The verdict of the complement.
    #[inline(always)]
    #[must_use]
    pub fn complement(self) -> Verdict<P> {
        match self {
            Verdict::Empty => Verdict::Full,
            Verdict::Full => Verdict::Empty,
            open => open,
        }
    }
}

/// A shape in model space.
///
/// A shape is asked in three steps. [`on`](Solid::on) puts it on the lattice of a frame, once: the
/// [`Classifier`] is a handle that costs nothing to copy and that threads, queries and poses share. Each
/// thread takes a [`Worker`] from it, which has the scratch memory and answers.
///
/// ```
/// use leafless::{
///     Bounds, Cell, Classifier, Control, Error, Frame, Rule, Solid, Tag, Verdict, Worker, build,
///     lattice::Cube,
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
/// impl Worker for OnFrame {
///     // What a cell is decided by is the cell itself.
///     type Part = ();
///
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

    /// What moving the shape does to it.
    fn motion(&self) -> Motion {
        Motion::Conservative
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

    /// What the verdicts prove, if not all that they say: those of a stored octree prove what its cells do.
    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    /// The volume and the moments of the whole shape, inside and outside of the universe, if they are known
    /// without splitting cells. `None`, the default, if they are not. They are proven as verdicts are.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    fn moments(&self, control: &Control<'_>) -> Result<Option<VolumeMoments>, Error> {
        let _ = control;
        Ok(None)
    }

    /// The area of the whole boundary (square model units), inside and outside of the universe, if it is known without
    /// splitting cells. `None`, the default, if it is not.
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn area(&self, control: &Control<'_>) -> Result<Option<Interval>, Error> {
        let _ = control;
        Ok(None)
    }

    /// Whether no piece of the boundary lies in a plane of the lattice, so that all its area lies in open PARTIAL cells.
    /// `false`, the default, if that is not known.
    fn is_off_lattice(&self) -> bool {
        false
    }
}

/// A classifier with scratch memory: what answers.
///
/// A PARTIAL cell has a *part*, which is what the worker remembers about it. It may refer to the worker's
/// scratch memory, a stack: parts that were made after a [mark](Worker::mark) are gone once the mark is
/// [released](Worker::release). A part means something to the worker that made it, and to no other. (To
/// another worker it may mean anything, and asking may panic.)
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
pub trait Worker: Send + Sync {
    /// What is remembered about one PARTIAL cell.
    type Part: Clone + Send + Sync;

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

    // ---- scratch memory -------------------------------------------------------------------------------------

    /// The present height of the scratch memory.
    fn mark(&self) -> usize {
        0
    }

    /// Bytes that the scratch memory takes for parts. Whoever keeps many parts at once keeps an eye on it.
    fn scratch_bytes(&self) -> usize {
        0
    }

    /// Back to an earlier height.
    fn release(&mut self, mark: usize) {
        let _ = mark;
    }

    /// Takes over a part of another worker of the same classifier, with what it refers to.
    ///
    /// # Errors
    /// If memory runs out.
    fn hand_over(&mut self, from: &Self, part: &Self::Part) -> Result<Self::Part, Error> {
        let _ = from;
        Ok(part.clone())
    }

    /// The part of a PARTIAL cell without the way to it, if it depends on the cell alone; then nobody needs
    /// to replay splits.
    fn recall(&mut self, cell: Cell) -> Option<Self::Part> {
        let _ = cell;
        None
    }

    // ---- faster forms of `split` ----------------------------------------------------------------------------

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

    /// Whether answers are dear, or come more cheaply many at a time, as those of a host program do. Whoever
    /// can then gathers cells for [`split_many`](Self::split_many), and uses threads for few of them.
    fn likes_many(&self) -> bool {
        false
    }

    /// Splits many PARTIAL cells: appends what [`split`](Self::split) says of each, in their order. A cancel
    /// by `control` ends it early. What was appended before an error is right.
    ///
    /// # Errors
    /// As all questions, and [`Error::Cancelled`].
    fn split_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<Self::Part>; 8]>,
    ) -> Result<(), Error> {
        verdicts.try_reserve(cells.len())?;
        for (cell, part) in cells {
            control.check()?;
            verdicts.push(self.split(*cell, part)?);
        }
        Ok(())
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

    /// Finds where rays through the centres of finest cells enter and leave the solid in a PARTIAL cell, if that is known
    /// for all rays that `beam` asks for: adds their intervals in the cell, and returns `true`. An interval holds just those
    /// centres that [`sample`](Self::sample) would find inside. The default adds nothing, and returns `false`: whoever asks
    /// descends.
    ///
    /// # Errors
    /// As all questions.
    fn chords(&mut self, cell: Cell, part: &Self::Part, beam: &mut Beam) -> Result<bool, Error> {
        let _ = (cell, part, beam);
        Ok(false)
    }

    /// The stored cells that a PARTIAL cell consists of, if they are stored in the form of octrees on this
    /// frame: whoever writes an octree copies them.
    fn subtree(&self, part: &Self::Part) -> Option<Subtree<'_>> {
        let _ = part;
        None
    }

    // ---- points ---------------------------------------------------------------------------------------------

    /// Whether the centre of a PARTIAL cell of the frame's depth lies in the solid, or `None` if the solid
    /// cannot tell. A centre on the boundary is decided as if all centres were shifted by (ε, ε², ε³), to
    /// first order: on a curved surface too, the first axis that leads across it decides.
    ///
    /// # Errors
    /// As all questions.
    fn sample(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<bool>, Error> {
        let _ = (cell, part);
        Ok(None)
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

    /// Samples many cells of the frame's depth: appends what [`sample`](Self::sample) says of each, in their
    /// order. A cancel by `control` ends it early.
    ///
    /// # Errors
    /// As all questions, and [`Error::Cancelled`].
    fn sample_many(
        &mut self,
        cells: &[(Cell, Self::Part)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        inside.try_reserve(cells.len())?;
        for (cell, part) in cells {
            control.check()?;
            inside.push(self.sample(*cell, part)?);
        }
        Ok(())
    }

    /// Whether points of the universe (model units) lie in the solid: sets `answers[i]` for `points[i]` where
    /// that is known without a descent; on the boundary either answer is right. The default knows nothing,
    /// and whoever asks descends.
    ///
    /// # Errors
    /// As all questions.
    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        let _ = (points, answers);
        Ok(())
    }

    // ---- what else may be known of a PARTIAL cell -----------------------------------------------------------

    /// Slabs between which the boundary lies in a PARTIAL cell, by the law that [`Enclosure`] states.
    ///
    /// # Errors
    /// As all questions.
    fn enclosure(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<Enclosure>, Error> {
        let _ = (cell, part);
        Ok(None)
    }

    /// Volume and moments of the solid in a PARTIAL cell, if they are known better than by an enclosure.
    ///
    /// # Errors
    /// As all questions.
    fn moments(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<CellMoments>, Error> {
        let _ = (cell, part);
        Ok(None)
    }

    /// Bounds of the area that the boundary has in a PARTIAL cell, in squares of the cell's half edge, if any are known
    /// beside those by an enclosure with a cone.
    ///
    /// # Errors
    /// As all questions.
    fn area(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<Interval>, Error> {
        let _ = (cell, part);
        Ok(None)
    }

    /// Where a segment with both ends in the closed cell first crosses the boundary, by the law that
    /// [`Crossing`] states; `None` if it does not, or the solid cannot tell.
    ///
    /// # Errors
    /// As all questions.
    fn crossing(
        &mut self,
        cell: Cell,
        part: &Self::Part,
        segment: &Segment,
    ) -> Result<Option<Crossing>, Error> {
        let _ = (cell, part, segment);
        Ok(None)
    }
}

/// The worker of a solid.
pub(crate) type WorkerOf<S> = <<S as Solid>::Classifier as Classifier>::Worker;

/// A solid that is borrowed.
impl<S: Solid> Solid for &S {
    forward::forward_solid!(S::Classifier, self => (**self));
}

/// The parts of a solid.
pub(crate) type PartOf<S> = <WorkerOf<S> as Worker>::Part;

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
