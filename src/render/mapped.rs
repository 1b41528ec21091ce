//! Lists that are made item by item, on the threads at hand.

use crate::control::Job;
use crate::error::Error;
use crate::memory;
use crate::parallel;
use alloc::vec::Vec;

/// Items between two looks at whether the caller cancelled.
const BLOCK: usize = 1 << 19;

/// Fewer items are not worth starting threads.
const WORTH: usize = 1 << 14;

/// What `make` makes of 0, 1, 2 … `count` − 1.
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
