//! Scan conversion of blocks of 64³ cells.
//!
//! Two bitmaps suffice: the cells that a triangle cuts, and the cell centres that lie inside. A cell that
//! nothing cuts is wholly on its centre's side. So the certified inner bound is the centres without the cut
//! cells, the outer bound the centres with the cut cells, and the sampled rule the centres alone.

use super::crossing::Projection;
use super::overlap::Overlap;
use super::placed::{Placed, ranks};
use crate::error::Error;
use crate::memory;
use crate::mesh::FillRule;
use crate::octree::Block;
use alloc::boxed::Box;
use alloc::vec::Vec;

const SIZE: usize = 64;
const COLUMNS: usize = SIZE * SIZE;

/// Bitmaps and counters of one block, kept from block to block.
pub(super) struct Scan {
    /// The cells that a triangle cuts: columns along z.
    cut: Box<[u64; COLUMNS]>,
    /// Winding numbers of the centres, modulo 4 in two's complement: −1 to 2.
    low: Box<[u64; COLUMNS]>,
    high: Box<[u64; COLUMNS]>,
    /// The winding numbers of the centres of the lowest layer.
    floor: Box<[i32; COLUMNS]>,
    /// The changes of the winding number along columns, for blocks in which it leaves the range of the
    /// bitmaps.
    changes: Vec<i32>,
}

/// A block: its lowest cell, the triangles that may cut it, and the winding number of its lowest centre.
#[derive(Clone, Copy)]
pub(super) struct Task<'t> {
    pub(super) placed: &'t Placed,
    pub(super) at: [i32; 3],
    pub(super) triangles: &'t [u32],
    pub(super) winding: i32,
    pub(super) fill: FillRule,
}

impl Scan {
    pub(super) fn new() -> Result<Scan, Error> {
        Ok(Scan {
            cut: memory::zeros()?,
            low: memory::zeros()?,
            high: memory::zeros()?,
            floor: memory::zeros()?,
            changes: Vec::new(),
        })
    }

    /// Fills the planes that `block` requests.
    pub(super) fn fill(&mut self, task: Task<'_>, block: &mut Block) -> Result<(), Error> {
        self.wind_floor(&task);
        if self.wind(&task) {
            let columns = self.low.iter_mut().zip(self.high.iter());
            match task.fill {
                FillRule::NonZero => columns.for_each(|(low, high)| *low |= high),
                // Among −1, 0, 1 and 2: the numbers whose two bits differ.
                FillRule::Positive => columns.for_each(|(low, high)| *low ^= high),
                FillRule::EvenOdd => {}
            }
        } else {
            self.wind_counting(&task)?;
        }
        let inside = &self.low;
        if let Some(centres) = block.centres_mut() {
            *centres = **inside;
        }
        if let Some((lower, upper)) = block.planes_mut() {
            mark_cut(&task, &mut self.cut);
            for (i, (&inside, &cut)) in inside.iter().zip(self.cut.iter()).enumerate() {
                (lower[i], upper[i]) = (inside & !cut, inside | cut);
            }
        }
        Ok(())
    }

    /// Computes the winding numbers of the lowest layer: from the block's lowest centre along x, then along
    /// y.
    fn wind_floor(&mut self, task: &Task<'_>) {
        let Task { placed, at, triangles, winding, .. } = *task;
        self.floor.fill(0);
        self.floor[0] = winding;
        for &triangle in triangles {
            let corners = placed.corners(triangle);
            let (first, end) = ranks(&corners, 2);
            if !(first <= at[2] && at[2] < end) {
                continue;
            }
            let (first, end) = ranks(&corners, 1);
            if first <= at[1] && at[1] < end {
                let mut seen = Projection::new(placed, triangle, corners, 0);
                if let Some(span) = seen.span(at[2]).filter(|span| span.first <= at[1] && at[1] < span.end) {
                    let x = seen.above(at[1], at[2], span.step) - at[0];
                    if (1..SIZE as i32).contains(&x) {
                        self.floor[x as usize] += span.step;
                    }
                }
            }
            if end <= at[1] || first >= at[1] + SIZE as i32 {
                continue;
            }
            let mut seen = Projection::new(placed, triangle, corners, 1);
            if let Some(span) = seen.span(at[2]) {
                for x in span.first.max(at[0])..span.end.min(at[0] + SIZE as i32) {
                    let y = seen.above(x, at[2], span.step) - at[1];
                    if (1..SIZE as i32).contains(&y) {
                        self.floor[y as usize * SIZE + (x - at[0]) as usize] += span.step;
                    }
                }
            }
        }
        for x in 1..SIZE {
            self.floor[x] += self.floor[x - 1];
        }
        for i in SIZE..COLUMNS {
            self.floor[i] += self.floor[i - SIZE];
        }
    }

    /// Computes the winding numbers of all centres in the bitmaps. Returns `false` if they do not fit.
    fn wind(&mut self, task: &Task<'_>) -> bool {
        let mut misfit = 0;
        for (column, &winding) in self.floor.iter().enumerate() {
            misfit |= !(-1..=2).contains(&winding) as u64;
            self.low[column] = (winding as u64 & 1).wrapping_neg();
            self.high[column] = (winding as u64 >> 1 & 1).wrapping_neg();
        }
        for_crossings(task, |column, z, step| {
            let above = !0 << z;
            let (low, high) = (self.low[column], self.high[column]);
            // Steps up from 2 and down from −1 leave the range.
            if step > 0 {
                misfit |= high & !low & above;
                self.high[column] = high ^ (low & above);
            } else {
                misfit |= high & low & above;
                self.high[column] = high ^ (!low & above);
            }
            self.low[column] = low ^ above;
        });
        misfit == 0
    }

    /// Computes the winding numbers with full counters, for blocks in which shells overlap several times. The
    /// lower bits then say whether a centre is inside.
    #[cold]
    fn wind_counting(&mut self, task: &Task<'_>) -> Result<(), Error> {
        self.changes.clear();
        self.changes.try_reserve_exact(COLUMNS * SIZE)?;
        self.changes.resize(COLUMNS * SIZE, 0);
        let changes = &mut self.changes;
        for_crossings(task, |column, z, step| changes[column * SIZE + z as usize] += step);
        for (column, changes) in changes.chunks_exact(SIZE).enumerate() {
            let mut winding = self.floor[column];
            let mut inside = 0;
            for (z, change) in changes.iter().enumerate() {
                winding += change;
                inside |= (task.fill.encloses(winding) as u64) << z;
            }
            self.low[column] = inside;
        }
        Ok(())
    }
}

/// Calls `cross(column, z, step)` for every triangle that a column of the block pierces above its lowest
/// centre: z (1 to 63) is the first centre above the triangle.
#[inline(always)]
fn for_crossings(task: &Task<'_>, mut cross: impl FnMut(usize, u32, i32)) {
    let Task { placed, at, triangles, .. } = *task;
    let [x0, y0, z0] = at;
    let size = SIZE as i32;
    for &triangle in triangles {
        let corners = placed.corners(triangle);
        let meets = |axis: usize| {
            let (first, end) = ranks(&corners, axis);
            first < end && first < at[axis] + size && end > at[axis]
        };
        let (lowest, highest) = ranks(&corners, 2);
        if !(meets(0) && meets(1)) || lowest >= z0 + size || highest <= z0 {
            continue;
        }
        let mut seen = Projection::new(placed, triangle, corners, 2);
        let (first, end) = seen.rows();
        for row in first.max(y0)..end.min(y0 + size) {
            let Some(span) = seen.span(row) else { continue };
            let columns = (row - y0) as usize * SIZE;
            for x in span.first.max(x0)..span.end.min(x0 + size) {
                let z = seen.above(x, row, span.step) - z0;
                if 0 < z && z < size {
                    cross(columns + (x - x0) as usize, z as u32, span.step);
                }
            }
        }
    }
}

/// Marks the cells of the block that a triangle cuts.
fn mark_cut(task: &Task<'_>, cut: &mut [u64; COLUMNS]) {
    cut.fill(0);
    let [x0, y0, z0] = task.at;
    for &triangle in task.triangles {
        let overlap = Overlap::new(task.placed, &task.placed.corners(triangle), 1.0, 0);
        let range = |axis: usize| cells(overlap.min[axis], overlap.max[axis], task.at[axis]);
        let ((xa, xb), (ya, yb), (za, zb)) = (range(0), range(1), range(2));
        if xa > xb || ya > yb || za > zb {
            continue;
        }
        let mut by_x = [0u64; SIZE];
        for x in xa..=xb {
            by_x[(x - x0) as usize] = overlap.beside(1, x as f64, z0, za, zb);
        }
        for y in ya..=yb {
            let row = (y - y0) as usize * SIZE;
            let by_y = overlap.beside(0, y as f64, z0, za, zb);
            if by_y == 0 {
                continue;
            }
            for x in xa..=xb {
                let column = (x - x0) as usize;
                let candidates = by_y & by_x[column] & !cut[row + column];
                if candidates != 0 && overlap.over(x as f64, y as f64) {
                    let first = z0 + candidates.trailing_zeros() as i32;
                    let last = z0 + 63 - candidates.leading_zeros() as i32;
                    cut[row + column] |= candidates & overlap.plane(x as f64, y as f64, z0, first, last);
                }
            }
        }
    }
}

/// The first and the last of the 64 cells from `at` on whose open interval meets `(min, max)`. A flat range
/// on a lattice plane meets none.
fn cells(min: f64, max: f64, at: i32) -> (i32, i32) {
    use crate::lattice::exact::floor;
    let (low, high) = (at as f64, (at + SIZE as i32) as f64);
    let first = floor(min.clamp(low, high)) as i32;
    let last = -floor(-max.clamp(low, high)) as i32 - 1;
    (first, last.min(at + SIZE as i32 - 1))
}
