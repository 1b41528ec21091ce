//! Bounds of a solid's measures from the moments of two sets between which the solid lies.
//!
//! The solid S contains F: the FULL cells and the parts of PARTIAL cells that are known to be inside. S lies
//! in A, which is F and the open part: PARTIAL cells, or their undecided parts. All volume integrals of one
//! sign over S are therefore bounded by those over F and A. (Where F and A are not sets but moments, their
//! matrices behave like those of such sets in the order of Loewner, and the proofs use nothing else.) Other
//! measures are bounded, too:
//!
//! - The matrix ∫ x xᵀ of second moments about a point grows with the set in the order of Loewner: for two
//!   nested sets, the difference is the matrix of the set between them, which is positive semidefinite. The
//!   matrix about the set's own centroid grows, too, because uᵀ M u = ∫ (u·x − u·c)², and the centroid c
//!   makes this a minimum.
//! - From L ≼ M ≼ U follows, for elements off the diagonal, |2 Mij − Lij − Uij| ≤ √(Δii Δjj) with Δ = U − L.
//!   (Both M − L and U − M have Mij² ≤ Mii Mjj; then Cauchy–Schwarz.)
//! - The same holds for the matrix of the moments of 1 and x − c: ∫ (x − c) over S is at most the mean of the
//!   integrals over F and A plus ½ √(V ∫ (x − c)²) of the open part, whose volume is V. (Scarf's bound.) If
//!   this is 0, no centroid lies beyond c. Otherwise the centroid lies beyond c by at most this bound divided
//!   by the volume of F.

use super::moments::{BITS, Moments, PAIRS, UNIVERSE};
use super::volume::Found;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::lattice::{Frame, Interval, MAX_DEPTH};

/// A symmetric matrix in the order of [`PAIRS`].
type Symmetric = [Interval; 6];

/// A symmetric tensor, row by row.
pub(super) type Tensor = [[Interval; 3]; 3];

const ZERO: Interval = Interval::exactly(0.0);
const NOT_NEGATIVE: Interval = Interval::between(0.0, f64::INFINITY);
const HALF: Interval = Interval::exactly(0.5);
const THREE: Interval = Interval::exactly(3.0);
/// The unit of moments, as a share of the unit without fraction bits.
const UNIT: Interval = Interval::exactly(1.0 / (1u64 << BITS) as f64);

/// The moments of F and of the open part.
pub(super) struct Known {
    /// The universe with grains as its finest cells.
    pub(super) frame: Frame,
    pub(super) found: Found,
}

/// Moments with error bounds.
struct Bounded {
    volume: Interval,
    first: [Interval; 3],
    second: [Interval; 6],
}

impl Bounded {
    fn new(moments: &Moments) -> Bounded {
        let error = moments.error;
        let within = |sum: i128, error: i128| {
            Interval::of_integer(sum - error).joined(Interval::of_integer(sum + error))
        };
        Bounded {
            volume: within(moments.volume, error),
            // No two points of the universe are further apart than 2^21 half grains along an axis.
            first: moments.first.each(|sum| within(sum, error << 22)),
            second: moments.second.each(|sum| within(sum, 3 * (error << 43))),
        }
    }
}

impl Known {
    fn all(&self) -> Moments {
        self.found.full + self.found.open
    }

    /// The edge of half a finest cell, in model units.
    fn half(&self) -> f64 {
        0.5 * self.frame.cell_size()
    }

    /// Converts units of moments to cubic model units.
    fn to_model(&self, volume: Interval) -> Interval {
        let size = Interval::exactly(self.frame.cell_size());
        volume.times(UNIT).times(size).times(size).times(size)
    }

    pub(super) fn volume(&self) -> Interval {
        let (full, all) = (Bounded::new(&self.found.full).volume, Bounded::new(&self.all()).volume);
        let universe = Interval::between(0.0, self.to_model(Interval::of_integer(UNIVERSE)).upper);
        // (A consistent solid gives no contradiction. The volume of a self-contradictory solid is unknown.)
        let between = Interval::new(full.lower, all.upper).map(|volume| self.to_model(volume));
        between.and_then(|volume| volume.common(universe)).unwrap_or(universe)
    }

    /// Returns the centroid; `None` if nothing is proven full.
    pub(super) fn centroid(&self) -> Option<[Interval; 3]> {
        if self.found.full.volume <= self.found.full.error {
            return None;
        }
        let last = 2 * self.frame.cells() as i128;
        let double = 2 * self.found.full.volume;
        let point = self.found.full.first.each(|first| (2 * nearest(first, double)).clamp(0, last));
        let [full, open] = [self.found.full, self.found.open].each(|m| Bounded::new(&m.about(point)));
        Some(axes(|axis| {
            let of = |sign: f64| {
                let signed = |sum: Interval| sum.times(Interval::exactly(sign));
                farthest(
                    full.volume,
                    signed(full.first[axis]),
                    open.volume,
                    signed(open.first[axis]),
                    open.second[axis],
                )
            };
            let universe = Interval::between(-point[axis] as f64, (last - point[axis]) as f64);
            let from_point = Interval::new(-of(-1.0), of(1.0)).and_then(|from| from.common(universe));
            let from_point = from_point.unwrap_or(universe);
            let plane = self.frame.plane(axis, (point[axis] / 2) as u32);
            plane.plus(from_point.times(Interval::exactly(self.half())))
        }))
    }

    /// Returns the tensor about the model's origin.
    pub(super) fn inertia_about_origin(&self) -> Tensor {
        let [full, open, all] =
            [self.found.full, self.found.open, self.all()].each(|m| self.second_about_origin(&m));
        self.tensor(&full, &all, axes(|axis| open[axis].upper))
    }

    /// Returns the tensor about the solid's own centroid.
    pub(super) fn inertia_about_centroid(&self) -> Tensor {
        let [full, all] = [self.found.full, self.all()].each(|m| second_about_centroid(&m));
        let spread = match (self.found.open.volume, self.found.open.error) {
            (0, 0) => [0.0; 3],
            _ => axes(|axis| all[axis].minus(full[axis]).upper),
        };
        self.tensor(&full, &all, spread)
    }

    /// Returns ∫ x xᵀ about the model's origin, in the units of [`Moments`] but without the factor 3.
    fn second_about_origin(&self, moments: &Moments) -> Symmetric {
        // The plane next to the origin is the reference, to avoid cancellation.
        let cells = self.frame.cells() as f64;
        let planes = axes(|axis| {
            let at = self.frame.scaled(axis, 0.0).clamp(0.0, cells);
            (at + 0.5) as u32
        });
        let point = planes.each(|plane| 2 * plane as i128);
        let offset = axes(|axis| self.frame.plane(axis, planes[axis]).over(Interval::exactly(self.half())));
        let Bounded { volume, first, second } = Bounded::new(&moments.about(point));
        let mut second = second.each(|sum| sum.over(THREE));
        for (sum, (i, j)) in second.iter_mut().zip(PAIRS) {
            let mixed = offset[i].times(first[j]).plus(offset[j].times(first[i]));
            let square = if i == j { offset[i].square() } else { offset[i].times(offset[j]) };
            *sum = sum.plus(mixed).plus(square.times(volume));
        }
        second
    }

    /// Returns the tensor of inertia of a set whose second moments lie between `lower` and `upper`, where the
    /// differences on the diagonal are at most `spread`.
    fn tensor(&self, lower: &Symmetric, upper: &Symmetric, spread: [f64; 3]) -> Tensor {
        let half = Interval::exactly(self.half());
        let to_model = |second: Interval| {
            let size = Interval::exactly(self.frame.cell_size());
            second.times(UNIT).times(half).times(half).times(size).times(size).times(size)
        };
        let mut tensor = [[ZERO; 3]; 3];
        for (k, (i, j)) in (0..6).zip(PAIRS) {
            tensor[i][j] = to_model(if i == j {
                // The sum over the other two axes.
                let (a, b) = ((i + 1) % 3, (i + 2) % 3);
                let between = Interval::new(lower[a].plus(lower[b]).lower, upper[a].plus(upper[b]).upper);
                between.map_or(NOT_NEGATIVE, Interval::not_negative)
            } else {
                let [a, b] = [i, j].each(|axis| Interval::exactly(spread[axis].max(0.0)));
                let radius = a.times(b).root().upper;
                let sum = lower[k].plus(upper[k]).plus(Interval::between(-radius, radius));
                sum.times(HALF).negated()
            });
            tensor[j][i] = tensor[i][j];
        }
        for i in 0..3 {
            tensor[i][i] = tensor[i][i].not_negative();
        }
        tensor
    }
}

/// Returns ∫ (x − c)(x − c)ᵀ about the set's own centroid c, in the units of [`Moments`] but without the
/// factor 3.
fn second_about_centroid(moments: &Moments) -> Symmetric {
    if moments.volume <= moments.error {
        // The set may be empty. The greatest moments are those of the error.
        let Bounded { second, .. } = Bounded::new(moments);
        return second.each(|sum| sum.joined(ZERO));
    }
    // The half cell next to the centroid is the reference, so that the subtracted term is small.
    let point = moments.first.each(|first| nearest(first, moments.volume).clamp(0, 2 << MAX_DEPTH));
    let about = moments.about(point);
    let Bounded { volume, first, second } = Bounded::new(&about);
    let mut second = second.each(|sum| sum.over(THREE));
    for (sum, (i, j)) in second.iter_mut().zip(PAIRS) {
        let product = if i == j { first[i].square() } else { first[i].times(first[j]) };
        *sum = sum.minus(product.over(volume));
    }
    second
}

/// Returns the integer nearest to a quotient, which is not negative; `b` is positive.
fn nearest(a: i128, b: i128) -> i128 {
    (2 * a + b) / (2 * b)
}

/// Returns an upper bound of the centroid's coordinate along an axis, from moments of F and of the open part.
/// The volume of F is positive.
fn farthest(
    full_volume: Interval,
    full_first: Interval,
    open_volume: Interval,
    open_first: Interval,
    open_second: Interval,
) -> f64 {
    let [v, m, w, p, q] = [full_volume, full_first, open_volume, open_first, open_second]
        .each(|sum| 0.5 * (sum.lower + sum.upper));
    let (w, q) = (w.max(0.0), q / 3.0);
    // Newton's method finds the approximate zero of the excess. The code after the loop proves a bound for
    // any result.
    let mut c = m / v;
    for _ in 0..20 {
        let about = p - c * w;
        let root = sqrt((w * (q - 2.0 * c * p + c * c * w)).max(0.0));
        let excess = m - c * v + 0.5 * (about + root);
        let step = excess / (v + 0.5 * w + 0.5 * w * about / root);
        let is_worth_it = step.abs() > 1e-12 * (1.0 + c.abs());
        if !is_worth_it || !(c + step).is_finite() {
            break;
        }
        c += step;
    }
    let at = Interval::exactly(c);
    let (v, m, w, p) = (full_volume, full_first, open_volume.not_negative(), open_first);
    let q = open_second.over(THREE).not_negative();
    let about = p.minus(at.times(w));
    let square = q.minus(at.times(p).times(Interval::exactly(2.0))).plus(at.square().times(w));
    let excess = m.minus(at.times(v)).plus(about.plus(w.times(square).root()).times(HALF));
    let beyond = Interval::between(0.0, excess.upper.max(0.0));
    at.plus(beyond.over(v)).upper
}
