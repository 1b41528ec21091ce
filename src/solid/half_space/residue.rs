//! A short hash by which equal surfaces are found among many.
//!
//! Two stored surfaces may be the same although their numbers differ: polynomials may be proportional, and a
//! figure may be placed by several maps or by one. The exact comparison takes long numbers. So the polynomial
//! in model space is first computed modulo a prime, where sums of doubles, products and quotients are exact
//! and short. Equal surfaces have equal residues. Different surfaces have equal residues in two of 2^61
//! cases, and are then compared exactly.

use crate::lattice::Each;
use crate::octree::cuts::{SurfaceKind, SurfacesRef};

/// A number modulo the prime 2^61 − 1, in which powers of two are rotations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Residue(u64);

/// 2^61 − 1.
const PRIME: u64 = (1 << 61) - 1;

impl Residue {
    const ZERO: Residue = Residue(0);
    const ONE: Residue = Residue(1);
    const HALF: Residue = Residue(1 << 60);

    fn of(number: f64) -> Residue {
        let bits = number.to_bits();
        let (exponent, fraction) = ((bits >> 52 & 0x7FF) as i64, bits & ((1 << 52) - 1));
        let (mantissa, power) =
            if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
        let turned = power.rem_euclid(61) as u32;
        let wide = u128::from(mantissa) << turned;
        let size = Residue::reduced(wide);
        if number < 0.0 { Residue::ZERO.minus(size) } else { size }
    }

    fn reduced(wide: u128) -> Residue {
        let folded = (wide & u128::from(PRIME)) as u64 + (wide >> 61) as u64;
        let folded = (folded & PRIME) + (folded >> 61);
        Residue(if folded >= PRIME { folded - PRIME } else { folded })
    }

    fn plus(self, other: Residue) -> Residue {
        let sum = self.0 + other.0;
        Residue(if sum >= PRIME { sum - PRIME } else { sum })
    }

    fn minus(self, other: Residue) -> Residue {
        self.plus(Residue(if other.0 == 0 { 0 } else { PRIME - other.0 }))
    }

    fn times(self, other: Residue) -> Residue {
        Residue::reduced(u128::from(self.0) * u128::from(other.0))
    }

    /// The reciprocal; zero for zero.
    fn inverse(self) -> Residue {
        // By Fermat's theorem, the reciprocal is the power with exponent 2^61 − 3.
        let (mut power, mut base, mut exponent) = (Residue::ONE, self, PRIME - 2);
        while exponent > 0 {
            if exponent & 1 != 0 {
                power = power.times(base);
            }
            base = base.times(base);
            exponent >>= 1;
        }
        power
    }

    fn sum(terms: &[f64]) -> Residue {
        terms.iter().fold(Residue::ZERO, |sum, &term| sum.plus(Residue::of(term)))
    }
}

/// A projective map from homogeneous coordinates of a point of model space to those of the point in a
/// figure's space.
type Map = [[Residue; 4]; 4];

fn product(a: &Map, b: &Map) -> Map {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| (0..4).fold(Residue::ZERO, |sum, k| sum.plus(a[i][k].times(b[k][j]))))
    })
}

/// The inverse of a placement, times its determinant.
fn inverse(rows: &[[f64; 4]; 3]) -> Map {
    let m = rows.each(|row| row.each(Residue::of));
    let minor = |i: usize, j: usize| {
        let [a, b, c, d] = [(1, 1), (2, 2), (1, 2), (2, 1)].each(|(p, q)| m[(i + p) % 3][(j + q) % 3]);
        a.times(b).minus(c.times(d))
    };
    let mut map = [[Residue::ZERO; 4]; 4];
    for (i, row) in map.iter_mut().take(3).enumerate() {
        for j in 0..3 {
            row[j] = minor(j, i);
            row[3] = row[3].minus(row[j].times(m[j][3]));
        }
    }
    map[3][3] = (0..3).fold(Residue::ZERO, |sum, j| sum.plus(m[0][j].times(minor(0, j))));
    map
}

/// Mixes residues into one number.
fn mixed(seed: u64, residues: impl Iterator<Item = u64>) -> u64 {
    residues.fold(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15), |all, one| {
        let wide = u128::from(all ^ one).wrapping_mul(0xD6E8_FEB8_6659_FD93_A076_1D64_78BD_642F);
        (wide as u64) ^ (wide >> 64) as u64
    })
}

/// The numbers of `form`, up to a common factor.
fn projective(seed: u64, form: impl Iterator<Item = Residue> + Clone) -> u64 {
    let first = form.clone().find(|&c| c != Residue::ZERO).unwrap_or(Residue::ONE);
    let scale = first.inverse();
    mixed(seed, form.map(|c| c.times(scale).0))
}

/// Returns a number that is equal for equal surfaces. `None` for a surface that equals no other (a slab
/// without an origin), or that is damaged. O(maps).
pub(crate) fn residue(surfaces: &SurfacesRef<'_>, id: usize) -> Option<u64> {
    let (kind, numbers) = surfaces.get(id)?;
    if let (Some(slab), Some(([low, high], _))) = (surfaces.cell_slab(id), surfaces.identity(id)) {
        // (On another universe it is another slab, and is compared as such.)
        return Some(mixed(kind as u64, [slab.home, slab.planes, low, high].into_iter()));
    }
    let one =
        core::array::from_fn(|i| core::array::from_fn(|j| if i == j { Residue::ONE } else { Residue::ZERO }));
    let map = surfaces.placements(id).fold(one, |map: Map, rows| product(&map, &inverse(rows)));
    let seed = kind as u64;
    let mut numbers = (0..kind.numbers() as usize).map(|i| Residue::sum(numbers.get(i)));
    let mut next = || numbers.next().unwrap_or(Residue::ZERO);
    Some(match kind {
        SurfaceKind::Plane => {
            let plane = [next(), next(), next(), next()];
            let dot = |j: usize| (0..4).fold(Residue::ZERO, |sum, k| sum.plus(plane[k].times(map[k][j])));
            projective(seed, (0..4).map(dot))
        }
        SurfaceKind::Quadric => {
            let [xx, yy, zz] = [next(), next(), next()];
            let [xy, yz, zx, x, y, z] = core::array::from_fn(|_| next().times(Residue::HALF));
            let form = [[xx, xy, zx, x], [xy, yy, yz, y], [zx, yz, zz, z], [x, y, z, next()]];
            let turned = core::array::from_fn(|i| core::array::from_fn(|j| map[j][i]));
            let form = product(&turned, &product(&form, &map));
            projective(seed, (0..4).flat_map(|i| (i..4).map(move |j| (i, j))).map(|(i, j)| form[i][j]))
        }
        SurfaceKind::Powers | SurfaceKind::Torus => {
            let own = mixed(seed, numbers.map(|number| number.0));
            projective(own, map.into_iter().flatten())
        }
        SurfaceKind::Slab => {
            let ([low, high], number) = surfaces.identity(id)?;
            let own = numbers.take(5).map(|number| number.0).chain([low, high, number]);
            projective(mixed(seed, own), map.into_iter().flatten())
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_are_exact_modulo_a_prime() {
        for (a, b) in [(0.1, 3.0), (-1e300, 1e-300), (f64::MIN_POSITIVE / 8.0, 2f64.powi(1000)), (0.75, -0.5)]
        {
            // The rounded part of a product of doubles, and its error.
            let (a, b) = (Residue::of(a), Residue::of(b));
            assert_eq!(a.times(b), b.times(a));
            assert_eq!(a.times(a.inverse()), Residue::ONE);
            assert_eq!(a.plus(b).minus(b), a);
        }
        assert_eq!(Residue::of(3.0).times(Residue::of(0.25)), Residue::of(0.75));
        assert_eq!(Residue::of(-1e300).plus(Residue::of(1e300)), Residue::ZERO);
        assert_eq!(
            Residue::of(2f64.powi(-1070)).times(Residue::of(2f64.powi(1000))),
            Residue::of(2f64.powi(-70))
        );
        assert_eq!(Residue::of(0.0), Residue::ZERO);
    }
}
