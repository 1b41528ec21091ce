//! Moves records on their lattice: symmetries, and offsets by whole cells.

use super::code::number_of;
use super::record::VoxelKind;
use super::records::{VoxelRecords, VoxelRecordsRef};
use super::symmetry::Symmetry;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, axes};
use crate::memory;
use crate::octree::Tag;
use alloc::vec::Vec;

/// A cell of the result of a record.
struct Piece {
    code: u64,
    level: u8,
    record: usize,
}

/// A box of finest cells: from `first` to before `end`.
struct Range {
    first: [i64; 3],
    end: [i64; 3],
}

impl VoxelRecordsRef<'_> {
    /// The records under a symmetry about the centre of their universe, followed by an offset by whole finest
    /// cells, on the same lattice. Exact. O(n · levels + m log m) for m records of the result.
    ///
    /// A record whose image is no cell becomes the largest cells that make up its image. Each of them has the
    /// record's kind and value. Parts that leave the universe are cut off. Space that enters the universe has
    /// no records. A refined voxel is dropped if its image is no cell of the universe.
    ///
    /// The result [proves](Self::proof) EMPTY only if the records do and the space around their universe is
    /// EMPTY. If inside or boundary voxels are cut off, the space around the result is unknown.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and the errors that `control` causes: its limit of bytes applies to the
    /// arrays.
    pub fn moved(
        &self,
        symmetry: Symmetry,
        offset: [i32; 3],
        control: &Control<'_>,
    ) -> Result<VoxelRecords, Error> {
        let turned = self.turned(symmetry, control)?;
        if offset == [0; 3] {
            return Ok(turned);
        }
        let from = turned.view();
        let depth = self.frame().depth();
        let universe = Range { first: [0; 3], end: [1 << depth; 3] };
        let mut pieces: Vec<Piece> = Vec::new();
        let mut is_cut = false;
        for record in 0..from.len() {
            control.check()?;
            let (cell, kind) = (from.cell_at(record), from.kind_at(record));
            let shift = depth - cell.level;
            let first = axes(|axis| (i64::from(cell.at[axis]) << shift) + i64::from(offset[axis]));
            let image = Range { first, end: first.each(|a| a + (1 << shift)) };
            let inside = image.common(&universe);
            let is_whole = (inside.first, inside.end) == (image.first, image.end);
            is_cut |= !is_whole && matches!(kind, VoxelKind::Inside | VoxelKind::Boundary);
            let is_cell = is_whole && first.iter().all(|a| a & ((1 << shift) - 1) == 0);
            if kind == VoxelKind::Refined && !is_cell {
                continue;
            }
            inside.cut(Cell::ROOT, depth, &mut |cell| {
                let code = number_of(cell, depth);
                memory::push(&mut pieces, Piece { code, level: cell.level, record })?;
                if pieces.len().is_multiple_of(4096) {
                    control.check()?;
                    let bytes = (pieces.len() * turned.bytes_each()) as u64;
                    if let Some(limit) = control.max_bytes.filter(|&limit| bytes > limit) {
                        return Err(Error::Limit { what: "bytes", limit });
                    }
                }
                Ok(())
            })?;
        }
        pieces.sort_unstable_by_key(|piece| (piece.code, piece.level));
        let is_empty_around = self.exterior() == Tag::Empty;
        let exterior = if is_empty_around && !is_cut { Tag::Empty } else { Tag::Partial };
        let mut proof = self.proof();
        proof.empty &= is_empty_around;
        let mut moved = VoxelRecords::empty(*self.frame(), exterior, proof, self.components());
        moved.boundary = self.boundary();
        moved.reserve(pieces.len())?;
        for Piece { code, level, record } in pieces {
            moved.codes.push(code);
            moved.levels.push(level);
            moved.kinds.push(from.kinds()[record]);
            moved.values.extend_from_slice(from.numbers_at(record));
        }
        Ok(moved)
    }
}

impl Range {
    fn common(&self, other: &Range) -> Range {
        Range {
            first: axes(|axis| self.first[axis].max(other.first[axis])),
            end: axes(|axis| self.end[axis].min(other.end[axis])),
        }
    }

    /// Calls `put` with the largest cells in `cell` that make up the part of the range there. The recursion
    /// is as deep as the lattice, at most 20 levels.
    fn cut(
        &self,
        cell: Cell,
        depth: u8,
        put: &mut impl FnMut(Cell) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let shift = depth - cell.level;
        let first = cell.at.each(|a| i64::from(a) << shift);
        let own = Range { first, end: first.each(|a| a + (1 << shift)) };
        let common = self.common(&own);
        if (0..3).any(|axis| common.first[axis] >= common.end[axis]) {
            return Ok(());
        }
        if (common.first, common.end) == (own.first, own.end) {
            return put(cell);
        }
        (0..8).try_for_each(|octant| self.cut(cell.child(octant), depth, put))
    }
}
