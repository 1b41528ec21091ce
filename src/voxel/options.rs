//! The choice of the voxels of an octree that are listed.

use crate::attribute::Detail;
use crate::error::Error;
use crate::lattice::{Frame, MAX_DEPTH};
use crate::octree::OctreeRef;

/// The choice of boundary voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum VoxelBoundary {
    /// Cells of the boundary depth that are cut further there, and undecided cells: the surface may pass
    /// through them. A surface that lies in a plane of the lattice passes through no cell, and a binary
    /// octree has no other surface.
    #[default]
    Undecided,
    /// In addition, inside cells of the boundary depth that touch an outside cell with a face. An inside cell
    /// that touches one is split down to the boundary depth. Faces of the universe count if the solid is
    /// known to end in it.
    Touching,
}

/// The choice of the voxels of an octree that are listed, and their size.
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build, attribute::Detail, voxel::{VoxelOptions, VoxelRecords}};
/// let frame = Frame::new([-1.0; 3], 2.0, 6)?;
/// let control = Control::default();
/// let ball = build(&Csg::ball([0.0; 3], 0.9)?, &frame, Rule::Certified, &control)?;
/// // Inside cells no longer than 1/8, boundary cells of level 6.
/// let options = VoxelOptions::new().detail(Detail::uniform(0.125)?);
/// let records = VoxelRecords::of(ball.view(), &options, None, &control)?;
/// assert!(records.view().iter().all(|record| record.cell.level >= 4));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VoxelOptions {
    boundary_depth: Option<u8>,
    boundary: VoxelBoundary,
    outside: bool,
    refined: bool,
    detail: Option<Detail>,
}

impl VoxelOptions {
    /// Makes the default options: inside and boundary voxels, as large as the octree's cells.
    pub fn new() -> VoxelOptions {
        VoxelOptions::default()
    }

    /// Sets the level of boundary voxels: cells that are cut there are not examined further. The default is
    /// the octree's depth, which is also the limit.
    #[must_use]
    pub fn boundary_depth(self, depth: u8) -> VoxelOptions {
        VoxelOptions { boundary_depth: Some(depth), ..self }
    }

    /// Sets the choice of boundary voxels.
    #[must_use]
    pub fn boundary(self, boundary: VoxelBoundary) -> VoxelOptions {
        VoxelOptions { boundary, ..self }
    }

    /// Sets whether outside voxels are listed, as large as possible.
    #[must_use]
    pub fn outside(self, outside: bool) -> VoxelOptions {
        VoxelOptions { outside, ..self }
    }

    /// Sets whether refined voxels are listed before the smaller voxels that they consist of.
    #[must_use]
    pub fn refined(self, refined: bool) -> VoxelOptions {
        VoxelOptions { refined, ..self }
    }

    /// Sets the detail of inside voxels: they are split until they are [fine](Detail::is_fine) for the
    /// attribute. Voxels next to the boundary may be smaller. Boundary voxels are not split for the
    /// attribute.
    #[must_use]
    pub fn detail(self, detail: Detail) -> VoxelOptions {
        VoxelOptions { detail: Some(detail), ..self }
    }

    pub(super) fn lists_outside(&self) -> bool {
        self.outside
    }

    pub(super) fn lists_refined(&self) -> bool {
        self.refined
    }

    pub(super) fn touching(&self) -> bool {
        self.boundary == VoxelBoundary::Touching
    }

    pub(super) fn how_fine(&self) -> Option<&Detail> {
        self.detail.as_ref()
    }

    /// The level of boundary voxels.
    pub(super) fn boundary_level(&self, tree: &OctreeRef<'_>) -> u8 {
        self.boundary_depth.unwrap_or(MAX_DEPTH).min(tree.frame().depth())
    }

    /// The lattice of the records: the octree's universe, as deep as the finest voxel may be.
    ///
    /// # Errors
    /// [`Error::Argument`] if the detail's fine limit is below the edge of a cell of level 20.
    pub fn frame(&self, tree: &OctreeRef<'_>) -> Result<Frame, Error> {
        let mut depth = self.boundary_level(tree);
        if let Some(detail) = &self.detail {
            let fine = |&level: &u8| super::record::edge(tree.frame(), level) <= detail.fine();
            let problem = "the universe would take more than 20 levels to the fine limit";
            let needed = (0..=MAX_DEPTH).find(fine).ok_or(Error::Argument { name: "fine", problem })?;
            depth = depth.max(needed);
        }
        tree.frame().with_depth(depth.max(1))
    }
}
