//! A stored octree as a solid.

use super::forward::forward_solid;
use super::{
    Classifier, Fingerprint, Fingerprinter, FreeParts, OCTANTS, OneByOne, Question, Solid, Subtree, Verdict,
    WholeQuestion, Worker, split_twice,
};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Bounds, Cell, Frame};
use crate::memory;
use crate::octree::links::Step;
use crate::octree::view::starts_half_way;
use crate::octree::{Octree, OctreeRef, Planes, Proof, Tag};
use alloc::vec::Vec;

/// Where a cut cell of a stored octree is described.
#[derive(Debug, Clone, Copy)]
pub enum StoredPart {
    /// By all of an element.
    Element {
        /// Element level.
        level: u8,
        /// Index of the element.
        index: usize,
    },
    /// By one octant of an element.
    Octant {
        /// Element level.
        level: u8,
        /// Index of the element.
        index: usize,
        /// The octant.
        octant: u8,
    },
}

impl OctreeRef<'_> {
    /// The element that a part names. Links are followed from parents to children only, and the level rises
    /// with each: whatever the bytes, a descent ends. A part that somebody made up leads nowhere.
    fn described(&self, level: u8, index: usize) -> Planes {
        let level = level as usize;
        let on_level = level < self.levels() && self.on_level(index, level);
        let entry = if on_level { self.entry(index) } else { None };
        entry.unwrap_or(Planes::uniform(Tag::Partial))
    }

    /// The universe.
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

    /// The eight children of any cell: those of one that is not cut are like it. (As for
    /// [`child_verdicts`](Self::child_verdicts).)
    pub(crate) fn verdicts_below(&self, verdict: &Verdict<StoredPart>) -> [Verdict<StoredPart>; 8] {
        match verdict {
            Verdict::Partial(part) => self.child_verdicts(part),
            settled => [*settled; 8],
        }
    }

    /// The eight children of a cut cell. (The links of a tree that is walked must have been checked.)
    pub(crate) fn child_verdicts(&self, part: &StoredPart) -> [Verdict<StoredPart>; 8] {
        match *part {
            StoredPart::Element { level, index } => {
                let planes = self.described(level, index);
                OCTANTS.map(|octant| match planes.octant(octant as u32) {
                    Tag::Empty => Verdict::Empty,
                    Tag::Full => Verdict::Full,
                    Tag::Partial => Verdict::Undecided,
                    Tag::Branch => Verdict::Partial(StoredPart::Octant { level, index, octant }),
                })
            }
            StoredPart::Octant { level, index, octant } => {
                let planes = self.described(level, index);
                OCTANTS.map(|k| self.verdict(level, index, planes, (8 * (octant & 7) + k) as u32))
            }
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

/// A tree that is borrowed, or owned: where its view comes from.
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

/// A stored octree whose links are checked, on a frame of its universe: handle and worker.
#[derive(Debug, Clone)]
pub struct StoredOnFrame<T> {
    tree: T,
    frame: Frame,
}

#[allow(private_bounds)]
impl<T: Tree> StoredOnFrame<T> {
    fn new(tree: T, frame: &Frame) -> Result<StoredOnFrame<T>, Error> {
        if !frame.same_universe(tree.tree().frame()) {
            return Err(tree.tree().frame().mismatch(frame));
        }
        // A descent remembers nothing, so elements with shared children would be visited again and again:
        // 64^10 times in a file of a few kilobytes.
        tree.tree().ensure_links()?;
        Ok(StoredOnFrame { tree, frame: *frame })
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

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

#[allow(private_bounds)]
impl<T: Tree> FreeParts for StoredOnFrame<T> {
    type Part = StoredPart;
}

#[allow(private_bounds)]
impl<T: Tree> OneByOne for StoredOnFrame<T> {}

#[allow(private_bounds)]
impl<T: Tree> Worker for StoredOnFrame<T> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<StoredPart>, Error> {
        Ok(self.tree.tree().root_verdict())
    }

    fn split(&mut self, _: Cell, part: &StoredPart) -> Result<[Verdict<StoredPart>; 8], Error> {
        Ok(self.tree.tree().child_verdicts(part))
    }

    fn answer(&mut self, _: Cell, _: &StoredPart, _: Question<'_>) -> Result<(), Error> {
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
        for c in (0..64).filter(|c| planes.branch() >> c & 1 != 0) {
            if let Verdict::Partial(part) = tree.verdict(level, index, planes, c) {
                memory::push(parts, (c as u8, part))?;
            }
        }
        // Whoever asks sees a cut cell as PARTIAL with a part.
        Ok(Planes { lower: planes.full(), upper: planes.upper | planes.lower })
    }

    fn subtree(&self, part: &StoredPart) -> Option<Subtree<'_>> {
        let tree = self.tree.tree();
        match *part {
            StoredPart::Element { level, index } if *tree.frame() == self.frame => {
                Some(Subtree { tree, level: level.into(), index, flip: false })
            }
            _ => None,
        }
    }
}

/// An octree, in memory or on disk, as a solid on its own universe. Built to fewer levels it is cut there
/// (what is cut becomes PARTIAL), built to more its PARTIAL cells stay undecided. Its verdicts prove what its
/// cells do ([`OctreeRef::proof`]).
///
/// To put it on a frame, all links are checked, O(elements), unless the tree was made in memory: [`Error::Damaged`] if the tree was mapped
/// unverified and they are damaged. Whoever writes an octree copies subtrees as they are: of an unverified
/// one whose links are sound, but not what they lead to, the copy is damaged, too, or [`Error::Damaged`] is
/// returned.
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

    /// Of what is stored, however its bricks are encoded. O(n).
    fn fingerprint(&self) -> Option<Fingerprint> {
        let frame = self.frame();
        // Of a brick that cannot be read a cell would be a branch.
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
        Some(all.finish())
    }
}

/// As a view of it, for whoever needs a solid that owns its tree.
impl Solid for Octree {
    type Classifier = StoredOnFrame<Octree>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<Self::Classifier, Error> {
        StoredOnFrame::new(self.clone(), frame)
    }

    forward_solid!(@description self => self.view());
}
