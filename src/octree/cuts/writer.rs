//! How cuts are gathered while a tree is written, and put in order when it is done.

use super::{BLOCK, Block, Cuts, Head, OwnedIds, Surfaces};
use crate::error::Error;
use crate::memory;
use alloc::boxed::Box;
use alloc::collections::VecDeque;
use alloc::vec::Vec;

/// What is known of a PARTIAL cell, while the tree is written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Cut {
    /// Nothing.
    None,
    /// Surfaces, in ascending order of their ids, and the function of them; the table depends on each.
    Table { ids: [u32; 3], table: u8 },
    /// What is known of the children.
    Split(Box<[Cut; 8]>),
}

impl Cut {
    /// Eight children that are PARTIAL, as one cell.
    pub(crate) fn of_children(children: [Cut; 8]) -> Cut {
        if children.iter().all(|child| *child == Cut::None) {
            Cut::None
        } else {
            Cut::Split(Box::new(children))
        }
    }

    /// Ids from `first` on become greater by `more`.
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

/// Cuts of a tree that is being written: level by level, as its elements.
#[derive(Default)]
pub(crate) struct CutWriter {
    levels: Vec<Level>,
}

/// Cuts of one level of elements.
#[derive(Default)]
struct Level {
    cuts: Vec<Cut>,
    /// How many each element has.
    counts: Vec<u32>,
}

impl CutWriter {
    pub(crate) fn new(levels: usize) -> Result<CutWriter, Error> {
        let mut own = memory::with_capacity(levels)?;
        own.resize_with(levels, Level::default);
        Ok(CutWriter { levels: own })
    }

    /// Hands over the cuts of an element of level `e`, which has been stored.
    pub(crate) fn put(&mut self, e: usize, cuts: impl IntoIterator<Item = Cut>) -> Result<(), Error> {
        let level = &mut self.levels[e];
        let before = level.cuts.len();
        for cut in cuts {
            memory::push(&mut level.cuts, cut)?;
        }
        memory::push(&mut level.counts, (level.cuts.len() - before) as u32)
    }

    /// Takes over what a sibling wrote, which comes after all that this one wrote so far; ids from `first` on become greater by
    /// `more`.
    pub(crate) fn append(&mut self, other: CutWriter, first: u32, more: u32) -> Result<(), Error> {
        for (level, mut theirs) in self.levels.iter_mut().zip(other.levels) {
            theirs.cuts.iter_mut().for_each(|cut| cut.renumber(first, more));
            level.cuts.try_reserve(theirs.cuts.len())?;
            level.counts.try_reserve(theirs.counts.len())?;
            level.cuts.append(&mut theirs.cuts);
            level.counts.append(&mut theirs.counts);
        }
        Ok(())
    }

    /// Puts all in order: records, what is counted before them, and of the surfaces, which `surfaces` tells by their ids so far,
    /// those that are used, in the order of their first use. Nothing comes of a tree without PARTIAL cells. `root` is the cut of a universe that is one PARTIAL cell.
    ///
    /// # Errors
    /// [`Error::Limit`] if there are 2^32 records or ids, [`Error::OutOfMemory`], and what `surfaces` refuses.
    pub(crate) fn finish(
        self,
        root: Option<Cut>,
        surfaces: impl FnOnce(&[u32]) -> Result<Surfaces, Error>,
    ) -> Result<Option<Cuts>, Error> {
        let mut first =
            memory::with_capacity(self.levels.iter().map(|level| level.counts.len()).sum::<usize>() + 1)?;
        let mut queue = VecDeque::new();
        let mut next = 0u64;
        for level in self.levels {
            for count in level.counts {
                first.push(next as u32);
                next += u64::from(count);
            }
            queue.try_reserve(level.cuts.len())?;
            queue.extend(level.cuts);
        }
        queue.try_reserve(1)?;
        next += u64::from(root.is_some());
        queue.extend(root);
        first.push(next as u32);
        let limit = |count: u64| {
            let what = "records of cuts, or surfaces in them";
            if count > u64::from(u32::MAX) {
                Err(Error::Limit { what, limit: u32::MAX.into() })
            } else {
                Ok(())
            }
        };
        limit(next)?;
        let (mut heads, mut ids, mut blocks) = (Vec::new(), Vec::new(), Vec::new());
        let (mut splits, mut used, mut names) = (0u32, Vec::new(), hashbrown::HashMap::new());
        while let Some(cut) = queue.pop_front() {
            if heads.len() % BLOCK == 0 {
                memory::push(&mut blocks, Block { ids: ids.len() as u32, splits })?;
            }
            let mut head = cut.head();
            match cut {
                Cut::None => {}
                Cut::Table { ids: own, table } => {
                    let own = &own[..head.surfaces()];
                    names.try_reserve(own.len())?;
                    used.try_reserve(own.len())?;
                    let mut named = [(0, 0); 3];
                    for (i, &id) in own.iter().enumerate() {
                        let name = *names.entry(id).or_insert_with(|| {
                            used.push(id);
                            used.len() as u32 - 1
                        });
                        named[i] = (name, i);
                    }
                    let named = &mut named[..own.len()];
                    named.sort_unstable();
                    head = Head(permuted(table, named.iter().map(|&(_, i)| i)));
                    ids.try_reserve(own.len())?;
                    ids.extend(named.iter().map(|&(name, _)| name));
                }
                Cut::Split(children) => {
                    splits += 1;
                    queue.try_reserve(8)?;
                    queue.extend(*children);
                }
            }
            memory::push(&mut heads, head.0)?;
            limit(heads.len() as u64 + queue.len() as u64)?;
            limit(ids.len() as u64)?;
        }
        if heads.is_empty() {
            return Ok(None);
        }
        let ids = OwnedIds::narrowed(ids, used.len())?;
        Ok(Some(Cuts { heads, ids, blocks, first, surfaces: surfaces(&used)? }))
    }
}

/// The table of the same surfaces in another order: the i-th is now the one that was at the i-th place of `order`.
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
        // The first and not the second of three, of which the third does not count.
        let table = 0xAA & !0xCC;
        assert_eq!(permuted(table, [1, 0].into_iter()), 0xCC & !0xAA);
        assert_eq!(permuted(0xAA & 0xCC | 0xF0, [2, 0, 1].into_iter()), 0xCC & 0xF0 | 0xAA);
        assert_eq!(permuted(0x55, [0].into_iter()), 0x55);
    }
}
