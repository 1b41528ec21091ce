//! Checks of a model's arrays.

use super::place::{Place, Span};
use super::view::{RowsRef, TriDexelRef, carries, with_rows};
use crate::error::Error;

impl TriDexelRef<'_> {
    /// Rejects arrays that are unchecked and damaged. Every operation that reads all rays calls this first:
    /// merges rely on ascending ends, and on rays that share no interval.
    ///
    /// # Errors
    /// [`Error::DamagedRays`].
    pub(crate) fn sound(&self) -> Result<(), Error> {
        if self.checked { Ok(()) } else { self.check() }
    }

    /// Checks the whole model. Rays must be in order. Intervals must be non-empty, disjoint and inside the
    /// universe, and may touch only where their materials differ. Normals must be valid codes, and windows
    /// must be no larger than needed. Agreement between the directions is not checked. O(n).
    ///
    /// # Errors
    /// [`Error::DamagedRays`].
    pub fn check(&self) -> Result<(), Error> {
        for (axis, rows) in self.rays.iter().enumerate() {
            if let Some(rows) = rows {
                with_rows!(rows, rows => self.check_rows(axis, rows))?;
            }
        }
        Ok(())
    }

    fn check_rows<S: Span>(&self, axis: usize, rows: &RowsRef<'_, S>) -> Result<(), Error> {
        let damage = |ray: u64| Error::DamagedRays { axis: axis as u8, ray };
        let (window, depth) = (rows.window, self.frame.depth());
        let count = window.count();
        let in_universe = (0..2)
            .all(|i| u64::from(window.first[i]) + u64::from(window.size[i]) <= u64::from(self.frame.cells()));
        let empty_is_nowhere = !window.is_empty() || window == Default::default();
        let starts = rows.starts;
        if !in_universe
            || !empty_is_nowhere
            || starts.len() as u64 != count + 1
            || starts.first() != Some(&0)
            || starts.last().copied() != u32::try_from(rows.columns.spans.len()).ok()
            || !carries(&rows.columns, &self.format)
        {
            return Err(damage(0));
        }
        let mut touched = [false; 4];
        for (ray, range) in starts.windows(2).enumerate() {
            if range[0] > range[1] || range[1] as usize > rows.columns.spans.len() {
                return Err(damage(ray as u64));
            }
            if range[0] < range[1] {
                let at = [ray as u64 % u64::from(window.size[0]), ray as u64 / u64::from(window.size[0])];
                for i in 0..2 {
                    touched[2 * i] |= at[i] == 0;
                    touched[2 * i + 1] |= at[i] + 1 == u64::from(window.size[i]);
                }
            }
            let mut last: Option<(S::Place, u32)> = None;
            for i in range[0] as usize..range[1] as usize {
                let item = rows.columns.item(i);
                let [start, end] = item.ends;
                let apart = last.is_none_or(|(end, material)| {
                    end < start || end == start && self.format.materials && material != item.material
                });
                // (Comparisons with NaN are false.)
                let inside = S::Place::LOW <= start && start < end && end <= S::Place::high(depth);
                if !(apart && inside && start.is_plain() && rows.columns.has_codes(i)) {
                    return Err(damage(ray as u64));
                }
                last = Some((end, item.material));
            }
        }
        if window.is_empty() || touched == [true; 4] { Ok(()) } else { Err(damage(0)) }
    }
}
