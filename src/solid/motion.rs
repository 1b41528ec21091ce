//! The precision of solids under affine maps.

/// The precision of a solid under an affine map, from the best to the worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Motion {
    /// Nothing is rounded: half-spaces, and expressions of them.
    Exact = 0,
    /// The vertices of a mesh are moved and rounded, by some 10^-16 of their coordinates. Proofs allow for
    /// that.
    Vertices = 1,
    /// A surface that is not parallel to the lattice blurs by about a cell. This is the precision of
    /// [`Transform`](crate::solid::Transform), and of a host's functions, which are called with boxes around
    /// inverse images. Where cells are the images of cells, nothing blurs.
    Conservative = 2,
}
