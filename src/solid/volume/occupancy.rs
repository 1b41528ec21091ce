//! The blocks of voxels that lie inside, and those that touch the solid: a pyramid with the grain of octree
//! elements.
//!
//! A group is 64 blocks of 4^k voxels along an edge, as two words in Morton order: the blocks that are inside
//! as a whole, and the blocks that contain an inside voxel. So on a frame whose cells are the voxels,
//! splitting two levels reads one group. The pyramid takes 1/32 of the memory of a bitmap, 1/256 of that of
//! bytes.

use super::field::{Field, spread};
use super::ranges::Ranges;
use super::slices::in_slices;
use super::value::{Limits, Value};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::morton;
use crate::memory;
use crate::octree::{Planes, Tag};
use alloc::vec::Vec;

/// Groups whose blocks have the same edge.
#[derive(Debug)]
struct Level {
    size: [u32; 3],
    groups: Vec<Planes>,
}

#[derive(Debug)]
pub(super) struct Occupancy {
    /// Level k has blocks of 4^(k + 1) voxels. The last level has one group.
    levels: Vec<Level>,
}

/// The findings in a box of voxels so far.
#[derive(Clone, Copy, Default)]
pub(super) struct Seen {
    pub(super) inside: bool,
    pub(super) outside: bool,
}

impl Seen {
    fn both(&self) -> bool {
        self.inside && self.outside
    }
}

impl Occupancy {
    pub(super) fn new(field: &Field<'_>, ranges: &Ranges, control: &Control<'_>) -> Result<Occupancy, Error> {
        let mut levels = memory::with_capacity(10)?;
        let mut size = field.grid.extents().each(|extent| extent.div_ceil(16));
        let count = |size: [u32; 3]| size.each(|edge| edge as usize).iter().product::<usize>();
        let mut groups = memory::filled(count(size), Planes::uniform(Tag::Empty))?;
        in_slices(&mut groups, size[0] as usize * size[1] as usize, control, |z, slice| {
            Rows::new(field, z as u32)?.gather(field, ranges, size, slice);
            Ok(())
        })?;
        while size != [1; 3] {
            control.check()?;
            let next = size.each(|edge| edge.div_ceil(4));
            let mut above = memory::filled(count(next), Planes::uniform(Tag::Empty))?;
            let mut below = groups.iter();
            for z in 0..size[2] {
                for y in 0..size[1] {
                    for (x, group) in (0..size[0]).zip(&mut below) {
                        let c = morton::index(x, y, z);
                        let group = Planes {
                            lower: u64::from(group.lower == !0) << c,
                            upper: u64::from(group.upper != 0) << c,
                        };
                        if let Some(place) = above.get_mut(index(next, [x / 4, y / 4, z / 4])) {
                            *place = place.union(group);
                        }
                    }
                }
            }
            levels.push(Level { size, groups });
            (size, groups) = (next, above);
        }
        levels.push(Level { size, groups });
        Ok(Occupancy { levels })
    }

    /// The 64 blocks, each of 4^(level + 1) voxels along an edge, of the group at a place counted in groups.
    /// Everything beyond the grid is EMPTY, and there is no greatest level.
    pub(super) fn group(&self, level: usize, at: [i64; 3]) -> Planes {
        if at.iter().any(|&a| a < 0) {
            return Planes::uniform(Tag::Empty);
        }
        let Some(Level { size, groups }) = self.levels.get(level) else {
            return self.above(level, at);
        };
        if (0..3).any(|axis| at[axis] >= i64::from(size[axis])) {
            return Planes::uniform(Tag::Empty);
        }
        groups.get(index(*size, at.each(|a| a as u32))).copied().unwrap_or(Planes::uniform(Tag::Partial))
    }

    /// A group larger than the grid, which lies in the group's first block.
    fn above(&self, level: usize, at: [i64; 3]) -> Planes {
        let top = self.levels.last().and_then(|top| top.groups.first());
        let top = top.copied().filter(|_| at == [0; 3]).unwrap_or(Planes::uniform(Tag::Empty));
        // On the next level the first block is the last group; above that level it is larger than the grid.
        let filled = level == self.levels.len() && top.lower == !0;
        Planes { lower: filled.into(), upper: u64::from(top.upper != 0) }
    }

    /// Finds out whether a box of voxels contains inside voxels, and whether it contains outside voxels. The
    /// box reaches from `low` to before `high`, is not empty and lies within the grid. O(1) if the box is a
    /// cell of an octree over the grid, else linear in its surface.
    pub(super) fn look(&self, field: &Field<'_>, low: [u32; 3], high: [u32; 3]) -> Seen {
        let longest = (0..3).map(|axis| high[axis] - low[axis]).max().unwrap_or(1);
        let mut level = 0;
        while 16 << (2 * level) < longest && level + 1 < self.levels.len() {
            level += 1;
        }
        let shift = 2 * level + 4;
        let mut seen = Seen::default();
        for z in low[2] >> shift..=(high[2] - 1) >> shift {
            for y in low[1] >> shift..=(high[1] - 1) >> shift {
                for x in low[0] >> shift..=(high[0] - 1) >> shift {
                    self.look_at(field, level, [x, y, z], [low, high], &mut seen);
                    if seen.both() {
                        return seen;
                    }
                }
            }
        }
        seen
    }

    /// Examines the part of a box of voxels in one group. The recursion is as deep as there are levels.
    fn look_at(&self, field: &Field<'_>, level: usize, at: [u32; 3], voxels: [[u32; 3]; 2], seen: &mut Seen) {
        let shift = 2 * level as u32 + 2;
        let planes = self.group(level, at.each(i64::from));
        let origin = at.each(|a| a << (shift + 2));
        let touched = blocks_between(origin, shift, voxels, false);
        seen.inside |= planes.lower & touched != 0;
        seen.outside |= !planes.upper & touched != 0;
        let mut mixed = planes.upper & !planes.lower & touched;
        if mixed & blocks_between(origin, shift, voxels, true) != 0 {
            *seen = Seen { inside: true, outside: true };
        }
        while mixed != 0 && !seen.both() {
            let place = morton::position(mixed.trailing_zeros());
            mixed &= mixed - 1;
            let block = axes(|axis| 4 * at[axis] + place[axis]);
            if level > 0 {
                self.look_at(field, level - 1, block, voxels, seen);
                continue;
            }
            let brick = field.brick(block);
            let touched = blocks_between(block.each(|b| 4 * b), 0, voxels, false);
            seen.inside |= brick & touched != 0;
            seen.outside |= !brick & touched != 0;
        }
    }

    /// The number of bytes of the pyramid.
    pub(super) fn bytes(&self) -> usize {
        self.levels.iter().map(|level| level.groups.len() * size_of::<Planes>()).sum()
    }
}

/// The index of a group.
fn index(size: [u32; 3], at: [u32; 3]) -> usize {
    let [x, y, z] = at.each(|a| a as usize);
    (z * size[1] as usize + y) * size[0] as usize + x
}

/// The blocks, of 64 with 2^shift voxels along an edge from `origin` on, that a box of voxels touches; if
/// `whole`, the blocks that it contains.
fn blocks_between(origin: [u32; 3], shift: u32, [low, high]: [[u32; 3]; 2], whole: bool) -> u64 {
    let mut blocks = !0;
    for axis in 0..3 {
        let from = low[axis].saturating_sub(origin[axis]);
        let to = high[axis].saturating_sub(origin[axis]).min(4 << shift);
        let (first, end) = if whole {
            (from.div_ceil(1 << shift), to >> shift)
        } else {
            (from >> shift, to.div_ceil(1 << shift))
        };
        if first >= end {
            return 0;
        }
        blocks &= morton::slabs(axis, first, end - 1);
    }
    blocks
}

/// Sixteen rows of blocks along x, for a slab of groups: bits of the blocks that are inside as a whole, and
/// of those that touch the solid.
struct Rows {
    z: u32,
    words: usize,
    all: Vec<u64>,
    any: Vec<u64>,
}

impl Rows {
    fn new(field: &Field<'_>, z: u32) -> Result<Rows, Error> {
        let words = field.grid.extents()[0].div_ceil(256) as usize;
        Ok(Rows { z, words, all: memory::filled(16 * words, 0)?, any: memory::filled(16 * words, 0)? })
    }

    /// Computes the groups of the slab.
    fn gather(&mut self, field: &Field<'_>, ranges: &Ranges, size: [u32; 3], groups: &mut [Planes]) {
        for (y, row) in (0..).zip(groups.chunks_mut(size[0] as usize)) {
            self.read(field, ranges, y);
            for (x, group) in row.iter_mut().enumerate() {
                for k in 0..16 {
                    let nibble = |bits: &[u64]| spread(bits[k * self.words + x / 16] >> (4 * (x % 16)) & 0xF);
                    let place = morton::index(0, k as u32 % 4, k as u32 / 4);
                    group.lower |= nibble(&self.all) << place;
                    group.upper |= nibble(&self.any) << place;
                }
            }
        }
    }

    fn read(&mut self, field: &Field<'_>, ranges: &Ranges, y: u32) {
        self.all.fill(0);
        self.any.fill(0);
        let [_, ny, nz] = field.grid.extents().each(|extent| extent.div_ceil(4));
        let words = self.words;
        let rows = self.all.chunks_mut(words).zip(self.any.chunks_mut(words));
        for (k, (all, any)) in (0..).zip(rows) {
            let (by, bz) = (4 * y + k % 4, 4 * self.z + k / 4);
            if by >= ny || bz >= nz {
                continue;
            }
            match ranges {
                Ranges::None => of_bits(field, [by, bz], all, any),
                Ranges::U8(ranges) => of_ranges(field, ranges, [by, bz], all, any),
                Ranges::U16(ranges) => of_ranges(field, ranges, [by, bz], all, any),
                Ranges::I16(ranges) => of_ranges(field, ranges, [by, bz], all, any),
                Ranges::F32(ranges) => of_ranges(field, ranges, [by, bz], all, any),
            }
            // Blocks that reach beyond the grid are not inside as a whole.
            let [nx, ny, nz] = field.grid.extents().each(|extent| extent / 4);
            let whole = if by < ny && bz < nz { nx as usize } else { 0 };
            for (word, bits) in all.iter_mut().enumerate() {
                *bits &= below(whole.saturating_sub(64 * word));
            }
        }
    }
}

/// The lowest `count` bits of a word; all bits if `count` is 64 or more.
fn below(count: usize) -> u64 {
    if count < 64 { (1 << count) - 1 } else { !0 }
}

/// A row of blocks, from the ranges of their samples.
fn of_ranges<T: Value>(field: &Field<'_>, ranges: &[[T; 2]], at: [u32; 2], all: &mut [u64], any: &mut [u64]) {
    let blocks = field.grid.extents().each(|extent| extent.div_ceil(4) as usize);
    let first = (at[1] as usize * blocks[1] + at[0] as usize) * blocks[0];
    let row = ranges.get(first..first + blocks[0]).unwrap_or(&[]);
    let [low, high] = field.limits.of::<T>();
    for (word, ranges) in row.chunks(64).enumerate() {
        let (mut inside, mut outside, mut known) = (0, 0, 0);
        for (i, &[least, greatest]) in ranges.iter().enumerate() {
            let is_inside = (low <= least) & (greatest <= high);
            let is_outside = (greatest < low) | (least > high);
            // One end lies in the band and the other does not: both are samples.
            let is_mixed = ((low <= least) & (least <= high)) != ((low <= greatest) & (greatest <= high));
            inside |= u64::from(is_inside) << i;
            outside |= u64::from(is_outside) << i;
            known |= u64::from(is_inside | is_outside | (is_mixed & !least.is_nan())) << i;
        }
        let mut touches = !outside & below(ranges.len());
        let mut open = !known & below(ranges.len());
        while open != 0 {
            let i = open.trailing_zeros();
            open &= open - 1;
            let brick = field.brick([64 * word as u32 + i, at[0], at[1]]);
            inside |= u64::from(brick == !0) << i;
            if brick == 0 {
                touches &= !(1 << i);
            }
        }
        if let (Some(all), Some(any)) = (all.get_mut(word), any.get_mut(word)) {
            (*all, *any) = (inside, touches);
        }
    }
}

/// A row of blocks of bits.
fn of_bits(field: &Field<'_>, at: [u32; 2], all: &mut [u64], any: &mut [u64]) {
    let super::Samples::Bits(bits) = &field.samples else { return };
    let (bits, words) = (bits.values(), field.grid.words());
    let [nx, ny, nz] = field.grid.extents().each(|extent| extent as usize);
    let limits: &Limits = &field.limits;
    let [y, z] = at.each(|a| 4 * a as usize);
    for word in 0..words {
        let real = below(nx - 64 * word);
        let (mut inside, mut touches) = (real, 0);
        for z in z..nz.min(z + 4) {
            for y in y..ny.min(y + 4) {
                let row = bits.get((z * ny + y) * words + word).copied().unwrap_or(0);
                let row = limits.word(row) & real;
                inside &= row;
                touches |= row;
            }
        }
        let inside = inside & inside >> 1;
        let touches = touches | touches >> 1;
        let place = 16 * (word % 4);
        if let (Some(all), Some(any)) = (all.get_mut(word / 4), any.get_mut(word / 4)) {
            *all |= every_fourth(inside & inside >> 2) << place;
            *any |= every_fourth(touches | touches >> 2) << place;
        }
    }
}

/// Gathers bits 0, 4, 8 … side by side.
fn every_fourth(word: u64) -> u64 {
    let word = word & 0x1111_1111_1111_1111;
    let word = (word | word >> 3) & 0x0303_0303_0303_0303;
    let word = (word | word >> 6) & 0x000F_000F_000F_000F;
    let word = (word | word >> 12) & 0x0000_00FF_0000_00FF;
    (word | word >> 24) & 0xFFFF
}
