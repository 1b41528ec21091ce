//! Minimal faces and edges of cells of several sizes: those that no smaller cell cuts.
//!
//! (Ju, Losasso, Schaefer and Warren, *Dual contouring of Hermite data*, 2002, section 3.2.)

use super::cells::{Cells, OUTSIDE, Slot};
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;

/// A cell, split or not.
#[derive(Debug, Clone, Copy)]
struct At {
    cell: Cell,
    slot: Slot,
}

impl At {
    fn is_split(&self) -> bool {
        matches!(self.slot, Slot::Branch(_))
    }

    fn leaf(&self) -> u32 {
        match self.slot {
            Slot::Leaf(leaf) => leaf,
            Slot::Branch(_) => OUTSIDE,
        }
    }

    /// A rank of sizes: the smaller the cell, the greater the rank. The space around the universe has the
    /// least.
    fn fineness(&self) -> u8 {
        if self.leaf() == OUTSIDE { 0 } else { self.cell.level + 1 }
    }
}

/// A face between two cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub(super) axis: usize,
    /// The lower corner, in finest cells.
    pub(super) at: [u32; 3],
    pub(super) length: u32,
    /// The leaves below and above the face.
    pub(super) sides: [u32; 2],
}

/// An edge between four cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub(super) axis: usize,
    /// The lower end, in finest cells.
    pub(super) at: [u32; 3],
    pub(super) length: u32,
    /// The leaves around the edge, counter-clockwise as seen from above: first low on both other axes, then
    /// high on the next axis in cyclic order.
    pub(super) around: [u32; 4],
}

/// The places of the cells around an edge, on the two next axes.
const ROUND: [[usize; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

/// A visitor of minimal faces and edges.
pub(super) trait Visitor {
    fn face(&mut self, face: &Face) -> Result<(), Error>;
    fn edge(&mut self, edge: &Edge) -> Result<(), Error>;
}

/// Visits all minimal faces and edges, including those on the boundary of the universe.
pub(super) fn walk(cells: &Cells, visitor: &mut impl Visitor) -> Result<(), Error> {
    let root = At { cell: Cell::ROOT, slot: cells.root };
    let outside = At { cell: Cell::ROOT, slot: Slot::Leaf(OUTSIDE) };
    let mut walker = Walker { cells, visitor };
    walker.in_cell(root)?;
    for axis in 0..3 {
        walker.across_face(axis, [outside, root])?;
        walker.across_face(axis, [root, outside])?;
        for place in 0..4 {
            let mut around = [outside; 4];
            around[place] = root;
            walker.around_edge(axis, around)?;
        }
    }
    Ok(())
}

struct Walker<'w, V> {
    cells: &'w Cells,
    visitor: &'w mut V,
}

impl<V: Visitor> Walker<'_, V> {
    /// The child at a place on three axes, the first of which is `axis`. A cell that is not split stands for
    /// its children.
    fn child(&self, at: At, axis: usize, [a, u, v]: [usize; 3]) -> At {
        let Slot::Branch(node) = at.slot else { return at };
        let octant = a << axis | u << ((axis + 1) % 3) | v << ((axis + 2) % 3);
        At { cell: at.cell.child(octant as u8), slot: self.cells.nodes[node as usize][octant] }
    }

    fn in_cell(&mut self, at: At) -> Result<(), Error> {
        if !at.is_split() {
            return Ok(());
        }
        for octant in 0..8 {
            self.in_cell(self.child(at, 0, [octant & 1, octant >> 1 & 1, octant >> 2]))?;
        }
        for axis in 0..3 {
            for [u, v] in ROUND {
                let sides = [0, 1].each(|a| self.child(at, axis, [a, u, v]));
                self.across_face(axis, sides)?;
            }
            for half in 0..2 {
                let around = ROUND.each(|[u, v]| self.child(at, axis, [half, u, v]));
                self.around_edge(axis, around)?;
            }
        }
        Ok(())
    }

    fn across_face(&mut self, axis: usize, sides: [At; 2]) -> Result<(), Error> {
        if !sides.iter().any(At::is_split) {
            let side = usize::from(sides[1].fineness() > sides[0].fineness());
            let (at, length) = self.place(sides[side].cell, [(axis, side == 0)]);
            return self.visitor.face(&Face { axis, at, length, sides: sides.each(|at| at.leaf()) });
        }
        let touching = |side: usize, u: usize, v: usize| self.child(sides[side], axis, [1 - side, u, v]);
        let pieces = ROUND.each(|[u, v]| [touching(0, u, v), touching(1, u, v)]);
        // The edges in the face, along the next axis and along the axis after it.
        let along_u =
            [0, 1].each(|u| [touching(0, u, 0), touching(0, u, 1), touching(1, u, 1), touching(1, u, 0)]);
        let along_v =
            [0, 1].each(|v| [touching(0, 0, v), touching(1, 0, v), touching(1, 1, v), touching(0, 1, v)]);
        for piece in pieces {
            self.across_face(axis, piece)?;
        }
        for half in 0..2 {
            self.around_edge((axis + 1) % 3, along_u[half])?;
            self.around_edge((axis + 2) % 3, along_v[half])?;
        }
        Ok(())
    }

    fn around_edge(&mut self, axis: usize, around: [At; 4]) -> Result<(), Error> {
        if !around.iter().any(At::is_split) {
            let finest = (1..4)
                .fold(0, |best, k| if around[k].fineness() > around[best].fineness() { k } else { best });
            let [u, v] = ROUND[finest];
            let (at, length) =
                self.place(around[finest].cell, [((axis + 1) % 3, u == 0), ((axis + 2) % 3, v == 0)]);
            return self.visitor.edge(&Edge { axis, at, length, around: around.each(|at| at.leaf()) });
        }
        for half in 0..2 {
            let mut pieces = around;
            for (piece, [u, v]) in pieces.iter_mut().zip(ROUND) {
                *piece = self.child(*piece, axis, [half, 1 - u, 1 - v]);
            }
            self.around_edge(axis, pieces)?;
        }
        Ok(())
    }

    /// The lower corner of a cell, at its upper side on some axes, and its edge, both in finest cells.
    fn place<const N: usize>(&self, cell: Cell, upper: [(usize, bool); N]) -> ([u32; 3], u32) {
        let log = self.cells.depth - cell.level;
        let mut at = cell.at.each(|c| c << log);
        for (axis, is_upper) in upper {
            at[axis] += u32::from(is_upper) << log;
        }
        (at, 1 << log)
    }
}
