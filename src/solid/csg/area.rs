//! The area that half-spaces bound in a cell.
//!
//! The flux of a constant field through the surface of a body is 0. So what flows through the boundary of a solid in a
//! cell flows through the walls of the cell where the solid reaches them. Along the gradient at the centre the flux is
//! the area of the boundary, but for the cosine of the angle to its normals, which differs from 1 by the square of the
//! angle; and what a wall has of the solid is a figure in the plane, of which the outline is known to second order. So
//! the area is known to third order.
//!
//! Where several half-spaces are open, the part of a surface that lies within the others is seen along an axis: a
//! convex figure in the plane, of which the sides are known as slabs are.

use super::bounds::{centre, half_edge};
use super::program::Program;
use super::word::{Op, Word};
use super::worker::{CsgPart, Scratch};
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, Interval, PLACES};
use crate::solid::cut::{Quadratic, Taylor};

/// More than what comes of rounding, lengths and areas being at most 24.
const ROUNDING: f64 = 1e-13;

impl Scratch {
    /// Bounds of the area of the boundary in a cell; `None` if other solids than half-spaces are open there.
    pub(super) fn area(&self, program: &Program, cell: Cell, part: CsgPart) -> Option<Interval> {
        if program.paper || part.len == 0 {
            return None;
        }
        let taylor = |index: u32| program.half_spaces[index as usize].taylor(centre(cell), half_edge(cell));
        // A union has the boundary of the complements' intersection.
        if let Some((literals, false, _)) = self.literals(program, part) {
            let mut sides = [None; 3];
            for (side, (index, complement)) in sides.iter_mut().zip(literals.into_iter().flatten()) {
                *side = Some(Side { f: taylor(index)?, complement });
            }
            return Some(of_intersection(&sides));
        }
        let words = Scratch::list(program, &self.words, part);
        if !part.is_table() {
            return of_many(program, words);
        }
        let mut sum = Interval::exactly(0.0);
        for word in Scratch::table_of(words).0 {
            sum.upper += of_surface(&taylor(word.variable().1)?).upper;
        }
        Some(sum)
    }
}

/// What is known of other expressions: no more than of all half-spaces in them.
fn of_many(program: &Program, words: &[Word]) -> Option<Interval> {
    let mut sum = Interval::exactly(0.0);
    for word in words {
        match word.op() {
            Op::HalfSpace { index, .. } => {
                sum.upper += at_most(program.half_spaces[index as usize].degree()?).upper
            }
            Op::Join { .. } => {}
            Op::Solid { .. } | Op::Unknown | Op::Group { .. } | Op::Primitive { .. } => return None,
        }
    }
    Some(sum)
}

/// A half-space, or its complement.
#[derive(Clone, Copy)]
struct Side {
    f: Taylor,
    complement: bool,
}

/// Of the area of the boundary of an intersection.
fn of_intersection(sides: &[Option<Side>; 3]) -> Interval {
    if let [Some(side), None, None] = sides {
        return of_surface(&side.f);
    }
    let known = sides.iter().flatten();
    if !known.clone().all(|side| side.f.f.error < f64::INFINITY) {
        return Interval { lower: 0.0, upper: known.map(|side| of_surface(&side.f).upper).sum() };
    }
    let mut sum = Interval::exactly(0.0);
    for (i, side) in sides.iter().enumerate() {
        let Some(Side { f, .. }) = side else { continue };
        let others =
            sides.iter().enumerate().filter(|(j, _)| *j != i).filter_map(|(_, other)| other.as_ref());
        let face = of_face(f, others);
        sum = Interval { lower: sum.lower + face.lower, upper: sum.upper + face.upper };
    }
    sum
}

/// Of the area that a surface has within other half-spaces.
fn of_face<'a>(surface: &Taylor, others: impl Iterator<Item = &'a Side>) -> Interval {
    let whole = Interval { lower: 0.0, upper: of_surface(surface).upper };
    let f = &surface.f;
    let size = f.gradient.map(f64::abs);
    let axis = (0..3).fold(0, |most, axis| if size[axis] > size[most] { axis } else { most });
    let (fall, length) = (f.gradient[axis], surface.steepness());
    let bend = surface.bend + 4.0 * f64::EPSILON * length;
    let is_graph = bend < 0.5 * size[axis] && f.error < f64::INFINITY;
    if !is_graph {
        return whole;
    }
    // Each point of the wall sees at most one of the surface, about where the linear function is 0. By how much f may
    // differ from that:
    let off = |f: &Quadratic| f.curvature() + f.error + 16.0 * f64::EPSILON * f.size();
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let moved = off(f) / fall.abs();
    let (mut inner, mut outer) = (Polygon::SQUARE, Polygon::SQUARE);
    let mut clip = |line: [f64; 3], margin: f64| {
        let margin =
            margin * (1.0 + 8.0 * f64::EPSILON) + ROUNDING * line.iter().map(|c| c.abs()).sum::<f64>();
        inner.clip([line[0] - margin, line[1], line[2]]);
        outer.clip([line[0] + margin, line[1], line[2]]);
    };
    // The coordinate along the axis, as a function of the others.
    let depth = [-f.value / fall, -f.gradient[x] / fall, -f.gradient[y] / fall];
    clip([1.0 - depth[0], -depth[1], -depth[2]], moved);
    clip([1.0 + depth[0], depth[1], depth[2]], moved);
    for Side { f: Taylor { f: other, .. }, complement } in others {
        let along = other.gradient[axis];
        let line = [other.value, other.gradient[x], other.gradient[y]];
        let line = [0, 1, 2].map(|k| {
            let value = line[k] + along * depth[k];
            if *complement { -value } else { value }
        });
        let terms = along.abs() * depth.iter().map(|c| c.abs()).sum::<f64>();
        clip(line, off(other) + along.abs() * moved + 16.0 * f64::EPSILON * terms);
    }
    let steepest = ((length + bend) / (size[axis] - bend)) * (1.0 + 8.0 * f64::EPSILON);
    let flattest = ((length - bend) / (size[axis] + bend)) * (1.0 - 8.0 * f64::EPSILON);
    let upper = whole.upper.min((outer.area() + ROUNDING) * steepest);
    Interval { lower: ((inner.area() - ROUNDING) * flattest.max(1.0)).clamp(0.0, upper), upper }
}

/// A convex polygon in [-1, 1]². Each of five lines adds at most one corner to the four.
struct Polygon {
    corners: [[f64; 2]; 12],
    count: usize,
}

impl Polygon {
    const SQUARE: Polygon = {
        let mut corners = [[0.0; 2]; 12];
        corners[0] = [-1.0, -1.0];
        corners[1] = [1.0, -1.0];
        corners[2] = [1.0, 1.0];
        corners[3] = [-1.0, 1.0];
        Polygon { corners, count: 4 }
    };

    /// Keeps the points with line[0] + line[1] x + line[2] y ≥ 0.
    fn clip(&mut self, line: [f64; 3]) {
        let value = |[x, y]: [f64; 2]| (line[0] + line[1] * x) + line[2] * y;
        let before = core::mem::replace(self, Polygon { corners: [[0.0; 2]; 12], count: 0 });
        for k in 0..before.count {
            let (from, to) = (before.corners[k], before.corners[(k + 1) % before.count]);
            let (a, b) = (value(from), value(to));
            if a >= 0.0 {
                self.push(from);
            }
            if (a >= 0.0) != (b >= 0.0) {
                let t = a / (a - b);
                self.push([from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]);
            }
        }
    }

    fn push(&mut self, corner: [f64; 2]) {
        // (Rounding may bend a polygon so that a line crosses it more than twice, but not that often.)
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    fn area(&self) -> f64 {
        let corner = |k: usize| self.corners[k % self.count];
        let cross = |k: usize| {
            let ([a, b], [c, d], [x, y]) = (corner(0), corner(k), corner(k + 1));
            (c - a) * (y - b) - (x - a) * (d - b)
        };
        (1..self.count.saturating_sub(1)).map(cross).sum::<f64>() * 0.5
    }
}

/// What is known of an area before anything is looked at: lines meet the surface no more often than its degree, and by
/// Crofton's formula the area is at most half of that times the surface of the cell.
pub(super) fn at_most(degree: u32) -> Interval {
    Interval { lower: 0.0, upper: 12.0 * degree as f64 }
}

/// The area in a cell of the surface on which a function is 0, in squares of the half edge.
pub(super) fn of_surface(surface: &Taylor) -> Interval {
    let f = &surface.f;
    let most = at_most(surface.degree);
    let length = surface.steepness();
    let sine = surface.sine();
    // Less than the cosine of the angle between the gradient at the centre and any other.
    let cosine = if sine < 1.0 { sqrt((1.0 - sine * sine) * (1.0 - 4.0 * f64::EPSILON)) } else { 0.0 };
    let is_known = cosine > 0.5 && f.error < f64::INFINITY;
    if !is_known {
        return most;
    }
    // Wall by wall: along each axis what flows out at the upper one and in at the lower one.
    let mut flux = Interval::exactly(0.0);
    for axis in 0..3 {
        let share = f.gradient[axis] / length;
        let (upper, lower) = (on_wall(f, axis, 1.0), on_wall(f, axis, -1.0));
        let (least, greatest) = (upper.lower - lower.upper, upper.upper - lower.lower);
        let (a, b) = (share * least, share * greatest);
        flux = Interval { lower: flux.lower + a.min(b), upper: flux.upper + a.max(b) };
    }
    let lower = (flux.lower - ROUNDING).max(0.0);
    let upper = ((flux.upper + ROUNDING).max(0.0) / cosine).min(most.upper);
    Interval { lower: lower.min(upper), upper }
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
            return Interval { lower: 0.0, upper: 4.0 };
        }
        // Each x has at most one y on the outline: about y0 = offset + slope · x, a straight line, by `moved` at the most.
        // On the line itself f tells by how much, up to `share` of it.
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
        Interval { lower: (area - error).clamp(0.0, 4.0), upper: (area + error).clamp(0.0, 4.0) }
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
