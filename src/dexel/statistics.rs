//! How much a model holds, direction by direction.

use super::line::Line;
use super::place::{Place, Span};
use super::view::{OTHERS, RowsRef, TriDexelRef, with_rows};

/// What the rays of one direction hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DexelStatistics {
    /// Rays that cross the solid.
    pub rays: u64,
    /// Intervals.
    pub intervals: u64,
    /// Bytes of the arrays.
    pub bytes: u64,
    /// The sum of the lengths of all intervals, each times the area of a cell's face: an estimate of the
    /// volume (cubic model units), not a bound.
    pub volume: f64,
    /// The least and the greatest coordinate on each axis of what the rays cross (model units); the first is
    /// greater than the second if they cross nothing.
    pub extent: [[f64; 2]; 3],
}

impl TriDexelRef<'_> {
    /// What the rays along an axis hold; `None` if the model has none. O(n).
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
        // Rays of a damaged file may have intervals in common: each is met once.
        let mut met = 0;
        for row in 0..rows.window.size[1] as usize {
            // Row by row, so that sums of many small numbers stay exact to rounding.
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
                    let [start, end] = span.ends().map(|end| end.cells(depth));
                    grow(axis, start, end);
                    length += end - start;
                }
            }
            statistics.volume += length * cell * cell * cell;
        }
        statistics
    }
}
