//! The one place where trees are made.
//!
//! The maker of a tree walks it depth first, and passes each element after its children. Each level has its
//! own output array. Every level fills up in Morton order, so the concatenation *is* the stored level order.
//! An element whose cells all agree is not stored but reported as that tag. As it then has no stored
//! children, nothing is ever removed again: the result is canonical by construction.

use super::arrays::Arrays;
use super::brick::{Brick, BrickArray, Bricks, OwnedArray, OwnedBricks};
use super::cuts::Cuts;
use super::links::Windows;
use super::octree::Octree;
use super::tag::Tag;
use super::view::{MAX_ELEMENT_LEVELS, OctreeRef, element_levels, root_cells, starts_half_way};
use super::word::Planes;
use crate::control::Job;
use crate::dispatch::{Hot, with_popcount};
use crate::error::{Damage, Error};
use crate::lattice::Frame;
use crate::memory;
use crate::parallel;
use alloc::vec::Vec;
use core::ops::Range;

/// Number of items that each of several threads copies at once when pieces are joined.
const BLOCK: usize = 64;

/// A vector in pieces: it grows without copying its contents or requesting twice the memory.
struct Chunks<T> {
    full: Vec<Vec<T>>,
    tail: Vec<T>,
}

impl<T: Copy + Send + Sync> Chunks<T> {
    const SMALLEST: usize = 64;
    const LARGEST: usize = 1 << 17;
    /// Longest run of items that is copied when vectors are joined; a longer one stays a separate piece.
    const COPIED: usize = 1 << 10;

    fn new() -> Chunks<T> {
        Chunks { full: Vec::new(), tail: Vec::new() }
    }

    fn len(&self) -> usize {
        self.full.iter().map(Vec::len).sum::<usize>() + self.tail.len()
    }

    /// Makes room for at least `count` more items without a further piece.
    fn reserve(&mut self, count: usize) -> Result<(), Error> {
        if self.tail.capacity() - self.tail.len() >= count {
            return Ok(());
        }
        let grown = (2 * self.tail.capacity()).clamp(Self::SMALLEST, Self::LARGEST);
        let fresh = memory::with_capacity(grown.max(count))?;
        self.retire(fresh)
    }

    /// Makes room for all items to come, of which there may turn out to be fewer, if they are to be in `one`
    /// piece. An allocator that keeps blocks of freed sizes must see this size each time, and not only the
    /// used part of it. Otherwise each result has fresh pages, and these take as long as the result.
    fn reserve_whole(&mut self, count: usize, one: bool) -> Result<(), Error> {
        drop(core::hint::black_box(memory::with_capacity::<T>(count)?));
        if one { self.reserve(count) } else { Ok(()) }
    }

    fn retire(&mut self, fresh: Vec<T>) -> Result<(), Error> {
        let tail = core::mem::replace(&mut self.tail, fresh);
        if !tail.is_empty() {
            memory::push(&mut self.full, tail)?;
        }
        Ok(())
    }

    #[inline(always)]
    fn push(&mut self, value: T) -> Result<(), Error> {
        if self.tail.len() == self.tail.capacity() {
            self.reserve(1)?;
        }
        self.tail.push(value);
        Ok(())
    }

    fn append(&mut self, mut other: Chunks<T>) -> Result<(), Error> {
        let room = self.tail.capacity() - self.tail.len();
        if other.full.is_empty() && other.tail.len() <= room.min(Self::COPIED) {
            self.tail.extend_from_slice(&other.tail);
            return Ok(());
        }
        self.retire(Vec::new())?;
        self.full.try_reserve(other.full.len())?;
        self.full.append(&mut other.full);
        self.tail = other.tail;
        Ok(())
    }

    /// Returns everything in one piece, without a copy if it already is. If several threads wrote it, all
    /// threads of the pool copy.
    fn into_vec(self, joined: bool) -> Result<Vec<T>, Error> {
        if self.full.is_empty() {
            let mut tail = self.tail;
            tail.shrink_to_fit();
            return Ok(tail);
        }
        let mut all = memory::with_capacity(self.len())?;
        if joined {
            let count = self.len();
            let pieces = || self.full.iter().chain([&self.tail]).map(Vec::as_slice);
            let mut blocks: Vec<[T; BLOCK]> = memory::with_capacity(count.div_ceil(BLOCK))?;
            // Each share consists of consecutive items, so it searches only for the first of them.
            parallel::extend(
                true,
                &mut blocks,
                0..count / BLOCK,
                || None,
                |at, i| {
                    let (rest, more) = at.get_or_insert_with(|| {
                        let (mut more, mut before) = (pieces(), i * BLOCK);
                        let rest = more.find_map(|piece| {
                            let rest = piece.get(before..);
                            before = before.saturating_sub(piece.len());
                            rest
                        });
                        (rest.unwrap_or_default().iter(), more)
                    });
                    if let Some((&block, behind)) = rest.as_slice().split_first_chunk() {
                        *rest = behind.iter();
                        return block;
                    }
                    core::array::from_fn(|_| {
                        loop {
                            if let Some(&item) = rest.next() {
                                return item;
                            }
                            *rest = more.next().unwrap_or_else(|| unreachable!("all were counted")).iter();
                        }
                    })
                },
            );
            let mut all = blocks.into_flattened();
            all.extend(pieces().flatten().skip(all.len()));
            return Ok(all);
        }
        for piece in self.full.into_iter().chain([self.tail]) {
            all.extend_from_slice(&piece);
        }
        Ok(all)
    }
}

enum BrickChunks {
    One(Chunks<u64>),
    Two(Chunks<Planes>),
}

/// The working form of a tree that is being made: an output array for each level, without links.
pub(crate) struct Writer<'j> {
    job: &'j Job<'j>,
    depth: u8,
    levels: Vec<Chunks<Planes>>,
    bricks: BrickChunks,
    /// True if parts were appended.
    joined: bool,
    /// Runs of elements that were copied since the last query, with their levels; `None` if they are not
    /// recorded.
    runs: Option<Vec<(usize, Range<usize>)>>,
    // Nodes written since the last report to the job.
    nodes: usize,
    bytes: usize,
    untold: u32,
}

/// Elements written between two reports to the job.
const REPORT: u32 = 256;

impl<'j> Writer<'j> {
    /// Returns a writer for a tree of `depth`; `binary` promises that no cell will be PARTIAL.
    pub(crate) fn new(job: &'j Job<'j>, depth: u8, binary: bool) -> Writer<'j> {
        Writer {
            job,
            depth,
            levels: (1..element_levels(depth)).map(|_| Chunks::new()).collect(),
            bricks: if binary { BrickChunks::One(Chunks::new()) } else { BrickChunks::Two(Chunks::new()) },
            joined: false,
            runs: None,
            nodes: 0,
            bytes: 0,
            untold: 0,
        }
    }

    /// Returns an empty writer for a part of the same tree, to be [appended](Self::append) later.
    pub(crate) fn sibling(&self) -> Writer<'j> {
        let runs = self.runs.as_ref().map(|_| Vec::new());
        Writer { runs, ..Writer::new(self.job, self.depth, matches!(self.bricks, BrickChunks::One(_))) }
    }

    /// Starts to record the runs that are copied.
    pub(crate) fn note_runs(&mut self) {
        self.runs = Some(Vec::new());
    }

    /// Returns the runs of elements that were copied since the last query, with their levels.
    pub(crate) fn noted_runs(&mut self) -> Vec<(usize, Range<usize>)> {
        self.runs.replace(Vec::new()).unwrap_or_default()
    }

    pub(crate) fn job(&self) -> &'j Job<'j> {
        self.job
    }

    /// Reserves room for `count` elements of level `e` if they are to be in `one` piece. Memory is only
    /// touched when it is used.
    pub(crate) fn reserve(&mut self, e: usize, count: usize, one: bool) -> Result<(), Error> {
        match self.levels.get_mut(e) {
            Some(level) => level.reserve_whole(count, one),
            None => match &mut self.bricks {
                BrickChunks::One(bricks) => bricks.reserve_whole(count, one),
                BrickChunks::Two(bricks) => bricks.reserve_whole(count, one),
            },
        }
    }

    /// Stores an element or brick of level `e` whose children have been stored. Returns the tag of its cell,
    /// which is BRANCH if it had to be stored.
    #[inline(always)]
    pub(crate) fn put(&mut self, e: usize, planes: Planes) -> Result<Tag, Error> {
        let real = if e == 0 { root_cells(self.depth) } else { !0 };
        if let Some(tag) = planes.merged(real) {
            return Ok(tag);
        }
        let size = match self.levels.get_mut(e) {
            Some(level) => {
                level.push(planes.masked(real))?;
                size_of::<Planes>()
            }
            None => match &mut self.bricks {
                BrickChunks::One(bricks) => {
                    if planes.partial() & real != 0 {
                        return Err(Damage::MissingPlane.into());
                    }
                    bricks.push(planes.lower & real)?;
                    size_of::<u64>()
                }
                BrickChunks::Two(bricks) => {
                    bricks.push(planes.masked(real))?;
                    size_of::<Planes>()
                }
            },
        };
        let half = e == 0 && starts_half_way(self.depth);
        self.account(1, size, || octree_nodes(planes.masked(real), half))?;
        Ok(Tag::Branch)
    }

    #[inline(always)]
    fn account(&mut self, count: u32, bytes: usize, nodes: impl FnOnce() -> usize) -> Result<(), Error> {
        self.bytes += bytes;
        self.untold += count;
        if self.job.counts_nodes() {
            self.nodes += nodes();
        }
        if self.untold >= REPORT { self.report() } else { Ok(()) }
    }

    #[cold]
    fn report(&mut self) -> Result<(), Error> {
        self.untold = 0;
        self.job.spend(core::mem::take(&mut self.nodes), core::mem::take(&mut self.bytes))
    }

    /// Copies the subtrees below the elements `range` of level `e`, complemented if `flip`: one run per
    /// level. They must be admissible by `windows`, which they pass.
    pub(crate) fn copy(
        &mut self,
        tree: &OctreeRef<'_>,
        windows: &mut Windows,
        parent: usize,
        e: usize,
        mut range: Range<usize>,
        flip: bool,
    ) -> Result<(), Error> {
        let last = self.levels.len();
        for level in e..=last {
            windows.admit(parent, level, range.start, range.end)?;
            if range.is_empty() {
                return Ok(());
            }
            if let Some(runs) = &mut self.runs {
                memory::push(runs, (level, range.clone()))?;
            }
            let count = range.len();
            let reported = u32::try_from(count).unwrap_or(u32::MAX);
            if level == last {
                let (first, end) = (range.start - tree.planes.len(), range.end - tree.planes.len());
                let damaged = Damage::Dictionary { brick: first as u64 };
                let size = self.copy_bricks(&tree.bricks, first..end, flip)?.ok_or(damaged)?;
                return self.account(reported, count * size, || {
                    (first..end).filter_map(|b| tree.bricks.get(b)).map(|b| octree_nodes(b, false)).sum()
                });
            }
            let run = &tree.planes[range.clone()];
            let out = &mut self.levels[level];
            out.reserve(count)?;
            if flip {
                out.tail.extend(run.iter().map(|planes| planes.complement()));
            } else {
                out.tail.extend_from_slice(run);
            }
            self.account(reported, size_of_val(run), || run.iter().map(|&p| octree_nodes(p, false)).sum())?;
            let children = with_popcount(Branches(run));
            let start = range.start;
            range = tree.children_from(start, level)..tree.children_from(range.end, level);
            if range.len() != children {
                return Err(Damage::Link { element: start as u64 }.into());
            }
        }
        Ok(())
    }

    /// Appends the bricks of `run`, and returns the bytes of each copied brick; `None` if one is damaged.
    fn copy_bricks(
        &mut self,
        from: &Bricks<'_>,
        run: Range<usize>,
        flip: bool,
    ) -> Result<Option<usize>, Error> {
        fn append<T: Brick, U: Brick>(
            from: &BrickArray<'_, T>,
            run: Range<usize>,
            flip: bool,
            out: &mut Chunks<U>,
        ) -> Result<Option<usize>, Error> {
            out.reserve(run.len())?;
            let good = match flip {
                true => from.extend(run, &mut out.tail, |brick| U::of(brick.planes().complement())),
                false => from.extend(run, &mut out.tail, |brick| U::of(brick.planes())),
            };
            Ok(good.then_some(size_of::<U>()))
        }
        match (from, &mut self.bricks) {
            (Bricks::One(from), BrickChunks::One(out)) => append(from, run, flip, out),
            (Bricks::One(from), BrickChunks::Two(out)) => append(from, run, flip, out),
            (Bricks::Two(from), BrickChunks::Two(out)) => append(from, run, flip, out),
            (Bricks::Two(_), BrickChunks::One(_)) => Err(Damage::MissingPlane.into()),
        }
    }

    /// Takes over the output of a sibling, which comes after all output of this writer so far.
    pub(crate) fn append(&mut self, other: Writer<'j>) -> Result<(), Error> {
        for (level, theirs) in self.levels.iter_mut().zip(other.levels) {
            level.append(theirs)?;
        }
        match (&mut self.bricks, other.bricks) {
            (BrickChunks::One(bricks), BrickChunks::One(theirs)) => bricks.append(theirs)?,
            (BrickChunks::Two(bricks), BrickChunks::Two(theirs)) => bricks.append(theirs)?,
            _ => unreachable!("siblings write the same kind of brick"),
        }
        self.joined = true;
        self.nodes += other.nodes;
        self.bytes += other.bytes;
        self.untold = self.untold.saturating_add(other.untold);
        if self.untold >= REPORT { self.report() } else { Ok(()) }
    }

    /// Makes the tree: concatenates the levels and ranks the children. `root` is the tag that the last
    /// [`put`](Self::put) of level 0 returned.
    pub(crate) fn finish(self, frame: Frame, root: Tag, exterior: Tag) -> Result<Octree, Error> {
        Ok(Octree::new(self.arrays(frame, root, exterior)?))
    }

    /// Makes the tree with cuts.
    pub(crate) fn finish_with(
        self,
        frame: &Frame,
        root: Tag,
        exterior: Tag,
        cuts: Option<Cuts>,
    ) -> Result<Octree, Error> {
        Ok(Octree::new(Arrays { cuts, ..self.arrays(*frame, root, exterior)? }))
    }

    fn arrays(mut self, frame: Frame, root: Tag, exterior: Tag) -> Result<Arrays, Error> {
        self.report()?;
        let mut starts = [0; MAX_ELEMENT_LEVELS + 1];
        let total = self.levels.iter().map(Chunks::len).sum();
        let mut planes: Vec<Planes> = memory::with_capacity(total)?;
        let levels = self.levels.len() + 1;
        for (e, level) in self.levels.into_iter().enumerate() {
            starts[e] = planes.len();
            for piece in level.full.iter().chain([&level.tail]) {
                planes.extend_from_slice(piece);
            }
        }
        starts[levels - 1] = planes.len();
        let undecided = |planes: &Planes| planes.partial() != 0;
        let bricks = match self.bricks {
            BrickChunks::One(bricks) => {
                if root == Tag::Partial || planes.iter().any(undecided) {
                    return Err(Damage::MissingPlane.into());
                }
                OwnedBricks::One(OwnedArray::Raw(bricks.into_vec(self.joined)?))
            }
            BrickChunks::Two(bricks) => {
                let bricks = bricks.into_vec(self.joined)?;
                // Even without a brick, the kind of bricks says whether anything is undecided.
                if root == Tag::Partial || planes.iter().any(undecided) || bricks.iter().any(undecided) {
                    OwnedBricks::Two(OwnedArray::Raw(bricks))
                } else {
                    let one = memory::collected(bricks.iter().map(|planes| planes.lower))?;
                    OwnedBricks::One(OwnedArray::Raw(one))
                }
            }
        };
        starts[levels..].fill(planes.len() + bricks.len());
        Arrays::link(frame, root, exterior, planes, bricks, starts)
    }
}

/// Counts the branches of a run of elements.
struct Branches<'r>(&'r [Planes]);

impl Hot for Branches<'_> {
    type Output = usize;

    #[inline(always)]
    fn run(self) -> usize {
        self.0.iter().map(|planes| planes.branch().count_ones() as usize).sum()
    }
}

/// Returns the number of octree nodes in an element: itself and its cut octants. A root that starts half-way
/// is only its octant.
#[inline]
pub(crate) fn octree_nodes(planes: Planes, half: bool) -> usize {
    if half {
        return 1;
    }
    let [empty, full, partial] = planes.octants();
    9 - (empty | full | partial).count_ones() as usize
}
