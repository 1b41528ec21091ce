//! Sums over cells.

use super::CellsIn;
use crate::cut;
use crate::lattice::{CellMoments, Frame, Interval};
use crate::octree::Tag;
use crate::solid::Enclosure;

/// The volume of a finest cell, in the units of the sums. There are at most 2^60 cells, so sums are below
/// 2^100.
const CELL: i128 = 1 << BITS;
const BITS: u32 = 40;

/// A bound above the error of a cell's volume bounds, including the rounding to whole units.
const SLACK: f64 = 2.0;

/// Numbers of cells, and their volume if it is wanted.
pub(super) struct Sums {
    cells: CellsIn,
    volume: Option<Share>,
}

/// The bounds of a volume, of a cell or of a sum, in units.
#[derive(Clone, Copy)]
pub(super) struct Share {
    least: i128,
    most: i128,
}

impl Share {
    pub(super) const WHOLE: Share = Share { least: CELL, most: CELL };
    pub(super) const UNKNOWN: Share = Share { least: 0, most: CELL };

    pub(super) fn of_moments(known: &CellMoments) -> Share {
        let volume = known.moments.volume;
        Share::between(volume - known.error, volume + known.error)
    }

    pub(super) fn of_enclosure(enclosure: &Enclosure) -> Share {
        let (low, high) = cut::bounds(enclosure);
        Share::between(low.volume, high.volume)
    }

    /// The share between two volumes in eighths of a cell, the unit of bounds by slabs and moments.
    fn between(low: f64, high: f64) -> Share {
        const EIGHTH: f64 = CELL as f64 / 8.0;
        let (low, high) = (libm::floor(low * EIGHTH) - SLACK, libm::ceil(high * EIGHTH) + SLACK);
        // NaN gives no bound.
        let least = if low > 0.0 { (low as i128).min(CELL) } else { 0 };
        let most = if high < CELL as f64 { (high as i128).max(least) } else { CELL };
        Share { least, most }
    }

    /// The bounds of the intersection of two sets within a cell that have these bounds.
    pub(super) fn common(self, other: Share) -> Share {
        Share { least: (self.least + other.least - CELL).max(0), most: self.most.min(other.most) }
    }
}

impl Sums {
    pub(super) fn of_cells() -> Sums {
        Sums { cells: CellsIn::default(), volume: None }
    }

    pub(super) fn of_volume() -> Sums {
        Sums { cells: CellsIn::default(), volume: Some(Share { least: 0, most: 0 }) }
    }

    /// True if [`add_share`](Self::add_share) is wanted.
    #[inline(always)]
    pub(super) fn has_volume(&self) -> bool {
        self.volume.is_some()
    }

    /// Adds `count` finest cells with these tags, neither of which is EMPTY, without their volume.
    #[inline(always)]
    pub(super) fn add(&mut self, solid: Tag, region: Tag, count: u64) {
        let CellsIn { full_least, full_most, upper_least, upper_most } = &mut self.cells;
        let add = |to: &mut u64, counts: bool| {
            *to = to.saturating_add(if counts { count } else { 0 });
        };
        add(full_least, solid == Tag::Full && region == Tag::Full);
        add(full_most, solid == Tag::Full);
        add(upper_least, region == Tag::Full);
        add(upper_most, true);
    }

    /// Adds `count` finest cells that the region may meet and whose tags in the solid are unknown.
    pub(super) fn add_unknown(&mut self, count: u64) {
        let CellsIn { full_most, upper_most, .. } = &mut self.cells;
        (*full_most, *upper_most) = (full_most.saturating_add(count), upper_most.saturating_add(count));
    }

    /// Adds the volume of `count` cells that each have this share.
    #[inline(always)]
    pub(super) fn add_share(&mut self, share: Share, count: u64) {
        if let Some(volume) = &mut self.volume {
            volume.least += share.least * i128::from(count);
            volume.most += share.most * i128::from(count);
        }
    }

    pub(super) fn cells(&self) -> CellsIn {
        self.cells
    }

    /// The volume in cubic model units.
    pub(super) fn volume(&self, frame: &Frame) -> Interval {
        let Share { least, most } = self.volume.unwrap_or(Share { least: 0, most: 0 });
        let units = Interval::between(Interval::of_integer(least).lower, Interval::of_integer(most).upper);
        let size = Interval::exactly(frame.cell_size());
        let cells = units.times(Interval::exactly(1.0 / CELL as f64));
        cells.times(size).times(size).times(size).not_negative()
    }
}
