//! Binary numbers of either byte order, taken from the front.

use super::is_space;
use crate::error::MeshFileError;

/// What was expected where a file ends.
pub(super) const TOO_SHORT: &str = "more data: the file is shorter than its header says";
/// What was expected where a file goes on.
pub(super) const TOO_LONG: &str = "the end of the file: it is longer than its header says";

/// A file whose numbers have the most significant byte first if `BIG`, and of which a part has been taken.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a, const BIG: bool> {
    all: &'a [u8],
    rest: &'a [u8],
}

impl<'a, const BIG: bool> Bytes<'a, BIG> {
    /// The file from behind the first `taken` bytes.
    pub fn new(all: &'a [u8], taken: usize) -> Self {
        Self { all, rest: all.get(taken..).unwrap_or(&[]) }
    }

    /// What has not been taken yet.
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

    /// Takes the bytes of a number, which come in little-endian order.
    #[inline]
    pub fn number<const N: usize>(&mut self) -> Result<[u8; N], MeshFileError> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>().ok_or_else(|| self.too_short())?;
        self.rest = rest;
        Ok(Self::in_order(*bytes))
    }

    /// A number's bytes in little-endian order.
    #[inline]
    pub fn in_order<const N: usize>(mut bytes: [u8; N]) -> [u8; N] {
        if BIG {
            bytes.reverse();
        }
        bytes
    }

    /// Takes the end of the file, before which there may be padding.
    pub fn end(&self) -> Result<(), MeshFileError> {
        if self.rest.iter().all(|&byte| is_space(byte) || matches!(byte, 0 | 0x1A)) {
            Ok(())
        } else {
            Err(self.error(TOO_LONG))
        }
    }

    /// The error that something else than what comes next was expected.
    #[cold]
    pub fn error(&self, expected: &'static str) -> MeshFileError {
        MeshFileError::Binary { offset: (self.all.len() - self.rest.len()) as u64, expected }
    }

    /// The error that the index that stands `ahead` bytes ahead is one of no vertex.
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
