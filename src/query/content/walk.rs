//! The walk through the cells that a solid and a region have in common.

use super::below;
use super::sums::{Share, Sums};
use crate::control::{Job, WHOLE};
use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::{Planes, Tag};
use crate::solid::{Ask, Verdict, Worker};
use crate::walk::ProvenWorker;
use crate::walk::split_one;
use alloc::vec::Vec;

/// A worker that may provide the number of cells below a cut cell.
pub(super) trait Counted: Worker {
    /// Returns the number of FULL and of PARTIAL finest cells below a cell with `cells` finest cells, if it
    /// is known without a split. The cell is not split afterwards.
    fn below(&mut self, cells: u64, part: &Self::Part) -> Option<[u64; 2]>;
}

impl<W: Worker> Counted for ProvenWorker<W> {
    fn below(&mut self, cells: u64, part: &W::Part) -> Option<[u64; 2]> {
        let stored = self.subtree(part)?;
        // (The links of a solid's subtrees are sound.)
        let [full, partial] =
            below::count(stored.tree, stored.level, stored.index, None).unwrap_or([0, cells]);
        Some([if stored.flip { cells.saturating_sub(full + partial) } else { full }, partial])
    }
}

/// Adds up the cells down to `depth` in which neither solid nor region is EMPTY.
pub(super) fn walk<S: Counted, R: Worker>(
    mut solid: S,
    mut region: R,
    depth: u8,
    sums: Sums,
    job: &Job<'_>,
) -> Result<Sums, Error> {
    let roots = (solid.root()?, region.root()?);
    // Where splits are counted, or each split may take long, cells are split one at a time.
    let by_eight = job.control().max_splits.is_some() || solid.likes_many() || region.likes_many();
    let left = job.control().max_splits.unwrap_or(u64::MAX);
    let (solid_parts, region_parts) = (Vec::new(), Vec::new());
    let mut walk =
        Walk { solid, region, solid_parts, region_parts, depth, by_eight, left, sums, job, told: 0 };
    walk.cell(Cell::ROOT, roots.0, roots.1)?;
    Ok(walk.sums)
}

struct Walk<'a, S: Worker, R: Worker> {
    solid: S,
    region: R,
    /// The parts of the present blocks, each with its place in its block.
    solid_parts: Vec<(u8, S::Part)>,
    region_parts: Vec<(u8, R::Part)>,
    depth: u8,
    by_eight: bool,
    left: u64,
    sums: Sums,
    job: &'a Job<'a>,
    /// The progress reported so far.
    told: usize,
}

/// The finest level whose cells are reported as progress.
const TOLD: u8 = 4;

impl<S: Counted, R: Worker> Walk<'_, S, R> {
    /// Takes in a cell, and reports it as progress.
    fn cell(&mut self, cell: Cell, solid: Verdict<S::Part>, region: Verdict<R::Part>) -> Result<(), Error> {
        self.take(cell, solid, region)?;
        self.tell(cell);
        Ok(())
    }

    /// Reports the cells up to this one, in Morton order. Finer cells are not reported.
    fn tell(&mut self, cell: Cell) {
        if cell.level <= TOLD {
            let place = (0..cell.level).fold(0, |place, level| {
                let octant = (0..3).fold(0, |octant, axis| octant | (cell.at[axis] >> level & 1) << axis);
                place | (octant as usize) << (3 * level)
            });
            let done = (place + 1) * (WHOLE >> (3 * cell.level));
            self.job.advance(done - self.told.min(done));
            self.told = self.told.max(done);
        }
    }

    /// Takes in a cell. The recursion is as deep as the frame, 20 levels at the most.
    fn take(&mut self, cell: Cell, solid: Verdict<S::Part>, region: Verdict<R::Part>) -> Result<(), Error> {
        let height = self.depth - cell.level;
        let cells = 1u64 << (3 * height);
        match (&solid, &region) {
            (Verdict::Empty, _) | (_, Verdict::Empty) => return Ok(()),
            (Verdict::Partial(part), Verdict::Full) => {
                if let Some([full, partial]) = self.solid.below(cells, part) {
                    self.add(Tag::Full, Tag::Full, full);
                    self.add(Tag::Partial, Tag::Full, partial);
                    return Ok(());
                }
            }
            (Verdict::Partial(_), _) | (_, Verdict::Partial(_)) => {}
            (solid, region) => {
                self.add(solid.tag(), region.tag(), cells);
                return Ok(());
            }
        }
        if height == 0 || self.left == 0 {
            if height > 0 && matches!(solid, Verdict::Partial(_)) {
                self.sums.add_unknown(cells);
            } else {
                self.sums.add(solid.tag(), region.tag(), cells);
            }
            return self.add_cut(cell, cells, &solid, &region);
        }
        self.job.check()?;
        let marks = (self.solid.mark(), self.region.mark());
        if self.by_eight || height % 2 == 1 {
            self.eight(cell, &solid, &region)?;
        } else {
            let parts = (self.solid_parts.len(), self.region_parts.len());
            self.block(cell, &solid, &region)?;
            self.solid_parts.truncate(parts.0);
            self.region_parts.truncate(parts.1);
        }
        self.solid.release(marks.0);
        self.region.release(marks.1);
        Ok(())
    }

    /// Takes in the children of a cell.
    fn eight(
        &mut self,
        cell: Cell,
        solid: &Verdict<S::Part>,
        region: &Verdict<R::Part>,
    ) -> Result<(), Error> {
        let of_solid = children(&mut self.solid, cell, solid, &mut self.left, self.job)?;
        let of_region = children(&mut self.region, cell, region, &mut self.left, self.job)?;
        for (octant, (solid, region)) in (0..8).zip(of_solid.into_iter().zip(of_region)) {
            self.cell(cell.child(octant), solid, region)?;
        }
        Ok(())
    }

    /// Takes in the 64 grandchildren of a cell.
    fn block(
        &mut self,
        cell: Cell,
        solid: &Verdict<S::Part>,
        region: &Verdict<R::Part>,
    ) -> Result<(), Error> {
        let (mut s, mut r) = (self.solid_parts.len(), self.region_parts.len());
        let of_solid = grandchildren(&mut self.solid, cell, solid, &mut self.solid_parts)?;
        let of_region = grandchildren(&mut self.region, cell, region, &mut self.region_parts)?;
        let is_last = cell.level + 2 == self.depth;
        let both = !of_solid.empty() & !of_region.empty();
        // Cells with a part that provides more: for the finest cells, the volume.
        let mut open = 0;
        if !is_last || self.sums.has_volume() {
            let own = self.solid_parts[s..].iter().map(|(c, _)| *c);
            own.chain(self.region_parts[r..].iter().map(|(c, _)| *c)).for_each(|c| open |= 1u64 << (c & 63));
        }
        open &= both;
        let shift = 3 * (self.depth - cell.level - 2);
        for (solid, of_solid) in [(Tag::Full, of_solid.full()), (Tag::Partial, of_solid.partial())] {
            for (region, of_region) in [(Tag::Full, of_region.full()), (Tag::Partial, of_region.partial())] {
                let cells = of_solid & of_region & !open;
                self.add(solid, region, u64::from(cells.count_ones()) << shift);
            }
        }
        while open != 0 {
            let c = open.trailing_zeros() as u8;
            open &= open - 1;
            let solid = verdict(of_solid, c, &self.solid_parts, &mut s);
            let region = verdict(of_region, c, &self.region_parts, &mut r);
            self.cell(cell.child(c >> 3).child(c & 7), solid, region)?;
        }
        Ok(())
    }

    /// Adds cells of which only the tags are known.
    #[inline(always)]
    fn add(&mut self, solid: Tag, region: Tag, cells: u64) {
        self.sums.add(solid, region, cells);
        let is_whole = solid == Tag::Full && region == Tag::Full;
        self.sums.add_share(if is_whole { Share::WHOLE } else { Share::UNKNOWN }, cells);
    }

    /// Adds the volume of a cell that is not split any further.
    fn add_cut(
        &mut self,
        cell: Cell,
        cells: u64,
        solid: &Verdict<S::Part>,
        region: &Verdict<R::Part>,
    ) -> Result<(), Error> {
        if self.sums.has_volume() {
            let share = share(&mut self.solid, cell, solid)?.common(share(&mut self.region, cell, region)?);
            self.sums.add_share(share, cells);
        }
        Ok(())
    }
}

/// Returns the verdicts of a cell's children: the cell's own verdict for each, if the cell cannot be split.
fn children<W: Worker>(
    worker: &mut W,
    cell: Cell,
    verdict: &Verdict<W::Part>,
    left: &mut u64,
    job: &Job<'_>,
) -> Result<[Verdict<W::Part>; 8], Error> {
    Ok(match verdict {
        Verdict::Empty => [const { Verdict::Empty }; 8],
        Verdict::Full => [const { Verdict::Full }; 8],
        Verdict::Undecided => [const { Verdict::Undecided }; 8],
        Verdict::Partial(part) => {
            *left = left.saturating_sub(1);
            split_one(worker, cell, part, job.control())?
        }
    })
}

/// Returns the verdicts two levels below, like [`children`].
fn grandchildren<W: Worker>(
    worker: &mut W,
    cell: Cell,
    verdict: &Verdict<W::Part>,
    parts: &mut Vec<(u8, W::Part)>,
) -> Result<Planes, Error> {
    match verdict {
        Verdict::Partial(part) => worker.split64(cell, part, parts),
        verdict => Ok(Planes::uniform(verdict.tag())),
    }
}

/// Returns the verdict of cell `c` of a block. `next` is the index of the block's first part that was not met
/// before; it never belongs to an earlier cell.
fn verdict<P: Clone>(planes: Planes, c: u8, parts: &[(u8, P)], next: &mut usize) -> Verdict<P> {
    match planes.tag(c.into()) {
        Tag::Empty => Verdict::Empty,
        Tag::Full => Verdict::Full,
        Tag::Partial | Tag::Branch => {
            while parts.get(*next).is_some_and(|part| part.0 < c) {
                *next += 1;
            }
            match parts.get(*next) {
                Some((place, part)) if *place == c => Verdict::Partial(part.clone()),
                _ => Verdict::Undecided,
            }
        }
    }
}

/// Returns the volume that a worker provides for a cell.
fn share<W: Worker>(worker: &mut W, cell: Cell, verdict: &Verdict<W::Part>) -> Result<Share, Error> {
    Ok(match verdict {
        Verdict::Full => Share::WHOLE,
        Verdict::Partial(part) => match worker.moments(cell, part)? {
            Some(moments) => Share::of_moments(&moments),
            None => worker.enclosure(cell, part)?.map_or(Share::UNKNOWN, |known| Share::of_enclosure(&known)),
        },
        // (An EMPTY cell adds nothing, and is not queried.)
        Verdict::Empty | Verdict::Undecided => Share::UNKNOWN,
    })
}
