//! Pairs of triangles that intersect.
//!
//! Two triangles of a surface may share a vertex or an edge. They *intersect* if they have any other common
//! point. All decisions are exact signs. Triangles without area are left out.
//!
//! Neighbouring triangles in one plane, or nearly so, are usually separated by a line or plane between them.
//! Exact signs would have to establish that determinants are zero, which is slow.

use super::self_pairs::self_pairs;
use super::signs::{Point, cross_sign, sure_volume_sign, volume_sign};
use super::tree::{Search, Steps};
use super::triangle_mesh::TriangleMesh;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sign;
use crate::memory;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// Two triangles with a common point that does not lie on a common vertex or edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntersectingPair {
    /// Indices of the triangles, ascending.
    pub triangles: [u32; 2],
    /// The least and the greatest coordinates of a box in which they meet, in model units: the overlap of the
    /// boxes around both triangles.
    pub bounds: ([f64; 3], [f64; 3]),
}

/// The pairs of intersecting triangles of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct IntersectingPairs {
    /// Number of pairs found.
    pub count: u64,
    /// True if these are all pairs. If false, the search was ended because too many triangles lie close to
    /// each other.
    pub is_complete: bool,
    /// The first pairs, in ascending order of triangles: at most as many as the caller requested.
    pub pairs: Vec<IntersectingPair>,
}

impl TriangleMesh {
    /// Returns the pairs of triangles with a common point that does not lie on a common vertex or edge: they
    /// cross, touch, or fold onto each other. The decision is exact. Triangles without area are left out.
    ///
    /// O(t log t) time for triangles that lie apart, also for many slivers with a common vertex. The mesh
    /// keeps a tree of 36 bytes a triangle. A search ends after 2^26 steps plus 512 a triangle;
    /// [`is_complete`](IntersectingPairs::is_complete) is then false. The result is deterministic.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] or [`Error::Cancelled`].
    ///
    /// ```
    /// use leafless::{Control, TriangleMesh};
    /// let vertices = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0.2, 0.2, -1.], [0.2, 0.2, 1.], [0.3, 0.2, 1.]];
    /// let mesh = TriangleMesh::new(vertices, vec![[0, 1, 2], [3, 4, 5]])?;
    /// let found = mesh.intersecting_pairs(10, &Control::default())?;
    /// assert_eq!((found.count, found.pairs[0].triangles), (1, [0, 1]));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn intersecting_pairs(
        &self,
        limit: usize,
        control: &Control<'_>,
    ) -> Result<IntersectingPairs, Error> {
        let mut found = Vec::new();
        let search = intersections(self, control, &mut |a, b| {
            memory::push(&mut found, [a, b])?;
            Ok(true)
        })?;
        let count = found.len() as u64;
        found.sort_unstable();
        found.truncate(limit);
        let pairs = memory::collected(found.iter().map(|&triangles| {
            let [a, b] = triangles.each(|t| corners(self, t));
            let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
            for axis in 0..3 {
                let [of_a, of_b] = [a, b].each(|corners| corners.each(|p| p[axis]));
                let ends = |[x, y, z]: [f64; 3]| [x.min(y).min(z), x.max(y).max(z)];
                let ([low_a, high_a], [low_b, high_b]) = (ends(of_a), ends(of_b));
                (low[axis], high[axis]) = (low_a.max(low_b), high_a.min(high_b));
            }
            IntersectingPair { triangles, bounds: (low, high) }
        }))?;
        Ok(IntersectingPairs { count, is_complete: search == Search::Finished, pairs })
    }
}

/// Calls `visit` with each pair of intersecting triangles, until it returns `false`.
pub(super) fn intersections(
    mesh: &TriangleMesh,
    control: &Control<'_>,
    visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
) -> Result<Search, Error> {
    let mut flat = memory::filled(mesh.triangles().len().div_ceil(64), 0u64)?;
    for (triangle, corners) in mesh.triangles().iter().enumerate() {
        flat[triangle / 64] |= u64::from(mesh.is_flat(corners)) << (triangle % 64);
    }
    let is_flat = |triangle: u32| flat[triangle as usize / 64] >> (triangle % 64) & 1 != 0;
    let mut steps = Steps((1 << 26) + 512 * mesh.triangles().len() as u64);
    let mut tests = 0u32;
    self_pairs(mesh, &is_flat, &mut steps, control, &mut |a, b| {
        tests = tests.wrapping_add(1);
        if tests.is_multiple_of(4096) {
            control.check()?;
        }
        if !is_flat(a) && !is_flat(b) && intersect(mesh, a, b) { visit(a, b) } else { Ok(true) }
    })
}

#[inline(always)]
pub(super) fn corners(mesh: &TriangleMesh, triangle: u32) -> [Point; 3] {
    mesh.triangles()[triangle as usize].each(|v| mesh.vertices()[v as usize])
}

/// Returns whether two triangles with area intersect.
fn intersect(mesh: &TriangleMesh, a: u32, b: u32) -> bool {
    let both = [a, b];
    let [of_a, of_b] = both.each(|t| mesh.triangles()[t as usize]);
    // For each corner of `b`, the corner of `a` that is the same vertex.
    let same: [Option<usize>; 3] = array(|k| of_a.iter().position(|&vertex| vertex == of_b[k]));
    let (a, b) = (corners(mesh, a), corners(mesh, b));
    let is_line_between = || is_line_between(mesh, both);
    match same {
        [None, None, None] => meet(&a, &b, is_line_between),
        [Some(i), None, None] => meet_beyond_vertex(&a, i, &b, 0, is_line_between),
        [None, Some(i), None] => meet_beyond_vertex(&a, i, &b, 1, is_line_between),
        [None, None, Some(i)] => meet_beyond_vertex(&a, i, &b, 2, is_line_between),
        [Some(i), Some(j), None] => fold(&a, 3 - i - j, &b[2], is_line_between),
        [Some(i), None, Some(j)] => fold(&a, 3 - i - j, &b[1], is_line_between),
        [None, Some(i), Some(j)] => fold(&a, 3 - i - j, &b[0], is_line_between),
        [Some(_), Some(_), Some(_)] => true,
    }
}

/// Upper bound of the rounding error of a sum of two or three products of differences, relative to the
/// magnitudes.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Returns whether two triangles surely share nothing but common vertices or a common edge, because a line
/// lies between them in an axis-parallel projection. The line runs along an edge, and at most common vertices
/// of the other triangle lie on it. Returns false if rounding may decide. (Most pairs never get here. This
/// function fetches its data again, so that those pairs do not carry it along.)
#[cold]
#[inline(never)]
fn is_line_between(mesh: &TriangleMesh, both: [u32; 2]) -> bool {
    let [of_a, of_b] = both.each(|t| mesh.triangles()[t as usize]);
    let (a, b) = (corners(mesh, both[0]), corners(mesh, both[1]));
    let [p, q, r] = &a;
    let [u, v]: [Point; 2] = [q, r].each(|x| array(|axis| x[axis] - p[axis]));
    let normal: Point = array(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        (u[i] * v[j] - u[j] * v[i]).abs()
    });
    // Project along the axis that shows the first triangle best.
    let axes = if normal[0] > normal[1] && normal[0] > normal[2] {
        [1, 2]
    } else if normal[1] > normal[2] {
        [2, 0]
    } else {
        [0, 1]
    };
    let [seen_a, seen_b] = [a, b].each(|corners| corners.each(|p| axes.each(|axis| p[axis])));
    let (a, b) = ((of_a, &seen_a), (of_b, &seen_b));
    is_edge_between(a, b) || is_edge_between(b, a)
}

/// Does the same with the lines along the first triangle's edges.
fn is_edge_between((of_a, a): ([u32; 3], &[[f64; 2]; 3]), (of_b, b): ([u32; 3], &[[f64; 2]; 3])) -> bool {
    (0..3).any(|k| {
        let [from, to, lone] = [k, (k + 1) % 3, (k + 2) % 3];
        let side = turn(&a[from], &a[to], &a[lone]);
        let is_on_edge = |vertex: u32| vertex == of_a[from] || vertex == of_a[to];
        side != 0 && (0..3).all(|n| is_on_edge(of_b[n]) || turn(&a[from], &a[to], &b[n]) == -side)
    })
}

/// Returns the side of the line through two points on which a third point lies; 0 if rounding may decide.
#[inline(always)]
fn turn(s: &[f64; 2], t: &[f64; 2], x: &[f64; 2]) -> i32 {
    let (left, right) = ((t[0] - s[0]) * (x[1] - s[1]), (t[1] - s[1]) * (x[0] - s[0]));
    let value = left - right;
    if value.abs() > ROUNDING * (left.abs() + right.abs()) { sign(value) } else { 0 }
}

/// Returns whether two cones at `v` surely have no common direction: the plane perpendicular to the vector
/// between their middles separates them. Returns false if rounding may decide.
#[cold]
fn is_plane_between(v: &Point, a: [&Point; 2], b: [&Point; 2]) -> bool {
    let [a, b]: [[Point; 2]; 2] = [a, b].each(|ends| ends.each(|p| array(|axis| p[axis] - v[axis])));
    let way: Point = array(|axis| (a[0][axis] + a[1][axis]) - (b[0][axis] + b[1][axis]));
    let is_ahead = |p: &Point, sign: f64| {
        let products: Point = array(|axis| way[axis] * p[axis]);
        let [x, y, z] = products.each(f64::abs);
        sign * (products[0] + products[1] + products[2]) > ROUNDING * (x + y + z)
    };
    a.iter().all(|p| is_ahead(p, 1.0)) && b.iter().all(|p| is_ahead(p, -1.0))
}

/// Returns whether two triangles with a common edge meet beyond it. `lone` is the corner of the first
/// triangle that is not on the edge, `p` the corresponding corner of the second.
fn fold(a: &[Point; 3], lone: usize, p: &Point, is_line_between: impl FnOnce() -> bool) -> bool {
    let [c, d, e] = array(|k| &a[(lone + k) % 3]);
    if sides([c, d, e], [p], is_line_between) != Some([0]) {
        return false;
    }
    // In one plane, they meet if both lie on the same side of the edge.
    let axis = axis_of(a);
    cross_sign([d, e], [d, c], axis) == cross_sign([d, e], [d, p], axis)
}

/// Returns the sides of the plane through three points on which other points lie. `None` if rounding may
/// decide and `are_apart` returns true for the triangles.
#[inline(always)]
fn sides<const N: usize>(
    [a, b, c]: [&Point; 3],
    points: [&Point; N],
    are_apart: impl FnOnce() -> bool,
) -> Option<[i32; N]> {
    let sure = points.map(|p| sure_volume_sign(a, b, c, p));
    if sure.contains(&None) && are_apart() {
        return None;
    }
    Some(array(|k| sure[k].unwrap_or_else(|| volume_sign(a, b, c, points[k]))))
}

/// Returns an axis along which the projection of the triangle has an area.
pub(super) fn axis_of([a, b, c]: &[Point; 3]) -> usize {
    (0..2).find(|&axis| cross_sign([a, b], [a, c], axis) != 0).unwrap_or(2)
}

/// Returns whether two triangles with a common vertex meet beyond it. The vertex is number `i` of the first
/// triangle and number `k` of the second.
///
/// At the vertex, each triangle begins as a cone between two edges. The triangles meet beyond the vertex if
/// and only if the cones have a common direction.
fn meet_beyond_vertex(
    a: &[Point; 3],
    i: usize,
    b: &[Point; 3],
    k: usize,
    is_line_between: impl FnOnce() -> bool,
) -> bool {
    let [v, p, q] = array(|n| &a[(i + n) % 3]);
    let [r, s] = array(|n| &b[(k + 1 + n) % 3]);
    // The sides of the first plane on which the second cone's edges lie, and the other way round.
    let are_apart = || is_plane_between(v, [p, q], [r, s]) || is_line_between();
    let Some(of_first) = sides([v, p, q], [r, s], are_apart) else { return false };
    if of_first[0] * of_first[1] > 0 {
        return false;
    }
    if of_first == [0, 0] {
        return cones_overlap(v, [p, q], [r, s], axis_of(a));
    }
    let of_second = [p, q].each(|x| volume_sign(v, r, s, x));
    if of_second[0] * of_second[1] > 0 {
        return false;
    }
    // The planes' common line has the direction
    // (p × q) × (r × s) = [p q s] r − [p q r] s = [p r s] q − [q r s] p.
    // The cones reach it in this direction or in the opposite one.
    let [pqr, pqs] = of_first;
    let [prs, qrs] = of_second;
    let way = |[first, second]: [i32; 2]| if first != 0 { first } else { second };
    way([pqs, -pqr]) == way([prs, -qrs])
}

/// Returns whether two cones at `v` in one plane, each less than a half plane, have a common direction.
fn cones_overlap(v: &Point, a: [&Point; 2], b: [&Point; 2], axis: usize) -> bool {
    let turn = |s: &Point, t: &Point| cross_sign([v, s], [v, t], axis);
    let within = |[s, t]: [&Point; 2], p: &Point| {
        let all = turn(s, t);
        turn(s, p) * all >= 0 && turn(p, t) * all >= 0
    };
    b.iter().any(|p| within(a, p)) || a.iter().any(|p| within(b, p))
}

/// Returns whether two triangles meet. If rounding may decide, `is_line_between` is called; it returns true
/// if they are surely apart.
pub(super) fn meet(a: &[Point; 3], b: &[Point; 3], is_line_between: impl FnOnce() -> bool) -> bool {
    let is_apart = |sides: [i32; 3]| sides[0] != 0 && sides == [sides[0]; 3];
    let Some(of_b) = sides(a.each_ref(), b.each_ref(), is_line_between) else { return false };
    if is_apart(of_b) {
        return false;
    }
    let of_a = a.each_ref().each(|p| volume_sign(&b[0], &b[1], &b[2], p));
    if is_apart(of_a) {
        return false;
    }
    // Then an edge of one meets the other triangle.
    edge_meets(a, b, of_b) || edge_meets(b, a, of_a)
}

/// Returns whether an edge of the second triangle meets the first triangle. `sides` are the sides of the
/// first triangle's plane on which the second triangle's corners lie.
fn edge_meets(triangle: &[Point; 3], edges: &[Point; 3], sides: [i32; 3]) -> bool {
    let [a, b, c] = triangle;
    (0..3).any(|k| {
        let next = (k + 1) % 3;
        let (p, q) = (&edges[k], &edges[next]);
        match sides[k] * sides[next] {
            1 => false,
            0 if sides[k] == 0 && sides[next] == 0 => meet_in_plane(triangle, p, q),
            _ => {
                // The line meets the plane in one point.
                let around = [[a, b], [b, c], [c, a]].each(|[s, t]| volume_sign(p, q, s, t));
                !(around.contains(&1) && around.contains(&-1))
            }
        }
    })
}

/// Returns whether a segment in the plane of a triangle meets the triangle.
fn meet_in_plane(triangle: &[Point; 3], p: &Point, q: &Point) -> bool {
    let axis = axis_of(triangle);
    let [a, b, c] = triangle;
    let edges = [[a, b], [b, c], [c, a]];
    let inner = cross_sign([a, b], [a, c], axis);
    let side = |[s, t]: [&Point; 2], x: &Point| cross_sign([s, t], [s, x], axis) * inner;
    let of_p = edges.each(|edge| side(edge, p));
    let of_q = edges.each(|edge| side(edge, q));
    if (0..3).any(|k| of_p[k] < 0 && of_q[k] < 0) {
        return false;
    }
    // No edge separates them. Neither does the segment's line if the corners lie on both sides of it.
    let of_corners = [a, b, c].each(|x| cross_sign([p, q], [p, x], axis));
    of_corners.contains(&0) || of_corners.contains(&1) && of_corners.contains(&-1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    /// All pairs, found one by one.
    fn slowly(mesh: &TriangleMesh) -> Vec<[u32; 2]> {
        let has_area = |t: &u32| !mesh.is_flat(&mesh.triangles()[*t as usize]);
        let all: Vec<u32> = (0..mesh.triangles().len() as u32).filter(has_area).collect();
        let pairs = all.iter().flat_map(|&a| all.iter().map(move |&b| [a, b]));
        pairs.filter(|&[a, b]| a < b && intersect(mesh, a, b)).collect()
    }

    fn quickly(mesh: &TriangleMesh) -> Vec<[u32; 2]> {
        let found = mesh.intersecting_pairs(usize::MAX, &Control::default()).unwrap();
        assert!(found.is_complete && found.count == found.pairs.len() as u64);
        found.pairs.iter().map(|pair| pair.triangles).collect()
    }

    /// A disc of slivers around one vertex, the cone below it, both, or the side of a prism, turned so that
    /// no sliver lies along an axis.
    fn slivers(count: u32, kind: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
        let rim = |k: u32| 2 + k % count;
        let mut vertices = vec![[0.0, 0.0, 0.0], [0.0, 0.0, -1.0]];
        let mut triangles = vec![];
        for k in 0..count {
            let angle = 2.0 * core::f64::consts::PI * f64::from(k) / f64::from(count);
            vertices.push([libm::cos(angle), libm::sin(angle), 0.0]);
            if kind != 1 {
                triangles.push([0, rim(k), rim(k + 1)]);
            }
            if kind == 1 || kind == 2 {
                triangles.push([1, rim(k + 1), rim(k)]);
            }
        }
        if kind == 3 {
            let above = |k: u32| 2 + count + k % count;
            for k in 0..count {
                let [x, y, _] = vertices[2 + k as usize];
                vertices.push([x, y, 3.0]);
                triangles.push([rim(k), rim(k + 1), above(k)]);
                triangles.push([rim(k + 1), above(k + 1), above(k)]);
            }
        }
        let turn = [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]];
        let turned = |p: &Point| turn.map(|row: Point| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
        (vertices.iter().map(turned).collect(), triangles)
    }

    /// The same with a needle through one sliver.
    fn pierced(count: u32, kind: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles) = slivers(count, kind);
        let own = triangles[triangles.len() / 3].map(|vertex| vertices[vertex as usize]);
        let middle: Point = array(|axis| (own[0][axis] + own[1][axis] + own[2][axis]) / 3.0);
        let [u, v]: [Point; 2] = [own[1], own[2]].map(|p| array(|axis| p[axis] - own[0][axis]));
        let normal: Point = array(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            (u[i] * v[j] - u[j] * v[i]) * 1e-2 * f64::from(count)
        });
        let first = vertices.len() as u32;
        let thin = 0.01 / f64::from(count);
        vertices.push(array(|axis| middle[axis] + normal[axis] / f64::from(count)));
        vertices.push(array(|axis| middle[axis] - normal[axis] / f64::from(count)));
        vertices.push([
            middle[0] + thin * normal[1],
            middle[1] + thin * normal[2],
            middle[2] - thin * normal[0],
        ]);
        triangles.push([first, first + 1, first + 2]);
        (vertices, triangles)
    }

    #[test]
    fn few_slivers_beside_all_pairs() {
        for count in [65, 70, 301] {
            for kind in 0..4 {
                for (vertices, triangles) in [slivers(count, kind), pierced(count, kind)] {
                    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
                    assert_eq!(quickly(&mesh), slowly(&mesh), "{count} {kind}");
                }
            }
        }
    }

    #[test]
    fn random_triangles_around_busy_vertices() {
        let mut state = 3u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        let mut met = 0;
        for round in 0..40 {
            // Coordinates with few steps, so that many points are collinear or coplanar.
            let steps = [2, 4, 1000][round % 3];
            let mut vertices: Vec<Point> =
                (0..3).map(|_| array(|_| random(steps) as f64 - (steps / 2) as f64)).collect();
            let mut triangles = vec![];
            for _ in 0..130 {
                let first = vertices.len() as u32;
                let (count, busy) = (1 + random(2) as u32, random(3) as u32);
                (0..2).for_each(|_| vertices.push(array(|_| random(steps) as f64 - (steps / 2) as f64)));
                triangles.push(match count {
                    1 => [busy, first, first + 1],
                    _ => [busy, (busy + 1) % 3, first],
                });
            }
            let Ok(mesh) = TriangleMesh::new(vertices, triangles) else { continue };
            let found = quickly(&mesh);
            met += found.len();
            assert_eq!(found, slowly(&mesh), "{round}");
        }
        assert!(met > 1000);
    }

    /// So many slivers that testing all pairs would take hours.
    #[test]
    fn many_slivers() {
        for kind in 0..4 {
            let count = if cfg!(debug_assertions) { 20_000 } else { 100_000 };
            let (vertices, triangles) = slivers(count, kind);
            let mesh = TriangleMesh::new(vertices, triangles).unwrap();
            let before = quickly(&mesh).len();
            let (vertices, triangles) = pierced(count, kind);
            let mesh = TriangleMesh::new(vertices, triangles).unwrap();
            let found = quickly(&mesh);
            assert!(found.len() > before, "{kind}: {} {before}", found.len());
        }
    }
}
