//! Affine maps of model space.

use super::array::Each;
use super::axes;
use super::exact::{Expansion, product_up, sign_of_products, sqrt, two_product};
use crate::error::Error;

/// Entries beyond ±2^64 are rejected, and so are entries below 2^-64 in magnitude, except zero.
const LARGEST: f64 = 18_446_744_073_709_551_616.0;

/// An invertible affine map p ↦ M p + t, which places a shape. Row i of `[M | t]` gives coordinate i of the
/// image. The map has exactly these doubles as coefficients; nothing is normalised or rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine {
    rows: [[f64; 4]; 3],
}

impl Affine {
    /// The identity map.
    pub const IDENTITY: Affine =
        Affine { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };

    /// The message of [`new`](Self::new) for matrices that are not invertible.
    pub(crate) const SINGULAR: &str = "the matrix is singular";

    /// Makes the map with the rows of `[M | t]`.
    ///
    /// # Errors
    /// [`Error::Argument`] if an entry is neither zero nor of a magnitude between 2^-64 and 2^64, or if M is
    /// singular (decided exactly).
    pub fn new(rows: [[f64; 4]; 3]) -> Result<Affine, Error> {
        let refuse = |problem| Err(Error::Argument { name: "placement", problem });
        if !rows.iter().flatten().all(|&c| c == 0.0 || (1.0 / LARGEST..=LARGEST).contains(&c.abs())) {
            return refuse("every entry must be zero or of a magnitude between 2^-64 and 2^64");
        }
        let map = Affine { rows: rows.each(|row| row.each(|c| c + 0.0)) };
        if map.orientation() == 0 {
            return refuse(Affine::SINGULAR);
        }
        Ok(map)
    }

    /// Makes the translation by `offset`.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn translation(offset: [f64; 3]) -> Result<Affine, Error> {
        let mut rows = Affine::IDENTITY.rows;
        for axis in 0..3 {
            rows[axis][3] = offset[axis];
        }
        Affine::new(rows)
    }

    /// The rows of `[M | t]`.
    pub fn rows(&self) -> &[[f64; 4]; 3] {
        &self.rows
    }

    /// Returns whether this is the identity map.
    pub fn is_identity(&self) -> bool {
        *self == Affine::IDENTITY
    }

    /// The greatest distance along any axis between the images of two points whose distance along each axis
    /// is `distance`; rounded upward.
    pub(crate) fn stretched(&self, distance: f64) -> f64 {
        let stretch = self.rows.iter().map(|[x, y, z, _]| x.abs() + y.abs() + z.abs()).fold(0.0, f64::max);
        product_up(stretch * (1.0 + 2.0 * f64::EPSILON), distance)
    }

    /// A bound of the length of images of vectors that are no longer than `length`. For rotations, and for
    /// maps that scale along axes, the bound is nearly tight. It is never as much as √3 times too large.
    pub(crate) fn lengthened(&self, length: f64) -> f64 {
        let is_translation =
            (0..3).all(|i| (0..3).all(|j| self.rows[i][j] == if i == j { 1.0 } else { 0.0 }));
        if length == 0.0 || is_translation {
            return length;
        }
        // The square of the norm is the greatest eigenvalue of MᵀM. An eigenvalue is no greater than the sum
        // of magnitudes in some row.
        let entry = |i: usize, j: usize| {
            let parts = self.rows.each(|row| row[i] * row[j]);
            let size = parts.iter().map(|part| part.abs()).sum::<f64>();
            parts.iter().sum::<f64>().abs() + 8.0 * f64::EPSILON * size
        };
        let most = (0..3).fold(0.0, |most: f64, i| most.max((0..3).map(|j| entry(i, j)).sum()));
        product_up(sqrt(most) * (1.0 + 16.0 * f64::EPSILON), length).next_up()
    }

    /// The exact sign of the determinant: 1 if the map keeps orientation, −1 if it mirrors, 0 if M is
    /// singular.
    pub fn orientation(&self) -> i32 {
        // Six products of three doubles, with four terms each. No term leaves the range of doubles.
        let m = &self.rows;
        let parts = axes(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (plus, minus) = (two_product(m[0][i], m[1][j]), two_product(m[0][j], m[1][i]));
            [(plus.0, m[2][k]), (plus.1, m[2][k]), (-minus.0, m[2][k]), (-minus.1, m[2][k])]
        });
        sign_of_products(parts.as_flattened())
    }

    /// The cofactors of M, and its determinant, as exact sums.
    fn cofactors(&self) -> ([[Expansion; 3]; 3], f64) {
        let m = &self.rows;
        let minor = |i: usize, j: usize| {
            let (r, s) = ((i + 1) % 3, (i + 2) % 3);
            let (c, d) = ((j + 1) % 3, (j + 2) % 3);
            let (plus, minus) = (two_product(m[r][c], m[s][d]), two_product(m[r][d], m[s][c]));
            Expansion::sum([plus.1, -minus.1, plus.0, -minus.0])
        };
        let cofactors = axes(|i| axes(|j| minor(i, j)));
        let determinant = (0..3).fold(Expansion::default(), |sum, j| {
            sum.plus(&cofactors[0][j].times(&Expansion::sum([m[0][j]])))
        });
        (cofactors, determinant.estimate())
    }

    /// Returns whether the linear part has one entry a row, and that entry is a power of two. Then neither
    /// the linear part nor its inverse is rounded.
    pub(crate) fn is_monomial(&self) -> bool {
        self.rows.iter().all(|[x, y, z, _]| {
            let mut entries = [x, y, z].into_iter().filter(|&&c| c != 0.0);
            let is_power = |c: &f64| c.is_normal() && c.to_bits() << 12 == 0;
            entries.next().is_some_and(is_power) && entries.next().is_none()
        })
    }

    /// The inverse of the linear part. The relative error of each entry is at most 5 · 2^-53: it is the
    /// quotient of a minor and the determinant, both of which come from exact sums.
    pub(crate) fn inverse_linear(&self) -> [[f64; 3]; 3] {
        let (cofactors, determinant) = self.cofactors();
        axes(|i| axes(|j| cofactors[j][i].estimate() / determinant))
    }

    /// The inverse map, rounded. The relative error of each entry is at most 5 · 2^-53, but entries below
    /// 2^-64 in magnitude become 0. The inverse is exact for a map that permutes and mirrors axes, scales
    /// them by powers of two, and translates.
    ///
    /// # Errors
    /// [`Error::Argument`] if an entry exceeds 2^64, or if the rounded matrix is singular: the map scales up
    /// or down by too much.
    ///
    /// ```
    /// let quarter = leafless::Affine::new([[0.0, -1.0, 0.0, 3.0], [1.0, 0.0, 0.0, 5.0], [0.0, 0.0, 2.0, 1.0]])?;
    /// assert_eq!(quarter.inverse()?.apply(quarter.apply([7.0, 8.0, 9.0])), [7.0, 8.0, 9.0]);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn inverse(&self) -> Result<Affine, Error> {
        let (cofactors, determinant) = self.cofactors();
        let rows = axes(|i| {
            let moved = (0..3).fold(Expansion::default(), |sum, j| {
                sum.plus(&cofactors[j][i].times(&Expansion::sum([-self.rows[j][3]])))
            });
            let [x, y, z] = axes(|j| cofactors[j][i].estimate() / determinant);
            [x, y, z, moved.estimate() / determinant]
        });
        Affine::new(rows.each(|row| row.each(|c| if c.abs() < 1.0 / LARGEST { 0.0 } else { c })))
    }

    /// The image of a point, rounded. The error of each coordinate is at most 2^-50 times the sum of the
    /// magnitudes of its four summands.
    pub fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        self.rows.each(|[x, y, z, t]| ((x * p[0] + y * p[1]) + z * p[2]) + t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orientation_is_exact() {
        let of = |m: [[f64; 3]; 3]| Affine { rows: m.map(|[a, b, c]| [a, b, c, 7.0]) }.orientation();
        assert_eq!(of([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), 1);
        assert_eq!(of([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), -1);
        let e = f64::EPSILON;
        // (1 + e)(1 − e) − 1 = −e².
        assert_eq!(of([[1.0 + e, 1.0, 0.0], [1.0, 1.0 - e, 0.0], [0.0, 0.0, 1e18]]), -1);
        assert_eq!(of([[1.0 + e, 1.0, 0.0], [1.0 + e, 1.0, 0.0], [0.0, 0.0, 1.0]]), 0);
        assert_eq!(of([[0.1, 0.2, 0.3], [0.2, 0.4, 0.6], [1.0, 5.0, 7.0]]), 0);
        assert!(Affine::new([[0.0; 4]; 3]).is_err());
        assert!(Affine::translation([f64::NAN, 0.0, 0.0]).is_err());
    }

    #[test]
    fn inverses() {
        // A rotation by a quarter turn, as libraries compute it: the residue in place of zero does not
        // matter.
        let c = 6.123233995736766e-17;
        let quarter =
            Affine::new([[c, -1.0, 0.0, 1e-5], [1.0, c, 0.0, -3.0], [0.0, 0.0, -0.5, 7.0]]).unwrap();
        let back = quarter.inverse().unwrap();
        for p in [[1.0, 2.0, 3.0], [-1e3, 1e-3, 0.0]] {
            let there_and_back = back.apply(quarter.apply(p));
            assert!((0..3).all(|k| (there_and_back[k] - p[k]).abs() < 1e-12), "{there_and_back:?}");
        }
        // Two of three directions are nearly equal: rows of cofactors are differences of almost equal
        // products.
        let e = f64::EPSILON;
        let thin =
            Affine::new([[1.0, 1.0, 0.0, 0.0], [1.0, 1.0 + e, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
        assert_eq!(thin.inverse().unwrap().rows()[0], [(1.0 + e) / e, -1.0 / e, 0.0, 0.0]);
        let scaled =
            |s: f64| Affine::new([[s, 0.0, 0.0, 0.0], [0.0, s, 0.0, 0.0], [0.0, 0.0, s, 1.0]]).unwrap();
        assert_eq!(scaled(LARGEST).inverse().unwrap(), {
            let mut small = scaled(1.0 / LARGEST);
            small.rows[2][3] = -1.0 / LARGEST;
            small
        });
        // The translation of the inverse would exceed the limits of a map.
        let far = Affine::new([[1e-10, 0.0, 0.0, 1e19], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
        assert!(far.inverse().is_err());
    }
}
