//! Winding numbers of open surfaces.
//!
//! The *winding number* of a surface at a point is the signed solid angle at which it is seen from there,
//! over 4π (Jacobson, Kavan and Sorkine-Hornung 2013). For a closed surface it is an integer. An open surface
//! is closed by *caps*: surfaces over the loops of its boundary. The winding number N of surface and caps
//! together is found exactly, as an integer, by counting the triangles that lines pierce. The surface's own
//! number is N − c, where c is the winding number of the caps alone: a sum over as many triangles as the
//! boundary has edges, and not over the whole surface. The choice of caps does not matter, because their
//! jumps cancel.
//!
//! The caps' winding number is a sum of solid angles (van Oosterom and Strackee 1983). The first two terms of
//! an expansion replace a far group of triangles (Barill, Dickson, Schmidt, Levin and Jacobson 2018), here
//! with a bound of the remainder. The distance at which a group counts as far is a parameter: a caller that
//! needs a smaller error calls again.
//!
//! Away from the surface the winding number is smooth. Its gradient is the magnetic field of a current along
//! the *boundary* (the law of Biot and Savart), so that derivatives are sums over the boundary's edges. The
//! third derivative is at most Σ ∫ 6 ds / (4π·distance⁴). One expansion bounds the winding number on a cell
//! and serves many cells below.

use super::crossing::Projection;
use super::placed::{Placed, ranks};
use super::rim::Rim;
use super::terms::{self, Angle, CapTerms, Edge, EdgeTerms, End, SCALE, length};
use crate::dispatch::{Hot, with_vectors};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{floor, sqrt};
use crate::memory;
use crate::mesh::Loops;
use alloc::vec::Vec;
use core::f64::consts::PI;
use glam::{DMat3, DVec2, DVec3};

/// The most triangles in a leaf, which are summed one by one.
const LEAF: usize = 4;

/// A cap is far from a ball if its distance from the ball's middle is more than this many radii.
const APART: f64 = 6.0;

/// A rim is close to a ball if its distance from the ball's middle is less than this many radii.
const CLOSE: f64 = 1.5;

/// A tree of bounding spheres over the caps of a surface. The caps are in the tree's order.
#[derive(Default)]
pub(super) struct Caps {
    /// Bit i: the edge from corner i to corner i + 1 belongs to the surface's boundary.
    rims: Vec<u8>,
    corners: Vec<[DVec3; 3]>,
    sizes: Vec<Size>,
    /// For each edge that does not belong to the boundary, the cap beyond it.
    beyond: Vec<[u32; 3]>,
    nodes: Vec<Node>,
    pub(super) rim: Rim,
    /// The greatest distance of the boundary from its vertices' placed positions, in finest cells.
    boundary_error: f64,
    /// A bound of the error of a vertex's position along each axis.
    vertex_error: f64,
}

/// The properties of a cap that do not depend on the point of view.
#[derive(Clone, Copy)]
struct Size {
    area: f64,
    edges: [f64; 3],
    /// The longest edge, rounded up.
    longest: f64,
}

/// A cap and its rims.
type Slot = ([u32; 3], u8);

/// A group of caps: all caps below a node of the tree.
#[derive(Clone, Copy)]
struct Node {
    /// The bounding sphere.
    centre: DVec3,
    radius: f64,
    /// ∫ dA.
    area: DVec3,
    /// ∫ dA ⊗ (y − centre).
    moment: DMat3,
    /// ∫ |dA|, and ∫ |y − centre|² |dA|.
    size: f64,
    second_moment: f64,
    /// A bound of the rounding errors in the sums over caps, as an area.
    rounding: f64,
    /// A bound of the rounding errors in the sums over edges of the boundary, as a length.
    rim_rounding: f64,
    /// The integrals ∫ |ds|, ∫ ds, and ∫ ds ⊗ (y − centre) over the boundary's edges.
    rim: f64,
    current: DVec3,
    currents: DMat3,
    first: u32,
    end: u32,
    /// The node after the last one below this node; the next node if this is a leaf.
    skip: u32,
}

/// A group of caps as seen from afar, from a point and from a ball around it.
#[derive(Clone, Copy)]
struct Seen {
    /// The vector from the point to the group's centre.
    towards: DVec3,
    distance: f64,
    /// The least distance of the group from the ball.
    clear: f64,
    /// Bounds of the group's contributions, as in [`Local`].
    error: f64,
    gradient_error: f64,
    hessian_error: f64,
    third_by_edges: f64,
    third_by_areas: f64,
}

/// The caps' winding number in a ball around a point, to second order. The number jumps by an integer on
/// every cap; this is its smooth continuation from the point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local {
    point: DVec3,
    value: f64,
    gradient: DVec3,
    /// Symmetric only up to rounding.
    hessian: DMat3,
    /// Bounds of the errors of value, gradient and second derivative.
    value_error: f64,
    gradient_error: f64,
    hessian_error: f64,
    /// Two bounds of the third derivative anywhere in the ball: from the boundary's edges, and from the caps'
    /// areas. For wide holes the first is the smaller, for hair cracks the second.
    third_by_edges: f64,
    third_by_areas: f64,
    /// A bound of the change, anywhere in the ball, per distance by which every vertex of the boundary may be
    /// misplaced, each in its own direction.
    position_sensitivity: f64,
}

/// A range of winding numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    /// The middle of the range.
    pub(super) value: f64,
    /// The greatest change that the model predicts from the middle.
    pub(super) change: f64,
    /// A bound of the further error.
    pub(super) error: f64,
}

impl Range {
    /// The range of an unknown number.
    pub(super) const UNKNOWN: Range = Range { value: 0.0, change: 0.0, error: f64::INFINITY };

    pub(super) fn plus(self, step: i32) -> Range {
        Range { value: self.value + step as f64, ..self }
    }

    /// Returns the nearest integer of all numbers in the range. `None` if one may be half way to the next.
    pub(super) fn nearest(self) -> Option<i32> {
        let change = self.change + self.error;
        // (An unknown value may be NaN.)
        let nearest = if change < 0.5 { floor(self.value + 0.5) } else { return None };
        ((self.value - nearest as f64).abs() + change < 0.5).then_some(nearest as i32)
    }
}

/// Returns, for each edge of each cap that does not belong to the boundary, the cap beyond it: a cap with the
/// same edge reversed. (Several caps of different loops may have it. They lie in one place, and each is used
/// once.)
fn neighbours(slots: &[Slot]) -> Result<Vec<[u32; 3]>, Error> {
    let mut edges = memory::with_capacity(3 * slots.len())?;
    for (cap, (corners, rims)) in slots.iter().enumerate() {
        for i in (0..3).filter(|i| rims >> i & 1 == 0) {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            edges.push(([a.min(b), a.max(b)], a > b, cap as u32, i as u8));
        }
    }
    edges.sort_unstable();
    let mut beyond = memory::filled(slots.len(), [u32::MAX; 3])?;
    for group in edges.chunk_by(|a, b| a.0 == b.0) {
        let (forward, backward) = group.split_at(group.partition_point(|edge| !edge.1));
        for (&(_, _, cap, i), &(_, _, other, k)) in forward.iter().zip(backward) {
            beyond[cap as usize][i as usize] = other;
            beyond[other as usize][k as usize] = cap;
        }
    }
    Ok(beyond)
}

/// The distance of the origin from a segment.
fn segment_distance(a: DVec3, b: DVec3) -> f64 {
    let edge = b - a;
    let along = -a.dot(edge) / edge.length_squared();
    let along = if along.is_nan() { 0.0 } else { along.clamp(0.0, 1.0) };
    length(a + along * edge)
}

impl Local {
    /// The expansion for no caps.
    pub(super) fn nothing(point: [f64; 3]) -> Local {
        Local {
            point: DVec3::from(point),
            value: 0.0,
            gradient: DVec3::ZERO,
            hessian: DMat3::ZERO,
            value_error: 0.0,
            gradient_error: 0.0,
            hessian_error: 0.0,
            third_by_edges: 0.0,
            third_by_areas: 0.0,
            position_sensitivity: 0.0,
        }
    }

    /// Returns the same function expanded around another point, valid for a ball around that point within the
    /// present ball.
    fn moved(&self, point: [f64; 3], radius: f64) -> Local {
        let to = DVec3::from(point) - self.point;
        let Range { value, .. } = self.at(point);
        let hessian = (self.hessian + self.hessian.transpose()) * 0.5;
        let value_error = self.error_at(length(to) + radius);
        Local { value, gradient: self.gradient + hessian * to, hessian, value_error, ..Local::nothing(point) }
    }

    /// Returns the range in the ball of the given radius around the expansion's point.
    pub(super) fn within(&self, radius: f64) -> Range {
        let change = (length(self.gradient) + 0.5 * sum_of_magnitudes(self.hessian) * radius) * radius;
        Range { value: self.value, change, error: self.error_at(radius) }
    }

    /// Returns the range in a cube with the lower corner `at`, which must lie in the expansion's ball.
    pub(super) fn over(&self, at: [i32; 3], size: i32) -> Range {
        let half = size as f64 / 2.0;
        let middle = DVec3::from(at.each(|a| a as f64 + half)) - self.point;
        let symmetric = (self.hessian + self.hessian.transpose()) * 0.5;
        let hessian_step = symmetric * middle;
        let gradient = (self.gradient + hessian_step).abs();
        let change = gradient.x + gradient.y + gradient.z + 0.5 * half * sum_of_magnitudes(symmetric);
        Range {
            value: self.value + (self.gradient + 0.5 * hessian_step).dot(middle),
            change: half * change,
            error: self.error_at(length(middle.abs() + half)),
        }
    }

    /// Returns a linear model in a cube as for [`over`](Self::over), in half edges from the cube's middle:
    /// the value in the middle, the gradient, and a bound of the remaining error.
    pub(super) fn tangent(&self, at: [i32; 3], size: i32) -> (f64, [f64; 3], f64) {
        let half = size as f64 / 2.0;
        let middle = DVec3::from(at.each(|a| a as f64 + half)) - self.point;
        let symmetric = (self.hessian + self.hessian.transpose()) * 0.5;
        let hessian_step = symmetric * middle;
        let value = self.value + (self.gradient + 0.5 * hessian_step).dot(middle);
        let slope = (self.gradient + hessian_step) * half;
        let bend = 0.5 * half * half * sum_of_magnitudes(symmetric);
        (value, slope.to_array(), bend + self.error_at(length(middle.abs() + half)))
    }

    /// Returns the range at the centre of a cell.
    pub(super) fn at_centre(&self, cell: [i32; 3]) -> Range {
        self.at(cell.each(|a| a as f64 + 0.5))
    }

    /// Returns the range at a point.
    pub(super) fn at(&self, point: [f64; 3]) -> Range {
        let to = DVec3::from(point) - self.point;
        let value = self.value + (self.gradient + 0.5 * (self.hessian * to)).dot(to);
        Range { value, change: 0.0, error: self.error_at(length(to)) }
    }

    /// The approximate change of the winding number over the length of a finest cell.
    pub(super) fn steepness(&self) -> f64 {
        length(self.gradient)
    }

    /// Returns the expansion along an axis, as a function of the distance from `from`: the coefficients of 1,
    /// x and x².
    pub(super) fn along(&self, axis: usize, from: [f64; 3]) -> [f64; 3] {
        let to = DVec3::from(from) - self.point;
        let symmetric = (self.hessian + self.hessian.transpose()) * 0.5;
        let hessian_step = symmetric * to;
        let value = self.value + (self.gradient + 0.5 * hessian_step).dot(to);
        [value, (self.gradient + hessian_step)[axis], 0.5 * symmetric.col(axis)[axis]]
    }

    fn error_at(&self, distance: f64) -> f64 {
        let third = self.third_by_edges.min(self.third_by_areas);
        let (first, second) = (self.gradient_error, 0.5 * self.hessian_error * distance);
        // The factor covers the roundings of all these bounds.
        (self.value_error + (first + second + third / 6.0 * distance * distance) * distance) * (1.0 + 1e-6)
            + 1e-12
    }
}

impl Caps {
    /// The bytes of the lists.
    pub(super) fn bytes(&self) -> usize {
        memory::bytes_of(&self.rims)
            + memory::bytes_of(&self.corners)
            + memory::bytes_of(&self.sizes)
            + memory::bytes_of(&self.beyond)
            + memory::bytes_of(&self.nodes)
            + self.rim.bytes()
    }

    /// Closes `placed` by caps over the loops of its boundary.
    ///
    /// O(n log n) in the boundary's edges, which are never fewer than the caps; some 400 bytes a cap.
    pub(super) fn close(placed: &mut Placed, loops: &Loops) -> Result<Caps, Error> {
        let count = loops.caps();
        let mut caps = Caps::default();
        let mut triangles = memory::with_capacity(count)?;
        caps.rims.try_reserve_exact(count)?;
        let mut slots = memory::with_capacity(count)?;
        let mut error = 0f32;
        for walk in loops.iter() {
            for &vertex in walk {
                error = placed.vertex(vertex).error.into_iter().fold(error, f32::max);
            }
            // The loop reversed, so that its edges cancel those of the surface. Halving instead of a fan
            // makes most caps as small as the edges at which they lie, so that groups of caps are far from
            // most points.
            halve(walk.len(), &mut |[a, b, c], rims| {
                slots.push((([a, b, c]).each(|corner| walk[corner]), rims));
            });
        }
        caps.vertex_error = error as f64;
        caps.rim.vertex_error = caps.vertex_error;
        caps.boundary_error = 2.0 * (caps.vertex_error + placed.displacement);
        caps.nodes.try_reserve_exact(2 * count.div_ceil(LEAF).next_power_of_two())?;
        let at = |vertex: u32| DVec3::from(placed.at(vertex));
        if count > 0 {
            caps.grow(&mut slots, 0, &at)?;
        }
        triangles.extend(slots.iter().map(|slot| slot.0));
        caps.rims.extend(slots.iter().map(|slot| slot.1));
        caps.corners.try_reserve_exact(count)?;
        caps.corners.extend(slots.iter().map(|slot| slot.0.each(at)));
        caps.sizes.try_reserve_exact(count)?;
        caps.sizes.extend(slots.iter().map(|slot| {
            let [a, b, c] = slot.0.each(at);
            let edges = [b - a, c - b, a - c].each(length);
            let longest = edges.iter().copied().fold(0.0, f64::max) * (1.0 + 1e-9);
            Size { area: length((b - a).cross(c - a)) / 2.0, edges, longest }
        }));
        for &(corners, rims) in &slots {
            let ends = corners.each(at);
            for i in (0..3).filter(|i| rims >> i & 1 != 0) {
                caps.rim.push([ends[i], ends[(i + 1) % 3]])?;
            }
        }
        caps.beyond = neighbours(&slots)?;
        placed.close(triangles)?;
        Ok(caps)
    }

    /// Adds the subtree of `slots`, whose first slot has the number `first`, and sorts the slots into its
    /// order.
    fn grow(&mut self, slots: &mut [Slot], first: usize, at: &impl Fn(u32) -> DVec3) -> Result<(), Error> {
        let node = Node::around(slots, first, at);
        let index = self.nodes.len();
        memory::push(&mut self.nodes, node)?;
        if slots.len() > LEAF {
            // Halves, so that the depth is logarithmic for all coordinates. The halves are near and far caps
            // along the longest extent, or small and large caps if the largest caps are larger than that
            // extent.
            let centroid = |slot: &Slot| slot.0.iter().map(|&v| at(v)).sum::<DVec3>() / 3.0;
            let size = |slot: &Slot| {
                let [a, b, c] = slot.0.each(at);
                (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared())
            };
            let (low, high) = (slots.iter().map(centroid))
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
            let extent = (high - low).to_array();
            let axis = (0..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
            let largest = slots.iter().map(size).fold(0.0, f64::max);
            let is_mixed = largest > extent[axis] * extent[axis];
            let key = |slot: &Slot| if is_mixed { size(slot) } else { centroid(slot)[axis] };
            let middle = slots.len() / 2;
            slots.select_nth_unstable_by(middle, |a, b| {
                // Ties are broken by corners, so that the halves are the same on every machine.
                key(a).total_cmp(&key(b)).then(a.cmp(b))
            });
            let (low, high) = slots.split_at_mut(middle);
            self.grow(low, first, at)?;
            self.grow(high, first + middle, at)?;
        }
        self.nodes[index].skip = self.nodes.len() as u32;
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns the winding number around `point` to second order, within `radius` of it (both in finest cells
    /// from the frame's origin). A group of caps that is expanded as a whole adds at most `enough` to the
    /// error. `None` if the boundary passes through the ball. For a ball of radius 0, only the value is
    /// computed.
    ///
    /// If the point is a cell's centre, `cell` must name the cell. The value is then the one on the side of
    /// every cap to which the symbolic shift moves the centre. Otherwise, a point on a cap may get the value
    /// of either side.
    pub(super) fn local(
        &self,
        placed: &Placed,
        point: [f64; 3],
        radius: f64,
        enough: f64,
        cell: Option<[i32; 3]>,
    ) -> Option<Local> {
        with_vectors(Around { caps: self, placed, point, radius, enough, cell })
    }

    /// Lists all caps.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn list(&self, list: &mut Vec<u32>) -> Result<(), Error> {
        list.try_reserve(self.sizes.len())?;
        list.extend(0..self.sizes.len() as u32);
        Ok(())
    }

    /// Returns the winding number of the caps that are not `near`, in the ball of `radius` around a point.
    /// The ball must lie in the ball of `known`, which covers all caps except those of a list. Caps of the
    /// list that are far from the ball are added to `known`. The other caps are appended to `near`.
    ///
    /// Lists are ascending. All edges of a far cap are far from the ball, so that derivatives of the cap's
    /// own winding number are sums over its edges. Edges between two added caps cancel.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn far(
        &self,
        placed: &Placed,
        known: &Local,
        list: core::ops::Range<usize>,
        near: &mut Vec<u32>,
        (point, radius): ([f64; 3], f64),
    ) -> Result<Local, Error> {
        let reach = radius + self.boundary_error;
        let local = known.moved(point, radius);
        let first = near.len();
        near.try_reserve(list.len())?;
        for i in list.clone() {
            let cap = near[i];
            let corners = self.corners[cap as usize].each(|corner| corner - local.point);
            let farthest = sqrt(corners.iter().fold(0.0, |most: f64, at| most.max(at.length_squared())));
            // (NaN counts as near.)
            let is_far = farthest - self.sizes[cap as usize].longest > APART * reach;
            if !is_far {
                near.push(cap);
            }
        }
        let (list, near) = (&near[list], &near[first..]);
        Ok(with_vectors(Far { caps: self, placed, list, near, reach, known: local }))
    }

    /// Returns the winding number of all caps in the ball of `radius` around the point of `far`, which covers
    /// all caps that are not `near`. `None` if the boundary passes through the ball, or comes so near that
    /// one expansion is useless.
    pub(super) fn whole(&self, placed: &Placed, far: &Local, near: &[u32], radius: f64) -> Option<Local> {
        let reach = radius + self.boundary_error;
        let is_close = |&cap: &u32| {
            let corners = self.corners[cap as usize].each(|corner| corner - far.point);
            (0..3).any(|i| {
                self.rims[cap as usize] >> i & 1 != 0
                    && segment_distance(corners[i], corners[(i + 1) % 3]) < CLOSE * reach
            })
        };
        if near.iter().any(is_close) {
            return None;
        }
        with_vectors(Whole { caps: self, placed, near, reach, far: *far })
    }

    /// Returns the winding number at a point of the ball of `far`, which covers all caps that are not `near`.
    /// If the point is a cell's centre, `cell` must name the cell, as for [`local`](Self::local).
    pub(super) fn at(
        &self,
        placed: &Placed,
        (far, near): (&Local, &[u32]),
        point: [f64; 3],
        cell: Option<[i32; 3]>,
    ) -> Range {
        let near = with_vectors(Near { caps: self, placed, near, point, cell });
        let far = far.at(point);
        Range { value: near.value + far.value, change: 0.0, error: near.error_at(0.0) + far.error }
    }

    /// Returns as bits the edges of a cap that do not belong to the boundary, except for edges whose cap
    /// beyond is added, too.
    #[inline(always)]
    fn inner_edges(&self, cap: u32, is_added: impl Fn(u32) -> bool) -> u8 {
        let (rims, beyond) = (self.rims[cap as usize], self.beyond[cap as usize]);
        (0..3).filter(|i| rims >> i & 1 == 0 && !is_added(beyond[*i])).fold(0, |mask, i| mask | 1 << i)
    }

    /// Adds half a cap's solid angle to the value, or to the argument of `turned`, which has modulus 1.
    #[inline(always)]
    fn add_angle(
        &self,
        (placed, cap, cell): (&Placed, usize, Option<[i32; 3]>),
        angle: Angle,
        sum: &mut Local,
        turned: &mut DVec2,
    ) {
        let Angle { real, imaginary, modulus, wrong } = angle;
        // This is false for NaN, too.
        if modulus >= 2.0 * wrong {
            let inverse = 1.0 / modulus;
            let direction = DVec2::new(real, imaginary) * inverse;
            if real > 0.0 && turned.x > 0.0 {
                // Both angles are less than a right angle, so that the product of the directions gives their
                // sum.
                *turned = turned.rotate(direction);
            } else if real > 0.0 {
                sum.value += libm::atan2(turned.y, turned.x) / (2.0 * PI);
                *turned = direction;
            } else {
                let mut angle = libm::atan2(imaginary, real);
                if imaginary.abs() <= wrong
                    && let Some(cell) = cell
                {
                    match self.side(placed, cap, cell) {
                        Some(side) => angle = side * angle.abs(),
                        None => sum.value_error += 1.0,
                    }
                }
                sum.value += angle / (2.0 * PI);
            }
            sum.value_error += wrong * inverse + f64::EPSILON * sum.value.abs();
        } else {
            sum.value_error += 1.0;
            if let Some(cell) = cell {
                // No proof, because the centre may lie beside the edge. But it is the best guess, and exact
                // on the edge.
                let corners = self.corners[cap].each(|corner| corner - sum.point);
                sum.value += self.on_edge(placed, cap, cell, corners) / (2.0 * PI);
            }
        }
    }

    /// Half the solid angle of a cap on whose edge or corner a cell's centre lies, as seen from the centre's
    /// symbolic shift: the angle of a half-plane or of a sector. `corners` are relative to the centre.
    #[cold]
    fn on_edge(&self, placed: &Placed, cap: usize, cell: [i32; 3], corners: [DVec3; 3]) -> f64 {
        let units = corners.each(DVec3::normalize_or_zero);
        let i = if let Some(apex) = units.iter().position(|unit| *unit == DVec3::ZERO) {
            let (first, last) = ((apex + 1) % 3, (apex + 2) % 3);
            let (u, v) = (units[first], units[last]);
            // The shift is along x, so that the apex appears along −x, and the other corners stay.
            let (imaginary, real) = (-u.cross(v).x, 1.0 - u.x + u.dot(v) - v.x);
            if sqrt(real * real + imaginary * imaginary) > 1e-12 {
                let angle = libm::atan2(imaginary, real);
                let is_over = real < 0.0 && imaginary.abs() <= 1e-9;
                let side = if is_over { self.side(placed, cap, cell) } else { None };
                return side.map_or(angle, |side| side * angle.abs());
            }
            // An edge leads along x: then the shifted centre is on that edge.
            if u.x > v.x { apex } else { last }
        } else {
            // The ends of the edge through the centre lie in opposite directions.
            let cosines = axes(|i| units[i].dot(units[(i + 1) % 3]));
            let i = (0..3).fold(0, |least, i| if cosines[i] < cosines[least] { i } else { least });
            if cosines[i] >= -0.99 {
                return 0.0;
            }
            i
        };
        let along = (corners[(i + 1) % 3] - corners[i]).normalize_or_zero();
        let inward = corners[(i + 2) % 3].reject_from_normalized(along).normalize_or_zero();
        // Shift along x first; along y if x leads along the edge.
        let shift = DVec3::AXES.each(|axis| axis.reject_from_normalized(along));
        let Some(shift) = shift.into_iter().find(|shift| shift.length() > 1e-9) else {
            return 0.0;
        };
        let (sine, cosine) = (shift.dot(along.cross(inward)), shift.dot(inward));
        if sine.abs() > 1e-9 * shift.length() {
            return -sine.signum() * (PI - libm::atan2(sine.abs(), cosine));
        }
        // The shift stays in the cap's plane. If it leads out of the cap, the solid angle is zero.
        let side = if cosine > 0.0 { self.side(placed, cap, cell) } else { None };
        side.unwrap_or(0.0) * PI
    }

    /// Returns on which side of a cap a cell's centre over it lies: 1 if the cap faces away from the centre.
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
                // With a step of −1, the cap faces up.
                if is_above == (span.step < 0) { -1.0 } else { 1.0 }
            })
        })
    }
}

impl Node {
    fn around(slots: &[Slot], first: usize, at: &impl Fn(u32) -> DVec3) -> Node {
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
            second_moment: 0.0,
            rim: 0.0,
            current: DVec3::ZERO,
            currents: DMat3::ZERO,
            first: first as u32,
            end: (first + slots.len()) as u32,
            skip: 0,
            rounding: 0.0,
            rim_rounding: 0.0,
        };
        for &(triangle, rims) in slots {
            let [a, b, c] = triangle.each(|vertex| at(vertex) - centre);
            let area = (b - a).cross(c - a) / 2.0;
            let size = length(area);
            let middle = a + b + c;
            node.area += area;
            // The columns are area · s.x, area · s.y, area · s.z.
            node.moment += DMat3::from_cols(area * middle.x, area * middle.y, area * middle.z) * (1.0 / 3.0);
            node.size += size;
            node.second_moment += size / 12.0
                * (a.length_squared() + b.length_squared() + c.length_squared() + middle.length_squared());
            for (i, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
                if rims >> i & 1 != 0 {
                    let (edge, middle) = (to - from, from.midpoint(to));
                    node.rim += length(edge);
                    node.current += edge;
                    node.currents += DMat3::from_cols(edge * middle.x, edge * middle.y, edge * middle.z);
                }
            }
        }
        // `rounding` covers all roundings of the value that `Node::add` adds, and of its bound. Let n be the
        // number of caps, u = ε/2, r the radius and |y| > 2 r the distance; errors are in units of SCALE/(|y|
        // − r)². A sum of n terms has an error of n·u times their magnitudes, and each term has fewer than
        // 100 roundings of its own. The terms of value and second moment are at most 4·size: this gives
        // 4·(n + 100)·u·size. A corner relative to the centre has an error of u·r, so a cap's area has an
        // error of 11·u·r², however thin the cap is: this gives 17·n·u·r² in value and second moment. The
        // factor 16·ε, which is 32·u, exceeds the need of both. Nothing else is rounded, so the bound counts
        // once; with it, `size` bounds the area.
        let count = slots.len() as f64;
        let slivers = count * node.radius * node.radius;
        node.rounding = 16.0 * f64::EPSILON * ((count + 16.0) * node.size + slivers);
        node.size += node.rounding;
        // The sums over the boundary's n edges have an error of 5·((n + 3)·rim + 2·n·r)·u in the gradient, in
        // units of SCALE/(|y| − r)²: n roundings of sums, and corners with an error of u·r. 10^-11 of the
        // boundary's length covers all other roundings.
        let edges = slots.iter().map(|slot| slot.1.count_ones() as f64).sum::<f64>();
        let sums = 16.0 * f64::EPSILON * ((edges + 16.0) * node.rim + edges * node.radius);
        node.rim_rounding = sums.max(1e-11 * node.rim);
        node
    }

    /// Returns the group as seen from afar, in the ball of `radius` around a point, if expanding it as a
    /// whole adds at most `enough` to the error anywhere in the ball.
    #[inline(always)]
    fn seen(&self, point: DVec3, radius: f64, enough: f64) -> Option<Seen> {
        let towards = self.centre - point;
        // Most groups that are not far are rejected without a square root.
        let (square, least) = (towards.length_squared(), 2.0 * self.radius + radius);
        if square < least * least * (1.0 - 1e-9) {
            return None;
        }
        let distance = sqrt(square);
        let (gap, clear) = (distance - self.radius, distance - self.radius - radius);
        // (NaN fails this and all tests below.)
        let is_apart = clear > self.radius;
        if !is_apart {
            return None;
        }
        // The n-th derivative of the kernel y/|y|³ is at most (n + 1)!/|y|ⁿ⁺²: it is a derivative of 1/|y|,
        // which is harmonic, so that it is largest along y. (`rounding` and `rim_rounding` cover the
        // roundings.)
        let per_gap = 1.0 / gap;
        let near = SCALE * per_gap * per_gap;
        let error = (3.0 * self.second_moment * per_gap * per_gap + self.rounding) * near;
        let is_exact = error <= enough;
        if !is_exact {
            return None;
        }
        let wide = self.radius * per_gap;
        let gradient_error = (3.0 * wide * wide * self.rim + self.rim_rounding) * near;
        let hessian_error = (6.0 * wide * self.rim + self.rim_rounding) * near * per_gap;
        let per_clear = 1.0 / clear;
        let close = SCALE * per_clear * per_clear * per_clear * per_clear;
        let (third_by_edges, third_by_areas) = (6.0 * self.rim * close, 24.0 * self.size * close * per_clear);
        let third = third_by_edges.max(third_by_areas);
        let beyond_value = (gradient_error + (0.5 * hessian_error + third / 6.0 * radius) * radius) * radius;
        let is_smooth = error + beyond_value <= enough;
        if !is_smooth {
            return None;
        }
        Some(Seen {
            towards,
            distance,
            clear,
            error,
            gradient_error,
            hessian_error,
            third_by_edges,
            third_by_areas,
        })
    }

    /// Adds the group's winding number as seen from afar.
    #[inline(always)]
    fn add(&self, seen: &Seen, sum: &mut Local) {
        let inverse = 1.0 / seen.distance;
        let direction = seen.towards * inverse;
        let (square, cube) = (SCALE * inverse * inverse, SCALE * inverse * inverse * inverse);
        // The kernel at the centre, and its first derivative (1 − 3 d dᵀ)/|y|³.
        let facing = self.area.dot(direction);
        let along = direction.dot(self.moment * direction);
        sum.value += facing * square + (trace(self.moment) - 3.0 * along) * cube;
        // ∫ y/|y|³ × ds with the same two terms.
        let turned = curl(self.currents);
        let along_direction = self.currents * direction;
        sum.gradient +=
            direction.cross(self.current) * square + (turned - 3.0 * direction.cross(along_direction)) * cube;
        // The first of these terms, differentiated once more: −(v − 3 d (d·v))/|y|³ × ds for a step v.
        let column = |v: DVec3| (3.0 * direction.dot(v) * direction - v).cross(self.current) * cube;
        let columns = [column(DVec3::X), column(DVec3::Y), column(DVec3::Z)];
        sum.hessian += DMat3::from_cols(columns[0], columns[1], columns[2]);
        sum.value_error += seen.error + f64::EPSILON * sum.value.abs();
        sum.gradient_error += seen.gradient_error;
        sum.hessian_error += seen.hessian_error;
        sum.round_derivatives();
        sum.third_by_edges += seen.third_by_edges;
        sum.third_by_areas += seen.third_by_areas;
        sum.position_sensitivity += SCALE * self.rim / (seen.clear * seen.clear);
    }
}

impl Local {
    /// Adds the contribution of an edge to the derivatives. `None` if the edge passes through the ball.
    #[inline(always)]
    fn add_edge(&mut self, edge: &Edge) -> Option<()> {
        if !edge.is_known {
            return None;
        }
        self.gradient += edge.gradient;
        self.hessian += DMat3::from_cols(edge.hessian[0], edge.hessian[1], edge.hessian[2]);
        self.gradient_error += edge.gradient_error;
        self.hessian_error += edge.hessian_error;
        self.round_derivatives();
        self.position_sensitivity += edge.position_sensitivity;
        self.third_by_edges += edge.third;
        Some(())
    }

    /// Accounts for the rounding of the sums to which a term was just added.
    #[inline(always)]
    fn round_derivatives(&mut self) {
        self.gradient_error += f64::EPSILON * self.gradient.abs().element_sum();
        self.hessian_error += f64::EPSILON * sum_of_magnitudes(self.hessian);
    }
}

/// A term of the sum.
#[derive(Clone, Copy)]
enum Item {
    /// A cap, and its edges that contribute to the derivatives besides the boundary's edges.
    Cap(u32, u8),
    Group(u32, Seen),
}

/// A sum over caps and groups, in the given order. Terms are computed for many items at a time.
struct Summing<'c> {
    caps: &'c Caps,
    placed: &'c Placed,
    cell: Option<[i32; 3]>,
    /// The radius of the ball; 0 if only the value is needed.
    reach: f64,
    sum: Local,
    /// A complex number of modulus 1. Its argument over 2π is a part of the sum.
    turned: DVec2,
    /// False if an edge passes through the ball.
    is_known: bool,
    /// The items that are not summed yet, and their terms.
    items: [Item; terms::MOST],
    count: usize,
    cap_terms: CapTerms,
    edge_terms: EdgeTerms,
}

impl<'c> Summing<'c> {
    #[inline(always)]
    fn new(caps: &'c Caps, placed: &'c Placed, sum: Local, reach: f64) -> Summing<'c> {
        Summing {
            caps,
            placed,
            cell: None,
            reach,
            sum,
            turned: DVec2::X,
            is_known: true,
            items: [Item::Cap(0, 0); terms::MOST],
            count: 0,
            cap_terms: CapTerms::new(),
            edge_terms: EdgeTerms::new(),
        }
    }

    /// Adds items: all of them, or if that is `enough`, until one is not known.
    #[inline(always)]
    fn add(&mut self, mut items: impl Iterator<Item = Item>, enough: bool) {
        loop {
            let mut is_end = false;
            while self.count < terms::MOST && self.edge_terms.room() >= 3 {
                match items.next() {
                    Some(item) => self.push(item),
                    None => {
                        is_end = true;
                        break;
                    }
                }
            }
            self.add_terms();
            if is_end || enough && !self.is_known {
                return;
            }
        }
    }

    #[inline(always)]
    fn push(&mut self, item: Item) {
        if let Item::Cap(cap, inner) = item {
            let i = cap as usize;
            let (corners, Size { area, edges, longest }) = (&self.caps.corners[i], self.caps.sizes[i]);
            self.cap_terms.push(corners, area, longest);
            if self.reach != 0.0 {
                for mask in [self.caps.rims[i], inner] {
                    for k in (0..3).filter(|k| mask >> k & 1 != 0) {
                        self.edge_terms.push([corners[k], corners[(k + 1) % 3]], edges[k]);
                    }
                }
            }
        }
        self.items[self.count] = item;
        self.count += 1;
    }

    #[inline(always)]
    fn add_terms(&mut self) {
        let Summing { caps, placed, cell, reach, sum, turned, is_known, .. } = self;
        self.cap_terms.find(sum.point, caps.vertex_error, *reach);
        self.edge_terms.find(sum.point, *reach);
        let (mut caps_taken, mut edges_taken) = (0, 0);
        for item in &self.items[..self.count] {
            let (cap, inner) = match item {
                Item::Group(node, seen) => {
                    caps.nodes[*node as usize].add(seen, sum);
                    continue;
                }
                Item::Cap(cap, inner) => (*cap as usize, *inner),
            };
            caps.add_angle((placed, cap, *cell), self.cap_terms.angle(caps_taken), sum, turned);
            if *reach != 0.0 {
                sum.third_by_areas += self.cap_terms.third(caps_taken);
                let edges = (caps.rims[cap].count_ones() + inner.count_ones()) as usize;
                for i in edges_taken..edges_taken + edges {
                    if sum.add_edge(&self.edge_terms.edge(i)).is_none() {
                        *is_known = false;
                        break;
                    }
                }
                edges_taken += edges;
            }
            caps_taken += 1;
        }
        self.count = 0;
        self.cap_terms.clear();
        self.edge_terms.clear();
    }

    #[inline(always)]
    fn finish(self) -> Local {
        let Summing { caps, mut sum, turned, .. } = self;
        sum.value += libm::atan2(turned.y, turned.x) / (2.0 * PI);
        sum.value_error += caps.boundary_error * sum.position_sensitivity;
        sum
    }
}

/// All groups that are far from a ball, as large as possible, and the caps between them, in the tree's order.
struct Items<'c> {
    caps: &'c Caps,
    point: DVec3,
    reach: f64,
    enough: f64,
    /// The next node, and the rest of the latest leaf.
    next: usize,
    leaf: core::ops::Range<u32>,
}

impl Iterator for Items<'_> {
    type Item = Item;

    #[inline(always)]
    fn next(&mut self) -> Option<Item> {
        loop {
            if self.leaf.start < self.leaf.end {
                self.leaf.start += 1;
                return Some(Item::Cap(self.leaf.start - 1, 0));
            }
            let node = self.caps.nodes.get(self.next)?;
            if let Some(seen) = node.seen(self.point, self.reach, self.enough) {
                let item = Item::Group(self.next as u32, seen);
                self.next = node.skip as usize;
                return Some(item);
            }
            self.next += 1;
            if node.skip as usize == self.next {
                self.leaf = node.first..node.end;
            }
        }
    }
}

/// The computation of [`Caps::local`].
struct Around<'c> {
    caps: &'c Caps,
    placed: &'c Placed,
    point: [f64; 3],
    radius: f64,
    enough: f64,
    cell: Option<[i32; 3]>,
}

impl Hot for Around<'_> {
    type Output = Option<Local>;

    #[inline(always)]
    fn run(self) -> Option<Local> {
        let Around { caps, placed, point, radius, enough, cell } = self;
        let reach = if radius > 0.0 { radius + caps.boundary_error } else { 0.0 };
        let mut summing = Summing::new(caps, placed, Local::nothing(point), reach);
        summing.cell = cell;
        let items = Items { caps, point: DVec3::from(point), reach, enough, next: 0, leaf: 0..0 };
        summing.add(items, true);
        if summing.is_known { Some(summing.finish()) } else { None }
    }
}

/// The additions of [`Caps::far`]: the caps of a list that are not `near`.
struct Far<'c> {
    caps: &'c Caps,
    placed: &'c Placed,
    list: &'c [u32],
    near: &'c [u32],
    reach: f64,
    known: Local,
}

impl Hot for Far<'_> {
    type Output = Local;

    #[inline(always)]
    fn run(self) -> Local {
        let Far { caps, placed, list, near, reach, known } = self;
        let is_new = |cap: u32| list.binary_search(&cap).is_ok() && near.binary_search(&cap).is_err();
        let mut next = near.iter().peekable();
        let far = list.iter().filter(|&cap| next.next_if_eq(&cap).is_none());
        let mut summing = Summing::new(caps, placed, known, reach);
        summing.add(far.map(|&cap| Item::Cap(cap, caps.inner_edges(cap, is_new))), false);
        let is_known = summing.is_known;
        let mut local = summing.finish();
        if !is_known {
            local.value_error = f64::INFINITY;
        }
        Local { position_sensitivity: 0.0, ..local }
    }
}

/// The additions of [`Caps::whole`].
struct Whole<'c> {
    caps: &'c Caps,
    placed: &'c Placed,
    near: &'c [u32],
    reach: f64,
    far: Local,
}

impl Hot for Whole<'_> {
    type Output = Option<Local>;

    #[inline(always)]
    fn run(self) -> Option<Local> {
        let Whole { caps, placed, near, reach, far } = self;
        let is_near = |cap: u32| near.binary_search(&cap).is_ok();
        let mut summing = Summing::new(caps, placed, far, reach);
        summing.add(near.iter().map(|&cap| Item::Cap(cap, caps.inner_edges(cap, is_near))), true);
        if summing.is_known { Some(summing.finish()) } else { None }
    }
}

/// The caps that [`Caps::at`] sums one by one.
struct Near<'c> {
    caps: &'c Caps,
    placed: &'c Placed,
    near: &'c [u32],
    point: [f64; 3],
    cell: Option<[i32; 3]>,
}

impl Hot for Near<'_> {
    type Output = Local;

    /// Sums the angles. Most half angles are less than a right angle and precise. For these, numbers that are
    /// not divided by the corners' distances suffice.
    #[inline(always)]
    fn run(self) -> Local {
        let Near { caps, placed, near, point, cell } = self;
        let mut sum = Local::nothing(point);
        let mut turned = DVec2::X;
        let mut found = CapTerms::new();
        for near in near.chunks(terms::MOST) {
            found.clear();
            for &cap in near {
                found.push(&caps.corners[cap as usize], 0.0, 0.0);
            }
            found.find_undivided(sum.point, caps.vertex_error);
            for (i, &cap) in near.iter().enumerate() {
                let Angle { real, imaginary, modulus, wrong } = found.angle(i);
                // (False for NaN.)
                let is_told = real > 0.0 && turned.x > 0.0 && modulus >= 2.0 * wrong;
                if is_told {
                    let inverse = 1.0 / modulus;
                    turned = turned.rotate(DVec2::new(real, imaginary) * inverse);
                    sum.value_error += wrong * inverse;
                } else {
                    let ends = caps.corners[cap as usize].each(|corner| End::new(corner - sum.point));
                    let angle = Angle::new(ends, caps.vertex_error);
                    caps.add_angle((placed, cap as usize, cell), angle, &mut sum, &mut turned);
                }
            }
        }
        sum.value += libm::atan2(turned.y, turned.x) / (2.0 * PI);
        sum
    }
}

fn trace(m: DMat3) -> f64 {
    m.x_axis.x + m.y_axis.y + m.z_axis.z
}

/// ∫ s × ds, from ∫ ds ⊗ s.
fn curl(m: DMat3) -> DVec3 {
    DVec3::new(m.y_axis.z - m.z_axis.y, m.z_axis.x - m.x_axis.z, m.x_axis.y - m.y_axis.x)
}

fn sum_of_magnitudes(m: DMat3) -> f64 {
    let sums = m.x_axis.abs() + m.y_axis.abs() + m.z_axis.abs();
    sums.x + sums.y + sums.z
}

/// Divides a polygon with `corners` corners into triangles, by halves. `found` gets the corners of each
/// triangle, descending, and the bits of its edges that are the polygon's.
pub(super) fn halve(corners: usize, found: &mut impl FnMut([usize; 3], u8)) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Frame;
    use crate::mesh::TriangleMesh;
    use alloc::sync::Arc;

    /// A cone without its base: `corners` corners at height 3 around the axis through (8, 8), at a radius of
    /// about 5, and the top at height 13. The frame has 16 cells along an axis.
    fn cone(corners: u32) -> (Placed, Caps) {
        let mut vertices = alloc::vec![[8.0, 8.0, 13.0]];
        for i in 0..corners {
            let angle = 2.0 * PI * f64::from(i) / f64::from(corners);
            let radius = 5.0 + 0.5 * libm::sin(5.0 * angle);
            let height = 3.0 + 0.3 * libm::cos(3.0 * angle);
            vertices.push([8.0 + radius * libm::cos(angle), 8.0 + radius * libm::sin(angle), height]);
        }
        let triangles = (0..corners).map(|i| [0, 1 + i, 1 + (i + 1) % corners]).collect();
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        let loops = mesh.loops().unwrap();
        let mut placed = Placed::new(Arc::new(mesh), &Frame::new([0.0; 3], 16.0, 4).unwrap()).unwrap();
        let caps = Caps::close(&mut placed, &loops).unwrap();
        (placed, caps)
    }

    fn local((placed, caps): &(Placed, Caps), point: DVec3, radius: f64, enough: f64) -> Option<Local> {
        caps.local(placed, point.to_array(), radius, enough, None)
    }

    #[test]
    fn expansions_hold_what_they_promise() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for corners in [3, 4, 7, 24, 100, 400] {
            let solid = cone(corners);
            let (mut known, mut taken) = (0, 0);
            for _ in 0..2000 {
                let point = DVec3::new(random(), random(), random()) * 24.0 - 4.0;
                let radius = 4.0 * random() * random();
                for enough in [0.0, 1e-6, 1e-3, 1e-1] {
                    let Some(around) = local(&solid, point, radius, enough) else { continue };
                    known += 1;
                    let step = DVec3::new(random(), random(), random()) * 2.0 - 1.0;
                    let step = step * (radius * random() / length(step));
                    let there = local(&solid, point + step, 0.0, 0.0).unwrap();
                    assert!(there.error_at(0.0) < 1e-9);
                    let hessian_step = around.hessian * step;
                    let guess = around.value + (around.gradient + 0.5 * hessian_step).dot(step);
                    // Caps may lie between the two points.
                    let off = guess - there.value;
                    let off = (off - libm::round(off)).abs();
                    let bound = around.error_at(length(step)) + 1e-9;
                    assert!(off <= bound, "{corners} {point} {radius} {step} {enough}: {off} {bound}");
                    taken += usize::from(bound < 0.5);
                }
            }
            assert!(known > 5000 && taken > 4000, "{known} {taken}");
        }
    }

    #[test]
    fn far_away_a_hole_is_a_dipole() {
        let solid = cone(100);
        let above = local(&solid, DVec3::new(8.0, 8.0, 1000.0), 1.0, 1e-9).unwrap();
        // The hole's cap faces down: its inner side is seen from above.
        let expected = 1e-6 * PI * 25.0 / (4.0 * PI);
        assert!((above.value - expected).abs() < 0.02 * expected, "{} {expected}", above.value);
        assert!((above.gradient.z + 2e-3 * expected).abs() < 1e-4 * expected, "{}", above.gradient);
    }
}
