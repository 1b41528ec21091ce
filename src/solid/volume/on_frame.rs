//! A volume on a frame.

use super::axis::{Axis, Run};
use super::occupancy::Seen;
use super::{Volume, VoxelGrid};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Cell, Frame};
use crate::octree::{Planes, Proof, Tag};
use crate::solid::{
    Batch, Classifier, FreeParts, OCTANTS, Question, Verdict, WholeQuestion, Worker, sample_one_by_one,
    split_one_by_one, split_twice,
};
use alloc::vec::Vec;

/// A volume on a frame: both handle and worker. The cell alone decides its verdict, so that its part is
/// empty.
#[derive(Debug, Clone)]
pub struct VolumeOnFrame<'a> {
    volume: Volume<'a>,
    frame: Frame,
    axes: [Axis; 3],
    /// The position of the first finest cell relative to the first voxel, in voxels, and k, if finest cells
    /// are cubes of 2^k voxels along an edge that lie on voxels.
    aligned: Option<([i64; 3], u32)>,
}

impl<'a> VolumeOnFrame<'a> {
    pub(super) fn new(volume: Volume<'a>, frame: &Frame) -> VolumeOnFrame<'a> {
        let axes = axes(|axis| Axis::new(volume.grid(), frame, axis));
        let aligned = match axes {
            [
                Axis::Lattice { offset: x, shift, .. },
                Axis::Lattice { offset: y, shift: of_y, .. },
                Axis::Lattice { offset: z, shift: of_z, .. },
            ] if shift == of_y && shift == of_z && shift >= -1 => Some(([x, y, z], (shift + 1) as u32)),
            _ => None,
        };
        VolumeOnFrame { volume, frame: *frame, axes, aligned }
    }

    /// The voxel of the first finest cell, if finest cells are voxels.
    pub(super) fn first_voxel(&self) -> Option<[i64; 3]> {
        self.aligned.filter(|&(_, k)| k == 0).map(|(first, _)| first)
    }

    fn grid(&self) -> &VoxelGrid {
        self.volume.grid()
    }

    /// The voxels between two planes, counted in half cells of the frame.
    fn run(&self, axis: usize, planes: [u32; 2]) -> Run {
        let [from, to] = planes.each(|k| self.axes[axis].place(self.grid(), &self.frame, k));
        self.axes[axis].run(from, to)
    }

    fn verdict(&self, runs: [Run; 3]) -> Verdict<()> {
        if runs.iter().any(|run| run.low >= run.high) {
            return Verdict::Empty;
        }
        let Seen { inside, mut outside } = self.volume.occupancy.look(
            &self.volume.field,
            runs.each(|run| run.low),
            runs.each(|run| run.high),
        );
        outside |= runs.iter().any(|run| run.beyond);
        match (inside, outside) {
            (true, true) => Verdict::Partial(()),
            (true, false) => Verdict::Full,
            _ => Verdict::Empty,
        }
    }

    /// The cell in voxels, if it is a cube of 2^k of them along an edge and lies on a multiple of its edge:
    /// its place counted in cubes of this size, and k.
    fn cube(&self, cell: Cell) -> Option<([i64; 3], u32)> {
        let (offset, finest) = self.aligned?;
        let k = u32::from(self.frame.depth() - cell.level) + finest;
        let is_on = |axis: usize| offset[axis] & ((1 << k) - 1) == 0;
        let at = axes(|axis| (offset[axis] >> k) + i64::from(cell.at[axis]));
        (k < 62 && (0..3).all(is_on)).then_some((at, k))
    }

    /// The 64 cubes that make up the cube of 4^(level + 2) voxels along an edge at a place. If the level is
    /// −1 they are voxels.
    fn group(&self, level: i32, at: [i64; 3]) -> Planes {
        if level >= 0 {
            return self.volume.occupancy.group(level as usize, at);
        }
        let blocks = self.grid().extents().each(|extent| i64::from(extent.div_ceil(4)));
        if (0..3).any(|axis| !(0..blocks[axis]).contains(&at[axis])) {
            return Planes::uniform(Tag::Empty);
        }
        Planes::binary(self.volume.field.brick(at.each(|a| a as u32)))
    }

    /// The 64 grandchildren of a cube of 2^k voxels along an edge, k ≥ 2: those that are certainly inside,
    /// and those that may be.
    fn grandchildren(&self, at: [i64; 3], k: u32) -> Planes {
        if k.is_multiple_of(2) {
            return self.group(k as i32 / 2 - 2, at);
        }
        let mut planes = Planes::uniform(Tag::Empty);
        for octant in OCTANTS {
            let bit = |axis: u32| i64::from(octant >> axis & 1);
            let child = [2 * at[0] + bit(0), 2 * at[1] + bit(1), 2 * at[2] + bit(2)];
            let group = self.group(k as i32 / 2 - 2, child);
            let [empty, full, _] = Planes { lower: group.lower, upper: group.upper | group.lower }.octants();
            // Gathers the low bits of the bytes side by side.
            let bits = |low: u64| low.wrapping_mul(0x0102_0408_1020_4080) >> 56;
            planes.lower |= bits(full) << (8 * octant);
            planes.upper |= (bits(empty) ^ 0xFF) << (8 * octant);
        }
        planes
    }
}

impl VolumeOnFrame<'_> {
    /// Returns whether the centre of a finest cell lies in the solid.
    fn contains_centre(&self, cell: Cell) -> bool {
        let mut voxel = [0; 3];
        for axis in 0..3 {
            // Shifted upward, a centre on a face between voxels lies in the upper voxel.
            let place = self.axes[axis].place(self.grid(), &self.frame, 2 * cell.at[axis] + 1);
            match u32::try_from(place.floor) {
                Ok(floor) if floor < self.grid().extents()[axis] => voxel[axis] = floor,
                _ => return false,
            }
        }
        self.volume.field.contains(voxel)
    }
}

impl<'a> Classifier for VolumeOnFrame<'a> {
    type Worker = VolumeOnFrame<'a>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<VolumeOnFrame<'a>, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        if self.grid().is_within(&self.frame) { Tag::Empty } else { Tag::Partial }
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl FreeParts for VolumeOnFrame<'_> {
    type Part = ();
}

impl Batch for VolumeOnFrame<'_> {
    fn likes_many(&self) -> bool {
        false
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, ())],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<()>; 8]>,
    ) -> Result<(), Error> {
        split_one_by_one(self, cells, control, verdicts)
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, ())],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        sample_one_by_one(self, cells, control, inside)
    }

    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        for (&point, answer) in points.iter().zip(answers) {
            let voxel = self.grid().voxel_of(point);
            *answer = Some(voxel.is_some_and(|voxel| self.volume.field.contains(voxel)));
        }
        Ok(())
    }

    fn recall(&mut self, _: Cell) -> Option<()> {
        Some(())
    }
}

impl Worker for VolumeOnFrame<'_> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        let end = 2 * self.frame.cells();
        Ok(self.verdict(axes(|axis| self.run(axis, [0, end]))))
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        // Planes of half cells, because the middle of a finest cell is one of them.
        let shift = 1 + self.frame.depth().saturating_sub(cell.level);
        let halves = axes(|axis| {
            let first = cell.at[axis] << shift;
            let planes = [first, first + (1 << (shift - 1)), first + (1 << shift)];
            let [low, middle, high] = planes.each(|k| self.axes[axis].place(self.grid(), &self.frame, k));
            [self.axes[axis].run(low, middle), self.axes[axis].run(middle, high)]
        });
        Ok(OCTANTS.each(|octant| self.verdict(axes(|axis| halves[axis][usize::from(octant >> axis & 1)]))))
    }

    #[inline]
    fn answer(&mut self, cell: Cell, _: &(), question: Question<'_>) -> Result<(), Error> {
        if let Question::Centre(inside) = question {
            *inside = Some(self.contains_centre(cell));
        }
        Ok(())
    }

    fn split64(&mut self, cell: Cell, part: &(), parts: &mut Vec<(u8, ())>) -> Result<Planes, Error> {
        let Some((at, k @ 2..)) = self.cube(cell) else { return split_twice(self, cell, part, parts) };
        let planes = self.grandchildren(at, k);
        let mut mixed = planes.partial();
        parts.try_reserve(mixed.count_ones() as usize)?;
        while mixed != 0 {
            parts.push((mixed.trailing_zeros() as u8, ()));
            mixed &= mixed - 1;
        }
        Ok(planes)
    }
}
