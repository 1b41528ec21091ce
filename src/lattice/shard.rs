//! Which cells of a frame a tree is made for, where one machine does not make all of it.

use super::Cell;
use crate::error::Error;

/// The cells that a *shard* of an octree knows. Of all others it knows nothing: they are PARTIAL.
///
/// A tree is cut at a level into its top and into one shard for each cell of that level that the top leaves
/// open ([`OctreeRef::open_cells`](crate::OctreeRef::open_cells)). Every shard is an octree on the frame of
/// the whole, and true of the whole solid: it only knows less of it. [`join`](crate::op::join) puts shards
/// together again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shard {
    /// The cells down to a level. What would be split there stays PARTIAL.
    Top {
        /// 0 to the depth of the frame.
        level: u8,
    },
    /// The cells in this cell, and those around it.
    Below(Cell),
}

impl Shard {
    /// Refuses what a frame of this depth does not have.
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

    /// The level at which cells are split no more, of a frame of this depth.
    pub(crate) fn last(&self, depth: u8) -> u8 {
        match *self {
            Shard::Top { level } => level,
            Shard::Below(_) => depth,
        }
    }

    /// Whether nothing is known in a cell.
    pub(crate) fn is_without(&self, cell: Cell) -> bool {
        match *self {
            Shard::Top { .. } => false,
            Shard::Below(own) => !own.is_in(cell) && !cell.is_in(own),
        }
    }

    /// Whether all cells in a cell are known as they are in the whole.
    pub(crate) fn has_all_in(&self, cell: Cell) -> bool {
        match *self {
            Shard::Top { .. } => false,
            Shard::Below(own) => cell.is_in(own),
        }
    }
}
