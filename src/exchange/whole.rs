//! Reading of whole files, limited for pipes and devices.

use crate::error::Error;
use alloc::vec::Vec;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Maximum number of bytes of a pipe or a device, whose length is unknown and may be infinite.
const STREAM: u64 = 1 << 30;

/// Returns the bytes of a file.
///
/// # Errors
/// [`Error::Io`], [`Error::OutOfMemory`]; [`Error::Limit`] for a pipe or a device with more than 1 GiB.
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
