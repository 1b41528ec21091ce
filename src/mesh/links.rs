//! Edge collapses and flips that preserve the topology of the surface.
//!
//! (Dey, Edelsbrunner, Guha and Nekhayev, *Topology preserving edge contraction*, 1999: the condition under
//! which an edge of a surface may be collapsed.)

use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// In place of a vertex: the triangle was removed.
const NONE: u32 = u32::MAX;

/// Triangles, and the triangles at each vertex.
pub(super) struct Links {
    triangles: Vec<[u32; 3]>,
    around: Vec<Vec<u32>>,
}

impl Links {
    pub(super) fn new(triangles: &[[u32; 3]], vertices: usize) -> Result<Links, Error> {
        let mut around: Vec<Vec<u32>> = memory::with_capacity(vertices)?;
        around.resize_with(vertices, Vec::new);
        for (number, triangle) in (0u32..).zip(triangles) {
            for &vertex in triangle {
                memory::push(&mut around[vertex as usize], number)?;
            }
        }
        Ok(Links { triangles: memory::copied(triangles)?, around })
    }

    /// Iterates over the triangles with their numbers, without removed ones.
    pub(super) fn all(&self) -> impl Iterator<Item = (u32, [u32; 3])> {
        (0..)
            .zip(&self.triangles)
            .filter(|(_, triangle)| triangle[0] != NONE)
            .map(|(k, &triangle)| (k, triangle))
    }

    /// Returns a triangle, unless it was removed.
    pub(super) fn triangle(&self, number: u32) -> Option<[u32; 3]> {
        Some(self.triangles[number as usize]).filter(|triangle| triangle[0] != NONE)
    }

    /// Returns the triangles at a vertex.
    pub(super) fn around(&self, vertex: u32) -> &[u32] {
        &self.around[vertex as usize]
    }

    /// Returns the only triangle that uses the edge in this direction.
    fn along(&self, from: u32, to: u32) -> Option<u32> {
        let runs = |&&number: &&u32| {
            let triangle = self.triangles[number as usize];
            (0..3).any(|k| triangle[k] == from && triangle[(k + 1) % 3] == to)
        };
        let mut all = self.around(from).iter().filter(runs);
        all.next().copied().filter(|_| all.next().is_none())
    }

    /// Returns the only triangles on the two sides of an edge, which use it in opposite directions.
    fn beside(&self, from: u32, to: u32) -> Option<[u32; 2]> {
        Some([self.along(from, to)?, self.along(to, from)?])
    }

    /// Returns the vertex of a triangle that is neither `from` nor `to`.
    fn apex(&self, number: u32, from: u32, to: u32) -> u32 {
        let triangle = self.triangles[number as usize];
        triangle.into_iter().find(|&vertex| vertex != from && vertex != to).unwrap_or(NONE)
    }

    /// Returns the neighbours of a vertex, ascending.
    fn neighbours(&self, vertex: u32) -> Result<Vec<u32>, Error> {
        let mut all = memory::with_capacity(2 * self.around(vertex).len())?;
        let corners = self.around(vertex).iter().flat_map(|&number| self.triangles[number as usize]);
        all.extend(corners.filter(|&corner| corner != vertex));
        all.sort_unstable();
        all.dedup();
        Ok(all)
    }

    /// Moves a vertex to the other end of an edge; the triangles on both sides of the edge vanish. Returns
    /// whether this was done. It is not done if an edge would then have more than two triangles, or if two
    /// triangles would have the same corners.
    pub(super) fn collapse(&mut self, from: u32, to: u32) -> Result<bool, Error> {
        let Some(sides) = self.beside(from, to) else { return Ok(false) };
        let apexes = sides.each(|number| self.apex(number, from, to));
        let (own, others) = (self.neighbours(from)?, self.neighbours(to)?);
        let common = own.iter().filter(|vertex| others.binary_search(vertex).is_ok()).count();
        let left = self.around(from).len() + self.around(to).len() - 4;
        let is_sound = apexes[0] != apexes[1]
            && common == 2
            && left >= 3
            && apexes.iter().all(|&apex| self.around(apex).len() > 3);
        if !is_sound {
            return Ok(false);
        }
        let more = self.around(from).len();
        self.around[to as usize].try_reserve(more)?;
        for number in core::mem::take(&mut self.around[from as usize]) {
            if sides.contains(&number) {
                for corner in self.triangles[number as usize] {
                    self.around[corner as usize].retain(|&own| own != number);
                }
                self.triangles[number as usize] = [NONE; 3];
                continue;
            }
            for corner in self.triangles[number as usize].iter_mut().filter(|corner| **corner == from) {
                *corner = to;
            }
            self.around[to as usize].push(number);
        }
        Ok(true)
    }

    /// Returns the triangle beyond the side that begins at a corner, and its vertex opposite that side.
    pub(super) fn across(&self, number: u32, side: usize) -> Option<(u32, u32)> {
        let triangle = self.triangle(number)?;
        let (from, to) = (triangle[side], triangle[(side + 1) % 3]);
        let [own, other] = self.beside(from, to)?;
        (own == number).then(|| (other, self.apex(other, from, to)))
    }

    /// Replaces the common side of two triangles by the other diagonal. Returns whether this was done. It is
    /// not done if the other diagonal is an edge already.
    pub(super) fn flip(&mut self, number: u32, side: usize) -> Result<bool, Error> {
        let Some((other, far)) = self.across(number, side) else { return Ok(false) };
        let triangle = self.triangles[number as usize];
        let (from, to, near) = (triangle[side], triangle[(side + 1) % 3], triangle[(side + 2) % 3]);
        let is_edge = self.around(near).iter().any(|&own| self.triangles[own as usize].contains(&far));
        if near == far || is_edge {
            return Ok(false);
        }
        self.around[near as usize].try_reserve(1)?;
        self.around[far as usize].try_reserve(1)?;
        self.triangles[number as usize] = [to, near, far];
        self.triangles[other as usize] = [near, from, far];
        self.around[from as usize].retain(|&own| own != number);
        self.around[to as usize].retain(|&own| own != other);
        self.around[near as usize].push(other);
        self.around[far as usize].push(number);
        Ok(true)
    }
}
