//! What the moments of the FULL and of the PARTIAL cells prove of the solid.
//!
//! The solid S contains the FULL cells F, and the FULL and PARTIAL cells together, A, contain it. All its
//! volume integrals of one sign are therefore bounded by those of F and of A, and so is more:
//!
//! - The matrix ∫ x xᵀ of second moments about a point grows with the set in the order of Loewner: the
//!   difference for two nested sets is the matrix of what lies between, which is positive semidefinite. So
//!   does the one about the set's own centroid, because uᵀ M u = ∫ (u·x − u·c)², and the centroid c makes
//!   this a minimum.
//! - From L ≼ M ≼ U follows, for elements off the diagonal, |2 Mij − Lij − Uij| ≤ √(Δii Δjj) with Δ = U − L.
//!   (Both M − L and U − M have Mij² ≤ Mii Mjj; then Cauchy–Schwarz.)
//! - The same holds of the matrix of the moments of 1 and x − c: ∫ (x − c) over S is at most the mean of
//!   those over F and A plus ½ √(V ∫ (x − c)²) of the PARTIAL cells of volume V. (Scarf's bound.) Where that
//!   is 0, no centroid lies beyond c; elsewhere none further than that over the volume of F.

use super::moments::{Moments, PAIRS};
use super::walk::Found;
use crate::lattice::exact::sqrt;
use crate::lattice::{Frame, Interval};

/// A symmetric matrix in the order of [`PAIRS`].
type Symmetric = [Interval; 6];

/// A symmetric tensor, row by row.
pub(super) type Tensor = [[Interval; 3]; 3];

const ZERO: Interval = Interval::exactly(0.0);
const HALF: Interval = Interval::exactly(0.5);
const THREE: Interval = Interval::exactly(3.0);

/// The FULL and the PARTIAL cells.
pub(super) struct Known<'f> {
    pub(super) frame: &'f Frame,
    pub(super) found: Found,
}

impl Known<'_> {
    fn all(&self) -> Moments {
        self.found.full + self.found.open
    }

    /// The edge of half a finest cell, in model units.
    fn half(&self) -> f64 {
        0.5 * self.frame.cell_size()
    }

    /// From finest cells to cubic model units.
    fn to_model(&self, volume: Interval) -> Interval {
        let size = Interval::exactly(self.frame.cell_size());
        let Interval { lower, upper } = volume.times(size).times(size).times(size);
        Interval { lower: lower.max(0.0), upper }
    }

    pub(super) fn volume(&self) -> Interval {
        let (full, all) =
            (Interval::of_integer(self.found.full.volume), Interval::of_integer(self.all().volume));
        self.to_model(Interval { lower: full.lower, upper: all.upper })
    }

    /// None if nothing is proven full.
    pub(super) fn centroid(&self) -> Option<[Interval; 3]> {
        if self.found.full.volume == 0 {
            return None;
        }
        let point = self.found.full.first.map(|first| 2 * nearest(first, 2 * self.found.full.volume));
        let (full, open) = (self.found.full.about(point), self.found.open.about(point));
        Some([0, 1, 2].map(|axis| {
            let of = |sign: i128| {
                farthest(
                    full.volume,
                    sign * full.first[axis],
                    open.volume,
                    sign * open.first[axis],
                    open.second[axis],
                )
            };
            let last = 2 * self.frame.cells() as i128;
            let universe = Interval { lower: -point[axis] as f64, upper: (last - point[axis]) as f64 };
            let from_point = Interval { lower: -of(-1), upper: of(1) }.within(universe);
            let plane = self.frame.plane(axis, (point[axis] / 2) as u32);
            plane.plus(from_point.times(Interval::exactly(self.half())))
        }))
    }

    /// About the model's origin.
    pub(super) fn inertia_about_origin(&self) -> Tensor {
        let [full, open, all] =
            [self.found.full, self.found.open, self.all()].map(|m| self.second_about_origin(&m));
        self.tensor(&full, &all, [0, 1, 2].map(|axis| open[axis].upper))
    }

    /// About the solid's own centroid.
    pub(super) fn inertia_about_centroid(&self) -> Tensor {
        let [full, all] = [self.found.full, self.all()].map(|m| second_about_centroid(&m));
        let spread = match self.found.open.volume {
            0 => [0.0; 3],
            _ => [0, 1, 2].map(|axis| all[axis].minus(full[axis]).upper),
        };
        self.tensor(&full, &all, spread)
    }

    /// ∫ x xᵀ about the model's origin, in the units of [`Moments`] but for the factor 3.
    fn second_about_origin(&self, moments: &Moments) -> Symmetric {
        // The plane next to the origin is the reference, so that nothing cancels.
        let cells = self.frame.cells() as f64;
        let planes = [0, 1, 2].map(|axis| {
            let at = self.frame.scaled(axis, 0.0).clamp(0.0, cells);
            (at + 0.5) as u32
        });
        let point = planes.map(|plane| 2 * plane as i128);
        let offset =
            [0, 1, 2].map(|axis| self.frame.plane(axis, planes[axis]).over(Interval::exactly(self.half())));
        let moments = moments.about(point);
        let volume = Interval::of_integer(moments.volume);
        let first = moments.first.map(Interval::of_integer);
        let mut second = moments.second.map(|sum| Interval::of_integer(sum).over(THREE));
        for (sum, (i, j)) in second.iter_mut().zip(PAIRS) {
            let mixed = offset[i].times(first[j]).plus(offset[j].times(first[i]));
            let square = if i == j { offset[i].square() } else { offset[i].times(offset[j]) };
            *sum = sum.plus(mixed).plus(square.times(volume));
        }
        second
    }

    /// The tensor of inertia of a set whose second moments lie between `lower` and `upper`, the differences
    /// of whose diagonals are at most `spread`.
    fn tensor(&self, lower: &Symmetric, upper: &Symmetric, spread: [f64; 3]) -> Tensor {
        let half = Interval::exactly(self.half());
        let to_model = |second: Interval| {
            let size = Interval::exactly(self.frame.cell_size());
            second.times(half).times(half).times(size).times(size).times(size)
        };
        let mut tensor = [[ZERO; 3]; 3];
        for (k, (i, j)) in (0..6).zip(PAIRS) {
            tensor[i][j] = to_model(if i == j {
                // Of the other two axes.
                let (a, b) = ((i + 1) % 3, (i + 2) % 3);
                Interval {
                    lower: lower[a].plus(lower[b]).lower.max(0.0),
                    upper: upper[a].plus(upper[b]).upper,
                }
            } else {
                let [a, b] = [i, j].map(|axis| Interval::exactly(spread[axis].max(0.0)));
                let radius = a.times(b).root().upper;
                let sum = lower[k].plus(upper[k]).plus(Interval { lower: -radius, upper: radius });
                sum.times(HALF).negated()
            });
            tensor[j][i] = tensor[i][j];
        }
        for i in 0..3 {
            tensor[i][i].lower = tensor[i][i].lower.max(0.0);
        }
        tensor
    }
}

/// ∫ (x − c)(x − c)ᵀ about the set's own centroid c, in the units of [`Moments`] but for the factor 3.
fn second_about_centroid(moments: &Moments) -> Symmetric {
    if moments.volume == 0 {
        return [ZERO; 6];
    }
    // The half cell next to the centroid is the reference, so that little is taken off.
    let moments = moments.about(moments.first.map(|first| nearest(first, moments.volume)));
    let volume = Interval::of_integer(moments.volume);
    let first = moments.first.map(Interval::of_integer);
    let mut second = moments.second.map(|sum| Interval::of_integer(sum).over(THREE));
    for (sum, (i, j)) in second.iter_mut().zip(PAIRS) {
        let product = if i == j { first[i].square() } else { first[i].times(first[j]) };
        *sum = sum.minus(product.over(volume));
    }
    second
}

/// The integer nearest to the quotient of two that are not negative.
fn nearest(a: i128, b: i128) -> i128 {
    (2 * a + b) / (2 * b)
}

/// A number that the centroid's coordinate does not exceed, from moments of the FULL and the PARTIAL cells
/// along the axis; `full_volume` is positive.
fn farthest(
    full_volume: i128,
    full_first: i128,
    open_volume: i128,
    open_first: i128,
    open_second: i128,
) -> f64 {
    let [v, m, w, p, q] =
        [full_volume, full_first, open_volume, open_first, open_second].map(|sum| sum as f64);
    let q = q / 3.0;
    // Newton's method leads to about where the excess is 0; whatever comes out, what follows is proven of it.
    let mut c = m / v;
    for _ in 0..20 {
        let about = p - c * w;
        let root = sqrt(w * (q - 2.0 * c * p + c * c * w));
        let excess = m - c * v + 0.5 * (about + root);
        let step = excess / (v + 0.5 * w + 0.5 * w * about / root);
        let is_worth_it = step.abs() > 1e-12 * (1.0 + c.abs());
        if !is_worth_it || !(c + step).is_finite() {
            break;
        }
        c += step;
    }
    let [v, m, w, p, q] =
        [full_volume, full_first, open_volume, open_first, open_second].map(Interval::of_integer);
    let at = Interval::exactly(c);
    let about = p.minus(at.times(w));
    let square = q.over(THREE).minus(at.times(p).times(Interval::exactly(2.0))).plus(at.square().times(w));
    let excess = m.minus(at.times(v)).plus(about.plus(w.times(square).root()).times(HALF));
    let beyond = Interval { lower: 0.0, upper: excess.upper.max(0.0) };
    at.plus(beyond.over(v)).upper
}
