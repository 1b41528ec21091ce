//! Octrees whose PARTIAL cells keep surfaces: their counts, and their invariants.

use super::cuts::{
    BLOCK, Block, CellCut, CellFunction, CellIds, CutCounts, CutsRef, Head, StoredSurface, SurfacesRef,
};
use super::links::Step;
use super::tag::Tag;
use super::view::{OctreeRef, starts_half_way};
use super::word::Planes;
use crate::error::{Damage, Error};
use crate::lattice::Each;
use crate::lattice::{Cell, VolumeMoments};
use crate::memory;
use alloc::vec::Vec;

/// The place of a PARTIAL cell below the universe among the planes: its element, the planes of the element,
/// and the cell's number there.
type PartialCell = (usize, Planes, u32);

impl OctreeRef<'_> {
    /// Returns the counts of the surfaces that PARTIAL cells keep; `None` if they keep none. O(records).
    pub fn cuts(&self) -> Option<CutCounts> {
        let cuts = self.cuts.as_ref()?;
        let count = |head: Head| cuts.heads.iter().filter(|&&own| own == head.0).count() as u64;
        let (given_up, splits) = (count(Head::NONE), count(Head::SPLIT));
        let surfaces = &cuts.surfaces;
        let bytes = size_of_val(cuts.heads)
            + size_of_val(cuts.ids.bytes)
            + size_of_val(cuts.blocks)
            + size_of_val(cuts.first)
            + surfaces.bytes();
        Some(CutCounts {
            cells: cuts.heads.len() as u64 - given_up - splits,
            given_up,
            splits,
            surfaces: surfaces.len() as u64,
            bytes: bytes as u64,
        })
    }

    /// Returns the volume and the moments of the solid, if the solid provided them when the tree was made.
    /// They are exact up to rounding, and valid as far as the cells are proven.
    pub fn moments(&self) -> Option<VolumeMoments> {
        self.cuts.as_ref()?.moments?.moments()
    }

    /// Returns the same tree without cuts, that is, with its planes only.
    #[must_use]
    pub fn without_cuts(&self) -> Self {
        OctreeRef { cuts: None, ..*self }
    }

    /// Checks the cuts as [`check_cuts`](Self::check_cuts) does, unless they are known to be sound: O(1) for
    /// trees that this library made in memory. The check also excludes parts that several cells share, which
    /// would be visited once for each path to them.
    pub(crate) fn ensure_cuts(&self) -> Result<(), Error> {
        if self.is_linked { Ok(()) } else { self.check_cuts() }
    }

    /// Checks all invariants of cuts: a record for each PARTIAL cell, groups for splits down to the finest
    /// cells at most, prefix counts, tables whose surfaces exist and matter, and no unused surfaces. O(n).
    pub(crate) fn check_cuts(&self) -> Result<(), Error> {
        let Some(cuts) = &self.cuts else { return Ok(()) };
        let mut levels = self.levels_of_records(cuts)?;
        cuts.surfaces.check_groups()?;
        // Records, and the counts before them.
        let (mut ids, mut splits, mut known) = (0, 0, Known::new(&cuts.surfaces)?);
        for (record, &head) in cuts.heads.iter().enumerate() {
            if record % BLOCK == 0 {
                let block = Block { ids: ids as u32, splits };
                if cuts.blocks.get(record / BLOCK) != Some(&block) {
                    return Err(Damage::CutBlock { block: (record / BLOCK) as u64 }.into());
                }
            }
            let wrong = Damage::CutRecord { record: record as u64 };
            let head = Head(head);
            let Some(&level) = levels.get(record).filter(|_| head.is_valid()) else {
                return Err(wrong.into());
            };
            if head.is_split() {
                if level >= self.frame.depth() || levels.len() + 8 > cuts.heads.len() {
                    return Err(wrong.into());
                }
                // (The group begins where the levels known so far end.)
                if cuts.heads[levels.len()..levels.len() + 8].iter().all(|&head| head == Head::NONE.0) {
                    return Err(wrong.into());
                }
                splits += 1;
                levels.try_reserve(8)?;
                levels.extend([level + 1; 8]);
            }
            let Some(own) = CellIds::read(cuts.ids, ids, head.surfaces()) else { return Err(wrong.into()) };
            ids += own.len();
            // (The bytes may hold one id more than the limit.)
            if u32::try_from(ids).is_err() {
                return Err(wrong.into());
            }
            let is_ascending = own.windows(2).all(|pair| pair[0] < pair[1]);
            if !is_ascending || !own.iter().all(|&id| known.meet(&cuts.surfaces, id)) {
                return Err(wrong.into());
            }
        }
        if levels.len() != cuts.heads.len() || !cuts.ids.ends_with(ids) || !known.are_all_met() {
            return Err(Damage::CutRecord { record: cuts.heads.len() as u64 }.into());
        }
        if cuts.moments.is_some_and(|stored| stored.moments().is_none()) {
            return Err(Damage::Moments.into());
        }
        Ok(cuts.surfaces.check(self.frame.depth())?)
    }

    /// Returns the levels of the PARTIAL cells of the planes, in the order of their records, whose counts are
    /// checked. (Takes memory for one level for each record.)
    fn levels_of_records(&self, cuts: &CutsRef<'_>) -> Result<Vec<u8>, Error> {
        let mut levels = memory::with_capacity(cuts.heads.len())?;
        if self.root == Tag::Partial {
            memory::push(&mut levels, 0)?;
        }
        let elements = self.planes.len() + self.bricks.len();
        let mut e = 0;
        for index in 0..=elements {
            let is_counted = cuts.first.get(index).is_some_and(|&first| first as usize == levels.len());
            if !is_counted || levels.len() > cuts.heads.len() {
                return Err(Damage::CutCount { index: index as u64 }.into());
            }
            while e + 1 < self.levels() && index >= self.starts[e + 1] {
                e += 1;
            }
            let Some(planes) = self.entry(index).filter(|_| index < elements) else { continue };
            let (cells, partial) = (self.cell_level(e), planes.partial());
            for octant in 0..8 {
                match (partial >> (8 * octant)) as u8 {
                    0xFF => memory::push(&mut levels, cells - 1)?,
                    some => {
                        for _ in 0..some.count_ones() {
                            memory::push(&mut levels, cells)?;
                        }
                    }
                }
            }
        }
        Ok(levels)
    }
}

/// The surfaces that have been met. Surfaces are sorted by group, and within a group by their first use.
struct Known {
    /// For each group, the numbers of its first surface, of the first one that has not been met, and of the
    /// first one of the next group.
    groups: Vec<[u64; 3]>,
}

impl Known {
    fn new(surfaces: &SurfacesRef<'_>) -> Result<Known, Error> {
        let first = surfaces.records.len() as u64;
        let ends = surfaces.groups.iter().map(|group| first.saturating_add(group.end));
        let mut groups = memory::with_capacity(1 + surfaces.groups.len())?;
        groups.push([0, 0, first]);
        let mut start = first;
        for end in ends {
            groups.push([start, start, end]);
            start = end;
        }
        Ok(Known { groups })
    }

    /// Returns true if a surface was met before, or is the next one of its group, and the group may be begun.
    fn meet(&mut self, surfaces: &SurfacesRef<'_>, id: u32) -> bool {
        let group = surfaces.group(id as usize).map_or(0, |(group, _)| group + 1);
        // (Group 0 has the exact surfaces, and may be empty; the groups of slabs are begun in their order.)
        let begun = group < 2 || self.groups.get(group - 1).is_some_and(|&[first, next, _]| next > first);
        let Some([_, next, end]) = self.groups.get_mut(group) else { return false };
        let id = u64::from(id);
        if id == *next && id < *end {
            *next += 1;
        }
        begun && id < *next
    }

    fn are_all_met(&self) -> bool {
        self.groups.iter().all(|[_, next, end]| next == end)
    }
}

impl<'a> OctreeRef<'a> {
    /// Returns the surface of this number, which is less than [`CutCounts::surfaces`]; `None` if there is no
    /// such surface, or it is damaged. O(1).
    pub fn surface(&self, id: u32) -> Option<StoredSurface<'a>> {
        StoredSurface::new(self.cuts.as_ref()?.surfaces, id)
    }

    /// Returns the function of surfaces that the solid is in a cell within a PARTIAL cell; `None` if nothing
    /// is known there, if different functions hold in parts of the cell, or there is no such cell. O(depth).
    pub fn cell_function(&self, cell: Cell) -> Option<CellFunction> {
        let cuts = self.cuts.as_ref()?;
        let depth = self.frame().depth();
        if cell.level > depth || cell.at.iter().any(|&a| a >> cell.level != 0) {
            return None;
        }
        let (mut record, mut level) = self.record_above(cuts, cell)?;
        loop {
            match cuts.at(record) {
                CellCut::None => return None,
                CellCut::Table { ids, table } => return Some(CellFunction { ids, table }),
                CellCut::Split(first) => {
                    if level >= cell.level {
                        return None;
                    }
                    level += 1;
                    record = first + usize::from(cell.ancestor(level).octant());
                }
            }
        }
    }

    /// Returns the record and the level of the PARTIAL cell of the planes that contains a cell.
    pub(super) fn record_above(&self, cuts: &CutsRef<'_>, cell: Cell) -> Option<(usize, u8)> {
        let (place, level) = self.partial_above(cell)?;
        Some((place.map_or(CutsRef::ROOT, |(index, planes, c)| cuts.record(index, planes, c)), level))
    }

    /// Returns the level of the PARTIAL cell of the planes that contains a cell about which nothing is known;
    /// `None` if something is known about the cell, or there is no such cell.
    pub(super) fn open_above(&self, cell: Cell) -> Option<u8> {
        if cell.level > self.frame().depth() || cell.at.iter().any(|&a| a >> cell.level != 0) {
            return None;
        }
        let (_, open) = self.partial_above(cell)?;
        let Some(cuts) = &self.cuts else { return Some(open) };
        let (mut record, mut level) = self.record_above(cuts, cell)?;
        loop {
            match cuts.at(record) {
                CellCut::None => return Some(open),
                CellCut::Split(first) if level < cell.level => {
                    level += 1;
                    record = first + usize::from(cell.ancestor(level).octant());
                }
                _ => return None,
            }
        }
    }

    /// Returns the PARTIAL cell of the planes that contains a cell, and its level. The inner `None` stands
    /// for the universe.
    fn partial_above(&self, cell: Cell) -> Option<(Option<PartialCell>, u8)> {
        match self.root_tag() {
            Tag::Branch => {}
            Tag::Partial => return Some((None, 0)),
            _ => return None,
        }
        // The finest cell at the lower corner.
        let shift = self.frame().depth() - cell.level;
        let finest = Cell { level: self.frame().depth(), at: cell.at.each(|a| a << shift) };
        let mut index = 0;
        for e in 0..self.levels() {
            let planes = self.entry(index)?;
            let cells = self.cell_level(e);
            let inner = finest.ancestor(cells).octant();
            // In a tree of odd depth, the root has one octant.
            let outer = if e == 0 && starts_half_way(self.frame().depth()) {
                0
            } else {
                finest.ancestor(cells - 1).octant()
            };
            let c = u32::from(8 * outer + inner);
            match self.step(e, index, planes, c) {
                Step::Into(child) => index = child,
                Step::Settled(Tag::Partial) => {
                    let level = cells - u8::from(planes.octant(c >> 3) == Tag::Partial);
                    return (level <= cell.level).then_some((Some((index, planes, c)), level));
                }
                Step::Settled(_) => return None,
            }
        }
        None
    }
}
