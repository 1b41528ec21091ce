//! Fills a channel from any source of values.

use super::source::{Known, Source};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::channel::writer::{Cells, ChannelWriter, Filled};
use crate::octree::view::{element_levels, starts_half_way};
use crate::octree::{Channel, Metadata, ValueType};
use crate::parallel::each;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Fills a channel with all values of `source` on the lattice of `frame`. The result has the same bits for
/// any number of threads.
pub(super) fn fill<S: Source>(
    source: &S,
    frame: &Frame,
    value_type: ValueType,
    control: &Control<'_>,
) -> Result<Channel, Error> {
    let job = Job::new(control);
    job.check()?;
    let levels = element_levels(frame.depth());
    let advanced = AtomicUsize::new(0);
    let (root, writer) = control.run(levels > 2, |parallel| {
        let mut writer = ChannelWriter::new(&job, frame.depth(), value_type)?;
        let filler = Filler { source, frame: *frame, levels, parallel, advanced: &advanced };
        let root = match source.root()? {
            Known::Free => Filled::Free,
            Known::Settled(value) => Filled::Settled(value),
            Known::Open(part) => filler.cell(0, Cell::ROOT, &part, &mut writer)?,
        };
        Ok::<_, Error>((root, writer))
    })?;
    let channel = writer.finish(*frame, root, Metadata::new())?;
    job.advance(WHOLE.saturating_sub(advanced.into_inner()));
    Ok(channel)
}

struct Filler<'s, S> {
    source: &'s S,
    frame: Frame,
    levels: usize,
    #[cfg_attr(not(feature = "parallel"), allow(dead_code))]
    parallel: bool,
    /// The parts of the whole that were reported as done.
    advanced: &'s AtomicUsize,
}

/// The share of a cell of the root element in the progress.
const PART: usize = WHOLE / 64;

/// The open cells of an element, each with its place in the element.
type Open<P> = Vec<(usize, Cell, P)>;

impl<S: Source> Filler<'_, S> {
    /// Writes everything below an open cell, which element level `e` describes.
    fn cell(
        &self,
        e: usize,
        cell: Cell,
        part: &S::Part,
        writer: &mut ChannelWriter<'_>,
    ) -> Result<Filled, Error> {
        writer.job().check()?;
        let mut cells: Cells = [Filled::Free; 64];
        let mut open: Open<S::Part> = Vec::new();
        let children = self.source.split(cell, part)?;
        for (known, k) in children.into_iter().zip(0..) {
            let child = cell.child(k);
            if e == 0 && starts_half_way(self.frame.depth()) {
                note(known, k.into(), child, &mut cells, &mut open)?;
                continue;
            }
            match known {
                Known::Free => {}
                Known::Settled(value) => {
                    cells[8 * k as usize..][..8].fill(Filled::Settled(value));
                }
                Known::Open(part) => {
                    for (known, j) in self.source.split(child, &part)?.into_iter().zip(0..) {
                        let place = 8 * k as usize + j as usize;
                        note(known, place, child.child(j), &mut cells, &mut open)?;
                    }
                }
            }
        }
        if e + 1 == self.levels {
            self.settle(open, &mut cells)?;
        } else {
            self.descend(e, open, &mut cells, writer)?;
        }
        writer.put(e, &cells)
    }

    /// Reports a cell of an element of level `e` as done.
    fn advance(&self, e: usize, writer: &ChannelWriter<'_>) {
        if e == 0 {
            self.advanced.fetch_add(PART, Relaxed);
            writer.job().advance(PART);
        }
    }

    fn settle(&self, open: Open<S::Part>, cells: &mut Cells) -> Result<(), Error> {
        let mut values = [None; 64];
        let places: Vec<usize> = memory::collected(open.iter().map(|&(place, ..)| place))?;
        let mut asked = memory::with_capacity(open.len())?;
        asked.extend(open.into_iter().map(|(_, cell, part)| (cell, part)));
        self.source.settle(&asked, &mut values[..asked.len()])?;
        for (place, &value) in places.into_iter().zip(&values) {
            cells[place] = Filled::Settled(value);
        }
        Ok(())
    }

    fn descend(
        &self,
        e: usize,
        open: Open<S::Part>,
        cells: &mut Cells,
        writer: &mut ChannelWriter<'_>,
    ) -> Result<(), Error> {
        if self.parallel && e < 2 && open.len() > 1 {
            let from = &*writer;
            let done = each(true, open.into_iter(), |(place, cell, part)| {
                let mut own = from.sibling()?;
                let filled = self.cell(e + 1, cell, &part, &mut own)?;
                self.advance(e, &own);
                Ok((place, filled, own))
            });
            for (place, filled, own) in done? {
                cells[place] = filled;
                writer.append(own)?;
            }
            return Ok(());
        }
        for (place, cell, part) in open {
            cells[place] = self.cell(e + 1, cell, &part, writer)?;
            self.advance(e, writer);
        }
        Ok(())
    }
}

fn note<P>(
    known: Known<P>,
    place: usize,
    cell: Cell,
    cells: &mut Cells,
    open: &mut Open<P>,
) -> Result<(), Error> {
    match known {
        Known::Free => {}
        Known::Settled(value) => cells[place] = Filled::Settled(value),
        Known::Open(part) => memory::push(open, (place, cell, part))?,
    }
    Ok(())
}
