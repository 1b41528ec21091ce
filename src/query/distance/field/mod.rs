//! The distances of all cells in a box.
//!
//! Two sets of cells bound the solid: the FULL cells from inside, the FULL and PARTIAL ones from outside. The
//! distance to the boundary of the first is an upper bound of the signed distance to the solid's boundary,
//! that to the second a lower bound. Both are exact Euclidean distances from the centres of cells to the
//! nearest closed cell of the other side, found axis by axis (Felzenszwalb and Huttenlocher 2012; Meijster,
//! Roerdink and Hesselink 2000).
//!
//! Lengths are integers: a half cell is the unit, and the centres of cells a row apart by k lie 2k − 1 from
//! each other's faces.

mod envelope;
mod mask;
mod rounding;
mod sides;
mod slab;

use super::place::{NOWHERE, Place, Square};
use super::stored::least;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::axes;
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Tag};
use crate::parallel::each;
use mask::{Mask, Range};
use rounding::Scale;
use slab::{DEEP, Slab};

/// Blocks along the box's longest edge at whose centres the distance is asked for first.
const BLOCKS: u32 = 16;

/// So many times as many cells as the box has are looked at all together, at the most. Where more were
/// needed, each cell of the box asks for itself, which costs about as much as so many cells do.
const MOST: u64 = 64;

/// A longer row is not looked at: squares of distances would not fit.
const LONGEST: u32 = 13_000;

impl OctreeRef<'_> {
    /// The signed distances of the finest cells in a box from the boundary of the solid:
    /// `field[(z·ny + y)·nx + x]` for the cell min + (x, y, z), where nx, ny, nz = max − min. `max` is the
    /// first cell beyond the box on each axis.
    ///
    /// The entry [lower, upper] (model units) contains the signed distance of the cell's *centre* from the
    /// boundary of any solid that the tree's cells and its exterior describe: positive outside, negative
    /// inside. The field is that of the whole solid, also of what lies outside of the box. For a cell that is
    /// EMPTY, lower is the distance from the nearest closed cell that is FULL or PARTIAL, and upper from the
    /// nearest that is FULL; for a FULL cell, they are minus the distances from the nearest EMPTY cell, and
    /// from the nearest that is EMPTY or PARTIAL. A PARTIAL one takes the first of the second pair and the
    /// second of the first. These distances are exact but for one rounding, outward, to single precision.
    /// They are ∞ where there is no such cell. What is outside of the universe counts as cells with the
    /// exterior's tag.
    ///
    /// The time is linear in the cells of the box and a margin around it as wide as the largest distance.
    /// Memory beside `field` is a quarter of a byte for each of these, and for each thread some 140 bytes for
    /// each cell of a slice across z. Where the margin were too wide, as for a small box far away from the
    /// solid, each cell asks for itself, as by [`distance`](Self::distance). The bits are the same for any
    /// number of threads.
    ///
    /// # Errors
    /// [`Error::Argument`] if min > max on an axis, if `max` lies outside of the universe, or if `field` has
    /// not one entry a cell; [`Error::OutOfMemory`], and [`Error::Cancelled`]: `field` then holds anything.
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
        let wanted = Range { min: min.map(|a| a + 1), max: max.map(|a| a + 1) };
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

    /// The range in which every cell of `wanted` has the nearest cell of each kind, if there is one.
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
            // From the block's middle, and from there to the centres of its cells: in half cells, rounded up.
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

    /// The entry of one cell.
    fn entry_alone(&self, at: [u32; 3], scale: &Scale) -> Result<[f32; 2], Error> {
        let place = Place::between_cells(&self.frame, at.map(|a| 2 * i64::from(a) + 1));
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
    /// As [`OctreeRef::distance_field`].
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

/// Whether cells of a tag belong to the set around the solid, and to that in it.
fn sets(tag: Tag) -> [bool; 2] {
    [tag != Tag::Empty, tag == Tag::Full]
}
