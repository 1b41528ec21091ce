//! Exact welding: which vertices lie at the same place.

use alloc::vec::Vec;
use core::hash::{BuildHasher, Hasher};

use hashbrown::DefaultHashBuilder;

use super::surface::TriangleMesh;
use crate::error::{Error, MeshError};
use crate::lattice::{LARGEST, SMALLEST};
use crate::memory;

/// Facets whose corners are looked up together.
const FACETS: usize = 8;
/// Vertices that are looked up together, so that their ways to memory overlap.
const BATCH: usize = 3 * FACETS;

/// Takes in a triangle soup some facets at a time, so that readers need not store it.
///
/// Besides the mesh it needs 10.7 to 21.4 bytes for each vertex of the mesh (32 for a moment when it grows), or
/// that for as many vertices as were expected.
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

    /// The mesh of all facets added.
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

/// No vertex has this index.
pub(super) const NOWHERE: u32 = u32::MAX;

/// A hash table of vertex indices by position, with open addressing. The positions stay in the caller's vector; a
/// slot is 8 bytes: an index and, lest every probe go to a position, 32 bits of the hash. The hash is seeded, and
/// no result depends on it.
pub(super) struct Places {
    /// The upper halves hold bits of hashes, of which the lowest is always 1: a slot of 0 is empty. At most three
    /// quarters are not. The number of slots is a power of two.
    slots: Vec<u64>,
    len: usize,
    hasher: DefaultHashBuilder,
}

/// What is known of a batch of positions at a first glance.
pub(super) struct Lookup {
    pub hashes: [u64; BATCH],
    /// Indices of those that were found; `NOWHERE` for those to be looked up with more patience.
    pub found: [u32; BATCH],
}

impl Places {
    /// How many positions may be looked up together.
    pub const BATCH: usize = BATCH;

    pub fn with_capacity(len: usize) -> Result<Self, Error> {
        let slots = len.checked_add(len / 3 + 1).and_then(usize::checked_next_power_of_two);
        let slots = empty_slots(slots.ok_or(Error::OutOfMemory)?.max(16))?;
        Ok(Self { slots, len: 0, hasher: DefaultHashBuilder::default() })
    }

    /// Looks at the first slot of each position, and at the positions to which these lead: one after the other, so
    /// that no access waits for another one. There may be up to `BATCH` positions.
    #[inline(always)]
    pub fn look_up(&self, positions: &[[f64; 3]], vertices: &[[f64; 3]]) -> Lookup {
        let (mut hashes, mut glances, mut found) = ([0; BATCH], [0; BATCH], [NOWHERE; BATCH]);
        for (hash, position) in hashes.iter_mut().zip(positions) {
            *hash = hash_of(&self.hasher, position);
        }
        for (glance, &hash) in glances.iter_mut().zip(&hashes).take(positions.len()) {
            *glance = self.slots[hash as usize & (self.slots.len() - 1)];
        }
        for (k, position) in positions.iter().enumerate() {
            // Comparing numbers is comparing bits here: there is neither -0.0 nor NaN.
            let index = glances[k] as u32;
            if tag(glances[k]) == tag_of(hashes[k]) && vertices[index as usize] == *position {
                found[k] = index;
            }
        }
        Lookup { hashes, found }
    }

    /// The index of a position. One that is not in the table yet gets the index `next`; the positions of all others
    /// must be in `vertices`.
    #[inline]
    pub fn find_or_insert(
        &mut self,
        hash: u64,
        position: &[f64; 3],
        next: u32,
        vertices: &[[f64; 3]],
    ) -> Result<u32, Error> {
        let mask = self.slots.len() - 1;
        let mut at = hash as usize & mask;
        while self.slots[at] != 0 {
            let index = self.slots[at] as u32;
            if tag(self.slots[at]) == tag_of(hash) && vertices[index as usize] == *position {
                return Ok(index);
            }
            at = (at + 1) & mask;
        }
        if self.len >= self.slots.len() / 4 * 3 {
            self.grow(vertices)?;
            at = self.free(hash);
        }
        self.slots[at] = slot(hash, next);
        self.len += 1;
        Ok(next)
    }

    /// The first free slot for a hash.
    fn free(&self, hash: u64) -> usize {
        let mask = self.slots.len() - 1;
        let mut at = hash as usize & mask;
        while self.slots[at] != 0 {
            at = (at + 1) & mask;
        }
        at
    }

    #[cold]
    fn grow(&mut self, vertices: &[[f64; 3]]) -> Result<(), Error> {
        let slots = empty_slots(self.slots.len().checked_mul(2).ok_or(Error::OutOfMemory)?)?;
        for old in core::mem::replace(&mut self.slots, slots) {
            if old != 0 {
                let hash = hash_of(&self.hasher, &vertices[old as u32 as usize]);
                let at = self.free(hash);
                self.slots[at] = slot(hash, old as u32);
            }
        }
        Ok(())
    }
}

fn empty_slots(count: usize) -> Result<Vec<u64>, Error> {
    let slots = memory::filled(count, 0)?;
    Ok(slots)
}

#[inline(always)]
fn tag_of(hash: u64) -> u32 {
    (hash >> 32) as u32 | 1
}

#[inline(always)]
fn slot(hash: u64, index: u32) -> u64 {
    u64::from(tag_of(hash)) << 32 | u64::from(index)
}

#[inline(always)]
fn tag(slot: u64) -> u32 {
    (slot >> 32) as u32
}

#[inline(always)]
fn hash_of(builder: &DefaultHashBuilder, position: &[f64; 3]) -> u64 {
    let mut hasher = builder.build_hasher();
    position.iter().for_each(|x| hasher.write_u64(x.to_bits()));
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

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::collections::BTreeMap;

    /// Positions that come again near by, far away, within one batch, and never.
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

    #[test]
    fn full_tables_grow() {
        let mut places = Places::with_capacity(0).unwrap();
        let vertices: Vec<[f64; 3]> = (0..10_000).map(|i| [f64::from(i), 0.0, 1.0]).collect();
        for (next, vertex) in (0..).zip(&vertices) {
            let hash = hash_of(&places.hasher, vertex);
            assert_eq!(places.find_or_insert(hash, vertex, next, &vertices).unwrap(), next);
            assert!(places.len * 4 <= places.slots.len() * 3 && places.len == next as usize + 1);
        }
        for (index, vertex) in (0..).zip(&vertices) {
            let hash = hash_of(&places.hasher, vertex);
            assert_eq!(places.find_or_insert(hash, vertex, NOWHERE, &vertices).unwrap(), index);
            let found = places.look_up(core::slice::from_ref(vertex), &vertices).found[0];
            assert!(found == index || found == NOWHERE);
        }
        // Nothing that is absent is found.
        let hash = hash_of(&places.hasher, &[0.5; 3]);
        assert_eq!(places.find_or_insert(hash, &[0.5; 3], 7777, &vertices).unwrap(), 7777);
    }
}
