//! Triangulation of polygons.
//!
//! A polygon is a closed walk of edges, its outer loop, and further loops around its holes. The boundary of
//! its triangles consists of exactly these edges. Polygons that share edges therefore still fit together
//! after triangulation, and every corner of the polygon stays a corner, even one that lies straight between
//! its neighbours. No vertex is added.
//!
//! The polygon is projected along the axis nearest to its normal. Leaving out a coordinate rounds nothing,
//! and all decisions in the plane are exact signs, so a triangulation is either right or refused. Most
//! polygons are convex, and become fans. All others get a constrained Delaunay triangulation (the crate
//! `spade`), whose triangles are classified by the winding number of the loops around them: 1 inside, 0
//! outside. Any other number, and any contradiction between the triangles and the loops, is a refusal.
//!
//! `spade` links the standard library through one of its dependencies, so this module needs the feature
//! `std`.

use crate::lattice::Each;
use alloc::vec::Vec;

use robust::{Coord, orient2d};
use spade::handles::{FixedFaceHandle, FixedVertexHandle, PossiblyOuterTag};
use spade::{ConstrainedDelaunayTriangulation, HierarchyHintGenerator, Point2, Triangulation};

use crate::error::Error;
use crate::lattice::exact::two_product;

/// Maximum bytes of a triangulation for each corner, in total. The library reserves and releases this amount
/// first, because the triangulating crate cannot report a shortage of memory.
const BYTES_PER_CORNER: usize = 320;

/// The reason why a polygon has no triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PolygonDefect {
    /// There is not enough memory.
    OutOfMemory,
    /// A corner is no vertex, a coordinate is not finite, or there is no loop.
    Input,
    /// The loops enclose no area.
    Flat,
    /// Two corners at different places coincide in the projection. Positions in the list of corners.
    Folded([usize; 2]),
    /// The edge that begins at this corner crosses another one.
    Crossing(usize),
    /// A corner lies within the edge that begins at this corner.
    Touching(usize),
    /// A part of the plane is enclosed more than once, or in the wrong direction: by a hole outside of the
    /// outer loop, around another hole, or in the same direction as the outer loop.
    Nesting,
}

/// Triangulates a polygon whose corners are `corners`; loop k is `corners[ends[k - 1]..ends[k]]`, and the
/// first loop is the outer one. Corners at one place count as one vertex. The triangles are added to
/// `triangles`. They turn counter-clockwise where the outer loop does.
///
/// The boundary of the triangles is the chain of the loops' edges. Edges that the loops use in both
/// directions, such as the bridge to a hole that is written as one loop, lie inside. On failure, nothing is
/// added.
///
/// O(n) for fans, O(n log n) expected otherwise; 5 µs a corner.
pub(crate) fn triangulate(
    vertices: &[[f64; 3]],
    corners: &[u32],
    ends: &[usize],
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), PolygonDefect> {
    let outer = ends.first().and_then(|&end| corners.get(..end)).ok_or(PolygonDefect::Input)?;
    if ends.last() != Some(&corners.len()) {
        return Err(PolygonDefect::Input);
    }
    let plane = Plane::of(vertices, outer)?;
    if ends.len() == 1 && fan(&plane, vertices, corners, triangles)? {
        return Ok(());
    }
    Arrangement::new(plane, vertices, corners, ends)?.triangles(triangles)
}

/// Triangulates a polygon of a mesh file, without holes, as [`triangulate`] does. If that is refused, makes a
/// fan around the first corner; its boundary is the same, but its triangles may overlap or leave the polygon.
/// Returns whether the result is a triangulation.
///
/// A loop of fewer than three corners adds nothing. Corners must be vertices.
///
/// # Errors
/// [`Error::OutOfMemory`].
#[allow(dead_code)]
pub(crate) fn triangulate_facet(
    vertices: &[[f64; 3]],
    corners: &[u32],
    triangles: &mut Vec<[u32; 3]>,
) -> Result<bool, Error> {
    if corners.len() > 3 {
        match triangulate(vertices, corners, &[corners.len()], triangles) {
            Ok(()) => return Ok(true),
            Err(PolygonDefect::OutOfMemory) => return Err(Error::OutOfMemory),
            Err(_) => {}
        }
    }
    let Some((&first, rest)) = corners.split_first() else { return Ok(true) };
    triangles.try_reserve(rest.len())?;
    triangles.extend(rest.windows(2).map(|pair| [first, pair[0], pair[1]]));
    Ok(corners.len() <= 3)
}

/// Makes the fan around the first corner, if it is surely a triangulation.
fn fan(
    plane: &Plane,
    vertices: &[[f64; 3]],
    corners: &[u32],
    triangles: &mut Vec<[u32; 3]>,
) -> Result<bool, PolygonDefect> {
    let at = |k: usize| plane.place(vertices, corners[k]);
    let (first, second) = (at(0)?, at(1)?);
    let mut previous = second;
    for k in 2..corners.len() {
        let next = at(k)?;
        // All triangles face up, and they follow each other within half a turn. Two triangles on a common
        // edge lie on its two sides because they face up.
        let within = k == 2 || corners.len() == 4 || turn(first, second, next) > 0.0;
        if !(within && turn(first, previous, next) > 0.0) {
            return Ok(false);
        }
        previous = next;
    }
    triangles.try_reserve(corners.len() - 2).map_err(|_| PolygonDefect::OutOfMemory)?;
    triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
    Ok(true)
}

/// Returns a number that is positive if three points turn counter-clockwise, negative if clockwise, zero on a
/// line: exactly.
fn turn([a, b]: [f64; 2], [c, d]: [f64; 2], [e, f]: [f64; 2]) -> f64 {
    orient2d(Coord { x: a, y: b }, Coord { x: c, y: d }, Coord { x: e, y: f })
}

/// The coordinate plane to which a polygon is projected, oriented so that its outer loop turns
/// counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Plane([usize; 2]);

impl Plane {
    fn of(vertices: &[[f64; 3]], outer: &[u32]) -> Result<Plane, PolygonDefect> {
        let normal = normal(vertices, outer).ok_or(PolygonDefect::Input)?;
        let axis =
            (1..3).fold(0, |most, axis| if normal[axis].abs() > normal[most].abs() { axis } else { most });
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        if normal[axis] > 0.0 {
            Ok(Plane([u, v]))
        } else if normal[axis] < 0.0 {
            Ok(Plane([v, u]))
        } else {
            Err(PolygonDefect::Flat)
        }
    }

    fn place(&self, vertices: &[[f64; 3]], vertex: u32) -> Result<[f64; 2], PolygonDefect> {
        let place = vertices.get(vertex as usize).map(|p| self.0.each(|axis| p[axis]));
        place.filter(|place| place.iter().all(|x| x.is_finite())).ok_or(PolygonDefect::Input)
    }
}

/// Returns twice the area of a loop, as a vector along its normal (Newell): rounded, from differences to the
/// first corner. `None` if a corner is no vertex or the result is not finite.
fn normal(vertices: &[[f64; 3]], corners: &[u32]) -> Option<[f64; 3]> {
    let origin = *vertices.get(*corners.first()? as usize)?;
    let from_origin = |corner: u32| {
        let p = vertices.get(corner as usize)?;
        Some([p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]])
    };
    let mut sum = [0.0; 3];
    let mut p = [0.0; 3];
    for &corner in &corners[1..] {
        let q = from_origin(corner)?;
        for axis in 0..3 {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            // Compensated products, so that the normal of a sliver is not lost in the errors of products that
            // cancel.
            let (left, left_error) = two_product(p[u], q[v]);
            let (right, right_error) = two_product(p[v], q[u]);
            sum[axis] += (left - right) + (left_error - right_error);
        }
        p = q;
    }
    sum.iter().all(|x| x.is_finite()).then_some(sum)
}

/// Returns the deviation of a face's corners from its plane, which is half the distance between the two
/// planes parallel to the face that enclose its corners, and the greatest distance of a corner from the first
/// one along an axis. The first loop gives the normal. `None` for a face without area.
pub(crate) fn flatness(vertices: &[[f64; 3]], outer: &[u32], corners: &[u32]) -> Option<(f64, f64)> {
    let normal = normal(vertices, outer)?;
    // Scale first, so that the square does not overflow.
    let most = normal.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if most == 0.0 {
        return None;
    }
    let normal = normal.each(|x| x / most);
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [mut low, mut high, mut extent] = [0.0; 3];
    let origin = vertices[corners[0] as usize];
    for &corner in corners {
        let p = vertices[corner as usize];
        let height = (0..3).map(|axis| normal[axis] / length * (p[axis] - origin[axis])).sum::<f64>();
        (low, high) = (height.min(low), height.max(high));
        extent = (0..3).fold(extent, |most: f64, axis| most.max((p[axis] - origin[axis]).abs()));
    }
    Some(((high - low) / 2.0, extent))
}

/// A triangulation of points in the plane. A hierarchy of coarser triangulations locates new points.
type Net = ConstrainedDelaunayTriangulation<Point2<f64>, (), (), (), HierarchyHintGenerator<f64>>;

/// Shuffles numbers. Inserting points in the order of a loop would cost quadratic time, because each one
/// would visit all triangles made so far.
fn shuffle(items: &mut [usize]) {
    let mut state = 1u64;
    for i in (1..items.len()).rev() {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        items.swap(i, (((state >> 32) * (i as u64 + 1)) >> 32) as usize);
    }
}

/// The loops as edges between points of the plane.
struct Arrangement<'a> {
    corners: &'a [u32],
    /// Places of the points, all different, in a shuffled order.
    places: Vec<[f64; 2]>,
    /// The position in `corners` of the first corner at each point.
    firsts: Vec<usize>,
    /// The edges of non-zero length: their points, and the position of their first corner.
    edges: Vec<([usize; 2], usize)>,
}

impl<'a> Arrangement<'a> {
    fn new(
        plane: Plane,
        vertices: &[[f64; 3]],
        corners: &'a [u32],
        ends: &[usize],
    ) -> Result<Arrangement<'a>, PolygonDefect> {
        let out_of_memory = |_| PolygonDefect::OutOfMemory;
        let count = corners.len();
        // Corners sorted by place; corners at one place stay in order.
        let mut sorted: Vec<([f64; 2], usize)> = Vec::new();
        sorted.try_reserve_exact(count).map_err(out_of_memory)?;
        for (k, &corner) in corners.iter().enumerate() {
            // Zeros of both signs are one place.
            sorted.push((plane.place(vertices, corner)?.each(|x| x + 0.0), k));
        }
        sorted.sort_unstable_by(|(a, i), (b, j)| {
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(i.cmp(j))
        });
        let mut first_of: Vec<usize> = Vec::new();
        first_of.try_reserve_exact(count).map_err(out_of_memory)?;
        first_of.resize(count, 0);
        for group in sorted.chunk_by(|(a, _), (b, _)| a == b) {
            let first = group[0].1;
            for &(_, k) in group {
                if vertices[corners[k] as usize] != vertices[corners[first] as usize] {
                    return Err(PolygonDefect::Folded([first, k]));
                }
                first_of[k] = first;
            }
        }
        let mut arrangement =
            Arrangement { corners, places: Vec::new(), firsts: Vec::new(), edges: Vec::new() };
        arrangement.places.try_reserve_exact(count).map_err(out_of_memory)?;
        arrangement.firsts.try_reserve_exact(count).map_err(out_of_memory)?;
        arrangement.edges.try_reserve_exact(count).map_err(out_of_memory)?;
        arrangement.firsts.extend((0..count).filter(|&k| first_of[k] == k));
        shuffle(&mut arrangement.firsts);
        for &k in &arrangement.firsts {
            arrangement.places.push(plane.place(vertices, corners[k])?.each(|x| x + 0.0));
        }
        let mut point_of: Vec<usize> = Vec::new();
        point_of.try_reserve_exact(count).map_err(out_of_memory)?;
        point_of.resize(count, 0);
        arrangement.firsts.iter().enumerate().for_each(|(point, &k)| point_of[k] = point);
        let mut start = 0;
        for &end in ends {
            if start >= end || end > count {
                return Err(PolygonDefect::Input);
            }
            for k in start..end {
                let next = if k + 1 < end { k + 1 } else { start };
                let edge = [k, next].each(|k| point_of[first_of[k]]);
                if edge[0] != edge[1] {
                    arrangement.edges.push((edge, k));
                }
            }
            start = end;
        }
        Ok(arrangement)
    }

    /// Adds the triangles with winding number 1.
    fn triangles(&self, triangles: &mut Vec<[u32; 3]>) -> Result<(), PolygonDefect> {
        let out_of_memory = |_| PolygonDefect::OutOfMemory;
        let points = self.places.len();
        let needed = points.checked_mul(BYTES_PER_CORNER).ok_or(PolygonDefect::OutOfMemory)?;
        Vec::<u8>::new().try_reserve_exact(needed).map_err(out_of_memory)?;

        let scale = self.scale();
        let scaled = self.places.iter().map(|place| {
            let [x, y] =
                place.each(|x| x * scale).each(|x| if x.abs() < spade::MIN_ALLOWED_VALUE { 0.0 } else { x });
            Point2::new(x, y)
        });
        let mut net = Net::with_capacity(points, 3 * points, 2 * points);
        for point in scaled {
            net.insert(point).map_err(|_| PolygonDefect::Input)?;
        }
        // If the scale has made coordinates equal, no triangulation is certain.
        if net.num_vertices() != points || net.num_inner_faces() == 0 {
            return Err(PolygonDefect::Flat);
        }
        let vertex = |point: usize| FixedVertexHandle::from_index(point);
        for &([from, to], corner) in &self.edges {
            match net.try_add_constraint(vertex(from), vertex(to)).len() {
                0 => return Err(PolygonDefect::Crossing(corner)),
                1 => {}
                _ => return Err(PolygonDefect::Touching(corner)),
            }
        }
        // Number of loop edges along each edge minus the number against it.
        let mut excess: Vec<i32> = Vec::new();
        excess.try_reserve_exact(net.num_undirected_edges()).map_err(out_of_memory)?;
        excess.resize(net.num_undirected_edges(), 0);
        for &([from, to], corner) in &self.edges {
            let edge = net.get_edge_from_neighbors(vertex(from), vertex(to));
            let edge = edge.ok_or(PolygonDefect::Touching(corner))?.fix();
            let forward = edge == edge.as_undirected().as_directed();
            excess[edge.as_undirected().index()] += if forward { 1 } else { -1 };
        }
        // Winding numbers spread from the outside; crossing an edge changes the number by the edge's excess.
        let mut windings: Vec<Option<i32>> = Vec::new();
        windings.try_reserve_exact(net.num_all_faces()).map_err(out_of_memory)?;
        windings.resize(net.num_all_faces(), None);
        let mut reached: Vec<FixedFaceHandle<PossiblyOuterTag>> = Vec::new();
        reached.try_reserve_exact(net.num_all_faces()).map_err(out_of_memory)?;
        let outer = net.outer_face().fix();
        windings[outer.index()] = Some(0);
        reached.push(outer);
        while let Some(face) = reached.pop() {
            let Some(winding) = windings[face.index()] else { continue };
            // The outer face has the hull's edges, the others three each.
            let mut visit = |edge: spade::handles::DirectedEdgeHandle<'_, _, _, _, _>| {
                let undirected = edge.fix().as_undirected();
                let excess = excess[undirected.index()];
                // The face lies to the left of its edge; to the left the winding number is higher by the
                // edge's excess.
                let across = winding - if edge.fix() == undirected.as_directed() { excess } else { -excess };
                let other = edge.rev().face().fix();
                match windings[other.index()] {
                    None => {
                        windings[other.index()] = Some(across);
                        reached.push(other);
                        Ok(())
                    }
                    Some(known) if known == across => Ok(()),
                    Some(_) => Err(PolygonDefect::Nesting),
                }
            };
            if face == outer {
                net.convex_hull().try_for_each(&mut visit)?;
            } else if let Some(inner) = net.face(face).as_inner() {
                inner.adjacent_edges().into_iter().try_for_each(&mut visit)?;
            }
        }
        let before = triangles.len();
        for face in net.inner_faces() {
            let points = face.vertices().each(|vertex| vertex.fix().index());
            let [a, b, c] = points.each(|point| self.places[point]);
            let refusal = match windings[face.adjacent_edges()[0].face().fix().index()] {
                Some(0) => continue,
                Some(1) if turn(a, b, c) > 0.0 => match triangles.try_reserve(1) {
                    Ok(()) => {
                        triangles.push(points.each(|point| self.corners[self.firsts[point]]));
                        continue;
                    }
                    Err(_) => PolygonDefect::OutOfMemory,
                },
                _ => PolygonDefect::Nesting,
            };
            triangles.truncate(before);
            return Err(refusal);
        }
        if triangles.len() > before { Ok(()) } else { Err(PolygonDefect::Flat) }
    }

    /// Returns a power of two that brings all coordinates into the range that can be triangulated, if there
    /// is one.
    fn scale(&self) -> f64 {
        let all = || self.places.iter().flatten().map(|x| x.abs()).filter(|&x| x > 0.0);
        let largest = all().fold(0.0, f64::max);
        if largest <= spade::MAX_ALLOWED_VALUE && all().all(|x| x >= spade::MIN_ALLOWED_VALUE) {
            return 1.0;
        }
        // 2^200 over the largest number's power of two. Exponents are biased by 1023.
        let exponent = (largest.to_bits() >> 52) as i64 - 1023;
        f64::from_bits(((200 - exponent + 1023).clamp(1, 2046) as u64) << 52)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::collections::BTreeMap;
    use alloc::vec;

    /// A generator of numbers below a bound.
    fn random(seed: u64) -> impl FnMut(u32) -> u32 {
        let mut state = seed;
        move |below| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((state >> 33) % u64::from(below)) as u32
        }
    }

    /// The number of uses of each pair of different places as an edge, minus the uses in the other direction.
    fn chain(vertices: &[[f64; 3]], edges: impl Iterator<Item = [u32; 2]>) -> BTreeMap<[[i64; 3]; 2], i32> {
        let place = |v: u32| vertices[v as usize].map(|x| (x * 1024.0) as i64);
        let mut chain = BTreeMap::new();
        for [a, b] in edges.map(|edge| edge.map(place)) {
            if a < b {
                *chain.entry([a, b]).or_insert(0) += 1;
            } else if b < a {
                *chain.entry([b, a]).or_insert(0) -= 1;
            }
        }
        chain.retain(|_, count| *count != 0);
        chain
    }

    fn loop_edges(corners: &[u32], ends: &[usize]) -> Vec<[u32; 2]> {
        let mut edges = vec![];
        let mut start = 0;
        for &end in ends {
            edges
                .extend((start..end).map(|k| [corners[k], corners[if k + 1 < end { k + 1 } else { start }]]));
            start = end;
        }
        edges
    }

    fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    /// Triangulates, and checks everything that a triangulation guarantees, for coordinates that are small
    /// integers.
    fn checked(vertices: &[[f64; 3]], loops: &[&[u32]]) -> Result<Vec<[u32; 3]>, PolygonDefect> {
        let corners = loops.concat();
        let ends: Vec<usize> = (1..=loops.len()).map(|k| loops[..k].iter().map(|l| l.len()).sum()).collect();
        // Existing triangles stay.
        let mut triangles = vec![[7, 8, 9]];
        let result = triangulate(vertices, &corners, &ends, &mut triangles);
        assert_eq!(triangles.remove(0), [7, 8, 9]);
        if let Err(defect) = result {
            assert_eq!(triangles, [[0; 3]; 0]);
            return Err(defect);
        }
        let edges = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let boundary = chain(vertices, edges);
        assert_eq!(boundary, chain(vertices, loop_edges(&corners, &ends).into_iter()), "{triangles:?}");
        // In the projection along the normal's axis, all turn the same way.
        let plane = Plane::of(vertices, loops[0]).unwrap();
        let flat = |v: u32| plane.place(vertices, v).unwrap();
        let areas = triangles.iter().map(|t| t.map(flat)).map(|[a, b, c]| cross(a, b, c));
        assert!(areas.clone().all(|area| area > 0.0), "{triangles:?}");
        let enclosed =
            loop_edges(&corners, &ends).into_iter().map(|[a, b]| cross([0.0; 2], flat(a), flat(b)));
        assert_eq!(areas.sum::<f64>(), enclosed.sum::<f64>(), "{triangles:?}");
        Ok(triangles)
    }

    fn flat(points: &[[i32; 2]]) -> Vec<[f64; 3]> {
        points.iter().map(|&[x, y]| [f64::from(x), f64::from(y), 5.0]).collect()
    }

    #[test]
    fn convex_polygons_are_fans() {
        let square = flat(&[[0, 0], [4, 0], [4, 4], [0, 4]]);
        assert_eq!(checked(&square, &[&[0, 1, 2, 3]]).unwrap(), [[0, 1, 2], [0, 2, 3]]);
        // From below, and from its other corners.
        assert_eq!(checked(&square, &[&[3, 2, 1, 0]]).unwrap(), [[3, 2, 1], [3, 1, 0]]);
        assert_eq!(checked(&square, &[&[2, 3, 0, 1]]).unwrap(), [[2, 3, 0], [2, 0, 1]]);
        // An arrow: the fan around the concave corner, or the other diagonal.
        let arrow = flat(&[[0, 0], [4, -2], [1, 0], [4, 2]]);
        assert_eq!(checked(&arrow, &[&[2, 3, 0, 1]]).unwrap(), [[2, 3, 0], [2, 0, 1]]);
        assert_eq!(checked(&arrow, &[&[0, 1, 2, 3]]).unwrap(), [[0, 1, 2], [0, 2, 3]]);
        let other = checked(&arrow, &[&[1, 2, 3, 0]]).unwrap();
        assert!(other.iter().all(|t| t.contains(&0) && t.contains(&2)), "{other:?}");
    }

    #[test]
    fn every_axis_and_side() {
        let points = [[0, 0], [6, 0], [6, 6], [4, 6], [4, 2], [2, 2], [2, 6], [0, 6]];
        for axis in 0..3 {
            for slope in [-1, 0, 1] {
                let vertices: Vec<[f64; 3]> = (points.iter())
                    .map(|&[u, v]| {
                        let mut p = [0.0; 3];
                        p[(axis + 1) % 3] = f64::from(u);
                        p[(axis + 2) % 3] = f64::from(v);
                        p[axis] = f64::from(slope * (u + 2 * v)) / 4.0;
                        p
                    })
                    .collect();
                let up: Vec<u32> = (0..8).collect();
                let down: Vec<u32> = (0..8).rev().collect();
                assert_eq!(checked(&vertices, &[&up]).unwrap().len(), 6);
                assert_eq!(checked(&vertices, &[&down]).unwrap().len(), 6);
            }
        }
    }

    #[test]
    fn corners_that_lie_straight_are_kept() {
        let points = flat(&[[0, 0], [1, 0], [2, 0], [3, 0], [3, 3], [2, 3], [1, 3], [0, 3], [0, 1]]);
        let corners: Vec<u32> = (0..9).collect();
        for turned in 0..9 {
            let corners: Vec<u32> = corners.iter().map(|&c| (c + turned) % 9).collect();
            let triangles = checked(&points, &[&corners]).unwrap();
            assert_eq!(triangles.len(), 7);
        }
        // A triangle with corners on all sides.
        let points = flat(&[[0, 0], [2, 0], [4, 0], [2, 2], [0, 4], [0, 2]]);
        assert_eq!(checked(&points, &[&[0, 1, 2, 3, 4, 5]]).unwrap().len(), 4);
    }

    #[test]
    fn holes() {
        let points = flat(&[
            [0, 0],
            [20, 0],
            [20, 10],
            [0, 10], // outside
            [2, 2],
            [2, 8],
            [8, 8],
            [8, 2], // a hole, clockwise
            [12, 2],
            [12, 8],
            [18, 5], // another one
        ]);
        let outer: &[u32] = &[0, 1, 2, 3];
        let (first, second): (&[u32], &[u32]) = (&[4, 5, 6, 7], &[8, 9, 10]);
        assert_eq!(checked(&points, &[outer, first]).unwrap().len(), 8);
        assert_eq!(checked(&points, &[outer, second, first]).unwrap().len(), 13);
        // One loop that walks to the hole and back.
        assert_eq!(checked(&points, &[&[0, 1, 2, 3, 0, 4, 5, 6, 7, 4]]).unwrap().len(), 8);
        // Holes that touch each other and the outside in corners.
        let points = flat(&[[0, 0], [9, 0], [9, 9], [0, 9], [3, 2], [5, 5], [6, 3], [7, 8]]);
        assert_eq!(checked(&points, &[&[0, 1, 2, 3], &[0, 5, 4], &[5, 7, 6]]).unwrap().len(), 8);
        // A hole that is written twice as a line encloses nothing, and its end is a vertex all the same.
        let slit = checked(&points, &[&[0, 1, 2, 3], &[4, 5]]).unwrap();
        assert!(slit.iter().flatten().any(|&v| v == 4) && slit.len() == 6);
    }

    #[test]
    fn what_is_no_polygon() {
        use PolygonDefect::*;
        let points = flat(&[[0, 0], [8, 0], [8, 8], [0, 8], [4, 0], [2, 2], [2, 6], [6, 6], [6, 2], [20, 4]]);
        let outer: &[u32] = &[0, 1, 2, 3];
        let defect = |loops: &[&[u32]]| checked(&points, loops).unwrap_err();
        assert_eq!(defect(&[&[0, 1, 3, 2, 9]]), Crossing(4));
        // An hour-glass of no area at all.
        assert_eq!(defect(&[&[0, 1, 3, 2]]), Flat);
        assert_eq!(defect(&[&[0, 4, 1]]), Flat);
        assert_eq!(defect(&[&[0, 1]]), Flat);
        assert_eq!(defect(&[&[0, 0, 0]]), Flat);
        // The hole's corner 4 lies within the outer loop's first edge.
        assert_eq!(defect(&[outer, &[4, 6, 7]]), Touching(0));
        // A hole in the same direction; outside; crossing the outer loop; equal to it.
        assert_eq!(defect(&[outer, &[5, 8, 7, 6]]), Nesting);
        assert_eq!(defect(&[&[5, 8, 7, 6], &[0, 3, 2, 1]]), Nesting);
        assert!(matches!(defect(&[outer, &[5, 6, 9]]), Crossing(_)));
        assert_eq!(defect(&[outer, &[3, 2, 1, 0]]), Flat);
        // Twice around.
        assert_eq!(defect(&[&[0, 1, 2, 3, 0, 1, 2, 3]]), Nesting);
        assert_eq!(defect(&[&[0, 1, 99]]), Input);
        assert_eq!(defect(&[outer, &[0, 99]]), Input);
        assert_eq!(defect(&[outer, &[]]), Input);
        assert_eq!(defect(&[&[]]), Input);
        assert_eq!(triangulate(&points, &[], &[], &mut vec![]), Err(Input));
        assert_eq!(triangulate(&points, &[0, 1, 2, 3], &[3], &mut vec![]), Err(Input));
        assert_eq!(triangulate(&points, &[0, 1, 2], &[4], &mut vec![]), Err(Input));
        // An edge that is perpendicular to the others.
        let mut folded = points.clone();
        folded[9] = [8.0, 8.0, 6.0];
        assert_eq!(checked(&folded, &[&[0, 1, 2, 9, 3]]).unwrap_err(), Folded([2, 3]));
        for bad in [f64::NAN, f64::INFINITY] {
            folded[2][0] = bad;
            assert_eq!(checked(&folded, &[outer]).unwrap_err(), Input);
        }
    }

    #[test]
    fn facets_of_files_are_never_refused() {
        let points = flat(&[[0, 0], [8, 0], [8, 8], [0, 8], [4, 3]]);
        let facet = |corners: &[u32]| {
            let mut triangles = vec![];
            let whole = triangulate_facet(&points, corners, &mut triangles).unwrap();
            (triangles, whole)
        };
        assert_eq!(facet(&[0, 1, 2]), (vec![[0, 1, 2]], true));
        assert_eq!(facet(&[0, 1, 2, 3]), (vec![[0, 1, 2], [0, 2, 3]], true));
        assert_eq!(facet(&[0, 1, 3, 2]), (vec![[0, 1, 3], [0, 3, 2]], false));
        let (concave, whole) = facet(&[1, 4, 2, 3, 0]);
        assert!(whole && concave.len() == 3 && concave.iter().all(|t| t.contains(&4)), "{concave:?}");
        for few in [&[][..], &[1], &[1, 2]] {
            assert_eq!(facet(few), (vec![], true));
        }
        // Corners twice in a row.
        assert_eq!(facet(&[0, 0, 1, 1, 2, 3]).0.len(), 2);
    }

    #[test]
    fn extreme_coordinates() {
        let shape = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [3.0, 1.0]];
        for scale in [crate::lattice::LARGEST / 4.0, crate::lattice::SMALLEST, 1e-60, 1e60] {
            let points = shape.map(|[x, y]| [x * scale, y * scale, 0.0]);
            let mut triangles = vec![];
            triangulate(&points, &[1, 2, 3, 0], &[4], &mut triangles).unwrap();
            assert_eq!(triangles.len(), 2);
            assert!(triangles.iter().all(|t| t.contains(&3)));
        }
        // The smallest differences decide.
        let up = 1f64.next_up();
        let points =
            [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 4.0, 0.0], [1.0, up, 0.0], [1.0, up.next_up(), 0.0]];
        let mut triangles = vec![];
        let crossed = triangulate(&points, &[0, 1, 2, 3, 4], &[5], &mut triangles);
        assert!(matches!(crossed, Err(PolygonDefect::Crossing(_))), "{crossed:?}");
        triangulate(&points, &[0, 1, 2, 4, 3], &[5], &mut triangles).unwrap();
        triangles.clear();
        triangulate(&points, &[0, 1, 2, 3], &[4], &mut triangles).unwrap();
        assert!(triangles.iter().all(|t| t.contains(&3)));
    }

    /// Returns whether the loops bound the region with winding number 1: no edges cross, no corner lies
    /// within an edge, and only the winding numbers 0 and 1 occur. Brute force, for small integers.
    fn is_polygon(points: &[[i32; 2]], loops: &[&[u32]]) -> bool {
        let cross = |a: [i32; 2], b: [i32; 2], c: [i32; 2]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let corners = loops.concat();
        let ends: Vec<usize> = (1..=loops.len()).map(|k| loops[..k].iter().map(|l| l.len()).sum()).collect();
        let edges: Vec<[[i32; 2]; 2]> =
            loop_edges(&corners, &ends).iter().map(|edge| edge.map(|v| points[v as usize])).collect();
        let area = |edges: &[[[i32; 2]; 2]]| edges.iter().map(|&[a, b]| cross([0; 2], a, b)).sum::<i32>();
        let side = area(&edges[..ends[0]]).signum();
        for &[a, b] in edges.iter().filter(|edge| edge[0] != edge[1]) {
            for &[c, d] in &edges {
                let within = |p: [i32; 2]| {
                    let along = |q: [i32; 2]| (q[0] - a[0]) * (b[0] - a[0]) + (q[1] - a[1]) * (b[1] - a[1]);
                    cross(a, b, p) == 0 && along(p) > 0 && along(p) < along(b)
                };
                let crossing = cross(a, b, c).signum() * cross(a, b, d).signum() < 0
                    && cross(c, d, a).signum() * cross(c, d, b).signum() < 0;
                if crossing || within(c) {
                    return false;
                }
            }
        }
        let mut found = false;
        for i in 0..(7 * 23) {
            for j in 0..(7 * 23) {
                let p = [f64::from(i) / 23.0 - 0.489, f64::from(j) / 23.0 - 0.487];
                let mut winding = 0;
                for &[a, b] in &edges {
                    let [a, b] = [a, b].map(|q| q.map(f64::from));
                    if (a[1] > p[1]) != (b[1] > p[1]) {
                        let right = super::tests::cross(a, b, p) * (b[1] - a[1]) > 0.0;
                        winding += if !right {
                            0
                        } else if b[1] > a[1] {
                            1
                        } else {
                            -1
                        };
                    }
                }
                match winding * side {
                    0 => {}
                    1 => found = true,
                    _ => return false,
                }
            }
        }
        found
    }

    #[test]
    fn random_loops_agree_with_the_definition() {
        let mut random = random(7);
        let (mut polygons, mut concave) = (0, 0);
        for round in 0..6_000 {
            let size = 3 + random(4) as i32;
            let count = 3 + random(6) as usize;
            let points: Vec<[i32; 2]> =
                (0..count).map(|_| [0; 2].map(|_: i32| random(size as u32) as i32)).collect();
            let all: Vec<u32> = (0..count as u32).collect();
            let (outer, inner) = all.split_at(if round % 3 == 0 && count > 6 { count - 3 } else { count });
            let loops: &[&[u32]] = if inner.is_empty() { &[outer] } else { &[outer, inner] };
            let space: Vec<[f64; 3]> = (points.iter())
                .map(|&[x, y]| match round % 4 {
                    0 => [x, y, 0],
                    1 => [y, 7, -x],
                    2 => [x + y, 2 * y + x, x - y],
                    _ => [-x, y, 3 * x - 2 * y],
                })
                .map(|p| p.map(f64::from))
                .collect();
            let result = checked(&space, loops);
            assert_eq!(result.is_ok(), is_polygon(&points, loops), "{points:?} {loops:?} {result:?}");
            polygons += u32::from(result.is_ok());
            concave += u32::from(result.is_ok() && count > 4);
        }
        assert!(polygons > 600 && concave > 60, "{polygons} {concave}");
    }

    #[test]
    fn large_polygons() {
        // A comb, and a ring whose two circles have many corners.
        for n in [10, 1000, 20_000] {
            let teeth = (0..n).flat_map(|i| [[4 * i, 0], [4 * i + 1, 50], [4 * i + 2, 50], [4 * i + 3, 1]]);
            let comb: Vec<[i32; 2]> = teeth.chain([[4 * n, -9], [0, -9]]).rev().collect();
            let corners: Vec<u32> = (0..comb.len() as u32).collect();
            assert_eq!(checked(&flat(&comb), &[&corners]).unwrap().len(), comb.len() - 2);

            let mut ring = vec![];
            for radius in [30_000.0, 20_000.0] {
                for i in 0..n {
                    // Half angles, because trigonometric functions need the standard library.
                    let t = (f64::from(i) + 0.5) / f64::from(n) * 4.0;
                    let (quarter, s) = (t as usize, t - f64::from(t as i32));
                    let (x, y) = ((1.0 - s * s) / (1.0 + s * s), 2.0 * s / (1.0 + s * s));
                    let [x, y] = [[x, y], [-y, x], [-x, -y], [y, -x]][quarter].map(|x| (x * radius) as i32);
                    ring.push([x, y]);
                }
            }
            let outer: Vec<u32> = (0..n as u32).collect();
            let inner: Vec<u32> = (n as u32..2 * n as u32).rev().collect();
            assert_eq!(checked(&flat(&ring), &[&outer, &inner]).unwrap().len(), 2 * n as usize);
        }
    }
}
