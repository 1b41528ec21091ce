//! Numbers of surfaces in records, with as few bits for each number as their count allows.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// Numbers of surfaces, one after the other, in a stream of bits. Each takes as many bits as the greatest
/// possible one, from the lowest bit of a byte on. The unused bits of the last byte are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ids<'a> {
    pub bytes: &'a [u8],
    /// Number of bits of a number.
    pub width: u32,
}

/// Numbers of surfaces in memory.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OwnedIds {
    bytes: Vec<u8>,
    width: u32,
}

/// Returns the number of bits of a number, if there are this many surfaces.
pub(crate) const fn width(surfaces: u64) -> u32 {
    match surfaces {
        0..=2 => 1,
        more => u64::BITS - (more - 1).leading_zeros(),
    }
}

/// Returns the bytes of `count` numbers of `width` bits each.
pub(crate) const fn bytes(count: u64, width: u32) -> u64 {
    (count * width as u64).div_ceil(8)
}

impl Ids<'_> {
    /// Returns the number with an index; an arbitrary number if it lies in the last byte and beyond the end.
    pub(crate) fn get(&self, index: usize) -> Option<u32> {
        let bit = (index as u64).checked_mul(self.width.into())?;
        let (first, shift) = (usize::try_from(bit / 8).ok()?, bit % 8);
        let word = match self.bytes.get(first..).and_then(<[u8]>::first_chunk) {
            Some(eight) => u64::from_le_bytes(*eight),
            None => {
                // (The end of the stream.)
                let end = (bit + u64::from(self.width)).div_ceil(8);
                let rest = self.bytes.get(first..usize::try_from(end).ok()?)?;
                rest.iter().rev().fold(0, |all, &byte| all << 8 | u64::from(byte))
            }
        };
        Some((word >> shift & ((1 << self.width) - 1)) as u32)
    }

    /// True if the stream ends after `count` numbers.
    pub(crate) fn ends_with(&self, count: usize) -> bool {
        let bits = (count as u64 * u64::from(self.width)) % 8;
        let is_rest_zero = bits == 0 || self.bytes.last().is_some_and(|&last| last >> bits == 0);
        self.bytes.len() as u64 == bytes(count as u64, self.width) && is_rest_zero
    }

    pub(crate) fn copied(&self) -> Result<OwnedIds, Error> {
        Ok(OwnedIds { bytes: memory::copied(self.bytes)?, width: self.width })
    }
}

impl OwnedIds {
    /// Returns the stream of `ids`, all of which are less than `surfaces`.
    pub(crate) fn packed(
        ids: impl ExactSizeIterator<Item = u32>,
        surfaces: usize,
    ) -> Result<OwnedIds, Error> {
        let width = width(surfaces as u64);
        let mut all = memory::with_capacity(bytes(ids.len() as u64, width) as usize)?;
        let (mut word, mut filled) = (0u64, 0);
        for id in ids {
            word |= u64::from(id) << filled;
            filled += width;
            while filled >= 8 {
                all.push(word as u8);
                word >>= 8;
                filled -= 8;
            }
        }
        if filled > 0 {
            all.push(word as u8);
        }
        Ok(OwnedIds { bytes: all, width })
    }

    pub(crate) fn view(&self) -> Ids<'_> {
        Ids { bytes: &self.bytes, width: self.width }
    }
}

/// The surfaces of a record: up to three.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct CellIds {
    ids: [u32; 3],
    count: u8,
}

impl CellIds {
    /// Returns `count` of `ids` from `first` on; `None` if the stream ends before.
    pub(crate) fn read(ids: Ids<'_>, first: usize, count: usize) -> Option<CellIds> {
        let mut own = CellIds { ids: [0; 3], count: count as u8 };
        for (i, id) in own.ids.get_mut(..count)?.iter_mut().enumerate() {
            *id = ids.get(first.checked_add(i)?)?;
        }
        Some(own)
    }
}

impl core::ops::Deref for CellIds {
    type Target = [u32];

    fn deref(&self) -> &[u32] {
        &self.ids[..usize::from(self.count)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back() {
        assert_eq!([0, 1, 2, 3, 256, 257, 1 << 32].map(width), [1, 1, 1, 2, 8, 9, 32]);
        for surfaces in [1u32, 2, 3, 200, 833, 1 << 20, u32::MAX] {
            for count in [0, 1, 2, 3, 7, 8, 9, 100] {
                let id = |i: u32| (i.wrapping_mul(0x9E37_79B9) ^ 0x5555) % surfaces;
                let own =
                    OwnedIds::packed((0..count as usize).map(|i| id(i as u32)), surfaces as usize).unwrap();
                assert!((0..count).all(|i| own.view().get(i as usize) == Some(id(i))));
                assert!(own.view().ends_with(count as usize));
                let far = count as usize + 8;
                assert_eq!(own.view().get(far), None);
                assert!(!own.view().ends_with(far));
            }
        }
    }
}
