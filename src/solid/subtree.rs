//! Stored cells that are copied unchanged.

use crate::octree::OctreeRef;

/// Stored cells that a writer of octrees can copy unchanged, or complemented.
#[derive(Debug, Clone, Copy)]
pub struct Subtree<'a> {
    pub(crate) tree: &'a OctreeRef<'a>,
    /// Element level and index of the element that describes the cell.
    pub(crate) level: usize,
    pub(crate) index: usize,
    pub(crate) flip: bool,
}

impl Subtree<'_> {
    /// The complement of the cells.
    #[must_use]
    pub fn complement(self) -> Self {
        Subtree { flip: !self.flip, ..self }
    }
}
