//! The cells of a contour: the unsplit cells, of several sizes.

use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use alloc::vec::Vec;

/// The verdict on a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Empty,
    Full,
    Open,
}

/// A cell that is not split.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leaf {
    pub(super) cell: Cell,
    pub(super) kind: Kind,
    /// The point where the planes of the surface in the cell meet, in unit coordinates, if the surface was
    /// examined.
    pub(super) vertex: Option<[f64; 3]>,
    /// Whether the cell was compared with a mesh.
    pub(super) is_checked: bool,
    /// Whether the cell was split later.
    pub(super) is_gone: bool,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Slot {
    Leaf(u32),
    Branch(u32),
}

/// The number that stands for the space around the universe.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// The cells of the universe.
pub(super) struct Cells {
    pub(super) root: Slot,
    pub(super) nodes: Vec<[Slot; 8]>,
    pub(super) leaves: Vec<Leaf>,
    /// The level of the finest cells, in which corners are measured.
    pub(super) depth: u8,
}

impl Cells {
    /// Creates the universe as one cell.
    pub(super) fn new(kind: Kind, depth: u8) -> Result<Cells, Error> {
        let mut cells = Cells { root: Slot::Leaf(0), nodes: Vec::new(), leaves: Vec::new(), depth };
        cells.add(Cell::ROOT, kind)?;
        Ok(cells)
    }

    /// The number of leaves that the surface passes through.
    pub(super) fn open(&self) -> u64 {
        self.leaves.iter().filter(|leaf| leaf.kind == Kind::Open && !leaf.is_gone).count() as u64
    }

    fn add(&mut self, cell: Cell, kind: Kind) -> Result<u32, Error> {
        memory::push(&mut self.leaves, Leaf { cell, kind, vertex: None, is_checked: false, is_gone: false })?;
        Ok(self.leaves.len() as u32 - 1)
    }

    /// Splits a leaf into eight. Returns the number of the first child.
    pub(super) fn split(&mut self, leaf: u32, kinds: [Kind; 8]) -> Result<u32, Error> {
        let cell = self.leaves[leaf as usize].cell;
        let first = self.leaves.len() as u32;
        self.leaves.try_reserve(8)?;
        self.nodes.try_reserve(1)?;
        for (octant, kind) in (0..8u8).zip(kinds) {
            self.add(cell.child(octant), kind)?;
        }
        let node = self.nodes.len() as u32;
        self.nodes.push(core::array::from_fn(|octant| Slot::Leaf(first + octant as u32)));
        self.leaves[leaf as usize].is_gone = true;
        *self.slot(cell) = Slot::Branch(node);
        Ok(first)
    }

    /// The slot of a cell.
    fn slot(&mut self, cell: Cell) -> &mut Slot {
        let mut place: Option<(usize, usize)> = None;
        for level in 1..=cell.level {
            let slot = match place {
                None => self.root,
                Some((node, octant)) => self.nodes[node][octant],
            };
            let Slot::Branch(node) = slot else { break };
            place = Some((node as usize, usize::from(cell.ancestor(level).octant())));
        }
        match place {
            None => &mut self.root,
            Some((node, octant)) => &mut self.nodes[node][octant],
        }
    }
}
