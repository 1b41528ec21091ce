//! Files read into memory.

#[cfg(feature = "std")]
use super::header::{HEADER_LENGTH, Head};
use crate::error::Error;
#[cfg(feature = "std")]
use crate::error::FormatError;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::{fs::File, io::Read, path::Path};

/// A file in memory that begins at an address that is a multiple of 8.
#[derive(Default)]
pub(super) struct Buffer {
    words: Vec<u64>,
    length: usize,
}

impl Buffer {
    /// Returns a copy of `bytes`.
    pub fn copy(bytes: &[u8]) -> Result<Buffer, Error> {
        let mut buffer = Buffer::default();
        buffer.extend(bytes.len())?;
        buffer.bytes_mut().copy_from_slice(bytes);
        Ok(buffer)
    }

    /// Grows to `length` bytes; new bytes are zero.
    fn extend(&mut self, length: usize) -> Result<(), Error> {
        let words = length.div_ceil(size_of::<u64>());
        let fresh = words.saturating_sub(self.words.len());
        self.words.try_reserve_exact(fresh)?;
        self.words.resize(words.max(self.words.len()), 0);
        self.length = length;
        Ok(())
    }

    pub fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }

    pub fn bytes_mut(&mut self) -> &mut [u8] {
        &mut bytemuck::cast_slice_mut(&mut self.words)[..self.length]
    }
}

impl AsRef<[u8]> for Buffer {
    fn as_ref(&self) -> &[u8] {
        self.bytes()
    }
}

/// Reads the whole file at `path`, if `wanted` accepts its header.
#[cfg(feature = "std")]
pub(super) fn read(
    path: &Path,
    wanted: impl FnOnce(&Head) -> Result<(), FormatError>,
) -> Result<Buffer, Error> {
    let mut file = File::open(path)?;
    let known = regular_length(&file)?;
    let mut start = Vec::new();
    file.by_ref().take(HEADER_LENGTH as u64).read_to_end(&mut start)?;
    let head = Head::read(&start)?;
    wanted(&head)?;
    let expected = head.header.file_length;
    match known {
        Some(found) if found != expected => return Err(FormatError::Length { expected, found }.into()),
        _ => {}
    }
    let length = usize::try_from(expected).map_err(|_| Error::OutOfMemory)?;
    let mut buffer = Buffer::default();
    let mut filled = start.len();
    // If the length is not known beforehand, memory is only allocated as bytes arrive.
    let most = |filled: usize| if known.is_some() { length } else { filled.saturating_mul(2).max(1 << 16) };
    buffer.extend(length.min(most(0)))?;
    // The header's file is longer than the header.
    buffer.bytes_mut()[..filled].copy_from_slice(&start);
    while filled < length {
        if filled == buffer.length {
            buffer.extend(length.min(most(filled)))?;
        }
        match file.read(&mut buffer.bytes_mut()[filled..]) {
            Ok(0) => return Err(FormatError::Length { expected, found: filled as u64 }.into()),
            Ok(count) => filled += count,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error.into()),
        }
    }
    if file.take(1).read_to_end(&mut start)? != 0 {
        return Err(FormatError::Length { expected, found: expected + 1 }.into());
    }
    Ok(buffer)
}

/// Returns the length of a regular file; `None` for a pipe or device.
#[cfg(feature = "std")]
pub(super) fn regular_length(file: &File) -> Result<Option<u64>, Error> {
    let metadata = file.metadata()?;
    Ok(metadata.is_file().then_some(metadata.len()))
}
