//! Cells of one lattice against cells of another one under an affine map: separating axes, and balls in both.
//!
//! A cell of the second lattice is a parallelepiped on the first one: a turned box, if the map is rigid. All
//! data that depend only on the map are computed once for each pose: fifteen axes, the radius of each
//! lattice's cells along each of them, and the steps of the centre from a cell to its children.
//!
//! # Rounding
//!
//! Any axis proves that two convex bodies are apart, if their projections on it are. The fifteen axes
//! therefore need not be accurate, and their doubles count as exact. Only the map and the sums are rounded:
//! `slack` bounds this error for each axis, and is added to the radii.
//!
//! Eight children are tested in single precision. Near the limit, the distance of the centre is about as
//! large as the radii, so its rounding error is relative to these. The whole error is less than 2^-22 of the
//! radii; 2^-20 are added.

use super::Ball;
use crate::lattice::Each;
use crate::lattice::exact::{product_down, product_up, sqrt};
use crate::lattice::{Affine, Cell, Frame, axes};
use crate::octree::stats::volume_of;
use wide::f32x8;

/// The number of axes that may separate two parallelepipeds: three normals of each, and nine products of
/// edges.
const AXES: usize = 15;

/// The number of axes including one that separates nothing, for vectors of two, four and eight.
const LANES: usize = 16;

/// The number of face normals, which come first.
const FACES: usize = 6;

/// The factor of the radii that covers the rounding in single precision.
const SINGLE: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// A cell: its lower corner in finest cells, and its edge as a power of two.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) at: [u32; 3],
    pub(super) log: u8,
}

impl Place {
    /// The edge, in finest cells.
    pub(super) fn edge(&self) -> f64 {
        f64::from(1u32 << self.log)
    }

    /// The child in an octant.
    pub(super) fn child(&self, octant: u8) -> Place {
        let log = self.log - 1;
        let half = |axis: usize| u32::from(octant >> axis & 1) << log;
        Place { at: axes(|axis| self.at[axis] + half(axis)), log }
    }

    /// The box from one corner to another, in quarters of the edge.
    pub(super) fn part(&self, low: [u32; 3], high: [u32; 3]) -> Extent {
        let quarter = 0.25 * self.edge();
        Extent {
            centre: axes(|i| f64::from(self.at[i]) + 0.5 * quarter * f64::from(low[i] + high[i])),
            half: axes(|i| 0.5 * quarter * f64::from(high[i] - low[i])),
        }
    }

    fn centre(&self) -> [f64; 3] {
        let half = 0.5 * self.edge();
        self.at.each(|at| f64::from(at) + half)
    }
}

/// A box of a lattice, in finest cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub(super) centre: [f64; 3],
    /// Half of the edges.
    pub(super) half: [f64; 3],
}

/// Two lattices, the second one placed.
pub(super) struct Pose {
    placement: Affine,
    frame: Frame,
    own: Frame,
    /// The map from finest cells of the second lattice to those of the first one: u = linear · v + offset.
    linear: [[f64; 3]; 3],
    offset: [f64; 3],
    /// The maximal error of a centre's image, along each axis of the first lattice.
    error: [f64; 3],
    /// The length, on the first lattice, of the longest edge of the second lattice's finest cells.
    longest: f64,
    /// The coordinates of the axes: of the first, the second, the third dimension.
    axes: [[f64; LANES]; 3],
    /// The radius of a cell of each lattice along the axes, for half an edge of 1.
    radii: [[f64; LANES]; 2],
    /// The contributions of each of the cell's three edges to the radius.
    shares: [[[f64; LANES]; 3]; 2],
    /// The addition to the radii for rounding.
    slack: [f64; LANES],
    /// The change of the centres' difference along the axes from a cell of each lattice to its eight
    /// children, for half an edge of 1 of a child.
    steps: [[f32x8; AXES]; 2],
    /// The factor from a distance along a face normal to a distance in finest cells.
    units: [f32; FACES],
    /// An upper bound of the volume of a finest cell of each lattice, in model units.
    volumes: [f64; 2],
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns a vector along `v` whose longest coordinate is about 1. A vector without direction is replaced by
/// the first unit vector.
fn direction(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    if largest > 0.0 && largest < f64::INFINITY { v.each(|c| c / largest) } else { [1.0, 0.0, 0.0] }
}

impl Pose {
    /// Prepares the comparison of placed cells of `own` with cells of `frame`.
    pub(super) fn new(placement: &Affine, frame: &Frame, own: &Frame) -> Pose {
        let rows = placement.rows();
        let (cell, step) = (frame.cell_size(), own.cell_size());
        let linear = axes(|i| axes(|j| rows[i][j] * step / cell));
        let mut error = [0.0; 3];
        let offset = axes(|i| {
            let (row, origin) = (&rows[i], own.origin());
            let terms = axes(|j| row[j] * origin[j]);
            let size =
                terms.iter().map(|term| term.abs()).sum::<f64>() + row[3].abs() + frame.origin()[i].abs();
            let reach = linear[i].iter().map(|entry| entry.abs()).sum::<f64>() * f64::from(own.cells());
            // Each entry has two roundings, and each of the sums for a centre a dozen at the most.
            error[i] = 64.0 * f64::EPSILON * (reach + size / cell + f64::from(frame.cells()));
            ((terms[0] + terms[1] + terms[2]) + (row[3] - frame.origin()[i])) / cell
        });
        let columns = axes(|j| axes(|i| linear[i][j]));
        let longest = columns.iter().map(|&column| sqrt(dot(column, column))).fold(0.0, f64::max);
        let mut pose = Pose {
            placement: *placement,
            frame: *frame,
            own: *own,
            linear,
            offset,
            error,
            longest,
            axes: [[0.0; LANES]; 3],
            radii: [[1.0; LANES]; 2],
            shares: [[[1.0; LANES]; 3]; 2],
            slack: [0.0; LANES],
            steps: [[f32x8::ZERO; AXES]; 2],
            units: [0.0; FACES],
            volumes: [volume(frame, 1.0), stretched_volume(placement, own)],
        };
        let directions = columns.each(direction);
        for axis in 0..AXES {
            let unit = |i: usize| axes(|k| f64::from(u8::from(k == i)));
            let along = match axis {
                0..3 => unit(axis),
                3..FACES => direction(cross(directions[(axis + 1) % 3], directions[(axis + 2) % 3])),
                _ => {
                    let (i, j) = ((axis - FACES) / 3, (axis - FACES) % 3);
                    direction(cross(unit(i), directions[j]))
                }
            };
            pose.take(axis, along, &columns);
        }
        pose
    }

    /// Stores an axis.
    fn take(&mut self, axis: usize, along: [f64; 3], columns: &[[f64; 3]; 3]) {
        let sizes = along.each(f64::abs);
        let shadows = columns.each(|column| dot(along, column));
        // (Three roundings of products, each counted like the largest.)
        let rounding = columns.each(|column| 8.0 * f64::EPSILON * dot(sizes, column.each(f64::abs)));
        let shares = [sizes, axes(|j| shadows[j].abs() + rounding[j])];
        for (lattice, shares) in shares.into_iter().enumerate() {
            for i in 0..3 {
                self.shares[lattice][i][axis] = shares[i] * SINGLE;
            }
            self.radii[lattice][axis] = shares.iter().sum::<f64>() * SINGLE;
        }
        for i in 0..3 {
            self.axes[i][axis] = along[i];
        }
        self.slack[axis] = dot(sizes, self.error) * SINGLE;
        let steps = |[x, y, z]: [f64; 3]| {
            f32x8::new(core::array::from_fn(|k| {
                let signed = |c: f64, bit: usize| if k >> bit & 1 != 0 { c } else { -c };
                (signed(x, 0) + signed(y, 1) + signed(z, 2)) as f32
            }))
        };
        // The difference is the second centre minus the first.
        self.steps[0][axis] = steps(along.each(|c| -c));
        self.steps[1][axis] = steps(shadows);
        if axis < FACES {
            self.units[axis] = (1.0 / sqrt(dot(along, along))) as f32;
        }
    }

    /// Returns the difference of the centres of two cells, the second one placed.
    fn difference(&self, a: &Place, b: &Place) -> [f64; 3] {
        self.between(a.centre(), b.centre())
    }

    #[inline(always)]
    fn between(&self, a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        axes(|i| (dot(self.linear[i], b) + self.offset[i]) - a[i])
    }

    /// True if a cell of the first lattice is at least as large as a cell of the second.
    #[inline(always)]
    pub(super) fn is_larger(&self, a: &Place, b: &Place) -> bool {
        a.edge() >= b.edge() * self.longest
    }

    /// Returns the children among `some` that no axis separates from a box of the other lattice, and the
    /// depth of each child's overlap as a share of the edges. The children belong to a cell of the first
    /// lattice or of the second.
    #[inline(always)]
    pub(super) fn overlapping(&self, cell: &Place, of_a: bool, other: &Extent, some: u8) -> (u8, [f32; 8]) {
        let half = 0.25 * cell.edge();
        let (own, difference) = if of_a {
            (0, self.between(cell.centre(), other.centre))
        } else {
            (1, self.between(other.centre, cell.centre()))
        };
        let (steps, radii, shares) = (&self.steps[own], &self.radii[own], &self.shares[1 - own]);
        let (mut at, mut radius) = ([0.0f32; LANES], [0.0f32; LANES]);
        for k in 0..LANES {
            let along = self.axes[0][k] * difference[0]
                + self.axes[1][k] * difference[1]
                + self.axes[2][k] * difference[2];
            at[k] = along as f32;
            let reach =
                shares[0][k] * other.half[0] + shares[1][k] * other.half[1] + shares[2][k] * other.half[2];
            radius[k] = (radii[k] * half + reach + self.slack[k]) as f32;
        }
        let longest = other.half.iter().fold(0.0, |longest: f64, &half| longest.max(half));
        let size = if of_a { half + longest * self.longest } else { half * self.longest + longest };
        let half = f32x8::splat(half as f32);
        let mut apart = f32x8::ZERO;
        let mut depth = f32x8::splat(f32::MAX);
        for k in 0..FACES {
            let limit = f32x8::splat(radius[k]);
            let place = (steps[k] * half + f32x8::splat(at[k])).abs();
            apart |= place.simd_gt(limit);
            depth = depth.fast_min((limit - place) * f32x8::splat(self.units[k]));
        }
        let mut left = some & !(apart.to_bitmask() as u8);
        if left == 0 {
            return (0, [0.0; 8]);
        }
        for k in FACES..AXES {
            let place = (steps[k] * half + f32x8::splat(at[k])).abs();
            apart |= place.simd_gt(f32x8::splat(radius[k]));
        }
        left &= !(apart.to_bitmask() as u8);
        let share = 1.0 / size as f32;
        (left, (depth * f32x8::splat(share)).to_array())
    }

    /// True if an axis separates two cells, in double precision.
    pub(super) fn is_apart(&self, a: &Place, b: &Place) -> bool {
        let difference = self.difference(a, b);
        let (half, other) = (0.5 * a.edge(), 0.5 * b.edge());
        (0..AXES).any(|k| {
            let along = dot(axes(|i| self.axes[i][k]), difference).abs();
            let radius = self.radii[0][k] * half + self.radii[1][k] * other;
            along > radius / SINGLE * (1.0 + 8.0 * f64::EPSILON) + self.slack[k]
        })
    }

    /// Returns a ball in two cells, the second one placed, and a cell of the frame in both, if one is found.
    /// `None` if the cells touch, or overlap so little that rounding may be the cause.
    pub(super) fn ball(&self, a: &Place, b: &Place) -> Option<(Ball, Option<Cell>)> {
        let (back, scale) = (self.placement.inverse_linear(), self.frame.cell_size() / self.own.cell_size());
        let two = Two {
            pose: self,
            a,
            inverse: back.each(|row| row.each(|entry| entry * scale)),
            difference: self.difference(a, b),
            half: 0.5 * a.edge(),
            other: 0.5 * b.edge(),
        };
        two.ball()
    }

    /// Returns an upper bound of the volume, in cubic model units, of the intersection of two solids that
    /// occupy `a` and `b` finest cells.
    pub(super) fn most(&self, a: f64, b: f64) -> f64 {
        product_up(a, self.volumes[0]).min(product_up(b, self.volumes[1]))
    }
}

/// Two cells that may overlap, in coordinates from the centre of the first one.
struct Two<'p> {
    pose: &'p Pose,
    a: &'p Place,
    /// The linear map of vectors back to the second lattice. The error of each entry is less than 2^-49 of
    /// the entry.
    inverse: [[f64; 3]; 3],
    /// The centre of the second cell.
    difference: [f64; 3],
    /// Half an edge of each cell, in finest cells of its lattice.
    half: f64,
    other: f64,
}

impl Two<'_> {
    fn ball(&self) -> Option<(Ball, Option<Cell>)> {
        // The centre of the smaller cell often lies in the larger one.
        let centres = [[0.0; 3], self.difference].each(|point| (self.radius(&point), point));
        let enough = 0.1 * self.half.min(self.other);
        let near = if centres[0].0 > centres[1].0 { centres[0] } else { centres[1] };
        let (radius, point) = match self.middle() {
            Some(middle) if near.0.is_nan() || near.0 <= enough => (self.radius(&middle), middle),
            _ => near,
        };
        let (frame, centre) = (&self.pose.frame, self.a.centre());
        let inside = axes(|i| centre[i] + point[i]);
        let at = axes(|i| frame.origin()[i] + inside[i] * frame.cell_size());
        // The centre is rounded twice, and the distances from it are rounded as well.
        let size = frame.origin().iter().fold(frame.edge(), |size, origin| size.max(origin.abs()));
        let radius = radius * frame.cell_size() * (1.0 - 1e-9) - 16.0 * f64::EPSILON * (size + frame.edge());
        (radius > 0.0).then(|| (Ball { centre: at, radius }, self.cell(inside)))
    }

    /// Returns the radius of a ball around a point that lies in both cells, in finest cells of the first
    /// lattice. The radius is not positive, or NaN, if there is no such ball.
    fn radius(&self, point: &[f64; 3]) -> f64 {
        let own = (0..3).map(|i| self.half - point[i].abs()).fold(f64::INFINITY, f64::min);
        (0..3).fold(own, |least, k| least.min((self.other - self.reach(k, point)) / norm(self.inverse[k])))
    }

    /// Returns an upper bound of a point's distance from the centre of the second cell along an axis of the
    /// second lattice.
    fn reach(&self, k: usize, point: &[f64; 3]) -> f64 {
        let row = self.inverse[k];
        let away = axes(|i| point[i] - self.difference[i]);
        // Entries of the row, the difference and the sum are rounded.
        let rounding =
            dot(row.each(f64::abs), axes(|i| self.pose.error[i] + 32.0 * f64::EPSILON * away[i].abs()));
        dot(row, away).abs() + rounding
    }

    /// Returns the approximate middle of two cells' intersection: the mean of the intersection's corners.
    fn middle(&self) -> Option<[f64; 3]> {
        let (difference, half, other) = (&self.difference, self.half, self.other);
        let columns = axes(|j| axes(|i| self.pose.linear[i][j] * other));
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        let mut add = |point: [f64; 3]| {
            sum = axes(|i| sum[i] + point[i]);
            count += 1.0;
        };
        // Corners of the first cell in the second one.
        for k in 0..8 {
            let corner = axes(|i| if k >> i & 1 != 0 { half } else { -half });
            let away = axes(|i| corner[i] - difference[i]);
            if (0..3).all(|row| dot(self.inverse[row], away).abs() <= other) {
                add(corner);
            }
        }
        // Faces of the second cell, clipped at the faces of the first one.
        for face in 0..6 {
            let (axis, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
            let (u, v) = (columns[(axis + 1) % 3], columns[(axis + 2) % 3]);
            let mut polygon = Polygon::default();
            for (p, q) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
                polygon.push(axes(|i| difference[i] + sign * columns[axis][i] + p * u[i] + q * v[i]));
            }
            for side in 0..6 {
                polygon = polygon.cut_off(side / 2, if side % 2 == 0 { 1.0 } else { -1.0 }, half);
            }
            polygon.corners().iter().copied().for_each(&mut add);
        }
        (count > 0.0).then(|| sum.each(|c| c / count))
    }

    /// Returns the largest cell of the frame around a point that lies in both cells, if there is one.
    fn cell(&self, inside: [f64; 3]) -> Option<Cell> {
        let (frame, a, centre) = (&self.pose.frame, self.a, self.a.centre());
        let most = frame.cells() - 1;
        // (A negative number becomes zero.)
        let finest = inside.each(|c| (c as u32).min(most));
        (0..=a.log).rev().find_map(|log| {
            let place = Place { at: finest.each(|c| c >> log << log), log };
            let (middle, half) = (place.centre(), 0.5 * place.edge());
            let away = axes(|i| middle[i] - centre[i]);
            let within = (0..3).all(|i| {
                let radius = self.inverse[i].iter().map(|c| c.abs()).sum::<f64>() * half;
                place.at[i] >> a.log == a.at[i] >> a.log
                    && self.reach(i, &away) + radius * (1.0 + 32.0 * f64::EPSILON) < self.other
            });
            within.then(|| Cell { level: frame.depth() - log, at: finest.each(|c| c >> log) })
        })
    }
}

/// An upper bound of the length of a vector, considering rounding.
fn norm(v: [f64; 3]) -> f64 {
    sqrt(dot(v, v)) * (1.0 + 8.0 * f64::EPSILON)
}

/// An upper bound of the volume of `cells` finest cells.
fn volume(frame: &Frame, cells: f64) -> f64 {
    let size = frame.cell_size();
    product_up(product_up(product_up(cells, size), size), size)
}

/// An upper bound of the volume of a placed finest cell: the product of its edges.
fn stretched_volume(placement: &Affine, own: &Frame) -> f64 {
    let edges = axes(|j| norm(axes(|i| placement.rows()[i][j])));
    edges.iter().fold(volume(own, 1.0), |volume, &edge| product_up(volume, edge))
}

/// A lower bound of the volume of a cell or of a ball in a frame, whichever is given.
pub(super) fn least_volume(frame: &Frame, cell: Option<Cell>, ball: Option<Ball>) -> f64 {
    let of_cell = |cell: Cell| volume_of(frame, 1 << (3 * (frame.depth() - cell.level)), u64::MAX).lower;
    let of_ball = |ball: Ball| {
        // (The factor is slightly less than 4/3 π.)
        product_down(product_down(product_down(4.188_790_2, ball.radius), ball.radius), ball.radius)
    };
    cell.map_or(0.0, of_cell).max(ball.map_or(0.0, of_ball))
}

/// A convex polygon of few corners.
#[derive(Default)]
struct Polygon {
    corners: [[f64; 3]; 12],
    count: usize,
}

impl Polygon {
    fn push(&mut self, corner: [f64; 3]) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    fn corners(&self) -> &[[f64; 3]] {
        &self.corners[..self.count]
    }

    /// The part whose coordinate, taken with a sign, is at most `limit`.
    fn cut_off(&self, axis: usize, sign: f64, limit: f64) -> Polygon {
        let mut rest = Polygon::default();
        let corners = self.corners();
        for (i, p) in corners.iter().enumerate() {
            let q = &corners[(i + 1) % corners.len()];
            let (over, next) = (sign * p[axis] - limit, sign * q[axis] - limit);
            if over <= 0.0 {
                rest.push(*p);
            }
            if (over < 0.0) != (next < 0.0) && over != next {
                let t = over / (over - next);
                if t > 0.0 && t < 1.0 {
                    rest.push(axes(|k| p[k] + t * (q[k] - p[k])));
                }
            }
        }
        rest
    }
}
