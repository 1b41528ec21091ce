//! Work on the slices of an array, by several threads.

use crate::control::Control;
use crate::error::Error;

/// Does `work` on each slice of `length` elements, with its index. The last may be shorter.
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
        #[cfg(feature = "parallel")]
        if parallel {
            use rayon::prelude::*;
            return values.par_chunks_mut(length).enumerate().try_for_each(work);
        }
        let _ = parallel;
        values.chunks_mut(length).enumerate().try_for_each(work)
    })
}
