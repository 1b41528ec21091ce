//! What the leaves say of polygons.

use super::super::figures::{Figures, dot, minus};
use super::super::leaves::{Leaf, Leaves, OpenLeaf};
use super::local::Local;
use crate::error::Error;
use crate::lattice::{Cell, axes};
use crate::memory;
use crate::solid::OpenSurfaces;
use alloc::vec::Vec;

/// The smallest box along the axes around points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Around {
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
}

impl Around {
    pub(super) fn of(points: &[[f64; 3]]) -> Around {
        let bound = |choose: fn(f64, f64) -> f64, start: f64| {
            axes(|k| points.iter().fold(start, |best, point| choose(best, point[k])))
        };
        Around { low: bound(f64::min, f64::INFINITY), high: bound(f64::max, f64::NEG_INFINITY) }
    }

    pub(super) fn grown(&self, by: f64) -> Around {
        Around { low: self.low.map(|c| c - by), high: self.high.map(|c| c + by) }
    }

    pub(super) fn centre(&self) -> [f64; 3] {
        axes(|k| 0.5 * (self.low[k] + self.high[k]))
    }

    /// Half the longest edge.
    pub(super) fn half(&self) -> f64 {
        (0..3).fold(0.0, |most: f64, k| most.max(0.5 * (self.high[k] - self.low[k])))
    }

    pub(super) fn meets(&self, other: &Around) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// The cube of a cell.
pub(super) fn cube(cell: Cell) -> Around {
    let size = 1.0 / f64::from(1u32 << cell.level);
    let low: [f64; 3] = cell.at.map(|c| f64::from(c) * size);
    Around { low, high: low.map(|c| c + size) }
}

/// The solid as its leaves know it.
pub(super) struct Truth<'l> {
    pub(super) leaves: &'l Leaves,
    pub(super) figures: &'l Figures,
}

impl Truth<'_> {
    /// The leaves that meet a box: what each is, with its cell. What lies around the universe is one of them.
    pub(super) fn meeting(&self, around: &Around, found: &mut Vec<(Cell, Leaf)>) -> Result<(), Error> {
        found.clear();
        if (0..3).any(|k| around.low[k] < 0.0 || around.high[k] > 1.0) {
            memory::push(found, (Cell::ROOT, Leaf::Outside))?;
        }
        self.descend((Cell::ROOT, self.leaves.root), &|cube| cube.meets(around), found)
    }

    /// The leaves that a triangle meets, and some beside it.
    pub(super) fn met_by(
        &self,
        triangle: &[[f64; 3]; 3],
        found: &mut Vec<(Cell, Leaf)>,
    ) -> Result<(), Error> {
        let around = Around::of(triangle);
        found.clear();
        if (0..3).any(|k| around.low[k] < 0.0 || around.high[k] > 1.0) {
            memory::push(found, (Cell::ROOT, Leaf::Outside))?;
        }
        let [a, b, c] = *triangle;
        let (u, v) = (minus(b, a), minus(c, a));
        let normal: [f64; 3] = axes(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        let width: f64 = normal.iter().map(|c| c.abs()).sum();
        // (All numbers are at most about 1, and the cubes are a little larger than they need be.)
        let meets = |cube: &Around| {
            let (off, half) = (dot(normal, minus(cube.centre(), a)).abs(), cube.half());
            cube.meets(&around) && off <= (half + LEAST) * width + LEAST * LEAST
        };
        self.descend((Cell::ROOT, self.leaves.root), &meets, found)
    }

    fn descend(
        &self,
        (cell, leaf): (Cell, Leaf),
        meets: &impl Fn(&Around) -> bool,
        found: &mut Vec<(Cell, Leaf)>,
    ) -> Result<(), Error> {
        if !meets(&cube(cell)) {
            return Ok(());
        }
        let Leaf::Branch(node) = leaf else { return memory::push(found, (cell, leaf)) };
        for (octant, &child) in (0u8..).zip(&self.leaves.nodes[node as usize]) {
            self.descend((cell.child(octant), child), meets, found)?;
        }
        Ok(())
    }

    pub(super) fn open(&self, number: u32) -> &OpenLeaf {
        &self.leaves.open[number as usize]
    }

    /// Whether all points of a polygon lie inside, or all outside; `None` if neither is known.
    pub(super) fn of(
        &self,
        polygon: &[[f64; 3]],
        leaves: &mut Vec<(Cell, Leaf)>,
    ) -> Result<Option<bool>, Error> {
        let around = Around::of(polygon);
        self.meeting(&around, leaves)?;
        let mut all = None;
        for &(_, leaf) in &*leaves {
            let own = match leaf {
                Leaf::Empty | Leaf::Outside | Leaf::Branch(_) => Some(false),
                Leaf::Full => Some(true),
                Leaf::Open(number) => {
                    self.open(number).open.and_then(|open| self.by_function(&open, polygon, &around))
                }
            };
            match (own, all) {
                (None, _) => return Ok(None),
                (Some(own), Some(other)) if own != other => return Ok(None),
                _ => all = own,
            }
        }
        Ok(all)
    }

    fn by_function(&self, open: &OpenSurfaces, polygon: &[[f64; 3]], around: &Around) -> Option<bool> {
        let (mut signs, mut unknown) = (0u8, 0u8);
        for (k, &surface) in open.indices().iter().enumerate() {
            let local = Local::new(self.figures, surface, around.centre(), around.half().max(LEAST));
            match local.map(|local| local.over(polygon)) {
                Some([low, _]) if low > 0.0 => signs |= 1 << k,
                Some([_, high]) if high < 0.0 => {}
                _ => unknown |= 1 << k,
            }
        }
        settled(open, signs, unknown)
    }
}

/// Half the edge of the least cube in which functions are looked at.
pub(super) const LEAST: f64 = 1.0 / (1u64 << 24) as f64;

/// What a function says where some signs are unknown, if that is one thing.
pub(super) fn settled(open: &OpenSurfaces, signs: u8, unknown: u8) -> Option<bool> {
    let first = open.inside(signs);
    // All subsets of what is unknown.
    let mut subset = unknown;
    while subset != 0 {
        if open.inside(signs | subset) != first {
            return None;
        }
        subset = (subset - 1) & unknown;
    }
    Some(first)
}
