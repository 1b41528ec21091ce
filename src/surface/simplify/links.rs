//! Triangles whose vertices are being removed, with the triangles around each vertex.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// No corner, or no vertex.
pub(super) const NONE: u32 = u32::MAX;

/// Triangles and the corners of each vertex. A corner is three times a triangle's number plus the place in
/// the triangle.
pub(super) struct Links {
    pub(super) triangles: Vec<[u32; 3]>,
    /// The sharp sides of each triangle: bit k for the side from corner k to the next one.
    pub(super) sharp: Vec<u8>,
    /// The greatest distance of each triangle from the first surface in its place (model units).
    pub(super) errors: Vec<f64>,
    /// The first corner of each vertex, and the next one after each corner.
    heads: Vec<u32>,
    next: Vec<u32>,
    /// The first of the removed points that lay over each triangle, and the next one after each point. (The
    /// points are vertices, and the middles of sides.)
    first_gone: Vec<u32>,
    next_gone: Vec<u32>,
}

/// The vertices around a vertex, counter-clockwise as seen from outside.
#[derive(Default)]
pub(super) struct Ring {
    pub(super) vertices: Vec<u32>,
    /// The corners of the middle vertex; corner k is that of the triangle before side k.
    pub(super) corners: Vec<u32>,
    spare: Vec<(u32, u32, u32)>,
}

impl Links {
    /// Links of triangles with `count` vertices. No side is sharp yet.
    pub(super) fn new(count: usize, triangles: Vec<[u32; 3]>) -> Result<Links, Error> {
        let mut links = Links {
            sharp: memory::filled(triangles.len(), 0)?,
            errors: memory::filled(triangles.len(), 0.0)?,
            heads: memory::filled(count, NONE)?,
            next: memory::filled(3 * triangles.len(), NONE)?,
            first_gone: memory::filled(triangles.len(), NONE)?,
            next_gone: memory::filled(count + 3 * triangles.len(), NONE)?,
            triangles,
        };
        for corner in (0..links.next.len()).rev() {
            let vertex = links.triangles[corner / 3][corner % 3] as usize;
            links.next[corner] = links.heads[vertex];
            links.heads[vertex] = corner as u32;
        }
        Ok(links)
    }

    /// Returns whether a triangle still exists.
    pub(super) fn is_there(&self, triangle: usize) -> bool {
        self.triangles[triangle][0] != NONE
    }

    /// The corners of a vertex.
    pub(super) fn corners(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let mut at = self.heads[vertex as usize];
        core::iter::from_fn(move || {
            let corner = at;
            if corner == NONE {
                return None;
            }
            at = self.next[corner as usize];
            Some(corner)
        })
        .filter(|&corner| self.is_there(corner as usize / 3))
    }

    /// The two other vertices of a corner's triangle, in order.
    pub(super) fn side(&self, corner: u32) -> [u32; 2] {
        let (triangle, k) = (&self.triangles[corner as usize / 3], corner as usize % 3);
        [triangle[(k + 1) % 3], triangle[(k + 2) % 3]]
    }

    /// Finds the ring around a vertex; `false` if there is none, or if it is larger than `most`.
    pub(super) fn ring(&self, vertex: u32, most: usize, ring: &mut Ring) -> Result<bool, Error> {
        let Ring { vertices, corners, spare } = ring;
        vertices.clear();
        corners.clear();
        spare.clear();
        for corner in self.corners(vertex) {
            if spare.len() == most {
                return Ok(false);
            }
            let [from, to] = self.side(corner);
            memory::push(spare, (from, to, corner))?;
        }
        if spare.len() < 3 {
            return Ok(false);
        }
        // (Sorted by the vertices, so that the next one is found quickly.)
        spare.sort_unstable();
        if spare.windows(2).any(|two| two[0].0 == two[1].0) {
            return Ok(false);
        }
        vertices.try_reserve(spare.len())?;
        corners.try_reserve(spare.len())?;
        let first = spare[0].0;
        let mut at = first;
        loop {
            let Ok(place) = spare.binary_search_by_key(&at, |side| side.0) else { return Ok(false) };
            let (from, to, corner) = spare[place];
            vertices.push(from);
            corners.push(corner);
            at = to;
            if at == first || vertices.len() == spare.len() {
                break;
            }
        }
        Ok(at == first && vertices.len() == spare.len())
    }

    /// Returns whether the side from a corner to the next one is sharp.
    pub(super) fn is_sharp(&self, corner: u32) -> bool {
        self.sharp[corner as usize / 3] >> (corner % 3) & 1 != 0
    }

    /// The removed points that belong to a triangle.
    pub(super) fn gone(&self, triangle: usize) -> impl Iterator<Item = u32> {
        let mut at = self.first_gone[triangle];
        core::iter::from_fn(move || {
            let vertex = at;
            (vertex != NONE).then(|| {
                at = self.next_gone[vertex as usize];
                vertex
            })
        })
    }

    /// Drops the removed points that belong to a triangle.
    pub(super) fn forget(&mut self, triangle: usize) {
        self.first_gone[triangle] = NONE;
    }

    /// Adds a removed point to a triangle.
    pub(super) fn remember(&mut self, triangle: usize, vertex: u32) {
        self.next_gone[vertex as usize] = self.first_gone[triangle];
        self.first_gone[triangle] = vertex;
    }

    /// Collapses the vertex of a ring onto one of the ring's vertices: two triangles vanish.
    pub(super) fn collapse(&mut self, ring: &Ring, onto: usize) {
        let count = ring.vertices.len();
        let target = ring.vertices[onto];
        // The sides between the target and the remaining triangles. They replace sides that vanish.
        let before = (onto + count - 1) % count;
        let [first, last] = [ring.corners[onto], ring.corners[before]];
        let is_sharp = [self.is_opposite_sharp(first), self.is_opposite_sharp(last)];
        for (place, &corner) in ring.corners.iter().enumerate() {
            let triangle = corner as usize / 3;
            if place == onto || place == before {
                self.triangles[triangle] = [NONE; 3];
                continue;
            }
            let k = corner as usize % 3;
            self.triangles[triangle][k] = target;
            self.next[corner as usize] = self.heads[target as usize];
            self.heads[target as usize] = corner;
            // The triangle after the first vanishing one begins where that one ended, and the triangle before
            // the last vanishing one ends where that one began.
            if place == (onto + 1) % count {
                self.set_sharp(triangle, k, is_sharp[0]);
            }
            if place == (before + count - 1) % count {
                self.set_sharp(triangle, (k + 2) % 3, is_sharp[1]);
            }
        }
    }

    /// Returns whether the side opposite a corner is sharp.
    fn is_opposite_sharp(&self, corner: u32) -> bool {
        self.sharp[corner as usize / 3] >> ((corner + 1) % 3) & 1 != 0
    }

    pub(super) fn set_sharp(&mut self, triangle: usize, side: usize, is_sharp: bool) {
        let bit = 1 << side;
        if is_sharp {
            self.sharp[triangle] |= bit;
        } else {
            self.sharp[triangle] &= !bit;
        }
    }
}
