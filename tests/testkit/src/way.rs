//! Descents from the universe through PARTIAL cells.

use super::Random;
use leafless::{Cell, Verdict, Worker};

/// A worker at one of its PARTIAL cells.
pub struct Way<W: Worker> {
    pub worker: W,
    pub cell: Cell,
    pub part: W::Part,
}

impl<W: Worker> Way<W> {
    /// Starts at the universe. Returns `None` if the universe is decided.
    pub fn new(mut worker: W) -> Option<Way<W>> {
        match worker.root().unwrap() {
            Verdict::Partial(part) => Some(Way { worker, cell: Cell::ROOT, part }),
            _ => None,
        }
    }

    /// Returns the PARTIAL children in Morton order. A finest cell has none.
    pub fn children(&mut self) -> Vec<(Cell, W::Part)> {
        if self.cell.level == self.worker.frame().depth() {
            return Vec::new();
        }
        let children = self.worker.split(self.cell, &self.part).unwrap();
        let partial = (0..8).zip(children).filter_map(|(octant, verdict)| match verdict {
            Verdict::Partial(part) => Some((self.cell.child(octant), part)),
            _ => None,
        });
        partial.collect()
    }

    /// Descends to a random PARTIAL child. Returns `false` if there is none.
    pub fn descend(&mut self, random: &mut Random) -> bool {
        let mut children = self.children();
        if children.is_empty() {
            return false;
        }
        (self.cell, self.part) = children.swap_remove(random.below(children.len() as u64) as usize);
        true
    }

    /// Descends to a child that is PARTIAL in the complement. Panics if the child is decided here.
    #[track_caller]
    pub fn follow(&mut self, cell: Cell) {
        let child = self.children().into_iter().find(|(child, _)| *child == cell);
        (self.cell, self.part) = child.unwrap_or_else(|| panic!("the complement is decided: {cell:?}"));
    }
}
