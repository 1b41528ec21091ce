//! How much of a solid lies in a region?

mod below;
mod in_box;
mod once;
mod sums;
mod walk;

use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Frame, Interval};
use crate::octree::{Octree, OctreeRef};
use crate::solid::{Classifier, Solid};
use crate::walk::Proven;
use once::Once;
use sums::Sums;
use walk::{Counted, walk};

/// How many finest cells of a solid lie in a region, between bounds.
///
/// A cell where the region is FULL lies in it, one where it is EMPTY does not, and one where it is PARTIAL
/// may. So the bounds hold however "in" is understood: whether a cell counts that lies in the region as a
/// whole, whose centre does, or that has any volume in common with it.
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

/// How many finest cells of `frame` lie in a solid and in a region, which is a ball
/// ([`Csg::ball`](crate::Csg::ball)) or any other solid. What is not proven of either counts as PARTIAL, and
/// what lies outside of the universe does not count.
///
/// No octree is made. A cell is split only where neither is EMPTY and one is undecided, so the time is about
/// that of splitting the region's boundary inside of the solid and the solid's boundary inside of the region,
/// down to the frame's depth; the memory is O(depth). Once `control.max_splits` cells of both are split, the
/// others count as undecided. One thread.
///
/// # Errors
/// What solid and region refuse; [`Error::OutOfMemory`], and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::cells_in};
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 3)?, Control::default());
/// let slab = Csg::cuboid([0.0; 3], [8.0, 8.0, 2.0])?;
/// let found = cells_in(&slab, &Csg::cuboid([1.0; 3], [4.0, 3.0, 7.0])?, &frame, &control)?;
/// assert_eq!((found.full_least, found.full_most), (6, 6));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn cells_in<S: Solid, R: Solid>(
    solid: &S,
    region: &R,
    frame: &Frame,
    control: &Control<'_>,
) -> Result<CellsIn, Error> {
    Ok(content(solid, region, frame, Sums::of_cells(), control)?.cells())
}

/// The volume that a solid and a region have in common inside of the universe of `frame`, in cubic model
/// units: an interval that contains the truth. The region is a ball ([`Csg::ball`](crate::Csg::ball)) or any
/// other solid.
///
/// Cells are split as [`cells_in`] does. In a cell of the finest level the volume is known as well as solid
/// and region know it there, by their moments or enclosures, and lies between nothing and the cell's where
/// they know nothing. (To split until a volume is known to a tolerance, [`measure`](crate::measure) the
/// intersection.)
///
/// # Errors
/// As [`cells_in`].
pub fn volume_in<S: Solid, R: Solid>(
    solid: &S,
    region: &R,
    frame: &Frame,
    control: &Control<'_>,
) -> Result<Interval, Error> {
    Ok(content(solid, region, frame, Sums::of_volume(), control)?.volume(frame))
}

fn content<S: Solid, R: Solid>(
    solid: &S,
    region: &R,
    frame: &Frame,
    sums: Sums,
    control: &Control<'_>,
) -> Result<Sums, Error> {
    let job = Job::new(control);
    job.check()?;
    let solid = Proven(solid.on(frame, control)?).worker()?;
    in_region(solid, region, frame, sums, &job)
}

fn in_region<S: Counted, R: Solid>(
    solid: S,
    region: &R,
    frame: &Frame,
    sums: Sums,
    job: &Job<'_>,
) -> Result<Sums, Error> {
    let region = Proven(region.on(frame, job.control())?).worker()?;
    walk(solid, region, frame.depth(), sums, job)
}

impl OctreeRef<'_> {
    /// How many finest cells of the octree lie in a region, which is a ball ([`Csg::ball`](crate::Csg::ball))
    /// or any other solid: the FULL ones, and the FULL and PARTIAL ones. The octree's cells are taken as they
    /// are, whatever they prove; what is not proven of the region counts as PARTIAL.
    ///
    /// Where the region is FULL, whole subtrees are counted, 64 cells at a time; where it is EMPTY, nothing
    /// is read; and where it is undecided and the octree is not EMPTY, it is split, down to the octree's
    /// depth. The memory is O(depth). Once `control.max_splits` cells of both are split, the others count as
    /// undecided. One thread. Whatever the bytes, no element is read twice, and damage reads as PARTIAL.
    ///
    /// # Errors
    /// What the region refuses; [`Error::OutOfMemory`], and [`Error::Cancelled`].
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
    pub fn cells_in<R: Solid>(&self, region: &R, control: &Control<'_>) -> Result<CellsIn, Error> {
        Ok(self.content_in(region, Sums::of_cells(), control)?.cells())
    }

    /// The volume that the solid and a region have in common, in cubic model units, as the octree's cells
    /// tell it: FULL ones bound it from below, FULL and PARTIAL ones from above. The region is a ball
    /// ([`Csg::ball`](crate::Csg::ball)) or any other solid; what lies outside of the universe does not
    /// count.
    ///
    /// In a finest cell that the region cuts, its volume is known as well as the region knows it there: that
    /// of a ball to the third order. Time, memory and hostile bytes are as for
    /// [`cells_in`](OctreeRef::cells_in), with one or two microseconds more for each cell that is cut.
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
    pub fn volume_in<R: Solid>(&self, region: &R, control: &Control<'_>) -> Result<Interval, Error> {
        Ok(self.content_in(region, Sums::of_volume(), control)?.volume(&self.frame))
    }

    fn content_in<R: Solid>(&self, region: &R, sums: Sums, control: &Control<'_>) -> Result<Sums, Error> {
        let job = Job::new(control);
        job.check()?;
        in_region(Once::new(self), region, &self.frame, sums, &job)
    }
}

impl Octree {
    /// As [`OctreeRef::cells_in`].
    ///
    /// # Errors
    /// As [`OctreeRef::cells_in`].
    pub fn cells_in<R: Solid>(&self, region: &R, control: &Control<'_>) -> Result<CellsIn, Error> {
        self.view().cells_in(region, control)
    }

    /// As [`OctreeRef::volume_in`].
    ///
    /// # Errors
    /// As [`OctreeRef::volume_in`].
    pub fn volume_in<R: Solid>(&self, region: &R, control: &Control<'_>) -> Result<Interval, Error> {
        self.view().volume_in(region, control)
    }
}
