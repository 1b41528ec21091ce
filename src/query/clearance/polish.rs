//! Refinement of the nearest points of two solids on their actual surfaces, where these are known.
//!
//! Points move along straight lines to where these leave a solid, in plain doubles. Interval evaluation of
//! the surfaces' functions then proves that the final points lie in the solids. Lengths are in finest cells.

use super::piece::{Place, between};
use super::simplex::{dot, minus, plus};
use crate::lattice::Each;
use crate::lattice::Interval;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::solid::{Form, OpenSurfaces};

/// The solid in a cell, within which points may move.
pub(super) struct Side<'n> {
    /// The corners of the cell.
    pub(super) ends: [[f64; 3]; 2],
    /// Cells per axis of the universe.
    pub(super) cells: f64,
    /// The surfaces in the cell; `None` if the cell lies in the solid.
    pub(super) open: Option<(OpenSurfaces, [Option<&'n Form>; OpenSurfaces::MOST])>,
}

/// The number of rounds of movements, each along a few lines.
const ROUNDS: usize = 6;

/// The number of bisections of a line.
const HALVINGS: usize = 52;

/// The initial inward shift of a point, and the maximal number of times that the shift grows eightfold until
/// the point is proven to be inside.
const INWARD: f64 = 1.0 / (1u64 << 50) as f64;
const TIMES: usize = 10;

impl Side<'_> {
    fn is_within(&self, point: [f64; 3]) -> bool {
        (0..3).all(|axis| self.ends[0][axis] <= point[axis] && point[axis] <= self.ends[1][axis])
    }

    fn surfaces(&self) -> impl Iterator<Item = (usize, &Form)> {
        self.open.iter().flat_map(|(_, forms)| forms).enumerate().filter_map(|(k, form)| Some((k, (*form)?)))
    }

    /// True if a point lies in the solid, up to rounding.
    fn holds(&self, point: [f64; 3]) -> bool {
        let at = point.each(|c| c / self.cells);
        let signs =
            self.surfaces().fold(0, |signs, (k, form)| signs | u8::from(form.about(at).0 >= 0.0) << k);
        self.is_within(point) && self.open.as_ref().is_none_or(|(open, _)| open.inside(signs))
    }

    /// True if a point is proven to lie in the solid.
    fn proves(&self, point: [f64; 3]) -> bool {
        // (The number of cells is a power of two.)
        let at = point.each(|c| Interval::exactly(c / self.cells));
        let (mut known, mut signs) = (0u8, 0u8);
        for (k, form) in self.surfaces() {
            let value = form.value(&at);
            known |= u8::from(value.lower > 0.0 || value.upper < 0.0) << k;
            signs |= u8::from(value.lower > 0.0) << k;
        }
        let is_inside = |(open, _): &(OpenSurfaces, _)| {
            let all = (0..1u8 << open.indices().len()).filter(|other| other & known == signs);
            all.into_iter().all(|signs| open.inside(signs))
        };
        self.is_within(point) && self.open.as_ref().is_none_or(is_inside)
    }

    /// True if a point lies in the solid or only just outside.
    fn holds_about(&self, point: [f64; 3]) -> bool {
        let (from, to) = (self.ends[0], self.ends[1]);
        let middle = axes(|axis| 0.5 * (from[axis] + to[axis]));
        let size = point.iter().fold(1.0, |most: f64, c| most.max(c.abs()));
        self.holds(point)
            || self.nearest(point).is_some_and(|(form, normal)| {
                let inward = if form.about(point.each(|c| c / self.cells)).0 > 0.0 { -1.0 } else { 1.0 };
                [inward, -inward]
                    .into_iter()
                    .any(|sign| self.holds(plus(point, sign * 64.0 * INWARD * size, normal)))
            })
            || self.holds(plus(point, 1e-12, minus(middle, point)))
    }

    /// Returns the surface that is nearest to a point, and the surface's normal direction.
    fn nearest(&self, point: [f64; 3]) -> Option<(&Form, [f64; 3])> {
        let at = point.each(|c| c / self.cells);
        let seen = self.surfaces().map(|(_, form)| {
            let (value, gradient) = form.about(at);
            let size = sqrt(dot(gradient, gradient));
            (value.abs() / size, form, gradient.each(|c| c / size))
        });
        let nearest = seen.filter(|(away, ..)| away.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, form, normal)| (form, normal))
    }

    fn normal(&self, point: [f64; 3]) -> Option<[f64; 3]> {
        Some(self.nearest(point)?.1)
    }

    /// Returns the last point of the solid on a line that begins in it.
    fn last_on(&self, from: [f64; 3], way: [f64; 3]) -> [f64; 3] {
        let at = |t: f64| plus(from, t, way);
        if self.holds(at(1.0)) {
            return at(1.0);
        }
        let (mut inside, mut outside) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if self.holds(at(middle)) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        at(inside)
    }

    /// Returns a point that is proven to lie in the solid, next to `point` and shifted against `direction`.
    fn proven(&self, point: [f64; 3], direction: [f64; 3]) -> Option<[f64; 3]> {
        if self.proves(point) {
            return Some(point);
        }
        let size = point.iter().fold(1.0, |most: f64, c| most.max(c.abs()));
        let mut inward = INWARD * size;
        for _ in 0..TIMES {
            let moved = plus(point, -inward, direction);
            if self.proves(moved) {
                return Some(moved);
            }
            inward *= 8.0;
        }
        None
    }
}

/// The result of moving two points.
#[derive(Default)]
pub(super) struct Polished {
    /// Points that are proven to lie in the solids, and their distance.
    pub(super) proven: Option<(Interval, [Place; 2])>,
    /// Points in other cells that may be nearer.
    pub(super) beyond: Option<[[f64; 3]; 2]>,
}

/// Returns points near two points of the solids whose distance is less than `least`.
pub(super) fn polished(sides: [&Side<'_>; 2], points: [[f64; 3]; 2], least: f64) -> Polished {
    let mut beyond = None;
    let proven = moved(sides, points, least, &mut beyond);
    Polished { proven, beyond }
}

fn moved(
    [a, b]: [&Side<'_>; 2],
    [mut p, mut q]: [[f64; 3]; 2],
    least: f64,
    beyond: &mut Option<[[f64; 3]; 2]>,
) -> Option<(Interval, [Place; 2])> {
    let square = |p: [f64; 3], q: [f64; 3]| dot(minus(q, p), minus(q, p));
    let mut best = square(p, q);
    for _ in 0..ROUNDS {
        let before = best;
        let way = minus(q, p);
        let length = sqrt(best);
        if length.is_nan() || length <= 0.0 {
            return None;
        }
        let towards = way.each(|c| c / length);
        let directed = |normal: [f64; 3], sign: f64| {
            if dot(normal, towards) * sign < 0.0 { normal.each(|c| -c) } else { normal }
        };
        let lines = [
            (false, Some(towards)),
            (false, a.normal(p).map(|normal| directed(normal, 1.0))),
            (true, b.normal(q).map(|normal| directed(normal, -1.0))),
        ];
        for (is_from_b, direction) in lines {
            let Some(direction) = direction else { continue };
            let ([own, other], [from, to]) = if is_from_b { ([b, a], [q, p]) } else { ([a, b], [p, q]) };
            let reach = dot(minus(to, from), direction);
            if reach.is_nan() || reach <= 0.0 {
                continue;
            }
            let leaves = own.last_on(from, direction.each(|c| reach * c));
            let foot = plus(from, reach, direction);
            let depth = 0.25 * (other.ends[1][0] - other.ends[0][0]);
            let target = [foot, plus(foot, depth, direction)].into_iter().find(|&target| other.holds(target));
            let meets = target.map_or(to, |target| other.last_on(target, minus(leaves, target)));
            let found = square(leaves, meets);
            if found < best {
                (p, q) = if is_from_b { (meets, leaves) } else { (leaves, meets) };
                best = found;
            }
        }
        if best.is_nan() || best >= before * (1.0 - 1e-12) {
            break;
        }
    }
    if let Some([x, y]) = stationary([a, b], [p, q]).filter(|[x, y]| square(*x, *y) < best) {
        if a.holds_about(x) && b.holds_about(y) {
            (p, q, best) = (x, y, square(x, y));
        } else {
            *beyond = Some([x, y]);
        }
    }
    let length = sqrt(best);
    let direction = minus(q, p).each(|c| c / length);
    if !direction.iter().all(|c| c.is_finite()) {
        return None;
    }
    let (p, q) = (a.proven(p, direction)?, b.proven(q, direction.each(|c| -c))?);
    let places: [Place; 2] = [p, q].each(|point| axes(|axis| Interval::exactly(point[axis])));
    let distance = between(&places[0], &places[1]);
    (distance.upper < least).then_some((distance, places))
}

/// Returns points of the two surfaces next to two given points whose distance is stationary, by Newton's
/// method: the line between them is normal to both surfaces. Surfaces that run alongside each other, such as
/// a pin and its bore, make the system singular. A small number is therefore added to its diagonal, and
/// points near to the given ones are found. `None` if the system is singular nevertheless.
fn stationary([a, b]: [&Side<'_>; 2], [p, q]: [[f64; 3]; 2]) -> Option<[[f64; 3]; 2]> {
    const STEPS: usize = 8;
    const ADDED: f64 = 1e-10;
    let cells = a.cells;
    let (f, g) = (a.nearest(p)?.0, b.nearest(q)?.0);
    let [mut p, mut q] = [p, q].each(|point| point.each(|c| c / cells));
    // The functions are scaled so that their gradients have a length of about 1.
    let scale = |form: &Form, at: [f64; 3]| {
        let gradient = form.about(at).1;
        1.0 / sqrt(dot(gradient, gradient))
    };
    let (scale_f, scale_g) = (scale(f, p), scale(g, q));
    let scaled = |form: &Form, scale: f64, at: [f64; 3]| {
        let (value, gradient) = form.about(at);
        (scale * value, gradient.each(|c| scale * c))
    };
    let hessian_f = f.second().each(|row| row.each(|c| scale_f * c));
    let hessian_g = g.second().each(|row| row.each(|c| scale_g * c));
    // The multipliers that fit best.
    let multiplier = |way: [f64; 3], gradient: [f64; 3]| dot(way, gradient) / dot(gradient, gradient);
    let mut l = multiplier(minus(q, p), scaled(f, scale_f, p).1);
    let mut m = multiplier(minus(p, q), scaled(g, scale_g, q).1);
    for _ in 0..STEPS {
        let ((of_p, along_p), (of_q, along_q)) = (scaled(f, scale_f, p), scaled(g, scale_g, q));
        // p − q + l ∇f = 0, q − p + m ∇g = 0, f = 0, g = 0.
        let mut rows = [[0.0; 9]; 8];
        for i in 0..3 {
            for j in 0..3 {
                let unit = if i == j { 1.0 } else { 0.0 };
                rows[i][j] = unit * (1.0 + ADDED) + l * hessian_f[i][j];
                rows[i][3 + j] = -unit;
                rows[3 + i][j] = -unit;
                rows[3 + i][3 + j] = unit * (1.0 + ADDED) + m * hessian_g[i][j];
            }
            (rows[i][6], rows[6][i]) = (along_p[i], along_p[i]);
            (rows[3 + i][7], rows[7][3 + i]) = (along_q[i], along_q[i]);
            rows[i][8] = q[i] - p[i] - l * along_p[i];
            rows[3 + i][8] = p[i] - q[i] - m * along_q[i];
        }
        (rows[6][8], rows[7][8]) = (-of_p, -of_q);
        let step = solved(rows)?;
        (p, q) = (axes(|i| p[i] + step[i]), axes(|i| q[i] + step[3 + i]));
        (l, m) = (l + step[6], m + step[7]);
    }
    let found = [p, q].each(|point| point.each(|c| c * cells));
    found.iter().flatten().all(|c| c.is_finite()).then_some(found)
}

/// Solves eight linear equations, whose right-hand sides stand in the last column.
fn solved(mut rows: [[f64; 9]; 8]) -> Option<[f64; 8]> {
    for k in 0..8 {
        let pivot = (k..8).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        let size = rows[k][k];
        if size.is_nan() || size.abs() <= 1e-14 {
            return None;
        }
        let own = rows[k];
        for i in (0..8).filter(|&i| i != k) {
            let factor = rows[i][k] / size;
            rows[i].iter_mut().zip(own).for_each(|(c, own)| *c -= factor * own);
        }
    }
    let mut solution = [0.0; 8];
    for (k, place) in solution.iter_mut().enumerate() {
        *place = rows[k][8] / rows[k][k];
    }
    Some(solution)
}
