//! Columns of any solid, without an octree: blocks of columns, each by a descent of its own.

use super::runs::CellLists;
use super::{ColumnCells, Columns, Heights, Shadow, Side, Visitor};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::parallel::each;
use crate::solid::{Classifier, OCTANTS, Parts, Solid, Verdict, Worker};
use crate::walk::Proven;
use crate::walk::split_one;
use alloc::vec::Vec;

/// Which cells of `frame` in these columns are solid: `full` are proven to be, and what is not in `upper` is
/// proven not to be. Splits all PARTIAL cells in the columns down to the frame's depth. The answer is the
/// same for any number of threads.
///
/// # Errors
/// [`Error::Argument`] if the columns reach beyond the universe; what the solid refuses; [`Error::Limit`] if
/// the result takes more than `control.max_bytes`; [`Error::OutOfMemory`], and [`Error::Cancelled`].
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
pub fn columns<S: Solid>(
    solid: &S,
    frame: &Frame,
    columns: &Columns,
    control: &Control<'_>,
) -> Result<ColumnCells, Error> {
    let count = columns.counted(frame)?;
    // What the lists of a column take, and its offsets.
    let bytes = 4 * size_of::<u64>();
    let lists = in_blocks(solid, frame, columns, 0, bytes, control, CellLists::new)?;
    ColumnCells::gathered(columns, count, &lists)
}

/// How far a solid reaches in these columns, as far as cells of `frame` tell. A PARTIAL cell is split unless
/// a FULL one hides it in each of its columns. The answer is the same for any number of threads.
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
pub fn heights<S: Solid>(
    solid: &S,
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

/// Blocks that columns are divided into along each axis, or one more.
const BLOCKS: u32 = 8;
/// The least edge of a block, in cells.
const SMALLEST: u32 = 16;

/// The columns in blocks, whose edge is a power of two, so that a cell of that edge lies in one of them.
fn blocks(columns: &Columns) -> Result<(u32, Vec<Columns>), Error> {
    let size = columns.size();
    let edge = size[0].max(size[1]).div_ceil(BLOCKS).next_power_of_two().max(SMALLEST);
    let mut blocks = Vec::new();
    let starts = |i: usize| (columns.first[i] / edge..columns.end[i].div_ceil(edge)).map(move |k| k * edge);
    for v in starts(1) {
        for u in starts(0) {
            let corner = [u, v];
            let first = [0, 1].map(|i| corner[i].max(columns.first[i]));
            let end = [0, 1].map(|i| (corner[i] + edge).min(columns.end[i]));
            if first[0] < end[0] && first[1] < end[1] {
                memory::push(&mut blocks, Columns { first, end, ..*columns })?;
            }
        }
    }
    Ok((edge, blocks))
}

/// Walks through each block, of which a visitor of its own is made from its columns and their count. A column
/// takes so many `bytes`. Octants are met in the order k ^ `mirror`.
fn in_blocks<S: Solid, V: Visitor + Send>(
    solid: &S,
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
    // What is greater than a block is split once for all of them.
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
                    let own = verdict.clone().try_map(|part| worker.hand_over(&above, &part))?;
                    descent.walk(&mut worker, &block, (*cell, own), &mut visitor)?;
                    worker.release(mark);
                }
            }
            job.advance(parts);
            Ok(visitor)
        })
    })
}

/// A cell, and what is known of it.
type Known<W> = (Cell, Verdict<<W as Parts>::Part>);

/// The way down through the cells in columns.
struct Descent<'j> {
    job: &'j Job<'j>,
    depth: u8,
    mirror: u8,
}

impl Descent<'_> {
    /// What lies in columns of a cell.
    fn shadow(&self, columns: &Columns, cell: Cell) -> Option<Shadow> {
        let shift = self.depth - cell.level;
        columns.shadow(cell.at.map(|a| a << shift), 1 << shift)
    }

    /// The children of a cell in the order of the walk.
    fn split<W: Worker>(&self, worker: &mut W, cell: Cell, part: &W::Part) -> Result<[Known<W>; 8], Error> {
        self.job.check()?;
        let mut children = split_one(worker, cell, part, self.job.control())?;
        Ok(OCTANTS.map(|k| {
            let octant = k ^ self.mirror;
            (cell.child(octant), core::mem::replace(&mut children[octant as usize], Verdict::Empty))
        }))
    }

    /// Adds the cells in the columns that are not EMPTY to `front`, in the order of the walk: those of an
    /// edge, and greater ones that are not split. The recursion is as deep as the frame, 20 levels at the
    /// most.
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

    /// Shows a cell in the columns, or what it is split into, to a visitor. The recursion is as deep as the
    /// frame.
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
