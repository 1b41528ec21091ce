//! Boxes of cells as bits: rows along x, each of whole words.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use alloc::vec::Vec;

/// A set of cells in a box.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Bits {
    /// Number of cells along the axes.
    pub(super) size: [usize; 3],
    /// Number of words in a row.
    pub(super) words: usize,
    pub(super) bits: Vec<u64>,
}

/// Successive cells of the set in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Run {
    pub(super) z: u32,
    pub(super) y: u32,
    pub(super) x: u32,
    pub(super) length: u32,
}

impl Bits {
    /// The memory of a box of cells, in bytes.
    pub(super) fn bytes(size: [usize; 3]) -> u64 {
        let rows = (size[1] as u64).saturating_mul(size[2] as u64);
        rows.saturating_mul(8 * size[0].div_ceil(64) as u64)
    }

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

    /// Adds the cells of a row from `from` up to, but not including, `to`.
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

    /// Returns all cells of the set, by rows.
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

    /// Passes the runs of one row to `take`: the start of each run, and its length.
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

    /// Returns the turned cells. The coordinate along axis i of the result is the coordinate along axis
    /// `order[i]` of this set, counted from the other end if `flip[i]`.
    pub(super) fn turned(&self, order: [usize; 3], flip: [bool; 3]) -> Result<Bits, Error> {
        let mut turned = Bits::new(order.each(|axis| self.size[axis]))?;
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

    /// Returns the cells `factor` times as large that contain cells of this set. The first large cell begins
    /// `beyond` small cells below the lower corner.
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

    /// Returns all cells nearer than `distance` cells to a cell of this set, in a box that is larger by `pad`
    /// at every end. `pad` must be at least the distance.
    pub(super) fn grown(&self, distance: f64, pad: usize) -> Result<Bits, Error> {
        let mut grown = Bits::new(self.size.each(|size| size + 2 * pad))?;
        let reach = pad as isize;
        // The square of the gap, in cells, between rows that are `steps` apart in one direction.
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

    /// Returns all cells nearer than `distance` (any number, in cells) to a cell of this set, and some that
    /// are slightly further away. The cells of the result may be larger. The result also contains their edge
    /// in present cells, and the number of present cells, along each axis, by which the result begins below
    /// the present set.
    pub(super) fn grown_far(&self, distance: f64) -> Result<(Bits, usize, usize), Error> {
        let scale = scale_for(distance);
        let reach = distance / scale as f64;
        let pad = libm::ceil(reach) as usize;
        Ok((self.coarser(scale, [0; 3])?.grown(reach, pad)?, scale, pad * scale))
    }
}

/// The greatest distance, in cells, by which cells are grown. For longer distances larger cells are grown.
/// This adds no more than a sixth of the distance, and avoids work that rises with the square of the
/// distance.
pub(super) const REACH: f64 = 12.0;

/// Returns the number of cells along each axis to join, so that a distance of `reach` cells is no longer than
/// [`REACH`] of the joined cells.
pub(super) fn scale_for(reach: f64) -> usize {
    let mut scale = 1;
    while reach > REACH * scale as f64 {
        scale *= 2;
    }
    scale
}

/// Returns the next bit from `at` on that is set, or that is clear.
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

    #[test]
    fn what_grows_far_holds_all_that_is_near() {
        let mut random = Random::new(41);
        for distance in [0.5, 11.0, 13.0, 30.0] {
            let mut bits = Bits::new([9, 7, 8]).unwrap();
            (0..3).for_each(|_| bits.set([random.below(9), random.below(7), random.below(8)]));
            let (grown, scale, below) = bits.grown_far(distance).unwrap();
            assert!(distance / scale as f64 <= REACH, "{scale}");
            let pad = distance as usize + 1;
            let near = bits.grown(distance, pad).unwrap();
            let far = bits.grown(1.25 * distance + 2.0, 2 * pad + 2).unwrap();
            let taken = |at: [isize; 3]| {
                let own = at.map(|at| (at + below as isize).div_euclid(scale as isize));
                (0..3).all(|k| (0..grown.size[k] as isize).contains(&own[k]))
                    && grown.has(own.map(|own| own as usize))
            };
            let end = 2 * pad as isize;
            for z in -end..8 + end {
                for y in -end..7 + end {
                    for x in -end..9 + end {
                        let at = |bits: &Bits, pad: usize| {
                            let own = [x, y, z].map(|at| at + pad as isize);
                            (0..3).all(|k| (0..bits.size[k] as isize).contains(&own[k]))
                                && bits.has(own.map(|own| own as usize))
                        };
                        let is_taken = taken([x, y, z]);
                        assert!(is_taken || !at(&near, pad), "{distance} {x} {y} {z}");
                        assert!(!is_taken || at(&far, 2 * pad + 2), "{distance} {x} {y} {z}");
                    }
                }
            }
        }
    }
}
