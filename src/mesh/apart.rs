//! The distance of two meshes: a descent of both trees, nearest boxes first.
//!
//! The second mesh may be placed by an affine map. Its vertices and its tree are not transformed: a box
//! becomes a box around its image when the search visits it, and triangles likewise. All coordinates are
//! relative to the middle of the first mesh, scaled by a power of two so that no magnitude exceeds 1. Meshes
//! that are far from the origin therefore lose no precision.

use super::discs::Discs;
use super::intersections::{corners, meet};
use super::nearest::TriangleTree;
use super::signs::Point;
use super::tree::{Node, Place, Tree, WIDTH};
use super::triangle_pair::{NearPair, SLACK, at_least, dot, gap_along, nearest, surely_cross};
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{Expansion, sqrt, two_product};
use crate::lattice::{Affine, Interval};
use crate::memory;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// Maximum distance by which boxes of a tree may miss their triangles, in the units of its grid.
const BOX: f64 = 1.0 / (1 << 24) as f64;

/// An upper bound of the rounding errors of a box.
const MARGIN: f64 = 1.0 / (1_u64 << 47) as f64;

/// The relative amount by which a distance of boxes may be rounded up.
const ROOT: f64 = 1e-12;

/// Pairs of nodes between two checks for cancelling.
const OFTEN: u64 = 256;

/// The triangles of a mesh that take part.
#[derive(Clone, Copy)]
pub(crate) struct Facets<'m> {
    pub tree: TriangleTree<'m>,
    /// True for the triangles that take part; empty if all do.
    pub chosen: &'m [bool],
    /// The discs, if they were made.
    pub discs: Option<&'m Discs>,
}

/// The conditions that end a search, in model units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Enough {
    /// The search ends when the bounds are no further apart.
    pub tolerance: f64,
    /// The search ends when the lower bound is at least this.
    pub lower: f64,
    /// The search ends when the upper bound is less than this.
    pub upper: f64,
    /// Maximum number of node pairs to visit.
    pub steps: u64,
}

/// Bounds of the distance of two meshes, in model units.
pub(crate) struct Apart {
    /// The least distance of two triangles, one from each mesh.
    pub distance: Interval,
    /// The nearest triangles that were found.
    pub nearest: Option<NearTriangles>,
    /// True if two triangles are proven to have a common point.
    pub is_sure_contact: bool,
    /// True if the steps were spent before an end condition held.
    pub is_spent: bool,
}

/// Two triangles that are near to each other, with a point on each.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NearTriangles {
    pub triangles: [u32; 2],
    /// The weights of the corners for the point on each triangle.
    pub weights: [[f64; 3]; 2],
    /// The vector from the first point to the second, in any unit.
    pub way: Point,
}

/// Two meshes and the map between them.
pub(crate) struct MeshPair<'m> {
    own: Facets<'m>,
    other: Facets<'m>,
    map: Map,
    /// Maximum distance of the facets from the true surfaces, summed over both meshes, due to moved vertices.
    off: f64,
}

/// The map from both meshes to common coordinates.
struct Map {
    /// A power of two.
    scale: f64,
    /// The middles of the meshes' boxes, relative to which coordinates are small.
    middles: [Point; 2],
    /// Linear map from the second mesh's middle; `None` if the mesh is not moved.
    linear: Option<[Point; 3]>,
    offset: Point,
}

impl Map {
    fn new(own: &TriangleTree<'_>, other: &TriangleTree<'_>, placement: Option<&Affine>) -> Map {
        let middles = [own, other].each(|side| side.tree.grid.centre);
        let offset: Point = array(|axis| match placement {
            None => middles[1][axis] - middles[0][axis],
            Some(placement) => {
                let [x, y, z, moved] = placement.rows()[axis];
                let products: [_; 3] = array(|k| two_product([x, y, z][k], middles[1][k]));
                let parts = products.iter().flat_map(|&(high, low)| [low, high]);
                Expansion::sum(parts.chain([moved, -middles[0][axis]])).estimate()
            }
        });
        let length = |p: &Point| sqrt(dot(p, p));
        let reach = |side: &TriangleTree<'_>| {
            let Some(around) = side.tree.around() else { return 0.0 };
            let extent = |axis: usize| f64::from(around.high[axis].abs().max(around.low[axis].abs())) + BOX;
            length(&array(extent)) / side.tree.grid.scale()
        };
        let stretch = placement
            .map_or(1.0, |placement| length(&placement.rows().each(|[x, y, z, _]| length(&[x, y, z]))));
        let all = (reach(own) + stretch * reach(other) + length(&offset)) * (1.0 + 1e-9);
        let exponent = ((all.to_bits() >> 52) as i32 - 1023 + 1).clamp(-1000, 1000);
        let scale = f64::from_bits(((1023 - exponent) as u64) << 52);
        let linear =
            placement.map(|placement| placement.rows().each(|[x, y, z, _]| [x, y, z].each(|c| c * scale)));
        Map { scale, middles, linear, offset: offset.each(|c| c * scale) }
    }

    fn own(&self, p: &Point) -> Point {
        array(|axis| (p[axis] - self.middles[0][axis]) * self.scale)
    }

    fn other(&self, p: &Point) -> Point {
        match &self.linear {
            None => self.own(p),
            Some(linear) => {
                let from: Point = array(|axis| p[axis] - self.middles[1][axis]);
                array(|axis| dot(&linear[axis], &from) + self.offset[axis])
            }
        }
    }
}

/// The axes of the second mesh's boxes, if the map moves the boxes without changing their shape.
struct Turned {
    axes: [Axis; 3],
    /// An upper bound of the length of a unit vector's image.
    size: f64,
}

/// An axis of the second mesh's boxes: its number, and the unit vector to which it is mapped.
struct Axis {
    number: usize,
    way: Point,
}

impl Turned {
    /// Returns the axes after the linear map from the grid of the second mesh; `None` if boxes change shape.
    fn new(linear: &[Point; 3]) -> Option<Turned> {
        let columns: [Point; 3] = array(|k| linear.each(|row| row[k]));
        let sizes = columns.each(|column| sqrt(dot(&column, &column)));
        let axes = array(|number| {
            let size = sizes[number];
            Axis { number, way: columns[number].each(|c| c / size) }
        });
        let is_alike = |size: &f64| (size / sizes[0] - 1.0).abs() < 0.1 * ROOT;
        let is_square = [[0, 1], [0, 2], [1, 2]]
            .iter()
            .all(|&[i, j]| dot(&columns[i], &columns[j]).abs() < 0.1 * ROOT * sizes[i] * sizes[j]);
        // (The remaining obliqueness lets a box stick out by less than that part of its size.)
        (is_square && sizes.iter().all(is_alike)).then(|| Turned { axes, size: sizes[0] * (1.0 + ROOT) })
    }
}

/// Four boxes in common coordinates: middles, and half extents including rounding errors.
struct Boxes {
    middle: [[f64; WIDTH]; 3],
    half: [[f64; WIDTH]; 3],
    /// Half extents before the boxes are moved.
    own: [[f64; WIDTH]; 3],
}

impl Boxes {
    const NONE: Boxes = Boxes { middle: [[0.0; WIDTH]; 3], half: [[0.0; WIDTH]; 3], own: [[0.0; WIDTH]; 3] };

    /// Returns the boxes of a node of the first mesh. `unit` is the unit of the tree's grid.
    #[inline(always)]
    fn own(node: &Node, unit: f64) -> Boxes {
        let mut boxes = Boxes::NONE;
        let margin = BOX * unit + MARGIN;
        for axis in 0..3 {
            let [low, high] = &node.planes[axis];
            for k in 0..WIDTH {
                let (low, high) = (f64::from(low[k]), f64::from(high[k]));
                boxes.middle[axis][k] = (high + low) * (0.5 * unit);
                boxes.half[axis][k] = (high - low) * (0.5 * unit) + margin;
            }
        }
        boxes
    }

    /// Returns the boxes around the images of these boxes.
    #[inline(always)]
    fn moved(&self, linear: &[Point; 3], offset: &Point) -> Boxes {
        let mut boxes = Boxes { own: self.half, ..Boxes::NONE };
        for axis in 0..3 {
            let [x, y, z] = linear[axis];
            for k in 0..WIDTH {
                let Boxes { middle, half, .. } = self;
                boxes.middle[axis][k] = x * middle[0][k] + y * middle[1][k] + z * middle[2][k] + offset[axis];
                boxes.half[axis][k] =
                    x.abs() * half[0][k] + y.abs() * half[1][k] + z.abs() * half[2][k] + MARGIN;
            }
        }
        boxes
    }

    /// Returns the squared distances of box k from the others, and of the distances of their middles. For
    /// turned boxes the axes of both are tried as separating directions.
    #[inline(always)]
    fn squares(&self, k: usize, others: &Boxes, turned: Option<&Turned>) -> ([f64; WIDTH], [f64; WIDTH]) {
        let (mut squares, mut between) = ([0.0; WIDTH], [0.0; WIDTH]);
        for axis in 0..3 {
            let (middle, half) = (self.middle[axis][k], self.half[axis][k]);
            for n in 0..WIDTH {
                let way = others.middle[axis][n] - middle;
                let gap = way.abs() - (half + others.half[axis][n]);
                let gap = if gap > 0.0 { gap } else { 0.0 };
                squares[n] += gap * gap;
                between[n] += way * way;
            }
        }
        if let Some(Turned { axes, size }) = turned {
            let mut along = [0.0; WIDTH];
            for axis in axes {
                let [x, y, z] = axis.way;
                let half = x.abs() * self.half[0][k] + y.abs() * self.half[1][k] + z.abs() * self.half[2][k];
                let own = &others.own[axis.number];
                for n in 0..WIDTH {
                    let way = x * (others.middle[0][n] - self.middle[0][k])
                        + y * (others.middle[1][n] - self.middle[1][k])
                        + z * (others.middle[2][n] - self.middle[2][k]);
                    let gap = way.abs() - (half + size * own[n] + ROOT);
                    let gap = if gap > 0.0 { gap } else { 0.0 };
                    along[n] += gap * gap;
                }
            }
            for n in 0..WIDTH {
                let square = along[n] * (1.0 - ROOT);
                squares[n] = if square > squares[n] { square } else { squares[n] };
            }
        }
        (squares, between)
    }

    /// Returns the ends of the boxes along a direction of length 1.
    #[inline(always)]
    fn ends(&self, way: &Point) -> [f64; WIDTH] {
        let Boxes { middle, half, .. } = self;
        array(|k| {
            let along = |axis: usize| way[axis] * middle[axis][k] + way[axis].abs() * half[axis][k];
            along(0) + along(1) + along(2) + MARGIN
        })
    }

    fn size(&self, k: usize) -> f64 {
        self.half[0][k] + self.half[1][k] + self.half[2][k]
    }
}

/// The nodes of a pair that are split.
#[derive(Clone, Copy, PartialEq)]
enum Split {
    Both,
    Own,
    Other,
}

/// A pair of nodes, and the square of a lower bound of their distance.
#[derive(Clone, Copy)]
struct Pair {
    square: f64,
    own: Place,
    other: Place,
    split: Split,
}

/// A triangle in common coordinates, with its end, towards the other mesh, along the direction between the
/// nearest triangles.
struct Loaded {
    triangle: u32,
    corners: [Point; 3],
    end: f64,
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// A pair of children: the square of the distance of their boxes, that of their middles, and their two
/// numbers.
type Parts = (f64, f64, u8, u8);

impl<'m> MeshPair<'m> {
    /// Makes a pair whose second mesh is placed by `placement`. The vertices of both meshes together may be
    /// displaced by `off` (model units).
    pub(crate) fn new(
        own: Facets<'m>,
        other: Facets<'m>,
        placement: Option<&Affine>,
        off: f64,
    ) -> MeshPair<'m> {
        let map = Map::new(&own.tree, &other.tree, placement);
        MeshPair { own, other, map, off }
    }

    /// Returns the distance of the meshes, as precisely as `enough` demands. The bounds hold for the
    /// triangles as given, moved exactly.
    ///
    /// About O(log n) for meshes that are near to each other in one place; O(n) if they run alongside each
    /// other.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`].
    pub(crate) fn apart(&self, enough: &Enough, job: &Job<'_>) -> Result<Apart, Error> {
        let scale = self.map.scale;
        let unit = self.other.tree.tree.grid.scale();
        let linear = match &self.map.linear {
            Some(linear) => linear.each(|row| row.each(|c| c / unit)),
            None => array(|axis| array(|k| if k == axis { scale / unit } else { 0.0 })),
        };
        let mut search = Search {
            pair: self,
            unit: scale / self.own.tree.tree.grid.scale(),
            linear,
            turned: if self.map.linear.is_some() { Turned::new(&linear) } else { None },
            enough: Enough {
                // (Smaller, so that rounding does not widen the bounds too much.)
                tolerance: (enough.tolerance * scale * (1.0 - 1e-6)).max(2.0 * SLACK),
                // (Distances of boxes are rounded down by less than this.)
                lower: enough.lower * scale * (1.0 + 4.0 * ROOT),
                upper: enough.upper * scale,
                steps: enough.steps,
            },
            open: Vec::new(),
            best: None,
            towards: [0.0; 3],
            next_towards: [0.0; 3],
            upper: f64::INFINITY,
            limit: f64::INFINITY,
            settled: f64::INFINITY,
            beyond: f64::INFINITY,
            is_sure_contact: false,
        };
        search.limit = search.enough.lower;
        let is_spent = search.run(job)?;
        let open = search.open.iter().fold(f64::INFINITY, |least: f64, pair| least.min(pair.square));
        let boxes = sqrt(open.min(search.beyond)) * (1.0 - ROOT);
        let lower = if search.is_sure_contact { 0.0 } else { search.settled.min(boxes).max(0.0) };
        let upper = if search.is_sure_contact { 0.0 } else { search.upper };
        let distance = Interval::between(lower.min(upper) / scale, upper / scale);
        let nearest = search.best.map(|(triangles, NearPair { weights, way, .. })| NearTriangles {
            triangles,
            weights,
            way,
        });
        Ok(Apart { distance, nearest, is_sure_contact: search.is_sure_contact, is_spent })
    }
}

/// A running search, in common coordinates.
struct Search<'s, 'm> {
    pair: &'s MeshPair<'m>,
    /// The unit of the first tree's grid.
    unit: f64,
    /// Linear map from the second tree's grid.
    linear: [Point; 3],
    turned: Option<Turned>,
    enough: Enough,
    open: Vec<Pair>,
    best: Option<([u32; 2], NearPair)>,
    /// The direction along which loaded triangles were measured, and the direction between the best ones: of
    /// length 1, or zero.
    towards: Point,
    next_towards: Point,
    upper: f64,
    /// Pairs at this distance or more cannot change the result.
    limit: f64,
    /// The least lower bound of the triangle pairs that were compared.
    settled: f64,
    /// The least squared distance of the box pairs that were left out.
    beyond: f64,
    is_sure_contact: bool,
}

impl<'m> Search<'_, 'm> {
    fn trees(&self) -> [&'m Tree; 2] {
        [self.pair.own.tree.tree, self.pair.other.tree.tree]
    }

    fn boxes_of_own(&self, node: &Node) -> Boxes {
        Boxes::own(node, self.unit)
    }

    fn boxes_of_other(&self, node: &Node) -> Boxes {
        Boxes::own(node, 1.0).moved(&self.linear, &self.pair.map.offset)
    }

    /// Runs the search. Returns whether the steps were spent.
    fn run(&mut self, job: &Job<'_>) -> Result<bool, Error> {
        let [Some(own), Some(other)] = self.trees().each(Tree::root) else { return Ok(false) };
        memory::push(&mut self.open, Pair { square: 0.0, own, other, split: Split::Both })?;
        let mut steps = 0;
        while let Some(pair) = self.open.pop() {
            if pair.square >= self.limit * self.limit || self.is_known() {
                self.beyond = self.beyond.min(pair.square);
                continue;
            }
            if steps == self.enough.steps {
                memory::push(&mut self.open, pair)?;
                return Ok(true);
            }
            if steps % OFTEN == 0 {
                job.check()?;
            }
            steps += 1;
            self.split(&pair)?;
        }
        Ok(false)
    }

    /// Returns whether an end condition holds.
    fn is_known(&self) -> bool {
        self.is_sure_contact || self.upper < self.enough.upper || self.limit <= 0.0
    }

    fn split(&mut self, pair: &Pair) -> Result<(), Error> {
        let &Pair { own, other, split, .. } = pair;
        let [of_own, of_other] = self.trees();
        let splits = match (own.level, other.level, split) {
            (0, 0, _) => [true, true],
            (0, ..) | (_, 1.., Split::Other) => [false, true],
            (_, 0, _) | (_, _, Split::Own) => [true, false],
            _ => [true, true],
        };
        let mut loaded = None;
        if own.level == 0 && other.level == 0 {
            self.towards = self.next_towards;
            let Some(triangles) = self.load(own, other) else { return Ok(()) };
            loaded = Some(triangles);
        }
        let whole = |node: &Node| node.around();
        let (node, counterpart) = (of_own.node(own), of_other.node(other));
        let boxes =
            if splits[0] { self.boxes_of_own(node) } else { self.boxes_of_own(&Node::of(&whole(node))) };
        let others = if splits[1] {
            self.boxes_of_other(counterpart)
        } else {
            self.boxes_of_other(&Node::of(&whole(counterpart)))
        };
        let counts = [
            if splits[0] { of_own.parts(own) } else { 1 },
            if splits[1] { of_other.parts(other) } else { 1 },
        ];
        let mut parts: [Parts; WIDTH * WIDTH] = [(0.0, 0.0, 0, 0); WIDTH * WIDTH];
        let mut count = 0;
        let limit = self.limit * self.limit;
        let way = self.next_towards;
        let back = way.each(|c| -c);
        let (mut ends, mut starts) = (boxes.ends(&way), others.ends(&back));
        if own.level > 0 && splits[0] {
            let unit = self.unit;
            self.sharpen(0, own, &mut ends, (&way.each(|c| c * unit), 0.0));
        }
        if other.level > 0 && splits[1] {
            let from_grid: Point = array(|k| (0..3).map(|axis| back[axis] * self.linear[axis][k]).sum());
            self.sharpen(1, other, &mut starts, (&from_grid, dot(&back, &self.pair.map.offset)));
        }
        for k in 0..counts[0] {
            let (squares, between) = boxes.squares(k, &others, self.turned.as_ref());
            for n in 0..counts[1] {
                // (Children are no nearer than their parents.)
                let gap = larger(-starts[n] - ends[k], 0.0);
                let square = larger(squares[n], larger(gap * gap, pair.square));
                if square < limit {
                    let part = (square, between[n], k as u8, n as u8);
                    let place = parts[..count].partition_point(|one| (one.0, one.1) <= (part.0, part.1));
                    parts.copy_within(place..count, place + 1);
                    parts[place] = part;
                    count += 1;
                } else {
                    self.beyond = self.beyond.min(square);
                }
            }
        }
        if let Some(loaded) = loaded {
            self.compare(&loaded, &parts[..count]);
            return Ok(());
        }
        self.open.try_reserve(count)?;
        // Push the nearest pair last, so that it is visited next.
        for &(square, _, k, n) in parts[..count].iter().rev() {
            let (k, n) = (usize::from(k), usize::from(n));
            let (size, of_other) = (boxes.size(k), others.size(n));
            let split = if size > 2.0 * of_other {
                Split::Own
            } else if of_other > 2.0 * size {
                Split::Other
            } else {
                Split::Both
            };
            let own = if splits[0] { own.child(k) } else { own };
            let other = if splits[1] { other.child(n) } else { other };
            self.open.push(Pair { square, own, other, split });
        }
        Ok(())
    }

    /// Lowers the ends of a node's children along a direction to the ends of their discs. `way` is the
    /// direction in the units of the grid, and `offset` is added to the ends of discs.
    #[inline(always)]
    fn sharpen(&self, side: usize, place: Place, ends: &mut [f64; WIDTH], (way, offset): (&Point, f64)) {
        let (facets, tree) = ([&self.pair.own, &self.pair.other][side], self.trees()[side]);
        let Some(discs) = facets.discs else { return };
        for (k, end) in ends.iter_mut().enumerate().take(tree.parts(place)) {
            if let Some(of_disc) = discs.end(tree, place.child(k), way) {
                let of_disc = of_disc + offset + MARGIN;
                *end = if of_disc < *end { of_disc } else { *end };
            }
        }
    }

    /// Compares the triangles of two lowest nodes.
    fn compare(&mut self, [own, other]: &[[Option<Loaded>; WIDTH]; 2], parts: &[Parts]) {
        for &(square, _, k, n) in parts {
            if square >= self.limit * self.limit || self.is_known() {
                self.beyond = self.beyond.min(square);
                continue;
            }
            if let [Some(a), Some(b)] = [&own[usize::from(k)], &other[usize::from(n)]] {
                self.take(a, b);
            }
        }
    }

    /// Loads the triangles of two lowest nodes. `None` if all are too far apart along the direction between
    /// the nearest triangles so far.
    fn load(&mut self, own: Place, other: Place) -> Option<[[Option<Loaded>; WIDTH]; 2]> {
        let [of_own, of_other] = self.trees();
        let MeshPair { own: facets, other: counterparts, map, .. } = self.pair;
        let towards = self.towards;
        let (mut greatest, mut least) = (f64::NEG_INFINITY, f64::INFINITY);
        let first = array(|k| {
            let triangle = of_own.triangle(own, k).filter(|&triangle| facets.counts(triangle))?;
            let corners = corners(facets.tree.mesh, triangle).each(|p| map.own(&p));
            let [x, y, z] = corners.each_ref().each(|p| dot(&towards, p));
            let end = larger(x, larger(y, z));
            greatest = larger(greatest, end);
            Some(Loaded { triangle, corners, end })
        });
        let second = array(|n| {
            let triangle = of_other.triangle(other, n).filter(|&triangle| counterparts.counts(triangle))?;
            let corners = corners(counterparts.tree.mesh, triangle).each(|p| map.other(&p));
            let [x, y, z] = corners.each_ref().each(|p| -dot(&towards, p));
            let end = -larger(x, larger(y, z));
            least = -larger(-least, -end);
            Some(Loaded { triangle, corners, end })
        });
        let gap = least - greatest - SLACK;
        if gap >= self.limit {
            self.settled = self.settled.min(gap);
            return None;
        }
        Some([first, second])
    }

    /// Compares two triangles and updates the bounds.
    fn take(&mut self, first: &Loaded, second: &Loaded) {
        // Most are too far apart along the direction between the nearest triangles so far, or between their
        // middles.
        let gap = second.end - first.end - SLACK;
        if gap >= self.limit {
            self.settled = self.settled.min(gap);
            return;
        }
        let (a, b) = (&first.corners, &second.corners);
        let middle = |t: &[Point; 3], axis: usize| t[0][axis] + t[1][axis] + t[2][axis];
        let between: Point = array(|axis| middle(b, axis) - middle(a, axis));
        let gap = gap_along(&between, a, b);
        let least = self.limit + SLACK;
        if gap > 0.0 && gap * gap >= least * least * dot(&between, &between) * (1.0 + ROOT) {
            self.settled = self.settled.min(self.limit);
            return;
        }
        let near = nearest(a, b);
        self.settled = self.settled.min(at_least(&near, a, b));
        let triangles = [first.triangle, second.triangle];
        if self.best.as_ref().is_none_or(|(_, best)| near.square < best.square) {
            self.best = Some((triangles, near));
            self.upper = (sqrt(near.square) + SLACK).next_up();
            self.limit = (self.upper - self.enough.tolerance).min(self.enough.lower);
            if near.square > SLACK * SLACK {
                let length = sqrt(near.square);
                self.next_towards = near.way.each(|c| c / length);
            }
        }
        if near.square <= SLACK * SLACK {
            self.is_sure_contact |= self.is_contact(triangles, a, b);
        }
    }

    /// Returns whether two triangles are proven to have a common point.
    fn is_contact(&self, triangles: [u32; 2], a: &[Point; 3], b: &[Point; 3]) -> bool {
        let MeshPair { own, other, map, off } = self.pair;
        if *off == 0.0 && map.linear.is_none() {
            let meshes = [own.tree.mesh, other.tree.mesh];
            let has_area = |k: usize| {
                let mesh = meshes[k];
                !mesh.is_flat(&mesh.triangles()[triangles[k] as usize])
            };
            let [first, second] = [0, 1].each(|k| corners(meshes[k], triangles[k]));
            return has_area(0) && has_area(1) && meet(&first, &second, || false);
        }
        surely_cross(a, b, off * map.scale + SLACK)
    }
}

impl Facets<'_> {
    fn counts(&self, triangle: u32) -> bool {
        self.chosen.is_empty() || self.chosen[triangle as usize]
    }

    /// Makes the discs around the triangles. O(t).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn make_discs(&self) -> Result<Discs, Error> {
        Discs::new(self.tree.mesh, self.tree.tree)
    }

    /// Returns one vertex of each connected part of the triangles that take part. O(t).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn one_of_each_part(&self) -> Result<Vec<Point>, Error> {
        let mesh = self.tree.mesh;
        let mut sets = super::topology::DisjointSets::new(mesh.vertices().len())?;
        let mut is_used = memory::filled(mesh.vertices().len(), false)?;
        for (triangle, &[a, b, c]) in (0..).zip(mesh.triangles()) {
            if self.counts(triangle) {
                sets.unite(a, b);
                sets.unite(a, c);
                is_used[a as usize] = true;
            }
        }
        // Sets are numbered by their first members: a new set number is greater than all earlier ones.
        let mut vertices = Vec::new();
        let numbers = sets.numbers();
        let count = numbers.iter().max().map_or(0, |&last| last as usize + 1);
        let mut is_met = memory::filled(count, false)?;
        for (vertex, &number) in numbers.iter().enumerate() {
            if is_used[vertex] && !core::mem::replace(&mut is_met[number as usize], true) {
                memory::push(&mut vertices, mesh.vertices()[vertex])?;
            }
        }
        Ok(vertices)
    }
}
