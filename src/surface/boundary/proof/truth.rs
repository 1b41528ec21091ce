//! Verdicts of the leaves on polygons.

use super::super::figures::{Figures, dot, minus};
use super::super::leaves::{Leaf, Leaves, OpenLeaf};
use super::clip::clip;
use super::local::Local;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, axes};
use crate::memory;
use crate::solid::OpenSurfaces;
use alloc::vec::Vec;

/// The smallest axis-aligned box around points.
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
        Around { low: self.low.each(|c| c - by), high: self.high.each(|c| c + by) }
    }

    pub(super) fn centre(&self) -> [f64; 3] {
        axes(|k| 0.5 * (self.low[k] + self.high[k]))
    }

    /// Half the longest edge.
    pub(super) fn half(&self) -> f64 {
        (0..3).fold(0.0, |most: f64, k| most.max(0.5 * (self.high[k] - self.low[k])))
    }

    fn holds(&self, other: &Around) -> bool {
        (0..3).all(|k| self.low[k] <= other.low[k] && other.high[k] <= self.high[k])
    }

    /// Returns whether the whole box lies in the universe.
    fn is_in_universe(&self) -> bool {
        Around { low: [0.0; 3], high: [1.0; 3] }.holds(self)
    }

    pub(super) fn meets(&self, other: &Around) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// The cube of a cell.
pub(super) fn cube(cell: Cell) -> Around {
    let size = 1.0 / f64::from(1u32 << cell.level);
    let low: [f64; 3] = cell.at.each(|c| f64::from(c) * size);
    Around { low, high: low.each(|c| c + size) }
}

/// The solid as its leaves describe it.
pub(super) struct Truth<'l> {
    pub(super) leaves: &'l Leaves,
    pub(super) figures: &'l Figures,
}

impl Truth<'_> {
    /// The leaves that meet a box, each with its cell. The space around the universe is one of them.
    pub(super) fn meeting(&self, around: &Around, found: &mut Vec<(Cell, Leaf)>) -> Result<(), Error> {
        found.clear();
        if !around.is_in_universe() {
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
        if !around.is_in_universe() {
            memory::push(found, (Cell::ROOT, Leaf::Outside))?;
        }
        let [a, b, c] = *triangle;
        let (u, v) = (minus(b, a), minus(c, a));
        let normal: [f64; 3] = axes(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        let width: f64 = normal.iter().map(|c| c.abs()).sum();
        // (All numbers are at most about 1, and the cubes are a little larger than necessary.)
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
}

/// The solid near a place: the leaves there, and the functions of their surfaces. Many polygons are compared
/// with these.
#[derive(Default)]
pub(super) struct Near {
    around: Option<Around>,
    leaves: Vec<(Cell, Leaf)>,
    functions: Vec<(u32, Option<Local>)>,
    part: Vec<[f64; 3]>,
    cut: Vec<[f64; 3]>,
}

impl Near {
    /// Moves to another place.
    pub(super) fn place(&mut self, truth: &Truth<'_>, around: Around) -> Result<(), Error> {
        self.functions.clear();
        self.around = Some(around);
        truth.meeting(&around, &mut self.leaves)
    }

    /// The leaves at the place, each with its cell.
    pub(super) fn leaves(&self) -> &[(Cell, Leaf)] {
        &self.leaves
    }

    /// The expansion of a surface's function at the place; `None` if nothing is known.
    pub(super) fn function(&mut self, figures: &Figures, surface: u32) -> Result<Option<&Local>, Error> {
        let place = match self.functions.iter().position(|(known, _)| *known == surface) {
            Some(place) => place,
            None => {
                let around = self.around.as_ref();
                let local = around
                    .and_then(|near| Local::new(figures, surface, near.centre(), near.half().max(LEAST)));
                memory::push(&mut self.functions, (surface, local))?;
                self.functions.len() - 1
            }
        };
        Ok(self.functions[place].1.as_ref())
    }

    /// Returns whether all points of a polygon at the place are inside the solid, or all outside; `None` if
    /// neither is known.
    pub(super) fn of(&mut self, truth: &Truth<'_>, polygon: &[[f64; 3]]) -> Result<Option<bool>, Error> {
        let around = Around::of(polygon);
        if !self.around.is_some_and(|own| own.holds(&around)) {
            return Ok(None);
        }
        let mut all = None;
        for k in 0..self.leaves.len() {
            let (cell, leaf) = self.leaves[k];
            let own = match leaf {
                Leaf::Outside if around.is_in_universe() => continue,
                Leaf::Outside => Some(false),
                _ if !cube(cell).meets(&around) => continue,
                _ => self.in_leaf(truth, leaf, polygon)?,
            };
            if own.is_some() && (all.is_none() || all == own) {
                all = own;
                continue;
            }
            // Possibly only a part of the polygon lies in the cell, or nothing of it.
            if matches!(leaf, Leaf::Outside) || polygon.len() < 3 {
                return Ok(None);
            }
            let mut part = core::mem::take(&mut self.part);
            part.clear();
            part.try_reserve(polygon.len())?;
            part.extend(polygon);
            let Around { low, high } = cube(cell).grown(ROUNDING);
            clip(&mut part, &mut self.cut, low, high)?;
            let own = if part.is_empty() { all } else { self.in_leaf(truth, leaf, &part)? };
            let is_there = !part.is_empty();
            self.part = part;
            if is_there && (own.is_none() || all.is_some() && all != own) {
                return Ok(None);
            }
            all = own;
        }
        Ok(all)
    }

    fn in_leaf(
        &mut self,
        truth: &Truth<'_>,
        leaf: Leaf,
        polygon: &[[f64; 3]],
    ) -> Result<Option<bool>, Error> {
        match leaf {
            Leaf::Empty | Leaf::Outside | Leaf::Branch(_) => Ok(Some(false)),
            Leaf::Full => Ok(Some(true)),
            Leaf::Open(number) => match truth.open(number).open {
                Some(open) => self.by_functions(truth.figures, &open, polygon),
                None => Ok(None),
            },
        }
    }

    fn by_functions(
        &mut self,
        figures: &Figures,
        open: &OpenSurfaces,
        polygon: &[[f64; 3]],
    ) -> Result<Option<bool>, Error> {
        let (mut signs, mut unknown) = (0u8, 0u8);
        for (k, &surface) in open.indices().iter().enumerate() {
            match self.function(figures, surface)?.map(|local| local.over(polygon)) {
                Some([low, _]) if low > 0.0 => signs |= 1 << k,
                Some([_, high]) if high < 0.0 => {}
                _ => unknown |= 1 << k,
            }
        }
        Ok(settled(open, signs, unknown))
    }
}

/// The greatest rounding error of places.
const ROUNDING: f64 = 4e-15;

/// Half the edge of the least cube in which functions are expanded.
pub(super) const LEAST: f64 = 1.0 / (1u64 << 24) as f64;

/// The value of a function with some unknown signs, if it is the same for all of them.
pub(super) fn settled(open: &OpenSurfaces, signs: u8, unknown: u8) -> Option<bool> {
    let first = open.inside(signs);
    // All subsets of the unknown signs.
    let mut subset = unknown;
    while subset != 0 {
        if open.inside(signs | subset) != first {
            return None;
        }
        subset = (subset - 1) & unknown;
    }
    Some(first)
}
