//! The cells of the deepest level: 4³ to a brick, raw or through a dictionary.

use super::word::Planes;
use alloc::vec::Vec;
use bytemuck::Pod;

/// The stored form of a brick: one plane of a binary solid, or both planes.
pub(crate) trait Brick: Pod + Eq + Ord + core::hash::Hash + Send + Sync {
    fn planes(self) -> Planes;
    fn of(planes: Planes) -> Self;
}

impl Brick for u64 {
    #[inline(always)]
    fn planes(self) -> Planes {
        Planes::binary(self)
    }
    #[inline(always)]
    fn of(planes: Planes) -> u64 {
        planes.lower
    }
}

impl Brick for Planes {
    #[inline(always)]
    fn planes(self) -> Planes {
        self
    }
    #[inline(always)]
    fn of(planes: Planes) -> Planes {
        planes
    }
}

/// Bricks of one kind, in level order.
#[derive(Debug, Clone, Copy)]
pub(crate) enum BrickArray<'a, T> {
    /// One after another.
    Raw(&'a [T]),
    /// Brick b is `entries[segments[b >> shift] + indices[b]]`; a segment's entries end where the next
    /// segment's begin.
    Dictionary { indices: &'a [u16], entries: &'a [T], segments: &'a [u64], shift: u8 },
}

impl<T: Brick> BrickArray<'_, T> {
    pub(crate) fn len(&self) -> usize {
        match self {
            BrickArray::Raw(bricks) => bricks.len(),
            BrickArray::Dictionary { indices, .. } => indices.len(),
        }
    }

    /// Returns brick `b`; `None` beyond the end and where the dictionary is damaged.
    #[inline(always)]
    pub(crate) fn get(&self, b: usize) -> Option<T> {
        match *self {
            BrickArray::Raw(bricks) => bricks.get(b).copied(),
            BrickArray::Dictionary { indices, entries, segments, shift } => {
                let index = *indices.get(b)? as u64;
                let start = if segments.len() == 1 { segments[0] } else { *segments.get(b >> shift)? };
                entries.get(usize::try_from(start.checked_add(index)?).ok()?).copied()
            }
        }
    }

    /// Appends the bricks of `range`, changed by `map`, to `out`. Returns `false` if one of them is damaged.
    pub(crate) fn extend<U>(
        &self,
        range: core::ops::Range<usize>,
        out: &mut Vec<U>,
        map: impl Fn(T) -> U,
    ) -> bool {
        match *self {
            BrickArray::Raw(bricks) => match bricks.get(range) {
                Some(run) => out.extend(run.iter().map(|&brick| map(brick))),
                None => return false,
            },
            BrickArray::Dictionary { .. } => {
                for b in range {
                    match self.get(b) {
                        Some(brick) => out.push(map(brick)),
                        None => return false,
                    }
                }
            }
        }
        true
    }
}

/// The bricks of an octree.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Bricks<'a> {
    /// A binary solid: one plane.
    One(BrickArray<'a, u64>),
    /// A solid with undecided cells: two planes.
    Two(BrickArray<'a, Planes>),
}

impl Bricks<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Bricks::One(bricks) => bricks.len(),
            Bricks::Two(bricks) => bricks.len(),
        }
    }

    /// Returns brick `b`; `None` beyond the end and where the dictionary is damaged.
    #[inline(always)]
    pub(crate) fn get(&self, b: usize) -> Option<Planes> {
        match self {
            Bricks::One(bricks) => bricks.get(b).map(Brick::planes),
            Bricks::Two(bricks) => bricks.get(b),
        }
    }

    /// Returns the bytes of the bricks, including their dictionary.
    pub(crate) fn bytes(&self) -> usize {
        fn of<T>(bricks: &BrickArray<'_, T>) -> usize {
            match *bricks {
                BrickArray::Raw(bricks) => size_of_val(bricks),
                BrickArray::Dictionary { indices, entries, segments, .. } => {
                    size_of_val(indices) + size_of_val(entries) + size_of_val(segments)
                }
            }
        }
        match self {
            Bricks::One(bricks) => of(bricks),
            Bricks::Two(bricks) => of(bricks),
        }
    }

    /// True if bricks have one plane: no cell in the tree is undecided.
    pub(crate) fn one_plane(&self) -> bool {
        matches!(self, Bricks::One(_))
    }
}

/// Bricks that own their memory.
pub(crate) enum OwnedArray<T> {
    Raw(Vec<T>),
    Dictionary { indices: Vec<u16>, entries: Vec<T>, segments: Vec<u64>, shift: u8 },
}

impl<T: Brick> OwnedArray<T> {
    pub(crate) fn view(&self) -> BrickArray<'_, T> {
        match self {
            OwnedArray::Raw(bricks) => BrickArray::Raw(bricks),
            OwnedArray::Dictionary { indices, entries, segments, shift } => {
                BrickArray::Dictionary { indices, entries, segments, shift: *shift }
            }
        }
    }
}

pub(crate) enum OwnedBricks {
    One(OwnedArray<u64>),
    Two(OwnedArray<Planes>),
}

impl OwnedBricks {
    pub(crate) fn view(&self) -> Bricks<'_> {
        match self {
            OwnedBricks::One(bricks) => Bricks::One(bricks.view()),
            OwnedBricks::Two(bricks) => Bricks::Two(bricks.view()),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.view().len()
    }
}
