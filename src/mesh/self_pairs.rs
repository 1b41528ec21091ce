//! Pairs of triangles of one mesh whose boxes meet, without those that many triangles around one vertex make.
//!
//! Boxes around triangles that have a vertex in common all meet: of n slivers around one vertex, n² pairs.
//! Two such triangles meet beyond the vertex if and only if they have a direction from there in common, as
//! both are convex. So for a *busy* vertex, which many triangles have, the directions are compared: arcs on a
//! sphere, along a tree of boxes of their own. Elsewhere these pairs are left out, whole nodes of them where
//! all triangles have the vertex.
//!
//! Long slivers that lie askew have large boxes, too. After many steps each node gets a box that is turned as
//! its triangles are.

use super::signs::Point;
use super::tree::{Grid, Place, Search, Steps, Tree, WIDTH};
use super::triangle_mesh::TriangleMesh;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::memory;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// A vertex of more triangles is busy.
const BUSY: u32 = 64;

/// Steps a triangle after which boxes are turned, and some more.
const STEPS: u64 = 96;
const FIRST: u64 = 1 << 18;

/// Steps between two looks at the clock.
const OFTEN: u64 = 1 << 16;

/// No vertex, and a place for any.
const NONE: u32 = u32::MAX;
const ANY: u32 = u32::MAX - 1;

/// The busy vertices that all triangles of a node have.
type Common = [u32; 3];

/// Pairs of one mesh.
struct Pairs<'m> {
    mesh: &'m TriangleMesh,
    tree: &'m Tree,
    control: &'m Control<'m>,
    /// Whether each vertex is busy; empty if none is.
    busy: Vec<bool>,
    /// For each node the busy vertices that all of its triangles have; empty if none is busy.
    common: Vec<Common>,
    turned: Option<Vec<Turned>>,
    /// Steps that may be left before boxes are turned.
    before: u64,
}

/// Calls `visit` with each pair of triangles that may meet, once, until it returns `false`. Triangles that
/// are `left_out` may be missing. What it does depends on the mesh alone.
pub(super) fn self_pairs(
    mesh: &TriangleMesh,
    left_out: &impl Fn(u32) -> bool,
    steps: &mut Steps,
    control: &Control<'_>,
    visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
) -> Result<Search, Error> {
    let tree = mesh.tree(control)?;
    let mut counts = memory::filled(mesh.vertices().len(), 0u32)?;
    mesh.triangles().iter().flatten().for_each(|&vertex| counts[vertex as usize] += 1);
    let mut pairs = Pairs {
        mesh,
        tree,
        control,
        busy: Vec::new(),
        common: Vec::new(),
        turned: None,
        before: steps.0.saturating_sub(FIRST + STEPS * mesh.triangles().len() as u64),
    };
    if counts.iter().any(|&count| count > BUSY) {
        pairs.busy = memory::collected(counts.iter().map(|&count| count > BUSY))?;
        pairs.common = pairs.common()?;
        match pairs.around_vertices(&counts, left_out, steps, visit)? {
            Search::Finished => {}
            search => return Ok(search),
        }
    }
    drop(counts);
    let Some(root) = tree.root() else { return Ok(Search::Finished) };
    pairs.within(root, steps, visit)
}

impl Pairs<'_> {
    fn is_busy(&self, vertex: u32) -> bool {
        !self.busy.is_empty() && self.busy[vertex as usize]
    }

    /// The busy vertices that all triangles of each node have.
    fn common(&self) -> Result<Vec<Common>, Error> {
        let mut common = memory::filled(self.tree.count(), [ANY; 3])?;
        if let Some(root) = self.tree.root() {
            self.find_common(root, &mut common);
        }
        Ok(common)
    }

    fn find_common(&self, place: Place, common: &mut [Common]) {
        let index = self.tree.index(place);
        for k in 0..self.tree.parts(place) {
            let part = if place.level > 0 {
                self.find_common(place.child(k), common);
                Some(common[self.tree.index(place.child(k))])
            } else {
                let vertices = self.tree.triangle(place, k).map(|t| self.mesh.triangles()[t as usize]);
                vertices.map(|all| all.map(|vertex| if self.is_busy(vertex) { vertex } else { NONE }))
            };
            if let Some(part) = part {
                let all = common[index];
                let joined = all.map(|vertex| if part.contains(&vertex) { vertex } else { NONE });
                common[index] = if all == [ANY; 3] { part } else { joined };
            }
        }
    }

    /// Whether all triangles of two nodes have a busy vertex in common.
    fn is_around_vertex(&self, a: Place, b: Place) -> bool {
        if self.common.is_empty() {
            return false;
        }
        let tree = self.tree;
        let (own, other) = (&self.common[tree.index(a)], &self.common[tree.index(b)]);
        own.iter().any(|vertex| *vertex != NONE && other.contains(vertex))
    }

    /// The least busy vertex that two triangles have in common.
    fn busy_of(&self, a: u32, b: u32) -> Option<u32> {
        if self.busy.is_empty() {
            return None;
        }
        let [own, other] = [a, b].map(|triangle| self.mesh.triangles()[triangle as usize]);
        own.into_iter().filter(|&vertex| self.is_busy(vertex) && other.contains(&vertex)).min()
    }

    /// Pairs with a busy vertex in common.
    fn around_vertices(
        &self,
        counts: &[u32],
        left_out: &impl Fn(u32) -> bool,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        // The triangles of each busy vertex, one list behind the other.
        let mut starts = memory::with_capacity(counts.len() + 1)?;
        let mut total = 0usize;
        for (vertex, &count) in counts.iter().enumerate() {
            starts.push(total);
            total += if self.busy[vertex] { count as usize } else { 0 };
        }
        starts.push(total);
        let mut lists = memory::filled(total, 0u32)?;
        let mut next = memory::copied(&starts)?;
        for (triangle, corners) in (0..).zip(self.mesh.triangles()) {
            if left_out(triangle) {
                continue;
            }
            for &vertex in corners.iter().filter(|&&vertex| self.is_busy(vertex)) {
                lists[next[vertex as usize]] = triangle;
                next[vertex as usize] += 1;
            }
        }
        for vertex in 0..counts.len() as u32 {
            let list = &lists[starts[vertex as usize]..next[vertex as usize]];
            if list.is_empty() {
                continue;
            }
            match self.around_vertex(vertex, list, steps, visit)? {
                Search::Finished => {}
                search => return Ok(search),
            }
        }
        Ok(Search::Finished)
    }

    /// Pairs of some triangles that have a vertex in common.
    fn around_vertex(
        &self,
        vertex: u32,
        list: &[u32],
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        // A box around an arc as a triangle without area, between two of its corners.
        let (mut corners, mut boxes) =
            (memory::with_capacity(2 * list.len())?, memory::with_capacity(list.len())?);
        for &triangle in list {
            let [low, high] = self.arc(vertex, triangle);
            let first = corners.len() as u32;
            corners.push(low);
            corners.push(high);
            boxes.push([first, first + 1, first + 1]);
        }
        let grid = Grid::around(([-2.0; 3], [2.0; 3]));
        let tree = Tree::new(grid, &corners, &boxes, self.control)?;
        tree.pairs(steps, &mut |a, b| {
            let (a, b) = (list[a as usize], list[b as usize]);
            if self.busy_of(a, b) == Some(vertex) { visit(a.min(b), a.max(b)) } else { Ok(true) }
        })
    }

    /// A box around the directions in which a triangle lies, seen from its vertex.
    fn arc(&self, vertex: u32, triangle: u32) -> [Point; 2] {
        /// More than what rounding changes in a direction.
        const MARGIN: f64 = 1e-9;
        let corners = self.mesh.triangles()[triangle as usize];
        let at = |vertex: u32| self.mesh.vertices()[vertex as usize];
        let from = at(vertex);
        let mut others = corners.into_iter().filter(|&other| other != vertex);
        let mut next = || unit(&minus(&at(others.next()?), &from));
        let (Some(p), Some(q)) = (next(), next()) else { return [[-2.0; 3], [2.0; 3]] };
        // An arc bulges by less than half of the square of its chord, beyond the chord's own box; and never
        // beyond the sphere.
        let chord = minus(&p, &q);
        let bulge = 0.5 * dot(&chord, &chord) + MARGIN;
        [
            array(|axis| (p[axis].min(q[axis]) - bulge).max(-1.0 - MARGIN)),
            array(|axis| (p[axis].max(q[axis]) + bulge).min(1.0 + MARGIN)),
        ]
    }

    /// Pairs of triangles of one node.
    fn within(
        &mut self,
        place: Place,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        if self.is_around_vertex(place, place) {
            return Ok(Search::Finished);
        }
        let tree = self.tree;
        let parts = tree.parts(place);
        if place.level > 0 {
            for k in 0..parts {
                match self.within(place.child(k), steps, visit)? {
                    Search::Finished => {}
                    search => return Ok(search),
                }
            }
        }
        let node = tree.node(place);
        for k in 1..parts {
            let earlier = (1 << k) - 1;
            let search =
                self.of_part((place, k), (place, node.touches(&node.part(k)) & earlier), steps, visit)?;
            if search != Search::Finished {
                return Ok(search);
            }
        }
        Ok(Search::Finished)
    }

    /// Of part k of one node and some parts of another one of the same level.
    fn of_part(
        &mut self,
        (place, k): (Place, usize),
        (other, mut parts): (Place, u32),
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        if !steps.take(WIDTH) {
            return Ok(Search::Exhausted);
        }
        if steps.0 % OFTEN < WIDTH as u64 {
            self.control.check()?;
        }
        let tree = self.tree;
        while parts != 0 {
            let i = parts.trailing_zeros() as usize;
            parts &= parts - 1;
            if place.level > 0 {
                let (a, b) = (place.child(k), other.child(i));
                if self.is_around_vertex(a, b) || self.are_apart(a, b, steps)? {
                    continue;
                }
                match self.between(a, b, steps, visit)? {
                    Search::Finished => {}
                    search => return Ok(search),
                }
            } else if let (Some(a), Some(b)) = (tree.triangle(place, k), tree.triangle(other, i))
                && self.busy_of(a, b).is_none()
                && !visit(a.min(b), a.max(b))?
            {
                return Ok(Search::Ended);
            }
        }
        Ok(Search::Finished)
    }

    /// Of two nodes of one level.
    fn between(
        &mut self,
        a: Place,
        b: Place,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        let tree = self.tree;
        let (of_a, of_b) = (tree.node(a), tree.node(b));
        for k in 0..tree.parts(a) {
            let search = self.of_part((a, k), (b, of_b.touches(&of_a.part(k))), steps, visit)?;
            if search != Search::Finished {
                return Ok(search);
            }
        }
        Ok(Search::Finished)
    }

    /// Whether the turned boxes of two nodes tell that they are apart. Nothing is told as long as few steps
    /// were taken.
    fn are_apart(&mut self, a: Place, b: Place, steps: &Steps) -> Result<bool, Error> {
        let tree = self.tree;
        if self.turned.is_none() {
            if steps.0 >= self.before {
                return Ok(false);
            }
            self.turned = Some(self.turned_boxes()?);
        }
        let Some(turned) = &self.turned else { return Ok(false) };
        Ok(turned[tree.index(a)].is_apart(&turned[tree.index(b)]))
    }

    /// The turned boxes of all nodes. O(t log t).
    fn turned_boxes(&self) -> Result<Vec<Turned>, Error> {
        let tree = self.tree;
        let mut boxes = memory::filled(tree.count(), Turned::NONE)?;
        let mut later = memory::with_capacity(1)?;
        let mut points = Vec::new();
        later.extend(tree.root());
        while let Some(place) = later.pop() {
            points.clear();
            self.add_points(place, &mut points)?;
            boxes[tree.index(place)] = Turned::around(&points);
            if place.level > 0 {
                for k in 0..tree.parts(place) {
                    memory::push(&mut later, place.child(k))?;
                }
            }
        }
        Ok(boxes)
    }

    fn add_points(&self, place: Place, points: &mut Vec<Point>) -> Result<(), Error> {
        let tree = self.tree;
        for k in 0..tree.parts(place) {
            if place.level > 0 {
                self.add_points(place.child(k), points)?;
            } else if let Some(triangle) = tree.triangle(place, k) {
                for vertex in self.mesh.triangles()[triangle as usize] {
                    memory::push(points, tree.grid.scaled(&self.mesh.vertices()[vertex as usize]))?;
                }
            }
        }
        Ok(())
    }
}

/// A box whose axes lie as its triangles do, in the units of the tree's grid.
#[derive(Clone, Copy)]
struct Turned {
    middle: Point,
    axes: [Point; 3],
    half: Point,
}

impl Turned {
    /// More than what rounding changes, where coordinates are at most 1.
    const MARGIN: f64 = 1e-12;

    const NONE: Turned = Turned { middle: [0.0; 3], axes: [[0.0; 3]; 3], half: [0.0; 3] };

    /// A box around some points: along the way between two that are far from each other, and across it
    /// towards the one that is farthest away.
    fn around(points: &[Point]) -> Turned {
        let farthest = |measure: &dyn Fn(&Point) -> f64| {
            points.iter().fold((-1.0, [0.0; 3]), |best: (f64, Point), p| {
                let distance = measure(p);
                if distance > best.0 { (distance, *p) } else { best }
            })
        };
        let from = |p: Point| farthest(&|q| dot(&minus(q, &p), &minus(q, &p))).1;
        let start = from(points.first().copied().unwrap_or_default());
        let end = from(start);
        let first = unit(&minus(&end, &start)).unwrap_or([1.0, 0.0, 0.0]);
        let aside = |p: &Point| {
            let way = minus(p, &start);
            let along = dot(&way, &first);
            array(|axis| way[axis] - along * first[axis])
        };
        let (_, side) = farthest(&|p| dot(&aside(p), &aside(p)));
        // (Next to the line, rounding may have turned the way: it is made square once more.)
        let across = |way: Point| -> Option<Point> {
            let way = unit(&way)?;
            let along = dot(&way, &first);
            if along.abs() > 0.5 { None } else { unit(&array(|axis| way[axis] - along * first[axis])) }
        };
        let flattest = (1..3).fold(0, |k, axis| if first[axis].abs() < first[k].abs() { axis } else { k });
        let any: Point = array(|axis| if axis == flattest { 1.0 } else { -first[flattest] * first[axis] });
        let second = across(aside(&side)).or_else(|| across(any)).unwrap_or([0.0; 3]);
        let axes = [first, second, cross(&first, &second)];
        let (mut middle, mut half) = ([0.0; 3], [0.0; 3]);
        for (k, axis) in axes.iter().enumerate() {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for p in points {
                let along = dot(axis, p);
                (low, high) = (low.min(along), high.max(along));
            }
            (middle[k], half[k]) = (0.5 * (low + high), 0.5 * (high - low) + Turned::MARGIN);
        }
        Turned { middle, axes, half }
    }

    /// Whether a plane across an axis of one, or across an edge of each, lies between two boxes.
    fn is_apart(&self, other: &Turned) -> bool {
        let along_axes = |own: &Turned, other: &Turned| {
            let centre = other.centre();
            (0..3).any(|k| {
                let axis = &own.axes[k];
                (dot(axis, &centre) - own.middle[k]).abs() > own.half[k] + other.reach(axis) + Turned::MARGIN
            })
        };
        if along_axes(self, other) || along_axes(other, self) {
            return true;
        }
        let way = minus(&other.centre(), &self.centre());
        self.axes.iter().any(|u| {
            other.axes.iter().any(|v| {
                let axis = cross(u, v);
                dot(&axis, &way).abs() > self.reach(&axis) + other.reach(&axis) + Turned::MARGIN
            })
        })
    }

    fn centre(&self) -> Point {
        array(|axis| (0..3).map(|k| self.middle[k] * self.axes[k][axis]).sum())
    }

    /// How far the box reaches from its middle along a direction.
    fn reach(&self, way: &Point) -> f64 {
        (0..3).map(|k| dot(&self.axes[k], way).abs() * self.half[k]).sum::<f64>()
    }
}

fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: &Point, b: &Point) -> Point {
    array(|axis| a[axis] - b[axis])
}

fn cross(a: &Point, b: &Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector of length 1 in the same direction.
fn unit(way: &Point) -> Option<Point> {
    let most = way.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let way = way.map(|c| c / most);
    let length = sqrt(dot(&way, &way));
    (length > 0.0).then(|| way.map(|c| c / length))
}
