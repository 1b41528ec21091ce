//! Memory-mapped files.

use crate::error::{Error, FormatError};
use memmap2::Mmap;
use std::fs::File;
use std::path::Path;

/// Maps the file at `path`; `None` if it is empty.
///
/// # Safety
/// The conditions of [`file::map`](super::map()).
#[allow(unsafe_code)]
pub(super) unsafe fn mapping(path: &Path) -> Result<Option<Mmap>, Error> {
    // Checked before opening, because opening a pipe without a writer would wait.
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
