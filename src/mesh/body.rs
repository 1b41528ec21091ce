//! The closed bodies of a mesh, each with a list of its triangles that can be searched by place.
//!
//! A body that is searched repeatedly gets its triangles sorted along a space-filling curve, with boxes
//! around runs of triangles. Finding the triangles near a small box then does not pass through all triangles
//! of the body.

use alloc::vec::Vec;
use core::ops::Range;

use super::intersections::corners;
use super::signs::Point;
use super::triangle_mesh::TriangleMesh;
use crate::error::Error;
use crate::memory;

/// A body with its properties.
pub(super) struct Body {
    /// The triangles; in any order until there are `boxes`.
    pub(super) triangles: Vec<u32>,
    pub(super) bounds: Bounds,
    pub(super) sense: i32,
    /// The winding numbers of other bodies around this one.
    pub(super) around: i32,
    pub(super) overlaps: bool,
    pub(super) undecided: bool,
    /// True if the body was searched before.
    is_searched: bool,
    boxes: Option<Boxes>,
}

impl Body {
    /// Returns the bodies whose `senses` are not zero. O(t + b).
    pub(super) fn all(mesh: &TriangleMesh, of_triangles: &[u32], senses: &[i32]) -> Result<Vec<Body>, Error> {
        let mut counts: Vec<usize> = memory::filled(senses.len(), 0)?;
        of_triangles.iter().for_each(|&body| counts[body as usize] += 1);
        let mut bodies = memory::with_capacity(senses.len())?;
        for (&sense, &count) in senses.iter().zip(&counts) {
            bodies.push(Body {
                triangles: memory::with_capacity(if sense == 0 { 0 } else { count })?,
                bounds: Bounds::NONE,
                sense,
                around: 0,
                overlaps: false,
                undecided: false,
                is_searched: false,
                boxes: None,
            });
        }
        for (triangle, &body) in (0..).zip(of_triangles) {
            let body = &mut bodies[body as usize];
            if body.sense != 0 {
                body.triangles.push(triangle);
                corners(mesh, triangle).iter().for_each(|p| body.bounds.include(p));
            }
        }
        bodies.retain(|body| body.sense != 0);
        Ok(bodies)
    }

    /// Returns the triangles whose boxes meet `around`, in any order, and the number of search steps, which
    /// is at most the number of triangles. `near` is memory that the result may use.
    ///
    /// The first search goes through all triangles, the second one sorts them.
    pub(super) fn near<'a>(
        &'a mut self,
        mesh: &TriangleMesh,
        around: &Bounds,
        near: &'a mut Vec<u32>,
    ) -> Result<(&'a mut [u32], usize), Error> {
        /// A body of at most this many triangles is always searched linearly.
        const FEW: usize = 256;
        if self.is_searched && self.boxes.is_none() && self.triangles.len() > FEW {
            self.boxes = Some(Boxes::new(mesh, &mut self.triangles, &self.bounds)?);
        }
        self.is_searched = true;
        let touches = |t: &u32| Bounds::of(&corners(mesh, *t)).touches(around);
        if self.boxes.is_none() {
            let steps = self.triangles.len();
            let kept = partition(&mut self.triangles, touches);
            return Ok((&mut self.triangles[..kept], steps));
        }
        near.clear();
        let steps = self.visit(around, &mut |t| if touches(&t) { memory::push(near, t) } else { Ok(()) })?;
        Ok((near, steps))
    }

    /// Calls `visit` with every triangle whose box meets `around`, and with some others. Returns the number
    /// of steps, which is at most the number of triangles.
    pub(super) fn visit(
        &self,
        around: &Bounds,
        visit: &mut impl FnMut(u32) -> Result<(), Error>,
    ) -> Result<usize, Error> {
        match &self.boxes {
            None => {
                self.triangles.iter().try_for_each(|&t| visit(t))?;
                Ok(self.triangles.len())
            }
            Some(boxes) => {
                let mut steps = 0;
                boxes.visit(around, &mut |run| {
                    steps += run.len();
                    self.triangles[run].iter().try_for_each(|&t| visit(t))
                })?;
                Ok(steps)
            }
        }
    }
}

/// Boxes around runs of triangles, around runs of those boxes, and so on up to one box. Seven bytes a
/// triangle.
struct Boxes {
    /// The boxes of all levels, the lowest first.
    boxes: Vec<Bounds>,
    /// The starts of the levels in `boxes`, and the end of the last one.
    starts: Vec<usize>,
    /// Number of triangles.
    count: usize,
}

/// Number of triangles, or of boxes, in a run.
const RUN: usize = 8;

impl Boxes {
    /// Sorts the triangles, whose bounds are given, and builds the boxes. O(t log t).
    fn new(mesh: &TriangleMesh, triangles: &mut [u32], bounds: &Bounds) -> Result<Boxes, Error> {
        let place = |t: u32| bounds.place(&corners(mesh, t)[0]);
        let mut sorted: Vec<u64> =
            memory::collected(triangles.iter().map(|&t| u64::from(place(t)) << 32 | u64::from(t)))?;
        sorted.sort_unstable();
        triangles.iter_mut().zip(&sorted).for_each(|(triangle, &key)| *triangle = key as u32);
        // Each level is at most an eighth of the one below, rounded up.
        let mut boxes: Vec<Bounds> = memory::with_capacity(triangles.len() / (RUN - 1) + 32)?;
        let mut starts = memory::with_capacity(32)?;
        starts.push(0);
        for run in triangles.chunks(RUN) {
            let mut bounds = Bounds::NONE;
            run.iter().for_each(|&t| corners(mesh, t).iter().for_each(|p| bounds.include(p)));
            memory::push(&mut boxes, bounds)?;
        }
        let mut level = 0..boxes.len();
        memory::push(&mut starts, level.end)?;
        while level.len() > 1 {
            for first in level.clone().step_by(RUN) {
                let mut bounds = Bounds::NONE;
                for below in &boxes[first..level.end.min(first + RUN)] {
                    bounds.include(&below.low);
                    bounds.include(&below.high);
                }
                memory::push(&mut boxes, bounds)?;
            }
            level = level.end..boxes.len();
            memory::push(&mut starts, level.end)?;
        }
        Ok(Boxes { boxes, starts, count: triangles.len() })
    }

    /// Calls `visit` with the runs of triangles in the lowest boxes that meet `around`.
    fn visit(
        &self,
        around: &Bounds,
        visit: &mut impl FnMut(Range<usize>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        // The highest level is one box.
        self.visit_below(self.starts.len() - 2, 0, around, visit)
    }

    /// Does the same below one box of a level. The recursion is as deep as there are levels, eleven at most.
    fn visit_below(
        &self,
        level: usize,
        index: usize,
        around: &Bounds,
        visit: &mut impl FnMut(Range<usize>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if !self.boxes[self.starts[level] + index].touches(around) {
            return Ok(());
        }
        let first = RUN * index;
        if level == 0 {
            return visit(first..self.count.min(first + RUN));
        }
        let below = self.starts[level] - self.starts[level - 1];
        (first..below.min(first + RUN))
            .try_for_each(|index| self.visit_below(level - 1, index, around, visit))
    }
}

/// An axis-aligned box.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    pub(super) low: Point,
    pub(super) high: Point,
}

impl Bounds {
    pub(super) const NONE: Bounds = Bounds { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    pub(super) fn of(points: &[Point]) -> Bounds {
        let mut bounds = Bounds::NONE;
        points.iter().for_each(|p| bounds.include(p));
        bounds
    }

    pub(super) fn include(&mut self, p: &Point) {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(p[axis]);
            self.high[axis] = self.high[axis].max(p[axis]);
        }
    }

    /// Returns whether the interiors meet.
    pub(super) fn overlaps(&self, other: &Bounds) -> bool {
        (0..3).all(|axis| self.low[axis] < other.high[axis] && other.low[axis] < self.high[axis])
    }

    /// Returns whether the closed boxes meet.
    pub(super) fn touches(&self, other: &Bounds) -> bool {
        // Without branches, because they would usually be mispredicted.
        (0..3).fold(true, |touches, axis| {
            touches & (self.low[axis] <= other.high[axis]) & (other.low[axis] <= self.high[axis])
        })
    }

    /// Returns the approximate place of a point of the box: a number on a Morton curve of 2^30 steps through
    /// the box.
    fn place(&self, p: &Point) -> u32 {
        (0..3).fold(0, |place, axis| {
            // If the box is flat, the NaN becomes zero.
            let share = (p[axis] - self.low[axis]) / (self.high[axis] - self.low[axis]);
            let mut bits = ((share * 1024.0) as u32).min(1023);
            bits = (bits | bits << 16) & 0x0300_00ff;
            bits = (bits | bits << 8) & 0x0300_f00f;
            bits = (bits | bits << 4) & 0x030c_30c3;
            bits = (bits | bits << 2) & 0x0924_9249;
            place | bits << axis
        })
    }
}

/// Moves the items that pass the test to the front and returns their number.
pub(super) fn partition<T>(items: &mut [T], test: impl Fn(&T) -> bool) -> usize {
    let mut kept = 0;
    for k in 0..items.len() {
        if test(&items[k]) {
            items.swap(kept, k);
            kept += 1;
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Searches find exactly the triangles whose boxes meet another box, among triangles of very different
    /// sizes.
    #[test]
    fn searches_find_every_triangle() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        for count in [1, 8, 9, 64, 65, 513, 5000] {
            let mut vertices = Vec::new();
            for _ in 0..count {
                let size = 1e-3 + random().powi(6);
                let corner: Point = [random(), random(), if count == 65 { 0.5 } else { random() }];
                (0..3).for_each(|_| vertices.push(corner.map(|x| x + size * random())));
            }
            let triangles: Vec<_> = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let mesh = TriangleMesh::new(vertices, triangles).unwrap();
            assert_eq!(mesh.triangles().len(), count as usize);
            let of_triangles = memory::filled(count as usize, 0).unwrap();
            let mut bodies = Body::all(&mesh, &of_triangles, &[1]).unwrap();
            let body = &mut bodies[0];
            body.boxes = Some(Boxes::new(&mesh, &mut body.triangles, &body.bounds.clone()).unwrap());
            let mut scratch = Vec::new();
            for _ in 0..200 {
                let low: Point = [random(), random(), random()];
                let size = random().powi(4);
                let high = low.map(|x| x + size);
                for around in [
                    Bounds { low, high },
                    Bounds { low, high: [low[0], low[1], f64::INFINITY] },
                    // Touching counts.
                    Bounds { low: body.bounds.high, high: [9.0; 3] },
                ] {
                    let touches = |&t: &u32| Bounds::of(&corners(&mesh, t)).touches(&around);
                    let expected: Vec<u32> = (0..count).filter(touches).collect();
                    let (found, steps) = body.near(&mesh, &around, &mut scratch).unwrap();
                    found.sort_unstable();
                    assert_eq!(found, expected);
                    assert!(steps >= expected.len() && steps <= count as usize);
                }
            }
        }
    }
}
