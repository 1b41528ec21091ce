//! The inside bits of voxels, block by block.

use super::value::{Limits, Value};
use super::{Samples, VoxelGrid};
use crate::lattice::Each;
use crate::lattice::morton;

/// The samples of a grid, and the values that are inside.
#[derive(Debug, Clone)]
pub(super) struct Field<'a> {
    pub(super) grid: VoxelGrid,
    pub(super) samples: Samples<'a>,
    pub(super) limits: Limits,
}

impl Field<'_> {
    /// The inside bits of the 4³ voxels of the block `at` (in blocks), in Morton order. Voxels beyond the
    /// grid are outside.
    pub(super) fn brick(&self, at: [u32; 3]) -> u64 {
        match &self.samples {
            Samples::Bits(words) => self.brick_of_bits(words.values(), at),
            Samples::U8(values) => self.brick_of(values.values(), at),
            Samples::U16(values) => self.brick_of(values.values(), at),
            Samples::I16(values) => self.brick_of(values.values(), at),
            Samples::F32(values) => self.brick_of(values.values(), at),
        }
    }

    /// Returns whether the voxel at a place is inside. A voxel beyond the grid is outside.
    pub(super) fn contains(&self, at: [u32; 3]) -> bool {
        self.samples.get(&self.grid, at).is_some_and(|value| self.limits.contains(value))
    }

    /// Calls `row` for each row of voxels in a block, with the index of the row among all rows, and with its
    /// y and z in the block.
    #[inline(always)]
    fn rows(&self, at: [u32; 3], mut row: impl FnMut(usize, u32, u32)) {
        let [_, ny, nz] = self.grid.extents();
        let [_, y, z] = at.each(|a| 4 * a);
        for k in 0..4.min(nz.saturating_sub(z)) {
            for j in 0..4.min(ny.saturating_sub(y)) {
                row((z + k) as usize * ny as usize + (y + j) as usize, j, k);
            }
        }
    }

    #[inline(always)]
    fn brick_of<T: Value>(&self, values: &[T], at: [u32; 3]) -> u64 {
        let [low, high] = self.limits.of::<T>();
        let (nx, x) = (self.grid.extents()[0] as usize, 4 * at[0] as usize);
        let width = 4.min(nx.saturating_sub(x));
        let mut brick = 0;
        self.rows(at, |row, j, k| {
            let first = row * nx + x;
            let bit = |value: T, i: usize| u32::from((low <= value) & (value <= high)) << i;
            let nibble = match values.get(first..first + width) {
                Some(&[a, b, c, d]) => bit(a, 0) | bit(b, 1) | bit(c, 2) | bit(d, 3),
                Some(few) => few.iter().enumerate().fold(0, |bits, (i, &value)| bits | bit(value, i)),
                None => 0,
            };
            brick |= spread(nibble.into()) << morton::index(0, j, k);
        });
        brick
    }

    fn brick_of_bits(&self, words: &[u64], at: [u32; 3]) -> u64 {
        let (nx, x) = (self.grid.extents()[0], 4 * at[0]);
        let real = (1u64 << 4.min(nx.saturating_sub(x))) - 1;
        let mut brick = 0;
        self.rows(at, |row, j, k| {
            let word = words.get(row * self.grid.words() + x as usize / 64).copied().unwrap_or(0);
            let nibble = self.limits.word(word) >> (x % 64) & real;
            brick |= spread(nibble) << morton::index(0, j, k);
        });
        brick
    }
}

/// Spreads four bits along x to their places in Morton order.
#[inline(always)]
pub(super) fn spread(nibble: u64) -> u64 {
    nibble & 3 | (nibble & 12) << 6
}
