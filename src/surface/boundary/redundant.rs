//! Surfaces that need not be known in a cell, because others determine their sides. One case is the third of
//! three surfaces that meet in one curve, as where a chamfer ends on a round. Another case is one of two
//! nearly parallel surfaces, as where a ball ends a round bar: the one that bounds nothing.
//!
//! Suppose b = c a + l p, with factors c and l that keep their signs in a cell. Then b has the common sign of
//! c a and l p wherever these have the same sign, so two of the eight combinations of signs are impossible.
//! For two quadrics that meet in a plane p, l is a linear function; for three planes through a line it is
//! constant. If b − c a has one sign in the cell, or everywhere, one of the surfaces lies beside the other,
//! or touches it.

use super::figures::{Figures, length};
use super::scaled::{Scaled, Terms};
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::solid::OpenSurfaces;

/// The greatest deviation of the boundary in a cell in which a surface is left out (edges of the universe).
/// It is caused by rounded numbers.
const SLACK: f64 = 1e-9;

/// The least factor of an identity, if all functions have slope 1 at the centre.
const FACTOR: f64 = 1e-3;

/// The sine of the least angle at which surfaces of an identity cross each other.
const SINE: f64 = 0.01;

/// The number of unknown factors of an identity: c, and the four terms of l.
const UNKNOWN: usize = 5;

/// The function of a cell without redundant surfaces, and the greatest deviation of the boundary (edges of
/// the universe). `None` if no surface is redundant.
pub(super) fn without_redundant(
    figures: &Figures,
    cell: Cell,
    open: &OpenSurfaces,
) -> Option<(OpenSurfaces, f64)> {
    let count = open.indices().len();
    if count < 2 {
        return None;
    }
    let mut known = [Scaled::default(); OpenSurfaces::MOST];
    for (place, &surface) in known.iter_mut().zip(open.indices()) {
        *place = Scaled::of(figures, surface, cell)?;
    }
    let known = &known[..count];
    let half = 0.5 / f64::from(1u32 << cell.level);
    let (mut cannot_be, mut slack) = (0u64, 0.0);
    for b in 0..count {
        for a in (0..count).filter(|&a| a != b) {
            if let Some((is_turned, is_above)) = known[b].beside(&known[a]) {
                cannot_be |= never(count, [a, b], is_turned, is_above);
            } else if a < b
                && let Some(touch) = known[b].touches(&known[a])
                && touch.away() * half <= SLACK
            {
                slack = f64::max(slack, touch.away() * half);
                cannot_be |= never(count, [a, b], touch.is_turned, touch.is_above);
            }
            for p in (0..count).filter(|&p| p != a && p != b) {
                // (If a and b are both curved, the result for a and b also holds for b and a.)
                let is_new = known[p].is_plane && (a < b || known[a].is_plane);
                let sine = least_sine(known, [a, b, p]);
                if !is_new || sine < SINE {
                    continue;
                }
                let Some((positive, off)) = identity(known, [a, b, p]) else { continue };
                // A point with an impossible combination of signs is near all three surfaces, and so near the
                // curve in which they meet.
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
    Some((left_out(open, cannot_be)?, slack))
}

/// The combinations of signs in which surface b is on the wrong side of surface a. One function (or its
/// opposite, if `is_turned`) is then positive while the other one is not, or the reverse.
pub(super) fn never(count: usize, [a, b]: [usize; 2], is_turned: bool, is_above: bool) -> u64 {
    let is = |signs: u8, k: usize| signs >> k & 1 != 0;
    let never = |signs: &u8| (is(*signs, a) != is_turned) == is_above && is(*signs, b) != is_above;
    (0..1u8 << count).filter(never).fold(0, |all, signs| all | 1 << signs)
}

/// The function without the variables that do not matter in any possible combination. `None` if there are no
/// such variables.
fn left_out(open: &OpenSurfaces, cannot_be: u64) -> Option<OpenSurfaces> {
    let less = without(*open, cannot_be);
    (less != *open).then(|| less.shortened())
}

/// Removes the dependence on each variable that does not matter in any possible combination.
pub(super) fn without(mut open: OpenSurfaces, cannot_be: u64) -> OpenSurfaces {
    let count = open.indices().len();
    for k in 0..count {
        let mut table = open.table();
        if !table.depends_on(k) {
            continue;
        }
        let mut is_free = true;
        for signs in (0..1u32 << count).filter(|signs| signs >> k & 1 == 0) {
            let both = [signs, signs | 1 << k];
            let [below, above] = both.each(|signs| cannot_be >> signs & 1 == 0);
            let [low, high] = both.each(|signs| table.0 >> signs & 1);
            is_free &= !below || !above || low == high;
            let value = if below { low } else { high };
            for signs in both {
                table.0 = table.0 & !(1 << signs) | value << signs;
            }
        }
        if is_free {
            // (The bits of missing variables repeat those of the others.)
            open = open.with_table((count..OpenSurfaces::MOST).fold(table, |table, k| table.with(k, false)));
        }
    }
    open
}

/// The least sine of an angle between two of three surfaces, for all normals in the cell.
fn least_sine(known: &[Scaled], of: [usize; 3]) -> f64 {
    let sine = |a: &Scaled, b: &Scaled| {
        let (n, m) = (a.normal(), b.normal());
        let cross = [n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]];
        length(cross) - 1.2 * (a.bend + b.bend)
    };
    let [a, b, p] = of.each(|k| &known[k]);
    sine(a, b).min(sine(a, p)).min(sine(b, p))
}

/// The product of a plane's function and a linear function.
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

/// Returns the signs of the factors in b = c a + l p, and the greatest distance from the surfaces (half edges
/// of the cell) at which rounding can make a sign wrong. `None` if a factor has no fixed sign.
fn identity(known: &[Scaled], [a, b, p]: [usize; 3]) -> Option<([bool; 2], f64)> {
    let (own, given, plane) = (&known[b], &known[a], &known[p]);
    let unit = |k: usize| product(&plane.terms, &core::array::from_fn(|i| f64::from(u8::from(i == k))));
    let columns = [given.terms, unit(0), unit(1), unit(2), unit(3)];
    let mut factors = [0.0; UNKNOWN];
    // The second pass corrects the rounding errors of the first.
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

/// The remainder of a polynomial after subtracting the columns times their factors.
pub(super) fn rest<const N: usize, const M: usize>(
    of: &[f64; M],
    columns: &[[f64; M]; N],
    factors: &[f64; N],
) -> [f64; M] {
    core::array::from_fn(|k| {
        columns.iter().zip(factors).fold(of[k], |rest, (c, factor)| rest - factor * c[k])
    })
}

/// The factors of columns whose sum is nearest to a polynomial. `None` if they are not unique.
pub(super) fn least_squares<const N: usize, const M: usize>(
    columns: &[[f64; M]; N],
    of: &[f64; M],
) -> Option<[f64; N]> {
    let sum = |a: &[f64; M], b: &[f64; M]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut rows: [([f64; N], f64); N] = core::array::from_fn(|i| {
        (core::array::from_fn(|k| sum(&columns[i], &columns[k])), sum(&columns[i], of))
    });
    for k in 0..N {
        let pivot =
            (k..N).fold(k, |best, i| if rows[i].0[k].abs() > rows[best].0[k].abs() { i } else { best });
        rows.swap(k, pivot);
        let (own, value) = rows[k];
        if own[k].is_nan() || own[k].abs() <= 1e-12 {
            return None;
        }
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row.0[k] / own[k];
            row.0.iter_mut().zip(own).for_each(|(c, own)| *c -= factor * own);
            row.1 -= factor * value;
        }
    }
    Some(core::array::from_fn(|k| rows[k].1 / rows[k].0[k]))
}
