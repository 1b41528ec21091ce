//! Moving solids: one way for all kinds.

use super::{AnySolid, Transform};
use crate::error::Error;
use crate::lattice::Affine;

/// What an affine map does to a solid, from the best to the worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Motion {
    /// Nothing is rounded: half-spaces, and what is made of them.
    Exact = 0,
    /// The vertices of a mesh are moved and rounded, by some 10^-16 of their coordinates; what is proven allows for that.
    Vertices = 1,
    /// As [`Transform`] does: a surface that is not parallel to the lattice blurs by about a cell. (Where cells are the
    /// images of cells, nothing blurs.)
    Conservative = 2,
}

impl AnySolid {
    /// The solid under an affine map, moved in the best way that its kind knows; [`motion`](super::Solid::motion) says which
    /// that is.
    ///
    /// # Errors
    /// As [`TriangleMesh::placed`](crate::TriangleMesh::placed) for meshes; [`Error::OutOfMemory`].
    ///
    /// ```
    /// use leafless::{Affine, AnySolid, Csg, Frame, Motion, Octree, Rule, Control, Solid, build};
    /// let turned = Affine::new([[0.8, -0.6, 0.0, 3.0], [0.6, 0.8, 0.0, 2.0], [0.0, 0.0, 1.0, 2.0]])?;
    /// let ball = AnySolid::new(Csg::ball([0.0; 3], 1.0)?);
    /// assert_eq!(ball.motion(), Motion::Exact);
    /// let stored = build(&ball, &Frame::new([-2.0; 3], 4.0, 6)?, Rule::Certified, &Control::default())?;
    /// let moved = AnySolid::new(stored).placed(&turned)?;
    /// assert_eq!(moved.motion(), Motion::Conservative);
    /// let tree = build(&moved, &Frame::new([0.0; 3], 8.0, 6)?, Rule::Certified, &Control::default())?;
    /// assert!(tree.statistics().volume().contains(4.0 / 3.0 * core::f64::consts::PI));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn placed(&self, placement: &Affine) -> Result<AnySolid, Error> {
        if placement.is_identity() {
            return Ok(self.clone());
        }
        match self.placed_by_kind(placement)? {
            Some(placed) => Ok(placed),
            None => Ok(AnySolid::new(Transform::of(self.clone(), placement))),
        }
    }
}
