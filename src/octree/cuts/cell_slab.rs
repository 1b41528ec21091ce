//! Slabs made for one cell: two words each.

use crate::lattice::Each;
use crate::lattice::{Cell, axes};
use bytemuck::{Pod, Zeroable};
use core::ops::RangeInclusive;

/// A slab made for one cell. Its planes lie a whole number of steps from the cell's centre. The slab is also
/// defined outside the cell, but nothing is known there about the surface that it represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct CellSlab {
    /// The cell, in bits 0 to 60: a one, followed by the octants from the universe down, three bits each.
    /// Bits 61 and 62 contain the index of the slab in its cell.
    pub home: u64,
    /// From the lowest bit on: two components of the normal, 16 bits each; the inner offset, 19; the width,
    /// 4; the step, 6; the axis of the greatest component, 2; the sign of that component.
    pub planes: u64,
}

/// The planes of a slab as integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Steps {
    /// The axis along which the normal has the component 1, or −1.
    pub axis: usize,
    pub is_negative: bool,
    /// The components along the next two axes, in units of 2^-15.
    pub others: [i16; 2],
    /// The inner offset in steps: n · (p − centre) for the points p of the inner plane, where n is the normal
    /// and centre that of the cell.
    pub offset: i32,
    /// The distance from the inner to the outer plane, in steps.
    pub width: u8,
    /// Exponent: a step is the universe's edge divided by 2^step.
    pub step: u8,
}

impl Steps {
    /// The greatest component of a normal, in units of the others.
    pub(crate) const UNIT: f64 = 32_768.0;
    /// The greatest offset; the least one is −`MOST_OFFSET` − 1.
    pub(crate) const MOST_OFFSET: i32 = (1 << 18) - 1;
    pub(crate) const MOST_WIDTH: u8 = 15;
    /// The range of exponents of steps, in which all numbers of a slab of any cell are doubles.
    pub(crate) const STEPS: RangeInclusive<u8> = 2..=50;

    /// Returns the normal.
    pub(crate) fn normal(&self) -> [f64; 3] {
        let mut normal = [if self.is_negative { -1.0 } else { 1.0 }; 3];
        for (k, &own) in (1..).zip(&self.others) {
            normal[(self.axis + k) % 3] = f64::from(own) / Steps::UNIT;
        }
        normal
    }
}

/// Number of bits of the cell in [`CellSlab::home`].
const CELL: u32 = 61;

/// The bit that distinguishes the numbers of slabs made for cells from other numbers of slabs.
const MADE_FOR_A_CELL: u64 = 1 << 63;

impl CellSlab {
    /// Returns the slab of a cell with this `index`, 0 to 2.
    pub(crate) fn new(cell: Cell, index: u8, steps: &Steps) -> CellSlab {
        let octants = 1 << (3 * cell.level) | cell.morton();
        let [a, b] = steps.others.each(|own| u64::from(own as u16));
        let offset = (steps.offset as u32 & 0x7_FFFF).into();
        let parts = [
            (a, 16),
            (b, 16),
            (offset, 19),
            (steps.width.into(), 4),
            (steps.step.into(), 6),
            (steps.axis as u64, 2),
            (steps.is_negative.into(), 1),
        ];
        let mut shift = 0;
        let planes = parts.into_iter().fold(0, |all, (part, bits)| {
            let own: u64 = part << shift;
            shift += bits;
            all | own
        });
        CellSlab { home: u64::from(index) << CELL | octants, planes }
    }

    pub(crate) fn steps(self) -> Steps {
        let part = |shift: u32, bits: u32| self.planes >> shift & ((1 << bits) - 1);
        Steps {
            axis: part(61, 2) as usize,
            is_negative: part(63, 1) != 0,
            others: [part(0, 16) as u16 as i16, part(16, 16) as u16 as i16],
            // (The highest of 19 bits is the sign.)
            offset: ((part(32, 19) as i32) << 13) >> 13,
            width: part(51, 4) as u8,
            step: part(55, 6) as u8,
        }
    }

    /// Returns the cell; `None` for a damaged slab.
    pub(crate) fn home(self) -> Option<Cell> {
        let octants = self.home & ((1 << CELL) - 1);
        let level = octants.checked_ilog2().filter(|bits| bits % 3 == 0)? / 3;
        let cell = (0..level).rev().fold(Cell::ROOT, |cell, k| cell.child((octants >> (3 * k) & 7) as u8));
        Some(cell)
    }

    /// Returns the number of the slab among all slabs of its origin.
    pub(crate) fn number(self) -> u64 {
        MADE_FOR_A_CELL | self.home
    }

    /// Returns the number of the slab of a cell with this `index`, 0 to 5, whether it has this form or not.
    pub(crate) fn number_in(cell: Cell, index: u8) -> u64 {
        let (octants, index) = (1 << (3 * cell.level) | cell.morton(), u64::from(index));
        match index {
            0..3 => MADE_FOR_A_CELL | index << CELL | octants,
            _ => (index - 2) << CELL | octants,
        }
    }

    /// True if the words are those of a slab of a cell in an octree of this depth.
    pub(crate) fn is_valid(self, depth: u8) -> bool {
        let steps = self.steps();
        self.home >> 63 == 0
            && self.home >> CELL < 3
            && self.home().is_some_and(|cell| cell.level <= depth)
            && steps.axis < 3
            && steps.others.iter().all(|&own| own != i16::MIN)
            && Steps::STEPS.contains(&steps.step)
    }

    /// Returns its numbers in units of the universe: the normal, and the offsets of the inner and the outer
    /// plane. They are exact.
    pub(crate) fn numbers(self) -> [f64; 5] {
        let steps = self.steps();
        let [x, y, z] = steps.normal();
        let Cell { level, at } = self.home().unwrap_or(Cell::ROOT);
        let centre = axes(|axis| (2 * u64::from(at[axis]) + 1) as f64 / (2u64 << level) as f64);
        let step = 1.0 / (1u64 << steps.step.min(*Steps::STEPS.end())) as f64;
        let inner = (x * centre[0] + y * centre[1]) + z * centre[2] + f64::from(steps.offset) * step;
        [x, y, z, inner, inner + f64::from(steps.width) * step]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back() {
        let cell = Cell { level: 20, at: [0xF_FFFF, 0x5_5555, 1] };
        let steps = Steps {
            axis: 1,
            is_negative: true,
            others: [-32_767, 12_345],
            offset: -Steps::MOST_OFFSET - 1,
            width: 15,
            step: 50,
        };
        for steps in
            [steps, Steps { axis: 2, is_negative: false, offset: Steps::MOST_OFFSET, step: 2, ..steps }]
        {
            let slab = CellSlab::new(cell, 2, &steps);
            assert_eq!((slab.steps(), slab.home()), (steps, Some(cell)));
            assert!(slab.is_valid(20) && !slab.is_valid(19) && slab.number() >> 63 == 1);
        }
        for step in [0, 1, 51] {
            assert!(!CellSlab::new(cell, 2, &Steps { step, ..steps }).is_valid(20));
        }
        let root =
            CellSlab::new(Cell::ROOT, 0, &Steps { axis: 0, is_negative: false, others: [0, 0], ..steps });
        assert_eq!(root.home(), Some(Cell::ROOT));
        assert!(
            CellSlab { home: 2, ..root }.home().is_none() && CellSlab { home: 0, ..root }.home().is_none()
        );
        assert!(!CellSlab { home: root.home | 3 << 61, ..root }.is_valid(20));
    }
}
