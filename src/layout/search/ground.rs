//! Cells that are taken before anything is placed.

use super::super::Layout;
use super::super::proof::diagonal;
use super::bits::Bits;
use super::forms::{FINER, Forms};
use super::space::Space;
use super::voxels::{Voxels, outside};
use super::{Direction, SearchOptions};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::lattice::{Affine, Bounds, axes};
use crate::memory;
use crate::solid::{AnySolid, Solid};
use alloc::vec::Vec;

/// Cells along the mean side of the smallest item, if nobody asks for a number, and along the container.
const ACROSS: f64 = 32.0;
const CELLS: [f64; 2] = [32.0, 256.0];

/// The cells by which is searched.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    /// The lower corner of the first cell, and the edge of all (model units).
    pub(super) origin: [f64; 3],
    pub(super) cell: f64,
    pub(super) size: [usize; 3],
}

impl Lattice {
    /// `left` says how many copies of each item are to be placed.
    pub(super) fn of(layout: &Layout, options: &SearchOptions, left: &[u32]) -> Lattice {
        let container = &layout.container;
        let margin = if container.is_box() { container.clearance() } else { 0.0 };
        let bounds = container.bounds();
        let origin = bounds.min.map(|low| low + margin);
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
        // (What rounding makes too large is found out by the proof.)
        let size = length.map(|length| (length / cell * (1.0 + 1e-12)) as usize);
        Lattice { origin, cell, size }
    }

    /// The forms of all items.
    pub(super) fn forms(
        &self,
        layout: &Layout,
        maps: &[Vec<Affine>],
        control: &Control<'_>,
    ) -> Result<Vec<Forms>, Error> {
        let mut forms = memory::with_capacity(maps.len())?;
        for (item, maps) in layout.items.iter().zip(maps) {
            forms.push(Forms::of(item, maps, self.cell, layout.clearance, control)?);
        }
        Ok(forms)
    }

    /// The space in which forms go: what is beside the container, obstacles, and what is placed, are taken.
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
            let margin = container.clearance() / self.cell;
            let pad = libm::ceil(margin) as usize;
            let wall = outside(container.solid(), self.origin, self.cell, self.size, pad, control)?;
            let wall = if pad > 0 { wall.grown(margin, pad)? } else { wall };
            space.take(&wall, [-(2 * pad as isize); 3], None)?;
        }
        let shade = free_along.map(Direction::back);
        for obstacle in &layout.obstacles {
            let (cells, offset) =
                self.taken(obstacle.solid(), obstacle.bounds(), layout.clearance, control)?;
            space.take(&cells, offset, shade)?;
        }
        for (placed, block) in layout.placed.iter().zip(&layout.boxes) {
            control.check()?;
            let solid = layout.items[placed.item].solid.placed(&placed.placement)?;
            let bounds = solid.bounds().and_then(|own| own.common(block)).unwrap_or(*block);
            let (cells, offset) = self.taken(&solid, &bounds, layout.clearance, control)?;
            space.take(&cells, offset, shade)?;
        }
        Ok(space)
    }

    /// The cells that a solid takes from others, and where the first of them is.
    fn taken(
        &self,
        solid: &AnySolid,
        bounds: &Bounds,
        clearance: f64,
        control: &Control<'_>,
    ) -> Result<(Bits, [isize; 3]), Error> {
        let fine = self.cell / FINER as f64;
        let reach = clearance / fine;
        let pad = libm::ceil(reach) as usize;
        let Voxels { bits, origin } = Voxels::of(solid, bounds, fine, Some(self.origin), control)?;
        let bits = if pad > 0 { bits.grown(reach, pad)? } else { bits };
        let first: [isize; 3] =
            axes(|k| libm::round((origin[k] - self.origin[k]) / fine) as isize - pad as isize);
        let low = first.map(|first| first.div_euclid(FINER as isize));
        let beyond: [usize; 3] = axes(|k| (first[k] - low[k] * FINER as isize) as usize);
        Ok((bits.coarser(FINER, beyond)?, low))
    }
}
