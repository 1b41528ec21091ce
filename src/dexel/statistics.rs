//! Statistics of a model, direction by direction.

use super::line::Line;
use super::place::{Place, Span};
use super::view::{OTHERS, RowsRef, TriDexelRef, with_rows};
use crate::lattice::Each;

/// Statistics of the rays of one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DexelStatistics {
    /// The number of rays that cross the solid.
    pub rays: u64,
    /// The number of intervals.
    pub intervals: u64,
    /// The number of bytes of the arrays.
    pub bytes: u64,
    /// The sum of the lengths of all intervals, times the area of a cell's face: an estimate of the volume
    /// (cubic model units), not a bound.
    pub volume: f64,
    /// The least and the greatest coordinate, on each axis, of the part that the rays cross (model units).
    /// The first is greater than the second if the rays cross nothing.
    pub extent: [[f64; 2]; 3],
}

impl TriDexelRef<'_> {
    /// The statistics of the rays along an axis; `None` if the model has none. O(n).
    pub fn statistics(&self, axis: usize) -> Option<DexelStatistics> {
        let rows = self.rays.get(axis)?.as_ref()?;
        Some(with_rows!(rows, rows => self.count(axis, rows)))
    }

    fn count<S: Span>(&self, axis: usize, rows: &RowsRef<'_, S>) -> DexelStatistics {
        let (depth, cell) = (self.frame.depth(), self.frame.cell_size());
        let mut statistics = DexelStatistics {
            rays: 0,
            intervals: rows.columns.spans.len() as u64,
            bytes: size_of_val(rows.starts) as u64
                + (rows.columns.spans.len() * self.format.bytes_per_interval()) as u64,
            volume: 0.0,
            extent: [[f64::INFINITY, f64::NEG_INFINITY]; 3],
        };
        let [u, v] = OTHERS[axis];
        // Rays of a damaged file may share intervals: each interval counts once.
        let mut met = 0;
        for row in 0..rows.window.size[1] as usize {
            // Row by row, so that sums of many small numbers are exact up to rounding.
            let mut length = 0.0;
            for column in 0..rows.window.size[0] as usize {
                let range = rows.at(row * rows.window.size[0] as usize + column);
                if range.is_empty() || range.start < met {
                    continue;
                }
                met = range.end;
                statistics.rays += 1;
                let mut grow = |axis: usize, low: f64, high: f64| {
                    let [least, most] = &mut statistics.extent[axis];
                    let line = Line { frame: &self.frame, axis };
                    *least = least.min(line.coordinate(low));
                    *most = most.max(line.coordinate(high));
                };
                let centre = |i: usize, k: usize| f64::from(rows.window.first[i]) + k as f64 + 0.5;
                grow(u, centre(0, column), centre(0, column));
                grow(v, centre(1, row), centre(1, row));
                for span in &rows.columns.spans[range] {
                    let [start, end] = span.ends().each(|end| end.cells(depth));
                    grow(axis, start, end);
                    length += end - start;
                }
            }
            statistics.volume += length * cell * cell * cell;
        }
        statistics
    }
}
