//! The triangles through which a half-line passes: the set is exact, the positions are exact to rounding.
//!
//! The half-line is shifted symbolically by (ε, ε², ε³), ε → 0, or with other signs into another octant, so
//! that it meets no edge of a triangle and begins on none. The triangles that it passes through therefore
//! determine the winding numbers along it, whatever it meets (simulation of simplicity: Edelsbrunner and
//! Mücke 1990, with one perturbation for all points). A triangle that the half-line itself meets, but the
//! shifted one does not, is *touched*.
//!
//! Let d be the line's direction, and p, q corners relative to the line's beginning. The sign of d · (p × q)
//! is the side on which the line passes an edge. The line passes through a triangle if the signs of its edges
//! agree. Doubles with an error bound decide nearly all signs, exact arithmetic on the original coordinates
//! the rest. (The watertight test of Woop, Benthin and Wald 2013 takes the same signs of rounded
//! coordinates.) If the surface may deviate from the mesh, no arithmetic decides cases that are too near.
//!
//! **The search.** The tree's boxes are tested in single precision. In the grid's coordinates the half-line
//! is clipped to the cube around the mesh, and begins there. Along each axis, the error of a point on it is
//! at most `slack`. The error has two causes: the beginning and the direction are rounded to 24 bits, where
//! the length is at most the width of the cube; and earlier rounding, which a beginning far away makes
//! larger. Boxes are enlarged by `slack` and by the maximum deviation of the surface from the mesh.

use crate::lattice::Each;
use core::array::from_fn as array;

use alloc::vec::Vec;

use super::intersections::{axis_of, corners};
use super::nearest::TriangleTree;
use super::signs::{Point, cross_sign, volume_sign};
use super::tree::{LATER, Node, Place, WIDTH};
use super::triangle_mesh::TriangleMesh;
use crate::error::Error;
use crate::lattice::exact::{Expansion, two_product};
use crate::lattice::{Interval, Ray};
use crate::memory;

/// Upper bound of the rounding error of a sum of products of three factors, each rounded, relative to the sum
/// of their magnitudes.
const ROUNDING: f64 = 12.0 * f64::EPSILON;

/// Maximum relative error of a time before exact arithmetic is used: the line lies nearly in the plane of a
/// triangle.
const FINE: f64 = 1.0 / (1u64 << 36) as f64;

/// Half width of the cube to which the half-line is clipped, in the scale of the grid.
const CUBE: f64 = 1.0 + 1.0 / 1024.0;

/// Error of positions in the cube in single precision: twice the bound derived at the top of this file.
const SINGLE: f64 = 1.0 / (1 << 20) as f64;

/// The same for the time at which a line reaches a plane, as a factor.
const TIMES: f32 = 1.0 + 1.0 / (1 << 20) as f32;

/// A triangle that a half-line meets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hit {
    /// The time of the crossing. If the line runs in the triangle's plane, an interval that contains the
    /// stay.
    pub t: Interval,
    /// The change of the winding number along the shifted half-line: −1 if it leaves through the triangle, 0
    /// if it only touches the triangle.
    pub step: i32,
    pub triangle: u32,
}

/// The triangles to find.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// All.
    All,
    /// The first triangle that the half-line passes through, and all that it meets no later. Others may be
    /// found, too.
    First,
}

/// The direction of the shift: (±ε, ±ε², ±ε³) with these signs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shift([i32; 3]);

impl Shift {
    /// Shifts into all octants, the default first.
    pub(crate) const ALL: [Shift; 8] = [
        Shift([1, 1, 1]),
        Shift([-1, -1, -1]),
        Shift([-1, 1, 1]),
        Shift([1, -1, -1]),
        Shift([1, -1, 1]),
        Shift([-1, 1, -1]),
        Shift([1, 1, -1]),
        Shift([-1, -1, 1]),
    ];

    /// Returns the side of a plane into which the shift leads: the sign of its product with the plane's
    /// normal. `normal` returns the signs of the normal's components.
    fn side(self, normal: impl Fn(usize) -> i32) -> i32 {
        (0..3).map(|axis| self.0[axis] * normal(axis)).find(|&sign| sign != 0).unwrap_or(0)
    }
}

impl TriangleTree<'_> {
    /// Finds the triangles that a ray, extended to infinity, meets, in no particular order. Returns `false`
    /// if the answer is uncertain, because the surface may deviate from the mesh and the ray comes near to an
    /// edge. Usually O(log t).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn pierced(
        &self,
        ray: &Ray,
        wanted: Wanted,
        shift: Shift,
        hits: &mut Vec<Hit>,
    ) -> Result<bool, Error> {
        hits.clear();
        let Some(cast) = Cast::new(self, ray) else { return Ok(true) };
        let line = Line::new(self.mesh, ray, shift);
        let (mut is_sure, mut kept) = (true, Ok(()));
        let mut until = f64::INFINITY;
        let mut meet = |triangle: u32| {
            match line.meets(triangle) {
                Met::No => {}
                Met::Unsure => is_sure = false,
                Met::At(hit) => {
                    if wanted == Wanted::First && hit.step != 0 {
                        until = until.min(hit.t.upper);
                    }
                    if kept.is_ok() {
                        kept = memory::push(hits, hit);
                    }
                }
            }
            until
        };
        match wanted {
            Wanted::All => self.tree.search(|node| cast.parts(node), &mut |triangle| {
                meet(triangle);
            }),
            Wanted::First => cast.nearest_first(self, &mut meet),
        }
        if wanted == Wanted::First {
            hits.retain(|hit| hit.t.lower <= until);
        }
        kept.map(|()| is_sure)
    }
}

impl TriangleTree<'_> {
    /// Returns the normal of a triangle; its length is twice the area.
    pub(crate) fn normal(&self, triangle: u32) -> Point {
        let [a, b, c] = corners(self.mesh, triangle);
        let [u, v]: [Point; 2] = [b, c].each(|p| array(|axis| p[axis] - a[axis]));
        array(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            u[i] * v[j] - u[j] * v[i]
        })
    }

    pub(crate) fn corners(&self, triangle: u32) -> [Point; 3] {
        corners(self.mesh, triangle)
    }

    /// Returns whether two triangles with area lie in one plane.
    pub(crate) fn are_coplanar(&self, one: u32, other: u32) -> bool {
        let [a, b, c] = corners(self.mesh, one);
        corners(self.mesh, other).iter().all(|p| volume_sign(&a, &b, &c, p) == 0)
    }

    /// Returns about half the mesh's extent, or up to twice as much.
    pub(crate) fn extent(&self) -> f64 {
        1.0 / self.tree.grid.scale()
    }

    /// Returns the maximum deviation of the surface from the mesh along an axis.
    pub(crate) fn displacement(&self) -> f64 {
        self.mesh.displacement()
    }

    /// Returns the maximum distance of the surface from the mesh.
    pub(crate) fn radius(&self) -> f64 {
        self.mesh.radius()
    }

    /// Returns the axis and the direction, up (1) or down (−1), along which a point leaves the box around the
    /// mesh soonest. `None` if the point surely lies outside.
    pub(crate) fn way_out(&self, point: &Point) -> Option<(usize, f64)> {
        let around = self.tree.around()?;
        let at = self.tree.grid.scaled(point);
        let beyond = SINGLE + self.displacement() * self.tree.grid.scale() * (1.0 + SINGLE);
        let mut best = (0, 0.0, f64::INFINITY);
        for axis in 0..3 {
            for (sign, plane) in [(1.0, around.high[axis]), (-1.0, around.low[axis])] {
                let way = sign * (f64::from(plane) - at[axis]);
                // (False for NaN.)
                let is_within = way >= -beyond;
                if !is_within {
                    return None;
                }
                if way < best.2 {
                    best = (axis, sign, way);
                }
            }
        }
        Some((best.0, best.1))
    }
}

/// A half-line in the cube around the mesh, in single precision.
struct Cast {
    /// The beginning, moved by the slack against the direction, and along it.
    near: [f32; 3],
    far: [f32; 3],
    /// The reciprocals of the direction's components, and whether they are negative.
    inverse: [f32; 3],
    is_down: [usize; 3],
    /// Its length, in units of the direction.
    length: f32,
    /// The ray's time at which it enters the cube, and the units here per unit of the ray.
    begins: f64,
    speed: f64,
}

impl Cast {
    /// Returns `None` if the half-line misses the cube.
    fn new(mesh: &TriangleTree<'_>, ray: &Ray) -> Option<Cast> {
        let grid = &mesh.tree.grid;
        mesh.tree.root()?;
        let scale = grid.scale();
        let from = grid.scaled(&ray.from);
        let way = ray.direction.each(|[high, _]| high);
        let speed = way.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let direction = way.each(|c| c / speed);
        let furthest = from.iter().fold(1.0, |most: f64, c| most.max(c.abs()));
        // The surface may deviate from the boxes by this much.
        let displacement = mesh.displacement() * scale * (1.0 + SINGLE);
        let slack = SINGLE + furthest * (1.0 / (1u64 << 48) as f64) + displacement;
        let (mut begins, mut ends) = (0.0, f64::INFINITY);
        let reach = CUBE + slack;
        for axis in 0..3 {
            let (at, along) = (from[axis], direction[axis]);
            if along == 0.0 {
                if at.abs() > reach {
                    return None;
                }
                continue;
            }
            let [one, other] = [(-reach - at) / along, (reach - at) / along];
            (begins, ends) = (one.min(other).max(begins), one.max(other).min(ends));
        }
        // (Rounding here moves points of the cube by less than the slack.)
        if begins > ends {
            return None;
        }
        /// A component of the direction that needs more than 2^60 units to cross the cube counts as zero.
        const LEAST: f32 = 1.0 / (1u64 << 60) as f32;
        let single = direction.each(|c| {
            let c = c as f32;
            if c.abs() < LEAST { LEAST.copysign(c) } else { c }
        });
        // (So far away the position in the cube is unknown: all boxes are met.)
        let is_lost = slack > 1e30;
        let slack = if is_lost { 1e36 } else { slack as f32 };
        let start: [f32; 3] =
            array(|axis| if is_lost { 0.0 } else { (from[axis] + begins * direction[axis]) as f32 });
        let back: [f32; 3] = single.each(|c| slack.copysign(c));
        Some(Cast {
            near: array(|axis| start[axis] + back[axis]),
            far: array(|axis| start[axis] - back[axis]),
            inverse: single.each(|c| 1.0 / c),
            is_down: single.each(|c| usize::from(c < 0.0)),
            length: ((ends - begins) * 1.001).min(1e30) as f32,
            begins,
            speed: speed * scale,
        })
    }

    /// Returns bounds of the times at which it enters and leaves the boxes of a node.
    #[inline(always)]
    fn stays(&self, node: &Node, until: f32) -> [[f32; WIDTH]; 2] {
        let mut enters = [0.0f32; WIDTH];
        let mut leaves = [until; WIDTH];
        for axis in 0..3 {
            let down = self.is_down[axis];
            let (near, far) = (&node.planes[axis][down], &node.planes[axis][1 - down]);
            for k in 0..WIDTH {
                let enter = (near[k] - self.near[axis]) * self.inverse[axis];
                let leave = (far[k] - self.far[axis]) * self.inverse[axis];
                enters[k] = if enter > enters[k] { enter } else { enters[k] };
                leaves[k] = if leave < leaves[k] { leave } else { leaves[k] };
            }
        }
        [enters, leaves.each(|leave| leave * TIMES)]
    }

    #[inline(always)]
    fn parts(&self, node: &Node) -> u32 {
        let [enters, leaves] = self.stays(node, self.length);
        (0..WIDTH).fold(0, |bits, k| bits | u32::from(enters[k] <= leaves[k]) << k)
    }

    /// Converts a time of the ray to an upper bound of the time here.
    fn at_most(&self, t: f64) -> f32 {
        let units = (t * self.speed - self.begins) * (1.0 + SINGLE) + SINGLE + self.begins * 1e-12;
        (units as f32).min(self.length)
    }

    /// Calls `meet` with the triangles whose boxes are met, roughly nearest first, up to the time that `meet`
    /// returns.
    #[inline(always)]
    fn nearest_first(&self, mesh: &TriangleTree<'_>, meet: &mut impl FnMut(u32) -> f64) {
        let tree = mesh.tree;
        let mut later = [(0.0f32, Place { level: 0, number: 0 }); LATER];
        let mut count = 0;
        let mut until = self.length;
        let mut next = tree.root();
        while let Some(place) = next {
            let [enters, leaves] = self.stays(tree.node(place), until);
            let mut parts = (0..WIDTH).fold(0, |bits, k| bits | u32::from(enters[k] <= leaves[k]) << k);
            if place.level == 0 {
                while parts != 0 {
                    let k = parts.trailing_zeros() as usize;
                    parts &= parts - 1;
                    if let Some(triangle) = tree.triangle(place, k) {
                        until = until.min(self.at_most(meet(triangle)));
                    }
                }
            } else {
                let first = count;
                while parts != 0 {
                    let k = parts.trailing_zeros() as usize;
                    parts &= parts - 1;
                    // The nearest last.
                    let mut at = count;
                    while at > first && later[at - 1].0 < enters[k] {
                        later[at] = later[at - 1];
                        at -= 1;
                    }
                    later[at] = (enters[k], place.child(k));
                    count += 1;
                }
            }
            next = loop {
                let Some(last) = count.checked_sub(1) else { return };
                count = last;
                let (enters, place) = later[last];
                if enters <= until * TIMES {
                    break Some(place);
                }
            };
        }
    }
}

/// The result of a line against a triangle.
enum Met {
    No,
    At(Hit),
    Unsure,
}

/// A half-line as given.
struct Line<'m> {
    mesh: &'m TriangleMesh,
    from: Point,
    direction: [[f64; 2]; 3],
    /// The direction, rounded.
    way: Point,
    /// The sum of the magnitudes of its components.
    size: f64,
    /// Maximum deviation of the surface from the mesh along an axis.
    displacement: f64,
    shift: Shift,
}

/// A triangle's corners relative to the line's beginning.
struct Seen {
    ends: [Point; 3],
    /// Their greatest magnitude, if it is needed.
    reach: f64,
}

impl<'m> Line<'m> {
    fn new(mesh: &'m TriangleMesh, ray: &Ray, shift: Shift) -> Line<'m> {
        let way = ray.direction.each(|[high, _]| high);
        let size = way.iter().map(|c| c.abs()).sum();
        let displacement = mesh.displacement();
        Line { mesh, from: ray.from, direction: ray.direction, way, size, displacement, shift }
    }

    fn meets(&self, triangle: u32) -> Met {
        let corners = corners(self.mesh, triangle);
        let ends: [Point; 3] = corners.each(|corner| array(|axis| corner[axis] - self.from[axis]));
        let mut reach = 0.0;
        if self.displacement > 0.0 {
            reach = ends.iter().flatten().fold(0.0, |most: f64, c| most.max(c.abs()));
        }
        let seen = Seen { ends, reach };
        let [a, b, c] = &seen.ends;
        let sides = [[a, b], [b, c], [c, a]].each(|[p, q]| self.side(&seen, p, q));
        let [Some(one), Some(two), Some(three)] = sides else {
            return if may_pass(sides) { self.closer(triangle, &corners, &seen, sides) } else { Met::No };
        };
        if one != two || two != three {
            return Met::No;
        }
        self.passed(triangle, &corners, &seen, -one)
    }

    /// Returns the side on which the line passes an edge, if it is certain.
    #[inline(always)]
    fn side(&self, seen: &Seen, p: &Point, q: &Point) -> Option<i32> {
        let (value, magnitude) = determinant(&self.way, p, q);
        let mut wrong = ROUNDING * magnitude;
        if self.displacement > 0.0 {
            wrong += 2.5 * self.size * self.displacement * (2.0 * seen.reach + self.displacement);
        }
        if value > wrong {
            Some(1)
        } else if value < -wrong {
            Some(-1)
        } else {
            None
        }
    }

    /// Does the same where doubles cannot decide.
    #[cold]
    fn closer(&self, triangle: u32, corners: &[Point; 3], seen: &Seen, sides: [Option<i32>; 3]) -> Met {
        if self.displacement > 0.0 {
            return Met::Unsure;
        }
        let own: [i32; 3] = array(|k| sides[k].unwrap_or_else(|| self.exact_side(corners, k)));
        if own.contains(&1) && own.contains(&-1) {
            return Met::No;
        }
        if own == [0; 3] {
            return self.along(triangle, corners);
        }
        let shifted: [i32; 3] = array(|k| if own[k] == 0 { self.shifted_side(corners, k) } else { own[k] });
        let step = if shifted == [shifted[0]; 3] { -shifted[0] } else { 0 };
        self.passed(triangle, corners, seen, step)
    }

    fn exact_way(&self) -> [Expansion; 3] {
        self.direction.each(Expansion::sum)
    }

    /// Returns exactly the side on which the line passes edge k; 0 if it meets the edge's line.
    fn exact_side(&self, corners: &[Point; 3], k: usize) -> i32 {
        let seen =
            |p: &Point| -> [Expansion; 3] { array(|axis| Expansion::sum([p[axis], -self.from[axis]])) };
        exact_determinant(&self.exact_way(), &seen(&corners[k]), &seen(&corners[(k + 1) % 3])).sign()
    }

    /// Does the same for the shifted line: the side of the plane through edge and line to which the line is
    /// shifted.
    fn shifted_side(&self, corners: &[Point; 3], k: usize) -> i32 {
        let (p, q) = (&corners[k], &corners[(k + 1) % 3]);
        let back: [Expansion; 3] = array(|axis| Expansion::sum([p[axis], -q[axis]]));
        let way = self.exact_way();
        let part = |axis: usize| {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            back[i].times(&way[j]).minus(&back[j].times(&way[i])).sign()
        };
        self.shift.side(part)
    }

    /// Handles a triangle that the line meets in one point. `step` is the change of the winding number.
    fn passed(&self, triangle: u32, corners: &[Point; 3], seen: &Seen, step: i32) -> Met {
        let [a, b, c] = corners;
        let edge = |p: &Point| -> Point { array(|axis| p[axis] - a[axis]) };
        let (u, v) = (edge(b), edge(c));
        // t = n · (a − from) / n · d
        let (height, of_height) = determinant(&seen.ends[0], &u, &v);
        let (slope, of_slope) = determinant(&self.way, &u, &v);
        let mut wrong = ROUNDING * of_height;
        if self.displacement > 0.0 {
            // The line meets the surface within this distance of a point of the triangle.
            let (area, of_area) = size_of_normal(&u, &v);
            wrong += (area + ROUNDING * of_area) * self.displacement * (1.0 + 1e-9);
        }
        let sure = slope.abs() - ROUNDING * of_slope;
        let t = height / slope;
        let error = 1.01 * ((wrong + t.abs() * ROUNDING * of_slope) / sure) + 2.0 * f64::EPSILON * t.abs();
        let known = if self.displacement == 0.0 && self.is_short(corners, height, slope) {
            quotient(height, slope)
        } else if sure > 0.0 && (self.displacement > 0.0 || error <= t.abs() * FINE) {
            Interval::new(t - error, t + error)
        } else {
            None
        };
        let known = known.filter(|t| t.lower > 0.0 || t.upper < 0.0);
        match known {
            Some(t) if t.upper < 0.0 => Met::No,
            Some(t) => Met::At(Hit { t, step, triangle }),
            None => self.passed_exactly(triangle, corners, step),
        }
    }

    /// Returns whether height and slope of a triangle were computed without rounding, because all numbers
    /// have few digits.
    #[inline(always)]
    fn is_short(&self, corners: &[Point; 3], height: f64, slope: f64) -> bool {
        // (Usually one of the two numbers shows that they have many.)
        const DIGITS: u64 = (1 << 16) - 1;
        if (height.to_bits() | slope.to_bits()) & DIGITS != 0 || slope == 0.0 {
            return false;
        }
        // Differences have one more bit, products of three have the sum of their bits, and sums of six three
        // more: 51.
        const BITS: i32 = 15;
        let along = self.direction.each(|[high, _]| high);
        let is_whole = self.direction.iter().all(|&[_, low]| low == 0.0);
        let points = corners.iter().chain([&self.from]).flatten().copied();
        is_whole && width_of(points) <= BITS && width_of(along) <= BITS
    }

    /// Handles a triangle that is nearly parallel to the line, or near to the line's beginning.
    #[cold]
    fn passed_exactly(&self, triangle: u32, corners: &[Point; 3], step: i32) -> Met {
        if self.displacement > 0.0 {
            return Met::Unsure;
        }
        let [a, b, c] = corners;
        let minus =
            |p: &Point, q: &Point| -> [Expansion; 3] { array(|axis| Expansion::sum([p[axis], -q[axis]])) };
        let (u, v) = (minus(b, a), minus(c, a));
        let height = exact_determinant(&minus(a, &self.from), &u, &v);
        let slope = exact_determinant(&self.exact_way(), &u, &v);
        let mut ahead = height.sign() * slope.sign();
        let t = if ahead == 0 { 0.0 } else { height.estimate() / slope.estimate() };
        // Estimates have two roundings each, and their quotient one more.
        let error = 8.0 * f64::EPSILON * t.abs();
        let Some(mut t) = Interval::new(t - error, t + error) else { return Met::Unsure };
        if ahead < 0 {
            return Met::No;
        }
        let mut step = step;
        if ahead == 0 {
            // The line begins on the triangle, and its shifted beginning lies on one side.
            let part = |axis: usize| {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                u[i].times(&v[j]).minus(&u[j].times(&v[i])).sign()
            };
            ahead = -self.shift.side(part) * slope.sign();
            if ahead < 0 {
                step = 0;
            }
            t = Interval::exactly(0.0);
        }
        Met::At(Hit { t, step, triangle })
    }

    /// Handles a triangle whose plane contains the line, or whose corners are collinear with a point of it.
    fn along(&self, triangle: u32, corners: &[Point; 3]) -> Met {
        let mut stay = Interval::between(0.0, f64::INFINITY);
        for axis in 0..3 {
            let at = corners.each(|corner| corner[axis]);
            let (low, high) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
            let [along, rest] = self.direction[axis];
            let from = Interval::exactly(self.from[axis]);
            let to = [low, high].each(|plane| Interval::exactly(plane).minus(from));
            let passes = if along == 0.0 {
                if low > self.from[axis] || high < self.from[axis] {
                    return Met::No;
                }
                continue;
            } else {
                let speed = Interval::exactly(along).plus(Interval::exactly(rest));
                let over = |to: Interval| {
                    if along > 0.0 { to.over(speed) } else { to.negated().over(speed.negated()) }
                };
                over(to[0]).joined(over(to[1]))
            };
            match stay.common(passes) {
                Some(both) => stay = both,
                None => return Met::No,
            }
        }
        match self.between_edges(corners, stay) {
            Some(t) => Met::At(Hit { t, step: 0, triangle }),
            None => Met::No,
        }
    }

    /// Returns bounds of the part of a stay in a triangle's plane that the line spends between the triangle's
    /// edges, in the projection in which the triangle is largest.
    fn between_edges(&self, corners: &[Point; 3], mut stay: Interval) -> Option<Interval> {
        let exactly = Interval::exactly;
        let minus = |p: f64, q: f64| exactly(p).minus(exactly(q));
        let w = axis_of(corners);
        let (u, v) = ((w + 1) % 3, (w + 2) % 3);
        let turns_along =
            |axis: usize| cross_sign([&corners[0], &corners[1]], [&corners[0], &corners[2]], axis);
        let turns = turns_along(w);
        if turns == 0 {
            // A triangle without area bounds nothing: its edges are edges of others.
            let is_flat = turns_along(u) == 0 && turns_along(v) == 0;
            return (!is_flat).then_some(stay);
        }
        let way = self.direction.each(|[high, low]| exactly(high).plus(exactly(low)));
        for k in 0..3 {
            let (p, q) = (&corners[k], &corners[(k + 1) % 3]);
            let edge = [minus(q[u], p[u]), minus(q[v], p[v])];
            // The line's distance to the inner side of the edge at its beginning, and its speed inward.
            let side = |[x, y]: [Interval; 2]| {
                let side = edge[0].times(y).minus(edge[1].times(x));
                if turns > 0 { side } else { side.negated() }
            };
            let begins = side([minus(self.from[u], p[u]), minus(self.from[v], p[v])]);
            let goes = side([way[u], way[v]]);
            let within = if goes.lower > 0.0 {
                Interval::new(begins.negated().over(goes).lower, f64::INFINITY)
            } else if goes.upper < 0.0 {
                Interval::new(f64::NEG_INFINITY, begins.over(goes.negated()).upper)
            } else if begins.upper < 0.0 && goes == exactly(0.0) {
                None
            } else {
                Some(Interval::ALL)
            };
            stay = stay.common(within?)?;
        }
        Some(stay)
    }
}

/// Returns whether the line may pass between edges of which not all sides are certain.
fn may_pass(sides: [Option<i32>; 3]) -> bool {
    !(sides.contains(&Some(1)) && sides.contains(&Some(-1)))
}

/// Returns the number of bits of numbers as integers of the largest power of two that divides them all.
fn width_of(numbers: impl IntoIterator<Item = f64>) -> i32 {
    let (mut least, mut most) = (i32::MAX, i32::MIN);
    for number in numbers {
        let bits = number.to_bits() & !(1 << 63);
        // (Numbers are zero or normal.)
        if bits != 0 {
            let exponent = (bits >> 52) as i32;
            least = least.min(exponent - 52 + (bits | 1 << 52).trailing_zeros() as i32);
            most = most.max(exponent);
        }
    }
    if most < least { 0 } else { most - least + 1 }
}

/// Returns the quotient of two numbers, rounded outward.
fn quotient(a: f64, b: f64) -> Option<Interval> {
    let t = a / b;
    let is_exact = two_product(t, b) == (a, 0.0);
    if is_exact { Some(Interval::exactly(t)) } else { Interval::new(t.next_down(), t.next_up()) }
}

/// Returns the sum of the magnitudes of u × v, and that of its products.
fn size_of_normal(u: &Point, v: &Point) -> (f64, f64) {
    (0..3).fold((0.0, 0.0), |(size, magnitude), k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (left, right) = (u[i] * v[j], u[j] * v[i]);
        (size + (left - right).abs(), magnitude + left.abs() + right.abs())
    })
}

/// Returns d · (p × q), and the sum of the magnitudes of its products.
#[inline(always)]
fn determinant(d: &Point, p: &Point, q: &Point) -> (f64, f64) {
    let (mut value, mut magnitude) = (0.0, 0.0);
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (left, right) = (p[i] * q[j], p[j] * q[i]);
        value += d[k] * (left - right);
        magnitude += d[k].abs() * (left.abs() + right.abs());
    }
    (value, magnitude)
}

fn exact_determinant(d: &[Expansion; 3], p: &[Expansion; 3], q: &[Expansion; 3]) -> Expansion {
    (0..3).fold(Expansion::default(), |sum, k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        sum.plus(&p[i].times(&q[j]).minus(&p[j].times(&q[i])).times(&d[k]))
    })
}
