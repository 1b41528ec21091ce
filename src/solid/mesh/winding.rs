//! Winding numbers of open surfaces.
//!
//! The *winding number* of a surface at a point is the solid angle at which it is seen from there, with a sign,
//! over 4π (Jacobson, Kavan and Sorkine-Hornung 2013). Of a closed surface it is an integer. What an open one lacks are
//! surfaces over the loops of its boundary, *caps*. Surface and caps together are closed, so that their winding
//! number N is found exactly, as an integer, by counting what lines pierce. The surface's own is then N − c with c
//! the winding number of the caps alone: a sum over as many triangles as the boundary has edges, and not over
//! the whole surface. Which caps are chosen does not matter, because their jumps cancel.
//!
//! The caps' winding number is a sum of solid angles (van Oosterom and Strackee 1983), in which a far group of
//! triangles is replaced by the first two terms of its expansion (Barill, Dickson, Schmidt, Levin and
//! Jacobson 2018), here with a bound of what that leaves out. The distance at which a group is far is a parameter:
//! whoever needs a smaller error asks again.
//!
//! Away from the surface the winding number is smooth. Its gradient is the magnetic field of a current along the
//! *boundary* (the law of Biot and Savart), and its second derivative at most Σ ∫ 2 ds / (4π·distance³) over the
//! boundary's edges. One sum thus bounds it on a whole cell, and serves many cells inside of that.

use super::boundary::Loops;
use super::crossing::Projection;
use super::placed::{Placed, Vertex, ranks};
use crate::error::Error;
use crate::lattice::exact::sqrt;
use alloc::vec::Vec;
use core::f64::consts::PI;
use glam::{DMat3, DVec3};

/// Triangles that are summed one by one.
const LEAF: usize = 4;

const SCALE: f64 = 1.0 / (4.0 * PI);

/// What a group of triangles may add to the error when it is taken together.
const ENOUGH: f64 = 1.0 / 16384.0;

/// Triangles that close a surface, in the order of a tree of bounding spheres.
#[derive(Default)]
pub(super) struct Caps {
    triangles: Vec<[u32; 3]>,
    /// Bit i: the edge from corner i to corner i + 1 is one of the surface's boundary.
    rims: Vec<u8>,
    nodes: Vec<Node>,
    /// How far the boundary may lie from where its vertices are placed, in finest cells.
    wobble: f64,
    /// Bound of the error of a vertex's position per axis.
    error: f64,
}

/// A group of caps, all that the tree has below it.
#[derive(Clone, Copy)]
struct Node {
    /// A sphere around them.
    centre: DVec3,
    radius: f64,
    /// ∫ dA.
    area: DVec3,
    /// ∫ dA ⊗ (y − centre).
    moment: DMat3,
    /// ∫ |dA|, and ∫ |y − centre|² |dA|.
    size: f64,
    spread: f64,
    /// Bound of ∫ |y − centre| |dA|.
    arm: f64,
    /// Length of the boundary's edges.
    rim: f64,
    first: u32,
    end: u32,
    /// The node after the last one below this; the next one if this is a leaf.
    skip: u32,
}

/// The caps' winding number in a ball around a point, to first order. It jumps by an integer on every cap; this is its
/// smooth continuation from the point.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Local {
    point: DVec3,
    value: f64,
    gradient: DVec3,
    /// Bounds of the value's error, of the gradient's, and of the second derivative anywhere in the ball; infinite or not
    /// a number if nothing is known.
    error: f64,
    slant: f64,
    bend: f64,
}

/// Which groups of caps are far from a ball, and which are not.
#[derive(Default)]
pub(super) struct Nearby {
    far: Local,
    /// Nodes, none below another.
    near: Vec<u32>,
}

/// A range of winding numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    /// Around this,
    pub(super) value: f64,
    /// that much off for its slope, and
    pub(super) change: f64,
    /// that much more at most for what is not known.
    pub(super) doubt: f64,
}

impl Range {
    /// Nothing is known.
    pub(super) const UNKNOWN: Range = Range { value: 0.0, change: 0.0, doubt: f64::INFINITY };

    pub(super) fn plus(self, step: i32) -> Range {
        Range { value: self.value + step as f64, ..self }
    }
}

impl Local {
    /// In the ball of the given radius around the point it was made for.
    pub(super) fn within(&self, radius: f64) -> Range {
        let change = length(self.gradient) * radius;
        Range { value: self.value, change, doubt: self.doubt(radius) }
    }

    /// In a cube with the lower corner `at`, which must lie in the ball it was made for.
    pub(super) fn over(&self, at: [i32; 3], size: i32) -> Range {
        let half = size as f64 / 2.0;
        let middle = DVec3::from(at.map(|a| a as f64 + half)) - self.point;
        let gradient = self.gradient.abs();
        Range {
            value: self.value + self.gradient.dot(middle),
            change: half * (gradient.x + gradient.y + gradient.z),
            doubt: self.doubt(length(middle.abs() + half)),
        }
    }

    /// At the centre of a cell.
    pub(super) fn at_centre(&self, cell: [i32; 3]) -> Range {
        let to = DVec3::from(cell.map(|a| a as f64 + 0.5)) - self.point;
        Range { value: self.value + self.gradient.dot(to), change: 0.0, doubt: self.doubt(length(to)) }
    }

    fn doubt(&self, distance: f64) -> f64 {
        // The factor outweighs the roundings of all these bounds.
        (self.error + (self.slant + 0.5 * self.bend * distance) * distance) * (1.0 + 1e-6) + 1e-12
    }

    /// The same around another point of the ball.
    fn moved_to(&self, point: DVec3) -> Local {
        let step = point - self.point;
        let distance = length(step);
        Local {
            point,
            value: self.value + self.gradient.dot(step),
            gradient: self.gradient,
            error: self.error + (self.slant + 0.5 * self.bend * distance) * distance,
            slant: self.slant + self.bend * distance,
            bend: self.bend,
        }
    }
}

impl Caps {
    /// Caps over the loops of a surface's boundary, whose vertices are given with their places.
    ///
    /// O(n log n) in the boundary's edges, of which there are never fewer than caps; 40 to 100 bytes for each.
    pub(super) fn new(loops: &Loops, vertices: &[Vertex], displacement: f64) -> Result<Caps, Error> {
        let count = loops.iter().map(|walk| walk.len() - 2).sum::<usize>();
        let mut caps = Caps::default();
        caps.triangles.try_reserve_exact(count).map_err(|_| Error::OutOfMemory)?;
        caps.rims.try_reserve_exact(count).map_err(|_| Error::OutOfMemory)?;
        if u32::try_from(count).is_err() {
            return Err(Error::OutOfMemory);
        }
        let mut slots = Vec::new();
        slots.try_reserve_exact(count).map_err(|_| Error::OutOfMemory)?;
        let mut error = 0f32;
        for walk in loops.iter() {
            for &vertex in walk {
                error = vertices[vertex as usize].error.into_iter().fold(error, f32::max);
            }
            // The loop backward, so that its edges cancel those of the surface. By halves, not as a fan: most caps
            // are then as small as the edges that they lie at, and groups of them are far from most places.
            halve(walk.len(), &mut |[a, b, c], rims| {
                slots.push((([a, b, c]).map(|corner| walk[corner]), rims));
            });
        }
        caps.error = error as f64;
        caps.wobble = 2.0 * (caps.error + displacement);
        caps.nodes
            .try_reserve_exact(2 * count.div_ceil(LEAF).next_power_of_two())
            .map_err(|_| Error::OutOfMemory)?;
        let at = |vertex: u32| DVec3::from(vertices[vertex as usize].at);
        if count > 0 {
            caps.grow(&mut slots, 0, &at)?;
        }
        caps.triangles.extend(slots.iter().map(|slot| slot.0));
        caps.rims.extend(slots.iter().map(|slot| slot.1));
        Ok(caps)
    }

    /// Adds the subtree of `slots`, the first of which is number `first`, and puts them in its order.
    fn grow(
        &mut self,
        slots: &mut [([u32; 3], u8)],
        first: usize,
        at: &impl Fn(u32) -> DVec3,
    ) -> Result<(), Error> {
        let node = Node::around(slots, first, at);
        let index = self.nodes.len();
        self.nodes.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
        self.nodes.push(node);
        if slots.len() > LEAF {
            // Halves, so that the depth is the logarithm whatever the coordinates are.
            let centroid = |slot: &([u32; 3], u8)| slot.0.iter().map(|&v| at(v)).sum::<DVec3>();
            let (low, high) = (slots.iter().map(centroid))
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
            let extent = (high - low).to_array();
            let axis = (0..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
            let middle = slots.len() / 2;
            slots.select_nth_unstable_by(middle, |a, b| {
                // Equal centroids are told apart by their corners: the order is the same on every machine.
                centroid(a)[axis].total_cmp(&centroid(b)[axis]).then(a.0.cmp(&b.0))
            });
            let (low, high) = slots.split_at_mut(middle);
            self.grow(low, first, at)?;
            self.grow(high, first + middle, at)?;
        }
        self.nodes[index].skip = self.nodes.len() as u32;
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// What is near and what is far of a ball, before anything is known.
    pub(super) fn everything(&self) -> Result<Nearby, Error> {
        let mut all = Nearby { far: Local::default(), near: Vec::new() };
        if !self.nodes.is_empty() {
            all.near.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
            all.near.push(0);
        }
        Ok(all)
    }

    /// What is near and what is far of the ball of `radius` around `point`, which lies in that of `outer`.
    pub(super) fn nearby(
        &self,
        outer: &Nearby,
        point: [f64; 3],
        radius: f64,
        inner: &mut Nearby,
    ) -> Result<(), Error> {
        inner.far = outer.far.moved_to(DVec3::from(point));
        inner.near.clear();
        for &item in &outer.near {
            let mut next = item as usize;
            while next < self.nodes[item as usize].skip as usize {
                let node = &self.nodes[next];
                if node.add(radius + self.wobble, ENOUGH, &mut inner.far) {
                    next = node.skip as usize;
                } else if node.radius <= radius || node.skip as usize == next + 1 {
                    inner.near.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
                    inner.near.push(next as u32);
                    next = node.skip as usize;
                } else {
                    next += 1;
                }
            }
        }
        Ok(())
    }

    /// The winding number around `point` to first order, within `radius` of it (both in finest cells from the frame's
    /// origin), which lies in the ball of `nearby`; a group adds at most `enough` to its error. `None` if the boundary passes
    /// through the ball.
    ///
    /// If the point is a cell's centre, `cell` says so, and the value is the one on that side of every cap on which
    /// the symbolic shift puts the centre. Otherwise a point on a cap may get the value of either side.
    pub(super) fn local(
        &self,
        placed: &Placed,
        nearby: &Nearby,
        point: [f64; 3],
        radius: f64,
        enough: f64,
        cell: Option<[i32; 3]>,
    ) -> Option<Local> {
        let radius = radius + self.wobble;
        let mut local = nearby.far.moved_to(DVec3::from(point));
        for &item in &nearby.near {
            let mut next = item as usize;
            while next < self.nodes[item as usize].skip as usize {
                let node = &self.nodes[next];
                if node.add(radius, enough, &mut local) {
                    next = node.skip as usize;
                    continue;
                }
                if node.skip as usize == next + 1 {
                    for cap in node.first as usize..node.end as usize {
                        self.add(placed, cap, radius, cell, &mut local)?;
                    }
                }
                next += 1;
            }
        }
        if self.wobble > 0.0 {
            // Where the boundary wobbles, the winding number changes as if the point did.
            local.error += self.wobble * (length(local.gradient) + local.slant + local.bend * radius);
        }
        Some(local)
    }

    /// Adds one cap.
    #[inline]
    fn add(
        &self,
        placed: &Placed,
        cap: usize,
        radius: f64,
        cell: Option<[i32; 3]>,
        sum: &mut Local,
    ) -> Option<()> {
        let corners = self.triangles[cap].map(|vertex| DVec3::from(placed.vertex(vertex).at) - sum.point);
        let lengths = corners.map(length);
        let inverses = lengths.map(|length| 1.0 / length);
        let [a, b, c] = [0, 1, 2].map(|i| corners[i] * inverses[i]);
        let (ab, bc, ca) = (a.dot(b), b.dot(c), c.dot(a));
        // Half the solid angle is the argument of (real, imaginary).
        let imaginary = a.dot(b.cross(c));
        let real = 1.0 + ab + bc + ca;
        let modulus = sqrt(real * real + imaginary * imaginary);
        let wrong = 64.0 * f64::EPSILON + 8.0 * self.error * (inverses[0] + inverses[1] + inverses[2]);
        // Also false for NaN.
        if modulus >= 2.0 * wrong {
            let mut angle = libm::atan2(imaginary, real);
            if real < 0.0
                && imaginary.abs() <= wrong
                && let Some(cell) = cell
            {
                match self.side(placed, cap, cell) {
                    Some(side) => angle = side * angle.abs(),
                    None => sum.error += 1.0,
                }
            }
            sum.value += angle / (2.0 * PI);
            sum.error += wrong / (3.0 * modulus);
        } else {
            sum.error += 1.0;
            if let Some(cell) = cell {
                // No proof, because the centre may lie beside the edge; but the best guess, and exact on it.
                sum.value += self.on_edge(placed, cap, cell, corners) / (2.0 * PI);
            }
        }
        for (i, cosine) in [ab, bc, ca].into_iter().enumerate() {
            if self.rims[cap] >> i & 1 != 0 {
                let j = (i + 1) % 3;
                sum.add_rim([corners[i], corners[j]], [lengths[i], lengths[j]], cosine, radius)?;
            }
        }
        Some(())
    }

    /// Half the solid angle of a cap on whose edge the centre of a cell lies, as seen from where the symbolic shift puts the
    /// centre: that of a half-plane. (Zero in a corner, where the surface has a vertex.) `corners` are relative to the
    /// centre.
    #[cold]
    fn on_edge(&self, placed: &Placed, cap: usize, cell: [i32; 3], corners: [DVec3; 3]) -> f64 {
        let units = corners.map(DVec3::normalize_or_zero);
        // Of that edge the ends lie in opposite directions.
        let cosines = [0, 1, 2].map(|i| units[i].dot(units[(i + 1) % 3]));
        let i = (0..3).fold(0, |least, i| if cosines[i] < cosines[least] { i } else { least });
        if cosines[i] >= -0.99 {
            return 0.0;
        }
        let along = (corners[(i + 1) % 3] - corners[i]).normalize_or_zero();
        let inward = corners[(i + 2) % 3].reject_from_normalized(along).normalize_or_zero();
        // Along x first; along y if that leads along the edge.
        let shift = DVec3::AXES.map(|axis| axis.reject_from_normalized(along));
        let Some(shift) = shift.into_iter().find(|shift| shift.length() > 1e-9) else {
            return 0.0;
        };
        let (sine, cosine) = (shift.dot(along.cross(inward)), shift.dot(inward));
        if sine.abs() > 1e-9 * shift.length() {
            return -sine.signum() * (PI - libm::atan2(sine.abs(), cosine));
        }
        // Within the cap's plane; out of the cap nothing of it is seen.
        let side = if cosine > 0.0 { self.side(placed, cap, cell) } else { None };
        side.unwrap_or(0.0) * PI
    }

    /// On which side of a cap the centre of a cell lies that is over it: 1 if the cap faces away from it.
    #[cold]
    fn side(&self, placed: &Placed, cap: usize, cell: [i32; 3]) -> Option<f64> {
        let triangle = (placed.mesh.triangles().len() + cap) as u32;
        let corners = placed.corners(triangle);
        (0..3).find_map(|w| {
            let (u, v) = [(1, 2), (0, 2), (0, 1)][w];
            let (first, end) = ranks(&corners, v);
            let within = first <= cell[v] && cell[v] < end;
            let mut seen = Projection::new(placed, triangle, corners, w);
            let span = within.then(|| seen.span(cell[v])).flatten()?;
            let over = span.first <= cell[u] && cell[u] < span.end;
            over.then(|| {
                let is_above = cell[w] >= seen.above(cell[u], cell[v], span.step);
                // A step of −1: the cap faces up.
                if is_above == (span.step < 0) { -1.0 } else { 1.0 }
            })
        })
    }
}

impl Node {
    fn around(slots: &[([u32; 3], u8)], first: usize, at: &impl Fn(u32) -> DVec3) -> Node {
        let corners = || slots.iter().flat_map(|slot| slot.0).map(at);
        let (low, high) = corners()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let centre = low.midpoint(high);
        let mut node = Node {
            centre,
            radius: corners().fold(0.0, |radius: f64, p| radius.max(length(p - centre))) * (1.0 + 1e-9),
            area: DVec3::ZERO,
            moment: DMat3::ZERO,
            size: 0.0,
            spread: 0.0,
            arm: 0.0,
            rim: 0.0,
            first: first as u32,
            end: (first + slots.len()) as u32,
            skip: 0,
        };
        for &(triangle, rims) in slots {
            let [a, b, c] = triangle.map(|vertex| at(vertex) - centre);
            let area = (b - a).cross(c - a) / 2.0;
            let size = length(area);
            let middle = a + b + c;
            node.area += area;
            // Columns are area · s.x, area · s.y, area · s.z.
            node.moment += DMat3::from_cols(area * middle.x, area * middle.y, area * middle.z) * (1.0 / 3.0);
            node.size += size;
            node.spread += size / 12.0
                * (a.length_squared() + b.length_squared() + c.length_squared() + middle.length_squared());
            for (i, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
                if rims >> i & 1 != 0 {
                    node.rim += length(to - from);
                }
            }
        }
        node.arm = node.size * node.radius;
        node
    }

    /// Adds the group's winding number as seen from afar to what is known of the ball of `radius` around a point, if that
    /// adds at most `enough` to the error anywhere in it.
    #[inline]
    fn add(&self, radius: f64, enough: f64, sum: &mut Local) -> bool {
        let towards = self.centre - sum.point;
        let distance = length(towards);
        let (gap, clear) = (distance - self.radius, distance - self.radius - radius);
        // Also true for NaN.
        if !(clear > self.radius) {
            return false;
        }
        // The n-th derivative of the kernel y/|y|³ is at most (n + 1)!/|y|ⁿ⁺²: it is one of 1/|y|, which is harmonic, so
        // that it is largest along y. (The terms with 1e-11 are for what is rounded.)
        let near = 1.0 / (gap * gap);
        let error = SCALE * (3.0 * self.spread * near + 1e-11 * self.size) * near;
        let slant = SCALE * (6.0 * self.arm * near * near + 1e-11 * self.size * near / gap);
        let bend = SCALE * (2.0 * self.rim).min(6.0 * self.size / clear) / (clear * clear * clear);
        if !(error + (slant + 0.5 * bend * radius) * radius <= enough) {
            return false;
        }
        let inverse = 1.0 / distance;
        let direction = towards * inverse;
        let (square, cube) = (inverse * inverse, inverse * inverse * inverse);
        // The kernel at the centre, and its first derivative (1 − 3 d dᵀ)/|y|³.
        let facing = self.area.dot(direction);
        let trace = self.moment.x_axis.x + self.moment.y_axis.y + self.moment.z_axis.z;
        let along = direction.dot(self.moment * direction);
        sum.value += SCALE * (facing * square + (trace - 3.0 * along) * cube);
        sum.gradient += (direction * (3.0 * facing) - self.area) * (SCALE * cube);
        sum.error += error;
        sum.slant += slant;
        sum.bend += bend;
        true
    }
}

impl Local {
    /// Adds what an edge of the boundary does to the derivatives. The gradient is the magnetic field of a current
    /// along the edge. `None` if the edge passes through the ball.
    #[inline]
    fn add_rim(
        &mut self,
        [from, to]: [DVec3; 2],
        [start, end]: [f64; 2],
        cosine: f64,
        radius: f64,
    ) -> Option<()> {
        let edge = to - from;
        let length = self::length(edge);
        let along = if length > 0.0 { (-from.dot(edge) / (length * length)).clamp(0.0, 1.0) } else { 0.0 };
        let distance = self::length(from + along * edge) * (1.0 - 1e-9) - 1e-9 * length.min(1.0) - radius;
        // Also true for NaN.
        if !(distance > 0.0) {
            return None;
        }
        let open = 1.0 + cosine;
        let strength = SCALE * (start + end) / (start * end * open);
        let field = from.cross(to) * (strength / (start * end));
        self.gradient += field;
        self.slant += 64.0 * f64::EPSILON * (self::length(field) / open + strength);
        // ∫ 2 ds / distance³ along the edge, and at most along its whole line.
        self.bend += SCALE * 2.0 * (length / distance).min(2.0) / (distance * distance);
        Some(())
    }
}

#[inline(always)]
fn length(v: DVec3) -> f64 {
    sqrt(v.length_squared())
}

/// The triangles of a polygon with `corners` corners, by halves; `found` gets the corners of each, descending, and
/// which edges are the polygon's.
fn halve(corners: usize, found: &mut impl FnMut([usize; 3], u8)) {
    fn part(first: usize, last: usize, closing: bool, found: &mut impl FnMut([usize; 3], u8)) {
        if last - first < 2 {
            return;
        }
        let middle = first.midpoint(last);
        let is_edge = |a: usize, b: usize| (b - a == 1) as u8;
        found(
            [last, middle, first],
            is_edge(middle, last) | is_edge(first, middle) << 1 | (closing as u8) << 2,
        );
        part(first, middle, false, found);
        part(middle, last, false, found);
    }
    part(0, corners - 1, true, found);
}
