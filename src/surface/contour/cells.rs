//! The cells of a contour: those that are not split any further, of several sizes.

use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use alloc::vec::Vec;

/// What is known of a cell.
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
    /// Where the planes of the surface in it meet, in unit coordinates, if the surface was looked at.
    pub(super) vertex: Option<[f64; 3]>,
    /// Whether it was compared with a mesh.
    pub(super) is_checked: bool,
    /// Whether it was split later on.
    pub(super) is_gone: bool,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Slot {
    Leaf(u32),
    Branch(u32),
}

/// The number of what lies around the universe.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// The cells of the universe.
pub(super) struct Cells {
    pub(super) root: Slot,
    pub(super) nodes: Vec<[Slot; 8]>,
    pub(super) leaves: Vec<Leaf>,
    /// Corners of cells are told in cells of this level.
    pub(super) depth: u8,
}

impl Cells {
    /// The universe as one cell.
    pub(super) fn new(kind: Kind, depth: u8) -> Result<Cells, Error> {
        let mut cells = Cells { root: Slot::Leaf(0), nodes: Vec::new(), leaves: Vec::new(), depth };
        cells.add(Cell::ROOT, kind)?;
        Ok(cells)
    }

    /// How many leaves the surface passes through.
    pub(super) fn open(&self) -> u64 {
        self.leaves.iter().filter(|leaf| leaf.kind == Kind::Open && !leaf.is_gone).count() as u64
    }

    fn add(&mut self, cell: Cell, kind: Kind) -> Result<u32, Error> {
        memory::push(&mut self.leaves, Leaf { cell, kind, vertex: None, is_checked: false, is_gone: false })?;
        Ok(self.leaves.len() as u32 - 1)
    }

    /// Splits a leaf into eight. The number of the first of them.
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

    /// Where a cell stands.
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
