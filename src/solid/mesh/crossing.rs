//! The exact places where lines of cell centres pierce triangles.
//!
//! The difference of the winding numbers of two cell centres follows from the triangles that an axis-parallel
//! line between them pierces. All centres are shifted symbolically by (ε, ε², ε³), ε → 0, so that no line
//! ever meets an edge or a vertex and no centre lies on a triangle. The shift is the same for all lines, so
//! that winding numbers do not depend on the path. (Simulation of simplicity: Edelsbrunner and Mücke 1990,
//! with one perturbation for all points.)
//!
//! All results are integers: which rows and columns of centres a triangle covers, and between which two
//! centres of the line it is pierced. Doubles with an error bound decide nearly all of these. Exact
//! arithmetic on the original coordinates decides the rest.

use super::placed::{Corners, Placed, accuracy, are_short, ranks};
use crate::lattice::Each;
use crate::lattice::exact::{DoubleDouble, Expansion};

/// A triangle seen along an axis.
pub(super) struct Projection<'p> {
    placed: &'p Placed,
    triangle: u32,
    corners: Corners,
    axes: Axes,
    /// For each edge (from corner i to corner i + 1): its advance along u per unit of v, and an error bound
    /// of the place where a row meets it.
    edges: [(f64, f64); 3],
    /// The corners' accuracy: an error bound of a position, which includes the roundings of a few sums.
    error: f64,
    short: bool,
    /// The greatest allowed error of a crossing: 2^-36 of the universe's edge.
    fine: f64,
    /// The triangle as a height over (u, v), computed on first use.
    height: Option<Height>,
}

/// `w` is the axis along which lines run, `u < v` are the other two.
#[derive(Clone, Copy)]
struct Axes {
    u: usize,
    v: usize,
    w: usize,
}

#[derive(Clone, Copy)]
struct Height {
    /// The planes of centres between which the triangle lies.
    first: i32,
    last: i32,
    /// The slopes, and an error bound of the height; infinite if the triangle is too steep.
    du: f64,
    dv: f64,
    error: f64,
}

/// The centres of one row that a triangle covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    /// First column.
    pub(super) first: i32,
    /// One past the last column.
    pub(super) end: i32,
    /// The change of the winding number when a line passes the triangle upward: −1 if the line leaves the
    /// solid.
    pub(super) step: i32,
}

impl<'p> Projection<'p> {
    pub(super) fn new(placed: &'p Placed, triangle: u32, corners: Corners, w: usize) -> Projection<'p> {
        let axes = [Axes { u: 1, v: 2, w: 0 }, Axes { u: 0, v: 2, w: 1 }, Axes { u: 0, v: 1, w: 2 }][w];
        let (error, magnitude) = accuracy(placed, &corners);
        let error = error + 4.0 * f64::EPSILON * magnitude;
        let edges = [0, 1, 2].each(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            let slope = (b.at[axes.u] - a.at[axes.u]) / (b.at[axes.v] - a.at[axes.v]);
            // Three positions and the slope of two more enter the meeting point. (NaN and infinity, from
            // edges along the row, make every comparison with this bound uncertain.)
            (slope, 8.0 * error * (1.0 + slope.abs()))
        });
        let fine = f64::from(placed.frame.cells()) * (1.0 / (1u64 << 36) as f64);
        Projection {
            placed,
            triangle,
            corners,
            axes,
            edges,
            error,
            short: are_short(&corners),
            fine,
            height: None,
        }
    }

    /// Rows (planes of centres along v) that the triangle meets: `first..end`.
    pub(super) fn rows(&self) -> (i32, i32) {
        ranks(&self.corners, self.axes.v)
    }

    /// Returns the centres of `row` that the triangle covers.
    #[inline]
    pub(super) fn span(&self, row: i32) -> Option<Span> {
        let v = self.axes.v;
        let above = self.corners.each_ref().each(|corner| row >= corner.rank[v]);
        if above[0] == above[1] && above[1] == above[2] {
            return None;
        }
        // The row meets the two edges at the corner that lies alone on its side of the row.
        let lone = if above[0] == above[1] {
            2
        } else if above[0] == above[2] {
            1
        } else {
            0
        };
        let (before, after) = ((lone + 2) % 3, lone);
        let leaving = self.column(after, row);
        let arriving = self.column(before, row);
        if leaving == arriving {
            return None;
        }
        // Counter-clockwise in (u, v) the edge on the left descends. Seen along y, (x, z) is left-handed.
        let left = if leaving < arriving { above[lone] } else { !above[lone] };
        let descends = !left;
        let faces_up = descends != (self.axes.w == 1);
        Some(Span {
            first: leaving.min(arriving),
            end: leaving.max(arriving),
            step: if faces_up { -1 } else { 1 },
        })
    }

    /// The first column whose centre lies to the right of edge `i` in `row`. The edge must cross the row. A
    /// centre on the edge counts as on its right: the shift along u outweighs the shift along v.
    #[inline(always)]
    fn column(&self, i: usize, row: i32) -> i32 {
        let Axes { u, v, .. } = self.axes;
        let (a, b) = (&self.corners[i], &self.corners[(i + 1) % 3]);
        let (first, last) = (a.rank[u].min(b.rank[u]), a.rank[u].max(b.rank[u]));
        if first == last {
            return first;
        }
        let (slope, error) = self.edges[i];
        let guess = a.at[u] + (row as f64 + 0.5 - a.at[v]) * slope - 0.5;
        search(first, last, guess, error, |column| self.right_of(i, column, row))
    }

    /// Decides exactly whether the centre lies to the right of edge `i`.
    #[cold]
    fn right_of(&self, i: usize, column: i32, row: i32) -> bool {
        let Axes { u, v, .. } = self.axes;
        let j = (i + 1) % 3;
        let ascends = row >= self.corners[i].rank[v];
        // The side of the edge on which the centre lies: positive if left.
        let side = if self.short {
            let (a, b) = (self.corners[i].at, self.corners[j].at);
            let (pu, pv) = (column as f64 + 0.5, row as f64 + 0.5);
            crate::lattice::exact::sign((a[u] - pu) * (b[v] - pv) - (a[v] - pv) * (b[u] - pu))
        } else {
            let original = self.placed.original(self.triangle);
            let from = |corner: usize, axis: usize, index: i32| {
                self.placed.frame.offset(axis, original[corner][axis], 2 * index as i64 + 1)
            };
            let (au, av) = (from(i, u, column), from(i, v, row));
            let (bu, bv) = (from(j, u, column), from(j, v, row));
            au.times(&bv).minus(&av.times(&bu)).sign()
        };
        if ascends { side <= 0 } else { side >= 0 }
    }

    /// Returns the first centre above the triangle on the line at (column, row), which must lie in a span.
    #[inline]
    pub(super) fn above(&mut self, column: i32, row: i32, step: i32) -> i32 {
        let height = match self.height {
            Some(height) => height,
            None => *self.height.insert(self.raise()),
        };
        if height.first == height.last {
            return height.first;
        }
        let Axes { u, v, w } = self.axes;
        let a = self.corners[0].at;
        let (pu, pv) = (column as f64 + 0.5 - a[u], row as f64 + 0.5 - a[v]);
        let guess = a[w] + height.du * pu + height.dv * pv - 0.5;
        search(height.first, height.last, guess, height.error, |k| self.is_above(column, row, k, step))
    }

    /// Returns the first centre as [`above`](Self::above) does, and where the line pierces the triangle: in
    /// finest cells from the universe's lower face, with an error below 2^-36 of the universe's edge.
    #[inline]
    pub(super) fn crossing(&mut self, column: i32, row: i32, step: i32) -> (i32, f64) {
        let height = match self.height {
            Some(height) => height,
            None => *self.height.insert(self.raise()),
        };
        let Axes { u, v, w } = self.axes;
        if height.error < self.fine {
            let a = self.corners[0].at;
            let (pu, pv) = (column as f64 + 0.5 - a[u], row as f64 + 0.5 - a[v]);
            let at = a[w] + height.du * pu + height.dv * pv;
            // The first centre above, unless a centre is too near.
            let nearest = at.clamp(height.first as f64 - 1.0, height.last as f64 + 1.0);
            let k = (nearest - (height.first as f64 - 1.0)) as i32 + (height.first - 1);
            let behind = nearest - (k as f64 + 0.5);
            let above = if behind.abs() > height.error {
                (k + i32::from(behind > 0.0)).clamp(height.first, height.last)
            } else {
                self.above(column, row, step)
            };
            return (above, at);
        }
        let above = self.above(column, row, step);
        (
            above,
            self.near_crossing(column, row, above).unwrap_or_else(|| self.exact_crossing(column, row, above)),
        )
    }

    /// Computes the crossing with a steep triangle relative to centre k of the line, from determinants of
    /// numbers with 106 bits. `None` if 106 bits are too few.
    fn near_crossing(&self, column: i32, row: i32, k: i32) -> Option<f64> {
        let Axes { u, v, w } = self.axes;
        let mut centre = [0; 3];
        (centre[u], centre[v], centre[w]) = (column, row, k);
        let mut size = 0.0f64;
        let mut offsets = [[DoubleDouble::default(); 3]; 3];
        for (offsets, corner) in offsets.iter_mut().zip(self.placed.original(self.triangle)) {
            for axis in 0..3 {
                offsets[axis] =
                    self.placed.frame.near_offset(axis, corner[axis], 2 * centre[axis] as i64 + 1);
                size = size.max(offsets[axis].high.abs());
            }
        }
        let [a, b, c] = &offsets;
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        let det = a[u] * minor(v, w) + a[v] * minor(w, u) + a[w] * minor(u, v);
        let slope = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
        // The errors of both determinants' products, those of the divisor times the greatest possible
        // quotient.
        let wrong = 64.0 * DoubleDouble::EPSILON * size * size * size;
        let cell = self.placed.frame.cell_size();
        (wrong < 0.25 * self.fine * cell * slope.high.abs())
            .then(|| k as f64 + 0.5 + det.quotient(slope) / cell)
    }

    /// Computes the crossing relative to centre k of the line from exact determinants.
    #[cold]
    fn exact_crossing(&self, column: i32, row: i32, k: i32) -> f64 {
        let Axes { u, v, w } = self.axes;
        let mut centre = [0; 3];
        (centre[u], centre[v], centre[w]) = (column, row, k);
        let [a, b, c] = self.placed.original(self.triangle).each(|corner| {
            [0, 1, 2].each(|axis| self.placed.frame.offset(axis, corner[axis], 2 * centre[axis] as i64 + 1))
        });
        let minor = |i: usize, j: usize| b[i].times(&c[j]).minus(&b[j].times(&c[i]));
        let det = a[u].times(&minor(v, w)).plus(&a[v].times(&minor(w, u))).plus(&a[w].times(&minor(u, v)));
        let edge = |to: &[Expansion; 3], axis: usize| to[axis].clone().minus(&a[axis]);
        let slope = edge(&b, u).times(&edge(&c, v)).minus(&edge(&b, v).times(&edge(&c, u)));
        k as f64 + 0.5 + det.estimate() / slope.estimate() / self.placed.frame.cell_size()
    }

    fn raise(&self) -> Height {
        let Axes { u, v, w } = self.axes;
        let (first, last) = ranks(&self.corners, w);
        let [a, b, c] = self.corners.each(|corner| corner.at);
        let edge = |from: [f64; 3], to: [f64; 3]| [to[u] - from[u], to[v] - from[v], to[w] - from[w]];
        let (ab, ac) = (edge(a, b), edge(a, c));
        // The normal in the order (u, v, w), up to its sign.
        let nu = ab[1] * ac[2] - ab[2] * ac[1];
        let nv = ab[2] * ac[0] - ab[0] * ac[2];
        let nw = ab[0] * ac[1] - ab[1] * ac[0];
        let extent = ab.iter().chain(&ac).fold(0.0, |most: f64, x| most.max(x.abs()));
        // Each product has two factors of at most `extent`, each with an error of at most twice a position's
        // error.
        let wrong = 16.0 * self.error * (extent + self.error);
        let (du, dv) = (-nu / nw, -nv / nw);
        let steep = 1.0 + du.abs() + dv.abs();
        let sure = nw.abs() - wrong;
        let error = if sure > 0.0 {
            // The slopes have an error of (their own size + 1) · wrong / |nw|, over a reach of the extent and
            // a cell.
            4.0 * steep * (wrong / sure * (extent + 2.0) + 4.0 * self.error)
        } else {
            f64::INFINITY
        };
        Height { first, last, du, dv, error }
    }

    /// Decides exactly whether centre k of the line lies above the triangle.
    #[cold]
    fn is_above(&self, column: i32, row: i32, k: i32, step: i32) -> bool {
        let Axes { u, v, w } = self.axes;
        let mut centre = [0; 3];
        (centre[u], centre[v], centre[w]) = (column, row, k);
        // A line that passes a triangle upward with step −1 moves along its normal.
        let upward = -step;
        let side = if self.short {
            let [a, b, c] = self
                .corners
                .each(|corner| [0, 1, 2].each(|axis| corner.at[axis] - (centre[axis] as f64 + 0.5)));
            let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
            crate::lattice::exact::sign(-(a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)))
        } else {
            let [a, b, c] = self.placed.original(self.triangle).each(|corner| {
                [0, 1, 2]
                    .each(|axis| self.placed.frame.offset(axis, corner[axis], 2 * centre[axis] as i64 + 1))
            });
            let minor = |i: usize, j: usize| b[i].times(&c[j]).minus(&b[j].times(&c[i]));
            let det =
                a[0].times(&minor(1, 2)).plus(&a[1].times(&minor(2, 0))).plus(&a[2].times(&minor(0, 1)));
            -det.sign()
        };
        match side {
            0 => self.leading_normal() == upward,
            side => side == upward,
        }
    }

    /// The sign of the first non-zero component of the normal: the side to which the shift moves a centre
    /// that lies on the triangle.
    fn leading_normal(&self) -> i32 {
        let [a, b, c] = self.placed.original(self.triangle);
        let edge = |to: [f64; 3], axis: usize| Expansion::sum([to[axis], -a[axis]]);
        (0..3)
            .map(|axis| {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                edge(b, i).times(&edge(c, j)).minus(&edge(b, j).times(&edge(c, i))).sign()
            })
            .find(|&sign| sign != 0)
            .unwrap_or(0)
    }
}

/// Returns the least k in `first..=last` that `holds`. `holds` is monotone and true at `last`. `guess` is the
/// real lower limit of k, up to an error.
#[inline(always)]
fn search(first: i32, last: i32, guess: f64, error: f64, holds: impl Fn(i32) -> bool) -> i32 {
    let guess = guess.clamp(first as f64 - 1.0, last as f64 + 1.0);
    let nearest = (guess + 0.5 - (first as f64 - 1.0)) as i32 + (first - 1);
    let gap = guess - nearest as f64;
    // This is false for NaN too: then nothing is certain.
    let k = if gap.abs() > error && error < 0.25 {
        nearest + (gap > 0.0) as i32
    } else if error < 0.25 {
        return match nearest {
            k if k >= last => last,
            k if k < first => first,
            k => k + !holds(k) as i32,
        };
    } else {
        return bisect(first, last, holds);
    };
    k.clamp(first, last)
}

#[cold]
fn bisect(mut first: i32, mut last: i32, holds: impl Fn(i32) -> bool) -> i32 {
    while first < last {
        let middle = first + (last - first) / 2;
        if holds(middle) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    first
}
