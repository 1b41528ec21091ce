//! A hash table of positions, which finds vertices at exactly the same place.

use crate::lattice::Each;
use alloc::vec::Vec;
use core::hash::{BuildHasher, Hasher};

use hashbrown::DefaultHashBuilder;

use crate::error::{Error, MeshError};
use crate::lattice::{LARGEST, SMALLEST};
use crate::memory;

/// Number of positions that are looked up together, so that their memory accesses overlap: the corners of
/// eight facets.
const BATCH: usize = 24;

/// An index that no vertex has.
pub(super) const NOWHERE: u32 = u32::MAX;

/// A hash table of vertex indices by position, with open addressing. The positions stay in the caller's
/// vector. A slot is 8 bytes: an index, and 32 bits of the hash, so that not every probe has to load a
/// position. The hash is seeded, and no result depends on it.
pub(super) struct Places {
    /// The upper halves hold bits of hashes, of which the lowest is always 1; a slot of 0 is empty. At most
    /// three quarters of the slots are used. The number of slots is a power of two.
    slots: Vec<u64>,
    len: usize,
    hasher: DefaultHashBuilder,
}

/// The result of a first look-up of a batch of positions.
pub(super) struct Lookup {
    pub hashes: [u64; BATCH],
    /// Indices of the positions that were found; `NOWHERE` for positions that need a full look-up.
    pub found: [u32; BATCH],
}

impl Places {
    /// Maximum number of positions that may be looked up together.
    pub const BATCH: usize = BATCH;

    pub fn with_capacity(len: usize) -> Result<Self, Error> {
        let slots = len.checked_add(len / 3 + 1).and_then(usize::checked_next_power_of_two);
        let slots = memory::filled(slots.ok_or(Error::OutOfMemory)?.max(16), 0)?;
        Ok(Self { slots, len: 0, hasher: DefaultHashBuilder::default() })
    }

    /// Loads the first slot of each position, and then the positions to which the slots lead, so that no
    /// access waits for another. There may be up to `BATCH` positions.
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

    /// Returns the index of a position. A position that is not in the table gets the index `next`; all others
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

    /// Returns the first free slot for a hash.
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
        let slots = memory::filled(self.slots.len().checked_mul(2).ok_or(Error::OutOfMemory)?, 0)?;
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

/// Returns the vertex with -0.0 turned into 0.0, or the reason why the vertex is refused.
#[inline]
pub(super) fn normalised(vertex: [f64; 3], index: u64) -> Result<[f64; 3], MeshError> {
    // False for NaN as well.
    if vertex.iter().all(|x| x.abs() <= LARGEST) {
        // Products of three coordinates must not underflow, because signs of determinants are exact. (This
        // also turns -0.0 into 0.0.)
        Ok(vertex.each(|x| if x.abs() < SMALLEST { 0.0 } else { x }))
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
        // A position that is absent is not found.
        let hash = hash_of(&places.hasher, &[0.5; 3]);
        assert_eq!(places.find_or_insert(hash, &[0.5; 3], 7777, &vertices).unwrap(), 7777);
    }
}
