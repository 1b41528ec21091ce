//! The solid fraction of voxels.

use super::record::VoxelKind;
use super::records::VoxelRecordsRef;
use crate::control::Control;
use crate::cut;
use crate::error::Error;
use crate::lattice::Cell;
use crate::memory;
use crate::solid::{Classifier, DynSolid, Verdict, Worker};
use crate::walk::Trail;
use alloc::vec::Vec;

impl VoxelRecordsRef<'_> {
    /// Computes the solid fraction of each voxel, 0 to 1, in the form of a volume's
    /// [weights](crate::render::VolumeLayer::weights). Inside voxels have 1, outside and refined voxels
    /// have 0. For a boundary voxel, the fraction comes from the moments of `solid` there, or from the mean
    /// of the two bounds by its slabs; it is ½ if the solid has neither. One thread; O(records · levels).
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build, voxel::{VoxelOptions, VoxelRecords}};
    /// let (frame, control) = (Frame::new([-1.0; 3], 2.0, 5)?, Control::default());
    /// let ball = Csg::ball([0.0; 3], 0.9)?;
    /// let tree = build(&ball, &frame, Rule::Certified, &control)?;
    /// let records = VoxelRecords::of(tree.view(), &VoxelOptions::new(), None, &control)?;
    /// let parts = records.view().solid_parts(&ball, &control)?;
    /// let volumes = records.view().iter().zip(&parts).map(|(record, part)| part * (2.0 / 2f64.powi(record.cell.level.into())).powi(3));
    /// assert!((volumes.sum::<f64>() - 3.053628).abs() < 1e-4);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of the solid, [`Error::OutOfMemory`], [`Error::Cancelled`].
    pub fn solid_parts(&self, solid: &dyn DynSolid, control: &Control<'_>) -> Result<Vec<f64>, Error> {
        let mut trail = Trail::new(solid.on(self.frame(), control)?.worker()?)?;
        let mut parts = memory::with_capacity(self.len())?;
        for index in 0..self.len() {
            let kind = self.kind_at(index);
            if kind != VoxelKind::Boundary {
                parts.push(if kind == VoxelKind::Inside { 1.0 } else { 0.0 });
                continue;
            }
            control.check()?;
            let cell = self.cell_at(index);
            let part = match cell.level {
                // A trail asks about a cell by way of its parent, and the universe has none.
                0 => mean((0..8).map(|octant| part(&mut trail, cell.child(octant), control)))?,
                _ => part(&mut trail, cell, control)?,
            };
            parts.push(part);
        }
        Ok(parts)
    }
}

/// The mean of eight fractions.
fn mean(parts: impl Iterator<Item = Result<f64, Error>>) -> Result<f64, Error> {
    Ok(parts.sum::<Result<f64, Error>>()? / 8.0)
}

/// The solid fraction of a cell below the universe.
fn part<W: Worker>(trail: &mut Trail<W>, cell: Cell, control: &Control<'_>) -> Result<f64, Error> {
    trail.follow(cell.parent(), control)?;
    let part = match trail.verdict(cell) {
        Verdict::Empty => 0.0,
        Verdict::Full => 1.0,
        Verdict::Undecided => 0.5,
        Verdict::Partial(_) => match trail.moments(cell)? {
            Some(known) if known.error < 1.0 => known.moments.volume / 8.0,
            _ => trail.enclosure(cell)?.map_or(0.5, |enclosure| {
                let (inner, outer) = cut::bounds(&enclosure);
                (inner.volume + outer.volume) / 16.0
            }),
        },
    };
    Ok(part.clamp(0.0, 1.0))
}
