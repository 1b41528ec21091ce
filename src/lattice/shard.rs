//! The cells that one shard of a tree covers, where several machines build the tree.

use super::Cell;
use crate::error::Error;

/// The cells that a *shard* of an octree covers. All other cells are unknown to the shard, and PARTIAL.
///
/// A tree is cut at a level into its top, and into one shard for each cell of that level that the top leaves
/// open ([`OctreeRef::open_cells`](crate::OctreeRef::open_cells)). Every shard is an octree on the frame of
/// the whole, and is valid for the whole solid, but with less detail. [`join`](crate::op::join) puts shards
/// together again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shard {
    /// The cells down to a level. Cells that would be split there stay PARTIAL.
    Top {
        /// 0 to the depth of the frame.
        level: u8,
    },
    /// The cells in this cell, and those around it.
    Below(Cell),
}

impl Shard {
    /// Rejects a shard that a frame of this depth does not have.
    ///
    /// # Errors
    /// [`Error::Argument`].
    pub(crate) fn check(&self, depth: u8) -> Result<(), Error> {
        let problem = match *self {
            Shard::Top { level } if level > depth => "has a level below the depth of the frame",
            Shard::Below(cell) if cell.level > depth => "has a cell below the depth of the frame",
            Shard::Below(cell) if cell.at.iter().any(|&a| a >> cell.level != 0) => {
                "has a cell outside of the universe"
            }
            _ => return Ok(()),
        };
        Err(Error::Argument { name: "shard", problem })
    }

    /// The level at which cells are no longer split, on a frame of this depth.
    pub(crate) fn last(&self, depth: u8) -> u8 {
        match *self {
            Shard::Top { level } => level,
            Shard::Below(_) => depth,
        }
    }

    /// Returns whether nothing is known in a cell.
    pub(crate) fn is_without(&self, cell: Cell) -> bool {
        match *self {
            Shard::Top { .. } => false,
            Shard::Below(own) => !own.is_in(cell) && !cell.is_in(own),
        }
    }

    /// Returns whether all cells in a cell are known as in the whole tree.
    pub(crate) fn has_all_in(&self, cell: Cell) -> bool {
        match *self {
            Shard::Top { .. } => false,
            Shard::Below(own) => cell.is_in(own),
        }
    }
}
