//! The side of a surface on which points lie, computed in place: in doubles with bounds on their errors,
//! without allocation.
//!
//! Points next to a surface stay undecided; [exact signs](crate::solid) are available for a tree that is put
//! on a frame.

use super::surfaces::{MOST_MAPS, Numbers, SurfaceKind, SurfacesRef};
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Ball, axes};

/// A surface in its own space.
#[derive(Clone, Copy)]
pub(crate) struct Figure<'a> {
    kind: SurfaceKind,
    numbers: [Ball; 10],
    surfaces: SurfacesRef<'a>,
    id: usize,
    is_placed: bool,
}

/// A surface along a line from `at` to `at` + `direction`.
#[derive(Clone, Copy)]
pub(crate) enum FigureLine<'a> {
    /// A polynomial of degree two: the coefficients of 1, t and t², with bounds on all rounding errors.
    Polynomial { figure: Figure<'a>, coefficients: [Ball; 3] },
    /// Another function: the line in the space of the figure.
    Other { figure: Figure<'a>, at: [Ball; 3], direction: [Ball; 3] },
}

#[inline(always)]
fn dot(a: [Ball; 3], b: [Ball; 3]) -> Ball {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

/// Returns the inverse of the linear part of a map: its adjugate, and one divided by its determinant.
fn inverse(rows: &[[f64; 4]; 3]) -> ([[Ball; 3]; 3], Ball) {
    let m = rows.each(|[a, b, c, _]| [a, b, c].each(Ball::exactly));
    let minor = |i: usize, j: usize| {
        let [r, s] = [(i + 1) % 3, (i + 2) % 3];
        let [p, q] = [(j + 1) % 3, (j + 2) % 3];
        m[r][p].times(m[s][q]).minus(m[r][q].times(m[s][p]))
    };
    let cofactors = axes(|i| axes(|j| minor(i, j)));
    let determinant = dot(m[0], cofactors[0]);
    (axes(|j| axes(|i| cofactors[i][j])), determinant.reciprocal())
}

impl<'a> Figure<'a> {
    /// Returns a surface of a table; `None` if it is damaged, or placed by too many maps.
    pub(crate) fn new(surfaces: &SurfacesRef<'a>, id: u32) -> Option<Figure<'a>> {
        let (kind, own) = surfaces.get(id as usize)?;
        let mut numbers = [Ball::ZERO; 10];
        if let Numbers::Slab([x, y, z, inner, outer]) = own {
            // In model space, where no map is needed.
            let normal = [x, y, z].each(Ball::exactly);
            let along = dot(normal, surfaces.universe.origin.each(Ball::exactly));
            let edge = Ball::exactly(surfaces.universe.edge);
            let [inner, outer] = [inner, outer].each(|offset| edge.times(Ball::exactly(offset)).plus(along));
            numbers[..3].copy_from_slice(&normal);
            numbers[3..5].copy_from_slice(&[inner, outer]);
        } else {
            for (i, to) in numbers.iter_mut().enumerate().take(kind.numbers() as usize) {
                *to = Ball::sum(own.get(i));
            }
        }
        let id = id as usize;
        let maps = surfaces.placements(id).count();
        let is_placed = maps > 0;
        (maps <= MOST_MAPS).then_some(Figure { kind, numbers, surfaces: *surfaces, id, is_placed })
    }

    /// Returns the maps that place the figure, the outermost first, and their number.
    fn maps(&self) -> ([&'a [[f64; 4]; 3]; MOST_MAPS], usize) {
        const NONE: [[f64; 4]; 3] = [[0.0; 4]; 3];
        let (mut maps, mut count) = ([&NONE; MOST_MAPS], 0);
        for (to, rows) in maps.iter_mut().zip(self.surfaces.placements(self.id)) {
            *to = rows;
            count += 1;
        }
        maps[..count].reverse();
        (maps, count)
    }

    /// Returns a centre and the vectors from it, in the figure's space. With `is_box`, the vectors are those
    /// of a box.
    #[inline]
    fn pulled(&self, mut at: [Ball; 3], mut vectors: [Ball; 3], is_box: bool) -> ([Ball; 3], [Ball; 3]) {
        if !self.is_placed {
            return (at, vectors);
        }
        let (maps, count) = self.maps();
        for rows in &maps[..count] {
            let (adjugate, scale) = inverse(rows);
            let moved = axes(|i| at[i].minus(Ball::exactly(rows[i][3])));
            at = axes(|i| dot(adjugate[i], moved).times(scale));
            vectors = axes(|i| {
                if is_box {
                    // The reach of the corners of the box.
                    let reach = |j: usize| adjugate[i][j].magnitude() * vectors[j].magnitude();
                    let all =
                        Ball::exactly(reach(0)).plus(Ball::exactly(reach(1))).plus(Ball::exactly(reach(2)));
                    Ball::exactly(all.times(scale).magnitude())
                } else {
                    dot(adjugate[i], vectors).times(scale)
                }
            });
        }
        (at, vectors)
    }

    /// Returns the common side of all points of the box `centre` ± `radius` (model units); `None` if it is
    /// unknown, or there is none.
    #[inline]
    pub(crate) fn side(&self, centre: [Ball; 3], radius: [f64; 3]) -> Option<bool> {
        let (at, reach) = if self.is_placed {
            let (at, reach) = self.pulled(centre, radius.each(Ball::exactly), true);
            (at, reach.each(Ball::magnitude))
        } else {
            (centre, radius)
        };
        let Some((value, gradient)) = self.polynomial(at) else {
            return self.natural(axes(|axis| at[axis].widened(reach[axis]))).is_positive();
        };
        if reach == [0.0; 3] {
            return self.of_value(value);
        }
        let first: f64 = (0..3).map(|axis| gradient[axis].magnitude() * reach[axis]).sum();
        self.of_value(value.widened(bounded(first + self.second(reach))))
    }

    /// Returns the surface along the line from `at` to `at` + `direction` (model units).
    pub(crate) fn line(self, at: [Ball; 3], direction: [Ball; 3]) -> FigureLine<'a> {
        let (at, direction) = self.pulled(at, direction, false);
        let Some((value, gradient)) = self.polynomial(at) else {
            return FigureLine::Other { figure: self, at, direction };
        };
        let bend = if self.kind == SurfaceKind::Quadric {
            let [a, b, c, d, e, f, ..] = self.numbers;
            let [x, y, z] = direction;
            let along =
                [a.times(x).plus(d.times(y)), b.times(y).plus(e.times(z)), c.times(z).plus(f.times(x))];
            dot(direction, along)
        } else {
            Ball::ZERO
        };
        FigureLine::Polynomial { figure: self, coefficients: [value, dot(gradient, direction), bend] }
    }

    /// Returns value and gradient of a polynomial of degree two; for a slab, those of its linear form.
    #[inline(always)]
    fn polynomial(&self, [x, y, z]: [Ball; 3]) -> Option<(Ball, [Ball; 3])> {
        let n = &self.numbers;
        match self.kind {
            SurfaceKind::Plane => Some((dot([n[0], n[1], n[2]], [x, y, z]).plus(n[3]), [n[0], n[1], n[2]])),
            SurfaceKind::Slab => Some((dot([n[0], n[1], n[2]], [x, y, z]), [n[0], n[1], n[2]])),
            SurfaceKind::Quadric => {
                let &[a, b, c, d, e, f, g, h, i, j] = n;
                let along_x = a.times(x).plus(d.times(y)).plus(g);
                let along_y = b.times(y).plus(e.times(z)).plus(h);
                let along_z = c.times(z).plus(f.times(x)).plus(i);
                let value = dot([x, y, z], [along_x, along_y, along_z]).plus(j);
                let gradient = [
                    along_x.plus(a.times(x)).plus(f.times(z)),
                    along_y.plus(b.times(y)).plus(d.times(x)),
                    along_z.plus(c.times(z)).plus(e.times(y)),
                ];
                Some((value, gradient))
            }
            SurfaceKind::Powers | SurfaceKind::Torus => None,
        }
    }

    /// Returns a bound of the terms of degree two for a vector with these components.
    #[inline(always)]
    fn second(&self, [x, y, z]: [f64; 3]) -> f64 {
        if self.kind != SurfaceKind::Quadric {
            return 0.0;
        }
        let [a, b, c, d, e, f, ..] = self.numbers.each(Ball::magnitude);
        (a * x * x + b * y * y + c * z * z) + (d * x * y + e * y * z + f * z * x)
    }

    /// Returns the side by the value of a polynomial.
    #[inline(always)]
    fn of_value(&self, value: Ball) -> Option<bool> {
        if self.kind != SurfaceKind::Slab {
            return value.is_positive();
        }
        let [inner, outer] = [self.numbers[3], self.numbers[4]];
        if inner.minus(value).is_positive() == Some(true) {
            Some(true)
        } else if value.minus(outer).is_positive() == Some(true) {
            Some(false)
        } else {
            None
        }
    }

    /// Returns the value of another function, in a form in which each number occurs once.
    fn natural(&self, at: [Ball; 3]) -> Ball {
        let n = &self.numbers;
        if self.kind == SurfaceKind::Torus {
            let [major, square, scale, shift] = [n[0], n[1], n[2], n[3]];
            let [x, y, z] = at.each(|c| c.times(scale));
            let across = x.times(x).plus(y.times(y)).root().minus(major);
            let z = z.plus(shift);
            return square.minus(across.times(across)).minus(z.times(z));
        }
        let term = |i: usize| n[3 * i].times(at[i].minus(n[3 * i + 1]).power(self.exponent(i)));
        term(0).plus(term(1)).plus(term(2)).plus(n[9])
    }

    /// Returns the exponent of a term; 1 where it is damaged.
    fn exponent(&self, i: usize) -> u32 {
        (self.numbers[3 * i + 2].value as u32).clamp(1, 64)
    }

    /// Returns the approximate gradient at a point (model units), which points to the positive side.
    pub(crate) fn gradient(&self, point: [f64; 3]) -> [f64; 3] {
        let (at, _) = self.pulled(point.each(Ball::exactly), [Ball::ZERO; 3], false);
        let n = &self.numbers;
        let mut gradient = match (self.polynomial(at), self.kind) {
            // A slab is positive where its linear form is smaller.
            (Some((_, own)), SurfaceKind::Slab) => own.each(|c| -c.value),
            (Some((_, own)), _) => own.each(|c| c.value),
            (None, SurfaceKind::Torus) => {
                let [x, y, z] = at.each(|c| c.value * n[2].value);
                let along = Ball::exactly(x * x + y * y).root().value;
                let across = if along > 0.0 { (n[0].value - along) / along } else { 0.0 };
                [across * x, across * y, -(z + n[3].value)]
            }
            (None, _) => axes(|i| {
                let exponent = self.exponent(i);
                let base = at[i].value - n[3 * i + 1].value;
                let power = if exponent == 1 { 1.0 } else { Ball::exactly(base).power(exponent - 1).value };
                n[3 * i].value * f64::from(exponent) * power
            }),
        };
        let (maps, count) = self.maps();
        for rows in maps[..count].iter().rev() {
            let (adjugate, scale) = inverse(rows);
            gradient = axes(|j| (0..3).map(|i| adjugate[i][j].value * gradient[i] * scale.value).sum());
        }
        gradient
    }
}

impl FigureLine<'_> {
    /// Returns the surface.
    pub(crate) fn figure(&self) -> &Figure<'_> {
        match self {
            FigureLine::Polynomial { figure, .. } | FigureLine::Other { figure, .. } => figure,
        }
    }

    /// Returns the common side of all points from t = `low` to `high`; `None` if it is unknown, or there is
    /// none.
    #[inline]
    pub(crate) fn side(&self, low: f64, high: f64) -> Option<bool> {
        let middle = 0.5 * low + 0.5 * high;
        let half = (high - middle).max(middle - low) * (1.0 + f64::EPSILON);
        let t = Ball::exactly(middle);
        match self {
            FigureLine::Polynomial { figure, coefficients: [c, b, a] } => {
                let bent = a.times(t);
                let rise = b.plus(bent);
                let value = c.plus(rise.times(t));
                let slope = rise.plus(bent).magnitude();
                let range = value.widened(bounded(slope * half + a.magnitude() * half * half));
                figure.of_value(range).or_else(|| self.side_by_ends(low, high))
            }
            FigureLine::Other { figure, at, direction } => {
                let reach = |axis: usize| bounded(direction[axis].magnitude() * half);
                let point = |axis: usize| at[axis].plus(direction[axis].times(t)).widened(reach(axis));
                figure.natural(axes(point)).is_positive()
            }
        }
    }
}

/// The best place to divide a piece of a line that does not lie on one side.
pub(crate) enum Division {
    At(f64),
    /// Nothing is known about the place where the line crosses the surface.
    InHalves,
    /// No part of the piece surely lies on one side.
    Nowhere,
}

/// Least distance from a crossing at which a line is divided. It exceeds the rounding errors of times from 0
/// to 1, and of [`FigureLine::side`] on the pieces.
const BESIDE: f64 = 1.0 / (1u64 << 44) as f64;

impl FigureLine<'_> {
    /// Returns the value of a polynomial at a time.
    #[inline(always)]
    fn value([c, b, a]: &[Ball; 3], t: f64) -> Ball {
        let t = Ball::exactly(t);
        c.plus(b.plus(a.times(t)).times(t))
    }

    /// Returns the common side of all points of a quadric from the sides of the ends. If the ends lie on one
    /// side, all points do if the parabola curves away from zero, if its vertex lies outside, or if it has no
    /// root.
    fn side_by_ends(&self, low: f64, high: f64) -> Option<bool> {
        let FigureLine::Polynomial { figure, coefficients } = self else { return None };
        if figure.kind != SurfaceKind::Quadric {
            return None;
        }
        let side = Self::value(coefficients, low).is_positive()?;
        if Self::value(coefficients, high).is_positive() != Some(side) {
            return None;
        }
        let &[c, b, a] = coefficients;
        let slope = |t: f64| b.plus(a.times(Ball::exactly(2.0 * t))).is_positive();
        let bends_away = || a.is_positive() == Some(!side);
        let does_not_turn = || slope(low).is_some_and(|rises| slope(high) == Some(rises));
        let has_no_root =
            || b.times(b).minus(Ball::exactly(4.0).times(a.times(c))).is_positive() == Some(false);
        (bends_away() || does_not_turn() || has_no_root()).then_some(side)
    }

    /// Returns where to divide the piece from t = `low` to `high`, whose side is unknown: next to a crossing.
    pub(crate) fn division(&self, low: f64, high: f64) -> Division {
        let FigureLine::Polynomial { figure, coefficients } = self else { return Division::InHalves };
        let [c, b, a] = coefficients;
        let (levels, is_linear) = match figure.kind {
            SurfaceKind::Slab => (&figure.numbers[3..5], true),
            kind => (&[Ball::ZERO][..], kind != SurfaceKind::Quadric),
        };
        let (mut least, mut is_crossing) = (high, false);
        for level in levels {
            let own = [c.minus(*level), *b, *a];
            for t in crossings(own.each(|number| number.value)).into_iter().filter(|t| t.is_finite()) {
                // Values below this may have either sign.
                let value = Self::value(&own, t);
                let unsure = value.error + value.value.abs();
                let steep = 4.0 * unsure / (b.value + 2.0 * a.value * t).abs();
                let flat = 2.0 * sqrt(unsure / a.value.abs());
                // (If one of them is NaN, the minimum is the other one.)
                let doubt = BESIDE + steep.min(flat);
                let ends = [t - doubt, t + doubt];
                for end in ends.into_iter().filter(|&end| end > low) {
                    least = least.min(end);
                }
                is_crossing |= ends[0] <= low && high <= ends[1];
            }
        }
        let is_open = |t: f64| figure.of_value(Self::value(coefficients, t)).is_none();
        if least < high {
            Division::At(least)
        } else if is_crossing || is_linear && is_open(low) && is_open(high) {
            Division::Nowhere
        } else {
            Division::InHalves
        }
    }
}

/// Returns the approximate zeros of c + b t + a t²; its vertex if it has no zero; infinite or NaN if it has
/// neither.
fn crossings([c, b, a]: [f64; 3]) -> [f64; 2] {
    if a == 0.0 {
        return [-c / b, f64::INFINITY];
    }
    let square = b * b - 4.0 * a * c;
    if square > 0.0 {
        let sum = -0.5 * (b + sqrt(square).copysign(b));
        [sum / a, c / sum]
    } else {
        [-0.5 * b / a, f64::INFINITY]
    }
}

/// Returns a sum of products of non-negative numbers, increased by a bound of its rounding error.
#[inline(always)]
fn bounded(sum: f64) -> f64 {
    sum * (1.0 + 32.0 * f64::EPSILON) + f64::MIN_POSITIVE
}
