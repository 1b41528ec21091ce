//! The test of which cells a triangle cuts.
//!
//! The separating-axis test of a triangle and a cube in the form of Schwarz and Seidel (*Fast parallel
//! surface and solid voxelization on GPUs*, 2010): bounding box, plane, and the triangle's edges in the three
//! coordinate planes. Each condition is linear in the cell's position, so that along a column it holds on an
//! interval and 64 cells are decided at once.
//!
//! A surface cell is never missed: every condition is widened by a bound of its rounding error. Where the
//! arithmetic is exact, the bound is zero, and contact is not overlap: a triangle that only touches a cell's
//! boundary does not cut it. Coarser cells are widened more than their children, so that a triangle that cuts
//! a cell also cuts its parent.

use super::placed::{Corners, Placed, accuracy, bounds, is_exact};
use crate::lattice::Each;
use crate::lattice::MAX_DEPTH;

/// A triangle, prepared for the test against cubes of one size.
pub(super) struct Overlap {
    /// The bounding box, rounded outward.
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
    /// The plane's normal. Then its offsets for the cube's corner that is farthest ahead along the normal,
    /// and for the corner that is farthest behind.
    normal: [f64; 3],
    ahead: f64,
    behind: f64,
    slack: f64,
    /// For each axis w, the triangle's edges projected along w: a cube with its lower corner at (u, v) is
    /// beside the triangle unless `n · (u, v) + offset > −slack` for all three edges. Where the triangle is
    /// (nearly) edge-on, so that its edges have no sure inner side, these are the two sides of the strip
    /// along its longest edge.
    edges: [[Edge; 3]; 3],
}

#[derive(Clone, Copy)]
struct Edge {
    u: f64,
    v: f64,
    offset: f64,
    slack: f64,
}

/// The other two axes, ascending.
const OTHERS: [(usize, usize); 3] = [(1, 2), (0, 2), (0, 1)];

impl Overlap {
    /// Prepares the test of a triangle against cubes of edge `size` (in finest cells), at `height` levels
    /// above the finest.
    pub(super) fn new(placed: &Placed, corners: &Corners, size: f64, height: u8) -> Overlap {
        let (min, max) = bounds(placed, corners);
        let [a, b, c] = corners.each(|corner| corner.at);
        let thickest = (0..3).fold(1.0, |most: f64, axis| most.max(max[axis] - min[axis]));
        let unit = if is_exact(placed, corners) {
            0.0
        } else {
            let (error, magnitude) = accuracy(placed, corners);
            16.0 * error + 64.0 * f64::EPSILON * (magnitude + placed.displacement)
        };
        // A surface that deviates from the mesh lies in the Minkowski sum of the triangle and a cube, which
        // reaches this far along a direction.
        let aside = |direction: &[f64]| {
            placed.displacement * direction.iter().fold(0.0, |sum: f64, c| sum + c.abs()) * (1.0 + 1e-9)
        };
        // Relative to the product of their factors' sizes, the conditions have an error of a few dozen
        // roundings. A level's widening exceeds the widening of the level below by more than both errors.
        let (wrong, extent) = ((height as f64 + 1.0) * unit, thickest + size);
        // The choice of edges or strip is the same for cubes of all sizes; otherwise a cell might be cut and
        // its parent not.
        let edge_on = 4.0 * (MAX_DEPTH as f64 + 1.0) * unit * (thickest + placed.frame.cells() as f64);
        let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        let (ab, bc, ca) = (minus(b, a), minus(c, b), minus(a, c));
        let normal =
            [ab[1] * bc[2] - ab[2] * bc[1], ab[2] * bc[0] - ab[0] * bc[2], ab[0] * bc[1] - ab[1] * bc[0]];
        let height = normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2];
        let reach = |sign: f64| normal.iter().fold(0.0, |sum, n| sum + (sign * n).max(0.0)) * sign * size;
        // (A loop, because three copies of this code are not inlined and take an eighth longer in all.)
        let edges = [0, 1, 2].each(|w| {
            let (u, v) = OTHERS[w];
            // Twice the area projected along w; its sign orients the edges. (Along y, (x, z) is left-handed.)
            let area = if w == 1 { -normal[1] } else { normal[w] };
            let side = |nu: f64, nv: f64, least: f64| {
                let offset = size * (nu.max(0.0) + nv.max(0.0)) - least;
                let aside = if placed.displacement > 0.0 { aside(&[nu, nv]) } else { 0.0 };
                Edge { u: nu, v: nv, offset, slack: wrong * extent + aside }
            };
            if area.abs() > edge_on {
                let sign = if area > 0.0 { 1.0 } else { -1.0 };
                return [(a, ab), (b, bc), (c, ca)].each(|(from, edge)| {
                    let (nu, nv) = (-edge[v] * sign, edge[u] * sign);
                    side(nu, nv, nu * from[u] + nv * from[v])
                });
            }
            let length = |edge: &[f64; 3]| edge[u] * edge[u] + edge[v] * edge[v];
            let longest = [bc, ca].into_iter().fold(ab, |l, e| if length(&e) > length(&l) { e } else { l });
            let (nu, nv) = (-longest[v], longest[u]);
            let on = [a, b, c].each(|corner| nu * corner[u] + nv * corner[v]);
            let (mut least, mut most) = (on[0].min(on[1]).min(on[2]), on[0].max(on[1]).max(on[2]));
            if !on.iter().all(|x| x.is_finite()) {
                // `min` and `max` skip NaN; then the limits are unknown.
                (least, most) = (f64::NAN, f64::NAN);
            }
            let (one, other) = (side(nu, nv, least), side(-nu, -nv, -most));
            [one, other, other]
        });
        Overlap {
            min,
            max,
            normal,
            ahead: reach(1.0) - height,
            behind: reach(-1.0) - height,
            // Three factors enter the plane's condition, in three times the terms.
            slack: 4.0 * wrong * extent * extent
                + if placed.displacement > 0.0 { aside(&normal) } else { 0.0 },
            edges,
        }
    }

    /// Returns whether the triangle cuts the cube of the prepared size with the lower corner `at`.
    pub(super) fn cuts(&self, at: [f64; 3], size: f64) -> bool {
        (0..3).all(|axis| self.min[axis] < at[axis] + size && self.max[axis] > at[axis])
            && (0..3).all(|w| {
                let (u, v) = OTHERS[w];
                self.edges[w].iter().all(|edge| edge.passes(at[u], at[v]))
            })
            && exceeds(self.normal[2], at[2], self.column(at[0], at[1], self.ahead), -self.slack)
            && exceeds(-self.normal[2], at[2], -self.column(at[0], at[1], self.behind), -self.slack)
    }

    /// The part of the plane's condition that is constant along a column.
    #[inline(always)]
    fn column(&self, x: f64, y: f64, offset: f64) -> f64 {
        self.normal[0] * x + (self.normal[1] * y + offset)
    }

    /// Returns whether the triangle, projected along z, covers a part of the column of unit cells at (x, y).
    #[inline(always)]
    pub(super) fn over(&self, x: f64, y: f64) -> bool {
        self.edges[2].iter().all(|edge| edge.passes(x, y))
    }

    /// Returns the unit cells among `first..=last` along z (at most 64; bit 0 is `base`) that the triangle,
    /// projected along `w` (0 or 1), covers a part of. `u` is the cells' other coordinate.
    #[inline]
    pub(super) fn beside(&self, w: usize, u: f64, base: i32, first: i32, last: i32) -> u64 {
        let mut mask = bits(base, first, last);
        for edge in &self.edges[w] {
            let row = edge.u * u + edge.offset;
            mask &= above(edge.v, row, -edge.slack, base, first, last);
        }
        mask
    }

    /// Returns the unit cells among `first..=last` of the column at (x, y) that the triangle's plane cuts.
    #[inline]
    pub(super) fn plane(&self, x: f64, y: f64, base: i32, first: i32, last: i32) -> u64 {
        let (ahead, behind) = (self.column(x, y, self.ahead), self.column(x, y, self.behind));
        above(self.normal[2], ahead, -self.slack, base, first, last)
            & above(-self.normal[2], -behind, -self.slack, base, first, last)
    }
}

impl Edge {
    #[inline(always)]
    fn passes(&self, u: f64, v: f64) -> bool {
        exceeds(self.v, v, self.u * u + self.offset, -self.slack)
    }
}

/// Returns whether `slope · k + start > limit`. A value that overflows (with coordinates of astronomic size)
/// counts as true, because only a proven separation may exclude a cell.
#[inline(always)]
fn exceeds(slope: f64, k: f64, start: f64, limit: f64) -> bool {
    let value = slope * k + start;
    // False for NaN on either side.
    !(value <= limit && value > f64::NEG_INFINITY)
}

/// Bits `first..=last`, counted from `base`; none if the range is empty.
#[inline(always)]
fn bits(base: i32, first: i32, last: i32) -> u64 {
    if first > last { 0 } else { !0 >> (63 - (last - first)) << (first - base) }
}

/// Returns the k in `first..=last` with `slope · k + start > limit`, as bits counted from `base`. Products
/// and sums of doubles are monotone, so that these k form an interval that reaches to one end.
#[inline(always)]
fn above(slope: f64, start: f64, limit: f64, base: i32, first: i32, last: i32) -> u64 {
    let holds = |k: i32| exceeds(slope, k as f64, start, limit);
    match (holds(first), holds(last)) {
        (true, true) => bits(base, first, last),
        (false, false) => 0,
        (low, _) => {
            // The guess is right up to rounding: step to the place where the condition itself changes.
            let mut k = (((limit - start) / slope) as i32).clamp(first, last);
            while k > first && holds(k) != low {
                k -= 1;
            }
            while k < last && holds(k + 1) == low {
                k += 1;
            }
            if low { bits(base, first, k) } else { bits(base, k + 1, last) }
        }
    }
}
