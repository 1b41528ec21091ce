//! Rays along lines of sight.

use super::sight::SightLine;
use super::stage::Stage;
use super::window::Window;
use crate::error::Error;
use crate::lattice::Bounds;
use crate::memory;
use crate::octree::OctreeRef;
use crate::query::{Ray, TouchedCell};
use alloc::vec::Vec;

/// The columns and rows of samples in a block whose rays are cast together.
const BLOCK: [usize; 2] = [8, 4];

/// The lines of sight of a window and the cells that they meet, block by block.
pub struct Cast<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    stage: Stage<'t>,
    universe: Bounds,
    block: usize,
    rays: Vec<Ray>,
    sights: Vec<SightLine>,
    hits: [Option<TouchedCell>; BLOCK[0] * BLOCK[1]],
}

impl<'t, 'a> Cast<'t, 'a> {
    pub fn new(tree: &'t OctreeRef<'a>, stage: Stage<'t>) -> Cast<'t, 'a> {
        let (rays, sights) = (Vec::new(), Vec::new());
        Cast {
            tree,
            stage,
            universe: Bounds::of(tree.frame()),
            block: 0,
            rays,
            sights,
            hits: [None; BLOCK[0] * BLOCK[1]],
        }
    }

    /// Returns the cells that the lines of sight of the next block meet; `None` after the last block.
    pub fn next<'s>(
        &'s mut self,
        window: &Window<'_>,
    ) -> Result<Option<impl Iterator<Item = (&'s SightLine, TouchedCell)> + use<'s, 't, 'a>>, Error> {
        let across = window.width().div_ceil(BLOCK[0]);
        let (column, row) = (self.block % across * BLOCK[0], self.block / across * BLOCK[1]);
        if row >= window.height() {
            return Ok(None);
        }
        self.block += 1;
        self.stage.job.check()?;
        self.rays.clear();
        self.sights.clear();
        for y in row..(row + BLOCK[1]).min(window.height()) {
            for x in column..(column + BLOCK[0]).min(window.width()) {
                if let Some((sight, ray)) = SightLine::new(&self.stage, window, [x, y], &self.universe) {
                    memory::push(&mut self.rays, ray)?;
                    memory::push(&mut self.sights, sight)?;
                }
            }
        }
        let hits = &mut self.hits[..self.rays.len()];
        self.tree.touch_all(&self.rays, hits)?;
        Ok(Some(self.sights.iter().zip(&*hits).filter_map(|(sight, hit)| Some((sight, (*hit)?)))))
    }
}
