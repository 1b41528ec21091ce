//! The priority queue of a best-first search.

use crate::error::Error;
use alloc::collections::BinaryHeap;
use core::cmp::Ordering;

/// A priority queue: the greatest key comes first. The result of a search depends on its order, so no two
/// keys may be equal: [`met`](Self::met) makes them differ.
pub(crate) struct Queue<K, T> {
    heap: BinaryHeap<Entry<K, T>>,
    met: u64,
}

/// An item with its key.
pub(crate) struct Entry<K, T> {
    pub(crate) key: K,
    pub(crate) item: T,
}

impl<K: Ord, T> Queue<K, T> {
    /// An empty queue.
    pub(crate) fn new() -> Self {
        Queue { heap: BinaryHeap::new(), met: 0 }
    }

    /// The number of items added so far.
    pub(crate) fn met(&self) -> u64 {
        self.met
    }

    /// Adds an item. O(log n).
    pub(crate) fn push(&mut self, key: K, item: T) -> Result<(), Error> {
        self.heap.try_reserve(1)?;
        self.heap.push(Entry { key, item });
        self.met += 1;
        Ok(())
    }

    /// The first item.
    pub(crate) fn peek(&self) -> Option<&Entry<K, T>> {
        self.heap.peek()
    }

    /// Removes the first item. O(log n).
    pub(crate) fn pop(&mut self) -> Option<T> {
        self.heap.pop().map(|entry| entry.item)
    }

    /// All items, in no particular order.
    pub(crate) fn into_items(self) -> impl Iterator<Item = T> {
        self.heap.into_iter().map(|entry| entry.item)
    }

    /// Changes the contents of the queue, keys and items. O(n).
    pub(crate) fn change<R>(&mut self, change: impl FnOnce(&mut [Entry<K, T>]) -> R) -> R {
        let mut entries = core::mem::take(&mut self.heap).into_vec();
        let result = change(&mut entries);
        self.heap = entries.into();
        result
    }
}

impl<K: Ord, T> Ord for Entry<K, T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key.cmp(&other.key)
    }
}

impl<K: Ord, T> PartialOrd for Entry<K, T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<K: Ord, T> PartialEq for Entry<K, T> {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl<K: Ord, T> Eq for Entry<K, T> {}
