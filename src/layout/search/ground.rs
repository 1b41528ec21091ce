//! The cells that are taken before anything is placed.

use super::super::Layout;
use super::super::proof::diagonal;
use super::bits::{Bits, REACH, scale_for};
use super::forms::{FINER, Forms};
use super::space::Space;
use super::voxels::{Voxels, outside};
use super::{Direction, SearchOptions};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Affine, Bounds, axes};
use crate::memory;
use crate::solid::{AnySolid, Solid};
use alloc::vec::Vec;

/// The default number of cells along the mean side of the smallest item, and the limits of the number along
/// the container.
const ACROSS: f64 = 32.0;
const CELLS: [f64; 2] = [32.0, 256.0];

/// The cells of the search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    /// The lower corner of the first cell, and the edge of all cells (model units).
    pub(super) origin: [f64; 3],
    pub(super) cell: f64,
    pub(super) size: [usize; 3],
}

impl Lattice {
    /// Chooses the lattice. `left` is the number of copies of each item to place.
    pub(super) fn of(layout: &Layout, options: &SearchOptions, left: &[u32]) -> Lattice {
        let container = &layout.container;
        let margin = if container.is_box() { container.clearance() } else { 0.0 };
        let bounds = container.bounds();
        let origin = bounds.min.each(|low| low + margin);
        let length: [f64; 3] = axes(|k| (bounds.max[k] - margin - origin[k]).max(0.0));
        let longest = length.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        let cells = match options.cells {
            0 => {
                let items = layout.items.iter().zip(left).filter(|(_, left)| **left > 0);
                let sides = items.map(|(item, _)| diagonal(&item.bounds) / sqrt(3.0));
                let least = sides.fold(longest, f64::min).max(f64::MIN_POSITIVE);
                (ACROSS * longest / least).clamp(CELLS[0], CELLS[1])
            }
            cells => f64::from(cells),
        };
        let cell = longest / libm::ceil(cells);
        // (The proof rejects places that rounding makes too large.)
        let size = length.each(|length| (length / cell * (1.0 + 1e-12)) as usize);
        Lattice { origin, cell, size }
    }

    /// Returns the clearance between items, or an equivalent smaller one for this container.
    fn clearance(&self, layout: &Layout) -> f64 {
        layout.clearance.min(diagonal(layout.container.bounds()) + self.cell)
    }

    /// Returns the forms of all items.
    pub(super) fn forms(
        &self,
        layout: &Layout,
        maps: &[Vec<Affine>],
        control: &Control<'_>,
    ) -> Result<Vec<Forms>, Error> {
        let across = diagonal(layout.container.bounds());
        let clearance = self.clearance(layout);
        let mut forms = memory::with_capacity(maps.len())?;
        let mut left = control.max_bytes;
        for (item, maps) in layout.items.iter().zip(maps) {
            let longest = (0..3).map(|k| item.bounds.max[k] - item.bounds.min[k]).fold(0.0, f64::max);
            // An item longer than the container's diagonal fits nowhere, and has many cells.
            let maps = if longest > across { &[] } else { &maps[..] };
            let own =
                Forms::of(item, maps, [self.cell, clearance], &Control { max_bytes: left, ..*control })?;
            if let (Some(left), Some(limit)) = (&mut left, control.max_bytes) {
                *left = left.checked_sub(own.bytes()).ok_or(Error::Limit { what: "bytes", limit })?;
            }
            forms.push(own);
        }
        Ok(forms)
    }

    /// Returns the space for forms. The outside of the container, obstacles, and placed copies are taken.
    pub(super) fn space(
        &self,
        layout: &Layout,
        forms: &[Forms],
        free_along: Option<Direction>,
        control: &Control<'_>,
    ) -> Result<Space, Error> {
        let runs = forms.iter().flat_map(|forms| &forms.all).flat_map(|form| &form.shape.runs);
        let longest = runs.map(|run| run.length as usize).fold(1, usize::max);
        let mut space = Space::new(self.size, longest)?;
        let container = &layout.container;
        if !container.is_box() {
            let across = diagonal(container.bounds());
            let margin = container.clearance().min(across) / self.cell;
            let scale = scale_for(margin);
            let (margin, cell) = (margin / scale as f64, self.cell * scale as f64);
            let size = self.size.each(|size| size.div_ceil(scale));
            let pad = libm::ceil(margin) as usize;
            let wall = outside(container.solid(), self.origin, cell, size, pad, control)?;
            let wall = if pad > 0 { wall.grown(margin, pad)? } else { wall };
            space.take(&wall, scale, [-((2 * pad * scale) as isize); 3], None)?;
        }
        let (shade, clearance) = (free_along.map(Direction::back), self.clearance(layout));
        for obstacle in &layout.obstacles {
            let (cells, scale, offset) =
                self.taken(obstacle.solid(), obstacle.bounds(), clearance, control)?;
            space.take(&cells, scale, offset, shade)?;
        }
        for (placed, block) in layout.placed.iter().zip(&layout.boxes) {
            control.check()?;
            let solid = layout.items[placed.item].solid.placed(&placed.placement)?;
            let bounds = solid.bounds().and_then(|own| own.common(block)).unwrap_or(*block);
            let (cells, scale, offset) = self.taken(&solid, &bounds, clearance, control)?;
            space.take(&cells, scale, offset, shade)?;
        }
        Ok(space)
    }

    /// Returns the cells that a solid takes from others, the edge of such a cell in cells of the search, and
    /// the position of the first of them.
    fn taken(
        &self,
        solid: &AnySolid,
        bounds: &Bounds,
        clearance: f64,
        control: &Control<'_>,
    ) -> Result<(Bits, usize, [isize; 3]), Error> {
        let fine = self.cell / FINER as f64;
        let Voxels { bits, origin } = Voxels::of(solid, bounds, fine, Some(self.origin), control)?;
        let at: [isize; 3] = axes(|k| libm::round((origin[k] - self.origin[k]) / fine) as isize);
        let reach = clearance / fine;
        let is_near = reach <= REACH;
        let pad = if is_near { libm::ceil(reach) as usize } else { 0 };
        let bits = if pad > 0 { bits.grown(reach, pad)? } else { bits };
        let first = at.each(|at| at - pad as isize);
        let low = first.each(|first| first.div_euclid(FINER as isize));
        let beyond: [usize; 3] = axes(|k| (first[k] - low[k] * FINER as isize) as usize);
        let cells = bits.coarser(FINER, beyond)?;
        if is_near {
            return Ok((cells, 1, low));
        }
        let (grown, scale, below) = cells.grown_far(clearance / self.cell)?;
        Ok((grown, scale, low.each(|low| low - below as isize)))
    }
}
