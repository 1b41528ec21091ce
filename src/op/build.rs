//! Building an octree from any solid.

use super::rule::Rule;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame, Shard, morton};
use crate::memory;
use crate::octree::block::BLOCK_LEVELS;
use crate::octree::links::Windows;
use crate::octree::view::{OctreeRef, element_levels, starts_half_way};
use crate::octree::writer::Writer;
use crate::octree::{Block, Octree, Planes, Tag};
use crate::parallel::{self, each_with};
use crate::solid::{Ask, Batch, Classifier, DynSolid, Parts, Subtree, Verdict, Worker};
use crate::walk;
use crate::walk::Gathered;
use alloc::vec::Vec;

/// Builds the octree of `solid` to the depth of `frame`, and resolves its undecided finest cells by `rule`.
///
/// The result is canonical, and the same bit for bit for any number of threads. Time and memory are linear in
/// the number of visited nodes.
///
/// # Errors
/// The errors of the solid ([`Error::FrameMismatch`] for stored trees, [`Error::Damaged`] for unverified
/// ones), [`Error::NotSampled`] under [`Rule::Sampled`] if the solid cannot decide points, and cancellation
/// or an exceeded limit of `control`.
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build};
/// let frame = Frame::new([0.0; 3], 2.0, 7)?;
/// let ball = build(&Csg::ball([1.0; 3], 0.75)?, &frame, Rule::Certified, &Control::default())?;
/// let volume = ball.statistics().volume();
/// assert!(volume.contains(4.0 / 3.0 * std::f64::consts::PI * 0.75f64.powi(3)));
/// assert!(volume.width() < 0.17);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn build(
    solid: &dyn DynSolid,
    frame: &Frame,
    rule: Rule,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    build_on(&solid.on(frame, control)?, rule, control)
}

/// Builds the cells of a [`Shard`] of the octree that [`build`] returns. All other cells are unknown
/// (PARTIAL), whatever the rule. Time and memory are linear in the number of visited nodes: those of the
/// shard and of the path to it.
///
/// [`join`](super::join) combines the top shard and the shards of all cells that the top leaves open. The
/// result is the octree that [`build`] returns, byte for byte.
///
/// # Errors
/// As [`build`]; [`Error::Argument`] if the frame does not contain the shard's cells.
///
/// ```
/// use leafless::op::join;
/// use leafless::{Control, Csg, Frame, Rule, Shard, build, build_shard, file};
/// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 7)?, Control::default());
/// let ball = Csg::ball([0.1, 0.0, 0.0], 0.75)?;
/// let make = |shard| build_shard(&ball, &frame, Rule::Certified, shard, &control);
/// let mut trees = vec![make(Shard::Top { level: 2 })?];
/// for cell in trees[0].view().open_cells(2)? {
///     trees.push(make(Shard::Below(cell))?);
/// }
/// assert!(trees.len() > 1);
/// let views: Vec<_> = trees.iter().map(|tree| *tree.view()).collect();
/// let whole = build(&ball, &frame, Rule::Certified, &control)?;
/// assert_eq!(file::to_bytes(&join(&views, &control)?)?, file::to_bytes(&whole)?);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn build_shard(
    solid: &dyn DynSolid,
    frame: &Frame,
    rule: Rule,
    shard: Shard,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    shard.check(frame.depth())?;
    build_cells(&solid.on(frame, control)?, rule, Some(shard), control)
}

/// [`build`] for a solid that has already been put on its frame.
pub(crate) fn build_on<C: Classifier>(
    classifier: &C,
    rule: Rule,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    build_cells(classifier, rule, None, control)
}

fn build_cells<C: Classifier>(
    classifier: &C,
    rule: Rule,
    shard: Option<Shard>,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    let job = Job::new(control);
    job.check()?;
    let frame = *classifier.frame();
    let mut hand = Hand::new(classifier)?;
    // A shallow tree is built faster than threads are started, unless a host program does the work.
    let worth = element_levels(frame.depth()) > 3 || hand.worker.likes_many();
    control.run(worth, |parallel| {
        let levels = element_levels(frame.depth());
        let builder = Builder { classifier, frame, rule, shard, levels, parallel };
        let mut writer = Writer::new(&job, frame.depth(), rule.is_binary() && shard.is_none());
        let root = hand.worker.root()?;
        let is_last = shard.is_some_and(|shard| shard.last(frame.depth()) == 0);
        if !matches!(root, Verdict::Partial(_)) || is_last {
            job.advance(WHOLE);
        }
        let tag = match root {
            Verdict::Empty => Tag::Empty,
            Verdict::Full => Tag::Full,
            Verdict::Partial(_) if is_last => Tag::Partial,
            Verdict::Undecided => rule.resolved(Planes::uniform(Tag::Partial))?.tag(0),
            Verdict::Partial(part) => builder.cell(0, Cell::ROOT, &part, &mut hand, &mut writer)?,
        };
        let octree = writer.finish(frame, tag, classifier.exterior())?;
        Ok(octree.with_proof(rule.proof(classifier.proof())))
    })
}

/// Returns the tree with its PARTIAL cells resolved: EMPTY under [`Rule::Inner`], FULL under [`Rule::Outer`].
/// A tree that keeps surfaces is refused, because it is unclear which cells are meant:
/// [`plain`](super::plain) takes a depth, and [`without_cuts`](OctreeRef::without_cuts) leaves the cells as
/// they are.
///
/// # Errors
/// [`Error::NotSampled`] under [`Rule::Sampled`] if a cell is PARTIAL, because a stored tree has no samples;
/// [`Error::Argument`] if the tree keeps surfaces; and cancellation or an exceeded limit of `control`.
pub fn resolve(tree: &OctreeRef<'_>, rule: Rule, control: &Control<'_>) -> Result<Octree, Error> {
    if tree.cuts.is_some() {
        let problem = "keeps surfaces: take the plain tree to a depth, or the tree without its cuts";
        return Err(Error::Argument { name: "tree", problem });
    }
    build(tree, tree.frame(), rule, control)
}

/// Returns the same tree with its bricks encoded as in a file: through a dictionary where that is shorter.
/// Queries and Booleans accept it like any other tree.
///
/// # Errors
/// [`Error::OutOfMemory`], or [`Error::Damaged`] if a brick cannot be read.
pub fn compact(tree: &OctreeRef<'_>) -> Result<Octree, Error> {
    Octree::recoded(tree)
}

struct Builder<'a, C> {
    classifier: &'a C,
    frame: Frame,
    rule: Rule,
    /// The wanted cells; `None` for all cells.
    shard: Option<Shard>,
    levels: usize,
    #[cfg_attr(not(feature = "parallel"), allow(dead_code))]
    parallel: bool,
}

/// The part type of a classifier.
type Part<C> = <<C as Classifier>::Worker as Parts>::Part;

/// The state of one thread: a worker, a stack of parts, a block.
struct Hand<C: Classifier> {
    worker: C::Worker,
    parts: Vec<(u8, Part<C>)>,
    /// Allocated when a cell is first small enough for a block.
    block: Option<Block>,
}

impl<C: Classifier> Hand<C> {
    fn new(classifier: &C) -> Result<Hand<C>, Error> {
        Ok(Hand { worker: classifier.worker()?, parts: Vec::new(), block: None })
    }
}

impl<C: Classifier> Builder<'_, C> {
    /// Writes the subtree of a PARTIAL cell as elements from level `e` on; returns its tag.
    fn cell(
        &self,
        e: usize,
        cell: Cell,
        part: &Part<C>,
        hand: &mut Hand<C>,
        writer: &mut Writer<'_>,
    ) -> Result<Tag, Error> {
        writer.job().check()?;
        let is_whole = self.has_all_in(cell);
        if is_whole && hand.worker.likes_many() && cell.level + walk::LEVELS >= self.frame.depth() {
            return self.gathered(e, cell, part, hand, writer);
        }
        if is_whole && cell.level + BLOCK_LEVELS == self.frame.depth() {
            let block = match &mut hand.block {
                Some(block) => block,
                none => none.insert(self.rule.block()?),
            };
            if hand.worker.fill(cell, part, block)? {
                self.progress(e, writer);
                return self.rule.cells(block).write(e, writer);
            }
        }
        let mark = hand.worker.mark();
        let first = hand.parts.len();
        let mut planes = self.split(e, cell, part, hand)?;
        let mut known = !0;
        if let Some(shard) = self.shard.filter(|_| !is_whole) {
            known = self.known(&shard, e, cell, planes, &hand.parts[first..]);
            planes = planes.masked(known);
            drop_unknown(&mut hand.parts, first, known);
        }
        let mut planes = if e + 1 == self.levels {
            self.progress(e, writer);
            self.resolve_finest(planes, cell, first, hand)?
        } else {
            self.children(e, cell, planes, first, hand, writer)?
        };
        // The rule resolves cells that the solid leaves undecided, not cells that the shard does not know.
        planes.upper |= !known;
        let tag = writer.put(e, planes)?;
        hand.parts.truncate(first);
        hand.worker.release(mark);
        Ok(tag)
    }

    /// Returns whether all descendants of a cell are wanted.
    fn has_all_in(&self, cell: Cell) -> bool {
        self.shard.is_none_or(|shard| shard.has_all_in(cell))
    }

    /// The cells of an element that a shard knows. Some cells of the element are wanted.
    fn known(&self, shard: &Shard, e: usize, cell: Cell, planes: Planes, parts: &[(u8, Part<C>)]) -> u64 {
        let cells = self.at(e, cell, 0).level;
        let last = shard.last(self.frame.depth());
        let goes_on = parts.iter().fold(0u64, |mask, &(c, _)| mask | 1 << c);
        if cells == last + 1 {
            // The octants are the last cells. They were split only to find their tags.
            let [empty, full, partial] = planes.octants();
            let goes_on =
                (0..64).step_by(8).filter(|o| goes_on >> o & 0xFF != 0).fold(0, |mask, o| mask | 1 << o);
            return (empty | full | partial & !goes_on) * 0xFF;
        }
        let outside =
            (0..64u8).filter(|&c| usize::from(c) < self.cells(e) && shard.is_without(self.at(e, cell, c)));
        let known = outside.fold(!0u64, |mask, c| mask & !(1 << c));
        if cells == last && last < self.frame.depth() { known & !goes_on } else { known }
    }

    /// Splits the cells of an element: two levels of the solid, or one level for a root that starts half-way.
    fn split(&self, e: usize, cell: Cell, part: &Part<C>, hand: &mut Hand<C>) -> Result<Planes, Error> {
        if e > 0 || !starts_half_way(self.frame.depth()) {
            let planes = hand.worker.split64(cell, part, &mut hand.parts)?;
            // No cell is a branch yet, so branch tags from a solid are ignored.
            return Ok(Planes { lower: planes.full(), upper: planes.lower | planes.upper });
        }
        let mut planes = Planes::uniform(Tag::Empty);
        for (k, child) in (0u8..).zip(hand.worker.split(cell, part)?) {
            planes.set(k as u32, child.tag());
            if let Verdict::Partial(part) = child {
                memory::push(&mut hand.parts, (k, part))?;
            }
        }
        Ok(planes)
    }

    /// Returns cell `c` of the element of level `e` at `cell`.
    fn at(&self, e: usize, cell: Cell, c: u8) -> Cell {
        if e == 0 && starts_half_way(self.frame.depth()) {
            return cell.child(c);
        }
        let [x, y, z] = morton::position(c as u32);
        let [cx, cy, cz] = cell.at.each(|a| 4 * a);
        Cell { level: cell.level + 2, at: [cx + x, cy + y, cz + z] }
    }

    /// The number of cells that an element of level `e` has in the universe.
    fn cells(&self, e: usize) -> usize {
        if e == 0 && starts_half_way(self.frame.depth()) { 8 } else { 64 }
    }

    /// The progress units of one cell of an element of level 0 or 1.
    fn weight(&self, e: usize) -> usize {
        WHOLE / self.cells(0) / if e == 0 { 1 } else { 64 }
    }

    /// Reports the progress of a subtree that ends above the cells of level 1, which otherwise report.
    fn progress(&self, e: usize, writer: &Writer<'_>) {
        match e {
            0 => writer.job().advance(WHOLE),
            1 => writer.job().advance(self.weight(0)),
            _ => {}
        }
    }

    /// Descends into the parts from `first` on, and resolves cells that cannot be split.
    fn children(
        &self,
        e: usize,
        cell: Cell,
        planes: Planes,
        first: usize,
        hand: &mut Hand<C>,
        writer: &mut Writer<'_>,
    ) -> Result<Planes, Error> {
        let splittable = hand.parts[first..].iter().fold(0u64, |mask, &(c, _)| mask | 1 << c);
        let hopeless = planes.partial() & !splittable;
        let mut result = if hopeless == 0 {
            planes
        } else {
            let resolved = self.rule.resolved(planes.masked(hopeless))?;
            planes.masked(!hopeless).union(resolved)
        };
        if e < 2 {
            let decided = self.cells(e) - splittable.count_ones() as usize;
            writer.job().advance(decided * self.weight(e));
        }
        if self.parallel
            && e < 2
            && (e + 3 < self.levels || hand.worker.likes_many())
            && splittable.count_ones() > 1
        {
            for (c, tag) in self.children_parallel(e, cell, first, hand, writer)? {
                result.set(c as u32, tag);
            }
            return Ok(result);
        }
        let mut run: Option<Run> = None;
        for i in first..hand.parts.len() {
            let (c, part) = hand.parts[i].clone();
            // Stored subtrees are copied, neighbouring ones together.
            let child = self.at(e, cell, c);
            if let Some(subtree) = self.stored(e + 1, &part, &hand.worker).filter(|_| self.has_all_in(child))
            {
                result.set(c as u32, Tag::Branch);
                match &mut run {
                    Some(run) if self.goes_on(run, &subtree, hand) => run.count += 1,
                    _ => self.copy(run.replace(Run { first: i, level: e + 1, count: 1 }), hand, writer)?,
                }
                continue;
            }
            self.copy(run.take(), hand, writer)?;
            let tag = self.cell(e + 1, child, &part, hand, writer)?;
            result.set(c as u32, tag);
            if e == 1 {
                writer.job().advance(self.weight(e));
            }
        }
        self.copy(run, hand, writer)?;
        Ok(result)
    }

    fn children_parallel(
        &self,
        e: usize,
        cell: Cell,
        first: usize,
        hand: &Hand<C>,
        writer: &mut Writer<'_>,
    ) -> Result<Vec<(u8, Tag)>, Error> {
        let subtrees = &*writer;
        let from = &hand.worker;
        let done = each_with(
            true,
            hand.parts[first..].iter(),
            || None,
            |own, (c, part)| {
                let (mut subtree, child) = (subtrees.sibling(), self.at(e, cell, *c));
                if let Some(stored) = self.stored(e + 1, part, from).filter(|_| self.has_all_in(child)) {
                    copy(&stored, 1, &mut subtree)?;
                    return Ok((*c, Tag::Branch, subtree));
                }
                let hand = match own {
                    Some(hand) => hand,
                    none => none.insert(Hand::new(self.classifier)?),
                };
                let mark = hand.worker.mark();
                let part = hand.worker.hand_over(from, part)?;
                let tag = self.cell(e + 1, child, &part, hand, &mut subtree)?;
                hand.worker.release(mark);
                if e == 1 {
                    subtree.job().advance(self.weight(e));
                }
                Ok((*c, tag, subtree))
            },
        )?;
        done.into_iter().map(|(c, tag, subtree)| writer.append(subtree).map(|()| (c, tag))).collect()
    }

    /// Resolves finest cells. Cells with a part may be sampled.
    fn resolve_finest(
        &self,
        planes: Planes,
        cell: Cell,
        first: usize,
        hand: &mut Hand<C>,
    ) -> Result<Planes, Error> {
        if self.rule != Rule::Sampled {
            return self.rule.resolved(planes);
        }
        if planes.partial().count_ones() as usize != hand.parts.len() - first {
            return Err(Error::NotSampled);
        }
        if self.levels > 1 || !starts_half_way(self.frame.depth()) {
            let parts = &hand.parts[first..];
            let inside = hand.worker.sample64(cell, parts)?.ok_or(Error::NotSampled)?;
            return Ok(Planes::binary(planes.full() | inside & planes.partial()));
        }
        // The only element is a root that starts half-way, so its cells are children.
        let mut result = planes;
        for i in first..hand.parts.len() {
            let (c, part) = hand.parts[i].clone();
            let centre = self.at(self.levels - 1, cell, c);
            let inside = hand.worker.sample(centre, &part)?.ok_or(Error::NotSampled)?;
            result.set(c as u32, if inside { Tag::Full } else { Tag::Empty });
        }
        Ok(result)
    }

    /// Writes the subtree of a PARTIAL cell by evaluating the solid level by level.
    fn gathered(
        &self,
        e: usize,
        cell: Cell,
        part: &Part<C>,
        hand: &mut Hand<C>,
        writer: &mut Writer<'_>,
    ) -> Result<Tag, Error> {
        // Below the root the threads already have cells of their own.
        let threads = if self.parallel && e == 0 { parallel::threads() } else { 1 };
        let (centres, job) = (self.rule == Rule::Sampled, writer.job());
        let asked = (cell, part.clone());
        let known = Gathered::new(self.classifier, &mut hand.worker, asked, centres, job, threads)?;
        let builder = Builder {
            classifier: &&known,
            frame: self.frame,
            rule: self.rule,
            shard: None,
            levels: self.levels,
            parallel: false,
        };
        builder.cell(e, cell, &0, &mut Hand::new(&&known)?, writer)
    }

    /// Returns the stored subtree of a PARTIAL cell of element level `e`, if it can be copied as it is.
    fn stored<'w>(&self, e: usize, part: &Part<C>, worker: &'w C::Worker) -> Option<Subtree<'w>> {
        let subtree = worker.subtree(part)?;
        let good = subtree.level == e
            && *subtree.tree.frame() == self.frame
            && (self.rule == Rule::Certified || subtree.tree.is_binary());
        good.then_some(subtree)
    }

    /// Returns whether a subtree directly follows the subtrees of a run.
    fn goes_on(&self, run: &Run, next: &Subtree<'_>, hand: &Hand<C>) -> bool {
        self.stored(run.level, &hand.parts[run.first].1, &hand.worker).is_some_and(|first| {
            let same = core::ptr::eq(first.tree.planes.as_ptr(), next.tree.planes.as_ptr());
            same && (next.index, next.flip) == (first.index + run.count, first.flip)
        })
    }

    /// Copies the subtrees of a run.
    fn copy(&self, run: Option<Run>, hand: &Hand<C>, writer: &mut Writer<'_>) -> Result<(), Error> {
        let Some(Run { first, level, count }) = run else { return Ok(()) };
        match self.stored(level, &hand.parts[first].1, &hand.worker) {
            Some(subtree) => copy(&subtree, count, writer),
            None => Ok(()),
        }
    }
}

/// Drops the parts from `first` on whose cells are not known.
fn drop_unknown<P>(parts: &mut Vec<(u8, P)>, first: usize, known: u64) {
    let mut place = 0;
    parts.retain(|&(c, _)| {
        place += 1;
        place <= first || known >> c & 1 != 0
    });
}

/// A run of neighbouring stored subtrees that are copied together: the index of the first one's part, their
/// element level and their number.
struct Run {
    first: usize,
    level: usize,
    count: usize,
}

/// Copies `count` neighbouring subtrees of a stored octree. All its links were checked when the octree was
/// put on the frame.
fn copy(first: &Subtree<'_>, count: usize, writer: &mut Writer<'_>) -> Result<(), Error> {
    let &Subtree { tree, level, index, flip } = first;
    writer.copy(tree, &mut Windows::new(tree), index, level, index..index + count, flip)
}
