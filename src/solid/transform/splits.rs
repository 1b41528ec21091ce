//! Sources of the children of cells of the solid's own frame: its worker, immediately, or batches of splits.

use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::solid::{Ask, Verdict, Worker};
use alloc::vec::Vec;
use hashbrown::HashMap;

/// Splits cells of the solid's own frame.
pub(super) trait Splits<P> {
    /// The children of a cell; `None` if they are not known yet.
    fn children(&mut self, cell: Cell, part: &P) -> Result<Option<[Verdict<P>; 8]>, Error>;

    /// Returns whether a cell must not be split because it is a function of surfaces: some of these may lie
    /// in faces of its children.
    fn is_function(&mut self, _: Cell, _: &P) -> Result<bool, Error> {
        Ok(false)
    }
}

/// Splits immediately: all cells, or (`false`) only cells that are no functions of surfaces.
pub(super) struct AtOnce<'w, W>(pub(super) &'w mut W, pub(super) bool);

impl<W: Worker> Splits<W::Part> for AtOnce<'_, W> {
    #[inline(always)]
    fn children(&mut self, cell: Cell, part: &W::Part) -> Result<Option<[Verdict<W::Part>; 8]>, Error> {
        self.0.split(cell, part).map(Some)
    }

    #[inline(always)]
    fn is_function(&mut self, cell: Cell, part: &W::Part) -> Result<bool, Error> {
        Ok(!self.1 && self.0.surfaces(cell, part)?.is_some())
    }
}

/// Splits that are known, and splits that are still wanted.
pub(super) struct Gathered<P> {
    known: HashMap<Cell, [Verdict<P>; 8]>,
    wanted: Vec<(Cell, P)>,
}

impl<P: Clone> Gathered<P> {
    pub(super) fn new() -> Gathered<P> {
        Gathered { known: HashMap::new(), wanted: Vec::new() }
    }

    /// Returns the wanted cells, each once, and clears the list.
    pub(super) fn take_wanted(&mut self) -> Vec<(Cell, P)> {
        let mut wanted = core::mem::take(&mut self.wanted);
        wanted.sort_unstable_by_key(|(cell, _)| (cell.level, cell.at));
        wanted.dedup_by_key(|(cell, _)| *cell);
        wanted
    }

    /// Stores the answers, in the order of the cells.
    pub(super) fn learn(&mut self, cells: &[(Cell, P)], answers: Vec<[Verdict<P>; 8]>) -> Result<(), Error> {
        self.known.try_reserve(answers.len())?;
        self.known.extend(cells.iter().map(|(cell, _)| *cell).zip(answers));
        Ok(())
    }
}

impl<P: Clone> Splits<P> for Gathered<P> {
    fn children(&mut self, cell: Cell, part: &P) -> Result<Option<[Verdict<P>; 8]>, Error> {
        let known = self.known.get(&cell);
        if known.is_none() {
            memory::push(&mut self.wanted, (cell, part.clone()))?;
        }
        Ok(known.cloned())
    }
}
