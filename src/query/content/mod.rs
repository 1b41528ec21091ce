//! The common volume and the common cells of a solid and a region.

mod below;
mod in_box;
mod once;
mod sums;
mod walk;

use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Frame, Interval};
use crate::octree::{Octree, OctreeRef};
use crate::solid::{Classifier, DynSolid};
use crate::walk::Proven;
use once::Once;
use sums::Sums;
use walk::{Counted, walk};

/// Bounds of the number of a solid's finest cells in a region.
///
/// A cell lies in the region if the region is FULL there, and does not if the region is EMPTY there. If the
/// region is PARTIAL, the cell may lie in the region. The bounds therefore hold for each meaning of "in":
/// cells that lie in the region as a whole, cells whose centre does, and cells with any volume in common with
/// it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct CellsIn {
    /// FULL cells of the solid that are proven to lie in the region.
    pub full_least: u64,
    /// FULL cells of the solid that may lie in the region.
    pub full_most: u64,
    /// FULL and PARTIAL cells of the solid that are proven to lie in the region.
    pub upper_least: u64,
    /// FULL and PARTIAL cells of the solid that may lie in the region.
    pub upper_most: u64,
}

/// Returns the number of finest cells of `frame` that lie in both a solid and a region. The region is a ball
/// ([`Csg::ball`](crate::Csg::ball)) or any other solid. Unproven verdicts of either count as PARTIAL. The
/// outside of the universe does not count.
///
/// No octree is made. A cell is split only where neither is EMPTY and one is undecided. The time is therefore
/// about that of splitting the region's boundary inside of the solid and the solid's boundary inside of the
/// region, down to the frame's depth. The memory is O(depth). Once `control.max_splits` cells of both are
/// split, the other cells count as undecided. It uses one thread.
///
/// # Errors
/// The own errors of the solid and of the region; [`Error::OutOfMemory`] and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::cells_in};
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 3)?, Control::default());
/// let slab = Csg::cuboid([0.0; 3], [8.0, 8.0, 2.0])?;
/// let found = cells_in(&slab, &Csg::cuboid([1.0; 3], [4.0, 3.0, 7.0])?, &frame, &control)?;
/// assert_eq!((found.full_least, found.full_most), (6, 6));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn cells_in(
    solid: &dyn DynSolid,
    region: &dyn DynSolid,
    frame: &Frame,
    control: &Control<'_>,
) -> Result<CellsIn, Error> {
    Ok(content(solid, region, frame, Sums::of_cells(), control)?.cells())
}

/// Returns the volume that a solid and a region have in common inside of the universe of `frame`, in cubic
/// model units: an interval that contains the true volume. The region is a ball
/// ([`Csg::ball`](crate::Csg::ball)) or any other solid.
///
/// Cells are split as in [`cells_in`]. In a cell of the finest level the volume is as exact as the moments or
/// enclosures that solid and region provide there. Where they provide nothing, the volume lies between zero
/// and the cell's volume. (To split until the volume is known to a tolerance, [`measure`](crate::measure) the
/// intersection.)
///
/// # Errors
/// As [`cells_in`].
pub fn volume_in(
    solid: &dyn DynSolid,
    region: &dyn DynSolid,
    frame: &Frame,
    control: &Control<'_>,
) -> Result<Interval, Error> {
    Ok(content(solid, region, frame, Sums::of_volume(), control)?.volume(frame))
}

fn content(
    solid: &dyn DynSolid,
    region: &dyn DynSolid,
    frame: &Frame,
    sums: Sums,
    control: &Control<'_>,
) -> Result<Sums, Error> {
    let job = Job::new(control);
    job.check()?;
    let solid = Proven(solid.on(frame, control)?).worker()?;
    in_region(solid, region, frame, sums, &job)
}

fn in_region<S: Counted>(
    solid: S,
    region: &dyn DynSolid,
    frame: &Frame,
    sums: Sums,
    job: &Job<'_>,
) -> Result<Sums, Error> {
    let region = Proven(region.on(frame, job.control())?).worker()?;
    walk(solid, region, frame.depth(), sums, job)
}

impl OctreeRef<'_> {
    /// Returns the number of finest cells of the octree in a region: bounds for the FULL cells, and bounds
    /// for the FULL and PARTIAL cells. The region is a ball ([`Csg::ball`](crate::Csg::ball)) or any other
    /// solid. The octree's cells are taken as they are, whatever they prove. Unproven verdicts of the region
    /// count as PARTIAL.
    ///
    /// Where the region is FULL, whole subtrees are counted, 64 cells at a time. Where it is EMPTY, nothing
    /// is read. Where it is undecided and the octree is not EMPTY, it is split, down to the octree's depth.
    /// The memory is O(depth). Once `control.max_splits` cells of both are split, the other cells count as
    /// undecided. It uses one thread. Whatever the bytes, no element is read twice, and damage reads as
    /// PARTIAL.
    ///
    /// # Errors
    /// The region's own errors; [`Error::OutOfMemory`] and [`Error::Cancelled`].
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build};
    /// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 6)?, Control::default());
    /// let block = build(&Csg::cuboid([-0.75; 3], [0.75; 3])?, &frame, Rule::Certified, &control)?;
    /// let found = block.cells_in(&Csg::ball([0.75, 0.0, 0.0], 0.5)?, &control)?;
    /// // Half a ball, in cells of 1/32.
    /// let half = 2.0 / 3.0 * std::f64::consts::PI * 16.0f64.powi(3);
    /// assert!(found.full_least as f64 <= half && half <= found.full_most as f64);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn cells_in(&self, region: &dyn DynSolid, control: &Control<'_>) -> Result<CellsIn, Error> {
        Ok(self.content_in(region, Sums::of_cells(), control)?.cells())
    }

    /// Returns the volume that the solid and a region have in common, in cubic model units, as the octree's
    /// cells determine it: FULL cells bound it from below, FULL and PARTIAL cells from above. The region is a
    /// ball ([`Csg::ball`](crate::Csg::ball)) or any other solid. The outside of the universe does not count.
    ///
    /// In a finest cell that the region cuts, the region's volume is as exact as the region provides it: for
    /// a ball to the third order. Time, memory and the treatment of hostile bytes are as for
    /// [`cells_in`](OctreeRef::cells_in), with one or two microseconds more for each cut cell.
    ///
    /// # Errors
    /// As [`cells_in`](OctreeRef::cells_in).
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build};
    /// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 6)?, Control::default());
    /// let block = build(&Csg::cuboid([-0.75; 3], [0.75; 3])?, &frame, Rule::Certified, &control)?;
    /// let found = block.volume_in(&Csg::ball([0.75, 0.0, 0.0], 0.5)?, &control)?;
    /// assert!(found.contains(std::f64::consts::PI / 12.0) && found.width() < 1e-4);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn volume_in(&self, region: &dyn DynSolid, control: &Control<'_>) -> Result<Interval, Error> {
        Ok(self.content_in(region, Sums::of_volume(), control)?.volume(&self.frame))
    }

    fn content_in(&self, region: &dyn DynSolid, sums: Sums, control: &Control<'_>) -> Result<Sums, Error> {
        let job = Job::new(control);
        job.check()?;
        in_region(Once::new(self), region, &self.frame, sums, &job)
    }
}

impl Octree {
    /// Returns the number of cells in a region. See [`OctreeRef::cells_in`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::cells_in`].
    pub fn cells_in(&self, region: &dyn DynSolid, control: &Control<'_>) -> Result<CellsIn, Error> {
        self.view().cells_in(region, control)
    }

    /// Returns the volume in a region. See [`OctreeRef::volume_in`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::cells_in`].
    pub fn volume_in(&self, region: &dyn DynSolid, control: &Control<'_>) -> Result<Interval, Error> {
        self.view().volume_in(region, control)
    }
}
