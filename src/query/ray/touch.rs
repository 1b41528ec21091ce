//! The first cells along rays for pictures, which need no bounds of the time at which they are met.

use super::march::March;
use super::octree::{Question, cast_all};
use super::{Obstacle, Ray};
use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::view::OctreeRef;

/// Where a ray first meets a cell that is not EMPTY.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Touch {
    /// When, but for rounding.
    pub(crate) t: f64,
    pub(crate) cell: Cell,
    /// The outward normal of the face by which the ray enters the cell. Zero if the ray starts in the cell.
    pub(crate) normal: [f64; 3],
}

impl OctreeRef<'_> {
    /// The first cells that are not EMPTY along rays, those of [`cast_rays`](Self::cast_rays); `touches[i]` for `rays[i]`.
    pub(crate) fn touch(&self, rays: &[Ray], touches: &mut [Option<Touch>]) -> Result<(), Error> {
        cast_all(self, rays, FirstCell, touches)
    }
}

#[derive(Clone, Copy)]
struct FirstCell;

impl Question for FirstCell {
    type Answer = Touch;
    const TO_FULL: bool = false;

    #[inline(always)]
    fn answer(self, march: &March, _: &OctreeRef<'_>, ray: &Ray) -> Option<Touch> {
        let ((cell, by), t) = march.outer?;
        let mut normal = [0.0; 3];
        if let Some((axis, _)) = by {
            normal[axis] = if ray.direction[axis][0] > 0.0 { -1.0 } else { 1.0 };
        }
        Some(Touch { t, cell, normal })
    }

    fn exactly(self, tree: &OctreeRef<'_>, ray: &Ray) -> Option<Touch> {
        let hit = Obstacle::Upper.exactly(tree, ray)?;
        Some(Touch { t: hit.t.lower.max(0.0), cell: hit.cell, normal: hit.normal })
    }
}
