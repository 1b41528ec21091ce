//! The cells below an element of a stored tree, counted without a descent.

use crate::dispatch::{Hot, with_popcount};
use crate::error::Damage;
use crate::octree::links::Windows;
use crate::octree::{OctreeRef, Planes, Tag};

/// Counts the FULL and the PARTIAL finest cells below element `index` of level `e`. In level order these
/// cells are one range of entries for each level. `windows`, which have admitted the element, also check each
/// element that is read.
///
/// # Errors
/// An error if the entries of a level do not belong to the branches of the level above. (The count therefore
/// never exceeds the number of cells below the element.)
pub(super) fn count(
    tree: &OctreeRef<'_>,
    e: usize,
    index: usize,
    mut windows: Option<&mut Windows>,
) -> Result<[u64; 2], Damage> {
    let levels = tree.levels();
    let damage = Damage::Link { element: index as u64 };
    let mut found = [0u64; 2];
    let (mut first, mut end) = (index, index + 1);
    for level in e..levels {
        if level > e {
            if first < tree.starts[level] || end > tree.starts[level + 1] {
                return Err(damage);
            }
            if let Some(windows) = &mut windows {
                windows.admit(index, level, first, end)?;
            }
        }
        let counts = with_popcount(Entries { tree, first, end });
        let shift = 6 * (levels - 1 - level) as u32;
        found[0] += counts.full << shift;
        found[1] += counts.partial << shift;
        if level + 1 == levels {
            // Bricks have no children.
            return if counts.branches == 0 { Ok(found) } else { Err(damage) };
        }
        if counts.branches == 0 {
            break;
        }
        (first, end) = (tree.children_from(first, level), tree.children_from(end, level));
        if end.checked_sub(first).map(|children| children as u64) != Some(counts.branches) {
            return Err(damage);
        }
    }
    Ok(found)
}

struct Entries<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    first: usize,
    end: usize,
}

#[derive(Default)]
struct Counts {
    full: u64,
    partial: u64,
    branches: u64,
}

impl Counts {
    #[inline(always)]
    fn add(&mut self, planes: Planes) {
        self.full += u64::from(planes.full().count_ones());
        self.partial += u64::from(planes.partial().count_ones());
        self.branches += u64::from(planes.branch().count_ones());
    }
}

impl Hot for Entries<'_, '_> {
    type Output = Counts;

    #[inline(always)]
    fn run(self) -> Counts {
        let Entries { tree, first, end } = self;
        let mut counts = Counts::default();
        match tree.planes.get(first..end) {
            Some(elements) => elements.iter().for_each(|&planes| counts.add(planes)),
            // A damaged brick reads as undecided.
            None => (first..end)
                .for_each(|index| counts.add(tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial)))),
        }
        counts
    }
}
