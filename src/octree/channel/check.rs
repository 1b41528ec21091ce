//! The one definition of a well-formed channel.

use super::value::Bits;
use super::view::{ChannelRef, Octant, octant};
use crate::error::{Damage, Error};
use crate::octree::brick::Bricks;
use crate::octree::view::{LevelCounts, starts_half_way};
use crate::octree::word::Planes;
use crate::octree::{Tag, dictionary};
use alloc::vec;
use alloc::vec::Vec;

impl ChannelRef<'_> {
    /// Checks everything that a well-formed channel guarantees: links, ranks, no uniform elements, legal
    /// values that differ from the previous one, a canonical dictionary, a true level table. The channels
    /// that the library makes pass by construction. O(n).
    ///
    /// # Errors
    ///
    /// [`Error::Damaged`] with the first [`Damage`] found; [`Error::OutOfMemory`].
    pub fn check(&self) -> Result<(), Error> {
        self.check_links()?;
        dictionary::check(&self.tree)?;
        let wrong = |index: usize| Damage::Value { index: index as u64 };
        let mut values = 0;
        for index in 0..self.entries() {
            let planes = self.tree.entry(index).ok_or(Damage::Link { element: index as u64 })?;
            self.check_entry(index, planes)?;
            let before = self.value_base.get(index >> 10).zip(self.value_rel.get(index));
            if before.is_none_or(|(base, &rel)| base.checked_add(rel.into()) != Some(values))
                || (index.is_multiple_of(1024) && self.value_rel[index] != 0)
            {
                return Err(Damage::Rank { index: index as u64 }.into());
            }
            let first = planes.upper.trailing_zeros();
            if values == 0 && planes.upper != 0 && planes.lower >> first & 1 == 0 {
                return Err(wrong(0).into());
            }
            values += u64::from(planes.full().count_ones());
        }
        let expected = if self.tree.root == Tag::Full { 1 } else { values };
        if self.value_count() != expected || !self.values.len().is_multiple_of(self.value_type.size()) {
            return Err(Damage::Rank { index: self.entries() as u64 }.into());
        }
        let mut before: Option<Bits> = None;
        for index in 0..expected as usize {
            let value = self.stored(index).filter(|&value| before != Some(value)).ok_or(wrong(index))?;
            if self.value_type.encode(self.value_type.decode(value)).ok() != Some(value) {
                return Err(wrong(index).into());
            }
            before = Some(value);
        }
        if let Some(table) = self.tree.table {
            let counts = self.count_levels();
            let wrong = (0..counts.len().max(table.len())).find(|&k| counts.get(k) != table.get(k));
            if let Some(level) = wrong {
                return Err(Damage::LevelTable { level: level as u8 }.into());
            }
        }
        Ok(())
    }

    /// Checks the conditions under which a walk visits no element twice: the links, and the number of ranks,
    /// which is that of the elements.
    pub(crate) fn check_links(&self) -> Result<(), Damage> {
        self.tree.check_links()?;
        let ranks = (self.value_rel.len(), self.value_base.len());
        if ranks != (self.entries(), self.entries().div_ceil(1024)) || self.tree.root == Tag::Partial {
            return Err(Damage::Rank { index: self.entries() as u64 });
        }
        Ok(())
    }

    fn entries(&self) -> usize {
        self.tree.planes.len() + self.tree.bricks.len()
    }

    fn check_entry(&self, index: usize, planes: Planes) -> Result<(), Damage> {
        let real = if index == 0 { self.tree.root_cells() } else { !0 };
        if planes.masked(!real) != Planes::uniform(Tag::Empty) {
            return Err(Damage::Padding);
        }
        let is_empty = planes == Planes::uniform(Tag::Empty);
        if is_empty || planes.upper == real && planes.lower & !1 == 0 {
            return Err(Damage::Uniform { index: index as u64 });
        }
        let brick = index.checked_sub(self.tree.planes.len());
        if let Some(brick) = brick.filter(|_| planes.branch() != 0) {
            return Err(Damage::BrickBranch { brick: brick as u64 });
        }
        if matches!(self.tree.bricks, Bricks::One(_)) {
            return Err(Damage::MissingPlane);
        }
        Ok(())
    }

    /// Counts on each level the nodes, the cells that have a value (`full`), and the cells that start one
    /// (`partial`).
    pub(crate) fn count_levels(&self) -> Vec<LevelCounts> {
        let tree = &self.tree;
        let mut counts = vec![LevelCounts::default(); tree.frame.depth() as usize + 1];
        match tree.root {
            Tag::Branch => {}
            Tag::Full => (counts[0].full, counts[0].partial) = (1, 1),
            Tag::Empty | Tag::Partial => {}
        }
        if tree.root != Tag::Branch {
            return counts;
        }
        let half = starts_half_way(tree.frame.depth());
        for e in 0..tree.levels() {
            let cells = tree.cell_level(e) as usize;
            for index in tree.starts[e]..tree.starts[e + 1] {
                // Damage reads as cells without a value.
                let planes = tree.entry(index).unwrap_or(Planes::uniform(Tag::Empty));
                let octants = if half && e == 0 { 1 } else { 8 };
                if octants == 8 {
                    counts[cells - 2].nodes += 1;
                }
                for k in 0..octants {
                    let of = |word: u64| u64::from(((word >> (8 * k)) as u8).count_ones());
                    match octant(planes, k) {
                        // An octant that is the universe is a node.
                        Octant::Nothing if octants == 8 => {}
                        Octant::OneValue if octants == 8 => {
                            counts[cells - 1].full += 1;
                            counts[cells - 1].partial += of(planes.full());
                        }
                        _ => {
                            counts[cells - 1].nodes += 1;
                            counts[cells].full += of(planes.upper);
                            counts[cells].partial += of(planes.full());
                        }
                    }
                }
            }
        }
        counts
    }
}
