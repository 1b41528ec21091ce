//! A cache of results for places on a lattice.

use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// Items by their place. When the cache is full, all items are dropped.
pub struct Places<T> {
    indices: HashMap<Place, u32>,
    items: Vec<T>,
    /// The place that was last looked up, and its item.
    last: Option<(Place, u32)>,
}

/// A place on a lattice.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place(u64);

/// The greatest number of items that are kept.
const MOST: usize = 1 << 14;

impl From<[i32; 3]> for Place {
    /// Three integers from −2^20 to 2^20 − 1.
    #[inline]
    fn from(at: [i32; 3]) -> Place {
        let [x, y, z] = at.each(|i| u64::from(i.wrapping_add(1 << 20) as u32));
        Place(x | y << 21 | z << 42)
    }
}

impl From<Cell> for Place {
    /// A cell of any level; the first set bit of each coordinate encodes the level.
    #[inline]
    fn from(cell: Cell) -> Place {
        let [x, y, z] = cell.at.each(|i| u64::from(i + (1 << cell.level)));
        Place(x | y << 21 | z << 42)
    }
}

impl<T> Places<T> {
    pub fn new() -> Places<T> {
        Places { indices: HashMap::new(), items: Vec::new(), last: None }
    }

    /// The index of an item; valid until the next call of [`Places::keep`].
    #[inline]
    pub fn find(&mut self, place: impl Into<Place>) -> Option<usize> {
        let place = place.into();
        if self.last.is_none_or(|last| last.0 != place) {
            self.last = Some((place, *self.indices.get(&place)?));
        }
        self.last.map(|(_, index)| index as usize)
    }

    /// Stores a new item, and returns its index.
    pub fn keep(&mut self, place: impl Into<Place>, item: T) -> Result<usize, Error> {
        if self.items.len() == MOST {
            self.indices.clear();
            self.items.clear();
        }
        let (place, index) = (place.into(), self.items.len());
        self.indices.try_reserve(1)?;
        memory::push(&mut self.items, item)?;
        self.indices.insert(place, index as u32);
        self.last = Some((place, index as u32));
        Ok(index)
    }

    /// The item at an index that [`Places::find`] or [`Places::keep`] returned.
    #[inline]
    pub fn item(&self, index: usize) -> &T {
        &self.items[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_is_found_until_all_is_forgotten() {
        let mut places = Places::new();
        let at = |i: i32| [i % 100 - 50, -i / 100, (1 << 20) - 1 - i];
        for i in 0..MOST as i32 {
            assert_eq!(places.find(at(i)), None);
            let kept = places.keep(at(i), i).unwrap();
            assert_eq!(places.find(at(i)), Some(kept));
        }
        for i in 0..MOST as i32 {
            let found = places.find(at(i)).unwrap();
            assert_eq!(*places.item(found), i);
        }
        let next = places.keep([7; 3], -1).unwrap();
        assert_eq!((places.find([7; 3]), places.find(at(5)), *places.item(next)), (Some(next), None, -1));
    }

    #[test]
    fn cells_of_all_levels_differ() {
        let mut places = Places::new();
        for level in 0..=20 {
            for at in [[0; 3], [(1 << level) - 1; 3], [0, (1 << level) - 1, 0]] {
                let cell = Cell { level, at };
                match places.find(cell) {
                    Some(found) => assert_eq!(*places.item(found), cell),
                    None => _ = places.keep(cell, cell).unwrap(),
                }
            }
        }
    }
}
