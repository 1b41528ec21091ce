//! Finds the box of a solid on a lattice, with few splits.

use super::split::split_one;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::solid::{Verdict, Worker};
use core::ops::Range;

/// The number of levels between one attempt and the next.
const STEP: u8 = 4;
/// The greatest number of splits of an attempt.
const SPLITS: u32 = 1 << 14;

/// Returns a range of finest cells on each axis: a box that contains all cells that are not EMPTY. It is as
/// narrow as some thousand splits can prove. Cells that lie in the box of other cells are not split. The box
/// of an empty solid is empty.
///
/// # Errors
/// Those of the worker, and [`Error::Cancelled`].
pub(crate) fn hull<W: Worker>(
    worker: &mut W,
    depth: u8,
    control: &Control<'_>,
) -> Result<[Range<u32>; 3], Error> {
    let mut found = [0..1 << depth, 0..1 << depth, 0..1 << depth];
    let mut level = STEP.min(depth);
    loop {
        let mut search =
            Search { worker, depth, level, splits: 0, control, low: [u32::MAX; 3], high: [0; 3] };
        let root = search.worker.root()?;
        if !search.visit(Cell::ROOT, root)? {
            return Ok(found);
        }
        found = axes(|axis| search.low[axis].min(search.high[axis])..search.high[axis]);
        if level == depth {
            return Ok(found);
        }
        level = (level + STEP).min(depth);
    }
}

/// An attempt down to one level.
struct Search<'a, W> {
    worker: &'a mut W,
    depth: u8,
    level: u8,
    splits: u32,
    control: &'a Control<'a>,
    low: [u32; 3],
    high: [u32; 3],
}

impl<W: Worker> Search<'_, W> {
    /// Widens the box by the part of a cell that is not EMPTY. Returns `false` if the splits are spent. The
    /// recursion is as deep as the frame, at most 20 levels.
    fn visit(&mut self, cell: Cell, verdict: Verdict<W::Part>) -> Result<bool, Error> {
        let shift = self.depth - cell.level;
        let (low, high) = (cell.at.each(|a| a << shift), cell.at.each(|a| (a + 1) << shift));
        if (0..3).all(|axis| self.low[axis] <= low[axis] && high[axis] <= self.high[axis]) {
            return Ok(true);
        }
        match verdict {
            Verdict::Empty => Ok(true),
            Verdict::Partial(part) if cell.level < self.level => {
                self.splits += 1;
                if self.splits > SPLITS {
                    return Ok(false);
                }
                self.control.check()?;
                let mark = self.worker.mark();
                let verdicts = split_one(self.worker, cell, &part, self.control)?;
                for (octant, verdict) in (0..8).zip(verdicts) {
                    if !self.visit(cell.child(octant), verdict)? {
                        return Ok(false);
                    }
                }
                self.worker.release(mark);
                Ok(true)
            }
            _ => {
                for axis in 0..3 {
                    self.low[axis] = self.low[axis].min(low[axis]);
                    self.high[axis] = self.high[axis].max(high[axis]);
                }
                Ok(true)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Frame;
    use crate::solid::{Classifier, Csg, Solid};

    fn of(solid: &Csg, depth: u8) -> [Range<u32>; 3] {
        let frame = Frame::new([0.0; 3], 1.0, depth).unwrap();
        let control = Control::default();
        hull(&mut solid.on(&frame, &control).unwrap().worker().unwrap(), depth, &control).unwrap()
    }

    #[test]
    fn small_solids_are_found_in_large_universes() {
        let cell = 2f64.powi(-20);
        let at = |k: f64| [k * cell, 0.25, 0.75];
        let block = Csg::cuboid(at(3.0), at(5.0).map(|x| x + cell)).unwrap();
        let quarter = 1 << 18;
        assert_eq!(of(&block, 20), [3..6, quarter..quarter + 1, 3 * quarter..3 * quarter + 1]);
        assert_eq!(of(&block.complement(), 20), [0..1 << 20, 0..1 << 20, 0..1 << 20]);
        let outside = Csg::ball([3.0; 3], 0.5).unwrap();
        assert!(of(&outside, 20).iter().all(|range| range.is_empty()));
    }

    #[test]
    fn the_box_holds_the_solid_and_not_much_more() {
        let ball = Csg::ball([0.5, 0.5, 0.5], 0.25).unwrap();
        for depth in [1, 4, 6, 10, 20] {
            let cells = f64::from(1u32 << depth);
            for range in of(&ball, depth) {
                let (low, high) = (f64::from(range.start) / cells, f64::from(range.end) / cells);
                assert!(low <= 0.25 && 0.75 <= high, "depth {depth}: {range:?}");
                assert!(high - low <= 0.5 + 2.0 / cells.min(32.0), "depth {depth}: {range:?}");
            }
        }
    }
}
