//! Points in PARTIAL cells that keep surfaces.

use super::Membership;
use super::descent::{Packed, brick};
use crate::dispatch::{Hot, with_popcount};
use crate::lattice::Ball;
use crate::lattice::Each;
use crate::octree::cuts::{CellCut, CutsRef, Figure, Head};
use crate::octree::links::{Links, levels_below};
use crate::octree::view::OctreeRef;
use crate::octree::{Planes, Tag};

/// A point in its descent of a tree with cuts.
pub(super) struct DescendCuts<'t, 'a> {
    pub tree: &'t OctreeRef<'a>,
    pub cuts: &'t CutsRef<'a>,
    pub point: [f64; 3],
    pub at: [u32; 3],
    /// The starting element and its level.
    pub from: (usize, usize),
}

impl Hot for DescendCuts<'_, '_> {
    type Output = Membership;

    #[inline(always)]
    fn run(self) -> Membership {
        let DescendCuts { tree, from: (mut index, level), .. } = self;
        match tree.root {
            Tag::Branch => {}
            Tag::Partial => return self.record(CutsRef::ROOT, 0),
            tag => return tag.into(),
        }
        let at = Packed::new(self.at);
        let links = Links::new(tree);
        for (shift, level) in levels_below(tree).skip(level) {
            let c = at.cell(shift);
            let (tag, child, goes_on) = links.step(index, c, level);
            if !goes_on {
                return self.settled(tag, index, links.planes(index), c, shift);
            }
            index = child;
        }
        let (planes, c) = (brick(tree, index), at.cell(0));
        self.settled(planes.tag(c), index, planes, c, 0)
    }
}

impl DescendCuts<'_, '_> {
    /// Returns the answer of cell `c` of an element whose cells have an edge of 2^shift.
    #[inline(always)]
    pub(super) fn settled(&self, tag: Tag, index: usize, planes: Planes, c: u32, shift: u32) -> Membership {
        if tag != Tag::Partial {
            return tag.into();
        }
        let level = self.tree.frame.depth() - shift as u8 - (planes.octant(c >> 3) == Tag::Partial) as u8;
        self.record(self.cuts.record(index, planes, c), level)
    }

    /// Returns the answer of the cut of a cell of `level`.
    fn record(&self, mut record: usize, mut level: u8) -> Membership {
        let depth = self.tree.frame.depth();
        loop {
            match self.cuts.at(record) {
                CellCut::None => return Membership::Undecided,
                CellCut::Table { ids, mut table } => {
                    let point = self.point.each(Ball::exactly);
                    for (i, &id) in ids.iter().enumerate() {
                        // The sides of other surfaces may make this one irrelevant.
                        if !Head::needs(table, i) {
                            continue;
                        }
                        let figure = Figure::new(&self.cuts.surfaces, id);
                        if let Some(side) = figure.and_then(|figure| figure.side(point, [0.0; 3])) {
                            table = Head::on_side(table, i, side);
                        }
                    }
                    return match Head(table) {
                        Head::NOWHERE => Membership::Outside,
                        Head::EVERYWHERE => Membership::Inside,
                        _ => Membership::Undecided,
                    };
                }
                CellCut::Split(_) if level >= depth => return Membership::Undecided,
                CellCut::Split(first) => {
                    level += 1;
                    let bit = |axis: usize| (self.at[axis] >> (depth - level) & 1) as usize;
                    record = first + (bit(0) | bit(1) << 1 | bit(2) << 2);
                }
            }
        }
    }
}

impl OctreeRef<'_> {
    /// Returns whether a tree with cuts contains a point of its universe.
    pub(super) fn contains_by_cuts(&self, cuts: &CutsRef<'_>, point: [f64; 3]) -> Membership {
        match self.frame.cell_of(point) {
            Some(at) => with_popcount(DescendCuts { tree: self, cuts, point, at, from: (0, 0) }),
            None => Membership::Undecided,
        }
    }
}
