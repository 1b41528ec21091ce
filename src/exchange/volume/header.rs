//! The contents of a volume file's header, independent of the format.

use super::super::LengthUnit;
use super::kind::SampleKind;
use super::place::Axes;
use crate::error::{Error, VolumeFileError};
use crate::memory;
use alloc::string::String;

/// The encoding of the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Raw,
    /// Compressed by DEFLATE.
    Deflated,
    Text,
}

/// The data to skip before the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Skip {
    Bytes(u64),
    /// All data in excess of the samples.
    Rest,
}

/// The location of the samples.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Place {
    /// In the same file, from this byte on.
    Here(usize),
    /// In the file with this name.
    There(String),
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) extents: [u32; 3],
    pub(super) kind: SampleKind,
    pub(super) big: bool,
    pub(super) encoding: Encoding,
    /// Number of lines of the data file to skip first.
    pub(super) lines: u64,
    pub(super) skip: Skip,
    /// True if the data to skip precedes the compressed bytes, and is not part of them.
    pub(super) skips_compressed: bool,
    /// Number of compressed bytes, if the header states it.
    pub(super) compressed: Option<u64>,
    pub(super) place: Place,
    pub(super) axes: Axes,
    pub(super) unit: Option<LengthUnit>,
}

/// A line of a header with its value.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    pub(super) number: u64,
    pub(super) value: &'a str,
}

impl<'a> Line<'a> {
    /// Returns the error that the line has an invalid value.
    pub(super) fn error(&self, expected: &'static str) -> VolumeFileError {
        VolumeFileError::Syntax { line: self.number, expected }
    }

    /// Parses `N` whole numbers from 0, separated by blanks.
    pub(super) fn whole<const N: usize>(&self, expected: &'static str) -> Result<[u64; N], Error> {
        self.each(expected, |word| word.parse().ok())
    }

    fn each<T: Copy + Default, const N: usize>(
        &self,
        expected: &'static str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> Result<[T; N], Error> {
        let mut words = self.value.split_ascii_whitespace();
        let mut found = [T::default(); N];
        for place in &mut found {
            *place = words.next().and_then(&parse).ok_or_else(|| self.error(expected))?;
        }
        if words.next().is_some() {
            return Err(self.error(expected).into());
        }
        Ok(found)
    }

    /// Returns a copy of the value.
    pub(super) fn text(&self) -> Result<String, Error> {
        memory::text(self.value)
    }
}

/// Parses a finite number.
pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|x: &f64| x.is_finite())
}

/// Returns the extents of a file's axes. If there are more than three axes, those with one sample are
/// dropped.
pub(super) fn extents(sizes: &[u64], line: &Line<'_>) -> Result<([u32; 3], [usize; 3]), Error> {
    let wrong = || Error::from(line.error("three sizes from 1 to 2^20, and no other above 1"));
    let (mut extents, mut axes, mut count) = ([1; 3], [usize::MAX; 3], 0);
    for (axis, &size) in sizes.iter().enumerate() {
        let left = sizes.len() - axis;
        if size == 1 && count + left > 3 {
            continue;
        }
        let (Some(extent), Some(place)) = (extents.get_mut(count), axes.get_mut(count)) else {
            return Err(wrong());
        };
        *extent = u32::try_from(size).ok().filter(|size| (1..=1 << 20).contains(size)).ok_or_else(wrong)?;
        *place = axis;
        count += 1;
    }
    if count == 0 { Err(wrong()) } else { Ok((extents, axes)) }
}

/// The lines of a text up to the one for which `is_last` is true, with their numbers, and the number of bytes
/// taken.
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    pub(super) taken: usize,
    pub(super) number: u64,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Lines<'a> {
        Lines { bytes, taken: 0, number: 0 }
    }

    /// Returns the next line without its end; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.taken..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&byte| byte == b'\n');
        let line = &rest[..length.unwrap_or(rest.len())];
        self.taken += length.map_or(rest.len(), |length| length + 1);
        self.number += 1;
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }
}
