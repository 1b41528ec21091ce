//! The blocks of cells that contain centres inside. Algorithms that visit all such centres skip the other
//! blocks.

use super::centres::BLOCK;
use super::place::{Place, Span};
use super::view::{OTHERS, RowsRef, TriDexelRef, with_rows};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// Blocks of 64³ cells that contain centres inside, by the rays that decide about centres.
pub(crate) struct Occupied {
    /// The Morton codes of the blocks, ascending.
    codes: Vec<u64>,
    /// The number of levels of the lattice of blocks.
    levels: u8,
}

impl Occupied {
    /// Finds the blocks of a model that was checked. A lattice of fewer cells is one block.
    ///
    /// O(rays of the window + intervals · 2^depth / 4096 + b log b) for b blocks.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn of(model: &TriDexelRef<'_>) -> Result<Occupied, Error> {
        let depth = model.frame().depth();
        let mut occupied =
            Occupied { codes: Vec::new(), levels: depth.saturating_sub(BLOCK.trailing_zeros() as u8) };
        if let Some((axis, rows)) = model.deciding() {
            with_rows!(rows, rows => occupied.add(rows, axis, depth))?;
            occupied.codes.sort_unstable();
        }
        Ok(occupied)
    }

    fn add<S: Span>(&mut self, rows: &RowsRef<'_, S>, axis: usize, depth: u8) -> Result<(), Error> {
        let mut along: Vec<u64> = memory::filled((1usize << self.levels).div_ceil(64), 0)?;
        let [us, vs] = [rows.window.range(0), rows.window.range(1)];
        let tiles = |range: &Range<u32>| range.start / BLOCK..range.end.div_ceil(BLOCK);
        for tile_v in tiles(&vs) {
            for tile_u in tiles(&us) {
                let within = |tile: u32, range: &Range<u32>| {
                    range.start.max(tile * BLOCK)..range.end.min((tile + 1) * BLOCK)
                };
                let (columns, mut any) = (within(tile_u, &us), false);
                for v in within(tile_v, &vs) {
                    // The intervals of all these rays are contiguous.
                    let Some(first) = rows.window.index([columns.start, v]) else { continue };
                    let spans = rows.starts[first] as usize..rows.starts[first + columns.len()] as usize;
                    for span in &rows.columns.spans[spans] {
                        let [start, end] = span.ends().each(|end| end.gap(depth));
                        if start < end {
                            any = true;
                            set(&mut along, start / BLOCK, (end - 1) / BLOCK);
                        }
                    }
                }
                if any {
                    self.take(&mut along, [tile_u, tile_v], axis)?;
                }
            }
        }
        Ok(())
    }

    /// Adds the blocks of a tile of rays.
    fn take(&mut self, along: &mut [u64], tile: [u32; 2], axis: usize) -> Result<(), Error> {
        let [u, v] = OTHERS[axis];
        for (first, word) in (0..).step_by(64).zip(along) {
            let mut rest = core::mem::take(word);
            while rest != 0 {
                let mut block = [0; 3];
                (block[axis], block[u], block[v]) = (first + rest.trailing_zeros(), tile[0], tile[1]);
                memory::push(&mut self.codes, code(block))?;
                rest &= rest - 1;
            }
        }
        Ok(())
    }

    /// Returns all blocks, by their places in the lattice of blocks.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn blocks(&self) -> Result<Vec<[u32; 3]>, Error> {
        memory::collected(self.codes.iter().map(|&code| place(code)))
    }

    /// Returns whether a centre in a cell of a level, 0 to that of blocks, lies inside.
    pub fn meets(&self, level: u8, at: [u32; 3]) -> bool {
        let shift = 3 * u32::from(self.levels.saturating_sub(level));
        let first = code(at) << shift;
        let next = self.codes.partition_point(|&code| code < first);
        self.codes.get(next).is_some_and(|code| code >> shift == first >> shift)
    }
}

/// Sets bits `first` to `last`.
fn set(words: &mut [u64], first: u32, last: u32) {
    let (low, high) = (first as usize / 64, last as usize / 64);
    let (from, to) = (!0 << (first % 64), !0 >> (63 - last % 64));
    if low == high {
        words[low] |= from & to;
        return;
    }
    words[low] |= from;
    words[low + 1..high].fill(!0);
    words[high] |= to;
}

/// Interleaves the bits of three numbers below 2^21; those of x are the lowest.
fn code(at: [u32; 3]) -> u64 {
    let spread = |x: u32| {
        let x = u64::from(x);
        let x = (x | x << 32) & 0x001F_0000_0000_FFFF;
        let x = (x | x << 16) & 0x001F_0000_FF00_00FF;
        let x = (x | x << 8) & 0x100F_00F0_0F00_F00F;
        let x = (x | x << 4) & 0x10C3_0C30_C30C_30C3;
        (x | x << 2) & 0x1249_2492_4924_9249
    };
    spread(at[0]) | spread(at[1]) << 1 | spread(at[2]) << 2
}

/// The three numbers of a code.
fn place(code: u64) -> [u32; 3] {
    let gather = |x: u64| {
        let x = x & 0x1249_2492_4924_9249;
        let x = (x | x >> 2) & 0x10C3_0C30_C30C_30C3;
        let x = (x | x >> 4) & 0x100F_00F0_0F00_F00F;
        let x = (x | x >> 8) & 0x001F_0000_FF00_00FF;
        let x = (x | x >> 16) & 0x001F_0000_0000_FFFF;
        ((x | x >> 32) & 0x001F_FFFF) as u32
    };
    [gather(code), gather(code >> 1), gather(code >> 2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;
    use crate::dexel::{Dexel, DexelEnd, DexelFormat, TriDexel};
    use crate::lattice::Frame;

    #[test]
    fn codes_take_bits_in_turn() {
        for at in [[1, 0, 0], [0, 1 << 13, 0], [0x3FFF, 0x2AAA, 0x1555], [0x1F_FFFF; 3]] {
            let expected = (0..21)
                .flat_map(|bit| (0..3).map(move |axis| (3 * bit + axis, at[axis as usize] >> bit & 1)));
            let expected: u64 = expected.map(|(place, bit)| u64::from(bit) << place).sum();
            assert_eq!(code(at), expected);
            assert_eq!(place(expected), at);
        }
    }

    #[test]
    fn cells_with_inside_centres_are_met_and_no_others() {
        let frame = Frame::new([0.0; 3], 512.0, 9).unwrap();
        let mut state = 5u32;
        let mut random = move |below: u32| {
            state = state.wrapping_mul(1664525).wrapping_add(1013904223);
            (state >> 8) % below
        };
        for axis in 0..3 {
            let mut list: Vec<([u32; 2], f64, f64)> = (0..6)
                .map(|_| {
                    let start = f64::from(random(500)) + 0.25 * f64::from(random(4));
                    let length = [0.2, 1.0, 100.0][random(3) as usize];
                    ([random(512), random(512)], start, start + length)
                })
                .collect();
            list.sort_by_key(|(ray, ..)| *ray);
            list.dedup_by_key(|(ray, ..)| *ray);
            let rays = |_: usize, ray: [u32; 2], to: &mut Vec<Dexel>| {
                for &(_, start, end) in list.iter().filter(|(of, ..)| *of == ray) {
                    to.push(Dexel { start: DexelEnd::new(start), end: DexelEnd::new(end), material: 0 });
                }
                Ok(())
            };
            let directions = [0, 1, 2].map(|a| a == axis);
            let control = Control::default();
            let model =
                TriDexel::from_rays(&frame, DexelFormat::default(), directions, rays, &control).unwrap();
            let occupied = Occupied::of(model.view()).unwrap();
            for level in 0..=3u8 {
                let size = 512u32 >> level;
                for i in 0..1u32 << (3 * level) {
                    let at = [0, 1, 2].map(|a| i >> (a * u32::from(level)) & ((1 << level) - 1));
                    let holds = list.iter().any(|&([u, v], start, end)| {
                        let first = (start - 0.5).ceil() as u32;
                        let end = (end - 0.5).ceil() as u32;
                        let range = at[axis] * size..(at[axis] + 1) * size;
                        let others = OTHERS[axis].map(|a| at[a]);
                        [u / size, v / size] == others && first.max(range.start) < end.min(range.end)
                    });
                    assert_eq!(occupied.meets(level, at), holds);
                }
            }
        }
    }
}
