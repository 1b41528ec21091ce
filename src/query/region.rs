//! How does a box lie to the solid?

use crate::error::Error;
use crate::lattice::morton;
use crate::octree::view::{OctreeRef, Windows};
use crate::octree::{Octree, Planes, Tag};

/// The answer to a box query. Each is proven, but for the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Region {
    /// The interiors of box and solid are disjoint.
    Outside = 0,
    /// The box lies in the solid.
    Inside = 1,
    /// Part of the box lies inside, part outside.
    Crossing = 2,
    /// None of these could be proven at the tree's depth.
    Undecided = 3,
}

/// What has been met in the box so far, and the box: first and last finest cell per axis.
struct Search<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    first: [u32; 3],
    last: [u32; 3],
    windows: Windows,
    empty: bool,
    full: bool,
    partial: bool,
}

impl OctreeRef<'_> {
    /// How the box `[min, max]` (model units, min ≤ max) lies to the solid; what of it lies outside of the
    /// universe is undecided. Ends as soon as the answer is known; whatever the bytes, no element is read
    /// twice.
    ///
    /// # Errors
    /// [`Error::Argument`] if min > max on an axis, or a coordinate is not a number.
    pub fn classify_box(&self, min: [f64; 3], max: [f64; 3]) -> Result<Region, Error> {
        if (0..3).any(|axis| min[axis] > max[axis] || min[axis].is_nan() || max[axis].is_nan()) {
            return Err(Error::Argument {
                name: "max",
                problem: "must be a number not below min on any axis",
            });
        }
        let mut search = Search {
            tree: self,
            first: [0; 3],
            last: [0; 3],
            windows: Windows::new(self),
            empty: false,
            full: false,
            partial: false,
        };
        for axis in 0..3 {
            let Some((first, last, outside)) = self.frame.cells_between(axis, min[axis], max[axis]) else {
                return Ok(Region::Undecided);
            };
            (search.first[axis], search.last[axis]) = (first, last);
            search.partial |= outside;
        }
        match self.root {
            Tag::Branch => search.element(0, 0, [0; 3]),
            tag => search.note(Planes::uniform(tag), 1),
        }
        Ok(match (search.empty, search.full, search.partial) {
            (true, true, _) => Region::Crossing,
            (true, false, false) => Region::Outside,
            (false, true, false) => Region::Inside,
            _ => Region::Undecided,
        })
    }
}

impl Search<'_, '_> {
    fn note(&mut self, planes: Planes, mask: u64) {
        self.empty |= planes.empty() & mask != 0;
        self.full |= planes.full() & mask != 0;
        self.partial |= planes.partial() & mask != 0;
    }

    /// Looks at the part of element `index` of level `e` that lies in the box; `origin` is its lowest finest
    /// cell. The recursion is as deep as the tree has element levels, ten at the most.
    fn element(&mut self, e: usize, index: usize, origin: [u32; 3]) {
        let levels = self.tree.levels();
        let Some(planes) = self.tree.entry(index) else {
            self.partial = true;
            return;
        };
        let shift = 2 * (levels - 1 - e);
        let mut mask = !0;
        for (axis, &start) in origin.iter().enumerate() {
            let end = start + (4 << shift) - 1;
            let first = self.first[axis].max(start) - start;
            let last = self.last[axis].min(end) - start;
            mask &= morton::slabs(axis, first >> shift, last >> shift);
        }
        self.note(planes, mask);
        let mut branches = planes.branch() & mask;
        while branches != 0 && !(self.empty && self.full) {
            let c = branches.trailing_zeros();
            branches &= branches - 1;
            match self.windows.child(self.tree, index, planes.branch(), c, (e + 1).min(levels - 1)) {
                Ok(child) if e + 1 < levels => {
                    let at = morton::position(c);
                    self.element(e + 1, child, [0, 1, 2].map(|axis| origin[axis] + (at[axis] << shift)));
                }
                _ => self.partial = true,
            }
        }
    }
}

impl Octree {
    /// As [`OctreeRef::classify_box`].
    ///
    /// # Errors
    /// As [`OctreeRef::classify_box`].
    pub fn classify_box(&self, min: [f64; 3], max: [f64; 3]) -> Result<Region, Error> {
        self.view().classify_box(min, max)
    }
}
