//! Triangles in the coordinates of a cell.
//!
//! The cell is [-1, 1]³. Corners are rounded in these coordinates, and a vertex is rounded alike for each of
//! its triangles. So the rounded surface is connected as the true one is.

use super::placed::Placed;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use core::array::from_fn as array;

pub(super) type Point = [f64; 3];

/// 2^-52: more than the relative error of one rounding.
pub(super) const UNIT: f64 = f64::EPSILON;

/// The farthest that clipping moves points of a polygon, in [`UNIT`]s of its triangle's reach: 6 for each of
/// seven planes.
pub(super) const CLIPPING: f64 = 42.0;

/// A cell and the mesh that its triangles belong to.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) placed: &'a Placed,
    /// The triangles that cut the cell.
    pub(super) triangles: &'a [u32],
    /// The lowest finest cell, and the edge in finest cells.
    pub(super) at: [i32; 3],
    pub(super) size: i32,
    /// The winding number at the lowest centre.
    pub(super) winding: i32,
}

/// A triangle in the coordinates of a cell.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub(super) corners: [Point; 3],
    pub(super) vertices: [u32; 3],
    /// The greatest error of the corners along an axis.
    pub(super) error: f64,
    /// The greatest magnitude of a coordinate, and at least 1.
    pub(super) reach: f64,
    /// The bounding box.
    pub(super) low: Point,
    pub(super) high: Point,
}

impl View<'_> {
    /// The factor from finest cells to coordinates of the cell.
    pub(super) fn scale(&self) -> f64 {
        2.0 / self.size as f64
    }

    /// The greatest distance of the surface from the mesh along an axis, in the coordinates of the cell.
    pub(super) fn displacement(&self) -> f64 {
        self.placed.displacement * self.scale()
    }

    /// The greatest Euclidean distance of the surface from the mesh, in the coordinates of the cell.
    pub(super) fn radius(&self) -> f64 {
        self.placed.radius * self.scale()
    }

    /// The coordinates of the centre of a finest cell.
    pub(super) fn centre(&self, cell: [i32; 3]) -> Point {
        array(|axis| (2 * (cell[axis] - self.at[axis]) + 1 - self.size) as f64 / self.size as f64)
    }

    /// A triangle of the mesh in the coordinates of the cell.
    #[inline]
    pub(super) fn seen(&self, triangle: u32) -> Seen {
        let vertices = self.placed.mesh.triangles()[triangle as usize];
        let scale = self.scale();
        let half = self.size as f64 / 2.0;
        let mut off: f64 = 0.0;
        let corners = vertices.each(|vertex| {
            let vertex = self.placed.vertex(vertex);
            array(|axis| {
                off = off.max(vertex.error[axis] as f64);
                (vertex.at[axis] - (self.at[axis] as f64 + half)) * scale
            })
        });
        let [a, b, c]: [Point; 3] = corners;
        let low: Point = array(|axis| a[axis].min(b[axis]).min(c[axis]));
        let high: Point = array(|axis| a[axis].max(b[axis]).max(c[axis]));
        let reach = (0..3).fold(1.0, |reach: f64, axis| reach.max(high[axis]).max(-low[axis]));
        Seen { corners, vertices, error: off * scale + UNIT * reach, reach, low, high }
    }
}

impl Seen {
    /// More than the error of corners and of clipped points.
    pub(super) fn slack(&self) -> f64 {
        2.0 * self.error + CLIPPING * UNIT * self.reach
    }

    /// The longest edge of the part of its bounding box in the cell, with a margin for all roundings.
    pub(super) fn extent(&self) -> f64 {
        let slack = self.slack();
        (0..3).fold(slack, |most: f64, k| most.max(self.high[k].min(1.0) - self.low[k].max(-1.0) + slack))
    }

    /// Returns whether the triangle lies within `limit` of the cell's centre along each axis.
    pub(super) fn is_within(&self, limit: f64) -> bool {
        (0..3).all(|k| self.high[k] <= limit && -self.low[k] <= limit)
    }

    /// Returns how many of the six planes at `limit` cut the triangle, or have it beyond them.
    pub(super) fn planes(&self, limit: f64) -> f64 {
        (0..3).map(|k| f64::from((self.high[k] > limit) as u8 + (-self.low[k] > limit) as u8)).sum()
    }

    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = &self.corners;
        let twice = cross(&minus(b, a), &minus(c, a));
        0.5 * sqrt(dot(&twice, &twice))
    }

    /// Returns the part within `limit` of the cell's centre along each axis. `None` if it has more corners
    /// than fit, which only rounding can cause.
    #[inline]
    pub(super) fn clipped(&self, limit: f64) -> Option<Polygon> {
        let mut polygon = Polygon::new(&self.corners);
        for axis in 0..3 {
            for (sign, beyond) in [(1.0, self.high[axis]), (-1.0, -self.low[axis])] {
                if beyond > limit {
                    polygon = polygon.below(axis, sign, limit)?;
                }
            }
        }
        Some(polygon)
    }

    /// Returns on which side of the plane a point with an error of `error` lies: 1 in front, −1 behind, 0 if
    /// unsure.
    pub(super) fn side(&self, p: &Point, error: f64) -> i32 {
        let [a, b, c] = &self.corners;
        volume_sign([&minus(b, a), &minus(c, a), &minus(p, a)], self.error + error)
    }

    /// The change of the winding number on the way from one point to another: 1 if the way passes the
    /// triangle from its front, −1 from behind, 0 if it misses. `None` if unsure.
    pub(super) fn pierced(&self, from: &Point, to: &Point) -> Option<i32> {
        let margin = 2.0 * self.error;
        let is_beside = (0..3).any(|axis| {
            from[axis].max(to[axis]) < self.low[axis] - margin
                || from[axis].min(to[axis]) > self.high[axis] + margin
        });
        if is_beside {
            return Some(0);
        }
        let way = minus(to, from);
        let ends = self.corners.each(|corner| minus(&corner, from));
        let turns: [i32; 3] = array(|k| volume_sign([&way, &ends[k], &ends[(k + 1) % 3]], self.error));
        if turns.contains(&1) && turns.contains(&-1) {
            return Some(0);
        }
        let (before, after) = (self.side(from, 0.0), self.side(to, 0.0));
        if before * after > 0 {
            return Some(0);
        }
        (before * after < 0 && !turns.contains(&0)).then_some(before)
    }
}

/// The sign of u × v · w for differences of points with errors of `error`; 0 if unsure.
fn volume_sign([u, v, w]: [&Point; 3], error: f64) -> i32 {
    let size = [u, v, w].into_iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let value = dot(&cross(u, v), w);
    // The error of a factor is twice `error` and a rounding; there are six products of three factors.
    let sure = 64.0 * size * size * (error + UNIT * size);
    if value > sure {
        1
    } else if value < -sure {
        -1
    } else {
        0
    }
}

/// A polygon, nearly plane and convex.
#[derive(Clone, Copy)]
pub(super) struct Polygon {
    points: [Point; Polygon::MOST],
    count: usize,
}

impl Polygon {
    /// A triangle cut by seven planes has ten corners. The rest is room for corners that rounding creates.
    const MOST: usize = 14;

    fn new([a, b, c]: &[Point; 3]) -> Polygon {
        let mut points = [[0.0; 3]; Polygon::MOST];
        (points[0], points[1], points[2]) = (*a, *b, *c);
        Polygon { points, count: 3 }
    }

    pub(super) fn points(&self) -> &[Point] {
        &self.points[..self.count]
    }

    /// The part where the coordinate times `sign` is at most `bound`: Sutherland and Hodgman 1974.
    #[inline(always)]
    pub(super) fn below(&self, axis: usize, sign: f64, bound: f64) -> Option<Polygon> {
        let mut kept = Polygon { points: [[0.0; 3]; Polygon::MOST], count: 0 };
        let points = self.points();
        for (k, p) in points.iter().enumerate() {
            let q = &points[if k + 1 == points.len() { 0 } else { k + 1 }];
            let [p_within, q_within] = [p, q].each(|p| sign * p[axis] <= bound);
            if p_within {
                kept.push(*p)?;
            }
            if p_within != q_within {
                kept.push(between(p, q, axis, sign * bound))?;
            }
        }
        Some(kept)
    }

    /// The part where `normal` · p is at most `bound`. `None` if it has more corners than fit.
    pub(super) fn behind(&self, normal: &Point, bound: f64) -> Option<Polygon> {
        let mut kept = Polygon { points: [[0.0; 3]; Polygon::MOST], count: 0 };
        let points = self.points();
        for (k, p) in points.iter().enumerate() {
            let q = &points[if k + 1 == points.len() { 0 } else { k + 1 }];
            let [at_p, at_q] = [p, q].each(|p| dot(normal, p) - bound);
            if at_p <= 0.0 {
                kept.push(*p)?;
            }
            if (at_p <= 0.0) != (at_q <= 0.0) {
                let t = at_p / (at_p - at_q);
                kept.push(array(|k| p[k] + t * (q[k] - p[k])))?;
            }
        }
        Some(kept)
    }

    #[inline(always)]
    fn push(&mut self, point: Point) -> Option<()> {
        *self.points.get_mut(self.count)? = point;
        self.count += 1;
        Some(())
    }

    pub(super) fn area(&self) -> f64 {
        let twice = self.twice_area();
        0.5 * sqrt(dot(&twice, &twice))
    }

    /// The normal, with the length of twice the area.
    pub(super) fn twice_area(&self) -> Point {
        let mut sum = [0.0; 3];
        if let [a, rest @ ..] = self.points() {
            for ends in rest.windows(2) {
                let area = cross(&minus(&ends[0], a), &minus(&ends[1], a));
                (0..3).for_each(|k| sum[k] += area[k]);
            }
        }
        sum
    }

    /// A point inside.
    pub(super) fn middle(&self) -> Point {
        let share = 1.0 / self.count as f64;
        array(|axis| self.points().iter().map(|p| p[axis]).sum::<f64>() * share)
    }
}

/// The point at coordinate `bound` on the segment between two points on different sides of it.
pub(super) fn between(p: &Point, q: &Point, axis: usize, bound: f64) -> Point {
    let t = (bound - p[axis]) / (q[axis] - p[axis]);
    let mut point = array(|k| p[k] + t * (q[k] - p[k]));
    point[axis] = bound;
    point
}

#[inline(always)]
pub(super) fn minus(a: &Point, b: &Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn cross(a: &Point, b: &Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(super) fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
