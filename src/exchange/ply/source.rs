//! Sources of element values: ASCII or binary.

use alloc::vec::Vec;

use super::indices::Indices;
use super::number_kind::NumberKind;
use crate::error::{Error, MeshFileError};

/// A source of element values.
pub(super) trait Source: Copy {
    /// Returns the error that something else was expected at the current place.
    fn error(&self, expected: &'static str) -> MeshFileError;

    /// Returns an upper bound of the number of elements that may follow, if each has at least `values` values
    /// and `bytes` bytes.
    fn at_most(&self, values: usize, bytes: usize) -> usize;

    /// Takes a finite number.
    fn coordinate(&mut self, kind: NumberKind) -> Result<f64, MeshFileError>;

    /// Takes any text or bytes of a number; `None` if the number is not finite.
    fn value(&mut self, kind: NumberKind) -> Result<Option<f64>, MeshFileError>;

    /// Takes the length of a list.
    fn count(&mut self, kind: NumberKind) -> Result<u64, MeshFileError>;

    /// Skips numbers of any value: `values` of them, in `bytes` bytes.
    fn skip(&mut self, values: u64, bytes: u64) -> Result<(), MeshFileError>;

    /// Takes `count` indices below `vertices`; in a strip also -1, which becomes the greatest `u32`.
    fn indices(&mut self, out: &mut Vec<u32>, count: u64, of: &Indices, vertices: u64) -> Result<(), Error>;

    /// Takes the end of an element that began at `start`, after skipping `more` values that the header does
    /// not announce. `None`: any number of such values, all on the line where the element began. Returns
    /// their number.
    fn end_element(&mut self, start: &Self, more: Option<u64>) -> Result<u64, MeshFileError>;

    /// Returns the current line.
    fn line(&self) -> u64;

    /// Takes the end of the file.
    fn end_file(&mut self) -> Result<(), MeshFileError>;
}
