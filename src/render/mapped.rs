//! Building lists item by item in parallel.

use crate::control::Job;
use crate::error::Error;
use crate::memory;
use crate::parallel;
use alloc::vec::Vec;

/// The number of items between two checks for cancellation.
const BLOCK: usize = 1 << 19;

/// The number of items up to which threads do not pay.
const WORTH: usize = 1 << 14;

/// Returns the results of `make` for 0, 1, 2 … `count` − 1.
pub fn mapped<T: Send>(
    job: &Job<'_>,
    count: usize,
    make: impl Fn(usize) -> T + Send + Sync,
) -> Result<Vec<T>, Error> {
    job.control().run(count > WORTH, |parallel| {
        let mut list = memory::with_capacity(count)?;
        for start in (0..count).step_by(BLOCK) {
            job.check()?;
            parallel::extend(parallel, &mut list, start..count.min(start + BLOCK), || (), |(), i| make(i));
        }
        Ok(list)
    })
}
