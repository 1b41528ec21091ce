//! The graph of a surface over a plane near it.

use super::polygon::Polygon;
use super::quadratic::Quadratic;
use crate::lattice::Each;
use crate::lattice::{PAIRS, PLACES};
use wide::f64x4;

/// A function whose surface is a graph z*(x, y) over the square, divided by its derivative along z: z − z₀ +
/// R, where z₀ = −(a x + b y + c) is a plane. z is the axis with the greatest component of the gradient.
pub(super) struct Graph {
    /// The axes of the cube that are called x, y and z.
    pub(super) axes: [usize; 3],
    /// The divisor of the function; positive if the solid is above.
    pub(super) scale: f64,
    /// a, b and c.
    pub(super) plane: [f64; 3],
    /// v, the value of R on the plane: coefficients of 1, x, y, x², y² and x y.
    v: [f64; 6],
    /// R's derivative along z on the plane: coefficients of 1, x and y. `bend` is half its second derivative
    /// along z.
    slope: [f64; 3],
    pub(super) bend: f64,
    /// A bound of R's derivative along z, in the cube and up to an edge beyond it.
    pub(super) steepest: f64,
    /// The greatest distance of z₀ from z* where one of them is in the cube; it is also at most |v| / (1 −
    /// `steepest`) everywhere.
    pub(super) most: f64,
    /// A bound of the rounding errors of values.
    pub(super) rounding: f64,
}

/// v on the plane at some points, and R's derivative along z.
pub(super) struct Values {
    pub(super) v: f64x4,
    pub(super) slope: f64x4,
}

impl Graph {
    /// Builds the graph of f = 0, with a plane that is near it in the cube; `None` if f's gradient varies too
    /// much there. `section` returns the intersection of the plane (with these axes) with the cube and the
    /// planes.
    #[inline(always)]
    pub(super) fn new(
        f: &Quadratic,
        section: impl Fn(&[usize; 3], &[f64; 3]) -> Option<Polygon>,
    ) -> Option<Graph> {
        let [gx, gy, gz] = f.gradient.each(f64::abs);
        let axis = if gx > gy.max(gz) {
            0
        } else if gy > gz {
            1
        } else {
            2
        };
        let axes = [(axis + 1) % 3, (axis + 2) % 3, axis];
        let g = axes.each(|axis| f.gradient[axis]);
        let q = PAIRS.each(|(i, j)| f.squares[PLACES[axes[i]][axes[j]]]);
        let times = |p: [f64; 3]| {
            [0, 1, 2].each(|i| (q[PLACES[i][0]] * p[0] + q[PLACES[i][1]] * p[1]) + q[PLACES[i][2]] * p[2])
        };
        // The plane where the linearisation of f at a point is 0, and the derivative along z.
        let tangent = |p: [f64; 3]| {
            let qp = times(p);
            let scale = g[2] + 2.0 * qp[2];
            let inverse = 1.0 / scale;
            let constant = f.value - ((p[0] * qp[0] + p[1] * qp[1]) + p[2] * qp[2]);
            let plane = [(g[0] + 2.0 * qp[0]) * inverse, (g[1] + 2.0 * qp[1]) * inverse, constant * inverse];
            (plane, scale)
        };
        // Around the point nearest to the centre at first, then around the middle of the section.
        let square = (g[0] * g[0] + g[1] * g[1]) + g[2] * g[2];
        let mut p = g.each(|slope| (-f.value / square * slope).clamp(-1.0, 1.0));
        let ([a, b, c], scale) = tangent(p);
        let polygon = section(&axes, &[a, b, c])?;
        let mut shift = 0.0;
        if let Some(([x, y], [xx, yy, xy])) = polygon.spread() {
            p = [x, y, (-((a * x + b * y) + c)).clamp(-1.0, 1.0)];
            let [h, i, j] = bends(&q, a, b);
            // Centred on the mean of R along the section's outline.
            shift = 0.5 * ((h * xx + i * yy) + 2.0 * j * xy) / scale;
        }
        let ([a, b, c], scale) = tangent(p);
        let inverse = 1.0 / scale;
        let c = c + shift;
        let q = q.each(|q| q * inverse);
        let [xx, yy, zz, xy, xz, yz] = q.each(f64::abs);
        let [rx, ry, rz] = p.each(|c| 1.0 + c.abs());
        let steepest = 2.0 * ((xz * rx + yz * ry) + zz * (1.0 + rz));
        let squares = ((xx * rx * rx + yy * ry * ry) + zz * rz * rz)
            + 2.0 * ((xy * rx * ry + xz * rx * rz) + yz * ry * rz);
        let size =
            (f.value.abs() + (gx + gy) + gz) * inverse.abs() + 4.0 * ((xx + yy + zz) + 2.0 * (xy + xz + yz));
        let rounding = 128.0 * f64::EPSILON * size;
        let most = (squares + shift.abs()) / (1.0 - steepest) + rounding;
        // (A comparison with NaN is false.)
        if !(steepest <= 0.5 && most <= 1.0 && a.abs() <= 2.0 && b.abs() <= 2.0) {
            return None;
        }
        // R at p + d is dᵀ q d − shift. On the plane d is (X, Y, e − a X − b Y), where X = x − p and Y = y −
        // p.
        let [_, _, zz, _, xz, yz] = q;
        let e = -((c + p[2]) + (a * p[0] + b * p[1]));
        let (along_x, along_y) = (xz - a * zz, yz - b * zz);
        let [h, i, j] = bends(&q, a, b);
        let (from_x, from_y) = (h * p[0] + j * p[1], i * p[1] + j * p[0]);
        let from_z = along_x * p[0] + along_y * p[1];
        let constant = (from_x * p[0] + from_y * p[1]) + e * (zz * e - 2.0 * from_z) - shift;
        Some(Graph {
            axes,
            scale,
            plane: [a, b, c],
            v: [constant, 2.0 * (e * along_x - from_x), 2.0 * (e * along_y - from_y), h, i, 2.0 * j],
            slope: [2.0 * (zz * e - from_z), 2.0 * along_x, 2.0 * along_y],
            bend: zz.abs(),
            steepest,
            most,
            rounding,
        })
    }

    /// Returns v and R's derivative along z.
    #[inline(always)]
    pub(super) fn at(&self, x: f64x4, y: f64x4) -> Values {
        let [one, by_x, by_y, xx, yy, xy] = self.v;
        let [slope, slope_x, slope_y] = self.slope;
        Values {
            v: (x * (x * xx + y * xy + by_x) + y * (y * yy + by_y)) + one,
            slope: (x * slope_x + y * slope_y) + slope,
        }
    }

    /// v's derivative along x on the plane.
    pub(super) fn rise(&self, x: f64x4, y: f64x4) -> f64x4 {
        let [_, by_x, _, xx, _, xy] = self.v;
        (x * (2.0 * xx) + y * xy) + by_x
    }

    /// Half of v's second derivatives along x and along y, and its mixed second derivative.
    pub(super) fn bends(&self) -> [f64; 3] {
        let [.., xx, yy, xy] = self.v;
        [xx, yy, xy]
    }

    /// The derivative along x, on the plane, of R's derivative along z.
    pub(super) fn turn(&self) -> f64 {
        self.slope[1]
    }

    /// The graph with x and y exchanged.
    pub(super) fn exchanged(&self) -> Graph {
        let ([i, j, k], [a, b, c]) = (self.axes, self.plane);
        let ([one, x, y, xx, yy, xy], [slope, by_x, by_y]) = (self.v, self.slope);
        Graph {
            axes: [j, i, k],
            plane: [b, a, c],
            v: [one, y, x, yy, xx, xy],
            slope: [slope, by_y, by_x],
            ..*self
        }
    }
}

/// Half the second derivatives xx, yy and xy of xᵀ q x on a plane z = −(a x + b y).
fn bends(q: &[f64; 6], a: f64, b: f64) -> [f64; 3] {
    let [xx, yy, zz, xy, xz, yz] = q;
    [
        (xx - 2.0 * a * xz) + a * a * zz,
        (yy - 2.0 * b * yz) + b * b * zz,
        ((xy - b * xz) - a * yz) + a * b * zz,
    ]
}
