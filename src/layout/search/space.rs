//! The places of shapes of cells among taken cells.
//!
//! A shape is a list of runs along x. The places where a run of length 2^k meets a taken cell are known all
//! at once, if each bit has been joined with those up to 2^k − 1 cells further on. Any other run is the union
//! of two overlapping runs of such lengths. A run thus takes two shifts for 64 places, and the runs of the
//! shape determine the places of a layer, without transforms or rounding. (Fourier transforms find all places
//! of all layers: Cui, Rong, Chen & Matusik 2023. Searching for the lowest layer with a place takes less
//! time. Cells that are taken later never free a place, so that no layer is visited again.)

use super::bits::{Bits, Run};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// The taken cells of the search.
pub(super) struct Space {
    size: [usize; 3],
    words: usize,
    /// For each k, the cells that have a taken cell among the 2^k cells from them on.
    joined: Vec<Vec<u64>>,
}

/// The places of a layer: a bit is set where the shape does not fit.
#[derive(Debug, Default)]
pub(super) struct Layer {
    bits: Vec<u64>,
    words: usize,
    rows: usize,
}

/// A shape to place.
pub(super) struct Shape {
    pub(super) size: [usize; 3],
    pub(super) runs: Vec<Run>,
}

impl Shape {
    pub(super) fn new(bits: &Bits) -> Result<Shape, Error> {
        Ok(Shape { size: bits.size, runs: bits.runs()? })
    }
}

/// The cells around a shape: runs, relative to one cell below the shape's lower corner, and the number of
/// cells.
pub(super) struct Halo {
    runs: Vec<Run>,
    count: u32,
}

impl Halo {
    pub(super) fn of(bits: &Bits) -> Result<Halo, Error> {
        let mut around = bits.grown(0.5, 1)?;
        for run in bits.runs()? {
            let row = around.row(run.y as usize + 1, run.z as usize + 1);
            for x in run.x as usize + 1..(run.x + run.length) as usize + 1 {
                around.bits[row + x / 64] &= !(1 << (x % 64));
            }
        }
        Ok(Halo { runs: around.runs()?, count: around.count() as u32 })
    }

    /// The memory of the runs, in bytes.
    pub(super) fn bytes(&self) -> usize {
        memory::bytes_of(&self.runs)
    }
}

impl Space {
    /// Returns the part of the cells around a shape that are taken, or beyond the sides or the floor.
    pub(super) fn contact(&self, halo: &Halo, at: [usize; 3]) -> f64 {
        let mut count = 0;
        let size = self.size.each(|size| size as isize);
        for run in &halo.runs {
            let y = (at[1] + run.y as usize) as isize - 1;
            let z = (at[2] + run.z as usize) as isize - 1;
            if y < 0 || y >= size[1] || z < 0 {
                count += run.length;
                continue;
            }
            if z >= size[2] {
                continue;
            }
            let from = (at[0] + run.x as usize) as isize - 1;
            let to = from + run.length as isize;
            let (first, last) = (from.max(0) as usize, to.min(size[0]) as usize);
            if first >= last {
                count += run.length;
                continue;
            }
            count += run.length - (last - first) as u32;
            let row = self.words * (y + size[1] * z) as usize;
            for word in first / 64..last.div_ceil(64) {
                let low = first.saturating_sub(64 * word);
                let high = (last - 64 * word).min(64);
                let mask = (u64::MAX >> (64 - (high - low))) << low;
                count += (self.joined[0][row + word] & mask).count_ones();
            }
        }
        f64::from(count) / f64::from(halo.count.max(1))
    }

    /// Builds a space without taken cells. No shape may have a run longer than `longest`, which is not 0.
    pub(super) fn new(size: [usize; 3], longest: usize) -> Result<Space, Error> {
        let words = size[0].div_ceil(64);
        // (Reading continues beyond the end of a row.)
        let count = words * size[1] * size[2] + words + 2;
        let mut joined = Vec::new();
        for _ in 0..=longest.ilog2() {
            memory::push(&mut joined, memory::filled(count, 0)?)?;
        }
        Ok(Space { size, words, joined })
    }

    /// Copies the space.
    pub(super) fn try_clone(&self) -> Result<Space, Error> {
        let mut joined = memory::with_capacity(self.joined.len())?;
        for list in &self.joined {
            joined.push(memory::copied(list)?);
        }
        Ok(Space { size: self.size, words: self.words, joined })
    }

    pub(super) fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Takes the cells of a row from `from` up to `to`, which may lie beyond the row's ends.
    pub(super) fn take_row(&mut self, from: isize, to: isize, y: usize, z: usize) {
        let (from, to) = (from.max(0) as usize, to.clamp(0, self.size[0] as isize) as usize);
        if from >= to {
            return;
        }
        let row = self.words * (y + self.size[1] * z);
        for (k, joined) in self.joined.iter_mut().enumerate() {
            let from = (from + 1).saturating_sub(1 << k);
            for word in from / 64..to.div_ceil(64) {
                let low = from.saturating_sub(64 * word);
                let high = (to - 64 * word).min(64);
                joined[row + word] |= (u64::MAX >> (64 - (high - low))) << low;
            }
        }
    }

    /// Takes cells at an offset. Each of them is as large as `scale` cells of the space along each axis. If
    /// `shade` is an axis and a sense, all cells beyond them in that direction are taken, too.
    pub(super) fn take(
        &mut self,
        cells: &Bits,
        scale: usize,
        offset: [isize; 3],
        shade: Option<(usize, bool)>,
    ) -> Result<(), Error> {
        let [nx, ny, nz] = self.size.each(|size| size as isize);
        let size = scale as isize;
        for z in 0..cells.size[2] {
            for y in 0..cells.size[1] {
                let (wy, wz) = (size * y as isize + offset[1], size * z as isize + offset[2]);
                let beyond = |at: isize, end: isize, axis: usize| match shade {
                    Some((own, upward)) if own == axis => {
                        if upward {
                            at.max(0)..end
                        } else {
                            0..(at + size).clamp(0, end)
                        }
                    }
                    _ => at.max(0)..(at + size).clamp(0, end),
                };
                cells.runs_of(y, z, |x, length| {
                    let mut from = size * x as isize + offset[0];
                    let mut to = from + size * length as isize;
                    match shade {
                        Some((0, true)) => to = nx,
                        Some((0, false)) => from = 0,
                        _ => {}
                    }
                    for wz in beyond(wz, nz, 2) {
                        for wy in beyond(wy, ny, 1) {
                            self.take_row(from, to, wy as usize, wz as usize);
                        }
                    }
                    Ok(())
                })?;
            }
        }
        Ok(())
    }

    /// Finds the places in layer `z` where a shape does not fit. The shape must be no larger than the space.
    /// Returns `false` if the shape fits nowhere.
    pub(super) fn layer(&self, shape: &Shape, z: usize, layer: &mut Layer) -> Result<bool, Error> {
        let rows = self.size[1] - shape.size[1] + 1;
        let words = self.words;
        layer.bits.clear();
        layer.bits.try_reserve(rows * words)?;
        // The bits of places along x at which the shape would stick out.
        let places = self.size[0] - shape.size[0] + 1;
        for _ in 0..rows {
            for word in 0..words {
                let within = places.saturating_sub(64 * word).min(64);
                layer.bits.push(if within == 0 { !0 } else { !(u64::MAX >> (64 - within)) });
            }
        }
        (layer.words, layer.rows) = (words, rows);
        let mut last = 0;
        for run in &shape.runs {
            if run.z != last {
                last = run.z;
                if layer.bits.iter().all(|&word| word == !0) {
                    return Ok(false);
                }
            }
            let k = run.length.ilog2();
            let joined = &self.joined[k as usize];
            let row = words * (run.y as usize + self.size[1] * (z + run.z as usize));
            let mut shift = |x: usize| {
                let from = &joined[row + x / 64..][..rows * words + 1];
                let by = x % 64;
                if by == 0 {
                    for (to, &word) in layer.bits.iter_mut().zip(from) {
                        *to |= word;
                    }
                } else {
                    for (to, pair) in layer.bits.iter_mut().zip(from.windows(2)) {
                        *to |= pair[0] >> by | pair[1] << (64 - by);
                    }
                }
            };
            let x = run.x as usize;
            shift(x);
            let rest = run.length as usize - (1 << k);
            if rest > 0 {
                shift(x + rest);
            }
        }
        Ok(layer.bits.iter().any(|&word| word != !0))
    }
}

impl Layer {
    /// Returns the places where the shape fits, but not one step further on some side along x, nor one step
    /// further on some side along y.
    pub(super) fn corners(&self) -> impl Iterator<Item = [usize; 2]> {
        let is_taken = move |x: isize, y: isize| {
            if x < 0 || y < 0 || y as usize >= self.rows || x as usize >= 64 * self.words {
                return true;
            }
            self.bits[self.words * y as usize + x as usize / 64] >> (x % 64) & 1 != 0
        };
        self.places().filter(move |&[x, y]| {
            let (x, y) = (x as isize, y as isize);
            (is_taken(x - 1, y) || is_taken(x + 1, y)) && (is_taken(x, y - 1) || is_taken(x, y + 1))
        })
    }

    /// Returns the places where the shape fits, by y and then by x.
    pub(super) fn places(&self) -> impl Iterator<Item = [usize; 2]> {
        (0..self.rows).flat_map(move |y| {
            let row = &self.bits[self.words * y..][..self.words];
            row.iter().enumerate().flat_map(move |(k, &word)| {
                let mut left = !word;
                core::iter::from_fn(move || {
                    let bit = (left != 0).then(|| left.trailing_zeros() as usize)?;
                    left &= left - 1;
                    Some([64 * k + bit, y])
                })
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::random::Random;
    use super::*;

    fn any(size: [usize; 3], one_of: usize, random: &mut Random) -> Bits {
        let mut bits = Bits::new(size).unwrap();
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    if random.below(one_of) == 0 {
                        bits.set([x, y, z]);
                    }
                }
            }
        }
        bits
    }

    #[test]
    fn places_are_those_where_nothing_is_taken() {
        let mut random = Random::new(11);
        for (size, own) in [
            ([20, 9, 6], [3, 2, 2]),
            ([64, 5, 4], [1, 1, 1]),
            ([150, 4, 4], [70, 2, 3]),
            ([130, 6, 3], [130, 1, 1]),
            ([129, 3, 3], [5, 3, 3]),
        ] {
            for shade in [None, Some((0, true)), Some((0, false)), Some((1, true)), Some((2, false))] {
                let mut space = Space::new(size, own[0]).unwrap();
                let cells = any(own, 2, &mut random);
                let shape = Shape::new(&cells).unwrap();
                let mut taken = Bits::new(size).unwrap();
                for _ in 0..3 {
                    let block = any([5, 3, 2], 3, &mut random);
                    let offset = [0, 1, 2].map(|k| random.below(size[k] + 2) as isize - 2);
                    space.take(&block, 1, offset, shade).unwrap();
                    for cell in 0..30 {
                        let cell = [cell % 5, cell / 5 % 3, cell / 15];
                        if !block.has(cell) {
                            continue;
                        }
                        let mut at = [0, 1, 2].map(|k| cell[k] as isize + offset[k]);
                        for _ in 0..200 {
                            if (0..3).all(|k| (0..size[k] as isize).contains(&at[k])) {
                                taken.set(at.map(|c| c as usize));
                            }
                            match shade {
                                Some((axis, upward)) => at[axis] += if upward { 1 } else { -1 },
                                None => break,
                            }
                        }
                    }
                }
                let mut layer = Layer::default();
                for z in 0..=size[2] - own[2] {
                    let is_any = space.layer(&shape, z, &mut layer).unwrap();
                    let found: Vec<[usize; 2]> = if is_any { layer.places().collect() } else { Vec::new() };
                    let mut expected = Vec::new();
                    for y in 0..=size[1] - own[1] {
                        for x in 0..=size[0] - own[0] {
                            let meets = shape.runs.iter().any(|run| {
                                let (ry, rz) = (y + run.y as usize, z + run.z as usize);
                                let from = x + run.x as usize;
                                (from..from + run.length as usize).any(|x| taken.has([x, ry, rz]))
                            });
                            if !meets {
                                expected.push([x, y]);
                            }
                        }
                    }
                    assert_eq!(found, expected, "{size:?} {own:?} {shade:?} {z}");
                }
            }
        }
    }
}
