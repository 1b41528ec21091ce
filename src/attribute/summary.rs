//! Statistics of the values of a channel in a box and a solid.

use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Cell, Cube, Frame, Interval, valid};
use crate::octree::channel::Spot;
use crate::octree::{ChannelRef, OctreeRef};
use crate::solid::Verdict;
use crate::solid::stored::StoredPart;

/// Statistics of the values of a channel in a region, component by component. Places beyond the components
/// are 0. All intervals contain the true values, as far as the cells of the solid and of the channel
/// determine them. Rounding errors are included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelSummary {
    /// The least value of any cell that may belong to the region.
    pub least: [f64; 4],
    /// The greatest value of any cell that may belong to the region.
    pub greatest: [f64; 4],
    /// The volume of the region that has values, in cubic model units.
    pub volume: Interval,
    /// The integral of the value over that volume; for a density, the mass.
    pub integral: [Interval; 4],
    /// The mean value.
    pub mean: [Interval; 4],
    /// The volume of the region that has no value.
    pub volume_without: Interval,
}

impl ChannelRef<'_> {
    /// Computes least and greatest value, mean and integral of the values in the part of `solid` that lies in
    /// the box `bounds` (model units). Without a solid the region is the whole box, without a box the whole
    /// cube. `None` if no point of the region may have a value.
    ///
    /// FULL cells of the solid bound volume and integral on one side, FULL and PARTIAL cells on the other.
    /// The faces of the box may lie anywhere. O(cells that the box meets), no allocation.
    ///
    /// # Errors
    /// [`Error::Argument`] if a coordinate of the box is NaN, or min > max; [`Error::FrameMismatch`] if the
    /// solid lies in another cube; [`Error::Damaged`] for damaged links; [`Error::Cancelled`].
    pub fn summary(
        &self,
        solid: Option<&OctreeRef<'_>>,
        bounds: Option<&Bounds>,
        control: &Control<'_>,
    ) -> Result<Option<ChannelSummary>, Error> {
        self.check_links()?;
        let mut depth = self.frame().depth();
        if let Some(solid) = solid {
            if !solid.frame().same_universe(self.frame()) {
                return Err(self.frame().mismatch(solid.frame()));
            }
            solid.check_links()?;
            depth = depth.max(solid.frame().depth());
        }
        if let Some(bounds) = bounds {
            valid::ordered("bounds", bounds.min, bounds.max)?;
        }
        // Faces outside the cube do not matter, infinite ones least of all.
        let bounds = match bounds.map(|bounds| bounds.common(&Bounds::of(self.frame()))) {
            None => None,
            Some(Some(common)) if (0..3).all(|axis| common.min[axis] < common.max[axis]) => Some(common),
            Some(_) => return Ok(None),
        };
        let job = Job::new(control);
        let frame = self.frame().with_depth(depth)?;
        let mut sums = Sums { channel: self, solid, frame, bounds, job: &job, found: None, without: ZERO };
        sums.cell(Cell::ROOT, &solid.map_or(Verdict::Full, OctreeRef::root_verdict), &self.root())?;
        let without = sums.without;
        Ok(sums.found.map(|mut found| {
            found.volume_without = without;
            found.mean = core::array::from_fn(|k| {
                // Values may be NaN.
                let known = Interval::new(found.least[k], found.greatest[k]).unwrap_or(Interval::ALL);
                // If the volume may be 0, the quotient is unbounded.
                found.integral[k].over(found.volume).common(known).unwrap_or(known)
            });
            found
        }))
    }
}

const ZERO: Interval = Interval::exactly(0.0);

struct Sums<'a> {
    channel: &'a ChannelRef<'a>,
    solid: Option<&'a OctreeRef<'a>>,
    frame: Frame,
    bounds: Option<Bounds>,
    job: &'a Job<'a>,
    found: Option<ChannelSummary>,
    without: Interval,
}

impl Sums<'_> {
    fn cell(&mut self, cell: Cell, verdict: &Verdict<StoredPart>, spot: &Spot) -> Result<(), Error> {
        let sure = match verdict {
            Verdict::Empty => return Ok(()),
            Verdict::Full => true,
            _ => false,
        };
        let Some(volume) = self.volume(cell) else { return Ok(()) };
        if let (Verdict::Full | Verdict::Undecided, Spot::Settled(value)) = (verdict, spot) {
            let volume = if sure { volume } else { Interval::between(0.0, volume.upper) };
            match value {
                Some(bits) => self.add(self.channel.value_type().decode(*bits), volume),
                None => self.without = self.without.plus(volume),
            }
            return Ok(());
        }
        self.job.check()?;
        let verdicts = self.solid.map_or([*verdict; 8], |solid| solid.verdicts_below(verdict));
        let spots = self.channel.children(spot);
        for ((verdict, spot), k) in verdicts.iter().zip(&spots).zip(0..) {
            self.cell(cell.child(k), verdict, spot)?;
        }
        Ok(())
    }

    /// The volume of a cell in the box; `None` if they do not overlap.
    fn volume(&self, cell: Cell) -> Option<Interval> {
        let cube = Cube { frame: &self.frame, cell };
        let edge = Interval::exactly(2.0 * cube.half_edge());
        let (first, last) = cube.planes();
        let mut volume = Interval::exactly(1.0);
        for axis in 0..3 {
            let mut length = edge;
            if let Some(bounds) = &self.bounds {
                let (min, max) = (bounds.min[axis], bounds.max[axis]);
                let [first, last] = [first[axis], last[axis]].each(|plane| 2 * i64::from(plane));
                let side = |x: f64, plane: i64| self.frame.side(axis, x, plane);
                if side(min, last) >= 0 || side(max, first) <= 0 {
                    return None;
                }
                let distance = |x: f64, plane: i64| self.frame.rounded_offset(axis, x, plane);
                // The distances from the lower plane to the end, and to the beginning.
                let end = if side(max, last) < 0 { distance(max, first) } else { edge };
                let start = if side(min, first) > 0 { distance(min, first) } else { ZERO };
                length = end.minus(start);
            }
            volume = volume.times(length.not_negative());
        }
        Some(volume)
    }

    fn add(&mut self, value: [f64; 4], volume: Interval) {
        let fresh = ChannelSummary {
            least: value,
            greatest: value,
            volume,
            integral: value.each(|value| volume.times(Interval::exactly(value))),
            mean: [ZERO; 4],
            volume_without: ZERO,
        };
        self.found = Some(match self.found {
            None => fresh,
            Some(sum) => ChannelSummary {
                least: core::array::from_fn(|k| sum.least[k].min(fresh.least[k])),
                greatest: core::array::from_fn(|k| sum.greatest[k].max(fresh.greatest[k])),
                volume: sum.volume.plus(volume),
                integral: core::array::from_fn(|k| sum.integral[k].plus(fresh.integral[k])),
                ..fresh
            },
        });
    }
}
