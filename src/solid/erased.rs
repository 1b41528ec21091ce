//! Solids of any kind behind one type.
//!
//! [`Solid`] has associated types so that loops over it compile to tight code. Programs that hold shapes of
//! different kinds in one place (the C interface first of all) use [`AnySolid`], which is a `Solid` itself.

use super::{Fingerprint, Scratch, Solid, Verdict};
use crate::error::Error;
use crate::lattice::{Cube, Frame};
use crate::octree::{Block, Planes, Tag};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::any::Any;

/// Most solids within each other; see [`Solid::nesting`].
pub(crate) const MOST_NESTED: u32 = 64;

/// Any solid, shared. Costs an indirect call a split.
#[derive(Clone)]
pub struct AnySolid {
    solid: Arc<dyn Erased>,
    nesting: u32,
}

/// A part of an [`AnySolid`]: its place among the parts that the scratch memory keeps.
#[derive(Debug, Clone, Copy)]
pub struct ErasedPart(usize);

/// Scratch memory of an [`AnySolid`], made by the solid when it is first used.
#[derive(Default)]
pub struct ErasedScratch(Option<Box<dyn Slot>>);

impl AnySolid {
    /// Wraps a solid.
    pub fn new<S: Solid<Part: 'static, Scratch: 'static> + Send + 'static>(solid: S) -> AnySolid {
        let nesting = solid.nesting().saturating_add(1);
        AnySolid { solid: Arc::new(solid), nesting }
    }

    /// The solid behind the type, if it is of this one.
    pub fn get<S: Any>(&self) -> Option<&S> {
        self.solid.as_any().downcast_ref()
    }
}

/// The typed scratch memory behind an [`ErasedScratch`]: the solid's own, and the parts that were handed out,
/// each with the height that the solid's own then had.
struct Typed<S: Solid> {
    scratch: S::Scratch,
    parts: Vec<(S::Part, usize)>,
    /// Those of an element on their way in or out.
    passing: Vec<(u8, S::Part)>,
}

impl<S: Solid> Typed<S> {
    fn hand_out(&mut self, part: S::Part) -> Result<ErasedPart, Error> {
        self.parts.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
        self.parts.push((part, self.scratch.mark()));
        Ok(ErasedPart(self.parts.len() - 1))
    }
}

trait Slot: Any + Send + Sync {
    fn mark(&self) -> usize;
    fn release(&mut self, mark: usize);
    fn evaluations(&self) -> u64;
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

impl<S: Solid<Part: 'static, Scratch: 'static> + 'static> Slot for [Typed<S>; 1] {
    fn mark(&self) -> usize {
        self[0].parts.len()
    }

    fn release(&mut self, mark: usize) {
        let [Typed { scratch, parts, .. }] = self;
        parts.truncate(mark);
        scratch.release(parts.last().map_or(0, |&(_, height)| height));
    }

    fn evaluations(&self) -> u64 {
        self[0].scratch.evaluations()
    }

    fn as_any(&self) -> &dyn Any {
        &self[0]
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        &mut self[0]
    }
}

impl Scratch for ErasedScratch {
    fn mark(&self) -> usize {
        self.0.as_ref().map_or(0, |slot| slot.mark())
    }

    fn release(&mut self, mark: usize) {
        if let Some(slot) = &mut self.0 {
            slot.release(mark);
        }
    }

    fn evaluations(&self) -> u64 {
        self.0.as_ref().map_or(0, |slot| slot.evaluations())
    }
}

impl ErasedScratch {
    /// The scratch memory as that of `S`. One that another kind of solid left behind is replaced: its parts
    /// mean nothing here.
    fn typed<S: Solid<Part: 'static, Scratch: 'static> + 'static>(&mut self) -> Result<&mut Typed<S>, Error> {
        if !self.0.as_ref().is_some_and(|slot| slot.as_any().is::<Typed<S>>()) {
            // Some solids' memory is large from the beginning: by way of a vector it can be refused.
            let mut slot = Vec::new();
            slot.try_reserve_exact(1).map_err(|_| Error::OutOfMemory)?;
            slot.push(Typed::<S> { scratch: S::Scratch::default(), parts: Vec::new(), passing: Vec::new() });
            let slot: Box<[Typed<S>; 1]> =
                slot.into_boxed_slice().try_into().map_err(|_| Error::OutOfMemory)?;
            self.0 = Some(slot);
        }
        let slot = self.0.as_mut().and_then(|slot| slot.as_any_mut().downcast_mut());
        Ok(slot.unwrap_or_else(|| unreachable!("the slot was just made for this type")))
    }

    fn part<S: Solid<Part: 'static, Scratch: 'static> + 'static>(
        &self,
        part: ErasedPart,
    ) -> Option<(&S::Scratch, &S::Part)> {
        let typed = self.0.as_ref()?.as_any().downcast_ref::<Typed<S>>()?;
        Some((&typed.scratch, &typed.parts.get(part.0)?.0))
    }
}

/// The object-safe face of a solid.
trait Erased: Send + Sync {
    fn as_any(&self) -> &dyn Any;
    fn root(&self, scratch: &mut ErasedScratch, frame: &Frame) -> Result<Verdict<ErasedPart>, Error>;
    fn split(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: ErasedPart,
    ) -> Result<[Verdict<ErasedPart>; 8], Error>;
    fn split64(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: ErasedPart,
        parts: &mut Vec<(u8, ErasedPart)>,
    ) -> Result<Planes, Error>;
    fn sample64(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        parts: &[(u8, ErasedPart)],
    ) -> Result<Option<u64>, Error>;
    fn fill(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: ErasedPart,
        block: &mut Block,
    ) -> Result<bool, Error>;
    fn sample(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: ErasedPart,
    ) -> Result<Option<bool>, Error>;
    fn exterior(&self, frame: &Frame) -> Tag;
    fn fingerprint(&self) -> Option<Fingerprint>;
    fn hand_over(
        &self,
        from: &ErasedScratch,
        part: ErasedPart,
        to: &mut ErasedScratch,
    ) -> Result<ErasedPart, Error>;
}

impl<S: Solid<Part: 'static, Scratch: 'static> + Send + 'static> Erased for S {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn root(&self, scratch: &mut ErasedScratch, frame: &Frame) -> Result<Verdict<ErasedPart>, Error> {
        let typed = scratch.typed::<S>()?;
        Ok(match Solid::root(self, &mut typed.scratch, frame)? {
            Verdict::Empty => Verdict::Empty,
            Verdict::Full => Verdict::Full,
            Verdict::Undecided => Verdict::Undecided,
            Verdict::Partial(part) => Verdict::Partial(typed.hand_out(part)?),
        })
    }

    fn split(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: ErasedPart,
    ) -> Result<[Verdict<ErasedPart>; 8], Error> {
        const UNDECIDED: Verdict<ErasedPart> = Verdict::Undecided;
        let typed = scratch.typed::<S>()?;
        let mut verdicts = [UNDECIDED; 8];
        let Some((part, _)) = typed.parts.get(part.0).cloned() else { return Ok(verdicts) };
        for (verdict, child) in verdicts.iter_mut().zip(Solid::split(self, &mut typed.scratch, cube, &part)?)
        {
            *verdict = match child {
                Verdict::Empty => Verdict::Empty,
                Verdict::Full => Verdict::Full,
                Verdict::Undecided => Verdict::Undecided,
                Verdict::Partial(part) => Verdict::Partial(typed.hand_out(part)?),
            };
        }
        Ok(verdicts)
    }

    fn split64(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: ErasedPart,
        parts: &mut Vec<(u8, ErasedPart)>,
    ) -> Result<Planes, Error> {
        let typed = scratch.typed::<S>()?;
        let Some((part, _)) = typed.parts.get(part.0).cloned() else {
            return Ok(Planes::uniform(Tag::Partial));
        };
        typed.passing.clear();
        let planes = Solid::split64(self, &mut typed.scratch, cube, &part, &mut typed.passing)?;
        parts.try_reserve(typed.passing.len()).map_err(|_| Error::OutOfMemory)?;
        typed.parts.try_reserve(typed.passing.len()).map_err(|_| Error::OutOfMemory)?;
        let Typed { scratch, parts: kept, passing } = typed;
        let height = scratch.mark();
        for (c, part) in passing.drain(..) {
            kept.push((part, height));
            parts.push((c, ErasedPart(kept.len() - 1)));
        }
        Ok(planes)
    }

    fn sample64(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        parts: &[(u8, ErasedPart)],
    ) -> Result<Option<u64>, Error> {
        let Typed { scratch, parts: kept, passing } = scratch.typed::<S>()?;
        passing.clear();
        passing.try_reserve(parts.len()).map_err(|_| Error::OutOfMemory)?;
        for (c, part) in parts {
            let Some((part, _)) = kept.get(part.0) else { return Ok(None) };
            passing.push((*c, part.clone()));
        }
        Solid::sample64(self, scratch, cube, passing)
    }

    fn fill(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: ErasedPart,
        block: &mut Block,
    ) -> Result<bool, Error> {
        let typed = scratch.typed::<S>()?;
        match typed.parts.get(part.0).cloned() {
            Some((part, _)) => Solid::fill(self, &mut typed.scratch, cube, &part, block),
            None => Ok(false),
        }
    }

    fn sample(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: ErasedPart,
    ) -> Result<Option<bool>, Error> {
        let typed = scratch.typed::<S>()?;
        let Some((part, _)) = typed.parts.get(part.0).cloned() else { return Ok(None) };
        Solid::sample(self, &mut typed.scratch, cube, &part)
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        Solid::exterior(self, frame)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Solid::fingerprint(self)
    }

    fn hand_over(
        &self,
        from: &ErasedScratch,
        part: ErasedPart,
        to: &mut ErasedScratch,
    ) -> Result<ErasedPart, Error> {
        let to = to.typed::<S>()?;
        match from.part::<S>(part) {
            Some((from, part)) => {
                let part = Solid::hand_over(self, from, part, &mut to.scratch)?;
                to.hand_out(part)
            }
            // A part that does not exist is none that can be split.
            None => Ok(ErasedPart(usize::MAX)),
        }
    }
}

impl Solid for AnySolid {
    type Part = ErasedPart;
    type Scratch = ErasedScratch;

    fn root(&self, scratch: &mut ErasedScratch, frame: &Frame) -> Result<Verdict<ErasedPart>, Error> {
        if self.nesting > MOST_NESTED {
            return Err(Error::Limit { what: "solids within each other", limit: MOST_NESTED.into() });
        }
        self.solid.root(scratch, frame)
    }

    fn split(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: &ErasedPart,
    ) -> Result<[Verdict<ErasedPart>; 8], Error> {
        self.solid.split(scratch, cube, *part)
    }

    fn split64(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: &ErasedPart,
        parts: &mut Vec<(u8, ErasedPart)>,
    ) -> Result<Planes, Error> {
        self.solid.split64(scratch, cube, *part, parts)
    }

    fn sample64(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        parts: &[(u8, ErasedPart)],
    ) -> Result<Option<u64>, Error> {
        self.solid.sample64(scratch, cube, parts)
    }

    fn fill(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: &ErasedPart,
        block: &mut Block,
    ) -> Result<bool, Error> {
        self.solid.fill(scratch, cube, *part, block)
    }

    fn sample(
        &self,
        scratch: &mut ErasedScratch,
        cube: &Cube<'_>,
        part: &ErasedPart,
    ) -> Result<Option<bool>, Error> {
        self.solid.sample(scratch, cube, *part)
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        self.solid.exterior(frame)
    }

    fn nesting(&self) -> u32 {
        self.nesting
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.solid.fingerprint()
    }

    fn hand_over(
        &self,
        from: &ErasedScratch,
        part: &ErasedPart,
        to: &mut ErasedScratch,
    ) -> Result<ErasedPart, Error> {
        self.solid.hand_over(from, *part, to)
    }
}
