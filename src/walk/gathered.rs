//! Solids whose answers come more cheaply many at a time: asked level by level.
//!
//! A host program's functions take most of the time of whoever asks them, and can be asked about all cells of
//! a level at once, by as many threads as there are. What they say is kept, and the octree is then built from
//! that.

use super::split::{Part, each, map_parts, split_each};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::{Proof, Tag};
use crate::solid::{Batch, Classifier, FreeParts, OneByOne, Parts, Question, Verdict, WholeQuestion, Worker};
use alloc::vec::Vec;

/// Levels below a cell that are asked at most before anything is written. (Of a surface some four times as
/// many cells are kept with each.)
pub(crate) const LEVELS: u8 = 8;

/// What a solid said of the cells below one cell.
pub(crate) struct Gathered {
    frame: Frame,
    splits: Vec<Split>,
    /// Whether the centres of finest cells that are open lie inside, if that was asked.
    centres: Vec<Option<bool>>,
}

/// A cell that was split.
struct Split {
    verdicts: [Verdict<()>; 8],
    /// Of the children that are open: where the first was split, or its centre. The others follow.
    first: u32,
}

impl Gathered {
    /// Splits a cell and all that is open below it; asks for the `centres` of finest cells too.
    pub(crate) fn new<C: Classifier>(
        classifier: &C,
        worker: &mut C::Worker,
        (cell, part): (Cell, Part<C>),
        centres: bool,
        job: &Job<'_>,
        threads: usize,
    ) -> Result<Gathered, Error> {
        let frame = *classifier.frame();
        let mut gathered = Gathered { frame, splits: Vec::new(), centres: Vec::new() };
        let mark = worker.mark();
        let mut front = memory::collected([(cell, part)].into_iter())?;
        for level in cell.level..frame.depth() {
            let verdicts = split_each(classifier, worker, &front, threads, job.control())?;
            let finest = level + 1 == frame.depth();
            let mut next = Vec::new();
            gathered.splits.try_reserve(front.len())?;
            // Children are split after all cells of this level, in the same order.
            let below = if finest { 0 } else { gathered.splits.len() + front.len() };
            for ((cell, _), eight) in front.iter().zip(verdicts) {
                let first = u32::try_from(below + next.len()).map_err(|_| Error::OutOfMemory)?;
                next.try_reserve(8)?;
                let verdicts = map_parts(eight, |octant, part| {
                    next.push((cell.child(octant), part));
                    Ok(())
                })?;
                gathered.splits.push(Split { verdicts, first });
            }
            front = next;
            if front.is_empty() {
                break;
            }
        }
        if centres {
            gathered.centres = each(classifier, worker, &front, threads, |worker, cells, inside| {
                worker.sample_many(cells, job.control(), inside)
            })?;
        }
        worker.release(mark);
        Ok(gathered)
    }
}

impl Classifier for &Gathered {
    type Worker = Self;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<Self, Error> {
        Ok(self)
    }

    fn exterior(&self) -> Tag {
        Tag::Partial
    }

    /// The verdicts are those of the solid that was asked, whatever it proves: nobody asks here.
    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

/// Parts are the places of splits, and of the centres of finest cells. The cell that all is below has the
/// first.
impl FreeParts for &Gathered {
    type Part = u32;
}

impl OneByOne for &Gathered {}

impl Worker for &Gathered {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<u32>, Error> {
        Ok(Verdict::Partial(0))
    }

    fn split(&mut self, _: Cell, part: &u32) -> Result<[Verdict<u32>; 8], Error> {
        let Split { verdicts, first } = &self.splits[*part as usize];
        let mut next = *first;
        map_parts(*verdicts, |_, ()| {
            next += 1;
            Ok(next - 1)
        })
    }

    fn answer(&mut self, _: Cell, part: &u32, question: Question<'_>) -> Result<(), Error> {
        if let Question::Centre(inside) = question {
            *inside = self.centres.get(*part as usize).copied().flatten();
        }
        Ok(())
    }
}
