//! Batches for solids that answer more cheaply many at a time: they are queried level by level.
//!
//! A host program's functions usually take most of the running time. They can classify all cells of a level
//! at once, in as many threads as there are. Their answers are kept, and the octree is then built from them.

use super::split::{Part, each, map_parts, split_each};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::{Proof, Tag};
use crate::solid::{Batch, Classifier, FreeParts, OneByOne, Parts, Question, Verdict, WholeQuestion, Worker};
use alloc::vec::Vec;

/// The greatest number of levels below a cell that are queried before anything is written. (With each level,
/// a surface has some four times as many cells to keep.)
pub(crate) const LEVELS: u8 = 8;

/// The answers of a solid for the cells below one cell.
pub(crate) struct Gathered {
    frame: Frame,
    splits: Vec<Split>,
    /// Whether the centres of open finest cells lie inside, if they were queried.
    centres: Vec<Option<bool>>,
}

/// A cell that was split.
struct Split {
    verdicts: [Verdict<()>; 8],
    /// For the open children: the index of the first child's split, or of its centre. The others follow.
    first: u32,
}

impl Gathered {
    /// Splits a cell and all open cells below it; also queries the `centres` of finest cells, if that is set.
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
        let front = memory::collected([(cell, part)].into_iter())?;
        let mark = worker.mark();
        let mut asking = Asking { classifier, worker, centres, job, threads };
        gathered.below(&mut asking, front)?;
        worker.release(mark);
        Ok(gathered)
    }

    /// Splits cells of one level and all open cells below them. Their splits, or their centres, are appended.
    fn below<C: Classifier>(
        &mut self,
        asking: &mut Asking<'_, C>,
        front: Vec<(Cell, Part<C>)>,
    ) -> Result<(), Error> {
        let Asking { classifier, worker, centres, job, threads } = asking;
        let Some(level) = front.first().map(|(cell, _)| cell.level) else { return Ok(()) };
        if level == self.frame.depth() {
            if *centres {
                let inside = each(*classifier, worker, &front, *threads, |worker, cells, inside| {
                    worker.sample_many(cells, job.control(), inside)
                })?;
                self.centres.try_reserve(inside.len())?;
                self.centres.extend(inside);
            }
            return Ok(());
        }
        let verdicts = split_each(*classifier, worker, &front, *threads, job.control())?;
        let mut next = Vec::new();
        // For each cell, the index of its split and the number of its open children.
        let mut families = memory::with_capacity(front.len())?;
        self.splits.try_reserve(front.len())?;
        for ((cell, _), eight) in front.into_iter().zip(verdicts) {
            next.try_reserve(8)?;
            let before = next.len();
            let verdicts = map_parts(eight, |octant, part| {
                next.push((cell.child(octant), part));
                Ok(())
            })?;
            families.push((self.splits.len(), next.len() - before));
            self.splits.push(Split { verdicts, first: 0 });
        }
        // The children of one piece after the other, each with everything below it.
        let is_large = worker.scratch_bytes() > MOST_BYTES;
        let piece = if is_large { families.len().div_ceil(PIECES) } else { families.len() };
        let mut next = next.into_iter();
        for families in families.chunks(piece.max(1)) {
            let finest = level + 1 == self.frame.depth();
            let mut first = if finest { self.centres.len() } else { self.splits.len() };
            let mut count = 0;
            for &(split, open) in families {
                self.splits[split].first = u32::try_from(first).map_err(|_| Error::OutOfMemory)?;
                (first, count) = (first + open, count + open);
            }
            let children = memory::collected(next.by_ref().take(count))?;
            let mark = asking.worker.mark();
            self.below(asking, children)?;
            asking.worker.release(mark);
        }
        Ok(())
    }
}

/// The target and the parameters of the queries.
struct Asking<'a, C: Classifier> {
    classifier: &'a C,
    worker: &'a mut C::Worker,
    /// Whether the centres of finest cells are queried.
    centres: bool,
    job: &'a Job<'a>,
    threads: usize,
}

/// If the parts of a level take more bytes, the cells below are queried in pieces. Where everything is open,
/// a level has eight times as many parts as the one before, and a part of a solid that is moved twice may
/// hold a thousand cells.
const MOST_BYTES: usize = 1 << 26;

/// The number of pieces then.
const PIECES: usize = 64;

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

    /// The verdicts are those of the queried solid, whatever that solid proves. Nobody uses this value.
    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

/// Parts are the indices of splits, and of the centres of finest cells. The top cell has the first index.
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
