//! A stored octree as a solid.

use super::{Fingerprint, Fingerprinter, Solid, Verdict, split_twice};
use crate::error::Error;
use crate::lattice::{Cube, Frame};
use crate::octree::view::starts_half_way;
use crate::octree::{Octree, OctreeRef, Planes, Tag};
use alloc::vec::Vec;

/// An octree, in memory or on disk, as a solid on its own universe. Built to fewer levels it is cut there
/// (what is cut becomes PARTIAL), built to more its PARTIAL cells stay undecided.
///
/// Its [root](Solid::root) is given only once all links are checked, O(elements): [`Error::Damaged`] if the
/// tree was mapped unverified and they are damaged.
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

const OCTANTS: [u8; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

impl Solid for Stored<'_> {
    type Part = StoredPart;
    type Scratch = ();

    fn root(&self, _: &mut (), frame: &Frame) -> Result<Verdict<StoredPart>, Error> {
        if !frame.same_universe(self.0.frame()) {
            return Err(Error::FrameMismatch);
        }
        // A descent remembers nothing, so elements with shared children would be visited again and again:
        // 64^10 times in a file of a few kilobytes.
        self.0.check_links()?;
        let half = starts_half_way(self.0.frame().depth());
        Ok(match self.0.root_tag() {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Partial => Verdict::Undecided,
            Tag::Branch if half => Verdict::Partial(StoredPart::Octant { level: 0, index: 0, octant: 0 }),
            Tag::Branch => Verdict::Partial(StoredPart::Element { level: 0, index: 0 }),
        })
    }

    fn split(&self, _: &mut (), _: &Cube<'_>, part: &StoredPart) -> Result<[Verdict<StoredPart>; 8], Error> {
        Ok(match *part {
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
        })
    }

    fn split64(
        &self,
        scratch: &mut (),
        cube: &Cube<'_>,
        part: &StoredPart,
        parts: &mut Vec<(u8, StoredPart)>,
    ) -> Result<Planes, Error> {
        // An octant straddles the stored grain: its grandchildren lie in the next elements.
        let StoredPart::Element { level, index } = *part else {
            return split_twice(self, scratch, cube, part, parts);
        };
        let planes = self.entry(level, index);
        for c in (0..64).filter(|c| planes.branch() >> c & 1 != 0) {
            if let Verdict::Partial(part) = self.cell(level, index, planes, c) {
                parts.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
                parts.push((c as u8, part));
            }
        }
        // Whoever asks sees a cut cell as PARTIAL with a part.
        Ok(Planes { lower: planes.full(), upper: planes.upper | planes.lower })
    }

    fn exterior(&self, _: &Frame) -> Tag {
        self.0.exterior()
    }

    /// Of what is stored, however its bricks are encoded. O(n).
    fn fingerprint(&self) -> Option<Fingerprint> {
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
        Some(all.finish())
    }
}

/// As [`Stored`], for whoever needs a solid that owns its tree.
impl Solid for Octree {
    type Part = StoredPart;
    type Scratch = ();

    fn root(&self, scratch: &mut (), frame: &Frame) -> Result<Verdict<StoredPart>, Error> {
        Stored(*self.view()).root(scratch, frame)
    }

    fn split(
        &self,
        scratch: &mut (),
        cube: &Cube<'_>,
        part: &StoredPart,
    ) -> Result<[Verdict<StoredPart>; 8], Error> {
        Stored(*self.view()).split(scratch, cube, part)
    }

    fn split64(
        &self,
        scratch: &mut (),
        cube: &Cube<'_>,
        part: &StoredPart,
        parts: &mut Vec<(u8, StoredPart)>,
    ) -> Result<Planes, Error> {
        Stored(*self.view()).split64(scratch, cube, part, parts)
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        Stored(*self.view()).exterior(frame)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Stored(*self.view()).fingerprint()
    }
}
