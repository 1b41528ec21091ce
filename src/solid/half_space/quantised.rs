//! Slabs of one cell in whole numbers, rounded outward once.

use super::slab::ThickPlane;
use super::{HalfSpace, PlacedHalfSpace, Surface};
use crate::lattice::Each;
use crate::lattice::{Affine, Cell, Frame, Interval, axes};
use crate::octree::cuts::{CellSlab, Steps, Universe};
use alloc::sync::Arc;

/// The number of steps between the planes: as many as the roundings of both planes allow.
const STEPS: f64 = (Steps::MOST_WIDTH - 2) as f64;

/// The greatest factor by which a slab may become thicker.
const THICKER: f64 = 1.4;

/// Slabs thinner than the tolerance over this number may become thicker by any factor.
const FINE: f64 = 1024.0;

impl PlacedHalfSpace {
    /// Returns a slab in model space that is used in one cell alone, its `index`-th, in whole numbers. Every
    /// point of the cell that the result proves inside or outside has that side for the slab, too. `None` if
    /// the half-space is no slab; if the slab is thicker in the cell than `tolerance` (model units); and if
    /// rounding would make the slab thicker by more than two fifths and thicker than a 1024th of `tolerance`,
    /// as in cells that are large compared with its width.
    pub(crate) fn quantised(
        &self,
        frame: &Frame,
        cell: Cell,
        index: u8,
        tolerance: f64,
    ) -> Option<PlacedHalfSpace> {
        let &Surface::Slab(ThickPlane { normal, inner, outer, .. }) = &*self.half_space.0 else {
            return None;
        };
        if !(self.placements.is_empty() && inner.is_finite() && outer.is_finite()) {
            return None;
        }
        let axis = (0..3).fold(0, |best, i| if normal[i].abs() > normal[best].abs() { i } else { best });
        let greatest = normal[axis].abs();
        let others = [1, 2].each(|k| {
            let unit = libm::round(normal[(axis + k) % 3] / greatest * Steps::UNIT);
            unit.clamp(1.0 - Steps::UNIT, Steps::UNIT - 1.0) as i16
        });
        let is_negative = normal[axis] < 0.0;
        let steps = Steps { axis, is_negative, others, offset: 0, width: 0, step: 0 };

        // In units of the universe, from the centre of the cell, for a normal whose greatest component is ±1.
        let (own, unit) = (normal.each(Interval::exactly), Interval::exactly(greatest));
        let edge = Interval::exactly(frame.edge());
        let centre = axes(|i| {
            let centre = (2 * u64::from(cell.at[i]) + 1) as f64 / (2u64 << cell.level) as f64;
            edge.times(Interval::exactly(centre)).plus(Interval::exactly(frame.origin()[i]))
        });
        let along = (0..3).fold(Interval::exactly(0.0), |sum, i| sum.plus(own[i].times(centre[i])));
        let scale = unit.times(edge);
        let offset = |offset: f64| Interval::exactly(offset).minus(along).over(scale);
        let (inner, outer) = (offset(inner), offset(outer));
        // The error of the rounded normal at the corners of the cell.
        let half = 0.5 / (1u64 << cell.level) as f64;
        let rounded = steps.normal();
        let turned = (0..3).fold(Interval::exactly(0.0), |sum, i| {
            let off = own[i].over(unit).minus(Interval::exactly(rounded[i]));
            // (A power of two: exact.)
            sum.plus(Interval::exactly(off.upper.max(-off.lower) * half))
        });
        // Offsets beyond the cell's corners do not matter.
        let reach = rounded.iter().map(|c| c.abs()).sum::<f64>() * half;
        let in_cell = |offset: f64| offset.clamp(-reach, reach);
        let before = in_cell(outer.upper) - in_cell(inner.lower);
        let (low, high) = (in_cell(inner.minus(turned).lower), in_cell(outer.plus(turned).upper));

        let wanted =
            f64::max((high - low) / STEPS, low.abs().max(high.abs()) / f64::from(Steps::MOST_OFFSET));
        let is_fine = |step: &u8| 1.0 / (1u64 << step) as f64 >= wanted;
        let step = Steps::STEPS.rev().find(is_fine)?;
        let size = 1.0 / (1u64 << step) as f64;
        let (first, last) = (libm::floor(low / size), libm::ceil(high / size));
        let width = last - first;
        let most = tolerance / frame.edge();
        let is_thin = before <= most && width * size <= f64::max(THICKER * before, most / FINE);
        let fits = width <= f64::from(Steps::MOST_WIDTH) && first.abs() <= f64::from(Steps::MOST_OFFSET);
        // (NaN does not compare as less.)
        if !(is_thin && fits) {
            return None;
        }
        let steps = Steps { offset: first as i32, width: width as u8, step, ..steps };
        let placements = Arc::from([Affine::new(Universe::of(frame).rows()).ok()?]);
        let half_space = HalfSpace::of_cell(CellSlab::new(cell, index, &steps), None);
        Some(PlacedHalfSpace { half_space, placements })
    }
}
