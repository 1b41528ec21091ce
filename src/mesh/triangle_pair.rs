//! The distance of two triangles.
//!
//! The nearest points are found in plain doubles, which proves nothing yet. Any two points of the triangles
//! bound the distance from above. Any direction bounds it from below, by the gap between the projections of
//! the two triangles onto it. The direction from one nearest point to the other gives the best lower bound.
//!
//! Coordinates are at most 1 in magnitude, so that rounding has one bound for all: [`SLACK`].

use super::signs::Point;
use crate::lattice::Each;
use core::array::from_fn as array;

/// Upper bound of the rounding error of a computed distance, for coordinates with errors of up to 2^-50 each.
pub(super) const SLACK: f64 = 1.0 / (1_u64 << 46) as f64;

/// Two points, one of each triangle, that are near to each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearPair {
    /// The square of their distance.
    pub(super) square: f64,
    /// The weights of each triangle's corners at its point.
    pub(super) weights: [[f64; 3]; 2],
    /// The vector from the first point to the second.
    pub(super) way: Point,
}

#[inline(always)]
pub(super) fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn minus(a: &Point, b: &Point) -> Point {
    array(|axis| a[axis] - b[axis])
}

#[inline(always)]
fn cross(a: &Point, b: &Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Clamps a share to 0 to 1. (NaN, from a lost length, becomes 0.)
#[inline(always)]
fn share(x: f64) -> f64 {
    if x > 0.0 { if x < 1.0 { x } else { 1.0 } } else { 0.0 }
}

/// Returns the edges of a triangle, each from its corner to the next one.
#[inline(always)]
fn edges(t: &[Point; 3]) -> [Point; 3] {
    array(|k| minus(&t[(k + 1) % 3], &t[k]))
}

/// Returns the nearest points of two triangles, up to rounding.
pub(super) fn nearest(a: &[Point; 3], b: &[Point; 3]) -> NearPair {
    let (of_a, of_b) = (edges(a), edges(b));
    let (squares_a, squares_b) = (of_a.each(|e| dot(&e, &e)), of_b.each(|e| dot(&e, &e)));
    let mut best = NearPair { square: f64::INFINITY, weights: [[0.0; 3]; 2], way: [0.0; 3] };
    let mut shares = (0, 0, 0.0, 0.0);
    for i in 0..3 {
        for j in 0..3 {
            let (u, v) = (&of_a[i], &of_b[j]);
            let back = minus(&a[i], &b[j]);
            let (along_u, along_v, both) = (dot(u, &back), dot(v, &back), dot(u, v));
            let (uu, vv) = (squares_a[i], squares_b[j]);
            let mut s = share((both * along_v - along_u * vv) / (uu * vv - both * both));
            let mut t = (both * s + along_v) / vv;
            if !(0.0..=1.0).contains(&t) {
                t = share(t);
                s = share((both * t - along_u) / uu);
            }
            let way: Point = array(|axis| t * v[axis] - s * u[axis] - back[axis]);
            let square = dot(&way, &way);
            if square < best.square {
                (best.square, best.way, shares) = (square, way, (i, j, s, t));
            }
        }
    }
    let (i, j, s, t) = shares;
    (best.weights[0][i], best.weights[0][(i + 1) % 3]) = (1.0 - s, s);
    (best.weights[1][j], best.weights[1][(j + 1) % 3]) = (1.0 - t, t);
    above(a, b, &of_a, &mut best, false);
    above(b, a, &of_b, &mut best, true);
    best
}

/// Tests the corners of the second triangle that lie above or below the interior of the first, and its edges
/// that pass through the interior.
#[inline(always)]
fn above(a: &[Point; 3], b: &[Point; 3], edges: &[Point; 3], best: &mut NearPair, is_turned: bool) {
    let normal = cross(&edges[0], &edges[1]);
    let area = dot(&normal, &normal);
    if area == 0.0 {
        return;
    }
    let heights = b.each(|p| dot(&normal, &minus(&p, &a[0])));
    // The weights of the corners at the projection of a point, if the projection lies in the triangle.
    let within = |p: &Point| -> Option<[f64; 3]> {
        let sides: [f64; 3] = array(|k| dot(&cross(&edges[k], &minus(p, &a[k])), &normal) / area);
        sides.iter().all(|&side| side >= 0.0).then_some([sides[1], sides[2], sides[0]])
    };
    for k in 0..3 {
        let square = heights[k] * heights[k] / area;
        if square < best.square
            && let Some(weights) = within(&b[k])
        {
            let mut corner = [0.0; 3];
            corner[k] = 1.0;
            let height = heights[k] / area;
            take(best, square, [weights, corner], normal.each(|n| n * height), is_turned);
        }
    }
    for k in 0..3 {
        let next = (k + 1) % 3;
        if heights[k] * heights[next] < 0.0 {
            let t = heights[k] / (heights[k] - heights[next]);
            let at = array(|axis| (1.0 - t) * b[k][axis] + t * b[next][axis]);
            if let Some(weights) = within(&at) {
                let mut edge = [0.0; 3];
                (edge[k], edge[next]) = (1.0 - t, t);
                take(best, 0.0, [weights, edge], [0.0; 3], is_turned);
            }
        }
    }
}

#[inline(always)]
fn take(best: &mut NearPair, square: f64, [own, other]: [[f64; 3]; 2], way: Point, is_turned: bool) {
    *best = if is_turned {
        NearPair { square, weights: [other, own], way: way.each(|c| -c) }
    } else {
        NearPair { square, weights: [own, other], way }
    };
}

/// Returns a lower bound, up to rounding, of the gap between two triangles along a direction: negative if
/// their projections overlap.
#[inline(always)]
pub(super) fn gap_along(way: &Point, a: &[Point; 3], b: &[Point; 3]) -> f64 {
    let along = |p: &Point| dot(way, &minus(p, &a[0]));
    // (If an operand is NaN, the result is NaN or not greater than zero.)
    let larger = |x: f64, y: f64| if x > y { x } else { y };
    let greatest = larger(larger(along(&a[1]), along(&a[2])), 0.0);
    let least = larger(larger(-along(&b[0]), -along(&b[1])), -along(&b[2]));
    -least - greatest
}

/// Returns a lower bound of the distance of two triangles whose nearest points are `near`.
pub(super) fn at_least(near: &NearPair, a: &[Point; 3], b: &[Point; 3]) -> f64 {
    let length = |way: &Point| libm::sqrt(dot(way, way));
    let along = |way: &Point| gap_along(way, a, b) / length(way) - SLACK;
    let mut least = along(&near.way).max(0.0);
    if least < libm::sqrt(near.square) - 4.0 * SLACK {
        // The points are not the nearest ones, or too near to each other to define a direction.
        let (of_a, of_b) = (edges(a), edges(b));
        let mut ask = |way: Point| {
            // (A zero vector gives NaN, which does not count.)
            least = least.max(along(&way)).max(along(&way.each(|c| -c)));
        };
        ask(cross(&of_a[0], &of_a[1]));
        ask(cross(&of_b[0], &of_b[1]));
        of_a.iter().for_each(|u| of_b.iter().for_each(|v| ask(cross(u, v))));
    }
    least
}

/// Returns whether an edge of one triangle surely passes through the other triangle, even if each corner is
/// moved by up to `off`.
pub(super) fn surely_cross(a: &[Point; 3], b: &[Point; 3], off: f64) -> bool {
    let side = |[a, b, c]: [&Point; 3], p: &Point| {
        let (u, v, w) = (minus(b, a), minus(c, a), minus(p, a));
        let volume = dot(&cross(&u, &v), &w);
        let [x, y, z] = [&u, &v, &w].each(|way| libm::sqrt(dot(way, way)) + 2.0 * off);
        let wrong = 2.0 * off * (x * y + y * z + z * x) * 1.001 + x * y * z * (8.0 * f64::EPSILON) + 1e-300;
        if volume > wrong {
            1
        } else if volume < -wrong {
            -1
        } else {
            0
        }
    };
    let through = |t: &[Point; 3], edges: &[Point; 3]| {
        let heights = edges.each_ref().each(|p| side(t.each_ref(), p));
        (0..3).any(|k| {
            let (p, q) = (&edges[k], &edges[(k + 1) % 3]);
            let around = || [[0, 1], [1, 2], [2, 0]].each(|[i, j]| side([p, q, &t[i]], &t[j]));
            heights[k] * heights[(k + 1) % 3] < 0 && {
                let sides = around();
                sides[0] != 0 && sides == [sides[0]; 3]
            }
        })
    };
    through(a, b) || through(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the least distance of points of a fine grid on both triangles, and its maximum error.
    fn sampled(a: &[Point; 3], b: &[Point; 3]) -> f64 {
        const STEPS: usize = 24;
        let points = |t: &[Point; 3]| -> alloc::vec::Vec<Point> {
            let weights = (0..=STEPS).flat_map(|i| (0..=STEPS - i).map(move |j| (i, j)));
            let point = |(i, j): (usize, usize)| {
                let [x, y] = [i, j].map(|n| n as f64 / STEPS as f64);
                array(|axis| (1.0 - x - y) * t[0][axis] + x * t[1][axis] + y * t[2][axis])
            };
            weights.map(point).collect()
        };
        let (own, others) = (points(a), points(b));
        let squares = own.iter().flat_map(|p| others.iter().map(move |q| dot(&minus(p, q), &minus(p, q))));
        libm::sqrt(squares.fold(f64::INFINITY, f64::min))
    }

    #[test]
    fn bounds_of_random_pairs() {
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        let mut crossing = 0;
        for case in 0..600 {
            let size = if case % 3 == 0 { 0.1 } else { 0.5 };
            let mut triangle = |shift: f64| -> [Point; 3] {
                let middle: Point = array(|axis| if axis == 0 { shift } else { 0.4 * random() });
                array(|_| array(|axis| middle[axis] + size * (random() - 0.5)))
            };
            let (mut a, mut b) = (triangle(0.0), triangle(if case % 2 == 0 { 0.0 } else { 0.3 }));
            match case % 7 {
                0 => a[2] = a[0],
                1 => a[2] = array(|axis| 0.5 * (a[0][axis] + a[1][axis])),
                2 => b[0] = a[1],
                3 => b = a,
                4 => b[0][2] = b[1][2],
                _ => {}
            }
            let near = nearest(&a, &b);
            let (least, upper) = (at_least(&near, &a, &b), libm::sqrt(near.square));
            let about = sampled(&a, &b);
            assert!(least <= upper + SLACK && upper <= about + 1e-12, "{case}: {least} {upper} {about}");
            assert!(about - upper < 2.0 * size * 1.5 / 24.0, "{case}: {upper} {about}");
            assert!(upper - least < 1e-9 || upper < 1e-9, "{case}: {least} {upper}");
            let points = [&a, &b].map(|t| t.map(|p| p));
            let of = |k: usize| -> Point {
                array(|axis| (0..3).map(|i| near.weights[k][i] * points[k][i][axis]).sum())
            };
            let way = minus(&of(1), &of(0));
            assert!(near.weights.iter().flatten().all(|w| (-1e-12..=1.0 + 1e-12).contains(w)));
            assert!(near.weights.iter().all(|w| (w.iter().sum::<f64>() - 1.0).abs() < 1e-12));
            assert!((libm::sqrt(dot(&way, &way)) - upper).abs() < 1e-12);
            if surely_cross(&a, &b, 1e-9) {
                crossing += 1;
                assert_eq!(upper, 0.0);
            }
        }
        assert!(crossing > 20);
    }
}
