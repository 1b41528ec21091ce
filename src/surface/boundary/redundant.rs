//! Surfaces that need not be known in a cell because others tell their sides: of three that meet in one curve, as where a chamfer ends on
//! a round, the third; of two beside each other that are nearly parallel, as where a ball ends a round bar, that which bounds nothing.
//!
//! Where b = c a + l p with factors c and l that keep their signs in a cell, a point at which c a and l p have the same sign has b of that
//! sign, too: two of the eight combinations of signs cannot be. For two quadrics that meet in a plane p, l is a linear function, for
//! three planes through a line it is constant. Where b − c a has one sign, one of the surfaces lies beside the other.

use super::figures::{Figures, Shape, dot, length};
use crate::cut::Quadratic;
use crate::lattice::{Cell, axes};
use crate::solid::OpenSurfaces;

/// The surfaces of a cell in which one is left out may be further by no more than this from where the others have them (edges of the
/// universe): they are told by rounded numbers.
const SLACK: f64 = 1e-9;

/// The factors of an identity are no smaller, if all functions have slope 1 at the centre.
const FACTOR: f64 = 1e-3;

/// Sums of terms are off by less, if all functions have slope 1 at the centre.
const ROUNDING: f64 = 1e-12;

/// Surfaces of an identity cross each other at no smaller angle (its sine).
const SINE: f64 = 0.01;

/// The unknown factors of an identity: c, and the four terms of l.
const UNKNOWN: usize = 5;

/// The coefficients of a polynomial of degree two, those of mixed products twice, so that their squares add up evenly.
type Terms = [f64; 10];

/// A function in a cell whose slope at the centre is 1.
#[derive(Clone, Copy, Default)]
pub(super) struct Known {
    terms: Terms,
    error: f64,
    bend: f64,
    is_plane: bool,
}

/// The function of a cell without surfaces whose sides others tell, and by how much the boundary may be elsewhere (edges of the universe).
/// `None` if there are none.
pub(super) fn without_redundant(
    figures: &Figures,
    cell: Cell,
    open: &OpenSurfaces,
) -> Option<(OpenSurfaces, f64)> {
    let count = open.indices().len();
    if count < 2 {
        return None;
    }
    let mut known = [Known::default(); OpenSurfaces::MOST];
    for (place, &surface) in known.iter_mut().zip(open.indices()) {
        *place = Known::of(figures, surface, cell)?;
    }
    let known = &known[..count];
    let half = 0.5 / f64::from(1u32 << cell.level);
    let (mut cannot_be, mut slack) = (0u64, 0.0);
    for b in 0..count {
        for a in (0..count).filter(|&a| a != b) {
            if let Some((is_turned, is_above)) = known[b].beside(&known[a]) {
                let never = |signs: &u8| {
                    let [a, b] = [a, b].map(|k| signs >> k & 1 != 0);
                    (a != is_turned) == is_above && b != is_above
                };
                (0..1u8 << count).filter(never).for_each(|signs| cannot_be |= 1 << signs);
            }
            for p in (0..count).filter(|&p| p != a && p != b) {
                // (What is told of a and b is told of b and a, if both are curved.)
                let is_new = known[p].is_plane && (a < b || known[a].is_plane);
                let sine = least_sine(known, [a, b, p]);
                if !is_new || sine < SINE {
                    continue;
                }
                let Some((positive, off)) = identity(known, [a, b, p]) else { continue };
                // A point whose signs cannot be is next to all three surfaces, and the curve in which they meet is next to it.
                let away = 2.0 * off * half / sine;
                if away > SLACK {
                    continue;
                }
                slack = f64::max(slack, away);
                for signs in 0..1u8 << count {
                    let is = |k: usize| signs >> k & 1 != 0;
                    let sides = [is(a) == positive[0], is(p) == positive[1]];
                    if sides[0] == sides[1] && is(b) != sides[0] {
                        cannot_be |= 1 << signs;
                    }
                }
            }
        }
    }
    if cannot_be == 0 {
        return None;
    }
    Some((left_out(open, count, cannot_be)?, slack))
}

/// The function without a variable on which it depends in no combination that can be, and again. `None` if there are none.
fn left_out(open: &OpenSurfaces, count: usize, cannot_be: u64) -> Option<OpenSurfaces> {
    let (mut table, mut is_changed) = (open.table(), false);
    for k in (0..count).filter(|&k| open.table().depends_on(k)) {
        let mut other = table;
        let mut is_free = true;
        for signs in (0..1u32 << count).filter(|signs| signs >> k & 1 == 0) {
            let both = [signs, signs | 1 << k];
            let [below, above] = both.map(|signs| cannot_be >> signs & 1 == 0);
            let [low, high] = both.map(|signs| table.0 >> signs & 1);
            is_free &= !below || !above || low == high;
            let value = if below { low } else { high };
            for signs in both {
                other.0 = other.0 & !(1 << signs) | value << signs;
            }
        }
        if is_free {
            (table, is_changed) = (other, true);
        }
    }
    // (Bits of variables that there are not repeat those of the others.)
    for k in count..OpenSurfaces::MOST {
        table = table.with(k, false);
    }
    is_changed.then(|| open.with_table(table).shortened())
}

impl Known {
    pub(super) fn of(figures: &Figures, surface: u32, cell: Cell) -> Option<Known> {
        let taylor = figures.taylor(surface, cell)?;
        let Quadratic { value, gradient, squares: [xx, yy, zz, xy, xz, yz], error } = taylor.f;
        let steep = length(gradient);
        let [x, y, z] = gradient;
        let terms = [value, x, y, z, xx, yy, zz, 2.0 * xy, 2.0 * xz, 2.0 * yz].map(|term| term / steep);
        let known = Known {
            terms,
            error: error / steep,
            bend: taylor.bend / steep,
            is_plane: figures.shape(surface) == Shape::Plane,
        };
        let is_finite = terms.iter().chain([&known.error, &known.bend]).all(|term| term.is_finite());
        is_finite.then_some(known)
    }

    /// How far the surface may be from its tangent plane (half edges of the cell).
    pub(super) fn rise(&self) -> f64 {
        self.terms[4..].iter().map(|term| term.abs()).sum::<f64>() + self.error
    }

    /// How far apart this surface and another one may be (half edges of the cell), and whether their functions have opposite signs.
    pub(super) fn apart(&self, other: &Known) -> (f64, bool) {
        let is_turned = dot(self.normal(), other.normal()) < 0.0;
        let sign = if is_turned { -1.0 } else { 1.0 };
        let differences = self.terms.iter().zip(other.terms).map(|(a, b)| (a - sign * b).abs());
        (differences.sum::<f64>() + self.error + other.error, is_turned)
    }

    /// Whether this function, less a multiple of another one, has one sign in all of the cell: whether the factor is negative, and
    /// whether the sign is positive.
    fn beside(&self, other: &Known) -> Option<(bool, bool)> {
        let factor = dot(self.normal(), other.normal());
        let mut rest = self.terms;
        rest.iter_mut().zip(other.terms).for_each(|(own, term)| *own -= factor * term);
        let away: f64 = rest[1..].iter().map(|term| term.abs()).sum();
        let away = away + self.error + factor.abs() * other.error + ROUNDING;
        (rest[0].abs() > away && factor != 0.0).then_some((factor < 0.0, rest[0] > 0.0))
    }

    fn normal(&self) -> [f64; 3] {
        axes(|k| self.terms[1 + k])
    }
}

/// The least sine of an angle between two of three surfaces, wherever in the cell their normals are taken.
fn least_sine(known: &[Known], of: [usize; 3]) -> f64 {
    let sine = |a: &Known, b: &Known| {
        let (n, m) = (a.normal(), b.normal());
        let cross = [n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]];
        length(cross) - 1.2 * (a.bend + b.bend)
    };
    let [a, b, p] = of.map(|k| &known[k]);
    sine(a, b).min(sine(a, p)).min(sine(b, p))
}

/// The product of a plane's function with a linear one.
fn product(p: &Terms, l: &[f64; 4]) -> Terms {
    let [p0, x, y, z, ..] = *p;
    let [l0, u, v, w] = *l;
    [
        p0 * l0,
        p0 * u + x * l0,
        p0 * v + y * l0,
        p0 * w + z * l0,
        x * u,
        y * v,
        z * w,
        x * v + y * u,
        x * w + z * u,
        y * w + z * v,
    ]
}

/// Whether the factors are positive with which b = c a + l p, and how far a point may be from each of the surfaces (half edges of the cell) at
/// which rounding makes it wrong. `None` if a factor has no sign.
fn identity(known: &[Known], [a, b, p]: [usize; 3]) -> Option<([bool; 2], f64)> {
    let (own, given, plane) = (&known[b], &known[a], &known[p]);
    let unit = |k: usize| product(&plane.terms, &core::array::from_fn(|i| f64::from(u8::from(i == k))));
    let columns = [given.terms, unit(0), unit(1), unit(2), unit(3)];
    let mut factors = [0.0; UNKNOWN];
    // The second time for what rounding left.
    for _ in 0..2 {
        let rest = rest(&own.terms, &columns, &factors);
        let step = least_squares(&columns, &rest)?;
        factors.iter_mut().zip(step).for_each(|(factor, step)| *factor += step);
    }
    let [c, l0, u, v, w] = factors;
    let steepest = u.abs() + v.abs() + w.abs();
    let least = l0.abs() - steepest;
    if c.abs() < FACTOR || least.is_nan() || least < FACTOR {
        return None;
    }
    let off: f64 = rest(&own.terms, &columns, &factors).iter().map(|term| term.abs()).sum();
    let off = off + own.error + c.abs() * given.error + (l0.abs() + steepest) * plane.error;
    let off = off / c.abs().min(least).min(1.0);
    Some(([c > 0.0, l0 > 0.0], off))
}

/// What columns leave of a polynomial.
fn rest(of: &Terms, columns: &[Terms; UNKNOWN], factors: &[f64; UNKNOWN]) -> Terms {
    core::array::from_fn(|k| {
        columns.iter().zip(factors).fold(of[k], |rest, (c, factor)| rest - factor * c[k])
    })
}

/// The factors of columns whose sum is nearest to a polynomial. `None` if there are several.
fn least_squares(columns: &[Terms; UNKNOWN], of: &Terms) -> Option<[f64; UNKNOWN]> {
    let sum = |a: &Terms, b: &Terms| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut rows: [[f64; UNKNOWN + 1]; UNKNOWN] = core::array::from_fn(|i| {
        core::array::from_fn(
            |k| if k < UNKNOWN { sum(&columns[i], &columns[k]) } else { sum(&columns[i], of) },
        )
    });
    for k in 0..UNKNOWN {
        let pivot =
            (k..UNKNOWN).fold(k, |best, i| if rows[i][k].abs() > rows[best][k].abs() { i } else { best });
        rows.swap(k, pivot);
        let own = rows[k];
        if own[k].is_nan() || own[k].abs() <= 1e-12 {
            return None;
        }
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k] / own[k];
            row.iter_mut().zip(own).for_each(|(c, own)| *c -= factor * own);
        }
    }
    Some(core::array::from_fn(|k| rows[k][UNKNOWN] / rows[k][k]))
}
