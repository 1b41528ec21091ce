//! Exact welding of vertices at the same place.

use alloc::vec::Vec;
use core::borrow::Borrow;

use super::positions::{NOWHERE, Places, is_proper, normalised};
use super::triangle_mesh::TriangleMesh;
use crate::error::{Error, MeshError};
use crate::memory;

/// Number of facets whose corners are looked up together.
const FACETS: usize = BATCH / 3;
const BATCH: usize = Places::BATCH;

impl TriangleMesh {
    /// Builds a mesh from separate triangles, each given by its three corners. Vertices are in order of
    /// appearance.
    ///
    /// O(t).
    ///
    /// # Errors
    /// [`MeshError::TooMany`]; [`MeshError::NotFinite`] or [`MeshError::TooLarge`] with the index of the
    /// corner, counted through all facets; or [`Error::OutOfMemory`].
    pub fn from_facets<I>(facets: I) -> Result<Self, Error>
    where
        I: IntoIterator<Item: Borrow<[[f64; 3]; 3]>>,
    {
        let facets = facets.into_iter();
        let mut welder = FacetWelder::with_capacity(facets.size_hint().0)?;
        for facet in facets {
            welder.push(facet.borrow())?;
        }
        Ok(welder.finish())
    }
}

/// A welder that accepts a triangle soup in portions, so that readers need not store it.
///
/// Besides the mesh it needs 10.7 to 21.4 bytes for each vertex of the mesh (briefly 32 when it grows), or
/// for each of the expected number of vertices.
pub(crate) struct FacetWelder {
    places: Places,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    facets: u64,
}

impl FacetWelder {
    /// Makes a welder with room for about `facets` facets. The data of that many facets must exist.
    pub fn with_capacity(facets: usize) -> Result<Self, Error> {
        // A closed mesh has about half as many vertices as triangles. A soup with more vertices makes the
        // table grow.
        let vertices = facets / 2 + facets / 16;
        let mut welder = Self {
            places: Places::with_capacity(vertices)?,
            vertices: Vec::new(),
            triangles: Vec::new(),
            facets: 0,
        };
        welder.vertices.try_reserve_exact(vertices)?;
        welder.triangles.try_reserve_exact(facets)?;
        Ok(welder)
    }

    /// Adds a facet. Fails as [`TriangleMesh::from_facets`] does.
    #[inline]
    pub fn push(&mut self, facet: &[[f64; 3]; 3]) -> Result<(), Error> {
        self.extend(core::slice::from_ref(facet))
    }

    /// Adds facets; eight or more at a time are added faster. Fails as [`TriangleMesh::from_facets`] does.
    #[inline]
    pub fn extend(&mut self, facets: &[[[f64; 3]; 3]]) -> Result<(), Error> {
        for facets in facets.chunks(FACETS) {
            let mut corners = [[0.0; 3]; BATCH];
            for ((corner, &given), k) in corners.iter_mut().zip(facets.as_flattened()).zip(0..) {
                *corner = normalised(given, self.facets * 3 + k)?;
            }
            let corners = &corners[..3 * facets.len()];
            let lookup = self.places.look_up(corners, &self.vertices);
            let mut indices = [0; BATCH];
            for (k, &corner) in corners.iter().enumerate() {
                indices[k] = self.weld(lookup.found[k], lookup.hashes[k], corner)?;
            }
            self.facets += facets.len() as u64;
            for triangle in indices[..corners.len()].as_chunks::<3>().0 {
                if is_proper(triangle) {
                    if u32::try_from(self.triangles.len()).map_or(true, |count| count == u32::MAX) {
                        return Err(MeshError::TooMany.into());
                    }
                    memory::push(&mut self.triangles, *triangle)?;
                }
            }
        }
        Ok(())
    }

    /// Returns the mesh of all added facets.
    pub fn finish(self) -> TriangleMesh {
        let welded = self.facets * 3 - self.vertices.len() as u64;
        let degenerate = self.facets - self.triangles.len() as u64;
        let (vertices, triangles) = (self.vertices, self.triangles);
        TriangleMesh::from_welded(vertices, triangles, welded, degenerate)
    }

    #[inline(always)]
    fn weld(&mut self, found: u32, hash: u64, vertex: [f64; 3]) -> Result<u32, Error> {
        if found != NOWHERE {
            return Ok(found);
        }
        let next = u32::try_from(self.vertices.len()).map_err(|_| MeshError::TooMany)?;
        if next == NOWHERE {
            return Err(MeshError::TooMany.into());
        }
        let index = self.places.find_or_insert(hash, &vertex, next, &self.vertices)?;
        if index == next {
            memory::push(&mut self.vertices, vertex)?;
        }
        Ok(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::collections::BTreeMap;

    /// Positions that recur near by, far away, within one batch, and never.
    fn positions(count: u32) -> impl Iterator<Item = [f64; 3]> {
        (0..count).map(move |i| {
            let i = match i % 7 {
                0 => i / 2,
                1 => i.wrapping_mul(0x9E37_79B9) % count,
                2 => i - 2,
                _ => i,
            };
            [i % 1000, i / 1000, i % 3].map(f64::from)
        })
    }

    #[test]
    fn the_first_of_equal_positions_counts() {
        for expected in [0, 1000, 100_000] {
            let mut welder = FacetWelder::with_capacity(expected).unwrap();
            let mut known = BTreeMap::new();
            let (mut corners, mut vertices) = (Vec::new(), Vec::new());
            for position in positions(90_000) {
                let next = known.len() as u32;
                let index = *known.entry(position.map(f64::to_bits)).or_insert(next);
                if index == next {
                    vertices.push(position);
                }
                corners.push((position, index));
            }
            let facets: Vec<[[f64; 3]; 3]> =
                corners.as_chunks::<3>().0.iter().map(|facet| facet.map(|(position, _)| position)).collect();
            // Batches of all lengths.
            let mut rest = &facets[..];
            for length in (1..20).cycle() {
                let (batch, more) = rest.split_at(length.min(rest.len()));
                welder.extend(batch).unwrap();
                rest = more;
                if rest.is_empty() {
                    break;
                }
            }
            let mesh = welder.finish();
            let triangles = corners.as_chunks::<3>().0.iter().map(|facet| facet.map(|(_, index)| index));
            let triangles: Vec<[u32; 3]> = triangles.filter(is_proper).collect();
            assert_eq!(mesh.vertices(), vertices);
            assert_eq!(mesh.triangles(), triangles);
            let given = facets.as_flattened().to_vec();
            let soup = (0..30_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let indexed = TriangleMesh::new(given, soup).unwrap();
            assert_eq!((indexed.vertices(), indexed.triangles()), (mesh.vertices(), mesh.triangles()));
        }
    }
}
