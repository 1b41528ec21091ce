//! Models from rows of rays, in one canonical form: the window of each direction is the least that holds the rays that
//! are not empty.

use super::arrays::RowArrays;
use super::columns::Columns;
use super::format::DexelFormat;
use super::item::Item;
use super::place::Span;
use super::view::Window;
use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// Consecutive whole rows of a window: how many intervals each ray has, and these.
#[derive(Debug)]
pub(crate) struct Piece<S> {
    pub counts: Vec<u32>,
    pub columns: Columns<S>,
}

impl<S: Span> Piece<S> {
    pub fn new(format: &DexelFormat) -> Piece<S> {
        Piece { counts: Vec::new(), columns: Columns::new(format) }
    }

    /// Appends an interval of the ray whose intervals begin at the one numbered `first`: nothing if it is empty; one that
    /// touches the interval before is joined to that, unless both have materials that differ.
    #[inline]
    pub fn add(&mut self, first: usize, item: &Item<S::Place>) -> Result<(), Error> {
        if item.ends[0] >= item.ends[1] {
            return Ok(());
        }
        let columns = &mut self.columns;
        if let Some(last) = columns.spans.len().checked_sub(1).filter(|&last| last >= first)
            && columns.spans[last].ends()[1] >= item.ends[0]
        {
            let mut joined = columns.view().item(last);
            if columns.materials.is_none() || joined.material == item.material {
                (joined.ends[1], joined.marks[1]) = (item.ends[1], item.marks[1]);
                columns.set(last, &joined);
                return Ok(());
            }
        }
        columns.push(item)
    }
}

/// The rays of a window from pieces that follow on one another.
///
/// # Errors
/// [`Error::Limit`] for 2^32 rays or intervals, and [`Error::OutOfMemory`].
pub(crate) fn assembled<S: Span>(
    window: Window,
    format: &DexelFormat,
    mut pieces: Vec<Piece<S>>,
) -> Result<RowArrays<S>, Error> {
    const MOST: u64 = u32::MAX as u64 - 1;
    let intervals = pieces.iter().map(|piece| piece.columns.spans.len() as u64).sum::<u64>();
    if intervals > MOST {
        return Err(Error::Limit { what: "intervals in one direction", limit: MOST });
    }
    let trimmed = trim(window, &pieces);
    if trimmed.count() > MOST {
        return Err(Error::Limit { what: "rays in one direction", limit: MOST });
    }
    let mut starts = memory::with_capacity(trimmed.count() as usize + 1)?;
    let mut next = 0u32;
    let kept = trimmed.range(0);
    let kept = (kept.start.saturating_sub(window.first[0])) as usize
        ..(kept.end.saturating_sub(window.first[0])) as usize;
    for (row, counts) in rows(window, &pieces) {
        if trimmed.range(1).contains(&row) {
            for &count in &counts[kept.clone()] {
                starts.push(next);
                next += count;
            }
        }
    }
    starts.push(next);
    let columns = if pieces.len() == 1 {
        pieces.swap_remove(0).columns
    } else {
        let mut all = Columns::new(format);
        all.reserve(intervals as usize, true)?;
        for piece in pieces {
            all.copy(&piece.columns.view(), 0..piece.columns.spans.len())?;
        }
        all
    };
    Ok(RowArrays { window: trimmed, starts, columns })
}

/// The rows of pieces, each with its index.
fn rows<S>(window: Window, pieces: &[Piece<S>]) -> impl Iterator<Item = (u32, &[u32])> {
    let width = (window.size[0] as usize).max(1);
    window.range(1).zip(pieces.iter().flat_map(move |piece| piece.counts.chunks_exact(width)))
}

/// The least window that holds the rays that are not empty.
fn trim<S>(window: Window, pieces: &[Piece<S>]) -> Window {
    let (mut low, mut high) = (usize::MAX, 0);
    let mut along: Option<Range<u32>> = None;
    for (row, counts) in rows(window, pieces) {
        if let Some(first) = counts.iter().position(|&count| count > 0) {
            let last = counts.iter().rposition(|&count| count > 0).unwrap_or(first);
            (low, high) = (low.min(first), high.max(last + 1));
            along = Some(along.map_or(row, |along| along.start)..row + 1);
        }
    }
    let Some(along) = along else { return Window::default() };
    Window::of([window.first[0] + low as u32..window.first[0] + high as u32, along])
}
