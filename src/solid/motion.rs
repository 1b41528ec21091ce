//! What moving a solid does to it.

/// What an affine map does to a solid, from the best to the worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Motion {
    /// Nothing is rounded: half-spaces, and what is made of them.
    Exact = 0,
    /// The vertices of a mesh are moved and rounded, by some 10^-16 of their coordinates; what is proven
    /// allows for that.
    Vertices = 1,
    /// A surface that is not parallel to the lattice blurs by about a cell, as
    /// [`Transform`](crate::solid::Transform) does, and as a host's functions do, which are asked about boxes
    /// around inverse images. Where cells are the images of cells, nothing blurs.
    Conservative = 2,
}
