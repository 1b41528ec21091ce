//! The writer of cuts: gathers them while a tree is written, and sorts them at the end.

use super::{BLOCK, Block, Cuts, CutsRef, Head, Origin, OwnedIds, Surfaces, records};
use crate::error::{Damage, Error};
use crate::memory;
use crate::octree::word::Planes;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::cmp::Ordering;
use core::ops::Range;
use hashbrown::HashMap;

/// The content of a PARTIAL cell, while the tree is written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Cut {
    /// Nothing is known.
    None,
    /// Surfaces, and the function of them; the table depends on each of them.
    Table { ids: [u32; 3], table: u8 },
    /// The cell is split: the contents of the children.
    Split(Box<[Cut; 8]>),
}

impl Cut {
    /// Returns eight PARTIAL children as one cell.
    pub(crate) fn of_children(children: [Cut; 8]) -> Cut {
        if children.iter().all(|child| *child == Cut::None) {
            Cut::None
        } else {
            Cut::Split(Box::new(children))
        }
    }

    /// Increases ids from `first` on by `more`.
    pub(crate) fn renumber(&mut self, first: u32, more: u32) {
        match self {
            Cut::None => {}
            Cut::Table { ids, .. } => ids.iter_mut().filter(|id| **id >= first).for_each(|id| *id += more),
            Cut::Split(children) => children.iter_mut().for_each(|child| child.renumber(first, more)),
        }
    }

    fn head(&self) -> Head {
        match self {
            Cut::None => Head::NONE,
            Cut::Table { table, .. } => Head(*table),
            Cut::Split(_) => Head::SPLIT,
        }
    }
}

/// Records one after the other, and the preliminary numbers of their surfaces.
#[derive(Default)]
struct Records {
    heads: Vec<u8>,
    ids: Vec<u32>,
}

/// Cuts of one level of elements: first the records of its cells, then those of their parts, then those of
/// the parts of these.
#[derive(Default)]
struct Level {
    generations: Vec<Records>,
    /// Number of records of each element.
    counts: Vec<u32>,
}

impl Level {
    fn generation(&mut self, g: usize) -> Result<&mut Records, Error> {
        if g == self.generations.len() {
            memory::push(&mut self.generations, Records::default())?;
        }
        Ok(&mut self.generations[g])
    }

    fn push(&mut self, g: usize, cut: &Cut) -> Result<(), Error> {
        let records = self.generation(g)?;
        let head = cut.head();
        memory::push(&mut records.heads, head.0)?;
        match cut {
            Cut::None => {}
            Cut::Table { ids, .. } => {
                records.ids.try_reserve(head.surfaces())?;
                records.ids.extend_from_slice(&ids[..head.surfaces()]);
            }
            Cut::Split(children) => {
                for child in &**children {
                    self.push(g + 1, child)?;
                }
            }
        }
        Ok(())
    }
}

/// Cuts of a tree that is being written: level by level, like its elements.
#[derive(Default)]
pub(crate) struct CutWriter {
    levels: Vec<Level>,
}

/// The names of the surfaces of copied records: for each its preliminary number, and whether it is negated
/// there.
pub(crate) type Names<'n> = &'n [(u32, bool)];

impl CutWriter {
    pub(crate) fn new(levels: usize) -> Result<CutWriter, Error> {
        let mut own = memory::with_capacity(levels)?;
        own.resize_with(levels, Level::default);
        Ok(CutWriter { levels: own })
    }

    /// Stores the cuts of an element of level `e`, which has been stored, and returns their number.
    pub(crate) fn put<'c>(&mut self, e: usize, cuts: impl Iterator<Item = &'c Cut>) -> Result<usize, Error> {
        let level = &mut self.levels[e];
        let mut count = 0;
        for cut in cuts {
            level.push(0, cut)?;
            count += 1;
        }
        memory::push(&mut level.counts, count)?;
        Ok(count as usize)
    }

    /// Copies the records of the elements `run`, which follow each other on level `e`, or (`flip`) those of
    /// the complement. Returns the bytes of the records.
    pub(crate) fn copy(
        &mut self,
        e: usize,
        cuts: &CutsRef<'_>,
        run: Range<usize>,
        names: Names<'_>,
        flip: bool,
    ) -> Result<usize, Error> {
        let level = &mut self.levels[e];
        let wrong = |element: usize| Damage::CutCount { index: element as u64 };
        let counts = cuts.first.get(run.start..run.end + 1).ok_or(wrong(run.end))?;
        level.counts.try_reserve(run.len())?;
        for (n, pair) in counts.windows(2).enumerate() {
            level.counts.push(pair[1].checked_sub(pair[0]).ok_or(wrong(run.start + n))?);
        }
        let (mut records, mut g, mut bytes) = (counts[0] as usize..counts[run.len()] as usize, 0, 0);
        while !records.is_empty() {
            let own = level.generation(g)?;
            let before = (own.heads.len(), own.ids.len());
            own.copy(cuts, records.clone(), names, flip)?;
            bytes += own.heads.len() - before.0 + size_of::<u32>() * (own.ids.len() - before.1);
            records = cuts.parts(records);
            g += 1;
        }
        Ok(bytes)
    }

    /// Copies elements whose cells keep nothing, and are `planes`, in the same way.
    pub(crate) fn copy_plain(
        &mut self,
        e: usize,
        planes: impl Iterator<Item = Planes>,
    ) -> Result<usize, Error> {
        let level = &mut self.levels[e];
        let mut all = 0;
        for planes in planes {
            let count = records(planes);
            memory::push(&mut level.counts, count)?;
            all += count as usize;
        }
        let heads = &mut level.generation(0)?.heads;
        heads.try_reserve(all)?;
        heads.resize(heads.len() + all, Head::NONE.0);
        Ok(all)
    }

    /// Takes over the output of a sibling, which comes after all output of this writer so far. Ids from
    /// `first` on are increased by `more`.
    pub(crate) fn append(&mut self, other: CutWriter, first: u32, more: u32) -> Result<(), Error> {
        for (level, mut theirs) in self.levels.iter_mut().zip(other.levels) {
            level.counts.try_reserve(theirs.counts.len())?;
            level.counts.append(&mut theirs.counts);
            for (g, mut theirs) in theirs.generations.into_iter().enumerate() {
                let own = level.generation(g)?;
                theirs.ids.iter_mut().filter(|id| **id >= first).for_each(|id| *id += more);
                own.heads.try_reserve(theirs.heads.len())?;
                own.ids.try_reserve(theirs.ids.len())?;
                own.heads.append(&mut theirs.heads);
                own.ids.append(&mut theirs.ids);
            }
        }
        Ok(())
    }

    /// Sorts everything: the records, and the counts before them. Also returns the preliminary numbers of the
    /// surfaces that are used: first the surfaces to which `group` gives no origin, then slabs of cells,
    /// origin by origin. Within these, the surfaces are in the order of their first use; those that the same
    /// record uses first are in the given `order` of their numbers. The table of surfaces is left empty.
    /// Returns nothing for a tree without PARTIAL cells. `root` is the cut of a universe that is one PARTIAL
    /// cell.
    ///
    /// # Errors
    ///
    /// [`Error::Limit`] if there are 2^32 records or ids, and [`Error::OutOfMemory`].
    pub(crate) fn finish(
        mut self,
        root: Option<Cut>,
        order: impl Fn(u32, u32) -> Ordering,
        group: impl Fn(u32) -> Option<Origin>,
    ) -> Result<Option<(Cuts, Vec<u32>)>, Error> {
        if let Some(root) = root {
            // (There is no element then.)
            self.levels[0].push(0, &root)?;
        }
        let limit = |count: usize| match u32::try_from(count) {
            Ok(count) => Ok(count),
            Err(_) => {
                Err(Error::Limit { what: "records of cuts, or surfaces in them", limit: u32::MAX.into() })
            }
        };
        let all = || self.levels.iter().flat_map(|level| &level.generations);
        let count = limit(all().map(|records| records.heads.len()).sum())?;
        if count == 0 {
            return Ok(None);
        }
        limit(all().map(|records| records.ids.len()).sum())?;
        let mut first =
            memory::with_capacity(self.levels.iter().map(|level| level.counts.len()).sum::<usize>() + 1)?;
        let mut next = 0u32;
        for count in self.levels.iter().flat_map(|level| &level.counts) {
            first.push(next);
            next += count;
        }
        first.push(next + u32::from(first.is_empty()));
        let mut heads: Vec<u8> = memory::with_capacity(count as usize)?;
        let mut ids: Vec<Name> = memory::with_capacity(all().map(|records| records.ids.len()).sum())?;
        let mut blocks = memory::with_capacity((count as usize).div_ceil(BLOCK))?;
        let (mut splits, mut names) = (0u32, Renaming::new(group)?);
        let generations = self.levels.iter().map(|level| level.generations.len()).max().unwrap_or(0);
        for records in (0..generations)
            .flat_map(|g| self.levels.iter().filter_map(move |level| level.generations.get(g)))
        {
            let mut rest = &*records.ids;
            for &head in &records.heads {
                if heads.len().is_multiple_of(BLOCK) {
                    blocks.push(Block { ids: ids.len() as u32, splits });
                }
                let mut head = Head(head);
                splits += u32::from(head.is_split());
                let (own, others) = rest.split_at(head.surfaces());
                rest = others;
                match own {
                    [] => {}
                    [one] => ids.push(names.of(*one)?),
                    several => head.0 = names.record(several, head.0, &order, &mut ids)?,
                }
                heads.push(head.0);
            }
        }
        let (starts, used) = names.finish()?;
        let numbers = ids.iter().map(|name| starts[name.group as usize] + name.place);
        let ids = OwnedIds::packed(numbers, used.len())?;
        Ok(Some((Cuts { heads, ids, blocks, first, surfaces: Surfaces::default(), moments: None }, used)))
    }
}

impl Records {
    /// Copies consecutive records.
    fn copy(
        &mut self,
        cuts: &CutsRef<'_>,
        run: Range<usize>,
        names: Names<'_>,
        flip: bool,
    ) -> Result<(), Error> {
        let wrong = |record: usize| Damage::CutRecord { record: record as u64 };
        let heads = cuts.heads.get(run.clone()).ok_or(wrong(run.end))?;
        let (mut id, _) = cuts.before(run.start).ok_or(wrong(run.start))?;
        self.heads.try_reserve(heads.len())?;
        for (record, &head) in run.zip(heads) {
            let count = Head(head).surfaces();
            let mut table = if flip && count > 0 { !head } else { head };
            self.ids.try_reserve(count)?;
            for i in 0..count {
                let known = cuts.ids.get(id + i).and_then(|id| names.get(id as usize));
                let &(name, negated) = known.ok_or(wrong(record))?;
                if negated {
                    table = Head::negated(table, i);
                }
                self.ids.push(name);
            }
            id += count;
            self.heads.push(table);
        }
        Ok(())
    }
}

/// The final number of a surface, without the number of surfaces in the groups before its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Name {
    group: u32,
    place: u32,
}

/// The numbers of surfaces: group by group, in the order of their first use.
struct Renaming<G> {
    /// Returns the origin of a slab of a cell.
    group: G,
    /// For each preliminary number the new name, if the surface is used.
    names: Vec<Option<Name>>,
    /// The preliminary numbers of each group. The first group has all surfaces but slabs of cells.
    used: Vec<Vec<u32>>,
    groups: HashMap<Origin, u32>,
}

impl<G: Fn(u32) -> Option<Origin>> Renaming<G> {
    fn new(group: G) -> Result<Renaming<G>, Error> {
        let used = memory::collected([Vec::new()].into_iter())?;
        Ok(Renaming { group, names: Vec::new(), used, groups: HashMap::new() })
    }

    fn known(&self, id: u32) -> Option<Name> {
        self.names.get(id as usize).copied().flatten()
    }

    fn of(&mut self, id: u32) -> Result<Name, Error> {
        if let Some(name) = self.known(id) {
            return Ok(name);
        }
        let missing = (id as usize + 1).saturating_sub(self.names.len());
        self.names.try_reserve(missing)?;
        self.names.resize(self.names.len() + missing, None);
        let group = match (self.group)(id) {
            None => 0,
            Some(origin) => {
                self.groups.try_reserve(1)?;
                let next = self.used.len() as u32;
                let group = *self.groups.entry(origin).or_insert(next);
                if group == next {
                    memory::push(&mut self.used, Vec::new())?;
                }
                group
            }
        };
        let used = &mut self.used[group as usize];
        let name = Name { group, place: used.len() as u32 };
        memory::push(used, id)?;
        self.names[id as usize] = Some(name);
        Ok(name)
    }

    /// Renumbers the surfaces of a record in ascending order, and returns their table.
    fn record(
        &mut self,
        own: &[u32],
        table: u8,
        order: impl Fn(u32, u32) -> Ordering,
        ids: &mut Vec<Name>,
    ) -> Result<u8, Error> {
        let mut places = [0, 1, 2];
        let places = &mut places[..own.len()];
        places.sort_unstable_by(|&a, &b| order(own[a], own[b]));
        let mut names = [None; 3];
        for &place in &*places {
            names[place] = Some(self.of(own[place])?);
        }
        places.sort_unstable_by_key(|&place| names[place]);
        ids.extend(places.iter().filter_map(|&place| names[place]));
        Ok(permuted(table, places.iter().copied()))
    }

    /// Returns the number of surfaces before those of each group, and the preliminary numbers of all.
    fn finish(self) -> Result<(Vec<u32>, Vec<u32>), Error> {
        let mut starts = memory::with_capacity(self.used.len())?;
        let mut all = Vec::new();
        for own in &self.used {
            starts.push(all.len() as u32);
            all.try_reserve(own.len())?;
            all.extend_from_slice(own);
        }
        Ok((starts, all))
    }
}

/// Returns the table of the same surfaces in another order: the i-th one is now the surface that was at the
/// i-th place of `order`.
fn permuted(table: u8, order: impl ExactSizeIterator<Item = usize> + Clone) -> u8 {
    let count = order.len();
    (0..8u8).fold(0, |all, m| {
        let low = m & ((1 << count) - 1);
        let before = order.clone().enumerate().fold(0, |signs, (to, from)| signs | (low >> to & 1) << from);
        all | (table >> before & 1) << m
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_in_another_order() {
        // The first and not the second of three surfaces; the third does not matter.
        let table = 0xAA & !0xCC;
        assert_eq!(permuted(table, [1, 0].into_iter()), 0xCC & !0xAA);
        assert_eq!(permuted(0xAA & 0xCC | 0xF0, [2, 0, 1].into_iter()), 0xCC & 0xF0 | 0xAA);
        assert_eq!(permuted(0x55, [0].into_iter()), 0x55);
    }
}
