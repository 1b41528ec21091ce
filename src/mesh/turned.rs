//! Facets with reversed orientation.

use alloc::vec::Vec;

use super::topology::{DisjointSets, for_each_edge};
use super::triangle_mesh::TriangleMesh;
use crate::error::{Error, MeshError};
use crate::memory;

impl TriangleMesh {
    /// Returns the number of triangles that face the other way than most triangles of their body. Triangles
    /// belong to one body if they are connected by edges that exactly two triangles use.
    ///
    /// The number is 0 for a mesh that is inverted as a whole. For a one-sided surface, which has no
    /// consistent orientation, the number only shows that there are such triangles.
    ///
    /// O(t + v), computed anew on each call.
    ///
    /// # Errors
    /// [`MeshError::TooMany`] beyond 2^31 triangles; [`Error::OutOfMemory`].
    pub fn turned_triangles(&self) -> Result<u64, Error> {
        let triangles = self.triangles();
        let count = triangles.len();
        if count > u32::MAX as usize / 2 {
            return Err(MeshError::TooMany.into());
        }
        // Member 2 t stands for triangle t as it is, 2 t + 1 for the reversed triangle.
        let mut sets = DisjointSets::new(2 * count)?;
        for_each_edge(triangles, self.vertices().len(), |edge| {
            if edge.count() == 2 {
                let turn = u32::from(edge.excess() != 0);
                let (mut a, mut b) = (edge.first(), edge.first());
                edge.triangles().for_each(|t| (a, b) = (b, t));
                sets.unite(2 * a, 2 * b + turn);
                sets.unite(2 * a + 1, 2 * b + 1 - turn);
            }
            Ok(())
        })?;
        let numbers = sets.numbers();
        // For each set, the number of triangles that are in it as they are. The other triangles of a body are
        // in the set of its opposites.
        let mut sizes: Vec<u64> =
            memory::filled(numbers.iter().max().map_or(0, |&last| last as usize + 1), 0)?;
        numbers.chunks_exact(2).for_each(|sides| sizes[sides[0] as usize] += 1);
        let mut turned = 0;
        let mut seen = memory::filled(sizes.len(), false)?;
        for sides in numbers.chunks_exact(2) {
            let [a, b] = [sides[0] as usize, sides[1] as usize];
            if !core::mem::replace(&mut seen[a.min(b)], true) {
                turned += if a == b { 1 } else { sizes[a].min(sizes[b]) };
            }
        }
        Ok(turned)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turned_triangles_are_the_fewer_ones_of_each_body() {
        let corners = |shift: f64| -> Vec<[f64; 3]> {
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                .map(|[x, y, z]| [x + shift, y, z])
                .into()
        };
        let facets = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let count = |vertices: Vec<[f64; 3]>, facets: Vec<[u32; 3]>| {
            TriangleMesh::new(vertices, facets).unwrap().turned_triangles().unwrap()
        };
        assert_eq!(count(corners(0.0), facets.into()), 0);
        let turn = |[a, b, c]: [u32; 3]| [a, c, b];
        assert_eq!(count(corners(0.0), facets.map(turn).into()), 0);
        for turned in 0..4 {
            let mut facets = facets;
            facets[turned] = turn(facets[turned]);
            assert_eq!(count(corners(0.0), facets.into()), 1);
            assert_eq!(count(corners(0.0), facets.map(turn).into()), 1);
            // Beside a body that is correct, or inverted.
            let both = [corners(0.0), corners(5.0)].concat();
            let mut second = other_body(turned % 2 == 1);
            second.extend(facets);
            assert_eq!(count(both, second), 1);
        }
        // A Möbius strip.
        let ring: Vec<_> = (0..5).map(|i| [f64::from(i), f64::from(i * i), f64::from(i * i * i)]).collect();
        let strip = (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect();
        assert_eq!(count(ring, strip), 1);
    }

    /// A second tetrahedron, whose vertices follow those of the first.
    fn other_body(is_inside_out: bool) -> Vec<[u32; 3]> {
        let facets = [[4, 6, 5], [4, 5, 7], [5, 6, 7], [6, 4, 7]];
        if is_inside_out { facets.map(|[a, b, c]| [a, c, b]).into() } else { facets.into() }
    }
}
