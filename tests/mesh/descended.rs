//! A way to switch block-wise scanning off.

use leafless::{Cube, Error, Frame, MeshPart, MeshScratch, MeshSolid, Solid, Tag, Verdict};

/// A mesh that is only ever split, never scanned in blocks.
pub struct Descended<'a>(pub &'a MeshSolid);

impl Solid for Descended<'_> {
    type Part = MeshPart;
    type Scratch = MeshScratch;
    fn root(&self, scratch: &mut MeshScratch, frame: &Frame) -> Result<Verdict<MeshPart>, Error> {
        self.0.root(scratch, frame)
    }
    fn split(
        &self,
        scratch: &mut MeshScratch,
        cube: &Cube<'_>,
        part: &MeshPart,
    ) -> Result<[Verdict<MeshPart>; 8], Error> {
        self.0.split(scratch, cube, part)
    }
    fn sample(
        &self,
        scratch: &mut MeshScratch,
        cube: &Cube<'_>,
        part: &MeshPart,
    ) -> Result<Option<bool>, Error> {
        self.0.sample(scratch, cube, part)
    }
    fn exterior(&self, frame: &Frame) -> Tag {
        self.0.exterior(frame)
    }
    fn hand_over(
        &self,
        from: &MeshScratch,
        part: &MeshPart,
        to: &mut MeshScratch,
    ) -> Result<MeshPart, Error> {
        self.0.hand_over(from, part, to)
    }
}
