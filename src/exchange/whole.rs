//! All bytes of a file, if it ends.

use crate::error::Error;
use alloc::vec::Vec;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Most bytes of what is no regular file: a pipe or a device does not say how long it is, and may have no
/// end.
const STREAM: u64 = 1 << 30;

/// The bytes of a file.
///
/// # Errors
/// [`Error::Io`], [`Error::OutOfMemory`]; [`Error::Limit`] for what is no regular file and goes on after 1
/// GiB.
pub fn read_whole(path: &Path) -> Result<Vec<u8>, Error> {
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    let mut bytes = Vec::new();
    if metadata.is_file() {
        bytes.try_reserve_exact(usize::try_from(metadata.len()).unwrap_or(usize::MAX))?;
        (&file).read_to_end(&mut bytes)?;
        return Ok(bytes);
    }
    file.take(STREAM + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > STREAM {
        return Err(Error::Limit { what: "bytes", limit: STREAM });
    }
    Ok(bytes)
}
