//! The triangle nearest to a point, and the triangles that may be nearest to a point of a box.
//!
//! **The nearest triangle** is the one with the least *computed* distance; if several have it, the first. The
//! tree leaves out only triangles whose computed distance cannot be as small, so the answer is the same as
//! that of a linear search. Distances to vertices and edges are computed from these alone, in the order of
//! their vertex numbers. Therefore triangles that share a vertex or edge, and triangles with the same
//! corners, have equal distances, bit by bit.
//!
//! **Candidates in a box.** Let t be the triangle nearest to the box's centre. The distance to t is a convex
//! function of position, so its maximum over the box is at a corner; call it U. A triangle that is further
//! than U from the whole box is not nearest to any point of the box. Computed distances differ from true
//! distances, so U is enlarged by bounds of the difference:
//!
//! * The computed distance is at least the true distance less 8u (D + L), with u = 2^-53, D the distance to a
//!   corner of the triangle and L its longest edge, because it is the distance to a computed point of the
//!   triangle.
//! * It is at most the true distance plus 128u (D + L) L / h, with h the height on the longest edge: the
//!   computed foot of the perpendicular may lie that far from the true one. For slivers, where h is less than
//!   2^-10 L, the distances to the edges are used as well; they exceed the true distance by at most h.
//!
//! Lengths are in the scale of the tree's grid, in which the mesh has a half extent of 1/2 to 1.

use crate::lattice::Each;
use core::array::from_fn as array;

use alloc::vec::Vec;

use super::intersections::corners;
use super::signs::Point;
use super::tree::{Box3, LATER, Node, Place, Tree, WIDTH};
use super::triangle_mesh::TriangleMesh;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::lattice::{Bounds, Interval};
use crate::memory;

/// Twice the maximum error of a coordinate of a box in the tree: coordinates have 24 bits.
const BOX: f64 = 1.0 / (1 << 24) as f64;
/// Points further away than this, along an axis, are moved to this distance: 2^100.
const FAR: f64 = (1_u128 << 100) as f64;
/// Upper bound of rounding errors, relative to the lengths concerned: 2^-42, more than eight times the need.
const ROUNDING: f64 = 1.0 / (1_u64 << 42) as f64;

/// Squares of areas below this may have lost digits by underflow: their edges are below 2^-240.
const LOST: f64 = 1e-290;

/// A mesh with the tree of its triangles.
#[derive(Clone, Copy)]
pub(crate) struct TriangleTree<'m> {
    pub(super) mesh: &'m TriangleMesh,
    pub(super) tree: &'m Tree,
}

/// The point of a surface that is nearest to a given point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NearestPoint {
    pub triangle: u32,
    /// Weights of the triangle's corners; none is negative.
    pub weights: [f64; 3],
    /// The square of the computed distance, in the scale of the tree.
    pub square: f64,
    /// A lower bound of the distance to all triangles, in the scale of the tree.
    lower: f64,
}

/// A visitor of the triangles that may be nearest.
pub(crate) trait NearVisitor {
    /// Returns whether the triangles of a node shall be visited one by one. If `all`, each of them may be
    /// nearest, or is hardly further away.
    fn enter(&mut self, node: usize, all: bool) -> bool;

    /// Returns whether a triangle shall be visited, if it may be nearest.
    fn wants(&self, triangle: u32) -> bool;

    /// Visits a triangle that may be nearest.
    fn visit(&mut self, triangle: u32);
}

impl TriangleMesh {
    /// Returns the mesh with the tree of its triangles. The first call builds the tree: O(t log t).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub(crate) fn triangle_tree(&self, control: &Control<'_>) -> Result<TriangleTree<'_>, Error> {
        Ok(TriangleTree { mesh: self, tree: self.tree(control)? })
    }

    /// Returns the mesh with the tree, if the tree exists already.
    pub(crate) fn known_triangle_tree(&self) -> Option<TriangleTree<'_>> {
        Some(TriangleTree { mesh: self, tree: self.known_tree()? })
    }
}

impl TriangleTree<'_> {
    /// Returns a summary of all triangles of each node. `none` is the summary of no triangle, `of` returns
    /// that of one, and `join` combines two.
    pub(crate) fn summaries<T: Copy>(
        &self,
        none: T,
        of: &impl Fn(u32) -> T,
        join: &impl Fn(T, T) -> T,
    ) -> Result<Vec<T>, Error> {
        let tree = self.tree;
        let mut summaries = memory::filled(tree.count(), none)?;
        if let Some(root) = tree.root() {
            self.summarise(root, &mut summaries, of, join);
        }
        Ok(summaries)
    }

    /// Summarises a node. The recursion is as deep as the tree.
    fn summarise<T: Copy>(
        &self,
        place: Place,
        summaries: &mut [T],
        of: &impl Fn(u32) -> T,
        join: &impl Fn(T, T) -> T,
    ) {
        let index = self.tree.index(place);
        for k in 0..self.tree.parts(place) {
            let part = if place.level > 0 {
                self.summarise(place.child(k), summaries, of, join);
                Some(summaries[self.tree.index(place.child(k))])
            } else {
                self.tree.triangle(place, k).map(of)
            };
            if let Some(part) = part {
                summaries[index] = join(summaries[index], part);
            }
        }
    }

    /// Returns the nearest point of the mesh; `None` if the mesh has no triangle, or the point is not finite.
    /// `hint` is a triangle that may be near; it saves time. Usually O(log t).
    pub(crate) fn nearest(&self, point: &Point, hint: Option<u32>) -> Option<NearestPoint> {
        self.search(point, hint, |_| true, false)
    }

    /// Returns the nearest point of the triangles that are `wanted`, and certified bounds of its distance in
    /// model units. `None` in the cases of [`nearest`](Self::nearest), for points further away than 2^99
    /// times the mesh's extent, and if no triangle is wanted.
    pub(crate) fn nearest_of(
        &self,
        point: &Point,
        wanted: impl Fn(u32) -> bool,
    ) -> Option<(NearestPoint, Interval)> {
        self.nearest_beside(point, None, wanted)
    }

    /// Does the same with a hint: a triangle that may be near, which saves time.
    pub(crate) fn nearest_beside(
        &self,
        point: &Point,
        hint: Option<u32>,
        wanted: impl Fn(u32) -> bool,
    ) -> Option<(NearestPoint, Interval)> {
        let grid = &self.tree.grid;
        let scaled = grid.scaled(point);
        if !scaled.iter().all(|x| x.abs() < FAR / 2.0) {
            return None;
        }
        let found = self.search(point, hint, wanted, true)?;
        let corners = Corners::of(self.mesh, found.triangle, grid.scale());
        let distance = sqrt(found.square);
        // The computed point of the triangle is at most this far away.
        let upper = distance + corners.excess(distance);
        let exactly = Interval::exactly;
        let bounds = Interval::new(found.lower.max(0.0).min(distance), upper.max(distance))?;
        Some((found, bounds.over(exactly(grid.scale()))))
    }

    /// Returns a close upper bound of the distance between a point and a triangle, in model units.
    pub(crate) fn most_from(&self, triangle: u32, point: &Point) -> f64 {
        let scale = self.tree.grid.scale();
        let shape = Corners::of(self.mesh, triangle, scale);
        let distance = sqrt(shape.nearest_to(&shape.from(point)).0);
        // (The scale is a power of two.)
        (distance + shape.excess(distance)) / scale
    }

    /// Returns the point of a triangle that is nearest to a given point, up to rounding.
    pub(crate) fn nearest_to(&self, triangle: u32, point: &Point) -> Point {
        let shape = Corners::of(self.mesh, triangle, self.tree.grid.scale());
        let (square, weights) = shape.nearest_to(&shape.from(point));
        self.point_of(&NearestPoint { triangle, weights, square, lower: 0.0 })
    }

    /// Returns the point with these weights, up to rounding.
    pub(crate) fn point_of(&self, near: &NearestPoint) -> Point {
        let corners =
            self.mesh.triangles()[near.triangle as usize].each(|v| self.mesh.vertices()[v as usize]);
        array(|axis| (0..3).map(|k| near.weights[k] * corners[k][axis]).sum())
    }

    fn search(
        &self,
        point: &Point,
        hint: Option<u32>,
        wanted: impl Fn(u32) -> bool,
        is_certified: bool,
    ) -> Option<NearestPoint> {
        let &TriangleTree { mesh, tree } = self;
        if !point.iter().all(|x| x.is_finite()) {
            return None;
        }
        let limit = FAR / tree.grid.scale();
        let point = array(|axis| {
            let centre = tree.grid.centre[axis];
            point[axis].clamp(centre - limit, centre + limit)
        });
        let hint = hint.filter(|&triangle| (triangle as usize) < mesh.triangles().len());
        let scaled = tree.grid.scaled(&point);
        let mut search = Search {
            tree,
            mesh,
            point,
            scaled,
            single: Single::new(&scaled),
            // The mesh lies within 2 of the centre. (Sums of three vectors are at most three times as long as
            // the longest.)
            rounding: ROUNDING * 20.0 * (4.0 + dot(&scaled, &scaled)),
            wanted,
            is_certified,
            best: None,
            until: key(f32::MAX, LAST),
            lower: f64::INFINITY,
        };
        if let Some(triangle) = hint {
            search.look_at(triangle);
        }
        search.run();
        let lower = search.lower;
        search.best.map(|best| NearestPoint { lower: lower.min(sqrt(best.square)), ..best })
    }

    /// Visits every triangle that [`nearest`](Self::nearest) can return for a point of a closed box, and some
    /// others. Returns `false` if the box is so large or so far away that rounding hides the answer.
    pub(crate) fn visit_near(&self, bounds: &Bounds, visitor: &mut impl NearVisitor) -> bool {
        let &TriangleTree { mesh, tree } = self;
        let Some(root) = tree.root() else { return true };
        let grid = &tree.grid;
        let [low, high] = [&bounds.min, &bounds.max].each(|corner| grid.scaled(corner));
        if !low.iter().chain(&high).all(|x| x.abs() <= FAR / 1024.0) {
            return false;
        }
        let centre: Point = array(|axis| bounds.min[axis].midpoint(bounds.max[axis]));
        let Some(NearestPoint { triangle, .. }) = self.nearest(&centre, None) else { return true };
        let shape = Corners::of(mesh, triangle, grid.scale());
        let corner =
            |k: usize| array(|axis| if k >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] });
        let most = (0..8).fold(0.0, |most: f64, k| most.max(shape.nearest_to(&shape.from(&corner(k))).0));
        let most = sqrt(most);
        let reach = (most + shape.error(most)) * (1.0 + ROUNDING) + ROUNDING;
        let half: Point = array(|axis| {
            let half = (bounds.max[axis] - centre[axis]).max(centre[axis] - bounds.min[axis]);
            half * grid.scale()
        });
        let small = half[0].max(half[1]).max(half[2]) / 4.0;
        if visitor.enter(tree.index(root), false) {
            Near { tree, mesh, low, high, centre, half, reach, small }.descend(root, visitor);
        }
        true
    }
}

/// Returns the larger of two numbers, in one instruction.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A point in single precision, in the scale of the tree.
struct Single {
    at: [f32; 3],
    /// Maximum amount by which gaps to boxes are overestimated.
    slack: f32,
}

impl Single {
    /// Returns `None` for a point so far away that single precision is useless.
    fn new(scaled: &Point) -> Option<Single> {
        const FAR: f64 = 1024.0;
        let furthest = scaled.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        // Boxes and the point have errors of 2^-25 each, the gap a relative error of the same size.
        let slack = (furthest / f64::from(1 << 22)) as f32;
        (furthest < FAR).then(|| Single { at: scaled.each(|x| x as f32), slack })
    }

    #[inline(always)]
    fn bounds(&self, node: &Node) -> [f32; WIDTH] {
        let mut squares = [0.0; WIDTH];
        for axis in 0..3 {
            let ([low, high], at) = (&node.planes[axis], self.at[axis]);
            for k in 0..WIDTH {
                let gap = larger(larger(low[k] - at, at - high[k]) - self.slack, 0.0);
                squares[k] += gap * gap;
            }
        }
        squares.each(|square| square * (1.0 - 1.0 / (1 << 20) as f32))
    }
}

/// The largest number of single precision.
const LARGEST: f64 = f32::MAX as f64;

/// A search for the nearest triangle.
struct Search<'a, W> {
    tree: &'a Tree,
    mesh: &'a TriangleMesh,
    point: Point,
    /// The point in the scale of the tree, relative to the grid's centre.
    scaled: Point,
    /// The point in single precision, unless it is far away.
    single: Option<Single>,
    /// Upper bound of the rounding error in a product of sums of vectors to a triangle's corners, and in a
    /// squared distance.
    rounding: f64,
    wanted: W,
    /// Whether bounds of true distances are needed.
    is_certified: bool,
    best: Option<NearestPoint>,
    /// The least [`key`] of children to leave out: those no nearer than the best triangle, or the furthest
    /// ones.
    until: u32,
    /// A lower bound of the distances to the triangles that were visited; those left out are not nearer than
    /// the best.
    lower: f64,
}

impl<W: Fn(u32) -> bool> Search<'_, W> {
    /// Returns lower bounds of the squared computed distances to everything in the boxes of a node.
    #[inline(always)]
    fn bounds(&self, node: &Node) -> [f32; WIDTH] {
        match &self.single {
            Some(single) => single.bounds(node),
            None => self.bounds_from_afar(node),
        }
    }

    /// Does the same for a point far away.
    #[cold]
    fn bounds_from_afar(&self, node: &Node) -> [f32; WIDTH] {
        array(|k| {
            let part = node.part(k);
            let square = (0..3).fold(0.0, |sum, axis| {
                let (low, high) = (f64::from(part.low[axis]), f64::from(part.high[axis]));
                let gap = (low - self.scaled[axis]).max(self.scaled[axis] - high) - BOX;
                let gap = gap.max(0.0);
                sum + gap * gap
            });
            // The point's own rounding is relative to the distance. (A box at an infinite distance contains
            // nothing.)
            let square = square * (1.0 - 1.0 / (1 << 20) as f64);
            if square < f64::INFINITY { (square.min(LARGEST) as f32).next_down() } else { f32::INFINITY }
        })
    }

    /// Runs the search, nearer children first.
    fn run(&mut self) {
        // (Entries that are too far away are written as well, and then overwritten.)
        let mut later = [(0, Place { level: 0, number: 0 }); LATER + 1];
        let mut count = 0;
        let mut next = self.tree.root();
        while let Some(place) = next {
            let bounds = self.bounds(self.tree.node(place));
            // Without branches, which would be mispredicted; the nearest child last.
            let keys = descending(array(|k| key(bounds[k], k as u32)));
            if place.level == 0 {
                for key in keys.into_iter().rev() {
                    if key <= self.until
                        && let Some(triangle) = self.tree.triangle(place, part(key))
                    {
                        self.look_at(triangle);
                    }
                }
            } else {
                for key in keys {
                    later[count] = (key, place.child(part(key)));
                    count += usize::from(key <= self.until);
                }
            }
            next = loop {
                let Some(last) = count.checked_sub(1) else { return };
                count = last;
                let (key, place) = later[last];
                if key <= self.until {
                    break Some(place);
                }
            };
        }
    }

    #[inline]
    fn look_at(&mut self, triangle: u32) {
        if !(self.wanted)(triangle) {
            return;
        }
        let scale = self.tree.grid.scale();
        let from: [Point; 3] = corners(self.mesh, triangle)
            .each(|corner| array(|axis| (self.point[axis] - corner[axis]) * scale));
        if self.best.is_some_and(|best| is_beyond(&from, best.square, self.rounding)) {
            return;
        }
        let corners = Corners::of(self.mesh, triangle, scale);
        let (square, weights) = corners.nearest_to(&corners.corners.each(|corner| from[corner]));
        let is_better = |best: &NearestPoint| (square, triangle) < (best.square, best.triangle);
        if self.best.as_ref().is_none_or(is_better) {
            self.best = Some(NearestPoint { triangle, weights, square, lower: 0.0 });
            // (Rounded up.)
            let until = square * (1.0 + 1.0 / (1 << 20) as f64);
            self.until = key(until.min(LARGEST) as f32, LAST);
        }
        if self.is_certified {
            let distance = sqrt(square);
            self.lower = self.lower.min(distance - corners.error(distance));
        }
    }
}

/// The number of a node's last child.
const LAST: u32 = WIDTH as u32 - 1;

/// Packs a child of a node and a non-negative bound into one number, which sorts first by the bound, rounded
/// down, then by the child.
#[inline(always)]
fn key(bound: f32, part: u32) -> u32 {
    bound.to_bits() & !LAST | part
}

/// Returns the child of a key.
#[inline(always)]
fn part(key: u32) -> usize {
    (key & LAST) as usize
}

/// Sorts four numbers in descending order.
#[inline(always)]
fn descending(mut numbers: [u32; WIDTH]) -> [u32; WIDTH] {
    for [i, j] in [[0, 1], [2, 3], [0, 2], [1, 3], [1, 2]] {
        let (a, b) = (numbers[i], numbers[j]);
        (numbers[i], numbers[j]) = (a.max(b), a.min(b));
    }
    numbers
}

/// Returns whether a plane perpendicular to the vector to a triangle's centroid proves that the computed
/// distance is greater than the root of `square`. `from` holds the vectors from the corners to the point.
/// `rounding` is an upper bound of the rounding error of squared lengths.
#[inline(always)]
fn is_beyond(from: &[Point; 3], square: f64, rounding: f64) -> bool {
    let [a, b, c] = from;
    let way: Point = array(|axis| a[axis] + b[axis] + c[axis]);
    let length = dot(&way, &way);
    let nearest = dot(&way, a).min(dot(&way, b)).min(dot(&way, c));
    let nearest = nearest - rounding;
    nearest > 0.0 && nearest * nearest * (1.0 - 1e-9) > square * length
}

/// A triangle with its corners in ascending order of their vertices.
struct Corners {
    at: [Point; 3],
    /// The triangle's corner numbers in this order.
    corners: [usize; 3],
    scale: f64,
    /// The edges from the first corner to the second and to the third, and from the second to the third.
    edges: [Edge; 3],
    base: Base,
    /// The square of the product of base and height.
    area: f64,
}

impl Corners {
    #[inline(always)]
    fn of(mesh: &TriangleMesh, triangle: u32, scale: f64) -> Corners {
        let vertices = mesh.triangles()[triangle as usize];
        let mut corners = [0, 1, 2];
        for [a, b] in [[0, 1], [1, 2], [0, 1]] {
            if vertices[corners[a]] > vertices[corners[b]] {
                corners.swap(a, b);
            }
        }
        let at: [Point; 3] = corners.each(|corner| mesh.vertices()[vertices[corner] as usize]);
        let edges = EDGES.each(|[from, to]| {
            let way = array(|axis| (at[to][axis] - at[from][axis]) * scale);
            Edge { way, square: dot(&way, &way) }
        });
        let base = Base::of(&edges);
        let area = dot(&base.normal, &base.normal);
        Corners { at, corners, scale, edges, base, area }
    }

    /// Returns the vectors from the corners to a point.
    #[inline(always)]
    fn from(&self, point: &Point) -> [Point; 3] {
        self.at.each(|corner| array(|axis| (point[axis] - corner[axis]) * self.scale))
    }

    /// Returns the maximum by which the computed distance may exceed the true distance, for points with at
    /// most this computed distance, plus the maximum by which another computed distance may fall below its
    /// true one.
    #[inline(always)]
    fn error(&self, distance: f64) -> f64 {
        let (area, square) = (self.area, self.base.square);
        let length = sqrt(square);
        let height = sqrt(area) / length;
        let rounding = ROUNDING * (distance + 3.0 * length);
        let foot = rounding * length / height;
        // A minimum ignores NaN and infinity, which occur for heights that are lost.
        rounding + if is_plump(area, square) { foot } else { foot.min((2.0 * height).max(0.0)) }
    }

    /// Returns the maximum by which the computed distance may fall below the true distance to the triangle.
    fn excess(&self, distance: f64) -> f64 {
        ROUNDING * (distance + 3.0 * sqrt(self.base.square))
    }

    /// Returns the squared distance of a point, given the vectors from the corners to it, and the weights of
    /// the triangle's corners at the nearest point.
    #[inline(always)]
    fn nearest_to(&self, from: &[Point; 3]) -> (f64, [f64; 3]) {
        let Corners { edges, area, .. } = *self;
        let Base { corners: [start, end, apex], way: base, square: length, side, normal } = self.base;
        let mut best = (f64::INFINITY, [1.0, 0.0, 0.0]);
        if area > LOST {
            let offset = &from[start];
            let up = dot(&cross(&base, offset), &normal) / area;
            let along = (dot(offset, &base) - up * dot(&side, &base)) / length;
            let rest = 1.0 - along - up;
            if up >= 0.0 && along >= 0.0 && rest >= 0.0 {
                let way: Point = array(|axis| offset[axis] - along * base[axis] - up * side[axis]);
                let mut weights = [0.0; 3];
                (weights[start], weights[end], weights[apex]) = (rest, along, up);
                best = (dot(&way, &way), weights);
                if is_plump(area, length) {
                    return (best.0, self.in_order(best.1));
                }
            }
        }
        for ([a, b], Edge { way: edge, square }) in EDGES.into_iter().zip(&edges) {
            let along = dot(&from[a], edge) / square;
            let (square, along) = if along >= 1.0 {
                (dot(&from[b], &from[b]), 1.0)
            } else if along > 0.0 {
                let way: Point = array(|axis| from[a][axis] - along * edge[axis]);
                (dot(&way, &way), along)
            } else {
                // Also if it is NaN, because the length of the edge is lost.
                (dot(&from[a], &from[a]), 0.0)
            };
            if square < best.0 {
                let mut weights = [0.0; 3];
                (weights[a], weights[b]) = (1.0 - along, along);
                best = (square, weights);
            }
        }
        (best.0, self.in_order(best.1))
    }

    /// Reorders weights of these corners to the triangle's own corner order.
    #[inline(always)]
    fn in_order(&self, weights: [f64; 3]) -> [f64; 3] {
        let mut ordered = [0.0; 3];
        for (corner, weight) in self.corners.into_iter().zip(weights) {
            ordered[corner] = weight;
        }
        ordered
    }
}

/// The corners of the edges of a triangle.
const EDGES: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

/// The vector from one corner to another, and the square of its length.
#[derive(Clone, Copy)]
struct Edge {
    way: Point,
    square: f64,
}

/// The longest edge of a triangle; if several are equal, the first.
#[derive(Clone, Copy)]
struct Base {
    /// Its start, its end, and the opposite corner.
    corners: [usize; 3],
    way: Point,
    square: f64,
    /// The vector from the start to the third corner.
    side: Point,
    /// The cross product of the vectors along the edge and the side.
    normal: Point,
}

impl Base {
    #[inline(always)]
    fn of([ab, ac, bc]: &[Edge; 3]) -> Base {
        let (corners, Edge { way, square }, side) = if bc.square > ab.square && bc.square > ac.square {
            ([1, 2, 0], *bc, ab.way.each(|x| -x))
        } else if ac.square > ab.square {
            ([0, 2, 1], *ac, ab.way)
        } else {
            ([0, 1, 2], *ab, ac.way)
        };
        Base { corners, way, square, side, normal: cross(&way, &side) }
    }
}

/// A box, and the distance from it within which triangles may be nearest to a point of it.
struct Near<'a> {
    tree: &'a Tree,
    mesh: &'a TriangleMesh,
    /// Corners of the box in the scale of the tree, relative to the grid's centre.
    low: Point,
    high: Point,
    /// The middle of the box, in model units.
    centre: Point,
    /// Half the edges, in the scale of the tree.
    half: Point,
    reach: f64,
    /// Nodes with edges of at most this length are accepted as a whole.
    small: f64,
}

impl Near<'_> {
    /// Visits the candidates in a node that was entered. The recursion is as deep as the tree.
    fn descend(&self, place: Place, visitor: &mut impl NearVisitor) {
        let node = self.tree.node(place);
        for k in 0..self.tree.parts(place) {
            let around = node.part(k);
            let (nearest, furthest) = self.distances(&around);
            if nearest > self.reach {
                continue;
            }
            if place.level > 0 {
                let child = place.child(k);
                let is_small =
                    (0..3).all(|axis| f64::from(around.high[axis] - around.low[axis]) <= self.small);
                if visitor.enter(self.tree.index(child), is_small || furthest <= self.reach) {
                    self.descend(child, visitor);
                }
            } else if let Some(triangle) = self.tree.triangle(place, k)
                && visitor.wants(triangle)
                && self.may_reach(triangle)
            {
                visitor.visit(triangle);
            }
        }
    }

    /// Returns bounds of the distances between points of a box and this box.
    fn distances(&self, around: &Box3) -> (f64, f64) {
        let (mut nearest, mut furthest) = (0.0, 0.0);
        for axis in 0..3 {
            let (low, high) = (f64::from(around.low[axis]), f64::from(around.high[axis]));
            let gap = ((low - self.high[axis]).max(self.low[axis] - high) - BOX).max(0.0);
            let beyond = ((self.low[axis] - low).max(high - self.high[axis]) + BOX).max(0.0);
            nearest += gap * gap;
            furthest += beyond * beyond;
        }
        (sqrt(nearest) * (1.0 - 1e-6), sqrt(furthest) * (1.0 + 1e-6))
    }

    /// Returns whether a triangle may be within reach. It is not if a plane separates it from the box. Two
    /// planes are tried, perpendicular to the vectors from the box's centre to the triangle's centroid and to
    /// its nearest point.
    fn may_reach(&self, triangle: u32) -> bool {
        let corners = Corners::of(self.mesh, triangle, self.tree.grid.scale());
        let from = corners.from(&self.centre);
        let [a, b, c] = &from;
        let most = sqrt(dot(a, a).max(dot(b, b)).max(dot(c, c)));
        let rounding = ROUNDING * (most + self.half[0] + self.half[1] + self.half[2]);
        let is_beyond = |way: Point| {
            let nearest = dot(&way, a).min(dot(&way, b)).min(dot(&way, c));
            let corner: f64 = (0..3).map(|axis| way[axis].abs() * self.half[axis]).sum();
            // False if the vector has no length.
            (nearest - corner) / sqrt(dot(&way, &way)) - rounding > self.reach
        };
        if is_beyond(array(|axis| a[axis] + b[axis] + c[axis])) {
            return false;
        }
        let (_, weights) = corners.nearest_to(&from);
        let [u, v, w] = corners.corners.each(|corner| weights[corner]);
        !is_beyond(array(|axis| u * a[axis] + v * b[axis] + w * c[axis]))
    }
}

/// Returns whether the edges of a triangle may be skipped: its height is at least 2^-10 of the base. `area`
/// is the square of the product of height and base, `square` that of the base.
#[inline(always)]
fn is_plump(area: f64, square: f64) -> bool {
    area > LOST && area * (1 << 20) as f64 >= square * square
}

#[inline(always)]
fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: &Point, b: &Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;
    use leafless_testkit::Random;

    fn any_point(random: &mut Random, size: f64) -> Point {
        array(|_| random.between(-0.5 * size, 0.5 * size))
    }

    /// Small triangles, large ones, slivers, needles, triangles without area, and some twice.
    fn soup(random: &mut Random, count: usize, scale: f64) -> TriangleMesh {
        let mut vertices: Vec<Point> = Vec::new();
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        while triangles.len() < count {
            let first = vertices.len() as u32;
            if random.index(4) == 0 && !triangles.is_empty() {
                let [a, b, c] = triangles[random.index(triangles.len())];
                triangles.push([[a, b, c], [b, c, a], [c, b, a]][random.index(3)]);
                continue;
            }
            let at = any_point(random, 1.0);
            let size = [1.0, 0.1, 0.01][random.index(3)];
            let corners: [Point; 3] = array(|_| {
                let way = any_point(random, size);
                array(|axis| at[axis] + way[axis])
            });
            let thin = [1.0, 1e-3, 1e-6, 1e-9, 1e-15, 0.0][random.index(6)];
            let [a, b, c] = corners;
            let along = random.between(-0.25, 1.25);
            let apex = array(|axis| a[axis] + along * (b[axis] - a[axis]) + thin * (c[axis] - a[axis]));
            vertices.extend([a, b, apex].map(|corner| corner.map(|x| x * scale)));
            triangles.push([first, first + 1, first + 2]);
            if random.index(3) == 0 {
                // A neighbour.
                vertices.push(any_point(random, 1.0).map(|x| x * scale));
                triangles.push([first + 1, first, first + 3]);
            }
        }
        TriangleMesh::new(vertices, triangles).unwrap()
    }

    fn square(tree: &TriangleTree<'_>, triangle: u32, point: &Point) -> f64 {
        let corners = Corners::of(tree.mesh, triangle, tree.tree.grid.scale());
        corners.nearest_to(&corners.from(point)).0
    }

    fn slow(tree: &TriangleTree<'_>, point: &Point) -> (f64, u32) {
        let of = |t: u32| (square(tree, t, point), t);
        (0..tree.mesh.triangles().len() as u32).map(of).min_by(|a, b| a.partial_cmp(b).unwrap()).unwrap()
    }

    #[test]
    fn a_look_at_all_triangles_agrees() {
        let mut random = Random(1);
        for scale in [1.0, 1e-70, 3e60] {
            for count in [1, 2, 9, 60, 500] {
                let mesh = soup(&mut random, count, scale);
                let tree = mesh.triangle_tree(&Control::default()).unwrap();
                let mut hint = None;
                for k in 0..200 {
                    let mut point = any_point(&mut random, [1.0, 3.0, 1e9][k % 3]).map(|x| x * scale);
                    if k % 5 == 0 {
                        // On the surface: at a corner, or the middle of an edge.
                        let [a, b, _] = mesh.triangles()[random.index(mesh.triangles().len())];
                        let [a, b] = [a, b].map(|v| mesh.vertices()[v as usize]);
                        point = if k % 2 == 0 { a } else { array(|axis| a[axis].midpoint(b[axis])) };
                    }
                    let found = tree.nearest(&point, hint).unwrap();
                    assert_eq!((found.square, found.triangle), slow(&tree, &point), "{point:?}");
                    assert!(found.weights.iter().all(|&w| w >= 0.0));
                    assert!((found.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
                    hint = Some(found.triangle);
                }
            }
        }
    }

    #[test]
    fn triangles_that_share_the_nearest_point_are_equally_near() {
        // A fan around a vertex, and the same triangles again with other first corners.
        let mut random = Random(7);
        let rim = (0..40).map(|_| any_point(&mut random, 2.0));
        let vertices: Vec<Point> = core::iter::once([0.0, 0.0, 3.0]).chain(rim).collect();
        let fan = (1..40).map(|k| [0, k, k + 1]);
        let mesh =
            TriangleMesh::new(vertices, fan.clone().chain(fan.map(|[a, b, c]| [b, c, a])).collect()).unwrap();
        let tree = mesh.triangle_tree(&Control::default()).unwrap();
        for _ in 0..1000 {
            let point = any_point(&mut random, 8.0);
            let found = tree.nearest(&point, None).unwrap();
            assert!(found.triangle < 39, "a later one is nearest");
            let square = |t: u32| square(&tree, t, &point);
            assert_eq!(square(found.triangle), square(found.triangle + 39));
            let zeros = found.weights.iter().filter(|&&w| w == 0.0).count();
            if zeros > 0 {
                // All that share the edge or vertex are at the same distance, so the first one was taken.
                let own = mesh.triangles()[found.triangle as usize];
                let used = |k: usize| found.weights[k] > 0.0;
                let shared: Vec<u32> = (0..3).filter(|&k| used(k)).map(|k| own[k]).collect();
                let first = mesh.triangles().iter().position(|t| shared.iter().all(|v| t.contains(v)));
                assert_eq!(first, Some(found.triangle as usize), "{point:?}");
            }
        }
    }

    #[test]
    fn the_ends_of_what_is_answered() {
        let triangle = |scale: f64| {
            let vertices = vec![[0.0; 3], [scale, 0.0, 0.0], [0.0, scale, 0.0]];
            TriangleMesh::new(vertices, vec![[0, 1, 2]]).unwrap()
        };
        for scale in [1.0, 1e77, 1e-77] {
            let mesh = triangle(scale);
            let tree = mesh.triangle_tree(&Control::default()).unwrap();
            for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert!(tree.nearest(&[0.0, x, 0.0], None).is_none());
            }
            for x in [f64::MAX, f64::MIN, f64::MIN_POSITIVE, 0.0] {
                let found = tree.nearest(&[x, -x, x], Some(9)).unwrap();
                assert!(found.weights.iter().all(|w| (0.0..=1.0).contains(w)), "{found:?}");
            }
        }
        let empty = TriangleMesh::new(vec![], vec![]).unwrap();
        assert!(empty.triangle_tree(&Control::default()).unwrap().nearest(&[0.0; 3], None).is_none());
    }

    #[test]
    fn whatever_is_nearest_in_a_box_is_visited() {
        struct Seen(Vec<bool>);
        impl NearVisitor for Seen {
            fn enter(&mut self, _: usize, _: bool) -> bool {
                true
            }
            fn wants(&self, _: u32) -> bool {
                true
            }
            fn visit(&mut self, triangle: u32) {
                self.0[triangle as usize] = true;
            }
        }
        let mut random = Random(3);
        for scale in [1.0, 1e-70, 3e60] {
            for round in 0..60 {
                let mesh = soup(&mut random, [3, 30, 300][round % 3], scale);
                let tree = mesh.triangle_tree(&Control::default()).unwrap();
                for k in 0..20 {
                    let size = [2.0, 0.3, 1e-2, 1e-5, 0.0][k % 5];
                    let mut centre = any_point(&mut random, [1.0, 2.0, 1e6][k % 3]);
                    if k % 2 == 0 {
                        let [a, _, _] = mesh.triangles()[random.index(mesh.triangles().len())];
                        centre = mesh.vertices()[a as usize].map(|x| x / scale);
                    }
                    let half = any_point(&mut random, size).map(f64::abs);
                    let min = array(|axis| (centre[axis] - half[axis]) * scale);
                    let max = array(|axis| (centre[axis] + half[axis]) * scale);
                    let mut seen = Seen(vec![false; mesh.triangles().len()]);
                    assert!(tree.visit_near(&Bounds { min, max }, &mut seen));
                    for sample in 0..100 {
                        let point = array(|axis| {
                            let at = random.unit();
                            let inside = min[axis] + at * (max[axis] - min[axis]);
                            let on = [min[axis], max[axis], inside][random.index(3)];
                            (if sample % 2 == 0 { inside } else { on }).clamp(min[axis], max[axis])
                        });
                        let found = tree.nearest(&point, None).unwrap();
                        assert!(seen.0[found.triangle as usize], "{point:?} in {min:?} {max:?}");
                    }
                }
            }
        }
    }
}
