//! From any solid to an octree.

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame, morton};
use crate::octree::block::BLOCK_LEVELS;
use crate::octree::view::{element_levels, starts_half_way};
use crate::octree::writer::Writer;
use crate::octree::{Block, Octree, OctreeRef, Planes, Rule, Tag};
use crate::solid::{Scratch, Solid, Stored, Verdict};
use alloc::vec::Vec;

/// Builds the octree of `solid` to the depth of `frame`, its undecided finest cells resolved by `rule`.
///
/// The result is canonical, and the same bit for bit for any number of threads. Time and memory are linear
/// in the nodes that are visited.
///
/// # Errors
/// What the solid refuses ([`Error::FrameMismatch`] for stored trees), [`Error::NotSampled`] under
/// [`Rule::Sampled`] if the solid cannot decide points, and what `control` asks for.
///
/// ```
/// use leafless::{Ball, Control, Frame, Rule, build};
/// let frame = Frame::new([0.0; 3], 2.0, 7)?;
/// let ball = build(&Ball::new([1.0; 3], 0.75)?, &frame, Rule::Certified, &Control::default())?;
/// let volume = ball.statistics().volume();
/// assert!(volume.contains(4.0 / 3.0 * std::f64::consts::PI * 0.75f64.powi(3)));
/// assert!(volume.width() < 0.17);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn build<S: Solid>(solid: &S, frame: &Frame, rule: Rule, control: &Control<'_>) -> Result<Octree, Error> {
    let job = Job::new(control);
    job.check()?;
    // Shallow trees are made faster than threads.
    control.run(element_levels(frame.depth()) > 3, |parallel| {
        let builder = Builder { solid, frame, rule, levels: element_levels(frame.depth()), parallel };
        let mut worker = Worker::<S>::new();
        let mut writer = Writer::new(&job, frame.depth(), rule.is_binary());
        let root = solid.root(&mut worker.scratch, frame)?;
        if !matches!(root, Verdict::Partial(_)) {
            job.advance(WHOLE);
        }
        let tag = match root {
            Verdict::Empty => Tag::Empty,
            Verdict::Full => Tag::Full,
            Verdict::Undecided => builder.resolve_all(Planes::uniform(Tag::Partial))?.tag(0),
            Verdict::Partial(part) => builder.cell(0, Cell::ROOT, &part, &mut worker, &mut writer)?,
        };
        writer.finish(*frame, tag, solid.exterior(frame))
    })
}

/// The tree with its PARTIAL cells resolved: EMPTY under [`Rule::Inner`], FULL under [`Rule::Outer`].
///
/// # Errors
/// [`Error::NotSampled`] under [`Rule::Sampled`] if a cell is PARTIAL, because a stored tree knows no more about it;
/// and what `control` asks for.
pub fn resolve(tree: &OctreeRef<'_>, rule: Rule, control: &Control<'_>) -> Result<Octree, Error> {
    build(&Stored::new(tree), tree.frame(), rule, control)
}

/// The same tree with its bricks encoded as a file would have them, through a dictionary where that is
/// shorter. Queries and Booleans work on it as on any other.
///
/// # Errors
/// [`Error::OutOfMemory`], or [`Error::Damaged`] if a brick cannot be read.
pub fn compact(tree: &OctreeRef<'_>) -> Result<Octree, Error> {
    Octree::recoded(tree)
}

struct Builder<'a, S> {
    solid: &'a S,
    frame: &'a Frame,
    rule: Rule,
    levels: usize,
    #[cfg_attr(not(feature = "parallel"), allow(dead_code))]
    parallel: bool,
}

/// What one thread needs: the solid's scratch memory, a stack of parts, a block.
struct Worker<S: Solid> {
    scratch: S::Scratch,
    parts: Vec<(u8, S::Part)>,
    /// Made when a cell is first small enough for it.
    block: Option<Block>,
}

impl<S: Solid> Worker<S> {
    fn new() -> Worker<S> {
        Worker { scratch: S::Scratch::default(), parts: Vec::new(), block: None }
    }
}

impl<S: Solid> Builder<'_, S> {
    /// Writes the subtree of a PARTIAL cell, which element level `e` describes; returns its tag.
    fn cell(
        &self,
        e: usize,
        cell: Cell,
        part: &S::Part,
        worker: &mut Worker<S>,
        writer: &mut Writer<'_>,
    ) -> Result<Tag, Error> {
        writer.job().check()?;
        let cube = Cube { frame: self.frame, cell };
        if cell.level + BLOCK_LEVELS == self.frame.depth() {
            let block = match &mut worker.block {
                Some(block) => block,
                none => none.insert(Block::new(self.rule)?),
            };
            if self.solid.fill(&mut worker.scratch, &cube, part, block)? {
                self.progress(e, writer);
                return block.write(e, writer);
            }
        }
        let mark = worker.scratch.mark();
        let first = worker.parts.len();
        let planes = self.split(e, &cube, part, worker)?;
        let tag = if e + 1 == self.levels {
            let planes = self.resolve_finest(planes, &cube, first, worker)?;
            self.progress(e, writer);
            writer.put(e, planes)?
        } else {
            let planes = self.children(e, &cube, planes, first, worker, writer)?;
            writer.put(e, planes)?
        };
        worker.parts.truncate(first);
        worker.scratch.release(mark);
        Ok(tag)
    }

    /// The cells of an element: two levels of the solid, or one for a root that starts half-way.
    fn split(
        &self,
        e: usize,
        cube: &Cube<'_>,
        part: &S::Part,
        worker: &mut Worker<S>,
    ) -> Result<Planes, Error> {
        if e > 0 || !starts_half_way(self.frame.depth()) {
            let planes = self.solid.split64(&mut worker.scratch, cube, part, &mut worker.parts)?;
            // Nothing is a branch yet; a solid that says so is not believed.
            return Ok(Planes { lower: planes.full(), upper: planes.lower | planes.upper });
        }
        let mut planes = Planes::uniform(Tag::Empty);
        for (k, child) in (0u8..).zip(self.solid.split(&mut worker.scratch, cube, part)?) {
            planes.set(k as u32, child.tag());
            if let Verdict::Partial(part) = child {
                worker.parts.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
                worker.parts.push((k, part));
            }
        }
        Ok(planes)
    }

    /// The cell `c` of the element of level `e` at `cube`.
    fn at(&self, e: usize, cube: &Cube<'_>, c: u8) -> Cell {
        if e == 0 && starts_half_way(self.frame.depth()) {
            return cube.cell.child(c);
        }
        let [x, y, z] = morton::position(c as u32);
        let [cx, cy, cz] = cube.cell.at.map(|a| 4 * a);
        Cell { level: cube.cell.level + 2, at: [cx + x, cy + y, cz + z] }
    }

    /// Cells that an element of level `e` has in the universe.
    fn cells(&self, e: usize) -> usize {
        if e == 0 && starts_half_way(self.frame.depth()) { 8 } else { 64 }
    }

    /// What one cell of an element of level 0 or 1 counts for in the progress.
    fn weight(&self, e: usize) -> usize {
        WHOLE / self.cells(0) / if e == 0 { 1 } else { 64 }
    }

    /// Progress of a subtree that ends before the cells of level 1, which otherwise report.
    fn progress(&self, e: usize, writer: &Writer<'_>) {
        match e {
            0 => writer.job().advance(WHOLE),
            1 => writer.job().advance(self.weight(0)),
            _ => {}
        }
    }

    /// Descends into the parts from `first` on, and resolves what cannot be split.
    fn children(
        &self,
        e: usize,
        cube: &Cube<'_>,
        planes: Planes,
        first: usize,
        worker: &mut Worker<S>,
        writer: &mut Writer<'_>,
    ) -> Result<Planes, Error> {
        let splittable = worker.parts[first..].iter().fold(0u64, |mask, &(c, _)| mask | 1 << c);
        let hopeless = planes.partial() & !splittable;
        let mut result = if hopeless == 0 {
            planes
        } else {
            let resolved = self.resolve_all(planes.masked(hopeless))?;
            planes.masked(!hopeless).union(resolved)
        };
        if e < 2 {
            let decided = self.cells(e) - splittable.count_ones() as usize;
            writer.job().advance(decided * self.weight(e));
        }
        #[cfg(feature = "parallel")]
        if self.parallel && e < 2 && e + 3 < self.levels && splittable.count_ones() > 1 {
            for (c, tag) in self.children_parallel(e, cube, first, worker, writer)? {
                result.set(c as u32, tag);
            }
            return Ok(result);
        }
        for i in first..worker.parts.len() {
            let (c, part) = worker.parts[i].clone();
            let tag = self.cell(e + 1, self.at(e, cube, c), &part, worker, writer)?;
            result.set(c as u32, tag);
            if e == 1 {
                writer.job().advance(self.weight(e));
            }
        }
        Ok(result)
    }

    #[cfg(feature = "parallel")]
    fn children_parallel(
        &self,
        e: usize,
        cube: &Cube<'_>,
        first: usize,
        worker: &Worker<S>,
        writer: &mut Writer<'_>,
    ) -> Result<Vec<(u8, Tag)>, Error> {
        use rayon::prelude::*;
        let subtrees = &*writer;
        let from = &worker.scratch;
        let done = worker.parts[first..]
            .par_iter()
            .map_init(Worker::<S>::new, |worker, (c, part)| {
                let mark = worker.scratch.mark();
                let part = self.solid.hand_over(from, part, &mut worker.scratch)?;
                let mut subtree = subtrees.sibling();
                let tag = self.cell(e + 1, self.at(e, cube, *c), &part, worker, &mut subtree)?;
                worker.scratch.release(mark);
                if e == 1 {
                    subtrees.job().advance(self.weight(e));
                }
                Ok((*c, tag, subtree))
            })
            .collect::<Result<Vec<_>, Error>>()?;
        done.into_iter().map(|(c, tag, subtree)| writer.append(subtree).map(|()| (c, tag))).collect()
    }

    /// Resolves finest cells: those with a part may be sampled.
    fn resolve_finest(
        &self,
        planes: Planes,
        cube: &Cube<'_>,
        first: usize,
        worker: &mut Worker<S>,
    ) -> Result<Planes, Error> {
        if self.rule != Rule::Sampled {
            return self.resolve_all(planes);
        }
        if planes.partial().count_ones() as usize != worker.parts.len() - first {
            return Err(Error::NotSampled);
        }
        if self.levels > 1 || !starts_half_way(self.frame.depth()) {
            let parts = &worker.parts[first..];
            let inside = self.solid.sample64(&mut worker.scratch, cube, parts)?.ok_or(Error::NotSampled)?;
            return Ok(Planes::binary(planes.full() | inside & planes.partial()));
        }
        // The only element is a root that starts half-way: its cells are children.
        let mut result = planes;
        for i in first..worker.parts.len() {
            let (c, part) = worker.parts[i].clone();
            let cube = Cube { frame: self.frame, cell: self.at(self.levels - 1, cube, c) };
            let inside = self.solid.sample(&mut worker.scratch, &cube, &part)?.ok_or(Error::NotSampled)?;
            result.set(c as u32, if inside { Tag::Full } else { Tag::Empty });
        }
        Ok(result)
    }

    /// Resolves cells that nothing more is known about.
    fn resolve_all(&self, planes: Planes) -> Result<Planes, Error> {
        match self.rule {
            Rule::Certified => Ok(planes),
            Rule::Inner => Ok(Planes::binary(planes.lower)),
            Rule::Outer => Ok(Planes::binary(planes.upper)),
            Rule::Sampled if planes.partial() == 0 => Ok(planes),
            Rule::Sampled => Err(Error::NotSampled),
        }
    }
}
