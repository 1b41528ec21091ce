//! Columns of any solid, without an octree: blocks of columns, each with its own descent.

use super::runs::CellLists;
use super::{ColumnCells, Columns, Heights, Shadow, Side, Visitor};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::parallel::each;
use crate::solid::{Classifier, DynSolid, OCTANTS, Parts, Verdict, Worker};
use crate::walk::Proven;
use crate::walk::split_one;
use alloc::vec::Vec;

/// Returns the solid cells of `frame` in these columns. The cells in `full` are proven to be solid; the cells
/// that are not in `upper` are proven to be empty. All PARTIAL cells in the columns are split down to the
/// frame's depth. The answer does not depend on the number of threads.
///
/// # Errors
/// [`Error::Argument`] if the columns reach beyond the universe; the solid's own errors; [`Error::Limit`] if
/// the result takes more than `control.max_bytes`; [`Error::OutOfMemory`] and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::{Columns, columns}};
/// let frame = Frame::new([-2.0; 3], 4.0, 6)?;
/// let ball = Csg::ball([0.0; 3], 1.0)?;
/// let middle = Columns::within(0, [32; 2], [33; 2])?;
/// let cells = columns(&ball, &frame, &middle, &Control::default())?;
/// let (full, upper) = (cells.full.column(0)[0], cells.upper.column(0)[0]);
/// assert!(upper.start == 16 && upper.length == 32 && full.start >= 16 && full.length >= 30);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn columns(
    solid: &dyn DynSolid,
    frame: &Frame,
    columns: &Columns,
    control: &Control<'_>,
) -> Result<ColumnCells, Error> {
    let count = columns.counted(frame)?;
    // The bytes of a column's lists and offsets.
    let bytes = 4 * size_of::<u64>();
    let lists = in_blocks(solid, frame, columns, 0, bytes, control, CellLists::new)?;
    ColumnCells::gathered(columns, count, &lists)
}

/// Returns the reach of a solid in these columns, as far as the cells of `frame` determine it. A PARTIAL cell
/// is split unless a FULL cell hides it in each of its columns. The answer does not depend on the number of
/// threads.
///
/// # Errors
/// As [`columns`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::{Columns, Side, heights}};
/// let frame = Frame::new([-2.0; 3], 4.0, 9)?;
/// let ball = Csg::ball([0.0; 3], 1.0)?;
/// let columns = Columns::all(&frame, 2)?;
/// let heights = heights(&ball, &frame, &columns, Side::Above, &Control::default())?;
/// let middle = heights.height(columns.index([256, 256]).unwrap()).expect("the ball is there");
/// assert!(middle.contains(1.0) && middle.width() < 0.02);
/// assert_eq!(heights.height(0), None);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn heights(
    solid: &dyn DynSolid,
    frame: &Frame,
    columns: &Columns,
    side: Side,
    control: &Control<'_>,
) -> Result<Heights, Error> {
    let mirror = if side == Side::Above { 1 << columns.axis } else { 0 };
    let bytes = 4 * size_of::<u32>();
    let new = |block: Columns, count: usize| Heights::new(*frame, block, side, count);
    let blocks = in_blocks(solid, frame, columns, mirror, bytes, control, new)?;
    let mut heights = Heights::new(*frame, *columns, side, columns.counted(frame)?)?;
    for block in &blocks {
        heights.take(block);
    }
    Ok(heights)
}

/// The number of blocks, or one less, that columns are divided into along each axis.
const BLOCKS: u32 = 8;
/// The least edge of a block, in cells.
const SMALLEST: u32 = 16;

/// Divides the columns into blocks. Their edge is a power of two, so that a cell of that edge lies in one
/// block.
fn blocks(columns: &Columns) -> Result<(u32, Vec<Columns>), Error> {
    let size = columns.size();
    let edge = size[0].max(size[1]).div_ceil(BLOCKS).next_power_of_two().max(SMALLEST);
    let mut blocks = Vec::new();
    let starts = |i: usize| (columns.first[i] / edge..columns.end[i].div_ceil(edge)).map(move |k| k * edge);
    for v in starts(1) {
        for u in starts(0) {
            let corner = [u, v];
            let first = [0, 1].each(|i| corner[i].max(columns.first[i]));
            let end = [0, 1].each(|i| (corner[i] + edge).min(columns.end[i]));
            if first[0] < end[0] && first[1] < end[1] {
                memory::push(&mut blocks, Columns { first, end, ..*columns })?;
            }
        }
    }
    Ok((edge, blocks))
}

/// Walks through each block with its own visitor. The visitor is made from the block's columns and their
/// count. A column takes `bytes` bytes. Octants are met in the order k ^ `mirror`.
fn in_blocks<V: Visitor + Send>(
    solid: &dyn DynSolid,
    frame: &Frame,
    columns: &Columns,
    mirror: u8,
    bytes: usize,
    control: &Control<'_>,
    new: impl Fn(Columns, usize) -> Result<V, Error> + Send + Sync,
) -> Result<Vec<V>, Error> {
    let job = Job::new(control);
    job.spend(0, columns.counted(frame)?.saturating_mul(bytes))?;
    let (edge, blocks) = blocks(columns)?;
    let classifier = Proven(solid.on(frame, control)?);
    let descent = Descent { job: &job, depth: frame.depth(), mirror };
    // Cells greater than a block are split once for all blocks.
    let mut above = classifier.worker()?;
    let mut front = Vec::new();
    let root = above.root()?;
    descent.gather(&mut above, columns, edge, (Cell::ROOT, root), &mut front)?;
    let parts = WHOLE / blocks.len().max(1);
    control.run(blocks.len() > 1, |parallel| {
        each(parallel, blocks.into_iter(), |block| {
            let mut worker = classifier.worker()?;
            let mut visitor = new(block, block.counted(frame)?)?;
            for (cell, verdict) in &front {
                if descent.shadow(&block, *cell).is_some() {
                    let mark = worker.mark();
                    let own = verdict.try_map(|part| worker.hand_over(&above, &part))?;
                    descent.walk(&mut worker, &block, (*cell, own), &mut visitor)?;
                    worker.release(mark);
                }
            }
            job.advance(parts);
            Ok(visitor)
        })
    })
}

/// A cell and its verdict.
type Known<W> = (Cell, Verdict<<W as Parts>::Part>);

/// The descent through the cells in columns.
struct Descent<'j> {
    job: &'j Job<'j>,
    depth: u8,
    mirror: u8,
}

impl Descent<'_> {
    /// Returns the part of a cell that lies in columns.
    fn shadow(&self, columns: &Columns, cell: Cell) -> Option<Shadow> {
        let shift = self.depth - cell.level;
        columns.shadow(cell.at.each(|a| a << shift), 1 << shift)
    }

    /// Returns the children of a cell in the order of the walk.
    fn split<W: Worker>(&self, worker: &mut W, cell: Cell, part: &W::Part) -> Result<[Known<W>; 8], Error> {
        self.job.check()?;
        let mut children = split_one(worker, cell, part, self.job.control())?;
        Ok(OCTANTS.each(|k| {
            let octant = k ^ self.mirror;
            (cell.child(octant), core::mem::replace(&mut children[octant as usize], Verdict::Empty))
        }))
    }

    /// Adds the cells in the columns that are not EMPTY to `front`, in the order of the walk: the cells of
    /// the given edge, and larger cells that are not split. The recursion is as deep as the frame, 20 levels
    /// at the most.
    fn gather<W: Worker>(
        &self,
        worker: &mut W,
        columns: &Columns,
        edge: u32,
        (cell, verdict): Known<W>,
        front: &mut Vec<Known<W>>,
    ) -> Result<(), Error> {
        if matches!(verdict, Verdict::Empty) || self.shadow(columns, cell).is_none() {
            return Ok(());
        }
        match verdict {
            Verdict::Partial(part) if 1 << (self.depth - cell.level) > edge => {
                for child in self.split(worker, cell, &part)? {
                    self.gather(worker, columns, edge, child, front)?;
                }
                Ok(())
            }
            verdict => memory::push(front, (cell, verdict)),
        }
    }

    /// Passes a cell in the columns, or the cells that it is split into, to a visitor. The recursion is as
    /// deep as the frame.
    fn walk<W: Worker>(
        &self,
        worker: &mut W,
        columns: &Columns,
        (cell, verdict): Known<W>,
        visitor: &mut impl Visitor,
    ) -> Result<(), Error> {
        if matches!(verdict, Verdict::Empty) {
            return Ok(());
        }
        let Some(shadow) = self.shadow(columns, cell) else { return Ok(()) };
        match verdict {
            Verdict::Partial(_) if visitor.skips(&shadow) => Ok(()),
            Verdict::Partial(part) if cell.level < self.depth => {
                let mark = worker.mark();
                for child in self.split(worker, cell, &part)? {
                    self.walk(worker, columns, child, visitor)?;
                }
                worker.release(mark);
                Ok(())
            }
            verdict => visitor.meet(matches!(verdict, Verdict::Full), &shadow),
        }
    }
}
