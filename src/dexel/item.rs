//! An interval with all its data.

use super::normal::{NO_NORMAL, flipped};
use super::place::Place;

/// The number that stands for an unknown surface.
pub(crate) const NO_SURFACE: u32 = u32::MAX;

/// The data of one end of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mark {
    /// The surface of the end.
    pub surface: u32,
    /// The outward normal at the end, as a code of 32 bits.
    pub normal: u32,
}

impl Mark {
    pub const NONE: Mark = Mark { surface: NO_SURFACE, normal: NO_NORMAL };

    /// The same surface seen from its other side.
    #[inline]
    pub fn flipped(self) -> Mark {
        Mark { surface: self.surface, normal: flipped(self.normal) }
    }
}

/// An interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Item<P> {
    pub ends: [P; 2],
    pub marks: [Mark; 2],
    pub material: u32,
}

impl<P: Place> Item<P> {
    /// An interval without further data.
    #[inline(always)]
    pub fn plain(ends: [P; 2]) -> Item<P> {
        Item { ends, marks: [Mark::NONE; 2], material: 0 }
    }
}
