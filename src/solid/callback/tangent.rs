//! Second-order bounds of a host's surface next to a point: balls on both sides that touch it.

use crate::lattice::Each;
use crate::lattice::Interval;
use crate::lattice::axes;
use crate::solid::Slab;

/// Two balls that touch the surface at a point, one in the solid and one outside of it.
///
/// Let d = y − `point` for a point y of the box, and let n be `normal` divided by its length. The promise has
/// two halves, which concern the points of the box alone:
///
/// - each y with n · d < −(`inner_curvature` / 2 · |d|² + `error`) lies in the solid;
/// - each y with n · d > `outer_curvature` / 2 · |d|² + `error` lies outside.
///
/// Without an error, the first half is about the open ball of radius 1 / `inner_curvature` that touches the
/// surface at `point` from within, and the second half about its counterpart outside. A curvature of 0 stands
/// for a half-space, a negative one for all points outside of a ball, and ∞ for no point. For a ball of
/// radius r the curvatures are 1/r and −1/r, exactly.
///
/// A bound of the surface's own curvatures does not suffice, because another sheet of the surface may pass
/// through the box. The reciprocal of the surface's reach suffices for both (Federer 1959). The reach is the
/// greatest distance up to which every point has only one nearest point on the surface. So its reciprocal is
/// no less than any curvature, and no less than 2 over the width of any wall or gap. If a single face of a
/// part passes through the box, the reach of that face's surface suffices: its reciprocal is 0 for a plane,
/// and 1/r for a cylinder or a sphere.
///
/// The slab is thinnest if `point` is the surface's nearest point to the middle of the box. Its thickness
/// falls with the square of the cell's edge, down to twice the error.
///
/// The bounds prove nothing if there is a NaN or a negative error, or if the normal is zero or infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentBalls {
    /// The point where the balls touch, in model units.
    pub point: [f64; 3],
    /// The direction out of the solid at that point, of any length.
    pub normal: [f64; 3],
    /// The reciprocal of the radius of the ball in the solid.
    pub inner_curvature: f64,
    /// The reciprocal of the radius of the ball outside the solid.
    pub outer_curvature: f64,
    /// The greatest error of the surface in model units, from the rounding of point and normal. Not negative.
    pub error: f64,
}

impl TangentBalls {
    /// The slab that these bounds prove for the cube of half edge `half` around a centre, as far as the cube
    /// lies in the box. The slab is measured from the centre, in half edges. `to_centre` points from `point`
    /// to the centre.
    pub(super) fn slab(&self, half: f64, to_centre: [Interval; 3]) -> Option<Slab> {
        let numbers = [self.inner_curvature, self.outer_curvature];
        if self.error >= 0.0 && !numbers.iter().chain(&self.point).any(|c| c.is_nan()) {
            let inner = self.beyond(half, to_centre, self.normal, self.inner_curvature);
            let outer = -self.beyond(half, to_centre, self.normal.each(|c| -c), self.outer_curvature);
            Some(Slab { normal: self.normal, inner, outer })
        } else {
            None
        }
    }

    /// A lower bound of n · x over the points x of the cube, in the cube's own coordinates, that the promise
    /// for one side does not cover. That side is the one opposite to n.
    ///
    /// Let a be the vector from `point` to the cube's centre, h the cube's half edge, l the length of n, κ
    /// the curvature, and a = α n + t with t at right angles to n. The promise covers x if
    ///
    /// n · a + l (κ/2 |a|² + error) + h (1 + l κ α) n · x + h l κ t · x + h² l κ/2 |x|² < 0,
    ///
    /// where |t · x| is at most the sum of the magnitudes of t's components, and |x|² ≤ 3.
    fn beyond(&self, half: f64, a: [Interval; 3], n: [f64; 3], curvature: f64) -> f64 {
        let dot = |a: &[Interval; 3], b: &[Interval; 3]| {
            a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
        };
        let n = n.each(Interval::exactly);
        let square = dot(&n, &n);
        if !(square.lower > 0.0 && square.upper < f64::INFINITY) {
            return f64::NEG_INFINITY;
        }
        let half = Interval::exactly(half);
        let along = dot(&n, &a);
        let share = along.over(square);
        let bend = square.root().times(Interval::exactly(curvature));
        let factor = half.times(Interval::exactly(1.0).plus(bend.times(share)));
        let across = axes(|axis| a[axis].minus(n[axis].times(share)));
        let most = across.iter().fold(0.0, |sum: f64, c| sum + c.upper.max(-c.lower));
        // (A sum of three terms, rounded.)
        let sideways = half.times(bend).times(Interval::exactly(most * (1.0 + 4.0 * f64::EPSILON)));
        let square_of_x = Interval::between(0.0, 1.5);
        let rest = along
            .plus(bend.times(Interval::exactly(0.5)).times(dot(&a, &a)))
            .plus(square.root().times(Interval::exactly(self.error)))
            .plus(Interval::exactly(sideways.upper.max(-sideways.lower)))
            .plus(half.square().times(bend).times(square_of_x));
        Interval::exactly(-rest.upper).over(factor).lower
    }
}
