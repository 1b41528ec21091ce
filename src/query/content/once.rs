//! A stored octree in a walk that meets each of its cells once.

use super::below;
use super::walk::Counted;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::links::Windows;
use crate::octree::view::starts_half_way;
use crate::octree::{OctreeRef, Planes, Tag};
use crate::solid::{FreeParts, OneByOne, Question, Verdict, Worker, split_twice};
use alloc::vec::Vec;

/// An octree as it is, whatever its cells prove. Each cell may be split once, depth first and in Morton
/// order. The links therefore need no check beforehand, which would take time in proportion to the whole
/// tree.
pub(super) struct Once<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    windows: Windows,
}

/// The place where a cut cell is described.
#[derive(Clone, Copy)]
pub(super) enum Place {
    Element { level: usize, index: usize },
    Octant { level: usize, index: usize, octant: u8 },
}

impl<'t, 'a> Once<'t, 'a> {
    pub(super) fn new(tree: &'t OctreeRef<'a>) -> Once<'t, 'a> {
        Once { tree, windows: Windows::new(tree) }
    }

    fn planes(&self, index: usize) -> Planes {
        self.tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial))
    }

    fn verdict(&mut self, level: usize, index: usize, planes: Planes, c: u32) -> Verdict<Place> {
        match planes.tag(c) {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Branch if level + 1 < self.tree.levels() => {
                match self.windows.child(self.tree, index, planes.branch(), c, level + 1) {
                    Ok(index) => Verdict::Partial(Place::Element { level: level + 1, index }),
                    Err(_) => Verdict::Undecided,
                }
            }
            Tag::Partial | Tag::Branch => Verdict::Undecided,
        }
    }
}

impl Counted for Once<'_, '_> {
    fn below(&mut self, cells: u64, place: &Place) -> Option<[u64; 2]> {
        let Place::Element { level, index } = *place else { return None };
        // A damaged cell is undecided.
        Some(below::count(self.tree, level, index, Some(&mut self.windows)).unwrap_or([0, cells]))
    }
}

impl FreeParts for Once<'_, '_> {
    type Part = Place;
}

impl OneByOne for Once<'_, '_> {}

impl Worker for Once<'_, '_> {
    fn frame(&self) -> &Frame {
        self.tree.frame()
    }

    fn root(&mut self) -> Result<Verdict<Place>, Error> {
        Ok(match self.tree.root_tag() {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Partial => Verdict::Undecided,
            Tag::Branch if starts_half_way(self.tree.frame().depth()) => {
                Verdict::Partial(Place::Octant { level: 0, index: 0, octant: 0 })
            }
            Tag::Branch => Verdict::Partial(Place::Element { level: 0, index: 0 }),
        })
    }

    fn split(&mut self, _: Cell, place: &Place) -> Result<[Verdict<Place>; 8], Error> {
        Ok(match *place {
            Place::Element { level, index } => {
                let planes = self.planes(index);
                [0, 1, 2, 3, 4, 5, 6, 7].each(|octant| match planes.octant(octant) {
                    Tag::Empty => Verdict::Empty,
                    Tag::Full => Verdict::Full,
                    Tag::Partial => Verdict::Undecided,
                    Tag::Branch => Verdict::Partial(Place::Octant { level, index, octant: octant as u8 }),
                })
            }
            Place::Octant { level, index, octant } => {
                let planes = self.planes(index);
                let first = 8 * u32::from(octant & 7);
                [0, 1, 2, 3, 4, 5, 6, 7].each(|k| self.verdict(level, index, planes, first + k))
            }
        })
    }

    fn answer(&mut self, _: Cell, _: &Place, _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }

    fn split64(&mut self, cell: Cell, place: &Place, parts: &mut Vec<(u8, Place)>) -> Result<Planes, Error> {
        let Place::Element { level, index } = *place else {
            return split_twice(self, cell, place, parts);
        };
        let planes = self.planes(index);
        let mut branches = planes.branch();
        while branches != 0 {
            let c = branches.trailing_zeros();
            branches &= branches - 1;
            if let Verdict::Partial(place) = self.verdict(level, index, planes, c) {
                memory::push(parts, (c as u8, place))?;
            }
        }
        // A cut cell is PARTIAL, with a part.
        Ok(Planes { lower: planes.full(), upper: planes.upper | planes.lower })
    }
}
