//! Minimal faces and edges of cells of several sizes: those that no smaller cell cuts.
//!
//! (Ju, Losasso, Schaefer and Warren, *Dual contouring of Hermite data*, 2002, section 3.2.)

use super::leaves::{Leaf, Leaves};
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;

/// A cell with its leaf.
#[derive(Debug, Clone, Copy)]
pub(super) struct At {
    pub(super) cell: Cell,
    pub(super) leaf: Leaf,
}

impl At {
    /// A rank of sizes: the smaller the cell, the greater the rank.
    fn size(&self) -> u8 {
        if matches!(self.leaf, Leaf::Outside) { 0 } else { 1 + self.cell.level }
    }
}

/// A face between a cell and the next one along an axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub(super) axis: usize,
    /// The lower corner, in finest cells.
    pub(super) at: [u32; 3],
    pub(super) edge: u32,
    /// The cells below and above the face.
    pub(super) sides: [At; 2],
}

/// An edge between four cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub(super) axis: usize,
    /// The lower end, in finest cells.
    pub(super) at: [u32; 3],
    pub(super) length: u32,
    /// The cells around the edge. Bit 0 of a cell's place is for the next axis in cyclic order, bit 1 for the
    /// axis after it.
    pub(super) around: [At; 4],
}

/// A visitor of minimal faces and edges.
pub(super) trait Visitor {
    fn face(&mut self, face: &Face) -> Result<(), Error>;
    fn edge(&mut self, edge: &Edge) -> Result<(), Error>;
}

impl Leaves {
    /// Visits all minimal faces and edges of open cells. The space around the universe is empty.
    pub(super) fn walk(&self, visitor: &mut impl Visitor) -> Result<(), Error> {
        let (root, outside) =
            (At { cell: Cell::ROOT, leaf: self.root }, At { cell: Cell::ROOT, leaf: Leaf::Outside });
        self.in_cell(root, visitor)?;
        for axis in 0..3 {
            self.across_face([outside, root], axis, visitor)?;
            self.across_face([root, outside], axis, visitor)?;
            for place in 0..4 {
                self.around_edge(
                    [0, 1, 2, 3].each(|q| if q == place { root } else { outside }),
                    axis,
                    visitor,
                )?;
            }
        }
        Ok(())
    }

    /// The child in an octant. A cell that is not split stands for its children.
    fn child(&self, at: &At, octant: usize) -> At {
        match at.leaf {
            Leaf::Branch(node) => {
                At { cell: at.cell.child(octant as u8), leaf: self.nodes[node as usize][octant] }
            }
            _ => *at,
        }
    }

    fn in_cell(&self, at: At, visitor: &mut impl Visitor) -> Result<(), Error> {
        let Leaf::Branch(_) = at.leaf else { return Ok(()) };
        for octant in 0..8 {
            self.in_cell(self.child(&at, octant), visitor)?;
        }
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for part in 0..4 {
                let low = (part & 1) << u | (part >> 1) << v;
                self.across_face([self.child(&at, low), self.child(&at, low | 1 << axis)], axis, visitor)?;
            }
            for half in 0..2 {
                let around =
                    [0, 1, 2, 3].each(|q| self.child(&at, half << axis | (q & 1) << u | (q >> 1) << v));
                self.around_edge(around, axis, visitor)?;
            }
        }
        Ok(())
    }

    fn across_face(&self, sides: [At; 2], axis: usize, visitor: &mut impl Visitor) -> Result<(), Error> {
        let is_split = |at: &At| matches!(at.leaf, Leaf::Branch(_));
        if !sides.iter().any(is_split) {
            if !sides.iter().any(|at| matches!(at.leaf, Leaf::Open(_))) {
                return Ok(());
            }
            let small = usize::from(sides[1].size() > sides[0].size());
            let cell = sides[small].cell;
            let log = self.depth - cell.level;
            let mut at = cell.at.each(|c| c << log);
            if small == 0 {
                at[axis] += 1 << log;
            }
            return visitor.face(&Face { axis, at, edge: 1 << log, sides });
        }
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        // The children that touch the face: the upper children of the lower cell, and the lower ones of the
        // upper cell.
        let touching = |side: usize, pu: usize, pv: usize| {
            self.child(&sides[side], (1 - side) << axis | pu << u | pv << v)
        };
        for part in 0..4 {
            let (pu, pv) = (part & 1, part >> 1);
            self.across_face([touching(0, pu, pv), touching(1, pu, pv)], axis, visitor)?;
        }
        for half in 0..2 {
            // Along u, the axes around the edge are v and the face's axis; along v, they are the face's axis
            // and u.
            let along_u =
                [touching(0, half, 0), touching(0, half, 1), touching(1, half, 0), touching(1, half, 1)];
            self.around_edge(along_u, u, visitor)?;
            let along_v =
                [touching(0, 0, half), touching(1, 0, half), touching(0, 1, half), touching(1, 1, half)];
            self.around_edge(along_v, v, visitor)?;
        }
        Ok(())
    }

    fn around_edge(&self, around: [At; 4], axis: usize, visitor: &mut impl Visitor) -> Result<(), Error> {
        let is_split = |at: &At| matches!(at.leaf, Leaf::Branch(_));
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        if !around.iter().any(is_split) {
            if !around.iter().any(|at| matches!(at.leaf, Leaf::Open(_))) {
                return Ok(());
            }
            let small =
                (0..4).fold(0, |best, q| if around[q].size() > around[best].size() { q } else { best });
            let cell = around[small].cell;
            let log = self.depth - cell.level;
            let mut at = cell.at.each(|c| c << log);
            // A cell below the edge has the edge at its upper side.
            at[u] += u32::from(small & 1 == 0) << log;
            at[v] += u32::from(small >> 1 == 0) << log;
            return visitor.edge(&Edge { axis, at, length: 1 << log, around });
        }
        for half in 0..2 {
            let children = [0, 1, 2, 3]
                .each(|q| self.child(&around[q], half << axis | (1 - (q & 1)) << u | (1 - (q >> 1)) << v));
            self.around_edge(children, axis, visitor)?;
        }
        Ok(())
    }
}
