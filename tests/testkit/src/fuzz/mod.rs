//! The bodies of the fuzz targets, and the mutations of their inputs.

mod attributes;
mod channels;
mod contacts;
mod csg;
pub mod dexel_algebra;
mod dexels;
mod direct;
pub mod layout;
mod layouts;
mod measured_trees;
mod measures;
pub mod meshes;
mod mutator;
pub mod packages;
mod queries;
mod records;
pub mod scenes;
pub mod seeds;
mod set_algebra;
mod surfaces;
pub mod volumes;
mod ways_in;

pub use attributes::attributes;
pub use contacts::contacts;
pub use csg::csg;
pub use direct::{direct, layers};
pub use layouts::layouts;
pub use measures::measures;
pub use mutator::{changed, mutate_file, mutate_pair, repairs};
pub use queries::queries;
pub use records::records;
pub use set_algebra::{set_algebra, threads};
pub use surfaces::{boundaries, contours};
pub use ways_in::{read_in_all_ways, ways_in};

use channels::channels;
use dexels::dexels_in_all_ways;
use leafless::octree::Cursor;
use leafless::{Control, Tag};
use measured_trees::ask_measures;

/// One thread, as for most work of this size.
pub const CONTROL: Control<'static> =
    Control { threads: 1, max_nodes: None, max_bytes: None, max_splits: None, cancel: None, progress: None };

/// The remaining bytes of an input; 0 for each missing one.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> usize {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first.into()
    }

    fn below(&mut self, end: usize) -> usize {
        self.byte() % end
    }

    /// Returns an integer between −`end` and `end`.
    fn around(&mut self, end: usize) -> f64 {
        self.below(2 * end + 1) as f64 - end as f64
    }
}

/// Splits an input of two parts: the length of the first part in four bytes, the first, the second.
pub fn halves(data: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = data.split_first_chunk::<4>()?;
    rest.split_at_checked(u32::from_le_bytes(*length) as usize)
}

/// Returns the input with these [`halves`].
pub fn joined(first: &[u8], second: &[u8]) -> Vec<u8> {
    [&(first.len() as u32).to_le_bytes()[..], first, second].concat()
}

/// The findings of a walk over all cells.
pub struct Walked {
    /// Number of cells that the cursor visited.
    pub steps: u64,
    /// Numbers of EMPTY, BRANCH, PARTIAL and FULL cells per level.
    pub cells: [[u64; 4]; 21],
}

/// Walks over the whole tree, octants in ascending order.
pub fn walk(mut cursor: Cursor<'_>) -> Walked {
    let mut walked = Walked { steps: 0, cells: [[0; 4]; 21] };
    // The octant that comes next on each level.
    let mut next = vec![0u8];
    let mut note = |cursor: &Cursor<'_>| {
        walked.steps += 1;
        walked.cells[cursor.cell().level as usize][cursor.tag() as usize] += 1;
    };
    note(&cursor);
    while let Some(octant) = next.pop() {
        if cursor.tag() == Tag::Branch && octant < 8 {
            assert!(cursor.descend(octant) && cursor.node().is_some() == (cursor.tag() == Tag::Branch));
            note(&cursor);
            next.extend([octant + 1, 0]);
        } else {
            assert_eq!(cursor.ascend(), !next.is_empty());
        }
    }
    walked
}
