//! Cuts: the surfaces that a PARTIAL cell keeps.
//!
//! An octree with cuts is an *extended octree* (Carlbom, Chakravarty and Vanderschel 1985, *polytrees*;
//! Brunet and Navazo, *Solid representation and operation using extended octrees*, ACM Transactions on
//! Graphics 9 (2), 1990), here with curved surfaces and exact signs. The planes of the tree are the same as
//! without the cuts.
//!
//! - `cell_slab`: slabs that were made for one cell, in whole numbers.
//! - `figure`: on which side of a surface points lie, by arithmetic in doubles.
//! - `ids`: the numbers of surfaces.
//! - `moments`: the moments of the solid.
//! - `read`: what cuts say, for others.
//! - `record`: one byte for each PARTIAL cell: a truth table of up to three surfaces, nothing, or a split
//!   into eight records.
//! - `surfaces`: the table of surfaces, in numbers that are exact.
//! - `writer`: how cuts are gathered and put in order.

mod cell_slab;
mod figure;
mod ids;
mod moments;
mod read;
mod record;
mod surfaces;
mod writer;

pub(crate) use cell_slab::{CellSlab, Steps};
pub(crate) use figure::{Division, Figure, FigureLine};
pub(crate) use ids::{CellIds, Ids, OwnedIds, bytes, width};
pub(crate) use moments::StoredMoments;
pub use read::{CellFunction, StoredSurface};
pub(crate) use record::Head;
pub use surfaces::SurfaceKind;
pub(crate) use surfaces::{
    CellSlabGroup, MOST_MAPS, MOST_TERMS, Origin, Placement, SurfaceRecord, SurfaceWriter, Surfaces,
    SurfacesRef, Universe,
};
pub(crate) use writer::{Cut, CutWriter, Names};

use super::word::Planes;
use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;
use bytemuck::{Pod, Zeroable};
use core::ops::Range;

/// Number of records that share a [`Block`].
pub(crate) const BLOCK: usize = 32;

/// The counts before the records of a block.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Block {
    /// Number of ids of surfaces.
    pub ids: u32,
    /// Number of records that are splits.
    pub splits: u32,
}

/// The cuts of an octree in memory.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cuts {
    /// One byte for each record. The first records belong to the PARTIAL cells of the planes, in their order.
    /// Groups of eight follow, one for each split, in the order of the splits.
    pub heads: Vec<u8>,
    /// Surfaces of the records, one after the other.
    pub ids: OwnedIds,
    pub blocks: Vec<Block>,
    /// For each element and brick, the number of records before its own. One more entry is the number of
    /// records of the planes.
    pub first: Vec<u32>,
    pub surfaces: Surfaces,
    /// Moments of the solid, if they were known. (A change of the solid makes new cuts.)
    pub moments: Option<StoredMoments>,
}

/// The cuts of an octree, borrowed. They are equal if they describe all cells equally.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CutsRef<'a> {
    pub heads: &'a [u8],
    pub ids: Ids<'a>,
    pub blocks: &'a [Block],
    pub first: &'a [u32],
    pub surfaces: SurfacesRef<'a>,
    pub moments: Option<&'a StoredMoments>,
}

impl PartialEq for CutsRef<'_> {
    fn eq(&self, other: &Self) -> bool {
        (self.heads, self.ids, self.first) == (other.heads, other.ids, other.first)
            && self.blocks == other.blocks
            && self.surfaces == other.surfaces
    }
}

impl Cuts {
    pub(crate) fn view(&self) -> CutsRef<'_> {
        CutsRef {
            heads: &self.heads,
            ids: self.ids.view(),
            blocks: &self.blocks,
            first: &self.first,
            surfaces: self.surfaces.view(),
            moments: self.moments.as_ref(),
        }
    }
}

impl CutsRef<'_> {
    pub(crate) fn copied(&self) -> Result<Cuts, Error> {
        Ok(Cuts {
            heads: memory::copied(self.heads)?,
            ids: self.ids.copied()?,
            blocks: memory::copied(self.blocks)?,
            first: memory::copied(self.first)?,
            surfaces: Surfaces {
                records: memory::copied(self.surfaces.records)?,
                doubles: memory::copied(self.surfaces.doubles)?,
                placements: memory::copied(self.surfaces.placements)?,
                origins: memory::copied(self.surfaces.origins)?,
                slabs: memory::copied(self.surfaces.slabs)?,
                groups: memory::copied(self.surfaces.groups)?,
                universe: self.surfaces.universe,
            },
            moments: self.moments.copied(),
        })
    }
}

/// The counts of the surfaces that PARTIAL cells of an extended octree keep.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CutCounts {
    /// Number of cells in which the solid is a known function of surfaces. A part of a cell of the planes
    /// counts as a cell.
    pub cells: u64,
    /// Number of cells about which nothing is known.
    pub given_up: u64,
    /// Number of PARTIAL cells that are split without a node, because all of their parts are PARTIAL.
    pub splits: u64,
    /// Number of surfaces.
    pub surfaces: u64,
    /// Bytes of all cuts in memory.
    pub bytes: u64,
}

/// The content of a PARTIAL cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CellCut {
    /// Nothing is known.
    None,
    /// The solid is a function of the signs of up to three surfaces. Bit m of the table is its value where
    /// exactly the surfaces whose bits are set in m are positive.
    Table { ids: CellIds, table: u8 },
    /// The cell is split: the first of the eight records of its children.
    Split(usize),
}

impl CutsRef<'_> {
    /// Returns the number of records of the planes' cells.
    fn of_planes(&self) -> usize {
        self.first.last().map_or(1, |&count| count as usize)
    }

    /// The record of the universe, if the universe is one PARTIAL cell.
    pub(crate) const ROOT: usize = 0;

    /// Returns the record of the PARTIAL cell `c` of an element, whose cells are `planes`. For an octant that
    /// is PARTIAL as a whole, it is the octant's record. An arbitrary number where the cuts are damaged.
    pub(crate) fn record(&self, element: usize, planes: Planes, c: u32) -> usize {
        let first = self.first.get(element).map_or(usize::MAX, |&first| first as usize);
        first.saturating_add(rank(planes, c) as usize)
    }

    /// Returns the content of a record; `None` where the cuts are damaged.
    pub(crate) fn at(&self, record: usize) -> CellCut {
        self.checked(record).unwrap_or(CellCut::None)
    }

    /// Returns the numbers of ids, and of splits, in the records before a record.
    fn before(&self, record: usize) -> Option<(usize, usize)> {
        let before = self.heads.get(record - record % BLOCK..record)?;
        let block = self.blocks.get(record / BLOCK)?;
        let splits = before.iter().filter(|&&head| Head(head).is_split()).count();
        let ids = before.iter().map(|&head| Head(head).surfaces()).sum::<usize>();
        Some((block.ids as usize + ids, block.splits as usize + splits))
    }

    /// Returns the records of the parts of all splits in a run of records.
    fn parts(&self, run: Range<usize>) -> Range<usize> {
        let splits =
            self.heads.get(run.clone()).unwrap_or(&[]).iter().filter(|&&head| Head(head).is_split()).count();
        let before = self.before(run.start).map_or(0, |(_, splits)| splits);
        let first = self.of_planes() + 8 * before;
        // (Children come after their parents, so that every path ends.)
        if splits > 0 && first >= run.end { first..first + 8 * splits } else { 0..0 }
    }

    fn checked(&self, record: usize) -> Option<CellCut> {
        let head = Head(*self.heads.get(record)?);
        let before = &self.heads[record - record % BLOCK..record];
        let block = self.blocks.get(record / BLOCK)?;
        Some(if head.is_split() {
            let splits = before.iter().filter(|&&head| Head(head).is_split()).count();
            let first = self.of_planes() + 8 * (block.splits as usize + splits);
            // (Children come after their parent, so that every path ends.)
            if first <= record || first + 8 > self.heads.len() {
                return None;
            }
            CellCut::Split(first)
        } else if head.surfaces() == 0 {
            CellCut::None
        } else {
            let ids = before.iter().map(|&head| Head(head).surfaces()).sum::<usize>();
            let ids = CellIds::read(self.ids, block.ids as usize + ids, head.surfaces())?;
            CellCut::Table { ids, table: head.0 }
        })
    }
}

/// Returns the number of records of an element whose cells are `planes`.
fn records(planes: Planes) -> u32 {
    let [.., whole] = planes.octants();
    planes.partial().count_ones() - 7 * whole.count_ones()
}

/// Returns the number of records of an element's cells before cell `c`.
fn rank(planes: Planes, c: u32) -> u32 {
    let partial = planes.partial();
    let [.., whole] = planes.octants();
    // An octant that is PARTIAL as a whole has one record.
    let eights = whole * 0xFF;
    let octant = c & !7;
    let below = |bits: u64, c: u32| (bits & ((1u64 << c) - 1)).count_ones();
    let inside = if whole >> octant & 1 != 0 { octant } else { c };
    below(whole, octant) + below(partial & !eights, inside)
}
