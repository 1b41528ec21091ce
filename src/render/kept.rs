//! The cells that lines of sight next to each other meet, each of which is split once.

use super::place_cache::Place;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::solid::{Verdict, Worker};
use crate::walk::split_one;
use hashbrown::HashMap;

/// A worker, and the parts of all cells that it was asked for. A cache: when there are too many it forgets
/// all of them.
pub struct Kept<W: Worker> {
    worker: W,
    root: Verdict<W::Part>,
    /// Height of the scratch memory before any split.
    mark: usize,
    /// What the solid says of the children of cells.
    splits: HashMap<Place, [Verdict<W::Part>; 8]>,
}

/// Most cells whose children are kept.
const MOST: usize = 1 << 15;

/// Bytes of scratch memory after which all is forgotten.
const MOST_BYTES: usize = 1 << 25;

impl<W: Worker> Kept<W> {
    /// Asks the solid for the universe.
    pub fn new(mut worker: W) -> Result<Kept<W>, Error> {
        let root = worker.root()?;
        let mark = worker.mark();
        Ok(Kept { worker, root, mark, splits: HashMap::new() })
    }

    /// What the solid says of a cell; of one in a cell that it does not split, what it says of that.
    pub fn verdict(&mut self, cell: Cell, control: &Control<'_>) -> Result<Verdict<W::Part>, Error> {
        let (mut level, mut known) = self.nearest(cell);
        if level < cell.level && self.is_full() {
            self.splits.clear();
            self.worker.release(self.mark);
            (level, known) = (0, self.root.clone());
        }
        while level < cell.level {
            let Verdict::Partial(part) = &known else { break };
            let ancestor = cell.ancestor(level);
            let split = split_one(&mut self.worker, ancestor, part, control)?;
            level += 1;
            known = split[cell.ancestor(level).octant() as usize].clone();
            self.splits.try_reserve(1)?;
            self.splits.insert(ancestor.into(), split);
        }
        Ok(known)
    }

    /// The deepest ancestor of which something is known, or the cell itself.
    fn nearest(&self, cell: Cell) -> (u8, Verdict<W::Part>) {
        for level in (1..=cell.level).rev() {
            if let Some(split) = self.splits.get(&Place::from(cell.ancestor(level - 1))) {
                return (level, split[cell.ancestor(level).octant() as usize].clone());
            }
        }
        (0, self.root.clone())
    }

    fn is_full(&self) -> bool {
        self.splits.len() >= MOST || self.worker.scratch_bytes() >= MOST_BYTES
    }

    /// Asks about a PARTIAL cell whose verdict was asked for last.
    pub fn ask<R>(&mut self, question: impl FnOnce(&mut W) -> Result<R, Error>) -> Result<R, Error> {
        let mark = self.worker.mark();
        let answer = question(&mut self.worker);
        self.worker.release(mark);
        answer
    }
}
