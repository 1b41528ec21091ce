//! Ways from the root to an element.

use super::tag::Tag;
use super::view::MAX_ELEMENT_LEVELS;
use super::word::Planes;

/// The elements from the root down, with their indices.
pub(super) type Path = [(usize, Planes); MAX_ELEMENT_LEVELS];

/// A path that leads nowhere yet.
pub(super) const NOWHERE: Path = [(usize::MAX, Planes::uniform(Tag::Partial)); MAX_ELEMENT_LEVELS];

/// An element, and where it lies.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Its element level.
    pub level: usize,
    /// Its index.
    pub index: usize,
    /// Its own cell's position, on that cell's level.
    pub at: [u32; 3],
}
