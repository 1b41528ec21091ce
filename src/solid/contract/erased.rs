//! Solids of any kind behind one type.
//!
//! [`Solid`] has associated types so that a loop over a known kind compiles to tight code. Most queries spend
//! their time in the answers of the solid, and not in the calls. They take `&dyn DynSolid`, so that each
//! query is compiled once, with the library. Programs that hold shapes of different kinds in one place (the C
//! interface first of all) own them as [`AnySolid`].
//!
//! Each of the three traits has an object-safe counterpart here. The methods of these counterparts have no
//! defaults, so that none can be forgotten.

use super::super::{Fingerprint, Motion, Subtree};
use super::forward::{forward_answers, forward_batch, forward_classifier, forward_parts, forward_solid};
use super::{Batch, Classifier, Parts, Question, Solid, Verdict, WholeQuestion, Worker};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, Bounds, Cell, Frame};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::octree::{Block, Planes, Proof, Tag};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::any::Any;
use core::ptr;

/// A solid of any kind, borrowed: the object-safe counterpart of [`Solid`]. Every solid has it, so that a
/// reference to any solid can be passed where `&dyn DynSolid` is wanted. Each split costs one indirect call.
pub trait DynSolid: sealed::ErasedSolid {}

impl<S: Solid> DynSolid for S {}

/// A shared solid of any kind. Each split costs one indirect call.
#[derive(Clone)]
pub struct AnySolid {
    solid: Arc<dyn OwnedSolid>,
    nesting: u32,
}

/// Any solid on a frame. The solid may borrow data for `'c`.
#[derive(Clone)]
pub struct AnyClassifier<'c>(Arc<dyn ErasedClassifier + 'c>);

/// A worker on any solid.
pub struct AnyWorker<'c>(Box<dyn ErasedWorker + 'c>);

/// A part of an [`AnySolid`]: its index among the parts that the worker keeps.
#[derive(Debug, Clone, Copy)]
pub struct ErasedPart(usize);

impl AnySolid {
    /// The greatest number of solids within each other; see [`nesting`](Self::nesting).
    pub const MOST_NESTED: u32 = 64;

    /// Wraps a solid that contains `nesting` solids within each other.
    pub(in crate::solid) fn around<S: Solid + 'static>(solid: S, nesting: u32) -> AnySolid {
        AnySolid { solid: Arc::new(solid), nesting: nesting.saturating_add(1) }
    }

    /// The solid behind the type, if it has the type `S`.
    pub fn get<S: Any>(&self) -> Option<&S> {
        self.solid.as_any().downcast_ref()
    }

    /// The number of `AnySolid`s within each other, this one included. Every question passes from one to the
    /// next, so that the number is limited to bound the use of the stack: a solid with more than 64 within
    /// each other cannot be put on a frame. (The count includes `AnySolid`s within expressions, and within
    /// transforms, counters and similar wrappers of `AnySolid` or `Csg`. Any other solid counts as one
    /// without inner solids.)
    pub fn nesting(&self) -> u32 {
        self.nesting
    }
}

impl AnySolid {
    /// The solid as moved by its own kind, if the kind can move it.
    pub(in crate::solid) fn placed_by_kind(&self, placement: &Affine) -> Result<Option<AnySolid>, Error> {
        if self.nesting > AnySolid::MOST_NESTED {
            return Ok(None);
        }
        OwnedSolid::placed(&*self.solid, placement)
    }

    /// An address that identifies a solid and its clones as long as they exist.
    pub(in crate::solid) fn address(&self) -> usize {
        Arc::as_ptr(&self.solid).cast::<()>() as usize
    }
}

// ---- the object-safe counterparts ---------------------------------------------------------------------

mod sealed {
    use super::*;

    /// The methods of [`DynSolid`]. They are not public, because their names are those of [`Solid`].
    pub trait ErasedSolid: Send + Sync {
        fn on<'c>(&self, frame: &Frame, control: &Control<'_>) -> Result<AnyClassifier<'c>, Error>
        where
            Self: 'c;
        fn placed<'c>(&self, placement: &Affine) -> Result<Option<Box<dyn DynSolid + 'c>>, Error>
        where
            Self: 'c;
        fn bounds(&self) -> Option<Bounds>;
        fn home(&self) -> Option<Frame>;
        fn fingerprint(&self) -> Option<Fingerprint>;
        fn motion(&self) -> Motion;
        fn kept_bytes(&self) -> u64;
        fn sole_mesh(&self) -> Option<&TriangleMesh>;
    }
}

impl<S: Solid> sealed::ErasedSolid for S {
    fn on<'c>(&self, frame: &Frame, control: &Control<'_>) -> Result<AnyClassifier<'c>, Error>
    where
        S: 'c,
    {
        Ok(Solid::on(self, frame, control)?.erased())
    }

    fn placed<'c>(&self, placement: &Affine) -> Result<Option<Box<dyn DynSolid + 'c>>, Error>
    where
        S: 'c,
    {
        Ok(match Solid::placed(self, placement)? {
            Some(placed) => Some(Box::new(placed)),
            None => None,
        })
    }

    fn bounds(&self) -> Option<Bounds> {
        Solid::bounds(self)
    }

    fn home(&self) -> Option<Frame> {
        Solid::home(self)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Solid::fingerprint(self)
    }

    fn motion(&self) -> Motion {
        Solid::motion(self)
    }

    fn kept_bytes(&self) -> u64 {
        Solid::kept_bytes(self)
    }

    fn sole_mesh(&self) -> Option<&TriangleMesh> {
        Solid::sole_mesh(self)
    }
}

/// (The methods that are called here are those of the counterpart: they come first for an object.)
impl<'s> Solid for dyn DynSolid + 's {
    forward_solid!(AnyClassifier<'s>, self => self);
}

/// A solid that [`AnySolid`] owns.
trait OwnedSolid: DynSolid {
    fn as_any(&self) -> &dyn Any;
    fn placed(&self, placement: &Affine) -> Result<Option<AnySolid>, Error>;
}

impl<S: Solid + 'static> OwnedSolid for S {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn placed(&self, placement: &Affine) -> Result<Option<AnySolid>, Error> {
        Ok(Solid::placed(self, placement)?.map(AnySolid::new))
    }
}

impl Solid for AnySolid {
    type Classifier = AnyClassifier<'static>;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<AnyClassifier<'static>, Error> {
        if self.nesting > AnySolid::MOST_NESTED {
            return Err(Error::Limit {
                what: "solids within each other",
                limit: AnySolid::MOST_NESTED.into(),
            });
        }
        self.solid.on(frame, control)
    }

    fn placed(&self, placement: &Affine) -> Result<Option<AnySolid>, Error> {
        AnySolid::placed(self, placement).map(Some)
    }

    forward_solid!(@description self => Shallow(self));
}

/// A solid's description of itself, unless too many solids lie within each other: no answer may overflow the
/// stack.
struct Shallow<'s>(&'s AnySolid);

impl<'s> Shallow<'s> {
    fn known(&self) -> Option<&'s dyn OwnedSolid> {
        (self.0.nesting <= AnySolid::MOST_NESTED).then_some(&*self.0.solid)
    }

    fn bounds(&self) -> Option<Bounds> {
        self.known()?.bounds()
    }

    fn home(&self) -> Option<Frame> {
        self.known()?.home()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.known()?.fingerprint()
    }

    fn motion(&self) -> Motion {
        self.known().map_or(Motion::Conservative, |solid| solid.motion())
    }

    fn kept_bytes(&self) -> u64 {
        self.known().map_or(0, |solid| solid.kept_bytes())
    }

    fn sole_mesh(&self) -> Option<&'s TriangleMesh> {
        self.0.mesh_by_kind().or_else(|| self.known()?.sole_mesh())
    }
}

impl<'c> AnyClassifier<'c> {
    pub(super) fn new<C: Classifier + 'c>(classifier: C) -> AnyClassifier<'c> {
        AnyClassifier(Arc::new(classifier))
    }
}

trait ErasedClassifier: Send + Sync {
    fn frame(&self) -> &Frame;
    fn worker<'c>(self: Arc<Self>) -> Result<AnyWorker<'c>, Error>
    where
        Self: 'c;
    fn exterior(&self) -> Tag;
    fn proof(&self) -> Proof;
    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error>;
    fn kept_bytes(&self) -> u64;
}

impl<C: Classifier> ErasedClassifier for C {
    fn worker<'c>(self: Arc<Self>) -> Result<AnyWorker<'c>, Error>
    where
        C: 'c,
    {
        let worker = Classifier::worker(&*self)?;
        let (parts, runs, passing) = (Vec::new(), Vec::new(), Vec::new());
        let typed = Typed { worker, parts, runs, passing, classifier: self };
        // Some workers are large from the start.
        Ok(AnyWorker(memory::boxed(typed)?))
    }

    fn frame(&self) -> &Frame {
        Classifier::frame(self)
    }

    fn exterior(&self) -> Tag {
        Classifier::exterior(self)
    }

    fn proof(&self) -> Proof {
        Classifier::proof(self)
    }

    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error> {
        Classifier::answer_whole(self, question, control)
    }

    fn kept_bytes(&self) -> u64 {
        Classifier::kept_bytes(self)
    }
}

impl<'c> Classifier for AnyClassifier<'c> {
    type Worker = AnyWorker<'c>;

    fn worker(&self) -> Result<AnyWorker<'c>, Error> {
        self.0.clone().worker()
    }

    // Without a second wrapper.
    fn erased<'e>(self) -> AnyClassifier<'e>
    where
        Self: 'e,
    {
        self
    }

    forward_classifier!(self => self.0);
}

/// A worker, and the parts that it has handed out.
struct Typed<C: Classifier> {
    worker: C::Worker,
    /// The parts, with their places among the cells of a `split64`. (A worker adds parts in this form.)
    parts: Vec<(u8, Part<C>)>,
    /// The parts that one answer made: the index of the first, and the height of the worker's memory
    /// afterwards.
    runs: Vec<(usize, usize)>,
    /// The parts of one element on their way in.
    passing: Vec<(u8, Part<C>)>,
    /// The classifier that made the worker.
    classifier: Arc<C>,
}

type Part<C> = <<C as Classifier>::Worker as Parts>::Part;

impl<C: Classifier> Typed<C> {
    /// Notes that the parts from `first` on were made by one answer.
    fn note_run(&mut self, first: usize) -> Result<(), Error> {
        if first == self.parts.len() {
            return Ok(());
        }
        memory::push(&mut self.runs, (first, self.worker.mark()))
    }

    fn hand_out(&mut self, part: Part<C>) -> Result<ErasedPart, Error> {
        let first = self.parts.len();
        memory::push(&mut self.parts, (0, part))?;
        self.note_run(first)?;
        Ok(ErasedPart(first))
    }

    fn hand_out_eight(&mut self, verdicts: [Verdict<Part<C>>; 8]) -> Result<[Verdict<ErasedPart>; 8], Error> {
        let first = self.parts.len();
        self.parts.try_reserve(8)?;
        let erased = verdicts.each(|verdict| {
            verdict.map(|part| {
                self.parts.push((0, part));
                ErasedPart(self.parts.len() - 1)
            })
        });
        self.note_run(first)?;
        Ok(erased)
    }

    /// The cells with the worker's own parts.
    fn own(&self, cells: &[(Cell, ErasedPart)]) -> Result<Vec<(Cell, Part<C>)>, Error> {
        let own = memory::collected(cells.iter().map(|(cell, part)| (*cell, self.part(part))))?;
        Ok(own)
    }

    fn part(&self, part: &ErasedPart) -> Part<C> {
        self.parts[part.0].1.clone()
    }
}

trait ErasedWorker: Send + Sync {
    /// The addresses of the classifier that made the worker, and of the `Typed`.
    fn identity(&self) -> [*const (); 2];
    fn frame(&self) -> &Frame;
    fn root(&mut self) -> Result<Verdict<ErasedPart>, Error>;
    fn mark(&self) -> usize;
    fn scratch_bytes(&self) -> usize;
    fn release(&mut self, mark: usize);
    fn hand_over(&mut self, from: &AnyWorker<'_>, part: &ErasedPart) -> Result<ErasedPart, Error>;
    fn recall(&mut self, cell: Cell) -> Option<ErasedPart>;
    fn split(&mut self, cell: Cell, part: &ErasedPart) -> Result<[Verdict<ErasedPart>; 8], Error>;
    fn split64(
        &mut self,
        cell: Cell,
        part: &ErasedPart,
        parts: &mut Vec<(u8, ErasedPart)>,
    ) -> Result<Planes, Error>;
    fn likes_many(&self) -> bool;
    fn split_many(
        &mut self,
        cells: &[(Cell, ErasedPart)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<ErasedPart>; 8]>,
    ) -> Result<(), Error>;
    fn sample_many(
        &mut self,
        cells: &[(Cell, ErasedPart)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error>;
    fn fill(&mut self, cell: Cell, part: &ErasedPart, block: &mut Block) -> Result<bool, Error>;
    fn subtree(&self, part: &ErasedPart) -> Option<Subtree<'_>>;
    fn sample64(&mut self, cell: Cell, parts: &[(u8, ErasedPart)]) -> Result<Option<u64>, Error>;
    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error>;
    fn answer(&mut self, cell: Cell, part: &ErasedPart, question: Question<'_>) -> Result<(), Error>;
}

// (An array of one, because its box can be made from a vector, whose allocation can fail without a panic.)
impl<C: Classifier> ErasedWorker for [Typed<C>; 1] {
    fn identity(&self) -> [*const (); 2] {
        [Arc::as_ptr(&self[0].classifier).cast(), ptr::from_ref(&self[0]).cast()]
    }

    fn frame(&self) -> &Frame {
        self[0].worker.frame()
    }

    fn root(&mut self) -> Result<Verdict<ErasedPart>, Error> {
        self[0].worker.root()?.try_map(|part| self[0].hand_out(part))
    }

    fn mark(&self) -> usize {
        self[0].parts.len()
    }

    fn scratch_bytes(&self) -> usize {
        size_of_val(&*self[0].parts) + size_of_val(&*self[0].runs) + self[0].worker.scratch_bytes()
    }

    fn release(&mut self, mark: usize) {
        let Typed { worker, parts, runs, .. } = &mut self[0];
        parts.truncate(mark);
        while runs.pop_if(|&mut (first, _)| first >= mark).is_some() {}
        worker.release(runs.last().map_or(0, |&(_, height)| height));
    }

    fn hand_over(&mut self, from: &AnyWorker<'_>, part: &ErasedPart) -> Result<ErasedPart, Error> {
        let ([own, _], [theirs, typed]) = (self.identity(), from.0.identity());
        assert!(own == theirs, "a part can only be handed over between workers of one classifier");
        // SAFETY: both workers keep an `Arc` of the classifier alive, so that equal addresses mean one
        // allocation. It was made for one type `C`. A worker that holds an `Arc<C>` is a `Typed<C>`, which
        // the borrow of `from` keeps in place.
        #[allow(unsafe_code)]
        let from = unsafe { &*typed.cast::<Typed<C>>() };
        let part = self[0].worker.hand_over(&from.worker, &from.parts[part.0].1)?;
        self[0].hand_out(part)
    }

    fn recall(&mut self, cell: Cell) -> Option<ErasedPart> {
        let part = self[0].worker.recall(cell)?;
        self[0].hand_out(part).ok()
    }

    fn split(&mut self, cell: Cell, part: &ErasedPart) -> Result<[Verdict<ErasedPart>; 8], Error> {
        let part = self[0].part(part);
        let verdicts = self[0].worker.split(cell, &part)?;
        self[0].hand_out_eight(verdicts)
    }

    fn split64(
        &mut self,
        cell: Cell,
        part: &ErasedPart,
        parts: &mut Vec<(u8, ErasedPart)>,
    ) -> Result<Planes, Error> {
        let (part, first) = (self[0].part(part), self[0].parts.len());
        let Typed { worker, parts: kept, .. } = &mut self[0];
        let planes = worker.split64(cell, &part, kept)?;
        parts.try_reserve(kept.len() - first)?;
        parts.extend((first..).zip(&kept[first..]).map(|(index, &(c, _))| (c, ErasedPart(index))));
        self[0].note_run(first)?;
        Ok(planes)
    }

    fn likes_many(&self) -> bool {
        self[0].worker.likes_many()
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, ErasedPart)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<ErasedPart>; 8]>,
    ) -> Result<(), Error> {
        let (own, mut found) = (self[0].own(cells)?, Vec::new());
        let done = self[0].worker.split_many(&own, control, &mut found);
        verdicts.try_reserve(found.len())?;
        for eight in found {
            verdicts.push(self[0].hand_out_eight(eight)?);
        }
        done
    }

    fn fill(&mut self, cell: Cell, part: &ErasedPart, block: &mut Block) -> Result<bool, Error> {
        let part = self[0].part(part);
        self[0].worker.fill(cell, &part, block)
    }

    fn subtree(&self, part: &ErasedPart) -> Option<Subtree<'_>> {
        self[0].worker.subtree(&self[0].parts[part.0].1)
    }

    fn sample64(&mut self, cell: Cell, parts: &[(u8, ErasedPart)]) -> Result<Option<u64>, Error> {
        let Typed { worker, parts: kept, passing, .. } = &mut self[0];
        passing.clear();
        passing.try_reserve(parts.len())?;
        passing.extend(parts.iter().map(|(c, part)| (*c, kept[part.0].1.clone())));
        worker.sample64(cell, passing)
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, ErasedPart)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        let own = self[0].own(cells)?;
        self[0].worker.sample_many(&own, control, inside)
    }

    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        self[0].worker.inside(points, answers)
    }

    fn answer(&mut self, cell: Cell, part: &ErasedPart, question: Question<'_>) -> Result<(), Error> {
        let part = self[0].part(part);
        self[0].worker.answer(cell, &part, question)
    }
}

impl Parts for AnyWorker<'_> {
    fn hand_over(&mut self, from: &Self, part: &ErasedPart) -> Result<ErasedPart, Error> {
        self.0.hand_over(from, part)
    }

    forward_parts!(ErasedPart, self => self.0);
}

impl Batch for AnyWorker<'_> {
    forward_batch!(ErasedPart, self => self.0);
}

impl Worker for AnyWorker<'_> {
    fn split(&mut self, cell: Cell, part: &ErasedPart) -> Result<[Verdict<ErasedPart>; 8], Error> {
        self.0.split(cell, part)
    }

    fn split64(
        &mut self,
        cell: Cell,
        part: &ErasedPart,
        parts: &mut Vec<(u8, ErasedPart)>,
    ) -> Result<Planes, Error> {
        self.0.split64(cell, part, parts)
    }

    fn fill(&mut self, cell: Cell, part: &ErasedPart, block: &mut Block) -> Result<bool, Error> {
        self.0.fill(cell, part, block)
    }

    fn subtree(&self, part: &ErasedPart) -> Option<Subtree<'_>> {
        self.0.subtree(part)
    }

    forward_answers!(ErasedPart, self => self.0);
}
