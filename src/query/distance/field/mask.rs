//! The cells of a range as bits, in rows along z.

use super::sets;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::morton;
use crate::memory;
use crate::octree::links::Windows;
use crate::octree::view::OctreeRef;
use crate::octree::{Planes, Tag};
use alloc::vec::Vec;

/// The finest cells from `min` to before `max`. All coordinates are one more than the cells' own, so that one
/// layer of the space around the universe has coordinates, too.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Range {
    pub(super) min: [u32; 3],
    pub(super) max: [u32; 3],
}

impl Range {
    pub(super) fn size(&self) -> [u32; 3] {
        axes(|axis| self.max[axis].saturating_sub(self.min[axis]))
    }

    pub(super) fn cells(&self) -> u64 {
        self.size().into_iter().map(u64::from).product()
    }

    pub(super) fn within(&self, other: &Range) -> Range {
        Range {
            min: axes(|axis| self.min[axis].max(other.min[axis])),
            max: axes(|axis| self.max[axis].min(other.max[axis])),
        }
    }

    /// Divides the range into blocks of this edge, or less at the upper sides.
    pub(super) fn blocks(self, edge: u32) -> impl Iterator<Item = Range> {
        let counts = self.size().each(|size| size.div_ceil(edge));
        let places = (0..counts[2])
            .flat_map(move |z| (0..counts[1]).flat_map(move |y| (0..counts[0]).map(move |x| [x, y, z])));
        places.map(move |place| {
            let min = axes(|axis| self.min[axis] + place[axis] * edge);
            Range { min, max: min.each(|a| a + edge) }.within(&self)
        })
    }
}

/// A set of cells in a range.
pub(super) struct Mask {
    pub(super) range: Range,
    /// Number of words in a row.
    row: usize,
    bits: Vec<u64>,
}

impl Mask {
    fn new(range: Range) -> Result<Mask, Error> {
        let [x, y, z] = range.size().each(|edge| edge as usize);
        let row = z.div_ceil(64);
        Ok(Mask { range, row, bits: memory::filled(x * y * row, 0)? })
    }

    /// Returns the set around the solid, and the set inside unless both are the same.
    pub(super) fn both(
        tree: &OctreeRef<'_>,
        range: Range,
        job: &Job<'_>,
    ) -> Result<(Mask, Option<Mask>), Error> {
        let masks = [Mask::new(range)?, Mask::new(range)?];
        let mut fill = Fill { tree, masks, job, windows: Windows::new(tree) };
        let end = tree.frame.cells() + 1;
        let universe = Range { min: [1; 3], max: [end; 3] };
        fill.cells(Range { min: [0; 3], max: [end + 1; 3] }, tree.exterior);
        fill.clear(universe);
        match tree.root {
            Tag::Branch => fill.element(0, 0, [1; 3])?,
            tag => fill.cells(universe, tag),
        }
        let [outer, inner] = fill.masks;
        Ok(if outer.bits == inner.bits { (outer, None) } else { (outer, Some(inner)) })
    }

    /// The row of bits at x, y.
    pub(super) fn row(&self, x: u32, y: u32) -> &[u64] {
        let first = self.first(x, y);
        &self.bits[first..first + self.row]
    }

    fn first(&self, x: u32, y: u32) -> usize {
        let [width, ..] = self.range.size();
        ((y - self.range.min[1]) as usize * width as usize + (x - self.range.min[0]) as usize) * self.row
    }

    /// Makes all cells of a range members, or none of them.
    fn set(&mut self, cells: Range, member: bool) {
        let cells = cells.within(&self.range);
        if cells.cells() == 0 {
            return;
        }
        let (from, to) = (cells.min[2] - self.range.min[2], cells.max[2] - self.range.min[2]);
        for y in cells.min[1]..cells.max[1] {
            for x in cells.min[0]..cells.max[0] {
                let first = self.first(x, y);
                for word in from / 64..=(to - 1) / 64 {
                    let below = |end: u32| match end.saturating_sub(64 * word) {
                        0..64 => (1 << (end.saturating_sub(64 * word))) - 1,
                        _ => !0u64,
                    };
                    let bits = below(to) & !below(from);
                    let place = &mut self.bits[first + word as usize];
                    *place = if member { *place | bits } else { *place & !bits };
                }
            }
        }
    }

    /// Makes the cells of a 4³ brick members whose bits are set; the first cell is at `at`.
    fn add_brick(&mut self, at: [u32; 3], cells: u64) {
        let z = i64::from(at[2]) - i64::from(self.range.min[2]);
        let end = i64::from(self.range.max[2] - self.range.min[2]);
        for y in 0..4 {
            for x in 0..4 {
                let column = [at[0] + x, at[1] + y];
                if (0..2).any(|axis| !(self.range.min[axis]..self.range.max[axis]).contains(&column[axis])) {
                    continue;
                }
                // The bits of a column, z from 0 to 3.
                let w = cells >> morton::index(x, y, 0);
                let mut bits = (w & 1) | (w >> 3 & 2) | (w >> 30 & 4) | (w >> 33 & 8);
                let mut low = z;
                if low < 0 {
                    bits = if low > -4 { bits >> -low } else { 0 };
                    low = 0;
                }
                if low + 4 > end {
                    bits &= if low < end { (1 << (end - low)) - 1 } else { 0 };
                }
                if bits == 0 {
                    continue;
                }
                let first = self.first(column[0], column[1]) + (low / 64) as usize;
                self.bits[first] |= bits << (low % 64);
                if low % 64 > 60 && bits >> (64 - low % 64) != 0 {
                    self.bits[first + 1] |= bits >> (64 - low % 64);
                }
            }
        }
    }
}

/// The descent in a stored tree.
struct Fill<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    masks: [Mask; 2],
    job: &'t Job<'t>,
    windows: Windows,
}

impl Fill<'_, '_> {
    fn cells(&mut self, cells: Range, tag: Tag) {
        for (mask, member) in self.masks.iter_mut().zip(sets(tag)) {
            if member {
                mask.set(cells, true);
            }
        }
    }

    fn clear(&mut self, cells: Range) {
        self.masks.iter_mut().for_each(|mask| mask.set(cells, false));
    }

    /// Adds the part of element `index` of level `e` that lies in the range; `at` is the element's lowest
    /// cell. The recursion is as deep as the tree has element levels, ten at the most.
    fn element(&mut self, e: usize, index: usize, at: [u32; 3]) -> Result<(), Error> {
        self.job.check()?;
        let levels = self.tree.levels();
        let planes = self.tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
        let shift = 2 * (levels - 1 - e);
        let mut real = if e == 0 { self.tree.root_cells() } else { !0 };
        if shift == 0 {
            // A branch among finest cells is damage.
            let branch = planes.branch();
            self.masks[0].add_brick(at, (planes.upper | branch) & real);
            self.masks[1].add_brick(at, planes.full() & real);
            return Ok(());
        }
        let range = self.masks[0].range;
        for axis in 0..3 {
            let first = range.min[axis].saturating_sub(at[axis]) >> shift;
            // (The parent excludes a range that ends before the element.)
            let last = (range.max[axis].saturating_sub(at[axis] + 1) >> shift).min(3);
            real &= morton::slabs(axis, first, last);
        }
        while real != 0 {
            let c = real.trailing_zeros();
            real &= real - 1;
            let place = morton::position(c);
            let corner = axes(|axis| at[axis] + (place[axis] << shift));
            let whole = Range { min: corner, max: corner.each(|a| a + (1 << shift)) };
            match planes.tag(c) {
                Tag::Branch => match self.windows.child(self.tree, index, planes.branch(), c, e + 1) {
                    Ok(child) => self.element(e + 1, child, corner)?,
                    Err(_) => self.cells(whole, Tag::Partial),
                },
                Tag::Empty => {}
                tag => self.cells(whole, tag),
            }
        }
        Ok(())
    }
}
