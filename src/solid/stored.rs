//! A stored octree as a solid.

use super::{Classifier, Fingerprint, Fingerprinter, OCTANTS, Solid, Subtree, Verdict, Worker, split_twice};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Bounds, Cell, Frame};
use crate::memory;
use crate::octree::view::starts_half_way;
use crate::octree::{Octree, OctreeRef, Planes, Tag};
use alloc::vec::Vec;

/// An octree, in memory or on disk, as a solid on its own universe. Built to fewer levels it is cut there
/// (what is cut becomes PARTIAL), built to more its PARTIAL cells stay undecided.
///
/// To put it on a frame, all links are checked, O(elements): [`Error::Damaged`] if the tree was mapped unverified and
/// they are damaged. Whoever writes an octree copies subtrees as they are: of an unverified one whose links are sound, but
/// not what they lead to, the copy is damaged, too, or [`Error::Damaged`] is returned.
#[derive(Debug, Clone, Copy)]
pub struct Stored<'a>(OctreeRef<'a>);

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

impl<'a> Stored<'a> {
    /// The octree as a solid.
    pub fn new(tree: &OctreeRef<'a>) -> Stored<'a> {
        Stored(*tree)
    }

    /// Links are followed from parents to children only, and the level rises with each: whatever the bytes,
    /// a descent ends. A part that somebody made up leads nowhere.
    fn entry(&self, level: u8, index: usize) -> Planes {
        let (tree, level) = (&self.0, level as usize);
        let on_level = level < tree.levels() && tree.on_level(index, level);
        let entry = if on_level { tree.entry(index) } else { None };
        entry.unwrap_or(Planes::uniform(Tag::Partial))
    }

    fn cell(&self, level: u8, index: usize, planes: Planes, c: u32) -> Verdict<StoredPart> {
        match planes.tag(c) {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Partial => Verdict::Undecided,
            Tag::Branch => match self.0.child(index, planes.branch(), c) {
                Some(child) if level as usize + 1 < self.0.levels() => {
                    Verdict::Partial(StoredPart::Element { level: level + 1, index: child })
                }
                _ => Verdict::Undecided,
            },
        }
    }
}

impl Stored<'_> {
    fn root_on(&self, frame: &Frame) -> Result<(), Error> {
        if !frame.same_universe(self.0.frame()) {
            return Err(Error::FrameMismatch);
        }
        // A descent remembers nothing, so elements with shared children would be visited again and again:
        // 64^10 times in a file of a few kilobytes.
        Ok(self.0.check_links()?)
    }

    fn bounds(&self) -> Option<Bounds> {
        (self.0.exterior() == Tag::Empty).then(|| Bounds::of(self.0.frame()))
    }

    /// Of what is stored, however its bricks are encoded. O(n).
    fn fingerprint(&self) -> Fingerprint {
        let (tree, frame) = (&self.0, self.0.frame());
        // Of a brick that cannot be read a cell would be a branch.
        let bricks =
            (0..tree.bricks.len()).map(|b| tree.bricks.get(b).unwrap_or(Planes::uniform(Tag::Branch)));
        let words = |planes: Planes| [planes.lower, planes.upper];
        let count = |entries: usize| 2 * entries as u64;
        let all = Fingerprinter::new("octree")
            .numbers(&frame.origin())
            .numbers(&[frame.edge()])
            .integers(&[frame.depth().into(), tree.root_tag() as u64, tree.exterior() as u64])
            .words(count(tree.planes.len()), tree.planes.iter().copied().flat_map(words))
            .words(count(tree.bricks.len()), bricks.flat_map(words));
        all.finish()
    }

    fn root(&self) -> Verdict<StoredPart> {
        let half = starts_half_way(self.0.frame().depth());
        match self.0.root_tag() {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Partial => Verdict::Undecided,
            Tag::Branch if half => Verdict::Partial(StoredPart::Octant { level: 0, index: 0, octant: 0 }),
            Tag::Branch => Verdict::Partial(StoredPart::Element { level: 0, index: 0 }),
        }
    }

    fn split(&self, part: &StoredPart) -> [Verdict<StoredPart>; 8] {
        match *part {
            StoredPart::Element { level, index } => {
                let planes = self.entry(level, index);
                OCTANTS.map(|octant| match planes.octant(octant as u32) {
                    Tag::Empty => Verdict::Empty,
                    Tag::Full => Verdict::Full,
                    Tag::Partial => Verdict::Undecided,
                    Tag::Branch => Verdict::Partial(StoredPart::Octant { level, index, octant }),
                })
            }
            StoredPart::Octant { level, index, octant } => {
                let planes = self.entry(level, index);
                OCTANTS.map(|k| self.cell(level, index, planes, (8 * (octant & 7) + k) as u32))
            }
        }
    }

    /// The two levels of an element; `None` if the part is an octant of one, which straddles the stored grain.
    fn split64(&self, part: &StoredPart, parts: &mut Vec<(u8, StoredPart)>) -> Result<Option<Planes>, Error> {
        let StoredPart::Element { level, index } = *part else { return Ok(None) };
        let planes = self.entry(level, index);
        for c in (0..64).filter(|c| planes.branch() >> c & 1 != 0) {
            if let Verdict::Partial(part) = self.cell(level, index, planes, c) {
                memory::push(parts, (c as u8, part))?;
            }
        }
        // Whoever asks sees a cut cell as PARTIAL with a part.
        Ok(Some(Planes { lower: planes.full(), upper: planes.upper | planes.lower }))
    }
}

/// A tree that is borrowed, or owned: where its view comes from.
trait Tree: Clone + Send + Sync {
    fn stored(&self) -> Stored<'_>;
}

impl Tree for Stored<'_> {
    fn stored(&self) -> Stored<'_> {
        *self
    }
}

impl Tree for Octree {
    fn stored(&self) -> Stored<'_> {
        Stored(*self.view())
    }
}

/// A stored octree whose links are checked, on a frame of its universe: handle and worker.
#[derive(Debug, Clone)]
pub struct OnFrame<T> {
    tree: T,
    frame: Frame,
}

#[allow(private_bounds)]
impl<T: Tree> OnFrame<T> {
    fn new(tree: T, frame: &Frame) -> Result<OnFrame<T>, Error> {
        tree.stored().root_on(frame)?;
        Ok(OnFrame { tree, frame: *frame })
    }
}

#[allow(private_bounds)]
impl<T: Tree> Classifier for OnFrame<T> {
    type Worker = OnFrame<T>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<OnFrame<T>, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        self.tree.stored().0.exterior()
    }
}

#[allow(private_bounds)]
impl<T: Tree> Worker for OnFrame<T> {
    type Part = StoredPart;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<StoredPart>, Error> {
        Ok(self.tree.stored().root())
    }

    fn split(&mut self, _: Cell, part: &StoredPart) -> Result<[Verdict<StoredPart>; 8], Error> {
        Ok(self.tree.stored().split(part))
    }

    fn split64(
        &mut self,
        cell: Cell,
        part: &StoredPart,
        parts: &mut Vec<(u8, StoredPart)>,
    ) -> Result<Planes, Error> {
        match self.tree.stored().split64(part, parts)? {
            Some(planes) => Ok(planes),
            // The grandchildren lie in the next elements.
            None => split_twice(self, cell, part, parts),
        }
    }

    fn subtree(&self, part: &StoredPart) -> Option<Subtree<'_>> {
        let Stored(tree) = self.tree.stored();
        match *part {
            StoredPart::Element { level, index } if *tree.frame() == self.frame => {
                Some(Subtree { tree, level: level.into(), index, flip: false })
            }
            _ => None,
        }
    }
}

impl<'a> Solid for Stored<'a> {
    type Classifier = OnFrame<Stored<'a>>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<Self::Classifier, Error> {
        OnFrame::new(*self, frame)
    }

    fn bounds(&self) -> Option<Bounds> {
        Stored::bounds(self)
    }

    fn home(&self) -> Option<Frame> {
        Some(*self.0.frame())
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Stored::fingerprint(self))
    }
}

/// As [`Stored`], for whoever needs a solid that owns its tree.
impl Solid for Octree {
    type Classifier = OnFrame<Octree>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<Self::Classifier, Error> {
        OnFrame::new(self.clone(), frame)
    }

    fn bounds(&self) -> Option<Bounds> {
        self.stored().bounds()
    }

    fn home(&self) -> Option<Frame> {
        Some(*self.frame())
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(self.stored().fingerprint())
    }
}
