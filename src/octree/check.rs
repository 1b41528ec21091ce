//! The one definition of a well-formed tree.

use super::dictionary;
use super::tag::Tag;
use super::view::OctreeRef;
use super::word::Planes;
use crate::error::{Damage, Error};

impl OctreeRef<'_> {
    /// Checks everything that a well-formed tree guarantees: children where level order puts them, no uniform
    /// elements, no branches in bricks, only real cells, a canonical dictionary, no more planes than needed,
    /// a true level table. The trees that the library makes pass by construction. O(n).
    ///
    /// # Errors
    ///
    /// [`Error::Damaged`] with the first [`Damage`] found. The order matters, because each step relies on the
    /// previous ones: links level by level, then elements, then bricks, then the data derived from them.
    /// [`Error::OutOfMemory`]: the entries of a dictionary are counted and compared, at most 65 536 at a
    /// time.
    pub fn check(&self) -> Result<(), Error> {
        self.check_links()?;
        let real = |index: usize| if index == 0 { self.root_cells() } else { !0 };
        let mut undecided = 0;
        for (index, planes) in self.planes.iter().enumerate() {
            undecided |= planes.partial();
            check_element(index, *planes, real(index))?;
        }
        dictionary::check(self)?;
        for b in 0..self.bricks.len() {
            let planes = self.bricks.get(b).ok_or(Damage::Dictionary { brick: b as u64 })?;
            let index = self.planes.len() + b;
            undecided |= planes.partial();
            check_element(index, planes, real(index))?;
            if planes.branch() != 0 {
                return Err(Damage::BrickBranch { brick: b as u64 }.into());
            }
        }
        match (self.root == Tag::Partial || undecided != 0, self.bricks.one_plane()) {
            (true, true) => return Err(Damage::MissingPlane.into()),
            (false, false) => return Err(Damage::NeedlessPlane.into()),
            _ => {}
        }
        self.check_cuts()?;
        if let Some(table) = self.table {
            let counts = self.count_levels();
            let wrong =
                (0..counts.len().max(table.len())).find(|&level| counts.get(level) != table.get(level));
            if let Some(level) = wrong {
                return Err(Damage::LevelTable { level: level as u8 }.into());
            }
        }
        Ok(())
    }

    /// Checks the links as [`check_links`](Self::check_links) does, unless they are known to be sound. A
    /// solid may be queried for a single point as often as for a million points; for trees that this library
    /// made in memory, the check is O(1).
    pub(crate) fn ensure_links(&self) -> Result<(), Damage> {
        if self.is_linked { Ok(()) } else { self.check_links() }
    }

    /// Ranks all children anew and compares the results with the links. If they agree, every element has one
    /// parent.
    pub(crate) fn check_links(&self) -> Result<(), Damage> {
        let count = self.planes.len();
        let levels = self.levels();
        let mut next = (self.root == Tag::Branch) as usize;
        for e in 0..levels {
            let (first, end) = (self.starts[e], self.starts[e + 1]);
            if end != next || end < first {
                let (expected, found) = ((next - first) as u64, end.wrapping_sub(first) as u64);
                return Err(Damage::Count { level: e as u8, expected, found });
            }
            if e + 1 == levels {
                break;
            }
            for n in first..end {
                let planes = self.planes.get(n).ok_or(Damage::Link { element: n as u64 })?;
                if self.first_child(n) != Some(next) || (n % 1024 == 0 && self.rel[n] != 0) {
                    return Err(Damage::Link { element: n as u64 });
                }
                next += planes.branch().count_ones() as usize;
            }
        }
        let lengths = (self.rel.len(), self.base.len(), self.bricks.len());
        if self.starts[levels - 1] != count
            || lengths != (count, count.div_ceil(1024), self.starts[levels] - count)
        {
            return Err(Damage::Link { element: count as u64 });
        }
        Ok(())
    }
}

fn check_element(index: usize, planes: Planes, real: u64) -> Result<(), Damage> {
    if planes.masked(!real) != Planes::uniform(Tag::Empty) {
        return Err(Damage::Padding);
    }
    if planes.merged(real).is_some() {
        return Err(Damage::Uniform { index: index as u64 });
    }
    Ok(())
}
