//! The bodies of the fuzz targets, and the mutations of their inputs. The test suite includes these files,
//! too.
#![allow(dead_code, unused_imports)]

mod aligned;
mod channels;
mod dexels;
pub mod layout;
mod measured_trees;
pub mod meshes;
mod mutator;
mod queries;
pub mod seeds;
mod set_algebra;
mod ways_in;

pub use aligned::Aligned;
pub use channels::channels;
pub use dexels::dexels_in_all_ways;
pub use measured_trees::ask_measures;
pub use mutator::{changed, mutate_file, mutate_pair, repairs};
pub use queries::queries;
pub use set_algebra::{set_algebra, threads};
pub use ways_in::{read_in_all_ways, ways_in};

use leafless::octree::Cursor;
use leafless::{Control, Tag};

/// One thread, as for most work of this size.
pub const CONTROL: Control<'static> =
    Control { threads: 1, max_nodes: None, max_bytes: None, max_splits: None, cancel: None, progress: None };

/// Pseudo-random numbers (splitmix64). A seed gives the same numbers everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut x = self.0;
        x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ x >> 31
    }

    /// Returns a number below `end`; 0 if `end` is 0.
    pub fn below(&mut self, end: usize) -> usize {
        if end == 0 { 0 } else { (self.next() % end as u64) as usize }
    }

    /// True once in `n` times.
    pub fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
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
