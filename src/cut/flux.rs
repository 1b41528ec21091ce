//! The area that one surface has in a cube.
//!
//! The flux of a constant field through the surface of a body is 0. So what flows through the boundary of a
//! solid in a cell flows through the walls of the cell where the solid reaches them. Along the gradient at
//! the centre, the flux is the area of the boundary, but for the cosine of the angle to its normals, which
//! differs from 1 by the square of the angle. What a wall has of the solid is a figure in the plane, of which
//! the outline is known to second order. So the area is known to third order.

use super::quadratic::Quadratic;
use super::taylor::Taylor;
use crate::lattice::exact::sqrt;
use crate::lattice::{Interval, PLACES};

/// More than what comes of rounding, lengths and areas being at most 24.
pub(super) const ROUNDING: f64 = 1e-13;

/// A surface has no more area than this in a cell, in squares of the half edge. Lines meet it no more often
/// than its degree, and by Crofton's formula the area is at most half of that times the surface of the cell.
pub(crate) fn most_area(degree: u32) -> f64 {
    12.0 * degree as f64
}

/// Bounds of the area that a surface has in a cell, in squares of the half edge.
pub(crate) fn area_of_surface(surface: &Taylor) -> Interval {
    let f = &surface.f;
    let most = most_area(surface.degree);
    let length = surface.steepness();
    let sine = surface.sine();
    // Less than the cosine of the angle between the gradient at the centre and any other.
    let cosine = if sine < 1.0 { sqrt((1.0 - sine * sine) * (1.0 - 4.0 * f64::EPSILON)) } else { 0.0 };
    let is_known = cosine > 0.5 && f.error < f64::INFINITY;
    if !is_known {
        return Interval::between(0.0, most);
    }
    // Wall by wall: along each axis what flows out at the upper one and in at the lower one.
    let (mut least, mut greatest) = (0.0, 0.0);
    for axis in 0..3 {
        let share = f.gradient[axis] / length;
        let (upper, lower) = (on_wall(f, axis, 1.0), on_wall(f, axis, -1.0));
        let (a, b) = (share * (upper.lower - lower.upper), share * (upper.upper - lower.lower));
        (least, greatest) = (least + a.min(b), greatest + a.max(b));
    }
    // Numbers that are too large to be told tell nothing.
    let is_known = least <= greatest;
    if !is_known {
        return Interval::between(0.0, most);
    }
    let lower = (least - ROUNDING).max(0.0);
    let upper = ((greatest + ROUNDING).max(0.0) / cosine).min(most);
    Interval::between(lower.min(upper), upper)
}

/// The area in which f ≥ 0 on the wall of a cell where the coordinate of `axis` is `at`.
fn on_wall(f: &Quadratic, axis: usize, at: f64) -> Interval {
    let square = |i: usize, j: usize| f.squares[PLACES[i][j]];
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let value = (f.value + at * f.gradient[axis]) + square(axis, axis);
    let [along_i, along_j] = [i, j].map(|other| f.gradient[other] + 2.0 * at * square(axis, other));
    let error = f.error + 16.0 * f64::EPSILON * f.size();
    // y is the axis along which f changes faster.
    let (of_x, of_y, x, y) =
        if along_i.abs() > along_j.abs() { (along_j, along_i, j, i) } else { (along_i, along_j, i, j) };
    let [xx, xy, yy] = [square(x, x), 2.0 * square(x, y), square(y, y)];
    Figure { value, of_x, of_y, xx, xy, yy, error }.area()
}

/// Where value + of_x x + of_y y + xx x² + xy x y + yy y², up to an error, is not negative in [-1, 1]².
struct Figure {
    value: f64,
    of_x: f64,
    of_y: f64,
    xx: f64,
    xy: f64,
    yy: f64,
    error: f64,
}

impl Figure {
    fn area(&self) -> Interval {
        let bends = (self.xx.abs() + self.xy.abs()) + self.yy.abs();
        let reach = (self.of_x.abs() + self.of_y.abs()) + (bends + self.error);
        let reach = reach * (1.0 + 8.0 * f64::EPSILON);
        if self.value >= reach {
            return Interval::exactly(4.0);
        }
        if -self.value >= reach {
            return Interval::exactly(0.0);
        }
        let fall = self.of_y.abs();
        // By how much the slope along y varies, as a share.
        let share = (self.xy.abs() + 2.0 * self.yy.abs()) / fall * (1.0 + 8.0 * f64::EPSILON);
        let is_graph = share < 0.5 && self.error < 0.25 * fall;
        if !is_graph {
            return Interval::between(0.0, 4.0);
        }
        // Each x has at most one y on the outline: about y0 = offset + slope · x, a straight line, by `moved`
        // at the most. On the line itself f tells by how much, up to `share` of it.
        let (offset, slope) = (-self.value / self.of_y, -self.of_x / self.of_y);
        let steeper = 1.0 / (1.0 - share) * (1.0 + 8.0 * f64::EPSILON);
        let moved = (bends + self.error) / fall * steeper;
        let [start, end] = range(offset, slope, [-1.0, 1.0]);
        let width = end - start;
        let below = {
            let middle = 0.5 * (start + end);
            let line = |x: f64| offset + slope * x;
            // Beyond the line's part in the square all or nothing lies below it.
            let outside =
                |from: f64, to: f64| if line(0.5 * (from + to)) > 0.0 { 2.0 * (to - from) } else { 0.0 };
            let bent = |x: f64| {
                let y = line(x);
                ((self.xx * x + self.xy * y) * x + self.yy * y * y) / self.of_y
            };
            let moved = (bent(start) + 4.0 * bent(middle) + bent(end)) / 6.0;
            outside(-1.0, start) + (1.0 + line(middle) - moved) * width + outside(end, 1.0)
        };
        // Near the upper and the lower side of the square the outline may leave it early or late.
        let near = |side: f64| {
            let [from, to] = range(offset, slope, [side - moved, side + moved]);
            moved * (to - from)
        };
        let within = width * (moved * share + self.error / fall * steeper);
        let error = (within + near(1.0) + near(-1.0)) * (1.0 + 16.0 * f64::EPSILON) + ROUNDING;
        let area = if self.of_y < 0.0 { below } else { 4.0 - below };
        let bounds = Interval::new((area - error).clamp(0.0, 4.0), (area + error).clamp(0.0, 4.0));
        bounds.unwrap_or(Interval::between(0.0, 4.0))
    }
}

/// Which x of [-1, 1] have offset + slope · x between two bounds.
fn range(offset: f64, slope: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    if slope == 0.0 {
        return if low <= offset && offset <= high { [-1.0, 1.0] } else { [1.0, 1.0] };
    }
    let (a, b) = ((low - offset) / slope, (high - offset) / slope);
    [a.min(b).clamp(-1.0, 1.0), a.max(b).clamp(-1.0, 1.0)]
}
