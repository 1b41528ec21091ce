//! Moments of the solid of a mesh in a cell, without splitting the cell.
//!
//! The solid's indicator function changes only at triangles, and the change at each triangle is known. So one
//! value on a line gives the indicator all along it, and the moments are sums over triangles. Lines lead from
//! a *base* point b (a finest centre of known winding number) along z, then y, then x to all points of the
//! cell. Along such a line, the integral of a polynomial p over the solid differs from the integral for a
//! constant indicator by a sum over the places ξ where the line meets triangles: the change at ξ times ∫ p
//! from ξ to the end of the line that lies behind ξ, seen from b. So each triangle contributes three
//! integrals: over its part in the cell, for lines along x; over its segment in the plane x = b_x, for lines
//! along y; and a value where it meets the line (b_x, b_y, ·). (This is the divergence theorem, in a form
//! that needs only triangles.)
//!
//! **Rounding.** The vertices are rounded in the cell's coordinates, and so are the points where edges meet
//! the plane. The rounded surface is still closed, because triangles round shared vertices and edges alike:
//! the side of the plane or of the line on which a point counts is a comparison of doubles. So the integrals
//! are those of another solid, which differs from the true one by the region between the two surfaces. That
//! region does not contain b if all triangles keep away from b. Every triangle adds to the error in
//! proportion to the extent of its part that may lie in the cell. Triangles that meet the plane add as if
//! they were as large as the cell.

use super::base::Base;
use super::local::{CLIPPING, Point, Polygon, Seen, UNIT, View, between, cross, minus};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::two_sum;
use crate::lattice::{CellMoments, CubeMoments, Interval};
use crate::mesh::{FillRule, Sides};

/// In a cell with more triangles than this, the sides on which the solid lies are not computed.
const MOST: usize = 48;

impl View<'_> {
    /// Returns the moments of the solid in the cell. `None` if triangles intersect in the cell, or the error
    /// is too large.
    pub(super) fn moments(&self, sides: &Sides, fill: FillRule) -> Result<Option<CellMoments>, Error> {
        if self.are_known(sides) {
            return Ok(self.base().and_then(|base| self.integral(&base, fill, self.known(sides))));
        }
        if self.triangles.len() > MOST {
            return Ok(None);
        }
        let Some(base) = self.base() else { return Ok(None) };
        let senses = self.senses(sides, &base, fill)?;
        Ok(senses.and_then(|senses| self.integral(&base, fill, senses.into_iter())))
    }

    /// Returns the area of the boundary in the cell. `None` if the surface may deviate from the mesh.
    pub(super) fn area(&self, sides: &Sides, fill: FillRule) -> Result<Option<Interval>, Error> {
        if self.placed.displacement > 0.0 {
            return Ok(None);
        }
        if self.are_known(sides) {
            return Ok(self.sum_areas(self.known(sides).map(Some)));
        }
        if self.triangles.len() > MOST {
            return Ok(Some(self.most_area(sides)));
        }
        if let Some(base) = self.base()
            && let Some(senses) = self.senses(sides, &base, fill)?
        {
            return Ok(self.sum_areas(senses.into_iter().map(Some)));
        }
        Ok(self.sum_areas(self.triangles.iter().map(|&triangle| sides.of(triangle))))
    }

    fn are_known(&self, sides: &Sides) -> bool {
        self.triangles.iter().all(|&triangle| sides.of(triangle).is_some())
    }

    fn known(&self, sides: &Sides) -> impl Iterator<Item = i8> {
        self.triangles.iter().filter_map(|&triangle| sides.of(triangle))
    }

    /// Sums the area of the triangles at which the solid ends. A triangle of unknown sense counts in the
    /// upper bound only.
    fn sum_areas(&self, senses: impl Iterator<Item = Option<i8>>) -> Option<Interval> {
        let (mut lower, mut upper) = (0.0, 0.0);
        for (&triangle, sense) in self.triangles.iter().zip(senses).filter(|(_, sense)| *sense != Some(0)) {
            let seen = self.seen(triangle);
            let (slack, extent) = (seen.slack(), seen.extent());
            // The error of a polygon whose corners have errors of `slack`.
            let error = 16.0 * extent * slack + 64.0 * UNIT * extent * extent;
            let [inner, outer] = if seen.is_within(1.0 - 4.0 * slack) {
                [seen.area(); 2]
            } else {
                [seen.clipped(1.0 - 4.0 * slack)?.area(), seen.clipped(1.0 + 4.0 * slack)?.area()]
            };
            upper += outer + error;
            if sense.is_some() {
                lower += (inner - error).max(0.0);
            }
        }
        let of_sums = UNIT * self.triangles.len() as f64;
        Interval::new(lower * (1.0 - of_sums), upper * (1.0 + of_sums))
    }

    /// An upper bound of the boundary's area in the cell: cheap.
    fn most_area(&self, sides: &Sides) -> Interval {
        let ends = self.triangles.iter().filter(|&&triangle| sides.of(triangle) != Some(0));
        let areas = ends.map(|&triangle| {
            let seen = self.seen(triangle);
            let (reach, extent) = (seen.reach, seen.extent());
            let error = 16.0 * reach * seen.slack() + 64.0 * UNIT * reach * reach;
            // A plane section of a cube of edge 1 has an area of at most √2.
            (seen.area() + error).min(1.5 * extent * extent)
        });
        let upper: f64 = areas.sum();
        Interval::between(0.0, upper * (1.0 + UNIT * self.triangles.len() as f64))
    }

    /// Returns the moments of the solid. `senses` says on which side of each triangle the solid lies.
    fn integral(&self, base: &Base, fill: FillRule, senses: impl Iterator<Item = i8>) -> Option<CellMoments> {
        let mut sums = Sums::default();
        let radius = self.radius();
        for (&triangle, sense) in self.triangles.iter().zip(senses).filter(|(_, sense)| *sense != 0) {
            let seen = self.seen(triangle);
            sums.add(&seen, &base.at, f64::from(sense))?;
            if radius > 0.0 {
                sums.error += tube(&seen, radius * (1.0 + 1e-9));
            }
        }
        let known = sums.finish(fill.encloses(base.winding));
        // (NaN does not pass.)
        (known.error < 1.0).then_some(known)
    }
}

/// The volume within distance `r` of the part of a triangle that may lie in the cell, with a margin for
/// rounding here.
fn tube(seen: &Seen, r: f64) -> f64 {
    // A plane section of a cube of edge 1 has an area of at most √2, and a perimeter below 5.
    let extent = seen.extent() + 2.0 * r;
    (2.83 * extent * extent + (7.86 * extent + 4.19 * r) * r) * r
}

/// Sums over triangles.
#[derive(Default)]
struct Sums {
    /// The volume, first and second moments, in the order of [`CubeMoments`].
    values: [f64; 10],
    /// The rounding errors of the sums.
    lost: [f64; 10],
    /// A bound of the terms' magnitudes, and their number.
    size: f64,
    count: f64,
    error: f64,
}

/// ∫ 1, ∫ x, ∫ x² from x to the end of the cell on the side of `sign`.
#[inline(always)]
fn powers(x: f64, sign: f64) -> [f64; 3] {
    // The distance to the end.
    let u = 1.0 - sign * x;
    let square = u * u;
    [u, sign * (u - 0.5 * square), u - square + square * u * (1.0 / 3.0)]
}

impl Sums {
    #[inline(always)]
    fn add_all(&mut self, terms: &[f64; 10], weight: f64) {
        for (k, term) in terms.iter().enumerate() {
            let (sum, lost) = two_sum(self.values[k], weight * term);
            self.values[k] = sum;
            self.lost[k] += lost;
        }
        self.count += 1.0;
    }

    /// Adds the contribution of a triangle.
    fn add(&mut self, seen: &Seen, base: &Point, sense: f64) -> Option<()> {
        let polygon = seen.clipped(1.0)?;
        let above = seen.corners.each(|corner| corner[0] >= base[0]);
        let is_cut = above[0] != above[1] || above[1] != above[2];
        if is_cut {
            self.add_polygon(&polygon.below(0, -1.0, -base[0])?, 1.0, sense);
            self.add_polygon(&polygon.below(0, 1.0, base[0])?, -1.0, sense);
            self.add_segment(&seen.segment(above, base[0]), base, sense);
        } else {
            self.add_polygon(&polygon, if above[0] { 1.0 } else { -1.0 }, sense);
        }
        // A corner that moves by d along each axis moves the boundary of the domain of integration: for each
        // edge, an area below 1.5 times the extent times d is gained or lost, twice, and more at an edge of
        // the cell. Integrands are at most 2. The same holds for the two corners that each plane cuts off.
        // The terms carry at most 60 roundings, and areas 32.
        let extent = seen.extent();
        let planes = seen.planes(1.0) + if is_cut { 2.0 } else { 0.0 };
        let clipping = 2.0 * CLIPPING * UNIT * seen.reach * planes;
        self.error += extent * (64.0 * seen.error + clipping) + 192.0 * UNIT * extent * extent;
        self.size += 4.0 * extent * extent;
        if is_cut {
            self.size += 32.0;
            self.error += 64.0 * (seen.error + 4.0 * UNIT * seen.reach);
        }
        Some(())
    }

    /// Adds the integral over a polygon on the side of `sign` of the plane x = b_x.
    #[inline]
    fn add_polygon(&mut self, polygon: &Polygon, sign: f64, sense: f64) {
        let [a, rest @ ..] = polygon.points() else { return };
        for ends in rest.windows(2) {
            let (b, c) = (&ends[0], &ends[1]);
            // Twice the area, projected along x.
            let area = cross(&minus(b, a), &minus(c, a))[0];
            if area == 0.0 {
                continue;
            }
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            let centre = axes(|k| (a[k] + b[k] + c[k]) * (1.0 / 3.0));
            // Exact for polynomials of degree three, such as these.
            let mut terms = [0.0; 10];
            for (p, weight) in [
                (a, 1.0 / 20.0),
                (b, 1.0 / 20.0),
                (c, 1.0 / 20.0),
                (&ab, 2.0 / 15.0),
                (&bc, 2.0 / 15.0),
                (&ca, 2.0 / 15.0),
                (&centre, 9.0 / 20.0),
            ] {
                let &[x, y, z] = p;
                let [one, first, second] = powers(x, sign).each(|power| power * weight);
                let (of_y, of_z) = (y * one, z * one);
                let values =
                    [one, first, of_y, of_z, second, y * of_y, z * of_z, y * first, z * first, y * of_z];
                terms.iter_mut().zip(values).for_each(|(term, value)| *term += value);
            }
            self.add_all(&terms, -0.5 * sense * sign * area);
        }
    }

    /// Adds the integral over a segment in the plane x = b_x, and the value where the segment meets the line
    /// (b_x, b_y, ·).
    fn add_segment(&mut self, [p, q]: &[Point; 2], base: &Point, sense: f64) {
        // The part in the cell: Liang and Barsky 1984.
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for axis in [1, 2] {
            let (from, way) = (p[axis], q[axis] - p[axis]);
            if way == 0.0 {
                if from.abs() > 1.0 {
                    (first, last) = (1.0, 0.0);
                }
                continue;
            }
            let (one, other) = ((-1.0 - from) / way, (1.0 - from) / way);
            (first, last) = (first.max(one.min(other)), last.min(one.max(other)));
        }
        let above = [p, q].each(|end| end[1] >= base[1]);
        if above[0] == above[1] {
            self.add_piece([p, q], [first, last], if above[0] { 1.0 } else { -1.0 }, sense);
            return;
        }
        let t = (base[1] - p[1]) / (q[1] - p[1]);
        let side = |above: bool| if above { 1.0 } else { -1.0 };
        self.add_piece([p, q], [first, last.min(t)], side(above[0]), sense);
        self.add_piece([p, q], [first.max(t), last], side(above[1]), sense);
        let z = between(p, q, 1, base[1])[2];
        if z.abs() < 1.0 {
            let sign = side(z > base[2]);
            let [one, first, second] = powers(z, sign);
            let terms = [
                4.0 * one,
                0.0,
                0.0,
                4.0 * first,
                4.0 / 3.0 * one,
                4.0 / 3.0 * one,
                4.0 * second,
                0.0,
                0.0,
                0.0,
            ];
            self.add_all(&terms, -sense * sign * side(above[0]));
        }
    }

    /// Adds the integral over a piece of a segment on the side of `sign` of the line (b_x, b_y, ·).
    fn add_piece(&mut self, [p, q]: [&Point; 2], [first, last]: [f64; 2], sign: f64, sense: f64) {
        if first >= last {
            return;
        }
        let at = |t: f64| [1, 2].each(|axis| p[axis] + t * (q[axis] - p[axis]));
        // Simpson's rule, exact for degree three.
        let mut terms = [0.0; 10];
        for (t, weight) in [(first, 1.0 / 6.0), (0.5 * (first + last), 2.0 / 3.0), (last, 1.0 / 6.0)] {
            let [y, z] = at(t);
            let [one, first, second] = powers(y, sign).each(|power| 2.0 * weight * power);
            let values =
                [one, 0.0, first, z * one, one * (1.0 / 3.0), second, z * z * one, 0.0, 0.0, z * first];
            terms.iter_mut().zip(values).for_each(|(term, value)| *term += value);
        }
        self.add_all(&terms, -sense * sign * (last - first) * (q[2] - p[2]));
    }

    fn finish(&self, is_inside: bool) -> CellMoments {
        let whole = if is_inside { CubeMoments::FULL } else { CubeMoments::EMPTY };
        let value = |k: usize| self.values[k] + self.lost[k];
        let moments = CubeMoments {
            volume: whole.volume + value(0),
            first: [value(1), value(2), value(3)],
            second: [0, 1, 2, 3, 4, 5].each(|k| whole.second[k] + value(4 + k)),
        };
        // The lost parts were rounded when they were added up; the results and the sum of errors are rounded
        // too.
        let of_sums = UNIT * self.count;
        let error = (self.error + 32.0 * UNIT + of_sums * of_sums * self.size) * (1.0 + of_sums);
        CellMoments { moments, error }
    }
}

impl Seen {
    /// Returns where the triangle meets the plane x = `bound`, from where its boundary goes down to where it
    /// comes up. `above` says which corners lie above the plane; one corner differs from the other two.
    fn segment(&self, above: [bool; 3], bound: f64) -> [Point; 2] {
        let mut ends = [[0.0; 3]; 2];
        for i in 0..3 {
            let j = (i + 1) % 3;
            if above[i] != above[j] {
                // Both triangles at the edge compute the same point.
                let (low, high) = if self.vertices[i] < self.vertices[j] { (i, j) } else { (j, i) };
                let end = between(&self.corners[low], &self.corners[high], 0, bound);
                ends[usize::from(above[j])] = end;
            }
        }
        ends
    }
}

fn middle(a: &Point, b: &Point) -> Point {
    axes(|k| 0.5 * (a[k] + b[k]))
}
