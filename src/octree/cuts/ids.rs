//! Which surfaces records have, in as few bytes a number as their count allows.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// Numbers of surfaces, one after the other: of one byte if there are up to 256 surfaces, of two up to 65 536, else of four.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Ids<'a> {
    U8(&'a [u8]),
    U16(&'a [u16]),
    U32(&'a [u32]),
}

/// The same in memory.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OwnedIds {
    U8(Vec<u8>),
    U16(Vec<u16>),
    U32(Vec<u32>),
}

/// Bytes of a number where there are so many surfaces.
pub(crate) const fn width(surfaces: usize) -> usize {
    match surfaces {
        0..=0x100 => 1,
        0x101..=0x1_0000 => 2,
        _ => 4,
    }
}

impl<'a> Ids<'a> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Ids::U8(ids) => ids.len(),
            Ids::U16(ids) => ids.len(),
            Ids::U32(ids) => ids.len(),
        }
    }

    /// Bytes of a number.
    pub(crate) fn width(&self) -> usize {
        match self {
            Ids::U8(_) => 1,
            Ids::U16(_) => 2,
            Ids::U32(_) => 4,
        }
    }

    pub(crate) fn get(&self, index: usize) -> Option<u32> {
        match self {
            Ids::U8(ids) => ids.get(index).copied().map(u32::from),
            Ids::U16(ids) => ids.get(index).copied().map(u32::from),
            Ids::U32(ids) => ids.get(index).copied(),
        }
    }

    pub(crate) fn iter(self) -> impl ExactSizeIterator<Item = u32> + Clone + use<'a> {
        (0..self.len()).map(move |index| self.get(index).unwrap_or(u32::MAX))
    }

    pub(crate) fn copied(&self) -> Result<OwnedIds, Error> {
        Ok(match self {
            Ids::U8(ids) => OwnedIds::U8(memory::copied(ids)?),
            Ids::U16(ids) => OwnedIds::U16(memory::copied(ids)?),
            Ids::U32(ids) => OwnedIds::U32(memory::copied(ids)?),
        })
    }
}

impl PartialEq for Ids<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl OwnedIds {
    /// The narrowest form of `ids`, all of which are less than `surfaces`.
    pub(crate) fn narrowed(ids: Vec<u32>, surfaces: usize) -> Result<OwnedIds, Error> {
        Ok(match width(surfaces) {
            1 => OwnedIds::U8(memory::collected(ids.iter().map(|&id| id as u8))?),
            2 => OwnedIds::U16(memory::collected(ids.iter().map(|&id| id as u16))?),
            _ => OwnedIds::U32(ids),
        })
    }

    pub(crate) fn view(&self) -> Ids<'_> {
        match self {
            OwnedIds::U8(ids) => Ids::U8(ids),
            OwnedIds::U16(ids) => Ids::U16(ids),
            OwnedIds::U32(ids) => Ids::U32(ids),
        }
    }
}

/// The surfaces of a record: up to three.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct CellIds {
    ids: [u32; 3],
    count: u8,
}

impl CellIds {
    /// `count` of `ids` from `first` on; nothing where they end before.
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
