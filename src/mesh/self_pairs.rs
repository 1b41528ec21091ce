//! Pairs of triangles of one mesh whose boxes meet, without the many pairs around busy vertices.
//!
//! Boxes around triangles with a common vertex all meet: n slivers around one vertex make n² pairs. Two such
//! triangles meet beyond the vertex if and only if they have a common direction from there, because both are
//! convex. For a *busy* vertex, which belongs to many triangles, the directions are therefore compared: arcs
//! on a sphere, by a tree of boxes of their own. The main search leaves these pairs out, whole nodes at once
//! if all their triangles have the vertex.
//!
//! Long oblique slivers have large boxes, too. After many steps each node gets an oriented box that is
//! aligned with its triangles.

use super::signs::Point;
use super::tree::{Grid, Place, Search, Steps, Tree, WIDTH};
use super::triangle_mesh::TriangleMesh;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::memory;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// A vertex of more triangles than this is busy.
const BUSY: u32 = 64;

/// Steps per triangle, and additional steps, after which oriented boxes are made.
const STEPS: u64 = 96;
const FIRST: u64 = 1 << 18;

/// Steps between two checks for cancelling.
const OFTEN: u64 = 1 << 16;

/// Markers: no vertex; any vertex.
const NONE: u32 = u32::MAX;
const ANY: u32 = u32::MAX - 1;

/// The busy vertices that all triangles of a node have in common.
type Common = [u32; 3];

/// The data of a search for pairs in one mesh.
struct Pairs<'m> {
    mesh: &'m TriangleMesh,
    tree: &'m Tree,
    control: &'m Control<'m>,
    /// Whether each vertex is busy; empty if none is.
    busy: Vec<bool>,
    /// The common busy vertices of each node; empty if no vertex is busy.
    common: Vec<Common>,
    turned: Option<Vec<Turned>>,
    /// Oriented boxes are made once fewer steps than this remain.
    before: u64,
}

/// Calls `visit` once with each pair of triangles that may meet, until it returns `false`. Triangles that are
/// `left_out` may be missing. The pairs and their order depend on the mesh alone.
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

    /// Returns the busy vertices that all triangles of each node have in common.
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
                vertices.map(|all| all.each(|vertex| if self.is_busy(vertex) { vertex } else { NONE }))
            };
            if let Some(part) = part {
                let all = common[index];
                let joined = all.each(|vertex| if part.contains(&vertex) { vertex } else { NONE });
                common[index] = if all == [ANY; 3] { part } else { joined };
            }
        }
    }

    /// Returns whether all triangles of two nodes have a common busy vertex.
    fn is_around_vertex(&self, a: Place, b: Place) -> bool {
        if self.common.is_empty() {
            return false;
        }
        let tree = self.tree;
        let (own, other) = (&self.common[tree.index(a)], &self.common[tree.index(b)]);
        own.iter().any(|vertex| *vertex != NONE && other.contains(vertex))
    }

    /// Returns the least busy vertex that two triangles share.
    fn busy_of(&self, a: u32, b: u32) -> Option<u32> {
        if self.busy.is_empty() {
            return None;
        }
        let [own, other] = [a, b].each(|triangle| self.mesh.triangles()[triangle as usize]);
        own.into_iter().filter(|&vertex| self.is_busy(vertex) && other.contains(&vertex)).min()
    }

    /// Visits the pairs with a common busy vertex.
    fn around_vertices(
        &self,
        counts: &[u32],
        left_out: &impl Fn(u32) -> bool,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        // The triangles of each busy vertex, one list after another.
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

    /// Visits the pairs of some triangles that share a vertex.
    fn around_vertex(
        &self,
        vertex: u32,
        list: &[u32],
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        // The box around an arc, represented as a triangle without area between two of the box's corners.
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

    /// Returns a box around the directions from the vertex to the points of a triangle.
    fn arc(&self, vertex: u32, triangle: u32) -> [Point; 2] {
        /// Upper bound of the rounding error of a direction.
        const MARGIN: f64 = 1e-9;
        let corners = self.mesh.triangles()[triangle as usize];
        let at = |vertex: u32| self.mesh.vertices()[vertex as usize];
        let from = at(vertex);
        let mut others = corners.into_iter().filter(|&other| other != vertex);
        let mut next = || unit(&minus(&at(others.next()?), &from));
        let (Some(p), Some(q)) = (next(), next()) else { return [[-2.0; 3], [2.0; 3]] };
        // An arc extends beyond its chord's box by less than half the square of the chord, and never beyond
        // the sphere.
        let chord = minus(&p, &q);
        let bulge = 0.5 * dot(&chord, &chord) + MARGIN;
        [
            array(|axis| (p[axis].min(q[axis]) - bulge).max(-1.0 - MARGIN)),
            array(|axis| (p[axis].max(q[axis]) + bulge).min(1.0 + MARGIN)),
        ]
    }

    /// Visits the pairs of triangles in one node.
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

    /// Visits the pairs of child k of one node and some children of another node of the same level.
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

    /// Visits the pairs of two nodes of one level.
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

    /// Returns whether the oriented boxes of two nodes prove that they are apart. Returns false as long as
    /// few steps were taken.
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

    /// Returns the oriented boxes of all nodes. O(t log t).
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

/// A box whose axes are aligned with its triangles, in the units of the tree's grid.
#[derive(Clone, Copy)]
struct Turned {
    middle: Point,
    axes: [Point; 3],
    half: Point,
}

impl Turned {
    /// Upper bound of rounding errors for coordinates of magnitude at most 1.
    const MARGIN: f64 = 1e-12;

    const NONE: Turned = Turned { middle: [0.0; 3], axes: [[0.0; 3]; 3], half: [0.0; 3] };

    /// Returns a box around points. Its first axis joins two points that are far from each other; the second
    /// points, at a right angle, to the point that is farthest from the first axis.
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
        // (If the point is close to the line, rounding may have changed the angle: orthogonalise once more.)
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

    /// Returns whether a plane perpendicular to an axis of one box, or parallel to an edge of each, separates
    /// two boxes.
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

    /// Returns how far the box extends from its middle along a direction.
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

/// Returns the vector of length 1 with the same direction.
fn unit(way: &Point) -> Option<Point> {
    let most = way.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let way = way.each(|c| c / most);
    let length = sqrt(dot(&way, &way));
    (length > 0.0).then(|| way.each(|c| c / length))
}
