//! A stored octree in shards, as a solid: the shards are not joined.

use super::{StoredOnFrame, StoredPart};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Cell, Frame};
use crate::memory;
use crate::octree::{Octree, Planes, Proof, Tag};
use crate::solid::{
    Batch, Classifier, FreeParts, OCTANTS, Question, Solid, Subtree, Verdict, WholeQuestion, Worker,
    sample_one_by_one, split_one_by_one, split_twice,
};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use hashbrown::HashMap;
use once_cell::race::OnceBox;

/// An octree in [shards](crate::Shard), in memory or on disk. Each shard is an octree: the top, and the
/// shards of cells that the top leaves open. The octree is a solid without being joined. A shard is read when
/// one of its cells is queried. A cell whose shard is missing is PARTIAL.
///
/// Its cells are those of the octree that [`join`](crate::op::join) makes. It keeps no list of surfaces
/// ([`WholeQuestion::Surfaces`]): to make an extended octree of it, join it.
///
/// ```
/// use leafless::solid::ShardedOctree;
/// use leafless::{Control, Csg, Frame, Rule, Shard, build_shard, measure};
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 7)?, Control::default());
/// let ball = Csg::ball([0.1, 0.0, 0.0], 0.75)?;
/// let make = |shard| build_shard(&ball, &frame, Rule::Certified, shard, &control);
/// let top = make(Shard::Top { level: 1 })?;
/// let cells = top.view().open_cells(1)?;
/// let shards = cells.iter().map(|&cell| Ok((cell, make(Shard::Below(cell))?)));
/// let whole = ShardedOctree::new(top, shards.collect::<Result<Vec<_>, leafless::Error>>()?)?;
/// assert!(measure(&whole, &frame, 0.0, &control)?.volume.contains(1.767145867644));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Clone)]
pub struct ShardedOctree(Arc<Pieces>);

struct Pieces {
    top: Octree,
    /// The level of the shards' cells; 0 if there are no shards.
    level: u8,
    /// The shards in ascending Morton order of their cells.
    shards: Vec<(u64, Octree)>,
    exterior: Tag,
    proof: Proof,
}

impl ShardedOctree {
    /// Combines a top and shards, in any order. O(shards).
    ///
    /// # Errors
    /// [`Error::FrameMismatch`] if the frames differ; [`Error::Argument`] if the cells are not of one level
    /// of the frame, or one has two shards.
    pub fn new(
        top: Octree,
        shards: impl IntoIterator<Item = (Cell, Octree)>,
    ) -> Result<ShardedOctree, Error> {
        let wrong = |problem| Error::Argument { name: "shards", problem };
        let (mut level, mut list) = (None, Vec::new());
        let (mut exterior, mut proof) = (top.view().exterior(), top.proof());
        for (cell, shard) in shards {
            if shard.frame() != top.frame() {
                return Err(top.frame().mismatch(shard.frame()));
            }
            let is_there = cell.level <= top.frame().depth() && cell.at.iter().all(|&a| a >> cell.level == 0);
            if !is_there || *level.get_or_insert(cell.level) != cell.level {
                return Err(wrong("must belong to cells of one level of the frame"));
            }
            if exterior == Tag::Partial {
                exterior = shard.view().exterior();
            }
            proof = proof.and(shard.proof());
            memory::push(&mut list, (cell.morton(), shard))?;
        }
        list.sort_unstable_by_key(|(code, _)| *code);
        if list.windows(2).any(|pair| pair[0].0 == pair[1].0) {
            return Err(wrong("must belong to different cells"));
        }
        let level = level.unwrap_or(0);
        Ok(ShardedOctree(Arc::new(Pieces { top, level, shards: list, exterior, proof })))
    }

    /// The frame.
    pub fn frame(&self) -> &Frame {
        self.0.top.frame()
    }

    /// The top.
    pub fn top(&self) -> &Octree {
        &self.0.top
    }

    /// The shards, in ascending Morton order of their cells.
    pub fn shards(&self) -> impl ExactSizeIterator<Item = (Cell, &Octree)> {
        let cell = |code| Cell::from_morton(self.0.level, code).unwrap_or(Cell::ROOT);
        self.0.shards.iter().map(move |(code, shard)| (cell(*code), shard))
    }
}

impl Pieces {
    /// The index of the shard of a cell of the shards' level.
    fn number(&self, cell: Cell) -> Option<usize> {
        self.shards.binary_search_by_key(&cell.morton(), |(code, _)| *code).ok()
    }

    /// Returns whether there are shards in a cell of the shards' level, or of a level above.
    fn has_any_in(&self, cell: Cell) -> bool {
        let shift = 3 * (self.level - cell.level);
        let first = self.shards.partition_point(|(code, _)| code >> shift < cell.morton());
        self.shards.get(first).is_some_and(|(code, _)| code >> shift == cell.morton())
    }
}

impl Solid for ShardedOctree {
    type Classifier = ShardedOnFrame;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<ShardedOnFrame, Error> {
        let mut placed = memory::with_capacity(self.0.shards.len())?;
        placed.resize_with(self.0.shards.len(), OnceBox::new);
        let top = StoredOnFrame::new(self.0.top.clone(), frame)?;
        Ok(ShardedOnFrame { pieces: self.0.clone(), top, placed: Arc::new(placed) })
    }

    fn bounds(&self) -> Option<Bounds> {
        (self.0.exterior == Tag::Empty && self.0.proof.empty).then(|| Bounds::of(self.frame()))
    }

    fn home(&self) -> Option<Frame> {
        Some(*self.frame())
    }

    fn kept_bytes(&self) -> u64 {
        self.0.shards.iter().fold(self.0.top.bytes(), |sum, (_, shard)| sum + shard.bytes())
    }
}

/// A sharded octree on a frame of its universe.
#[derive(Clone)]
pub struct ShardedOnFrame {
    pieces: Arc<Pieces>,
    top: StoredOnFrame<Octree>,
    /// The shards that were queried so far.
    placed: Arc<Vec<OnceBox<StoredOnFrame<Octree>>>>,
}

impl Classifier for ShardedOnFrame {
    type Worker = ShardedWorker;

    fn frame(&self) -> &Frame {
        &self.top.frame
    }

    fn worker(&self) -> Result<ShardedWorker, Error> {
        Ok(ShardedWorker { all: self.clone(), own: HashMap::new() })
    }

    fn exterior(&self) -> Tag {
        self.pieces.exterior
    }

    fn proof(&self) -> Proof {
        self.pieces.proof
    }

    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error> {
        match question {
            // The surfaces of the top are not all surfaces.
            WholeQuestion::Surfaces(_) | WholeQuestion::Layers(_) => Ok(()),
            question => self.top.answer_whole(question, control),
        }
    }
}

/// The data about a cell.
#[derive(Debug, Clone, Copy)]
pub enum ShardedPart {
    /// A cell that the top describes.
    Top(StoredPart),
    /// A cell of which nothing is known, but which contains shards.
    Open,
    /// A cell that a shard describes, by the number of the shard.
    Shard(u32, StoredPart),
}

/// The scratch memory of one thread.
pub struct ShardedWorker {
    all: ShardedOnFrame,
    own: HashMap<u32, StoredOnFrame<Octree>>,
}

impl ShardedWorker {
    fn shard(&mut self, number: u32) -> Result<&mut StoredOnFrame<Octree>, Error> {
        if !self.own.contains_key(&number) {
            let place = &self.all.placed[number as usize];
            let placed = place.get_or_try_init(|| {
                let (_, shard) = &self.all.pieces.shards[number as usize];
                StoredOnFrame::new(shard.clone(), &self.all.top.frame).map(Box::new)
            })?;
            self.own.try_reserve(1)?;
            self.own.insert(number, placed.worker()?);
        }
        self.own.get_mut(&number).ok_or(Error::OutOfMemory)
    }

    /// The verdict on a cell with this verdict in the top.
    fn of_top(&mut self, cell: Cell, verdict: Verdict<StoredPart>) -> Result<Verdict<ShardedPart>, Error> {
        Ok(match verdict {
            Verdict::Empty => Verdict::Empty,
            Verdict::Full => Verdict::Full,
            Verdict::Partial(part) => Verdict::Partial(ShardedPart::Top(part)),
            Verdict::Undecided if cell.level < self.all.pieces.level => {
                if self.all.pieces.has_any_in(cell) {
                    Verdict::Partial(ShardedPart::Open)
                } else {
                    Verdict::Undecided
                }
            }
            Verdict::Undecided if cell.level == self.all.pieces.level => match self.all.pieces.number(cell) {
                Some(number) => self.of_shard(number as u32, cell)?,
                None => Verdict::Undecided,
            },
            Verdict::Undecided => Verdict::Undecided,
        })
    }

    /// The verdict of a shard on its cell.
    fn of_shard(&mut self, number: u32, cell: Cell) -> Result<Verdict<ShardedPart>, Error> {
        let worker = self.shard(number)?;
        let mut verdict = worker.root()?;
        for level in 1..=cell.level {
            let Verdict::Partial(part) = verdict else { break };
            let eight = worker.split(cell.ancestor(level - 1), &part)?;
            verdict = eight[usize::from(cell.ancestor(level).octant())];
        }
        Ok(in_shard(number, verdict))
    }
}

fn in_shard(number: u32, verdict: Verdict<StoredPart>) -> Verdict<ShardedPart> {
    match verdict {
        Verdict::Empty => Verdict::Empty,
        Verdict::Full => Verdict::Full,
        Verdict::Undecided => Verdict::Undecided,
        Verdict::Partial(part) => Verdict::Partial(ShardedPart::Shard(number, part)),
    }
}

impl FreeParts for ShardedWorker {
    type Part = ShardedPart;
}

impl Batch for ShardedWorker {
    fn likes_many(&self) -> bool {
        false
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, ShardedPart)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<ShardedPart>; 8]>,
    ) -> Result<(), Error> {
        split_one_by_one(self, cells, control, verdicts)
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, ShardedPart)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        sample_one_by_one(self, cells, control, inside)
    }

    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        self.all.top.inside(points, answers)?;
        let (frame, level) = (self.all.top.frame, self.all.pieces.level);
        if level > frame.depth() {
            return Ok(());
        }
        for (point, answer) in points.iter().zip(answers).filter(|(_, answer)| answer.is_none()) {
            let cell = frame.cell_of(*point).map(|at| Cell { level: frame.depth(), at }.ancestor(level));
            if let Some(number) = cell.and_then(|cell| self.all.pieces.number(cell)) {
                let shard = self.shard(number as u32)?;
                shard.inside(core::slice::from_ref(point), core::slice::from_mut(answer))?;
            }
        }
        Ok(())
    }

    fn recall(&mut self, _: Cell) -> Option<ShardedPart> {
        None
    }
}

impl Worker for ShardedWorker {
    fn frame(&self) -> &Frame {
        &self.all.top.frame
    }

    fn root(&mut self) -> Result<Verdict<ShardedPart>, Error> {
        let root = self.all.top.root()?;
        self.of_top(Cell::ROOT, root)
    }

    fn split(&mut self, cell: Cell, part: &ShardedPart) -> Result<[Verdict<ShardedPart>; 8], Error> {
        let eight = match part {
            ShardedPart::Top(part) => self.all.top.split(cell, part)?,
            ShardedPart::Open => OCTANTS.each(|_| Verdict::Undecided),
            ShardedPart::Shard(number, part) => {
                return Ok(self
                    .shard(*number)?
                    .split(cell, part)?
                    .each(|verdict| in_shard(*number, verdict)));
            }
        };
        let mut verdicts = OCTANTS.each(|_| Verdict::Undecided);
        for ((k, verdict), known) in OCTANTS.into_iter().zip(eight).zip(&mut verdicts) {
            *known = self.of_top(cell.child(k), verdict)?;
        }
        Ok(verdicts)
    }

    fn answer(&mut self, cell: Cell, part: &ShardedPart, question: Question<'_>) -> Result<(), Error> {
        match (part, question) {
            // The numbers of surfaces are valid in one shard only.
            (_, Question::Surfaces(_) | Question::Layers(_)) | (ShardedPart::Open, _) => Ok(()),
            (ShardedPart::Top(part), question) => self.all.top.answer(cell, part, question),
            (ShardedPart::Shard(number, part), question) => self.shard(*number)?.answer(cell, part, question),
        }
    }

    fn split64(
        &mut self,
        cell: Cell,
        part: &ShardedPart,
        parts: &mut Vec<(u8, ShardedPart)>,
    ) -> Result<Planes, Error> {
        let ShardedPart::Shard(number, part) = part else { return split_twice(self, cell, part, parts) };
        let mut own = Vec::new();
        let planes = self.shard(*number)?.split64(cell, part, &mut own)?;
        for (c, part) in own {
            memory::push(parts, (c, ShardedPart::Shard(*number, part)))?;
        }
        Ok(planes)
    }

    fn subtree(&self, part: &ShardedPart) -> Option<Subtree<'_>> {
        match part {
            ShardedPart::Shard(number, part) => self.own.get(number)?.subtree(part),
            _ => None,
        }
    }
}
