//! The octree of cells that the surface crosses, with coplanar cells merged: branch on need (Wilhelms and Van
//! Gelder 1992), shrunk from the bottom up.
//!
//! Eight cells of a node become one *super-cell* if the configurations of all existing cells are coplanar,
//! and lie in one plane. A node that cannot be merged keeps the nodes above it from merging. The
//! configuration of a super-cell follows from those of its cells: a missing cell would have the same side at
//! its corner as the other cells have at the middle of the node, because the surface does not pass between
//! the two points.

use super::blocks::Blocks;
use super::chunks;
use super::cubes::Around;
use super::key::{self, Key};
use super::masks::{bits, configuration};
use super::plane::{Plane, of_configuration};
use super::simple::Snap;
use crate::control::Job;
use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// A cell of the surface, 2^level dual cells long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// The place of its lowest dual cell: interleaved as in the keys of blocks, two levels further down.
    key: Key,
    /// The plane of all triangles in the cell.
    pub plane: Plane,
    /// The corners that lie inside, as bits.
    pub configuration: u8,
    pub level: u8,
}

impl Cell {
    /// The lowest corner of the cell. `bias` is the bias of the blocks.
    pub fn corner(&self, bias: i32) -> [i32; 3] {
        key::position(self.key, 4 * bias)
    }
}

/// The condition for merging cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Merge {
    /// The cells lie in one plane and have the same outer side.
    Sided,
    /// The cells lie in one plane, as in the published method.
    Plane,
}

impl Merge {
    fn fit(self, a: Plane, b: Plane) -> bool {
        match self {
            Merge::Sided => a == b,
            Merge::Plane => a.without_side() == b.without_side(),
        }
    }
}

/// The number of cell levels in a block.
const OF_BLOCK: u32 = 2;

/// Returns the cells of a surface in Morton order, merged as far as possible. O(dual cells of the surface).
///
/// # Errors
/// [`Error::OutOfMemory`] and [`Error::Cancelled`].
pub(super) fn cells(
    blocks: &Blocks,
    snap: Snap,
    merge: Merge,
    weight: usize,
    job: &Job<'_>,
    parallel: bool,
) -> Result<Vec<Cell>, Error> {
    let list = &blocks.list;
    let found = chunks::map(list.len(), weight, job, parallel, |range| {
        let mut found = Vec::new();
        for i in range {
            let corners = Around::of(list, i).corners();
            let mut of_block = [Cell { key: 0, plane: Plane::NONE, configuration: 0, level: 0 }; 64];
            let mut count = 0;
            for c in bits(list[i].mixed) {
                let configuration = configuration(&corners, c);
                let key = list[i].key << 6 | Key::from(c);
                let plane = of_configuration(configuration, snap).moved(key::position(key, 4 * blocks.bias));
                of_block[count] = Cell { key, plane, configuration: configuration as u8, level: 0 };
                count += 1;
            }
            shrink(&of_block[..count], 0, OF_BLOCK, merge, &mut found)?;
        }
        Ok(found)
    })?;
    let mut all = memory::with_capacity(found.iter().map(Vec::len).sum())?;
    found.iter().for_each(|part| all.extend_from_slice(part));
    drop(found);
    let mut cells = Vec::new();
    // Blocks lie on both sides of the middle of the key range.
    let levels = blocks.bias.ilog2() + 1 + OF_BLOCK;
    shrink(&all, OF_BLOCK, levels, merge, &mut cells)?;
    Ok(cells)
}

/// Appends the cells of a node of `level`, whose cells are already merged up to the level `from`. The
/// recursion is as deep as the number of levels between.
fn shrink(cells: &[Cell], from: u32, level: u32, merge: Merge, output: &mut Vec<Cell>) -> Result<(), Error> {
    if level == from || cells.len() == 1 && u32::from(cells[0].level) == level {
        output.try_reserve(cells.len())?;
        output.extend_from_slice(cells);
        return Ok(());
    }
    let start = output.len();
    let shift = 3 * (level - 1);
    let mut rest = cells;
    while let Some(first) = rest.first() {
        let child = first.key >> shift;
        let count = rest.partition_point(|cell| cell.key >> shift == child);
        let (cells, after) = rest.split_at(count);
        shrink(cells, from, level - 1, merge, output)?;
        rest = after;
    }
    if let Some(cell) = merged(&output[start..], level, merge) {
        output.truncate(start);
        output.push(cell);
    }
    Ok(())
}

/// Returns the super-cell of the cells in a node of this level, if they can be merged.
fn merged(cells: &[Cell], level: u32, merge: Merge) -> Option<Cell> {
    let first = cells.first()?;
    let fit = |cell: &Cell| u32::from(cell.level) + 1 == level && merge.fit(cell.plane, first.plane);
    if first.plane.is_none() || !cells.iter().all(fit) {
        return None;
    }
    let child = |cell: &Cell| (cell.key >> (3 * (level - 1)) & 7) as u8;
    // The middle of the node is the corner that is opposite to each cell's own corner.
    let middle = first.configuration >> (7 - child(first)) & 1;
    let mut configuration = if middle == 1 { 255 } else { 0 };
    for cell in cells {
        let own = 1 << child(cell);
        configuration = configuration & !own | cell.configuration & own;
    }
    let key = first.key >> (3 * level) << (3 * level);
    Some(Cell { key, plane: first.plane, configuration, level: level as u8 })
}
