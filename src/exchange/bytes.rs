//! Binary numbers of either byte order, taken from the front.

use super::is_space;
use crate::error::MeshFileError;

/// The expectation in the error for a file that ends too early.
pub(super) const TOO_SHORT: &str = "more data: the file is shorter than its header says";
/// The expectation in the error for a file that is too long.
pub(super) const TOO_LONG: &str = "the end of the file: it is longer than its header says";

/// A partly consumed file. Its numbers are big-endian if `BIG`.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a, const BIG: bool> {
    all: &'a [u8],
    rest: &'a [u8],
}

impl<'a, const BIG: bool> Bytes<'a, BIG> {
    /// Makes a reader of the file after the first `taken` bytes.
    pub fn new(all: &'a [u8], taken: usize) -> Self {
        Self { all, rest: all.get(taken..).unwrap_or(&[]) }
    }

    /// Returns the bytes that are left.
    #[inline]
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    #[inline]
    pub fn take(&mut self, length: u64) -> Result<&'a [u8], MeshFileError> {
        let taken = usize::try_from(length).ok().and_then(|length| self.rest.split_at_checked(length));
        let (taken, rest) = taken.ok_or_else(|| self.too_short())?;
        self.rest = rest;
        Ok(taken)
    }

    /// Takes the bytes of a number and returns them in little-endian order.
    #[inline]
    pub fn number<const N: usize>(&mut self) -> Result<[u8; N], MeshFileError> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>().ok_or_else(|| self.too_short())?;
        self.rest = rest;
        Ok(Self::in_order(*bytes))
    }

    /// Returns a number's bytes in little-endian order.
    #[inline]
    pub fn in_order<const N: usize>(mut bytes: [u8; N]) -> [u8; N] {
        if BIG {
            bytes.reverse();
        }
        bytes
    }

    /// Takes the end of the file. Padding may precede it.
    pub fn end(&self) -> Result<(), MeshFileError> {
        if self.rest.iter().all(|&byte| is_space(byte) || matches!(byte, 0 | 0x1A)) {
            Ok(())
        } else {
            Err(self.error(TOO_LONG))
        }
    }

    /// Returns the error that something else was expected at the current byte.
    #[cold]
    pub fn error(&self, expected: &'static str) -> MeshFileError {
        MeshFileError::Binary { offset: (self.all.len() - self.rest.len()) as u64, expected }
    }

    /// Returns the error that the index at `ahead` bytes from here refers to no vertex.
    #[cold]
    pub fn index_error(&self, ahead: usize, index: i64, vertices: u64) -> MeshFileError {
        let offset = (self.all.len() - self.rest.len() + ahead) as u64;
        MeshFileError::BinaryIndex { offset, index, vertices }
    }

    #[cold]
    fn too_short(&self) -> MeshFileError {
        MeshFileError::Binary { offset: self.all.len() as u64, expected: TOO_SHORT }
    }
}
