//! Exact signs of determinants: the sides on which points lie.

use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{Expansion, sign, sign_of_products, two_diff};
use core::array::from_fn as array;

pub(super) type Point = [f64; 3];

/// Returns the sign of (b − a) × (c − a) · (d − a): positive if d lies on the side from which a, b, c turn
/// counter-clockwise.
pub(super) fn volume_sign(a: &Point, b: &Point, c: &Point, d: &Point) -> i32 {
    sure_volume_sign(a, b, c, d).unwrap_or_else(|| exact_volume_sign(a, [b, c, d]))
}

/// Does the same in doubles; `None` if rounding may decide.
#[inline]
pub(super) fn sure_volume_sign(a: &Point, b: &Point, c: &Point, d: &Point) -> Option<i32> {
    let [u, v, w]: [Point; 3] = [b, c, d].each(|p| array(|axis| p[axis] - a[axis]));
    let (mut value, mut magnitude) = (0.0, 0.0);
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (left, right) = (u[i] * v[j], u[j] * v[i]);
        value += (left - right) * w[k];
        magnitude += (left.abs() + right.abs()) * w[k].abs();
    }
    // Each product involves at most ten roundings. (No product underflows: coordinates that are not zero, and
    // differences of them, are at least 2^-308.)
    (value.abs() > 16.0 * (f64::EPSILON / 2.0) * magnitude || magnitude == 0.0).then(|| sign(value))
}

/// Does the same by exact arithmetic.
#[cold]
fn exact_volume_sign(a: &Point, points: [&Point; 3]) -> i32 {
    let is_exact = |p: &Point| (0..3).all(|axis| two_diff(p[axis], a[axis]).1 == 0.0);
    let vectors: [Point; 3] = points.each(|p| array(|axis| p[axis] - a[axis]));
    if points.into_iter().all(is_exact)
        && let Some([u, v, w]) = in_whole_steps(&vectors)
    {
        let minor = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
        return (minor(1, 2) * w[0] + minor(2, 0) * w[1] + minor(0, 1) * w[2]).signum() as i32;
    }
    let [u, v, w] = points.each(|p| axes(|axis| Expansion::sum([p[axis], -a[axis]])));
    let mut sum = Expansion::default();
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        sum = sum.plus(&u[i].times(&v[j]).minus(&u[j].times(&v[i])).times(&w[k]));
    }
    sum.sign()
}

/// Returns three vectors as integer multiples of one step, with at most 41 bits, so that their determinant
/// has at most 126 bits.
fn in_whole_steps(vectors: &[Point; 3]) -> Option<[[i128; 3]; 3]> {
    const BITS: i32 = 41;
    let most = vectors.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let exponent = (most.to_bits() >> 52) as i32 - 1023 + 1 - BITS;
    if !(-900..900).contains(&exponent) {
        return None;
    }
    let power = |exponent: i32| f64::from_bits(((1023 + exponent) as u64) << 52);
    let (step, steps) = (power(exponent), power(-exponent));
    let whole = vectors.each(|vector| vector.each(|x| (x * steps) as i64));
    let is_whole = |x: f64, whole: i64| whole as f64 * step == x;
    let are_whole = vectors.iter().flatten().zip(whole.iter().flatten()).all(|(&x, &n)| is_whole(x, n));
    are_whole.then(|| whole.each(|vector| vector.each(i128::from)))
}

/// Returns the sign of a component of the cross product of two differences, each from its first point to its
/// second.
pub(super) fn cross_sign(u: [&Point; 2], v: [&Point; 2], axis: usize) -> i32 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let difference = |[from, to]: [&Point; 2], k: usize| to[k] - from[k];
    let (left, right) = (difference(u, i) * difference(v, j), difference(u, j) * difference(v, i));
    let value = left - right;
    if value.abs() > 8.0 * (f64::EPSILON / 2.0) * (left.abs() + right.abs()) {
        return sign(value);
    }
    let exact = |[from, to]: [&Point; 2], k: usize| two_diff(to[k], from[k]);
    let products = |(a, b): (f64, f64), (c, d): (f64, f64)| [(a, c), (a, d), (b, c), (b, d)];
    let left = products(exact(u, i), exact(v, j));
    let right = products(exact(u, j), exact(v, i)).each(|(a, b)| (-a, b));
    sign_of_products([left, right].as_flattened())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn by_expansions(a: &Point, points: [&Point; 3]) -> i32 {
        let [u, v, w] = points.map(|p| axes(|axis| Expansion::sum([p[axis], -a[axis]])));
        let minor = |i: usize, j: usize| u[i].times(&v[j]).minus(&u[j].times(&v[i]));
        let first = minor(1, 2).times(&w[0]);
        first.plus(&minor(2, 0).times(&w[1])).plus(&minor(0, 1).times(&w[2])).sign()
    }

    /// Points in one plane and next to it, with few digits and with many, of all sizes.
    #[test]
    fn signs_are_exact() {
        let mut seed = 1u64;
        let mut below = |end: i64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as i64 % end - end / 2
        };
        let mut seen = [0; 3];
        for round in 0..20_000 {
            let (end, size) = ([9, 1 << 20, 1 << 40, 1 << 45][round % 4], [1.0, 1e-75, 3e60][round / 4 % 3]);
            let [a, u, v]: [[i64; 3]; 3] = array(|_| array(|_| below(end)));
            let (s, t) = (below(5), below(5));
            let off = [0, 0, 1][round / 12 % 3];
            let d = array(|axis| a[axis] + s * u[axis] + t * v[axis] + off * i64::from(axis == round % 3));
            let end_of = |way: [i64; 3]| array(|axis| a[axis] + way[axis]);
            let [a, b, c, d] = [a, end_of(u), end_of(v), d].map(|p: [i64; 3]| p.map(|x| x as f64 * size));
            let sign = volume_sign(&a, &b, &c, &d);
            assert_eq!(sign, by_expansions(&a, [&b, &c, &d]), "{a:?} {b:?} {c:?} {d:?}");
            seen[(sign + 1) as usize] += 1;
            for axis in 0..3 {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                let [u, v] = [&b, &d].map(|p| axes(|axis| Expansion::sum([p[axis], -a[axis]])));
                let exact = u[i].times(&v[j]).minus(&u[j].times(&v[i])).sign();
                assert_eq!(cross_sign([&a, &b], [&a, &d], axis), exact, "{a:?} {b:?} {d:?}");
            }
        }
        assert!(seen.iter().all(|&count| count > 1000), "{seen:?}");
    }
}
