//! Assembles models from rows of rays, in one canonical form: the window of each direction is the least that
//! contains all rays that are not empty.

use super::arrays::RowArrays;
use super::columns::Columns;
use super::format::DexelFormat;
use super::item::Item;
use super::place::Span;
use super::view::{RowsRef, Window};
use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// Consecutive whole rows of a window.
#[derive(Debug)]
pub(crate) struct Piece<S> {
    /// For each ray, the index of its first interval; then the number of all intervals.
    starts: Vec<u32>,
    pub columns: Columns<S>,
}

impl<S: Span> Piece<S> {
    /// Makes an empty piece, with room for `rays` rays.
    pub fn new(format: &DexelFormat, rays: usize) -> Result<Piece<S>, Error> {
        let mut starts = memory::with_capacity(rays + 1)?;
        starts.push(0);
        Ok(Piece { starts, columns: Columns::new(format) })
    }

    /// The index of the next ray's first interval.
    #[inline(always)]
    pub fn begin(&self) -> usize {
        self.starts.last().map_or(0, |&start| start as usize)
    }

    /// Ends a ray. It consists of all intervals that were added since the previous ray.
    #[inline(always)]
    pub fn end_ray(&mut self) -> Result<(), Error> {
        // (`assembled` rejects a number that is too large for u32.)
        memory::push(&mut self.starts, self.columns.spans.len() as u32)
    }

    /// Appends rays without intervals.
    pub fn skip(&mut self, rays: usize) -> Result<(), Error> {
        self.starts.try_reserve(rays)?;
        self.starts.resize(self.starts.len() + rays, self.begin() as u32);
        Ok(())
    }

    /// Appends rays unchanged, given by their indices in the window of rows that were checked.
    pub fn copy(&mut self, from: &RowsRef<'_, S>, rays: Range<usize>) -> Result<(), Error> {
        let base = self.columns.spans.len() as u32;
        let starts = &from.starts[rays.start..=rays.end];
        let (first, end) = (starts[0], starts[rays.len()]);
        self.starts.try_reserve(rays.len())?;
        self.starts.extend(starts[1..].iter().map(|&start| base + (start - first)));
        self.columns.copy(&from.columns, first as usize..end as usize)
    }

    /// Appends an interval to the current ray, unless the interval is empty. An interval that touches the
    /// previous one is joined to it, unless both have materials that differ.
    #[inline]
    pub fn add(&mut self, item: &Item<S::Place>) -> Result<(), Error> {
        if item.ends[0] >= item.ends[1] {
            return Ok(());
        }
        let first = self.begin();
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

    /// Concatenates consecutive pieces.
    fn concatenated(format: &DexelFormat, mut pieces: Vec<Piece<S>>) -> Result<Piece<S>, Error> {
        if pieces.len() == 1 {
            return Ok(pieces.swap_remove(0));
        }
        let mut all = Piece::new(format, pieces.iter().map(|piece| piece.starts.len() - 1).sum())?;
        all.columns.reserve(pieces.iter().map(|piece| piece.columns.spans.len()).sum(), true)?;
        for piece in pieces {
            let base = all.columns.spans.len() as u32;
            all.starts.extend(piece.starts[1..].iter().map(|&start| base + start));
            all.columns.copy(&piece.columns.view(), 0..piece.columns.spans.len())?;
        }
        Ok(all)
    }

    /// Removes the rays outside the least window that contains all rays that are not empty.
    fn trim(&mut self, window: Window) -> Window {
        let starts = &mut self.starts;
        let trimmed = least(window, starts);
        if trimmed != window {
            // The removed rays are empty, so that the indices of intervals do not change.
            let (mut to, width) = (0, trimmed.size[0] as usize);
            for row in trimmed.range(1) {
                if let Some(from) = window.index([trimmed.first[0], row]) {
                    starts.copy_within(from..from + width, to);
                    to += width;
                }
            }
            starts.truncate(to);
            starts.push(self.columns.spans.len() as u32);
        }
        trimmed
    }
}

/// Assembles the rays of a window from consecutive pieces.
///
/// # Errors
/// [`Error::Limit`] for 2^32 rays or intervals, and [`Error::OutOfMemory`].
pub(crate) fn assembled<S: Span>(
    window: Window,
    format: &DexelFormat,
    pieces: Vec<Piece<S>>,
) -> Result<RowArrays<S>, Error> {
    const MOST: u64 = u32::MAX as u64 - 1;
    let intervals = pieces.iter().map(|piece| piece.columns.spans.len() as u64).sum::<u64>();
    if intervals > MOST {
        return Err(Error::Limit { what: "intervals in one direction", limit: MOST });
    }
    let mut piece = Piece::concatenated(format, pieces)?;
    let window = piece.trim(window);
    if window.count() > MOST {
        return Err(Error::Limit { what: "rays in one direction", limit: MOST });
    }
    Ok(RowArrays { window, starts: piece.starts, columns: piece.columns })
}

/// The least window that contains all rays that are not empty.
fn least(window: Window, starts: &[u32]) -> Window {
    let width = window.size[0] as usize;
    let (mut low, mut high) = (width, 0);
    let mut along: Option<Range<u32>> = None;
    for (row, first) in window.range(1).zip((0..).step_by(width.max(1))) {
        let starts = &starts[first..=first + width];
        let (before, after) = (starts[0], starts[width]);
        if before < after {
            low = starts[1..=low].iter().position(|&start| start != before).unwrap_or(low);
            high = high.max(starts.iter().rposition(|&start| start != after).map_or(0, |last| last + 1));
            along = Some(along.map_or(row, |along| along.start)..row + 1);
        }
    }
    let Some(along) = along else { return Window::default() };
    Window::of([window.first[0] + low as u32..window.first[0] + high as u32, along])
}
