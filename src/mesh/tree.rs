//! A bounding box tree of triangles: finds the triangles that a line may meet, the triangles near a point,
//! and the pairs of triangles that may meet.
//!
//! Each node has up to four children, whose boxes are stored coordinate by coordinate, so that a processor
//! tests four at once. All nodes but the last of a level are full, and lie in the order of their parents. A
//! node is addressed by its level and its number, without pointers.
//!
//! Corners are rounded to 24 bits relative to the centre of the mesh. Rounding keeps the order of numbers, so
//! boxes that meet still meet, and no pair is missed.

use super::signs::Point;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{floor, two_diff};
use crate::memory;
use crate::parallel;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// Maximum number of children of a node.
pub(super) const WIDTH: usize = 4;

/// Levels of a tree of 2^32 triangles.
pub(super) const LEVELS: usize = 16;

/// Number of places that a search keeps for later: three a level, and four of the first.
pub(super) const LATER: usize = (WIDTH - 1) * LEVELS + 1;

/// Trees of fewer triangles are built on one thread.
const MANY: usize = 1 << 13;

/// The boxes of a node's four children.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(super) struct Node {
    /// For each axis the lower coordinates of all boxes, then the upper ones.
    pub(super) planes: [[[f32; WIDTH]; 2]; 3],
}

/// The address of a node: its level, where the children of level 0 are triangles, and its number on that
/// level.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) level: u8,
    pub(super) number: u32,
}

impl Place {
    /// Returns the number of a child among the children of the whole level.
    #[inline(always)]
    pub(super) fn part(self, k: usize) -> usize {
        self.number as usize * WIDTH + k
    }

    /// Returns the node that is child k. (Above the lowest level.)
    #[inline(always)]
    pub(super) fn child(self, k: usize) -> Place {
        Place { level: self.level - 1, number: self.part(k) as u32 }
    }
}

/// A tree of all triangles of a mesh. 36 bytes a triangle.
#[derive(Clone)]
pub(crate) struct Tree {
    pub(super) grid: Grid,
    /// The triangles in the order of the tree. Placed copies of the mesh share it.
    order: Arc<Vec<u32>>,
    nodes: Vec<Node>,
    /// The start of each level's nodes, and the end of the last level.
    starts: [u32; LEVELS + 1],
    levels: u8,
}

/// A triangle with the box around it.
#[derive(Clone, Copy)]
struct Item {
    around: Box3,
    triangle: u32,
}

#[derive(Clone, Copy)]
pub(super) struct Box3 {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
}

impl Box3 {
    const NONE: Box3 = Box3 { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn include(&mut self, other: &Box3) {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(other.low[axis]);
            self.high[axis] = self.high[axis].max(other.high[axis]);
        }
    }

    /// Returns twice the middle.
    #[inline(always)]
    fn middle(&self, axis: usize) -> f32 {
        self.low[axis] + self.high[axis]
    }
}

impl Node {
    const NONE: Node = Node { planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3] };

    /// Returns the box of a child.
    #[inline(always)]
    pub(super) fn part(&self, k: usize) -> Box3 {
        Box3 { low: array(|axis| self.planes[axis][0][k]), high: array(|axis| self.planes[axis][1][k]) }
    }

    /// Returns a node with one child.
    pub(super) fn of(part: &Box3) -> Node {
        let mut node = Node::NONE;
        node.set(0, part);
        node
    }

    fn set(&mut self, k: usize, part: &Box3) {
        for axis in 0..3 {
            self.planes[axis][0][k] = part.low[axis];
            self.planes[axis][1][k] = part.high[axis];
        }
    }

    pub(super) fn around(&self) -> Box3 {
        (0..WIDTH).fold(Box3::NONE, |mut around, k| {
            around.include(&self.part(k));
            around
        })
    }

    /// Returns the children that a closed box meets: bit k for child k.
    #[inline(always)]
    pub(super) fn touches(&self, other: &Box3) -> u32 {
        let mut touches = [true; WIDTH];
        for axis in 0..3 {
            let [low, high] = &self.planes[axis];
            for k in 0..WIDTH {
                // Without branches, because they would usually be mispredicted.
                touches[k] &= (low[k] <= other.high[axis]) & (other.low[axis] <= high[k]);
            }
        }
        (0..WIDTH).fold(0, |bits, k| bits | u32::from(touches[k]) << k)
    }
}

/// The grid to which coordinates are rounded.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    /// The centre of the mesh's bounds, up to rounding.
    pub(super) centre: Point,
    /// The mesh lies within 2^exponent of the centre along each axis.
    exponent: i32,
}

impl Grid {
    /// Returns the grid of a mesh with these bounds.
    pub(super) fn around((low, high): (Point, Point)) -> Grid {
        let centre: Point = array(|axis| low[axis].midpoint(high[axis]));
        let reach = (0..3)
            .fold(0.0, |reach: f64, axis| reach.max(high[axis] - centre[axis]).max(centre[axis] - low[axis]));
        // The exponent field of a double, or one more.
        let exponent = ((reach.to_bits() >> 52) as i32 - 1023 + 1).clamp(-1000, 1000);
        Grid { centre, exponent }
    }

    /// Returns 2^-exponent, with which no scaled coordinate exceeds 1.
    pub(super) fn scale(&self) -> f64 {
        f64::from_bits(((1023 - self.exponent) as u64) << 52)
    }

    /// Returns a point relative to the centre, scaled to [-1, 1]. The error of each coordinate is at most
    /// 2^-53 of itself plus 2^-1074.
    #[inline(always)]
    pub(super) fn scaled(&self, p: &Point) -> Point {
        let scale = self.scale();
        array(|axis| (p[axis] - self.centre[axis]) * scale)
    }

    /// Returns a triangle's first corner relative to the centre, and its edges from there, scaled. The errors
    /// are those of [`scaled`](Self::scaled).
    #[inline(always)]
    pub(super) fn triangle(&self, [a, b, c]: &[Point; 3]) -> [Point; 3] {
        let scale = self.scale();
        let edge = |p: &Point| array(|axis| (p[axis] - a[axis]) * scale);
        [self.scaled(a), edge(b), edge(c)]
    }

    /// Returns the number of fractional bits of the scaled coordinates of all vertices, if the coordinates
    /// are exact and have at most 15 such bits.
    pub(super) fn bits(&self, vertices: &[Point]) -> Option<i32> {
        const MOST: i32 = 15;
        let scale = self.scale();
        let mut bits = 0;
        for p in vertices {
            for (&x, &centre) in p.iter().zip(&self.centre) {
                let (offset, lost) = two_diff(x, centre);
                let is_whole = |bits: i32| {
                    let steps = offset * scale * f64::from(1 << bits);
                    steps == floor(steps.clamp(-1e9, 1e9)) as f64
                };
                while !is_whole(bits) {
                    bits += 1;
                    if bits > MOST {
                        return None;
                    }
                }
                if lost != 0.0 {
                    return None;
                }
            }
        }
        Some(bits)
    }

    #[inline(always)]
    fn rounded(&self, p: &Point) -> [f32; 3] {
        self.scaled(p).each(|x| x as f32)
    }

    /// Returns the box around a triangle.
    #[inline(always)]
    fn box_of(&self, vertices: &[Point], corners: [u32; 3]) -> Box3 {
        corners.into_iter().fold(Box3::NONE, |mut around, vertex| {
            let at = self.rounded(&vertices[vertex as usize]);
            around.include(&Box3 { low: at, high: at });
            around
        })
    }
}

/// Number of steps that a search may still take. One step tests a box against another one.
pub(super) struct Steps(pub(super) u64);

impl Steps {
    #[inline(always)]
    pub(super) fn take(&mut self, steps: usize) -> bool {
        let left = self.0.checked_sub(steps as u64);
        self.0 = left.unwrap_or(0);
        left.is_some()
    }
}

/// The end of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Search {
    /// The search is complete.
    Finished,
    /// The visitor ended the search.
    Ended,
    /// No steps are left.
    Exhausted,
}

impl Tree {
    /// Builds the tree of a mesh, which depends on the mesh alone, by halving along the longest extent, down
    /// to four triangles. O(t log t), on the threads of `control`; 28 bytes a triangle of scratch memory.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub(super) fn new(
        grid: Grid,
        vertices: &[Point],
        triangles: &[[u32; 3]],
        control: &Control<'_>,
    ) -> Result<Tree, Error> {
        control.check()?;
        let count = triangles.len();
        let mut items = memory::with_capacity(count)?;
        items.extend(
            triangles
                .iter()
                .zip(0..)
                .map(|(&corners, triangle)| Item { around: grid.box_of(vertices, corners), triangle }),
        );
        let unit = (0..LEVELS as u32).map(|level| 1 << (2 * level)).find(|unit| unit * WIDTH >= count);
        control.run(count > MANY, |parallel| arrange(&mut items, unit.unwrap_or(1), parallel, control))?;
        let mut order = memory::with_capacity(count)?;
        order.extend(items.iter().map(|item| item.triangle));
        Tree::of_boxes(grid, Arc::new(order), items.iter().map(|item| item.around))
    }

    /// Builds the tree of a mesh that is a moved copy of another one, in the triangle order of the original.
    /// O(t).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn in_order(
        grid: Grid,
        vertices: &[Point],
        triangles: &[[u32; 3]],
        order: &Arc<Vec<u32>>,
    ) -> Result<Tree, Error> {
        let box_of = |&triangle: &u32| grid.box_of(vertices, triangles[triangle as usize]);
        Tree::of_boxes(grid, order.clone(), order.iter().map(box_of))
    }

    fn of_boxes(
        grid: Grid,
        order: Arc<Vec<u32>>,
        boxes: impl ExactSizeIterator<Item = Box3>,
    ) -> Result<Tree, Error> {
        let mut starts = [0; LEVELS + 1];
        let (mut levels, mut parts) = (0, boxes.len());
        let mut count = 0;
        while levels == 0 || parts > 1 {
            parts = parts.div_ceil(WIDTH);
            count += parts;
            levels += 1;
            starts[levels] = count as u32;
        }
        let mut nodes: Vec<Node> = memory::filled(count, Node::NONE)?;
        for (k, around) in boxes.enumerate() {
            nodes[k / WIDTH].set(k % WIDTH, &around);
        }
        for level in 1..levels {
            let [start, end] = [starts[level - 1] as usize, starts[level] as usize];
            for k in 0..end - start {
                let around = nodes[start + k].around();
                nodes[end + k / WIDTH].set(k % WIDTH, &around);
            }
        }
        Ok(Tree { grid, order, nodes, starts, levels: levels as u8 })
    }

    /// Returns the bytes that the lists take.
    pub(super) fn bytes(&self) -> usize {
        memory::bytes_of(&self.order) + memory::bytes_of(&self.nodes)
    }

    /// Returns the order of the triangles, for copies of the mesh.
    pub(super) fn order(&self) -> &Arc<Vec<u32>> {
        &self.order
    }

    /// Returns the number of nodes.
    pub(super) fn count(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the root; `None` for a mesh without triangles.
    #[inline(always)]
    pub(super) fn root(&self) -> Option<Place> {
        (!self.nodes.is_empty()).then_some(Place { level: self.levels - 1, number: 0 })
    }

    /// Returns the box around all triangles.
    pub(super) fn around(&self) -> Option<Box3> {
        Some(self.node(self.root()?).around())
    }

    /// Returns the number of a node among all nodes.
    #[inline(always)]
    pub(super) fn index(&self, place: Place) -> usize {
        (self.starts[place.level as usize] + place.number) as usize
    }

    #[inline(always)]
    pub(super) fn node(&self, place: Place) -> &Node {
        &self.nodes[self.index(place)]
    }

    /// Returns the triangle that is child k of a lowest node; `None` if the node has fewer children.
    #[inline(always)]
    pub(super) fn triangle(&self, place: Place, k: usize) -> Option<u32> {
        self.order.get(place.part(k)).copied()
    }

    /// Returns the number of a node's children.
    pub(super) fn parts(&self, place: Place) -> usize {
        let all = match place.level.checked_sub(1) {
            None => self.order.len(),
            Some(below) => (self.starts[below as usize + 1] - self.starts[below as usize]) as usize,
        };
        (all - place.part(0)).min(WIDTH)
    }

    /// Calls `visit` with each pair of triangles whose boxes meet, until it returns `false`. The result and
    /// the order of the pairs depend on the mesh alone.
    pub(super) fn pairs(
        &self,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        self.root().map_or(Ok(Search::Finished), |root| self.pairs_in(root, steps, visit))
    }

    fn pairs_in(
        &self,
        place: Place,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        let node = self.node(place);
        let parts = self.parts(place);
        if place.level > 0 {
            for k in 0..parts {
                match self.pairs_in(place.child(k), steps, visit)? {
                    Search::Finished => {}
                    search => return Ok(search),
                }
            }
        }
        for k in 1..parts {
            let earlier = (1 << k) - 1;
            let search =
                self.pairs_of((place, k), (place, node.touches(&node.part(k)) & earlier), steps, visit)?;
            if search != Search::Finished {
                return Ok(search);
            }
        }
        Ok(Search::Finished)
    }

    /// Visits the pairs of child k of one node and some children of another node of the same level.
    fn pairs_of(
        &self,
        (place, k): (Place, usize),
        (other, mut parts): (Place, u32),
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        if !steps.take(WIDTH) {
            return Ok(Search::Exhausted);
        }
        while parts != 0 {
            let i = parts.trailing_zeros() as usize;
            parts &= parts - 1;
            if place.level > 0 {
                match self.pairs_between(place.child(k), other.child(i), steps, visit)? {
                    Search::Finished => {}
                    search => return Ok(search),
                }
            } else if let (Some(a), Some(b)) = (self.triangle(place, k), self.triangle(other, i))
                && !visit(a.min(b), a.max(b))?
            {
                return Ok(Search::Ended);
            }
        }
        Ok(Search::Finished)
    }

    /// Visits the pairs of two nodes of one level.
    fn pairs_between(
        &self,
        a: Place,
        b: Place,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        let (of_a, of_b) = (self.node(a), self.node(b));
        for k in 0..self.parts(a) {
            let search = self.pairs_of((a, k), (b, of_b.touches(&of_a.part(k))), steps, visit)?;
            if search != Search::Finished {
                return Ok(search);
            }
        }
        Ok(Search::Finished)
    }

    /// Calls `visit` with each triangle whose box meets the line through `p` along `axis`.
    pub(super) fn on_line(&self, p: &Point, axis: usize, visit: &mut impl FnMut(u32)) {
        let at = self.grid.rounded(p);
        let (mut low, mut high) = (at, at);
        (low[axis], high[axis]) = (f32::NEG_INFINITY, f32::INFINITY);
        let line = Box3 { low, high };
        self.search(|node| node.touches(&line), visit);
    }

    /// Calls `visit` with each triangle whose box meets the given box.
    pub(super) fn within(&self, low: [f32; 3], high: [f32; 3], visit: &mut impl FnMut(u32)) {
        let around = Box3 { low, high };
        self.search(|node| node.touches(&around), visit);
    }

    /// Calls `visit` with the triangles that are reached through children selected by `chosen`, all the way
    /// down.
    #[inline(always)]
    pub(super) fn search(&self, chosen: impl Fn(&Node) -> u32, visit: &mut impl FnMut(u32)) {
        let mut later = [Place { level: 0, number: 0 }; LATER];
        let mut count = 0;
        let mut next = self.root();
        while let Some(place) = next {
            let mut parts = chosen(self.node(place));
            while parts != 0 {
                let k = parts.trailing_zeros() as usize;
                parts &= parts - 1;
                if place.level > 0 {
                    later[count] = place.child(k);
                    count += 1;
                } else if let Some(triangle) = self.triangle(place, k) {
                    visit(triangle);
                }
            }
            next = count.checked_sub(1).map(|last| {
                count = last;
                later[last]
            });
        }
    }
}

/// Sorts triangles so that each group of `unit` triangles, each quarter of a group, and so on, are
/// neighbours.
fn arrange(items: &mut [Item], mut unit: usize, parallel: bool, control: &Control<'_>) -> Result<(), Error> {
    if items.len() <= WIDTH {
        return Ok(());
    }
    while unit >= items.len() {
        unit /= WIDTH;
    }
    divide(items, unit, parallel, control)
}

/// Does the same for some groups, by halving.
fn divide(items: &mut [Item], unit: usize, parallel: bool, control: &Control<'_>) -> Result<(), Error> {
    let units = items.len().div_ceil(unit);
    if units <= 1 {
        return arrange(items, unit / WIDTH, parallel, control);
    }
    let is_large = items.len() > MANY;
    if is_large {
        control.check()?;
    }
    let mut middles = Box3::NONE;
    for item in items.iter() {
        let at = array(|axis| item.around.middle(axis));
        middles.include(&Box3 { low: at, high: at });
    }
    let extent = |axis: usize| middles.high[axis] - middles.low[axis];
    let axis = (1..3).fold(0, |most, axis| if extent(axis) > extent(most) { axis } else { most });
    let half = units / 2 * unit;
    items.select_nth_unstable_by(half, |a, b| {
        // Ties are broken by the triangles' numbers, so that the halves are the same on every machine.
        a.around.middle(axis).total_cmp(&b.around.middle(axis)).then(a.triangle.cmp(&b.triangle))
    });
    let (low, high) = items.split_at_mut(half);
    let (low, high) = parallel::both(
        parallel && is_large,
        || divide(low, unit, parallel, control),
        || divide(high, unit, parallel, control),
    );
    low.and(high)
}
