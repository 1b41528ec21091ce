//! Volumes: three-dimensional bitmaps and arrays of samples as solids.

mod axis;
mod field;
mod grid;
mod interpolate;
mod occupancy;
mod on_frame;
mod ranges;
mod samples;
mod slices;
mod value;

pub use grid::VoxelGrid;
pub use samples::{Band, SampleArray, Samples};

use super::{Fingerprint, Fingerprinter, Solid};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Frame};
use alloc::sync::Arc;
use field::Field;
use occupancy::Occupancy;
use on_frame::VolumeOnFrame;
use ranges::Ranges;
use value::Limits;

/// A three-dimensional bitmap, or an array of samples with a threshold, as a solid.
///
/// **The solid** is the union of all voxels whose sample lies in the [`Band`]. A voxel is the closed box
/// around its sample ([`VoxelGrid`]). So the solid is a regularised closed set, as all solids are. A cell is
/// FULL if it lies in the grid and all voxels that its interior meets are inside. It is EMPTY if none of them
/// is inside. No verdict is weaker than that. Everything beyond the grid is outside, and so is a sample that
/// is not a number.
///
/// On the frame of [`VoxelGrid::frame`], finest cells are voxels: nothing is PARTIAL there, and a tree built
/// by [`Rule::Sampled`](crate::Rule::Sampled) is the bitmap, bit for bit. On any other frame, and for voxels
/// that are not cubes, verdicts come from exact comparisons. A cell is then PARTIAL if it contains parts of
/// voxels of both kinds. A centre on a face between voxels belongs to the upper voxel.
///
/// Samples are never copied. Beside them, a volume keeps the least and the greatest value of each block of 4³
/// samples (not for bits), which all clones and all thresholds share. For each threshold it keeps two bits a
/// block, and a pyramid of these. The ranges and the pyramid take 1/32 and 1/256 of the memory of byte
/// samples; for bits, the pyramid takes 1/32. Splitting a cell reads one or eight words of the pyramid if the
/// cell consists of whole voxels on the grid's own lattice. Otherwise the cost is linear in the number of 4³
/// blocks that the cell's surface meets.
///
/// ```
/// use leafless::{Control, Octree, Rule, Volume, build, solid::{Band, VoxelGrid}};
///
/// // A ball in a volume of 100 × 90 × 80 bytes.
/// let (extents, middle) = ([100, 90, 80], [50.0, 45.0, 40.0]);
/// let mut samples = Vec::new();
/// for z in 0..80 {
///     for y in 0..90 {
///         for x in 0..100 {
///             let apart = [x, y, z].into_iter().zip(middle).map(|(c, m)| f64::from(c) + 0.5 - m);
///             let distance = apart.map(|d| d * d).sum::<f64>().sqrt();
///             samples.push((255.0 - 4.0 * distance).max(0.0) as u8);
///         }
///     }
/// }
/// let grid = VoxelGrid::new(extents, [0.0; 3], [0.25; 3])?;
/// let control = Control::default();
/// let ball = Volume::new(samples.into(), &grid, Band::at_least(128.0)?, &control)?;
///
/// // 128 cells per axis contain it; nothing is stored for the rest.
/// let tree = build(&ball, &grid.frame()?, Rule::Sampled, &control)?;
/// let volume = tree.statistics().volume();
/// assert_eq!(volume.width(), 0.0);
/// assert!((volume.lower / (4.0 / 3.0 * std::f64::consts::PI * 7.9375f64.powi(3)) - 1.0).abs() < 0.02);
///
/// // Another threshold does not read the samples again.
/// let smaller = ball.with_band(Band::at_least(192.0)?, &control)?;
/// let smaller = build(&smaller, &grid.frame()?, Rule::Sampled, &control)?;
/// assert!(smaller.statistics().volume().upper < volume.lower);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Volume<'a> {
    field: Field<'a>,
    band: Band,
    ranges: Arc<Ranges>,
    occupancy: Arc<Occupancy>,
}

impl<'a> Volume<'a> {
    /// Makes a solid of the voxels of `grid` whose samples lie in `band`. Several threads read all samples
    /// once: O(n), limited by the bandwidth of the memory.
    ///
    /// # Errors
    /// [`Error::Argument`] if the number of elements of `samples` is not the one that the grid needs;
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub fn new(
        samples: Samples<'a>,
        grid: &VoxelGrid,
        band: Band,
        control: &Control<'_>,
    ) -> Result<Volume<'a>, Error> {
        samples.check(grid)?;
        let ranges = Arc::new(Ranges::new(grid, &samples, control)?);
        let field = Field { grid: *grid, limits: Limits::new(&samples, &band), samples };
        let occupancy = Arc::new(Occupancy::new(&field, &ranges, control)?);
        Ok(Volume { field, band, ranges, occupancy })
    }

    /// Makes a solid of the same samples with another band. O(n / 64), except for bits. A band with two ends,
    /// or samples that are not numbers, may cost more: blocks of 4³ samples that their least and greatest
    /// values do not decide are read again.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub fn with_band(&self, band: Band, control: &Control<'_>) -> Result<Volume<'a>, Error> {
        let limits = Limits::new(&self.field.samples, &band);
        let field = Field { limits, ..self.field.clone() };
        let occupancy = Arc::new(Occupancy::new(&field, &self.ranges, control)?);
        Ok(Volume { field, band, ranges: self.ranges.clone(), occupancy })
    }

    /// The grid: the positions of the voxels.
    pub fn grid(&self) -> &VoxelGrid {
        &self.field.grid
    }

    /// The samples.
    pub fn samples(&self) -> &Samples<'a> {
        &self.field.samples
    }

    /// The values that are inside.
    pub fn band(&self) -> &Band {
        &self.band
    }

    /// The least and the greatest sample; `None` for bits, and if one is not a number. O(n / 64).
    pub fn value_range(&self) -> Option<[f64; 2]> {
        self.ranges.all()
    }

    /// The sample (x, y, z); `None` beyond the grid.
    pub fn sample(&self, at: [u32; 3]) -> Option<f64> {
        self.field.samples.get(&self.field.grid, at)
    }

    /// Returns whether the voxel (x, y, z) is inside. A voxel beyond the grid is outside.
    pub fn contains_voxel(&self, at: [u32; 3]) -> bool {
        self.field.contains(at)
    }

    /// The inside bits of the 4³ voxels from (4x, 4y, 4z) on, in Morton order: bits 0 to 2 of a place are the
    /// lowest bits of x, y, z, bits 3 to 5 the next. Voxels beyond the grid are outside.
    pub fn brick(&self, at: [u32; 3]) -> u64 {
        self.field.brick(at)
    }

    /// The same samples in voxels of edge 1, with the first corner at 0.
    pub(crate) fn in_voxels(&self) -> Result<Volume<'a>, Error> {
        let grid = VoxelGrid::new(self.field.grid.extents(), [0.0; 3], [1.0; 3])?;
        Ok(Volume { field: Field { grid, ..self.field.clone() }, ..self.clone() })
    }

    /// The voxel of the first of a frame's finest cells, if finest cells are voxels. It may lie beyond the
    /// grid.
    pub(crate) fn first_voxel(&self, frame: &Frame) -> Option<[i64; 3]> {
        VolumeOnFrame::new(self.clone(), frame).first_voxel()
    }

    /// The number of bytes that are kept beside the samples.
    pub fn bytes(&self) -> usize {
        self.ranges.bytes() + self.occupancy.bytes()
    }
}

impl<'a> Solid for Volume<'a> {
    type Classifier = VolumeOnFrame<'a>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<VolumeOnFrame<'a>, Error> {
        Ok(VolumeOnFrame::new(self.clone(), frame))
    }

    /// The box of the grid.
    fn bounds(&self) -> Option<Bounds> {
        Some(self.field.grid.bounds())
    }

    /// Covers all samples. O(n).
    fn fingerprint(&self) -> Option<Fingerprint> {
        let Field { grid, samples, limits } = &self.field;
        let all = Fingerprinter::new("volume")
            .integers(&grid.extents().each(u64::from))
            .numbers(&grid.corner())
            .numbers(&grid.spacing())
            .numbers(&[limits.low, limits.high]);
        let count = |values: usize, each: usize| values.div_ceil(each) as u64;
        let all = match samples {
            Samples::Bits(words) => {
                let (row, values) = (grid.words(), words.values());
                let last = grid.extents()[0] % 64;
                let real = if last == 0 { !0 } else { (1 << last) - 1 };
                let words = values.iter().zip((1..=row).cycle());
                let words = words.map(|(&word, i)| if i == row { word & real } else { word });
                all.integers(&[0]).words(count(values.len(), 1), words)
            }
            Samples::U8(values) => all.integers(&[1]).bytes(values.values()),
            Samples::U16(values) => {
                let word = |four: &[u16]| four.iter().rev().fold(0, |word, &v| word << 16 | u64::from(v));
                all.integers(&[2]).words(count(values.values().len(), 4), values.values().chunks(4).map(word))
            }
            Samples::I16(values) => {
                let word =
                    |four: &[i16]| four.iter().rev().fold(0, |word, &v| word << 16 | u64::from(v as u16));
                all.integers(&[3]).words(count(values.values().len(), 4), values.values().chunks(4).map(word))
            }
            Samples::F32(values) => {
                let word =
                    |two: &[f32]| two.iter().rev().fold(0, |word, v| word << 32 | u64::from(v.to_bits()));
                all.integers(&[4]).words(count(values.values().len(), 2), values.values().chunks(2).map(word))
            }
        };
        Some(all.finish())
    }

    /// Counts the samples, unless they are borrowed, and the data beside them.
    fn kept_bytes(&self) -> u64 {
        let samples = if self.field.samples.is_borrowed() { 0 } else { self.field.samples.bytes() };
        (samples + self.bytes()) as u64
    }
}
