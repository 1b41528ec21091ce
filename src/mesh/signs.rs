//! On which side points lie: the signs of determinants, exactly.

use crate::lattice::axes;
use crate::lattice::exact::{Expansion, sign};
use core::array::from_fn as array;

pub(super) type Point = [f64; 3];

/// The sign of (b − a) × (c − a) · (d − a): positive if d lies on the side from which a, b, c turn
/// counter-clockwise.
pub(super) fn volume_sign(a: &Point, b: &Point, c: &Point, d: &Point) -> i32 {
    let [u, v, w]: [Point; 3] = [b, c, d].map(|p| array(|axis| p[axis] - a[axis]));
    let (mut value, mut magnitude) = (0.0, 0.0);
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (left, right) = (u[i] * v[j], u[j] * v[i]);
        value += (left - right) * w[k];
        magnitude += (left.abs() + right.abs()) * w[k].abs();
    }
    // At most ten roundings lie behind each product.
    if value.abs() > 16.0 * (f64::EPSILON / 2.0) * magnitude {
        return sign(value);
    }
    if magnitude == 0.0 {
        // No product underflows: coordinates that are not zero, and differences of them, are at least 2^-308.
        return 0;
    }
    let [u, v, w] = [b, c, d].map(|p| axes(|axis| Expansion::sum([p[axis], -a[axis]])));
    let mut sum = Expansion::default();
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        sum = sum.plus(&u[i].times(&v[j]).minus(&u[j].times(&v[i])).times(&w[k]));
    }
    sum.sign()
}

/// The sign of a component of the cross product of two differences, each from its first point to its second.
pub(super) fn cross_sign(u: [&Point; 2], v: [&Point; 2], axis: usize) -> i32 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let difference = |[from, to]: [&Point; 2], k: usize| to[k] - from[k];
    let (left, right) = (difference(u, i) * difference(v, j), difference(u, j) * difference(v, i));
    let value = left - right;
    if value.abs() > 8.0 * (f64::EPSILON / 2.0) * (left.abs() + right.abs()) {
        return sign(value);
    }
    let exact = |[from, to]: [&Point; 2], k: usize| Expansion::sum([to[k], -from[k]]);
    exact(u, i).times(&exact(v, j)).minus(&exact(u, j).times(&exact(v, i))).sign()
}
