//! Boxes of cells as bits: rows along x, each of whole words.

use crate::error::Error;
use crate::lattice::axes;
use crate::memory;
use alloc::vec::Vec;

/// Which cells of a box count.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Bits {
    /// Cells along the axes.
    pub(super) size: [usize; 3],
    /// Words in a row.
    pub(super) words: usize,
    pub(super) bits: Vec<u64>,
}

/// Cells in a row that all count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Run {
    pub(super) z: u32,
    pub(super) y: u32,
    pub(super) x: u32,
    pub(super) length: u32,
}

impl Bits {
    pub(super) fn new(size: [usize; 3]) -> Result<Bits, Error> {
        let words = size[0].div_ceil(64);
        Ok(Bits { size, words, bits: memory::filled(words * size[1] * size[2], 0)? })
    }

    pub(super) fn row(&self, y: usize, z: usize) -> usize {
        self.words * (y + self.size[1] * z)
    }

    #[cfg(test)]
    pub(super) fn has(&self, [x, y, z]: [usize; 3]) -> bool {
        self.bits[self.row(y, z) + x / 64] >> (x % 64) & 1 != 0
    }

    pub(super) fn set(&mut self, [x, y, z]: [usize; 3]) {
        let row = self.row(y, z);
        self.bits[row + x / 64] |= 1 << (x % 64);
    }

    /// Those from `from` up to `to` in a row.
    pub(super) fn set_row(&mut self, from: usize, to: usize, y: usize, z: usize) {
        if from >= to {
            return;
        }
        let row = self.row(y, z);
        for word in from / 64..to.div_ceil(64) {
            let low = from.saturating_sub(64 * word);
            let high = (to - 64 * word).min(64);
            self.bits[row + word] |= (u64::MAX >> (64 - (high - low))) << low;
        }
    }

    pub(super) fn count(&self) -> u64 {
        self.bits.iter().map(|word| u64::from(word.count_ones())).sum()
    }

    /// All cells, by rows.
    pub(super) fn runs(&self) -> Result<Vec<Run>, Error> {
        let mut runs = Vec::new();
        for z in 0..self.size[2] {
            for y in 0..self.size[1] {
                self.runs_of(y, z, |x, length| {
                    let run = Run { z: z as u32, y: y as u32, x: x as u32, length: length as u32 };
                    memory::push(&mut runs, run)
                })?;
            }
        }
        Ok(runs)
    }

    /// The runs of one row: where each begins, and its length.
    pub(super) fn runs_of(
        &self,
        y: usize,
        z: usize,
        mut take: impl FnMut(usize, usize) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let row = &self.bits[self.row(y, z)..][..self.words];
        let mut at = 0;
        while let Some(start) = next(row, at, false) {
            let end = next(row, start, true).unwrap_or(64 * self.words).min(self.size[0]);
            take(start, end - start)?;
            at = end;
        }
        Ok(())
    }

    /// Cells turned: cell `p` of the result is the one at `order` and `flip` of this, axis by axis: the coordinate along axis i is the one
    /// along axis `order[i]` of this, counted from the other end if `flip[i]`.
    pub(super) fn turned(&self, order: [usize; 3], flip: [bool; 3]) -> Result<Bits, Error> {
        let mut turned = Bits::new(order.map(|axis| self.size[axis]))?;
        for z in 0..self.size[2] {
            for y in 0..self.size[1] {
                self.runs_of(y, z, |x, length| {
                    for x in x..x + length {
                        let own = [x, y, z];
                        turned.set(axes(|i| {
                            let at = own[order[i]];
                            if flip[i] { self.size[order[i]] - 1 - at } else { at }
                        }));
                    }
                    Ok(())
                })?;
            }
        }
        Ok(turned)
    }

    /// Cells `factor` times as large that hold some of these, which begin `beyond` the lower corner of the first.
    pub(super) fn coarser(&self, factor: usize, beyond: [usize; 3]) -> Result<Bits, Error> {
        let mut coarse = Bits::new(axes(|k| (self.size[k] + beyond[k]).div_ceil(factor)))?;
        for z in 0..self.size[2] {
            for y in 0..self.size[1] {
                self.runs_of(y, z, |x, length| {
                    let from = x + beyond[0];
                    let to = (from + length - 1) / factor + 1;
                    coarse.set_row(from / factor, to, (y + beyond[1]) / factor, (z + beyond[2]) / factor);
                    Ok(())
                })?;
            }
        }
        Ok(coarse)
    }

    /// All cells that are nearer than `distance` cells to one of these, in a box that is larger by `pad` at every end, which is to be no
    /// less than the distance.
    pub(super) fn grown(&self, distance: f64, pad: usize) -> Result<Bits, Error> {
        let mut grown = Bits::new(self.size.map(|size| size + 2 * pad))?;
        let reach = pad as isize;
        // How far a row reaches along x that is so far away in the other two directions.
        let between = |steps: isize| {
            let cells = steps.unsigned_abs().saturating_sub(1) as f64;
            cells * cells
        };
        let mut shifts = Vec::new();
        for dz in -reach..=reach {
            for dy in -reach..=reach {
                let beside = between(dy) + between(dz);
                let widths = (0..=reach).rev();
                let mut widest = widths.filter(|&dx| beside + between(dx) < distance * distance);
                if let Some(dx) = widest.next() {
                    memory::push(&mut shifts, (dz, dy, dx as usize))?;
                }
            }
        }
        for z in 0..self.size[2] {
            for y in 0..self.size[1] {
                self.runs_of(y, z, |x, length| {
                    for &(dz, dy, dx) in &shifts {
                        let (y, z) = ((y + pad).wrapping_add_signed(dy), (z + pad).wrapping_add_signed(dz));
                        grown.set_row(x + pad - dx, x + length + pad + dx, y, z);
                    }
                    Ok(())
                })?;
            }
        }
        Ok(grown)
    }
}

/// The next bit from `at` on that is set, or that is not.
fn next(row: &[u64], at: usize, clear: bool) -> Option<usize> {
    let mut word = at / 64;
    let mut mask = u64::MAX << (at % 64);
    while word < row.len() {
        let found = (if clear { !row[word] } else { row[word] }) & mask;
        if found != 0 {
            return Some(64 * word + found.trailing_zeros() as usize);
        }
        (word, mask) = (word + 1, u64::MAX);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::super::super::random::Random;
    use super::*;

    fn any(size: [usize; 3], random: &mut Random) -> Bits {
        let mut bits = Bits::new(size).unwrap();
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    if random.below(4) == 0 {
                        bits.set([x, y, z]);
                    }
                }
            }
        }
        bits
    }

    fn cells(bits: &Bits) -> Vec<[usize; 3]> {
        let mut all = Vec::new();
        for z in 0..bits.size[2] {
            for y in 0..bits.size[1] {
                all.extend((0..bits.size[0]).map(|x| [x, y, z]).filter(|&cell| bits.has(cell)));
            }
        }
        all
    }

    #[test]
    fn runs_are_the_cells() {
        let mut random = Random::new(1);
        for size in [[1, 1, 1], [64, 2, 3], [65, 3, 2], [130, 4, 4]] {
            let bits = any(size, &mut random);
            let mut again = Bits::new(size).unwrap();
            for run in bits.runs().unwrap() {
                let (from, to) = (run.x as usize, (run.x + run.length) as usize);
                again.set_row(from, to, run.y as usize, run.z as usize);
            }
            assert_eq!(again, bits);
            assert_eq!(cells(&bits).len() as u64, bits.count());
        }
    }

    #[test]
    fn cells_grow_and_turn() {
        let mut random = Random::new(2);
        let bits = any([70, 6, 5], &mut random);
        let near = |a: usize, b: usize| a.abs_diff(b).saturating_sub(1) as f64;
        for distance in [0.5, 1.0, 1.5, 2.3] {
            let pad = 3;
            let grown = bits.grown(distance, pad).unwrap();
            for z in 0..grown.size[2] {
                for y in 0..grown.size[1] {
                    for x in 0..grown.size[0] {
                        let is_near = cells(&bits).iter().any(|cell| {
                            let gap = |k: usize, at: usize| near(cell[k] + pad, at).powi(2);
                            gap(0, x) + gap(1, y) + gap(2, z) < distance * distance
                        });
                        assert_eq!(grown.has([x, y, z]), is_near);
                    }
                }
            }
        }
        let turned = bits.turned([2, 0, 1], [true, false, false]).unwrap();
        assert_eq!(turned.size, [5, 70, 6]);
        assert!(cells(&turned).iter().all(|&[x, y, z]| bits.has([y, z, 4 - x])));
        assert_eq!(turned.count(), bits.count());
        let coarse = bits.coarser(4, [2; 3]).unwrap();
        assert_eq!(coarse.size, [18, 2, 2]);
        for cell in cells(&bits) {
            assert!(coarse.has(cell.map(|c| (c + 2) / 4)));
        }
    }
}
