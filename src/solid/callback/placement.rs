//! The positions of cells and points in the space of a host's shape that was moved.

use super::gradient::GradientRange;
use super::middle;
use crate::lattice::Each;
use crate::lattice::{Affine, Bounds, Cube, Interval, Inverse, axes};
use crate::solid::{Enclosure, Slab};

/// A box in model units: lower and upper corner.
pub(super) type Corners = [[f64; 3]; 2];

/// The placement of a moved shape.
#[derive(Clone, Copy)]
pub(super) struct Placement {
    pub(super) back: Inverse,
    /// A box around the moved shape, if the host promised one.
    pub(super) bounds: Option<Bounds>,
}

impl Placement {
    /// A placement of a shape that lies in `bounds` before it is moved.
    pub(super) fn new(placement: &Affine, bounds: Option<Bounds>) -> Placement {
        let bounds = bounds.and_then(|bounds| bounds.placed(placement));
        Placement { back: Inverse::of(placement), bounds }
    }

    /// This placement, followed by another one.
    pub(super) fn then(&self, placement: &Affine) -> Placement {
        let bounds = self.bounds.and_then(|bounds| bounds.placed(placement));
        Placement { back: self.back.then(placement), bounds }
    }

    /// A box around the inverse image of a box.
    pub(super) fn corners(&self, min: [f64; 3], max: [f64; 3]) -> Corners {
        let image = self.back.image(&axes(|axis| Interval::between(min[axis], max[axis])));
        [image.each(|x| x.lower), image.each(|x| x.upper)]
    }

    /// The enclosure of a cell, from a range of the gradient over the box around the cell's inverse image.
    /// The value is that at `at`, a point of the box.
    pub(super) fn enclosure(
        &self,
        range: &GradientRange,
        at: [f64; 3],
        cube: &Cube<'_>,
    ) -> Option<Enclosure> {
        let (min, max) = cube.bounds();
        let middle = middle(min, max);
        // By the mean value theorem, from `at` to the image of the cell's middle. Both points lie in the box.
        let image = self.back.image(&middle.each(Interval::exactly));
        let way = |axis: usize| image[axis].minus(Interval::exactly(at[axis]));
        let value = (0..3).fold(range.value, |sum, axis| sum.plus(range.gradient[axis].times(way(axis))));
        GradientRange { value, gradient: self.back.pulled_back(&range.gradient) }.enclosure(cube, middle)
    }

    /// The inverse image of a cell's centre.
    pub(super) fn centre(&self, cube: &Cube<'_>) -> [Interval; 3] {
        self.back.image(&cube.centre_from([0.0; 3]))
    }

    /// Converts a slab over the cube of half edge `half` around the inverse image of a cell's centre to a
    /// slab over the cell.
    pub(super) fn slab(&self, slab: &Slab, half: f64, cube: &Cube<'_>) -> Option<Slab> {
        let ratio = Interval::exactly(cube.half_edge()).over(Interval::exactly(half));
        let pulled = self.back.pulled_back(&slab.normal.each(Interval::exactly)).each(|c| c.times(ratio));
        let normal = pulled.each(|c| 0.5 * c.lower + 0.5 * c.upper);
        if !normal.iter().all(|c| c.is_finite()) {
            return None;
        }
        // Coordinates of the cell are at most 1.
        let slack = (0..3).fold(Interval::exactly(0.0), |sum, axis| {
            let off = (pulled[axis].upper - normal[axis]).max(normal[axis] - pulled[axis].lower).next_up();
            sum.plus(Interval::between(-off, off))
        });
        let [inner, outer] = [slab.inner, slab.outer].each(|offset| Interval::exactly(offset).plus(slack));
        Some(Slab { normal, inner: inner.lower, outer: outer.upper })
    }
}
