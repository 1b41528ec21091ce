//! The statistics of shards that are not joined.

use super::octree::Octree;
use super::stats::Statistics;
use crate::error::Error;
use crate::lattice::Cell;
use alloc::vec::Vec;

impl Octree {
    /// Returns the statistics of the octree that [`join`](crate::op::join) would make of this tree, a
    /// [top](crate::Shard::Top), and of shards of cells of its level, each with its statistics. Nothing is
    /// joined. An open cell without a shard is PARTIAL. O(cells × depth).
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] if the cells do not ascend in Morton order on one level, if a cell is not open in
    /// the top, or if it is not split in its shard: the content of such a shard belongs into the top, which
    /// [`join`](crate::op::join) puts there.
    pub fn statistics_with(&self, shards: &[(Cell, Statistics)]) -> Result<Statistics, Error> {
        let mut counts = Vec::from(self.counts());
        let wrong = |problem| Error::Argument { name: "shards", problem };
        let mut before: Option<Cell> = None;
        for (cell, own) in shards {
            let (cell, levels) = (*cell, own.levels());
            let depth = self.frame().depth();
            if cell.level >= depth || before.is_some_and(|before| before.level != cell.level) {
                return Err(wrong("must be of cells of one level above the finest"));
            }
            if before.is_some_and(|before| before.morton() >= cell.morton()) {
                return Err(wrong("must be in ascending Morton order of their cells"));
            }
            let open =
                self.view().open_above(cell).ok_or(wrong("must be of cells that the top leaves open"))?;
            if levels.len() != counts.len() || levels[usize::from(cell.level)].nodes != 1 {
                return Err(wrong("must be split on this frame: others belong into the top"));
            }
            // PARTIAL cells above it become nodes, except those that became nodes with the previous shard.
            let is_new = |level| before.is_none_or(|before| before.ancestor(level) != cell.ancestor(level));
            for level in (open..=cell.level).filter(|&level| is_new(level)) {
                // (A mapped level table may contain anything.)
                let at = usize::from(level);
                counts[at].nodes = counts[at].nodes.saturating_add(1);
                counts[at].partial = counts[at].partial.saturating_sub(1);
                if level < cell.level {
                    counts[at + 1].partial = counts[at + 1].partial.saturating_add(8);
                }
            }
            for (sum, own) in counts.iter_mut().zip(levels).skip(usize::from(cell.level) + 1) {
                sum.nodes = sum.nodes.saturating_add(own.nodes);
                sum.full = sum.full.saturating_add(own.full);
                sum.partial = sum.partial.saturating_add(own.partial);
            }
            before = Some(cell);
        }
        Ok(Statistics::new(self.frame(), &counts))
    }
}
