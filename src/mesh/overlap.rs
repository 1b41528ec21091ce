//! Detection of bodies that overlap, or lie within others with the same sense.
//!
//! At such places the surface winds around points more than once, and the volume that a fill rule encloses is
//! not the sum of the bodies' signed volumes.
//!
//! **Pairs.** Only bodies whose boxes meet are compared. All decisions are exact signs. If an edge of one
//! body passes through a triangle of the other, from one side to the other and between its edges, then the
//! two bodies cross. Otherwise the surfaces are apart or only touch. Touching is resolved by moving one body
//! by an infinitesimal distance, in one of eight general directions, in which no sign is zero. If the
//! surfaces do not cross after one of these moves, then the winding number of each body around the other is
//! well defined, and shows whether one lies inside the other. (Volumes are continuous in the move.) Bodies
//! that cross after every move are not decided by this: a peg that fits its hole exactly, but also two blocks
//! with sides in common planes. Points close to their contact may then prove an overlap; without such points
//! the pair stays undecided.
//!
//! **Nesting.** The winding numbers of all bodies around a body add up. The body is nested with the same
//! sense if the sum has the sign of its own volume. A cavity in a body is not nested in this sense, nor is a
//! body in a cavity.

use crate::lattice::Each;
use crate::lattice::axes;
use alloc::vec::Vec;

use super::body::{Body, Bounds, partition};
use super::intersections::corners;
use super::positions::normalised;
use super::signs::{Point, cross_sign, volume_sign};
use super::triangle_mesh::{Overlaps, TriangleMesh};
use crate::error::Error;
use crate::lattice::exact::sign;
use crate::memory;
use core::array::from_fn as array;

/// Compares the bodies whose `senses`, the signs of their volumes, are not zero. These bodies must be closed.
/// With `walls`, pairs of triangles that cancel each other exist, and passing through one is no crossing.
///
/// O(t + b log b) for t triangles and b bodies with few boxes that meet. A body whose box meets the boxes of
/// two other bodies is sorted once, in O(t log t) for its t triangles. From then on, another body within its
/// box costs only a search for the triangles near that body. Work is limited to 2^24 steps plus 128 a
/// triangle; pairs that remain then are undecided.
pub(super) fn overlaps(
    mesh: &TriangleMesh,
    of_triangles: &[u32],
    senses: &[i32],
    walls: bool,
) -> Result<Overlaps, Error> {
    if senses.iter().filter(|&&sense| sense != 0).count() < 2 {
        return Ok(Overlaps::default());
    }
    let mut all = Search { mesh, walls, steps: (1 << 24) + 128 * mesh.triangles().len() as u64 };
    let mut near = [Vec::new(), Vec::new()];
    let mut bodies = Body::all(mesh, of_triangles, senses)?;
    // Sort by the lower ends of the boxes along x.
    bodies.sort_unstable_by(|a, b| a.bounds.low[0].total_cmp(&b.bounds.low[0]));
    // Bodies with the surrounding bodies that wind in their sense; and pairs of bodies that touch.
    let (mut nested, mut touching) = (Vec::new(), Vec::new());
    // The bodies that begin before the current one and may reach it.
    let mut open: Vec<usize> = Vec::new();
    for current in 0..bodies.len() {
        let start = bodies[current].bounds.low[0];
        open.retain(|&other| bodies[other].bounds.high[0] > start);
        if !all.take(open.len()) {
            bodies.iter_mut().for_each(|body| body.undecided = true);
            break;
        }
        for &other in &open {
            let (before, from) = bodies.split_at_mut(current);
            let (a, b) = (&mut before[other], &mut from[0]);
            if !a.bounds.overlaps(&b.bounds) {
                continue;
            }
            let mut touches = Touches::NONE;
            match all.compare([a, b], &mut near, &mut touches)? {
                Relation::Crossing => (a.overlaps, b.overlaps) = (true, true),
                Relation::Around([of_a, of_b]) => {
                    (b.around, a.around) = (b.around + of_a, a.around + of_b);
                    if of_a * b.sense > 0 {
                        memory::push(&mut nested, (current, other))?;
                    }
                    if of_b * a.sense > 0 {
                        memory::push(&mut nested, (other, current))?;
                    }
                }
                Relation::Undecided => memory::push(&mut touching, (other, current, touches))?,
            }
        }
        memory::push(&mut open, current)?;
    }
    for (a, b, touches) in touching {
        let both = all.overlap_near(&bodies, [a, b], &touches);
        for k in [a, b] {
            let body = &mut bodies[k];
            *(if both { &mut body.overlaps } else { &mut body.undecided }) = true;
        }
    }
    for (inner, outer) in nested {
        let Body { around, sense, undecided, .. } = bodies[inner];
        if !undecided && around * sense > 0 {
            (bodies[inner].overlaps, bodies[outer].overlaps) = (true, true);
        }
    }
    let count = |test: fn(&Body) -> bool| bodies.iter().filter(|body| test(body)).count() as u64;
    Ok(Overlaps {
        overlapping: count(|body| body.overlaps),
        undecided: count(|body| body.undecided && !body.overlaps),
    })
}

/// A general direction: (s₀ε, s₁ε², s₂ε³) for all sufficiently small ε > 0, with signs s.
#[derive(Clone, Copy)]
struct Shift([i32; 3]);

impl Shift {
    const COUNT: usize = 8;

    fn new(index: usize) -> Shift {
        Shift(axes(|axis| if index >> axis & 1 == 0 { 1 } else { -1 }))
    }

    fn back(self) -> Shift {
        Shift(self.0.each(|s| -s))
    }

    /// Returns the sign of `value` or, if it is zero, the sign of the first non-zero coefficient.
    fn sign(self, value: i32, coefficient: impl Fn(usize) -> i32) -> i32 {
        let moved = || (0..3).map(|axis| self.0[axis] * coefficient(axis)).find(|&s| s != 0);
        if value != 0 { value } else { moved().unwrap_or(0) }
    }
}

/// The relation of two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Relation {
    /// The surfaces cross.
    Crossing,
    /// The surfaces do not cross. The winding numbers of each body around the other.
    Around([i32; 2]),
    /// Neither was established.
    Undecided,
}

/// Places at which triangles of two bodies touch, so that they would cross after a move of the second body.
#[derive(Debug, Clone, Copy)]
struct Touches {
    /// A bit for each move, set if they cross after it.
    crossing: u8,
    /// Some of the places, each with the size of the triangles there.
    places: [(Point, f64); Touches::PLACES],
    count: usize,
}

impl Touches {
    const PLACES: usize = 8;
    const NONE: Touches = Touches { crossing: 0, places: [([0.0; 3], 0.0); Touches::PLACES], count: 0 };

    /// Records the overlap of the boxes around two triangles that cross after a move.
    fn note(&mut self, a: &Bounds, b: &Bounds) {
        let Some(place) = self.places.get_mut(self.count) else { return };
        let low: Point = array(|axis| a.low[axis].max(b.low[axis]));
        let high: Point = array(|axis| a.high[axis].min(b.high[axis]));
        let extent = |low: &Point, high: &Point| (0..3).fold(0.0, |most: f64, k| most.max(high[k] - low[k]));
        let size = match extent(&low, &high) {
            0.0 => extent(&a.low, &a.high).min(extent(&b.low, &b.high)),
            size => size,
        };
        *place = (array(|axis| low[axis].midpoint(high[axis])), size);
        self.count += 1;
    }
}

struct Search<'a> {
    mesh: &'a TriangleMesh,
    /// Whether some triangles may cancel each other.
    walls: bool,
    /// Number of steps left.
    steps: u64,
}

impl Search<'_> {
    /// Compares two bodies whose boxes meet, and records where they touch. `near` is scratch memory.
    fn compare(
        &mut self,
        [a, b]: [&mut Body; 2],
        [near_a, near_b]: &mut [Vec<u32>; 2],
        touches: &mut Touches,
    ) -> Result<Relation, Error> {
        if self.steps == 0 {
            return Ok(Relation::Undecided);
        }
        let (bounds_a, bounds_b) = (a.bounds, b.bounds);
        let (near_a, steps_a) = a.near(self.mesh, &bounds_b, near_a)?;
        let (near_b, steps_b) = b.near(self.mesh, &bounds_a, near_b)?;
        let is_crossing =
            if self.take(steps_a + steps_b) { self.divide(near_a, near_b, touches) } else { None };
        let apart = (0..Shift::COUNT).find(|k| touches.crossing >> k & 1 == 0).map(Shift::new);
        Ok(match (is_crossing, apart) {
            (Some(true), _) if !self.walls => Relation::Crossing,
            (Some(false), Some(shift)) => {
                let [of_a, of_b] = [&*b, &*a].each(|body| corners(self.mesh, body.triangles[0])[0]);
                match (self.winding(a, &of_a, shift), self.winding(b, &of_b, shift.back())) {
                    (Some(of_a), Some(of_b)) => Relation::Around([of_a, of_b]),
                    _ => Relation::Undecided,
                }
            }
            _ => Relation::Undecided,
        })
    }

    /// Takes steps; returns whether enough were left.
    fn take(&mut self, steps: usize) -> bool {
        let left = self.steps.checked_sub(steps as u64);
        self.steps = left.unwrap_or(0);
        left.is_some()
    }

    fn bounds(&self, triangles: &[u32]) -> Bounds {
        let mut bounds = Bounds::NONE;
        triangles.iter().for_each(|&t| corners(self.mesh, t).iter().for_each(|p| bounds.include(p)));
        bounds
    }

    /// Returns whether triangles of the two lists cross; `None` if no steps are left. Records where they
    /// touch. Reorders the lists.
    fn crossings(&mut self, a: &mut [u32], b: &mut [u32], touches: &mut Touches) -> Option<bool> {
        if !self.take(a.len() + b.len()) {
            return None;
        }
        let (bounds_a, bounds_b) = (self.bounds(a), self.bounds(b));
        let kept_a = partition(a, |&t| self.bounds(&[t]).touches(&bounds_b));
        let kept_b = partition(b, |&t| self.bounds(&[t]).touches(&bounds_a));
        self.divide(&mut a[..kept_a], &mut b[..kept_b], touches)
    }

    /// Does the same for lists without triangles that lie outside of the box around the other list.
    fn divide(&mut self, a: &mut [u32], b: &mut [u32], touches: &mut Touches) -> Option<bool> {
        /// Pairs up to this number are not worth dividing.
        const FEW: usize = 64;
        if a.is_empty() || b.is_empty() {
            return Some(false);
        }
        if a.len() * b.len() > FEW {
            // The moves depend on which body is moved, so a flag keeps the order.
            let swapped = b.len() > a.len();
            let (longer, other) = if swapped { (b, a) } else { (a, b) };
            let bounds = self.bounds(longer);
            let axis = (1..3).fold(0, |most, axis| {
                let extent = |axis: usize| bounds.high[axis] - bounds.low[axis];
                if extent(axis) > extent(most) { axis } else { most }
            });
            // Divide at the middle of the box if that divides the list, otherwise at the middle of the list.
            let middle = bounds.low[axis].midpoint(bounds.high[axis]);
            let below = partition(longer, |&t| corners(self.mesh, t)[0][axis] < middle);
            let is_divided = below.min(longer.len() - below) > longer.len() / 8;
            let half = if is_divided { below } else { longer.len() / 2 };
            if !is_divided {
                longer.select_nth_unstable_by(half, |&s, &t| {
                    corners(self.mesh, s)[0][axis].total_cmp(&corners(self.mesh, t)[0][axis])
                });
            }
            let (low, high) = longer.split_at_mut(half);
            for part in [low, high] {
                let (first, second) = if swapped { (&mut *other, part) } else { (part, &mut *other) };
                if self.crossings(first, second, touches)? {
                    return Some(true);
                }
            }
            return Some(false);
        }
        if !self.take(4 * a.len() * b.len()) {
            return None;
        }
        for &s in &*a {
            let first = corners(self.mesh, s);
            let box_of_first = Bounds::of(&first);
            for &t in &*b {
                let second = corners(self.mesh, t);
                if box_of_first.touches(&Bounds::of(&second)) && crosses(&first, &second, touches) {
                    return Some(true);
                }
            }
        }
        Some(false)
    }

    /// Returns the winding number of a closed body around a moved point; `None` if no steps are left.
    fn winding(&mut self, body: &Body, p: &Point, shift: Shift) -> Option<i32> {
        if (0..3).any(|axis| p[axis] < body.bounds.low[axis] || p[axis] > body.bounds.high[axis]) {
            return Some(0);
        }
        if self.steps == 0 {
            return None;
        }
        let mut winding = 0;
        // Triangles below or beside the point add nothing.
        let line = Bounds { low: *p, high: [p[0], p[1], f64::INFINITY] };
        let steps = body.visit(&line, &mut |t| {
            winding += above(&corners(self.mesh, t), p, shift);
            Ok(())
        });
        // The visitor never fails.
        let is_counted = steps.is_ok_and(|steps| self.take(steps));
        is_counted.then_some(winding)
    }

    /// Returns whether points are found that prove an overlap: either a point around which both bodies wind
    /// in the same sense, and all bodies together more than once; or a point in both bodies and one in each
    /// of them alone. Tries points in eight directions from the places of contact.
    fn overlap_near(&mut self, bodies: &[Body], pair: [usize; 2], touches: &Touches) -> bool {
        let shift = Shift::new(0);
        let mut parts = [false; 4];
        for &(place, size) in &touches.places[..touches.count] {
            for (reach, k) in [0.25, 1.0 / 64.0].into_iter().flat_map(|reach| (0..8).map(move |k| (reach, k)))
            {
                // Offsets that are no round fraction of any length.
                let [x, y, z] = Shift::new(k).0.each(f64::from);
                let way = [x * 0.97, y * 0.71, z * 0.53].each(|way| way * reach * size);
                let Ok(near) = normalised(array(|axis| place[axis] + way[axis]), 0) else { continue };
                let [Some(a), Some(b)] = pair.each(|k| self.winding(&bodies[k], &near, shift)) else {
                    return false;
                };
                parts[usize::from(a != 0) + 2 * usize::from(b != 0)] = true;
                if matches!(parts, [_, true, true, true]) {
                    return true;
                }
                if a * b > 0 {
                    let all =
                        bodies.iter().try_fold(0, |sum, body| Some(sum + self.winding(body, &near, shift)?));
                    if all.is_some_and(|all| all.abs() > 1) {
                        return true;
                    }
                }
            }
        }
        false
    }
}

/// Returns whether two triangles cross: an edge of one passes through the interior of the other. If they only
/// touch, records the moves of the second triangle after which they cross.
fn crosses(a: &[Point; 3], b: &[Point; 3], touches: &mut Touches) -> bool {
    let on_one_side = |of: &[Point; 3], points: &[Point; 3]| {
        let first = volume_sign(&of[0], &of[1], &of[2], &points[0]);
        first != 0 && points[1..].iter().all(|p| volume_sign(&of[0], &of[1], &of[2], p) == first)
    };
    if on_one_side(a, b) || on_one_side(b, a) {
        return false;
    }
    let mut crossing = 0;
    // The edges of `b` move with it; moving `a` backwards is the same.
    for (edges, triangle, backwards) in [(b, a, false), (a, b, true)] {
        for k in 0..3 {
            match pierces(&edges[k], &edges[(k + 1) % 3], triangle, None) {
                Some(true) => return true,
                Some(false) => {}
                None => {
                    for index in 0..Shift::COUNT {
                        let shift = Shift::new(index);
                        let shift = if backwards { shift.back() } else { shift };
                        let moved = pierces(&edges[k], &edges[(k + 1) % 3], triangle, Some(shift));
                        crossing |= u8::from(moved == Some(true)) << index;
                    }
                }
            }
        }
    }
    if crossing != 0 {
        touches.crossing |= crossing;
        touches.note(&Bounds::of(a), &Bounds::of(b));
    }
    false
}

/// Returns whether the edge from `p` to `q`, moved by `shift`, passes through the interior of a triangle.
/// Without a move, `None` if a move may change the answer.
fn pierces(p: &Point, q: &Point, [a, b, c]: &[Point; 3], shift: Option<Shift>) -> Option<bool> {
    let signed = |value: i32, coefficient: &dyn Fn(usize) -> i32| match shift {
        Some(shift) => shift.sign(value, coefficient),
        None => value,
    };
    let side = |p: &Point| signed(volume_sign(a, b, c, p), &|axis| cross_sign([a, b], [a, c], axis));
    let (from, to) = (side(p), side(q));
    if from * to > 0 {
        return Some(false);
    }
    let along =
        |s: &Point, t: &Point| signed(volume_sign(p, q, s, t), &|axis| cross_sign([p, q], [s, t], axis));
    let edges = [along(a, b), along(b, c), along(c, a)];
    if edges.contains(&1) && edges.contains(&-1) {
        return Some(false);
    }
    let is_through = from * to < 0 && !edges.contains(&0);
    if is_through || shift.is_some() { Some(is_through) } else { None }
}

/// Returns the contribution of a triangle to the winding number around a moved point: 1 or -1 if it lies
/// above, by the side that faces the point; else 0.
fn above([a, b, c]: &[Point; 3], p: &Point, shift: Shift) -> i32 {
    for axis in 0..2 {
        let [x, y, z] = [a, b, c].each(|corner| corner[axis]);
        if p[axis] < x.min(y).min(z) || p[axis] > x.max(y).max(z) {
            return 0;
        }
    }
    // The side of an edge on which the point lies, seen from above.
    let side = |s: &Point, t: &Point| {
        shift.sign(cross_sign([s, t], [s, p], 2), |axis| match axis {
            0 => -sign(t[1] - s[1]),
            1 => sign(t[0] - s[0]),
            _ => 0,
        })
    };
    let turn = side(a, b);
    if turn == 0 || side(b, c) != turn || side(c, a) != turn {
        return 0;
    }
    let height = shift.sign(volume_sign(a, b, c, p), |axis| cross_sign([a, b], [a, c], axis));
    if height * turn < 0 { turn } else { 0 }
}
