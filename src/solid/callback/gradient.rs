//! First-order bounds of a host's function over a box: a value and the range of the gradient.

use crate::lattice::Each;
use crate::lattice::{Cube, Interval};
use crate::solid::{Enclosure, Slab};
use core::f64::consts::FRAC_PI_2;

/// First-order bounds of a host's function f over a box. The solid is the set of points with f ≤ 0, as for a
/// signed distance: f is negative inside, and its gradient points out of the solid.
///
/// The promise concerns the points of the box alone. By the mean value theorem the bounds give a
/// [slab](Slab). If the gradient's range shrinks with the box, as it does by interval arithmetic, the slab's
/// thickness falls with the square of the cell's edge.
///
/// An infinite gradient says nothing. One end of `value` may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GradientRange {
    /// An interval that contains the value of f at the middle of the box.
    pub value: Interval,
    /// For each axis, an interval that contains the partial derivative of f everywhere in the box. f must be
    /// continuous in the box. Where f has no derivative, as at a crease, the interval must contain the
    /// one-sided derivatives of all sides.
    pub gradient: [Interval; 3],
}

impl GradientRange {
    /// The enclosure that these bounds prove for a cube in the box. The value is that at `middle`, a point of
    /// the box.
    ///
    /// Let m be the middle of the gradient's range. For each point y of the box, f(y) lies in value + m · (y
    /// − middle) + (range − m) · (y − middle).
    pub(super) fn enclosure(&self, cube: &Cube<'_>, middle: [f64; 3]) -> Option<Enclosure> {
        let half = cube.half_edge();
        let to_centre = cube.centre_from(middle);
        let normal = self.gradient.each(|range| 0.5 * range.lower + 0.5 * range.upper);
        let mut rest = self.value;
        let (mut square, mut deviation_square) = (Interval::exactly(0.0), Interval::exactly(0.0));
        for axis in 0..3 {
            let slope = Interval::exactly(normal[axis]);
            let deviation = self.gradient[axis].minus(slope);
            let way = to_centre[axis].plus(Interval::between(-half, half));
            rest = rest.plus(slope.times(to_centre[axis])).plus(deviation.times(way));
            square = square.plus(slope.square());
            deviation_square = deviation_square.plus(deviation.square());
        }
        let offset = rest.negated().over(Interval::exactly(half));
        let slab = Slab { normal, inner: offset.lower, outer: offset.upper };
        Enclosure::of_one(slab, cone(deviation_square.over(square).upper))
    }
}

/// An upper bound of the angle between a vector and a second vector that differs from it by at most a share
/// of its length. `square` is the square of that share. The angle is the arc sine of the share, which is less
/// than the tangent of that angle.
fn cone(square: f64) -> f64 {
    if square < 1.0 {
        let square = Interval::exactly(square);
        let tangent = square.over(Interval::exactly(1.0).minus(square)).root().upper;
        tangent.min(FRAC_PI_2.next_up())
    } else {
        f64::INFINITY
    }
}
