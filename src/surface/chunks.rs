//! Parallel work on chunks of blocks, each writing to its own piece of the output.

use crate::control::Job;
use crate::error::Error;
use crate::memory;
use crate::parallel::each;
use alloc::vec::Vec;
use core::ops::Range;

/// The number of blocks in a chunk.
const CHUNK: usize = 1 << 10;

/// Splits `output` into pieces, one for each chunk of `blocks` blocks; the piece of block i begins at
/// `start(i)`. `work` fills each piece. All pieces together count for `weight` in the progress.
///
/// # Errors
/// The errors of `work`, and [`Error::Cancelled`].
pub(super) fn for_each<T: Send>(
    blocks: usize,
    output: &mut [T],
    start: impl Fn(usize) -> usize,
    weight: usize,
    job: &Job<'_>,
    parallel: bool,
    work: impl Fn(Range<usize>, &mut [T]) -> Result<(), Error> + Sync,
) -> Result<(), Error> {
    let count = blocks.div_ceil(CHUNK);
    // The remainder of the weight after division.
    job.advance(weight.checked_rem(count).unwrap_or(weight));
    let mut pieces: Vec<(Range<usize>, &mut [T])> = memory::with_capacity(count)?;
    let mut rest = output;
    for chunk in 0..count {
        let range = CHUNK * chunk..blocks.min(CHUNK * (chunk + 1));
        let end = if range.end == blocks { rest.len() } else { start(range.end) - start(range.start) };
        let (piece, after) = rest.split_at_mut(end.min(rest.len()));
        pieces.push((range, piece));
        rest = after;
    }
    let done = |(range, piece): (Range<usize>, &mut [T])| {
        job.check()?;
        work(range, piece)?;
        job.advance(weight / count);
        Ok(())
    };
    each(parallel, pieces.into_iter(), done).map(drop)
}

/// Returns the results of `work` for the chunks of `blocks` blocks; all chunks together count for `weight` in
/// the progress.
///
/// # Errors
/// As [`for_each`].
pub(super) fn map<T: Send>(
    blocks: usize,
    weight: usize,
    job: &Job<'_>,
    parallel: bool,
    work: impl Fn(Range<usize>) -> Result<T, Error> + Sync,
) -> Result<Vec<T>, Error> {
    let count = blocks.div_ceil(CHUNK);
    job.advance(weight.checked_rem(count).unwrap_or(weight));
    each(parallel, 0..count, |chunk| {
        job.check()?;
        let made = work(CHUNK * chunk..blocks.min(CHUNK * (chunk + 1)))?;
        job.advance(weight / count);
        Ok(made)
    })
}
