//! What is known of places on a lattice.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// Items by their place: three integers from −2^20 to 2^20 − 1. A cache: when there are too many it forgets all of them.
pub struct Places<T> {
    indices: HashMap<u64, u32>,
    items: Vec<T>,
    last: (u64, u32),
}

/// Most items that are kept.
const MOST: usize = 1 << 14;

/// No place has this key.
const NOWHERE: u64 = u64::MAX;

fn key(place: [i32; 3]) -> u64 {
    let [x, y, z] = place.map(|i| u64::from(i.wrapping_add(1 << 20) as u32));
    x | y << 21 | z << 42
}

impl<T> Places<T> {
    pub fn new() -> Places<T> {
        Places { indices: HashMap::new(), items: Vec::new(), last: (NOWHERE, 0) }
    }

    /// Where an item is kept; good until the next call of [`Places::keep`].
    #[inline]
    pub fn find(&mut self, place: [i32; 3]) -> Option<usize> {
        let key = key(place);
        if self.last.0 != key {
            self.last = (key, *self.indices.get(&key)?);
        }
        Some(self.last.1 as usize)
    }

    /// Keeps what was not there, and says where.
    pub fn keep(&mut self, place: [i32; 3], item: T) -> Result<usize, Error> {
        if self.items.len() == MOST {
            self.indices.clear();
            self.items.clear();
        }
        let (key, index) = (key(place), self.items.len());
        self.indices.try_reserve(1)?;
        memory::push(&mut self.items, item)?;
        self.indices.insert(key, index as u32);
        self.last = (key, index as u32);
        Ok(index)
    }

    /// What [`Places::find`] or [`Places::keep`] said.
    #[inline]
    pub fn item(&self, index: usize) -> &T {
        &self.items[index]
    }
}
