//! A tree of boxes around triangles: which pairs of them may meet, and which ones a line may meet.
//!
//! Corners are rounded to 24 bits about the centre of the mesh. Rounding keeps the order of numbers, so that boxes
//! that meet still meet, and no pair is missed.

use super::signs::Point;
use super::triangle_mesh::TriangleMesh;
use crate::error::Error;
use crate::lattice::exact::{floor, two_diff};
use crate::memory;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// At most twice as many triangles are not divided further.
const FEW: usize = 4;

/// A balanced binary tree: each node has one half of its parent's triangles. 46 bytes a triangle.
pub(super) struct Tree {
    pub(super) grid: Grid,
    pub(super) items: Vec<Item>,
    /// The root is node 1, the children of node k are 2k and 2k + 1. All leaves are at one level.
    pub(super) nodes: Vec<Box3>,
    levels: u32,
}

/// A triangle with the box around it.
#[derive(Clone, Copy)]
pub(super) struct Item {
    pub(super) around: Box3,
    pub(super) triangle: u32,
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

    /// Whether the closed boxes meet.
    #[inline(always)]
    fn touches(&self, other: &Box3) -> bool {
        // Without branches: as a rule nobody can foretell them.
        (0..3).fold(true, |touches, axis| {
            touches & (self.low[axis] <= other.high[axis]) & (other.low[axis] <= self.high[axis])
        })
    }

    fn middle(&self, axis: usize) -> f32 {
        self.low[axis] + self.high[axis]
    }
}

/// How coordinates are rounded.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    /// The centre of the mesh's bounds, up to rounding.
    pub(super) centre: Point,
    /// The mesh lies within 2^exponent of the centre along each axis.
    exponent: i32,
}

impl Grid {
    pub(super) fn of(mesh: &TriangleMesh) -> Grid {
        let (low, high) = mesh.bounds();
        let centre: Point = array(|axis| low[axis].midpoint(high[axis]));
        let reach = (0..3)
            .fold(0.0, |reach: f64, axis| reach.max(high[axis] - centre[axis]).max(centre[axis] - low[axis]));
        // The exponent field of a double, or one more.
        let exponent = ((reach.to_bits() >> 52) as i32 - 1023 + 1).clamp(-1000, 1000);
        Grid { centre, exponent }
    }

    /// 2^-exponent, at which no coordinate is greater than 1.
    pub(super) fn scale(&self) -> f64 {
        f64::from_bits(((1023 - self.exponent) as u64) << 52)
    }

    /// A point relative to the centre, scaled to [-1, 1]: each coordinate is off by a 2^-53 of itself and by a
    /// 2^-1074.
    #[inline(always)]
    pub(super) fn scaled(&self, p: &Point) -> Point {
        let scale = self.scale();
        array(|axis| (p[axis] - self.centre[axis]) * scale)
    }

    /// A triangle's first corner relative to the centre, and its edges from there, scaled. Off by as much.
    #[inline(always)]
    pub(super) fn triangle(&self, [a, b, c]: &[Point; 3]) -> [Point; 3] {
        let scale = self.scale();
        let edge = |p: &Point| array(|axis| (p[axis] - a[axis]) * scale);
        [self.scaled(a), edge(b), edge(c)]
    }

    /// The bits behind the point that the scaled coordinates of all vertices have, if they are exact and not more
    /// than 15.
    pub(super) fn bits(&self, mesh: &TriangleMesh) -> Option<i32> {
        const MOST: i32 = 15;
        let scale = self.scale();
        let mut bits = 0;
        for p in mesh.vertices() {
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
        self.scaled(p).map(|x| x as f32)
    }
}

/// Steps that a search may take. One step looks at two boxes.
pub(super) struct Steps(pub(super) u64);

impl Steps {
    #[inline(always)]
    fn take(&mut self, steps: usize) -> bool {
        let left = self.0.checked_sub(steps as u64);
        self.0 = left.unwrap_or(0);
        left.is_some()
    }
}

/// Whether a search went through to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Search {
    /// It did.
    Finished,
    /// The visitor has seen enough.
    Ended,
    /// No steps are left.
    Exhausted,
}

impl Tree {
    /// A tree of the triangles that are `wanted`. O(t log t).
    pub(super) fn new(mesh: &TriangleMesh, wanted: impl Fn(u32) -> bool) -> Result<Tree, Error> {
        let grid = Grid::of(mesh);
        let mut items = memory::with_capacity(mesh.triangles().len())?;
        for (corners, triangle) in mesh.triangles().iter().zip(0..) {
            if wanted(triangle) {
                let mut around = Box3::NONE;
                for &vertex in corners {
                    let at = grid.rounded(&mesh.vertices()[vertex as usize]);
                    around.include(&Box3 { low: at, high: at });
                }
                items.push(Item { around, triangle });
            }
        }
        let mut levels = 0;
        while items.len() >> levels > FEW {
            levels += 1;
        }
        let nodes = memory::filled(2 << levels, Box3::NONE)?;
        let mut tree = Tree { grid, items, nodes, levels };
        tree.arrange(1, 0, tree.items.len());
        Ok(tree)
    }

    /// Sorts the items of a node by halves, and finds the boxes. The recursion is as deep as the tree.
    fn arrange(&mut self, node: usize, first: usize, end: usize) {
        let is_leaf = self.is_leaf(node);
        let items = &mut self.items[first..end];
        let mut around = Box3::NONE;
        items.iter().for_each(|item| around.include(&item.around));
        self.nodes[node] = around;
        if is_leaf {
            return;
        }
        let axis = (1..3).fold(0, |most, axis| {
            let extent = |axis: usize| around.high[axis] - around.low[axis];
            if extent(axis) > extent(most) { axis } else { most }
        });
        let half = items.len() / 2;
        if half < items.len() {
            items.select_nth_unstable_by(half, |a, b| {
                a.around.middle(axis).total_cmp(&b.around.middle(axis)).then(a.triangle.cmp(&b.triangle))
            });
        }
        self.arrange(2 * node, first, first + half);
        self.arrange(2 * node + 1, first + half, end);
    }

    /// The root, with all items.
    pub(super) fn root(&self) -> Part {
        (1, 0, self.items.len())
    }

    pub(super) fn is_leaf(&self, node: usize) -> bool {
        node >> self.levels != 0
    }

    /// Calls `visit` with each pair of triangles whose boxes meet, until it returns `false`. What it returns
    /// depends on the mesh alone, and so does the order of the pairs.
    pub(super) fn pairs(
        &self,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        self.pairs_in(self.root(), steps, visit)
    }

    pub(super) fn halves(&self, (node, first, end): Part) -> [Part; 2] {
        let middle = first + (end - first) / 2;
        [(2 * node, first, middle), (2 * node + 1, middle, end)]
    }

    fn pairs_in(
        &self,
        part: Part,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        let (node, first, end) = part;
        if self.is_leaf(node) {
            if !steps.take((end - first).pow(2)) {
                return Ok(Search::Exhausted);
            }
            for k in first..end {
                for other in first..k {
                    if !self.visit(other, k, visit)? {
                        return Ok(Search::Ended);
                    }
                }
            }
            return Ok(Search::Finished);
        }
        let [low, high] = self.halves(part);
        for half in [low, high] {
            let search = self.pairs_in(half, steps, visit)?;
            if search != Search::Finished {
                return Ok(search);
            }
        }
        self.pairs_between(low, high, steps, visit)
    }

    /// Of two nodes of one level.
    fn pairs_between(
        &self,
        a: Part,
        b: Part,
        steps: &mut Steps,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<Search, Error> {
        if !steps.take(1) {
            return Ok(Search::Exhausted);
        }
        if !self.nodes[a.0].touches(&self.nodes[b.0]) {
            return Ok(Search::Finished);
        }
        if self.is_leaf(a.0) {
            if !steps.take((a.2 - a.1) * (b.2 - b.1)) {
                return Ok(Search::Exhausted);
            }
            for i in a.1..a.2 {
                for k in b.1..b.2 {
                    if !self.visit(i, k, visit)? {
                        return Ok(Search::Ended);
                    }
                }
            }
            return Ok(Search::Finished);
        }
        for of_a in self.halves(a) {
            for of_b in self.halves(b) {
                let search = self.pairs_between(of_a, of_b, steps, visit)?;
                if search != Search::Finished {
                    return Ok(search);
                }
            }
        }
        Ok(Search::Finished)
    }

    #[inline(always)]
    fn visit(
        &self,
        i: usize,
        k: usize,
        visit: &mut impl FnMut(u32, u32) -> Result<bool, Error>,
    ) -> Result<bool, Error> {
        let (a, b) = (&self.items[i], &self.items[k]);
        if !a.around.touches(&b.around) {
            return Ok(true);
        }
        visit(a.triangle.min(b.triangle), a.triangle.max(b.triangle))
    }

    /// Calls `visit` with each triangle whose box the line through `p` along `axis` meets.
    pub(super) fn on_line(&self, p: &Point, axis: usize, visit: &mut impl FnMut(u32)) {
        let at = self.grid.rounded(p);
        let mut low = at;
        let mut high = at;
        (low[axis], high[axis]) = (f32::NEG_INFINITY, f32::INFINITY);
        self.within(self.root(), &Box3 { low, high }, visit);
    }

    fn within(&self, part: Part, line: &Box3, visit: &mut impl FnMut(u32)) {
        let (node, first, end) = part;
        if !self.nodes[node].touches(line) {
            return;
        }
        if self.is_leaf(node) {
            let items = self.items[first..end].iter().filter(|item| item.around.touches(line));
            items.for_each(|item| visit(item.triangle));
            return;
        }
        self.halves(part).into_iter().for_each(|half| self.within(half, line, visit));
    }
}

/// A node with its items: from the first to before the end.
pub(super) type Part = (usize, usize, usize);
