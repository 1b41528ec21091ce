//! The own coordinates of a layer. They begin at the frame's origin, so that a plane between two voxels has
//! the same coordinate for both.

use crate::lattice::Each;
use crate::lattice::{Cell, Frame, MAX_DEPTH};
use crate::render::camera::Camera;
use glam::DVec3;

/// The places of a layer's cells.
pub(super) struct Coordinates {
    /// The origin, in the model's coordinates.
    pub origin: DVec3,
    /// The edge of the cells of each level.
    pub edges: [f64; MAX_DEPTH as usize + 2],
}

impl Coordinates {
    pub fn new(frame: &Frame) -> Coordinates {
        let edges = core::array::from_fn(|level| frame.edge() / (1u64 << level) as f64);
        Coordinates { origin: DVec3::from(frame.origin()), edges }
    }

    /// The centre of a cell, and half its edge.
    #[inline(always)]
    pub fn cube(&self, cell: Cell) -> (DVec3, f64) {
        let half = 0.5 * self.edges[cell.level as usize];
        (DVec3::from(cell.at.each(|a| (2 * a + 1) as f64 * half)), half)
    }

    /// The least and the greatest corner of a cell. Cells that touch have the same numbers where they do.
    #[inline(always)]
    pub fn corners(&self, cell: Cell) -> [DVec3; 2] {
        let edge = self.edges[cell.level as usize];
        [0, 1].each(|end| DVec3::from(cell.at.each(|a| f64::from(a + end) * edge)))
    }

    /// The place of the camera.
    pub fn place(&self, camera: &Camera) -> Place {
        Place {
            eye: DVec3::from(camera.eye()) - self.origin,
            right: DVec3::from(camera.right()),
            up: DVec3::from(camera.up()),
            forward: DVec3::from(camera.forward()),
        }
    }
}

/// The camera in a layer's own coordinates.
pub(super) struct Place {
    pub eye: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub forward: DVec3,
}
