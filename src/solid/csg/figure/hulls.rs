//! A search structure for the farthest of consecutive corners in a direction.
//!
//! The structure is a tree of convex hulls over repeated halves of the corners. A query for a range of
//! corners visits the few nodes that make up the range, and is answered on each hull by bisection.

use super::segment::{before, turn};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// The number of corners that are tested one by one.
const LEAF: usize = 32;

/// The hulls of all blocks of 2^k times [`LEAF`] corners.
pub(crate) struct Hulls {
    /// The levels, from the smallest blocks on.
    levels: Vec<Level>,
}

/// The upper and the lower hulls of the blocks of one size.
struct Level {
    corners: [Vec<u32>; 2],
    /// The places where each block's hull begins, and where the last hull ends.
    starts: [Vec<usize>; 2],
}

impl Hulls {
    /// Builds the tree. O(n log² n) time, O(n log n) memory.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn new(count: usize, at: impl Fn(usize) -> [f64; 2]) -> Result<Hulls, Error> {
        let order = |i: u32, j: u32| {
            let (p, q) = (at(i as usize), at(j as usize));
            p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])).then(i.cmp(&j))
        };
        let mut sorted: Vec<u32> = memory::with_capacity(count)?;
        sorted.extend((0..count).map(|i| i as u32));
        let mut levels = Vec::new();
        let mut size = LEAF;
        while size < count {
            let mut level = Level { corners: [Vec::new(), Vec::new()], starts: [Vec::new(), Vec::new()] };
            for block in sorted.chunks_mut(size) {
                block.sort_unstable_by(|&i, &j| order(i, j));
                for (side, sense) in [1, -1].into_iter().enumerate() {
                    let hull = &mut level.corners[side];
                    let start = hull.len();
                    memory::push(&mut level.starts[side], start)?;
                    for &corner in &*block {
                        let p = at(corner as usize);
                        while let [.., a, b] = hull[start..]
                            && turn([at(a as usize), at(b as usize)], [at(b as usize), p]) * sense >= 0
                        {
                            hull.pop();
                        }
                        memory::push(hull, corner)?;
                    }
                }
            }
            for side in 0..2 {
                let end = level.corners[side].len();
                memory::push(&mut level.starts[side], end)?;
            }
            memory::push(&mut levels, level)?;
            size *= 2;
        }
        Ok(Hulls { levels })
    }

    /// Returns the corner of a non-empty range that is farthest to the left of the direction of `base`.
    ///
    /// O(log² n).
    pub(crate) fn farthest(
        &self,
        base: [[f64; 2]; 2],
        mut from: usize,
        to: usize,
        at: impl Fn(usize) -> [f64; 2],
    ) -> usize {
        let mut best = from;
        let mut offer = |corner: usize| {
            if turn(base, [at(best), at(corner)]) > 0 {
                best = corner;
            }
        };
        while from < to {
            // The largest block that begins here and lies in the range.
            let fits = |level: &usize| {
                let size = LEAF << level;
                from.is_multiple_of(size) && from + size <= to
            };
            match (0..self.levels.len()).take_while(fits).last() {
                None => {
                    let end = to.min((from / LEAF + 1) * LEAF);
                    (from..end).for_each(&mut offer);
                    from = end;
                }
                Some(level) => {
                    let size = LEAF << level;
                    offer(self.levels[level].farthest(base, from / size, &at));
                    from += size;
                }
            }
        }
        best
    }
}

impl Level {
    fn farthest(&self, base: [[f64; 2]; 2], block: usize, at: &impl Fn(usize) -> [f64; 2]) -> usize {
        // The upper hull, if left is up.
        let side = usize::from(before(base[1], base[0]));
        let hull = &self.corners[side][self.starts[side][block]..self.starts[side][block + 1]];
        // Along the hull the corners get farther first, then nearer.
        let (mut low, mut high) = (0, hull.len() - 1);
        while low < high {
            let middle = low.midpoint(high);
            let [a, b] = [hull[middle], hull[middle + 1]].each(|corner| at(corner as usize));
            if turn(base, [a, b]) > 0 { low = middle + 1 } else { high = middle }
        }
        hull[low] as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_farthest_of_a_range_is_found() {
        let mut state = 3u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) % below
        };
        for round in 0..60 {
            let (count, size) = (1 + random(700) as usize, 2 + random(if round % 2 == 0 { 5 } else { 1000 }));
            let points: Vec<[f64; 2]> =
                (0..count).map(|_| [random(size) as f64, random(size) as f64]).collect();
            let hulls = Hulls::new(count, |i| points[i]).unwrap();
            for _ in 0..300 {
                let from = random(count as u64) as usize;
                let to = from + 1 + random((count - from) as u64) as usize;
                let base = [0, 1].map(|_| [random(7) as f64, random(7) as f64]);
                if base[0] == base[1] {
                    continue;
                }
                let found = hulls.farthest(base, from, to, |i| points[i]);
                assert!((from..to).contains(&found));
                assert!(
                    (from..to).all(|i| turn(base, [points[found], points[i]]) <= 0),
                    "{from} {to} {base:?}"
                );
            }
        }
    }
}
