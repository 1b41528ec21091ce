//! Operations for solids of all kinds: wrapping and moving. This file therefore depends on all kinds.

use super::{Adaptive, AnySolid, Csg, MeshSolid, Solid, SplitCounter, Transform};
use crate::error::Error;
use crate::lattice::Affine;
use crate::mesh::TriangleMesh;
use core::any::Any;

impl AnySolid {
    /// Wraps a solid.
    pub fn new<S: Solid + 'static>(solid: S) -> AnySolid {
        let nesting = nesting_in(&solid);
        AnySolid::around(solid, nesting)
    }

    /// The solid under an affine map, moved in the best way that its kind offers;
    /// [`motion`](super::Solid::motion) returns that way.
    ///
    /// # Errors
    /// As [`TriangleMesh::placed`](crate::TriangleMesh::placed) for meshes; [`Error::OutOfMemory`].
    ///
    /// ```
    /// use leafless::{Affine, AnySolid, Csg, Frame, Octree, Rule, Control, Solid, build, solid::Motion};
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

    /// The mesh of a solid that is enclosed by a mesh.
    pub(super) fn mesh_by_kind(&self) -> Option<&TriangleMesh> {
        self.get::<MeshSolid>().map(|solid| &**solid.mesh())
    }
}

/// The number of `AnySolid`s within each other in a solid that may hold some.
fn nesting_in(solid: &dyn Any) -> u32 {
    fn of<S: Any>(solid: &dyn Any, nesting: impl Fn(&S) -> u32) -> Option<u32> {
        solid.downcast_ref().map(nesting)
    }
    None.or_else(|| of(solid, Csg::nesting))
        .or_else(|| of(solid, AnySolid::nesting))
        .or_else(|| of(solid, |moved: &Transform<AnySolid>| moved.solid().nesting()))
        .or_else(|| of(solid, |moved: &Transform<Csg>| moved.solid().nesting()))
        .or_else(|| of(solid, |counted: &SplitCounter<AnySolid>| counted.solid().nesting()))
        .or_else(|| of(solid, |counted: &SplitCounter<Csg>| counted.solid().nesting()))
        .or_else(|| of(solid, |adaptive: &Adaptive<AnySolid>| adaptive.solid().nesting()))
        .or_else(|| of(solid, |adaptive: &Adaptive<Csg>| adaptive.solid().nesting()))
        .or_else(|| nesting_in_prepared(solid))
        .unwrap_or(0)
}

fn nesting_in_prepared(solid: &dyn Any) -> Option<u32> {
    #[cfg(feature = "std")]
    return solid.downcast_ref().map(|prepared: &super::Prepared| prepared.solid().nesting());
    #[cfg(not(feature = "std"))]
    None::<u32>.filter(|_| solid.is::<()>())
}
