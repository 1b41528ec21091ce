//! Records as a solid, and their conversion back into an octree.

use super::descent::{Part, checked};
use super::record::VoxelKind;
use super::records::VoxelRecordsRef;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Cell, Frame};
use crate::octree::{Octree, Proof, Tag};
use crate::op::{Rule, build};
use crate::solid::{Classifier, FreeParts, OneByOne, Question, Solid, Verdict, WholeQuestion, Worker};

/// Records as a solid on their own universe. Inside voxels are FULL. Outside voxels and cells without a
/// record are EMPTY. Boundary voxels have a tag of the caller's choice.
///
/// The verdicts prove what the records do ([`VoxelRecordsRef::proof`]), with a restriction for boundary
/// voxels:
///
/// | boundary voxels as | FULL | EMPTY |
/// |---|---|---|
/// | PARTIAL | as the records | as the records |
/// | FULL | not proven, unless all of them are known to lie inside ([`VoxelRecordsRef::boundary`]) | as the records |
/// | EMPTY | as the records | not proven |
///
/// Without boundary voxels, all columns are as the records.
#[derive(Debug, Clone, Copy)]
pub struct VoxelSolid<'a> {
    records: VoxelRecordsRef<'a>,
    boundary: Tag,
    proof: Proof,
}

/// The solid on a frame: both handle and worker.
#[derive(Debug, Clone, Copy)]
pub struct VoxelsOnFrame<'a> {
    solid: VoxelSolid<'a>,
    frame: Frame,
}

impl<'a> VoxelSolid<'a> {
    /// Makes the solid of records, with the tag `boundary` for boundary voxels. O(records).
    ///
    /// # Errors
    /// [`Error::Argument`] if `boundary` is [`Tag::Branch`].
    pub fn new(records: VoxelRecordsRef<'a>, boundary: Tag) -> Result<VoxelSolid<'a>, Error> {
        let boundary = checked(boundary)?;
        let mut proof = records.proof();
        if boundary != Tag::Partial && records.count(VoxelKind::Boundary) > 0 {
            proof.full &= boundary == Tag::Empty || records.boundary() == Tag::Full;
            proof.empty &= boundary == Tag::Full;
        }
        Ok(VoxelSolid { records, boundary, proof })
    }

    fn verdict(&self, part: &Part) -> Verdict<(usize, usize)> {
        if part.range.is_empty() {
            return Verdict::Empty;
        }
        if self.records.has_own(part) {
            let tag = match self.records.kind_at(part.range.start) {
                VoxelKind::Outside => Tag::Empty,
                VoxelKind::Inside => Tag::Full,
                VoxelKind::Boundary => self.boundary,
                VoxelKind::Refined => Tag::Branch,
            };
            match tag {
                Tag::Empty => return Verdict::Empty,
                Tag::Full => return Verdict::Full,
                Tag::Partial => return Verdict::Undecided,
                Tag::Branch => {}
            }
        }
        Verdict::Partial((part.range.start, part.range.end))
    }
}

impl VoxelRecordsRef<'_> {
    /// Builds the octree of the records, to the depth of their frame. The records of an octree give that
    /// octree again, to the depth of the records. Cells that were split for an attribute merge, and values
    /// are dropped. `boundary` is the tag of boundary voxels: PARTIAL for undecided voxels, FULL for the
    /// voxels of a binary octree.
    ///
    /// The exterior is that of the records. The cells prove as much as the verdicts of [`VoxelSolid`].
    ///
    /// # Errors
    /// [`Error::Argument`] if `boundary` is [`Tag::Branch`], and as [`build`](crate::build).
    pub fn to_octree(&self, boundary: Tag, control: &Control<'_>) -> Result<Octree, Error> {
        build(&VoxelSolid::new(*self, boundary)?, self.frame(), Rule::Certified, control)
    }
}

impl<'a> Solid for VoxelSolid<'a> {
    type Classifier = VoxelsOnFrame<'a>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<VoxelsOnFrame<'a>, Error> {
        if !frame.same_universe(self.records.frame()) {
            return Err(self.records.frame().mismatch(frame));
        }
        Ok(VoxelsOnFrame { solid: *self, frame: *frame })
    }

    fn bounds(&self) -> Option<Bounds> {
        let ends_inside = self.records.exterior() == Tag::Empty && self.proof.empty;
        ends_inside.then(|| Bounds::of(self.records.frame()))
    }

    fn home(&self) -> Option<Frame> {
        Some(*self.records.frame())
    }
}

impl<'a> Classifier for VoxelsOnFrame<'a> {
    type Worker = VoxelsOnFrame<'a>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<VoxelsOnFrame<'a>, Error> {
        Ok(*self)
    }

    fn exterior(&self) -> Tag {
        self.solid.records.exterior()
    }

    fn proof(&self) -> Proof {
        self.solid.proof
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl FreeParts for VoxelsOnFrame<'_> {
    /// The range of the records in the cell: the first, and the one after the last.
    type Part = (usize, usize);
}

impl OneByOne for VoxelsOnFrame<'_> {}

impl Worker for VoxelsOnFrame<'_> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<(usize, usize)>, Error> {
        Ok(self.solid.verdict(&self.solid.records.whole()))
    }

    fn split(&mut self, cell: Cell, part: &(usize, usize)) -> Result<[Verdict<(usize, usize)>; 8], Error> {
        let end = part.1.min(self.solid.records.len());
        let part = Part { cell, range: part.0.min(end)..end };
        Ok(self.solid.records.split(&part).each(|part| self.solid.verdict(&part)))
    }

    fn answer(&mut self, _: Cell, _: &(usize, usize), _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }
}
