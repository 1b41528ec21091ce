//! The area of one surface in a cube.
//!
//! The flux of a constant field through the surface of a body is 0. So the flux through the boundary of a
//! solid in a cell equals the flux through the parts of the cell's walls that lie in the solid. For a field
//! along the gradient at the centre, the flux is the area of the boundary times a cosine: that of the angle
//! between the gradient and the normals. The cosine differs from 1 by the square of the angle. The solid's
//! part of a wall is a plane figure whose outline is known to second order. So the area is known to third
//! order.

use super::quadratic::Quadratic;
use super::taylor::Taylor;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Interval, PLACES};

/// A bound of the rounding errors; lengths and areas are at most 24.
pub(super) const ROUNDING: f64 = 1e-13;

/// The greatest area of a surface in a cell, in squares of the half edge. A line meets the surface no more
/// often than its degree. By Crofton's formula the area is at most half the degree times the surface of the
/// cell.
pub(crate) fn most_area(degree: u32) -> f64 {
    12.0 * degree as f64
}

/// Bounds of the area of a surface in a cell, in squares of the half edge.
pub(crate) fn area_of_surface(surface: &Taylor) -> Interval {
    let f = &surface.f;
    let most = most_area(surface.degree);
    let length = surface.steepness();
    let sine = surface.sine();
    // A lower bound of the cosine of the angle between the gradient at the centre and any other gradient.
    let cosine = if sine < 1.0 { sqrt((1.0 - sine * sine) * (1.0 - 4.0 * f64::EPSILON)) } else { 0.0 };
    let is_known = cosine > 0.5 && f.error < f64::INFINITY;
    if !is_known {
        return Interval::between(0.0, most);
    }
    // For each axis, the flux out through the upper wall and in through the lower one.
    let (mut least, mut greatest) = (0.0, 0.0);
    for axis in 0..3 {
        let share = f.gradient[axis] / length;
        let (upper, lower) = (on_wall(f, axis, 1.0), on_wall(f, axis, -1.0));
        let (a, b) = (share * (upper.lower - lower.upper), share * (upper.upper - lower.lower));
        (least, greatest) = (least + a.min(b), greatest + a.max(b));
    }
    // Numbers beyond the range of doubles give no bounds.
    let is_known = least <= greatest;
    if !is_known {
        return Interval::between(0.0, most);
    }
    let lower = (least - ROUNDING).max(0.0);
    let upper = ((greatest + ROUNDING).max(0.0) / cosine).min(most);
    Interval::between(lower.min(upper), upper)
}

/// The area where f ≥ 0 on the wall of a cell with the coordinate `at` along `axis`.
fn on_wall(f: &Quadratic, axis: usize, at: f64) -> Interval {
    let square = |i: usize, j: usize| f.squares[PLACES[i][j]];
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let value = (f.value + at * f.gradient[axis]) + square(axis, axis);
    let [along_i, along_j] = [i, j].each(|other| f.gradient[other] + 2.0 * at * square(axis, other));
    let error = f.error + 16.0 * f64::EPSILON * f.size();
    // y is the axis along which f changes faster.
    let (of_x, of_y, x, y) =
        if along_i.abs() > along_j.abs() { (along_j, along_i, j, i) } else { (along_i, along_j, i, j) };
    let [xx, xy, yy] = [square(x, x), 2.0 * square(x, y), square(y, y)];
    Figure { value, of_x, of_y, xx, xy, yy, error }.area()
}

/// The figure where value + of_x x + of_y y + xx x² + xy x y + yy y², up to an error, is not negative in [-1,
/// 1]².
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
        // The variation of the derivative along y, as a share of it.
        let share = (self.xy.abs() + 2.0 * self.yy.abs()) / fall * (1.0 + 8.0 * f64::EPSILON);
        let is_graph = share < 0.5 && self.error < 0.25 * fall;
        if !is_graph {
            return Interval::between(0.0, 4.0);
        }
        // Each x has at most one y on the outline. It differs from the straight line y0 = offset + slope · x
        // by at most `moved`. The value of f on the line gives the difference, up to a share of `share`.
        let (offset, slope) = (-self.value / self.of_y, -self.of_x / self.of_y);
        let steeper = 1.0 / (1.0 - share) * (1.0 + 8.0 * f64::EPSILON);
        let moved = (bends + self.error) / fall * steeper;
        let [start, end] = range(offset, slope, [-1.0, 1.0]);
        let width = end - start;
        let below = {
            let middle = 0.5 * (start + end);
            let line = |x: f64| offset + slope * x;
            // Beyond the line's part in the square, everything or nothing lies below the line.
            let outside =
                |from: f64, to: f64| if line(0.5 * (from + to)) > 0.0 { 2.0 * (to - from) } else { 0.0 };
            let bent = |x: f64| {
                let y = line(x);
                ((self.xx * x + self.xy * y) * x + self.yy * y * y) / self.of_y
            };
            let moved = (bent(start) + 4.0 * bent(middle) + bent(end)) / 6.0;
            outside(-1.0, start) + (1.0 + line(middle) - moved) * width + outside(end, 1.0)
        };
        // Near the upper and the lower side of the square the outline may leave the square early or late.
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

/// The range of x in [-1, 1] where offset + slope · x lies between two bounds.
fn range(offset: f64, slope: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    if slope == 0.0 {
        return if low <= offset && offset <= high { [-1.0, 1.0] } else { [1.0, 1.0] };
    }
    let (a, b) = ((low - offset) / slope, (high - offset) / slope);
    [a.min(b).clamp(-1.0, 1.0), a.max(b).clamp(-1.0, 1.0)]
}
