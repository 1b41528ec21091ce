//! Files in memory that belong to the system.

use crate::error::{Error, FormatError};
use memmap2::Mmap;
use std::fs::File;
use std::path::Path;

/// The file at `path` in memory; `None` if it is empty.
///
/// # Safety
/// As [`file::map`](super::map()).
#[allow(unsafe_code)]
pub(super) unsafe fn mapping(path: &Path) -> Result<Option<Mmap>, Error> {
    // Asked before opening, because opening a pipe that nobody writes to would wait.
    if !std::fs::metadata(path)?.is_file() {
        return Err(FormatError::NotRegular.into());
    }
    let file = File::open(path)?;
    if file.metadata()?.len() == 0 {
        return Ok(None);
    }
    // SAFETY: the caller promises that the file is not changed while the mapping lives.
    Ok(Some(unsafe { Mmap::map(&file) }?))
}
