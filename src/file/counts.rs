//! The sizes of a tree's arrays, as a header or a record states them.

use super::field::{demand, illegal};
use crate::error::FormatError;
use crate::octree::view::element_levels;
use crate::octree::{Tag, dictionary};

/// Raw bricks, one after another; part of the format.
pub(super) const ENCODING_RAW: u8 = 0;

/// Bricks through a dictionary; part of the format.
pub(super) const ENCODING_DICTIONARY: u8 = 1;

/// The smallest base-2 logarithm of the number of bricks in a segment; part of the format.
const LEAST_SEGMENT_SHIFT: u8 = 16;

/// The numbers of elements, bricks and dictionary entries of a tree, and the encoding of its bricks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Counts {
    pub depth: u8,
    pub root: u8,
    pub brick_encoding: u8,
    pub segment_shift: u8,
    pub elements: u64,
    pub bricks: u64,
    pub dictionary_entries: u64,
}

impl Counts {
    /// Checks everything that can be checked without the arrays. The depth is legal already.
    pub(super) fn check(&self) -> Result<(), FormatError> {
        match self.brick_encoding {
            ENCODING_RAW => {
                demand("segment shift", self.segment_shift, 0u64)?;
                demand("dictionary entries", self.dictionary_entries, 0u64)?;
            }
            ENCODING_DICTIONARY => {
                let shift = self.segment_shift;
                // A single segment has only one representation.
                let whole = self.segments() == 1;
                if !(LEAST_SEGMENT_SHIFT..=dictionary::WHOLE).contains(&shift)
                    || whole != (shift == dictionary::WHOLE)
                {
                    return Err(illegal("segment shift", shift));
                }
                if self.dictionary_entries == 0 || self.dictionary_entries > self.bricks {
                    return Err(illegal("dictionary entries", self.dictionary_entries));
                }
            }
            unknown => return Err(illegal("brick encoding", unknown)),
        }
        if element_levels(self.depth) == 1 {
            demand("elements", self.elements, 0u64)?;
        }
        if self.root != Tag::Branch as u8 {
            demand("elements", self.elements, 0u64)?;
            demand("bricks", self.bricks, 0u64)?;
        }
        Ok(())
    }

    /// Returns the number of segments of the dictionary.
    pub(super) fn segments(&self) -> u64 {
        match 1u64.checked_shl(self.segment_shift.into()) {
            Some(length) => self.bricks.div_ceil(length),
            None => 0,
        }
    }
}
