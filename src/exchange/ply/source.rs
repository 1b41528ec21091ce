//! Where the values of elements come from.

use alloc::vec::Vec;

use super::indices::Indices;
use super::number_kind::NumberKind;
use crate::error::{Error, MeshFileError};

/// Where the values of elements come from.
pub(super) trait Source: Copy {
    /// The error that something else than what comes next was expected.
    fn error(&self, expected: &'static str) -> MeshFileError;

    /// At most how many elements may still come, each of so many `values` or more, of `bytes` together.
    fn at_most(&self, values: usize, bytes: usize) -> usize;

    /// Takes a finite number.
    fn coordinate(&mut self, kind: NumberKind) -> Result<f64, MeshFileError>;

    /// Takes anything that stands for a number; `None` if it is not a finite one.
    fn value(&mut self, kind: NumberKind) -> Result<Option<f64>, MeshFileError>;

    /// Takes the length of a list.
    fn count(&mut self, kind: NumberKind) -> Result<u64, MeshFileError>;

    /// Takes numbers of any values, so many or of so many bytes.
    fn skip(&mut self, values: u64, bytes: u64) -> Result<(), MeshFileError>;

    /// Takes `count` indices below `vertices`; in a strip also -1, which becomes the greatest `u32`.
    fn indices(&mut self, out: &mut Vec<u32>, count: u64, of: &Indices, vertices: u64) -> Result<(), Error>;

    /// Takes the end of an element that began at `start`, and before it so many values that the header does
    /// not announce; `None`: any number, all on the line where the element began. Tells how many there were.
    fn end_element(&mut self, start: &Self, more: Option<u64>) -> Result<u64, MeshFileError>;

    /// Where something stands.
    fn line(&self) -> u64;

    /// Takes the end of the file.
    fn end_file(&mut self) -> Result<(), MeshFileError>;
}
