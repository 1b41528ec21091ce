//! Parallel work on the slices of an array.

use crate::control::Control;
use crate::error::Error;
use crate::parallel::each;

/// Calls `work` with the index of each slice of `length` elements, and the slice. The last slice may be
/// shorter.
pub(super) fn in_slices<T: Send>(
    values: &mut [T],
    length: usize,
    control: &Control<'_>,
    work: impl Fn(usize, &mut [T]) -> Result<(), Error> + Send + Sync,
) -> Result<(), Error> {
    let length = length.max(1);
    let work = |(i, slice): (usize, &mut [T])| {
        control.check()?;
        work(i, slice)
    };
    control.run(values.len() > 1 << 12, |parallel| {
        each(parallel, values.chunks_mut(length).enumerate(), work).map(drop)
    })
}
