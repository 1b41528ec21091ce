//! Exact welding: which vertices lie at the same place.

use alloc::vec::Vec;
use core::hash::{BuildHasher, Hasher};

use hashbrown::{DefaultHashBuilder, HashTable};

use super::surface::TriangleMesh;
use crate::error::{Error, MeshError};
use crate::lattice::{LARGEST, SMALLEST};

/// Takes in a triangle soup one facet at a time, so that readers need not store it.
pub(crate) struct FacetWelder {
    places: Places,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    facets: u64,
}

impl FacetWelder {
    /// A welder with room for about `facets` facets; `facets` must be backed by data that exists.
    pub fn with_capacity(facets: usize) -> Result<Self, Error> {
        // A closed mesh has about half as many vertices as triangles; a soup that welds worse makes it grow.
        let vertices = facets / 2 + facets / 16;
        let mut welder = Self {
            places: Places::with_capacity(vertices)?,
            vertices: Vec::new(),
            triangles: Vec::new(),
            facets: 0,
        };
        welder.vertices.try_reserve_exact(vertices).map_err(|_| Error::OutOfMemory)?;
        welder.triangles.try_reserve_exact(facets).map_err(|_| Error::OutOfMemory)?;
        Ok(welder)
    }

    /// Adds a facet. Fails as [`TriangleMesh::from_facets`] does.
    #[inline]
    pub fn push(&mut self, facet: &[[f64; 3]; 3]) -> Result<(), Error> {
        let mut triangle = [0; 3];
        for ((index, &corner), k) in triangle.iter_mut().zip(facet).zip(0..) {
            *index = self.weld(normalised(corner, self.facets * 3 + k)?)?;
        }
        self.facets += 1;
        if is_proper(&triangle) {
            if u32::try_from(self.triangles.len()).map_or(true, |count| count == u32::MAX) {
                return Err(MeshError::TooMany.into());
            }
            self.triangles.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
            self.triangles.push(triangle);
        }
        Ok(())
    }

    /// The mesh of all facets added.
    pub fn finish(self) -> TriangleMesh {
        let welded = self.facets * 3 - self.vertices.len() as u64;
        let degenerate = self.facets - self.triangles.len() as u64;
        let (vertices, triangles) = (self.vertices, self.triangles);
        TriangleMesh::from_welded(vertices, triangles, welded, degenerate)
    }

    #[inline]
    fn weld(&mut self, vertex: [f64; 3]) -> Result<u32, Error> {
        let hash = self.places.hash(&vertex);
        if let Some(index) = self.places.find(hash, &vertex, &self.vertices) {
            return Ok(index);
        }
        let index = u32::try_from(self.vertices.len()).map_err(|_| MeshError::TooMany)?;
        if index == u32::MAX {
            return Err(MeshError::TooMany.into());
        }
        self.vertices.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
        self.places.insert(hash, index, &self.vertices)?;
        self.vertices.push(vertex);
        Ok(index)
    }
}

/// A hash table of vertex indices by position. The positions stay in the caller's vector, so a slot is 4 bytes;
/// the hash is seeded, and no result depends on it.
pub(super) struct Places {
    table: HashTable<u32>,
    hasher: DefaultHashBuilder,
}

impl Places {
    pub fn with_capacity(len: usize) -> Result<Self, Error> {
        let mut table = HashTable::new();
        table.try_reserve(len, |_| 0).map_err(|_| Error::OutOfMemory)?;
        Ok(Self { table, hasher: DefaultHashBuilder::default() })
    }

    #[inline]
    pub fn hash(&self, vertex: &[f64; 3]) -> u64 {
        hash(&self.hasher, vertex)
    }

    #[inline]
    pub fn find(&self, hash: u64, vertex: &[f64; 3], vertices: &[[f64; 3]]) -> Option<u32> {
        // Comparing numbers is comparing bits here: there is neither -0.0 nor NaN.
        self.table.find(hash, |&i| vertices[i as usize] == *vertex).copied()
    }

    /// Adds an index whose position is not in the table yet; those of all others must be in `vertices`.
    #[inline]
    pub fn insert(&mut self, hash_of_index: u64, index: u32, vertices: &[[f64; 3]]) -> Result<(), Error> {
        let Self { table, hasher } = self;
        let rehash = |&i: &u32| hash(hasher, &vertices[i as usize]);
        table.try_reserve(1, rehash).map_err(|_| Error::OutOfMemory)?;
        table.insert_unique(hash_of_index, index, rehash);
        Ok(())
    }
}

#[inline]
fn hash(builder: &DefaultHashBuilder, vertex: &[f64; 3]) -> u64 {
    let mut hasher = builder.build_hasher();
    vertex.iter().for_each(|x| hasher.write_u64(x.to_bits()));
    hasher.finish()
}

/// The vertex with -0.0 turned into 0.0, or why it is refused.
#[inline]
pub(super) fn normalised(vertex: [f64; 3], index: u64) -> Result<[f64; 3], MeshError> {
    // False for NaN as well.
    if vertex.iter().all(|x| x.abs() <= LARGEST) {
        // Products of three coordinates must not underflow, because signs of determinants are exact. (This
        // also turns -0.0 into 0.0.)
        Ok(vertex.map(|x| if x.abs() < SMALLEST { 0.0 } else { x }))
    } else if vertex.iter().all(|x| x.is_finite()) {
        Err(MeshError::TooLarge { vertex: index })
    } else {
        Err(MeshError::NotFinite { vertex: index })
    }
}

#[inline]
pub(super) fn is_proper(&[a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}
