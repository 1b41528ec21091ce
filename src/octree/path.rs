//! Paths from the root to an element.

use super::tag::Tag;
use super::view::MAX_ELEMENT_LEVELS;
use super::word::Planes;

/// The elements from the root down, with their indices.
pub(super) type Path = [(usize, Planes); MAX_ELEMENT_LEVELS];

/// A path that leads nowhere yet.
pub(super) const NOWHERE: Path = [(usize::MAX, Planes::uniform(Tag::Partial)); MAX_ELEMENT_LEVELS];

/// An element, and its position.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Element level.
    pub level: usize,
    /// Index of the element.
    pub index: usize,
    /// Position of its own cell, on that cell's level.
    pub at: [u32; 3],
}
