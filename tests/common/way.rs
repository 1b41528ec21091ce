//! Ways from the universe down through cells that are PARTIAL.

use super::Random;
use leafless::{Cell, Verdict, Worker};

/// A worker in one of its PARTIAL cells.
pub struct Way<W: Worker> {
    pub worker: W,
    pub cell: Cell,
    pub part: W::Part,
}

impl<W: Worker> Way<W> {
    /// At the universe; `None` if that is decided.
    pub fn new(mut worker: W) -> Option<Way<W>> {
        match worker.root().unwrap() {
            Verdict::Partial(part) => Some(Way { worker, cell: Cell::ROOT, part }),
            _ => None,
        }
    }

    /// The PARTIAL children, in Morton order; none of a finest cell.
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

    /// On to a random PARTIAL child; `false` if there is none.
    pub fn descend(&mut self, random: &mut Random) -> bool {
        let mut children = self.children();
        if children.is_empty() {
            return false;
        }
        (self.cell, self.part) = children.swap_remove(random.below(children.len() as u64) as usize);
        true
    }

    /// On to a child, which the complement says is PARTIAL.
    #[track_caller]
    pub fn follow(&mut self, cell: Cell) {
        let child = self.children().into_iter().find(|(child, _)| *child == cell);
        (self.cell, self.part) = child.unwrap_or_else(|| panic!("the complement is decided: {cell:?}"));
    }
}
