//! Exact predicates on points and segments of the plane.

use crate::lattice::Each;
use crate::lattice::exact::{sign, sign_of_products, two_diff};

/// Returns the exact sign of (b − a) × (d − c): 1 if the second direction is to the left of the first.
pub(crate) fn turn([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> i32 {
    let left = (b[0] - a[0]) * (d[1] - c[1]);
    let right = (b[1] - a[1]) * (d[0] - c[0]);
    let cross = left - right;
    // Five roundings, each of at most 2^-53 of the magnitude; the bound has room for its own roundings.
    if cross.abs() > 4.0 * f64::EPSILON * (left.abs() + right.abs()) {
        return sign(cross);
    }
    let ((x, p), (y, q)) = (two_diff(b[0], a[0]), two_diff(d[1], c[1]));
    let ((u, r), (v, s)) = (two_diff(a[1], b[1]), two_diff(d[0], c[0]));
    sign_of_products(&[(x, y), (x, q), (p, y), (p, q), (u, v), (u, s), (r, v), (r, s)])
}

/// Returns whether one point comes before the other in lexicographic order.
pub(crate) fn before(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0] < b[0] || a[0] == b[0] && a[1] < b[1]
}

/// Returns whether two edges have a point in common.
pub(crate) fn meet(e: [[f64; 2]; 2], f: [[f64; 2]; 2]) -> bool {
    let boxes_meet = (0..2).all(|axis| {
        let [[a, b], [c, d]] = [e, f].each(|edge| edge.each(|end| end[axis]));
        a.min(b) <= c.max(d) && c.min(d) <= a.max(b)
    });
    let sides = |[a, b]: [[f64; 2]; 2], [p, q]: [[f64; 2]; 2]| turn([a, b], [a, p]) * turn([a, b], [a, q]);
    boxes_meet && sides(e, f) <= 0 && sides(f, e) <= 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_exact() {
        let e = f64::EPSILON;
        assert_eq!(turn([[0.0; 2], [1.0, 1.0]], [[0.5, 0.5], [1.5, 1.5 + 2.0 * e]]), 1);
        assert_eq!(turn([[0.0; 2], [1.0, 1.0]], [[0.1, 0.1], [0.7, 0.7]]), 0);
        assert_eq!(turn([[0.1, 0.1], [0.3, 0.3]], [[1e30, 1e30], [1e31, 1e31]]), 0);
        assert_eq!(turn([[0.1, 0.1], [0.3, 0.3]], [[1e30, 1e30], [1e31, 1e31_f64.next_down()]]), -1);
    }
}
