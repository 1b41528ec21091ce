//! The nearest points of two convex bodies that are given by their vertices, in plain doubles: nothing here
//! is proven.
//!
//! The method is by Gilbert, Johnson and Keerthi (1988). A simplex of differences of vertices moves towards
//! the origin. The nearest face of the simplex is found by testing all faces.

use crate::lattice::Each;

/// The maximal number of iterations. The search then returns its best points.
const TURNS: usize = 40;

/// The relative gap between both sides of the optimum at which the search ends.
const ENOUGH: f64 = 1e-15;

/// The nearest points of two bodies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near {
    /// A point of each body.
    pub(super) points: [[f64; 3]; 2],
    /// The second point minus the first, as the simplex has it: zero if the bodies meet.
    pub(super) way: [f64; 3],
}

/// A difference of two vertices, and the vertices.
#[derive(Clone, Copy)]
struct Corner {
    way: [f64; 3],
    ends: [[f64; 3]; 2],
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn plus(a: [f64; 3], scale: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vertex that is furthest along a direction.
fn furthest(body: &[[f64; 3]], direction: [f64; 3]) -> [f64; 3] {
    let mut best = (f64::NEG_INFINITY, [0.0; 3]);
    for &vertex in body {
        let along = dot(vertex, direction);
        if along > best.0 {
            best = (along, vertex);
        }
    }
    best.1
}

/// Returns the nearest points of the hulls of two nonempty sets of vertices, to rounding.
pub(super) fn nearest(a: &[[f64; 3]], b: &[[f64; 3]], towards: [f64; 3]) -> Near {
    let corner = |direction: [f64; 3]| {
        // The difference b − a that is furthest against the direction.
        let ends = [furthest(a, direction), furthest(b, direction.each(|c| -c))];
        Corner { way: minus(ends[1], ends[0]), ends }
    };
    let mut simplex = [corner(towards); 4];
    let mut count = 1;
    let mut weights = [1.0, 0.0, 0.0, 0.0];
    let mut way = simplex[0].way;
    for _ in 0..TURNS {
        let square = dot(way, way);
        if square == 0.0 {
            break;
        }
        let next = corner(way);
        // NaN is no gain.
        let gains = square - dot(way, next.way) > ENOUGH * square;
        if !gains || simplex[..count].iter().any(|known| known.way == next.way) {
            break;
        }
        simplex[count] = next;
        count += 1;
        let (found, nearer, left) = reduced(&mut simplex, count);
        let is_nearer = dot(nearer, nearer) < square;
        if !is_nearer {
            break;
        }
        (weights, way, count) = (found, nearer, left);
        if count == 4 {
            break;
        }
    }
    let mut points = [[0.0; 3]; 2];
    for (corner, weight) in simplex[..count].iter().zip(weights) {
        for (point, end) in points.iter_mut().zip(corner.ends) {
            *point = plus(*point, weight, end);
        }
    }
    Near { points, way }
}

/// Returns the point of a simplex that is nearest to the origin: its weights, the point, and the number of
/// remaining corners, which are moved to the front.
fn reduced(simplex: &mut [Corner; 4], count: usize) -> ([f64; 4], [f64; 3], usize) {
    let mut best = (f64::INFINITY, [0.0; 4], [0.0; 3], 1u32);
    for set in 1u32..1 << count {
        let mut of = [0; 4];
        let size = set.count_ones() as usize;
        (0..count).filter(|k| set >> k & 1 != 0).zip(&mut of).for_each(|(k, place)| *place = k);
        let ways = of.each(|k| simplex[k].way);
        let Some(weights) = weights(&ways, size) else { continue };
        let mut way = [0.0; 3];
        (0..size).for_each(|k| way = plus(way, weights[k], ways[k]));
        let square = if size == 4 { 0.0 } else { dot(way, way) };
        if square < best.0 {
            best = (square, weights, if size == 4 { [0.0; 3] } else { way }, set);
        }
    }
    let (_, weights, way, set) = best;
    let mut left = 0;
    for k in (0..count).filter(|k| set >> k & 1 != 0) {
        simplex[left] = simplex[k];
        left += 1;
    }
    (weights, way, left)
}

/// Returns the weights of the point nearest to the origin in the affine hull of some corners; `None` if the
/// point lies outside of the corners' convex hull.
fn weights(corners: &[[f64; 3]; 4], size: usize) -> Option<[f64; 4]> {
    let [p, q, r, s] = *corners;
    let found = match size {
        1 => [1.0, 0.0, 0.0, 0.0],
        2 => {
            let along = minus(q, p);
            let t = -dot(p, along) / dot(along, along);
            [1.0 - t, t, 0.0, 0.0]
        }
        3 => {
            let normal = cross(minus(q, p), minus(r, p));
            let square = dot(normal, normal);
            let share = |u: [f64; 3], v: [f64; 3]| dot(cross(u, v), normal) / square;
            [share(q, r), share(r, p), share(p, q), 0.0]
        }
        _ => {
            let volume = |u: [f64; 3], v: [f64; 3], w: [f64; 3]| dot(u, cross(v, w));
            let [a, b, c, d] = [volume(q, r, s), -volume(p, r, s), volume(p, q, s), -volume(p, q, r)];
            let all = a + b + c + d;
            [a / all, b / all, c / all, d / all]
        }
    };
    // (NaN is no weight.)
    found.iter().all(|&weight| weight >= 0.0).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(at: [f64; 3]) -> [[f64; 3]; 8] {
        core::array::from_fn(|k| {
            core::array::from_fn(|axis| at[axis] + if k >> axis & 1 == 0 { -1.0 } else { 1.0 })
        })
    }

    #[test]
    fn cubes_are_as_far_apart_as_their_nearest_corners() {
        for x in [-5.0, -2.0, -1.0, 0.0, 1.5, 2.0, 4.0] {
            for y in [-3.0, 0.25, 2.5] {
                for z in [0.0, -7.0, 2.125] {
                    let found = nearest(&cube([0.0; 3]), &cube([x, y, z]), [x, y, z]);
                    let gap = [x, y, z].map(|c: f64| (c.abs() - 2.0).max(0.0));
                    let truth = dot(gap, gap);
                    assert!((dot(found.way, found.way) - truth).abs() < 1e-12, "{x} {y} {z} {found:?}");
                    let between = minus(found.points[1], found.points[0]);
                    assert!((dot(between, between) - truth).abs() < 1e-12, "{x} {y} {z} {found:?}");
                }
            }
        }
    }
}
