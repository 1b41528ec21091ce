//! Functions of surfaces in a cell, scaled so that they can be compared with each other.

use super::figures::{Figures, Shape, dot, length};
use crate::cut::Quadratic;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, axes};

/// The greatest rounding error of terms, if all functions have slope 1 at the centre.
const ROUNDING: f64 = 1e-12;

/// The least dot product of the normals of surfaces that may touch each other in a cell.
const ALIKE: f64 = 0.7;

/// The greatest curvature in a cell of a surface that may touch another one there.
const CURVED: f64 = 0.6;

/// The greatest eigenvalue that counts as 0 because of rounding, for a form with eigenvalues of about 1 or
/// less.
const NOTHING: f64 = 1e-13;

/// The greatest uncertainty of a function.
const UNKNOWN: f64 = 1e-6;

/// The number of rotations of all pairs of axes. Each sweep at least squares the remainder.
const SWEEPS: usize = 8;

/// The ratio in which a golden-section search divides an interval.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// The coefficients of a polynomial of degree two. Those of mixed products are doubled, so that all squares
/// have the same weight.
pub(super) type Terms = [f64; 10];

/// A function in a cell, scaled to slope 1 at the centre. Places are measured from the centre in half edges
/// of the cell.
#[derive(Clone, Copy, Default)]
pub(super) struct Scaled {
    pub(super) terms: Terms,
    pub(super) error: f64,
    pub(super) bend: f64,
    pub(super) is_plane: bool,
}

/// The position of two surfaces that touch each other, or nearly do.
#[derive(Clone, Copy)]
pub(super) struct Touch {
    /// Whether their functions have opposite signs.
    pub(super) is_turned: bool,
    /// Whether the combination is nowhere negative (otherwise it is nowhere positive): one function minus a
    /// positive multiple of the other one, whose sign is reversed if `is_turned`.
    pub(super) is_above: bool,
    /// The amount by which the combination may have the wrong sign in the cell.
    pub(super) off: f64,
}

impl Touch {
    /// The greatest distance from both surfaces of a point on the wrong side (half edges of the cell).
    pub(super) fn away(&self) -> f64 {
        // Factors are at most 2.
        2.0 * self.off / (1.0 - CURVED)
    }
}

impl Scaled {
    pub(super) fn of(figures: &Figures, surface: u32, cell: Cell) -> Option<Scaled> {
        let taylor = figures.taylor(surface, cell)?;
        let Quadratic { value, gradient, squares: [xx, yy, zz, xy, xz, yz], error } = taylor.f;
        let steep = length(gradient);
        let [x, y, z] = gradient;
        let terms = [value, x, y, z, xx, yy, zz, 2.0 * xy, 2.0 * xz, 2.0 * yz].each(|term| term / steep);
        let known = Scaled {
            terms,
            error: error / steep,
            bend: taylor.bend / steep,
            is_plane: figures.shape(surface) == Shape::Plane,
        };
        let is_finite = terms.iter().chain([&known.error, &known.bend]).all(|term| term.is_finite());
        is_finite.then_some(known)
    }

    /// The greatest distance of the surface from its tangent plane (half edges of the cell).
    pub(super) fn rise(&self) -> f64 {
        self.terms[4..].iter().map(|term| term.abs()).sum::<f64>() + self.error
    }

    /// The greatest distance between this surface and another one (half edges of the cell), and whether their
    /// functions have opposite signs.
    pub(super) fn apart(&self, other: &Scaled) -> (f64, bool) {
        let is_turned = dot(self.normal(), other.normal()) < 0.0;
        let sign = if is_turned { -1.0 } else { 1.0 };
        let differences = self.terms.iter().zip(other.terms).map(|(a, b)| (a - sign * b).abs());
        (differences.sum::<f64>() + self.error + other.error, is_turned)
    }

    /// Tests whether this function minus a multiple of another one has one sign in the whole cell. Returns
    /// whether the factor is negative, and whether the sign is positive.
    pub(super) fn beside(&self, other: &Scaled) -> Option<(bool, bool)> {
        let factor = dot(self.normal(), other.normal());
        let mut rest = self.terms;
        rest.iter_mut().zip(other.terms).for_each(|(own, term)| *own -= factor * term);
        let away: f64 = rest[1..].iter().map(|term| term.abs()).sum();
        let away = away + self.error + factor.abs() * other.error + ROUNDING;
        (rest[0].abs() > away && factor != 0.0).then_some((factor < 0.0, rest[0] > 0.0))
    }

    /// Finds a combination of this function and another one that has one sign everywhere, as where a ball
    /// ends a round bar, or where a plane face continues as a round. The factors have opposite signs, or
    /// equal signs if the functions are turned.
    ///
    /// The least eigenvalue of own − c other is concave in c, so a golden-section search finds the best
    /// factor.
    pub(super) fn touches(&self, other: &Scaled) -> Option<Touch> {
        let alike = dot(self.normal(), other.normal());
        let error = self.error + 2.0 * other.error;
        let is_curved = [self, other].iter().any(|known| known.bend.is_nan() || known.bend >= CURVED);
        if self.is_plane && other.is_plane || alike.abs() < ALIKE || is_curved || error >= UNKNOWN {
            return None;
        }
        let nothing = NOTHING + error;
        let (own, given) = (form(&self.terms), form(&other.terms));
        let size = sqrt(given.as_flattened().iter().map(|c| c * c).sum());
        let turned = alike.signum();
        [true, false].into_iter().find_map(|is_above| {
            let sign = if is_above { 1.0 } else { -1.0 };
            let least = |c: f64| {
                let row = |i: usize, k: usize| sign * (own[i][k] - turned * c * given[i][k]);
                least_eigenvalue(core::array::from_fn(|i| core::array::from_fn(|k| row(i, k))))
            };
            let (mut from, mut to) = (0.5, 2.0);
            let inner = |from: f64, to: f64| [to - GOLDEN * (to - from), from + GOLDEN * (to - from)];
            let mut places = inner(from, to);
            let mut values = places.each(least);
            while to - from > 4.0 * f64::EPSILON {
                let best = f64::max(values[0], values[1]);
                // No eigenvalue changes faster than the norm of the added matrix.
                if best >= -nothing || best + size * (to - from) < -nothing {
                    break;
                }
                if values[0] > values[1] {
                    to = places[1];
                    let [next, _] = inner(from, to);
                    (places, values) = ([next, places[0]], [least(next), values[0]]);
                } else {
                    from = places[0];
                    let [_, next] = inner(from, to);
                    (places, values) = ([places[1], next], [values[1], least(next)]);
                }
            }
            // The four squares of a point of the cell, extended by 1, sum up to at most four.
            let is_found = values[0] >= -nothing || values[1] >= -nothing;
            is_found.then_some(Touch { is_turned: turned < 0.0, is_above, off: 8.0 * nothing })
        })
    }

    pub(super) fn normal(&self) -> [f64; 3] {
        axes(|k| self.terms[1 + k])
    }
}

/// The symmetric matrix of a polynomial, for points extended by a leading 1.
fn form([value, x, y, z, xx, yy, zz, xy, xz, yz]: &Terms) -> [[f64; 4]; 4] {
    let [x, y, z, xy, xz, yz] = [x, y, z, xy, xz, yz].each(|c| 0.5 * c);
    [[*value, x, y, z], [x, *xx, xy, xz], [y, xy, *yy, yz], [z, xz, yz, *zz]]
}

/// The least eigenvalue of a symmetric matrix, by rotations (Jacobi 1846).
fn least_eigenvalue(mut m: [[f64; 4]; 4]) -> f64 {
    for _ in 0..SWEEPS {
        let mut rest = 0.0;
        for p in 0..4 {
            for q in p + 1..4 {
                let off = m[p][q];
                rest += off * off;
                if off == 0.0 {
                    continue;
                }
                let theta = 0.5 * (m[q][q] - m[p][p]) / off;
                let t = theta.signum() / (theta.abs() + sqrt(theta * theta + 1.0));
                let c = 1.0 / sqrt(t * t + 1.0);
                let s = t * c;
                for row in &mut m {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for k in 0..4 {
                    (m[p][k], m[q][k]) = (c * m[p][k] - s * m[q][k], s * m[p][k] + c * m[q][k]);
                }
            }
        }
        if rest <= 1e-36 {
            break;
        }
    }
    (0..4).fold(f64::INFINITY, |least, k| least.min(m[k][k]))
}
