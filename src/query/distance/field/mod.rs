//! The distances of all cells in a box.
//!
//! Two sets of cells bound the solid: the FULL cells from inside, the FULL and PARTIAL cells from outside.
//! The distance to the boundary of the first set is an upper bound of the signed distance to the solid's
//! boundary. The distance to the boundary of the second set is a lower bound. Both are exact Euclidean
//! distances from the centres of cells to the nearest closed cell of the other side, found axis by axis
//! (Felzenszwalb and Huttenlocher 2012; Meijster, Roerdink and Hesselink 2000).
//!
//! Lengths are integers in half cells. For two cells of a row that are k places apart, the distance from the
//! centre of one to the nearest face of the other is 2k − 1.

mod envelope;
mod mask;
mod rounding;
mod sides;
mod slab;

use super::place::{NOWHERE, Place, Square};
use super::stored::least;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Tag};
use crate::parallel::each;
use mask::{Mask, Range};
use rounding::Scale;
use slab::{DEEP, Slab};

/// The number of blocks along the box's longest edge. The distances at their centres are computed first.
const BLOCKS: u32 = 16;

/// The maximal ratio of jointly processed cells to the cells of the box. If more cells were needed, the
/// distance of each cell of the box is computed by itself, which costs about as much as this many cells.
const MOST: u64 = 64;

/// The maximal length of a row: the squares of distances in longer rows would overflow.
const LONGEST: u32 = 13_000;

impl OctreeRef<'_> {
    /// Computes the signed distances of the finest cells in a box from the boundary of the solid. The entry
    /// of the cell min + (x, y, z) is `field[(z·ny + y)·nx + x]`, where nx, ny, nz = max − min. `max` is the
    /// first cell beyond the box on each axis.
    ///
    /// The entry [lower, upper] (model units) contains the signed distance of the cell's *centre* from the
    /// boundary of any solid that the tree's cells and its exterior describe: positive outside, negative
    /// inside. The field describes the whole solid, including the parts outside of the box.
    ///
    /// - For an EMPTY cell, lower is the distance from the nearest closed cell that is FULL or PARTIAL. Upper
    ///   is the distance from the nearest FULL cell.
    /// - For a FULL cell, lower is minus the distance from the nearest EMPTY cell. Upper is minus the
    ///   distance from the nearest cell that is EMPTY or PARTIAL.
    /// - For a PARTIAL cell, lower is minus the distance from the nearest EMPTY cell. Upper is the distance
    ///   from the nearest FULL cell.
    ///
    /// These distances are exact but for one rounding, outward, to single precision. They are ∞ where there
    /// is no such cell. The space outside of the universe counts as cells with the exterior's tag.
    ///
    /// The time is linear in the cells of the box and a margin around it as wide as the largest distance. In
    /// addition to `field`, the memory is a quarter of a byte for each of these cells, and for each thread
    /// about 140 bytes for each cell of a slice across z. If the margin were too wide, as for a small box far
    /// away from the solid, the distance of each cell is computed by itself, as by
    /// [`distance`](Self::distance). The result is bitwise the same for any number of threads.
    ///
    /// # Errors
    /// [`Error::Argument`] if min > max on an axis, if `max` lies outside of the universe, or if `field` has
    /// not one entry for each cell. [`Error::OutOfMemory`] and [`Error::Cancelled`]: the contents of `field`
    /// are then unspecified.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build};
    /// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 6)?, Control::default());
    /// let ball = build(&Csg::ball([0.0; 3], 1.0)?, &frame, Rule::Certified, &control)?;
    /// let mut field = vec![[0.0f32; 2]; 64 * 64];
    /// ball.view().distance_field([0, 0, 32], [64, 64, 33], &mut field, &control)?;
    /// // The centre of the cell (0, 32, 32) is (-31.5, 0.5, 0.5) / 16.
    /// let [lower, upper] = field[32 * 64];
    /// assert!(lower <= 0.9693 && 0.9692 <= upper && upper - lower < 0.2);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn distance_field(
        &self,
        min: [u32; 3],
        max: [u32; 3],
        field: &mut [[f32; 2]],
        control: &Control<'_>,
    ) -> Result<(), Error> {
        let cells = self.frame.cells();
        if (0..3).any(|axis| min[axis] > max[axis] || max[axis] > cells) {
            return Err(Error::Argument {
                name: "max",
                problem: "must be a cell or the universe's end, and not below min",
            });
        }
        let size = axes(|axis| u64::from(max[axis] - min[axis]));
        let count = size[0] * size[1] * size[2];
        if field.len() as u64 != count {
            return Err(Error::Argument {
                name: "field",
                problem: "must have one entry for each cell of the box",
            });
        }
        let job = Job::new(control);
        job.check()?;
        if count == 0 {
            return Ok(());
        }
        let wanted = Range { min: min.each(|a| a + 1), max: max.each(|a| a + 1) };
        let seen = self.range_around(wanted)?;
        let scale = Scale::new(&self.frame);
        let seen_size = seen.size();
        let few = seen.cells() / MOST <= count && seen_size.iter().all(|&edge| edge <= LONGEST);
        let slice = (size[0] * size[1]) as usize;
        if few {
            let masks = Mask::both(self, seen, &job)?;
            let shares = size[2].div_ceil(DEEP as u64) as usize;
            control.run(count > 1 << 15, |parallel| {
                let tasks = field.chunks_mut(DEEP * slice).enumerate();
                each(parallel, tasks, |(k, part)| {
                    let first = wanted.min[2] + (k * DEEP) as u32;
                    let slab = Slab { wanted, first, deep: part.len() / slice, scale: &scale, job: &job };
                    slab.fill(&masks, part)?;
                    job.advance(WHOLE / shares);
                    Ok(())
                })
            })?;
            job.advance(WHOLE % shares);
        } else {
            control.run(count > 1 << 10, |parallel| {
                let tasks = field.chunks_mut(size[0] as usize).enumerate();
                each(parallel, tasks, |(k, row)| {
                    job.check()?;
                    let at =
                        [min[0], min[1] + (k as u64 % size[1]) as u32, min[2] + (k as u64 / size[1]) as u32];
                    for (x, entry) in (0..).zip(row) {
                        *entry = self.entry_alone([at[0] + x, at[1], at[2]], &scale)?;
                    }
                    Ok(())
                })
            })?;
            job.advance(WHOLE);
        }
        Ok(())
    }

    /// Returns a range in which every cell of `wanted` has its nearest cell of each kind, if there is one.
    fn range_around(&self, wanted: Range) -> Result<Range, Error> {
        let all = Range { min: [0; 3], max: [self.frame.cells() + 2; 3] };
        let longest = wanted.size().into_iter().max().unwrap_or(0);
        let step = longest.div_ceil(BLOCKS).max(8);
        let mut seen = wanted;
        for block in wanted.blocks(step) {
            let size = block.size();
            let doubled = axes(|axis| i64::from(block.min[axis] + block.max[axis]) - 2);
            let place = Place::between_cells(&self.frame, doubled);
            let [outer, inner] = least(self, &place, false)?;
            let [not_inner, not_outer] = least(self, &place, true)?;
            let farthest =
                [outer, inner, not_inner, not_outer].into_iter().filter(|&square| square != NOWHERE).max();
            let Some(farthest) = farthest else { continue };
            // The reach from the block's middle, plus the distance from there to the centres of the block's
            // cells: in half cells, rounded up.
            let half_diagonal = size.iter().map(|&edge| u64::from(edge).pow(2)).sum::<u64>().isqrt() + 1;
            let reach =
                u64::try_from(place.in_half_cells(farthest).isqrt()).unwrap_or(u64::MAX).saturating_add(2);
            let reach = u32::try_from(reach.saturating_add(half_diagonal) / 2 + 1).unwrap_or(u32::MAX);
            for axis in 0..3 {
                seen.min[axis] = seen.min[axis].min(block.min[axis].saturating_sub(reach));
                seen.max[axis] = seen.max[axis].max(block.max[axis].saturating_add(reach));
            }
        }
        Ok(seen.within(&all))
    }

    /// Computes the entry of a single cell.
    fn entry_alone(&self, at: [u32; 3], scale: &Scale) -> Result<[f32; 2], Error> {
        let place = Place::between_cells(&self.frame, at.each(|a| 2 * i64::from(a) + 1));
        let square = |square: Square| (square != NOWHERE).then(|| place.in_half_cells(square) as u64);
        let [outer, inner] = least(self, &place, false)?;
        if outer > 0 {
            return Ok([scale.down(square(outer)), scale.up(square(inner))]);
        }
        let [not_inner, not_outer] = least(self, &place, true)?;
        let upper = if inner > 0 { scale.up(square(inner)) } else { -scale.down(square(not_inner)) };
        Ok([-scale.up(square(not_outer)), upper])
    }
}

impl Octree {
    /// Computes the distances of the cells in a box. See [`OctreeRef::distance_field`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::distance_field`].
    pub fn distance_field(
        &self,
        min: [u32; 3],
        max: [u32; 3],
        field: &mut [[f32; 2]],
        control: &Control<'_>,
    ) -> Result<(), Error> {
        self.view().distance_field(min, max, field, control)
    }
}

/// Returns whether cells of a tag belong to the set around the solid, and whether they belong to the set
/// inside.
fn sets(tag: Tag) -> [bool; 2] {
    [tag != Tag::Empty, tag == Tag::Full]
}
