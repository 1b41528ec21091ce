//! Removing vertices one after the other, first those whose removal moves the surface least.

use super::links::{Links, NONE, Ring};
use super::patch::Patch;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::walk::Queue;
use alloc::vec::Vec;
use core::cmp::Reverse;

/// Vertices with more triangles than this stay.
const MOST: usize = 96;

/// The weight of a side's length in the rank, besides the movement of the surface. Among equally good
/// vertices, those that lie close together go first.
const LENGTH: f64 = 1e-3;

/// A sum of steps up to this part of the tolerance is used as the error bound. Beyond it, the points of the
/// first surface are evaluated.
const SURE: f64 = 0.125;

/// If a triangle has more points than this, every other point is dropped.
const MANY: usize = 64;

/// The number of vertices between two checks for cancellation.
const CHECKED: usize = 1 << 10;

/// A possible collapse of a vertex: its target, and the distance of the result from the first surface.
#[derive(Clone, Copy)]
struct Step {
    onto: u32,
    error: f64,
    /// Whether `error` is the sum of all steps so far.
    is_sum: bool,
    rank: f64,
}

/// A mesh while its vertices are being removed.
pub(super) struct Collapse<'c> {
    pub(super) links: Links,
    vertices: &'c [[f64; 3]],
    /// The greatest movement of the surface at each vertex (model units). Vertices with 0 stay.
    limits: &'c [f64],
    /// The middles of the sides, triangle by triangle.
    middles: Vec<[f64; 3]>,
    /// The vertex onto which each vertex was collapsed.
    pub(super) went: Vec<u32>,
    /// The number of changes of a vertex's surroundings.
    changes: Vec<u32>,
    marks: Marks,
    ring: Ring,
    patch: Patch,
    gone: Vec<u32>,
    queue: Queue<Reverse<(u64, u32)>, (u32, Step)>,
}

impl<'c> Collapse<'c> {
    pub(super) fn new(mut links: Links, vertices: &'c [[f64; 3]], limits: &'c [f64]) -> Result<Self, Error> {
        let count = vertices.len();
        let mut middles = memory::with_capacity(links.triangles.len() * 3 / 2 + 3)?;
        for triangle in 0..links.triangles.len() {
            let corners = links.triangles[triangle];
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                if a < b {
                    links.remember(triangle, (count + middles.len()) as u32);
                    let (a, b) = (vertices[a as usize], vertices[b as usize]);
                    memory::push(&mut middles, axes(|k| 0.5 * (a[k] + b[k])))?;
                }
            }
        }
        Ok(Collapse {
            middles,
            links,
            vertices,
            limits,
            gone: Vec::new(),
            went: memory::filled(count, NONE)?,
            changes: memory::filled(count, 0)?,
            marks: Marks { marks: memory::filled(count, 0)?, last: 0 },
            ring: Ring::default(),
            patch: Patch::default(),
            queue: Queue::new(),
        })
    }

    /// Removes vertices until no more can go. Progress advances by `parts`.
    pub(super) fn run(&mut self, job: &Job<'_>, parts: usize) -> Result<(), Error> {
        for vertex in 0..self.vertices.len() as u32 {
            if (vertex as usize).is_multiple_of(CHECKED) {
                job.check()?;
            }
            self.enter(vertex)?;
        }
        job.advance(parts / 2);
        let mut taken = 0;
        while let Some(entry) = self.queue.peek() {
            let Reverse((_, vertex)) = entry.key;
            // (The queue is not empty, as the line before shows.)
            let Some((changes, step)) = self.queue.pop() else { break };
            if self.changes[vertex as usize] != changes {
                continue;
            }
            taken += 1;
            if usize::is_multiple_of(taken, CHECKED) {
                job.check()?;
            }
            self.links.ring(vertex, MOST, &mut self.ring)?;
            let onto = self.ring.vertices.iter().position(|&other| other == step.onto);
            let Some(onto) = onto.filter(|&onto| self.marks.may_go(&self.links, &self.ring, onto)) else {
                // The surroundings beyond the ring have changed since.
                self.enter(vertex)?;
                continue;
            };
            self.take(vertex, onto, &step)?;
            self.went[vertex as usize] = step.onto;
            self.changes[vertex as usize] += 1;
            let around = core::mem::take(&mut self.ring.vertices);
            for &other in &around {
                self.changes[other as usize] += 1;
                self.enter(other)?;
            }
            self.ring.vertices = around;
        }
        job.advance(parts - parts / 2);
        Ok(())
    }

    /// A point of the first surface: a vertex, or, with a greater number, the middle of a side.
    fn point(&self, number: u32) -> [f64; 3] {
        let number = number as usize;
        if number < self.vertices.len() {
            self.vertices[number]
        } else {
            self.middles[number - self.vertices.len()]
        }
    }

    /// Removes the vertex in the middle of the ring.
    fn take(&mut self, vertex: u32, onto: usize, step: &Step) -> Result<(), Error> {
        let ring = self.ring.vertices.iter().map(|&other| self.vertices[other as usize]);
        self.patch.see(self.vertices[vertex as usize], ring)?;
        self.gone.clear();
        memory::push(&mut self.gone, vertex)?;
        for triangle in self.ring.corners.iter().map(|&corner| corner as usize / 3) {
            let few = if self.links.gone(triangle).count() > MANY { 2 } else { 1 };
            for gone in self.links.gone(triangle).step_by(few) {
                memory::push(&mut self.gone, gone)?;
            }
            self.links.forget(triangle);
        }
        for &gone in &self.gone {
            self.patch.add(self.point(gone))?;
        }
        let change = if step.is_sum { step.error } else { self.patch.change(onto) };
        self.links.collapse(&self.ring, onto);
        for &corner in &self.ring.corners {
            self.links.errors[corner as usize / 3] = change;
        }
        for (&gone, (place, far)) in self.gone.iter().zip(self.patch.places(onto)) {
            let triangle = self.ring.corners[place] as usize / 3;
            self.links.remember(triangle, gone);
            if !step.is_sum {
                self.links.errors[triangle] = self.links.errors[triangle].max(far);
            }
        }
        Ok(())
    }

    /// Puts a vertex into the queue, if it can go.
    fn enter(&mut self, vertex: u32) -> Result<(), Error> {
        let Some(step) = self.best(vertex)? else { return Ok(()) };
        // (The bits of non-negative numbers have the same order as the numbers.)
        let key = Reverse((step.rank.to_bits(), vertex));
        self.queue.push(key, (self.changes[vertex as usize], step))
    }

    /// Returns the best collapse of a vertex.
    fn best(&mut self, vertex: u32) -> Result<Option<Step>, Error> {
        let limit = self.limits[vertex as usize];
        if limit == 0.0 || !self.links.ring(vertex, MOST, &mut self.ring)? {
            return Ok(None);
        }
        let count = self.ring.vertices.len();
        let is_sharp = |k: usize| self.links.is_sharp(self.ring.corners[k % count]);
        let sharp = (0..count).filter(|&k| is_sharp(k)).count();
        if sharp != 0 && sharp != 2 {
            return Ok(None);
        }
        let middle = self.vertices[vertex as usize];
        let ring = self.ring.vertices.iter().map(|&other| self.vertices[other as usize]);
        if !self.patch.see(middle, ring)? {
            return Ok(None);
        }
        let triangles = self.ring.corners.iter().map(|&corner| corner as usize / 3);
        let before = triangles.clone().fold(0.0, |most: f64, triangle| most.max(self.links.errors[triangle]));
        self.patch.add(middle)?;
        for gone in triangles.flat_map(|triangle| self.links.gone(triangle)) {
            self.patch.add(self.point(gone))?;
        }
        let mut best: Option<Step> = None;
        for k in 0..count {
            // A vertex on an edge of the shape can only move along the edge, whose two parts become one.
            if sharp == 2 && (!is_sharp(k) || is_sharp(k + 1) || is_sharp(k + count - 1)) {
                continue;
            }
            if !self.patch.may_go(k) {
                continue;
            }
            let change = self.patch.change(k);
            let long = LENGTH * self.patch.length(k);
            let is_better = |error: f64| error <= limit && best.is_none_or(|best| error + long < best.rank);
            if !is_better(change) {
                continue;
            }
            let sum = before + change;
            let is_sum = sum <= SURE * limit;
            let error = if is_sum {
                Some(sum).filter(|&sum| is_better(sum))
            } else {
                self.patch.places(k).try_fold(change, |most, (_, far)| {
                    let most = f64::max(most, far);
                    is_better(most).then_some(most)
                })
            };
            if let Some(error) = error
                && self.marks.may_go(&self.links, &self.ring, k)
            {
                let rank = error + long;
                best = Some(Step { onto: self.ring.vertices[k], error, is_sum, rank });
            }
        }
        Ok(best)
    }
}

/// Marks of the neighbours of a vertex: those with the last mark.
struct Marks {
    marks: Vec<u32>,
    last: u32,
}

impl Marks {
    /// Returns whether the surface stays connected in the same way if the middle of the ring moves to one of
    /// its vertices: no new side may exist already.
    fn may_go(&mut self, links: &Links, ring: &Ring, onto: usize) -> bool {
        let vertices = &ring.vertices;
        let count = vertices.len();
        let [target, next, before] = [0, 1, count - 1].each(|step| vertices[(onto + step) % count]);
        self.last = self.last.wrapping_add(1);
        if self.last == 0 {
            // All mark numbers have been used.
            self.marks.fill(0);
            self.last = 1;
        }
        for corner in links.corners(target) {
            let side = links.side(corner);
            if count == 3 && side == [before, next] {
                return false;
            }
            side.iter().for_each(|&vertex| self.marks[vertex as usize] = self.last);
        }
        let is_neighbour = |vertex: u32| self.marks[vertex as usize] == self.last;
        vertices.iter().all(|&own| own == next || own == before || own == target || !is_neighbour(own))
    }
}
