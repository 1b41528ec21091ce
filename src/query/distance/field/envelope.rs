//! The step from the distances across a line of cells to the distances in the plane.
//!
//! Along a line, cells of one side form runs. Let a cell's distance from the other side across the line be
//! √v. A cell k places further is then no more than √(v + (2k − 1)²) away: the path goes to the plane between
//! cells in front of the first cell, and from there across. A plane therefore represents the better of the
//! two cells beside it. A cell's square is its own, or the least of all v + d², where d is the distance of
//! the cell's centre from a plane. The cells beside the run lie on the other side, with v = 0. The lower
//! envelope of these parabolas is found in linear time: each parabola has the least value on at most one
//! interval.

use super::sides::{NONE, Signed};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// A plane in front of the cell `at` of a run, with its value v.
#[derive(Clone, Copy)]
struct Site {
    at: i32,
    value: i32,
}

impl Site {
    /// The square of the distance of a cell's centre through this site.
    #[inline(always)]
    fn reach(&self, cell: i32) -> i32 {
        let half_cells = 2 * (cell - self.at) + 1;
        self.value + half_cells * half_cells
    }

    /// True if this site is nowhere better than both a site before it and a site behind it.
    #[inline(always)]
    fn is_hidden(&self, before: &Site, behind: &Site) -> bool {
        let (a, b) = (i64::from(self.at - before.at), i64::from(behind.at - self.at));
        let [u, v, w] = [before, self, behind].each(|site| i64::from(site.value));
        // The parabolas of the two others cross before either crosses this one.
        (a + b) * v - b * u - a * w >= 4 * a * b * (a + b)
    }
}

/// Scratch memory for lines.
pub(super) struct Envelope {
    sites: Vec<Site>,
}

impl Envelope {
    /// Allocates the memory for lines of at most `longest` cells.
    pub(super) fn new(longest: usize) -> Result<Envelope, Error> {
        Ok(Envelope { sites: memory::with_capacity(longest + 1)? })
    }

    /// Converts a line's squares to squares in the plane, from `first` on, one for each entry of `found`.
    pub(super) fn run(&mut self, line: &[Signed], first: usize, found: &mut [Signed]) {
        let end = first + found.len();
        let mut from = 0;
        while from < end {
            let is_member = line[from] < 0;
            let length = line[from..].iter().position(|&v| (v < 0) != is_member);
            let to = length.map_or(line.len(), |length| from + length);
            if to > first {
                let wanted = from.max(first)..to.min(end);
                let (skipped, into) = (wanted.start - from, wanted.start - first..wanted.end - first);
                self.run_of_one_side(&line[from..to], from > 0, to < line.len(), skipped, &mut found[into]);
            }
            from = to;
        }
    }

    fn run_of_one_side(
        &mut self,
        run: &[Signed],
        begins: bool,
        ends: bool,
        skipped: usize,
        found: &mut [Signed],
    ) {
        self.sites.clear();
        let mut before = if begins { 0 } else { NONE };
        for (at, &value) in (0..).zip(run) {
            self.add(at, before.min(value.abs()));
            before = value.abs();
        }
        self.add(run.len() as i32, if ends { 0 } else { before });
        let is_member = run[0] < 0;
        let mut sites = self.sites.iter();
        let Some(mut site) = sites.next() else {
            found.fill(if is_member { -NONE } else { NONE });
            return;
        };
        let mut following = sites.next();
        for ((cell, &own), found) in (skipped as i32..).zip(&run[skipped..]).zip(found) {
            let mut square = site.reach(cell);
            while let Some(next) = following {
                let reach = next.reach(cell);
                if reach > square {
                    break;
                }
                (site, square) = (next, reach);
                following = sites.next();
            }
            let square = square.min(own.abs());
            *found = if is_member { -square } else { square };
        }
    }

    /// Adds a site behind all others. The memory suffices.
    #[inline(always)]
    fn add(&mut self, at: i32, value: i32) {
        if value == NONE {
            return;
        }
        let site = Site { at, value };
        while let [.., before, last] = self.sites[..] {
            if !last.is_hidden(&before, &site) {
                break;
            }
            self.sites.pop();
        }
        self.sites.push(site);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    #[test]
    fn lines_against_their_definition() {
        let mut state = 7u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % below) as i32
        };
        let apart = |cells: i32| (2 * cells.abs() - 1).max(0).pow(2);
        let mut envelope = Envelope::new(100).unwrap();
        for _ in 0..20_000 {
            let length = 1 + random(60) as usize;
            let (mut side, turns) = (1, 1 + random(30) as u64);
            let most = [3, 20, 200, 3000][random(4) as usize];
            let line: Vec<i32> = (0..length)
                .map(|_| {
                    if random(turns) == 0 {
                        side = -side;
                    }
                    side * if random(4) == 0 { NONE } else { 1 + random(most) }
                })
                .collect();
            let first = random(length as u64) as usize;
            let mut found = vec![0; 1 + random((length - first) as u64) as usize];
            envelope.run(&line, first, &mut found);
            for (k, &found) in found.iter().enumerate() {
                let own = line[first + k];
                let others = (0..length).filter_map(|j| {
                    let value = if (line[j] < 0) == (own < 0) { line[j].abs() } else { 0 };
                    (value != NONE).then(|| value + apart((first + k) as i32 - j as i32))
                });
                let square = others.min().unwrap_or(NONE);
                assert_eq!(found, own.signum() * square, "{line:?} {first} {k}");
            }
        }
    }
}
