//! A cache of the cells that neighbouring lines of sight meet, so that each is split once.

use super::place_cache::Place;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::solid::{Verdict, Worker};
use crate::walk::split_one;
use hashbrown::HashMap;

/// A worker and a cache of the parts of all visited cells. When the cache is full, everything in it is
/// dropped.
pub struct Kept<W: Worker> {
    worker: W,
    root: Verdict<W::Part>,
    /// The height of the scratch memory before any split.
    mark: usize,
    /// The verdicts of the solid on the children of cells.
    splits: HashMap<Place, [Verdict<W::Part>; 8]>,
}

/// The greatest number of cells whose children are kept.
const MOST: usize = 1 << 15;

/// The bytes of scratch memory after which everything is dropped.
const MOST_BYTES: usize = 1 << 25;

impl<W: Worker> Kept<W> {
    /// Evaluates the universe.
    pub fn new(mut worker: W) -> Result<Kept<W>, Error> {
        let root = worker.root()?;
        let mark = worker.mark();
        Ok(Kept { worker, root, mark, splits: HashMap::new() })
    }

    /// Returns the verdict of the solid on a cell. If the cell lies in a cell that the solid does not split,
    /// returns the verdict on that cell.
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

    /// The deepest ancestor with a known verdict, or the cell itself.
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

    /// Evaluates a question about a PARTIAL cell, whose verdict must have been requested last.
    pub fn ask<R>(&mut self, question: impl FnOnce(&mut W) -> Result<R, Error>) -> Result<R, Error> {
        let mark = self.worker.mark();
        let answer = question(&mut self.worker);
        self.worker.release(mark);
        answer
    }
}
