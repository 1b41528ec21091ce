//! Cells whose vertices stay, because the mesh was too far from the boundary there. The vertices of the
//! neighbouring cells stay, too.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, axes};
use crate::memory;
use alloc::vec::Vec;

/// Cells of any levels, in ascending order.
#[derive(Default)]
pub(super) struct Held {
    cells: Vec<(u8, [u32; 3])>,
}

impl Held {
    /// Adds cells.
    pub(super) fn add(&mut self, cells: &[Cell]) -> Result<(), Error> {
        self.cells.try_reserve(cells.len())?;
        self.cells.extend(cells.iter().map(|cell| (cell.level, cell.at)));
        self.cells.sort_unstable();
        self.cells.dedup();
        Ok(())
    }

    /// Returns for each point (unit coordinates) whether it lies in a held cell or in one of the 26 cells of
    /// its size around it. (Otherwise triangles that reach into the cell from there would still change.)
    pub(super) fn chosen(&self, points: impl ExactSizeIterator<Item = [f64; 3]>) -> Result<Vec<bool>, Error> {
        let mut levels = [false; 32];
        self.cells.iter().for_each(|cell| levels[usize::from(cell.0 & 31)] = true);
        memory::collected(points.map(|point| {
            (0u8..32).filter(|&level| levels[usize::from(level)]).any(|level| self.holds(point, level))
        }))
    }

    fn holds(&self, point: [f64; 3], level: u8) -> bool {
        let side = f64::from(1u32 << level);
        let place = point.each(|c| (c * side).max(0.0) as u32);
        (0..27u32).any(|k| {
            let at = axes(|axis| (place[axis] + [k, k / 3, k / 9][axis] % 3).wrapping_sub(1));
            self.cells.binary_search(&(level, at)).is_ok()
        })
    }
}
