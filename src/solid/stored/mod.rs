//! A stored octree as a solid.

mod cuts;
mod sharded;

use super::forward::forward_solid;
use super::{
    Batch, Classifier, Fingerprint, Fingerprinter, FreeParts, OCTANTS, Question, Solid, Subtree, Verdict,
    WholeQuestion, Worker, sample_one_by_one, split_one_by_one, split_twice,
};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Cell, Frame};
use crate::memory;
use crate::octree::cuts::{CellCut, CutsRef};
use crate::octree::links::Step;
use crate::octree::view::starts_half_way;
use crate::octree::{Octree, OctreeRef, Planes, Proof, Tag};
use alloc::sync::Arc;
use alloc::vec::Vec;
use cuts::PlacedCuts;
pub use sharded::ShardedOctree;

/// The place of the description of a cut cell in a stored octree.
#[derive(Debug, Clone, Copy)]
pub enum StoredPart {
    /// A whole element.
    Element {
        /// Element level.
        level: u8,
        /// Index of the element.
        index: usize,
    },
    /// One octant of an element.
    Octant {
        /// Element level.
        level: u8,
        /// Index of the element.
        index: usize,
        /// The octant.
        octant: u8,
    },
    /// The record of a PARTIAL cell.
    Record(u32),
    /// The record of a PARTIAL cell that contains this cell, and the function that remains in this cell.
    Cut {
        /// The record.
        record: u32,
        /// The truth table of the remaining function.
        table: u8,
    },
}

impl OctreeRef<'_> {
    /// The element that a part names. Links are followed from parents to children only, and the level rises
    /// with each link: a descent ends, whatever the bytes are. An invented part leads nowhere.
    fn described(&self, level: u8, index: usize) -> Planes {
        let level = level as usize;
        let on_level = level < self.levels() && self.on_level(index, level);
        let entry = if on_level { self.entry(index) } else { None };
        entry.unwrap_or(Planes::uniform(Tag::Partial))
    }

    /// The verdict on the universe.
    pub(crate) fn root_verdict(&self) -> Verdict<StoredPart> {
        match self.root_tag() {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Partial => Verdict::Undecided,
            Tag::Branch if starts_half_way(self.frame().depth()) => {
                Verdict::Partial(StoredPart::Octant { level: 0, index: 0, octant: 0 })
            }
            Tag::Branch => Verdict::Partial(StoredPart::Element { level: 0, index: 0 }),
        }
    }

    /// The verdicts on the eight children of any cell; the children of a decided cell are like the cell. (The
    /// requirement is that of [`child_verdicts`](Self::child_verdicts).)
    pub(crate) fn verdicts_below(&self, verdict: &Verdict<StoredPart>) -> [Verdict<StoredPart>; 8] {
        match verdict {
            Verdict::Partial(part) => self.child_verdicts(part),
            settled => [*settled; 8],
        }
    }

    /// The verdicts on the eight children of a cut cell. (The links of a tree must have been checked before
    /// it is walked.)
    pub(crate) fn child_verdicts(&self, part: &StoredPart) -> [Verdict<StoredPart>; 8] {
        match *part {
            StoredPart::Element { level, index } => {
                let planes = self.described(level, index);
                OCTANTS.each(|octant| match planes.octant(octant as u32) {
                    Tag::Empty => Verdict::Empty,
                    Tag::Full => Verdict::Full,
                    Tag::Partial => Verdict::Undecided,
                    Tag::Branch => Verdict::Partial(StoredPart::Octant { level, index, octant }),
                })
            }
            StoredPart::Octant { level, index, octant } => {
                let planes = self.described(level, index);
                OCTANTS.each(|k| self.verdict(level, index, planes, (8 * (octant & 7) + k) as u32))
            }
            StoredPart::Record(_) | StoredPart::Cut { .. } => [Verdict::Undecided; 8],
        }
    }

    fn verdict(&self, level: u8, index: usize, planes: Planes, c: u32) -> Verdict<StoredPart> {
        match self.step(level.into(), index, planes, c) {
            Step::Into(index) => Verdict::Partial(StoredPart::Element { level: level + 1, index }),
            Step::Settled(Tag::Empty) => Verdict::Empty,
            Step::Settled(Tag::Full) => Verdict::Full,
            Step::Settled(_) => Verdict::Undecided,
        }
    }
}

/// The owner of a view: a borrowed tree, or an owned one.
trait Tree: Clone + Send + Sync {
    fn tree(&self) -> &OctreeRef<'_>;
}

impl Tree for OctreeRef<'_> {
    fn tree(&self) -> &OctreeRef<'_> {
        self
    }
}

impl Tree for Octree {
    fn tree(&self) -> &OctreeRef<'_> {
        self.view()
    }
}

/// A stored octree with checked links, on a frame of its universe: both handle and worker.
#[derive(Debug, Clone)]
pub struct StoredOnFrame<T> {
    tree: T,
    frame: Frame,
    cuts: Option<Arc<PlacedCuts>>,
}

#[allow(private_bounds)]
impl<T: Tree> StoredOnFrame<T> {
    fn new(tree: T, frame: &Frame) -> Result<StoredOnFrame<T>, Error> {
        if !frame.same_universe(tree.tree().frame()) {
            return Err(tree.tree().frame().mismatch(frame));
        }
        // A descent remembers nothing, so that elements with shared children would be visited again and
        // again: 64^10 times in a file of a few kilobytes.
        tree.tree().ensure_links()?;
        tree.tree().ensure_cuts()?;
        let cuts = match &tree.tree().cuts {
            Some(cuts) => Some(Arc::new(PlacedCuts::new(cuts, frame)?)),
            None => None,
        };
        Ok(StoredOnFrame { tree, frame: *frame, cuts })
    }
}

#[allow(private_bounds)]
impl<T: Tree> Classifier for StoredOnFrame<T> {
    type Worker = StoredOnFrame<T>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<StoredOnFrame<T>, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        self.tree.tree().exterior()
    }

    fn proof(&self) -> Proof {
        self.tree.tree().proof()
    }

    fn kept_bytes(&self) -> u64 {
        self.cuts.as_ref().map_or(0, |cuts| cuts.bytes() as u64)
    }

    fn answer_whole(&self, question: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        match question {
            WholeQuestion::Surfaces(known) | WholeQuestion::Layers(known) => match &self.cuts {
                Some(cuts) => *known = Some(memory::collected(cuts.surfaces().iter().cloned())?),
                // No surface crosses a cell.
                None if self.tree.tree().is_binary() => *known = Some(Vec::new()),
                None => {}
            },
            WholeQuestion::Moments(known) => *known = self.tree.tree().moments(),
            _ => {}
        }
        Ok(())
    }
}

#[allow(private_bounds)]
impl<T: Tree> FreeParts for StoredOnFrame<T> {
    type Part = StoredPart;
}

#[allow(private_bounds)]
impl<T: Tree> StoredOnFrame<T> {
    /// The cuts, if there are any and they are not damaged.
    fn cuts(&self) -> Option<(&PlacedCuts, &CutsRef<'_>)> {
        Some((self.cuts.as_deref()?, self.tree.tree().cuts.as_ref()?))
    }

    /// The verdict after the record of a PARTIAL cell is taken into account.
    fn settled(&self, cuts: &CutsRef<'_>, verdict: Verdict<StoredPart>) -> Verdict<StoredPart> {
        let Verdict::Partial(StoredPart::Record(record)) = verdict else { return verdict };
        match cuts.at(record as usize) {
            CellCut::None => Verdict::Undecided,
            CellCut::Table { table, .. } => Verdict::Partial(StoredPart::Cut { record, table }),
            CellCut::Split(_) => verdict,
        }
    }
}

/// Exact signs decide the points of trees with cuts.
#[allow(private_bounds)]
impl<T: Tree> Batch for StoredOnFrame<T> {
    fn likes_many(&self) -> bool {
        false
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, StoredPart)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<StoredPart>; 8]>,
    ) -> Result<(), Error> {
        split_one_by_one(self, cells, control, verdicts)
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, StoredPart)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        sample_one_by_one(self, cells, control, inside)
    }

    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        if let Some((placed, cuts)) = self.cuts() {
            for (&point, answer) in points.iter().zip(answers) {
                *answer = placed.inside(self.tree.tree(), cuts, point)?;
            }
        }
        Ok(())
    }

    fn recall(&mut self, _: Cell) -> Option<StoredPart> {
        None
    }
}

#[allow(private_bounds)]
impl<T: Tree> Worker for StoredOnFrame<T> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<StoredPart>, Error> {
        let tree = self.tree.tree();
        Ok(match self.cuts() {
            Some((_, cuts)) => self.settled(cuts, tree.root_with(Some(cuts))),
            None => tree.root_verdict(),
        })
    }

    fn split(&mut self, cell: Cell, part: &StoredPart) -> Result<[Verdict<StoredPart>; 8], Error> {
        let Some((placed, cuts)) = self.cuts() else { return Ok(self.tree.tree().child_verdicts(part)) };
        if let StoredPart::Cut { record, table } = *part {
            return placed.split(cuts, cell, record, table);
        }
        Ok(self.tree.tree().verdicts_with(Some(cuts), part).each(|verdict| self.settled(cuts, verdict)))
    }

    fn answer(&mut self, cell: Cell, part: &StoredPart, question: Question<'_>) -> Result<(), Error> {
        if let (StoredPart::Cut { record, table }, Some((placed, cuts))) = (*part, self.cuts()) {
            placed.answer(cuts, cell, (record, table), question)?;
        }
        Ok(())
    }

    fn split64(
        &mut self,
        cell: Cell,
        part: &StoredPart,
        parts: &mut Vec<(u8, StoredPart)>,
    ) -> Result<Planes, Error> {
        // The grandchildren of an octant lie in the next elements.
        let StoredPart::Element { level, index } = *part else { return split_twice(self, cell, part, parts) };
        let tree = self.tree.tree();
        let planes = tree.described(level, index);
        if planes.partial() != 0 && self.cuts().is_some() {
            return split_twice(self, cell, part, parts);
        }
        for c in (0..64).filter(|c| planes.branch() >> c & 1 != 0) {
            if let Verdict::Partial(part) = tree.verdict(level, index, planes, c) {
                memory::push(parts, (c as u8, part))?;
            }
        }
        // The caller sees a cut cell as PARTIAL, with a part.
        Ok(Planes { lower: planes.full(), upper: planes.upper | planes.lower })
    }

    fn subtree(&self, part: &StoredPart) -> Option<Subtree<'_>> {
        let tree = self.tree.tree();
        match *part {
            // (The planes do not contain the decisions of cuts.)
            StoredPart::Element { level, index } if *tree.frame() == self.frame && self.cuts.is_none() => {
                Some(Subtree { tree, level: level.into(), index, flip: false })
            }
            _ => None,
        }
    }
}

/// An octree, in memory or on disk, as a solid on its own universe. On a frame of fewer levels it is
/// truncated: cells that are cut there become PARTIAL. On a frame of more levels its PARTIAL cells stay
/// undecided. Its verdicts prove as much as its cells do ([`OctreeRef::proof`]).
///
/// Putting the octree on a frame checks all links, O(elements), unless the tree was made in memory. Damaged
/// links of a tree that was mapped unverified are [`Error::Damaged`]. A writer of octrees copies subtrees
/// unchanged. If an unverified tree has sound links but damaged contents, the copy is damaged, too, or
/// [`Error::Damaged`] is returned.
impl<'a> Solid for OctreeRef<'a> {
    type Classifier = StoredOnFrame<OctreeRef<'a>>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<Self::Classifier, Error> {
        StoredOnFrame::new(*self, frame)
    }

    fn bounds(&self) -> Option<Bounds> {
        (self.exterior() == Tag::Empty && self.proof().empty).then(|| Bounds::of(self.frame()))
    }

    fn home(&self) -> Option<Frame> {
        Some(*self.frame())
    }

    /// Covers the stored cells, independent of the encoding of the bricks. O(n).
    fn fingerprint(&self) -> Option<Fingerprint> {
        let frame = self.frame();
        // A cell of an unreadable brick counts as a branch.
        let bricks =
            (0..self.bricks.len()).map(|b| self.bricks.get(b).unwrap_or(Planes::uniform(Tag::Branch)));
        let words = |planes: Planes| [planes.lower, planes.upper];
        let count = |entries: usize| 2 * entries as u64;
        let all = Fingerprinter::new("octree")
            .numbers(&frame.origin())
            .numbers(&[frame.edge()])
            .integers(&[frame.depth().into(), self.root_tag() as u64, self.exterior() as u64])
            .words(count(self.planes.len()), self.planes.iter().copied().flat_map(words))
            .words(count(self.bricks.len()), bricks.flat_map(words));
        Some(match &self.cuts {
            Some(cuts) => cuts.taken_in(all).finish(),
            None => all.finish(),
        })
    }
}

/// As a view of the octree, for callers that need a solid that owns its tree.
impl Solid for Octree {
    type Classifier = StoredOnFrame<Octree>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<Self::Classifier, Error> {
        StoredOnFrame::new(self.clone(), frame)
    }

    fn kept_bytes(&self) -> u64 {
        self.bytes()
    }

    forward_solid!(@shape self => self.view());
}

impl CutsRef<'_> {
    /// Adds the cuts to a fingerprint.
    fn taken_in(&self, all: Fingerprinter) -> Fingerprinter {
        let surfaces = &self.surfaces;
        let doubles = surfaces.doubles.iter().map(|double| double.to_bits());
        let slabs = surfaces.slabs.iter().flat_map(|slab| [slab.home, slab.planes]);
        let groups = surfaces.groups.iter().flat_map(|group| [group.origin[0], group.origin[1], group.end]);
        all.bytes(self.heads)
            .bytes(self.ids.bytes)
            .bytes(bytemuck::cast_slice(surfaces.records))
            .words(surfaces.doubles.len() as u64, doubles)
            .bytes(bytemuck::cast_slice(surfaces.placements))
            .bytes(bytemuck::cast_slice(surfaces.origins))
            .words(2 * surfaces.slabs.len() as u64, slabs)
            .words(3 * surfaces.groups.len() as u64, groups)
    }
}
